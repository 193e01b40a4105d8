"""Fields: names and numbers out of XML elements, every fault with file and line."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

from ...errors import ModelError, quote
from ...model.provenance import Source
from .numbers import real
from .xml import Element


@dataclass(eq=False, slots=True)
class Fields:
    """One element of a file: its attributes, children and numbers.

    Parameters: element; source, the file; inside, the element around it where that belongs in
    messages. Children are looked for in the element's own namespace.
    Raises, from every method: ModelError that says file and line, element and attribute, what was
    expected and what arrived.
    """

    element: Element
    source: Source
    inside: Fields | None = None
    _children: dict[str, list[Element]] = field(default_factory=dict, init=False)

    @property
    def line(self) -> int:
        """The line on which the element's start tag ends."""
        return int(self.element.sourceline or 1)

    @property
    def what(self) -> str:
        """The element as messages call it, as in `joint 'elbow': <axis>`."""
        if self.inside is not None:
            return f"{self.inside.what}: <{self.tag}>"
        name = self.element.get("name")
        if not name:
            return f"<{self.tag}>"
        return f"{self.tag} {quote(name)}"

    @property
    def tag(self) -> str:
        """The element's tag without its namespace."""
        return self.element.tag.rpartition("}")[2]

    def fault(self, message: str) -> ModelError:
        """An error about this element, to be raised."""
        return ModelError(f"{self.source.place(self.line)}: {self.what}: {message}")

    def name(self, attribute: str) -> str:
        """A name that must be there and not empty."""
        value = self.element.get(attribute)
        if not value:
            found = "it is empty"
            if value is None:
                found = "there is none"
            raise self.fault(f'expected an attribute {attribute}="...", {found}')
        return value

    def all(self, tag: str) -> list[Fields]:
        """The direct children of that tag, in order."""
        return [Fields(element, self.source) for element in self._found(tag)]

    def children(self, tag: str) -> list[Fields]:
        """The direct children of that tag, which messages call after this element."""
        return [Fields(element, self.source, self) for element in self._found(tag)]

    def child(self, tag: str) -> Fields | None:
        """The only child of that tag, or None."""
        found = self.children(tag)
        if len(found) > 1:
            raise found[1].fault(f"it appears {len(found)} times, expected once")
        return next(iter(found), None)

    def _found(self, tag: str) -> list[Element]:
        if not self._children:
            for element in self.element:
                self._children.setdefault(element.tag, []).append(element)
        space, bracket, _ = self.element.tag.rpartition("}")
        return self._children.get(space + bracket + tag, [])

    def number(
        self,
        attribute: str,
        *,
        finite: bool = True,
    ) -> float | None:
        """Number, never NaN, infinite only if not `finite`; None where the attribute is missing."""
        text = self.element.get(attribute)
        if text is None:
            return None
        value = real(text)
        if value is None or math.isnan(value) or (finite and math.isinf(value)):
            expected = "a number"
            if finite:
                expected = "a finite number"
            raise self.fault(f"{attribute} must be {expected}, got {quote(text)}{_hint(text)}")
        return value

    def vector(self, attribute: str) -> tuple[float, float, float] | None:
        """Three finite numbers apart by blanks, or None where the attribute is missing."""
        values = self.numbers(attribute, 3)
        if values is None:
            return None
        x, y, z = values
        return x, y, z

    def numbers(
        self,
        attribute: str,
        count: Literal[3, 4],
    ) -> list[float] | None:
        """As many finite numbers apart by blanks, or None where the attribute is missing."""
        text = self.element.get(attribute)
        if text is None:
            return None
        values = [real(part) for part in text.split()]
        words = {3: "three", 4: "four"}[count]
        if len(values) != count:
            raise self.fault(
                f"{attribute} must be {words} numbers, got {len(values)}: {quote(text)}{_hint(text)}"
            )
        finite = [value for value in values if value is not None and math.isfinite(value)]
        if len(finite) != count:
            raise self.fault(
                f"{attribute} must be {words} finite numbers, got {quote(text)}{_hint(text)}"
            )
        return finite


def _hint(text: str) -> str:
    if "${" in text or "$(" in text:
        return " (an unprocessed xacro expression?)"
    return ""
