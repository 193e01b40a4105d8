"""The directive `live` of docs/: a still that becomes a page in which the arm moves.

    :::{live} NAME
    Caption.
    :::

NAME is one of `tools/docs_pages.py`; with the option `:open:` the arm moves at once. A page is loaded
when it is opened, and given up when another one is: each takes a second and a canvas of the browser.
"""

from __future__ import annotations

from html import escape

from docutils.nodes import Element, Node, raw
from docutils.parsers.rst import Directive
from docutils.parsers.rst.directives import flag

from tools.docs_pages import EXAMPLES

FIGURE = """<figure class="live"><details name="live" ontoggle="{toggle}"{opened}>
<summary><img src="{place}.svg" alt="{title}" loading="lazy"><span></span></summary>
<iframe title="{title}" loading="lazy" allow="clipboard-write; fullscreen"></iframe></details><figcaption>"""
TOGGLE = (
    "const page = this.querySelector('iframe'); "
    "if (this.open) {{ page.src = '{place}.html'; }} else {{ page.removeAttribute('src'); }}"
)
END = '<a href="{place}.html">The page by itself</a></figcaption></figure>'


class Live(Directive):
    """A page of `tools/docs_pages.py` with its caption."""

    required_arguments = 1
    has_content = True
    option_spec = {"open": flag}  # noqa: RUF012  (docutils' own name)

    def run(self) -> list[Node]:
        name = self.arguments[0]
        if name not in EXAMPLES:
            raise self.error(f"live: expected one of {', '.join(EXAMPLES)}, got {name}")
        page = self.state.document.settings.env.docname
        place = "../" * page.count("/") + f"live/{name}"
        words = {
            "place": place,
            "toggle": TOGGLE.format(place=place),
            "title": escape(EXAMPLES[name].__doc__ or name),
            "opened": " open" if "open" in self.options else "",
        }
        begin = raw("", FIGURE.format(**words), format="html")
        end = raw("", END.format(**words), format="html")
        caption = Element()
        self.state.nested_parse(self.content, self.content_offset, caption)
        return [begin, *caption.children, end]
