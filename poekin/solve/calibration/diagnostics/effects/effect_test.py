"""EffectTest: one effect that was looked for in the residuals, and its chance."""

from __future__ import annotations

from typing import NamedTuple

from .columns import EffectKind

_LEAST = 1e-300  # a chance that is smaller is not told
_WHAT: dict[EffectKind, str] = {
    "gravity": "gravity lever of {}",
    "angle": "angle of {}",
    "lag": "the move before",
    "backlash": "direction of the move before",
    "drift": "time",
    "place": "place in space",
    "set": "{} against the others",
    "reflector": "place of {} on the tool",
    "loose": "scatter of {} against the others",
}
_VERDICTS: dict[EffectKind, str] = {
    "gravity": "{} sags",
    "angle": "the error of {} repeats with its angle",
    "lag": "readings lag the motion",
    "backlash": "joints stop by the side that they come from (backlash)",
    "drift": "the base drifts",
    "place": "the device errs by the place in space (its scale, or its field)",
    "set": "{} stands elsewhere than the others",
    "reflector": "{} is not where it is said to be",
    "loose": "{} is loose",
}


class EffectTest(NamedTuple):
    """Test of the residuals against one effect.

    Parameters
    ----------
    kind : str
        "gravity" (lever of a joint's weight), "angle" (first and second harmonics of a joint), "lag"
        and "backlash" (the move before and its sign), "drift" (of the base, linear in time), "place"
        (strain of space), "set" (a set of measurements is displaced), "reflector" (a point of the
        tool is), "loose" (it moves).
    whose : str
        Joint, set or reflector; empty where it is the whole arm's.
    p : float
        Chance of so large an effect, in any of the tests, where there is nothing but noise.
    size : float
        Part of the residuals that it explains, root mean square, m; of a loose reflector, all of
        its own.
    against : bool
        Whether a joint turns against its load.
    """

    kind: EffectKind
    whose: str
    p: float
    size: float
    against: bool = False

    @property
    def what(self) -> str:
        """Name of the effect that was looked for."""
        return _WHAT[self.kind].format(self.whose)

    @property
    def verdict(self) -> str:
        """Sentence for where it is more than chance, such as "joint 2 (lift) sags"."""
        if self.against:
            return f"{self.whose} turns against its load"
        return _VERDICTS[self.kind].format(self.whose)

    @property
    def figures(self) -> str:
        """Chance and size."""
        return f"{chance(self.p)}, {1e3 * self.size:.2g} mm"

    def __str__(self) -> str:
        return f"{self.verdict} ({self.figures})"


def chance(p: float) -> str:
    """A chance in words: p = 0.003."""
    if p < _LEAST:
        return f"p < {_LEAST:g}"
    return f"p = {p:.2g}"
