"""Robotics Toolbox's DHRobot, Robot and ETS: as it moves them itself, and by stand-ins with the
same attributes.
"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, ModelError, PoseError, ShapeError
from poekin.formats.objects import from_object, make_table
from poekin.formats.objects.attributes import as_list
from poekin.testing.strategies import group_strategies
from tests.formats.test_dh import largest, tables
from tests.groups.test_objects import Spatial, library

POSES = group_strategies.poses(lengths=(1e-3, 2.0))
AXES = ("Rx", "Ry", "Rz", "tx", "ty", "tz")
# Both sides multiply matrices in float64, one rounding of the whole a joint or transform: up to 40
# of them.
ROUNDING = 1e-14


def link_of(row, modified) -> Any:
    """A row of a table as the attributes of a DHLink; what its `fkine` does not read is nonsense."""
    turns = row.kind == "revolute"
    return SimpleNamespace(
        theta=9.0 if turns else row.theta,
        d=row.d if turns else 9.0,
        a=row.a,
        alpha=row.alpha,
        offset=row.theta if turns else row.d,
        sigma=0 if turns else 1,
        mdh=modified,
        isflip=row.flip,
        qlim=None if np.isinf(row.limits).all() else np.array(row.limits),
    )


def make_robot(table) -> Any:
    links = [link_of(row, table.convention == "modified") for row in table.rows]
    return SimpleNamespace(
        links=links, base=Spatial(table.base), tool=Spatial(table.tool), name=table.name
    )


@given(tables())
def test_a_dh_robot_gives_the_table_that_it_was_made_of(table):
    assert make_table(make_robot(table)) == table
    assert from_object(make_robot(table)) == pk.dh.to_chain(table)


def test_limits_of_a_dh_robot_survive_and_a_missing_base_or_tool_is_the_identity():
    table = pk.dh.published("puma560")
    robot = make_robot(table)
    del robot.base, robot.tool, robot.name
    np.testing.assert_array_equal(from_object(robot).limits, table.limits)
    np.testing.assert_array_equal(make_table(robot).base, np.eye(4))


def test_a_link_that_does_not_say_isflip_is_not_flipped():
    table = pk.dh.published("puma560")
    robot = make_robot(table)
    for link in robot.links:
        del link.isflip
    assert make_table(robot) == table


def toolbox():
    return library("roboticstoolbox")


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@given(tables(6), st.integers(0, 2**32))
def test_a_dh_robot_of_the_toolbox_moves_as_it_says(table, seed):
    rtb = toolbox()
    SE3 = library("spatialmath").SE3
    links = [vars(link_of(row, table.convention == "modified")) for row in table.rows]
    flips = [link.pop("isflip") for link in links]
    for link in links:  # the toolbox takes nothing but 0 for what it does not read
        link["d" if link["sigma"] else "theta"] = 0.0
    robot = rtb.DHRobot(
        [rtb.DHLink(flip=flip, **link) for link, flip in zip(links, flips, strict=True)]
    )
    robot.base, robot.tool = SE3(table.base, check=False), SE3(table.tool, check=False)
    chain = from_object(robot)
    q = np.random.default_rng(seed).uniform(-np.pi, np.pi, len(table))
    assert np.abs(chain.fk(q) - robot.fkine(q).A).max() <= ROUNDING * (chain.reach + largest(table))


# The catalogue as of the toolbox's 1.5.0; what another version lacks is not missed here.
CATALOGUE = (
    *(
        "AL5D",
        "Ball",
        "Baxter",
        "Cobra600",
        "Coil",
        "Hyper",
        "Hyper3d",
        "IRB140",
        "Jaco",
        "KR5",
        "LWR4",
        "Mico",
    ),
    *(
        "Orion5",
        "P8",
        "Panda",
        "Planar2",
        "Planar3",
        "Puma560",
        "Sawyer",
        "Stanford",
        "TwoLink",
        "UR10",
        "UR3",
        "UR5",
    ),
)


def test_the_catalogue_of_the_toolbox_is_all_here():
    models = toolbox().models.DH
    assert {name for name in dir(models) if name[0].isupper()} <= set(CATALOGUE)


@pytest.mark.parametrize("name", CATALOGUE)
def test_a_dh_robot_of_the_catalogue_moves_as_it_says(name):
    models = toolbox().models.DH
    if not hasattr(models, name):
        pytest.skip(f"this version of the toolbox has no {name}")
    robot = getattr(models, name)()
    chain = from_object(robot)
    q = chain.random(0, 20)
    poses = np.array([robot.fkine(x).A for x in q])
    assert np.abs(chain.fk(q) - poses).max() <= ROUNDING * chain.reach
    assert make_table(robot).name == robot.name
    for link, limits in zip(robot.links, chain.limits.tolist(), strict=True):
        assert limits == ([-math.inf, math.inf] if link.qlim is None else list(link.qlim))


def elementary(axis: str, value: float) -> np.ndarray:
    T = np.eye(4)
    k = "xyz".index(axis[1])
    if axis[0] == "t":
        T[k, 3] = value
        return T
    i, j = (k + 1) % 3, (k + 2) % 3
    T[i, i] = T[j, j] = math.cos(value)
    T[j, i], T[i, j] = math.sin(value), -math.sin(value)
    return T


def et(axis: str, value: float | None = None, **more: Any) -> Any:
    """A stand-in for an elementary transform: a constant, or a joint where there is no value."""
    given = {"jindex": None, "isflip": False, "qlim": None, "offset": 0.0, **more}
    fixed = {"A": lambda q=0.0: elementary(axis, q if value is None else value)}
    return SimpleNamespace(axis=axis, eta=value, isjoint=value is None, **fixed, **given)


@st.composite
def sequences(draw):
    """Elementary transforms: joints of any `jindex`, more than one of the same too, flips, offsets,
    and constants.
    """
    values = st.one_of(st.none(), st.sampled_from([0.0, math.pi / 2]), st.floats(-2, 2))
    drawn = draw(st.lists(st.tuples(st.sampled_from(AXES), values), min_size=1, max_size=12))
    joints = [i for i, (_, value) in enumerate(drawn) if value is None]
    order = draw(st.permutations(range(len(joints))))
    if draw(st.booleans()):
        order = [min(k, len(order) // 2) for k in order]
    jindex = dict(zip(joints, order, strict=True))
    return [
        (axis, value, jindex.get(i), draw(st.booleans()), draw(st.sampled_from([0.0, 0.0, 0.7])))
        for i, (axis, value) in enumerate(drawn)
    ]


def stand_in(sequence):
    return [
        et(axis, value, jindex=k, isflip=flip, offset=offset if value is None else 0.0)
        for axis, value, k, flip, offset in sequence
    ]


def product(sequence, q):
    T = np.eye(4)
    for axis, value, k, flip, offset in sequence:
        moved = value if value is not None else (-q[k] if flip else q[k]) + offset
        T = T @ elementary(axis, moved)
    return T


@given(sequences(), st.integers(0, 2**32))
def test_a_sequence_of_elementary_transforms_moves_as_their_product(sequence, seed):
    chain = from_object(stand_in(sequence))
    q = np.random.default_rng(seed).uniform(-np.pi, np.pi, chain.dof)
    # A joint's own slide of up to pi metres is not in the reach.
    assert np.abs(chain.fk(q) - product(sequence, q)).max() <= ROUNDING * (
        chain.reach + 4 * len(sequence)
    )


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@given(sequences(), st.integers(0, 2**32))
def test_an_ets_of_the_toolbox_moves_as_it_says(sequence, seed):
    ET, ETS = toolbox().ET, toolbox().ETS
    made = []
    for axis, value, k, flip, offset in sequence:
        made.append(
            getattr(ET, axis)(**({"jindex": k, "flip": flip} if value is None else {"eta": value}))
        )
        if value is None and hasattr(made[-1], "offset"):  # since 1.5.0
            made[-1].offset = offset
    ets = ETS(made)
    chain = from_object(ets)
    q = np.random.default_rng(seed).uniform(-np.pi, np.pi, chain.dof)
    expected = np.asarray(ets.eval(q)) if chain.dof else np.asarray(ets.eval([0.0]))
    assert np.abs(chain.fk(q) - expected).max() <= ROUNDING * (chain.reach + 4 * len(sequence))


def test_coordinates_of_an_ets_are_in_the_order_of_jindex_and_shared_ones_have_what_is_left_of_their_limits():
    chain = from_object(
        [et("Rz", jindex=4, qlim=[-2, 1]), et("tx", jindex=1, qlim=[-3, 0.5]),
         et("Rz", jindex=4, qlim=[-1, 3]), et("ty", jindex=7)]
    )  # fmt: skip
    assert chain.q_names == ("q1", "q4", "q7")
    assert chain.limits.tolist() == [[-3, 0.5], [-1, 1], [-math.inf, math.inf]]
    assert chain.coupling.tolist() == [[0, 1, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    assert chain.kinds == ("revolute", "prismatic", "revolute", "prismatic")


def test_a_joint_far_along_its_axis_is_revolute():
    chain = from_object(
        [et("Rx", 0.7), et("Ry", 0.4), et("tz", 1e6), et("Rz", jindex=0), et("tz", jindex=1)]
    )
    assert chain.kinds == ("revolute", "prismatic")


def test_one_elementary_transform_is_a_chain_too():
    assert from_object(et("Ry")).screws.tolist() == [[0, 1, 0, 0, 0, 0]]
    assert from_object([et("tx", 0.3)]).dof == 0


def test_a_joint_that_says_its_axis_alone_moves_along_it_from_zero_without_limits():
    bare = [SimpleNamespace(isjoint=True, axis=axis) for axis in ("Rz", "tx", "Ry")]
    for step in bare:
        step.A = None
    chain = from_object(bare)
    assert chain.screws.tolist() == [[0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], [0, 1, 0, 0, 0, 0]]
    assert chain.home.tolist() == np.eye(4).tolist()
    assert chain.q_names == ("q0", "q1", "q2")
    assert not np.isfinite(chain.limits).any()


class Listed:
    """What is like a list and is none."""

    def __init__(self, items: list[Any]):
        self.items = items

    def __iter__(self) -> Any:
        return iter(self.items)

    def __len__(self) -> int:
        return len(self.items)


def test_transforms_come_in_whatever_is_like_a_list_and_not_as_a_text():
    steps = [et("Rz"), et("tx", 0.3), et("Ry")]
    array = np.empty(3, dtype=object)
    array[:] = steps
    for sequence in (steps, tuple(steps), array, Listed(steps)):
        assert from_object(sequence).dof == 2
    for text in ("Rz", b"Rz", {"Rz": 1}):
        assert as_list(text) == []


@pytest.mark.parametrize(
    ("ets", "error", "message"),
    [
        (
            [et("Rz", 0.1), et("R")],
            InputError,
            "ETS, transform 1: expected one of Rx, Ry, Rz, tx, ty, tz, got 'R'",
        ),
        (
            [et("Rz", offset="a")],
            InputError,
            "ETS, transform 0: offset: expected real numbers, got text (str)",
        ),
        (
            [SimpleNamespace(isjoint=False, axis="SE2", A=lambda: np.eye(3))],
            ShapeError,
            "ETS, transform 0: expected shape (..., 4, 4), got (3, 3):"
            " pk.se3.pose(R, p) makes a pose of a rotation and a translation",
        ),
        (
            [SimpleNamespace(isjoint=False, axis="SE3", A=lambda: np.ones((4, 4)))],
            PoseError,
            (
                "ETS, transform 0 is no pose: its last row is [1.0, 1.0, 1.0, 1.0], expected [0, 0, 0, 1]"
            ),
        ),
        (
            [et("Rz", jindex=0, qlim=[1, 2]), et("Rz", jindex=0, qlim=[3, 4])],
            InputError,
            "limits: expected lower <= upper for 'q0', got 3.0 and 2.0",
        ),
    ],
    ids=[
        "planar joint",
        "text for offset",
        "planar constant",
        "no pose",
        "nothing left of the limits",
    ],
)
def test_a_sequence_that_makes_no_sense_is_refused_with_the_place(ets, error, message):
    with pytest.raises(error) as caught:
        from_object(ets)
    assert str(caught.value) == message


def tree() -> Any:
    """A robot of the toolbox with a joint in the middle of a link, two of one jindex, and two ends."""
    a = SimpleNamespace(
        name="a", parent=None, ets=[et("tz", 0.3), et("Rz", jindex=2, isflip=True), et("tx", 0.2)]
    )
    b = SimpleNamespace(name="b", parent=a, ets=[et("Ry", 0.4), et("tz", jindex=0, qlim=[-1, 1])])
    c = SimpleNamespace(name="base", parent=a, ets=[et("Rx", jindex=2), et("ty", jindex=1)])
    d = SimpleNamespace(name="d", parent=b, ets=[et("tx", 0.1)])
    return SimpleNamespace(links=[a, b, c, d], name="tree", base=None, tool=None)


def test_a_tree_of_links_moves_as_the_products_of_their_transforms():
    robot = tree()
    robot.base, robot.tool = Spatial(elementary("Rx", 0.7)), Spatial(elementary("tx", 0.5))
    q = np.array([0.3, -0.6, 1.1])
    made = from_object(robot)
    T: dict[Any, Any] = {None: robot.base.A}
    for link in robot.links:
        T[link.name] = T[link.parent and link.parent.name]
        for one in link.ets:
            T[link.name] = T[link.name] @ one.A(
                *([(-1) ** one.isflip * q[one.jindex]] if one.isjoint else [])
            )
    assert (made.name, made.root, made.q_names) == ("tree", "base_", ("q0", "q1", "q2"))
    assert set(made.leaves) == {"d_tool", "base_tool"}
    assert made.limits[0].tolist() == [-1, 1]
    found = made.fk(q)
    for name in ("a", "b", "base", "d"):
        np.testing.assert_allclose(found[name], T[name], rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(found["d_tool"], T["d"] @ robot.tool.A, rtol=0, atol=ROUNDING)


def test_a_link_has_one_of_its_own_before_it_only_where_more_follows_a_joint():
    made = from_object(tree())
    # behind the joint of "a" comes a constant, behind the first of "base" another joint
    assert made.links == ("base_", "a", "b", "base", "d", "a_0", "base_0")
    assert {(joint.parent, joint.child) for joint in made.joints} == {
        ("base_", "a_0"), ("a_0", "a"), ("a", "b"), ("a", "base_0"), ("base_0", "base"), ("b", "d"),
    }  # fmt: skip
    steps = [et("Rz"), et("Ry"), et("tx"), et("tz")]
    one = SimpleNamespace(name="a", parent=None, ets=steps)
    made = from_object(SimpleNamespace(links=[one], name="one"))
    ways = [(joint.parent, joint.child) for joint in made.joints]
    assert ways == [("base", "a_0"), ("a_0", "a_1"), ("a_1", "a_2"), ("a_2", "a")]


def test_joints_are_called_after_their_coordinates_and_fixed_ones_after_their_links():
    robot = tree()
    robot.tool = Spatial(elementary("tx", 0.5))
    assert [joint.name for joint in from_object(robot).joints] == [
        *("q0", "q1", "q2", "q2_", "a_joint", "d_joint", "base_tool_joint", "d_tool_joint"),
    ]


def test_a_transform_of_a_link_that_makes_no_sense_is_refused_with_the_link():
    robot = tree()
    robot.links[1].ets[0] = et("R")
    with pytest.raises(InputError, match=r"^link 'b', transform 0: expected one of Rx, "):
        from_object(robot)


def test_a_tree_whose_links_miss_their_parent_is_refused():
    robot = tree()
    del robot.links[0]
    with pytest.raises(ModelError, match=r"does not exist|has no parent|root"):
        from_object(robot)


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.parametrize(
    "name", ["Frankie", "GenericSeven", "Panda", "Planar_Y", "Puma560", "XYPanda"]
)
def test_a_robot_of_the_toolbox_moves_as_it_says(name):
    robot = getattr(toolbox().models.ETS, name)()
    robot.base = library("spatialmath").SE3.Rx(0.3)
    made = from_object(robot)
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, robot.n)
    found = made.fk(q)
    for link in robot.links:
        assert np.abs(found[link.name] - robot.fkine(q, end=link).A).max() <= 4 * ROUNDING


def test_links_of_both_conventions_are_refused():
    robot = make_robot(pk.dh.published("puma560"))
    robot.links[2].mdh = True
    with pytest.raises(
        InputError,
        match=r"^types\.SimpleNamespace: its links mix the standard and the modified convention$",
    ):
        from_object(robot)


def test_what_is_no_dh_robot_has_no_table():
    with pytest.raises(
        InputError,
        match=(
            r"^expected a DHRobot with links that have alpha, a, d, theta, offset, sigma, mdh, got int$"
        ),
    ):
        make_table(3)


def test_a_symbol_in_the_place_of_a_number_is_refused():
    robot = make_robot(pk.dh.published("puma560"))
    robot.links[1].alpha = object()
    with pytest.raises(InputError, match=r"^alpha: expected real numbers, got object \(list\)$"):
        from_object(robot)
