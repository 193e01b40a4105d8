"""A file in left-handed coordinates is recognised, and no other one is."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.planted_changes import ARMS, arm, planted
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.alignment.search import search
from poekin.analysis.compare.compare import compare
from poekin.analysis.compare.mistakes.mirror import AXES, Axis, mirror_of, mirrored
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain

TOL = Tolerances(1e-5, np.radians(1e-3))


@pytest.mark.parametrize("axis", AXES)
def test_the_mirrored_arm_reaches_the_mirrored_poses(axis):
    chain = arm("random 7a")
    F = np.eye(4)
    k = AXES.index(axis)
    F[k, k] = -1.0
    q = chain.random(0, 10)
    assert mirrored(chain, axis).fk(q) == pytest.approx(F @ chain.fk(q) @ F, abs=1e-13)
    assert mirrored(mirrored(chain, axis), axis).screws == pytest.approx(chain.screws)


def test_a_thread_runs_the_other_way_in_a_mirror():
    row = screw.helical([0, 0, 1], [0.1, 0, 0], 0.02)
    chain = Chain.from_space([row], np.eye(4))
    F = np.diag([1.0, -1.0, 1.0, 1.0])
    other = mirrored(chain, "y")
    assert other.fk([0.7]) == pytest.approx(F @ chain.fk([0.7]) @ F, abs=1e-15)
    assert other.pitches.tolist() == [-0.02]


# Each arm with one coordinate, each coordinate with two or three arms.
@pytest.mark.parametrize("name, axis", [*zip(list(ARMS)[::3], AXES * 3, strict=False)])
def test_a_mirrored_file_is_named_with_the_coordinate_that_is_negated(name, axis):
    chain = arm(name)
    # A file keeps the sign that its axes had.
    other = mirrored(chain, axis)
    flipped = other.replace(screws=-other.screws)
    for b in (other, flipped):
        result = compare(chain, b, samples=5)
        assert (result.outcome, result.mistake) == ("differ", "mirrored")
        assert f"{axis} of its base is -{axis} of a's" in result.findings[0]
        assert not any(joint.axis_differs for joint in result.joints)
        assert result.before is not None
        assert result.after is not None
        # Axes agree within 1e-5 m and 1.7e-5 rad; up to 9 joints turn what is up to 3 m away.
        assert result.after.worst_position < 1e-3 < result.before.worst_position


@pytest.mark.parametrize("name, axis", [*zip(["ur5e", "panda", "random 6a"], AXES, strict=True)])
def test_a_mirrored_file_that_is_calibrated_too_is_named_and_its_axes_are_sized(name, axis):
    chain = arm(name)
    other = mirrored(worn(chain), axis)
    for a, b in ((chain, other), (other, chain)):
        result = compare(a, b, samples=5)
        assert (result.outcome, result.mistake) == ("differ", "mirrored")
        assert result.findings[0].startswith(f"model b is a mirrored: {axis} of its base")
        assert not any(joint.reversed for joint in result.joints)
        assert max(joint.angle for joint in result.joints) < 0.01


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("name", ["ur5e", "panda", "random 6a"])
def test_a_calibrated_arm_is_no_mirror_nor_with_all_its_directions_reversed(name, way):
    chain = worn(arm(name))
    other = chain.replace(screws=way * chain.screws)
    assert compare(arm(name), other, samples=1).mistake == ""


def worn(chain):
    """The arm with each axis turned by a milliradian or so and moved by half a millimetre or so."""
    rng = np.random.default_rng(0)
    motions = rng.normal(size=(chain.dof, 6)) * [*[1e-3] * 3, *[5e-4] * 3]
    Ad = se3.adjoint(se3.exp(motions))
    return chain.replace(screws=(Ad @ chain.screws[..., None])[..., 0])


def test_a_mirrored_file_that_stands_elsewhere_is_named_too():
    chain = arm("random 6a")
    other = mirrored(chain, "y").rebased(se3.exp([0.1, 0.2, 0.3, 1, 0, 0]))
    result = compare(chain, other, samples=5)
    assert result.mistake == "mirrored"
    assert any(text.startswith("aligned: the base frame") for text in result.findings)


@pytest.mark.parametrize("name", ["panda", "ur5e", "random 6b"])
@pytest.mark.parametrize("change", ["flip", "zero", "shift"])
def test_what_is_no_mirror_is_not_called_one(name, change):
    chain = arm(name)
    rng = np.random.default_rng(0)
    other = planted(planted(chain, change, 3, rng), "flip", 4, rng)
    assert compare(chain, other, samples=1).mistake == ""
    assert mirror_of(chain, other, TOL, moved=False) is None


def planes(directions, places, q):
    """An arm that the plane of x and z mirrors onto itself at q = 0, from where it stands at q."""
    rows = [screw.revolute(w, p) for w, p in zip(directions, places, strict=True)]
    home = se3.exp([0, 0, 0, 0.9, 0, 0.95])
    return Chain.from_space(rows, home).rezeroed(q)


def test_what_two_changes_of_convention_explain_as_well_is_a_mirror_and_one_change_is_none():
    x, y, z = np.eye(3)
    places = [[0, 0, 0], [0.1, 0, 0.4], [0.1, 0, 0.9], [0.2, 0, 0.95], [0.7, 0, 0.95]]
    three = planes([z, y, y, x, y], places, [0.3, 0.4, 0.2, 0.5, 0.1])
    two = planes([z, y, y, x, y], places, [0.3, 0.4, 0.2, 0, 0.1])  # the fourth joint has its zero
    one = planes([y, y, x, y], places[1:], [0, 0.3, 0, 0.2])  # the third joint turns the other way
    cases: list[tuple[Chain, Axis, str, int]] = [
        (three, "x", "mirrored", 3),
        (two, "x", "mirrored", 2),
        (one, "y", "", 1),
    ]
    for chain, axis, mistake, changes in cases:
        other = mirrored(chain, axis)
        reading = search(chain, other, TOL)[0]
        assert (reading.moved.any(), reading.changes.sum()) == (False, changes)
        assert mirror_of(chain, other, TOL, moved=False) is not None
        assert compare(chain, other, samples=5).mistake == mistake
