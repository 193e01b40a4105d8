"""Calibration: the result that users hold, data with methods of one line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, overload

from numpy.typing import ArrayLike

from ...analysis.compare.compare import compare
from ...analysis.compare.comparison import Comparison
from ...errors import quote
from ...formats import dh
from ...formats.dh.from_chain import FromChain
from ...formats.emit.c import CSource
from ...formats.relink import relinked
from ...formats.text.atomic_write import FilePath, write_whole
from ...formats.urdf_text import Into, to_urdf
from ...groups.arrays import Array
from ...model.coordinates import coordinates
from ...model.robot import Robot
from ...results import brief
from . import compensation, emission
from .compensation import Command
from .emission import Language
from .report import document, html_report, summary, toml_io
from .result import CalibrationData
from .terms.term import Term


class Calibration(CalibrationData):
    """Calibrated arm, how well it is known, and what was left over.

    Attributes
    ----------
    nominal, chain : Chain
        The nominal and the calibrated arm.
    parameters : tuple of Parameter
        Parameters that were estimated, those of unknown frames included.
    values : (P,) ndarray
        Their values, each in its unit.
    covariance : (P, P) ndarray
        Their covariance; fixed directions have no variance.
    frames : dict of str to ndarray
        Unknown frames (4, 4) and points (3,), m, by name.
    identification : Identification
        Parameters that the measurements identify.
    success : bool
        Whether the search converged.
    steps : tuple of Step
        Its history.
    before, after : Residuals
        On all measurements, with unknown frames fitted only, and calibrated.
    cross_validation : CrossValidation or None
        Residuals on held-out data; None where none was.
    outliers : tuple of Outlier
        Measurements that are grossly off, beside the effects that the diagnosis found.
    noise_std : tuple of NoiseEstimate or None
        Standard deviations estimated for each set without covariances, None for the others.
    loss : {"linear", "huber", "cauchy", "tukey"}
        Loss that was minimised.
    error_model : ErrorModel
        Model by which the parameters move the arm.
    warnings : tuple of str
        The tool, or the arm itself, is another one than the nominal, which was off by more than a
        tenth of its reach, or residuals are larger than a covariance that was given.
    remarks : tuple of str
        The nominal arm is off by as much, as its base is elsewhere, or residuals are smaller than a
        covariance.
    verdict : tuple of str
        Reasons not to use the calibrated arm, none where it is sound; the first names the cause
        that explains the measurements best, with the error that it would leave.
    residuals : ResidualVectors or None
        Readings, measured points and their residuals in the base frame, `residuals.in_axes("tool")`
        those in axes of the tool; None where it was loaded from a file, which does not hold the
        measurements.
    diagnosis : ResidualDiagnosis or None
        Effects that the residuals show; None of a file that an older poekin wrote.
    evidence : FitEvidence, SavedEvidence or None
        Measurements, fit and conditions that the diagnosis is made of; of a file the diagnosis itself.
    terms : tuple of TermGain
        Gain on held-out readings of each non-geometric term that is in the fit, and with
        `parameters="auto"` of those that are not.
    """

    def true_joints(self, q: Any, conditions: Mapping[str, Any] | None = None) -> Array:
        """Joint values at which the calibrated `chain` is where the arm is at these readings.

        Without non-geometric terms they are the readings.

        Parameters
        ----------
        q : (..., m) array_like or dict
            Readings, rad or m.
        conditions : dict of str to array_like, optional
            As of `pk.calibrate`, over the leading axes of q made flat. What is not said is as it was
            at the calibration on average, and the arm comes from nowhere.

        Returns
        -------
        q_true : (..., m) ndarray
            Joint values, rad or m: q + B(q) c.

        Raises
        ------
        ShapeError, UnknownName, InputError
            If q or the conditions do not fit the arm, or the calibration does not know of them.

        Notes
        -----
        Accuracy: rounding of the terms. Source: none, it adds them.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.load("ur5").chain()
        >>> made = pk.calibration.simulated(arm, 40, seed=2)
        >>> kinds = ("screws", "home", "compliance")
        >>> found = pk.calibrate(arm, made.q, made.measurements, parameters=kinds, folds=0)
        >>> q = arm.random(0, 5)
        >>> T = found.chain.fk(found.true_joints(q))
        >>> float(abs(found.true_joints(q) - q).max()) < 1e-2
        True
        """
        q = coordinates(q, self.nominal.q_names)
        return compensation.true_joints(self, q, conditions)

    def compensate(
        self,
        T: ArrayLike,
        *,
        nearest_to: Any = None,
        conditions: Mapping[str, Any] | None = None,
    ) -> Command:
        """Command for the uncalibrated controller that puts the tool at T.

        Parameters
        ----------
        T : (..., 4, 4) array_like
            Poses where the tip shall be, m.
        nearest_to : (m,) or (..., m) array_like or dict, optional
            Configuration to be near to, as of `pk.ik`.
        conditions : dict of str to array_like, optional
            As of `true_joints`.

        Returns
        -------
        command : Command
            Joint readings to drive to, and the poses that the nominal arm has there, to be given to
            a controller that solves its own inverse kinematics.

        Raises
        ------
        ShapeError, PoseError, UnknownName, InputError
            If T, nearest_to or the conditions do not fit the arm; if T is out of reach.

        Notes
        -----
        Accuracy: the calibrated arm is at T within 1e-9 m and rad. Source: inverse kinematics of the
        calibrated arm, then q = q_true - B(q) c by fixed-point iteration, a contraction as terms are
        small.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.load("ur5").chain()
        >>> made = pk.calibration.simulated(arm, 40, seed=2)
        >>> found = pk.calibrate(arm, made.q, made.measurements, folds=0)
        >>> T = arm.fk(made.q[0])
        >>> command = found.compensate(T, nearest_to=made.q[0])
        >>> float(abs(found.chain.fk(command.q) - T).max()) < 1e-9
        True
        """
        return compensation.compensate(self, T, nearest_to, conditions)

    @overload
    def emit(self, language: Literal["c"], *, name: str = "arm", origin: str = "") -> CSource: ...

    @overload
    def emit(self, language: Literal["python"], *, name: str = "arm", origin: str = "") -> str: ...

    def emit(self, language: Language, *, name: str = "arm", origin: str = "") -> str | CSource:
        """`true_joints` as source text that needs no poekin, beside `pk.emit.c(found.chain, ...)`.

        Parameters
        ----------
        language : {"c", "python"}
            C99 in double, of math.h alone, or Python for arrays of NumPy, JAX and PyTorch.
        name : str, default "arm"
            Name with which the C names begin.
        origin : str, default ""
            Words for the head of the text on where the calibration is from.

        Returns
        -------
        source : CSource or str
            Files NAME_true_joints.h, .c and _selftest.c, or a module. The function `true_joints` is of
            the readings q and, where the terms depend on any, of the conditions in the order that the
            head of the text says; it gives the true joint values.

        Raises
        ------
        InputError
            If there are no non-geometric terms, one is a `Term` without a formula, the language is
            neither, or name or origin is no text.

        Notes
        -----
        Accuracy: 1e-12 (rad, m) of `true_joints` (tests/solve/calibration/test_emission.py). Source: the
        formulas of the terms, traced.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.load("ur5").chain()
        >>> made = pk.calibration.simulated(arm, 40, seed=2)
        >>> kinds = ("screws", "home", "compliance")
        >>> found = pk.calibrate(arm, made.q, made.measurements, parameters=kinds, folds=0)
        >>> list(found.emit("c", name="ur5").files)
        ['ur5_true_joints.h', 'ur5_true_joints.c', 'ur5_true_joints_selftest.c']
        """
        return emission.emit(self, language, name, origin)

    def compare(self) -> Comparison:
        """Comparison of the nominal and the calibrated arm, joint by joint.

        Returns
        -------
        comparison : Comparison
            As of `pk.compare`.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.load("ur5").chain()
        >>> made = pk.calibration.simulated(arm, 30, seed=2)
        >>> found = pk.calibrate(arm, made.q, made.measurements, folds=0)
        >>> len(found.compare().joints)
        6
        """
        return compare(self.nominal, self.chain)

    def to_robot(self, robot: Robot) -> Robot:
        """Robot whose branch from the chain's base to its tip moves as calibrated.

        Parameters
        ----------
        robot : Robot
            The nominal robot.

        Returns
        -------
        calibrated : Robot
            As of `pk.relinked`.

        Raises
        ------
        ModelError, UnknownName
            As `pk.relinked`.
        """
        return relinked(robot, self.chain, base=self.chain.base, tip=self.chain.tip)

    @overload
    def to_urdf(self, robot: Robot, *, into: None = None) -> str: ...

    @overload
    def to_urdf(self, robot: Robot, *, into: Into) -> bytes: ...

    def to_urdf(self, robot: Robot, *, into: Into | None = None) -> str | bytes:
        """URDF of `to_robot(robot)`.

        Parameters
        ----------
        robot : Robot
            The nominal robot.
        into : str or os.PathLike or bytes or Robot, optional
            Its own URDF, in whose text only origins and axes are changed: as of `pk.to_urdf`, so
            `robot` itself where it was read from one.

        Returns
        -------
        text : str or bytes
            The URDF; the content of the edited file with `into`.

        Raises
        ------
        ModelError, UnknownName, InputError
            As `to_robot` and `pk.to_urdf`.
        """
        calibrated = self.to_robot(robot)
        if into is None:
            return to_urdf(calibrated)
        return to_urdf(calibrated, into=into)

    def to_dh(self, convention: dh.Convention = "standard") -> FromChain:
        """Calibrated arm as a DH table, with error, bound and warnings.

        Parameters
        ----------
        convention : {"standard", "modified"}, default "standard"
            Convention of the table.

        Returns
        -------
        found : FromChain
            As of `pk.dh.from_chain`.

        Raises
        ------
        InputError
            If the convention is none.
        """
        return dh.from_chain(self.chain, convention=convention)

    def save(self, path: FilePath) -> None:
        """Write all of it as TOML (extra `formats`), whole or not at all.

        `calibration.load` reads it back to the last bit, and `pk.load` the calibrated chain as a
        robot.

        Parameters
        ----------
        path : str or os.PathLike
            Path of the file.

        Raises
        ------
        FileError
            If the file cannot be written.
        MissingExtra
            Without tomli-w.
        """
        toml_io.save(self, path)

    def report(
        self,
        path: FilePath,
        title: str | None = None,
        sources: Sequence[str] | None = None,
    ) -> None:
        """Write a page that shows all of it: one HTML file, no scripts, nothing fetched.

        Parameters
        ----------
        path : str or os.PathLike
            Path of the file.
        title : str, optional
            Title of the page.
        sources : sequence of str, optional
            Source of each row of q, such as file and line, by which outliers are named.

        Raises
        ------
        ShapeError
            If there are fewer sources than rows.
        FileError
            If the file cannot be written.
        MissingExtra
            Without Matplotlib (extra `report`).
        """
        write_whole(path, html_report.html(self, title, sources).encode())

    def __repr__(self) -> str:
        arm = f"{quote(self.chain.base)} -> {quote(self.chain.tip)}"
        return brief(self, f"{arm}, {summary.headline(self)}")

    def summary(self) -> str:
        """Errors before and after, what could be identified, outliers and warnings, as text."""
        return summary.text_of(self)

    def to_dict(self) -> dict[str, object]:
        """Statistics, parameters, frames and identification as dicts, lists and numbers, in SI."""
        return document.document(self)


def load(path: FilePath, terms: Sequence[Term] = ()) -> Calibration:
    """Calibration in a file that `Calibration.save` wrote.

    Parameters
    ----------
    path : str or os.PathLike
        Path of the file.
    terms : sequence of Term, optional
        The user's own terms that it was calibrated with: files hold no functions.

    Returns
    -------
    found : Calibration
        Equal to the one that was saved to the last bit, with its terms, masses and diagnosis; but
        without the measurements, so that `residuals` is None.

    Raises
    ------
    FileError
        If the file cannot be read.
    ModelError
        With file and key, if it is no calibration, of another version, or does not fit together.
    """
    return Calibration(**vars(toml_io.load(path, terms)))
