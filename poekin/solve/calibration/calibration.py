"""Calibration: the result that users hold, data with methods of one line."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

from ...analysis.compare.compare import compare
from ...analysis.compare.comparison import Comparison
from ...formats import dh
from ...formats.dh.from_chain import FromChain
from ...formats.relink import relinked
from ...formats.urdf_text import to_urdf
from ...groups.arrays import Array
from ...model.robot import Robot
from .report import html_report, summary, toml_io
from .result import CalibrationData, pose_covariance


class Calibration(CalibrationData):
    """An arm as measurements say it is.

    chain, nominal: the calibrated and the nominal arm. parameters, values (P,), covariance (P, P):
    what moved, in each parameter's unit, unknown frames included; fixed directions have no
    variance. frames: unknown frames (4, 4) and points (3,) by name, m. identification: what the
    measurements identify. success: whether the search converged; steps: its history. before, after:
    residuals on all measurements, with unknown frames fitted only and calibrated; cross_validation:
    residuals on held-out data, None where none was. outliers. noise_std: the standard deviations
    estimated for each set without covariances, None for the others. loss: its name. error_model: how the
    parameters move the arm. warnings: the
    tool, or the arm itself, is another one than the nominal, which was off by more than a tenth of
    its reach, or residuals are larger than a covariance that was given; remarks: it is off by as
    much, as its base is elsewhere, or residuals are smaller than a covariance.
    """

    def pose_covariance(self, q: Any) -> Array:
        """Covariance of the calibrated arm's pose at any q: C_T = D C_p D^T.

        Parameters: q (..., m) or a dict. Returns: (..., 6, 6), rad^2 and m^2, of the tip's rotation
        vector and position errors, both in base axes. It knows what was fitted only: neither what
        was fixed, nor joints that bend.
        Raises: ShapeError, UnknownName, InputError. Accuracy: first order in the errors of the
        parameters.
        Source: propagation of covariance through `Chain.screw_derivatives`.
        """
        return pose_covariance(self, q)

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

    def to_dh(self, convention: dh.Convention = "standard") -> FromChain:
        """The calibrated arm as a DH table, with error, bound and warnings; see `pk.dh.from_chain`."""
        return dh.from_chain(self.chain, convention=convention)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write all of it as TOML (extra `formats`), whole or not at all.

        `calibration.load` reads it back to the last bit, and `pk.load` the calibrated chain as a
        robot.
        Parameters: path, of the file.
        Raises: FileError; MissingExtra without tomli-w.
        """
        toml_io.save(self, path)

    def report(
        self,
        path: str | os.PathLike[str],
        title: str | None = None,
        sources: Sequence[str] | None = None,
    ) -> None:
        """Write a page that shows all of it: one HTML file, no scripts, nothing fetched
        (extra `report`).

        path: of the file; title: of the page; sources: what each row of q came from, such as file
        and line, to name outliers by.
        Raises: ShapeError, FileError; MissingExtra without Matplotlib.
        """
        html_report.write(self, path, title, sources)

    def summary(self) -> str:
        """Errors before and after, what could be identified, outliers and warnings, as text."""
        return summary.text_of(self)

    def __str__(self) -> str:
        return self.summary()


def load(path: str | os.PathLike[str]) -> Calibration:
    """The calibration in a file that `Calibration.save` wrote.

    Parameters: path, of the file. Returns: Calibration, equal to the one that was saved to the last
    bit.
    Raises: FileError for a file that cannot be read; ModelError with file and key for one that is
    no calibration, of another version, or that does not fit together.
    """
    return Calibration(**vars(toml_io.load(path)))
