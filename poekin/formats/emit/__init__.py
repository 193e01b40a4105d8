"""An arm's kinematics as source text: C99 for a controller, and Python for NumPy, JAX and PyTorch
arrays.
"""

from .c import CSource, c
from .python import python

__all__ = ["CSource", "c", "python"]
