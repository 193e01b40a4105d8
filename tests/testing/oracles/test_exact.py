"""The oracle against mpmath's own matrix exponential, against defining properties, and against
other libraries.
"""

from __future__ import annotations

import re
import runpy
import sys

import mpmath
import numpy as np
import pytest

from poekin.errors import InputError, MissingExtra
from poekin.testing.oracles import exact, exact_jacobians, exact_numbers
from poekin.testing.oracles.exact import mp, norm

ANGLES = [
    0.0,
    1e-300,
    1e-150,
    1e-38,
    1e-8,
    0.5,
    float(np.nextafter(1, 0)),
    1.0,
    2.0,
    3.0,
    np.pi - 1e-15,
    np.pi,
    6.2,
    10.0,
]
DIGITS = mp.mpf(10) ** -60
N = np.array([0.6, -0.64, 0.48])
V = np.array([0.3, 2.0, -1.1])


def expm(X: np.ndarray, digits: int = 100) -> np.ndarray:
    with mpmath.workdps(digits):
        return exact.exactly(mpmath.expm(mpmath.matrix(X.tolist())).tolist())


def twist(angle: float) -> np.ndarray:
    return np.concatenate([angle * N, V])


def wrong_by(X: np.ndarray, Y: np.ndarray) -> float:
    """Relative error of each half of two twists, poses or adjoints, the worse one."""
    worst = norm(X - Y) / max(norm(Y), mp.mpf(10) ** -400)
    if X.ndim == 1:
        worst = max(norm(X[:3] - Y[:3]) / max(norm(Y[:3]), mp.mpf(10) ** -400), worst)
    return worst


@pytest.mark.parametrize("angle", ANGLES)
def test_exp_is_mpmaths_matrix_exponential(angle):
    xi = twist(angle)
    digits = 100 if angle == 0 else 100 - 2 * min(0, int(np.log10(angle)))
    E = expm(exact.hat(xi), digits)
    assert wrong_by(exact.exp(xi), E) < DIGITS
    assert wrong_by(exact.exp(xi[:3]), E[:3, :3]) < DIGITS
    skew = exact.exp(xi)[:3, :3] - exact.exp(xi)[:3, :3].T
    assert norm(skew - (E[:3, :3] - E[:3, :3].T)) <= DIGITS * norm(skew), (
        "a small rotation keeps its digits"
    )


@pytest.mark.parametrize("angle", ANGLES)
def test_adjoint_of_exp_is_mpmaths_exponential_of_ad(angle):
    xi = twist(angle)
    assert wrong_by(exact.adjoint(exact.exp(xi)), expm(exact.ad(xi))) < DIGITS


@pytest.mark.parametrize("size", [3, 6])
@pytest.mark.parametrize("angle", ANGLES)
def test_left_jacobian_is_the_corner_of_an_exponential(angle, size):
    # exp [[X, I], [0, 0]] has the upper right block Σ X^k / (k+1)!.
    X = exact.ad(twist(angle)[:size])
    block = exact.exactly(np.zeros((2 * size, 2 * size)))
    block[:size, :size], block[:size, size:] = X, exact.exactly(np.eye(size))
    assert wrong_by(exact.left_jacobian(twist(angle)[:size]), expm(block)[:size, size:]) < DIGITS


@pytest.mark.parametrize("size", [3, 6])
@pytest.mark.parametrize("angle", ANGLES)
def test_jacobians_and_their_inverses_fit_together(angle, size):
    xi = twist(angle)[:size]
    J_l, J_r = exact.left_jacobian(xi), exact.right_jacobian(xi)
    assert wrong_by(exact.adjoint(exact.exp(xi)) @ J_r, J_l) < DIGITS
    assert wrong_by(J_l @ exact.left_jacobian_inverse(xi), exact.exactly(np.eye(size))) < DIGITS
    assert wrong_by(J_r @ exact.right_jacobian_inverse(xi), exact.exactly(np.eye(size))) < DIGITS


@pytest.mark.parametrize("angle", [x for x in ANGLES if x <= np.pi])
def test_log_undoes_exp(angle):
    xi = exact.exactly(twist(1.0))
    xi[:3] = xi[:3] * mp.mpf(angle)
    w = xi[:3]
    with mp.workdps(exact.DIGITS - (0 if angle == 0 else 2 * min(0, int(np.log10(angle))))):
        T = exact.exp(xi)
    assert wrong_by(exact.log(T), xi) < DIGITS
    assert wrong_by(exact.log(T[:3, :3]), w) < DIGITS


@pytest.mark.parametrize("gap", ["1e-16", "1e-40", "1e-200"])
def test_log_keeps_sign_and_digits_towards_pi(gap):
    with mp.workdps(500):
        angle = mp.pi - mp.mpf(gap)
        n = exact.exactly([2, -6, 3]) / 7
        R = exact.exp(n * angle)
    assert norm(exact.log(R) - n * angle) < DIGITS


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 0, -1), (0.6, 0.8, 0)])
def test_log_at_pi_has_the_axis_up_to_sign(axis):
    n = exact.exactly(axis) if sum(axis) in (1, -1) else exact.exactly([3, 4, 0]) / 5
    R = 2 * np.outer(n, n) - exact.exactly(np.eye(3))
    w = exact.log(R)
    assert min(norm(w - mp.pi * n), norm(w + mp.pi * n)) < DIGITS


STRETCH = np.eye(3) + 1e-3 * np.outer([1, 2, 3], [1, 2, 3])


def test_log_of_a_symmetric_matrix_near_the_identity_is_zero():
    assert not any(exact.log(np.eye(3) + 1e-9 * np.outer([1, 2, 3], [1, 2, 3])))
    assert not any(exact.log(STRETCH))


@pytest.mark.parametrize("angle", ["1e-300", "1e-150", "1e-60", "1e-25", "1e-9", "2"])
def test_log_keeps_the_digits_of_a_rotation_however_small_it_is_beside_the_stretch(angle):
    with mp.workdps(800):
        w = exact.exactly(N) * mp.mpf(angle)
        X = exact.exp(w) @ exact.exactly(STRETCH)
    assert wrong_by(exact.log(X), w) < DIGITS


@pytest.mark.parametrize(("i", "j"), [(0, 1), (1, 2), (2, 0)])
def test_one_entry_that_differs_from_its_mirror_image_makes_a_rotation(i, j):
    X = STRETCH.copy()
    X[i, j] += 1e-12
    assert any(exact.log(X))


def test_log_of_a_stretched_half_turn_has_its_axis_up_to_sign():
    n = exact.exactly([2, -6, 3]) / 7
    R = 2 * np.outer(n, n) - exact.exactly(np.eye(3))
    w = exact.log(R @ exact.exactly(STRETCH))
    assert min(norm(w - mp.pi * n), norm(w + mp.pi * n)) < DIGITS


@pytest.mark.parametrize("noise", [0.0, 1e-16, 1e-8, 1e-7, 4e-7, 1e-3, 0.3])
def test_polar_is_the_rotation_that_leaves_a_positive_symmetric_factor(noise):
    rng = np.random.default_rng(0)
    X = exact.rounded(exact.exp(2.5 * N)) + noise * rng.uniform(-1, 1, (3, 3))
    R = exact.polar(X)
    P = R.T @ exact.exactly(X)
    assert norm(R.T @ R - exact.exactly(np.eye(3))) < DIGITS
    assert norm(P - P.T) < DIGITS
    assert np.linalg.eigvalsh(exact.rounded(P)).min() > 0
    assert wrong_by(exact.exp(exact.log(X)), R) < DIGITS


def test_a_matrix_next_to_a_singular_one_has_no_polar_rotation():
    identity = exact.exactly(np.eye(3))
    assert norm(exact.polar(np.diag([1e-8, 1e-8, 1.0])) - identity) < DIGITS
    with pytest.raises(InputError, match="too close to a singular one"):
        exact.polar(np.diag([1e-40, 1e-40, 1.0]))


@pytest.mark.parametrize("last", [-1.0, -0.1, 0.0])
def test_a_reflection_or_a_singular_matrix_has_no_polar_rotation(last):
    with pytest.raises(InputError) as caught:
        exact.polar(np.diag([1.0, 1.0, last]))
    words = "only a matrix of positive determinant has a rotation as its polar factor, got"
    assert str(caught.value) == f"{words} {last:.3g}"


def test_inverse_and_forward_are_what_they_say():
    T = exact.exp(twist(2.0))
    assert wrong_by(T @ exact.inverse(T), exact.exactly(np.eye(4))) < DIGITS
    screws = np.array([[0, 0, 1, 0, 0, 0], [0, 0, 0, 0.6, 0.8, 0]])
    f = exact.forward(screws, exact.rounded(T), [0.3, -2.0])
    product = expm(exact.hat(screws[0]) * mp.mpf(0.3)) @ expm(exact.hat(screws[1]) * mp.mpf(-2.0))
    assert wrong_by(f, product @ exact.exactly(exact.rounded(T))) < DIGITS


def test_nobody_elses_precision_is_touched():
    before = mpmath.mp.dps
    exact.log(exact.rounded(exact.exp(1e-200 * N)))
    assert mpmath.mp.dps == before
    with mpmath.workdps(5):
        assert wrong_by(exact.exp(twist(2.0)), expm(exact.hat(twist(2.0)))) < DIGITS


def test_it_agrees_with_scipy_and_pinocchio_where_they_are_right():
    # At 1 rad, where none of the faults of these libraries is known.
    pinocchio, transform = (
        pytest.importorskip("pinocchio"),
        pytest.importorskip("scipy.spatial.transform"),
    )
    xi = twist(1.0)
    v_first = np.roll(xi, 3)
    T = exact.rounded(exact.exp(xi))
    assert np.abs(pinocchio.exp6(v_first).homogeneous - T).max() < 1e-15
    assert np.abs(np.roll(pinocchio.log6(T).vector, 3) - xi).max() < 4e-15
    assert np.abs(transform.Rotation.from_rotvec(xi[:3]).as_matrix() - T[:3, :3]).max() < 1e-15
    J_r = np.roll(np.roll(pinocchio.Jexp6(v_first), 3, 0), 3, 1)
    assert np.abs(J_r - exact.rounded(exact.right_jacobian(xi))).max() < 1e-14
    J_r_inverse = np.roll(np.roll(pinocchio.Jlog6(pinocchio.SE3(T)), 3, 0), 3, 1)
    assert np.abs(J_r_inverse - exact.rounded(exact.right_jacobian_inverse(xi))).max() < 1e-14


def _printed_coefficients(s):
    t = mp.sqrt(s)
    return mp.sin(t) / t, (1 - mp.cos(t)) / s, (t - mp.sin(t)) / (s * t)


PLANTED = {
    "C with its sign wrong": (
        "coefficients",
        lambda s, f=exact_numbers.coefficients: (f(s)[0], f(s)[1], -f(s)[2]),
    ),
    "closed forms towards 0": (
        "coefficients",
        lambda s: _printed_coefficients(s) if s else (1, 0.5, 1 / 6),
    ),
    "series of the Jacobian cut": (
        "_jacobian_series",
        lambda s, f=exact_jacobians._jacobian_series: [*f(s)[:3], mp.zero],
    ),
    "axes swapped": ("cross", lambda a, b, f=exact.cross: -f(a, b)),
    "no projection": ("polar", lambda R: exact.exactly(R)),
    "transposed inverse": ("inverse3", lambda X, f=exact_numbers.inverse3: f(X).T),
}


@pytest.mark.parametrize("error", PLANTED)
def test_a_planted_error_is_caught(error, monkeypatch):
    name, wrong = PLANTED[error]
    holders = [m for m in (exact, exact_jacobians, exact_numbers) if hasattr(m, name)]
    assert holders
    for module in holders:
        monkeypatch.setattr(module, name, wrong)
    with pytest.raises((AssertionError, ValueError)):
        check_everything_once()


def check_everything_once() -> None:
    for angle in (1e-8, 0.5, 3.0):
        test_exp_is_mpmaths_matrix_exponential(angle)
        test_left_jacobian_is_the_corner_of_an_exponential(angle, 6)
        test_jacobians_and_their_inverses_fit_together(angle, 6)
    test_left_jacobian_is_the_corner_of_an_exponential(1e-30, 3)
    test_polar_is_the_rotation_that_leaves_a_positive_symmetric_factor(1e-3)


def test_without_a_planted_error_everything_passes():
    check_everything_once()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: exact.exp(np.zeros(5)), r"expected shape \(3,\) or \(6,\), got \(5,\)"),
        (lambda: exact.left_jacobian(np.zeros((2, 6))), r"got \(2, 6\); of a batch, one at a time"),
        (lambda: exact.hat(np.zeros(4)), r"expected shape \(3,\) or \(6,\)"),
        (lambda: exact.log(np.zeros(6)), r"expected shape \(3, 3\) or \(4, 4\), got \(6,\)"),
        (lambda: exact.adjoint(np.zeros((6, 6))), r"expected shape \(3, 3\) or \(4, 4\)"),
        (
            lambda: exact.forward(np.zeros((2, 6)), np.eye(4), [1.0]),
            r"^expected screws \(n, 6\) and x \(n,\), got \(2, 6\) and \(1,\)$",
        ),
        (
            lambda: exact.forward(np.zeros((1, 6)), np.eye(3), [1.0]),
            r"expected shape \(4, 4\), got \(3, 3\)",
        ),
        (lambda: exact.exp(["a", 0, 0]), r"expected numbers, got \['a', 0, 0\]"),
        (lambda: exact.log(-np.eye(3)), r"positive determinant .* got -1"),
        (lambda: exact.log(np.full((3, 3), np.nan)), r"positive determinant .* got nan"),
    ],
    ids=["exp", "batch", "hat", "log", "adjoint", "forward", "home", "text", "reflection", "nan"],
)
def test_what_is_no_argument_is_refused(call, message):
    with pytest.raises(InputError, match=message):
        call()


def test_nan_in_is_nan_out_without_a_warning():
    assert np.isnan(exact.rounded(exact.exp([np.nan, 0, 0]))).all()


def test_without_mpmath_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "mpmath", None)
    message = "poekin.testing.oracles.exact needs the package mpmath: pip install 'poekin[testing]'"
    with pytest.raises(MissingExtra, match=f"^{re.escape(message)}$"):
        runpy.run_path(exact_numbers.__file__)
