"""DH tables into screws and back, against the product of their matrices in 50 digits."""

import copy
import math
import pickle

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings, target
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, PoekinWarning, ShapeError
from poekin.formats import dh, erd
from poekin.formats.dh import Row, Table
from poekin.testing import strategies

UNIT = 2.0**-53
QUARTERS = st.sampled_from([0.0, math.pi / 2, -math.pi / 2, math.pi])
NEARLY = st.tuples(QUARTERS, st.sampled_from([1, -1]), st.floats(-12, -3)).map(lambda t: t[0] + t[1] * 10 ** t[2])
ANGLES = st.one_of(QUARTERS, NEARLY, st.floats(-3, 3))
LENGTHS = st.one_of(st.just(0.0), st.floats(-2, 2), st.floats(-12, -3).map(lambda e: 10**e))
ROWS = st.builds(Row, ANGLES, LENGTHS, LENGTHS, ANGLES, st.sampled_from(["revolute", "prismatic"]), st.booleans())
POSES = strategies.poses(lengths=(1e-3, 2.0))
CONVENTIONS = st.sampled_from(["standard", "modified"])
FEW = settings(max_examples=max(settings().max_examples // 2, 20))


@st.composite
def tables(draw, most=10):
    rows = draw(st.lists(ROWS, min_size=1, max_size=most))
    return Table(draw(CONVENTIONS), rows, base=draw(POSES), tool=draw(POSES))


def exact_pose(table, x):
    """The product of the table's matrices in 50 digits, written out as in the books."""

    def about(axis, angle):
        c, s = mpmath.cos(angle), mpmath.sin(angle)
        rows = {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis]
        return mpmath.matrix([[*row, 0] for row in rows] + [[0, 0, 0, 1]])

    def shift(a, d):
        T = mpmath.eye(4)
        T[0, 3], T[2, 3] = a, d
        return T

    with mpmath.workdps(50):
        T = mpmath.matrix(table.base.tolist())
        for row, value in zip(table.rows, map(mpmath.mpf, map(float, x)), strict=True):
            moved = -value if row.flip else value
            turns = row.kind == "revolute"
            theta, d = row.theta + moved * turns, row.d + moved * (not turns)
            around, along = about("z", theta) * shift(0, d), shift(row.a, 0) * about("x", row.alpha)
            T = T * (around * along if table.convention == "standard" else along * around)
        T = T * mpmath.matrix(table.tool.tolist())
        return np.array(T.tolist(), dtype=float)


def error(table, got, expected, reach):
    difference = got - expected
    difference[..., :3, 3] /= reach
    return float(np.abs(difference).max())


def largest(table):
    return max(np.abs(table.d).max(initial=0), np.abs(table.a).max(initial=0))


@FEW
@given(tables(), st.integers(0, 2**32))
def test_a_table_s_screws_move_as_its_matrices_do(table, seed):
    chain = dh.to_chain(table)
    x = np.random.default_rng(seed).uniform(-np.pi, np.pi, len(table))
    got = error(table, chain.fk(x), exact_pose(table, x), chain.reach)
    target(got)
    assert got <= 1e-13


@FEW
@given(tables(), CONVENTIONS)
@example(Table("standard", [Row(alpha=1e-9, a=0.4), Row(a=0.3), Row(d=1.0)]), "modified")
@example(Table("standard", [Row(alpha=1e-4, a=0.4), Row(kind="prismatic"), Row(alpha=1.0, a=0.2), Row()]), "standard")
def test_from_screws_to_a_table_and_back_keeps_the_pose(table, convention):
    chain = dh.to_chain(table)
    result = dh.from_chain(chain, convention=convention)
    assert result.table.convention == convention
    assert result.table.kinds == chain.kinds
    assert result.error <= result.bound
    n, dropped = len(table), [w for w in result.warnings if "taken as parallel" in w]
    if largest(result.table) <= 10 * chain.reach and not dropped:
        assert result.error <= 1e-13
    elif not dropped:
        assert result.bound <= 100 * UNIT * n * (1 + largest(result.table) / chain.reach)
    if largest(result.table) > 10 * chain.reach:
        assert any("product of exponentials" in w for w in result.warnings)


@FEW
@given(tables(most=6), CONVENTIONS)
@example(Table("standard", [Row(kind="prismatic", alpha=1e-5), Row()]), "standard")  # far: its rounding is no pitch
def test_a_table_of_a_table_s_chain_is_that_table_again(table, convention):
    first = dh.from_chain(dh.to_chain(table), convention=convention).table
    again = dh.from_chain(dh.to_chain(first), convention=convention)
    assert again.error <= again.bound
    if largest(first) <= 10 * dh.to_chain(first).reach:
        x = np.linspace(-1, 1, len(table))
        a, b = dh.to_chain(first), dh.to_chain(again.table)
        assert error(first, a.fk(x), b.fk(x), a.reach) <= 1e-12


def test_a_tilt_in_the_plane_of_two_axes_throws_d_far_and_moves_the_screw_by_no_more_than_itself():
    a, delta = 0.4318, 1e-4
    home = np.eye(4)
    straight = [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.revolute([0, 0, 1], [a, 0, 0])]
    tilted = [straight[0], pk.screw.revolute([np.sin(delta), 0, np.cos(delta)], [a, 0, 0])]
    assert np.abs(tilted[1] - straight[1]).max() <= delta
    result = dh.from_chain(pk.Chain(tilted, home), convention="standard")
    assert abs(result.table.d[0]) == pytest.approx(a / np.tan(delta), rel=1e-9)
    (warning,) = result.warnings
    assert "nearly parallel, 0.0001 rad: d is 4.32e+03 m" in warning


def test_the_panda_comes_out_as_franka_publishes_it():
    table = dh.from_chain(pk.load("panda").chain(tip="panda_link8"), convention="modified").table
    np.testing.assert_allclose(table.a, [0, 0, 0, 0.0825, 0.0825, 0, 0.088], atol=1e-15)
    np.testing.assert_allclose(np.abs(table.alpha), [0, *[np.pi / 2] * 6], atol=1e-15)
    np.testing.assert_allclose(np.abs(table.d), [0.333, 0, 0.316, 0, 0.384, 0, 0.107], atol=1e-15)


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.filterwarnings("ignore::poekin.errors.PoekinWarning")
def test_every_chain_of_the_real_robots_has_a_table(convention):
    worst = 0.0
    for name in sorted(erd.available()):
        if name == "ur3":
            continue
        robot = pk.load(f"erd:{name}")
        if any(joint.kind in ("floating", "planar") for joint in robot.joints):
            continue
        for tip in robot.leaves:
            chain = robot.chain(tip=tip)
            result = dh.from_chain(chain, convention=convention, samples=20)
            assert result.error <= result.bound
            if largest(result.table) <= 10 * chain.reach and not result.warnings:
                worst = max(worst, result.error)
    assert worst <= 1e-13


def test_a_helical_joint_is_refused_by_name():
    chain = pk.Chain([pk.screw.helical([0, 0, 1], [0, 0, 0], 0.1)], np.eye(4), joint_names=["bolt"])
    with pytest.raises(InputError, match="joint 'bolt' is helical"):
        dh.from_chain(chain)


def test_a_coupled_chain_gives_the_table_of_its_joints():
    chain = pk.load("panda").chain(tip="panda_rightfinger")
    result = dh.from_chain(chain)
    assert result.table.names == chain.joint_names
    assert result.error <= 1e-13


def test_a_chain_without_joints_is_a_tool():
    home = pk.se3.exp([0.1, 0.2, 0.3, 1, 2, 3])
    table = dh.from_chain(pk.Chain([], home)).table
    assert len(table) == 0
    np.testing.assert_array_equal(dh.to_chain(table).fk([]), home)


@FEW
@given(tables())
def test_a_table_s_robot_is_its_chain_with_links(table):
    robot, chain = dh.to_robot(table), dh.to_chain(table)
    x = np.linspace(-1, 1, len(table))
    np.testing.assert_allclose(robot.chain().fk(x), chain.fk(x), atol=1e-13)
    assert robot.q_names == table.names


def test_tables_are_values():
    table = Table("modified", [{"theta": 0, "d": 1, "a": 2, "alpha": 0.5, "limits": (-1, 1)}], name="t")
    for other in (copy.deepcopy(table), pickle.loads(pickle.dumps(table)), Table("modified", table.rows, name="t")):
        assert other == table
        assert hash(other) == hash(table)
    assert table != Table("standard", table.rows, name="t")
    assert "theta 0 + x  d 1  a 2  alpha 0.5" in repr(table)
    with pytest.raises(AttributeError, match="frozen"):
        table.d = [1]  # type: ignore[assignment]
    with pytest.raises(ValueError, match="read-only"):
        table.d[0] = 2


@pytest.mark.parametrize(
    "rows, error, message",
    [
        ([{"theta": 0, "d": 0, "a": 0}], InputError, "row 0: column alpha is missing"),
        ([{"theta": 0, "d": 0, "a": 0, "alhpa": 0}], InputError, "row 0: no column 'alhpa'"),
        ([Row(kind="ball")], InputError, "kind must be 'revolute' or 'prismatic', got 'ball'"),
        ([Row(d=math.nan)], InputError, r"d\[0\]: expected a finite number"),
        ([Row(), 7], ShapeError, "row 1: expected a Row or a dict, got int"),
        ([Row(limits=(1, 0))], InputError, "lower <= upper"),
        ([Row(name="a"), Row(name="a")], InputError, "more than once"),
    ],
)
def test_what_makes_no_table_is_refused(rows, error, message):
    with pytest.raises(error, match=message):
        Table("standard", rows)


def test_a_convention_is_named_and_degrees_are_suspected():
    with pytest.raises(InputError, match="expected 'standard' or 'modified'"):
        Table("craig", [])
    with pytest.warns(PoekinWarning, match="alpha = 90 is more than a turn: degrees?"):
        Table("standard", [Row(alpha=90.0)])


PLANTED = {
    "flip lost": lambda t: Table(t.convention, [_with(r, flip=False) for r in t.rows], base=t.base, tool=t.tool),
    "tool lost": lambda t: Table(t.convention, t.rows, base=t.base),
    "base lost": lambda t: Table(t.convention, t.rows, tool=t.tool),
    "other convention": lambda t: Table("modified", t.rows, base=t.base, tool=t.tool),
    "kind lost": lambda t: Table(t.convention, [_with(r, kind="revolute") for r in t.rows], base=t.base, tool=t.tool),
    "offset lost": lambda t: Table(t.convention, [_with(r, theta=0.0) for r in t.rows], base=t.base, tool=t.tool),
}


def _with(row, **changes):
    return Row(**{**{f: getattr(row, f) for f in Row.__dataclass_fields__}, **changes})


@pytest.mark.parametrize("fault", PLANTED)
def test_the_comparison_with_50_digits_sees_what_peers_lose(fault):
    table = Table(
        "standard",
        [Row(0.3, 0.1, 0.2, 1.0, flip=True), Row(0.5, 0.2, 0.1, -0.7, "prismatic"), Row(0.7, 0.3, 0.4, 0.2)],
        base=pk.se3.exp([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]),
        tool=pk.se3.exp([0.3, 0.1, 0.2, 0.1, 0.2, 0.3]),
    )
    x = [0.4, -0.3, 0.9]
    assert error(table, dh.to_chain(table).fk(x), exact_pose(table, x), 1.0) < 1e-15
    assert error(table, dh.to_chain(PLANTED[fault](table)).fk(x), exact_pose(table, x), 1.0) > 1e-3
