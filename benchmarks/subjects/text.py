"""Functions of a library as its users type them: one text is what runs, and what is printed to be pasted."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from .. import peers
from ..cases.accuracy_peers import TEXTS

NAMES = {"exp_so3": "so3_exp", "log_so3": "so3_log", "exp_se3": "exp", "log_se3": "log"}

# Beside exp and log. x is (omega; v) or a matrix; `swap` and `square` put the library's (v; omega) into that order.
SWAP = "swap = lambda J: np.roll(J, (3, 3), (0, 1))"
MORE: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "Pinocchio": (
        f"import pinocchio as pin; {SWAP}",
        {"adjoint": "swap(pin.SE3(x).action)", "right_jacobian": "swap(pin.Jexp6(pin.Motion(np.roll(x, 3))))",
         "so3_right_jacobian": "pin.Jexp3(x)"},
    ),
    "Robotics Toolbox": (f"from spatialmath import base; {SWAP}", {"adjoint": "swap(base.tr2adjoint(x))"}),
    "Modern Robotics": ("import modern_robotics as mr", {"adjoint": "mr.Adjoint(x)"}),
    "jaxlie": (
        f"import jax; jax.config.update('jax_enable_x64', True); import jaxlie; {SWAP}",
        {"adjoint": "swap(np.asarray(jaxlie.SE3.from_matrix(x).adjoint()))"},
    ),
    "pytransform3d": (
        "from pytransform3d import rotations, transformations",
        {"adjoint": "transformations.adjoint_from_transform(x)",
         "left_jacobian": "transformations.left_jacobian_SE3(x)",
         "left_jacobian_inverse": "transformations.left_jacobian_SE3_inv(x)",
         "so3_left_jacobian": "rotations.left_jacobian_SO3(x)",
         "so3_left_jacobian_inverse": "rotations.left_jacobian_SO3_inv(x)"},
    ),
}  # fmt: skip


class ByText:
    """A subject made of texts; `library` is the peer's name, as in the tables above.

    leaves_out: laws that the library does not claim to keep, each with the reason.
    """

    library = ""
    twist_order = "angular first"
    leaves_out: Mapping[str, str] = MappingProxyType({})

    def __init__(self) -> None:
        self.peer = next(p for p in (peers.STANDARD | peers.OPTIONAL).values() if p.name == self.library)
        self.name = getattr(type(self), "title", self.library)
        self.version = self.peer.version
        self.paste: dict[str, str] = {}
        for table, names in ((TEXTS, NAMES), (MORE, {})):
            before, calls = table.get(self.library, ("", {}))
            for key, call in calls.items():
                name = names.get(key, key)
                self.paste[name] = f"{before}; print(np.asarray({call}))"
                setattr(self, name, _function(before, call))


def _function(before: str, call: str) -> Callable[[np.ndarray], Any]:
    names: dict[str, Any] = {"np": np}
    # Constants of this repository, no input of anybody's.
    exec(before, names)
    return eval(f"lambda x: np.asarray({call})", names)
