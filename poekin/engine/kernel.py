"""A kernel: a function of arrays, compiled at its first call for one signature and kept in the cache."""

from __future__ import annotations

from collections.abc import Callable


class Kernel:
    """Call `kernel.call(...)`: the first time this loads or compiles the function and puts the result in its place."""

    __slots__ = ("arguments", "call", "function", "returns")

    def __init__(self, function: Callable, arguments: str, returns: str = ""):
        self.function, self.arguments, self.returns = function, arguments, returns
        self.call: Callable = self._first_call

    def _first_call(self, *arguments):
        # Numba takes longer to import than all the rest of poekin: whoever only reads a model does without
        from .compile import compiled

        self.call = compiled(self.function, self.arguments, self.returns)
        return self.call(*arguments)


def kernel(arguments: str, returns: str = ""):
    """Decorator: make a function of arrays a `Kernel`; for the argument codes see `engine.compile.array_type`."""
    return lambda function: Kernel(function, arguments, returns)
