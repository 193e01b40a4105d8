"""Diagnosis: the effects that the residuals of a calibration show, each with its chance."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from .....groups.arrays import Array
from .....results import Result, brief
from ...fit.fitting import Fit
from ...fit.losses import LossName
from ...measurements.points import Distances, Points, points_of
from ...model.problem import Problem
from ...terms.conditions import Conditions
from ..base_and_tool import pose_points
from .effect_test import EffectTest
from .search import EffectSearch


@dataclass(frozen=True, eq=False)
class ResidualDiagnosis(Result):
    """Effects in the residuals of a calibration, tested one by one.

    Attributes
    ----------
    findings : tuple of EffectTest
        Effects that are there, the surest first, each tested with those before it in the fit, at a
        chance of 0.05 of any false one.
    tests : tuple of EffectTest
        All that were looked for, the likeliest first, each alone beside what was fitted.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> q = arm.random(1, 60)
    >>> lever = arm.jacobian(q, frame="hybrid")[:, 5]  # height of the tip, m/rad
    >>> p = arm.fk(q - lever * [0, 1e-3, 0, 0, 0, 0])[:, :3, 3]
    >>> p += np.random.default_rng(1).normal(scale=5e-5, size=p.shape)
    >>> found = pk.calibrate(arm, q, p, folds=0)
    >>> found.diagnosis.findings[0].verdict
    'joint 2 (shoulder_lift_joint) sags'
    """

    findings: tuple[EffectTest, ...]
    tests: tuple[EffectTest, ...] = field(repr=False)

    def summary(self) -> str:
        """Verdicts with their chance and size, in mm; that there are none, and what came nearest."""
        if self.findings:
            return "\n".join(f"diagnosis: {found}" for found in self.findings)
        if not self.tests:
            return "diagnosis: nothing is left to be tested"
        nearest = self.tests[0]
        return (
            f"diagnosis: nothing but noise, by {len(self.tests)} tests; the nearest to more is "
            f"{nearest.what} ({nearest.figures})"
        )


@dataclass(frozen=True, eq=False)
class SavedEvidence:
    """Diagnosis of a fit, and the points (k, 3) of the tool that were measured, out of a file."""

    points: Array
    diagnosis: ResidualDiagnosis


@dataclass(frozen=True, eq=False)
class FitEvidence:
    """A fit, and the conditions of its readings: what a diagnosis is made of, when it is asked for."""

    problem: Problem
    fit: Fit
    loss: LossName
    conditions: Conditions

    def __repr__(self) -> str:
        count = sum(map(len, self.problem.sets))
        return brief(
            self, f"{count} measurements at {len(self.problem.q)} readings, {self.loss} loss"
        )

    @cached_property
    def search(self) -> EffectSearch:
        """Effects that were found, and what they leave."""
        return EffectSearch(self.problem, self.fit, self.loss, self.conditions)

    @property
    def points(self) -> Array:
        """Points (k, 3) of the tool that were measured, m; four for a pose."""
        found = []
        for k, s in enumerate(self.problem.sets):
            frames = self.problem.frames_of_set(k, self.fit.p)
            if isinstance(s, Points):
                found.append(points_of(s, frames))
            elif not s.sees_arm:
                continue
            elif isinstance(s, Distances):
                found.append(s.point[None])
            else:
                found.append(pose_points(self.problem.model.nominal.reach))
        return np.unique(np.concatenate(found), axis=0)

    @property
    def diagnosis(self) -> ResidualDiagnosis:
        """Effects that the fit left."""
        return ResidualDiagnosis(tuple(self.search.findings), tuple(self.search.tests))
