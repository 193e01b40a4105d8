"""Candidates of a design: configurations that are given or drawn, within the limits and allowed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ....checks import is_whole
from ....errors import InputError, ShapeError, quote, safe_repr
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.checks import finite
from ....model.coordinates import coordinates
from ....model.readings.coupled import beyond_own_limits, joint_values

Predicate = Callable[[Array, Array], Any]
"""Function of configurations q (N, m) and poses T_base_tip (N, 4, 4) that says which are allowed,
(N,) of bool.
"""
WORKSPACE = 1000
"""Configurations that are drawn for a workspace that a predicate says."""
DRAWS = 100
"""Times as many as are asked for that are drawn at most, where predicates leave few."""


def parse_predicates(given: Any, name: str) -> list[Predicate]:
    """Predicates, of one, several, or none (None). Raises: InputError."""
    if given is None:
        return []
    several = given if isinstance(given, (list, tuple)) else [given]
    for one in several:
        if not callable(one):
            raise InputError(
                f"{name}: expected a function of q (N, m) and T (N, 4, 4) that says which are "
                f"allowed, such as WorkspaceBox or ViewCone, or a list of them, got {safe_repr(one)}"
            )
    return list(several)


def allowed_rows(
    chain: Chain,
    q: Array,
    predicates: Sequence[Predicate],
    name: str,
) -> np.ndarray:
    """Whether each configuration (N, m) is allowed by all predicates, (N,) of bool.

    Raises: ShapeError for a predicate that returns anything else than N booleans.
    """
    allowed = np.ones(len(q), bool)
    T = chain.fk(q)
    for predicate in predicates:
        found = np.asarray(predicate(q, T))
        if found.dtype != bool or found.shape != allowed.shape:
            raise ShapeError(
                f"{name}: expected {len(q)} booleans, one for each configuration, got "
                f"{found.dtype.name} of shape {found.shape}"
            )
        allowed &= found
    return allowed


def drawn(
    chain: Chain,
    count: int,
    seed: Any,
    predicates: Sequence[Predicate],
    name: str,
) -> Array:
    """Configurations (count, m) drawn within the limits that the predicates allow. Raises: InputError
    where they allow next to none.
    """
    rng = np.random.default_rng(seed)
    parts = []
    found = 0
    for _ in range(DRAWS):
        q = chain.random(rng, count)
        part = q[allowed_rows(chain, q, predicates, name)]
        parts.append(part)
        found += len(part)
        if found >= count:
            return np.concatenate(parts)[:count]
    raise InputError(
        f"{name}: {found} of {DRAWS * count} configurations drawn within the limits are allowed, "
        f"{count} are needed: expected predicates that allow more, or candidates (K, m) that they allow"
    )


def parse_candidates(
    chain: Chain,
    candidates: Any,
    seed: int,
    allowed: Any,
) -> tuple[Array, np.ndarray]:
    """The candidates (K, m), finite and within the limits, and the rows of those that are allowed."""
    predicates = parse_predicates(allowed, "allowed")
    if is_whole(candidates, 1):
        count = int(candidates)
        return drawn(chain, count, seed, predicates, "allowed"), np.arange(count)
    q = _configurations(chain, candidates, "candidates")
    _check_limits(chain, q)
    return q, np.flatnonzero(allowed_rows(chain, q, predicates, "allowed"))


def parse_workspace(
    chain: Chain,
    workspace: Any,
    seed: int,
) -> Array:
    """Configurations (K, m) of a workspace: as they are given, or drawn where predicates say it."""
    if callable(workspace) or (
        isinstance(workspace, (list, tuple)) and any(map(callable, workspace))
    ):
        predicates = parse_predicates(workspace, "workspace")
        return drawn(chain, WORKSPACE, (seed, 2), predicates, "workspace")
    return _configurations(chain, workspace, "workspace")


def parse_measured(chain: Chain, measured: Any) -> Array:
    """Configurations (M, m) that were measured before, none of them where None."""
    if measured is None:
        return np.empty((0, chain.dof))
    return _configurations(chain, measured, "measured")


def _configurations(chain: Chain, given: Any, name: str) -> Array:
    """Configurations (K, m), finite. Raises: ShapeError, InputError."""
    scalar = given is None or isinstance(given, (str, int, float, np.generic))
    q = np.empty(()) if scalar else coordinates(given, chain.q_names, name)
    if q.ndim != 2:
        to_draw = ", or how many to draw" * (name == "candidates")
        raise ShapeError(
            f"{name}: expected configurations (K, {chain.dof}){to_draw}, got {safe_repr(given)}"
        )
    return finite(q, name)


def _check_limits(chain: Chain, q: Array) -> None:
    """Refuse coordinates beyond their limits, and joints beyond their own."""
    values = np.hstack([q, joint_values(chain, q)])
    lower, upper = np.vstack([chain.limits, chain.joint_limits]).T
    bad = (values < lower) | (values > upper)
    # a sum of coordinates may be beyond by rounding
    bad[:, chain.dof :] = beyond_own_limits(chain, q)
    for row, k in np.argwhere(bad).tolist():
        many = int(bad.any(axis=1).sum())
        others = f"; {many} of the {len(q)} candidates cannot be taken" * (many > 1)
        joint = "joint " * (k >= chain.dof)
        name = (*chain.q_names, *chain.joint_names)[k]
        raise InputError(
            f"candidates[{row}]: {joint}{quote(name)} = {values[row, k]:.6g} is outside its limits "
            f"{lower[k]:.6g} to {upper[k]:.6g}{others}"
        )
