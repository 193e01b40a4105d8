"""A chain walked from line to line, and the same walk with its turns and lengths made exact.

The lines are the base frame's z axis, the axes of the joints, and the tool frame's z axis. From one
to the next lie two turns and two lengths, in 50 digits:

    Rz(theta) Tz(d) Tx(a) Rx(alpha)    along the common normal (modified Denavit-Hartenberg)
    the smallest turn, and (t_x, t_y)  from line to line where they are parallel, or within 0.1 of
                                       it: no common normal is looked for, so nothing blows up; x is
                                       carried along from the line before
"""

from __future__ import annotations

import math
from decimal import Decimal
from typing import NamedTuple

import numpy as np

from ...algebra import add, cross, dot, scale, subtract
from ...errors import quote
from ...groups.arrays import Array
from ...groups.vectors import translation_part
from ..chain_data import ChainData
from .normals import (
    BASE,
    ZERO,
    Frame,
    Vector,
    across,
    axis_near,
    common_normal,
    exact,
    frame_on_line,
    length,
    nearest_on_line,
    unit,
)

SLANT = Decimal("0.1")
"""The sine of the angle below which two lines are walked without their common normal."""

ROUNDING = 1e-14
"""Changes up to this [rad], or this many times the reach [m], are the input's own rounding, and not
worth a word.
"""


class Turn(NamedTuple):
    """An angle by its cosine and sine."""

    cosine: Decimal
    sine: Decimal


class Walk:
    """Frames from line to line in a chain as it is and in the exact one.

    Attributes: given, exact, frames with their z axes on the lines, the base frame first and the
    tool frame last; snapped, whether the two differ; changes, in words.
    """

    def __init__(self, chain: ChainData, tol: float) -> None:
        self.chain = chain
        self.tol = tol
        self.noise = ROUNDING * chain.reach
        self.changes: list[str] = []
        self.snapped = False
        # A name may hold braces, which are no places for numbers.
        joints = [
            f"axis of {quote(name)}".replace("{", "{{").replace("}", "}}")
            for name in chain.joint_names
        ]
        self.names = ["the base's z axis", *joints, "the tool's z axis"]
        self.given = [BASE]
        self.exact = [BASE]
        for S, kind in zip(chain.screws, chain.kinds, strict=True):
            last = self.given[-1].o
            self._step(*axis_near(S, kind == "prismatic", last))
        x = exact(chain.home[:3, 0])
        z = unit(exact(chain.home[:3, 2]))
        p = exact(translation_part(chain.home))
        foot = nearest_on_line(p, z, self.given[-1].o)
        self._step(z, foot)
        self._end(frame_on_line(unit(across(x, z)), z, p))

    def _step(self, z: Vector, p: Vector) -> None:
        """To the next line, of direction z through p, its point nearest to the last frame's origin."""
        slant = length(cross(self.given[-1].z, z))
        step = self._aside if slant < SLANT else self._across
        given, exact = step(z, p)
        self.given.append(given)
        self.exact.append(exact)

    def _across(self, z: Vector, p: Vector) -> tuple[Frame, Frame]:
        """By the common normal."""
        last = self.given[-1]
        new = self.exact[-1]
        before, name = self._lines()
        normal = common_normal(last.o, last.z, p, z)
        x = normal.x
        c, s, _ = last.of(x)
        theta = self._angle(
            c,
            s,
            f"{name} turned by {{0:.3g}} rad about {before}, to {{1}}° from the normal before it",
        )
        d = self._length(
            dot(subtract(normal.foot, last.o), last.z),
            f"{name} moved by {{0:.3g}} m along {before}, to where the normal before it is",
        )
        a = self._length(normal.a, f"{name} moved by {{0:.3g}} m to meet {before}")
        alpha = self._angle(
            normal.cosine,
            normal.sine,
            f"{name} turned by {{0:.3g}} rad to be {{2}} to {before}",
        )
        turned = new.out((theta.cosine, theta.sine, ZERO))
        up = add(
            scale(alpha.cosine, new.z),
            scale(alpha.sine, cross(turned, new.z)),
        )
        way = add(scale(d, new.z), scale(a, turned))
        origin = add(new.o, way)
        meeting = add(normal.foot, scale(normal.a, x))
        given = frame_on_line(x, z, meeting)
        return given, frame_on_line(turned, up, origin)

    def _aside(self, z: Vector, p: Vector) -> tuple[Frame, Frame]:
        """By the smallest turn, to the next line's point nearest to the last origin."""
        last = self.given[-1]
        new = self.exact[-1]
        before, name = self._lines()
        given = frame_on_line(unit(across(last.x, z)), z, p)
        u, v, w = last.of(z)
        straight = self._is_zero(u) and self._is_zero(v)
        parallel = f"to lie in a plane of the frame on {before}"
        if straight:
            parallel = f"to be parallel to {before}"
        u, v = self._zeros(u, v, ROUNDING, f"{name} turned by {{0:.3g}} rad {parallel}")
        w_exact = (1 - u * u - v * v).sqrt()
        up = new.out((u, v, w_exact.copy_sign(w)))
        x, y, _ = given.of(subtract(p, last.o))
        line = f"into a plane of the frame on {before}"
        if straight and self._is_zero(x) and self._is_zero(y):
            line = f"to be one line with {before}"
        x, y = self._zeros(x, y, self.noise, f"{name} moved by {{0:.3g}} m {line}")
        turned = unit(across(new.x, up))
        aside = scale(y, cross(up, turned))
        origin = add(new.o, add(scale(x, turned), aside))
        return given, frame_on_line(turned, up, origin)

    def _end(self, tool: Frame) -> None:
        """Along the tool's z axis and about it, to the tool frame."""
        last = self.given[-1]
        new = self.exact[-1]
        c, s, _ = last.of(tool.x)
        theta = self._angle(
            c,
            s,
            "the tool turned by {0:.3g} rad about its z axis, to {1}° from the normal before it",
        )
        d = self._length(
            dot(subtract(tool.o, last.o), last.z),
            "the tool moved by {0:.3g} m along its z axis, to where the normal before it is",
        )
        x = new.out((theta.cosine, theta.sine, ZERO))
        self.given[-1] = tool
        origin = add(new.o, scale(d, new.z))
        self.exact[-1] = frame_on_line(x, new.z, origin)

    def _lines(self) -> list[str]:
        """Names of the last line and of the next."""
        count = len(self.given)
        return self.names[count - 1 : count + 1]

    def _is_zero(self, value: Decimal) -> bool:
        return abs(value) <= self.tol

    def _length(self, value: Decimal, words: str) -> Decimal:
        return self._zeros(value, ZERO, self.noise, words)[0]

    def _zeros(
        self,
        x: Decimal,
        y: Decimal,
        noise: float,
        words: str,
    ) -> tuple[Decimal, Decimal]:
        """Each made 0 where it is within the tolerance."""
        a = ZERO if self._is_zero(x) else x
        b = ZERO if self._is_zero(y) else y
        self._changed(math.hypot(x - a, y - b), noise, words)
        return a, b

    def _angle(self, c: Decimal, s: Decimal, words: str) -> Turn:
        """The multiple of 15 degrees nearest to an angle given by cosine and sine, where it is near;
        else the angle itself.
        """
        k = round(math.atan2(s, c) / (math.pi / 12))
        turn = Turn(_cosine(k), _cosine(k - 6))
        sine_off = s * turn.cosine - c * turn.sine
        off = abs(math.asin(sine_off))
        if off > self.tol:
            return Turn(c, s)
        degrees = 180 - (180 - 15 * k) % 360
        relation = "perpendicular" if abs(degrees) == 90 else f"at {degrees}°"
        self._changed(off, ROUNDING, words, degrees, relation)
        return turn

    def _changed(
        self,
        size: float,
        noise: float,
        words: str,
        *rest: object,
    ) -> None:
        self.snapped |= size > 0
        if size > noise:
            self.changes.append(words.format(size, *rest))

    def screws(self) -> Array:
        """The exact lines (n, 6) with the given pitches."""
        S = np.zeros((len(self.chain.kinds), 6))
        joints = zip(
            self.exact[1:],
            self.chain.kinds,
            self.chain.local.slides,
            strict=False,
        )
        for row, (frame, kind, pitch) in zip(S, joints, strict=True):
            if kind == "prismatic":
                row[3:] = _floats(frame.z)
            else:
                moment = add(
                    cross(frame.o, frame.z),
                    scale(Decimal(float(pitch)), frame.z),
                )
                row[:3] = _floats(frame.z)
                row[3:] = _floats(moment, length(frame.o))
        return S

    def home(self) -> Array:
        """The exact home pose (4, 4)."""
        tool = self.exact[-1]
        columns = [
            *map(_floats, (tool.x, tool.y, tool.z)),
            _floats(tool.o, length(tool.o)),
        ]
        T = np.eye(4)
        T[:3] = np.stack(columns, axis=1)
        return T


def _cosine(k: int) -> Decimal:
    """cos(15 degrees k)."""
    k %= 24
    if k > 12:
        k = 24 - k
    if k > 6:
        return -_cosine(12 - k)
    # cos² = (2 + m sqrt(s)) / 4, of 0 to 90 degrees
    m, s = ((2, 1), (1, 3), (1, 1), (0, 1), (-1, 1), (-1, 3), (-2, 1))[k]
    return ((2 + m * Decimal(s).sqrt()) / 4).sqrt()


def _floats(v: Vector, size: Decimal = ZERO) -> Array:
    """A vector as floats; what is rounding of 50 digits, in a direction or in lengths of that size,
    becomes 0.
    """
    nothing = Decimal("1e-35") * max(size, Decimal(1))
    return np.array([0.0 if abs(x) < nothing else float(x) for x in v])
