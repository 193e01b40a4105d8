"""Families of arms that have a closed form, found from their axes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.model.chain import Chain
from poekin.solve.ik_all.structure import Family, meeting_point, misfits
from poekin.testing import strategies
from tests.solve.ik_all.perturbed import calibrated_ur10e, perturbed, reversed_chain


def family_of(chain, tol):
    """Family of the least misfit, None where no three axes fit."""
    found = misfits(chain, tol, tol)
    return found[0].family if found else None


def arm(first: int, kind: str, n: int = 6, seed: int = 0) -> Chain:
    """An arm of n joints at random, three of which meet or are parallel."""
    rng = np.random.default_rng(seed)
    w = rng.normal(size=(n, 3))
    w /= np.linalg.norm(w, axis=1, keepdims=True)
    p = rng.normal(size=(n, 3))
    if kind == "meeting":
        p[first : first + 3] = p[first]
    else:
        w[first : first + 3] = w[first]
    return Chain.from_space(
        [pk.screw.revolute(*line) for line in zip(w, p, strict=True)], np.eye(4)
    )


@pytest.mark.parametrize(
    ("kind", "first", "turned"),
    [
        ("meeting", 3, False),
        ("meeting", 2, False),
        ("meeting", 1, True),
        ("meeting", 0, True),
        ("parallel", 0, False),
        ("parallel", 1, False),
        ("parallel", 2, True),
        ("parallel", 3, True),
    ],
)
@given(seed=st.integers(0, 1000))
def test_three_axes_that_meet_or_are_parallel_are_found_wherever_they_stand(
    kind, first, turned, seed
):
    chain = arm(first, kind, seed=seed)
    assert family_of(chain, 1e-9) == Family(kind, first, turned)
    assert misfits(chain, 1e-9, 1e-9)[0].exact


@given(seed=st.integers(0, 1000), P=strategies.poses(lengths=(1e-3, 10.0)))
def test_a_family_does_not_depend_on_the_base_frame(seed, P):
    chain = arm(3, "meeting", seed=seed)
    assert family_of(chain.rebased(P), 1e-9) == family_of(chain, 1e-9)


@given(
    seed=st.integers(0, 1000),
    first=st.integers(0, 3),
    kind=st.sampled_from(["meeting", "parallel"]),
)
def test_a_reversed_arm_has_the_mirrored_family(seed, first, kind):
    family = family_of(arm(first, kind, seed=seed), 1e-9)
    assert family is not None
    mirrored = family_of(reversed_chain(arm(first, kind, seed=seed)), 1e-9)
    assert mirrored == Family(kind, 3 - first, not family.reversed)


@pytest.mark.parametrize(("tol", "found"), [(6e-3, None), (8e-3, Family("parallel", 1, False))])
def test_a_calibrated_arm_belongs_to_its_family_within_its_deltas_only(tol, found):
    # its largest delta_alpha is 6.94e-3 rad
    assert family_of(calibrated_ur10e(), tol) == found


def test_a_wrist_comes_before_parallel_axes_and_what_is_exact_before_both():
    # joints 4 to 6 meet, joints 1 to 3 are parallel
    rng = np.random.default_rng(3)
    meet = [pk.screw.revolute(w, [0.3, 0.1, 0.2]) for w in np.eye(3)]
    apart = [pk.screw.revolute([0, 0, 1], p) for p in rng.normal(size=(3, 3))]
    chain = Chain.from_space([*apart, *meet], np.eye(4))
    assert family_of(chain, 1e-4) == Family("meeting", 3, False)
    off = pk.screw.revolute([1, 0, 0], [0.3, 0.1, 0.2 + 1e-6])
    nearly = Chain.from_space([*apart, off, *meet[1:]], np.eye(4))
    assert family_of(nearly, 1e-4) == Family("parallel", 0, False)
    assert family_of(
        nearly.replace(screws=perturbed(nearly, 0, 1e-6, 1e-7).screws), 1e-4
    ) == Family("meeting", 3, False)


def test_neither_four_parallel_axes_nor_coaxial_neighbours_nor_sliding_joints_make_a_family():
    rng = np.random.default_rng(4)
    parallel = [pk.screw.revolute([0, 0, 1], p) for p in rng.normal(size=(4, 3))]
    others = [pk.screw.revolute([1, 0, 0], p) for p in rng.normal(size=(2, 3))]
    assert family_of(Chain.from_space([*parallel, *others], np.eye(4)), 1e-6) is None
    coaxial = [parallel[0], parallel[0], parallel[1]]
    assert family_of(Chain.from_space(coaxial, np.eye(4)), 1e-6) is None
    slide = pk.screw.prismatic([0, 0, 1])
    assert family_of(Chain.from_space([parallel[0], slide, parallel[1]], np.eye(4)), 1e-6) is None


def test_an_arm_of_seven_joints_and_one_of_two_have_no_family():
    assert family_of(arm(3, "meeting", n=7), 1e-6) is None
    assert family_of(arm(0, "meeting", n=3), 1e-6) == Family("meeting", 0, False)
    two = Chain.from_space(arm(0, "meeting", n=3).screws[:2], np.eye(4))
    assert family_of(two, 1e-6) is None


@pytest.mark.parametrize(("away", "height"), [(10.0, 10.0), (1000.0, 0.0)])
def test_axes_almost_parallel_meet_far_away_unless_they_are_parallel_to_a_thousandth(away, height):
    places = np.array([[0.1, 0.0, 0.0], [-0.1, 0.0, 0.0], [0.0, 0.1, 0.0]])
    there = np.array([0.0, 0.0, away])
    screws = np.array([pk.screw.revolute(there - p, p) for p in places])
    # by tilts of 1e-2 rounding is 1e-12 m; what is left free stays at the feet, 1e-5 m high
    np.testing.assert_allclose(meeting_point(screws)[2], height, rtol=0, atol=1e-3)
