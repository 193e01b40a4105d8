"""SO(3), the rotations, over arrays.

A rotation R_ab (..., 3, 3) takes vectors from frame b to frame a. A rotation vector w (..., 3) is
axis times angle, in rad. Leading axes are the batch. NaN in an element gives NaN in that element of
the result. u = 2^-53 below.
"""

from .algebra import ad, adjoint, hat, inverse, vee
from .exp_log import AxisAngle, axis_angle, exp, log
from .jacobians import (
    left_jacobian,
    left_jacobian_inverse,
    right_jacobian,
    right_jacobian_inverse,
)
from .nearest import NearestRotation, nearest

__all__ = [
    "AxisAngle",
    "NearestRotation",
    "ad",
    "adjoint",
    "axis_angle",
    "exp",
    "hat",
    "inverse",
    "left_jacobian",
    "left_jacobian_inverse",
    "log",
    "nearest",
    "right_jacobian",
    "right_jacobian_inverse",
    "vee",
]
