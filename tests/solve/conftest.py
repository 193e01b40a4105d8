"""What the tests of solve share."""

from __future__ import annotations

import pytest

from poekin.solve import figures


@pytest.fixture
def drawn_figures(monkeypatch):
    """The figures that are drawn in a test, as matplotlib has them."""
    found, svg = [], figures.svg

    def kept(width, height, purpose, draw):
        def both(figure):
            draw(figure)
            found.append(figure)

        return svg(width, height, purpose, both)

    monkeypatch.setattr(figures, "svg", kept)
    return found
