"""Results kept with a compiled arm, the latest ones; any number of threads may ask for them at a
time.
"""

from __future__ import annotations

import threading
from collections.abc import Hashable
from typing import TypeVar

from ...model.kinematics.compiled import CompiledChain

KEPT = 64
"""So many results are kept with an arm."""

_keeping = threading.Lock()
_Result = TypeVar("_Result")


def keep(fast: CompiledChain, key: Hashable, result: _Result) -> _Result:
    """Put a result into the memory of an arm, in the place of the oldest one where it is full;
    returns it.
    """
    with _keeping:
        while len(fast.memory) >= KEPT:
            del fast.memory[next(iter(fast.memory))]
        fast.memory[key] = result
    return result
