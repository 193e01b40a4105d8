"""A URDF reader as a subject: one law for each thing in a URDF that readers are known to get wrong."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np

from ...model.evaluation import FRAME_NAMES
from .. import exact
from ..derivative_laws import exact_jacobians
from ..strategies import Arrays, angles, axes, frozen, magnitudes, st, vectors
from . import arm_cases, confirm, of_arms, small_urdf
from .calls import called, made
from .grades import Verdict, judged
from .law import Case, Law, Shown, typed
from .small_urdf import EACH, Joint, Layout
from .subject import Subject

NAMES = ("j0", "j1", "j2")
LENGTHS = (1e-3, 3.0)
_SIGNS = (1.0, -1.0)
FRAME_AXES = np.concatenate([np.eye(3), 0.0 - np.eye(3)])


def frame_axes() -> Arrays:
    """x, y and z, either way."""
    return st.sampled_from([frozen(axis) for axis in FRAME_AXES])


def long_axes() -> Arrays:
    """Axes of the frame of a length from 1e-3 to 1e3."""
    return st.builds(lambda n, length: frozen(n * (length or 2.0)), frame_axes(), magnitudes(1e-3, 1e3))


def signed_angles(largest: float = math.pi) -> st.SearchStrategy[float]:
    """Angles in rad, either way."""
    return st.builds(lambda x, sign: sign * x, angles(largest, 1e-9), st.sampled_from(_SIGNS))


def turns() -> Arrays:
    """Roll, pitch and yaw: none, quarter turns, or anything up to a half turn."""
    one = st.one_of(st.just(0.0), st.sampled_from([math.pi / 2, -math.pi / 2, math.pi]), signed_angles())
    return st.builds(lambda *x: frozen(x), one, one, one)


def _row(axis: Arrays, q: st.SearchStrategy[float], mimic: bool = False) -> Arrays:
    factors = st.sampled_from([0.0, 0.0, -2.0, -0.5, 1.0]) if mimic else st.just(0.0)
    shifts = st.sampled_from([0.0, 0.0, 0.25, -1.0]) if mimic else st.just(0.0)
    return st.builds(lambda *x: np.concatenate([*x[:3], x[3:]]), axis, vectors(LENGTHS), turns(), factors, shifts, q)


def arms(
    axis: Arrays, kinds: tuple[str, ...] = ("revolute", "prismatic", "fixed"), axis_written: bool = True,
    largest: float = math.pi,
) -> st.SearchStrategy[Case]:  # fmt: skip
    """One to three joints of these kinds, the first one moving, in the file's order."""

    def of(count: int) -> st.SearchStrategy[Case]:
        sorts = st.tuples(*(st.sampled_from([kind for kind in kinds if k or kind != "fixed"]) for k in range(count)))
        rows = st.tuples(*(_row(axis, signed_angles(largest)) for _ in range(count)))
        return st.builds(make, sorts, rows)

    def make(sorts: tuple[str, ...], rows: tuple[np.ndarray, ...]) -> Case:
        joints = tuple(Joint(kind, name, axis_written) for kind, name in zip(sorts, NAMES, strict=False))
        return Case(np.concatenate(rows), Layout(joints, tuple(range(len(joints)))))

    return st.integers(1, 3).flatmap(of)


def mimics() -> st.SearchStrategy[Case]:
    """Two joints, one of which follows the other one, whichever comes first."""

    def make(first: int, kind: str, rows: tuple[np.ndarray, np.ndarray]) -> Case:
        joints = [Joint(kind, NAMES[0]), Joint(kind, NAMES[1])]
        joints[1 - first] = joints[1 - first]._replace(follows=first)
        numbers = [row * (np.arange(EACH) < 9) + row * (np.arange(EACH) == 11) for row in rows]
        numbers[1 - first] = rows[1 - first] * (np.arange(EACH) < 11)
        return Case(np.concatenate(numbers), Layout(tuple(joints), (0, 1)))

    rows = st.tuples(*(_row(frame_axes(), signed_angles(), mimic=True) for _ in range(2)))
    return st.builds(make, st.integers(0, 1), st.sampled_from(["revolute", "prismatic"]), rows)


def orders() -> st.SearchStrategy[Case]:
    """Two or three joints whose order in the file, and by name, is not that from base to tip; one may branch off."""

    def make(names: tuple[str, ...], order: tuple[int, ...], side: bool, rows: tuple[np.ndarray, ...]) -> Case:
        count = len(order)
        joints = tuple(Joint("revolute", names[k]) for k in range(count))
        return Case(np.concatenate(rows[:count]), Layout(joints, order, side))

    files = [order for count in (2, 3) for order in itertools.permutations(range(count))]
    rows = st.tuples(*(_row(frame_axes(), signed_angles()) for _ in range(3)))
    return st.builds(make, st.permutations(NAMES).map(tuple), st.sampled_from(files), st.booleans(), rows)


def check(subject: Subject, case: Case, jacobian: bool = False) -> Verdict:
    """Whether what the subject reads out of the URDF has the pose, or the Jacobian, of the definition."""
    law = "read_urdf"
    read, fault = made(lambda: subject.own.read_urdf(small_urdf.text(case), "base", "tip"))
    if fault:
        return judged(law, fault)
    arm, q, names = small_urdf.arm(case)
    (found, fault) = made(lambda: [str(name) for name in read.names])
    if fault:
        return judged(law, f"`names` of what was read: {fault}")
    lost = [name for name in names if name not in found]
    if lost:
        return judged(law, f"no coordinate {', '.join(lost)} among those read: {', '.join(found) or 'none'}")
    given = {**dict(zip(names, q, strict=True)), small_urdf.SIDE: small_urdf.SIDE_VALUE}
    values = np.array([given.get(name, 0.0) for name in found])
    if not jacobian:
        T, fault = called(read.fk, (4, 4), values)
        return judged(law, fault or of_arms.pose_parts(arm, q, T))
    J, fault = called(read.jacobian, (6, len(found)), values)
    if fault:
        return judged(law, fault)
    J = subject.rows(J)[:, [found.index(name) for name in names]]
    return judged(law, of_arms.jacobian_parts(subject.frame, arm, q, J))


def confirmed(case: Case, jacobian: bool = False) -> bool:
    """Whether the exact pose, and Jacobian, stand against the second oracle."""
    arm, q, _ = small_urdf.arm(case)
    pose = confirm.near(confirm.chain_of(small_urdf.factors(case)), of_arms.pose(arm, q))
    return pose and arm_cases.confirmed(arm, q, jacobian)


def show(subject: Subject, case: Case, jacobian: bool = False) -> Shown:
    """The URDF and the values of its joints, as Python."""
    arm, q, names = small_urdf.arm(case)
    text, values = small_urdf.text(case), dict(zip(names, q.tolist(), strict=True))
    expected = exact.rounded(of_arms.pose(arm, q))
    if jacobian:
        expected = subject.rows(exact.rounded(exact_jacobians(arm, exact.exactly(q))[FRAME_NAMES.index(subject.frame)]))
    call = "jacobian" if jacobian else "fk"
    paste = (
        f"from {subject.module} import {subject.title}; arm = {subject.title}().read_urdf({text!r}, 'base', 'tip'); "
        f"q = {values!r}; print(arm.{call}([q.get(name, 0.0) for name in arm.names]))"
    )
    return Shown(f"q = {values}, {_words(case)}", paste, expected)


def _words(case: Case) -> str:
    """Each joint in a few words."""
    layout, rows = small_urdf.layout_of(case), small_urdf.rows_of(case)
    said = []
    for joint, row in zip(layout.joints, rows, strict=True):
        words = f"{joint.name} {joint.kind}"
        if joint.kind != "fixed":
            words += f", axis {typed(row[:3])}" if joint.axis else ", no axis written (which means x)"
        words += f", xyz {typed(row[3:6])}" if np.any(row[3:6]) else ""
        words += f", rpy {typed(row[6:9])}" if np.any(row[6:9]) else ""
        if joint.follows >= 0:
            words += f", mimics {layout.joints[joint.follows].name} × {1 + row[9]:g} + {row[10]:g}"
        said.append(words)
    return "; ".join(said)


def _law(name: str, says: str, cases: Callable[[], st.SearchStrategy[Case]], jacobian: bool = False) -> Law:
    return Law(
        name, says, "read_urdf", lambda subject: cases(),
        lambda subject, case: check(subject, case, jacobian), lambda subject, case: confirmed(case, jacobian),
        lambda subject, case: show(subject, case, jacobian), small_urdf.simpler, small_urdf.triples,
        small_urdf.allowed, lambda subject: not jacobian or bool(subject.frame),
    )  # fmt: skip


URDF_LAWS = (
    _law(
        "urdf", "axes along x, y, z; origins anywhere; revolute, prismatic and fixed joints", lambda: arms(frame_axes())
    ),
    _law("urdf oblique axis", "an axis may point anywhere", lambda: arms(axes(), ("revolute", "prismatic"))),
    _law(
        "urdf long axis", "an axis of any length is its direction", lambda: arms(long_axes(), ("revolute", "prismatic"))
    ),
    _law(
        "urdf missing axis",
        "a joint without an axis has x",
        lambda: arms(st.just(frozen([1, 0, 0])), ("revolute", "prismatic"), False),
    ),
    _law(
        "urdf continuous",
        "a continuous joint turns any number of times",
        lambda: arms(frame_axes(), ("continuous",), largest=10.0),
    ),
    _law("urdf mimic", "a joint that mimics another moves with it", mimics),
    _law("urdf order", "joints are known by name, not by their place in the file", orders),
    _law("urdf jacobian", "the Jacobian is the derivative", lambda: arms(axes(), ("revolute", "prismatic")), True),
)
"""The battery for URDF readers."""
