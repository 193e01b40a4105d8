"""ChainData: the numbers of a chain without its kinematics."""

import pickle

import numpy as np
import pytest
from hypothesis import given

import poekin as pk
from poekin.engine.kernels import chain_kernels
from poekin.errors import InputError, ShapeError
from poekin.model.chain_data import ChainData
from poekin.model.geometry import idealise, other_frames
from poekin.model.geometry.structure import structure
from poekin.model.joint import Mimic
from poekin.model.kinematics import pose_jacobian
from poekin.testing.strategies import chain_strategies

TURN = pk.screw.revolute([0, 0, 1], [0.1, 0, 0])
SLIDE = pk.screw.prismatic([1, 0, 0])
MOVED = pk.se3.exp([0.1, 0.2, 0.3, 1, 2, 3])


def data_of(chain):
    """The data of a chain, without its face."""
    return ChainData(
        chain.screws,
        chain.home,
        frame="space",
        joint_names=chain.joint_names,
        q_names=chain.q_names,
        limits=chain.limits,
        coupling=chain.nontrivial_coupling,
        offset=chain.offset,
        base=chain.base,
        tip=chain.tip,
        pitches=chain.pitches,
        velocity_limits=chain.velocity_limits,
    )


@given(chain_strategies.chains())
def test_the_functions_take_data_and_give_what_the_methods_give(chain):
    data = data_of(chain)
    q = chain.random(1, 3)
    np.testing.assert_array_equal(pose_jacobian.fk(data, q), chain.fk(q))
    J = pose_jacobian.jacobian(data, q, "body")
    np.testing.assert_array_equal(J, chain.jacobian(q, "body"))
    assert structure(data) == structure(chain)
    assert data == chain
    assert hash(data) == hash(chain)
    assert repr(data) == repr(chain)


@pytest.mark.parametrize("kind", [ChainData, pk.Chain])
def test_a_copy_with_something_changed_is_of_the_class_of_its_original(kind):
    chain = kind(
        [TURN, SLIDE],
        MOVED,
        frame="space",
        coupling=[[1.0], [2.0]],
        q_names=["a"],
        base="world",
    )
    copies = [
        chain.replace(tip="hand"),
        other_frames.rebased(chain, MOVED, None),
        other_frames.retooled(chain, MOVED, None),
        other_frames.rezeroed(chain, [0.5]),
        idealise.idealised(chain, 0.01).chain,
        pickle.loads(pickle.dumps(chain)),
    ]
    assert [type(copy) for copy in copies] == [kind] * len(copies)
    assert {copy.base for copy in copies} == {"world"}
    assert copies[0].tip == "hand"
    np.testing.assert_array_equal(copies[0].coupling, [[1.0], [2.0]])
    assert copies[0] != chain
    assert copies[0].replace(tip=chain.tip) == chain


def test_a_copy_is_checked_as_a_new_chain_is():
    chain = pk.Chain.from_space([TURN], MOVED)
    with pytest.raises(ShapeError, match="offset"):
        chain.replace(offset=[1.0, 2.0])
    with pytest.raises(InputError, match="base"):
        chain.replace(base="")
    with pytest.raises(TypeError):
        chain.replace(colour="red")


REVOLUTE = pk.screw.revolute([0, 0, 1], [0.1, 0, 0])
HELICAL = pk.screw.helical([0, 0, 1], [0.1, 0, 0], 0.01)


@pytest.mark.parametrize("old", [REVOLUTE, HELICAL, SLIDE])
@pytest.mark.parametrize(
    "new, kind, pitch",
    [(REVOLUTE, "revolute", 0.0), (HELICAL, "helical", 0.01), (SLIDE, "prismatic", 0.0)],
)
def test_new_screws_have_pitches_of_their_own_unless_pitches_are_given(old, new, kind, pitch):
    chain = pk.Chain.from_space([old], MOVED)
    found = chain.replace(screws=[new])
    assert found == pk.Chain.from_space([new], MOVED)
    assert found.kinds == (kind,)
    assert found.pitches == pytest.approx([pitch])
    np.testing.assert_array_equal(chain.replace(tip="hand").pitches, chain.pitches)
    if kind != "prismatic":
        assert chain.replace(screws=[new], pitches=[0.02]).pitches.tolist() == [0.02]


NAMES = ["a", "b", "c"]
THREE = pk.Chain.from_space([TURN, SLIDE, TURN], MOVED, joint_names=NAMES, offset=[0, 0, 1])
GEARED = pk.Chain.from_space([TURN, SLIDE, TURN], MOVED, coupling=[[1, 0], [2, 0], [0, 1]])
NAMED = ("joint_names", "offset", "q_names", "limits", "velocity_limits")
DEFAULTS = dict.fromkeys(NAMED)


@pytest.mark.parametrize(
    "chain, given_too, missing",
    [
        (THREE, (), "joint_names, q_names, limits, offset, velocity_limits"),
        (THREE, ("limits", "joint_names"), "q_names, offset, velocity_limits"),
        (GEARED, (), "joint_names, q_names, limits, coupling, offset, velocity_limits"),
        (GEARED, ("q_names", "coupling", "velocity_limits"), "joint_names, limits, offset"),
    ],
)
def test_more_or_fewer_screws_say_what_has_to_be_given_with_them(chain, given_too, missing):
    with pytest.raises(ShapeError) as caught:
        chain.replace(screws=chain.screws[:2], **dict.fromkeys(given_too))
    expected = f"screws: 2 in place of 3: give {missing} too, or None for the default"
    assert str(caught.value) == expected


@pytest.mark.parametrize("screws", [[], [TURN], [TURN] * 4], ids=len)
def test_another_number_of_screws_is_taken_with_what_belongs_to_it(screws):
    names = [f"j{i}" for i in range(len(screws))]
    found = THREE.replace(screws=screws, **{**DEFAULTS, "joint_names": names})
    assert found == pk.Chain.from_space(screws, MOVED, joint_names=names)
    uncoupled = GEARED.replace(screws=screws, coupling=None, **DEFAULTS)
    assert uncoupled == pk.Chain.from_space(screws, MOVED)
    C = np.ones((4, 2))
    geared = GEARED.replace(screws=[TURN] * 4, coupling=C, **DEFAULTS)
    assert geared == pk.Chain.from_space([TURN] * 4, MOVED, coupling=C)


@pytest.mark.parametrize("screws", [None, 5, [[1], [1, 2]], np.zeros((6, 2)), np.zeros((2, 1, 6))])
def test_new_screws_that_are_no_rows_are_refused_as_those_of_a_new_chain(screws):
    with pytest.raises(InputError) as expected:
        pk.Chain.from_space(screws, MOVED)
    with pytest.raises(InputError) as caught:
        THREE.replace(screws=screws)
    assert str(caught.value) == str(expected.value)


def test_only_a_chain_whose_joints_are_its_coordinates_goes_straight_to_the_kernel():
    plain = pk.Chain.from_space([TURN, SLIDE], MOVED)
    assert plain.plain_shape == (2,)
    assert plain.nontrivial_coupling is None
    assert plain.kernel_table.shape == (3, chain_kernels.OFFSET)
    shifted = pk.Chain.from_space([TURN, SLIDE], MOVED, offset=[0.0, 1.0])
    coupled = pk.Chain.from_space([TURN, SLIDE], MOVED, coupling=[[1.0], [0.0]], q_names=["a"])
    assert shifted.plain_shape is coupled.plain_shape is None
    assert (plain.jacobian_shape, coupled.jacobian_shape) == ((6, 2), (6, 1))
    np.testing.assert_array_equal(coupled.nontrivial_coupling, [[1.0], [0.0]])


def test_a_coordinate_is_an_angle_where_the_first_joint_that_follows_it_turns():
    chain = pk.Chain.from_space([TURN, SLIDE], MOVED)
    assert [chain.is_angle(k) for k in range(2)] == [True, False]
    for rows, angle in (([TURN, SLIDE], True), ([SLIDE, TURN], False)):
        coupled = pk.Chain.from_space(
            rows, MOVED, coupling=[[1.0, 0.0], [2.0, 0.0]], q_names=["a", "idle"]
        )
        assert [coupled.is_angle(k) for k in range(2)] == [angle, True]
    crossed = pk.Chain.from_space(
        [TURN, SLIDE], MOVED, coupling=[[0, 2], [3, 0]], q_names=["s", "t"]
    )
    assert [crossed.is_angle(k) for k in range(2)] == [False, True]


def test_a_coordinate_has_the_unit_of_its_joint_in_either_direction():
    """A slide that follows a turning joint by m/rad comes first on the way back."""
    turn = pk.Joint("turn", "revolute", "a", "b", np.eye(4), [0, 0, 1])
    rack = pk.Joint("rack", "prismatic", "b", "c", np.eye(4), [0, 1, 0], mimic=Mimic("turn", 0.02))
    robot = pk.Robot("rack", ["a", "b", "c"], [turn, rack])
    for base, tip in (("a", "c"), ("c", "a")):
        chain = robot.chain(base=base, tip=tip)
        assert chain.q_names == ("turn",)
        assert chain.is_angle(0)


def test_masses_say_nothing_of_where_an_arm_is_and_are_left_out_with_new_screws():
    chain = pk.Chain.from_space([TURN, SLIDE], MOVED, masses=[[2.0, 0.1, 0, 0], [1.0, 0, 0, 0]])
    light = chain.replace(masses=None)
    assert chain == light
    assert hash(chain) == hash(light)
    assert chain.replace(tip="flange").masses is not None
    assert chain.replace(screws=[TURN, TURN]).masses is None


def test_a_chain_has_room_for_its_data_alone():
    with pytest.raises(AttributeError):
        object.__setattr__(pk.load("ur5e").chain(tip="tool0"), "note", "mine")
