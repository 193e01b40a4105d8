"""`calibrate` finds the arm that was measured, says how well, and refuses what cannot be."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError
from poekin.groups import se3
from poekin.solve.calibration import (
    Distances,
    EyeInHand,
    EyeToHand,
    Points,
    Poses,
    calibrate,
    choose_poses,
    identify,
)
from poekin.solve.calibration.model.error_model import ErrorModel
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be
from tests.messages import says

PUMA = pk.load("puma560").chain().retooled(se3.exp([0.1, 0.2, -0.1, 0.05, 0.03, 0.2]))
PANDA = pk.load("panda").chain(tip="panda_link8")
FRESH = PUMA.random(99, 200)
X, Z = se3.exp([0.3, -0.5, 0.2, 1.0, 0.4, -0.3]), se3.exp([-0.1, 0.2, 1.4, 0.05, -0.08, 0.1])


def moved(
    arm: pk.Chain, seed: int = 0, size: float = 5e-3, kinds: tuple[str, ...] = ("screws", "home")
) -> pk.Chain:
    """An arm off by some milliradians and millimetres in every parameter."""
    parameters = ErrorModel(arm, kinds, None)
    return parameters.chain(
        size * np.random.default_rng(seed).normal(size=len(parameters.parameters))
    )


TRUE = moved(PUMA)


@pytest.mark.parametrize("letters", ["R", "RRP", "PPP", "RPRPRR", "HRR"])
@settings(max_examples=5)
@given(seed=st.integers(0, 2**32 - 1))
def test_exact_poses_give_the_exact_arm(letters, seed):
    rng = np.random.default_rng(seed)
    make = {
        "R": lambda: pk.screw.revolute(rng.normal(size=3), rng.uniform(-1, 1, 3)),
        "P": lambda: pk.screw.prismatic(rng.normal(size=3)),
        "H": lambda: pk.screw.helical(rng.normal(size=3), rng.uniform(-1, 1, 3), 0.1),
    }
    arm = pk.Chain.from_space([make[letter]() for letter in letters], se3.exp(rng.normal(size=6)))
    true = moved(arm, seed)
    q = rng.uniform(-2, 2, (30, arm.dof))
    found = calibrate(arm, q, true.fk(q), folds=0)
    assert found.success
    fresh = rng.uniform(-2, 2, (50, arm.dof))
    np.testing.assert_allclose(
        found.chain.fk(fresh), true.fk(fresh), rtol=0, atol=1e-12 * arm.reach
    )


def test_a_covariance_that_is_too_small_is_warned_of_and_one_too_large_is_remarked():
    q, rng = PUMA.random(0, 40), np.random.default_rng(0)
    p = PUMA.fk(q)[:, :3, 3] + rng.normal(scale=1e-4, size=(40, 3))
    said = []
    for deviation in (1e-5, 1e-4, 1e-3):
        points = Points(p, covariance=deviation**2 * np.eye(3))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            found = calibrate(PUMA, q, points, parameters=("offsets",), folds=0)
        assert [str(w.message) for w in caught] == list(found.warnings)
        said.append(
            [
                ["times as large as covariance= says" in words for words in told]
                for told in (found.warnings, found.remarks)
            ]
        )
    assert said == [[[True], []], [[], []], [[], [True]]]


@pytest.mark.parametrize("tilt", [1e-4, 1e-3, 1e-2])
def test_a_tilted_axis_is_found_in_five_steps_to_1e_12_m(tilt):
    """Axes 2 and 3 of a Puma are parallel: in their common plane a tilt throws DH's d to infinity."""
    arm = pk.load("puma560").chain()
    axis, point = arm.screws[2, :3], np.cross(arm.screws[2, :3], arm.screws[2, 3:])
    between = point - np.cross(arm.screws[1, :3], arm.screws[1, 3:])
    between -= axis * (axis @ between)
    across = np.cross(axis, between / np.linalg.norm(between))
    turn = tilt * across
    A = arm.screws.copy()
    A[2] = se3.adjoint(se3.exp([*turn, *np.cross(point, turn)])) @ A[2]
    true = pk.Chain.from_space(A, arm.home)
    q = arm.random(0, 40)
    found = calibrate(arm, q, true.fk(q), folds=0, iterations=5)
    np.testing.assert_allclose(found.chain.fk(FRESH), true.fk(FRESH), rtol=0, atol=1e-12)


def one_point(T: np.ndarray, at: tuple[float, float, float] = (0.1, 0.0, 0.05)) -> np.ndarray:
    return T[:, :3, :3] @ at + T[:, :3, 3]


def test_points_give_the_points_and_three_points_the_poses():
    q = PUMA.random(1, 60)
    T, fresh = TRUE.fk(q), TRUE.fk(FRESH)
    found = calibrate(PUMA, q, Points(one_point(T), (0.1, 0.0, 0.05)), folds=0)
    np.testing.assert_allclose(
        one_point(found.chain.fk(FRESH)), one_point(fresh), rtol=0, atol=1e-12
    )
    tools = np.array([[0.1, 0.0, 0.05], [0, 0.1, 0], [0, 0, 0.0]])
    several = np.stack([one_point(T, tuple(tool)) for tool in tools], 1)
    found = calibrate(PUMA, q, Points(several, tools), folds=0)
    np.testing.assert_allclose(found.chain.fk(FRESH), fresh, rtol=0, atol=1e-12)


def test_points_in_a_devices_frame_give_the_arm_but_for_where_its_base_is():
    q = PUMA.random(1, 60)
    p = (one_point(TRUE.fk(q)) - X[:3, 3]) @ X[:3, :3]
    found = calibrate(PUMA, q, Points(p, (0.1, 0.0, 0.05), frame="unknown"), folds=0)
    device = found.frames["T_base_device"]
    again = (one_point(found.chain.fk(FRESH)) - device[:3, 3]) @ device[:3, :3]
    np.testing.assert_allclose(
        again, (one_point(TRUE.fk(FRESH)) - X[:3, 3]) @ X[:3, :3], rtol=0, atol=1e-12
    )


def test_distances_from_three_places_give_the_point():
    q = PUMA.random(1, 120)
    p = one_point(TRUE.fk(q))
    centres = [[1.5, 0, 0], [0, 1.5, 0.2], [-1, -1, 1.5]]
    known = [None, *centres[1:]]
    measured = [np.linalg.norm(p - c, axis=1) for c in centres]
    sets = [Distances(d, c, (0.1, 0.0, 0.05)) for d, c in zip(measured, known, strict=True)]
    found = calibrate(PUMA, q, sets, folds=0)
    assert found.success
    # where the first is, is solved along; the other two say where the base is, but for a turn about
    # their line
    again = one_point(found.chain.fk(FRESH))
    for c, true in zip(
        [found.frames["centre of measurement set 0"], *centres[1:]], centres, strict=True
    ):
        lengths = np.linalg.norm(one_point(TRUE.fk(FRESH)) - true, axis=1)
        np.testing.assert_allclose(np.linalg.norm(again - c, axis=1), lengths, rtol=0, atol=1e-11)


@pytest.mark.parametrize("kind", [EyeInHand, EyeToHand])
def test_camera_and_board_are_solved_along(kind):
    true = moved(PANDA)
    q = PANDA.random(1, 60)
    found = calibrate(PANDA, q, kind(se3.inverse(X) @ true.fk(q) @ Z), folds=0)
    assert found.success
    board, camera = found.frames.values()
    fresh = PANDA.random(2, 100)
    again = se3.inverse(board) @ found.chain.fk(fresh) @ camera
    np.testing.assert_allclose(again, se3.inverse(X) @ true.fk(fresh) @ Z, rtol=0, atol=1e-11)
    # what the arm shares with camera and board stays where it is nominal: the arm moves no more
    # than need be
    assert np.abs(found.chain.home - PANDA.home).max() < 0.05


def test_kinds_are_mixed_freely_with_weights_by_their_covariances():
    q = PUMA.random(3, 40)
    T = TRUE.fk(q)
    rng = np.random.default_rng(0)
    rough = Poses(
        T[:20] @ se3.exp(1e-2 * rng.normal(size=(20, 6))), 1e-4 * np.eye(6), rows=np.arange(20)
    )
    fine = Points(T[:, :3, 3], covariance=1e-14 * np.eye(3))
    far = Distances(
        np.linalg.norm(T[20:, :3, 3] - [2, 0, 0], axis=1),
        [2, 0, 0],
        covariance=1e-14,
        rows=np.arange(20, 40),
    )
    found = calibrate(PUMA, q, [rough, fine, far], folds=0)
    off = found.chain.fk(FRESH) - TRUE.fk(FRESH)
    assert np.abs(off[:, :3, 3]).max() < 1e-6
    assert 1e-4 < np.abs(off[:, :3, :3]).max() < 3e-2
    assert len(found.after) == 80


@pytest.mark.parametrize(
    ("kinds", "size"),
    [
        (("offsets",), 6),
        (("gains",), 6),
        (("offsets", "gains", "home"), 17),
        (("screws", "home", "gains", "pitch"), 42),
    ],
    ids=lambda x: "+".join(x) if isinstance(x, tuple) else str(x),
)
def test_other_parameters_by_name(kinds, size):
    true = moved(PUMA, 4, 5e-3, kinds)
    q = PUMA.random(1, 60)
    found = calibrate(PUMA, q, true.fk(q), parameters=kinds, folds=0)
    assert found.identification.rank == size
    np.testing.assert_allclose(found.chain.fk(FRESH), true.fk(FRESH), rtol=0, atol=1e-12)


def test_only_the_chosen_joints_change():
    q = PUMA.random(1, 40)
    found = calibrate(
        PUMA, q, TRUE.fk(q), parameters=("screws",), joints=["joint2", "joint3"], folds=0
    )
    np.testing.assert_array_equal(found.chain.screws[[0, 3, 4, 5]], PUMA.screws[[0, 3, 4, 5]])
    assert np.abs(found.chain.screws[1:3] - PUMA.screws[1:3]).max() > 1e-4


def test_a_prior_holds_what_is_not_seen_and_yields_to_what_is():
    q = PUMA.random(1, 40)
    q[:, 4] = 0.0
    found = calibrate(
        PUMA, q, Poses(TRUE.fk(q), 1e-12 * np.eye(6)), prior={"rad": 1e-2, "m": 1e-2}, folds=0
    )
    assert found.success
    np.testing.assert_allclose(found.chain.fk(q), TRUE.fk(q), rtol=0, atol=1e-6)
    mine = [k for k, p in enumerate(found.parameters) if p.owner == "joint5"]
    np.testing.assert_allclose(found.deviations[mine], 1e-2, rtol=1e-6)


def noisy(seed: int, count: int = 60, outliers: int = 0) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    q = PUMA.random(rng, count)
    T = TRUE.fk(q)
    T[:, :3, :3] = pk.so3.exp(3e-4 * rng.normal(size=(count, 3))) @ T[:, :3, :3]
    T[:, :3, 3] += 2e-4 * rng.normal(size=(count, 3))
    T[:outliers] = T[:outliers] @ se3.exp(0.3 * rng.normal(size=(outliers, 6)))
    return q, T


def fresh_error(chain: pk.Chain) -> float:
    return float(np.sqrt(np.mean((chain.fk(FRESH) - TRUE.fk(FRESH))[:, :3, 3] ** 2)))


def test_spreads_are_estimated_where_no_covariance_is_given():
    q, T = noisy(0, 200)
    found = calibrate(PUMA, q, T)
    (spread,) = found.noise_std
    assert spread is not None
    # 600 numbers each: known to 3 %; four deviations
    assert spread.angle == pytest.approx(3e-4, rel=0.12)
    assert spread.length == pytest.approx(2e-4, rel=0.12)


@pytest.mark.parametrize("loss", ["huber", "cauchy", "tukey"])
def test_gross_outliers_cost_little_with_a_robust_loss_and_are_named(loss):
    q, T = noisy(0, 60, 3)
    clean = fresh_error(calibrate(PUMA, q[3:], T[3:], folds=0).chain)
    found = calibrate(PUMA, q, T, loss=loss, folds=0)
    assert fresh_error(found.chain) < 1.3 * clean
    assert [o.row for o in found.outliers][:3] == [0, 1, 2]
    assert len(found.outliers) <= 4
    assert fresh_error(calibrate(PUMA, q, T, folds=0).chain) > 5 * clean


def test_data_kept_aside_are_judged_by_the_others():
    q, T = noisy(1)
    found = calibrate(PUMA, q, T, folds=5)
    assert found.cross_validation is not None
    assert len(found.cross_validation.after) == len(found.cross_validation.before) == 60
    np.testing.assert_array_equal(found.cross_validation.after.row, np.arange(60))
    assert (
        found.after.rms_length
        < found.cross_validation.after.rms_length
        < 2 * found.after.rms_length
    )
    assert found.cross_validation.after.rms_length < 0.1 * found.cross_validation.before.rms_length
    np.testing.assert_allclose(
        found.cross_validation.before.length, found.before.length, rtol=1e-12
    )
    other = calibrate(PUMA, q, T, folds=5, seed=3)
    assert other.cross_validation
    assert other.cross_validation.after.rms_length != found.cross_validation.after.rms_length  # type: ignore[union-attr]


def test_the_pose_covariance_is_the_scatter_of_the_poses_found():
    q, _ = noisy(0)
    rng = np.random.default_rng(7)
    parameters = ErrorModel(PUMA, ("screws", "home"), None)
    at = PUMA.random(5)
    true = TRUE.fk(at)
    C = np.diag([9e-8] * 3 + [4e-8] * 3)
    errors = []
    for _ in range(300):
        T = TRUE.fk(q)
        T[:, :3, :3] = pk.so3.exp(3e-4 * rng.normal(size=(60, 3))) @ T[:, :3, :3]
        T[:, :3, 3] += 2e-4 * rng.normal(size=(60, 3))
        found = calibrate(PUMA, q, Poses(T, C), folds=0)
        E = found.chain.fk(at)
        errors.append([*pk.so3.log(E[:3, :3] @ true[:3, :3].T), *(E[:3, 3] - true[:3, 3])])
    assert len(parameters.parameters) == len(found.values)
    said = found.pose_covariance(at)
    whitened = np.linalg.solve(np.linalg.cholesky(said), np.array(errors).T)
    # 300 samples: a variance is known to 8 %, a correlation to 6 %; four deviations
    np.testing.assert_allclose(np.cov(whitened), np.eye(6), rtol=0, atol=0.33)


def test_what_did_not_converge_says_so_and_keeps_the_best():
    q, T = noisy(0)
    found = calibrate(PUMA, q, T, folds=0, iterations=1)
    assert not found.success
    assert "NOT converged" in str(found)
    assert found.after.rms_length < found.before.rms_length


def test_the_result_says_what_it_is_and_goes_on_to_other_forms(tmp_path):
    robot = pk.load("panda")
    arm = robot.chain(tip="panda_link8")
    q = arm.random(0, 60)
    found = calibrate(arm, q, moved(arm, 1, 1e-3).fk(q))
    words = str(found)
    for part in (
        "34 parameters",
        "converged",
        "rank 34 of 34",
        "held out (5 folds)",
        "rms mm",
        "median mrad",
    ):
        assert part in words
    path = tmp_path / "panda.urdf"
    path.write_text(found.to_urdf(robot))
    assert found.to_urdf(robot, into=robot) == pk.to_urdf(found.chain, into=robot)
    again = pk.load(path).chain(tip="panda_link8")
    np.testing.assert_allclose(again.fk(q), found.chain.fk(q), rtol=0, atol=1e-12)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pk.PoekinWarning)
        table = found.to_dh("modified")
    np.testing.assert_allclose(
        pk.dh.to_chain(table.table).fk(q), found.chain.fk(q), rtol=0, atol=1e-9
    )
    assert "panda_joint" in str(found.compare())
    compared = found.compare()
    assert (compared.a, compared.b) == (found.nominal, found.chain)


def test_millimetres_and_degrees_are_suggested_never_converted():
    q, T = noisy(0)
    mm = T.copy()
    mm[:, :3, 3] *= 1e3
    with pytest.raises(InputError, match=r"lengths look like millimetres: give metres"):
        calibrate(PUMA, q, mm)
    with pytest.raises(InputError, match=r"joint angles look like degrees: give radians"):
        calibrate(PUMA, np.rad2deg(q), T)
    with pytest.raises(InputError, match=r"millimetres and the joint angles like degrees"):
        calibrate(PUMA, np.rad2deg(q), mm)
    with pytest.raises(InputError, match=r"lengths look like millimetres"):
        calibrate(PUMA, q, 1e3 * T[:, :3, 3])
    with pytest.raises(InputError, match=r"lengths look like millimetres"):
        calibrate(
            PUMA, q, Distances(1e3 * np.linalg.norm(T[:, :3, 3] - [1, 1, 0], axis=1), [1, 1, 0])
        )


@pytest.mark.parametrize("kind", [EyeInHand, EyeToHand])
def test_units_are_told_with_unknown_frames_too(kind):
    q = PANDA.random(1, 40)
    G = se3.inverse(X) @ moved(PANDA).fk(q) @ Z
    with pytest.raises(InputError, match=r"joint angles look like degrees"):
        calibrate(PANDA, np.rad2deg(q), kind(G))
    G[:, :3, 3] *= 1e3
    with pytest.raises(InputError, match=r"lengths look like millimetres"):
        calibrate(PANDA, q, kind(G))


BAD = {
    "no chain": (
        {"chain": pk.load("puma560")},
        "chain: expected a Chain, as Robot.chain(tip=...) makes it, got Robot(...",
    ),
    "a loss": (
        {"loss": "l1"},
        "loss: expected 'linear', 'huber', 'cauchy' or 'tukey', got 'l1'",
    ),
    "on_rank_deficiency": (
        {"on_rank_deficiency": True},
        "on_rank_deficiency: expected 'raise' or 'fix', got True",
    ),
    "a prior of a wrong unit": (
        {"prior": {"mm": 1}},
        "prior: expected 'rad', 'm', '1', 'm/rad', 'rad/m', 'rad/(N m)', 'm/N', 'rad/s', 'm/s', 'rad/K' "
        "or 'm/K', got 'mm'",
    ),
    "a prior of nothing": (
        {"prior": {}},
        "prior: expected standard deviations by unit, such as {'rad': 1e-3}, got {}",
    ),
    "a bare prior": (
        {"prior": 1e-3},
        "prior: expected standard deviations by unit, such as {'rad': 1e-3}, got 0.001",
    ),
    **{
        f"a prior of {sigma}": (
            {"prior": {"m": sigma}},
            f"prior['m']: expected a positive number, got {sigma!r}",
        )
        for sigma in (0.0, -1.0, np.inf, np.nan, True, [1], np.complex128(2))
    },
    **{
        f"{most} steps": (
            {"iterations": most},
            f"iterations: expected a whole number from 1 on, got {most}",
        )
        for most in (0, True, 1.5)
    },
}


@pytest.mark.parametrize("what", BAD)
def test_bad_input_is_refused(what):
    q, T = noisy(0)
    given, message = BAD[what]
    with pytest.raises(InputError) as caught:
        calibrate(**{"chain": PUMA, "q": q, "measurements": T, **given})
    assert says(caught.value, message)


def test_progress_counts_the_folds():
    q, T = noisy(0)
    told: list[tuple[int, int]] = []
    calibrate(PUMA, q, T, folds=4, progress=lambda done, total: told.append((done, total)))
    assert told == [(0, 4), (1, 4), (2, 4), (3, 4), (4, 4)]


@pytest.mark.parametrize("folds", [0, 4])
def test_an_arm_without_joints_has_its_constant_pose_calibrated(folds):
    fixed, rng = pk.Chain.from_space(np.empty((0, 6)), np.eye(4)), np.random.default_rng(0)
    home, q = se3.exp([0.01, 0.02, -0.01, 0.04, 0.02, 0.03]), np.empty((12, 0))
    T = home @ se3.exp(1e-4 * rng.normal(size=(12, 6)))
    found = calibrate(fixed, q, T, folds=folds)
    # the mean of twelve: its error is a standard deviation / sqrt(12), each of six within five of
    # these
    assert np.abs(se3.log(se3.inverse(found.chain.home) @ home)).max() <= 5e-4 / np.sqrt(12)
    assert [p.owner for p in found.parameters] == ["home"] * 6
    assert identify(fixed, q, T).rank == 6
    assert choose_poses(fixed, 4, q).rows.shape == (4,)
    for ask in (calibrate, identify):
        with pytest.raises(InputError, match="nothing to calibrate"):
            ask(fixed, q, T, parameters="screws")


@pytest.mark.parametrize("kind", dataclasses_of("poekin.solve.calibration", "calibration"))
def test_a_calibration_cannot_be_changed_and_is_equal_to_itself_alone(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)
