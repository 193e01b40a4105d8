"""What the tests of solve share."""

from __future__ import annotations

import pytest

from poekin import svg


@pytest.fixture
def drawn_figures(monkeypatch):
    """The figures that are drawn in a test, as matplotlib has them."""
    found, draw_svg = [], svg.svg

    def kept(width, height, purpose, draw):
        def both(figure):
            draw(figure)
            found.append(figure)

        return draw_svg(width, height, purpose, both)

    monkeypatch.setattr(svg, "svg", kept)
    return found
