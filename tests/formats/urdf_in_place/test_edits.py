"""Changes to one joint: what changed by no more than is rounding stays as it is written."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from poekin.formats import urdf
from poekin.formats.urdf_in_place.edits import JointText, Still, apply_edits, edits_of
from poekin.formats.urdf_in_place.spans import find

PARENT = '<parent link="a"/><child link="b"/><limit lower="-1" upper="1" effort="1" velocity="1"/>'


def moved(inside: str, still: Still, xyz=None, axis=None) -> str:
    """What stands before the parent once the joint of a text has another place or axis."""
    joint = f'<joint name="j" type="revolute">{inside}{PARENT}</joint>'
    text = f'<robot name="r"><link name="a"/><link name="b"/>{joint}</robot>'
    (before,) = urdf.read_text(text).joints
    origin = before.origin.copy()
    if xyz is not None:
        origin[:3, 3] = xyz
    wanted = replace(before, origin=origin, axis=before.axis if axis is None else axis)
    content = text.encode()
    written = JointText(content, find(content, "x").joints[0], before, "", False)
    edited = apply_edits(content, list(edits_of(written, wanted, still))).decode()
    return edited.split('type="revolute">')[1].split("<parent")[0]


@pytest.mark.parametrize(
    ("length", "expected"),
    [(0.5, '<origin xyz="1 2 3"/>'), (0.4999, '<origin xyz="1.5 2 3"/>')],
)
def test_a_length_stays_up_to_what_is_rounding(length, expected):
    found = moved('<origin xyz="1 2 3"/>', Still(0.0, length), xyz=[1.5, 2, 3])
    assert found == expected


@pytest.mark.parametrize(("angle", "expected"), [(1.0, ""), (0.999, '<axis xyz="0 0 1"/>')])
def test_an_axis_that_is_not_written_stays_so_up_to_what_is_rounding(angle, expected):
    assert moved("", Still(angle, 0.0), axis=np.array([0.0, 0.0, 1.0])) == expected


def test_of_numbers_of_which_one_changed_the_others_keep_their_digits():
    inside = '<origin xyz="1.00 2.000 3.0"/>'
    found = moved(inside, Still(0.0, 0.25), xyz=[1.25, 2.5, 2.75])
    assert found == '<origin xyz="1.00 2.5 3.0"/>'
    # so does a new attribute, whose old numbers are 0
    found = moved("", Still(0.0, 0.25), xyz=[0.25, 0.5, -0.25])
    assert found == '<origin xyz="0 0.5 0"/>'
