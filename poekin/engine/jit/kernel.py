"""A kernel: a function of arrays, compiled at its first call for one signature and kept in the
cache.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from . import source_hash  # noqa: F401  takes the key of the source as it is now
from .locks import COMPILING


@dataclass(eq=False, repr=False, slots=True)
class Kernel:
    """Call `kernel.call(...)`: the first time this loads or compiles the function and puts the
    result in its place.

    A call releases the interpreter's lock and refuses arguments of other types with a TypeError. A
    `quick` kernel keeps the lock, and a `bare` one checks nothing either, which makes a call of
    half a microsecond a third faster: its caller has checked every argument. In a `portable` kernel
    no product and sum are fused: it gives the same bits on every processor.
    """

    function: Callable
    arguments: str
    returns: str
    quick: bool
    bare: bool
    portable: bool
    call: Callable = field(init=False)

    def __post_init__(self) -> None:
        self.call = self._first_call

    def ready(self) -> Callable:
        """The compiled function itself."""
        # Numba takes longer to import than all the rest of poekin: whoever only reads a model does
        # without
        with COMPILING:
            if self.call == self._first_call:  # and no other thread was quicker
                from .compile import compiled

                self.call = compiled(self)
        return self.call

    def _first_call(self, *arguments):
        return self.ready()(*arguments)


def kernel(
    arguments: str,
    returns: str = "",
    quick: bool = False,
    bare: bool = False,
    portable: bool = False,
):
    """Decorator: make a function of arrays a `Kernel`; for the argument codes see
    `engine.jit.compile.array_type`.
    """
    return lambda function: Kernel(function, arguments, returns, quick, bare, portable)
