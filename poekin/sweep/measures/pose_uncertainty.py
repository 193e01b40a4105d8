"""Measure of how precise an arm is: what errors of its screws and home pose do to its tool."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from ...checks import choice
from ...errors import InputError
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, chain_of
from ...solve.calibration.result import CalibrationData
from .error_program import error_program
from .error_sources import calibration_sources, covariance_sources, tolerance_sources
from .measure import Measure

if TYPE_CHECKING:
    from ...engine.straight_line.program import Program

ErrorPart = Literal["position", "orientation"]


@dataclass(frozen=True)
class PoseUncertainty(Measure):
    """Standard deviation of the tool's position (m) or orientation (rad), first order: sqrt(tr J Σ Jᵀ).

    J are the rows of `Chain.screw_derivatives` for the velocity of the tool's origin, or those of
    its rotation; Σ is the covariance of screws and home pose. It is made by one of the `by_`
    functions.

    Attributes
    ----------
    sources : tuple
        Independent errors of standard deviation 1, each n + 1 rows of six numbers: twists eta_i
        that move the screws, A_i <- Ad(e^eta_i) A_i, and eta of the home pose, M <- M e^eta.
    part : {"position", "orientation"}
        Part of the pose.
    bound : bool
        Whether the measure is the worst case instead, the sum of what each source does.

    Raises
    ------
    InputError
        If there is no source, or no such part.

    Notes
    -----
    Accuracy: first order; `monte_carlo` says what that leaves out, which grows with the square of
    the errors (tests/sweep/measures/test_monte_carlo.py). Source: propagation of covariance.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> error = pk.sweep.PoseUncertainty.by_tolerances(arm, offset=1e-4)
    >>> found = pk.sweep.reach(arm, resolution=0.2, samples=20_000, measure=error, keep="worst")
    >>> bool(found.best[found.counts > 0].max() < 3e-4)  # m
    True
    """

    sources: tuple[tuple[tuple[float, ...], ...], ...]
    part: ErrorPart = "position"
    bound: bool = False

    kind = 1
    sign = -1

    def __post_init__(self) -> None:
        choice(self.part, get_args(ErrorPart), "part")
        if not self.sources:
            raise InputError("error: expected an error above 0")

    @classmethod
    def by_tolerances(
        cls,
        chain: Arm,
        *,
        tilt: ArrayLike = 0.0,
        shift: ArrayLike = 0.0,
        offset: ArrayLike = 0.0,
        home_rotation: float = 0.0,
        home_position: float = 0.0,
        part: ErrorPart = "position",
        bound: bool = False,
    ) -> PoseUncertainty:
        """Error by tolerances of each screw and of the home pose, all independent.

        Parameters
        ----------
        chain : Chain or CompiledChain
            The arm.
        tilt, shift : float or (n,) array_like, default 0.0
            Of the joints' axes: rad about, and m along, each of the two directions across the axis,
            at the origin of its z-aligned frame.
        offset : float or (m,) array_like, default 0.0
            Of the coordinates, rad or m.
        home_rotation, home_position : float, default 0.0
            Of the home pose: rad about, and m along, each axis of the tool.
        part : {"position", "orientation"}, default "position"
            Part of the pose.
        bound : bool, default False
            Whether tolerances are bounds of the errors and the measure is the worst case; otherwise
            they are standard deviations.

        Returns
        -------
        error : PoseUncertainty
            The measure.

        Raises
        ------
        InputError
            If a tolerance is negative or not finite, or all are 0.
        ShapeError
            If there is another number of tolerances.
        """
        sources = tolerance_sources(
            chain_of(chain), tilt, shift, offset, home_rotation, home_position
        )
        return cls(_tuples(sources), part, bound)

    @classmethod
    def by_covariance(
        cls, chain: Arm, covariance: ArrayLike, part: ErrorPart = "position"
    ) -> PoseUncertainty:
        """Error by a covariance of all screws and the home pose.

        Parameters
        ----------
        chain : Chain or CompiledChain
            The arm.
        covariance : (6 (n + 1), 6 (n + 1)) array_like
            Covariance of eta_1, ..., eta_n, eta, rad and m, as `Chain.screw_derivatives` has them.
        part : {"position", "orientation"}, default "position"
            Part of the pose.

        Returns
        -------
        error : PoseUncertainty
            The measure.

        Raises
        ------
        InputError
            If it is no covariance.
        ShapeError
            If it has another shape.
        """
        return cls(_tuples(covariance_sources(chain_of(chain), covariance)), part)

    @classmethod
    def by_calibration(
        cls, found: CalibrationData, part: ErrorPart = "position"
    ) -> PoseUncertainty:
        """Error by what a calibration does not know of the arm that it found, `found.chain`.

        Parameters
        ----------
        found : Calibration
            Result of `poekin.calibrate`, of screws, home pose and offsets.
        part : {"position", "orientation"}, default "position"
            Part of the pose.

        Returns
        -------
        error : PoseUncertainty
            The measure.

        Raises
        ------
        InputError
            If gains, pitches or non-geometric terms were estimated.
        """
        return cls(_tuples(calibration_sources(found)), part)

    @property
    def name(self) -> str:
        """Part of the pose, and whether it is the worst case."""
        return f"{self.part}_{'bound' if self.bound else 'error'}"

    def check(self, chain: Chain) -> None:
        """Refuses an arm of another number of joints. Raises: InputError."""
        n = len(self.sources[0]) - 1
        if n != len(chain.joint_names):
            raise InputError(f"error: it is of an arm of {n} joints, {chain!r} is another")

    def program(self, chain: Chain) -> Program:
        """Pose, and squares of what the sources do."""
        return error_program(chain, self.sources, self.part == "orientation", not self.bound)

    def outputs(self, chain: Chain) -> int:
        """The sum, or a square for each source."""
        return len(self.sources) if self.bound else 1

    def describe(self) -> dict[str, object]:
        """SHA-256 of the sources, and how many there are."""
        content = np.array(self.sources).tobytes()
        return {"sources": len(self.sources), "sha256": hashlib.sha256(content).hexdigest()}


def _tuples(sources: Array) -> tuple[tuple[tuple[float, ...], ...], ...]:
    return tuple(tuple(map(tuple, source)) for source in sources.tolist())
