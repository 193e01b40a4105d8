"""`poekin axes`: how the axes of an arm lie to each other."""

from __future__ import annotations


def test_pairs_and_shapes_are_said(poekin):
    code, out, err = poekin("axes", "panda", "--tip", "panda_hand")
    assert (code, err) == (0, "")
    assert "perpendicular, 82.5 mm from intersecting" in out
    assert "spherical shoulder" in out


def test_json_has_every_pair(as_json):
    document = as_json("axes", "panda", "--tip", "panda_hand")
    assert len(document["pairs"]) == 11
    assert document["shapes"][0]["kind"] == "spherical shoulder"
    assert document["shapes"][0]["joints"] == [1, 2, 3]


def test_a_tree_without_a_tip_and_a_bad_tolerance_are_refused(crane, refused):
    assert "hook" in refused("axes", crane)
    assert "tol_mm" in refused("axes", crane, "--tip", "hook", "--tol-mm", "-1")
