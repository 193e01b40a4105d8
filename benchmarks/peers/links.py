"""A chain as fixed poses between frames whose z axes are the joints', for peers that are built link
by link.
"""

from __future__ import annotations

import numpy as np

from poekin import Chain


def serial(chain: Chain) -> None:
    """Raises ValueError for helical joints and for coordinates that are shared or shifted: no peer
    has them all.
    """
    if chain.coupling.shape != (len(chain.screws),) * 2 or np.any(
        chain.coupling != np.eye(chain.dof)
    ):
        raise ValueError("a coordinate of its own for each joint expected")
    if np.any(chain.offset):
        raise ValueError("coordinates without offset expected")
    if any(abs(screw[:3] @ screw[3:]) > 1e-12 for screw in chain.screws):
        raise ValueError("revolute and prismatic joints expected, got a helical one")


def z_aligned(chain: Chain) -> tuple[list[tuple[np.ndarray, bool]], np.ndarray]:
    """[(T, turns)] a joint and the last T: T_sb = T_1 Rot or Shift(z, q_1) T_2 ⋯ T_last. Raises: as
    `serial`.
    """
    serial(chain)
    frame, fixed = np.eye(4), []
    for screw in chain.screws:
        w, v = screw[:3], screw[3:]
        turns = bool(np.any(w))
        axis = np.eye(4)
        axis[:3, :3] = _with_z(w if turns else v / np.linalg.norm(v))
        axis[:3, 3] = np.cross(w, v)
        fixed.append((np.linalg.inv(frame) @ axis, turns))
        frame = axis
    return fixed, np.linalg.inv(frame) @ chain.home


def _with_z(z: np.ndarray) -> np.ndarray:
    """A rotation whose last column is z."""
    x = np.cross(np.eye(3)[np.argmin(np.abs(z))], z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], 1)
