"""Measured poses: of the tip in the base, or between a camera and a board, one of them on the tip."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ....groups import se3, so3
from ....groups.arrays import Array
from ..fit import initial_guess
from .measurement import (
    Measurement,
    covariances,
    make_unknown_frame,
    parse_rows,
    pose_rows,
    transform_twists,
)


def pose_errors(T: Array, measured: Array) -> Array:
    """Errors (N, 6): the rotation vector of R R_measured^T (rad), and p - p_measured (m), both in
    the fixed axes.
    """
    turned = so3.log(T[:, :3, :3] @ np.swapaxes(measured[:, :3, :3], 1, 2))
    return np.concatenate([turned, T[:, :3, 3] - measured[:, :3, 3]], axis=1)


def pose_error_jacobian(T: Array, errors: Array, D: Array) -> Array:
    """Jacobian (N, 6, P) of `pose_errors` when T moves by the space twists D (N, 6, P): dw =
    J_l^-1(w) omega, dp = v + omega x p.
    """
    turns = D[:, :3]
    p = T[:, :3, 3]
    dw = so3.left_jacobian_inverse(errors[:, :3]) @ turns
    dp = D[:, 3:] - so3.hat(p) @ turns
    return np.concatenate([dw, dp], axis=1)


@dataclass(frozen=True, eq=False)
class Poses(Measurement):
    """Poses of the tip in the base frame.

    T (N, 4, 4) = T_base_tip, m; covariance (6, 6) or (N, 6, 6) of the errors: the rotation vector
    of R_model R_measured^T, then p_model - p_measured, both in base axes, rad^2 and m^2 (None: two
    standard deviations, of angles and of lengths, are estimated from the residuals); rows (N,): the
    row of q of each, default all in order.
    Raises: ShapeError, PoseError, InputError.
    """

    T: Any
    covariance: Any = None
    rows: Any = None

    what = "Poses"
    width = 6
    angular = 3
    _per_measurement = ("T", "rows")

    def __post_init__(self):
        T = pose_rows(self.T, "T")
        C = covariances(self.covariance, len(T), 6, self.what)
        self._set_fields(T=T, covariance=C, rows=parse_rows(self.rows, len(T)))

    def __len__(self) -> int:
        return len(self.T)

    def errors(self, T: Array, frame_values: Sequence[Array]) -> Array:
        """See `pose_errors`."""
        return pose_errors(T, self.T)

    def jacobian(
        self, T: Array, frame_values: Sequence[Array], errors: Array, D: Array
    ) -> tuple[Array, list[Array]]:
        """See `pose_error_jacobian`."""
        return pose_error_jacobian(T, errors, D), []


class _HandEye(Measurement):
    """T_fixed_moving = X^-1 f(q) Z, with X = T_base_fixed and Z = T_tip_moving estimated jointly."""

    width = 6
    angular = 3
    _per_measurement = ("T", "rows")
    T: Array

    def _set(self, T: ArrayLike, name: str, **said: ArrayLike | str | None) -> None:
        """Keep T, and what is said of X and Z, in this order, by the names of these frames."""
        poses = pose_rows(T, name)
        C = covariances(self.covariance, len(poses), 6, self.what)
        unknown = tuple(make_unknown_frame(frame, value) for frame, value in said.items())
        rows = parse_rows(self.rows, len(poses))
        self._set_fields(T=poses, covariance=C, rows=rows, unknown_frames=unknown)

    def __len__(self) -> int:
        return len(self.T)

    def errors(self, T: Array, frame_values: Sequence[Array]) -> Array:
        """See `pose_errors`, in the axes of the board or camera that stands still."""
        X, Z = frame_values
        return pose_errors(se3.inverse(X) @ T @ Z, self.T)

    def jacobian(
        self, T: Array, frame_values: Sequence[Array], errors: Array, D: Array
    ) -> tuple[Array, list[Array]]:
        """With G = X^-1 T Z: dG G^-1 = Ad(X^-1) D; X <- X e^xi gives -xi, Z <- Z e^zeta gives Ad(G)
        zeta.
        """
        X, Z = frame_values
        back = se3.inverse(X)
        G = back @ T @ Z
        fixed = np.broadcast_to(-np.eye(6), (len(G), 6, 6))
        both = np.concatenate([transform_twists(back, D), fixed, se3.adjoint(G)], axis=2)
        jacobian = pose_error_jacobian(G, errors, both)
        return jacobian[..., :-12], [jacobian[..., -12:-6], jacobian[..., -6:]]

    def guesses(self, T: Array) -> list[Array]:
        """X and Z as given; what is not, by the linear method of `initial_guess.hand_eye`."""
        X, Z = (u.guess for u in self.unknown_frames)
        if X is not None and Z is not None:
            return [X, Z]
        if X is not None:
            return [X, initial_guess.mean_pose(se3.inverse(T) @ X @ self.T)]
        if Z is not None:
            return [initial_guess.mean_pose(T @ Z @ se3.inverse(self.T)), Z]
        return list(initial_guess.hand_eye(T, self.T))


@dataclass(frozen=True, eq=False)
class EyeInHand(_HandEye):
    """A camera on the tip that sees a board which stands still: T_board_camera = T_base_board^-1
    f(q) T_tip_camera.

    T_board_camera (N, 4, 4), m; covariance and rows as `Poses`, the errors in the board's axes;
    board, camera: rough T_base_board and T_tip_camera where known, else a linear initial guess is
    made; or a name, such as "wrist": sets in which it is the same have this frame in common.
    Raises: as `Poses`.
    """

    T_board_camera: Any
    covariance: Any = None
    rows: Any = None
    board: Any = None
    camera: Any = None

    what = "EyeInHand"

    def __post_init__(self):
        self._set(
            self.T_board_camera, "T_board_camera", T_base_board=self.board, T_tip_camera=self.camera
        )


@dataclass(frozen=True, eq=False)
class EyeToHand(_HandEye):
    """A camera that stands still and sees a board on the tip: T_camera_board = T_base_camera^-1
    f(q) T_tip_board.

    T_camera_board (N, 4, 4), m; covariance and rows as `Poses`, the errors in the camera's axes;
    camera, board: rough T_base_camera and T_tip_board where known, else a linear initial guess is
    made; or names, as of `EyeInHand`.
    Raises: as `Poses`.
    """

    T_camera_board: Any
    covariance: Any = None
    rows: Any = None
    camera: Any = None
    board: Any = None

    what = "EyeToHand"

    def __post_init__(self):
        self._set(
            self.T_camera_board, "T_camera_board", T_base_camera=self.camera, T_tip_board=self.board
        )
