"""HTML pages of the notebooks that need no network: `jupyter nbconvert --config pages.py --to html *.ipynb` makes them.

nbconvert loads MathJax from a server to draw formulas; here they become MathML, which browsers draw by themselves.
Needs docutils; where it is missing nbconvert prints that, and goes on without this file.
"""

import re

from docutils.utils.math import latex2mathml

CODE = re.compile(r"(```.*?```|`[^`\n]*`)", re.DOTALL)
FORMULA = re.compile(r"\$\$(?P<block>.+?)\$\$|(?<![\\$])\$(?P<line>[^$]+?)(?<!\\)\$", re.DOTALL)
MARKUP = str.maketrans(
    {"*": "&#42;", "_": "&#95;"}
)  # of Markdown, and no more than letters in a formula


def drawn(formula):
    """A formula found by FORMULA as MathML in one line."""
    text = latex2mathml.tex2mathml(
        formula["block"] or formula["line"], as_block=bool(formula["block"])
    )
    text = (
        re.sub(r"\s*\n\s*", " ", text)
        .replace("<mo>‖</mo>", '<mo stretchy="false">‖</mo>')
        .translate(MARKUP)
    )
    return f"<div>{text}</div>" if formula["block"] else text


def mathml(notebook, resources):
    """The notebook with the formulas of its Markdown cells as MathML."""
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            parts = CODE.split(cell.source)
            parts[::2] = [FORMULA.sub(drawn, part) for part in parts[::2]]
            cell.source = "".join(parts)
    return notebook, resources


c = get_config()  # noqa: F821  (Jupyter runs this file)
c.HTMLExporter.preprocessors = [mathml]
for name in ("mathjax_url", "jquery_url", "require_js_url"):
    setattr(c.HTMLExporter, name, "")
