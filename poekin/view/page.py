"""A page: one HTML file that shows a scene offline, and moves its arms by their own programs."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from html import escape
from pathlib import Path

from ..errors import InputError, escape_unprintable
from ..formats.text.atomic_write import FilePath, write_whole
from .k3d_objects import grouped, snapshot
from .scene import Scene
from .scene_json import scene_json

SCRIPTS = (
    "mathematics",
    "panel/elements",
    "labels",
    "drawing",
    "panel/sliders",
    "panel/numbers",
    "panel/panel",
    "drag",
    "panel/play",
    "main",
)
"""Files of the page's own JavaScript, in the order in which the page holds them."""

_HEAD = """<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline' \
'unsafe-eval' blob:; style-src 'unsafe-inline'; img-src data: blob:; font-src data:; \
connect-src data: blob:; worker-src blob:">
<link rel="icon" href="data:,">
<title>$TITLE</title>
<script>window.poekinPlot = new Promise((plotted) => { window.poekinPlotted = plotted; });</script>
"""
# k3d's fonts of formulas are in the page; it names files of them beside the page too.
_NO_FILES = """<script>if (typeof k3dSource === "string") {
    k3dSource = k3dSource.replace(/,url\\(fonts\\/[^)]*\\) format\\("[a-z]+"\\)/g, "");
}</script>
"""
_DRAWN = "window.poekinPlotted(K3DInstance);"
_FRAME = (
    '<iframe title="$TITLE" srcdoc="$PAGE" sandbox="allow-scripts" '
    'allow="clipboard-write; fullscreen" style="width:100%;height:640px;border:0"></iframe>'
)


@dataclass(frozen=True, slots=True, eq=False)
class Page:
    """One self-contained HTML page in which an arm moves.

    The page fetches nothing: it holds its own renderer, kinematics and numbers, and can be mailed.
    As the last line of a notebook cell it shows itself.

    Attributes
    ----------
    title : str
        Title of the page.
    html : str
        The whole page. The same scene gives the same text.

    Examples
    --------
    >>> import poekin as pk
    >>> page = pk.view(pk.load("ur5e"))
    >>> page.title, len(page.html) < 2_000_000
    ('ur5e', True)
    """

    title: str
    html: str

    def save(self, path: FilePath) -> Path:
        """Write the page to a file, which appears whole or not at all.

        Parameters
        ----------
        path : path
            File to write; an old one is replaced.

        Returns
        -------
        path : Path
            The file.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        write_whole(path, self.html.encode())
        return Path(path)

    def __repr__(self) -> str:
        return f"<Page {escape_unprintable(self.title, 60)!r}, {len(self.html) / 1e6:.1f} MB>"

    def _repr_html_(self) -> str:
        title = escape(escape_unprintable(self.title, 200))
        return _FRAME.replace("$TITLE", title).replace("$PAGE", escape(self.html))


def page(scene: Scene) -> Page:
    """The page of a scene.

    Parameters
    ----------
    scene : Scene
        What the page shows.

    Returns
    -------
    page : Page
        The same scene gives the same bytes.

    Raises
    ------
    MissingExtra
        If k3d is not installed.
    """
    objects = grouped(scene.nodes)
    text = snapshot(objects, _DRAWN)
    title = escape(escape_unprintable(scene.title, 200))
    head, _, rest = text.partition("<title>")
    _, _, rest = rest.partition("</title>")  # k3d's has the time of day
    style, end, body = rest.rpartition("</head>")
    body, bottom, after = body.rpartition("</body>")
    if not bottom or not end:
        raise InputError("k3d's page has no title, head or body: this k3d is not one that is known")
    parts = [
        head,
        _HEAD.replace("$TITLE", title),
        style,
        f"<style>\n{_web('page.css')}</style>\n",
        _NO_FILES,
        end,
        body,
        f'<script type="application/json" id="poekin-scene">{scene_json(scene, objects)}</script>\n',
        *_modules(scene),
        bottom,
        after,
    ]
    return Page(scene.title, "".join(parts))


def _modules(scene: Scene) -> Iterator[str]:
    """Elements <script> of the kinematics of each arm, and of the page itself."""
    yield "<script>window.poekinKinematics = [];</script>\n"
    for k, arm in enumerate(scene.arms):
        yield _module(f"{arm.program}\nwindow.poekinKinematics[{k}] = {{ links, tips }};\n")
    yield _module(page_script())


def page_script() -> str:
    """The page's own JavaScript as one module: the files without what joins them."""
    whole = "\n".join(_web(f"{name}.js") for name in SCRIPTS)
    whole = re.sub(r"^import .*\n", "", whole, flags=re.MULTILINE)
    return re.sub(r"^export ", "", whole, flags=re.MULTILINE)


def _module(text: str) -> str:
    """An element <script>; nothing in the text, such as a name in a comment, can end it."""
    safe = text.replace("</", "<\\/").replace("<!--", "<\\!--")
    return f'<script type="module">\n{safe}</script>\n'


def _web(name: str) -> str:
    """A file of the folder `web`."""
    return (Path(__file__).with_name("web") / name).read_text(encoding="utf-8")
