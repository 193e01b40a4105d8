"""What emitted inverse kinematics says and declares, its self-test's targets, and what is refused."""

from __future__ import annotations

import re

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.formats import emit
from poekin.formats.emit.ik import ik_vectors
from poekin.formats.emit.ik.c_ik_selftest import selftest
from poekin.formats.emit.ik.closed_arm import closed_arm
from poekin.formulas.inverse import confirmed

# a lift with a turning table: of q = (u, v) the pose turns by u and is at height v
LIFT = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.prismatic([0, 0, 1])],
    pk.se3.exp([0, 0, 0, 0.5, 0, 0]),
    base="floor",
    tip="plate",
)
PUMA = pk.load("puma560").chain()
GENERAL = pk.Chain.from_space(
    [pk.screw.revolute(a, p) for a, p in np.random.default_rng(1).normal(size=(6, 2, 3))],
    np.eye(4),
)


@pytest.fixture(scope="module")
def source():
    return emit.c_ik(LIFT, name="Lift", origin="lift.toml")


def test_the_header_says_whose_solutions_they_are_and_how_they_are_asked_for(source):
    family = closed_arm(LIFT).family
    rows = closed_arm(LIFT).rows
    lines = [line.removeprefix("/*").strip(" */") for line in source.header.split("\n")]
    said = [line for line in lines if line]
    for line in [
        "lift_ik: all solutions of the inverse kinematics of one arm. Generated: change the arm instead.",
        "Base frame 'floor', tip frame 'plate'. Units: rad, m.",
        f"In closed form: {family}. Each solution is held against the arm's own pose.",
    ]:
        assert line in " ".join(said), line
    assert "lift.toml" in source.header
    assert f"#define LIFT_IK_MOST {rows}\n" in source.header
    assert "int lift_ik(const double T[16], double q[LIFT_IK_MOST][2]);\n" in source.header
    assert "LIFT_IK_H_INCLUDED" in source.header
    assert list(source.files) == ["lift_ik.h", "lift_ik.c", "lift_ik_selftest.c"]


def test_each_file_begins_with_the_same_words_and_has_room_for_all_branches(source):
    head = source.header[: source.header.index("*/") + 2]
    assert source.source.startswith(head)
    rows = closed_arm(LIFT).rows
    body = source.source[source.source.rindex("int lift_ik(") :]
    # a branch: 2 coordinates, 2 cosines, 2 sines and a margin; work: (2 + 8) rows of 2
    assert f"double branches[{7 * rows}], pose[16], work[20];" in body
    assert f"k < {rows}; k++)" in body
    assert "branches[7 * k + 6] = -1.0;" in body
    assert '#include "lift_ik.h"\n\n#include <math.h>\n' in source.source


def test_what_the_header_does_not_declare_is_of_this_file_alone(source):
    # Two arms in one program would otherwise be linked with each other's functions.
    defined = re.findall(r"^(?!static )(?:const )?\w+ \**(\w+)\(", source.source, re.MULTILINE)
    assert defined == ["lift_ik"]


@pytest.mark.parametrize(("near", "outside"), [(None, "OUTSIDE"), (LIFT, "OUTSIDE_NEARBY")])
def test_sizes_are_periods_then_reach_then_the_margin_that_is_let_in(near, outside):
    text = emit.c_ik(LIFT, near=near, name="lift").source
    table = re.findall(r"lift_ik_sizes\[4\] = \{(.*?)\}", text, re.DOTALL)[0]
    wanted = [2 * np.pi, 0.0, LIFT.reach, getattr(confirmed, outside)]
    assert [float(x) for x in table.split(",") if x.strip()] == wanted


def test_an_arm_nearby_of_another_size_is_refused():
    with pytest.raises(InputError) as said:
        emit.c_ik(LIFT, near=PUMA)
    assert str(said.value) == "near: expected an arm with 2 coordinates, got one with 6"


def test_targets_are_clear_of_double_solutions_and_the_last_is_away():
    form = closed_arm(PUMA)
    sizes = np.append(np.full(6, 2 * np.pi), [PUMA.reach, confirmed.OUTSIDE])
    found = ik_vectors.targets(PUMA, form, sizes)
    assert found.T.shape == (9, 4, 4)
    assert len(found.solutions) == 9
    for T, q in zip(found.T[:-1], found.solutions[:-1], strict=True):
        assert len(q) > 0
        # rounding of 1e-14 of the reach by a least singular value above 1e-3
        assert np.abs(PUMA.fk(q) - T).max() <= 1e-11
        J = PUMA.jacobian(q, "hybrid")
        J[:, 3:] /= PUMA.reach
        assert np.linalg.svd(J, compute_uv=False).min() > 1e-3
        margins = form.branches(T)[:, -1]
        assert np.nanmin(np.abs(margins)) > 1e-3
    home = PUMA.fk(np.zeros(6))
    np.testing.assert_allclose(
        found.T[-1] - home, 4 * PUMA.reach * np.outer(np.eye(4)[0], np.eye(4)[3]), atol=1e-14
    )
    assert found.solutions[-1].shape == (0, 6)


@pytest.mark.parametrize(("count", "kept"), [(0, 1), (1, 0)])
def test_where_solutions_meet_the_target_away_is_kept_only_if_it_has_none(count, kept, monkeypatch):
    class Meeting:
        """A form all of whose solutions meet in two."""

        def branches(self, T):
            return np.zeros((1, 3))

    monkeypatch.setattr(ik_vectors, "solutions", lambda *_: np.zeros((count, 2)))
    found = ik_vectors.targets(LIFT, Meeting(), np.array([2 * np.pi, 0.0]))  # type: ignore[arg-type]
    assert len(found.T) == len(found.solutions) == kept


def test_targets_are_drawn_within_half_a_turn_and_a_metre():
    sizes = np.array([2 * np.pi, 0.0, LIFT.reach, confirmed.OUTSIDE])
    drawn = np.concatenate(ik_vectors.targets(LIFT, closed_arm(LIFT), sizes).solutions)
    angles, heights = np.transpose(drawn)
    assert len(set(angles)) == len(set(heights)) == 8
    # none of eight is beyond a quarter with a chance of 4^-8
    assert 0.25 * np.pi < np.abs(angles).max() <= np.pi
    assert 0.25 < np.abs(heights).max() <= 1.0


def test_what_selects_solutions_has_as_much_room_as_the_emitted_program_gives_it(monkeypatch):
    form = closed_arm(LIFT)
    body = emit.c_ik(LIFT, name="lift").source
    assert f"branches[{form.rows * 7}], pose[16], work[{(2 + 8) * 2}]" in body
    shapes = []

    def select(forward, placed, *arrays):
        shapes.extend(a.shape for a in arrays)
        return 0

    monkeypatch.setattr(confirmed, "select", select)
    ik_vectors.solutions(LIFT, form, np.array([2 * np.pi, 0.0, 1.0, 0.0]), np.eye(4))
    assert shapes == [(4, 4), (form.rows, 3), (4,), (4, 4), (2 + 8, 2), (form.rows, 2)]


class Margins:
    """A form with branches of these margins, and one that is not filled in."""

    def __init__(self, *margins):
        self.rows = np.array([*([0.0] * 6 + [margin] for margin in margins), [np.nan] * 7])

    def branches(self, T):
        return self.rows


@pytest.mark.parametrize("turned", range(3))
def test_a_target_is_clear_where_the_least_singular_value_over_the_reach_is_above_a_thousandth(
    turned,
):
    arm = PUMA.rebased(pk.se3.exp([*(0.5 * np.pi * np.eye(3)[turned]), 0, 0, 0]))
    form = Margins(1.0, -1.0)
    rng = np.random.default_rng(2)
    found, wanted = [], []
    for row in rng.uniform(-3, 3, (300, 6)):
        row[4] = rng.uniform(0, 0.01)  # the wrist is stretched where that is 0
        J = arm.jacobian(row, "hybrid") / np.repeat([1.0, arm.reach], 3)[:, None]
        least = np.linalg.svd(J, compute_uv=False).min()
        if abs(least - 1e-3) > 1e-12:  # rounding decides nearer than that
            wanted.append(least > 1e-3)
            found.append(ik_vectors._is_clear(arm, form, np.eye(4), row[None]))  # type: ignore[arg-type]
    assert found == wanted
    assert 0 < sum(wanted) < len(wanted)


@pytest.mark.parametrize("sign", [1, -1])
def test_a_target_is_clear_where_each_margin_is_above_a_thousandth_on_either_side(sign):
    q = np.full((1, 6), 0.5)
    for margin, clear in ((1.01e-3, True), (1e-3, False), (0.99e-3, False)):
        for margins in ((1.0, sign * margin), (sign * margin, -1.0)):
            form = Margins(*margins)
            assert ik_vectors._is_clear(PUMA, form, np.eye(4), q) == clear  # type: ignore[arg-type]


def test_the_self_test_has_the_targets_counts_and_solutions_in_its_tables():
    T = np.arange(48.0).reshape(3, 4, 4)
    q = [np.array([[1.5, 2.5], [3.5, 4.5]]), np.empty((0, 2)), np.array([[5.5, 6.5]])]
    text = selftest("some_ik", np.array([7.25, 0.0]), ik_vectors.Targets(T, q))
    for line in [
        "#define TARGETS 3", "#define ALLOWED 1e-09", "COUNTS[TARGETS] = {2, 0, 1};",
        "EXPECTED[3][2] = {", "PERIODS[2] = {7.25, 0.0};", "double q[SOME_IK_MOST][2], worst",
        "Tests some_ik.c: compile both", '#include "some_ik.h"', "error allowed, 1e-09 (rad or m)",
        'printf("some_ik: worst error %.3g, allowed %.3g: %s\\n"', "const int count = some_ik(T_GIVEN[k], q);",
    ]:  # fmt: skip
        assert line in text, line
    tables = [
        [float(x) for x in re.findall(r"\d+\.\d*", table)]
        for table in re.findall(r"(?:T_GIVEN|EXPECTED)\S+ = \{\n(.*?)\n\};", text, re.DOTALL)
    ]
    assert tables == [T.ravel().tolist(), [1.5, 2.5, 3.5, 4.5, 5.5, 6.5]]
    none = selftest("some_ik", np.array([7.25, 0.0]), ik_vectors.Targets(T[:1], q[1:2]))
    assert "COUNTS[TARGETS] = {0};" in none
    assert "EXPECTED[1][2] = {\n    {0.0, 0.0}" in none


def joints(count):
    return pk.Chain.from_space([LIFT.screws[0]] * count, np.eye(4), base="a", tip="b")


@pytest.mark.parametrize(
    ("arm", "said"),
    [
        (joints(0), "emit: expected an arm of one to six joints for its inverse kinematics,"
         " 'a' -> 'b' has 0 coordinates"),
        (joints(7), "emit: expected an arm of one to six joints for its inverse kinematics,"
         " 'a' -> 'b' has 7 coordinates"),
        (GENERAL.replace(base="a", tip="b"), "emit: 'a' -> 'b' has no closed form that is known here:"
         " no three neighbouring axes meet in a point, and no three are parallel (or move in a plane)."
         " Chain.idealised makes rounded geometry exact; near= takes an arm nearby that has a closed"
         " form; ik_all solves any arm, in Python"),
        (LIFT.replace(screws=[LIFT.screws[0], pk.screw.helical([0, 0, 1], [0, 0, 0], 0.1)],
                      joint_names=["turn", "wind"]),
         "emit: expected revolute and prismatic joints only for the inverse kinematics,"
         " 'wind' is helical"),
    ],
    ids=["no joint", "seven", "general", "helical"],
)  # fmt: skip
def test_what_has_no_closed_form_is_refused_with_its_frames_and_the_reason(arm, said):
    with pytest.raises(InputError) as caught:
        closed_arm(arm)
    assert str(caught.value) == said


@pytest.mark.parametrize("count", [1, 6])
def test_of_one_joint_and_of_six_a_closed_form_is_known(count):
    whole = pk.load("ur5e").chain()
    arm = pk.Chain.from_space(whole.screws[-count:], whole.home)
    form = closed_arm(arm)
    assert form.columns == count + 1
    assert form.branches(arm.fk(np.full(count, 0.3))).shape[1] == count + 1
