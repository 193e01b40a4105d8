"""Which family an arm's inverse kinematics belongs to, and why."""

from __future__ import annotations

import warnings
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError
from poekin.formats import erd
from poekin.formats.load import BUILT_IN
from poekin.model.chain import Chain
from poekin.solve.ik_structure.ik_structure import NEAR_DISTANCE, QUARTIC
from tests.solve.ik_all.perturbed import (
    ANGLE,
    calibrated_ur10e,
    largest_differences,
    perturbed,
    reversed_chain,
)
from tests.solve.ik_all.test_structure import arm

UR = ("three parallel axes", "closed form", (2, 3, 4))
WRIST = ("spherical wrist", "closed form", (4, 5, 6))
REDUNDANT = ("redundant", "lock", ())
BUILT_IN_ARMS = {
    "cobra600": ("fewer than six joints", "closed form", (4,)),
    "iiwa14": REDUNDANT,
    "irb140": WRIST,
    "jaco": ("two axes intersect", "elimination", (5, 6)),
    "kr5": WRIST,
    "panda": REDUNDANT,
    "puma560": WRIST,
    "stanford": WRIST,
    **dict.fromkeys(("ur3", "ur3e", "ur5", "ur5e", "ur10", "ur10e", "ur16e"), UR),
}
LEG = ("spherical shoulder", "closed form", (1, 2, 3))
IMU_SIDE = ("two axes intersect", "elimination", (1, 2))
SIX = {
    ("alex_nub_hands", "LeftShoulderYawIMULink"): IMU_SIDE,
    ("alex_nub_hands", "RightShoulderYawIMULink"): IMU_SIDE,
    ("anymal-kinova", "j2s6s200_end_effector"): WRIST,
    ("g1_29dof_rev_1_0", "left_ankle_roll_link"): (
        "two parallel axes",
        "elimination",
        (4, 5),
    ),
    ("icub", "codyco_balancing_world"): LEG,
    ("icub", "imu_frame"): ("spherical wrist", "elimination", (4, 5, 6)),
    ("icub", "l_upper_arm_dh_frame"): WRIST,
    ("pr2", "l_forearm_cam_optical_frame"): WRIST,
    ("talos_full_v2", "left_sole_link"): LEG,
    ("talos_left_arm", "gripper_left_fingertip_1_link"): WRIST,
    ("ur3_gripper", "ee_link"): UR,
    ("so101", "moving_jaw_so101_v1_link"): UR,
}


def said(chain: Chain) -> tuple[str, str, tuple[int, ...]]:
    found = pk.ik_structure(chain)
    return found.kind, found.method, found.joints


@pytest.mark.parametrize("name", BUILT_IN)
def test_every_built_in_arm_has_its_family(name):
    robot = pk.load(name)
    tip = {"panda": "panda_hand", "ur5e": "tool0"}.get(name)
    chain = robot.chain(tip=tip) if tip else robot.chain()
    assert said(chain) == BUILT_IN_ARMS[name]


def example_chains() -> Iterator[tuple[str, str, Chain]]:
    """Chains of up to six coordinates to every leaf of example-robot-data, each geometry once."""
    seen = set()
    for name in sorted(erd.example_robots()[0]):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                robot = pk.load(f"erd:{name}")
            except InputError:
                continue
        parents = {joint.parent for joint in robot.joints}
        for tip in (link for link in robot.links if link not in parents):
            try:
                chain = robot.chain(tip=tip)
            except InputError:  # floating and planar joints
                continue
            geometry = chain.screws.round(6).tobytes()
            if 1 <= chain.dof <= 6 and geometry not in seen:
                seen.add(geometry)
                yield name, tip, chain


def test_every_chain_of_example_robot_data_has_a_closed_form_or_elimination():
    found = {(name, tip): said(chain) for name, tip, chain in example_chains()}
    assert {key: found[key] for key in SIX} == SIX
    others = {key: of for key, of in found.items() if of[1] not in ("closed form", "elimination")}
    # joints 4 and 5 of the eye are on one line with the first ones: rank 4
    assert others == {("romeo", "gaze"): ("singular everywhere", "search", ())}


def test_a_calibrated_arm_is_told_the_nearest_with_parallel_axes_and_eliminated():
    chain = calibrated_ur10e()
    found = pk.ik_structure(chain)
    assert (found.kind, found.method, found.exact) == (UR[0], "elimination", False)
    (assumption,) = found.assumptions
    # 0.3975 degrees between axes 3 and 4, by `pk.axes`
    assert assumption.angle == pytest.approx(np.radians(0.3975), abs=1e-6)
    assert assumption.distance == 0
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (4000, 6))
    assert found.nearest is not None
    position, rotation = largest_differences(chain, found.nearest, q)
    assert position <= found.position_bound
    assert rotation <= found.rotation_bound
    assert pk.ik_structure(found.nearest).method == "closed form"
    assert str(found).split("\n") == [
        "three parallel axes: axes 2, 3 and 4",
        "elimination: all real roots of a polynomial of degree 16",
        "axes 2, 3 and 4 are parallel within 0.398°",
        f"the nearest such arm is at most {1e3 * found.position_bound:.3g} mm and "
        f"{np.degrees(found.rotation_bound):.3g}° away",
        "closed form if axes 2, 3 and 4 were parallel: they are 0.398° apart",
    ]


def test_the_case_of_the_other_joints_is_that_of_the_nearest_arm():
    arm = pk.load("puma560").chain()  # axes 1 and 2 intersect, those of the nearest arm do not
    screws = arm.screws.copy()
    screws[4] = pk.se3.adjoint(pk.se3.exp([0, 0, 0, 1e-3, 2e-3, 1e-3])) @ screws[4]
    found = pk.ik_structure(arm.replace(screws=screws))
    assert found.nearest is not None
    assert found.first_joints == pk.ik_structure(found.nearest).first_joints == "general: a quartic"


@given(seed=st.integers(0, 100))
def test_a_wrist_with_errors_is_eliminated_and_its_other_joints_are_a_quartic(seed):
    found = pk.ik_structure(perturbed(pk.load("puma560").chain(), seed))
    assert (found.kind, found.method, found.joints) == (
        "spherical wrist",
        "elimination",
        (4, 5, 6),
    )
    assert found.first_joints == QUARTIC
    (assumption,) = found.assumptions
    # a millimetre of each axis, and half a degree about origins that are 0.44 m away at most
    assert 0 < assumption.distance <= 1e-3 + 0.44 * ANGLE
    assert found.hint.startswith("closed form if axes 4, 5 and 6 met: they miss by")


@pytest.mark.parametrize(
    ("name", "case"),
    [
        ("puma560", "axes 1 and 2 intersect"),
        ("irb140", "axes 2 and 3 are parallel"),
        ("stanford", "prismatic"),
    ],
)
def test_the_joints_before_a_wrist_have_their_case_from_either_end(name, case):
    chain = pk.load(name).chain()
    assert pk.ik_structure(chain).first_joints == case
    found = pk.ik_structure(reversed_chain(chain))
    assert (found.kind, found.joints, found.reversed) == ("spherical shoulder", (1, 2, 3), True)
    mirrored = {"axes 1 and 2": "axes 5 and 6", "axes 2 and 3": "axes 4 and 5"}
    for here, there in mirrored.items():
        case = case.replace(here, there)
    assert found.first_joints == case


def test_sliding_joints_are_named():
    found = pk.ik_structure(pk.load("stanford").chain())
    assert found.prismatic == ("joint3",)
    assert "prismatic: 'joint3'" in str(found)


@given(seed=st.integers(0, 1000), n=st.integers(1, 4))
def test_any_arm_of_up_to_four_joints_that_turn_is_closed_by_fictitious_ones(seed, n):
    chain = Chain.from_space(arm(0, "meeting", 7, seed).screws[3 : 3 + n], np.eye(4))
    found = pk.ik_structure(chain)
    assert (found.kind, found.method) == ("fewer than six joints", "closed form")
    assert found.fictitious == 6 - n
    assert f"{6 - n} of them fictitious and held at zero" in str(found)


@given(seed=st.integers(0, 1000))
def test_five_joints_are_closed_where_two_axes_at_an_end_intersect(seed):
    six = arm(0, "meeting", 6, seed).screws
    ends = Chain.from_space(six[1:], np.eye(4))
    found = pk.ik_structure(ends)
    assert (found.kind, found.joints, found.reversed) == ("fewer than six joints", (1, 2), True)
    found = pk.ik_structure(reversed_chain(ends))
    assert (found.kind, found.joints, found.reversed) == ("fewer than six joints", (4, 5), False)


@given(seed=st.integers(0, 1000))
def test_an_arm_with_nothing_particular_is_general_and_told_what_would_help(seed):
    chain = Chain.from_space(arm(0, "meeting", 7, seed).screws[[0, 3, 1, 4, 5, 6]], np.eye(4))
    found = pk.ik_structure(chain)
    if found.assumptions:  # three axes nearly meet by chance
        assert found.assumptions[0].distance <= NEAR_DISTANCE * chain.reach
        return
    assert (found.kind, found.method) == ("general", "elimination")
    assert found.hint.startswith("closed form if axes")


def test_seven_joints_are_told_what_each_locked_one_gives():
    panda = pk.ik_structure(pk.load("panda").chain(tip="panda_hand"))
    assert panda.hint == "closed form with 'panda_joint7' locked"
    last = panda.locked[6]
    assert (last.kind, last.joints, last.reversed) == ("spherical shoulder", (1, 2, 3), True)
    assert str(last) == (
        "'panda_joint7' locked: spherical shoulder (axes 1, 2 and 3), solved reversed"
    )
    iiwa = pk.ik_structure(pk.load("iiwa14").chain())
    assert iiwa.hint == (
        "S-R-S, shoulder and wrist are spherical: closed form with 'joint7' locked, or with the "
        "arm angle given"
    )
    # whichever joint is locked, the shoulder or the wrist stays; but with a stiff elbow the two
    # centres keep their distance
    kinds = [one.kind for one in iiwa.locked]
    assert kinds[3] == "singular everywhere"
    assert {*kinds[:3], *kinds[4:]} == {"spherical wrist", "spherical shoulder"}
    assert iiwa.locked[0].joints == (5, 6, 7)


def test_eight_coordinates_fewer_coordinates_than_joints_and_a_lower_rank_are_said():
    eight = Chain.from_space(arm(0, "meeting", 8).screws, np.eye(4))
    assert pk.ik_structure(eight).hint == "lock 2 joints of 8"
    six = arm(3, "meeting")
    planar = [pk.screw.revolute([0, 0, 1], [k, k * k, 0]) for k in range(4)]
    lower = pk.ik_structure(Chain.from_space(planar, np.eye(4)))
    assert lower.kind == "singular everywhere"
    assert lower.hint == (
        "the Jacobian has lower rank than the arm has coordinates at every q: a pose that is "
        "reached is reached in infinitely many ways"
    )
    geared = six.replace(coupling=np.diag([2.0, 1, 1, 1e-20, 1, -3]), q_names=None)
    assert pk.ik_structure(geared).kind == "spherical wrist"
    both = np.eye(6)
    both[:2, :2] = [[1.0, -0.5], [-0.5, 1.0]]
    differential = six.replace(coupling=both, q_names=list("abcdef"), limits=None)
    assert pk.ik_structure(differential).kind == "spherical wrist"
    follows = np.eye(6)[:, :5]
    follows[5, 4] = 1.0
    mimic = six.replace(coupling=follows, q_names=None, limits=None, velocity_limits=None)
    coupled = pk.ik_structure(mimic)
    assert coupled.kind == "coupled joints"
    assert coupled.hint == (
        "joints follow others: there are fewer coordinates than joints, and no closed form is known"
    )


def test_a_compiled_chain_is_taken_and_json_leaves_the_chain_out():
    chain = pk.load("ur5e").chain()
    assert pk.ik_structure(chain.compile()) == pk.ik_structure(chain)
    found = pk.ik_structure(calibrated_ur10e())
    assert "nearest" not in found.to_dict()
    assert found.to_dict()["assumptions"] == [found.assumptions[0].to_dict()]
    assert found.assumptions[0].to_dict()["joints"] == [2, 3, 4]


def test_what_is_no_chain_or_has_no_joints_is_refused():
    with pytest.raises(InputError, match="expected a Chain"):
        pk.ik_structure(pk.load("ur5e"))  # type: ignore[arg-type]
    with pytest.raises(
        InputError, match=r"^ik_structure: expected an arm with joints, the chain has none$"
    ):
        pk.ik_structure(Chain.from_space([], np.eye(4)))
