"""exp and log as each library's users type them, as texts of Python.

x is a rotation vector (3,), a twist (6,) with the angular part first, or a matrix (3, 3) or (4, 4).
"""

from __future__ import annotations

TEXTS = {
    "poekin": (
        "import poekin as pk",
        {"exp_so3": "pk.so3.exp(x)", "log_so3": "pk.so3.log(x)",
         "exp_se3": "pk.se3.exp(x)", "log_se3": "pk.se3.log(x)"},
    ),
    "Pinocchio": (
        "import pinocchio as pin",
        {"exp_so3": "pin.exp3(x)", "log_so3": "pin.log3(x)", "exp_se3": "pin.exp6(np.roll(x, 3)).homogeneous",
         "log_se3": "np.roll(pin.log6(x).vector, 3)"},
    ),
    "SciPy": (
        "from scipy.spatial.transform import RigidTransform, Rotation",
        {"exp_so3": "Rotation.from_rotvec(x).as_matrix()", "log_so3": "Rotation.from_matrix(x).as_rotvec()",
         "exp_se3": "RigidTransform.from_exp_coords(x).as_matrix()",
         "log_se3": "RigidTransform.from_matrix(x).as_exp_coords()"},
    ),
    "Robotics Toolbox": (
        "from spatialmath import base",
        {"exp_so3": "base.trexp(x, check=False)", "log_so3": "base.trlog(x, check=False, twist=True)",
         "exp_se3": "base.trexp(np.roll(x, 3), check=False)",
         "log_se3": "np.roll(base.trlog(x, check=False, twist=True), 3)"},
    ),
    "Modern Robotics": (
        "import modern_robotics as mr",
        {"exp_so3": "mr.MatrixExp3(mr.VecToso3(x))", "log_so3": "mr.so3ToVec(mr.MatrixLog3(x))",
         "exp_se3": "mr.MatrixExp6(mr.VecTose3(x))", "log_se3": "mr.se3ToVec(mr.MatrixLog6(x))"},
    ),
    "jaxlie": (
        "import jax; jax.config.update('jax_enable_x64', True); import jaxlie",
        {"exp_so3": "jaxlie.SO3.exp(x).as_matrix()", "log_so3": "jaxlie.SO3.from_matrix(x).log()",
         "exp_se3": "jaxlie.SE3.exp(np.roll(x, 3)).as_matrix()",
         "log_se3": "np.roll(jaxlie.SE3.from_matrix(x).log(), 3)"},
    ),
    "pytransform3d": (
        "from pytransform3d import rotations, transformations",
        {"exp_so3": "rotations.matrix_from_compact_axis_angle(x)",
         "log_so3": "rotations.compact_axis_angle_from_matrix(x)",
         "exp_se3": "transformations.transform_from_exponential_coordinates(x)",
         "log_se3": "transformations.exponential_coordinates_from_transform(x)"},
    ),
}  # fmt: skip
"""Of each library by name: the line before, and the call of each function."""
