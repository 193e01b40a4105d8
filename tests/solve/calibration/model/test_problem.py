"""A problem's parameters: their scale, whose they are, and frames that sets have in common."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.solve.calibration import EyeInHand, Points, Poses, Term
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.parameters import Parameter
from poekin.solve.calibration.model.problem import Problem
from poekin.solve.calibration.terms.named import BUILDERS

ARM = pk.load("ur5").chain()
Q = ARM.random(1, 9)
T = ARM.fk(Q)
TERMS = tuple(BUILDERS)


def own_basis(q, conditions):
    B = np.zeros((*q.shape, 2))
    B[:, 0, 0] = 3.0 * q[:, 1]
    B[:, 1, 0] = 4.0
    return B


OWN = Term("own", (Parameter("a", "bend", "rad"), Parameter("a", "nothing", "rad")), own_basis)


def test_lengths_are_scaled_by_the_reach_and_terms_by_what_they_move_on_average():
    model = ErrorModel(ARM, ("screws", "home", "gains", OWN), None)
    problem = Problem(model, Q, [Points(T[:, :3, 3], None, frame="unknown")])
    moved = np.sqrt(np.mean((3.0 * Q[:, 1]) ** 2 + 16.0))
    for parameter, scale in zip(problem.parameters, problem.scale, strict=True):
        expected = ARM.reach if parameter.unit == "m" else 1.0
        if parameter.what == "bend":
            expected = 1.0 / moved
        # what moves nothing has the scale of its unit
        assert scale == pytest.approx(expected, rel=1e-12)
    assert {p.unit for p in problem.parameters} == {"rad", "m", "1"}
    assert problem.size == problem.model_size + 9
    assert problem.n_equations == 27
    part = problem.part(np.array([0, 3]))
    np.testing.assert_array_equal(part.scale, problem.scale)


def test_a_pitch_is_scaled_by_the_reach():
    model = ErrorModel(ARM, ("pitch",), None)
    assert {p.unit for p in model.parameters} == {"m/rad"}
    scale = Problem(model, Q, [Poses(T)]).scale
    np.testing.assert_allclose(scale, ARM.reach)


def test_a_part_has_the_measurements_at_its_readings_in_the_order_of_the_readings():
    rows = np.array([7, 2, 0, 2])
    problem = Problem(
        ErrorModel(ARM, ("home",), None), Q, [Poses(T), Points(T[rows, :3, 3], rows=rows)]
    )
    part = problem.part(np.array([2, 0, 5]))
    np.testing.assert_array_equal(part.q, Q[[2, 0, 5]])
    poses, points = part.sets
    np.testing.assert_array_equal(part.rows[0], [1, 0, 2])
    np.testing.assert_array_equal(poses.measured, T[[0, 2, 5]])
    np.testing.assert_array_equal(part.rows[1], [0, 1, 0])
    np.testing.assert_array_equal(points.measured[:, 0], T[[2, 0, 2], :3, 3])


def test_frames_are_named_by_their_set_or_by_what_sets_call_them():
    model = ErrorModel(ARM, ("home",), None)
    X = pk.se3.exp([0.3, -0.5, 0.2, 1.0, 0.4, -0.3])
    seen = pk.se3.inverse(X) @ T
    sets = [
        EyeInHand(seen, camera="wrist"),
        Points(T[:, :3, 3]),
        EyeInHand(seen, board=X, camera="wrist"),
    ]
    problem = Problem(model, Q, sets)
    assert problem.frame_names == [
        "T_base_board of measurement set 0",
        "T_tip_camera of 'wrist'",
        "T_base_board of measurement set 2",
    ]
    assert [p.owner for p in problem.parameters[6:]] == [
        name for name in problem.frame_names for _ in range(6)
    ]


@pytest.mark.parametrize("larger", [0, 1])
def test_points_that_sets_share_are_guessed_by_the_larger_one(larger):
    """The smaller set saw another point, a tenth of a metre away."""
    few = np.array([1, 4])
    p = T[:, :3, 3]
    sets = [Points(p, "ball"), Points(p[few] + T[few, :3, 0] * 0.1, "ball", rows=few)]
    if larger:
        sets.reverse()
    problem = Problem(ErrorModel(ARM, ("screws",), None), Q, sets)
    (guess,) = problem.initial_frames
    np.testing.assert_allclose(guess, 0.0, rtol=0, atol=1e-9)


def test_what_is_about_the_readings_has_its_own_parameters():
    kinds = ("screws", "home", "offsets", "gains", *TERMS, OWN)
    model = ErrorModel(ARM, kinds, None)
    for kind in ("gains", *TERMS):
        assert model.parameters_of(kind) == ErrorModel(ARM, (kind,), None).parameters
    assert model.parameters_of(OWN) == OWN.parameters
    assert model.parameters_of("screws") == model.parameters_of("home") == ()
    assert model.judged == ("gains", *TERMS, OWN)
    assert ErrorModel(ARM, ("screws", "home", "lag"), None).judged == ("lag",)


def test_kinds_of_which_there_is_nothing_are_named():
    slides = pk.Chain.from_space([pk.screw.prismatic([0, 0, 1.0])], np.eye(4))
    with pytest.raises(InputError) as caught:
        ErrorModel(slides, ("pitch", "harmonics"), None)
    words = "parameters: 'pitch', 'harmonics' of these joints: nothing to calibrate"
    assert str(caught.value) == words


@pytest.mark.parametrize("kinds", [("offsets",), ("gains",), ("offsets", "gains")])
def test_a_chain_with_zeros_or_gains_that_are_off_is_another(kinds):
    model = ErrorModel(ARM, kinds, None)
    p = np.full(len(model.parameters), 1e-2)
    found = model.chain(p)
    offsets = 1e-2 * ("offsets" in kinds)
    gains = 1e-2 * ("gains" in kinds)
    np.testing.assert_allclose(found.fk(Q), ARM.fk((1 + gains) * Q + offsets), rtol=0, atol=1e-12)
    np.testing.assert_array_equal(found.limits, ARM.limits)
    assert model.chain(0 * p) is ARM
