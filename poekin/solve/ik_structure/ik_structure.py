"""ik_structure: which family the inverse kinematics of an arm belongs to, and why."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ...errors import InputError, quote
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, chain_of
from ...model.sampling import joint_ratios
from ..ik_all.nearest.nearest_arm import NearestArm, configurations, nearest_arm
from ..ik_all.sources import solvers_of
from ..ik_all.structure import MOST_JOINTS, Family, Misfit, all_misfits, misfits
from .neighbours import intersecting, locked, parallel
from .result import Assumption, IKKind, IKStructure, LockedStructure, axes_of, degrees, mm

NEAR_ANGLE = math.radians(2)
"""Angle up to which axes are taken for nearly parallel, rad."""
NEAR_DISTANCE = 0.01
"""Part of the reach up to which axes are taken to nearly meet."""

QUARTIC = "general: a quartic"
"""Case of three joints of which no neighbouring axes intersect or are parallel."""

_LOCKED_AT = 0.7  # rad or m, of no particular geometry
_TRIALS = 4  # configurations: a rank that is too low at all of them is so everywhere
_RANK_TOLERANCE = 1e-10  # of the largest singular value


def ik_structure(chain: Arm) -> IKStructure:
    """Family of an arm's inverse kinematics, what is assumed, and what would make it closed.

    An arm of six joints has a closed form where three consecutive axes meet in a point or are
    parallel. Where they nearly do, the nearest such arm and its distance are said. Six revolute
    joints of any geometry are solved by elimination.

    Parameters
    ----------
    chain : Chain or CompiledChain
        Arm to look at.

    Returns
    -------
    structure : IKStructure
        Kind, method, joints, assumptions with sizes, nearest arm with bounds, and a hint.

    Raises
    ------
    InputError
        If `chain` is no Chain, or has no joints.

    See Also
    --------
    ik_all : Every solution of an arm for a pose.
    axes : Relations of an arm's axes, exact or not.

    Notes
    -----
    Axes that miss a family by up to 2 degrees or 1 % of the reach nearly belong to it; the family
    whose nearest arm has the least mean square pose difference is taken.
    Accuracy: the bounds hold for all coordinates of joints that turn, and within the limits of
    joints that slide (tests/solve/ik_all/nearest/test_pose_bound.py).
    Source: Pieper 1968; Raghavan and Roth 1993 for the elimination.

    Examples
    --------
    >>> import poekin as pk
    >>> print(pk.ik_structure(pk.load("puma560").chain()))
    spherical wrist: axes 4, 5 and 6
    other joints: axes 1 and 2 intersect
    closed form
    >>> panda = pk.ik_structure(pk.load("panda").chain(tip="panda_hand"))
    >>> panda.kind, panda.locked[6].kind, panda.locked[6].reversed
    ('redundant', 'spherical shoulder', True)
    """
    chain = chain_of(chain)
    if not chain.dof:
        raise InputError("ik_structure: expected an arm with joints, the chain has none")
    slides = zip(chain.joint_names, chain.kinds, strict=True)
    prismatic = tuple(name for name, kind in slides if kind == "prismatic")
    found = _structure(chain)
    if found.method != "lock":
        solvers = solvers_of(chain, "auto")
        found = replace(found, method=solvers[0].method if solvers else "search")
    return replace(found, prismatic=prismatic)


def _structure(chain: Chain) -> IKStructure:
    C = chain.nontrivial_coupling
    if C is not None and np.linalg.matrix_rank(C / joint_ratios(chain)) < len(chain.kinds):
        return IKStructure("coupled joints", hint=_COUPLED)
    if chain.dof > MOST_JOINTS:
        return _redundant(chain)
    if _singular_everywhere(chain):
        return IKStructure("singular everywhere", hint=_SINGULAR)
    near = misfits(chain, NEAR_ANGLE, NEAR_DISTANCE * chain.reach)
    if near and near[0].exact:
        return _closed(chain, near[0].family)
    if chain.dof < MOST_JOINTS:
        padded = _padded(chain)
        if padded is not None:
            return padded
    if near:
        return _near(chain, near)
    return _general(chain)


_COUPLED = (
    "joints follow others: there are fewer coordinates than joints, and no closed form is known"
)
_SINGULAR = (
    "the Jacobian has lower rank than the arm has coordinates at every q: a pose that is reached "
    "is reached in infinitely many ways"
)


def _singular_everywhere(chain: Chain) -> bool:
    """Whether the rank of the Jacobian is below the number of coordinates at all of some q."""
    J = chain.jacobian(configurations(chain)[:_TRIALS], frame="space") / joint_ratios(chain)
    J[:, 3:] /= chain.reach
    values = np.linalg.svd(J, compute_uv=False)
    ranks = (values > _RANK_TOLERANCE * values[:, :1]).sum(axis=1)
    return bool((ranks < chain.dof).all())


def _closed(chain: Chain, family: Family) -> IKStructure:
    """Structure of an arm that belongs to a family to rounding."""
    return IKStructure(
        kind=_kind(family, len(chain.kinds)),
        joints=_numbers(family),
        reversed=family.reversed,
        first_joints=_first_joints(chain, family),
        fictitious=MOST_JOINTS - len(chain.kinds),
    )


def _near(chain: Chain, near: list[Misfit]) -> IKStructure:
    """Structure of an arm that nearly belongs to families: of the nearest arm."""
    arms = [nearest_arm(chain, misfit.family) for misfit in near]
    best = min(range(len(near)), key=lambda k: arms[k].rms)
    nearest: NearestArm = arms[best]
    closed = _closed(nearest.chain, nearest.family)
    return replace(
        closed,
        exact=False,
        assumptions=(_assumption(near[best]),),
        nearest=nearest.chain,
        position_bound=nearest.position_bound,
        rotation_bound=nearest.rotation_bound,
        hint=_hint(near[best]),
    )


def _padded(chain: Chain) -> IKStructure | None:
    """Structure of an arm of fewer than six joints that fictitious ones give three axes that meet.

    Three fictitious axes behind an arm of three joints, two behind the last of four, one through
    the point in which the last two of five intersect; or before the first ones.
    """
    n = len(chain.kinds)
    own = max(n - 3, 0)
    last = tuple(range(n - own, n))
    for joints, turned in ((last, False), (tuple(range(own)), True)):
        if any(chain.kinds[i] != "revolute" for i in joints):
            continue
        if own == 2 and not intersecting(chain, joints[0]):
            continue
        return IKStructure(
            kind="fewer than six joints",
            joints=tuple(i + 1 for i in joints),
            reversed=turned,
            fictitious=MOST_JOINTS - n,
        )
    return None


def _general(chain: Chain) -> IKStructure:
    """Structure of an arm of which no three axes meet or are parallel, nearly or to rounding."""
    n = len(chain.kinds)
    found = IKStructure(
        "general",
        hint=_closest(chain),
        fictitious=MOST_JOINTS - n,
    )
    for i in (n - 2, 0):
        if intersecting(chain, i):
            turned = i == 0
            return replace(
                found,
                kind="two axes intersect",
                joints=(i + 1, i + 2),
                reversed=turned,
            )
    for i in range(1, n - 2):
        if parallel(chain, i):
            return replace(
                found,
                kind="two parallel axes",
                joints=(i + 1, i + 2),
            )
    return found


def _redundant(chain: Chain) -> IKStructure:
    """Structure of an arm of seven coordinates and more."""
    extra = chain.dof - MOST_JOINTS
    if extra > 1:
        return IKStructure("redundant", "lock", hint=f"lock {extra} joints of {chain.dof}")
    each = tuple(_locked(chain, k) for k in range(chain.dof))
    closed = [one for one in each if len(one.joints) == 3]
    if not closed:
        return IKStructure("redundant", "lock", exact=False, locked=each)
    # a quartic last; of equals the joint nearest to the tip
    best = max(closed, key=lambda one: (one.exact, one.first_joints != QUARTIC, each.index(one)))
    way = "closed form" if best.exact else "elimination"
    hint = f"{way} with {quote(best.joint)} locked"
    centres = {
        one.joints for one in closed if one.kind in ("spherical wrist", "spherical shoulder")
    }
    if centres >= {(1, 2, 3), (5, 6, 7)}:
        hint = f"S-R-S, shoulder and wrist are spherical: {hint}, or with the arm angle given"
    return IKStructure("redundant", "lock", exact=best.exact, locked=each, hint=hint)


def _locked(chain: Chain, k: int) -> LockedStructure:
    """Structure with joint k locked where no axes have a particular relation by its value."""
    found = _structure_of_locked(locked(chain, k, _LOCKED_AT))
    joints = tuple(number + (number > k) for number in found.joints)
    return LockedStructure(
        chain.joint_names[k],
        found.kind,
        joints,
        found.reversed,
        found.exact,
        _renumbered(found.first_joints, k),
    )


def _renumbered(first_joints: str, k: int) -> str:
    """The case of the other joints, numbered in the whole arm, whose joint k, from 0, is locked."""
    words = [str(int(w) + (int(w) > k)) if w.isdigit() else w for w in first_joints.split(" ")]
    return " ".join(words)


def _structure_of_locked(chain: Chain) -> IKStructure:
    """Structure of six joints, without the nearest arm."""
    if _singular_everywhere(chain):
        return IKStructure("singular everywhere")
    near = misfits(chain, NEAR_ANGLE, NEAR_DISTANCE * chain.reach)
    if near:
        return replace(_closed(chain, near[0].family), exact=near[0].exact)
    return _general(chain)


def _kind(family: Family, n: int) -> IKKind:
    if family.kind == "parallel":
        return "three parallel axes"
    if family.first == n - 3:
        return "spherical wrist"
    return "spherical shoulder" if family.first == 0 else "spherical joint"


def _numbers(family: Family) -> tuple[int, ...]:
    return tuple(i + 1 for i in family.joints)


def _first_joints(chain: Chain, family: Family) -> str:
    """Case of the three joints beside a spherical wrist, or shoulder, in the order of solving."""
    n = len(chain.kinds)
    if family.kind == "parallel" or n < MOST_JOINTS or family.first not in (0, n - 3):
        return ""
    others = range(3, 6) if family.reversed else range(3)
    if any(chain.kinds[i] == "prismatic" for i in others):
        return "prismatic"
    # pairs by their first joint, the one at the end of the arm first
    pairs = (4, 3) if family.reversed else (0, 1)
    for i in pairs:
        if intersecting(chain, i):
            return f"{axes_of((i + 1, i + 2))} intersect"
        if parallel(chain, i):
            return f"{axes_of((i + 1, i + 2))} are parallel"
    return QUARTIC


def _assumption(misfit: Misfit) -> Assumption:
    if misfit.family.kind == "parallel":
        return Assumption(_numbers(misfit.family), "are parallel", misfit.angle, 0.0)
    return Assumption(_numbers(misfit.family), "meet in a point", 0.0, misfit.distance)


def _closest(chain: Chain) -> str:
    """Hint at the three axes that miss a family by least; empty where no three axes could."""
    every = all_misfits(chain)
    if not every:
        return ""
    return _hint(min(every, key=lambda misfit: misfit.angle + misfit.distance / chain.reach))


def _hint(misfit: Misfit) -> str:
    """Change of geometry that would make a closed form."""
    axes = axes_of(_numbers(misfit.family))
    if misfit.family.kind == "parallel":
        return f"closed form if {axes} were parallel: they are {degrees(misfit.angle)} apart"
    return f"closed form if {axes} met: they miss by {mm(misfit.distance)}"
