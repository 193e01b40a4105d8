"""Arms with fewer than six coordinates are judged by what they can do at all: the textbook's
singularities of 2R, planar 3R, SCARA, polar (RRP), elbow and five-joint arms.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.analysis.dexterity import jacobian_part
from poekin.analysis.dexterity.jacobian_part import generic_rank
from poekin.analysis.dexterity.singularity import singularity
from poekin.groups import se3, so3

X, Y, Z = np.eye(3)


def chain(*joints, tool):
    """Joints (axis, point), or (axis, None) where they slide, and the tool's origin at q = 0."""
    rows = [
        pk.screw.prismatic(axis) if point is None else pk.screw.revolute(axis, point)
        for axis, point in joints
    ]
    return pk.Chain.from_space(rows, se3.exp([0, 0, 0, *tool]))


def planar(*lengths):
    at = np.concatenate([[0.0], np.cumsum(lengths)])
    return chain(*((Z, [x, 0, 0]) for x in at[:-1]), tool=[at[-1], 0, 0])


SCARA = chain(
    (Z, [0, 0, 0]), (Z, [0.4, 0, 0]), (Z, [0.7, 0, 0]), (Z, None), tool=[0.7, 0, 0.2]
)  # fmt: skip
POLAR = chain((Z, [0, 0, 0]), (Y, [0, 0, 0]), (X, None), tool=[0.5, 0, 0])
ELBOW = chain((Z, [0, 0, 0]), (Y, [0, 0, 0.3]), (Y, [0.4, 0, 0.3]), tool=[0.7, 0, 0.3])
FIVE = chain(
    (Z, [0, 0, 0]), (Y, [0, 0, 0.3]), (Y, [0.4, 0, 0.3]), (Y, [0.8, 0, 0.3]), (X, [0, 0, 0.3]),
    tool=[1.0, 0, 0.3],
)  # fmt: skip
WRIST = chain((Z, [0, 0, 0]), (Y, [0, 0, 0]), (X, [0, 0, 0]), tool=[0.1, 0, 0])
GANTRY = chain((X, None), (Y, None), (Z, None), tool=[0, 0, 0])

# Arm, the part that is judged, its largest rank, a singular and a regular configuration, and the
# direction that the tool's origin loses at the first.
ARMS = {
    "2R": (planar(0.5, 0.4), "translation", 2, [0.3, 0.0], [0.3, 1.0], so3.exp(0.3 * Z) @ X),
    "2R folded": (planar(0.5, 0.4), "translation", 2, [0.3, np.pi], [0.3, -1.0], so3.exp(0.3 * Z) @ X),
    "planar 3R": (planar(0.5, 0.4, 0.2), "pose", 3, [0.3, 0.0, 0.0], [0.3, 1.0, 0.0], so3.exp(0.3 * Z) @ X),
    "planar 4R": (planar(0.5, 0.4, 0.3, 0.2), "pose", 3, [0.3, 0, 0, 0], [0.3, 1, 0, 0], so3.exp(0.3 * Z) @ X),
    "SCARA": (SCARA, "pose", 4, [0.3, 0.0, 0.7, 0.1], [0.3, -1.0, 0.7, 0.1], so3.exp(0.3 * Z) @ X),
    "RRP": (POLAR, "translation", 3, [0.3, np.pi / 2, 0.1], [0.3, 1.0, 0.1], so3.exp(0.3 * Z) @ Y),
    "RRP drawn in": (POLAR, "translation", 3, [0.3, 0.4, -0.5], [0.3, 0.4, -0.2], None),
    "elbow": (ELBOW, "translation", 3, [0.3, -0.2, 0.0], [0.3, -0.2, 0.9], so3.exp(0.3 * Z) @ so3.exp(-0.2 * Y) @ X),
    "5R": (FIVE, "pose", 5, [0.3, 0.0, 0.0, 0.0, 0.5], [0.3, 0.0, 0.8, 0.5, 0.5], None),
    "wrist": (WRIST, "pose", 3, [0.3, np.pi / 2, 0.4], [0.3, 0.5, 0.4], None),
}  # fmt: skip


@pytest.mark.parametrize("name", ARMS)
def test_an_arm_is_singular_where_its_rank_drops_below_its_largest(name):
    arm, part, rank, singular, regular, _ = ARMS[name]
    found = singularity(arm, singular)
    assert (found.singular, found.part, found.generic_rank) == (True, part, rank)
    assert found.rank < rank
    assert found.singular_subspace.shape == (rank - found.rank, 6)
    assert found.distance == pytest.approx(0, abs=1e-15)
    away = singularity(arm, regular)
    assert (away.singular, away.rank, away.generic_rank) == (False, rank, rank)
    assert away.smallest > 1e-3


@pytest.mark.parametrize("name", [name for name in ARMS if ARMS[name][-1] is not None])
def test_what_is_lost_is_what_the_arm_has_elsewhere_and_not_what_it_never_has(name):
    arm, _, _, q, _, along = ARMS[name]
    found = singularity(arm, q)
    lost = found.singular_direction
    np.testing.assert_allclose(np.abs(lost[3:] @ along), np.linalg.norm(lost[3:]), rtol=1e-12)
    np.testing.assert_allclose(lost[:3], 0.0, rtol=0, atol=1e-12)
    assert np.abs(lost @ arm.jacobian(q, "hybrid")).max() < 1e-15
    assert f"the tool cannot move by moving along ({along[0]:.2f}" in found.summary()


def test_the_motion_of_a_singular_vector_that_the_arm_never_has_would_be_seen(monkeypatch):
    arm, _, _, q, _, along = ARMS["planar 3R"]
    module = "poekin.analysis.dexterity.singularity._with_lost_motions"
    monkeypatch.setattr(module, lambda U, *rest: U)
    wrong = singularity(arm, q).singular_direction
    assert np.linalg.norm(wrong[:3]) + abs(wrong[5]) + abs(abs(wrong[3:] @ along) - 1) > 0.1


@given(
    lengths=st.tuples(st.floats(0.05, 2.0), st.floats(0.05, 2.0)),
    q=st.tuples(st.floats(-3, 3), st.floats(-3, 3)),
)
def test_two_links_are_as_far_from_singular_as_the_elbow_is_from_straight(lengths, q):
    found = singularity(planar(*lengths), q)
    area = lengths[0] * lengths[1] * abs(np.sin(q[1]))
    assert np.prod(found.singular_values) == pytest.approx(area, rel=1e-9, abs=1e-14)
    ratio = found.singular_values[1] / found.singular_values[0]
    assert found.singular == (ratio <= 1e-3)
    assert found.generic_rank == 2


@pytest.mark.parametrize("off", [1e-2, 1e-4, -1e-6])
def test_the_distance_of_a_planar_arm_of_four_joints_is_that_to_the_stretched_arm(off):
    arm = planar(0.5, 0.4, 0.3, 0.2)
    bent = singularity(arm, [0.3, 0.0, off, 0.0])
    assert bent.distance < abs(off) * 1.01
    assert np.abs(bent.gradient_direction @ [1, 0, 0, 0]) < 1e-6, "a turned base changes nothing"


def test_a_part_is_what_is_asked_for_and_else_the_position_where_it_takes_all_coordinates():
    parts = {"2R": planar(1, 1), "3R": planar(1, 1, 1), "gantry": GANTRY, "wrist": WRIST}
    found = {name: singularity(arm, np.full(arm.dof, 0.4)).part for name, arm in parts.items()}
    assert found == {"2R": "translation", "3R": "pose", "gantry": "translation", "wrist": "pose"}
    assert not singularity(planar(1, 1), [0.3, 0.0], part="pose").singular
    assert singularity(planar(1, 1), [0.3, 0.0], part="rotation").generic_rank == 1
    gantry = singularity(GANTRY, np.zeros(3), part="rotation")
    assert (gantry.singular, gantry.generic_rank) == (False, 0)


@pytest.mark.parametrize("name", ARMS)
@settings(max_examples=max(settings().max_examples // 5, 10))
@given(seed=st.integers(0, 10**6))
def test_the_largest_rank_does_not_depend_on_base_zero_or_size(name, seed):
    arm = ARMS[name][0]
    rng = np.random.default_rng(seed)
    other = arm.rebased(se3.exp(rng.normal(size=6))).rezeroed(rng.normal(size=arm.dof))
    for part in jacobian_part.ROWS:
        assert generic_rank(other, part) == generic_rank(arm, part)


def test_the_largest_rank_is_counted_in_lengths_of_the_arm_and_rounding_is_no_motion():
    tiny = planar(1e-3, 1e-3, 1e-3)
    assert generic_rank(tiny, "pose") == 3
    turned = WRIST.retooled(se3.exp([0, 0, 0, -0.1, 0, 0])).rebased(
        se3.exp([0.3, 0.2, 0.1, 1, 2, 3])
    )
    assert generic_rank(turned, "translation") == 0
    tilted = [*planar(0.5, 0.4, 0.3).screws, pk.screw.revolute([0, 3.7e-6, 1], [1.2, 0, 0])]
    assert generic_rank(pk.Chain.from_space(tilted, planar(1.4).home), "pose") == 3, (
        "rpy of 1.5708 is no 4th"
    )


@pytest.mark.parametrize("axis", np.eye(3), ids=["x", "y", "z"])
def test_a_slide_counts_along_whatever_axis_it_moves(axis):
    bolt = [pk.screw.revolute(axis, [0, 0, 0]), pk.screw.prismatic(axis)]
    assert generic_rank(pk.Chain.from_space(bolt, np.eye(4)), "pose") == 2


def test_manipulability_of_a_planar_arm_is_that_of_its_plane():
    q = np.array([[0.3, 1.0, -0.4, 0.5], [0.3, 0.0, 0.0, 0.0]])
    arm = planar(0.5, 0.4, 0.3, 0.2)
    J = arm.jacobian(q[0], "hybrid")[[2, 3, 4]]
    found = pk.manipulability(arm, q)
    plane = np.sqrt(np.linalg.det(J @ J.T))
    np.testing.assert_allclose(found.pose.yoshikawa[0], plane, rtol=1e-12)
    # stretched it is 0, which the root of a rounded determinant cannot say (1e-16 becomes 1e-8):
    # the largest singular value is below 3, so the smallest is wrong by 3 * 3 eps, the product by
    # 9 times that
    assert found.pose.yoshikawa[1] < 81 * np.finfo(float).eps
    assert found.pose.yoshikawa[0] > 0.01
    assert found.translation.condition[0] < 10
    np.testing.assert_allclose(found.rotation.yoshikawa, 2.0, rtol=1e-14)
    step = 1e-6 * np.eye(4)
    above, below = (pk.manipulability(arm, q[0] + s * step).pose.yoshikawa for s in (1, -1))
    gradient = pk.manipulability_gradient(arm, q[0])
    np.testing.assert_allclose(gradient, (above - below) / 2e-6, rtol=0, atol=1e-8)
    nothing = pk.manipulability(GANTRY, np.zeros(3)).rotation
    assert (nothing.yoshikawa, nothing.smallest, nothing.condition) == (0, 0, np.inf)


def test_measures_are_summed_up_by_the_worst_of_a_batch():
    arm = planar(0.5, 0.4)
    found = pk.manipulability(arm, [[0.0, np.pi / 2], [0.0, np.pi / 6]])
    worst = min(found.translation.yoshikawa)
    assert str(found.translation).startswith(f"yoshikawa {worst:.4g}, condition ")
    assert str(found).splitlines()[1] == f"translation: {found.translation}"
    assert found.to_dict()["rotation"] == vars(found)["rotation"].to_dict()
    assert str(pk.manipulability(arm, np.zeros((0, 2))).pose) == "no configuration"
