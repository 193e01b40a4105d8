"""Kinematics of an arm as source text: C99, JavaScript, and Python for NumPy, JAX and PyTorch arrays."""

from .c import CSource, Real, c
from .ik.c_ik import c_ik
from .javascript import javascript
from .python import python

__all__ = ["CSource", "Real", "c", "c_ik", "javascript", "python"]
