"""compare names millimetres against metres, tells what else differs, and leaves arms that truly
differ alone.
"""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.planted_changes import arm, planted, random_arm
from poekin.analysis.compare.alignment.lines import lines
from poekin.analysis.compare.compare import compare
from poekin.analysis.compare.length_unit import length_ratio, rescaled, to_one_unit
from poekin.formats.load import load
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain
from poekin.model.sampling import sampling_range

COBRA = load("cobra600").chain()
RAIL = Chain.from_space(
    [screw.prismatic([0, 1, 0]), *random_arm(4, ("revolute",) * 4).screws], np.eye(4)
)


def in_other_conventions(chain, seed):
    rng = np.random.default_rng(seed)
    low, high = sampling_range(chain)
    moved = chain.rezeroed(rng.uniform(-0.2, 0.2, chain.dof) * (high - low)).rebased(
        se3.exp(rng.normal(size=6))
    )
    return moved.retooled(se3.exp(rng.normal(size=6)))


@pytest.mark.parametrize(
    "chain, factor", [(arm("ur5e"), 1000.0), (RAIL, 1000.0), (COBRA, 1000.0), (COBRA, 0.001)],
    ids=["ur5e in mm", "on a rail in mm", "cobra600 in mm", "cobra600 in km"],
)  # fmt: skip
def test_lengths_a_thousand_times_too_long_or_too_short_are_named_whichever_model_has_them(
    chain, factor
):
    other = rescaled(in_other_conventions(chain, 1), factor)
    for one, two, ratio in ((chain, other, factor), (other, chain, 1 / factor)):
        result = compare(one, two, samples=5)
        assert (result.same_arm, result.length_ratio) == (False, pytest.approx(ratio))
        assert not any(j.axis_differs or j.reversed for j in result.joints)
        larger, smaller = ("b", "a") if ratio > 1 else ("a", "b")
        assert (
            f"lengths of model {larger} are 1000 times those of model {smaller} (millimetres"
            in result.verdict
        )
        assert result.verdict.startswith("the models differ; lengths")
        assert result.after is not None
        assert result.after.worst_position < 1e-4
        assert result.before is not None
        assert result.before.worst_position > 0.1


def test_pose_errors_as_the_models_stand_are_told_in_the_units_that_the_models_have():
    chain = arm("ur5e")
    result = compare(chain, rescaled(chain, 1000.0), samples=5)
    assert (result.mistake, result.joints[1].shift) == ("millimetres", pytest.approx(0.0, abs=1e-9))
    assert result.before is not None
    assert result.after is not None
    assert result.before.worst_position > 100 * chain.reach
    assert result.after.worst_position < 1e-9


@pytest.mark.parametrize(
    "change, swapped", [("tilt", True), ("shift", False), ("zero", True), ("flip", False)]
)
def test_an_error_in_a_joint_beside_the_wrong_unit_is_named_and_sized(change, swapped):
    chain = arm("ur5e")
    two = [chain, rescaled(planted(chain, change, 2, np.random.default_rng(0)), 1000.0)]
    result = compare(*(two[::-1] if swapped else two), samples=5)
    assert result.length_ratio == pytest.approx(0.001 if swapped else 1000)
    assert [j.number for j in result.differing] == [3]
    (joint,) = result.differing
    found = {
        "tilt": np.degrees(joint.angle),
        "shift": 1e3 * (joint.normal or 0.0),
        "zero": np.degrees(abs(joint.zero_offset)),
        "flip": float(joint.reversed),
    }[change]
    assert found == pytest.approx(
        {"tilt": 0.1, "shift": 1.0, "zero": 0.5, "flip": 1.0}[change], rel=0.01
    )
    assert "joint 3 (" in result.verdict


def test_the_unit_is_named_beside_another_link_an_extra_joint_and_in_a_strict_comparison():
    chain = arm("ur5e")
    longer = np.array(chain.screws)
    lengthened = se3.adjoint(se3.exp(np.array([0, 0, 0, 0.005, 0, 0])))
    longer[2:] = longer[2:] @ lengthened.T
    link = compare(chain, rescaled(Chain.from_space(longer, chain.home), 1000.0), samples=5)
    assert link.length_ratio == 1000
    assert "the link between joint 2 (" in link.verdict
    names = [*chain.joint_names[:3], "extra", *chain.joint_names[3:]]
    rows = np.insert(chain.screws, 3, screw.revolute([1, 2, 0], [0.1, 0.3, 0.2]), 0)
    extra = compare(
        chain, rescaled(Chain.from_space(rows, chain.home, joint_names=names), 1000.0), samples=5
    )
    assert (extra.length_ratio, extra.unmatched_joints, extra.before) == (
        1000,
        ("b", "extra"),
        None,
    )
    strict = compare(chain, rescaled(chain, 1000.0), samples=5, strict=True)
    assert (strict.same_arm, strict.length_ratio, strict.differing) == (False, 1000, ())
    assert strict.verdict.startswith("the models differ; lengths")


def test_the_unit_of_a_calibrated_arm_is_named_though_every_axis_differs():
    chain = arm("ur5e")
    rng = np.random.default_rng(3)
    worn = chain.screws.copy()
    for k in range(6):
        worn[k] = se3.adjoint(se3.exp(1e-3 * rng.normal(size=6))) @ worn[k]
    other = rescaled(chain.replace(screws=worn), 1000.0)
    result = compare(chain, other)
    assert (result.mistake, result.length_ratio, len(result.differing)) == ("millimetres", 1000, 6)
    assert result.after is not None
    # 1 mrad and 1 mm an axis and coordinate, on an arm of 1.3 m.
    assert 0.01 * chain.reach < result.after.worst_position < 0.02 * chain.reach
    # Joints as they stand are shown in one unit too.
    strict = compare(chain, other, strict=True)
    assert (strict.verdict, strict.length_ratio) == (result.verdict, 1000)
    assert max(joint.shift or 0.0 for joint in strict.joints) < 0.01


@pytest.mark.parametrize("seed", [2, 4, 7])
def test_the_unit_is_named_either_way_round_and_by_however_many_samples_beside_axes_some_mm_off(
    seed,
):
    chain = load("ur5").chain()
    rng = np.random.default_rng(seed)
    screws = chain.screws.copy()
    for k in (1, 3, 5):
        screws[k] = se3.adjoint(se3.exp(0.004 * rng.normal(size=6))) @ screws[k]
    zeros = np.radians([0, 0, 0, 90, 0, 0])
    other = rescaled(chain.replace(screws=screws).rezeroed(zeros), 1000.0)
    # The limits differ, and so do the configurations at which either order looks at poses.
    other = other.replace(limits=chain.limits)
    for pair in ((chain, other), (other, chain)):
        for samples in (3, 30):
            assert compare(*pair, samples=samples).mistake == "millimetres"


@pytest.mark.parametrize(("wrong", "ratio"), [((2, 4), 1000), ((1, 2, 4), 1)])
def test_the_unit_is_named_where_no_more_than_a_third_of_the_axes_are_elsewhere(wrong, ratio):
    chain = random_arm(3, ("revolute",) * 6)
    rng = np.random.default_rng(1)
    screws = chain.screws.copy()
    for k in wrong:
        screws[k] = se3.adjoint(se3.exp(0.5 * rng.normal(size=6))) @ screws[k]
    result = compare(chain, rescaled(chain.replace(screws=screws), 1000.0), samples=5)
    assert result.length_ratio == ratio
    if ratio == 1000:
        assert [joint.number - 1 for joint in result.differing] == list(wrong)


def elbow(length):
    """Three axes of which the first two intersect: in one unit or the other one of them differs."""
    places = ([0, 0, 1], [0, 0, 0]), ([0, 1, 0], [0, 0, 0]), ([0, 1, 0], [length, 0, 0])
    return Chain.from_space([screw.revolute(*place) for place in places], np.eye(4))


def test_arms_that_truly_differ_and_arms_of_another_size_are_no_matter_of_units():
    one, other = (random_arm(seed, ("revolute",) * 3) for seed in (1, 2))
    pairs = [
        (one, rescaled(other, 1000.0)), (rescaled(one, 0.001), other), (one, rescaled(one, 500.0)),
        (one, rescaled(one, 900.0)), (elbow(0.5), elbow(400.0)), (one, rescaled(one, 2.0)),
    ]  # fmt: skip
    for a, b in pairs:
        result = compare(a, b, samples=20)
        assert (result.same_arm, result.length_ratio) == (False, 1.0)
        assert "1000" not in result.verdict
    # Their sizes alone would not tell: another comparison, in one unit, decides.
    assert [length_ratio(a, b) for a, b in pairs] == [1000, 1000, 1000, 1000, 1000, 1]


def test_a_rescaled_chain_reaches_the_same_poses_with_lengths_multiplied():
    rng = np.random.default_rng(0)
    rows = [
        screw.prismatic([1, 0, 0]), screw.revolute([0, 0, 1], [0.3, 0, 0]), screw.helical([0, 1, 0], [0, 0, 0.2], 0.1),
    ]  # fmt: skip
    # Joint 2 follows a slide, joint 3 turns by itself.
    C, c = np.array([[1.0, 0.0], [0.5, 0.0], [0.0, 2.0]]), [0.1, 0.2, 0.3]
    chain = Chain.from_space(rows, se3.exp(rng.normal(size=6)), coupling=C, offset=c, q_names=["slide", "turn"],
                  limits=[[-0.5, 0.5], [-1, 1]], velocity_limits=[0.25, 3])  # fmt: skip
    large = rescaled(chain, 1000.0)
    q = chain.random(0, 5)
    expected = chain.fk(q)
    expected[:, :3, 3] *= 1000
    assert large.fk(q * [1000, 1]) == pytest.approx(expected, rel=1e-12, abs=1e-12)
    assert large.limits.tolist() == [[-500, 500], [-1, 1]]
    assert large.velocity_limits.tolist() == [250, 3]
    assert compare(chain, large, samples=1).length_ratio == 1000
    C[1, 0] = 0.6
    geared = Chain.from_space(rows, chain.home, coupling=C, offset=c, q_names=["slide", "turn"])
    assert [j.number for j in compare(geared, large, samples=1).differing] == [2]


@pytest.mark.parametrize("times", [(1.0, 1000.0), (1000.0, 1.0), (1.0, 0.001), (0.001, 1.0)])
def test_of_two_models_the_one_is_rescaled_whose_lengths_are_the_less_likely_in_metres(times):
    chain = random_arm(2, ("revolute",) * 4)
    size = np.linalg.norm(lines(chain).places)
    assert 0.1 < size < 2
    a, b = (rescaled(chain, factor) for factor in times)
    ratio = length_ratio(a, b)
    assert ratio == pytest.approx(times[1] / times[0])
    for one, given, factor in zip(to_one_unit(a, b, ratio), (a, b), times, strict=True):
        assert np.linalg.norm(lines(one).places) == pytest.approx(size)
        assert (one is given) == (factor == 1.0)


@pytest.mark.parametrize("size, kept", [(5.2e-3, 5.2), (5.5e-3, 5.5e-3)])
def test_the_sizes_that_are_told_apart_are_as_far_from_17_cm_by_their_logarithm(size, kept):
    chain = random_arm(2, ("revolute",) * 4)
    small = rescaled(chain, size / np.linalg.norm(lines(chain).places))
    pair = to_one_unit(small, rescaled(small, 1000.0), 1000.0)
    assert [np.linalg.norm(lines(one).places) for one in pair] == pytest.approx([kept, kept])


@pytest.mark.parametrize("factor, ratio", [
    (195, 1), (205, 1000), (4900, 1000), (5100, 1), (1 / 195, 1), (1 / 205, 0.001), (1 / 4900, 0.001), (1 / 5100, 1),
])  # fmt: skip
def test_a_wrong_unit_is_suspected_within_a_factor_of_5_of_1000(factor, ratio):
    chain = random_arm(2, ("revolute",) * 4)
    assert length_ratio(chain, rescaled(chain, factor)) == ratio


def test_the_joints_own_limits_have_the_unit_of_the_lengths_too():
    limits = np.array([[-1.0, 2.0], [-3.0, 0.5], *COBRA.limits[2:]])
    chain = RAIL.replace(limits=np.resize(limits, (5, 2)), velocity_limits=np.arange(1.0, 6.0))
    said = "J2 = J1 + J2"
    other = rescaled(chain.coupled(said), 1000.0)
    apart = rescaled(chain, 1000.0)
    np.testing.assert_allclose(other.joint_limits[1], apart.limits[1], rtol=1e-15)
    assert other.joint_velocity_limits[1] == apart.velocity_limits[1] == 2.0
    slide = rescaled(chain.coupled("J1 = J1 + J2"), 1000.0)
    np.testing.assert_allclose(slide.joint_limits[0], 1000.0 * chain.limits[0], rtol=1e-15)
    assert slide.joint_velocity_limits[0] == 1000.0
