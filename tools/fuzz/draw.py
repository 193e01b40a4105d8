"""Draw: plain values of the kinds that files hold, and now and then one that readers stumble over."""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import TypeVar

Any = TypeVar("Any")

NUMBERS = (
    "nan", "-nan", "NaN(1)", "inf", "-inf", "infinity", "1e999", "-1e999", "1e400", "1e308", "-1.7976931348623157e308",
    "1e155", "1e101", "1e100", "1e99", "1e16", "1e5", "1e-17", "1e-320", "5e-324", "1e-400", "-0", "-0.0", "+0", "0",
    "1", "-1", "2", "", " ", "+", "-", ".", "1.", ".5", "1e", "1e+", "1.5.2", "1e1e1", "0x10", "0x1p3", "0b1", "0o7",
    "1_000", "1,5", "1 2", "1;", "1d5", "#1", "--1", "½", "∞", "٣", "१", "١٢", "１２", "²", "true", "None", "[1]",
    "{1}", "${x}", "$(arg x)", "2147483648", "4294967296", "9223372036854775808", "18446744073709551616", "1000000000",
    "9" * 400, "9" * 5000, "0" * 400 + "1", "0x" + "f" * 300, "0x" + "f" * 5000,
    "0." + "0" * 400 + "1", "1e" + "9" * 30, "1.0000001", "1.000000000001",
    "3.141592653589793", "1.5707963267948966", "6.283185307179586", "\t1\n", "\u00a01", "1\u2028", "1\0",
)  # fmt: skip
TEXTS = (
    "", " ", "\t", "\n", "a\nb", "\0", "\x01", "\x1b[31m", "\x7f", "\x85", "\u2028", "\u202e", "\ufeff", "\ufffe",
    "\ud800", "\udfff", "e\u0301", "é", "ß", "🤖" * 30, "&lt;", "&amp;", "&#0;", "&#x1b;", "&#xD800;", "&#x10FFFF;",
    "&x;", "<", ">", "]]>", "-->", "<!--", "<?", '"', "'", "'''", '"""', "\\", "\\x", "\\u0000", "\\U00110000", "%s",
    "%", "{", "{0}", "${x}", "$(find x)", "=1+1", "@", "../../x", "/dev/zero", "/", ".", "nan", "1", "0", "True",
    "null", "~", "world", "base_link", "__class__", "__proto__", "[b]", "[/b]", "a,b", "a;b", "# a", ": ", "- ", "!x",
    "&a", "*a", "|", "x" * 79, "x" * 80, "x" * 81, "x" * 300, "x" * 4000, "x" * 30_000, "ab" * 15_000, "ä" * 3000,
)  # fmt: skip
PLAIN = (
    "0",
    "0.0",
    "1",
    "-1",
    "0.5",
    "-0.25",
    "0.333",
    "0.1625",
    "1.5708",
    "-1.5708",
    "3.14159",
    "2.8973",
    "1e-3",
)


class Draw:
    """Draws from a generator; `odd` is the probability that a value is one that readers stumble
    over.
    """

    def __init__(self, source: random.Random, odd: float = 0.0):
        self.source, self.odd = source, odd

    def chance(self, probability: float) -> bool:
        return self.source.random() < probability

    def below(self, count: int) -> int:
        """0 ... count - 1, and 0 where count is none."""
        return int(self.source.random() * count)

    def pick(self, values: Sequence[Any]) -> Any:
        return values[int(self.source.random() * len(values))]

    def odd_number(self) -> str:
        """One of `NUMBERS`."""
        return self.pick(NUMBERS)

    def number(self) -> str:
        if self.chance(self.odd):
            return self.odd_number()
        return self.pick(PLAIN) if self.chance(0.7) else repr(self.source.uniform(-3, 3))

    def numbers(self, count: int, between: str = " ") -> str:
        """So many numbers in one text; at times one more or less."""
        if self.chance(self.odd):
            count = max(0, count + self.pick((-1, 1, -count, 40)))
        return between.join([self.number() for _ in range(count)])

    def axis(self) -> str:
        """A direction, most of them of unit length."""
        if self.chance(self.odd):
            return self.pick(
                (
                    "0 0 0",
                    "-0 0 0.0",
                    "1e-200 0 1e-200",
                    "1.7e308 0 -1.7e308",
                    "5e-324 0 0",
                    "2 0 0",
                )
            )
        return (
            self.pick(("0 0 1", "0 1 0", "1 0 0", "0 0 -1", "0 0.6 0.8"))
            if self.chance(0.8)
            else self.numbers(3)
        )

    def text(self, plain: str) -> str:
        return self.pick(TEXTS) if self.chance(self.odd) else plain

    def word(self, *plain: str) -> str:
        """One of these, or, as odd as the rest, any text."""
        return self.text(self.pick(plain))

    def maybe(self, text: str, probability: float = 0.5) -> str:
        return text if self.chance(probability) else ""

    def size(self, usual: int = 6) -> int:
        """How many of something: a few; none or hundreds where it is odd, and then little else is,
        or none is read.
        """
        if self.chance(self.odd / 4):
            size = self.pick((0, 1, 40, 300, 900))
            self.odd /= max(1, size)
            return size
        return 1 + self.below(usual)

    def shuffled(self, values: list[Any]) -> list[Any]:
        if self.chance(0.3):
            self.source.shuffle(values)
        return values
