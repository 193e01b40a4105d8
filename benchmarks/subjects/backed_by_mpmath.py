"""Subjects without a fault, to see that none is found: all they do is done in 60 digits and rounded once.

The formulas are the textbooks' closed ones, evaluated with so many digits that nothing cancels; log is by the largest
eigenvector of a symmetric 4×4; URDFs are read with the standard library. Nothing is shared with `poekin.testing.exact`,
which is made of series, Newton's method and another reader.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ElementTree
from typing import Any

import mpmath
import numpy as np

mp: Any = mpmath.mp.clone()
DIGITS = 60

_to_mpf = np.frompyfunc(mp.mpf, 1, 1)


def numbers(x: Any) -> np.ndarray:
    """Floats as mpmath numbers."""
    return np.asarray(_to_mpf(np.asarray(x)), dtype=object)


def floats(x: np.ndarray) -> np.ndarray:
    """The nearest floats."""
    return np.asarray(np.frompyfunc(float, 1, 1)(x), dtype=float)


def hat(w: np.ndarray) -> np.ndarray:
    """[w]."""
    x, y, z = w
    nought = mp.mpf(0)
    return np.array([[nought, -z, y], [z, nought, -x], [-y, x, nought]], dtype=object)


def eye(n: int) -> np.ndarray:
    """The identity."""
    return numbers(np.eye(n))


def precision(w: Any) -> Any:
    """So many digits that θ^-5 times a difference of terms near 1 keeps DIGITS of them."""
    largest = max(abs(float(x)) for x in w)
    return mp.workdps(DIGITS + (6 * max(0, -math.floor(math.log10(largest))) if largest else 0))


def rotation(w: np.ndarray) -> np.ndarray:
    """Rodrigues' formula."""
    theta = mp.sqrt(w @ w)
    if theta == 0:
        return eye(3)
    W = hat(w / theta)
    return eye(3) + mp.sin(theta) * W + (1 - mp.cos(theta)) * (W @ W)


def P(w: np.ndarray) -> np.ndarray:
    """The left Jacobian of SO(3), in closed form."""
    theta = mp.sqrt(w @ w)
    if theta == 0:
        return eye(3)
    W = hat(w / theta)
    return eye(3) + (1 - mp.cos(theta)) / theta * W + (1 - mp.sin(theta) / theta) * (W @ W)


def P_inverse(w: np.ndarray) -> np.ndarray:
    """Its inverse, in closed form."""
    theta = mp.sqrt(w @ w)
    if theta == 0:
        return eye(3)
    W = hat(w / theta)
    return eye(3) - theta / 2 * W + (1 - theta / 2 * mp.cot(theta / 2)) * (W @ W)


def Q(w: np.ndarray, v: np.ndarray) -> np.ndarray:
    """The lower block of the left Jacobian of SE(3), in closed form (Barfoot, State Estimation for Robotics)."""
    theta, W, V = mp.sqrt(w @ w), hat(w), hat(v)
    if theta == 0:
        return V / 2
    s, c, t2 = mp.sin(theta), mp.cos(theta), theta**2
    first, second = (theta - s) / theta**3, (1 - t2 / 2 - c) / t2**2
    third = (second - 3 * (theta - s - theta**3 / 6) / theta**5) / 2
    WV, VW = W @ V, V @ W
    WVW = W @ VW
    Q = V / 2 + first * (WV + VW + WVW) - second * (W @ WV + VW @ W - 3 * WVW)
    return Q - third * (WVW @ W + W @ WVW)


def lower(P: np.ndarray, Q: np.ndarray) -> np.ndarray:
    """[P 0; Q P]."""
    return np.block([[P, numbers(np.zeros((3, 3)))], [Q, P]])


def pose(R: np.ndarray, t: np.ndarray) -> np.ndarray:
    """[R t; 0 1]."""
    T = eye(4)
    T[:3, :3], T[:3, 3] = R, t
    return T


def exp(xi: np.ndarray) -> np.ndarray:
    """e^ξ."""
    return pose(rotation(xi[:3]), P(xi[:3]) @ xi[3:])


def rotation_vector(R: np.ndarray) -> np.ndarray:
    """ω of the rotation nearest to R: the quaternion is the eigenvector of the largest eigenvalue (Horn 1987)."""
    a = R.T.ravel()  # by columns
    xx, yx, zx, xy, yy, zy, xz, yz, zz = a
    K = [
        [xx + yy + zz, zy - yz, xz - zx, yx - xy],
        [zy - yz, xx - yy - zz, xy + yx, xz + zx],
        [xz - zx, xy + yx, yy - xx - zz, yz + zy],
        [yx - xy, xz + zx, yz + zy, zz - xx - yy],
    ]
    values, vectors = mp.eigsy(mp.matrix(K))
    q = np.array(list(vectors[:, max(range(4), key=lambda k: values[k])]), dtype=object)
    q = -q if q[0] < 0 else q
    sine = mp.sqrt(q[1:] @ q[1:])
    return q[1:] * 0 if sine == 0 else q[1:] / sine * (2 * mp.atan2(sine, q[0]))


def skew_size(R: np.ndarray) -> np.ndarray:
    """The entries of R - Rᵀ: how small the rotation is, or how near π."""
    skew = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]], dtype=float)
    return skew if np.any(skew) else np.ones(3)


class Angular:
    """Twists (omega; v), Jacobians in the space frame."""

    name = "backed by mpmath"
    twist_order = "angular first"
    jacobian_frame = "space"
    noise = 1e-8

    def so3_exp(self, w: np.ndarray) -> np.ndarray:
        with mp.workdps(DIGITS):
            return floats(rotation(numbers(w)))

    def so3_log(self, R: np.ndarray) -> np.ndarray:
        with precision(skew_size(R)):
            return floats(rotation_vector(numbers(R)))

    def so3_left_jacobian(self, w: np.ndarray) -> np.ndarray:
        with precision(w):
            return floats(P(numbers(w)))

    def so3_right_jacobian(self, w: np.ndarray) -> np.ndarray:
        with precision(w):
            return floats(P(numbers(w)).T)

    def so3_left_jacobian_inverse(self, w: np.ndarray) -> np.ndarray:
        with precision(w):
            return floats(P_inverse(numbers(w)))

    def so3_right_jacobian_inverse(self, w: np.ndarray) -> np.ndarray:
        with precision(w):
            return floats(P_inverse(numbers(w)).T)

    def _in(self, xi: np.ndarray) -> np.ndarray:
        return numbers(xi)

    def _square(self, X: np.ndarray) -> np.ndarray:
        return floats(X)

    def exp(self, xi: np.ndarray) -> np.ndarray:
        x = self._in(xi)
        with precision(x[:3]):
            return floats(exp(x))

    def log(self, T: np.ndarray) -> np.ndarray:
        with precision(skew_size(T)):
            X = numbers(T)
            w = rotation_vector(X[:3, :3])
            return self._rows(np.concatenate([w, P_inverse(w) @ X[:3, 3]]))

    def adjoint(self, T: np.ndarray) -> np.ndarray:
        with mp.workdps(DIGITS):
            X = numbers(T)
            return self._square(lower(X[:3, :3], hat(X[:3, 3]) @ X[:3, :3]))

    def left_jacobian(self, xi: np.ndarray) -> np.ndarray:
        x = self._in(xi)
        with precision(x[:3]):
            return self._square(lower(P(x[:3]), Q(x[:3], x[3:])))

    def right_jacobian(self, xi: np.ndarray) -> np.ndarray:
        return self.left_jacobian(-np.asarray(xi))

    def left_jacobian_inverse(self, xi: np.ndarray) -> np.ndarray:
        x = self._in(xi)
        with precision(x[:3]):
            inverse = P_inverse(x[:3])
            return self._square(lower(inverse, -(inverse @ Q(x[:3], x[3:]) @ inverse)))

    def right_jacobian_inverse(self, xi: np.ndarray) -> np.ndarray:
        return self.left_jacobian_inverse(-np.asarray(xi))

    def _rows(self, x: np.ndarray) -> np.ndarray:
        return floats(x)

    def _screws(self, screws: np.ndarray) -> np.ndarray:
        return numbers(screws)

    def fk(self, screws: np.ndarray, home: np.ndarray, q: np.ndarray) -> np.ndarray:
        with mp.workdps(200):
            return floats(moved(self._screws(screws), numbers(q))[0] @ numbers(home))

    def jacobian(self, screws: np.ndarray, home: np.ndarray, q: np.ndarray) -> np.ndarray:
        with mp.workdps(200):
            return self._rows(moved(self._screws(screws), numbers(q))[1])

    def read_urdf(self, text: str, base: str, tip: str) -> Any:
        return Read(self, text, base, tip)


class Linear(Angular):
    """Twists (v; omega), otherwise the same."""

    twist_order = "linear first"

    def _in(self, xi: np.ndarray) -> np.ndarray:
        return numbers(np.roll(xi, 3))

    def _square(self, X: np.ndarray) -> np.ndarray:
        return floats(np.roll(X, (3, 3), (0, 1)))

    def _rows(self, x: np.ndarray) -> np.ndarray:
        return floats(np.roll(x, 3, 0))

    def _screws(self, screws: np.ndarray) -> np.ndarray:
        return numbers(np.roll(screws, 3, 1))


def moved(screws: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The product of exponentials and the space Jacobian."""
    T, columns = eye(4), []
    for S, x in zip(screws, q, strict=True):
        R, t = T[:3, :3], T[:3, 3]
        columns.append(lower(R, hat(t) @ R) @ S)
        T = T @ exp(S * x)
    return T, np.array(columns, dtype=object).reshape(-1, 6).T


class Read:
    """An arm out of a URDF: poses link by link, in 200 digits."""

    def __init__(self, subject: Angular, text: str, base: str, tip: str):
        self.subject = subject
        below = {joint.find("child").get("link"): joint for joint in ElementTree.fromstring(text).iter("joint")}  # type: ignore[union-attr]
        self.joints: list[ElementTree.Element] = []
        while tip != base:
            self.joints.insert(0, below[tip])
            tip = below[tip].find("parent").get("link")  # type: ignore[union-attr]
        moving = [joint for joint in self.joints if joint.get("type") != "fixed"]
        self.names = [str(joint.get("name")) for joint in moving if joint.find("mimic") is None]

    def fk(self, q: np.ndarray) -> np.ndarray:
        with mp.workdps(200):
            return floats(self._walked(q)[0])

    def jacobian(self, q: np.ndarray) -> np.ndarray:
        with mp.workdps(200):
            return self.subject._rows(self._walked(q)[1])

    def _walked(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        values = dict(zip(self.names, q, strict=True))
        T, J = eye(4), numbers(np.zeros((6, len(q))))
        for joint in self.joints:
            T = T @ _origin(joint)
            if joint.get("type") == "fixed":
                continue
            mimic, name, factor, shift = joint.find("mimic"), str(joint.get("name")), mp.mpf(1), mp.mpf(0)
            if mimic is not None:
                name, factor = str(mimic.get("joint")), mp.mpf(float(mimic.get("multiplier", 1)))
                shift = mp.mpf(float(mimic.get("offset", 0)))
            x = factor * mp.mpf(float(values[name])) + shift
            axis = joint.find("axis")
            n = numbers([1.0, 0, 0] if axis is None else [float(a) for a in str(axis.get("xyz")).split()])
            n = n / mp.sqrt(n @ n)
            S = np.concatenate([0 * n, n] if joint.get("type") == "prismatic" else [n, 0 * n])
            column = self.names.index(name)
            J[:, column] = J[:, column] + factor * (lower(T[:3, :3], hat(T[:3, 3]) @ T[:3, :3]) @ S)
            T = T @ exp(S * x)
        return T, J


def _origin(joint: ElementTree.Element) -> np.ndarray:
    origin = joint.find("origin")
    if origin is None:
        return eye(4)
    (r, p, y), xyz = (numbers([float(a) for a in origin.get(key, "0 0 0").split()]) for key in ("rpy", "xyz"))
    cr, sr, cp, sp, cy, sy = (f(a) for a in (r, p, y) for f in (mp.cos, mp.sin))
    R = np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ],
        dtype=object,
    )
    return pose(R, xyz)
