"""YAML read safely: mappings of mappings of plain texts, each with its line, and nothing that a
loader would construct.

The parser's events are read one after the other, so that neither deep nesting nor aliases, which
stand for many times their own length, have anything to grow into. Tags, anchors, aliases, lists and
a second document are refused.
"""

from __future__ import annotations

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
    """The mapping that a YAML text is.

    Parameters: text; place, what to call it in messages.
    Raises: ModelError with file and line for a text that is no YAML, no mapping, has a key twice or
    no key, or uses what is refused (see the top of this module); MissingExtra without pyyaml.
    """
    try:
        import yaml
    except ImportError as missing:
        raise MissingExtra("pyyaml", "formats", "reading YAML") from missing
    open_ones: list[MappingNode] = []
    key: TextNode | None = (
        None  # of the innermost open mapping, once it is read and its value is not
    )
    root: MappingNode | None = None
    try:
        for event in yaml.parse(text, Loader=yaml.SafeLoader):
            line = event.start_mark.line + 1 if event.start_mark else 1
            where = f"{place}:{line}"
            if isinstance(event, yaml.DocumentStartEvent) and root is not None:
                raise ModelError(f"{where}: expected one document, a second one begins here")
            if isinstance(event, (yaml.AliasEvent, yaml.SequenceStartEvent)):
                what = "an alias" if isinstance(event, yaml.AliasEvent) else "a list"
                raise ModelError(f"{where}: expected names and numbers, got {what}")
            if isinstance(event, (yaml.MappingStartEvent, yaml.ScalarEvent)) and (
                event.anchor or event.tag
            ):
                raise ModelError(
                    f"{where}: tags and anchors are refused, got {quote(event.tag or event.anchor)}"
                )
            if isinstance(event, yaml.MappingEndEvent):
                open_ones.pop()
            elif isinstance(event, (yaml.MappingStartEvent, yaml.ScalarEvent)):
                value = (
                    TextNode(event.value, line)
                    if isinstance(event, yaml.ScalarEvent)
                    else MappingNode({}, {}, line)
                )
                if open_ones and key is None:
                    key = _key(value, open_ones[-1], where)
                elif open_ones and key is not None:
                    open_ones[-1].items[key.text] = value
                    open_ones[-1].key_lines[key.text] = key.line
                    key = None
                elif isinstance(value, MappingNode):
                    root = value
                else:
                    raise ModelError(
                        f'{where}: expected a mapping, as in "kinematics:", got {quote(value.text)}'
                    )
                if isinstance(value, MappingNode):
                    open_ones.append(value)
                    if len(open_ones) > DEEPEST:
                        raise ModelError(f"{where}: expected at most {DEEPEST} levels, got more")
    except ModelError:
        raise
    except (
        yaml.YAMLError,
        ValueError,
        OverflowError,
    ) as fault:  # "\U00110000": it calls chr() unchecked
        mark: Any = getattr(fault, "problem_mark", None)
        line = f":{mark.line + 1}" if mark else ""
        reason = getattr(fault, "problem", None) or str(fault)
        raise ModelError(f"{place}{line}: not YAML: {escape_unprintable(reason, 200)}") from fault
    if root is None:
        raise ModelError(f"{place}: the text is empty")
    return root


def _key(value: TextNode | MappingNode, mapping: MappingNode, where: str) -> TextNode:
    if not isinstance(value, TextNode):
        raise ModelError(f"{where}: expected the name of a key, got a mapping")
    if value.text in mapping.items:
        first = mapping.key_lines[value.text]
        raise ModelError(f"{where}: {quote(value.text)} is there twice (first: line {first})")
    return value
