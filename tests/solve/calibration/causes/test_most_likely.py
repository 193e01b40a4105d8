"""The cause of measurements that do not fit, found by trying each on the data."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.groups import se3
from poekin.solve.calibration import Distances, EyeInHand, Measurement, Points, Poses, simulated
from poekin.solve.calibration.causes import most_likely as causes
from poekin.solve.calibration.causes.most_likely import build_problem, most_likely
from poekin.solve.calibration.diagnostics.explanation import Explanation, Size
from poekin.solve.calibration.measurements.inputs import parse_measurements
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.problem import Problem
from tests.solve.calibration.causes.wrong_data import Wrong, arm, wrong_data

PUMA = arm("puma560")
MODEL = ErrorModel(PUMA, ("screws", "home"), None)
REFLECTOR = [0.05, 0.0, 0.02]
KINDS = {wrong.name: wrong for wrong in wrong_data(PUMA, 5)}


@pytest.mark.parametrize("name", KINDS)
def test_the_cause_of_wrong_data_is_named_with_the_error_that_it_would_leave(name):
    wrong: Wrong = KINDS[name]
    cause = most_likely(MODEL, wrong.q, parse_measurements(wrong.measured, len(wrong.q)))
    assert cause is not None
    assert wrong.words in cause.words
    # axes off by 2 mrad and 1 mm
    assert 1e-4 < cause.left.length < 2e-2
    assert f"with that the nominal arm is off by {cause.left} (median)" in str(cause)


@pytest.mark.parametrize("kind", ["poses", "points", "distances", "eye-in-hand", "eye-to-hand"])
@pytest.mark.parametrize("unknown", [False, True])
def test_no_cause_is_named_of_right_data(kind, unknown):
    made = simulated(PUMA, 40, kind=kind, unknown=unknown, points=REFLECTOR, seed=3)
    assert most_likely(MODEL, made.q, [made.measurements]) is None


def seen(kind: type[Measurement]) -> Measurement:
    names: Any = {EyeInHand: "eye-in-hand", Points: "points", Distances: "distances"}
    made = simulated(
        PUMA,
        40,
        kind=names[kind],
        unknown=True,
        points=REFLECTOR,
        seed=3,
    )
    return made.measurements


@pytest.mark.parametrize("kind", [EyeInHand, Points, Distances])
def test_a_reversed_joint_is_named_where_frames_are_not_known(kind):
    q = simulated(PUMA, 40, seed=3).q.copy()
    q[:, 2] *= -1.0
    cause = most_likely(MODEL, q, [seen(kind)])
    assert cause is not None
    assert cause.words == "joint3 reversed"


def test_inverse_poses_of_a_camera_are_named_where_there_is_no_guess_of_its_frames():
    made = simulated(PUMA, 40, kind="eye-in-hand", seed=3)
    back = EyeInHand(se3.inverse(made.measurements.T))  # type: ignore[attr-defined]
    words = r"^most likely: the poses inverted; with that .*; as the data stand, no two frames fit"
    with pytest.raises(InputError, match=words):
        build_problem(MODEL, made.q, [back])


def test_a_base_or_tool_that_was_fitted_has_to_be_better_than_what_fits_nothing():
    """A quarter turn of the first joint is also a base that is turned."""
    made = simulated(PUMA, 40, seed=1)
    q = made.q.copy()
    q[:, 0] += np.pi / 2
    cause = most_likely(MODEL, q, [made.measurements])
    assert cause is not None
    assert cause.words == "-90° added to joint1"


def test_of_several_sets_the_one_with_another_base_and_tool_is_named():
    made = simulated(PUMA, 40, seed=1)
    T = made.measurements.T  # type: ignore[attr-defined]
    X = se3.exp([0.3, -0.5, 0.2, 2.0, 1.4, -0.3])
    beside = Poses(X @ T @ se3.exp([0.1, 0.2, 0.3, 0.1, 0.2, 0.1]))
    cause = most_likely(MODEL, made.q, [made.measurements, beside])
    assert cause is not None
    assert cause.words.startswith("measurement set 1 (Poses): base moved by ")


def test_the_message_of_no_guess_stays_where_no_cause_gives_one():
    q = np.zeros((6, 6))
    q[:, 5] = np.linspace(0.0, 1.0, 6)
    with pytest.raises(InputError, match=r"^an initial guess of two unknown frames needs a hand"):
        build_problem(MODEL, q, [EyeInHand(PUMA.fk(q))])


def test_a_chain_of_slides_has_no_other_zeros():
    gantry = pk.Chain.from_space(
        [pk.screw.prismatic([1, 0, 0]), pk.screw.prismatic([0, 1, 0])], np.eye(4)
    )
    q = gantry.random(0, 20)
    cause = most_likely(ErrorModel(gantry, ("home",), None), -q, [Poses(gantry.fk(q))])
    assert cause is None or "added" not in cause.words


@pytest.mark.parametrize("by", [1, -1, 2, -2])
def test_readings_some_rows_off_are_named_by_how_many(by):
    made = simulated(PUMA, 30, seed=1)
    cause = most_likely(MODEL, np.roll(made.q, by, axis=0), [made.measurements])
    assert cause is not None
    assert cause.words == f"each measurement {by:+d} rows of q further on"


def test_exchanged_measurements_are_named_by_their_rows_of_q():
    made = simulated(PUMA, 40, seed=1)
    rows = np.arange(1, 40, 2)
    T = made.measurements.T[rows]  # type: ignore[attr-defined]
    T[[3, 10]] = T[[10, 3]]
    cause = most_likely(MODEL, made.q, [Poses(T, rows=rows)])
    assert cause is not None
    assert cause.words == "the measurements of rows 7, 21 exchanged"


@pytest.mark.parametrize(("size", "together"), [
    (Size(2.0, 0.3), 0.8), (Size(2.0), 0.5), (Size(0.0, 0.0), 1e-12),
])  # fmt: skip
def test_an_error_is_taken_together_in_rad_and_reaches(size, together):
    assert causes._together(size, 4.0) == pytest.approx(together, rel=1e-12, abs=0.0)


@pytest.mark.parametrize(("ratio", "named"), [(0.99 / 4.5, True), (1.01 / 4.5, False)])
def test_base_and_tool_are_named_where_they_explain_a_set_four_and_a_half_times_better(
    ratio, named, monkeypatch
):
    q = PUMA.random(0, 20)
    problem = Problem(MODEL, q, [Poses(PUMA.fk(q) @ se3.exp([0, 0, 0, 0.1, 0, 0]))])
    found = Explanation(Size(0.5, 0.1), Size(0.2, 0.1), Size(0.1 * ratio, 0.0))
    monkeypatch.setattr(causes, "explained", lambda *given: found)
    cause = causes._of_base_and_tool(problem)
    assert (cause is not None) == named


def test_nothing_is_tried_of_a_nominal_arm_that_is_off_by_a_centimetre_a_metre(monkeypatch):
    tried = []
    monkeypatch.setattr(causes, "_others", lambda *given: tried.append(given) or [])
    monkeypatch.setattr(causes, "explained", lambda *given: None)
    q = PUMA.random(0, 20)
    for off, looked in ((0.0099, 0), (0.0101, 1)):
        moved = PUMA.fk(q)
        moved[:, 2, 3] += off * PUMA.reach
        most_likely(MODEL, q, [Poses(moved)])
        assert len(tried) == looked
