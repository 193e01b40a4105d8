"""Laws of the branches of the logarithm, `log(X, near=…)`; and `NEAR_LAWS`, the battery of them.

Of the logarithms ω (1 + 2πk/|ω|) of a rotation the one closest to ω_near is meant; of a pose, the
twist with that ω. The subject is a `group.Group` of the functions under test, whose log takes the
argument near; one that is not there is an InputError. Poses are those of a frame in the base frame.
Source: Park 1994, Remark 1: every (2k + 1) π is a logarithm's angle at π, and so it is elsewhere
with 2πk added.
"""

from __future__ import annotations

import math

import numpy as np

from poekin.groups.arrays import Array
from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.laws.group import Group
from poekin.testing.laws.laws import Law, Pairs, check_bounds, checked
from poekin.testing.laws.measures import angle, length, of_elements, of_twist, shift, size


def near_picks_the_closest_branch(
    group: Group,
    xi: Array,
    near: Array,
) -> float:
    """Law: the logarithm near a given one is a logarithm, and none is closer.

    It lies on the line of the principal logarithm. Also held near what lies on that line, both ways.
    Where the rotation is the identity to 1e-12 its axis is free, and so is which logarithm is the
    closest.
    """
    X = group.exp(xi)
    principal = group.log(X)
    theta = angle(principal)
    if theta < 1e-12:
        return 0.0
    n = np.zeros(group.size)
    n[:3] = principal[:3] / theta
    # 3 and 6 lie a little short of a half and a whole turn: there the principal logarithm is
    # hastily taken.
    sizes = (angle(near), 3.0, 6.0)
    guesses = [near, *(size * n for size in sizes), *(-size * n for size in sizes)]
    return max(_closest(group, X, principal, guess, xi) for guess in guesses)


@checked()
def a_logarithm_is_nearest_to_itself(
    group: Group,
    xi: Array,
) -> Pairs:
    """Law: the logarithm nearest to ξ of exp ξ is ξ, on every branch.

    log(exp ξ, near=ξ) = ξ, but at the multiples of 2π, where v has no bound.
    """
    theta = angle(xi)
    gap = abs(math.remainder(theta, 2 * math.pi))
    if gap < 0.1 < theta:
        return []
    error = group.log(group.exp(xi), near=xi) - xi
    # Within rounding of π both signs are as near; of the two, either may come back.
    if abs(theta - math.pi) < 1e-14:
        return []
    angular = (64 if theta > math.pi + 1e-9 else 24) * UNIT * theta
    return of_twist(error, angular, 512 * UNIT * (1 + theta) ** 2 * length(xi))


NEAR_LAWS = (
    Law(near_picks_the_closest_branch, ("twist", "far_twist")),
    Law(a_logarithm_is_nearest_to_itself, ("far_twist",)),
)
"""The battery: each law with the kinds of its arguments (`strategies.group_cases`)."""


def _closest(
    group: Group,
    X: Array,
    principal: Array,
    near: Array,
    xi: Array,
) -> float:
    found = group.log(X, near=near)
    theta = angle(principal)
    n = principal[:3] / theta
    distances = [size((theta + 2 * math.pi * k) * n - near[:3]) for k in range(-4, 5)]
    extent = 1 + angle(found)
    off_line = size(np.cross(n, found[:3]))
    # Near a multiple of 2π the translation of a logarithm has no bound: it is 1/sin(θ/2) times that
    # of the pose.
    stretch = 1.0
    if angle(found) > math.pi + 1e-9:
        stretch = 1 / abs(math.sin(theta / 2))
    pairs = of_elements(group.exp(found), X, 2 * extent, 4 * extent**2 * stretch * shift(X))
    excess = size(found[:3] - near[:3]) - min(distances)
    bound = 16 * UNIT * extent
    return check_bounds(
        "near picks the closest branch",
        *pairs,
        (off_line, bound),
        (excess, 4 * bound),
        xi=xi,
        near=near,
    )
