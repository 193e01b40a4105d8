"""A sweep as data: an arm, samples of its configurations, cells that they fall into, a measure."""

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
from .cells import Cells
from .samples import Samples

Measure = Literal["reach", "manipulability"]


@dataclass(frozen=True, eq=False)
class Sweep:
    """Question to many configurations: which cells they reach, and how well.

    Attributes
    ----------
    chain : Chain
        The arm.
    samples : Random, Sobol or Grid
        Its configurations.
    cells : Cells
        Cells of space, and of directions.
    measure : {"reach", "manipulability"}
        Whether cells only count, or keep Yoshikawa's manipulability of the pose, sqrt(det J Jᵀ),
        too.

    Raises
    ------
    InputError
        If there is no such measure, or the samples have another number of coordinates.
    """

    chain: Chain
    samples: Samples
    cells: Cells
    measure: Measure = "reach"

    def __post_init__(self) -> None:
        choice(self.measure, get_args(Measure), "measure")
        if len(self.samples.lower) != self.chain.dof:
            raise InputError(
                f"sweep: {self.chain!r} has {self.chain.dof} coordinates, its samples {len(self.samples.lower)}"
            )

    @property
    def is_measured(self) -> bool:
        """Whether cells keep a measure."""
        return self.measure != "reach"

    def describe(self) -> dict[str, object]:
        """Plain data of all that the result depends on but the arm.

        Returns
        -------
        document : dict
            Names, numbers and lists of numbers, in SI units.
        """
        cells = self.cells
        return {
            "base": self.chain.base,
            "tip": self.chain.tip,
            "q_names": list(self.chain.q_names),
            "measure": self.measure,
            "samples": self.samples.describe(),
            "corner": list(cells.corner),
            "resolution": cells.resolution,
            "shape": list(cells.shape),
            "side": cells.side,
        }

    def key(self) -> str:
        """SHA-256 of the sweep, its arm and the formulas that run: equal keys have equal results.

        Returns
        -------
        key : str
            Hexadecimal digits.
        """
        chain = self.chain
        text = json.dumps([self.describe(), source_hash.LOADED], sort_keys=True)
        whole = hashlib.sha256(text.encode())
        for numbers in (chain.screws, chain.home, chain.coupling, chain.offset):
            whole.update(np.ascontiguousarray(numbers).tobytes())
        return whole.hexdigest()
