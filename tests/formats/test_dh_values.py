"""One arm of every case, number by number and word by word: its table, what was free in it, and
what is said of it.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin import errors
from poekin.errors import InputError, ModelError, PoekinError
from poekin.formats import dh
from poekin.formats.dh import Row, Table, table_io
from poekin.model.screw_rows.unit_screws import pitches_of
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be

UNIT = 2.0**-53
HALF = math.pi / 2
HOME = pk.se3.exp([0.1, 0.2, 0.3, 1, 2, 3])
SCREWS = [
    pk.screw.revolute([0, 0, 1], [0.1, 0.2, 0]),
    pk.screw.revolute([0, 0, 1], [0.5, 0.2, 0.3]),  # parallel to the one before
    pk.screw.prismatic([0, 1, 0]),
    pk.screw.revolute([1, 0, 0], [0.5, 0.9, 1.3]),
    pk.screw.revolute([0.6, 0, 0.8], [0.9, 0.4, 1.5]),
]
ARM = pk.Chain.from_space(SCREWS, HOME, joint_names=list("abcde"))
GAUGE = (
    "zero of 'a' and place along its axis: nearest to the base frame",
    "axes of 'a' and 'b' are parallel: their normal is taken at the origin before it",
    "axis of 'c' has no place: put through the origin before it",
    "axes of 'b' and 'c' meet: x is along z x z'",
    "last frame: on the axis of 'e', nearest to the tool, theta = 0",
)
TURNS = [(0, 0), (math.pi, 0), (HALF, 0.7), (HALF, 0.25), (0, 1.51)]  # theta, d
NORMALS = [
    (0.4, 0),
    (0, HALF),
    (1.3, -HALF),
    (0.5, math.atan2(0.8, 0.6)),
]  # a, alpha of the axes i and i + 1


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_an_arm_of_every_case_has_the_table_that_its_axes_say(convention):
    result = dh.from_chain(ARM, convention=convention)
    t = result.table
    normals = [*NORMALS, (0, 0)] if convention == "standard" else [(0, 0), *NORMALS]
    np.testing.assert_allclose(np.transpose([t.theta, t.d]), TURNS, rtol=0, atol=1e-15)
    np.testing.assert_allclose(np.transpose([t.a, t.alpha]), normals, rtol=0, atol=1e-15)
    assert (t.kinds, t.names, t.flips) == (ARM.kinds, ARM.joint_names, (False,) * 5)
    assert (t.name, t.convention, result.gauge, result.warnings) == ("tool", convention, GAUGE, ())
    base = np.eye(4)
    base[:2, 3] = 0.1, 0.2
    np.testing.assert_allclose(t.base, base, rtol=0, atol=1e-15)
    # one arm, to the rounding of some products of poses that reach 6 m
    assert np.abs(dh.to_chain(t).fk(np.arange(5.0)) - ARM.fk(np.arange(5.0))).max() < 1e-14
    assert result.error <= 1e-15
    assert result.bound == pytest.approx(20 * UNIT * 6 * (1 + 1.51 / ARM.reach), rel=1e-12, abs=0)


def test_the_bound_takes_the_largest_length_of_the_table():
    for longest in (Row(d=-7.0, alpha=1.0), Row(a=7.0, alpha=1.0)):
        chain = dh.to_chain(Table("standard", [Row(alpha=1.0), longest, Row()]))
        assert dh.from_chain(chain, convention="standard").bound == pytest.approx(
            20 * UNIT * 4 * (1 + 7.0 / chain.reach), rel=1e-9, abs=0
        )
    empty = dh.from_chain(pk.Chain.from_space([], HOME), convention="standard")
    assert (empty.bound, empty.error, empty.gauge, empty.warnings) == (20 * UNIT, 0.0, (), ())
    assert (empty.table.name, empty.table.convention) == ("tool", "standard")
    np.testing.assert_array_equal(empty.table.tool, HOME)


def two(tilt, apart=0.4, far=0.0):
    """Two axes that meet at the distance apart / tan(tilt) along the first; the tool `far` metres
    off along z.
    """
    home = np.eye(4)
    home[2, 3] = far
    second = pk.screw.revolute([math.sin(tilt), 0, math.cos(tilt)], [apart, 0, 0])
    return pk.Chain.from_space([pk.screw.revolute([0, 0, 1], [0, 0, 0]), second], home)


@pytest.mark.parametrize("arm", [0.0, 2.6])
def test_axes_that_meet_beyond_ten_times_the_reach_are_told_of_and_those_below_are_not(arm):
    reach = two(0.4 / (30 if arm else 10), far=arm).reach
    for times, told in ((9.95, False), (10.05, True)):
        chain = two(math.atan2(0.4, times * reach), far=arm)
        assert chain.reach == pytest.approx(reach, rel=1e-3)
        result = dh.from_chain(chain, convention="standard")
        assert len(result.warnings) == told
        assert result.table.d[0] == pytest.approx(-times * reach, rel=1e-9)
        assert result.error <= result.bound


def test_what_is_told_of_axes_that_meet_far_away_has_its_numbers():
    (warning,) = dh.from_chain(two(1e-8), convention="standard").warnings
    assert warning == (
        "axes of 'joint1' and 'joint2' are nearly parallel, 1e-08 rad: d is 4e+07 m on an arm of 1 m, and its rounding"
        " 4e-09 m; a product of exponentials has no such number"
    )


def test_an_angle_that_is_dropped_far_from_the_arm_counts_with_its_lever():
    """The first two axes have their common normal 8 m away, and there the third is taken as
    parallel to the second.
    """
    z = np.array([math.sin(0.06), 0, math.cos(0.06)])
    rows = [
        pk.screw.revolute([0, 0, 1], [0, 0, 0]),
        pk.screw.revolute(z, [0.5, 0.2, 0]),
        pk.screw.revolute([z[0], 1e-10, z[2]], [0.5, 0.4, 0]),
    ]
    chain = pk.Chain.from_space(rows, np.eye(4))
    result = dh.from_chain(chain, convention="standard")
    assert "taken as parallel" in result.warnings[0]
    assert 5e-10 < result.error <= result.bound  # with 2 delta alone the bound would be 2e-10
    table = result.table
    lengths = np.abs(table.d).sum() + np.abs(table.a).sum() + np.linalg.norm(table.tool[:3, 3])
    assert result.bound == pytest.approx(2e-10 * lengths / chain.reach, rel=1e-4)
    slide = pk.Chain.from_space([*rows, pk.screw.prismatic(z)], np.eye(4))
    more = dh.from_chain(slide, convention="standard")
    assert more.error <= more.bound
    assert more.bound * slide.reach == pytest.approx(
        2e-10
        * (
            np.abs(more.table.d).sum()
            + np.abs(more.table.a).sum()
            + np.linalg.norm(more.table.tool[:3, 3])
            + 1
        ),
        rel=1e-4,
    )


def test_axes_are_taken_as_parallel_where_the_rounding_of_d_would_cost_more_than_their_angle():
    """2 angle reach <= u away, and away = 0.4 / angle: that is at sqrt(0.2 u) = 4.7e-9 rad."""
    switch = math.sqrt(0.2 * UNIT)
    kept, dropped = (
        dh.from_chain(two(1.01 * switch), convention="standard"),
        dh.from_chain(two(0.99 * switch), convention="standard"),
    )
    assert "nearly parallel" in kept.warnings[0]
    assert dropped.warnings == (
        f"axes of 'joint1' and 'joint2' are taken as parallel: the angle of {0.99 * switch:.3g} rad between them would "
        f"put d at {0.4 / (0.99 * switch):.3g} m; a product of exponentials keeps it",
    )
    assert dropped.bound == pytest.approx(20 * UNIT * 3 * 1.4 + 2 * 0.99 * switch, rel=1e-9, abs=0)
    np.testing.assert_allclose(dropped.table.a, [0.4, 0], rtol=0, atol=1e-15)
    np.testing.assert_array_equal(dropped.table.alpha, [0, 0])
    assert dropped.error <= dropped.bound
    assert dropped.error > 0.1 * switch  # the angle is gone, and the error says so
    against = pk.Chain.from_space([two(0).screws[0], -two(0.99 * switch).screws[1]], np.eye(4))
    table = dh.from_chain(against, convention="standard").table
    np.testing.assert_allclose(np.abs(table.alpha), [math.pi, 0], rtol=0, atol=1e-15)
    assert dh.from_chain(against, convention="standard").error <= dropped.bound


def test_axes_at_no_distance_worth_a_number_meet_or_are_one():
    """Below 1e-16 of the reach."""
    for off, meets in ((0.9e-16, True), (1.1e-16, False), (0.0, True)):
        screws = [
            pk.screw.revolute([0, 0, 1], [0, 0, 0]),
            pk.screw.revolute([1, 0, 0], [0, off, 0]),
        ]
        result = dh.from_chain(pk.Chain.from_space(screws, np.eye(4)), convention="standard")
        assert any("meet" in line for line in result.gauge) == meets
        one = [screws[0], pk.screw.revolute([0, 0, 1], [0, off, 0])]
        table = dh.from_chain(pk.Chain.from_space(one, np.eye(4)), convention="standard").table
        assert (table.a[0] == 0.0) == meets


def test_the_error_is_measured_at_as_many_places_as_are_asked_for():
    wrong = two(0.99 * math.sqrt(0.2 * UNIT))
    assert dh.from_chain(wrong, samples=0, convention="standard").error == 0.0
    few, many = (dh.from_chain(wrong, samples=n, convention="standard").error for n in (1, 200))
    assert 0 < few < many
    assert (
        dh.from_chain(wrong, convention="standard").error
        == dh.from_chain(wrong, samples=100, seed=0, convention="standard").error
    )
    assert (
        dh.from_chain(wrong, convention="standard").error
        != dh.from_chain(wrong, seed=1, convention="standard").error
    )


@pytest.mark.parametrize("about", range(3))
def test_the_error_s_lengths_are_multiples_of_the_reach(about):
    tilt = 0.5 * math.sqrt(0.2 * UNIT / 50)
    # the tool is 50 m away: a tilt of it is a length of 50 tilt, and 50 m are the reach
    chain = two(tilt, far=50.0).rebased(turn(about, math.pi / 2))
    assert chain.reach >= 50
    result = dh.from_chain(chain, convention="standard")
    assert 0 < result.error <= 2.1 * tilt


@pytest.mark.parametrize("times, parallel", [(1.01, 0), (0.99, 1)])
def test_how_long_an_arm_is_counts_in_what_its_axes_angle_is_worth(times, parallel):
    """2 angle reach <= u 0.4 / angle: the same test of an arm of 50 m."""
    reach = two(1e-10, far=50.0).reach
    result = dh.from_chain(
        two(times * math.sqrt(0.2 * UNIT / reach), far=50.0), convention="standard"
    )
    assert len(result.warnings) == 1
    assert ("taken as parallel" in result.warnings[0]) == parallel


def test_limits_go_with_the_joints_and_are_those_of_the_sum_where_two_coordinates_share_one():
    chain = pk.Chain.from_space(
        SCREWS[:3], HOME, q_names=["q", "r"], coupling=[[2, 0], [1, 1], [0, -1]], offset=[0.5, 0, 0.1],
        limits=[[-1, 2], [0, 0.3]],
    )  # fmt: skip
    limits = dh.from_chain(chain, convention="standard").table.limits
    np.testing.assert_allclose(limits, [[-1.5, 4.5], [-1.0, 2.3], [-0.2, 0.1]], rtol=1e-15)


def test_a_first_axis_along_x_takes_y_for_its_x():
    """What is across the axis and nearest to the base frame's x, or to its y where x is within a
    quarter of a turn.
    """
    for axis, x in (([1, 0, 0], [0, 1, 0]), ([0, 1, 0], [1, 0, 0]), ([0, 0, -1], [1, 0, 0])):
        base = dh.from_chain(
            pk.Chain.from_space([pk.screw.revolute(axis, [0, 0, 0])], np.eye(4)),
            convention="standard",
        ).table.base
        np.testing.assert_allclose(
            base[:3, :3], np.array([x, np.cross(axis, x), axis]).T, rtol=0, atol=1e-15
        )
    for lean, uses_x in ((0.89, True), (0.91, False), (-0.91, False)):
        z = np.array([lean, 0, math.sqrt(1 - lean * lean)])
        base = dh.from_chain(
            pk.Chain.from_space([pk.screw.revolute(z, [0, 0, 0])], np.eye(4)), convention="standard"
        ).table.base
        assert abs(base[1, 0]) < 1e-12 if uses_x else base[1, 0] == pytest.approx(1.0)


def test_a_helical_joint_and_an_unknown_convention_are_refused():
    bolt = pk.Chain.from_space(
        [SCREWS[0], pk.screw.helical([0, 0, 1], [0, 0, 0], 0.1)],
        np.eye(4),
        joint_names=["a", "bolt"],
    )
    with pytest.raises(
        InputError,
        match=r"^joint 'bolt' is helical: Denavit-Hartenberg parameters cannot express its pitch$",
    ):
        dh.from_chain(bolt, convention="standard")
    with pytest.raises(
        InputError, match=r"^convention: expected 'standard' or 'modified', got 'craig';"
    ):
        dh.from_chain(ARM, convention="craig")  # type: ignore[arg-type]


ROWS = [
    Row(0.3, 0.1, 0.2, 1.0, flip=True, limits=(-1, 2)),
    Row(0.5, 0.2, 0.15, -0.7, "prismatic", name="slide"),
    Row(0.7, 0.3, 0.4, 0.2, "prismatic", True),
]


def turn(axis, angle):
    return pk.se3.exp(np.array([*(np.eye(3)[axis] * angle), 0, 0, 0]))


def shift(a, d):
    T = np.eye(4)
    T[0, 3], T[2, 3] = a, d
    return T


def by_hand(rows, convention, x):
    T = HOME
    for row, value in zip(rows, x, strict=True):
        moved = -value if row.flip else value
        theta, d = (
            (row.theta + moved, row.d) if row.kind == "revolute" else (row.theta, row.d + moved)
        )
        around, along = turn(2, theta) @ shift(0, d), shift(row.a, 0) @ turn(0, row.alpha)
        T = T @ around @ along if convention == "standard" else T @ along @ around
    return T @ turn(1, 0.4)


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_a_table_is_the_product_of_its_matrices(convention, count):
    table = Table(convention, ROWS[:count], base=HOME, tool=turn(1, 0.4))
    x = [0.4, -0.3, 0.9][:count]
    expected = by_hand(ROWS[:count], convention, x)
    np.testing.assert_allclose(dh.to_chain(table).fk(x), expected, rtol=0, atol=3e-15)
    robot = dh.to_robot(table)
    np.testing.assert_allclose(
        robot.chain(base="base", tip="tool").fk(x), expected, rtol=0, atol=3e-15
    )
    assert robot.q_names == table.names == ("joint1", "slide", "joint3")[:count]
    assert [joint.name for joint in robot.joints] == [*table.names, "tool_mount"]
    assert robot.links == ("base", *(f"link{i}" for i in range(1, count + 1)), "tool")
    np.testing.assert_array_equal(robot.limits, table.limits)


def test_a_joint_called_like_the_mount_of_the_tool_keeps_its_name():
    robot = dh.to_robot(Table("standard", [Row(name="tool_mount")]))
    assert [joint.name for joint in robot.joints] == ["tool_mount", "tool_mount_"]
    robot = dh.to_robot(Table("standard", [Row(name="tool_mount"), Row(name="tool_mount_")]))
    assert robot.joints[-1].name == "tool_mount__"


MAKERS = r"dh\.read\(path\), dh\.published\(name\) and dh\.from_chain\(\.\.\.\)\.table make one$"


def test_only_a_table_is_one():
    for function in (dh.to_chain, dh.to_robot):
        with pytest.raises(
            InputError, match=rf"^{function.__name__}: expected a dh.Table, got 5; {MAKERS}"
        ):
            function(5)  # pyright: ignore[reportArgumentType]
    with pytest.raises(
        InputError,
        match=rf"^write: expected a dh\.Table, got 5; {MAKERS}",
    ):
        dh.write(5, "arm.toml")  # pyright: ignore[reportArgumentType]


def test_a_table_is_printed_with_what_moves():
    table = Table("standard", [*ROWS, Row(name="last")], name="arm")
    assert repr(table) == (
        "<standard DH table 'arm', 4 joints\n"
        "  'joint1': theta 0.3 - x  d 0.1  a 0.2  alpha 1\n"
        "  'slide': theta 0.5  d 0.2 + x  a 0.15  alpha -0.7\n"
        "  'joint3': theta 0.7  d 0.3 - x  a 0.4  alpha 0.2\n"
        "  'last': theta 0 + x  d 0  a 0  alpha 0>"
    )
    coupled = Table("standard", [Row(name="a"), Row(name="b")], coupling=["b = b - a"])
    assert repr(coupled).endswith("alpha 0\n  coupling: b = -a + b>")


def test_two_tables_are_equal_when_all_of_them_is():
    table = Table("standard", ROWS, name="t")
    assert table == Table("standard", ROWS, name="t")
    assert table != Table("standard", ROWS, name="u")
    assert table != Table("standard", ROWS, name="t", base=HOME)
    assert table != Table("standard", ROWS[:2], name="t")
    assert table != 5
    assert len({table, Table("standard", ROWS, name="t"), Table("standard", ROWS, name="u")}) == 2
    with pytest.raises(AttributeError, match=r"^cannot delete field 'd'$"):
        del table.d  # pyright: ignore[reportAttributeAccessIssue]


def test_a_turn_of_alpha_is_taken_and_more_of_it_warned_about(recwarn):
    Table("standard", [Row(alpha=2 * math.pi), Row(alpha=-2 * math.pi)])
    assert not recwarn.list
    with pytest.warns(
        pk.PoekinWarning,
        match=(
            r"^table 'arm': alpha = -6\.3 of joint 'joint2' is more than a turn: degrees\? Expected "
            r"are rad, as np\.radians makes them$"
        ),
    ):
        Table("standard", [Row(), Row(alpha=-6.3), Row(alpha=90)])


def test_the_warning_of_degrees_points_to_the_line_that_made_the_table():
    with pytest.warns(
        pk.PoekinWarning,
        match=(
            r"^table 'arm': alpha = 90 of joint 'joint1' is more than a turn: degrees\? Expected are "
            r"rad, as np\.radians makes them$"
        ),
    ) as warned:
        Table("standard", [Row(alpha=90)])
    assert warned[0].filename == __file__


def test_of_columns_that_are_unknown_or_missing_the_first_is_named():
    with pytest.raises(
        InputError,
        match=(
            r"^row 0: no column 'x'; there are theta, d, a, alpha, kind, flip, name, limits;"
            r" a joint's offset stands in theta or d$"
        ),
    ):
        Table("standard", [{"x": 1, "y": 2}])  # pyright: ignore[reportArgumentType]
    with pytest.raises(
        InputError, match=r"^row 0: column d is missing; needed are theta, d, a, alpha$"
    ):
        Table("standard", [{"theta": 1}])  # pyright: ignore[reportArgumentType]


def test_a_kind_is_what_it_says_whoever_made_the_word():
    made: Any = "".join(["revo", "lute"])
    assert repr(Table("standard", [Row(kind=made)])) == repr(Table("standard", [Row()]))


@pytest.mark.parametrize("ending", [".toml", ".csv"])
def test_a_base_moved_back_is_written_too(ending):
    table = Table("standard", [Row()], base=shift(-0.5, -0.2), tool=shift(-0.1, 0.0), name="t")
    assert table_io.read_text(table_io.make_text(table, ending), f"t{ending}") == table


def test_the_words_of_a_file_follow_the_format():
    table = Table("modified", ROWS[:2], base=shift(0.5, 0.0), name="t")
    assert table_io.make_text(table, ".csv") == (
        "convention,name,kind,theta,d,a,alpha,flip,lower,upper,pose\n"
        "modified,,base,,,,,,,,1.0 0.0 0.0 0.5 0.0 1.0 0.0 0.0 0.0 0.0 1.0 0.0\n"
        "modified,joint1,revolute,0.3,0.1,0.2,1.0,true,-1.0,2.0,\n"
        "modified,slide,prismatic,0.5,0.2,0.15,-0.7,false,-inf,inf,\n"
    )
    toml = table_io.make_text(table, ".toml")
    assert "tool" not in toml
    assert toml.count("limits") == 1


def meeting_at(times, chain_of):
    """The chain whose first two axes meet at so many times its reach."""
    reach = 1.0
    for _ in range(6):  # the reach hardly depends on the tilt
        chain = chain_of(math.atan2(0.4, times * reach))
        reach = chain.reach
    return chain


@pytest.mark.parametrize("slides", [True, False], ids=["prismatic", "parallel"])
@pytest.mark.parametrize("arm", [0.0, 2.6])
def test_a_normal_that_is_free_is_not_taken_where_axes_meet_far_away(arm, slides):
    """Up to ten times the reach from the base it stays at the origin before it (d = 0), beyond it
    comes back.
    """

    def three(tilt):
        first = two(tilt, far=arm)
        z = first.screws[1][:3]
        third = pk.screw.prismatic([0, 1, 0]) if slides else pk.screw.revolute(z, [0.4, 0.1, 0])
        return pk.Chain.from_space([*first.screws, third], first.home)

    for times, back in ((9.9, False), (10.1, True)):
        chain = meeting_at(times, three)
        result = dh.from_chain(chain, convention="standard")
        away = times * chain.reach
        assert result.table.d[0] == pytest.approx(-away, rel=1e-6)
        # from where the axes meet to the point of the second that is nearest to the base
        assert result.table.d[1] == pytest.approx(away if back else 0.0, rel=1e-2, abs=1e-12)
        assert result.error <= result.bound


def test_a_row_and_a_result_are_frozen():
    for value, field in ((ROWS[0], "d"), (dh.from_chain(ARM, convention="standard"), "bound")):
        with pytest.raises(AttributeError, match=r"cannot assign to field"):
            setattr(value, field, 1.0)


def test_a_joint_that_cannot_move_is_a_joint():
    for text, name in (
        ("convention,theta,d,a,alpha,lower,upper\nstandard,1,2,3,1,0.5,0.5\n", "t.csv"),
        (
            "convention='standard'\n[[joint]]\ntheta=1\nd=2\na=3\nalpha=1\nlimits=[0.5, 0.5]\n",
            "t.toml",
        ),
    ):
        assert table_io.read_text(text, name).limits.tolist() == [[0.5, 0.5]]


def test_of_columns_that_are_there_twice_the_first_is_named():
    with pytest.raises(ModelError, match=r"^t\.csv:1: d: it appears 3 times, expected once$"):
        table_io.read_text("convention,theta,d,d,d,a,a,alpha\n", "t.csv")


@pytest.mark.parametrize("text, ending", [("x", ".csv"), ("x =", ".toml"), ("x", ".txt")])
def test_a_file_s_name_takes_400_characters_of_a_message_at_most(text, ending):
    whole, cut = "n" * (400 - len(ending)) + ending, "n" * (401 - len(ending)) + ending
    for name, said in ((whole, whole), (cut, errors.escape_unprintable(cut, 400))):
        with pytest.raises(PoekinError) as caught:
            table_io.read_text(text, name)
        assert str(caught.value).startswith(f"{said}:")
    assert errors.escape_unprintable(cut, 400) not in errors.escape_unprintable(cut, 401)


@pytest.mark.parametrize(
    "limits", [(-math.inf, 5.0), (-5.0, math.inf), (0.0, 0.0), (-math.inf, math.inf)], ids=str
)
def test_limits_come_back_from_either_file(limits):
    table = Table(
        "standard", [Row(limits=limits), Row(kind="prismatic", flip=True, limits=limits)], name="t"
    )
    for ending in (".toml", ".csv"):
        assert table_io.read_text(table_io.make_text(table, ending), f"t{ending}") == table


@pytest.mark.parametrize(
    "limits", ["[]", "[1]", "[0, 1, 2]", "1", "[0, nan]", "[nan, 0]", "['a', 1]", "[false, 1]"]
)
def test_limits_that_are_no_pair_of_numbers_are_refused(limits):
    text = f"convention='standard'\n[[joint]]\ntheta=1\nd=2\na=3\nalpha=1\nlimits={limits}\n"
    with pytest.raises(
        ModelError,
        match=r"^t.toml: joint 1: limits: expected (a list of 2 numbers|lower <= upper|a number), got ",
    ):
        table_io.read_text(text, "t.toml")


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_a_far_base_makes_no_pitch_of_its_rounding(convention):
    """Ad of a pose 1e5 m away leaves omega . v = 1e-11 m per rad, of which a revolute joint has
    none.

    That is more than the rounding of v where the pose is far away along the axis: there v is small.
    """
    base = pk.se3.exp([0.4, -0.7, 0.3, 1e5, -2e5, 3e5])
    turned = pk.se3.exp([0.4, -0.7, 0.3, 0, 0, 0])
    for table in (
        Table(convention, [Row(d=0.3, alpha=1.0), Row(a=0.2, alpha=0.7), *ROWS], base=base),
        Table(convention, [Row(d=1e5), Row(d=0.3), *ROWS], base=turned),
    ):
        chain = dh.to_chain(table)
        assert chain.kinds == table.kinds
        assert pitches_of(chain.screws).tolist() == chain.pitches.tolist() == [0.0] * len(table)


def test_an_arm_of_a_micrometre_has_the_screws_of_a_large_one():
    """Nothing of the size of a metre is added and taken away."""
    rows = [Row(0.3, d, a, 1.0) for d, a in ((0.5, 0.25), (0.75, 0.5), (0.0, 1.0))]
    small = [
        Row(row.theta, row.d * 2.0**-20, row.a * 2.0**-20, row.alpha, flip=True) for row in rows
    ]
    large, tiny = (dh.to_chain(Table("standard", table)).screws for table in (rows, small))
    np.testing.assert_allclose(-tiny[:, 3:] * 2.0**20, large[:, 3:], rtol=0, atol=1e-14)


def test_the_first_frame_stands_where_its_axis_is_nearest_to_the_base():
    z, p = np.array([2.0, -3.0, 6.0]) / 7, np.array([0.3, -1.2, 2.5])
    base = dh.from_chain(
        pk.Chain.from_space([pk.screw.revolute(z, p)], HOME), convention="standard"
    ).table.base
    np.testing.assert_allclose(base[:3, 2:], np.transpose([z, p - z * (z @ p)]), rtol=0, atol=1e-15)
    slide = dh.from_chain(
        pk.Chain.from_space([pk.screw.prismatic(z)], HOME), convention="standard"
    ).table.base
    np.testing.assert_allclose(slide[:3, 2:], np.transpose([z, np.zeros(3)]), rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    "line, got", [("standard,1,2,3", 4), ("standard,1,2,3,4,5", 6), ("standard,1,2,3,4,5,6,7", 8)]
)
def test_a_line_of_too_many_or_too_few_columns_is_counted(line, got):
    with pytest.raises(
        ModelError, match=rf"^t.csv:2: expected 5 columns as in the header, got {got}$"
    ):
        table_io.read_text(f"convention,theta,d,a,alpha\n{line}\n", "t.csv")


@pytest.mark.parametrize("kind", dataclasses_of("poekin.formats.dh", "from_chain table"))
def test_a_table_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)
