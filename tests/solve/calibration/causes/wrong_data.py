"""Twenty kinds of wrong data of an arm, each with words that name its cause."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

import poekin as pk
from poekin.groups import se3
from poekin.solve.calibration import Points, simulated

REFLECTORS = np.array([[0.05, 0, 0.02], [-0.03, 0.05, 0.02], [0, -0.04, 0.06]])
BASE = se3.exp([0.3, -0.5, 0.2, 1.0, 0.4, -0.3])
TOOL = se3.exp([-0.1, 0.2, 0.4, 0.05, -0.08, 0.12])
ARMS = {"ur5": None, "panda": "panda_link8", "puma560": None, "stanford": None}
ROWS = 60


class Wrong(NamedTuple):
    """Wrong readings or measurements, and words that name what is wrong."""

    name: str
    q: np.ndarray
    measured: Any
    words: str


def arm(name: str) -> pk.Chain:
    """The nominal arm."""
    return pk.load(name).chain(tip=ARMS[name])


def wrong_data(chain: pk.Chain, seed: int) -> Iterator[Wrong]:
    """The twenty kinds, of an arm off by 2 mrad and 1 mm, measured to 0.1 mrad and mm."""
    said = simulated(chain, ROWS, seed=seed)
    q = said.q
    T = said.measurements.T  # type: ignore[attr-defined]
    p = simulated(chain, ROWS, kind="points", points=REFLECTORS, seed=seed).measurements.p  # type: ignore[attr-defined]
    three = Points(p, REFLECTORS)
    names = chain.q_names
    angles = [k for k in range(chain.dof) if chain.is_angle(k)]
    a, b, c = angles[1], angles[2], angles[-2]

    def changed(k: int, factor: float = 1.0, other: Any = 0.0) -> np.ndarray:
        moved = q.copy()
        moved[:, k] = factor * q[:, k] + other
        return moved

    yield Wrong("a sign", changed(a, -1), T, f"{names[a]} reversed")
    yield Wrong("a sign, points", changed(c, -1), three, f"{names[c]} reversed")
    yield Wrong("a zero", changed(b, other=np.pi / 2), T, f"-90° added to {names[b]}")
    yield Wrong("a zero, points", changed(a, other=-np.pi / 2), three, f"90° added to {names[a]}")
    yield Wrong("half a turn", changed(c, other=np.pi), T, f"180° added to {names[c]}")
    yield Wrong("rows shifted", np.roll(q, 1, axis=0), T, "+1 rows of q further on")
    yield Wrong("rows shifted, points", np.roll(q, -2, axis=0), three, "-2 rows of q further on")
    yield Wrong("rows reversed", q[::-1].copy(), T, "rows of q in reverse order")
    exchanged = q.copy()
    exchanged[[7, 31]] = q[[31, 7]]
    yield Wrong("two rows", exchanged, T, "the measurements of rows 7, 31 exchanged")
    plus = f"{names[b]} = {names[b]} - {names[a]}"
    yield Wrong("q3 + q2", changed(b, other=q[:, a]), T, plus)
    minus = f"{names[b]} = {names[b]} + {names[a]}"
    yield Wrong("q3 - q2", changed(b, other=-q[:, a]), three, minus)
    columns = q.copy()
    columns[:, [a, b]] = q[:, [b, a]]
    yield Wrong("two columns", columns, T, f"{names[a]} and {names[b]} exchanged")
    order = Points(p[:, [1, 2, 0]], REFLECTORS)
    yield Wrong("reflectors", q, order, "the points in the order 3, 1, 2")
    yield Wrong("a quaternion", q, misread(T), "quaternions in the order x y z w")
    yield Wrong("inverse poses", q, se3.inverse(T), "the poses inverted")
    yield Wrong("the flange", q, T @ TOOL, "the tool moved by ")
    yield Wrong("a point forgotten", q, Points(p[:, 0]), "points=(")
    device = (p[:, 0] - BASE[:3, 3]) @ BASE[:3, :3]
    yield Wrong("a frame forgotten", q, Points(device, REFLECTORS[0]), "frame='unknown'")
    degrees = q.copy()
    degrees[:, angles] = np.rad2deg(q[:, angles])
    yield Wrong("degrees", degrees, T, "look like degrees")
    millimetres = T.copy()
    millimetres[:, :3, 3] *= 1e3
    yield Wrong("millimetres", q, millimetres, "look like millimetres")


def misread(T: np.ndarray) -> np.ndarray:
    """Poses of whose quaternions x, y, z, w were read as w, x, y, z."""
    w = pk.so3.log(T[:, :3, :3])
    half = np.linalg.norm(w, axis=1, keepdims=True) / 2
    x = np.sin(half) * w / (2 * half)
    found = T.copy()
    for k, (scalar, vector) in enumerate(zip(np.cos(half)[:, 0], x, strict=True)):
        wxyz = [vector[0], vector[1], vector[2], scalar]
        found[k, :3, :3] = rotation(*wxyz)
    return found


def rotation(w: float, x: float, y: float, z: float) -> np.ndarray:
    """Rotation of a unit quaternion."""
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip
