"""A joint: data that is checked once."""

from __future__ import annotations

import math
import pickle
from dataclasses import FrozenInstanceError

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from poekin.errors import InputError, ModelError, PoekinError, PoseError, ShapeError
from poekin.model.checks import one_pose
from poekin.model.joint import KINDS, Joint, Mimic, SafetyController
from poekin.model.provenance import Source
from poekin.model.robot import Robot
from poekin.testing.strategies.group_strategies import frozen, poses
from tests.messages import says


def joint(**fields) -> Joint:
    return Joint(**{"name": "j", "kind": "revolute", "parent": "a", "child": "b", **fields})


@given(origin=poses())
def test_an_origin_is_kept_read_only_and_a_joint_equals_its_copies(origin):
    one = joint(origin=origin, limits=(-1, 2), mimic=Mimic("k", 2, 3))
    np.testing.assert_array_equal(one.origin, one_pose(origin))
    assert not one.origin.flags.writeable
    copy = pickle.loads(pickle.dumps(one))
    assert copy == one
    assert hash(copy) == hash(one)
    assert not copy.origin.flags.writeable
    assert one != joint(origin=origin, limits=(-1, 2), mimic=Mimic("k", 2, 4))
    assert one != "j"


def axis_off(vector):
    """How far a joint's axis is from the vector's direction, and its length from 1, ÷ rounding; u =
    2^-53.

    A quotient by the largest, the length and the quotient by it are four roundings of each entry,
    and the truth here has as many: 8 u. The length has those of the root, twice, and of the
    quotient: with its own here 4 u.
    """
    axis, exact = joint(axis=vector).axis, np.array(vector) / max(map(abs, vector))
    off = np.abs(np.array(axis) - exact / math.hypot(*exact)).max()
    return max(abs(math.hypot(*axis) - 1) / 4, off / 8) / 2.0**-53


@example([0.0, -1.0, -4.37114e-08])  # of length 1 + 8 u
@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=3, max_size=3))
def test_an_axis_of_any_length_becomes_a_unit_vector_in_its_direction(vector):
    if not any(vector):
        with pytest.raises(ModelError, match=r"'j'.*axis must not be zero"):
            joint(axis=vector)
        return
    axis = joint(axis=vector).axis
    assert axis_off(vector) <= 1
    assert joint(axis=axis).axis == axis


def test_an_origin_slightly_off_is_replaced_by_the_nearest_rotation():
    off = np.eye(4)
    off[0, 1] = 4e-6
    R = joint(origin=off).origin[:3, :3]
    assert np.abs(R @ R.T - np.eye(3)).max() <= 1e-15
    assert np.abs(R - off[:3, :3]).max() <= 2.1e-6


@pytest.mark.parametrize(
    "kind, screw",
    [
        ("revolute", (0, 0, 1, 0, 0, 0)),
        ("continuous", (0, 0, 1, 0, 0, 0)),
        ("prismatic", (0, 0, 0, 0, 0, 1)),
        ("helical", (0, 0, 1, 0, 0, 0.5)),
        ("fixed", (0,) * 6),
        ("floating", (0,) * 6),
        ("planar", (0,) * 6),
    ],
)
def test_a_joints_screw_is_its_kind_in_numbers(kind, screw):
    pitch = 0.5 if kind == "helical" else 0.0
    assert joint(kind=kind, axis=(0, 0, 2), pitch=pitch).screw == screw


def test_a_continuous_joint_has_no_limits():
    assert joint(kind="continuous", limits=(-1, 1)).limits == (-math.inf, math.inf)


DRIVE = {
    "velocity": 2.5,
    "effort": 87,
    "damping": 0.5,
    "friction": 0.25,
    "safety_controller": SafetyController(40, 100, -2.8, 2.8),
}


def test_of_a_joint_s_drive_nothing_is_known_unless_said():
    plain = joint()
    assert (plain.velocity, plain.effort) == (math.inf, math.inf)
    assert (plain.damping, plain.friction) == (0, 0)
    assert plain.safety_controller is None
    assert SafetyController() == SafetyController(0, 0, 0, 0)


@pytest.mark.parametrize("kind", KINDS)
def test_a_joint_keeps_what_is_said_of_its_drive_and_equals_its_copies(kind):
    one = joint(kind=kind, **DRIVE)
    assert {field: getattr(one, field) for field in DRIVE} == DRIVE
    assert all(isinstance(getattr(one, field), float) for field in list(DRIVE)[:4])
    copy = pickle.loads(pickle.dumps(one))
    assert copy == one
    assert hash(copy) == hash(one)


@pytest.mark.parametrize("field", DRIVE)
def test_joints_of_other_drives_are_unequal(field):
    other = {"safety_controller": SafetyController(40, 100, -2.8, 2.7)}
    assert joint(**DRIVE) != joint(**DRIVE | {field: other.get(field, 1.0)})


NO_BOUND = "expected a positive number, infinite where it is not known, got"
NO_LOSS = "expected no negative number, got"
BAD_DRIVES = [
    ("velocity", 0, f"{NO_BOUND} 0"),
    ("velocity", -1.5, f"{NO_BOUND} -1.5"),
    ("velocity", math.nan, f"{NO_BOUND} nan"),
    ("velocity", "fast", f"{NO_BOUND} 'fast'"),
    ("velocity", None, f"{NO_BOUND} None"),
    ("effort", 0.0, f"{NO_BOUND} 0.0"),
    ("effort", 10**400, f"{NO_BOUND} {'1' + '0' * 400}"),
    ("damping", -0.1, f"{NO_LOSS} -0.1"),
    ("damping", math.inf, "expected 1 finite number(s), got (inf,)"),
    ("friction", -1, f"{NO_LOSS} -1"),
    ("friction", None, "expected 1 finite number(s), got (None,)"),
]


@pytest.mark.parametrize("field, value, message", BAD_DRIVES)
def test_a_drive_of_impossible_numbers_is_refused_by_joint_and_field(field, value, message):
    with pytest.raises(ModelError) as caught:
        joint(**{field: value})
    assert str(caught.value).startswith(f"joint 'j': {field}: {message[:100]}")


def test_what_is_no_safety_controller_is_refused():
    with pytest.raises(
        ModelError, match=r"^joint 'j': safety_controller must be a Safety.* got 5$"
    ):
        joint(safety_controller=5)
    for field in ("k_velocity", "k_position", "soft_lower_limit", "soft_upper_limit"):
        with pytest.raises(ModelError, match=rf"^safety_controller: {field}: expected 1 finite"):
            SafetyController(**{field: math.inf})


def test_no_damping_has_no_sign():
    assert math.copysign(1, joint(damping=-0.0).damping) == 1


def test_a_joint_is_frozen():
    with pytest.raises(AttributeError):
        joint().name = "k"  # pyright: ignore[reportAttributeAccessIssue]


FAULTS = {
    "no name": (
        {"name": ""},
        ModelError,
        "a joint: a name must be a string that is not empty, got ''",
    ),
    "a name that is no string": (
        {"name": 7},
        ModelError,
        "a joint: a name must be a string that is not empty, got 7",
    ),
    "no parent": (
        {"parent": ""},
        ModelError,
        "joint 'j': parent: a name must be a string that is not empty, got ''",
    ),
    "no child": (
        {"child": None},
        ModelError,
        "joint 'j': child: a name must be a string that is not empty, got None",
    ),
    "unknown kind": (
        {"kind": "ball"},
        ModelError,
        "joint 'j': kind must be one of revolute, continuous, prismatic, helical, fixed, floating, planar, got 'ball'",
    ),
    "NaN in the axis": (
        {"axis": (0, math.nan, 1)},
        ModelError,
        "joint 'j': axis: expected 3 finite number(s), got (0, nan, 1)",
    ),
    "two numbers for an axis": (
        {"axis": (0, 1)},
        ModelError,
        "joint 'j': axis: expected 3 finite number(s), got (0, 1)",
    ),
    "text for an axis": (
        {"axis": "xyz"},
        ModelError,
        "joint 'j': axis: expected 3 finite number(s), got 'xyz'",
    ),
    "lower above upper": (
        {"limits": (1, 0)},
        ModelError,
        "joint 'j': limits must be lower <= upper, got lower = 1.0, upper = 0.0",
    ),
    "NaN in the limits": (
        {"limits": (math.nan, 0)},
        ModelError,
        "joint 'j': limits must be lower <= upper, got lower = nan, upper = 0.0",
    ),
    "one limit": (
        {"limits": (1,)},
        ModelError,
        "joint 'j': limits must be two numbers, lower and upper, got (1,)",
    ),
    "a lower limit at infinity": (
        {"limits": (math.inf, math.inf)},
        ModelError,
        "joint 'j': limits must be lower <= upper, got lower = inf, upper = inf",
    ),
    "pitch of a revolute joint": (
        {"pitch": 0.1},
        ModelError,
        "joint 'j': only a helical joint has a pitch, and this one is revolute",
    ),
    "infinite pitch": (
        {"kind": "helical", "pitch": math.inf},
        ModelError,
        "joint 'j': pitch: expected 1 finite number(s), got (inf,)",
    ),
    "endless pitch": (
        {"kind": "helical", "pitch": -1e101},
        ModelError,
        "joint 'j': pitch: expected at most 1e+100 m per rad, got -1e+101",
    ),
    "an integer beyond all floats": (
        {"axis": (0, 0, 10**400)},
        ModelError,
        "joint 'j': axis: expected 3 finite number(s), got (0, 0, 10000...",
    ),
    "a kind that is no word": (
        {"kind": []},
        ModelError,
        "joint 'j': kind must be one of revolute, continuous, prismatic, helical, fixed, floating, planar, got []",
    ),
    "an origin out of reach": (
        {"origin": [[1, 0, 0, 0], [0, 1, 0, -1e155], [0, 0, 1, 0], [0, 0, 0, 1]]},
        InputError,
        "joint 'j': origin: expected lengths of at most 1e+100 m, got -1e+155 in row 1",
    ),
    "mimic by name": (
        {"mimic": "k"},
        ModelError,
        "joint 'j': mimic must be a Mimic or None, got 'k'",
    ),
    "floating mimic": (
        {"kind": "floating", "mimic": Mimic("k")},
        ModelError,
        "joint 'j': a floating joint has no single value and cannot mimic another joint",
    ),
    "origin 3x3": (
        {"origin": np.eye(3)},
        ShapeError,
        (
            "joint 'j': origin: expected shape (..., 4, 4), got (3, 3):"
            " pk.se3.pose(R, p) makes a pose of a rotation and a translation"
        ),
    ),
    "many origins": (
        {"origin": np.zeros((2, 4, 4))},
        ShapeError,
        "joint 'j': origin: expected one pose (4, 4), got shape (2, 4, 4)",
    ),
    "text in the origin": (
        {"origin": [["x"] * 4] * 4},
        InputError,
        "joint 'j': origin: expected real numbers, got text (list)",
    ),
    "NaN in the origin": (
        {"origin": np.diag([1, 1, math.nan, 1])},
        PoseError,
        "joint 'j': origin: expected finite numbers, row 2 is [0.0, 0.0, nan, 0.0]",
    ),
    "skewed origin": (
        {"origin": np.diag([1, 1, 1.1, 1])},
        PoseError,
        "joint 'j': origin is no pose: its rotation misses orthonormality, max abs(R R^T - I) = 0.21, ...",
    ),
    "mirrored origin": (
        {"origin": np.diag([1, 1, -1, 1])},
        PoseError,
        "joint 'j': origin is no pose: its rotation is a reflection, det R = -1, expected 1",
    ),
    "last row of the origin": (
        {"origin": np.diag([1, 1, 1, 2])},
        PoseError,
        "joint 'j': origin is no pose: its last row is [0.0, 0.0, 0.0, 2.0], expected [0, 0, 0, 1]",
    ),
}


@pytest.mark.parametrize("fields, error, message", FAULTS.values(), ids=FAULTS)
def test_what_is_no_joint_is_refused_by_name(fields, error, message):
    with pytest.raises(error) as caught:
        joint(**fields)
    assert says(caught.value, message)
    assert isinstance(caught.value, PoekinError)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("numbers", [("k", math.nan), ("k", 1, math.inf), ("k", "x"), ("",), (3,)])
def test_what_is_no_mimic_is_refused(numbers):
    with pytest.raises(ModelError, match="mimic"):
        Mimic(*numbers)


def test_without_more_said_a_joint_stands_in_its_parent_and_turns_about_x_without_end():
    plain = Joint("j", "revolute", "a", "b")
    np.testing.assert_array_equal(plain.origin, np.eye(4))
    assert (plain.axis, plain.limits, plain.mimic, plain.pitch) == (
        (1, 0, 0),
        (-math.inf, math.inf),
        None,
        0,
    )
    assert (Mimic("k").multiplier, Mimic("k").offset) == (1, 0)
    assert joint(kind="continuous", limits=(-1, 1)).limits == (-math.inf, math.inf)


TURNS, SLIDES, STAYS = (0, 0.6, 0.8, 0, 0, 0), (0, 0, 0, 0, 0.6, 0.8), (0,) * 6
SCREWS = {"revolute": TURNS, "continuous": TURNS, "prismatic": SLIDES, "helical": TURNS, "fixed": STAYS,
          "floating": STAYS, "planar": STAYS}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_has_its_screw_and_a_helical_one_alone_a_pitch(kind):
    assert (joint(kind=kind).kind, joint(kind=kind, axis=(0, 3, 4)).screw) == (kind, SCREWS[kind])
    if kind == "helical":
        assert joint(kind=kind, axis=(0, 3, 4), pitch=0.5).screw == pytest.approx(
            (0, 0.6, 0.8, 0, 0.3, 0.4)
        )
    else:
        with pytest.raises(
            ModelError, match=f"only a helical joint has a pitch, and this one is {kind}"
        ):
            joint(kind=kind, pitch=-0.5)


@pytest.mark.parametrize(
    "record", [Mimic("k"), Source("arm.urdf"), joint(), Robot("r", ["a"], [])], ids=repr
)
def test_a_record_of_a_model_is_frozen_and_holds_its_fields_alone(record):
    with pytest.raises(FrozenInstanceError):
        setattr(record, record.__slots__[0], "other")
    assert not hasattr(record, "__dict__")


def test_hostile_names_are_shown_harmlessly():
    text = repr(joint(name="\x1b[31m\u202e<b>[/b]\n"))
    assert text.startswith(r"Joint('\x1b[31m\u202e<b>[/b]\n', revolute")


def test_an_array_that_the_user_changes_later_changes_nothing():
    mine = np.eye(4)
    one = joint(origin=mine)
    mine[0, 3] = 1
    assert one == joint(origin=frozen(np.eye(4)))


def test_joints_and_robots_that_differ_are_unequal_either_way_round():
    pairs = [(joint(), joint(name="k")), (joint(pitch=0.0), joint(limits=(-1, 1)))]
    pairs += [
        (Robot("r", ["a"], []), Robot("s", ["a"], [])),
        (Robot("r", ["a"], []), Robot("r", ["b"], [])),
    ]
    for one, other in pairs:
        assert one != other
        assert other != one
        assert one == one
