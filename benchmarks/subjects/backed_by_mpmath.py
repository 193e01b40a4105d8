"""Subjects without a fault, to see that none is found: all they do is done in 60 digits and rounded
once.

The formulas are those of `closed_formulas`; URDFs are read with the standard library. Nothing is
shared with `poekin.testing.oracles.exact` and the small URDFs' own meaning.
"""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from typing import Any

import numpy as np

from .closed_formulas import (
    DIGITS,
    P,
    P_inverse,
    Q,
    exp,
    eye,
    floats,
    hat,
    lower,
    moved,
    mp,
    numbers,
    pose,
    precision,
    rotation,
    rotation_vector,
    skew_size,
)


class Angular:
    """Twists (omega; v), Jacobians in the space frame."""

    name = "backed by mpmath"
    twist_order = "angular first"
    jacobian_frame = "space"
    helical = True
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

    def read_robot(self, text: str) -> Any:
        return Whole(self, text)


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


class Read:
    """An arm out of a URDF: poses link by link, in 200 digits."""

    def __init__(self, subject: Angular, text: str, base: str, tip: str):
        self.subject = subject
        every = list(ElementTree.fromstring(text).iter("joint"))
        below = {_link(joint, "child"): joint for joint in every}
        self.joints: list[ElementTree.Element] = []
        while tip != base:
            self.joints.insert(0, below[tip])
            tip = _link(below[tip], "parent")
        # All coordinates of the robot: a joint may mimic one that is elsewhere.
        moving = [
            joint for joint in every if joint.get("type") != "fixed" and joint.find("mimic") is None
        ]
        self.names = [str(joint.get("name")) for joint in moving]

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
            mimic, name, factor, shift = (
                joint.find("mimic"),
                str(joint.get("name")),
                mp.mpf(1),
                mp.mpf(0),
            )
            if mimic is not None:
                name, factor = str(mimic.get("joint")), mp.mpf(float(mimic.get("multiplier", 1)))
                shift = mp.mpf(float(mimic.get("offset", 0)))
            x = factor * mp.mpf(float(values[name])) + shift
            axis = joint.find("axis")
            n = numbers(
                [1.0, 0, 0] if axis is None else [float(a) for a in str(axis.get("xyz")).split()]
            )
            n = n / mp.sqrt(n @ n)
            S = np.concatenate([0 * n, n] if joint.get("type") == "prismatic" else [n, 0 * n])
            column = self.names.index(name)
            J[:, column] = J[:, column] + factor * (lower(T[:3, :3], hat(T[:3, 3]) @ T[:3, :3]) @ S)
            T = T @ exp(S * x)
        return T, J


class Whole:
    """A robot out of a URDF: of each link the arm that ends there."""

    def __init__(self, subject: Angular, text: str):
        links = [str(link.get("name")) for link in ElementTree.fromstring(text).iter("link")]
        self.arms = {link: Read(subject, text, links[0], link) for link in links}
        self.names = self.arms[links[0]].names

    def poses(self, q: np.ndarray) -> dict[str, np.ndarray]:
        return {link: arm.fk(q) for link, arm in self.arms.items()}


def _link(joint: ElementTree.Element, which: str) -> str:
    element = joint.find(which)
    return "" if element is None else str(element.get("link"))


def _origin(joint: ElementTree.Element) -> np.ndarray:
    origin = joint.find("origin")
    if origin is None:
        return eye(4)
    (r, p, y), xyz = (
        numbers([float(a) for a in origin.get(key, "0 0 0").split()]) for key in ("rpy", "xyz")
    )
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
