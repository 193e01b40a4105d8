"""Hypothesis strategies for neighbourhoods: rotations, twists and poses whose angle is close to 0,
to π, or to another.

There a logarithm loses its sign or its axis (π), a series is cut too early and a quotient cancels
(0), and a formula changes its form (its own switch). Everything but the angle is as in
`group_strategies`: axes and lengths
independent of it.

Arrays are float64 and read-only; twists are (ω; v) in rad and m, poses those of a frame in the base
frame. Everything shrinks to `at` itself, then to powers of 10 away from it.
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
    """Angles close to one angle: it, the 8 floats next to it, and log-uniform distances.

    Of four angles one is within 8 floats. Distances are from 1 ulp on; at 0 they are log-uniform from
    1e-12, and one time in four from 1e-150.

    Parameters
    ----------
    at : float, default π
        Angle in the middle, rad, 0 or more.
    widest : float, default 1e-3
        Largest distance from it, rad.
    beyond : bool, default False
        Whether angles above `at` are drawn as well (at 0 there are no others).

    Returns
    -------
    strategy : SearchStrategy
        Strategy of floats, rad.

    Raises
    ------
    InputError
        If bounds are none.
    """
    return read(7, _angle_near(at, widest, beyond))


def near_rotation_vectors(
    at: float = math.pi,
    widest: float = WIDEST,
    beyond: bool = False,
) -> Arrays:
    """Rotation vectors ω with |ω| as in `near_angles`.

    Parameters
    ----------
    at : float, default π
        Angle in the middle, rad, 0 or more.
    widest : float, default 1e-3
        Largest distance from it, rad.
    beyond : bool, default False
        Whether angles above `at` are drawn as well (at 0 there are no others).

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (3,), rad.

    Raises
    ------
    InputError
        If bounds are none.
    """
    angle = _angle_near(at, widest, beyond)
    return read(19, lambda r: frozen(angle(r) * decoders.axis(r)))


def near_rotations(
    at: float = math.pi,
    widest: float = WIDEST,
    beyond: bool = False,
) -> Arrays:
    """Rotations by an angle as in `near_angles`.

    Parameters
    ----------
    at : float, default π
        Angle in the middle, rad, 0 or more.
    widest : float, default 1e-3
        Largest distance from it, rad.
    beyond : bool, default False
        Whether angles above `at` are drawn as well (at 0 there are no others).

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (3, 3), orthonormal to a few roundings.

    Raises
    ------
    InputError
        If bounds are none.

    Examples
    --------
    >>> from hypothesis import find
    >>> from poekin.testing import strategies
    >>> half_turns = strategies.near_rotations()
    >>> print(find(half_turns, lambda R: R[0, 0] < 0).round(3) + 0.0)
    [[-1.  0.  0.]
     [ 0.  1.  0.]
     [ 0.  0. -1.]]
    """
    angle = _angle_near(at, widest, beyond)
    return read(19, lambda r: frozen(_rotation(r, angle(r))))


def near_twists(
    at: float = math.pi,
    widest: float = WIDEST,
    lengths: tuple[float, float] = LENGTHS,
    beyond: bool = False,
) -> Arrays:
    """Twists (ω; v) with |ω| as in `near_angles`, and v independent of it.

    Parameters
    ----------
    at : float, default π
        Angle in the middle, rad, 0 or more.
    widest : float, default 1e-3
        Largest distance from it, rad.
    lengths : tuple of float, default (1e-12, 1e3)
        Smallest |v| beside 0, and largest, m.
    beyond : bool, default False
        Whether angles above `at` are drawn as well (at 0 there are no others).

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (6,), rad and m, of any frame.

    Raises
    ------
    InputError
        If bounds are none.
    """
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
    """Poses with a rotation as in `near_rotations`, and an independent translation.

    Parameters
    ----------
    at : float, default π
        Angle in the middle, rad, 0 or more.
    widest : float, default 1e-3
        Largest distance from it, rad.
    lengths : tuple of float, default (1e-12, 1e3)
        Smallest |t| beside 0, and largest, m.
    beyond : bool, default False
        Whether angles above `at` are drawn as well (at 0 there are no others).

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (4, 4), of a frame in the base frame, m.

    Raises
    ------
    InputError
        If bounds are none.
    """
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
