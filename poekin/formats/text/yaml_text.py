"""YAML read safely: mappings of mappings of plain texts, each with its line, or one text of them.

The parser's events are read one after the other, so that neither deep nesting nor aliases, which
stand for many times their own length, have anything to grow into. In a mapping that is wanted
whole, tags, anchors, aliases, lists and a second document are refused.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any, NamedTuple

from ...errors import MissingExtra, ModelError, escape_unprintable, quote

DEEPEST = 8


class TextNode(NamedTuple):
    """A scalar as it is written, and its line."""

    text: str
    line: int


class MappingNode(NamedTuple):
    """Keys and what they stand for, in order, and the line on which the mapping begins."""

    items: dict[str, MappingNode | TextNode]
    key_lines: dict[str, int]
    line: int


def parse(text: str, place: str) -> MappingNode:
    """Mapping that a YAML text is.

    Parameters: text; place, what to call it in messages.
    Raises: ModelError with file and line for a text that is no YAML, no mapping, has a key twice or
    no key, or uses what is refused (see the top of this module); MissingExtra without pyyaml.
    """
    yaml = _package()
    builder = _Builder(place, yaml)
    for event in _events(text, place, yaml):
        builder.take(event)
    if builder.root is None:
        raise ModelError(f"{place}: the text is empty")
    return builder.root


def find(text: str, place: str, names: tuple[str, ...]) -> TextNode | None:
    """First text that stands for a key of one of the names, at any depth, or is the document.

    What comes behind it is not read; lists, tags and aliases are passed over. None where there is
    no such text. Parameters: text; place, what to call it in messages; names.
    Raises: ModelError with file and line for a text that is no YAML or too deep; MissingExtra
    without pyyaml.
    """
    yaml = _package()
    opens = (yaml.MappingStartEvent, yaml.SequenceStartEvent)
    closes = (yaml.MappingEndEvent, yaml.SequenceEndEvent)
    around: list[_Level] = []
    for event in _events(text, place, yaml):
        if isinstance(event, closes):
            around.pop()
        if not isinstance(event, (*opens, yaml.ScalarEvent, yaml.AliasEvent)):
            continue
        line = event.start_mark.line + 1
        value = getattr(event, "value", "")
        wanted = around and around[-1].key in names
        document = not around and value  # behind a last --- there is an empty one
        if (wanted or document) and isinstance(event, yaml.ScalarEvent):
            return TextNode(value, line)
        if around and around[-1].in_mapping:
            around[-1].take(value)
        if isinstance(event, opens):
            around.append(_Level(isinstance(event, yaml.MappingStartEvent)))
        if len(around) > DEEPEST:
            raise ModelError(f"{place}:{line}: expected at most {DEEPEST} levels, got more")
    return None


@dataclass(eq=False)
class _Level:
    """An open mapping or list, and the key of a mapping whose value comes next."""

    in_mapping: bool
    key: str | None = None

    def take(self, value: str) -> None:
        """Take a key, or the value of the key that was taken."""
        if self.key is None:
            self.key = value
        else:
            self.key = None


def _package() -> ModuleType:
    try:
        import yaml
    except ImportError as missing:
        raise MissingExtra("pyyaml", "formats", "reading YAML") from missing
    return yaml


def _events(text: str, place: str, yaml: ModuleType) -> Iterator[Any]:
    """Events of the parser. Raises: ModelError with file and line for a text that is no YAML."""
    events = yaml.parse(text, Loader=yaml.SafeLoader)
    while True:
        try:
            event = next(events, None)
        # "\U00110000": the parser calls chr() unchecked.
        except (yaml.YAMLError, ValueError, OverflowError) as fault:
            mark: Any = getattr(fault, "problem_mark", None)
            where = place
            if mark:
                where = f"{place}:{mark.line + 1}"
            reason = getattr(fault, "problem", None) or str(fault)
            raise ModelError(f"{where}: not YAML: {escape_unprintable(reason, 200)}") from fault
        if event is None:
            return
        yield event


@dataclass(eq=False)
class _Builder:
    """Mappings built out of the parser's events, one after the other."""

    place: str
    yaml: ModuleType
    root: MappingNode | None = None
    open: list[MappingNode] = field(default_factory=list)
    key: TextNode | None = None  # of the innermost open mapping, until its value is read

    def take(self, event: Any) -> None:
        """Build what an event adds, or refuse it."""
        yaml = self.yaml
        line = 1
        if event.start_mark:
            line = event.start_mark.line + 1
        where = f"{self.place}:{line}"
        if isinstance(event, yaml.DocumentStartEvent) and self.root is not None:
            raise ModelError(f"{where}: expected one document, a second one begins here")
        for kind, got in ((yaml.AliasEvent, "an alias"), (yaml.SequenceStartEvent, "a list")):
            if isinstance(event, kind):
                raise ModelError(f"{where}: expected names and numbers, got {got}")
        if isinstance(event, yaml.MappingEndEvent):
            self.open.pop()
        if not isinstance(event, (yaml.MappingStartEvent, yaml.ScalarEvent)):
            return
        if event.anchor or event.tag:
            raise ModelError(
                f"{where}: tags and anchors are refused, got {quote(event.tag or event.anchor)}"
            )
        if isinstance(event, yaml.ScalarEvent):
            self._add(TextNode(event.value, line), where)
        else:
            mapping = MappingNode({}, {}, line)
            self._add(mapping, where)
            self.open.append(mapping)
            if len(self.open) > DEEPEST:
                raise ModelError(f"{where}: expected at most {DEEPEST} levels, got more")

    def _add(self, value: TextNode | MappingNode, where: str) -> None:
        """Take a value as the root, as the next key, or as what that key stands for."""
        if not self.open:
            if isinstance(value, TextNode):
                raise ModelError(
                    f'{where}: expected a mapping, as in "kinematics:", got {quote(value.text)}'
                )
            self.root = value
        elif self.key is None:
            self.key = _key(value, self.open[-1], where)
        else:
            mapping = self.open[-1]
            mapping.items[self.key.text] = value
            mapping.key_lines[self.key.text] = self.key.line
            self.key = None


def _key(value: TextNode | MappingNode, mapping: MappingNode, where: str) -> TextNode:
    if not isinstance(value, TextNode):
        raise ModelError(f"{where}: expected the name of a key, got a mapping")
    if value.text in mapping.items:
        first = mapping.key_lines[value.text]
        raise ModelError(f"{where}: {quote(value.text)} appears twice (first: line {first})")
    return value
