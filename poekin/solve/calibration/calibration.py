"""What a calibration found, and what can be done with it."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...analysis.compare.compare import compare
from ...errors import escape_unprintable
from ...formats import dh
from ...formats.relink import relinked
from ...formats.urdf_text import to_urdf
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.coordinates import coordinates
from ...model.robot import Robot
from .diagnostics.cross_validation import HeldOut
from .diagnostics.identification import Identification
from .fit.minimise import Step
from .fit.noise import Spread
from .measurements.poses import pose_slopes
from .model.parameters import Arm, Parameter
from .model.residuals import Residuals

if TYPE_CHECKING:
    from ...analysis.compare.comparison import Comparison
    from ...formats.dh.from_chain import FromChain

MOST_OUTLIERS = 12


class Outlier(NamedTuple):
    """A measurement that is off by more than one good one in 10^4 would be: its set, its index
    there, its row of q.
    """

    set: int
    index: int
    row: int


@dataclass(frozen=True, eq=False)
class Calibration:
    """An arm as measurements say it is.

    chain, nominal: the calibrated and the nominal arm. parameters, values (P,), covariance (P, P):
    what moved, in each parameter's unit, unknown frames included; what was held has no variance.
    frames: unknown frames (4, 4) and points (3,) by name, m. identification: what the measurements
    can tell. success: whether the search converged; steps: its history. before, after: residuals on
    all measurements, with unknown frames fitted only and calibrated; held_out: on data kept aside,
    None where none was. outliers. spreads: the standard deviations estimated for each set without
    covariances, None for the others. loss: its name. warnings: the tool, or the arm itself, is
    another one than the nominal, which was off by more than a tenth of its reach, or residuals are
    larger than a covariance that was given; remarks: it is off by as much, as its base is
    elsewhere, or residuals are smaller than a covariance.
    """

    nominal: Chain
    chain: Chain
    parameters: tuple[Parameter, ...]
    values: Array = field(repr=False)
    covariance: Array = field(repr=False)
    frames: Mapping[str, Array]
    identification: Identification
    success: bool
    steps: tuple[Step, ...] = field(repr=False)
    before: Residuals = field(repr=False)
    after: Residuals = field(repr=False)
    held_out: HeldOut | None = field(repr=False)
    outliers: tuple[Outlier, ...]
    spreads: tuple[Spread | None, ...]
    loss: str
    arm: Arm = field(repr=False)
    warnings: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()

    @property
    def deviations(self) -> Array:
        """Standard deviations (P,) of the values."""
        return np.sqrt(np.diag(self.covariance))

    def pose_covariance(self, q: Any) -> Array:
        """Covariance of the calibrated arm's pose at any q: C_T = D C_p D^T.

        Parameters: q (..., m) or a dict. Returns: (..., 6, 6), rad^2 and m^2, of the tip's rotation
        vector and position errors, both in base axes. It knows what was fitted only: neither what
        was held, nor joints that bend.
        Raises: ShapeError, UnknownName, InputError. Accuracy: first order in the errors of the
        parameters.
        Source: propagation of covariance through `Chain.screw_derivatives`.
        """
        q = coordinates(q, self.nominal.q_names)
        rows, n = q.reshape(-1, self.nominal.dof), len(self.arm.parameters)
        T, D = self.arm.changes(self.values[:n], rows)
        slopes = pose_slopes(T, np.zeros((len(T), 6)), D)
        found = slopes @ self.covariance[:n, :n] @ np.swapaxes(slopes, 1, 2)
        return found.reshape(*q.shape[:-1], 6, 6)

    def compare(self) -> Comparison:
        """`pk.compare` of the nominal and the calibrated arm: joint by joint, what is off by how
        much.
        """
        return compare(self.nominal, self.chain)

    def to_robot(self, robot: Robot) -> Robot:
        """The robot whose branch from the chain's base to its tip moves as calibrated; see
        `pk.relinked`.
        """
        return relinked(robot, self.chain, base=self.chain.base, tip=self.chain.tip)

    def to_urdf(self, robot: Robot) -> str:
        """URDF of `to_robot(robot)`, as text. Raises: as `to_robot` and `pk.to_urdf`."""
        return to_urdf(self.to_robot(robot))

    def to_dh(self, convention: str = "standard") -> FromChain:
        """The calibrated arm as a DH table, with error, bound and warnings; see `pk.dh.from_chain`."""
        return dh.from_chain(self.chain, convention=convention)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write all of it as TOML (extra `formats`), whole or not at all.

        `calibration.load` reads it back to the last bit, and `pk.load` the calibrated chain as a
        robot.
        Parameters: path, of the file.
        Raises: FileError; MissingExtra without tomli-w.
        """
        from .report.toml_io import save

        save(self, path)

    def report(
        self,
        path: str | os.PathLike[str],
        title: str | None = None,
        sources: Sequence[str] | None = None,
    ) -> None:
        """Write a page that tells and shows all of it: one HTML file, no scripts, nothing fetched
        (extra `report`).

        path: of the file; title: of the page; sources: what each row of q came from, such as file
        and line,
        to name outliers by.
        Raises: ShapeError, FileError; MissingExtra without Matplotlib.
        """
        from .report.html_report import write

        write(self, path, title, sources)

    def __str__(self) -> str:
        state = "converged" if self.success else "NOT converged: the best that was found"
        lines = [
            f"{len(self.parameters)} parameters, {len(self.after)} measurements, {state} in {len(self.steps)} steps",
            str(self.identification),
            *_table(self),
        ]
        if self.outliers:
            rows = ", ".join(str(o.row) for o in self.outliers[:MOST_OUTLIERS])
            more = len(self.outliers) - MOST_OUTLIERS
            lines.append(f"outliers: rows {rows}" + (f" and {more} more" if more > 0 else ""))
        lines += [*(f"warning: {words}" for words in self.warnings), *self.remarks]
        return "\n".join(escape_unprintable(line, keep="\n") for line in lines)


def _table(found: Calibration) -> list[str]:
    """Residuals before and after, on all measurements and on those kept aside."""
    kept = found.held_out
    rows = [("before", found.before), ("after", found.after)]
    if kept is not None:
        rows += [
            (f"kept aside ({kept.folds} folds), before", kept.before),
            ("kept aside, after", kept.after),
        ]
    angles = not np.isnan(found.before.angle).all()
    heads = ["median mm", "rms mm"] + ["median mrad", "rms mrad"] * angles
    lines = [" " * 29 + "".join(f"{head:>13}" for head in heads)]
    for name, r in rows:
        values = [r.median_length, r.rms_length] + [r.median_angle, r.rms_angle] * angles
        lines.append(f"{name:29}" + "".join(f"{1e3 * value:13.3g}" for value in values))
    return lines
