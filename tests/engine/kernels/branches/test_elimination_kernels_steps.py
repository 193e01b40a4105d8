"""The steps of elimination one by one, as plain Python: what is a solution, and what is not sure."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.engine.kernels.branches import elimination_kernels as kernel
from poekin.engine.kernels.branches import elimination_roots
from tests.engine.kernels.branches.four_at_once import FOUR
from tests.engine.kernels.branches.test_elimination_kernels import chain, table

ROOM = kernel.circle_roots.ROOM
WHOLE = (1.0, 0.0, 1.0)
QUARTER = (math.cos(0.3), math.sin(0.3), 0.2)


def test_six_revolute_joints_have_up_to_sixteen_solutions():
    assert kernel.MOST == 16


@pytest.mark.parametrize("joint", range(6))
def test_rows_are_one_solution_where_all_angles_agree_to_1e_7_and_whole_turns(joint):
    rows = np.zeros((3, 7))
    rows[:, :6] = -2.0, -1.0, 0.0, 0.5, 1.0, 2.0
    rows[0, :6] += 0.5
    for a, off, is_new in (
        (0.5, 0.9e-7, False), (0.5, -0.9e-7, False), (-0.5, 1.1e-7, True), (0.5, -1.1e-7, True),
        (0.0, 0.0, False), (0.0, math.pi, True), (-0.25, math.pi / 2, True), (-2.0, 4.0, True),
        (math.pi - 0.3e-7, 0.6e-7 - 2 * math.pi, False), (-math.pi, 2 * math.pi - 0.9e-7, False),
        (math.pi - 0.6e-7, 1.2e-7 - 2 * math.pi, True),
    ):  # fmt: skip
        rows[1, joint] = a
        rows[2, joint] = a + off
        rows[:, 6] = 0.1, 0.2, 0.3
        assert kernel._is_new(rows, 2) is is_new
        assert kernel._is_new(rows[[1, 0, 2]], 2) is is_new
        assert kernel._is_new(rows[1:], 1) is is_new


def test_angles_that_are_as_far_apart_as_they_may_be_are_two_solutions(monkeypatch):
    monkeypatch.setattr(kernel, "_SAME", 0.5)
    rows = np.zeros((2, 7))
    rows[1, 3] = 0.5
    assert kernel._is_new(rows, 1)


def test_a_view_keeps_the_roots_of_its_quarter_and_a_thousandth_of_a_radian_more():
    off = np.array(
        [0.0, math.pi / 4 + 0.0009, -math.pi / 4 - 0.0009, 1.5, math.pi / 4 + 0.0011, 0.2]
    )
    half = np.arctan2(np.tan(off / 2), 0.2)
    found = np.zeros(3 * ROOM)
    found[:6], found[ROOM : ROOM + 6] = -1.5 * np.cos(half), -1.5 * np.sin(half)
    found[2 * ROOM : 2 * ROOM + 6] = slopes = np.array([3.0, -4.0, 5.0, 0.5, 7.0, 8.0])
    all_six = found.copy()
    kept = [0, 1, 2, 5]
    assert kernel._within(found, 6, 0.2, 3.0) == (4, False)
    for part, numbers in zip(found.reshape(3, ROOM), all_six.reshape(3, ROOM), strict=True):
        assert part[:4].tolist() == numbers[kept].tolist()
    assert kernel._within(all_six.copy(), 6, 0.2, 3.1) == (4, True)
    assert kernel._within(all_six.copy(), 6, 1.0, 0.4) == (6, False)
    assert kernel._within(all_six.copy(), 6, 1.0, 0.6) == (6, True)
    assert slopes[3] == 0.5


def test_memory_of_a_call_has_room_for_four_of_each():
    one = elimination_roots.make_scratch()
    assert one.axes.shape == (6, 6)
    # lines from both sides, six equations, matrices, samples, coefficients, those on arcs
    sizes = [one.far_side, one.near_side, one.sigma, one.A, one.M, one.values, one.f, one.on_arcs]
    assert [a.shape for a in sizes] == [(n,) for n in (420, 148, 168, 216, 324, 20, 24, 136)]
    # halved arcs, 32 roots with slopes and in brackets, and of four: products, points, angles
    sizes = [one.segments, one.found, one.brackets, one.v, one.solved, one.angles]
    assert [a.shape for a in sizes] == [(n,) for n in (798, 96, 192, 48, 52, 24)]


class Passed:
    """`_pass` over roots with these gaps, angles and slopes; what its parts were asked."""

    def __init__(
        self, monkeypatch, gaps, angles=None, view=WHOLE, size=2.0, noise=1e-12, count=0, many=4,
        room=16, slope=0.5
    ):  # fmt: skip
        self.groups: list[tuple[int, int]] = []
        self.asked: Any = None
        number = len(gaps)
        self.scratch = SimpleNamespace(
            found=np.zeros(3 * ROOM), solved=np.zeros(4 * 13), angles=np.zeros(24), f=None
        )

        def roots(scratch, zero, steepest, is_whole):
            self.asked = (zero, steepest, is_whole)
            scratch.found[:number] = 1.0
            scratch.found[ROOM : ROOM + number] = 1.6  # within a quarter of the circle
            scratch.found[2 * ROOM : 2 * ROOM + number] = -slope - np.arange(number)
            return number

        def sharpen(one, view, scratch, first, some):
            self.groups.append((first, some))
            for k in range(some):
                at = first + k
                scratch.solved[many * elimination_roots.GAP + k] = gaps[at]
                for i in range(6):
                    scratch.angles[many * i + k] = (
                        0.09 * at - 0.1 * i if angles is None else angles[at]
                    )

        monkeypatch.setattr(kernel, "lanes", SimpleNamespace(at_once=lambda: many))
        monkeypatch.setattr(kernel, "polynomial", lambda *rest: (size, noise))
        monkeypatch.setattr(kernel, "circle_roots", SimpleNamespace(steepest=lambda f: 4.0))
        monkeypatch.setattr(kernel, "roots", roots)
        monkeypatch.setattr(kernel, "_sharpen", sharpen)
        self.rows = np.full((room, 7), np.nan)
        self.said = kernel._pass(table(chain(4), 0, 0), None, view, self.scratch, self.rows, count)


@pytest.mark.parametrize("many", [1, 4])
def test_roots_are_sharpened_in_groups_and_each_is_a_row_with_its_slope_as_the_margin(
    many, monkeypatch
):
    one = Passed(monkeypatch, [0.0] * 6, many=many)
    assert one.said == (6, False, False)
    assert one.groups == ([(0, 4), (4, 2)] if many == 4 else [(k, 1) for k in range(6)])
    expected = 0.09 * np.arange(6)[:, None] - 0.1 * np.arange(6)
    np.testing.assert_allclose(one.rows[:6, :6], expected, atol=1e-15)
    np.testing.assert_allclose(one.rows[:6, 6], (0.5 + np.arange(6)) / 4.0, rtol=1e-15)
    assert np.isnan(one.rows[6:]).all()


def test_a_pass_goes_on_after_the_solutions_of_those_before(monkeypatch):
    one = Passed(monkeypatch, [0.0, 0.0], count=3)
    assert one.said == (5, False, False)
    assert np.isnan(one.rows[:3]).all()


@pytest.mark.parametrize(
    ("size", "noise", "count"),
    [(100.0, 1e-4, 0), (100.0, math.nan, 0), (100.0, 0.0, -1), (0, 0, 0)],
)
def test_a_determinant_that_is_noise_is_degenerate(size, noise, count, monkeypatch):
    one = Passed(monkeypatch, [0.0], size=size, noise=noise, count=count)
    assert one.said == (kernel.DEGENERATE, True, False)


@pytest.mark.parametrize(
    ("size", "noise", "zero"),
    [(100.0, 0.99e-4, 128 * 0.99e-4), (2.0, 1e-15, 4e-11), (2.0, 1e-12, 128e-12)],
)
def test_what_is_zero_is_so_many_times_the_noise_or_rounding(size, noise, zero, monkeypatch):
    for view, is_whole in ((WHOLE, True), (QUARTER, False)):
        one = Passed(monkeypatch, [0.0], size=size, noise=noise, view=view)
        assert one.asked == (pytest.approx(zero, rel=1e-12, abs=0.0), 4.0, is_whole)
        assert one.said[0] == 1


def test_what_leaves_it_unsure_whether_there_are_other_solutions(monkeypatch):
    for gaps, said in (
        ([1e-7, 0.0], (2, False, False)), ([1.1e-7, 0.0], (2, True, False)), ([0.0, math.nan], (1, True, False)),
        ([0.0, 1e-2, 0.0], (3, True, False)), ([0.0, 1.1e-2, 0.0], (2, True, False)),
    ):  # fmt: skip
        assert Passed(monkeypatch, gaps).said == said
    assert Passed(monkeypatch, [0.0] * 4, room=3).said == (3, True, False)
    assert Passed(monkeypatch, [0.0] * 3, room=3).said == (3, False, False)
    twice = [0.5, 0.5, -0.5]
    assert Passed(monkeypatch, [0.0] * 3, twice).said == (2, True, False)
    assert Passed(monkeypatch, [0.0] * 3, twice, QUARTER).said == (2, False, False)
    full = [0.0] * ROOM
    assert Passed(monkeypatch, full, room=40).said == (ROOM, True, False)
    assert Passed(monkeypatch, full[1:], room=40).said == (ROOM - 1, False, False)
    for slope, is_flat in ((3.9e-6, True), (4.1e-6, False)):
        assert Passed(monkeypatch, [0.0], slope=slope).said == (1, False, is_flat)


def test_a_root_whose_line_is_off_by_less_than_a_hundredth_is_to_be_tried(monkeypatch):
    """Its margin is 0: a double root is known to the square root of rounding alone."""
    rows = Passed(monkeypatch, [1e-7, 1.1e-7, 1e-2, 0.0]).rows
    assert (rows[:4, 6] > 0).tolist() == [True, False, False, True]
    assert rows[1:3, 6].tolist() == [0, 0]
    np.testing.assert_allclose(rows[1:3, 0], [0.09, 0.18], atol=1e-15)


def filled(monkeypatch, results, quarters=1, is_first=True, is_fixed=True):
    """What `fill` returns, the margins of its rows, the views and counts, and what was called."""
    views: list[Any] = []
    calls: list[Any] = []
    left = list(results)

    def passed(arm, one, view, scratch, rows, count):
        views.append((view, count))
        return left.pop(0)

    loop = SimpleNamespace(h=[1], P=[2], W=3, d=4)
    monkeypatch.setattr(kernel, "_loop", lambda *rest: loop)
    monkeypatch.setattr(kernel, "is_far_side_fixed", lambda arm: is_fixed)
    monkeypatch.setattr(kernel, "_pass", passed)
    monkeypatch.setattr(kernel, "lanes", SimpleNamespace(at_once=lambda: 4, rows=lambda a: a))
    equations = SimpleNamespace(ROOM=28)
    for name in ("far_side", "near_side", "combine"):
        setattr(equations, name, lambda *given, name=name: calls.append((name, given)))
    monkeypatch.setattr(kernel, "line_equations", equations)
    scratch = SimpleNamespace(axes=0, far_side="F", near_side="B", sigma="S")
    rows = np.full((16, 7), 7.0)
    said = kernel.fill(table(chain(4), 0, 0, quarters), None, rows, scratch, is_first)
    assert not left
    assert (rows[:, :6] == 7.0).all()
    return said, rows[:, 6].tolist(), views, calls


@pytest.mark.parametrize(
    ("result", "quarters", "said"),
    [
        ((2, False, False), 1, (2, False)),
        ((3, False, False), 1, (3, True)),
        ((0, False, False), 0, (0, False)),
        ((2, True, False), 1, (2, True)),
        ((4, False, True), 0, (4, True)),
        ((16, False, False), 1, (16, False)),
        ((kernel.DEGENERATE, True, False), 1, (kernel.DEGENERATE, True)),
    ],
)
def test_the_whole_circle_is_enough_where_no_root_is_flat_or_quarters_are_not_asked_for(
    result, quarters, said, monkeypatch
):
    found, margins, views, _ = filled(monkeypatch, [result], quarters)
    assert found == said
    assert views == [(WHOLE, 0)]
    known = max(result[0], 0)
    assert margins == [7.0] * known + [-1.0] * (16 - known)


@pytest.mark.parametrize(
    ("last", "unsure"), [((4, False, False), False), ((4, True, False), True), ((4, False, True), True)]
)  # fmt: skip
def test_each_quarter_of_the_circle_is_looked_at_where_a_root_is_flat(last, unsure, monkeypatch):
    results = [(5, True, True), (1, False, False), (2, False, False), (4, False, False)]
    for k in range(1, 5):
        order = results.copy()
        order.insert(k, (order[k - 1][0] if k > 1 else 0, *last[1:]))
        found, margins, views, _ = filled(monkeypatch, order)
        assert found == (order[-1][0], unsure or order[-1][0] % 2 == 1)
        assert [count for _, count in views] == [0, 0, *(count for count, *_ in order[1:-1])]
        for j, (view, _) in enumerate(views[1:], 1):
            expected = (math.cos(j * math.pi / 4), math.sin(j * math.pi / 4), 0.2)
            assert view == pytest.approx(expected, abs=1e-15)
        assert margins == [7.0] * found[0] + [-1.0] * (16 - found[0])


def test_the_far_side_is_written_for_the_first_target_and_where_the_target_moves_it(monkeypatch):
    for is_first, is_fixed, named in ((1, 1, 1), (0, 1, 0), (1, 0, 1), (0, 0, 1)):
        *_, calls = filled(monkeypatch, [(2, False, False)], 1, bool(is_first), bool(is_fixed))
        assert [name for name, _ in calls] == ["far_side"] * named + ["near_side", "combine"]
        assert calls[-1][1] == ("B", "F", 7, "S")


def test_targets_are_solved_one_after_the_other_and_the_first_is_told_so(monkeypatch):
    said = [(2, False), (3, True), (kernel.DEGENERATE, True), (4, False)]
    asked = []

    def fill(arm, target, rows, scratch, is_first):
        asked.append((target[0, 0], rows[0, 0], bool(is_first)))
        return said[len(asked) - 1]

    monkeypatch.setattr(kernel, "fill", fill)
    targets = np.arange(4.0)[:, None, None] * np.ones((4, 4))
    rows = 10 * np.arange(4.0)[:, None, None] * np.ones((16, 7))
    counts = np.full((4, 2), np.nan)
    kernel.eliminate(None, targets, rows, counts, None)
    assert counts.tolist() == [[2, 0], [3, 1], [kernel.DEGENERATE, 1], [4, 0]]
    assert asked == [(0, 0, True), (1, 10, False), (2, 20, False), (3, 30, False)]


class Sharpened:
    """`_sharpen` of four at once on f = |(C, S)|^16 sin(x - r), (C, S) half of x, of lines whose gap
    is what is left of the angle, and `apart`.
    """

    def __init__(self, monkeypatch, off, slope=1.0, apart=0.0):
        self.steps = 0
        some = len(off)
        r = 0.7 + 0.1 * np.arange(4)
        r[some:] = r[0]
        scratch = SimpleNamespace(
            found=np.zeros(3 * ROOM), v=np.zeros(48), solved=np.full(52, np.nan), angles=np.zeros(24),
            A=np.zeros(4), M=np.zeros(4)
        )  # fmt: skip
        found = scratch.found.reshape(3, -1, 4)
        half = (r[:some] + np.array(off)) / 2
        self.start = found[:2, 1, :some] = 1.1 * np.array([np.cos(half), np.sin(half)])
        found[2, 1, :some] = slope

        def value(scratch, view, C, S):
            return slope * (C * C + S * S) ** 8 * np.sin(2 * np.arctan2(S, C) - r)

        def joints(one, view, x, y, v, solved):
            self.steps += 1
            left = 2 * np.arctan2(y, x) - r
            for k in range(6):
                solved[2 * k] = np.cos(r + k)
                solved[2 * k + 1] = np.sin(r + k)
            solved[elimination_roots.GAP] = abs(left) + apart
            solved[elimination_roots.GAP][some:] = 1.0

        monkeypatch.setattr(kernel, "lanes", FOUR)
        monkeypatch.setattr(kernel, "determinant", value)
        vector = SimpleNamespace(null_vector=lambda *rest: None)
        monkeypatch.setattr(kernel, "resultant", vector)
        monkeypatch.setattr(kernel, "_joints", joints)
        monkeypatch.setattr(kernel, "atan2", np.arctan2)
        where = SimpleNamespace(where_less=lambda a, b, x, y: np.where(a < b, x, y))
        monkeypatch.setattr(kernel, "elementary", where)
        kernel._sharpen(None, WHOLE, scratch, 4, some)
        self.found = found[:, 1]
        self.left = 2 * np.arctan2(found[1, 1], found[0, 1]) - r
        self.angles = scratch.angles.reshape(6, 4)
        self.r = r
        assert not found[:, [0, 2]].any()


@pytest.mark.parametrize("some", [1, 3, 4])
@pytest.mark.parametrize("slope", [1.0, -3.0])
def test_roots_are_sharpened_until_all_lines_are_close(some, slope, monkeypatch):
    one = Sharpened(monkeypatch, [0.03, -0.02, 0.0, 0.01][:some], slope)
    assert one.steps == 2  # of an error e, some e^3 / 3 is left
    np.testing.assert_allclose(one.left, 0.0, atol=1e-12)
    expected = (one.r + np.arange(6)[:, None] + np.pi) % (2 * np.pi) - np.pi
    np.testing.assert_allclose(one.angles, expected, atol=1e-14)
    # lanes of no root are those of the first
    for part in one.found:
        assert (part[some:] == part[0]).all()


def test_roots_whose_lines_stay_apart_are_sharpened_four_times_and_a_long_step_is_none(monkeypatch):
    for off, moved in (([0.099, 0.0], True), ([0.101, 0.0], False), ([-0.101, 0.0], False)):
        one = Sharpened(monkeypatch, np.arcsin(off), apart=1.0)
        assert one.steps == 4
        if not moved:
            np.testing.assert_array_equal(one.found[:2, 0], one.start[:, 0])
        assert abs(one.left[0]) < 1e-12 or not moved


def test_a_line_that_is_as_far_as_it_may_be_is_close(monkeypatch):
    monkeypatch.setattr(kernel, "_CLOSE", 0.0)
    assert Sharpened(monkeypatch, [0.0, 0.0]).steps == 1


def test_a_root_in_a_view_has_the_joints_of_its_angle():
    arm = chain(4)
    one = kernel._loop(table(arm, 0, 0), arm.fk(np.arange(6.0)), np.empty((6, 6)))
    v = np.linspace(0.2, 1.3, 12)
    seen, whole = np.full(13, np.nan), np.full(13, np.nan)
    c, s, stretch = QUARTER
    x, y = 0.9, 0.4
    kernel._joints(one, QUARTER, x, y, v, seen)
    kernel._joints(one, WHOLE, c * x - s * stretch * y, s * x + c * stretch * y, v, whole)
    np.testing.assert_allclose(seen, whole, atol=1e-13)
    third = 0.6 + 2 * math.atan(stretch * y / x)
    np.testing.assert_allclose(seen[4:6], [math.cos(third), math.sin(third)], atol=1e-15)
