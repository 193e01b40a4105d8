"""pytorch_kinematics: poses and Jacobians of whole batches in PyTorch; twists (v; omega). No exp
and log of poses.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from poekin.testing.oracles.pinocchio_oracle import ANGULAR_FIRST

from .peer import Arm, Arrays, Kinematics, Peer, module


def kinematics(arm: Arm) -> Kinematics:
    """A serial chain out of the URDF's text, on the processor, turned to double precision as its
    documentation does.
    """
    torch, library = module("torch"), module("pytorch_kinematics")
    chain = library.build_serial_chain_from_urdf(arm.urdf.encode(), arm.chain.tip)
    chain = chain.to(dtype=torch.float64, device="cpu")

    def fk_jacobian(q: Any) -> tuple[Any, Any]:
        with torch.no_grad():
            J, T = chain.jacobian(q, ret_eef_pose=True)
        return T, J

    def fk(q: Any) -> Any:
        with torch.no_grad():
            return chain.forward_kinematics(q).get_matrix()

    def arrays(T: Any, J: Any) -> Arrays:
        return T.numpy(), J.numpy()[..., ANGULAR_FIRST, :]

    return Kinematics(
        "hybrid", fk, fk_jacobian, pose=lambda T: T.numpy(), arrays=arrays,
        native=lambda q: torch.from_numpy(np.ascontiguousarray(q)), batch=True,
        note="its reader rounds the URDF's numbers to float32 before they are turned to float64",
    )  # fmt: skip


PEER = Peer("pytorch_kinematics", "pytorch-kinematics", "pytorch_kinematics", None, kinematics)
