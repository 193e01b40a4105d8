"""Columns of effects: how each that a calibration left out would change the measured numbers."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Literal, NamedTuple

import numpy as np

from .....errors import escape_unprintable
from .....groups import se3
from .....groups.arrays import Array
from .....groups.vectors import rotation_part, translation_part
from ...fit.fitting import Fit
from ...measurements.points import Points
from ...model.problem import Problem
from ...terms.conditions import Conditions
from ...terms.named import BUILDERS

EffectKind = Literal[
    "gravity", "angle", "lag", "backlash", "drift", "place", "set", "reflector", "loose"
]
_KIND_OF_TERM: dict[str, EffectKind] = {
    "compliance": "gravity",
    "harmonics": "angle",
    "second harmonics": "angle",
    "lag": "lag",
    "backlash": "backlash",
}
_OF_EACH = ("gravity", "angle")  # the others are of all joints together
_PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


class Effect(NamedTuple):
    """One effect: its kind, whose it is, in words, and its whitened columns (M, d)."""

    kind: EffectKind
    whose: str
    columns: Array


def effects(
    problem: Problem,
    fit: Fit,
    conditions: Conditions,
) -> list[Effect]:
    """All effects that are tested, but for loose reflectors."""
    every = twists(problem, fit.p, conditions)
    widths = [D.shape[2] for D in every.values()]
    *inner, _ = np.cumsum(widths)
    D = np.concatenate(list(every.values()), axis=2)
    J = problem.along_twists(fit.p, D)
    whitened = []
    for k, of_set in enumerate(J):
        columns = fit.noise.whitened(k, of_set)
        whitened.append(columns.reshape(-1, D.shape[2]))
    of_each = np.split(np.concatenate(whitened), inner, axis=1)
    columns = dict(zip(every, of_each, strict=True))
    base = columns.pop(_BASE)
    found = [Effect(*name, of_name) for name, of_name in columns.items()]
    return [*found, *_of_sets(problem, base), *_of_reflectors(problem, fit)]


_Name = tuple[EffectKind, str]
_BASE: _Name = ("set", "")


def twists(
    problem: Problem,
    p: Array,
    conditions: Conditions,
) -> dict[_Name, Array]:
    """Space twists (N, 6, d) of the tip at the readings for each effect that moves it."""
    model = problem.model
    q = problem.q
    J = problem.reading_twists(p)
    pieces: dict[_Name, list[Array]] = {}
    every = np.arange(model.nominal.dof)
    names = model.nominal.q_names
    for word, kind in _KIND_OF_TERM.items():
        for term in BUILDERS[word](model.nominal, every, model.reference):
            moved = J @ term.basis(q, conditions)
            for k, parameter in enumerate(term.parameters):
                whose = ""
                if kind in _OF_EACH:
                    whose = joint_name(names.index(parameter.owner), parameter.owner)
                pieces.setdefault((kind, whose), []).append(moved[..., k : k + 1])
    found = {name: np.concatenate(own, axis=2) for name, own in pieces.items()}
    base = np.tile(np.eye(6), (len(q), 1, 1))
    found["drift", ""] = base * conditions.drift[:, None, None]
    found["place", ""] = _strains(problem, p)
    found[_BASE] = base
    return found


def joint_name(
    k: int,
    name: str,
) -> str:
    """Name of a joint in a sentence: its number from 1, and what it is called."""
    return f"joint {k + 1} ({escape_unprintable(name, 60)})"


def _strains(
    problem: Problem,
    p: Array,
) -> Array:
    """Twists (N, 6, 6) that move the tip by a strain of space, e_ij = e_ji, about its middle place."""
    T = problem.poses(p)
    places = translation_part(T)
    places = places - places.mean(axis=0)
    found = np.zeros((len(T), 6, 6))
    for k, (i, j) in enumerate(_PAIRS):
        found[:, 3 + i, k] = places[:, j]
        found[:, 3 + j, k] = places[:, i]
    return found


def parts(problem: Problem) -> list[slice]:
    """Places of the errors of each set among all."""
    ends = itertools.accumulate((len(s) * s.width for s in problem.sets), initial=0)
    return list(itertools.starmap(slice, itertools.pairwise(ends)))


def _of_sets(
    problem: Problem,
    base: Array,
) -> Iterator[Effect]:
    """Each set of several moved as a whole against the others."""
    if len(problem.sets) == 1:
        return
    for k, part in enumerate(parts(problem)):
        columns = np.zeros_like(base)
        columns[part] = base[part]
        yield Effect("set", f"measurement set {k} ({problem.sets[k].what})", columns)


def _of_reflectors(
    problem: Problem,
    fit: Fit,
) -> Iterator[Effect]:
    """Each point of a set of several moved in the axes of the tool."""
    total = problem.n_equations
    for k, part in enumerate(parts(problem)):
        s = problem.sets[k]
        count = s.width // 3
        if not isinstance(s, Points) or count < 2:
            continue
        shifts = fit.noise.whitened(k, point_shifts(problem, fit.p, k))
        for j in range(count):
            columns = np.zeros((total, 3))
            columns[part] = shifts[..., 3 * j : 3 * j + 3].reshape(-1, 3)
            yield Effect("reflector", reflector_name(problem, k, j), columns)


def reflector_name(
    problem: Problem,
    k: int,
    j: int,
) -> str:
    """Name of a reflector: its number from 1, and its set where there are several."""
    which = f" of measurement set {k}" if len(problem.sets) > 1 else ""
    return f"reflector {j + 1}{which}"


def point_shifts(
    problem: Problem,
    p: Array,
    k: int,
) -> Array:
    """Changes (N, 3k, 3k) of the errors of set k of points, where each is moved in the tool's axes."""
    s = problem.sets[k]
    T = problem.poses(p)[problem.rows[k]]
    for frame in problem.frames_of_set(k, p):
        if frame.ndim == 2:  # a device; the others are points
            T = se3.inverse(frame) @ T
    R = rotation_part(T)
    count = s.width // 3
    of_points = np.einsum("ab,nij->naibj", np.eye(count), R)
    return of_points.reshape(len(T), s.width, s.width)
