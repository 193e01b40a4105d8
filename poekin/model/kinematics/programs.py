"""Straight-line programs of one arm: what the machine code of a compiled chain computes."""

from __future__ import annotations

from functools import cached_property
from typing import Any, Generic, NamedTuple

import numpy as np

from ...engine.straight_line.program import Program
from ...engine.straight_line.specialise import (
    Structure,
    cheapest_frame,
    cheapest_program,
    with_frame_at,
)
from ...errors import InputError
from ...groups.arrays import Array
from ..chain_data import AnyChain
from ..checks import read_only
from ..geometry.structure import structure
from .pose_jacobian import FRAME_CODES, AnyFrame, frame_code

CHEAPEST = -4
"""Code of the frame "cheapest"; the other frames have those of the general kernels, and None stands
for no Jacobian.
"""

_NAMES: dict[int | None, Any] = {code: name for name, code in FRAME_CODES.items()}


class CheapestFrame(NamedTuple):
    """Frame in which the Jacobian costs least: it moves with a joint, whose z axis it has.

    Attributes
    ----------
    joint : int
        Number of the joint, 0 ... n - 1.
    along : float
        Place of the frame of `CompiledChain.structure` on that z axis, m.
    T_km : (4, 4) ndarray
        Pose in the joint's own frame k (`Chain.joint_poses`), m.
    """

    joint: int
    along: float
    T_km: Array


class ChainPrograms(Generic[AnyChain]):
    """Structure of a chain, and the programs that are made for it."""

    chain: AnyChain

    @cached_property
    def structure(self) -> Structure:
        """Chain as the formulas that are specialised take it."""
        return structure(self.chain)

    @cached_property
    def cheapest(self) -> CheapestFrame:
        """Frame "cheapest"; InputError for a chain without joints."""
        if not self.chain.joint_names:
            raise InputError("frame 'cheapest': the chain has no joint")
        k, h = cheapest_frame(self.structure)
        T_km = np.eye(4)
        T_kf = self.structure.frames[k]
        T_km[:3, :3] = np.array(T_kf[:9]).reshape(3, 3)
        T_km[:3, 3] = np.array(T_kf[9:]) - h * T_km[:3, 2]
        return CheapestFrame(k, h, read_only(T_km))

    def program(self, frame: AnyFrame | None, *, pose: bool = False) -> Program:
        """Straight-line program of the Jacobian in a frame; its `count` says what it costs.

        Parameters
        ----------
        frame : {"space", "body", "hybrid", "cheapest"}, int or None
            Frame of the Jacobian; None for the pose alone.
        pose : bool, default False
            Whether the program computes the pose too.

        Returns
        -------
        program : Program
            Operations in the order in which the machine code runs them.

        Raises
        ------
        InputError
            If a string is no frame, or a number no joint's.
        """
        code = None if frame is None else self._frame_code(frame)
        return self._program(code, pose or frame is None)

    def _program(self, code: int | None, pose: bool) -> Program:
        if code == CHEAPEST:
            k, h, _ = self.cheapest
            return cheapest_program(with_frame_at(self.structure, k, h), k, pose)
        return cheapest_program(self.structure, _NAMES.get(code, code), pose)

    def _frame_code(self, frame: object) -> int:
        if isinstance(frame, str) and frame == "cheapest":
            return CHEAPEST
        return frame_code(self.chain, frame)
