"""Where a robot is from."""

from __future__ import annotations

from poekin.model.provenance import Source


def test_sources_are_equal_by_where_they_are_from_and_not_by_their_text():
    assert Source("a.urdf", text="x") == Source("a.urdf", text="y", mjcf="z")
    assert Source("a.urdf") != Source("b.urdf")
    assert Source("a.urdf", link_lines=(1,)) != Source("a.urdf", link_lines=(2,))


def test_a_source_shows_its_name_and_never_its_whole_text():
    shown = repr(Source("a.xml", text="<robot/>", mjcf="<mujoco/>"))
    assert shown == "Source(name='a.xml', link_lines=(), joint_lines=())"
