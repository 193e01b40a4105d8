"""choose_poses: where measuring is possible, what was measured before, and where errors count."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.solve.calibration import EyeToHand, Points, Poses, WorkspaceBox, identify
from poekin.solve.calibration.design import candidates as drawing
from poekin.solve.calibration.design.candidates import drawn, parse_workspace

HOME = pk.se3.exp([0, 0, 0, 0.9, 0, 0.8])  # of a reach beyond 1 m
ARM = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.revolute([0, 1, 0], [0.3, 0, 0.5])],
    HOME,
    limits=[[-2, 2], [-1, 1]],
)
Q = ARM.random(5, 40)
choose: Any = pk.choose_poses


def right(q, T):  # type: ignore[no-untyped-def]
    """Configurations with a first joint that turns to the right."""
    return q[:, 0] < 0


def test_only_what_all_predicates_allow_is_chosen_and_rows_are_those_of_all_candidates():
    box = WorkspaceBox([-2, -2, 0.2], [2, 2, 2])
    choice = choose(ARM, 5, Q, allowed=[right, box], n_random=3)
    allowed = (Q[:, 0] < 0) & (ARM.fk(Q)[:, 2, 3] >= 0.2)
    assert set(choice.rows.tolist()) <= set(np.flatnonzero(allowed).tolist())
    assert np.array_equal(choice.q, Q[choice.rows])
    assert choice.candidates == allowed.sum() < np.sum(Q[:, 0] < 0)
    alone = choose(ARM, 5, Q[allowed], n_random=3)
    assert np.array_equal(alone.q, choice.q)
    assert alone.metrics == choice.metrics


def test_as_many_candidates_as_are_asked_for_are_drawn_where_predicates_allow():
    choice = choose(ARM, 5, 30, allowed=right, n_random=3, seed=4)
    assert choice.candidates == 30
    assert (choice.q[:, 0] < 0).all()
    rng = np.random.default_rng(4)
    q = np.concatenate([ARM.random(rng, 30) for _ in range(4)])
    assert np.array_equal(choice.q, q[q[:, 0] < 0][choice.rows])


@pytest.mark.parametrize("criterion", ["prediction", "O1", "smallest"])
def test_beside_measured_configurations_the_metrics_are_of_both(criterion):
    before = Q[:7]
    choice = choose(ARM, 2, Q[7:], measured=before, criterion=criterion, n_random=50)
    q = np.concatenate([choice.q, before])
    found = identify(ARM, q, Poses(ARM.fk(q)))
    assert choice.measured == 7
    # sums of a hundred products, of a condition of 10
    for name in ("O1", "condition", "smallest", "amplification"):
        assert getattr(choice.metrics, name) == pytest.approx(getattr(found, name), rel=1e-9)
    assert choice.criterion_improvement > 1
    assert "2 of 33 configurations beside 7 measured ones for 14 parameters" in str(choice)


def test_no_other_pair_beside_the_measured_ones_predicts_better():
    before, few = Q[:4], Q[4:12]
    choice = choose(ARM, 2, few, measured=before, workspace=Q, n_random=1)
    variances = []
    for i in range(8):
        for j in range(i):
            q = np.concatenate([before, few[[i, j]]])
            variances.append((variance(q), {i, j}))
    least, pair = min(variances, key=lambda v: v[0])
    assert set(choice.rows.tolist()) == pair
    assert choice.metrics.prediction == pytest.approx(np.sqrt(least), rel=1e-6)


def variance(q, where=Q, noise=1e-5):  # type: ignore[no-untyped-def]
    """Mean variance of the poses, in units of the noise, that a calibration predicts."""
    sigma = noise * np.repeat([1.0, ARM.reach], 3)
    measured = Poses(ARM.fk(q), covariance=np.diag(sigma**2))
    C = pk.calibrate(ARM, q, measured, folds=0).pose_covariance(where)
    return np.mean(np.diagonal(C, axis1=1, axis2=2) / sigma**2)


def test_one_more_may_be_enough_beside_what_was_measured():
    with pytest.raises(InputError, match="n: 1 configurations of 6 equations each are too few"):
        choose(ARM, 1, Q)
    more = choose(ARM, 1, Q[9:], measured=Q[:9], n_random=2)
    assert more.metrics.prediction < choose(ARM, 9, Q[:9], n_random=1).metrics.prediction


def test_the_prediction_is_over_the_workspace_that_is_given():
    far = ARM.random(8, 25)
    choice = choose(ARM, 6, Q, workspace=far, n_random=2)
    assert choice.metrics.prediction == pytest.approx(np.sqrt(variance(choice.q, far)), rel=1e-6)


def test_a_workspace_is_drawn_where_its_predicates_allow(monkeypatch):
    monkeypatch.setattr(drawing, "WORKSPACE", 40)
    for workspace in (right, [right]):
        where = parse_workspace(ARM, workspace, 3)
        assert where.shape == (40, 2)
        q = ARM.random(np.random.default_rng((3, 2)), 200)  # a stream of their own
        assert np.array_equal(where, q[q[:, 0] < 0][:40])
    choice = choose(ARM, 6, Q, workspace=right, n_random=2, seed=3)
    assert choice.metrics.prediction == pytest.approx(np.sqrt(variance(choice.q, where)), rel=1e-6)


def test_covariances_count_where_every_measurement_has_one():
    sigma = np.repeat([3e-4, 2e-5], 3)
    poses = Poses(HOME[None], covariance=np.diag(sigma**2))
    choice = choose(ARM, 6, Q, measurements=poses, n_random=2)
    measured = Poses(ARM.fk(choice.q), covariance=np.diag(sigma**2))
    C = pk.calibrate(ARM, choice.q, measured, folds=0).pose_covariance(Q)
    expected = np.sqrt(np.mean(np.diagonal(C, axis1=1, axis2=2) / sigma**2))
    assert choice.metrics.prediction == pytest.approx(expected, rel=1e-6)
    points = Points([[0, 0, 0]], points=[0.1, 0.1, 0])
    both, without = (
        choose(ARM, 6, Q, measurements=[x, points], n_random=2) for x in (poses, Poses(HOME[None]))
    )
    assert both.metrics == without.metrics


def test_an_unknown_device_is_taken_to_stand_at_the_base_and_a_probe_to_be_at_the_tip():
    here = np.eye(4)
    rough = EyeToHand(here[None], camera=here, board=here)
    unknown = Poses(here[None], frame="unknown", tool="unknown")
    given, taken = (choose(ARM, 6, Q, measurements=x, n_random=2) for x in (rough, unknown))
    assert taken.rank == given.rank
    assert taken.metrics == given.metrics


def test_candidates_at_their_limits_are_candidates():
    q = np.array([[-2.0, 1.0], [2.0, -1.0]])
    given, rows = drawing.parse_candidates(ARM, q, 0, ())
    assert np.array_equal(given, q)
    assert rows.tolist() == [0, 1]
    for beyond in np.nextafter(q, 2 * q):
        with pytest.raises(InputError, match=r"candidates\[0\].*is outside its limits"):
            drawing.parse_candidates(ARM, [beyond], 0, ())


def test_candidates_that_take_joints_beyond_their_own_limits_are_refused_with_the_joint():
    arm = ARM.replace(coupling=[[1, 0], [1, 1]], joint_limits=[[-2, 2], [-0.3, 0.3]])
    q = arm.random(5, 40)
    q[7] = [0.1, 0.2]  # a sum that rounding may take above 0.3
    assert len(choose(arm, 6, q, n_random=1).q) == 6
    q[17] = [0.6, -0.1]
    said = f"candidates[17]: joint '{arm.joint_names[1]}' = 0.5 is outside its limits -0.3 to 0.3"
    with pytest.raises(InputError, match=f"^{re.escape(said)}$"):
        choose(arm, 6, q)
    first = arm.replace(coupling=[[1, 1], [0, 1]], joint_limits=[[-0.3, 0.3], [-2, 2]])
    with pytest.raises(InputError, match=rf"joint '{arm.joint_names[0]}' = 0.5 is outside"):
        choose(first, 6, q[17:18])
    q[20] = [1.0, 2.0]  # the coordinate, too, is beyond its limits
    with pytest.raises(InputError, match=r"; 2 of the 40 candidates cannot be taken$"):
        choose(arm, 6, q)
    with pytest.raises(InputError, match=rf"^candidates\[0\]: '{arm.q_names[1]}' = 2 is outside"):
        choose(arm, 6, q[20:])


FUNCTION = (
    "expected a function of q (N, m) and T (N, 4, 4) that says which are allowed, such as WorkspaceBox or "
    "ViewCone, or a list of them, got "
)
REFUSED: dict[str, tuple[dict[str, Any], type[Exception], str]] = {
    "no function": (
        {"allowed": "box"},
        InputError,
        f"allowed: {FUNCTION}'box'",
    ),
    "no booleans": (
        {"allowed": lambda q, T: q[:, 0]},
        ShapeError,
        "allowed: expected 40 booleans, one for each configuration, got float64 of shape (40,)",
    ),
    "one boolean": (
        {"allowed": lambda q, T: True},
        ShapeError,
        "allowed: expected 40 booleans, one for each configuration, got bool of shape ()",
    ),
    "few allowed": (
        {"allowed": lambda q, T: np.arange(len(q)) < 5},
        InputError,
        "n: expected at most the 5 of 40 candidates that are allowed, got 6",
    ),
    "no workspace": (
        {"workspace": 7},
        ShapeError,
        "workspace: expected configurations (K, 2), got 7",
    ),
    "a predicate and none": (
        {"workspace": [right, 3]},
        InputError,
        f"workspace: {FUNCTION}3",
    ),
    "measured": (
        {"measured": [0.1, 0.2]},
        ShapeError,
        "measured: expected configurations (K, 2), got [0.1, 0.2]",
    ),
    "measured nan": (
        {"measured": [[0.1, np.nan]]},
        InputError,
        "measured[0, 1]: expected a finite number, got nan",
    ),
}


@pytest.mark.parametrize(("changed", "error", "message"), REFUSED.values(), ids=REFUSED)
def test_what_says_nothing_of_configurations_is_refused(changed, error, message):
    with pytest.raises(error, match=f"^{re.escape(message)}$"):
        choose(ARM, 6, Q, **changed)


def test_predicates_that_allow_next_to_nothing_are_refused_with_how_few_they_allow():
    allowed = [lambda q, T: np.arange(len(q)) == 3]
    for count, some in ((100, 0), (101, 1)):
        rng = np.random.default_rng(0)
        if not some:
            assert len(drawn(ARM, count, rng, allowed, "allowed")) == count
            continue
        with pytest.raises(InputError) as caught:
            drawn(ARM, count, rng, allowed, "allowed")
        assert str(caught.value) == (
            "allowed: 100 of 10100 configurations drawn within the limits are allowed, 101 are needed: "
            "expected predicates that allow more, or candidates (K, m) that they allow"
        )
