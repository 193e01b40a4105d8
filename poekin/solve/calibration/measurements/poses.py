"""Measured poses: of the tip in the base, or between a camera and a board, one of them on the tip."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Literal, get_args

import numpy as np

from ....checks import choice
from ....groups import se3, so3
from ....groups.arrays import Array
from ....groups.vectors import rotation_part, translation_part
from ..fit import initial_guess
from .measurement import (
    Derivatives,
    Frames,
    Measurement,
    UnknownFrame,
    make_unknown_frame,
    pose_rows,
    seen_from,
)

PoseFrame = Literal["base", "unknown"]
PoseTool = Literal["tip", "unknown"]


def pose_errors(T: Array, measured: Array) -> Array:
    """Errors (N, 6): the rotation vector of R R_measured^T (rad), and p - p_measured (m), both in
    the fixed axes.
    """
    back = np.swapaxes(rotation_part(measured), 1, 2)
    turns = rotation_part(T) @ back
    moved = translation_part(T) - translation_part(measured)
    return np.concatenate([so3.log(turns), moved], axis=1)


def pose_error_jacobian(T: Array, errors: Array, D: Array) -> Array:
    """Jacobian (N, 6, P) of `pose_errors` when T moves by the space twists D (N, 6, P): dw =
    J_l^-1(w) omega, dp = v + omega x p.
    """
    turns = D[:, :3]
    p = translation_part(T)
    dw = so3.left_jacobian_inverse(errors[:, :3]) @ turns
    dp = D[:, 3:] - so3.hat(p) @ turns
    return np.concatenate([dw, dp], axis=1)


class _BetweenFrames(Measurement):
    """T_fixed_moving = X^-1 f(q) Z, with X = T_base_fixed and Z = T_tip_moving, the identity where
    they are not estimated jointly.
    """

    width = 6
    angular = 3
    frames: ClassVar[dict[str, str]]  # the fields that say what is known of X and Z, in this order
    T: Array

    def _both(self, values: Sequence[Any]) -> list[Any]:
        """X and Z, of values of those that are unknown."""
        unknown = (u.name for u in self.unknown_frames)
        named = dict(zip(unknown, values, strict=True))
        return [named.get(name, np.eye(4)) for name in self.frames]

    def _unknown(self, both: Sequence[Array]) -> list[Array]:
        """Values of the unknown frames, of values of X and Z."""
        named = dict(zip(self.frames, both, strict=True))
        return [named[u.name] for u in self.unknown_frames]

    def errors(self, T: Array, frame_values: Frames) -> Array:
        """Errors (N, 6) in the axes of the fixed frame: rotation vector of R_model R_measuredᵀ, Δp."""
        X, Z = self._both(frame_values)
        return pose_errors(se3.inverse(X) @ T @ Z, self.T)

    def jacobian(
        self,
        T: Array,
        frame_values: Frames,
        errors: Array,
        D: Array,
    ) -> Derivatives:
        """With G = X⁻¹ T Z: dG G⁻¹ is Ad(X⁻¹) D, −ξ of X <- X e^[ξ], Ad(G) ζ of Z <- Z e^[ζ].

        J_l⁻¹(w) ω turns the error w, and v + ω × p moves it.
        """
        if not len(frame_values):
            return pose_error_jacobian(T, errors, D), []
        X, Z = self._both(frame_values)
        seen, twists = seen_from(X, T, D)
        G = seen @ Z
        both = np.concatenate([twists, se3.adjoint(G)], axis=2)
        jacobian = pose_error_jacobian(G, errors, both)
        arm, *frames = np.split(jacobian, [-12, -6], axis=2)
        return arm, self._unknown(frames)

    def guesses(self, T: Array) -> list[Array]:
        """Frames as given, else by hand-eye calibration or the mean of the measured poses."""
        given = [u.guess for u in self.unknown_frames]
        X, Z = self._both(given)
        if Z is None:
            if X is None:
                return self._unknown(initial_guess.hand_eye(T, self.T))
            Z = initial_guess.mean_pose(se3.inverse(T) @ X @ self.T)
        elif X is None:
            X = initial_guess.mean_pose(T @ Z @ se3.inverse(self.T))
        return self._unknown([X, Z])


@dataclass(frozen=True, eq=False, repr=False)
class Poses(_BetweenFrames):
    """Measured poses of the tip in the base frame, T = f(q), or of a probe in a device's frame.

    Then T = T_base_device⁻¹ f(q) T_tip_probe.

    Parameters
    ----------
    T : (N, 4, 4) array_like
        Measured T_base_tip, or T_device_probe, m.
    covariance : (6, 6) or (N, 6, 6) array_like, optional
        Covariance of the errors, rad² and m²: the rotation vector of R_model R_measuredᵀ, then
        p_model − p_measured, both in base axes, or the device's. By default two standard
        deviations, of angles and of lengths, are estimated from the residuals.
    rows : (N,) array_like of int, optional
        Row of q of each measurement; all in order by default.
    frame : {"base", "unknown"}, default "base"
        Frame in which T stands: the base frame, or that of a device whose pose T_base_device is
        estimated jointly.
    tool : {"tip", "unknown"}, default "tip"
        What T is the pose of: the tip, or a probe on it whose T_tip_probe is estimated jointly.

    Raises
    ------
    ShapeError
        If an array has another shape.
    PoseError
        If an element of T is no pose.
    InputError
        If a number is not finite, a covariance is not symmetric and positive definite, or frame or
        tool is another word.

    Examples
    --------
    A tracker that stands anywhere, and sees the poses of a probe on the tool:

    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> made = pk.calibration.simulated(arm, 30, kind="eye-to-hand")
    >>> probe = pk.calibration.Poses(made.measurements.T, frame="unknown", tool="unknown")
    >>> found = pk.calibrate(arm, made.q, probe, folds=0)
    >>> sorted(found.frames)
    ['T_base_device', 'T_tip_probe']
    """

    T: Any
    covariance: Any = None
    rows: Any = None
    frame: PoseFrame = "base"
    tool: PoseTool = "tip"

    frames: ClassVar = {"T_base_device": "frame", "T_tip_probe": "tool"}

    def __post_init__(self) -> None:
        choice(self.frame, get_args(PoseFrame), "frame")
        choice(self.tool, get_args(PoseTool), "tool")
        unknown = []
        for name, own in self.frames.items():
            if getattr(self, own) == "unknown":
                unknown.append(UnknownFrame(name, 6))
        T = pose_rows(self.T, "T")
        self._keep(T=T, unknown_frames=tuple(unknown))


class _HandEye(_BetweenFrames):
    """Poses between a camera and a board, both frames estimated jointly."""

    frame = "unknown"

    def __post_init__(self) -> None:
        name = fields(self)[0].name  # type: ignore[arg-type]
        pairs = self.frames.items()
        unknown = (make_unknown_frame(frame, getattr(self, own)) for frame, own in pairs)
        T = pose_rows(getattr(self, name), name)
        self._keep(T=T, unknown_frames=tuple(unknown))


@dataclass(frozen=True, eq=False, repr=False)
class EyeInHand(_HandEye):
    """Poses of a board that stands still, seen by a camera on the tip.

    The model is T_board_camera = T_base_board⁻¹ f(q) T_tip_camera; both frames are estimated
    jointly.

    Parameters
    ----------
    T_board_camera : (N, 4, 4) array_like
        Measured poses of the camera in the frame of the board, m.
    covariance : (6, 6) or (N, 6, 6) array_like, optional
        As of `Poses`, the errors in the axes of the board.
    rows : (N,) array_like of int, optional
        Row of q of each measurement; all in order by default.
    board, camera : (4, 4) array_like or str, optional
        Rough T_base_board and T_tip_camera, m, by default guessed linearly; or a name, such as
        "wrist": sets in which it is the same have this frame in common.

    Raises
    ------
    ShapeError, PoseError, InputError
        As `Poses`.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> made = pk.calibration.simulated(arm, 30, kind="eye-in-hand")
    >>> seen = pk.calibration.EyeInHand(made.measurements.T)
    >>> found = pk.calibrate(arm, made.q, seen, folds=0)
    >>> sorted(found.frames)
    ['T_base_board', 'T_tip_camera']
    """

    T_board_camera: Any
    covariance: Any = None
    rows: Any = None
    board: Any = None
    camera: Any = None

    frames: ClassVar = {"T_base_board": "board", "T_tip_camera": "camera"}


@dataclass(frozen=True, eq=False, repr=False)
class EyeToHand(_HandEye):
    """Poses of a board on the tip, seen by a camera that stands still.

    The model is T_camera_board = T_base_camera⁻¹ f(q) T_tip_board; both frames are estimated
    jointly.

    Parameters
    ----------
    T_camera_board : (N, 4, 4) array_like
        Measured poses of the board in the frame of the camera, m.
    covariance : (6, 6) or (N, 6, 6) array_like, optional
        As of `Poses`, the errors in the axes of the camera.
    rows : (N,) array_like of int, optional
        Row of q of each measurement; all in order by default.
    camera, board : (4, 4) array_like or str, optional
        Rough T_base_camera and T_tip_board, m, by default guessed linearly; or a name, as of
        `EyeInHand`.

    Raises
    ------
    ShapeError, PoseError, InputError
        As `Poses`.
    """

    T_camera_board: Any
    covariance: Any = None
    rows: Any = None
    camera: Any = None
    board: Any = None

    frames: ClassVar = {"T_base_camera": "camera", "T_tip_board": "board"}
