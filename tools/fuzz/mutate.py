"""Mutations of documents: each takes bytes and gives bytes, and knows of formats only what they
look like.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from .draw import NUMBERS, TEXTS, Draw

LARGEST = 128 * 2**10
"""Bytes of an input; what takes long does so at this length already."""

_NUMBER = re.compile(rb"[-+]?\d[\d.]*(?:e[-+]?\d+)?")
_QUOTED = re.compile(rb"\"[^\"<]*\"|'[^'<]*'")
_NAME = re.compile(rb"[A-Za-z_]\w*")
_VALUE = re.compile(rb"(?<=[=:] )[^\n<>]+")
_TAG = re.compile(rb"<[^<>]{1,200}>|\[\[?\w+\]?\]|\n")

Mutation = Callable[[Draw, bytes], bytes]


def flip(d: Draw, data: bytes) -> bytes:
    changed = bytearray(data)
    for _ in range(1 + d.below(4)):
        changed[d.below(len(changed))] = 1 << d.below(8) if d.chance(0.5) else d.below(256)
    return bytes(changed)


def _piece(d: Draw, data: bytes) -> tuple[int, int]:
    start = d.below(len(data))
    return start, min(len(data), start + 1 + d.below(d.pick((2, 8, 60, 1000))))


def delete(d: Draw, data: bytes) -> bytes:
    start, stop = _piece(d, data)
    return data[:start] + data[stop:]


def repeat(d: Draw, data: bytes) -> bytes:
    start, stop = _piece(d, data)
    times = d.pick((1, 1, 2, 5, 50, 2000)) if d.chance(0.3) else 1
    return data[:stop] + data[start:stop] * times + data[stop:]


def swap(d: Draw, data: bytes) -> bytes:
    (a, b), (c, e) = sorted((_piece(d, data), _piece(d, data)))
    return data if b > c else data[:a] + data[c:e] + data[b:c] + data[a:b] + data[e:]


def truncate(d: Draw, data: bytes) -> bytes:
    return data[: d.below(len(data))] if d.chance(0.7) else data[d.below(len(data)) :]


def insert(d: Draw, data: bytes) -> bytes:
    at = d.below(len(data) + 1)
    new = encoded(d.pick(TEXTS)) if d.chance(0.7) else d.source.randbytes(1 + d.below(8))
    return data[:at] + new + data[at:]


def _one(pattern: re.Pattern[bytes], d: Draw, data: bytes) -> re.Match[bytes] | None:
    """A match behind a random place: nearly as good as any one of all, and as quick in a long text."""
    return pattern.search(data, d.below(len(data))) or pattern.search(data)


def number(d: Draw, data: bytes) -> bytes:
    match = _one(_NUMBER, d, data)
    return (
        data
        if match is None
        else data[: match.start()] + encoded(d.pick(NUMBERS)) + data[match.end() :]
    )


def quoted(d: Draw, data: bytes) -> bytes:
    match = _one(_QUOTED, d, data)
    if match is None:
        return data
    return data[: match.start() + 1] + encoded(d.pick(TEXTS)) + data[match.end() - 1 :]


OTHERS = (
    "1", "-1", "0.5", "true", '"x"', "x", "''", "[]", "{}", "[[]]", "[1]", '["a"]', "[[1, 2], [3, 4]]", "[1, [2]]",
    "{a = 1}", "{a: 1}", "1979-05-27T07:32:00Z", "07:32:00", "nan", "-inf", "~", "\n    a: 1", "",
)  # fmt: skip


def value(d: Draw, data: bytes) -> bytes:
    """What stands behind `=` or `:` on a line, for something of another kind."""
    match = _one(_VALUE, d, data)
    return (
        data
        if match is None
        else data[: match.start()] + encoded(d.pick(OTHERS)) + data[match.end() :]
    )


def rename(d: Draw, data: bytes) -> bytes:
    """A name for another one of the text, in one place or in all of them."""
    match, other = _one(_NAME, d, data), _one(_NAME, d, data)
    if match is None or other is None:
        return data
    if d.chance(0.2):
        return data.replace(match.group(), other.group())
    return data[: match.start()] + other.group() + data[match.end() :]


def element(d: Draw, data: bytes) -> bytes:
    """Twice, gone, or somewhere else: a tag, a TOML table's head, the end of a line."""
    match = _one(_TAG, d, data)
    if match is None:
        return data
    rest = data[: match.start()] + data[match.end() :]
    other = _one(_TAG, d, data)
    at = other.start() if other and d.chance(0.8) else d.below(len(rest) + 1)
    return (
        rest
        if d.chance(0.3)
        else (data if d.chance(0.5) else rest)[:at] + match.group() + data[at:]
    )


def line(d: Draw, data: bytes) -> bytes:
    lines = data.split(b"\n")
    i, k = d.below(len(lines)), d.below(len(lines))
    lines[i], lines[k] = lines[k], lines[i] if d.chance(0.5) else lines[k]
    if d.chance(0.3):
        del lines[d.below(len(lines))]
    return b"\n".join(lines)


def nest(d: Draw, data: bytes) -> bytes:
    match, depth = _one(_TAG, d, data), d.pick((3, 100, 240, 260, 3000))
    opened, closed = d.pick(
        ((b"<a>", b"</a>"), (b"<link>", b"</link>"), (b"[", b"]"), (b"{a: ", b"}"), (b"- ", b""))
    )
    at = match.end() if match else 0
    return (
        data[:at] + opened * depth + closed * (depth if d.chance(0.8) else depth // 2) + data[at:]
    )


def encode(d: Draw, data: bytes) -> bytes:
    text = data.decode("utf-8", "replace")
    kind = d.pick(
        ("utf-16", "utf-16-le", "utf-16-be", "utf-32", "latin-1", "utf-8-sig", "utf-7", "cp037")
    )
    declared = (
        f'<?xml version="1.0" encoding="{kind}"?>' if d.chance(0.3) and text.startswith("<") else ""
    )
    return (declared + text).encode(kind, "replace")


def declare(d: Draw, data: bytes) -> bytes:
    """A document type with entities before it, and at times one of them within."""
    dtd = d.pick(
        (b'<!DOCTYPE r [<!ENTITY x "y">]>', b'<!DOCTYPE r SYSTEM "/dev/zero">', b"<!DOCTYPE r>", b"<!DOCTYPE",
         b'<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]>', b'<!DOCTYPE r [<!ENTITY % p "y"> %p;]>',
         b'<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY x "&a;&a;&a;&a;&a;&a;&a;&a;">]>', b"%YAML 1.1\n---\n")
    )  # fmt: skip
    if d.chance(0.5):
        data = quoted(Draw(d.source), data).replace(b'="', b'="&x;', 1)
    return dtd + data


MUTATIONS: tuple[Mutation, ...] = (
    flip, delete, repeat, swap, truncate, insert, number, number, number, quoted, quoted, value, value, rename,
    rename, element, element, line, nest, encode, declare,
)  # fmt: skip
# What leaves little of a document to be read is done last, and rarely.
_ROUGH = (truncate, nest, encode, declare, flip)


def encoded(text: str) -> bytes:
    """UTF-8, in which lone surrogates become bytes that are none."""
    return text.encode("utf-8", "surrogatepass")


def mutated(d: Draw, data: bytes, others: Sequence[bytes]) -> bytes:
    """The document after one to six mutations, now and then spliced with another one."""
    if others and d.chance(0.05):
        other = d.pick(others)
        data = data[: d.below(len(data) + 1)] + other[d.below(len(other) + 1) :]
    for _ in range(1 + d.below(d.pick((1, 1, 3, 6)))):
        if not data:
            break
        mutation = d.pick(MUTATIONS)
        if mutation not in _ROUGH or d.chance(0.5):
            data = mutation(d, data)[:LARGEST]
    return data
