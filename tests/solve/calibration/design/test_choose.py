"""choose_poses: which configurations to measure at."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError, UnknownName
from poekin.solve.calibration import (
    Distances,
    EyeInHand,
    EyeToHand,
    Points,
    Poses,
    calibrate,
    identify,
)
from poekin.solve.calibration.design.choice import Choice, DesignMetrics, _ratio
from poekin.solve.calibration.design.choose import choose_poses
from poekin.solve.calibration.design.exchange import CRITERIA
from poekin.solve.calibration.design.metrics import (
    Design,
    check_enough,
    design_metrics,
    root_information,
)
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be
from tests.messages import says

TOOL = (0.05, 0.0, 0.1)  # off the last axis, so that all of it can be seen


@pytest.fixture(scope="module")
def puma():
    return pk.load("puma560").chain()


@pytest.fixture(scope="module")
def candidates(puma):
    q = puma.random(3, 300)
    q.flags.writeable = False
    return q


def at(where):  # type: ignore[no-untyped-def]
    """The pose without a turn at a place."""
    T = np.eye(4)
    T[:3, 3] = where
    return T


def as_measured(kind, arm, q):  # type: ignore[no-untyped-def]
    """An example of each kind without data, and the same kind measured at q without noise."""
    T = arm.fk(q)
    X, Z = at((0.7, 0.1, 0)), at(TOOL)
    p = (T @ Z)[:, :3, 3]
    if kind == "poses":
        return "poses", Poses(T)
    if kind == "poses in a device's frame":
        return (Poses(x, frame="unknown") for x in (T[:1], T))
    if kind == "point":
        return Points([[0, 0, 0]], points=TOOL), Points(p, points=TOOL)
    if kind == "distance":
        d = np.linalg.norm(p - X[:3, 3], axis=1)
        return (Distances(x, centre=X[:3, 3], point=TOOL) for x in ([1.0], d))
    seen = np.linalg.inv(X) @ T @ Z
    if kind == "eye in hand":
        return (EyeInHand(x, board=X, camera=Z) for x in (seen[:1], seen))
    return (EyeToHand(x, camera=X, board=Z) for x in (seen[:1], seen))


@pytest.mark.parametrize(
    ("name", "tip", "kind"),
    [("puma560", None, "poses"), ("panda", "panda_hand", "point")],
)
def test_thirty_of_2000_beat_the_median_random_choice_by_half_in_the_noise_amplification_index(
    name, tip, kind
):
    arm = pk.load(name).chain(tip=tip)
    example = "poses" if kind == "poses" else Points([[0, 0, 0]], points=TOOL)
    choice = choose_poses(arm, 30, 2000, measurements=example, criterion="amplification")
    assert choice.criterion_improvement >= 1.5
    assert choice.metrics.amplification >= choice.random_best.amplification


@pytest.mark.parametrize("by", CRITERIA)
def test_each_criterion_is_bettered_beyond_the_best_random_choice(puma, candidates, by):
    choice = choose_poses(puma, 20, candidates, criterion=by)
    assert choice.criterion_improvement > 1
    assert choice.criterion_improvement == getattr(choice.improvement, by)
    smaller = by in ("condition", "prediction")
    own, best = (getattr(x, by) for x in (choice.metrics, choice.random_best))
    assert own < best if smaller else own > best
    for name, median, better in zip(
        DesignMetrics._fields, choice.random_median, choice.random_best, strict=True
    ):
        assert better < median if name in ("condition", "prediction") else better > median


@pytest.mark.parametrize(
    "kind",
    ["poses", "poses in a device's frame", "point", "distance", "eye in hand", "eye to hand"],
)
def test_the_indices_are_those_that_identify_finds_once_it_was_measured_there(
    puma, candidates, kind
):
    example, _ = as_measured(kind, puma, candidates)
    choice = choose_poses(puma, 40, candidates, measurements=example)
    _, measured = as_measured(kind, puma, choice.q)
    found = identify(puma, choice.q, measured)
    assert (choice.rank, choice.identifiable) == (found.rank, found.identifiable)
    # rounding of both, times the condition, of which the distances' is 1e3
    for name in DesignMetrics._fields[:4]:
        assert getattr(choice.metrics, name) == pytest.approx(getattr(found, name), rel=1e-9)


def test_the_prediction_is_the_uncertainty_of_the_calibrated_arm_over_all_candidates(
    puma, candidates
):
    choice = choose_poses(puma, 12, candidates, criterion="O1")
    spread = 1e-5 * np.repeat([1.0, puma.reach], 3)  # as large in reaches as in rad
    measured = Poses(puma.fk(choice.q), covariance=np.diag(spread**2))
    covariance = calibrate(puma, choice.q, measured, folds=0).pose_covariance(candidates)
    variances = np.diagonal(covariance, axis1=-2, axis2=-1) / spread**2
    assert np.sqrt(variances.mean()) == pytest.approx(choice.metrics.prediction, rel=1e-6)


def test_several_measurements_at_each_configuration_count_together(puma, candidates):
    both = [Poses(np.eye(4)[None], rows=[7]), Points([[0, 0, 0]], points=TOOL)]
    choice = choose_poses(puma, 20, candidates, measurements=both)
    q = choice.q
    T = puma.fk(q)
    found = identify(puma, q, [Poses(T), Points((T @ at(TOOL))[:, :3, 3], points=TOOL)])
    assert choice.metrics.smallest == pytest.approx(found.smallest, rel=1e-9)


def test_the_random_choices_are_drawn_from_the_same_candidates(puma, candidates):
    everything = choose_poses(puma, 40, candidates[:40])
    assert everything.improvement == pytest.approx((1, 1, 1, 1, 1))
    assert everything.random_median == pytest.approx(everything.random_best)


def test_the_same_arguments_give_the_same_choice_and_rows_say_which(puma, candidates):
    a, b = (choose_poses(puma, 15, candidates, seed=4, n_random=5) for _ in range(2))
    assert a.rows.tolist() == b.rows.tolist() == sorted(set(a.rows.tolist()))
    assert np.array_equal(a.q, candidates[a.rows])
    assert (a.metrics, a.random_median, a.random_best) == (
        b.metrics,
        b.random_median,
        b.random_best,
    )
    c = choose_poses(puma, 15, candidates, seed=5, n_random=5)
    assert (a.metrics, a.random_median) != (c.metrics, c.random_median)
    assert a.metrics == c.metrics  # the seed only draws


def test_a_number_of_candidates_is_drawn_within_the_limits(puma):
    choice = choose_poses(puma, 10, 50, seed=8, n_random=1)
    assert np.array_equal(choice.q, puma.random(8, 50)[choice.rows])


def test_what_no_candidate_shows_is_said_and_the_rest_is_chosen_for(puma, candidates):
    still = candidates.copy()
    still[:, 2] = 0.3
    choice = choose_poses(puma, 20, still)
    assert (choice.rank, choice.identifiable) == (26, 30)
    assert puma.joint_names[2] in str(choice)
    assert "unobserved from any of them" in str(choice)


def test_it_says_in_a_sentence_by_how_much_it_is_better(puma, candidates):
    choice = choose_poses(puma, 20, candidates, criterion="amplification", n_random=7)
    said = str(choice)
    assert said.startswith("20 of 300 configurations for 30 parameters: noise amplification index ")
    assert (
        f"{choice.criterion_improvement:.2f} times better than the median of 7 random choices"
        in said
    )
    assert f"noise leaves {1 / choice.improvement.prediction:.2f} times the error" in said
    assert "noise leaves" not in str(choose_poses(puma, 20, candidates))


def test_chosen_joints_and_parameters_need_fewer_configurations(puma, candidates):
    choice = choose_poses(puma, 1, candidates, parameters="screws", joints=[puma.joint_names[1]])
    assert choice.rank == 4


def test_progress_ends_at_its_total(puma, candidates):
    said: list[tuple[int, int]] = []
    choose_poses(puma, 8, candidates, progress=lambda done, total: said.append((done, total)))
    assert said[-1][0] == said[-1][1]
    assert [done for done, _ in said[:8]] == [1, 2, 3, 4, 5, 6, 7, 8]


@pytest.mark.parametrize("n", [2, 4])
def test_too_few_configurations_for_the_parameters_are_refused_with_how_many_are_needed(
    puma, candidates, n
):
    message = rf"n: {n} configurations of 6 equations each are too few for 30 parameters: expected at least (\d+)"
    with pytest.raises(InputError, match=message) as refused:
        choose_poses(puma, n, candidates)
    needed = int(str(refused.value).split("at least ")[1].split(",")[0])
    assert needed >= 5  # 30 / 6
    assert choose_poses(puma, needed, candidates).metrics.smallest > 0


def test_a_candidate_outside_the_limits_is_refused_with_its_row(puma, candidates):
    name, (lower, upper) = puma.q_names[4], puma.limits[4]
    off = candidates.copy()
    off[17, 4] = upper + 0.01
    said = f"candidates[17]: '{name}' = {upper + 0.01:.6g} is outside its limits {lower:.6g} to {upper:.6g}"
    with pytest.raises(InputError, match=f"^{re.escape(said)}$"):
        choose_poses(puma, 20, off)
    off[20, 4] = lower - 0.01
    with pytest.raises(InputError, match=r"2 of the 300 candidates cannot be taken"):
        choose_poses(puma, 20, off)
    off[20] = np.nan
    with pytest.raises(InputError, match=r"candidates\[2, 0\]: expected a finite number, got nan"):
        choose_poses(puma, 2, off[18:])


WRONG = {
    "no-arm": (
        {"chain": "puma560"},
        InputError,
        "chain: expected a Chain, as Robot.chain(tip=...) makes it, got 'puma560'",
    ),
    "n-zero": ({"n": 0}, InputError, "n: expected a whole number from 1 on, got 0"),
    "n-bool": ({"n": True}, InputError, "n: expected a whole number from 1 on, got True"),
    "n-above": ({"n": 301}, InputError, "n: expected at most the 300 candidates, got 301"),
    "n_random": ({"n_random": 0}, InputError, "n_random: expected a whole number from 1 on, got 0"),
    "seed": ({"seed": -1}, InputError, "seed: expected a whole number from 0 on, got -1"),
    "criterion": (
        {"criterion": "E"},
        InputError,
        "criterion: expected 'prediction', 'O1', 'amplification', 'condition' or 'smallest', got 'E'",
    ),
    "none": (
        {"candidates": None},
        ShapeError,
        "candidates: expected configurations (K, 6), or how many to draw, got None",
    ),
    "zero": (
        {"candidates": 0},
        ShapeError,
        "candidates: expected configurations (K, 6), or how many to draw, got 0",
    ),
    "one": (
        {"candidates": np.zeros(6)},
        ShapeError,
        "candidates: expected configurations (K, 6), or how many to draw, got array([0., 0., 0., 0., 0., 0.])",
    ),
    "many": (
        {"candidates": np.zeros((1, 2, 6))},
        ShapeError,
        "candidates: expected configurations (K, 6), or how many to draw, got array([[[0., 0., 0., 0., 0., 0.],...",
    ),
    "text": (
        {"candidates": "home"},
        ShapeError,
        "candidates: expected configurations (K, 6), or how many to draw, got 'home'",
    ),
    "real": (
        {"candidates": 7.5},
        ShapeError,
        "candidates: expected configurations (K, 6), or how many to draw, got 7.5",
    ),
    "ragged": (
        {"candidates": [[1, 2], [3]]},
        ShapeError,
        "candidates: expected an array of numbers, got rows of different lengths",
    ),
    "joints": (
        {"candidates": np.zeros((9, 7))},
        ShapeError,
        (
            "candidates: expected 6 coordinates on the last axis ('joint1', 'joint2', 'joint3', "
            "'joint4', 'joint5', 'joint6'), got shape (9, 7)"
        ),
    ),
    "kind": (
        {"measurements": "angles"},
        InputError,
        (
            "measurements: expected 'poses', 'points', or an example of Poses, Points, "
            "Distances, EyeInHand or EyeToHand, or a list of them, got 'angles'"
        ),
    ),
    "no-kind": (
        {"measurements": []},
        InputError,
        (
            "measurements: expected 'poses', 'points', or an example of Poses, Points, "
            "Distances, EyeInHand or EyeToHand, or a list of them, got []"
        ),
    ),
    "no-board": (
        {"measurements": EyeInHand(np.eye(4)[None], camera=np.eye(4))},
        InputError,
        "measurements: EyeInHand: expected board=, roughly where it is: nothing is measured yet",
    ),
    "no-centre": (
        {"measurements": Distances([1.0])},
        InputError,
        "measurements: Distances: expected centre=, roughly where it is: nothing is measured yet",
    ),
    "joint": (
        {"joints": ["elbow"]},
        UnknownName,
        "joints: no joint 'elbow'; available: 'joint1', 'joint2', 'joint3', 'joint4', 'joint5' and 1 more",
    ),
    "parameters": (
        {"parameters": ["axes"]},
        InputError,
        "parameters: expected some of 'screws', 'home', 'offsets', 'gains', 'pitch', 'compliance',"
        " 'coupling', 'harmonics', 'second harmonics', 'backlash', 'lag', 'drift', got 'axes'",
    ),
}


@pytest.mark.parametrize(("changed", "error", "message"), WRONG.values(), ids=WRONG)
def test_what_cannot_be_chosen_from_is_refused(puma, candidates, changed, error, message):
    given = {"chain": puma, "n": 20, "candidates": candidates} | changed
    with pytest.raises(error) as caught:
        choose_poses(**given)
    assert says(caught.value, message)


@pytest.mark.parametrize(
    ("a", "b", "ratio"),
    [
        (6.0, 3.0, 2.0),
        (1.0, 0.0, np.inf),
        (1.0, np.inf, 0.0),
        (0.0, 0.0, 1.0),
        (np.inf, 3.0, np.inf),
    ],
)
def test_a_random_choice_that_shows_nothing_is_beaten_without_end(a, b, ratio):
    assert _ratio(a, b) == ratio


def design(blocks):  # type: ignore[no-untyped-def]
    """A design of these blocks, with nothing measured before, that predicts what it measures."""
    return Design(blocks, blocks[:0], root_information(blocks))


def shows(*directions, size=3, times=2):
    """A design of candidates each of which sees one direction, in several rows."""
    blocks = np.zeros((len(directions), times, size))
    blocks[np.arange(len(directions)), :, directions] = 1.0
    return design(blocks)


@pytest.mark.parametrize("n", [1, 4])
def test_configurations_are_needed_until_all_that_is_seen_anywhere_is_seen(n):
    """Of five directions, each candidate sees one."""
    with pytest.raises(InputError, match="expected at least 5, better three times as many"):
        check_enough(shows(0, 1, 2, 3, 4, 0, size=5), n)


@pytest.mark.parametrize("n, needed", [(1, 3), (2, 3), (3, None)])
def test_as_many_configurations_are_needed_as_show_the_last_direction(n, needed):
    blocks = shows(0, 0, 1, 2, 1)
    if needed is None:
        check_enough(blocks, n)
    else:
        with pytest.raises(InputError, match=f"n: {n} configurations of 2 equations each are too few for 3 parameters: "
                           f"expected at least {needed}, better three times as many"):  # fmt: skip
            check_enough(blocks, n)


def test_a_choice_that_leaves_a_direction_unseen_is_worth_nothing():
    assert design_metrics(design(np.zeros((4, 3, 3))), np.array([0, 1])) == (
        0,
        np.inf,
        0,
        0,
        np.inf,
    )
    blocks = shows(0, 0, 1, 2)
    for rows in ([0], [0, 1], [0, 2], [1, 2]):
        assert design_metrics(blocks, np.array(rows)) == (0, np.inf, 0, 0, np.inf)
    found = design_metrics(blocks, np.array([0, 2, 3]))
    # Each direction is seen twice: singular values of sqrt(2), and what two numbers tell is known
    # to sqrt(1/2) of one.
    assert found.condition == pytest.approx(1)
    assert found.smallest == pytest.approx(np.sqrt(2))
    assert found.prediction == pytest.approx(np.sqrt(0.5))


def test_a_choice_says_its_figure_the_median_s_and_the_best_s_and_what_noise_leaves():
    own, median, best = (
        DesignMetrics(1.0, 20.0, 0.3, 0.04, 5.0),
        DesignMetrics(0.5, 60.0, 0.1, 0.01, 9.0),
        DesignMetrics(6, 7, 8, 9, 10),
    )
    choice = Choice(
        np.zeros((3, 2)),
        np.arange(3),
        "condition",
        own,
        median,
        best,
        12,
        13,
        ("'a' alone", "'b'"),
        40,
        7,
    )
    assert choice.improvement == pytest.approx((2, 3, 3, 4, 1.8))
    assert str(choice) == (
        "3 of 40 configurations for 12 parameters: condition 20, 3.00 times better than the median of 7 random choices "
        "(60, the best of them 7); noise leaves 0.56 times the error in the calibrated arm that it leaves after those; "
        "unobserved from any of them: 'a' alone; unobserved from any of them: 'b'"
    )


@pytest.mark.parametrize("kind", dataclasses_of("poekin.solve.calibration.design", "choice"))
def test_a_choice_cannot_be_changed_and_is_equal_to_itself_alone(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)


def test_where_nothing_is_said_a_hundred_random_choices_are_drawn_by_the_seed_0():
    arm = pk.Chain.from_space(
        [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.revolute([0, 1, 0], [0.3, 0, 0.5])],
        at(TOOL),
    )
    q = np.random.default_rng(0).uniform(-1, 1, (20, 2))
    said: tuple[dict[str, Any], ...] = (
        {},
        {"n_random": 100, "seed": 0, "criterion": "prediction"},
        {"seed": 1},
    )
    found, same, other = (choose_poses(arm, 6, q, **options) for options in said)
    assert (found.n_random, found.criterion) == (100, "prediction")
    assert (found.metrics, found.random_median, found.random_best) == (
        same.metrics,
        same.random_median,
        same.random_best,
    )
    assert found.random_median != other.random_median


def test_the_metrics_count_the_configurations_that_were_measured_before():
    seen = shows(0, 1, 2)
    found = design_metrics(seen._replace(before=seen.blocks[:1]), np.arange(3))
    # sums of squares 4, 2 and 2 over 3 + 1 configurations: O1 = (2 √2 √2)^(1/3) / √4
    expected = 4 ** (1 / 3) / 2
    assert found[0] == pytest.approx(expected, rel=1e-12)
