"""Trajectory: coordinates and rates over time, and the files that controllers take."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from ....checks import choice, is_real, positive
from ....errors import FileError, InputError, quote, safe_repr
from ....formats.text import csv_rows
from ....formats.text.atomic_write import FilePath, write_whole
from ....groups.arrays import Array, numbers
from ....groups.vectors import norms, translation_part
from ....model.chain import Chain
from ....model.readings.coupled import joint_values
from ....results import Result
from ...ik.diagnosis import AT_LIMIT
from ..csv_io import TIME, velocity_columns
from . import hermite
from .joint_trajectory import MessageFormat, json_text, yaml_text
from .urscript import check_urscript, urscript

ENDINGS = (".csv", ".yaml", ".yml", ".json", ".script")
"""Endings of the names of files that a trajectory is written to."""


class TrajectorySample(NamedTuple):
    """Values of a trajectory at some times t (...).

    Attributes
    ----------
    q : (..., m) ndarray
        Coordinates, rad or m.
    dq : (..., m) ndarray
        Rates, per s.
    ddq : (..., m) ndarray
        Accelerations, per s².
    """

    q: Array
    dq: Array
    ddq: Array


@dataclass(frozen=True, eq=False)
class Trajectory(Result):
    """Coordinates and rates of an arm at N times, at rest at both ends, as `time_optimal` makes it.

    A call with t (...), s, gives the `TrajectorySample` there: between the points q is a cubic of
    the time, as a controller that is given positions and velocities interpolates; before and after,
    the arm rests at the ends.

    Attributes
    ----------
    chain : Chain
        The arm.
    times : (N,) ndarray
        Times, s, ascending from 0, whole nanoseconds.
    q : (N, m) ndarray
        Coordinates, rad or m.
    dq : (N, m) ndarray
        Rates, per s; the first and the last are exactly 0.
    speed, acceleration : (m,) ndarray
        Limits of each coordinate, per s and s².
    waypoints : (K,) ndarray
        Number of the point at which each given configuration is reached.
    """

    derived = (
        "duration",
        "largest_speed",
        "largest_acceleration",
        "beyond_limits",
        "joints_beyond_limits",
        "path_deviation",
    )
    left_out = ("chain",)

    chain: Chain
    times: Array
    q: Array
    dq: Array
    speed: Array
    acceleration: Array
    waypoints: np.ndarray

    def __call__(self, t: ArrayLike) -> TrajectorySample:
        """q, dq and ddq at t (...), s. Raises: InputError."""
        t = numbers(t, "t")
        within = np.clip(t, 0.0, self.duration)
        q, dq, ddq = hermite.sample(self.times, self.q, self.dq, within)
        moving = (t >= 0) & (t <= self.duration)
        rest = np.where(np.isnan(t), np.nan, 0.0)[..., None]
        dq = np.where(moving[..., None], dq, rest)
        ddq = np.where(moving[..., None], ddq, rest)
        return TrajectorySample(q, dq, ddq)

    @property
    def duration(self) -> float:
        """Time of the last point, s."""
        return float(self.times[-1])

    @cached_property
    def largest_speed(self) -> Array:
        """Largest |dq| (m,) of each coordinate at any time, per s."""
        return hermite.peaks(self.times, self.q, self.dq)[0].max(axis=0)

    @cached_property
    def largest_acceleration(self) -> Array:
        """Largest |ddq| (m,) of each coordinate at any time, per s²."""
        return hermite.peaks(self.times, self.q, self.dq)[1].max(axis=0)

    @cached_property
    def beyond_limits(self) -> Array:
        """Largest distance (m,) of each coordinate from the chain's limits, rad or m; 0 within."""
        return _excess(self.q, self.chain.limits)

    @cached_property
    def joints_beyond_limits(self) -> Array:
        """Largest distance (n,) of each joint from its own limits, rad or m; 0 within."""
        return _excess(joint_values(self.chain, self.q), self.chain.joint_limits)

    @cached_property
    def path_deviation(self) -> float:
        """Largest distance (m) of the tip from the straight lines between its waypoints."""
        positions = translation_part(self.chain.fk(self.q))
        corners = positions[self.waypoints]
        points = np.arange(len(positions))
        k = np.searchsorted(self.waypoints[1:-1], points, side="right")
        way = corners[k + 1] - corners[k]
        off = positions - corners[k]
        length = np.sum(way * way, axis=1)
        along = np.sum(off * way, axis=1) / np.where(length > 0, length, 1.0)
        across = off - np.clip(along, 0.0, 1.0)[:, None] * way
        return float(norms(across).max())

    def to_csv(self) -> str:
        """Text with the columns time, one for each coordinate, and NAME_velocity for each.

        Returns
        -------
        text : str
            CSV, which `motion.read_joints` reads; s, rad or m, and per s.
        """
        names = self.chain.q_names
        header = (TIME, *names, *velocity_columns(names))
        return csv_rows.text(header, np.column_stack([self.times, self.q, self.dq]))

    def to_joint_trajectory(self, format: MessageFormat = "yaml") -> str:
        """Text of a message trajectory_msgs/JointTrajectory of ROS.

        Each point has positions, velocities and `time_from_start`; a controller interpolates by
        cubics. The arm has to be at the first point: its time is 0.

        Parameters
        ----------
        format : {"yaml", "json"}, default "yaml"
            Form of the text; numbers are read alike by YAML 1.1 and 1.2.

        Returns
        -------
        text : str
            The message; rad or m, and per s.

        Raises
        ------
        InputError
            If the format is none of those.
        """
        choice(format, get_args(MessageFormat), "format")
        write = yaml_text if format == "yaml" else json_text
        return write(self.chain.q_names, self.times, self.q, self.dq)

    def to_urscript(
        self,
        *,
        step: float = 0.008,
        lookahead: float = 0.1,
        gain: float = 300,
    ) -> str:
        """Program for a robot of Universal Robots: movej to the first point, then servoj.

        The last point is held for the time of looking ahead, in which the arm comes to it.

        Parameters
        ----------
        step : float, default 0.008
            Seconds of each servoj: whole cycles of the controller, 0.008 of a CB series, 0.002 of
            an e-Series.
        lookahead : float, default 0.1
            Time of looking ahead, 0.03 to 0.2 s, by which the arm follows more smoothly.
        gain : float, default 300
            Gain of the servo, 100 to 2000.

        Returns
        -------
        text : str
            URScript; rad, s.

        Raises
        ------
        ModelError
            If the arm has other than six revolute joints, each with its own coordinate.
        InputError
            If a number is not positive, or out of its range.
        """
        check_urscript(self.chain)
        positive(step, "step")
        _check_range(lookahead, "lookahead", 0.03, 0.2)
        _check_range(gain, "gain", 100, 2000)
        count = int(np.ceil((self.duration + lookahead) / step))
        samples = self(step * np.arange(count + 1)).q
        return urscript(self.chain.q_names, samples, step, lookahead, gain)

    def write(self, path: FilePath) -> None:
        """Writes a file that a controller takes; its name says what.

        Parameters
        ----------
        path : path_like
            File that ends in .csv (`to_csv`), .yaml, .yml or .json (`to_joint_trajectory`), or
            .script (`to_urscript`); it appears whole or not at all.

        Raises
        ------
        FileError
            If the name ends in something else, or the file cannot be written.
        ModelError
            If the arm is none that URScript is for.
        """
        write_whole(path, self.text_of(path).encode())

    def text_of(self, path: FilePath) -> str:
        """Text that `write` gives a file of this name.

        Parameters
        ----------
        path : path_like
            Name of the file.

        Returns
        -------
        text : str
            Content of the file; rad or m, and s.

        Raises
        ------
        FileError
            If the name ends in something else.
        ModelError
            If the arm is none that URScript is for.
        """
        ending = Path(path).suffix.lower()
        if ending == ".csv":
            return self.to_csv()
        if ending in (".yaml", ".yml"):
            return self.to_joint_trajectory("yaml")
        if ending == ".json":
            return self.to_joint_trajectory("json")
        if ending == ".script":
            return self.to_urscript()
        raise FileError(
            f"cannot write {quote(path)}: a name that ends in {', '.join(ENDINGS)} expected"
        )

    def summary(self) -> str:
        """Report, one sentence a line: the duration, how near each coordinate comes to its limits.

        Returns
        -------
        text : str
            Rates in rad or m, distances in mm.
        """
        sentences = [
            f"{self.duration:.6g} s, {len(self.times)} points, at rest at both ends",
            f"between its waypoints the tip is at most {1e3 * self.path_deviation:.3g} mm off the "
            "straight lines",
            *map(self._used, range(self.chain.dof)),
            *self._used_by_joints(),
            *self._beyond(),
        ]
        return "\n".join(sentences)

    def __repr__(self) -> str:
        return f"<Trajectory {self.duration:.6g} s, {len(self.times)} points>"

    def _used(self, k: int) -> str:
        speed = self.largest_speed[k] / self.speed[k]
        acceleration = self.largest_acceleration[k] / self.acceleration[k]
        return (
            f"{quote(self.chain.q_names[k])}: {100 * speed:.3g} % of its speed, "
            f"{100 * acceleration:.3g} % of its acceleration"
        )

    def _used_by_joints(self) -> list[str]:
        C = self.chain.coupling.T
        speeds = hermite.peaks(self.times, self.q @ C, self.dq @ C)[0].max(axis=0)
        shares = zip(self.chain.joint_names, speeds / self.chain.joint_velocity_limits, strict=True)
        return [
            f"joint {quote(name)}: {100 * share:.3g} % of its own speed"
            for name, share in shares
            if share
        ]

    def _beyond(self) -> list[str]:
        coordinates = zip(map(quote, self.chain.q_names), self.beyond_limits, strict=True)
        joints = zip(self.chain.joint_names, self.joints_beyond_limits, strict=True)
        said = [(f"{name} leaves its limits", excess) for name, excess in coordinates]
        said += [(f"joint {quote(name)} leaves its own limits", excess) for name, excess in joints]
        return [f"{words} by {excess:.3g} (rad or m)" for words, excess in said if excess > 0]


def _excess(x: Array, limits: Array) -> Array:
    """Largest distance (k,) of values (N, k) from limits (k, 2), 0 within."""
    low, high = limits.T
    beyond = np.maximum(low - x, x - high).max(axis=0)
    return np.where(beyond > AT_LIMIT, beyond, 0.0)


def _check_range(value: float, what: str, low: float, high: float) -> None:
    if not is_real(value) or not low <= value <= high:
        raise InputError(f"{what}: expected a number from {low} to {high}, got {safe_repr(value)}")
