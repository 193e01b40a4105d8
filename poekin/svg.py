"""Pictures as SVG text; the one file of the package that imports Matplotlib."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

from .errors import MissingExtra, escape_unprintable

INK = "#222222"
PALE = "#9a9a9a"
GRID = "#dddddd"


def svg(
    width: float,
    height: float,
    purpose: str,
    draw: Callable[[Any], None],
    size: float = 9,
) -> str:
    """An SVG file of this size (inches), drawn by draw(figure): text stays text, in the reader's
    own font of `size` points.

    purpose: what it is, for the message where Matplotlib is missing. The same numbers give the same
    text.
    Raises: MissingExtra without Matplotlib (extra `report`).
    """
    looks: Any = {"svg.fonttype": "none", "svg.hashsalt": "poekin", "font.size": size}
    with _matplotlib(purpose).rc_context(looks):
        figure = new_figure(width, height, purpose)
        draw(figure)
        out = io.StringIO()
        figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
    return out.getvalue()


def new_figure(width: float, height: float, purpose: str) -> Any:
    """An empty figure of Matplotlib of this size (inches), that no window shows. Raises as `svg`."""
    _matplotlib(purpose)
    from matplotlib.figure import Figure

    return Figure((width, height), layout="constrained")


def _matplotlib(purpose: str) -> Any:
    try:
        import matplotlib
    except ModuleNotFoundError as missing:
        raise MissingExtra("matplotlib", "report", purpose) from missing
    return matplotlib


def inline(text: str) -> str:
    """SVG text without what stands before the picture itself, to be put into a page."""
    return text[text.index("<svg") :]


def label(name: object, width: int = 40) -> str:
    """A name out of a file as a label: harmless, and no formula, which a dollar sign would begin."""
    return escape_unprintable(name, width).replace("$", r"\$")


def plain(axes: Any) -> None:
    """The house's look: no frame at the top and on the right."""
    axes.spines[["top", "right"]].set_visible(False)
