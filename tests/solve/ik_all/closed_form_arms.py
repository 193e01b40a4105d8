"""Arms that have a closed form, drawn at random, and how far branches are from what they are asked
for.
"""

from __future__ import annotations

import numpy as np

import poekin as pk
from poekin.solve.ik_all.closed_form import ClosedForm


def unit(rng: np.random.Generator, square: bool = False) -> np.ndarray:
    """A direction, along an axis of the base where the arm is `square`."""
    if square:
        return rng.choice([-1.0, 1.0]) * np.eye(3)[rng.integers(0, 3)]
    h = rng.normal(size=3)
    return h / np.linalg.norm(h)


def wrist(rng: np.random.Generator, square: bool) -> list[np.ndarray]:
    """Three axes through a point, square to each other or clearly slanted."""
    place = rng.uniform(-0.5, 0.5, 3)
    h = unit(rng)
    across = np.cross(h, unit(rng))
    across /= np.linalg.norm(across)
    slant = 0.0 if square else rng.uniform(-0.8, 0.8)
    second = slant * h + np.sqrt(1 - slant**2) * across
    third = h if square else second * 0.3 + np.sqrt(1 - 0.09) * np.cross(second, unit(rng))
    third /= np.linalg.norm(third)
    return [pk.screw.revolute(z, place) for z in (h, second, third)]


def parallels(rng: np.random.Generator) -> list[np.ndarray]:
    """Three parallel axes, some of them in the other direction."""
    h = unit(rng)
    places = rng.uniform(-0.5, 0.5, (3, 3))
    return [pk.screw.revolute(rng.choice([-1.0, 1.0]) * h, p) for p in places]


def arm(seed: int, group: str, first: int, others: str, square: bool = False) -> pk.Chain:
    """An arm of three axes that meet or are parallel, and other joints: "R" turns, "P" slides."""
    rng = np.random.default_rng(seed)
    three = wrist(rng, square) if group == "wrist" else parallels(rng)
    rest = [
        pk.screw.revolute(unit(rng, square), rng.uniform(-0.6, 0.6, 3))
        if kind == "R"
        else pk.screw.prismatic(unit(rng, square))
        for kind in others
    ]
    home = pk.se3.exp(np.concatenate([rng.uniform(-1, 1, 3), rng.uniform(-0.6, 0.6, 3)]))
    return pk.Chain.from_space([*rest[:first], *three, *rest[first:]], home)


def planar_arm(seed: int, first: int, kinds: str) -> pk.Chain:
    """An arm of three joints that move in a plane, and three revolute ones."""
    rng = np.random.default_rng(seed)
    n = unit(rng)
    three = []
    for kind in kinds:
        if kind == "R":
            three.append(pk.screw.revolute(rng.choice([-1.0, 1.0]) * n, rng.uniform(-0.5, 0.5, 3)))
        else:
            way = np.cross(n, unit(rng))
            three.append(pk.screw.prismatic(way / np.linalg.norm(way)))
    rest = [pk.screw.revolute(unit(rng), rng.uniform(-0.6, 0.6, 3)) for _ in range(3)]
    home = pk.se3.exp(rng.uniform(-0.6, 0.6, 6))
    return pk.Chain.from_space([*rest[:first], *three, *rest[first:]], home)


def configurations(chain: pk.Chain, seed: int, count: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    q = rng.uniform(-np.pi, np.pi, (count, chain.dof))
    q[:, sliding(chain)] *= 0.2
    return q


def sliding(chain: pk.Chain) -> np.ndarray:
    return np.array([kind == "prismatic" for kind in chain.kinds])


def apart(chain: pk.Chain, rows: np.ndarray, q: np.ndarray) -> np.ndarray:
    """How far (N,) the nearest branch is from each configuration, inf without any."""
    off = rows - q[:, None]
    turns = ~sliding(chain)
    off[:, :, turns] = np.remainder(off[:, :, turns] + np.pi, 2 * np.pi) - np.pi
    worst = np.abs(off).max(axis=2)
    return np.where(np.isnan(worst), np.inf, worst).min(axis=1)


def pose_errors(chain: pk.Chain, rows: np.ndarray, T: np.ndarray) -> np.ndarray:
    """Largest entry (N, 16) of the poses' difference, NaN where there is no branch."""
    found = chain.fk(np.nan_to_num(rows))
    worst = np.abs(found - T[:, None]).max(axis=(2, 3))
    return np.where(np.isnan(rows).any(axis=2), np.nan, worst)


def regular(chain: pk.Chain, q: np.ndarray, least: float = 1e-3) -> np.ndarray:
    """Whether configurations are clear of singular ones."""
    return clearance(chain, q) > least


def clearance(chain: pk.Chain, q: np.ndarray) -> np.ndarray:
    """Smallest singular value of the Jacobian in reaches, as a share of the largest."""
    J = chain.jacobian(q, frame="hybrid")
    J[..., 3:, :] /= chain.reach
    sizes = np.linalg.svd(J, compute_uv=False)
    return sizes[..., -1] / sizes[..., 0]


def silently_missed(chain: pk.Chain, found: ClosedForm, q: np.ndarray, near: float) -> int:
    """Number of regular configurations that no branch is near, of targets that are not said to be
    unsure.
    """
    T = chain.fk(q)
    rows, _ = found.rows(T)
    *_, unsure = found.starts(T)
    missed = (apart(chain, rows, q) > near) & regular(chain, q)
    missed[unsure] = False
    return int(missed.sum())
