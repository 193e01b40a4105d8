"""What a report is made of: topics with figures, tables and pictures, as plain data."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace


@dataclass(frozen=True)
class Figure:
    """One measured figure and the bar that it ought to hold.

    what: what was measured, in words; value: the figure, None where it could not be measured (note
    says why);
    bar: the largest value that holds, None where the figure is only information; unit: "" for a
    plain number;
    spread: (lower, upper) quartile of repeated measurements; error: the numerical error of the same
    run, as text; shown: the value as text where a number is not how to say it; holds: by default
    value ≤ bar.
    """

    what: str
    value: float | None
    bar: float | None = None
    unit: str = ""
    spread: tuple[float, float] | None = None
    error: str = ""
    note: str = ""
    shown: str = ""
    bar_shown: str = ""
    holds: bool | None = None

    @property
    def verdict(self) -> bool | None:
        """Whether the bar holds; None for a figure without one."""
        if self.holds is not None:
            return self.holds
        if self.bar is None:
            return None
        return self.value is not None and math.isfinite(self.value) and self.value <= self.bar

    @property
    def text(self) -> str:
        """The figure as people read it."""
        return self.shown or (
            "not measured" if self.value is None else f"{short(self.value)} {self.unit}".strip()
        )

    @property
    def bar_text(self) -> str:
        """The bar as people read it, or nothing."""
        return self.bar_shown or (
            "" if self.bar is None else f"≤ {short(self.bar)} {self.unit}".strip()
        )


def side_by_side(
    what: str, found: Sequence[int], bars: Sequence[int], *, error: str = "", note: str = ""
) -> Figure:
    """A figure of several numbers, each with a bar of its own: its value is the largest share of a
    bar that is used.
    """
    value = max(number / bar for number, bar in zip(found, bars, strict=True))
    shown, bar_shown = ("/".join(map(str, numbers)) for numbers in (found, bars))
    return Figure(what, value, 1, shown=shown, bar_shown=f"≤ {bar_shown}", error=error, note=note)


@dataclass(frozen=True)
class Table:
    """A table: its caption, its column heads (with units), and rows of texts or numbers; folded
    until asked for.
    """

    caption: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str | int | float]]
    folded: bool = False


@dataclass(frozen=True)
class Picture:
    """A drawing: an SVG element as text, and the caption that says what is to be seen.

    answers: the question at the top of the page that it answers, of `cases.QUESTIONS`; or none.
    """

    caption: str
    svg: str
    answers: str = ""

    def answering(self, question: str) -> Picture:
        """The picture for the top of the page."""
        return replace(self, answers=question)


@dataclass
class Topic:
    """One part of the report. Failure is the traceback of a topic that broke off, else empty.

    Who runs it says the rest: name, section, the seconds that it took, and whether it was a quick
    look, of fewer samples.
    """

    title: str
    text: str = ""
    figures: list[Figure] = field(default_factory=list)
    tables: list[Table] = field(default_factory=list)
    pictures: list[Picture] = field(default_factory=list)
    failure: str = ""
    name: str = ""
    section: str = ""
    seconds: float = 0.0
    quick: bool = False


def short(value: float) -> str:
    """A figure for reading: three significant digits, in the way that is shortest to read."""
    if isinstance(value, int) or (
        value == int(value) and abs(value) < 1e6 if math.isfinite(value) else False
    ):
        return f"{int(value)}"
    return f"{value:.3g}"
