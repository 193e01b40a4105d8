"""Compile the formulas with Numba.

Importing this module registers every function of `poekin.algebra` and `poekin.formulas` with Numba,
which leaves the functions themselves plain Python. It is imported at the first call of a kernel,
not with the package.
"""

from __future__ import annotations

import importlib
import inspect
import math
import os
import pkgutil
import sys

import numba
from numba.core import cgutils, config, types
from numba.extending import intrinsic, overload, register_jitable

from ... import algebra, formulas
from ...errors import FileError
from ...formulas import elementary
from ...formulas.lie import arctangent, compensated, exponential, logarithm, quaternion
from ..lanes import vector
from ..straight_line import sincos
from . import array_io
from .cache import KernelCache


def _modules():
    yield from (algebra, array_io, sincos)
    for info in pkgutil.walk_packages(formulas.__path__, f"{formulas.__name__}."):
        yield importlib.import_module(info.name)


@intrinsic
def _without_references(typing_context, value):
    def generate(context, builder, signature, arguments):
        return _not_counted(context, builder, signature.args[0], arguments[0])

    return value(value), generate


def _not_counted(context, builder, kind, value):
    """An array, or all arrays of a tuple."""
    if isinstance(kind, types.Number):
        return value
    if isinstance(kind, types.BaseTuple):
        parts = zip(kind, cgutils.unpack_tuple(builder, value), strict=True)  # type: ignore[arg-type]
        return context.make_tuple(
            builder, kind, [_not_counted(context, builder, *part) for part in parts]
        )
    struct = context.make_array(kind)(context, builder, value)
    struct.meminfo = cgutils.get_null_value(struct.meminfo.type)
    return struct._getvalue()


_OVERLOADED = {
    elementary.sqrt: lambda x: lambda x: math.sqrt(x),
    elementary.sin: lambda x: lambda x: math.sin(x),
    elementary.cos: lambda x: lambda x: math.cos(x),
    elementary.asin: lambda x: lambda x: math.asin(x),
    elementary.atan2: lambda y, x: lambda y, x: math.atan2(y, x),
    elementary.takes_series: lambda x: lambda x: True,
    elementary.below: lambda x, limit: lambda x, limit: x < limit,
    array_io.without_refcount: lambda held: lambda held: _without_references(held),  # type: ignore[call-arg]
}
"""Compiled code of the functions that are not compiled as they stand."""
_COMPILED_OTHERWISE = {*_OVERLOADED, *vector.OVERLOADED}


def _register() -> None:
    for function, implementation in _OVERLOADED.items():
        overload(function)(implementation)
    for module in _modules():
        _register_functions(module)


# Products and sums may be fused; nothing else is reordered, and NaN and infinities are what they
# are. An entry for C, which nobody calls, would take a quarter as long again to compile.
OPTIONS: dict = {"error_model": "numpy", "fastmath": {"contract"}, "no_cfunc_wrapper": True}
# Called once for each element of a batch: as functions of their own they would cost a third more.
_INLINED = (arctangent, compensated, exponential, logarithm, quaternion)
_ENGINE = "poekin.engine."
_registered: set[str] = set()


def _register_functions(module) -> None:
    """Let compiled code call the plain functions of a module."""
    if module.__name__ not in _registered:
        _registered.add(module.__name__)
        for _, function in inspect.getmembers(module, inspect.isfunction):
            if function.__module__ == module.__name__ and function not in _COMPILED_OTHERWISE:
                inline = module in _INLINED
                register_jitable(forceinline=inline, no_cfunc_wrapper=True)(function)


def modules_used(module):
    """A module of kernels, and those of the engine whose plain functions it calls, itself or by
    others.
    """
    found = [module]
    for used in found:
        for value in list(vars(used).values()):
            if inspect.isfunction(value) and value.__module__.startswith(_ENGINE):
                imported = sys.modules[value.__module__]
                if imported not in found:
                    found.append(imported)
    return found


def array_type(code: str):
    """Numba's type of one argument: "r2" reads and "w2" writes a 2-dimensional float64 array, "i1"
    reads and "n1" writes integers, "int" is an integer.

    What is read may have any strides and alignment and be read-only, so no layout makes the kernel
    compile anew.
    "w" takes C-contiguous writable arrays only; being an exact match, it is also the faster way to
    hand one in.
    """
    if code == "int":
        return types.int64
    kind = code[0]
    dimensions = int(code[1])
    if kind in "wn":
        written = types.float64 if kind == "w" else types.int64
        return types.Array(written, dimensions, "C")
    element = types.int64 if kind == "i" else types.float64
    return types.Array(element, dimensions, "A", readonly=True, aligned=False)


def compiled(kernel):
    """Machine code of an `engine.jit.kernel.Kernel` for its one signature, from the cache or compiled now.

    Raises: FileError in a working directory that was deleted.
    """
    function = kernel.function
    if config.DISABLE_JIT:  # type: ignore[attr-defined]
        return function
    for module in modules_used(sys.modules[function.__module__]):
        _register_functions(module)
    options: dict = OPTIONS | {"fastmath": False} if kernel.portable else OPTIONS
    dispatcher = numba.njit(nogil=not (kernel.quick or kernel.bare), **options)(function)
    dispatcher._cache = KernelCache(function.__name__)  # type: ignore[attr-defined]
    result = types.int64 if kernel.returns == "int" else types.void
    signature = result(*(array_type(code) for code in kernel.arguments.split()))
    try:
        dispatcher.compile(signature)
    except FileNotFoundError as fault:
        if not _is_directory_gone():
            raise
        raise FileError(
            "compiling kernels: the working directory is gone; change to another one, or run "
            "`poekin warm` elsewhere once, after which no kernel is compiled"
        ) from fault
    dispatcher.disable_compile()
    # the entry point unpacks its arguments without asking of what type they are
    if kernel.bare:
        return dispatcher.overloads[signature.args].entry_point
    return dispatcher


def _is_directory_gone() -> bool:
    """Whether the working directory, which Numba asks for as it compiles, was deleted."""
    try:
        os.getcwd()
    except FileNotFoundError:
        return True
    return False


_register()
