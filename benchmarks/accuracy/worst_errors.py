"""Worst errors of exp, log and the Jacobians of exp: the rows that the report prints, from one run.

Angles lie on a grid (0, every decade from 1e-150, the switches of the formulas ± 1 ulp, π - 10⁻ᵏ,
π, up to 10) and at random, log-uniform; lengths are log-uniform and independent of them. To these
come the worst of many more cases, picked in extended precision: a worst case of one in a million is
not met by chance in a few hundred. All are judged in 60 digits. Each function is called on whole
arrays, as its users do, with every floating-point warning an error.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np

from poekin.groups import se3, so3
from poekin.testing.accuracy import error_bounds
from poekin.testing.accuracy.accuracy_laws import (
    NOISE_BAR,
    jacobian_errors,
)
from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.oracles import exact
from poekin.testing.strategies.decoding.decoders import SMALLEST, SWITCHES, around

from . import longdouble_oracle, worst_cases

REPORT_BAR = 1.5
"""exp and log may err by this many times what float64 can attain (`error_bounds`)."""
JACOBIAN_REPORT_BAR = 5e-16
"""The Jacobians' 3×3 block, and their Q block ÷ ‖v‖, may err by this much (Frobenius)."""
SIGN_BAR = 9e-16
"""The sign of log must be right where π - θ is at least this."""
_LARGEST_EXP = 10.0


class Row(NamedTuple):
    """A line of the report.

    Fields: what was measured; error, the worst, and bar, what it may be, both in the unit that
    `what` names (rad, or multiples of what float64 can attain); cases, over how many; worst, the
    case: a twist (6,), a pose (4, 4) in the base frame, or a rotation (3, 3).
    """

    what: str
    error: float
    bar: float
    cases: int
    worst: np.ndarray

    @property
    def passed(self) -> bool:
        """Whether the error keeps the bar (NaN does not)."""
        return bool(self.error <= self.bar)


def worst_errors(
    seed: int = 0, samples: int = 300, sweep: int = 100_000, rotation: Any = so3, pose: Any = se3
) -> list[Row]:
    """The worst errors of exp, log and the Jacobians, over a fixed grid, random cases, and the
    worst of many more.

    Parameters: seed of the random cases; samples, how many random ones of each kind; sweep, among
    how many more the worst are picked; rotation and pose, what is judged: modules (or objects) with
    the functions of `poekin.so3` and `poekin.se3`, over arrays. Returns: rows, in the order of the
    report; their `cases` are those judged in 60 digits. Raises: whatever the judged functions
    raise, and their floating-point warnings. Takes about half a minute. Source: the definitions, in
    60 digits (`exact`). Accuracy: errors are right to all that is shown.
    """
    rng = np.random.default_rng(seed)
    far, principal = (
        _twists(rng, _angles(rng, largest, samples)) for largest in (_LARGEST_EXP, math.pi)
    )
    poses = np.stack([exact.rounded(exact.exp(x)) for x in principal])
    poses = np.concatenate([poses, _near_pi(rng, max(samples // 4, 20))])
    noisy = _noisy(rng, poses[rng.integers(len(poses), size=samples), :3, :3])
    with warnings.catch_warnings(), np.errstate(all="raise", under="ignore"):
        warnings.simplefilter("error")
        many_far, many = (
            worst_cases.twists(rng, sweep, largest) for largest in (_LARGEST_EXP, math.pi)
        )
        many_poses = longdouble_oracle.exp(many).astype(float)
        xi = np.concatenate([far, worst_cases.of_exp(pose, many_far)])
        T = np.concatenate([poses, worst_cases.of_log(pose, many_poses)])
        return [
            _worst("exp: error ÷ attainable", REPORT_BAR, xi, _exp_ratios(rotation, pose, xi)),
            *_log_rows(rotation, pose, T),
            _worst(
                "log of a noisy rotation: error", NOISE_BAR, noisy, _noise_errors(rotation, noisy)
            ),
            *_jacobian_rows("jacobian", pose, far, many_far),
            *_jacobian_rows("jacobian_inverse", pose, principal, many),
        ]


def _angles(rng: np.random.Generator, largest: float, samples: int) -> np.ndarray:
    marks = [
        0.0,
        *(10.0**-k for k in range(17)),
        *(10.0 ** (-10 * k) for k in range(2, 16)),
        math.pi,
        largest,
    ]
    marks += [x for s in SWITCHES for x in sorted(around(s))]
    marks += [math.pi - 10.0**-k for k in range(1, 16)] + [2 * math.pi, 3 * math.pi]
    low, high = math.log(SMALLEST), math.log(largest)
    wide, usual = (
        rng.uniform(low, high, samples // 4),
        rng.uniform(math.log(1e-10), high, samples // 2),
    )
    even = rng.uniform(0, largest, samples - samples // 4 - samples // 2)
    angles = np.concatenate([[x for x in marks if x <= largest], np.exp(wide), np.exp(usual), even])
    return np.minimum(angles, largest)


def _twists(rng: np.random.Generator, angles: np.ndarray) -> np.ndarray:
    lengths = 10.0 ** rng.uniform(-9, 3, len(angles))
    n, direction = (worst_cases.axes(rng, len(angles)) for _ in range(2))
    return np.concatenate([angles[:, None] * n, lengths[:, None] * direction], axis=1)


def _near_pi(rng: np.random.Generator, count: int) -> np.ndarray:
    """Poses whose angle is π - 1e-16 to π - 1e-12, where the sign of log is at stake."""
    angles = math.pi - np.maximum(
        10.0 ** rng.uniform(-16, -12, count), 8 * UNIT * rng.integers(0, 3, count)
    )
    return np.stack([exact.rounded(exact.exp(x)) for x in _twists(rng, angles)])


def _noisy(rng: np.random.Generator, R: np.ndarray) -> np.ndarray:
    return R + 10.0 ** rng.uniform(-17, -8, (len(R), 1, 1)) * rng.uniform(-1, 1, R.shape)


def _exp_ratios(rotation: Any, pose: Any, xi: np.ndarray) -> list[float]:
    T, R = pose.exp(xi), rotation.exp(xi[:, :3])
    return [
        max(error_bounds.ratio_exp(x, t), error_bounds.ratio_exp(x[:3], r))
        for x, t, r in zip(xi, T, R, strict=True)
    ]


def _log_rows(rotation: Any, pose: Any, T: np.ndarray) -> list[Row]:
    ratios, gaps = [], []
    for t, xi, w in zip(T, pose.log(T), rotation.log(T[:, :3, :3]), strict=True):
        truth = exact.log(t)
        ratios.append(max(error_bounds.ratio_to(truth, xi), error_bounds.ratio_to(truth[:3], w)))
        wrong = truth[:3] @ exact.exactly(xi[:3]) < 0 or truth[:3] @ exact.exactly(w) < 0
        gaps.append(float(exact.mp.pi - exact.norm(truth[:3])) if wrong else 0.0)
    return [
        _worst("log: error ÷ attainable", REPORT_BAR, T, ratios),
        _worst("log: largest π - θ with a wrong sign", SIGN_BAR, T, gaps),
    ]


def _noise_errors(rotation: Any, R: np.ndarray) -> list[float]:
    logarithms = rotation.log(R)
    return [error_bounds.log_error(w, exact.log(r)) for r, w in zip(R, logarithms, strict=True)]


def _jacobian_rows(name: str, pose: Any, cases: np.ndarray, many: np.ndarray) -> list[Row]:
    """Rows of the left Jacobian, or its inverse, at ξ and of the right one at -ξ: the truth is the
    same.
    """
    xi = np.concatenate([cases, worst_cases.of_jacobian(pose, f"left_{name}", many)])
    truth: Callable[[np.ndarray], np.ndarray] = getattr(exact, f"left_{name}")
    left, right = getattr(pose, f"left_{name}")(xi), getattr(pose, f"right_{name}")(-xi)
    errors: dict[str, list[tuple[float, float]]] = {"left": [], "right": []}
    for x, *sides in zip(xi, left, right, strict=True):
        expected = truth(x)
        for side, J in zip(errors, sides, strict=True):
            errors[side].append(jacobian_errors(J, expected, x))
    rows = []
    for side, pairs in errors.items():
        what = f"{side} {name.replace('_', ' ')}"
        rows.append(
            _worst(f"{what}: 3×3 block", JACOBIAN_REPORT_BAR, xi, (block for block, _ in pairs))
        )
        rows.append(
            _worst(
                f"{what}: Q block ÷ ‖v‖", JACOBIAN_REPORT_BAR, xi, (corner for _, corner in pairs)
            )
        )
    return rows


def _worst(what: str, bar: float, cases: np.ndarray, errors: Iterable[float]) -> Row:
    """The row of the largest error; NaN counts as infinite."""
    values = np.nan_to_num(np.fromiter(errors, float), nan=np.inf, posinf=np.inf)
    place = int(values.argmax())
    return Row(what, float(values[place]), bar, len(values), cases[place])
