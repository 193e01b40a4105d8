"""The pages of docs/: their code runs, their links lead somewhere, and what they say of the source
is so.

Each page is run as README.md is (`tests/test_readme.py`): in its own namespace and directory,
outputs compared.
"""

from __future__ import annotations

import inspect
import re
import warnings
import xml.etree.ElementTree as ElementTree
from io import StringIO
from pathlib import Path

import docutils.core
import numpy as np
import pytest

import poekin as pk
from tests import test_readme as readme
from tests.test_architecture import FLOORS
from tests.test_packaging import pins
from tests.versions import SHRINKS, needs
from tools import (
    docs_charts,
    docs_drawings,
    docs_equations,
    docs_floors,
    docs_names,
    docs_pages,
    docs_render,
)

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
MADE = {"_build", "_generated"}
PAGES = sorted(
    p.relative_to(ROOT).as_posix() for p in DOCS.rglob("*.md") if not MADE & set(p.parts)
)
BESIDE = ["CHANGELOG.md", "CONTRIBUTING.md"]

# Blocks that Sphinx takes for itself, and which are no code.
DIRECTIVE = re.compile(r"^```\{(include)\}.*?^```$", re.MULTILINE | re.DOTALL)


def run_page(name: str, text: str, place: Path) -> dict[str, int]:
    """Run a page as a README is run; a failure names the page."""
    # Lines stay where they are, so that a failure names the right one.
    text = DIRECTIVE.sub(lambda found: "\n" * found[0].count("\n"), text)
    try:
        return readme.run(text, place)
    except AssertionError as error:
        raise AssertionError(str(error).replace("README.md", name)) from error


# What a page needs besides what poekin itself does; it prints what Hypothesis shrinks a
# counterexample to.
NEEDS = {
    "docs/explanation/frames.md": ("modern-robotics", "1.1"),
    "docs/howto/conform.md": ("hypothesis", SHRINKS),
    "docs/howto/convert.md": ("modern-robotics", "1.1"),
    "docs/howto/testing.md": ("hypothesis", SHRINKS),
}


@pytest.mark.parametrize("page", PAGES + BESIDE)
def test_a_page_runs_and_prints_what_it_says(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if page in NEEDS:
        needs(*NEEDS[page])
    run_page(page, (ROOT / page).read_text(encoding="utf-8"), tmp_path)


def test_there_is_code_on_the_pages():
    texts = [(ROOT / page).read_text(encoding="utf-8") for page in PAGES]
    counts = [block.language for text in texts for block in readme.blocks(text)]
    assert len(PAGES) >= 10
    assert counts.count("python") >= 40
    # Every output that stands on a page is compared: none stands alone.
    assert counts.count("text") == sum(
        b.language == "text" and b.adjoins for t in texts for b in readme.blocks(t)
    )


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("# P\n```python\nprint(1)\n```\n```text\n2\n```", "docs/p.md:6: printed"),
        (
            "```{include} x\n:y: 1\n```\n```python\nraise ValueError('so')\n```",
            "docs/p.md:5: ValueError: so",
        ),
        ("```{toctree}\nx\n```", "docs/p.md:2: a block of '{toctree}'"),
    ],
    ids=["another output", "an error", "a directive that hides code"],
)
def test_a_planted_fault_on_a_page_is_caught(text, fault, tmp_path):
    with pytest.raises(AssertionError, match=re.escape(fault)):
        run_page("docs/p.md", text, tmp_path)


def anchors(text: str) -> set[str]:
    """What links to the headings of a page: lower case, without punctuation, hyphens for spaces."""
    plain = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    headings = re.findall(r"^#+ (.*)$", plain, re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def lost_anchors(page: Path) -> list[str]:
    """Links to headings that do not exist, on this page or on another."""
    links = re.findall(r"\]\(([^)\s#:]*)#([^)\s]+)\)", page.read_text(encoding="utf-8"))
    targets = [(page if not file else page.parent / file, anchor) for file, anchor in links]
    return [
        anchor
        for file, anchor in targets
        if anchor not in anchors(file.read_text(encoding="utf-8"))
    ]


def dead(page: Path) -> list[str]:
    """Links and figures of a page that lead nowhere; what is made at the build counts as there."""
    text = page.read_text(encoding="utf-8")
    pictures = {**docs_drawings.drawings(), **docs_charts.charts()}
    made = {f"_generated/{n}" for n in pictures} | {
        "_generated/floors.md",
        "_generated/paper.md",
    }
    made |= {f"_generated/reference/{n.removesuffix('.rst')}" for n in docs_names.reference()}
    named = re.findall(r"^(?::::|```)\{(?:figure|include)\} (\S+)", text, re.MULTILINE)
    for toctree in re.findall(r"^:::\{toctree\}\n(.*?)^:::", text, re.MULTILINE | re.DOTALL):
        named += [line for line in toctree.splitlines() if line and not line.startswith(":")]
    lost = readme.missing_links(text, page.parent)
    for name in named:
        target = (page.parent / name).resolve()
        inside = target.relative_to(DOCS).as_posix() if target.is_relative_to(DOCS) else ""
        if inside not in made and not target.exists() and not target.with_suffix(".md").exists():
            lost.append(name)
    live = re.findall(r"^:::\{live\} (\S+)", text, re.MULTILINE)
    return lost + [name for name in live if name not in docs_pages.EXAMPLES]


@pytest.mark.parametrize("page", PAGES + BESIDE)
def test_a_page_links_to_what_exists(page):
    assert dead(ROOT / page) == []


def test_every_how_to_page_has_a_picture_and_the_gallery_has_every_live_page():
    texts = {page: (ROOT / page).read_text(encoding="utf-8") for page in PAGES}
    pictured = re.compile(r"^::::?\{(?:live|figure)\} ", re.MULTILINE)
    wanted = [page for page in PAGES if "/howto/" in page] + ["docs/index.md"]
    assert [page for page in wanted if not pictured.search(texts[page])] == []
    shown = re.findall(r"^:::\{live\} (\S+)$", texts["docs/howto/gallery.md"], re.MULTILINE)
    assert sorted(shown) == sorted(docs_pages.EXAMPLES)


@pytest.mark.parametrize("page", [*PAGES, *BESIDE, "README.md"])
def test_a_link_to_a_heading_finds_it(page):
    assert lost_anchors(ROOT / page) == []


def test_every_page_is_in_the_index():
    index = (DOCS / "index.md").read_text(encoding="utf-8")
    assert [
        p
        for p in PAGES
        if p.removeprefix("docs/").removesuffix(".md") not in index and p != "docs/index.md"
    ] == []
    assert [
        n
        for n in docs_names.reference()
        if f"_generated/reference/{n.removesuffix('.rst')}\n" not in index
    ] == []


def test_a_dead_link_is_caught(tmp_path):
    (tmp_path / "page.md").write_text(
        "[a](gone.md)\n:::{figure} ../gone.svg\n:::\n:::{toctree}\n:hidden:\n\npage\nlost\n:::\n"
        ":::{live} panda\n:::\n:::{live} pandas\n:::\n",
        encoding="utf-8",
    )
    assert dead(tmp_path / "page.md") == ["gone.md", "../gone.svg", "lost", "pandas"]


def test_a_link_to_a_heading_that_is_gone_is_caught(tmp_path):
    (tmp_path / "a.md").write_text(
        "# One (two): `x`\n```sh\n# no heading\n```\n[x](#one-two-x)", encoding="utf-8"
    )
    (tmp_path / "b.md").write_text(
        "[x](a.md#one-two-x) [y](a.md#no-heading) [z](#here)", encoding="utf-8"
    )
    assert lost_anchors(tmp_path / "a.md") == []
    assert lost_anchors(tmp_path / "b.md") == ["no-heading", "here"]


# The architecture page: made from the floors, and what it names exists.


def lost_names(text: str, root: Path = ROOT) -> list[str]:
    """Files and folders of this repository that a text names in backquotes and that do not exist."""
    named = re.findall(
        r"`((?:poekin|tests|tools|docs|benchmarks)/[\w./-]*|\.ci/\w+|\w+\.(?:toml|txt))`", text
    )
    return [name for name in named if not (root / name).exists()]


def test_the_floors_on_the_page_are_those_of_the_test():
    assert docs_floors.floors() == FLOORS
    page = docs_floors.page()
    assert set(re.findall(r"^\| ([\d.]+) \| `(\w+)(?:/|\.py)` \|", page, re.MULTILINE)) == {
        (f"{height:g}", name) for name, height in FLOORS.items()
    }
    for path in (ROOT / "poekin").rglob("*.py"):
        inside = path.relative_to(ROOT / "poekin")
        is_floor = len(inside.parts) == 1 or (len(inside.parts) == 2 and path.stem == "__init__")
        assert is_floor or f"| `{inside.as_posix()}` |" in page, inside


@pytest.mark.parametrize("page", [*PAGES, *BESIDE, "README.md"])
def test_a_file_that_a_page_names_exists(page):
    assert lost_names((ROOT / page).read_text(encoding="utf-8")) == []


def test_the_architecture_page_says_something_of_every_file():
    rows = re.findall(r"^\| `([\w./]+)` \| *(.*?) *\|$", docs_floors.page(), re.MULTILINE)
    assert len(rows) > 100
    assert [name for name, words in rows if len(words) < 10] == []


def test_a_floor_or_file_that_does_not_exist_is_caught(tmp_path):
    assert lost_names("`poekin/attic/` `poekin/model/chain.py` `poekin/model/chains.py` `nothing.toml`") == [
        "poekin/attic/", "poekin/model/chains.py", "nothing.toml"
    ]  # fmt: skip
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_architecture.py").write_text(
        'FLOORS = {"attic": 9}', encoding="utf-8"
    )
    with pytest.raises(FileNotFoundError, match=r"the floor attic is no part of poekin"):
        docs_floors.page(tmp_path)


# The reference: what autodoc will be given, without Sphinx.


def complaints(rest: list[str]) -> str:
    """What docutils has to say against lines of reStructuredText; roles of Sphinx are made plain
    before.
    """
    text = re.sub(r":py:obj:`([^`<]+) <[^`]+>`", r"``\1``", "\n".join(rest))
    settings = {"warning_stream": (stream := StringIO()), "report_level": 1, "halt_level": 5}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        docutils.core.publish_doctree(text, settings_overrides=settings)
    return stream.getvalue()


def docstrings() -> dict[str, str]:
    """Every docstring of the reference, by its full name."""
    things = {name: docs_names.resolved(name) for name in docs_names.documented()}
    modules = {name: docs_names.resolved(name) for name in docs_names.formula_modules()}
    inner = {
        f"{name}.{n}": x
        for name, module in modules.items()
        for n, x in vars(module).items()
        if inspect.isfunction(x) and x.__module__ == name
    }
    return {name: inspect.getdoc(x) or "" for name, x in {**things, **modules, **inner}.items()}


def test_every_docstring_of_the_reference_is_sound_markup():
    found = docstrings()
    assert len(found) > 250
    faults = {
        name: said
        for name, doc in found.items()
        if (said := complaints(docs_render.rest(doc.splitlines(), docs_names.links(name))))
    }
    assert faults == {}


def visible(text: str) -> str:
    """The words of a document, without the spaces between them."""
    return re.sub(r"\s", "", docutils.core.publish_doctree(text).astext())


def test_rendering_loses_no_character():
    for name, doc in docstrings().items():
        shown = visible("\n".join(docs_render.rest(doc.splitlines(), {})))
        said = re.sub(r"\s|`|-{3,}", "", doc)
        # Terms lose their colon, and entries of lists their dash.
        assert sorted(re.sub(r"[:-]", "", shown)) == sorted(re.sub(r"[:-]", "", said)), name


DOCSTRING = """
A_i |x| *q* of `fk` and x_ as they stand.

    f = e^{A_1 x_1} *

Some text:
- "body": one
  thing
- two `Chain.fk`

one  two words
three  four

Parameters
----------
q, dq : (..., m) array_like
    Rates, rad/s.
chain : Chain or None, optional
    The chain of the extra `fk`.
*others
    More.

Returns
-------
T : {"a_b", 1}
    In m.

Raises
------
ShapeError
    If not so.

Notes
-----
Source: none.

Examples
--------
>>> f(*x)
1_
"""
RENDERED = """
\\ A\\_i \\|x\\| \\*q\\* of \\ :py:obj:`fk <poekin.Chain.fk>`\\  and x\\_ as they stand.
::
        f = e^{A_1 x_1} *
\\ Some text:
* \\ "body": one thing
* \\ two \\ ``Chain.fk``\\
::
    one  two words
    three  four
:Parameters:
    **q**, **dq** : \\ *(..., m) array\\_like*\\
        \\ Rates, rad/s.
    **chain** : :py:obj:`Chain <poekin.Chain>` \\ *or None, optional*\\
        \\ The chain of the extra \\ ``fk``\\ .
    **\\*others**
        \\ More.
:Returns:
    **T** : \\ *{"a\\_b", 1}*\\
        \\ In m.
:Raises:
    :py:obj:`ShapeError <poekin.errors.ShapeError>`
        \\ If not so.
.. rubric:: Notes
\\ Source: none.
.. rubric:: Examples
>>> f(*x)
1_
"""


def test_a_docstring_becomes_paragraphs_equations_lists_and_definitions():
    dotted = ["poekin.Chain.fk", "poekin.Chain", "poekin.errors.ShapeError"]
    links = dict(zip(["fk", "Chain", "errors.ShapeError"], dotted, strict=True))
    rest = docs_render.rest(DOCSTRING.splitlines(), links)
    assert [line.rstrip() for line in rest if line] == RENDERED.strip("\n").splitlines()
    assert complaints(rest) == ""


def test_markup_that_is_not_escaped_is_caught():
    assert complaints(["*open emphasis"]) != ""
    assert complaints(["a |substitution| here"]) != ""
    assert complaints(["two ``words"]) != ""


def test_every_link_out_of_a_docstring_leads_to_a_documented_name():
    documented = set(docs_names.documented())
    for name in documented:
        assert set(docs_names.links(name).values()) <= documented
    assert docs_names.links("poekin.Chain.jacobian")["fk"] == "poekin.Chain.fk"
    assert docs_names.links("poekin.Chain")["from_space"] == "poekin.Chain.from_space"
    assert docs_names.links("poekin.so3.log")["exp"] == "poekin.so3.exp"
    assert docs_names.links("poekin.compare")["Chain.fk"] == "poekin.Chain.fk"


def test_every_module_of_formulas_has_its_equation():
    lacking = (
        set(docs_names.formula_modules())
        - set(docs_equations.EQUATIONS)
        - set(docs_equations.WITHOUT)
    )
    assert lacking == set()
    assert set(docs_equations.WITHOUT) & set(docs_equations.EQUATIONS) == set()
    for name in docs_equations.EQUATIONS:
        docs_names.resolved(name)  # which raises where there is no such name


@pytest.mark.parametrize("name", docs_equations.EQUATIONS)
def test_an_equation_can_be_drawn_without_a_network(name):
    from docutils.utils.math import latex2mathml

    drawn = latex2mathml.tex2mathml(docs_equations.EQUATIONS[name], as_block=True)
    drawn = drawn.replace(
        "&ApplyFunction;", "\N{FUNCTION APPLICATION}"
    )  # which HTML knows and XML does not
    assert ElementTree.fromstring(drawn).tag.endswith("math")


def test_what_make_docs_installs_is_pinned():
    pinned = pins((ROOT / "constraints.txt").read_text(encoding="utf-8"))
    assert {"sphinx", "myst-parser", "furo", "docutils"} <= set(pinned)


# The drawings.


@pytest.mark.parametrize("draw", [docs_drawings.screws, docs_drawings.arm, docs_drawings.frames])
def test_a_drawing_is_an_image_within_its_own_borders(draw):
    picture = ElementTree.fromstring(draw())
    width, height = (float(picture.attrib[k]) for k in ("width", "height"))
    points = [
        tuple(map(float, pair.split(",")))
        for element in picture.iter()
        for pair in element.attrib.get("points", "").split()
    ]
    assert len(points) > 20
    for words in (e for e in picture.iter() if e.tag.endswith("text")):
        # A letter is at most 0.6 of the size wide, rises 0.8 of it over its line and hangs 0.3
        # below.
        x, y, size = (
            float(words.attrib["x"]),
            float(words.attrib["y"]),
            float(picture.attrib["font-size"]),
        )
        wide = 0.6 * size * len(words.text or "")
        left = x - wide * {"start": 0, "middle": 0.5, "end": 1}[words.attrib["text-anchor"]]
        points += [(left, y - 0.8 * size), (left + wide, y + 0.3 * size)]
    assert all(0 <= x <= width and 0 <= y <= height for x, y in points)


def test_the_view_of_the_drawings_is_a_rotation_that_keeps_vertical_lines_vertical():
    assert np.allclose(docs_drawings.VIEW @ docs_drawings.VIEW.T, np.eye(3), rtol=0, atol=1e-15)
    drawing = docs_drawings.Drawing(10, 10, (0, 0), 1, "")
    (x0, y0), (x1, y1) = drawing.flat([[1, 2, 0], [1, 2, 1]])
    assert abs(x0 - x1) < 1e-15
    assert y1 < y0  # up in space is up on the page, where y runs down
    assert np.allclose(
        pk.so3.exp(pk.so3.log(docs_drawings.VIEW)), docs_drawings.VIEW, rtol=0, atol=1e-15
    )


# The live pages.


@pytest.mark.parametrize("name", ["ur5e", "compare"])
def test_a_live_page_is_small_and_has_a_still(name, tmp_path):
    docs_pages.write(tmp_path, [name])
    assert "poekin-scene" in (tmp_path / f"{name}.html").read_text(encoding="utf-8")
    assert (tmp_path / f"{name}.html").stat().st_size < 2_000_000
    still = (tmp_path / f"{name}.svg").read_text(encoding="utf-8")
    assert ElementTree.fromstring(still).tag.endswith("svg")
    assert still == docs_pages.svg_of(docs_pages.EXAMPLES[name]()[1], **docs_pages.TIGHT)


def test_a_chart_shows_where_the_hasty_formula_is_wrong():
    angle = np.array([1e-12, 0.99e-5, 1e-5, 1.0])
    error = docs_charts.hasty_error(angle, np.ones(4))
    # V v − v is |ω| |v| / 2 to first order, and rotated
    assert error[:2] == pytest.approx(angle[:2] / 2, rel=1e-3)
    assert (error[2:] == 0).all()
    for chart in docs_charts.charts().values():
        assert ElementTree.fromstring(chart).tag.endswith("svg")
