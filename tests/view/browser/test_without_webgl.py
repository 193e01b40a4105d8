"""A page in a browser that cannot draw: it says so, and its sliders and numbers work."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from poekin.view.page import page
from tests.view import sliding_arm
from tests.view.sliding_arm import poses

pytest.importorskip("k3d", reason="no k3d: no page was opened")
# As of a browser whose WebGL is switched off, or that knows WebGL 1 alone.
TAKEN_AWAY = """const whole = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
    return kind === "webgl2" || (kind.includes("webgl") && $BOTH) ? null : whole.call(this, kind, ...more);
};"""


@pytest.fixture(params=["true", "false"], ids=["no WebGL", "WebGL 1"])
def tab(request: pytest.FixtureRequest, chromium: Any, tmp_path: Any) -> Iterator[Any]:
    """A page that was opened by a link."""
    file = page(sliding_arm.scene()).save(tmp_path / "page.html")
    context = chromium.new_context(offline=True)
    found = context.new_page()
    found.add_init_script(TAKEN_AWAY.replace("$BOTH", request.param))
    found.goto(file.as_uri() + "#q=0.1,-2,0.05&tip=1")
    found.wait_for_selector(".no-picture")
    yield found
    context.close()


def place(tab: Any) -> list[float]:
    """Position of the tip that the panel shows, m."""
    row = tab.locator("#poekin-panel tr", has_text="p (m)").first
    return [float(text.replace("−", "-")) for text in row.locator("td").all_inner_texts() if text]


def test_it_says_so_where_the_picture_would_be_and_offers_nothing_to_draw(tab):
    assert "no WebGL 2" in tab.inner_text("#canvasTarget .no-picture")
    assert not tab.is_visible(".layers")
    assert tab.locator("#poekin-toolbar").count() == 0


def test_links_sliders_tips_and_choices_move_the_numbers(tab):
    rounding = 0.5e-4  # of four places
    assert place(tab) == pytest.approx(poses([0.1, -2, 0.05])[1, :3, 3], abs=rounding)
    columns = tab.locator("#poekin-panel tr", has_text="ωx").first.locator("td")
    assert columns.count() == 1  # of the Jacobian of a tip that one joint moves
    tab.select_option("#poekin-tip", "0")
    assert columns.count() == 3
    assert place(tab) == pytest.approx(poses([0.1, -2, 0.05])[3, :3, 3], abs=rounding)
    tab.locator(".slider input[type=number]").first.fill("30")
    tab.keyboard.press("Enter")
    q = tab.evaluate("[...poekin.q]")
    assert q[0] == pytest.approx(0.5236, abs=rounding)
    assert place(tab) == pytest.approx(poses(q)[3, :3, 3], abs=rounding)
    tab.locator(".choice").first.click()
    assert tab.locator(".choice").first.get_attribute("aria-pressed") == "true"
    assert place(tab) == pytest.approx(poses(tab.evaluate("[...poekin.q]"))[3, :3, 3], abs=rounding)
    tab.evaluate("location.hash = '#q=0,0,0.1'")
    tab.wait_for_function("poekin.q[0] === 0")
    assert place(tab) == pytest.approx(poses([0, 0, 0.1])[3, :3, 3], abs=rounding)
