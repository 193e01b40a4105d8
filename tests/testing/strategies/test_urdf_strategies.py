"""URDFs with oddities: to Pinocchio each is the robot that it was made of, and what is named is
there.
"""

from __future__ import annotations

import re

import numpy as np
import pytest

from poekin.errors import InputError
from poekin.formats.urdf_text import to_urdf
from poekin.testing.strategies.urdf_strategies import ODDITIES, odd_urdfs
from tests.testing.drawing import drawn

pin = pytest.importorskip("pinocchio")


def frames(text):
    """The poses of all frames by name, each joint moved by 0.3."""
    model = pin.buildModelFromXML(text)
    data = model.createData()
    q = pin.integrate(model, pin.neutral(model), np.full(model.nv, 0.3))
    pin.framesForwardKinematics(model, data, q)
    return {frame.name: T.homogeneous for frame, T in zip(model.frames, data.oMf, strict=True)}


@pytest.mark.parametrize("oddity", ODDITIES)
def test_an_oddity_is_there_and_changes_nothing_of_the_robot(oddity):
    odd = 0
    for text, name, robot in drawn(odd_urdfs(oddity), 12):
        plain = to_urdf(robot)
        assert name == oddity
        odd += text != plain
        truth, found = frames(plain), frames(text)
        assert list(found) == list(truth)
        # Of axes that are longer by 5e-7, a reader that does not normalise turns by so much more.
        within = 1e-5 if oddity == "axes off unit length" else 1e-14
        for frame, T in found.items():
            np.testing.assert_allclose(T, truth[frame], rtol=0, atol=within)
    assert bool(odd) is (oddity != "none")


def test_what_there_is_not_is_refused():
    with pytest.raises(InputError, match=r"oddities: there is no 'two axes'"):
        odd_urdfs("two axes")


def test_axes_off_unit_length_are_longer_by_half_a_millionth():
    lengths = set()
    for text, _, _ in drawn(odd_urdfs("axes off unit length"), 12):
        axes = re.findall(r'<axis xyz="([^"]*)"', text)
        lengths |= {
            round(float(np.linalg.norm([float(x) for x in axis.split()])), 9) for axis in axes
        }
    assert lengths == {1.0000005}
