"""One Chromium for all tests of a session, without a network; a page that writes an error to its
console fails the test that opened it.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from poekin.view.page import Page

# WebGL by the processor: the same on every machine. Layers put together without it take half the time.
FLAGS = (
    "--disable-gpu-compositing",
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
)
NAMES = ("chromium", "chromium-browser", "google-chrome")
READY = "new Promise((done) => window.poekin.ready.then(() => done(true)))"
DRAWN = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Open pages first: workers that share the tests out steal from the end, and a file's pages are
    opened, and the browser started, in each worker that has one of its tests.
    """
    here = f"{Path(__file__).parent}{os.sep}"
    items.sort(key=lambda item: not str(item.path).startswith(here))


@pytest.fixture(scope="session")
def chromium() -> Iterator[Any]:
    """The browser; a skip that says so where there is none."""
    driver = pytest.importorskip(
        "playwright.sync_api", reason="no playwright: no page was opened in a browser"
    )
    found = [path for name in NAMES if (path := shutil.which(name))]
    if not found:
        pytest.skip("no chromium: no page was opened in a browser")
    with driver.sync_playwright() as started:
        browser = started.chromium.launch(executable_path=found[0], args=list(FLAGS))
        yield browser
        browser.close()


class Opened:
    """A page in the browser, and what it wrote to its console as an error."""

    def __init__(self, browser: Any, address: str, framed: bool) -> None:
        self.faults: list[str] = []
        self.context = browser.new_context(offline=True, has_touch=True)
        self.tab = self.context.new_page()
        self.tab.set_default_timeout(60_000)
        self.look()
        self.tab.on("console", self._heard)
        self.tab.on("pageerror", lambda fault: self.faults.append(str(fault)))
        self.tab.on("requestfailed", self._failed)
        self.tab.goto(address)
        self.frame = self.tab.frames[-1] if framed else self.tab
        self.wait()

    def wait(self) -> None:
        """Wait until the page has opened."""
        self.frame.wait_for_function("window.poekin !== undefined")
        self.ask(READY)
        self.settle()

    def _failed(self, request: Any) -> None:
        # k3d ends its unpacking worker when that has answered: now and then the browser calls the
        # worker's script, which is in the page, a failed request. A worker without an answer shows
        # nothing, and `wait` finds it.
        if not request.url.startswith("blob:"):
            self.faults.append(request.url)

    def _heard(self, message: Any) -> None:
        # the canvas is read back without a GPU, which the driver says is slow
        if message.type in {"error", "warning"} and "due to ReadPixels" not in message.text:
            self.faults.append(message.text)

    def ask(self, script: str, given: Any = None) -> Any:
        """Value of JavaScript in the page; of a function, of what is given."""
        return self.frame.evaluate(script, given)

    def look(self, width: int = 720, height: int = 450, dark: bool = False) -> None:
        """Make the window so large, px, and light or dark."""
        self.tab.set_viewport_size({"width": width, "height": height})
        self.tab.emulate_media(color_scheme="dark" if dark else "light")

    def settle(self) -> None:
        """Wait until what was changed is drawn."""
        self.ask(DRAWN)

    def move(self, q: Any) -> None:
        """Move the arm and draw it."""
        self.ask("(q) => poekin.set(q)", [float(x) for x in q])
        self.settle()

    def boxes(self, selector: str) -> list[dict[str, float]]:
        """Rectangles of all elements that are seen."""
        script = """(selector) => [...document.querySelectorAll(selector)]
            .filter((e) => e.checkVisibility({ visibilityProperty: true }))
            .map((e) => { const { left, right, top, bottom } = e.getBoundingClientRect();
                          return { left, right, top, bottom }; })"""
        return self.ask(script, selector)

    def close(self) -> None:
        self.context.close()


@pytest.fixture(scope="module")
def open_page(chromium: Any, tmp_path_factory: Any) -> Iterator[Any]:
    """Function that opens a page for the tests of a file."""
    opened: list[Opened] = []

    def open_(made: Page, framed: bool = False, hash_: str = "") -> Opened:
        file = made.save(tmp_path_factory.mktemp("page") / "page.html")
        opened.append(Opened(chromium, file.as_uri() + hash_, framed))
        return opened[-1]

    yield open_
    faults = [fault for one in opened for fault in one.faults]
    for one in opened:
        one.close()
    assert faults == []
