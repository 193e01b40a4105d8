"""Kinematics of an arm as source text: C99, JavaScript, and Python for NumPy, JAX and PyTorch arrays;
its sweeps as CUDA and JAX.
"""

from .c import CSource, Real, c
from .ik.c_ik import c_ik
from .javascript import javascript
from .python import python
from .sweep.cuda import cuda
from .sweep.jax import jax

__all__ = ["CSource", "Real", "c", "c_ik", "cuda", "javascript", "jax", "python"]
