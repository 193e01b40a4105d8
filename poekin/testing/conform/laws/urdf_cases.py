"""A URDF reader as a subject: one law for each thing in a URDF that readers are known to get wrong."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable

import numpy as np

from ....groups.arrays import Array
from ...laws.measures import size
from ...strategies.group_strategies import Arrays, angles, axes, frozen, magnitudes, st, vectors
from . import of_urdf, small_urdf
from .law import Case, Cases, SubjectLaw, always, drawable, nothing, unit
from .small_urdf import JointNumbers, UrdfJoint, UrdfLayout

NAMES = ("j0", "j1", "j2")
LENGTHS = (1e-3, 3.0)
ANGLES = (1e-9, math.pi)
AXIS_LENGTHS = (1e-3, 1e3)
TURNS = 10.0
"""How far a continuous joint turns at most, in rad."""
_SIGNS = (1.0, -1.0)
FRAME_AXES = np.concatenate([np.eye(3), 0.0 - np.eye(3)])


def frame_axes() -> Arrays:
    """x, y and z, either way."""
    return st.sampled_from([frozen(axis) for axis in FRAME_AXES])


def long_axes() -> Arrays:
    """Axes of the frame of a length from 1e-3 to 1e3."""
    return st.builds(
        lambda n, length: frozen(n * (length or 2.0)),
        frame_axes(),
        magnitudes(*AXIS_LENGTHS),
    )


def signed_angles(largest: float = math.pi) -> st.SearchStrategy[float]:
    """Angles in rad, either way."""
    return st.builds(lambda x, sign: sign * x, angles(largest, ANGLES[0]), st.sampled_from(_SIGNS))


def turns() -> Arrays:
    """Roll, pitch and yaw: none, quarter turns, or anything up to a half turn."""
    one = st.one_of(
        st.just(0.0),
        st.sampled_from([math.pi / 2, -math.pi / 2, math.pi]),
        signed_angles(),
    )
    return st.builds(lambda *x: frozen(x), one, one, one)


def _row(
    axis: Arrays,
    q: st.SearchStrategy[float],
    mimic: bool = False,
) -> Arrays:
    factors = shifts = st.just(0.0)
    if mimic:
        factors = st.sampled_from([0.0, 0.0, -2.0, -0.5, 1.0])
        shifts = st.sampled_from([0.0, 0.0, 0.25, -1.0])
    return st.builds(
        lambda *x: np.concatenate([*x[:3], x[3:]]),
        axis,
        vectors(LENGTHS),
        turns(),
        factors,
        shifts,
        q,
    )


def arms(
    axis: Arrays,
    kinds: tuple[str, ...] = ("revolute", "prismatic", "fixed"),
    axis_written: bool = True,
    largest: float = math.pi,
) -> Cases:
    """One to three joints of these kinds, the first one moving, in the file's order."""

    @functools.cache
    def of(count: int) -> Cases:
        first = st.sampled_from([kind for kind in kinds if kind != "fixed"])
        sorts = st.tuples(first, *[st.sampled_from(kinds)] * (count - 1))
        rows = st.tuples(*(_row(axis, signed_angles(largest)) for _ in range(count)))
        return st.builds(make, sorts, rows)

    def make(
        sorts: tuple[str, ...],
        rows: tuple[Array, ...],
    ) -> Case:
        joints = tuple(
            UrdfJoint(kind, name, axis_written) for kind, name in zip(sorts, NAMES, strict=False)
        )
        return Case(np.concatenate(rows), small_urdf.chain(joints))

    return st.integers(1, 3).flatmap(of)


def _followers() -> Arrays:
    return _row(frame_axes(), signed_angles(), mimic=True)


def _numbers(layout: UrdfLayout, rows: Iterable[Array]) -> Case:
    """The case of these joints: multiplier and offset of those that follow another, q of the
    others.
    """
    numbers = []
    for joint, row in zip(layout.joints, rows, strict=False):
        own = np.array(row)
        if joint.follows >= 0:
            own[small_urdf.VALUE] = 0.0
        else:
            own[small_urdf.MIMIC] = 0.0
        numbers.append(own)
    return Case(np.concatenate(numbers), layout)


def mimics() -> Cases:
    """Two joints, one of which follows the other one, whichever comes first."""

    def make(
        first: int,
        kind: str,
        rows: tuple[Array, ...],
    ) -> Case:
        joints = [UrdfJoint(kind, NAMES[0]), UrdfJoint(kind, NAMES[1])]
        joints[1 - first] = joints[1 - first]._replace(follows=first)
        return _numbers(small_urdf.chain(tuple(joints)), rows)

    kinds = st.sampled_from(["revolute", "prismatic"])
    return st.builds(make, st.integers(0, 1), kinds, st.tuples(_followers(), _followers()))


def _orders(*counts: int) -> st.SearchStrategy[list[int]]:
    return st.one_of(*(st.permutations(range(count)) for count in counts))


def trees(mimic: bool = False) -> Cases:
    """Three or four joints of a tree with two branches or more, the file in any order.

    mimic: the last joint follows the last but one, which is on another branch.
    """

    def make(
        kinds: tuple[str, ...],
        places: tuple[int, ...],
        order: list[int],
        rows: tuple[Array, ...],
    ) -> Case:
        last = len(order) - 1
        after = [-1, *(min(place, k) for k, place in enumerate(places))][: last + 1]
        after[last] = min(after[last], last - 2)
        joints = [UrdfJoint(kind, f"j{k}") for k, kind in enumerate(kinds[: last + 1])]
        if mimic:
            joints[last] = UrdfJoint(joints[last - 1].kind, joints[last].name, follows=last - 1)
        return _numbers(UrdfLayout(tuple(joints), tuple(order), tuple(after)), rows)

    sorts = ["revolute", "prismatic"]
    if not mimic:
        sorts.append("fixed")
    kinds = st.sampled_from(sorts)
    files = _orders(3, 4)
    places = st.tuples(*[st.integers(-1, 2)] * 3)
    return st.builds(make, st.tuples(*[kinds] * 4), places, files, st.tuples(*[_followers()] * 4))


def orders() -> Cases:
    """Two to four joints whose order in the file, and by name, is not that from base to tip; one
    may branch off.
    """

    def make(
        names: list[str],
        order: list[int],
        side: bool,
        rows: tuple[Array, ...],
    ) -> Case:
        count = len(order)
        layout = small_urdf.chain(
            tuple(UrdfJoint("revolute", name) for name in names[:count]),
            tuple(order),
        )
        if side and count > 2:  # the first one goes nowhere, and the second one begins at the base
            layout = layout._replace(after=(-1, -1, *range(1, count - 1)))
        return _numbers(layout, rows)

    files = _orders(2, 3, 4)
    rows = st.tuples(*[_row(frame_axes(), signed_angles())] * 4)
    return st.builds(make, st.permutations([*NAMES, "side"]), files, st.booleans(), rows)


About = Callable[[Case], bool]
Fits = Callable[[Array], bool]


def _along(axis: Array) -> bool:
    return np.count_nonzero(axis) == 1


def _frame_axis(axis: Array) -> bool:
    return _along(axis) and unit(axis)


def _long_axis(axis: Array) -> bool:
    return _along(axis) and drawable(size(axis), AXIS_LENGTHS)


def _allowed(axis: Fits, largest: float = math.pi) -> About:
    """Whether a law could have drawn a case: its axes, lengths, angles and values of joints up to
    `largest`.
    """

    def allowed(case: Case) -> bool:
        return small_urdf.allowed(case) and all(map(fits, small_urdf.numbers_of(case)))

    def fits(numbers: JointNumbers) -> bool:
        return (
            axis(numbers.axis)
            and drawable(size(numbers.xyz), LENGTHS)
            and all(drawable(angle, ANGLES) for angle in numbers.rpy)
            and drawable(numbers.q, (ANGLES[0], largest))
        )

    return allowed


def _law(
    name: str,
    says: str,
    cases: Callable[[], Cases],
    about: About = always,
    axis: Fits = _frame_axis,
    largest: float = math.pi,
    function: str = "fk",
) -> SubjectLaw:
    jacobian = function == "jacobian"
    triples: Callable[[Case], Iterable[int]] = small_urdf.triples
    directions: Callable[[Case], Iterable[int]] = small_urdf.axes
    if axis is _long_axis:  # of any length, it is a vector like others
        triples = _axes_and_origins
        directions = nothing
    return SubjectLaw(
        name=name,
        says=says,
        needs="read_urdf",
        cases=lambda _: cases(),
        check=lambda subject, case: of_urdf.check(subject, case, jacobian),
        confirm=lambda _, case: of_urdf.confirmed(case, jacobian),
        show=lambda subject, case: of_urdf.show(subject, case, function),
        simpler=small_urdf.simpler,
        triples=triples,
        directions=directions,
        allowed=_allowed(axis, largest),
        applies=lambda subject: not jacobian or bool(subject.frame),
        about=about,
        unless="jacobian_frame is not declared",
    )


def _axes_and_origins(case: Case) -> Iterable[int]:
    return [*small_urdf.axes(case), *small_urdf.triples(case)]


def _robot_law(
    name: str,
    says: str,
    mimic: bool,
    about: About,
) -> SubjectLaw:
    law = _law(name, says, lambda: trees(mimic), about, function="poses")
    return law._replace(
        needs="read_robot",
        check=of_urdf.check_robot,
        confirm=lambda _, case: of_urdf.confirmed(
            case,
            False,
            range(len(small_urdf.rows_of(case))),
        ),
    )


def _axes(case: Case) -> list[Array]:
    joints = zip(case.layout.joints, small_urdf.numbers_of(case), strict=True)
    return [numbers.axis for joint, numbers in joints if joint.kind != "fixed"]


def _oblique(case: Case) -> bool:
    return any(np.count_nonzero(axis) > 1 for axis in _axes(case))


def _long(case: Case) -> bool:
    return any(abs(size(axis) - 1) > 1e-9 for axis in _axes(case))


def _missing(case: Case) -> bool:
    return any(not joint.axis for joint in case.layout.joints)


def _many_turns(case: Case) -> bool:
    return any(abs(numbers.q) > math.pi for numbers in small_urdf.numbers_of(case))


def _mimic(case: Case) -> bool:
    return any(joint.follows >= 0 for joint in case.layout.joints)


def _mimic_across(case: Case) -> bool:
    on = small_urdf.path(case, small_urdf.TIP)
    joints = case.layout.joints
    return any(joints[k].follows not in (-1, *on) for k in on)


def _branches(case: Case) -> bool:
    layout = case.layout
    return layout.after != small_urdf.chain(layout.joints).after


def _disordered(case: Case) -> bool:
    layout = case.layout
    names = [joint.name for joint in layout.joints]
    return layout.order != tuple(range(len(names))) or names != sorted(names) or _branches(case)


MOVING = ("revolute", "prismatic")
URDF_LAWS = (
    _law(
        "urdf",
        "axes along x, y, z; origins anywhere; revolute, prismatic and fixed joints",
        lambda: arms(frame_axes()),
    ),
    _law(
        "urdf oblique axis",
        "an axis may point anywhere",
        lambda: arms(axes(), MOVING),
        _oblique,
        unit,
    ),
    _law(
        "urdf long axis",
        "an axis of any length is its direction",
        lambda: arms(long_axes(), MOVING),
        _long,
        _long_axis,
    ),
    _law(
        "urdf missing axis",
        "a joint without an axis has x",
        lambda: arms(st.just(frozen([1, 0, 0])), MOVING, False),
        _missing,
    ),
    _law(
        "urdf continuous",
        "a continuous joint turns any number of times",
        lambda: arms(frame_axes(), ("continuous",), largest=TURNS),
        _many_turns,
        largest=TURNS,
    ),
    _law("urdf mimic", "a joint that mimics another moves with it", mimics, _mimic),
    _law(
        "urdf mimic across",
        "it may mimic one of another branch",
        lambda: trees(mimic=True),
        _mimic_across,
    ),
    _law(
        "urdf order",
        "joints are known by name, not by their place in the file",
        orders,
        _disordered,
    ),
    _law(
        "urdf jacobian",
        "the Jacobian is the derivative",
        lambda: arms(axes(), MOVING),
        axis=unit,
        function="jacobian",
    ),
    _robot_law("robot", "the pose of each link of a tree", False, _branches),
    _robot_law(
        "robot mimic",
        "of each link, where a joint mimics one of another branch",
        True,
        _mimic,
    ),
)
"""The battery for URDF readers."""
