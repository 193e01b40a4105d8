"""SE(3), the poses, over arrays.

A pose T_ab (..., 4, 4) takes points from frame b to frame a: p_a = T_ab p_b. A twist xi = (ω; v)
(..., 6) has its angular part first: rad and m. Leading axes are the batch. NaN in an element gives
NaN in that element of the result. u = 2^-53 below.
"""

from .algebra import ad, adjoint, hat, inverse, linear_first, pose, vee
from .exp_log import ScrewMotion, axis_angle, exp, log
from .jacobians import (
    left_jacobian,
    left_jacobian_inverse,
    right_jacobian,
    right_jacobian_inverse,
)
from .nearest import NearestPose, nearest

__all__ = [
    "NearestPose",
    "ScrewMotion",
    "ad",
    "adjoint",
    "axis_angle",
    "exp",
    "hat",
    "inverse",
    "left_jacobian",
    "left_jacobian_inverse",
    "linear_first",
    "log",
    "nearest",
    "pose",
    "right_jacobian",
    "right_jacobian_inverse",
    "vee",
]
