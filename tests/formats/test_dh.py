"""DH tables into screws and back, against the product of their matrices in 50 digits."""

import copy
import dataclasses
import json
import math
import pickle
import re

import numpy as np
import pytest
from hypothesis import example, given, settings, target
from hypothesis import strategies as st

import poekin as pk
from poekin.analysis.validate import routes
from poekin.errors import InputError, PoekinWarning, ShapeError
from poekin.formats import dh
from poekin.formats.dh import Row, Table
from poekin.formats.erd import example_robots
from poekin.model import screw
from poekin.model.chain import Chain
from poekin.model.joint import MOVING
from poekin.testing.strategies import dh_strategies
from poekin.testing.strategies.dh_strategies import tables
from tests.formats import dh_product

UNIT = 2.0**-53
CONVENTIONS = st.sampled_from(dh_strategies.CONVENTIONS)
FEW = settings(max_examples=max(settings().max_examples // 2, 20))


def error(table, got, expected, reach):
    difference = got - expected
    difference[..., :3, 3] /= reach
    return np.abs(difference).max(axis=(-2, -1))


def largest(table):
    return max(np.abs(table.d).max(initial=0), np.abs(table.a).max(initial=0))


def rounding(chain, x):
    """What the poses of a table's matrices and of its screws may differ by at joint values x (...,
    n), lengths ÷ reach.

    Each pose is off by u (8 (n + 1) + 4 X), X = sum |x|; screw i comes out of a product of i
    matrices, off by 8 u each, and moves the tip by that times its x. Lengths grow with what slides.
    """
    n, X = len(chain.screws), np.abs(x).sum(axis=-1)
    slid = np.abs(chain.local.slides * x).sum(axis=-1) / chain.reach
    return UNIT * (16 * (n + 1) + 8 * (n + 1) * X) * (1 + slid)


def screws_off(table, seed, shape=(), arithmetic=dh_product.EXACT):
    """How far a table's chain is from the product of its matrices at random configurations ÷
    `rounding`.

    A length of the table that is longer than the reach counts in place of it: there and back, the
    reach is short.
    """
    chain = dh.to_chain(table)
    x = np.random.default_rng(seed).uniform(-np.pi, np.pi, (*shape, len(table)))
    far = max(chain.reach, largest(table))
    wanted = dh_product.pose(table, x, arithmetic)
    return error(table, chain.fk(x), wanted, far) / (rounding(chain, x) * far / chain.reach)


@FEW
@given(tables(), st.integers(0, 2**32))
@example(
    Table("standard", [Row(alpha=0.7, d=3e4, theta=0.3), Row(d=-3e4, a=0.3, alpha=-0.7), Row()]), 0
)
@example(
    Table(
        "modified", [Row(theta=0.3), Row(a=0.2, alpha=1e-4, d=3e4), Row(alpha=-1e-4, d=-3e4), Row()]
    ),
    1,
)
def test_a_table_s_screws_move_as_its_matrices_do(table, seed):
    got = screws_off(table, seed)
    target(float(got))
    assert got <= 1


@FEW
@given(tables(), CONVENTIONS)
@example(Table("standard", [Row(alpha=1e-9, a=0.4), Row(a=0.3), Row(d=1.0)]), "modified")
@example(
    Table(
        "standard", [Row(alpha=1e-4, a=0.4), Row(kind="prismatic"), Row(alpha=1.0, a=0.2), Row()]
    ),
    "standard",
)
def test_from_screws_to_a_table_and_back_keeps_the_pose(table, convention):
    chain = dh.to_chain(table)
    result = dh.from_chain(chain, convention=convention)
    assert result.table.convention == convention
    assert result.table.kinds == chain.kinds
    assert result.error <= result.bound
    n, dropped = len(table), [w for w in result.warnings if "taken as parallel" in w]
    if not dropped:
        assert result.bound <= 100 * UNIT * n * (1 + largest(result.table) / chain.reach)
    if largest(result.table) > 10 * chain.reach:
        assert any("product of exponentials" in w for w in result.warnings)


@FEW
@given(tables(max_joints=6), CONVENTIONS)
@example(
    Table("standard", [Row(kind="prismatic", alpha=1e-5), Row()]), "standard"
)  # far: its rounding is no pitch
def test_a_table_of_a_table_s_chain_is_that_table_again(table, convention):
    first = dh.from_chain(dh.to_chain(table), convention=convention).table
    again = dh.from_chain(dh.to_chain(first), convention=convention)
    assert again.error <= again.bound
    x = np.linspace(-1, 1, len(table))
    a, b = dh.to_chain(first), dh.to_chain(again.table)
    assert error(first, a.fk(x), b.fk(x), a.reach) <= again.bound + 2 * rounding(a, x)


def test_a_tilt_in_the_plane_of_two_axes_throws_d_far_and_moves_the_screw_by_no_more_than_itself():
    a, delta = 0.4318, 1e-4
    home = np.eye(4)
    straight = [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.revolute([0, 0, 1], [a, 0, 0])]
    tilted = [straight[0], pk.screw.revolute([np.sin(delta), 0, np.cos(delta)], [a, 0, 0])]
    assert np.abs(tilted[1] - straight[1]).max() <= delta
    result = dh.from_chain(pk.Chain.from_space(tilted, home), convention="standard")
    assert abs(result.table.d[0]) == pytest.approx(a / np.tan(delta), rel=1e-9)
    (warning,) = result.warnings
    assert "nearly parallel, 0.0001 rad: d is 4.32e+03 m" in warning


def test_the_panda_comes_out_as_franka_publishes_it():
    table = dh.from_chain(pk.load("panda").chain(tip="panda_link8"), convention="modified").table
    np.testing.assert_allclose(table.a, [0, 0, 0, 0.0825, 0.0825, 0, 0.088], rtol=0, atol=1e-15)
    np.testing.assert_allclose(np.abs(table.alpha), [0, *[np.pi / 2] * 6], rtol=0, atol=1e-15)
    np.testing.assert_allclose(
        np.abs(table.d), [0.333, 0, 0.316, 0, 0.384, 0, 0.107], rtol=0, atol=1e-15
    )


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.filterwarnings("ignore::poekin.errors.PoekinWarning")
def test_every_chain_of_the_real_robots_has_a_table(convention):
    robots, chains = example_robots()[0], 0
    for name in sorted(robots):
        robot, seen = pk.load(f"erd:{name}"), set()
        # A chain that would cross a floating or planar joint comes in two, above and below it.
        for base, tip, _ in routes(robot):
            chain = robot.chain(base=base, tip=tip)
            result = dh.from_chain(chain, convention=convention, samples=20)
            dropped = [w for w in result.warnings if "taken as parallel" in w]
            assert result.error <= result.bound, (name, tip)
            if not dropped:
                n = len(result.table) + 1
                assert result.bound <= 100 * UNIT * n * (1 + largest(result.table) / chain.reach), (
                    name,
                    tip,
                )
            chains, seen = chains + 1, seen | set(chain.joint_names)
        assert seen == {joint.name for joint in robot.joints if joint.kind in MOVING}, name
    assert (len(robots), chains) == (68, 721)


def test_a_helical_joint_is_refused_by_name():
    chain = pk.Chain.from_space(
        [pk.screw.helical([0, 0, 1], [0, 0, 0], 0.1)], np.eye(4), joint_names=["bolt"]
    )
    with pytest.raises(
        InputError,
        match=r"^joint 'bolt' is helical: Denavit-Hartenberg parameters cannot express its pitch$",
    ):
        dh.from_chain(chain, convention="standard")


def test_a_coupled_chain_gives_the_table_of_its_joints():
    chain = pk.load("panda").chain(tip="panda_rightfinger")
    result = dh.from_chain(chain, convention="standard")
    assert result.table.names == chain.joint_names
    assert result.error <= result.bound


@pytest.mark.parametrize(
    "coupling", ["joint3 = -joint3", "joint3 = 2 joint3", ["joint2 = joint3", "joint3 = joint2"]]
)
def test_a_coupling_of_one_reading_a_joint_stays_in_the_table(coupling):
    chain = pk.load("puma560").chain().coupled(coupling)
    q = np.linspace(-1, 1, chain.dof)
    result = dh.from_chain(chain, convention="standard")
    np.testing.assert_allclose(dh.to_chain(result.table).fk(q), chain.fk(q), rtol=0, atol=1e-14)
    assert result.warnings == ()
    moved = dh.from_chain(chain.replace(offset=0.1 * np.eye(chain.dof)[0]), convention="standard")
    [warning] = moved.warnings
    assert warning.startswith("the coupling of readings is left out: with offsets c")
    assert moved.table.coupling == ()


def test_a_table_s_result_says_what_it_chose_and_becomes_plain_data():
    result = dh.from_chain(pk.load("stanford").chain(), convention="modified")
    lines = str(result).splitlines()
    assert lines[:-1] == [f"Free choice: {words}" for words in result.gauge]
    assert lines[-1].startswith(f"Pose error ÷ reach ({result.reach:.3g} m): {result.error:.2g} ")
    document = json.loads(result.to_json())
    assert list(document) == [
        *("convention", "joints", "base_pose", "tool_pose", "coupling"),
        *("gauge", "error", "bound", "warnings", "reach"),
    ]
    rows = [Row(**joint | {"limits": (-math.inf, math.inf)}) for joint in document["joints"]]
    poses = {"base": document["base_pose"], "tool": document["tool_pose"]}
    made = Table(document["convention"], rows, **poses)
    x = np.linspace(-1, 1, len(made))
    np.testing.assert_array_equal(dh.to_chain(made).fk(x), dh.to_chain(result.table).fk(x))
    near = pk.screw.revolute([math.sin(1e-5), 0, math.cos(1e-5)], [1, 0, 0])
    tilted = [pk.screw.revolute([0, 0, 1], [0, 0, 0]), near]
    far = dh.from_chain(pk.Chain.from_space(tilted, np.eye(4)), convention="standard")
    assert f"Warning: {far.warnings[0]}" in far.summary().splitlines()


def test_a_chain_without_joints_is_a_tool():
    home = pk.se3.exp([0.1, 0.2, 0.3, 1, 2, 3])
    table = dh.from_chain(pk.Chain.from_space([], home), convention="standard").table
    assert len(table) == 0
    np.testing.assert_array_equal(dh.to_chain(table).fk([]), home)


@FEW
@given(tables())
def test_a_table_s_robot_is_its_chain_with_links(table):
    robot, chain = dh.to_robot(table), dh.to_chain(table)
    x = np.linspace(-1, 1, len(table))
    np.testing.assert_allclose(
        robot.chain().fk(x), chain.fk(x), rtol=0, atol=rounding(chain, x) * chain.reach
    )
    assert robot.q_names == table.names


def test_tables_are_values():
    table = Table(
        "modified", [{"theta": 0, "d": 1, "a": 2, "alpha": 0.5, "limits": (-1, 1)}], name="t"
    )
    for other in (
        copy.deepcopy(table),
        pickle.loads(pickle.dumps(table)),
        Table("modified", table.rows, name="t"),
    ):
        assert other == table
        assert hash(other) == hash(table)
    assert table != Table("standard", table.rows, name="t")
    assert "theta 0 + x  d 1  a 2  alpha 0.5" in repr(table)
    with pytest.raises(AttributeError, match=r"^cannot assign to field 'd'$"):
        table.d = [1]  # type: ignore[assignment]
    with pytest.raises(ValueError, match="read-only"):
        table.d[0] = 2


BALL = Row(kind="ball")  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize(
    "rows, error, message",
    [
        ([{"theta": 0, "d": 0, "a": 0}], InputError, "row 0: column alpha is missing"),
        ([{"theta": 0, "d": 0, "a": 0, "alhpa": 0}], InputError, "row 0: no column 'alhpa'"),
        (
            [BALL],
            InputError,
            "row 0: kind: expected 'revolute' or 'prismatic', got 'ball'",
        ),
        ([Row(d=math.nan)], InputError, r"d\[0\]: expected a finite number"),
        (
            [Row(), 7],
            ShapeError,
            r"row 1: expected a Row or a dict, as in Row\(theta, d, a, alpha\) \[rad, m\], got int",
        ),
        ([Row(limits=(1, 0))], InputError, "lower <= upper"),
        ([Row(name="a"), Row(name="a")], InputError, "more than once"),
    ],
)
def test_what_makes_no_table_is_refused(rows, error, message):
    with pytest.raises(error, match=message):
        Table("standard", rows)


def test_a_table_of_a_coupled_chain_keeps_the_limits_of_the_joints_own_values():
    S = [
        screw.revolute([0, 0, 1], [0, 0, 0]),
        screw.revolute([0, 1, 0], [0.4, 0, 0]),
        screw.prismatic([1, 0, 0]),
    ]
    chain = Chain.from_space(
        S, np.eye(4), coupling=[[1, 0], [-2, 0], [0, 1]], offset=[0, 0.5, 0], q_names=["q", "r"],
        limits=[[-1, 2], [0, 0.3]],
    )  # fmt: skip
    assert dh.from_chain(chain, convention="standard").table.limits.tolist() == [
        [-1, 2],
        [-3.5, 2.5],
        [0, 0.3],
    ]


def test_what_is_no_chain_is_refused():
    for wrong in (None, Table("standard", [Row()])):
        with pytest.raises(
            InputError,
            match=r"chain: expected a Chain, as Robot\.chain\(tip=\.\.\.\) makes it, got",
        ):
            dh.from_chain(wrong, convention="standard")  # pyright: ignore[reportArgumentType]
    with pytest.raises(
        ShapeError, match=r"^rows: expected a list of Rows or dicts, one a joint, got 5$"
    ):
        Table("standard", 5)  # pyright: ignore[reportArgumentType]


MEANING = (
    r"; standard \(Paul, distal\) is Rz\(theta\) Tz\(d\) Tx\(a\) Rx\(alpha\),"
    r" modified \(Craig, proximal\) is Rx\(alpha\) Tx\(a\) Rz\(theta\) Tz\(d\)$"
)
CHOICES = r"^convention: expected 'standard' or 'modified', "


@pytest.mark.parametrize(
    "make",
    [lambda: dh.from_chain(pk.Chain.from_space([], np.eye(4))), Table, lambda: Table(rows=[Row()])],
    ids=["of a chain", "nothing given", "only rows"],
)
def test_a_convention_that_is_left_out_is_asked_for_with_what_each_means(make):
    with pytest.raises(InputError, match=CHOICES + "it was left out" + MEANING):
        make()


@pytest.mark.parametrize("convention", ["craig", "Standard", None, ["standard"], 5])
def test_what_is_no_convention_is_refused_with_what_each_means(convention):
    got = re.escape(f"got {convention!r}")
    with pytest.raises(InputError, match=CHOICES + got + MEANING):
        Table(convention, [])
    with pytest.raises(InputError, match=CHOICES + got + MEANING):
        dh.from_chain(pk.Chain.from_space([], np.eye(4)), convention=convention)


def test_a_table_without_rows_is_not_taken_for_an_empty_one():
    with pytest.raises(ShapeError, match=r"^rows: expected a list of Rows or dicts, one a joint"):
        Table("standard")


@pytest.mark.parametrize("column", ["theta", "alpha"])
def test_degrees_are_suspected(column):
    with pytest.warns(
        PoekinWarning,
        match=(
            rf"^table 'arm': {column} = -90 of joint 'elbow' is more than a turn: degrees\?"
            r" Expected are rad, as np\.radians makes them$"
        ),
    ):
        Table("standard", [Row(), dataclasses.replace(Row(name="elbow"), **{column: -90.0})])


@pytest.mark.parametrize("name", ["samples", "seed"])
@pytest.mark.parametrize("value", [-1, 1.5, "3", None])
def test_samples_and_seed_are_whole_numbers(name, value):
    with pytest.raises(
        InputError, match=rf"^{name}: expected a whole number from 0 on, got {value!r}$"
    ):
        dh.from_chain(pk.Chain.from_space([], np.eye(4)), convention="modified", **{name: value})


def test_rounding_is_printed_as_0():
    table = Table("standard", [Row(d=8e-50, a=-1e-13, alpha=1e-12)])
    assert "theta 0 + x  d 0  a 0  alpha 1e-12" in repr(table)
    assert table.d[0] == 8e-50


PLANTED = {
    "flip lost": lambda t: Table(
        t.convention, [_with(r, flip=False) for r in t.rows], base=t.base, tool=t.tool
    ),
    "tool lost": lambda t: Table(t.convention, t.rows, base=t.base),
    "base lost": lambda t: Table(t.convention, t.rows, tool=t.tool),
    "other convention": lambda t: Table("modified", t.rows, base=t.base, tool=t.tool),
    "kind lost": lambda t: Table(
        t.convention, [_with(r, kind="revolute") for r in t.rows], base=t.base, tool=t.tool
    ),
    "offset lost": lambda t: Table(
        t.convention, [_with(r, theta=0.0) for r in t.rows], base=t.base, tool=t.tool
    ),
}


def _with(row, **changes):
    return Row(**{**{f: getattr(row, f) for f in Row.__dataclass_fields__}, **changes})


@pytest.mark.parametrize("fault", PLANTED)
def test_the_comparison_with_50_digits_sees_what_peers_lose(fault):
    table = Table(
        "standard",
        [
            Row(0.3, 0.1, 0.2, 1.0, flip=True),
            Row(0.5, 0.2, 0.1, -0.7, "prismatic"),
            Row(0.7, 0.3, 0.4, 0.2),
        ],
        base=pk.se3.exp([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]),
        tool=pk.se3.exp([0.3, 0.1, 0.2, 0.1, 0.2, 0.3]),
    )
    x = [0.4, -0.3, 0.9]
    assert error(table, dh.to_chain(table).fk(x), dh_product.pose(table, x), 1.0) < 1e-15
    assert (
        error(table, dh.to_chain(PLANTED[fault](table)).fk(x), dh_product.pose(table, x), 1.0)
        > 1e-3
    )
