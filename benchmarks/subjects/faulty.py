"""Eight faults that libraries had, each in a small subject that is sound otherwise, and what must
find it.
"""

from __future__ import annotations

import math
import re
import warnings
from typing import Any

import numpy as np

from poekin import se3, so3
from poekin.errors import PoekinWarning
from poekin.formats.urdf import read_text


class ExpWithoutV:
    """(a) t = R v below θ² = 1e-10."""

    twist_order = "angular first"

    def exp(self, xi: np.ndarray) -> np.ndarray:
        T = se3.exp(xi)
        if xi[:3] @ xi[:3] < 1e-10:
            T[:3, 3] = T[:3, :3] @ xi[3:]
        return T


class LogByAcos:
    """(b) θ = acos((tr R - 1)/2), and ω = θ/(2 sin θ) (R - Rᵀ), also near π."""

    def so3_log(self, R: np.ndarray) -> np.ndarray:
        w = so3.log(R)
        if w @ w < 1:
            return w
        theta = math.acos(min(max((np.trace(R) - 1) / 2, -1.0), 1.0))
        return (
            theta
            / (2 * math.sin(theta))
            * np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
        )


class LogOfNothing:
    """(c) log = 0 below 1e-8."""

    def so3_log(self, R: np.ndarray) -> np.ndarray:
        w = so3.log(R)
        return w if np.linalg.norm(w) > 1e-8 else np.zeros(3)


class ExpOfNothing:
    """(d) exp = I below 1e-6."""

    def so3_exp(self, w: np.ndarray) -> np.ndarray:
        return so3.exp(w) if np.linalg.norm(w) > 1e-6 else np.eye(3)


class JacobianWithoutV:
    """(e) the left Jacobian is I at ω = 0, whatever v is."""

    twist_order = "angular first"

    def left_jacobian(self, xi: np.ndarray) -> np.ndarray:
        return se3.left_jacobian(xi) if np.any(xi[:3]) else np.eye(6)


class JacobianOfAShortSeries:
    """(f) the coefficients of the Q block by series below θ = 0.01, the first of them one term
    short.
    """

    twist_order = "angular first"

    def left_jacobian(self, xi: np.ndarray) -> np.ndarray:
        J, (w, v) = se3.left_jacobian(xi), np.split(np.asarray(xi), 2)
        s = float(w @ w)
        if s < 1e-4:
            W, V = so3.hat(w), so3.hat(v)
            # Whole, the first would be 1/6 - s/120.
            first, second, third = 1 / 6, 1 / 24 - s / 720, 1 / 120 - s / 2520
            Q = V / 2 + first * (W @ V + V @ W + W @ V @ W)
            Q += second * (W @ W @ V + V @ W @ W - 3 * W @ V @ W)
            J[3:, :3] = Q + third * (W @ V @ W @ W + W @ W @ V @ W)
        return J


class _Reader:
    """A reader of URDFs that is sound but for what `edited` does to the text."""

    def edited(self, text: str) -> str:
        return text

    def read_urdf(self, text: str, base: str, tip: str) -> Any:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", PoekinWarning)
            chain = read_text(self.edited(text)).chain(base=base, tip=tip)

        class Arm:
            names = chain.q_names

            def fk(self, q: np.ndarray) -> np.ndarray:
                return chain.fk(q)

        return Arm()


class NearestAxis(_Reader):
    """(g) an oblique axis is replaced by the nearest axis of the frame."""

    def edited(self, text: str) -> str:
        def nearest(found: re.Match[str]) -> str:
            axis = np.array([float(x) for x in found[1].split()])
            k = int(np.argmax(np.abs(axis)))
            return f'<axis xyz="{" ".join(f"{x:g}" for x in np.sign(axis[k]) * np.eye(3)[k])}"/>'

        return re.sub(r'<axis xyz="([^"]*)"/>', nearest, text)


class NoMimic(_Reader):
    """(h) mimic is ignored."""

    def edited(self, text: str) -> str:
        return re.sub(r"<mimic[^>]*/>", "", text)


FAULTS: dict[str, tuple[type, str]] = {
    "a": (ExpWithoutV, "exp"),
    "b": (LogByAcos, "so3_log"),
    "c": (LogOfNothing, "so3_log"),
    "d": (ExpOfNothing, "so3_exp"),
    "e": (JacobianWithoutV, "left_jacobian"),
    "f": (JacobianOfAShortSeries, "left_jacobian"),
    "g": (NearestAxis, "urdf oblique axis"),
    "h": (NoMimic, "urdf mimic"),
}
"""Each subject, and the law that must find its fault."""
