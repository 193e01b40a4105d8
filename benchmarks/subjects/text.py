"""Functions of a library as its users type them: one text is what runs, and what is printed to be
pasted.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from poekin.testing.conform.subjects.subject import printed

from .. import peers
from .exp_log_texts import TEXTS

NAMES = {"exp_so3": "so3_exp", "log_so3": "so3_log", "exp_se3": "exp", "log_se3": "log"}

# Beside exp and log. x is (omega; v) or a matrix; `swap` and `square` put the library's (v; omega)
# into that order.
SWAP = "swap = lambda J: np.roll(J, (3, 3), (0, 1))"
MORE: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "Pinocchio": (
        f"import pinocchio as pin; {SWAP}",
        {"adjoint": "swap(pin.SE3(x).action)", "right_jacobian": "swap(pin.Jexp6(pin.Motion(np.roll(x, 3))))",
         "so3_right_jacobian": "pin.Jexp3(x)"},
    ),
    "Robotics Toolbox": (f"from spatialmath import base; {SWAP}", {"adjoint": "swap(base.tr2adjoint(x))"}),
    "Modern Robotics": ("import modern_robotics as mr", {"adjoint": "mr.Adjoint(x)"}),
    # jlog is of an element, which at |ω| = π has two logarithms: `turn` makes the one that has ω.
    # The translation is poekin's, as jaxlie's own exp has an error that jlog is not to be blamed
    # for.
    "jaxlie": (
        f"import jax; jax.config.update('jax_enable_x64', True); import jaxlie; import poekin as pk; {SWAP}; "
        "turn = lambda w: jaxlie.SO3(jaxlie.SO3.exp(w).wxyz.at[0].max(1e-300))",
        {"adjoint": "swap(np.asarray(jaxlie.SE3.from_matrix(x).adjoint()))",
         "so3_right_jacobian_inverse": "turn(x).jlog()",
         "right_jacobian_inverse": "swap(np.asarray("
         "jaxlie.SE3.from_rotation_and_translation(turn(x[:3]), pk.se3.exp(x)[:3, 3]).jlog()))"},
    ),
    "pytransform3d": (
        "from pytransform3d import rotations, transformations",
        {"adjoint": "transformations.adjoint_from_transform(x)",
         "left_jacobian": "transformations.left_jacobian_SE3(x)",
         "left_jacobian_inverse": "transformations.left_jacobian_SE3_inv(x)",
         "so3_left_jacobian": "rotations.left_jacobian_SO3(x)",
         "so3_left_jacobian_inverse": "rotations.left_jacobian_SO3_inv(x)"},
    ),
    "pytransform3d, batches": (
        "from pytransform3d import batch_rotations, trajectories",
        {"so3_exp": "batch_rotations.matrices_from_compact_axis_angles(x)",
         "exp": "trajectories.transforms_from_exponential_coordinates(x)",
         "log": "trajectories.exponential_coordinates_from_transforms(x)"},
    ),
}  # fmt: skip


class ByText:
    """A subject made of texts; `library` is the peer's name, and that in the tables above unless
    `texts` is another.

    leaves_out: laws that the library does not claim to keep, each with the reason.
    """

    library = texts = ""
    twist_order = "angular first"
    leaves_out: Mapping[str, str] = MappingProxyType({})

    def __init__(self) -> None:
        self.peer = next(
            p for p in (peers.STANDARD | peers.OPTIONAL).values() if p.name == self.library
        )
        self.name = getattr(type(self), "title", self.library)
        self.version = self.peer.version
        self.paste: dict[str, str] = {}
        for table, names in ((TEXTS, NAMES), (MORE, {})):
            before, calls = table.get(self.texts or self.library, ("", {}))
            for key, call in calls.items():
                name = names.get(key, key)
                self.paste[name] = f"{before}; {printed(call)}"
                setattr(self, name, _function(before, call))


def _function(before: str, call: str) -> Callable[[np.ndarray], Any]:
    names: dict[str, Any] = {"np": np}
    # Constants of this repository, no input of anybody's.
    exec(before, names)
    return eval(f"lambda x: np.asarray({call})", names)
