"""The lines of a chain's axes and their common normals, in 50 digits.

Nearly parallel axes have their common normal far away: with an angle s between them it is found
s^-2 times worse than the axes are known. In 50 digits that costs nothing, and a table is as good as
its numbers' own rounding lets it be.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from decimal import Context, Decimal, localcontext
from typing import NamedTuple

import numpy as np

from ...algebra import add, cross, dot, scale, subtract
from ...groups.vectors import angular_part, linear_part

Vector = tuple[Decimal, Decimal, Decimal]
ZERO = Decimal(0)


@contextmanager
def digits() -> Iterator[None]:
    """Arithmetic in 50 digits, whatever the caller's own decimal context is."""
    with localcontext(Context(prec=50)):
        yield


def exact(values: Iterable[float]) -> Vector:
    """Three floats as they are."""
    x, y, z = values
    return Decimal(float(x)), Decimal(float(y)), Decimal(float(z))


def length(a: Vector) -> Decimal:
    """|a|."""
    return dot(a, a).sqrt()


def unit(a: Vector) -> Vector:
    """a / |a|."""
    return scale(1 / length(a), a)


def across(a: Vector, z: Vector) -> Vector:
    """The part of a that is perpendicular to the unit vector z."""
    return subtract(a, scale(dot(a, z), z))


class Frame(NamedTuple):
    """A frame by its three directions and its origin, in the base frame."""

    x: Vector
    y: Vector
    z: Vector
    o: Vector

    def of(self, v: Vector) -> Vector:
        """A direction of the base frame, as this frame sees it."""
        return dot(self.x, v), dot(self.y, v), dot(self.z, v)

    def out(self, v: Vector) -> Vector:
        """A direction of this frame, as the base frame sees it."""
        return add(
            add(scale(v[0], self.x), scale(v[1], self.y)),
            scale(v[2], self.z),
        )

    def seen_by(self, other: Frame) -> Frame:
        """Frame by its directions and origin in another one."""
        o = other.of(subtract(self.o, other.o))
        return Frame(
            other.of(self.x),
            other.of(self.y),
            other.of(self.z),
            o,
        )


def frame_on_line(x: Vector, z: Vector, o: Vector) -> Frame:
    """Frame whose z axis lies on the line of direction z through o."""
    return Frame(x, cross(z, x), z, o)


BASE = frame_on_line(
    (Decimal(1), ZERO, ZERO),
    (ZERO, ZERO, Decimal(1)),
    (ZERO, ZERO, ZERO),
)
"""The base frame."""


def nearest_on_line(p: Vector, z: Vector, o: Vector) -> Vector:
    """Point nearest to o of the line of unit direction z through p."""
    return add(p, scale(dot(subtract(o, p), z), z))


def axis_near(S: np.ndarray, slides: bool, origin: Vector) -> tuple[Vector, Vector]:
    """Direction of a screw's axis and its point nearest to `origin`, which is that itself where a
    joint only slides.
    """
    w = exact(angular_part(S))
    v = exact(linear_part(S))
    if slides:
        return unit(v), origin
    z = unit(w)
    foot = scale(1 / dot(w, w), cross(w, v))
    return z, nearest_on_line(foot, z, origin)


class Normal(NamedTuple):
    """The common normal of two lines: its foot on the first, the unit direction x from the first to
    the second, the distance a along x, the sine and cosine of the angle alpha from one direction to
    the other about x.
    """

    foot: Vector
    x: Vector
    a: Decimal
    sine: Decimal
    cosine: Decimal


def common_normal(p: Vector, z: Vector, p2: Vector, z2: Vector) -> Normal:
    """Common normal of two lines (point, unit direction) that are not parallel. Where they meet, x
    is along z x z2.
    """
    c = cross(z, z2)
    w = subtract(p2, p)
    ss = dot(c, c)
    sine = ss.sqrt()
    cosine = dot(z, z2)
    foot = add(p, scale(dot(cross(w, z2), c) / ss, z))
    x = scale(1 / sine, c)
    a = dot(w, x)
    if a < 0:
        return Normal(foot, scale(-1, x), -a, -sine, cosine)
    return Normal(foot, x, a, sine, cosine)


def parallel_normal(
    p: Vector,
    z: Vector,
    p2: Vector,
    z2: Vector,
    x: Vector,
    nothing: Decimal,
) -> Normal:
    """Common normal of two parallel lines, taken at p; of one and the same line (distance at most
    `nothing`) x stays as it is.
    """
    apart = across(subtract(p2, p), z)
    a = length(apart)
    cosine = Decimal(1 if dot(z, z2) > 0 else -1)
    if a <= nothing:
        return Normal(p, x, ZERO, ZERO, cosine)
    return Normal(p, scale(1 / a, apart), a, ZERO, cosine)
