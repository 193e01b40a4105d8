"""All kernels of the package: who compiles them once spares every later process that wait."""

from __future__ import annotations

import importlib
import pkgutil

from . import kernels as folder
from .jit.kernel import Kernel


def kernels() -> dict[str, Kernel]:
    """Every kernel, by its module and the name of its function."""
    found: dict[str, Kernel] = {}
    for module in pkgutil.walk_packages(folder.__path__, f"{folder.__name__}."):
        names = vars(importlib.import_module(module.name))
        for value in names.values():
            if isinstance(value, Kernel) and value.function.__module__ == module.name:
                found[f"{module.name.rpartition('.')[2]}.{value.function.__name__}"] = value
    return found
