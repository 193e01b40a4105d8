"""A sweep as data: an arm, samples of configurations or of poses, cells that they fall into, a measure."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from ..checks import choice
from ..engine.jit import source_hash
from ..errors import InputError
from ..model.chain import Chain
from ..version import __version__
from .bins import Bins, TopList
from .cells import Cells
from .masks.self_collision import SelfCollision
from .measures.measure import Measure, Reach
from .measures.names import MeasureName, measure_of
from .pose_samples import NumberedPoses
from .samples import Samples
from .solutions import check_solvable

Keep = Literal["best", "worst", "mean"]
KeepRule = Literal["count", "extreme", "sum", "top"]


@dataclass(frozen=True, eq=False)
class Sweep:
    """Question to many configurations or poses: which cells are reached, and how well.

    A pose is reached where `ik_all` has a solution of it within the limits. Its measure is that of
    the best of its solutions; what is not reached counts nowhere.

    Attributes
    ----------
    chain : Chain
        The arm.
    samples : Random, Sobol, Grid, PoseSamples or PoseGrid
        Its configurations, or poses of its tool: of an arm of up to six coordinates that is solved
        in closed form or by elimination.
    cells : Cells
        Cells of space, and of directions.
    measure : Measure or str
        What is kept of each cell: "reach" for nothing but counts, "manipulability",
        "inverse_condition", "smallest_singular_value", "limit_margin", "travel", of poses
        "solutions" too, their number; or a measure with parameters, such as `PoseUncertainty`.
    keep : {"best", "worst", "mean"}
        Whether the best or the worst measure of a cell is kept, with its first sample, or the mean.
    mask : SelfCollision, optional
        Samples that it leaves out: they count nowhere; of poses solutions that it leaves out.

    Raises
    ------
    InputError
        If there is no such measure, the arm has it not, the mask is another arm's, the samples
        have another number of coordinates, or poses are asked of an arm that is not solved.
    """

    chain: Chain
    samples: Samples | NumberedPoses
    cells: Cells | Bins | TopList
    measure: Measure | MeasureName = "reach"
    keep: Keep = "best"
    mask: SelfCollision | None = None

    def __post_init__(self) -> None:
        choice(self.keep, get_args(Keep), "keep")
        self.measured.check(self.chain)
        if self.mask is not None:
            self.mask.check(self.chain)
        if not self.is_measured and not isinstance(self.cells, Cells):
            raise InputError("measure: expected a measure to keep, got 'reach'")
        if isinstance(self.samples, NumberedPoses):
            check_solvable(self.chain)
            return
        if self.measured.of_poses:
            raise InputError(
                f"measure {self.measured.name!r}: expected samples of poses, PoseSamples or PoseGrid"
            )
        if len(self.samples.lower) != self.chain.dof:
            raise InputError(
                f"sweep: {self.chain!r} has {self.chain.dof} coordinates, its samples {len(self.samples.lower)}"
            )

    @property
    def measured(self) -> Measure:
        """The measure itself."""
        return measure_of(self.measure)

    @property
    def is_measured(self) -> bool:
        """Whether cells keep a measure."""
        return not isinstance(self.measured, Reach)

    @property
    def rule(self) -> KeepRule:
        """Rule by which measures are kept and added up."""
        if isinstance(self.cells, TopList):
            return "top"
        if not self.is_measured:
            return "count"
        return "sum" if self.keep == "mean" else "extreme"

    @property
    def sign(self) -> int:
        """1 where the largest measure is kept, -1 where the smallest."""
        return -self.measured.sign if self.keep == "worst" else self.measured.sign

    def describe(self) -> dict[str, object]:
        """Plain data of all that the result depends on but the arm.

        Returns
        -------
        document : dict
            Names, numbers and lists of numbers, in SI units.
        """
        document = {
            "base": self.chain.base,
            "tip": self.chain.tip,
            "q_names": list(self.chain.q_names),
            "measure": self.measured.name,
            "parameters": self.measured.describe(),
            "keep": self.keep,
            "samples": self.samples.describe(),
        } | self.cells.describe()
        if self.mask is not None:
            document["mask"] = self.mask.describe()
        return document

    def key(self) -> str:
        """SHA-256 of the sweep, its arm and the formulas that run: equal keys have equal results.

        Returns
        -------
        key : str
            Hexadecimal digits.
        """
        chain = self.chain
        text = json.dumps(
            [self.describe(), source_hash.LOADED, __version__],
            sort_keys=True,
        )
        whole = hashlib.sha256(text.encode())
        limits = (chain.limits, chain.joint_limits)
        for numbers in (chain.screws, chain.home, chain.coupling, chain.offset, *limits):
            whole.update(np.ascontiguousarray(numbers).tobytes())
        return whole.hexdigest()
