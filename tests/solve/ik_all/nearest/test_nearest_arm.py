"""The nearest arm of a family: it belongs to it, is nearer than the rounded one, and cannot be
bettered by a small motion.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError
from poekin.solve.ik_all.nearest.constrained_arm import rounded_arm
from poekin.solve.ik_all.nearest.nearest_arm import configurations, nearest_arm
from poekin.solve.ik_all.nearest.pose_bound import pose_bound
from poekin.solve.ik_all.structure import Family, misfits
from poekin.testing import strategies
from tests.solve.ik_all.perturbed import (
    calibrated_ur10e,
    largest_differences,
    perturbed,
    root_mean_square,
)

PARALLEL = Family("parallel", 1, False)
WRIST = Family("meeting", 3, False)
CASES = [
    ("ur10e", calibrated_ur10e(), PARALLEL),
    *((f"ur5e {k}", perturbed(pk.load("ur5e").chain(), k), PARALLEL) for k in range(20)),
    *((name, perturbed(pk.load(name).chain(), 0), WRIST) for name in ("puma560", "kr5", "irb140")),
]
Q = np.random.default_rng(1).uniform(-np.pi, np.pi, (4000, 6))


def family_of(chain, tol):
    """Family of the least misfit, None where no three axes fit."""
    found = misfits(chain, tol, tol)
    return found[0].family if found else None


@pytest.mark.parametrize(("name", "chain", "family"), CASES, ids=[case[0] for case in CASES])
def test_it_is_nearer_than_the_rounded_arm_at_configurations_that_it_was_not_made_of(
    name, chain, family
):
    found = nearest_arm(chain, family)
    rounded = rounded_arm(chain, family).chain(chain)
    assert family_of(found.chain, 1e-14) == family
    assert root_mean_square(chain, found.chain, Q) < root_mean_square(chain, rounded, Q)
    assert found.position_bound < pose_bound(chain, rounded).position
    position, rotation = largest_differences(chain, found.chain, Q)
    assert position <= found.position_bound
    assert rotation <= found.rotation_bound
    # quadrature by few configurations, of a sum of products of sines: within a few percent
    assert found.rms == pytest.approx(root_mean_square(chain, found.chain, Q), rel=0.05)


@settings(max_examples=max(settings().max_examples // 5, 10))
@given(
    seed=st.integers(0, 100), first=st.integers(0, 3), kind=st.sampled_from(["meeting", "parallel"])
)
@example(seed=66, first=3, kind="parallel")  # the axes of a wrist: 2 rad from any arm of the family
def test_no_small_motion_that_keeps_the_family_makes_it_nearer(seed, first, kind):
    base = pk.load("puma560" if kind == "meeting" else "ur5e").chain()
    chain = perturbed(base, seed)
    found = nearest_arm(chain, Family(kind, first, False))
    q = configurations(chain)
    least = root_mean_square(chain, found.chain, q)
    arm = rounded_arm(found.chain, found.family)
    motions = arm.motions()
    rng = np.random.default_rng(seed)
    x = rng.normal(size=motions.turns.shape[2]) * 1e-4
    home = rng.normal(size=6) * 1e-4
    for sign in (1, -1):
        moved = arm.moved(motions, sign * x, sign * home).chain(chain)
        assert root_mean_square(chain, moved, q) >= least * (1 - 1e-9)


@pytest.mark.parametrize(("name", "family"), [("ur5e", PARALLEL), ("puma560", WRIST)])
def test_an_arm_of_the_family_is_its_own_nearest(name, family):
    chain = pk.load(name).chain()
    found = nearest_arm(chain, family)
    assert found.rms <= 1e-14
    assert found.position_bound <= 1e-12
    np.testing.assert_allclose(found.chain.screws, chain.screws, atol=1e-13)


@settings(max_examples=max(settings().max_examples // 5, 10))
@given(R=strategies.rotation_vectors())
def test_it_does_not_depend_on_how_the_base_frame_is_turned(R):
    chain = calibrated_ur10e()
    P = pk.se3.exp(np.concatenate([R, np.zeros(3)]))
    here = nearest_arm(chain, PARALLEL).chain.rebased(P)
    there = nearest_arm(chain.rebased(P), PARALLEL).chain
    # a step that changes the mean square by 1e-9 of itself is the last: 3e-5 of the difference
    np.testing.assert_allclose(there.screws, here.screws, atol=1e-6)


def test_it_is_the_same_each_time_and_keeps_names_limits_and_coupling():
    chain = perturbed(pk.load("ur5e").chain().coupled("elbow_joint = elbow_joint"), 0)
    found = nearest_arm(chain, PARALLEL)
    again = nearest_arm(chain, PARALLEL)
    assert found == again
    assert found.chain.replace(screws=chain.screws, home=chain.home) == chain


def test_sliding_and_fewer_joints_have_a_nearest_arm_too():
    stanford = perturbed(pk.load("stanford").chain(), 3)
    found = nearest_arm(stanford, WRIST)
    assert found.chain.kinds == stanford.kinds
    assert family_of(found.chain, 1e-14) == WRIST
    five = pk.Chain.from_space(stanford.screws[1:], stanford.home)
    assert family_of(nearest_arm(five, Family("meeting", 2, False)).chain, 1e-14) is not None


def test_its_words_name_bounds_and_joints():
    found = nearest_arm(calibrated_ur10e(), PARALLEL)
    first, *rows = str(found).split("\n")
    position = f"{1e3 * found.position_bound:.3g} mm"
    assert first == f"within {position} and {np.degrees(found.rotation_bound):.3g}°"
    assert rows[2].startswith("elbow_joint: turned by 0.")
    assert len(rows) == 6
    assert "chain" not in found.to_dict()


@pytest.mark.parametrize("first", [-1, 1, 4])
def test_three_joints_that_do_not_turn_or_are_not_there_are_refused(first):
    with pytest.raises(InputError, match="expected three revolute joints"):
        nearest_arm(pk.load("stanford").chain(), Family("meeting", first, False))
