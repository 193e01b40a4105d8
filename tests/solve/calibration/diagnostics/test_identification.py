"""What measurements can tell is counted rightly, and what they cannot is named."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError
from poekin.solve.calibration import Distances, EyeInHand, Points, Poses, calibrate, identify
from poekin.solve.calibration.diagnostics import identification
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.problem import Problem
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be

CHAINS = ("R", "RR", "RRR", "RRRRRR", "RRRRRRR", "RRP", "PPP", "RRPR", "RPRPRR")
PUMA = pk.load("puma560").chain()
PANDA = pk.load("panda").chain(tip="panda_link8")
POINT = (0.11, -0.07, 0.23)


def random_chain(letters: str, seed: int) -> pk.Chain:
    """Axes anywhere, with no two alike."""
    rng = np.random.default_rng(seed)
    A = []
    for letter in letters:
        axis, point = rng.normal(size=3), rng.uniform(-1, 1, 3)
        A.append(pk.screw.revolute(axis, point) if letter == "R" else pk.screw.prismatic(axis))
    return pk.Chain.from_space(A, pk.se3.exp(rng.normal(size=6)))


@pytest.mark.parametrize("letters", CHAINS)
@settings(max_examples=10)
@given(seed=st.integers(0, 2**32 - 1))
def test_rank_is_4r_2p_6_from_poses_and_4r_2p_3_from_one_point(letters, seed):
    arm = random_chain(letters, seed)
    q = np.random.default_rng(seed).uniform(-2, 2, (40, arm.dof))
    least = 4 * letters.count("R") + 2 * letters.count("P")
    T = arm.fk(q)
    full, point = identify(arm, q, Poses(T)), identify(arm, q, Points(T[:, :3, 3], POINT))
    assert (full.rank, full.identifiable, full.size) == (least + 6,) * 3
    assert (point.rank, point.identifiable, point.size) == (least + 3, least + 3, least + 6)
    assert full.unidentifiable == full.unobserved == point.unobserved == ()
    assert np.isfinite([full.condition, point.condition]).all()


def test_offsets_tell_nothing_that_the_screws_do_not():
    q = PUMA.random(0, 40)
    found = identify(PUMA, q, PUMA.fk(q), parameters=("screws", "home", "offsets"))
    assert (found.size, found.rank, found.identifiable) == (36, 30, 30)
    alone = identify(PUMA, q, PUMA.fk(q), parameters=("offsets",))
    assert (alone.size, alone.rank) == (6, 6)


@pytest.mark.parametrize("kinds, count", [
    ((Poses,), 15), ((Points,), 30), ((Poses, Points), 10), ((Poses, Points, Points), 8), ((Poses, Distances), 13),
])  # fmt: skip
def test_what_can_be_known_is_looked_for_at_so_many_configurations_that_each_parameter_has_three_equations(
    kinds, count, monkeypatch
):
    looked = []
    anywhere = identification._random_configurations

    def noted(chain, count):
        looked.append(count)
        return anywhere(chain, count)

    monkeypatch.setattr(identification, "_random_configurations", noted)
    T = PUMA.fk(PUMA.random(0, 2))  # too few: the rest is looked for elsewhere
    make = {
        Poses: lambda: Poses(T),
        Points: lambda: Points(T[:, :3, 3]),
        Distances: lambda: Distances([2.0, 2.0], centre=[2.0, 0.0, 0.0]),
    }
    found = identify(PUMA, PUMA.random(0, 2), [make[kind]() for kind in kinds])
    assert found.size == 30
    assert looked == [count]


def test_gains_and_pitches_are_seen():
    q = PUMA.random(0, 40)
    found = identify(PUMA, q, PUMA.fk(q), parameters=("screws", "home", "gains", "pitch"))
    assert (found.size, found.rank) == (42, 42)


def test_what_a_point_never_sees_is_held_and_named():
    q = PUMA.random(0, 40)
    found = identify(PUMA, q, PUMA.fk(q)[:, :3, 3])
    assert found.rank == found.identifiable == 21
    assert "home: turn about x, turn about y, turn about z" in found.unidentifiable
    assert found.unobserved == ()


def test_camera_and_board_take_up_what_the_arm_shares_with_them():
    q = PANDA.random(0, 40)
    found = identify(PANDA, q, EyeInHand(PANDA.fk(q)))
    assert (found.size, found.rank, found.identifiable) == (46, 34, 34)
    assert len(found.unidentifiable) == 1
    assert "T_base_board and T_tip_camera may move, the arm does not" in found.unidentifiable[0]


@pytest.mark.parametrize(
    ("at", "words"), [(0.0, "all 4 parameters of panda_joint4 "), (-1.0, "4 combined changes of ")]
)
def test_a_joint_that_did_not_move_is_named_with_a_camera_too(at, words):
    q = PANDA.random(0, 40)
    q[:, 3] = at
    found = identify(PANDA, q, EyeInHand(PANDA.fk(q)))
    assert (found.rank, found.identifiable) == (30, 34)
    assert len(found.unobserved) == 1
    assert found.unobserved[0].startswith(words)
    assert found.unobserved[0].endswith("(panda_joint4 is the same in all readings)")


def test_a_joint_that_did_not_move_is_named():
    q = PUMA.random(0, 40)
    q[:, 4] = 0.0
    found = identify(PUMA, q, PUMA.fk(q))
    assert (found.rank, found.identifiable) == (26, 30)
    assert found.unobserved == ("all 4 parameters of joint5 (joint5 is the same in all readings)",)


def test_a_joint_held_at_an_angle_is_named_among_those_it_moves_with():
    q = PUMA.random(0, 40)
    q[:, 2] = 0.4
    found = identify(PUMA, q, PUMA.fk(q))
    assert found.rank == 26
    assert "joint3" in " ".join(found.unobserved)


@pytest.mark.parametrize(
    ("measured", "words"),
    [
        (
            lambda q: PUMA.fk(q),
            r"24 equations for 30 identifiable parameters: measure at least 30",
        ),
        (lambda q: PUMA.fk(q)[:, :3, 3], r"12 equations for 21 identifiable parameters"),
        (lambda q: Distances(np.ones(4), [1, 1, 0]), r"4 equations for 18 identifiable parameters"),
    ],
    ids=["poses", "points", "distances"],
)
def test_too_few_measurements_are_refused_with_how_many_it_takes(measured, words):
    q = PUMA.random(0, 4)
    with pytest.raises(InputError, match=words):
        calibrate(PUMA, q, measured(q), folds=0)


def test_what_is_not_seen_is_refused_by_name_or_held_when_asked():
    true = PUMA.retooled(pk.se3.exp([1e-3, 0, 2e-3, 0, 1e-3, 0]))
    q = PUMA.random(0, 40)
    q[:, 4] = 0.0
    with pytest.raises(
        InputError,
        match=(
            r"^these measurements identify 26 of 30 parameters\. Unobserved: all 4 parameters of joint5 "
            r"\(joint5 is the same in all readings\)\. Measure with these joints in more positions, "
            r"or estimate the rest only with on_rank_deficiency='fix'$"
        ),
    ):
        calibrate(PUMA, q, true.fk(q))
    found = calibrate(PUMA, q, true.fk(q), on_rank_deficiency="fix", folds=0)
    assert found.success
    np.testing.assert_allclose(found.chain.fk(q), true.fk(q), rtol=0, atol=1e-12)
    np.testing.assert_allclose(found.chain.screws[4], PUMA.screws[4], rtol=0, atol=1e-12)


def test_the_condition_does_not_depend_on_units_of_the_arm():
    scale = np.array([1, 1, 1, 1e3, 1e3, 1e3])
    home = PUMA.home.copy()
    home[:3, 3] *= 1e3
    # reach is at least 1 m: of two large arms one is a thousand times the other
    large = pk.Chain.from_space(PUMA.screws * scale, home)
    larger_home = home.copy()
    larger_home[:3, 3] *= 1e3
    larger = pk.Chain.from_space(PUMA.screws * [1, 1, 1, 1e6, 1e6, 1e6], larger_home)
    q = PUMA.random(0, 30)
    a, b = identify(large, q, large.fk(q)), identify(larger, q, larger.fk(q))
    np.testing.assert_allclose(a.singular_values, b.singular_values, rtol=1e-9)


def test_what_is_seen_and_what_is_left_span_all_directions():
    J = np.array([[3.0, 0, 0, 0], [0, 2, 0, 0], [0, 0, 1e-7, 0]])
    for least, rank in ((1e-9, 3), (1e-6, 2)):
        for rows in (J, np.concatenate([J, J, J])):
            s, seen = identification.row_space(rows, least)
            assert seen.shape == (4, rank)
            np.testing.assert_allclose(s[0], np.linalg.norm(rows, 2))
            left = identification._complement(seen)
            both = np.concatenate([seen, left], axis=1)
            np.testing.assert_allclose(both.T @ both, np.eye(4), atol=1e-12)
            np.testing.assert_allclose(np.abs(left[3]).max(), 1, atol=1e-12)
    assert identification.row_space(np.zeros((3, 4)), 1e-9).basis.shape == (4, 0)
    assert identification.row_space(np.zeros((0, 4)), 1e-9).basis.shape == (4, 0)
    np.testing.assert_array_equal(identification._complement(np.zeros((4, 0))), np.eye(4))
    assert identification._complement(np.eye(4)).shape == (4, 0)


def test_a_span_is_of_the_directions_that_most_point_in():
    N = np.array([[1.0, 1, 0], [0, 1e-9, 0], [0, 0, 0.5]])
    for count, expected in ((2, [0, 2]), (1, [0]), (0, []), (-1, [])):
        span = identification._span(N, count)
        assert span.shape == (3, len(expected))
        assert np.abs(span).argmax(axis=0).tolist() == expected


def test_where_a_frame_moves_with_the_arm_the_frame_gives_way():
    shared = np.array([1.0, 0, 0, 1]) / np.sqrt(
        2
    )  # of two parameters of the arm and two of a frame

    class Small:
        size, model_size = 4, 2

    problem: Any = Small()
    free = identification._free(problem, shared[:, None])
    assert free.shape == (4, 3)
    np.testing.assert_allclose(free.T @ free, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(np.abs(free[0]).max(), 0, atol=1e-5)
    np.testing.assert_allclose(np.linalg.norm(free[1:], axis=1), 1, atol=1e-5)


def test_what_is_told_is_a_row_for_each_known_parameter_and_anywhere_every_coordinate_moves():
    class Three:
        size = 3

    three: Any = Three()
    assert identification._prior_rows(three, None).shape == (0, 3)
    np.testing.assert_array_equal(
        identification._prior_rows(three, np.array([True, False, True])), np.eye(3)[[0, 2]]
    )
    q = identification._random_configurations(PUMA, 50)
    assert q.shape == (50, 6)
    assert (np.ptp(q, axis=0) > np.pi).all()
    assert len(np.unique(q)) == 300


@pytest.mark.parametrize(
    "kind", dataclasses_of("poekin.solve.calibration.diagnostics", "identification")
)
def test_an_identification_cannot_be_changed_and_is_equal_to_itself_alone(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)


def test_where_a_fit_ended_as_many_directions_are_seen_as_the_matrix_has_independent_columns():
    q = PUMA.random(0, 20)
    for still, count in ((False, 30), (True, 26)):
        if still:
            q[:, 2] = 0.3
        problem = Problem(ErrorModel(PUMA, ("screws", "home"), None), q, [Poses(PUMA.fk(q))])
        p = np.zeros(problem.size)
        assert (
            identification.rank_at(problem, p)
            == identification.free_directions_at(problem, p).shape[1]
            == count
        )
        assert (
            identification.identify_directions(problem)[0].rank
            == np.linalg.matrix_rank(identification.identification_matrix(problem))
            == count
        )


def test_an_identification_says_its_figures_and_then_what_is_held_and_what_is_not_seen():
    found = identification.Identification(
        7, 6, 5, 42, ("'a' alone", "'b'"), ("c", "d"), np.ones(5), 3.0, 0.5, 0.25, 0.125
    )
    assert str(found) == (
        "42 equations for 6 identifiable parameters: rank 5 of 6, condition 3, smallest singular "
        "value 0.5, O1 0.25, noise amplification index 0.125\n"
        "unidentifiable from measurements of this kind, fixed: 'a' alone\n"
        "unidentifiable from measurements of this kind, fixed: 'b'\n"
        "unobserved by these measurements: c\n"
        "unobserved by these measurements: d"
    )
    assert "array" not in repr(found)
