"""Calibrations put on robots, and refused on a robot of another arm."""

from __future__ import annotations

import os
from typing import NamedTuple

from ...checks import true_or_false
from ...errors import InputError, PoekinError, quote, safe_repr
from ...formats import chain_toml
from ...formats.relink import relinked
from ...formats.text.atomic_write import FilePath
from ...formats.vendors import yaml_io
from ...formats.vendors.calibration import FactoryCalibration
from ...formats.vendors.deviations import LARGEST, deviations, origins
from ...formats.vendors.known_arms import best_fit
from ...formats.vendors.naming import Naming
from ...model.chain import Chain
from ...model.robot import Robot
from .calibration import Calibration
from .exact.from_fk_result import FromFk


def apply(
    robot: Robot,
    calibration: Calibration | FromFk | FactoryCalibration | Chain | FilePath,
    *,
    base: str | None = None,
    tip: str | None = None,
    force: bool = False,
) -> Robot:
    """Robot with the kinematics of a calibration and, nearly, its own link frames.

    As `poekin.relinked` does: names, limits, mimic and all that hangs off the arm are the robot's.
    A calibration of another arm is refused.

    Parameters
    ----------
    robot : Robot
        Nominal robot.
    calibration : Calibration, FromFk, FactoryCalibration, Chain, str or os.PathLike
        Result of `pk.calibrate` or `from_fk`; a vendor's factory calibration (`pk.vendors.read`); a chain with
        the calibrated screws and home pose; or the path of a file: .toml of `Calibration.save`,
        .yaml or .yml of a vendor.
    base, tip : str, optional
        Links at which the branch begins and ends. By default those of the calibration: its chain's,
        or the vendor's names (`base` and `tool0`, `link_base` and `link_eef`, `base_link` and
        `flange`), also behind a prefix as in left_tool0. Where the robot has none of the vendor's
        names: the root and the only leaf.
    force : bool, default False
        Whether to put it on whatever arm it is of.

    Returns
    -------
    robot : Robot
        The robot, calibrated.

    Raises
    ------
    InputError
        If the calibration is not of this arm: an axis or the tip is more than 20 mm or 3° off. If
        the robot's joints are not those of the calibration, as `poekin.relinked` says. If base or
        tip must be named, or `calibration` is none.
    UnknownName
        If there is no link of that name.
    FileError
        If the file cannot be read.
    ModelError
        If it cannot be understood.

    Notes
    -----
    Judged at zero, joint by joint: the distance of the new axis from the origin of the link that the
    joint moves, the angle between the axes, and the pose of the tip. Factory calibrations move an
    axis by some millimetres and up to half a degree. For a `Calibration` the nominal arm it began
    with is judged, so that a base or tool that was found elsewhere is no reason to refuse it.

    Accuracy: as `poekin.relinked`.

    Examples
    --------
    >>> import poekin as pk
    >>> nominal = pk.dh.published("ur5e")
    >>> measured = pk.ur.add_deltas(nominal, delta_a=[0, 1e-3, 0, 0, 0, 0])
    >>> calibration = pk.ur.from_dh(measured, nominal=nominal)
    >>> robot = pk.calibration.apply(pk.load("ur5e"), calibration)
    >>> q = [0.0] * 6
    >>> change = robot.chain().fk(q)[:3, 3] - pk.load("ur5e").chain().fk(q)[:3, 3]
    >>> float(abs(change).max().round(9))
    0.001
    """
    if not isinstance(robot, Robot):
        raise InputError(f"apply: expected a Robot, got {safe_repr(robot)}")
    true_or_false(force, "force")
    new = _resolved(robot, calibration, base, tip)
    nominal = robot.chain(new.base, new.tip)
    if not force and _alike(nominal, new.judged):
        _refuse_other_arm(robot, nominal, new.judged)
    try:
        return relinked(robot, new.chain, base=new.base, tip=new.tip)
    except InputError as fault:
        raise InputError(f"{fault}{_fits(new.judged)}") from fault


class _Kinematics(NamedTuple):
    """The chain to put on a robot, the one that says which arm it is of, and the ends of both."""

    chain: Chain
    judged: Chain
    base: str | None
    tip: str | None


def _resolved(
    robot: Robot,
    calibration: object,
    base: str | None,
    tip: str | None,
) -> _Kinematics:
    if isinstance(calibration, (str, os.PathLike)):
        calibration = _read(calibration)
    if isinstance(calibration, FactoryCalibration):
        chain = calibration.to_chain()
        return _Kinematics(chain, chain, *_ends(robot, calibration.naming, base, tip))
    if isinstance(calibration, FromFk):
        calibration = calibration.calibration
    if isinstance(calibration, Chain):
        calibration = _Chains(None, calibration)
    if isinstance(calibration, (Calibration, _Chains)):
        chain = calibration.chain
        judged = calibration.nominal or chain
        return _Kinematics(chain, judged, base or chain.base, tip or chain.tip)
    raise InputError(
        "apply: expected a Calibration, a FactoryCalibration, a Chain or the path of a file, got"
        f" {type(calibration).__name__}"
    )


class _Chains(NamedTuple):
    """The arm that a calibration began with, where it is known, and the calibrated one."""

    nominal: Chain | None
    chain: Chain


def _read(path: FilePath) -> _Chains | FactoryCalibration:
    ending = os.path.splitext(os.fsdecode(path))[1].lower()
    if ending == ".toml":
        return _Chains(*chain_toml.read_chains(path))
    if ending in yaml_io.ENDINGS:
        return yaml_io.read(path)
    raise InputError(
        f"{quote(os.fsdecode(path), 400)}: expected a calibration, a .toml of"
        " `Calibration.save` or a .yaml of a vendor; pk.relinked puts the chain of any other model on a robot"
    )


def _ends(
    robot: Robot,
    naming: Naming,
    base: str | None,
    tip: str | None,
) -> tuple[str | None, str | None]:
    """Base and tip by the vendor's names, behind the same prefix."""
    last = naming.last
    if tip is None:
        ends = [link for link in robot.links if link == last or link.endswith(f"_{last}")]
        if last in ends:
            tip = last
        elif len(ends) == 1:
            tip = ends[0]
    if base is None:
        prefix = ""
        if tip is not None and tip.endswith(last):
            prefix = tip.removesuffix(last)
        names = (f"{prefix}{name}" for name in naming.bases)
        base = next((name for name in names if name in robot.links), None)
    return base, tip


def _alike(nominal: Chain, judged: Chain) -> bool:
    """Tests whether joints can be compared one by one; what cannot, `relinked` refuses."""
    mine = nominal.joint_names
    theirs = judged.joint_names
    other_order = mine != theirs and set(mine) == set(theirs)
    return nominal.kinds == judged.kinds and not other_order


def _refuse_other_arm(
    robot: Robot,
    nominal: Chain,
    judged: Chain,
) -> None:
    found = deviations(nominal, judged, origins(robot, nominal))
    tip = found[-1]
    first = next((each for each in found if each.far), None)
    if first is None:
        return
    words = f"the tip {quote(tip.name)} is {tip.summary()} off"
    if first is not tip:
        words = f"the axis of {quote(first.name)} is {first.summary()} off, {words}"
    raise InputError(
        f"the calibration is not of the arm {quote(robot.name)}, from {quote(nominal.base)} to"
        f" {quote(nominal.tip)}: {words}, and one of the same arm moves them by less than"
        f" {LARGEST.summary()}{_other_end(robot, nominal, judged)}{_fits(judged)};"
        " force=True (--force) puts it on all the same"
    )


def _other_end(
    robot: Robot,
    nominal: Chain,
    judged: Chain,
) -> str:
    """Part of a message: the base or tip between which the robot is the arm after all."""
    for link in robot.links:
        for end, base, tip in (("base", link, nominal.tip), ("tip", nominal.base, link)):
            try:
                chain = robot.chain(base, tip)
            except PoekinError:  # no way between them
                continue
            if chain.joint_names != nominal.joint_names:
                continue
            found = deviations(chain, judged, origins(robot, chain))
            if not any(each.far for each in found):
                return f"; with {quote(link)} for the {end} it is of this arm"
    return ""


def _fits(chain: Chain) -> str:
    """End of a message: the known arm that a chain fits."""
    fit = best_fit(chain)
    if fit is None:
        return ""
    return f"; it fits {quote(fit.arm.name)}, within {fit.worst.summary()}"
