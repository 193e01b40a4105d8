"""Hypothesis strategies, laws and oracles, for poekin's own tests and for other projects' tests.

strategies: what to try
    group_strategies   angles, axes, vectors, rotations, noisy rotations, twists, poses
    batch_strategies   batches of them, and their shapes
    near_strategies    the same close to 0, to π or to any other angle
    chain_strategies   screws, chains, coordinates
    configuration_strategies  configurations within and at limits, singular ones
    robot_strategies   robots: whole trees, with mimic joints, limits and several leaves
    urdf_strategies    URDF texts with what files in the wild have in them
    dh_strategies      Denavit-Hartenberg tables
    decoding.bytes_reader  random bytes read as numbers, to write strategies like these

laws: what must hold, as plain functions that raise LawViolation with the error and its bound
    laws, measures     LawViolation, and how an error is measured
    group, group_laws, adjoint_laws
                       SO(3) and SE(3) as plain functions, and their laws

oracles: what is true, by code that shares nothing with what it judges
    exact              so(3) and se(3) in 60 digits and more (mpmath)
    exact_chain        poses and Jacobians of a serial chain, as exact
    differences        finite differences on the group
    pinocchio_oracle   poses and Jacobians of a URDF by Pinocchio

accuracy: how far exp, log and the Jacobians of exp are from the truth
    accuracy_laws      each of them against `oracles.exact`
    error_bounds       what float64 can attain for exp and log, and how far a result is from it
    falsify            shows that a battery of laws catches a planted error

conform: holds any library to the laws, and grades it: `poekin conform`

Importing `poekin.testing` imports none of them: oracles and laws need mpmath, strategies and
`falsify` hypothesis, and each says so with `MissingExtra` where it is absent (`pip install
'poekin[testing]'`).
"""

from __future__ import annotations

import importlib
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from . import accuracy, conform, laws, oracles, strategies

__all__ = ["accuracy", "conform", "laws", "oracles", "strategies"]


def __getattr__(name: str) -> ModuleType:
    if name in __all__:
        return importlib.import_module(f"{__name__}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
