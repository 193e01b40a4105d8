"""Axes as lines about a centre, and how far another arm's axes are from them, on arms worked out by
hand.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.planted_changes import random_arm
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.alignment.alignments import Alignments
from poekin.analysis.compare.alignment.lines import lines, sides
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain

X, Y, Z = np.eye(3)
TOOL = se3.exp(np.array([0, 0, 0, 0.3, 0.4, 9.0]))


def chain_of(*rows, home=TOOL, **data):
    return Chain.from_space(rows, home, **data)


@pytest.mark.parametrize("rows, centre", [
    ([screw.revolute(Z, [1, 2, 0]), screw.revolute(Y, [1, 0, 5])], [1, 2, 5]),  # where they cross
    ([screw.revolute(Z, [1, 2, 0]), screw.revolute(Y, [3, 0, 5])], [2, 2, 5]),  # halfway
    # level with the tool
    ([screw.revolute(Z, [1, 2, 0]), screw.revolute(Z, [3, 2, 0])], [2, 2, 9]),
    # as good as parallel
    ([screw.revolute(Z, [1, 2, 0]), screw.revolute([0, 0.005, 1], [3, 2, 9])], [2, 2, 8.996]),
    ([screw.revolute(Z, [1, 2, 0]), screw.prismatic(Y)], [1, 2, 9]),  # a slide has no place
    ([screw.prismatic(X)], [0.3, 0.4, 9]),
    ([screw.helical(Z, [1, 2, 0], 0.1)], [1, 2, 9]),
])  # fmt: skip
def test_the_hub_is_the_point_nearest_to_all_axes(rows, centre):
    assert lines(chain_of(*rows)).centre == pytest.approx(centre, abs=1e-4)


def test_lines_are_about_the_hub_and_without_pitch():
    side = lines(
        chain_of(screw.revolute(Z, [1, 2, 0]), screw.helical(Y, [3, 0, 5], 0.2), screw.prismatic(X))
    )
    assert side.centre == pytest.approx([2, 2, 5])
    assert side.places == pytest.approx(np.array([[-1, 0, 0], [1, 0, 0], [0, 0, 0]]))
    assert side.ways == pytest.approx(np.array([Z, Y, X]))
    assert side.axes == pytest.approx(
        np.array([[0, 0, 1, 0, 1, 0], [0, 1, 0, 0, 0, 1], [0, 0, 0, 1, 0, 0]])
    )
    assert side.screws[1] - side.axes[1] == pytest.approx([0, 0, 0, 0, 0.2, 0])


def moved(chain, k, angle=0.0, length=0.0, along=X):
    """The chain whose axis k is turned about, and then moved by a length along, a direction at its
    place.
    """
    S, side = chain.screws.copy(), lines(chain)
    place = side.places[k] + side.centre
    S[k] = se3.adjoint(se3.exp(np.array([0, 0, 0, *(length * along)]))) @ S[k]
    S[k] = se3.adjoint(se3.exp(angle * screw.revolute(along, place))) @ S[k]
    return Chain.from_space(S, chain.home)


def test_a_miss_is_the_larger_of_the_turn_and_the_way_at_its_place_each_in_tolerances():
    chain = chain_of(screw.revolute(Z, [1, 2, 0]), screw.revolute(Y, [3, 0, 5]), screw.prismatic(Z))
    tol = Tolerances(1e-4, 1e-3)
    for k, angle, length, expected in ((0, 3e-6, 5e-4, 5), (1, 0.003, 1e-5, 3), (2, 0.004, 7.0, 4)):
        other = moved(chain, k, angle, length)
        pair = sides(chain, other, tol)
        b = pair.transformed(pair.as_they_stand)
        assert b.deviations[0] == pytest.approx(
            np.where(np.arange(3) == k, expected, 0), rel=1e-3, abs=1e-8
        )
        # The direction comes first, as a vector; the place of a slide is its direction once more.
        r = b.residuals[0, k]
        if k < 2:
            assert np.linalg.norm(r[3:]) == pytest.approx(length / tol.position, rel=1e-3)
            assert np.linalg.norm(r[:3]) == pytest.approx(angle / tol.rotation, rel=1e-3)
        else:
            assert (np.linalg.norm(r[3:]), r[:3].any()) == (
                pytest.approx(angle / tol.rotation, rel=1e-3),
                False,
            )
        # And the other way round it is the same axis.
        flipped = Chain.from_space(
            other.screws * np.where(np.arange(3) == k, -1, 1)[:, None], other.home
        )
        pair = sides(chain, flipped, tol)
        b = pair.transformed(pair.as_they_stand)
        assert b.signs[0].tolist() == [-1 if i == k else 1 for i in range(3)]
        assert b.deviations[0, k] == pytest.approx(expected, rel=1e-3)


def test_joints_are_alike_whose_kind_is_the_same_and_whose_pitch_shows_less_than_the_tolerance_in_a_turn():
    def pair(pitch):
        a, b = (chain_of(screw.helical(Z, [1, 0, 0], h), screw.prismatic(Z), screw.revolute(Z, [1, 1, 0]))
                for h in (0.1, 0.1 + pitch))  # fmt: skip
        return sides(a, b, Tolerances(1e-5, 1e-3))

    assert pair(1.5e-6).alike.tolist() == [True, True, True]
    assert pair(-1.7e-6).alike.tolist() == [False, True, True]
    assert pair(0.0).zero_tolerance.tolist() == [1e-3, 1e-5, 1e-3]
    a, b = (
        chain_of(S, screw.revolute(Z, [1, 1, 0]))
        for S in (screw.prismatic(Z), screw.revolute(Z, [1, 0, 0]))
    )
    for one, two, tolerance in ((a, b, 1e-3), (b, a, 1e-5)):
        unlike = sides(one, two, Tolerances(1e-5, 1e-3))
        miss = unlike.deviations(Alignments.rigid(np.eye(4)[None], 2))
        assert (unlike.alike.tolist(), miss[0, 0]) == ([False, True], np.inf)
        assert unlike.zero_tolerance[0] == tolerance  # of b's joint


def test_a_hinge_turns_what_is_behind_it_about_the_other_model_s_axis_the_way_its_own_turns():
    chain = random_arm(3, ("revolute", "revolute", "prismatic", "revolute"))
    rng = np.random.default_rng(0)
    other = Chain.from_space(moved(moved(chain, 1, 0.1), 2, 0.2).screws, chain.home)
    P, z = se3.exp(0.1 * rng.normal(size=(2, 6))), 0.2 * rng.normal(size=(2, 4))
    for k in (1, 2):
        for sign in (1.0, -1.0):
            S = other.screws.copy()
            S[k] *= sign
            pair = replace(
                sides(chain, Chain.from_space(S, chain.home), Tolerances(1e-5, 1e-5)),
                suspect_joint=k,
            )
            D = pair.carriers(Alignments(P, z))
            D_k = D[:, k]
            own = sign * pair.a.screws[k]
            part = slice(3, 6) if k == 2 else slice(0, 3)
            assert ((se3.adjoint(D_k) @ pair.b.screws[k])[:, part] @ own[part] > 0).all()
            assert pair.suspect_screw(se3.adjoint(D_k) @ pair.b.screws[k]) == pytest.approx(
                np.stack([own, own])
            )
            assert D[:, k + 1] == pytest.approx(se3.exp(own * z[:, k, None]) @ D_k)
            for i in {0, 1, 2, 3} - {k}:
                assert D[:, i + 1] == pytest.approx(
                    D[:, i] @ se3.exp(pair.b.screws[i] * z[:, i, None])
                )


def test_an_axis_that_is_perpendicular_to_its_own_is_not_reversed():
    chain, other = (
        chain_of(screw.revolute(w, [0, 0, 0]), screw.revolute(Y, [1, 0, 0])) for w in (Z, X)
    )
    for sign in (1.0, -1.0):
        turned = Chain.from_space(other.screws * [[sign], [1.0]], other.home)
        pair = replace(sides(chain, turned, Tolerances(1e-5, 1e-5)), suspect_joint=0)
        b = pair.transformed(pair.as_they_stand)
        assert b.signs.tolist() == [[1, 1]]
        assert pair.suspect_screw(b.screws[:, 0]) == pytest.approx(pair.a.screws[:1])
