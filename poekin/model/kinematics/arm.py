"""The arm that a function is given: a chain, or a compiled one."""

from __future__ import annotations

from typing import Any

from ...errors import InputError, safe_repr
from ..chain import Chain
from .compiled import CompiledChain

Arm = Chain | CompiledChain[Chain]
"""An arm as functions take it."""


def chain_of(arm: Any, what: str = "chain") -> Chain:
    """The chain of an arm. Raises: InputError for what is none."""
    if isinstance(arm, CompiledChain):
        arm = arm.chain
    if not isinstance(arm, Chain):
        raise InputError(
            f"{what}: expected a Chain, as Robot.chain(tip=...) makes it, got {safe_repr(arm)}"
        )
    return arm


def compiled(arm: Any) -> CompiledChain[Chain]:
    """The compiled chain of an arm. Raises: InputError for what is none."""
    if isinstance(arm, CompiledChain):
        return arm
    return chain_of(arm).compile()
