"""How Sphinx makes the pages (`make docs`); nothing in it is fetched, here or by who reads them."""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from docutils.nodes import SkipNode  # noqa: E402
from docutils.utils.math import latex2mathml  # noqa: E402

import poekin  # noqa: E402
from tools import (  # noqa: E402
    docs_charts,
    docs_drawings,
    docs_equations,
    docs_floors,
    docs_names,
    docs_pages,
    docs_paper,
    docs_render,
)
from tools.docs_live import Live  # noqa: E402

project = "poekin"
author = copyright = "the poekin authors"
version = release = poekin.__version__

extensions = ["sphinx.ext.autodoc", "myst_parser"]
exclude_patterns = ["_build", "_generated/floors.md", "_generated/paper.md"]
myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
highlight_language = "none"  # of indented blocks in docstrings: equations
smartquotes = False  # f' is a derivative and ... are dots

autodoc_typehints = "none"  # the docstrings give shapes and units
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True  # methods=METHODS, not all that is in it
autodoc_docstring_signature = False  # a first line may look like a call, and is an equation
autodoc_class_signature = "mixed"
add_module_names = False
python_maximum_signature_line_length = 88
nitpicky = True

html_theme = "furo"
html_title = f"poekin {release}"
html_show_sphinx = False
html_copy_source = False
html_static_path = ["_static"]
html_extra_path = ["_generated/extra"]
html_css_files = ["page.css"]
html_math_renderer = "mathml"


def render(app, what, name, obj, options, lines):
    """A docstring of the house as reStructuredText; the paper's equation stands below its first
    sentence.
    """
    summary = lines.index("") if "" in lines else len(lines)
    links = docs_names.links(name)
    latex = docs_equations.EQUATIONS.get(name, "").splitlines()
    equation = [".. math::", "", *(f"    {line}" for line in latex), ""] if latex else []
    below = docs_render.rest(lines[summary:], links)
    lines[:] = [*docs_render.rest(lines[:summary], links), *equation, *below]


def skip(app, what, name, obj, skipped, options):
    """Fields of named tuples, whose class says what they are, are not listed again."""
    return True if type(obj).__name__ == "_tuplegetter" else skipped


def mathml(text, **kind):
    """An equation as MathML, which browsers draw by themselves; the bars of a norm no higher than
    what is in them.
    """
    return latex2mathml.tex2mathml(text, **kind).replace(
        "<mo>‖</mo>", '<mo stretchy="false">‖</mo>'
    )


def visit_math(self, node):
    """An equation in a line of text."""
    self.body.append(mathml(node.astext()))
    raise SkipNode


def visit_displaymath(self, node):
    """The same on a line of its own."""
    self.body.append(f'<div class="equation">{mathml(node.astext(), as_block=True)}</div>')
    raise SkipNode


def setup(app):
    """Write the pages' made parts, and take the hooks above into use."""
    generated = HERE / "_generated"
    generated.mkdir(exist_ok=True)
    reference = {f"reference/{name}": text for name, text in docs_names.reference().items()}
    for name, text in {
        "floors.md": docs_floors.page(),
        "paper.md": docs_paper.page(),
        **docs_charts.charts(),
        **docs_drawings.drawings(),
        **reference,
    }.items():
        file = generated / name
        file.parent.mkdir(exist_ok=True)
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            file.write_text(text, encoding="utf-8")
    docs_pages.write(generated / "extra" / "live")
    app.add_directive("live", Live)
    app.connect("autodoc-process-docstring", render)
    app.connect("autodoc-skip-member", skip)
    app.add_html_math_renderer("mathml", (visit_math, None), (visit_displaymath, None))
