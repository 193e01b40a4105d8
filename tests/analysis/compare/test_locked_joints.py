"""Positions at which joints can be held: what is asked of the axes beside them, and the steps
towards it.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare import unmatched_joints
from poekin.analysis.compare.alignment.lines import lines
from poekin.analysis.compare.locked_joints import (
    _angle,
    _apart,
    _misfit,
    _placed,
    _relations,
    _side,
    _starts,
    _step,
    held_positions,
)
from poekin.model import screw
from poekin.model.chain import Chain

X, Y, Z = np.eye(3)
TOL = Tolerances(1e-5, np.radians(1e-3))


def arm_of(letters, seed=0):
    """An arm of these joints, r, p or h, that stand anyhow."""
    rng = np.random.default_rng(seed)
    make = {
        "r": screw.revolute,
        "h": lambda z, p: screw.helical(z, p, 0.05),
        "p": lambda z, p: screw.prismatic(z),
    }
    rows = rng.normal(size=(len(letters), 2, 3))
    return Chain.from_space(
        [make[letter](z, 0.4 * p) for letter, (z, p) in zip(letters, rows, strict=True)], np.eye(4)
    )


def at(rows):
    return lines(Chain.from_space(rows, np.eye(4)))


def revolving(z, p=(0, 0, 0)):
    return screw.revolute(z, p)


def test_a_step_is_the_damped_one_of_its_own_equations():
    rng = np.random.default_rng(1)
    r, J = rng.normal(size=(5, 4)), rng.normal(size=(5, 4, 2))
    for step, e, D in zip(_step(r, J), r, J, strict=True):
        # min |D step + e|² + |e|² |step|², as one least squares problem
        stacked = np.concatenate([D, np.linalg.norm(e) * np.eye(2)])
        assert step == pytest.approx(
            np.linalg.lstsq(stacked, -np.append(e, [0, 0]), rcond=None)[0], rel=1e-12
        )
        assert np.linalg.norm(step) <= 0.5


def test_where_the_axes_leave_a_position_free_a_step_stays_finite():
    for J in ([0, 0], [1, 1], [1e4, 1e4]):
        assert (_step(np.zeros((1, 1)), np.array(J, float)[None, None]) == 0).all()


@pytest.mark.parametrize("letters", ["rrr", "hrp", "prh", "rpr", "pp", "h"])
def test_the_jacobian_is_that_of_the_misfit(letters):
    ours = lines(arm_of(f"r{letters}rr"))
    run, behind = range(1, 1 + len(letters)), [1 + len(letters), 2 + len(letters)]
    relations = [
        _angle(ours.ways[0], X, Y, 0, slice(0, 3)),
        _angle(ours.ways[0], X, X, 1, slice(0, 3)),
        _apart(ours.axes[0], revolving(X, [0, 1, 0]), revolving(Y, [0, 0, 2]), 1),
        _apart(ours.axes[0], revolving(X, [0, 1, 0]), revolving(X, [0, 0, 2]), 0),
    ]
    x = np.random.default_rng(3).normal(size=(3, len(letters)))
    r, J = _misfit(ours, run, behind, relations, x)
    assert (r.shape, J.shape) == ((3, 6), (3, 6, len(letters)))
    for c, step in enumerate(1e-6 * np.eye(len(letters))):
        ahead, back = (_misfit(ours, run, behind, relations, y)[0] for y in (x + step, x - step))
        assert J[..., c] == pytest.approx((ahead - back) / 2e-6, abs=1e-8)


def test_a_misfit_is_what_angle_and_place_of_the_axes_miss():
    # Held at 90 degrees, joint 2 takes the axis along x at height 1 to the one along y at height 1.
    ours = at([revolving(Y), revolving(Z), revolving(X, [0, 0, 1])])
    centre = ours.centre[2]
    turned = np.array([[0.0], [np.pi / 2], [np.pi / 6]])

    def miss(relation):
        return _misfit(ours, [1], [2], [relation], turned)[0]

    assert miss(_angle(Y, X, Y, 0, slice(0, 3)))[:, 0] == pytest.approx([0, 1, 0.5])
    assert miss(_angle(Y, X, np.array([0.8, 0.6, 0]), 0, slice(0, 3)))[:, 0] == pytest.approx(
        [-0.8, 0.2, -0.3]
    )
    parallel = miss(_angle(Y, X, -X, 0, slice(0, 3)))
    assert np.linalg.norm(parallel, axis=1) == pytest.approx([1, 0, np.sqrt(0.75)])
    # The mutual moment of skew lines is their distance by the sine of their angle.
    skew = _apart(ours.axes[0], revolving(Y), revolving(X, [0, 0, 3]), 0)
    assert abs(miss(skew)[:, 0]) == pytest.approx([2, 3, abs(np.cos(np.pi / 6) - 3)])
    # The axes are |1| apart where they are parallel, whichever way they point.
    for first, second in ((Y, Y), (Y, -Y)):
        ahead = at([revolving(first), revolving(Z), revolving(second, [0, 0, 1])])
        for far in (1.0, 3.0):
            near = _apart(ahead.axes[0], revolving(first), revolving(second, [0, 0, far]), 0)
            assert _misfit(ahead, [1], [2], [near], np.zeros((1, 1)))[0][0] == pytest.approx(
                [1 - far * far]
            )
    assert centre == pytest.approx(0.5)


def test_starts_are_evenly_over_a_turn_or_three_about_zero_and_on_both_sides_of_a_slide():
    ours = at([revolving(Z), screw.helical(Z, [1, 0, 0], 0.1), screw.prismatic(X)])
    turn = np.sort(_starts(ours, [0])[:, 0])
    assert (len(turn), turn[0]) == (8, 0)
    assert np.diff(turn) == pytest.approx(np.full(7, np.pi / 4))
    turns = np.sort(_starts(ours, [1])[:, 0])
    assert len(turns) == 24
    assert np.diff(turns) == pytest.approx(np.full(23, np.pi / 4))
    assert turns[0] == pytest.approx(-3 * np.pi)
    assert _starts(ours, [2])[:, 0].tolist() == [-0.5, 0, 0.5]
    both = _starts(ours, [2, 0])
    assert {(x, y) for x, y in both} == set(product([-0.5, 0, 0.5], turn))


def test_the_axes_of_a_side_are_its_first_and_those_behind_slides_up_to_a_joint_that_is_gone():
    ours = at(
        [
            revolving(Z),
            screw.prismatic(X),
            screw.prismatic(Y),
            revolving(X, [0, 1, 0]),
            revolving(Y),
        ]
    )
    for joints, gone, side in (
        ([3, 2, 1, 0], [], [3]),
        ([2, 1, 0], [], [2, 1, 0]),
        ([1, 2, 3, 4], [], [1, 2, 3]),
        ([1, 2, 3], [2], [1]),
        ([1, 2, 3], [1], []),
        ([2], [], [2]),
    ):
        assert _side(ours, joints, gone) == side


@pytest.mark.parametrize("rows, placed", [
    ([revolving(Z)], True),
    ([screw.prismatic(Z)], False),
    ([screw.prismatic(Z), revolving(Z, [1, 0, 0])], True),  # it slides along itself
    ([screw.prismatic(-Z), revolving(Z, [1, 0, 0])], True),
    ([screw.prismatic([1e-3, 0, 1]), revolving(Z, [1, 0, 0])], False),
    ([screw.prismatic([1e-7, 0, 1]), revolving(Z, [1, 0, 0])], True),
    ([screw.prismatic(Z), screw.prismatic(X), revolving(Z, [1, 0, 0])], False),
    ([screw.prismatic(Z), screw.prismatic(X)], False),
    ([screw.prismatic(X), screw.prismatic(X)], False),
])  # fmt: skip
def test_an_axis_behind_a_slide_has_a_place_where_it_slides_along_itself(rows, placed):
    assert _placed(at(rows), list(range(len(rows)))) == placed


@pytest.mark.parametrize("letters, k, count", [
    ("rrr", 1, 2),  # angle and moment
    ("prr", 1, 1),  # an angle alone
    ("rrpr", 1, 2),  # two angles: a slide moves the second axis' place
    ("rprrr", 2, 2),
    ("rprpr", 2, 4),
])  # fmt: skip
def test_axes_before_have_their_angles_to_those_behind_and_the_nearest_with_places_their_moment(
    letters, k, count
):
    ours = lines(arm_of(letters))
    front, behind = (
        _side(ours, range(k - 1, -1, -1), []),
        _side(ours, range(k + 1, len(letters)), []),
    )
    relations = _relations(ours, front, behind, dict(enumerate(ours.axes)))
    assert len(relations) == count
    assert _misfit(ours, [k], behind, relations, np.zeros((1, 1)))[0] == pytest.approx(
        np.zeros((1, count)), abs=1e-14
    )


def test_the_distance_to_an_axis_behind_two_slides_along_it_is_its_own():
    slides = [screw.prismatic(Z)] * 2
    ours = at([revolving(X), revolving(Y, [0.2, 0, 0]), *slides, revolving(Z, [1, 2, 0])])
    relations = _relations(ours, [0], [2, 3, 4], dict(enumerate(ours.axes)))
    assert [relation.place for relation in relations] == [0, 1, 2, 2]
    miss = _misfit(ours, [1], [2, 3, 4], relations, np.zeros((1, 1)))[0]
    assert miss == pytest.approx(np.zeros((1, 4)), abs=1e-14)


def positions(chain, run, gone, held, tol=TOL):
    short = unmatched_joints.without(chain, gone, held)
    return held_positions(chain, short, run, gone, tol)


@pytest.mark.parametrize("flipped", [(), (0,), (1,), (0, 1), (1, 2), (0, 2), (2, 3)], ids=str)
@pytest.mark.parametrize("letters", ["rrrrr", "prrpr", "rprrr", "pprrr", "rrrpp"])
def test_the_other_model_s_axes_may_point_either_way(letters, flipped):
    chain = arm_of(letters, seed=2)
    short = unmatched_joints.without(chain, (2,), [0.9])
    S = np.array([-row if k in flipped else row for k, row in enumerate(short.screws)])
    found = held_positions(chain, Chain.from_space(S, short.home), (2,), (2,), TOL)
    assert min(abs(x - 0.9) for (x,) in found) < 1e-9
    assert all(abs(x) <= np.pi for (x,) in found)


@pytest.mark.parametrize("letters, run", [
    ("rrrr", (1,)), ("rrrr", (2,)), ("rpprrr", (3,)), ("rprprr", (3,)), ("rrrppr", (2,)), ("rprpr", (2,)),
    ("rrrprpr", (4,)), ("rpprppr", (3,)), ("rprpprr", (2,)), ("rprrrpr", (2, 4)),
])  # fmt: skip
def test_more_axes_than_needed_leave_one_position(letters, run):
    chain, held = arm_of(letters, seed=4), np.array([0.7, -0.4])[: len(run)]
    short = unmatched_joints.without(chain, run, held)
    for k, x in zip(run, held, strict=True):
        # Each of two that are apart is looked for where the other one is held.
        others = [j for j in run if j != k]
        known = chain.rezeroed(
            np.where(np.isin(range(chain.dof), others), np.resize(held[::-1], chain.dof), 0.0)
        )
        found = held_positions(known, short, (k,), run, TOL)
        assert len(found) == 1
        assert found[0][0] == pytest.approx(x, abs=1e-9)


@pytest.mark.parametrize("share, found", [(0.99, True), (1.01, False)])
@pytest.mark.parametrize("size", [0.5, 4.0])
def test_a_length_may_be_missed_by_ten_tolerances_of_length_and_of_angle_by_the_arm_s_size(
    share, found, size
):
    # The axis behind is carried about joint 2, and is 1.5 size from the one before at most; the
    # other model's is more.
    def arm(far):
        return [revolving(Z), revolving(Z, [0.5 * size, 0, 0]), revolving(X, [0, -far, 0])]

    chain = Chain.from_space(arm(size), np.eye(4))
    scale = float(np.linalg.norm(lines(chain).places))
    short = Chain.from_space(np.delete(arm((1.5 + 0.4 * share) * size), 1, 0), np.eye(4))
    tol = Tolerances(0.03 * size, 0.01 * size / scale)
    assert bool(held_positions(chain, short, (1,), (1,), tol)) == found


def test_of_a_continuum_of_positions_sixteen_are_tried_that_differ():
    chain = Chain.from_space(
        [revolving(Z, [x, 0, 0]) for x in (0.0, 0.4, 0.6, 0.7, 1.0)], np.eye(4)
    )
    found = positions(chain, (1, 2), (1, 2), [0.5, -0.9])
    assert len(found) == 16
    assert all(
        max(map(abs, np.subtract(x, y))) > TOL.rotation
        for k, x in enumerate(found)
        for y in found[:k]
    )


@pytest.mark.parametrize("share, found", [(0.99, True), (1.01, False)])
@pytest.mark.parametrize("metres", [0.3, 10.0])
def test_ten_tolerances_of_angle_and_of_length_by_the_arm_s_size_may_be_missed(
    share, found, metres
):
    # Held anyhow, joint 2 takes the axis behind it to a cosine of cos(0.2) to the slide at most.
    def arm(cosine):
        first, way = ([np.sin(angle), 0, np.cos(angle)] for angle in (0.1, 0.1 + np.arccos(cosine)))
        return [screw.prismatic(first), revolving(Z), revolving(way, [0, metres, 0])]

    chain = Chain.from_space(arm(np.cos(0.2)), np.eye(4))
    size = float(np.linalg.norm(lines(chain).places))
    assert size == pytest.approx(metres / np.sqrt(2))
    short = Chain.from_space(np.delete(arm(np.cos(0.2) + 0.019 * share), 1, 0), np.eye(4))
    assert bool(held_positions(chain, short, (1,), (1,), Tolerances(9e-4 * size, 1e-3))) == found


def test_without_any_place_the_tolerance_is_the_size():
    chain = Chain.from_space([screw.prismatic(X), revolving(Z), screw.prismatic(X)], np.eye(4))
    ((x,), *_) = positions(chain, (1,), (1,), [0.5])
    assert abs(x) == pytest.approx(0.5)


def test_positions_come_the_best_first():
    # The mutual moment tells 0.5 alone; with it off by less than ten tolerances both signs of the
    # angle are near.
    chain = Chain.from_space(
        [revolving(X, [0, 0, 0.3]), revolving(Z), revolving([1, 0, 0.5], [0, 0.4, -0.2])], np.eye(4)
    )
    found = [x for (x,) in positions(chain, (1,), (1,), [0.5], Tolerances(0.02, 0.02))]
    assert len(found) > 1
    assert found[0] == pytest.approx(0.5, abs=1e-6)
