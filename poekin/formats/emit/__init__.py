"""Kinematics of an arm as source text: C99, and Python for NumPy, JAX and PyTorch arrays."""

from .c import CSource, Real, c
from .python import python

__all__ = ["CSource", "Real", "c", "python"]
