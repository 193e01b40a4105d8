"""Hypothesis strategies for neighbourhoods: rotations, twists and poses whose angle is close to 0,
to π, or to another.

There a logarithm loses its sign or its axis (π), a series is cut too early and a quotient cancels
(0), and a formula changes its form (its own switch). Everything but the angle is as in
`group_strategies`: axes and lengths
independent of it.

    near_rotations(math.pi)     near_twists(0.0)     near_poses(1.0, beyond=True)

Parameters of all: at, the angle in rad, 0 or more, π by default; widest, the largest distance from
it in rad; beyond, whether angles above `at` are drawn as well (at 0 there are no others); lengths,
(smallest, largest) of |v| or |t| in m beside 0. Returns: a strategy of float64, arrays read-only;
twists are (ω; v), poses those of a frame in the base frame. It shrinks to `at` itself, then to
powers of 10 away from it.
Raises: InputError, at the call, for bounds that are none. Accuracy: distances are kept to the
rounding of the angle. Source: the worst places of the logarithm and of the Jacobians of exp, as
`accuracy` measures them.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from . import arguments
from .decoding import decoders
from .decoding.bytes_reader import BytesReader
from .decoding.decoders import SMALLEST
from .group_strategies import LENGTHS, Arrays, Reals, frozen, pose, read

WIDEST = 1e-3
"""How far from the centre angles are drawn unless something else is asked for, in rad."""
ULPS = 8
"""Of four angles one is the centre or at most this many floats away from it."""


def near_angles(
    at: float = math.pi,
    widest: float = WIDEST,
    beyond: bool = False,
) -> Reals:
    """Angles in rad close to `at`: it, the 8 floats next to it, and log-uniform distances from 1
    ulp to widest.

    Of four angles one is within 8 floats. At 0 the distances are log-uniform from 1e-12, and one
    time in four from 1e-150.
    """
    return read(7, _angle_near(at, widest, beyond))


def near_rotation_vectors(
    at: float = math.pi, widest: float = WIDEST, beyond: bool = False
) -> Arrays:
    """Rotation vectors ω (3,) in rad, |ω| as in `near_angles` (to the rounding of |ω|)."""
    angle = _angle_near(at, widest, beyond)
    return read(19, lambda r: frozen(angle(r) * decoders.axis(r)))


def near_rotations(
    at: float = math.pi,
    widest: float = WIDEST,
    beyond: bool = False,
) -> Arrays:
    """Rotations (3, 3) by an angle as in `near_angles`, orthonormal to a few roundings."""
    angle = _angle_near(at, widest, beyond)
    return read(19, lambda r: frozen(_rotation(r, angle(r))))


def near_twists(
    at: float = math.pi,
    widest: float = WIDEST,
    lengths: tuple[float, float] = LENGTHS,
    beyond: bool = False,
) -> Arrays:
    """Twists (ω; v) (6,), |ω| as in `near_angles` in rad, v in m independent of it."""
    angle = _angle_near(at, widest, beyond)
    bounds = arguments.magnitudes("lengths", lengths)
    return read(
        35,
        lambda r: frozen(np.concatenate([angle(r) * decoders.axis(r), decoders.vector(r, bounds)])),
    )


def near_poses(
    at: float = math.pi,
    widest: float = WIDEST,
    lengths: tuple[float, float] = LENGTHS,
    beyond: bool = False,
) -> Arrays:
    """Poses (4, 4) with a rotation as in `near_rotations` and a translation in m independent of it."""
    angle = _angle_near(at, widest, beyond)
    bounds = arguments.magnitudes("lengths", lengths)
    return read(35, lambda r: pose(_rotation(r, angle(r)), decoders.vector(r, bounds)))


def _angle_near(
    at: float,
    widest: float,
    beyond: bool,
) -> functools.partial[float]:
    centre = arguments.number("at (rad)", at, 0.0, 1e3)
    most = arguments.number("widest (rad)", widest, max(math.ulp(centre), SMALLEST), 1e3)
    return functools.partial(
        _angle,
        at=centre,
        widest=most,
        beyond=bool(beyond),
    )


def _angle(
    r: BytesReader,
    at: float,
    widest: float,
    beyond: bool,
) -> float:
    closest = r.byte() < 64
    above = r.byte() >= 128
    if at == 0.0:
        smallest = min(1e-12, widest)
        if closest:
            smallest = SMALLEST
        return r.magnitude(smallest, widest)
    ulp = math.ulp(at)
    if closest:
        gap = r.pick(range(ULPS + 1)) * ulp
    else:
        gap = r.magnitude(ulp, widest)
    if above and beyond:
        return at + gap
    return max(at - gap, 0.0)


def _rotation(r: BytesReader, angle: float) -> np.ndarray:
    return decoders.turned(decoders.axis(r), angle)
