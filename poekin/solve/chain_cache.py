"""Latest results of a function of a compiled chain, kept beside the function."""

from __future__ import annotations

import threading
from collections.abc import Hashable
from typing import Generic, TypeVar

from ..model.kinematics.compiled import CompiledChain

KEPT = 64
"""Number of results that a cache keeps, and so of arms that it may keep alive."""

_Result = TypeVar("_Result")


class ChainCache(Generic[_Result]):
    """Cache by compiled chain and key; any number of threads may use it at a time.

    Chains are told apart by identity: to hash their numbers takes longer than some calls. An entry
    holds its chain, so that no other one can take over its identity.
    """

    def __init__(self) -> None:
        self._entries: dict[Hashable, tuple[CompiledChain, _Result]] = {}
        self._keeping = threading.Lock()

    def __len__(self) -> int:
        return len(self._entries)

    def get(self, chain: CompiledChain, key: Hashable = None) -> _Result | None:
        """Result for a chain and a key; None where there is none. Raises: TypeError, no hash."""
        entry = self._entries.get((id(chain), key))
        return None if entry is None else entry[1]

    def keep(self, chain: CompiledChain, result: _Result, key: Hashable = None) -> _Result:
        """Keeps a result, in the place of the oldest one where the cache is full; returns it."""
        with self._keeping:
            while len(self._entries) >= KEPT:
                del self._entries[next(iter(self._entries))]
            self._entries[id(chain), key] = chain, result
        return result
