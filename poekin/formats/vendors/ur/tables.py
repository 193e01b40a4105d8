"""Factory calibrations out of DH tables: the arm's own, or the nominal one with its deltas."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ....errors import InputError, join_names, quote
from ....groups.vectors import norm, translation_part
from ....model.checks import finite
from ....model.provenance import warn
from ... import dh
from ...dh import Table
from ...dh.table import COLUMNS, check_table
from ...relink import relinked
from ...relink.branch import ON_AXIS, tip_off_axis
from ..calibration import FactoryCalibration
from ..deviations import FAR
from ..naming import JOINTS, LINKS


def add_deltas(
    table: Table,
    *,
    delta_theta: ArrayLike | None = None,
    delta_a: ArrayLike | None = None,
    delta_d: ArrayLike | None = None,
    delta_alpha: ArrayLike | None = None,
) -> Table:
    """Table with deltas added to its columns: an arm's own parameters from the nominal ones.

    Parameters
    ----------
    table : Table
        Nominal table, as `pk.dh.published("ur10e")`.
    delta_theta : (n,) array_like, optional
        Angles to add, rad, one number a joint, as the controller keeps them in calibration.conf
        (`read_deltas`).
    delta_a, delta_d : (n,) array_like, optional
        Lengths to add, m.
    delta_alpha : (n,) array_like, optional
        Angles to add, rad.

    Returns
    -------
    table : Table
        Table of the same convention, base, tool, name and coupling.

    Raises
    ------
    InputError
        If deltas are of another number of joints or not finite, or `table` is no Table.

    Notes
    -----
    Accuracy: one rounding. A controller takes π/2 to be 1.570796327, which is 2e-10 rad more than
    in the published tables of poekin, so its own alpha differs from this one by as much. Source:
    Universal Robots ROS 2 driver, ur_calibration/test/calibration_test.cpp, which adds them so.

    Examples
    --------
    >>> import poekin as pk
    >>> nominal = pk.dh.published("ur10e")
    >>> measured = pk.ur.add_deltas(nominal, delta_d=[2e-4, 0, 0, 0, 0, 0])
    >>> round(float(measured.d[0] - nominal.d[0]), 9)
    0.0002
    """
    check_table(table, "add_deltas")
    given = dict(zip(COLUMNS, (delta_theta, delta_d, delta_a, delta_alpha), strict=True))
    columns: dict[str, list[float]] = {}
    for column, values in given.items():
        change = np.zeros(len(table)) if values is None else finite(values, f"delta_{column}")
        if change.shape != (len(table),):
            raise InputError(
                f"delta_{column}: expected {len(table)} numbers, one a joint of the table {quote(table.name)}, got"
                f" {change.size if change.ndim == 1 else f'shape {change.shape}'}: the calibration of another arm?"
            )
        columns[column] = (getattr(table, column) + change).tolist()
    rows = [
        replace(row, **{column: values[i] for column, values in columns.items()})
        for i, row in enumerate(table.rows)
    ]
    return Table(
        table.convention,
        rows,
        base=table.base,
        tool=table.tool,
        name=table.name,
        coupling=table.coupling,
    )


def from_dh(
    table: Table,
    *,
    nominal: Table,
    hash: str = "",
) -> FactoryCalibration:
    """Calibration of an arm from its own DH table, with link frames near the nominal ones.

    Of two nearly parallel axes DH puts the frames where their common normal is, hundreds of metres
    away. Here each frame is the one on its joint's axis that is nearest to the nominal link, as
    `poekin.relinked` places it; the last one is the flange itself, so that f(q) is the table's.

    Parameters
    ----------
    table : Table
        Table of the arm, as the controller reports it or `add_deltas` makes it, rad and m.
    nominal : Table
        Published table of the same model, as `pk.dh.published("ur10e")`.
    hash : str, default ""
        Text by which the driver knows the arm again.

    Returns
    -------
    calibration : FactoryCalibration
        Six poses whose product is the table's f(q).

    Raises
    ------
    InputError
        If there are other joints than six revolute ones that are not flipped, or the flange is off
        the last axis (a or alpha of the last joint, or a tool), for which the form has no place.

    Warns
    -----
    PoekinWarning
        If a link moves by more than 2 cm: most likely the calibration of another arm.

    Notes
    -----
    Accuracy: pose as `pk.dh.to_chain`; tests/formats/vendors/test_ur.py has the figures of a real arm.
    Source: the driver's ur_calibration/doc/algorithm.rst says why frames must be moved back; where
    they go is decided here.

    Examples
    --------
    >>> import poekin as pk
    >>> nominal = pk.dh.published("ur10e")
    >>> measured = pk.ur.add_deltas(nominal, delta_alpha=[0, 1e-4, 0, 0, 0, 0])
    >>> calibration = pk.ur.from_dh(measured, nominal=nominal, hash="calib_1")
    >>> calibration.to_chain()
    <Chain 'base' -> 'tool0': 6 revolute joints, reach ... m>
    """
    for each in (table, nominal):
        _six(each)
    before = _frames(nominal).to_robot()
    chain = dh.to_chain(table)
    if tip_off_axis(chain, (0.0, 0.0, 1.0)) > ON_AXIS:
        raise InputError(
            f"the flange of the table {quote(table.name)} is off the axis of {quote(JOINTS[-1])}: a calibration"
            " has no place for a or alpha of the last joint, nor for a tool"
        )
    after = relinked(before, chain, tip=f"{LINKS[-1]}_link", turn="frames")
    joints = [after.joint(name) for name in JOINTS]
    for joint in joints:
        if joint.axis[2] < 0:
            raise InputError(
                f"the axis of {quote(joint.name)} points the other way in the table {quote(table.name)} than in"
                f" {quote(nominal.name)}: they are not of the same arm"
            )
    _warn_if_far(before.fk(np.zeros(6)), after.fk(np.zeros(6)), table, nominal)
    return FactoryCalibration(np.array([joint.origin for joint in joints]), hash)


def _frames(table: Table) -> FactoryCalibration:
    """Frames of a nominal table as ur_description places them: behind theta and d of each joint."""
    # Each row in two: the turn about z, and the normal.
    halves = []
    for row in table.rows:
        halves.append(dh.Row(theta=row.theta, d=row.d))
        halves.append(dh.Row(a=row.a, alpha=row.alpha))
    robot = dh.to_robot(Table("standard", halves, base=table.base))
    origins = [joint.origin for joint in robot.joints]
    return FactoryCalibration(np.array(origins[:-1:2]) @ np.array(origins[1::2]))


def _six(table: Table) -> None:
    check_table(table, "from_dh")
    name = quote(table.name)
    if len(table) != len(JOINTS):
        raise InputError(
            f"an arm of Universal Robots has {len(JOINTS)} joints, the table {name} has {len(table)}:"
            f" {join_names(table.names) or 'none'}"
        )
    for joint, kind, flip in zip(table.names, table.kinds, table.flips, strict=True):
        if flip:
            kind = "flipped"
        if kind != "revolute":
            raise InputError(
                f"table {name}: joint {quote(joint)} is {kind}; a calibration has turning joints about +z"
            )
    if table.convention != "standard":
        raise InputError(
            f"table {name}: expected the standard convention, as Universal Robots uses it, got 'modified'"
        )


def _warn_if_far(
    before: dict,
    after: dict,
    table: Table,
    nominal: Table,
) -> None:
    moved = {
        link: norm(translation_part(after[link]) - translation_part(T))
        for link, T in before.items()
    }
    worst = max(moved, key=lambda link: moved[link])
    if moved[worst] > FAR:
        warn(
            f"table {quote(table.name)} moves {quote(worst)} by {moved[worst] * 1e3:.3g} mm from where the"
            f" nominal {quote(nominal.name)} has it: the calibration of another arm?"
        )
