"""Measure of a pose by its inverse kinematics alone: how many solutions it has."""

from __future__ import annotations

from dataclasses import dataclass

from .measure import Measure


@dataclass(frozen=True)
class SolutionCount(Measure):
    """Number of solutions of `ik_all` within the limits; whole turns of a joint are one."""

    called = "solutions"
    kind = 6
    of_poses = True
