"""Hypothesis strategies, laws and oracles, for poekin's own tests and for other projects' tests.

    exact              so(3) and se(3) in 60 digits and more (mpmath); shares no code with the package
    attainable         what float64 can attain for exp and log, and how far a result is from it
    differences        finite differences on the group
    pinocchio_oracle   poses and Jacobians of a URDF by Pinocchio
    strategies         Hypothesis strategies: angles, axes, twists, poses, noisy rotations
    chain_strategies   Hypothesis strategies: screws, chains, configurations
    configuration_strategies  Hypothesis strategies: configurations within and at limits, singular ones
    dh_strategies      Hypothesis strategies: Denavit-Hartenberg tables
    reader             random bytes read as numbers, which the strategies are made of
    laws, measures     LawViolation, and how an error is measured
    group, group_laws  SO(3) and SE(3) as plain functions, and their laws
    accuracy_laws      exp, log and the Jacobians of exp against `exact`
    near_laws          the branches of log
    chain_laws         laws of a serial chain
    change_laws        laws of a chain with another base, tool, zero position or link frames
    method_laws        the algorithms for the Jacobian agree
    hunting            shows that a battery of laws catches a planted error
    conform            holds any library to the laws, and grades it: `poekin conform`
    accuracy           the worst errors of exp, log and the Jacobians, as rows of a report; `extended` and `suspects`
                       find the cases for it

Importing `poekin.testing` imports none of them: oracles and laws need mpmath, strategies and
`hunting` hypothesis, and each says so with `MissingExtra` where it is absent (`pip install 'poekin[testing]'`).
"""

from __future__ import annotations

import importlib
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from . import (
        accuracy,
        accuracy_laws,
        attainable,
        chain_laws,
        chain_strategies,
        change_laws,
        configuration_strategies,
        conform,
        dh_strategies,
        differences,
        exact,
        extended,
        group,
        group_laws,
        hunting,
        laws,
        measures,
        method_laws,
        near_laws,
        pinocchio_oracle,
        reader,
        strategies,
        suspects,
    )

__all__ = [
    "accuracy",
    "accuracy_laws",
    "attainable",
    "chain_laws",
    "chain_strategies",
    "change_laws",
    "configuration_strategies",
    "conform",
    "dh_strategies",
    "differences",
    "exact",
    "extended",
    "group",
    "group_laws",
    "hunting",
    "laws",
    "measures",
    "method_laws",
    "near_laws",
    "pinocchio_oracle",
    "reader",
    "strategies",
    "suspects",
]


def __getattr__(name: str) -> ModuleType:
    if name in __all__:
        return importlib.import_module(f"{__name__}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
