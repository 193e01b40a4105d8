"""Verdict on a calibration: the reasons not to use it, and the cause that explains them best."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import norm, norms, translation_part
from ..causes.most_likely import most_likely
from ..model.parameters import SHIFT, TILT
from ..model.problem import Problem
from ..model.residuals import Residuals, median, rms
from ..result import CalibrationData
from .explanation import set_name
from .misfit import Contradiction

AXIS_TILT = math.radians(3.0)
"""An axis that is off by more is no arm's; the tip, or a zero, another one."""
AXIS_SHIFT = 0.1
"""The same of shifts, in lengths of the longer of an axis's two links."""
TIP_SHIFT = 0.025
"""m: a tip that is off by more is another one."""
RESIDUAL = 5e-3
"""m: by more no rigid arm is off after calibration."""
NOISE_TIMES = 10.0
"""The same in standard deviations that were told."""
CONDITION = 1e3
_ROUNDING = 1e-9  # m: a nominal arm that is off by less cannot be made better
_LOOSE = 1e-2  # rad or m: by more the parameters of an arm are not off
_LEAST_LINK = 0.1  # reaches: a link that is shorter counts as so long
_CHANCE = 1.645  # standard deviations of a mean that is above zero by chance once in 20 times


def judge(
    found: CalibrationData,
    problem: Problem,
    doubts: Sequence[Contradiction],
    has_prior: bool,
    to_hold_out: bool,
) -> tuple[str, ...]:
    """Reasons not to use the calibrated arm, the likely cause with the first; none where it is
    sound.

    has_prior: of any parameters; to_hold_out: whether data were to be held out, should they be
    enough for that.
    """
    reasons = [*_held_out(found, to_hold_out), *_left(found, problem, doubts), *_moved(found)]
    condition = [] if has_prior else list(_condition(found, problem))
    if not reasons:
        return tuple(condition)
    cause = most_likely(problem.model, problem.q, problem.sets)
    if cause is None:
        # it is why the others are
        return (*condition, *reasons)
    first, *others = reasons
    return (f"{first}; most likely: {cause}", *others, *condition)


def _held_out(found: CalibrationData, to_hold_out: bool) -> Iterator[str]:
    """Held-out data that are predicted no better than by the nominal arm, or by chance; too few to
    hold any out.
    """
    held_out = found.cross_validation
    if held_out is None:
        if to_hold_out:
            yield (
                f"{found.identification.n_equations} equations for {len(found.values)} parameters "
                "are too few to hold some out, and nothing shows that the calibrated arm is better:"
                " measure more, or calibrate fewer parameters"
            )
        return
    before = _by_configuration(held_out.before)
    after = _by_configuration(held_out.after)
    size, name = _size(found)
    was = size(before)
    now = size(after)
    if was < _ROUNDING:
        return
    figures = f"off by {1e3 * now:.3g} mm, the nominal arm by {1e3 * was:.3g} mm ({name})"
    gains = before - after
    gain = float(np.mean(gains))
    if gain <= 0.0 or now >= was:
        yield f"held-out data are predicted no better than before: {figures}"
    elif gain < _CHANCE * float(np.std(gains)) / len(gains) ** 0.5:
        yield (
            f"{len(gains)} configurations for {len(found.values)} parameters are too few, the gain "
            f"on held-out data may be chance: {figures}; measure more, or calibrate fewer "
            "parameters"
        )


def _by_configuration(found: Residuals) -> Array:
    """Root mean square distance at each row of q."""
    _, which = np.unique(found.row, return_inverse=True)
    squares = np.bincount(which, found.length**2) / np.bincount(which)
    return np.sqrt(squares)


def _size(found: CalibrationData) -> tuple[Callable[[Array], float], str]:
    """Size of errors, and its name: a robust loss is for data of which some are grossly wrong."""
    if found.loss == "linear":
        return rms, "rms"
    return median, "median"


def _left(
    found: CalibrationData,
    problem: Problem,
    doubts: Sequence[Contradiction],
) -> Iterator[str]:
    """Residuals of more than 5 mm, or more than ten times the noise that was told."""
    yield from (doubt.words for doubt in doubts if doubt.ratio > NOISE_TIMES)
    size, _ = _size(found)
    for k, s in enumerate(problem.sets):
        off = size(found.after.of_set(k).length)
        if s.covariance is None and off > RESIDUAL:
            which = set_name(problem.sets, k, "the")
            odd = len([o for o in found.outliers if o.set == k])
            outliers = ""
            if found.loss == "linear" and 0 < odd < len(s) // 4:
                outliers = f", {odd} of {len(s)} stand out (loss='huber' gives them less weight)"
            yield f"{which}: the calibrated arm is still off by {1e3 * off:.3g} mm{outliers}"


def _moved(found: CalibrationData) -> Iterator[str]:
    """Axes, zeros and a tip that moved by more than those of any arm are off."""
    nominal = found.nominal
    lengths = norms(translation_part(nominal.local.frames))
    lengths = np.maximum(lengths, _LEAST_LINK * nominal.reach)
    longer = np.maximum(lengths[:-1], lengths[1:])
    links = dict(zip(nominal.joint_names, longer, strict=True))
    tilts = dict.fromkeys(nominal.joint_names, 0.0)
    shifts = tilts.copy()
    own = found.error_model.parameters
    for parameter, value in zip(own, found.values.tolist(), strict=False):
        for word, sizes in ((TILT, tilts), (SHIFT, shifts)):
            if parameter.what.startswith(word):
                sizes[parameter.owner] = math.hypot(sizes[parameter.owner], value)
    for name, link in links.items():
        if tilts[name] > AXIS_TILT or shifts[name] > AXIS_SHIFT * link:
            yield (
                f"the axis of {name} moves by {_degrees(tilts[name])}° and "
                f"{1e3 * shifts[name]:.3g} mm, further than that of any arm is off"
            )
    errors = found.error_model.errors(found.values[: len(own)])
    turn = norm(errors.home[:3])
    shift = norm(errors.home[3:])
    if turn > AXIS_TILT or shift > TIP_SHIFT:
        yield f"the tip moves by {_degrees(turn)}° and {1e3 * shift:.3g} mm, to another one"
    for k in np.flatnonzero(np.abs(errors.offsets) > AXIS_TILT).tolist():
        if nominal.is_angle(k):
            yield f"the zero of {nominal.q_names[k]} moves by {_degrees(errors.offsets[k])}°"


def _degrees(angle: float) -> str:
    """An angle in degrees; one far below them is rounding."""
    return f"{round(math.degrees(angle), 9) + 0.0:.3g}"


def _condition(found: CalibrationData, problem: Problem) -> Iterator[str]:
    """A condition at which noise is taken for parameters, and the loosest prior that mends it: with
    it the largest singular value, over the noise, is a thousand times the prior's own.
    """
    can = found.identification
    if not can.rank or can.condition <= CONDITION:
        return
    noise = []
    for s, estimate in zip(problem.sets, found.noise_std, strict=True):
        if estimate is None:
            variances = np.diagonal(s.covariance, axis1=1, axis2=2)[:, s.angular :]
            noise.append(math.sqrt(np.mean(variances)))
        else:
            noise.append(estimate.length)
    loosest = CONDITION * min(noise) / (can.singular_values[0] * found.nominal.reach)
    prior = f"{min(loosest, _LOOSE):.1g}"
    yield (
        f"some parameters are seen {can.condition:.3g} times less than others (condition): measure "
        f"where more differs, or give prior={{'rad': {prior}, 'm': {prior}}}"
    )
