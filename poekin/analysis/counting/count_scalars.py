"""An algorithm run on scalars that count, or on scalars that record, with generic numbers in place
of an arm's own.

Of the user's chain only the kinds of its joints and its coupling are taken: zeros and right angles
that one arm happens to have are the business of its specialised program.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...algebra import IDENTITY, compose, turned_about_z
from ...engine.count import Count, counted
from ...engine.straight_line.program import Angles, program
from ...engine.straight_line.specialise import Structure
from ...engine.straight_line.trace import Graph
from ...formulas import dh
from ...formulas.kinematics import columns
from ...formulas.lie.exponential import joint
from ...groups import se3
from ...groups.arrays import Array
from ...model import screw
from ...model.chain import Chain
from .count_methods import JacobianThenPose, Links, Row, Rows, empty_rows

Algorithm = Callable[[Links], JacobianThenPose]


class JointMotion(NamedTuple):
    """Joint i as it moves: x = C q + c, sin r x, cos r x, and s x."""

    kind: str
    x: Any
    sine: Any
    cosine: Any
    shift: Any


Form = Callable[[JointMotion, np.random.Generator], Row]


def paper_operations(algorithm: Algorithm, chain: Chain, with_pose: bool) -> Count:
    """Operations of an algorithm, needed for its result or not; the links' poses are given."""
    total = Count()
    # The count does not depend on the numbers.
    poses = counted([IDENTITY for _ in chain.kinds], total)
    _run(algorithm, chain, poses, with_pose)
    return total


def live_operations(algorithm: Algorithm, chain: Chain, with_pose: bool) -> Count:
    """Operations that an algorithm's result needs; the links' poses are given."""
    graph = Graph()
    numbers = itertools.count(1)
    # Inputs from 0 on are of angles.
    poses = [tuple(graph.input(-next(numbers)) for _ in IDENTITY) for _ in chain.kinds]
    J, T = _run(algorithm, chain, poses, with_pose)
    return _count(graph, Angles(graph), T, J)


def all_operations(
    algorithm: Algorithm,
    form: Form,
    chain: Chain,
    with_pose: bool,
) -> Count:
    """Operations that an algorithm's result needs from q on: sines, cosines, the links' poses in
    their form, and the coupling.
    """
    graph = Graph()
    angles = Angles(graph)
    rng = generator()
    C = chain.coupling.tolist()
    offsets = chain.offset.tolist()
    inputs = range(1, chain.dof + 1)
    coordinates = [graph.input(-k) for k in inputs]
    poses = []
    rotates, slides = structure(chain)
    joints = zip(chain.kinds, rotates, slides, C, offsets, strict=True)
    for kind, r, s, row, c in joints:
        x = c
        for q, factor in zip(coordinates, row, strict=True):
            x = x + graph.scaled(q, factor)
        rates = [r * factor for factor in row]
        sine, cosine = angles.sine_cosine(rates, r * c, 0)
        motion = JointMotion(kind, x, sine, cosine, s * x)
        poses.append(form(motion, rng))
    J, T = _run(algorithm, chain, poses, with_pose)
    if chain.nontrivial_coupling is None:
        return _count(graph, angles, T, J)
    J_q = empty_rows(chain.dof)
    columns.coupled(J, C, len(C), chain.dof, J_q)
    return _count(graph, angles, T, J_q)


def exponential(motion: JointMotion, rng: np.random.Generator) -> Row:
    """e^{A x} of a general screw: 15 multiplications and 13 additions of a revolute joint."""
    A = generic_screw(motion.kind, rng)
    omega = A[:3]
    v = A[3:]
    return joint(omega, v, motion.x, motion.sine, motion.cosine)


def general_link(motion: JointMotion, rng: np.random.Generator) -> Row:
    """M e^{S x} in link frames that are attached anywhere."""
    return compose(generic_pose(rng), exponential(motion, rng))


def z_link(motion: JointMotion, rng: np.random.Generator) -> Row:
    """M e^{S x} in z-aligned link frames: 12 multiplications and 6 additions of a revolute joint."""
    M = generic_pose(rng)
    return turned_about_z(M, motion.sine, motion.cosine, motion.shift)


def paul_link(motion: JointMotion, rng: np.random.Generator) -> Row:
    """Rz(theta) Tz(d) Tx(a) Rx(alpha), the joint before its link."""
    d, a, alpha, theta = generic(rng, 4).tolist()
    turn = motion.sine, motion.cosine
    if motion.kind == "prismatic":
        turn = _sine_cosine(theta)
    twist = _sine_cosine(alpha)
    return dh.link(*turn, d + motion.shift, a, *twist)


def craig_link(motion: JointMotion, rng: np.random.Generator) -> Row:
    """Tx(a) Rx(alpha) Rz(theta) Tz(d), the joint behind its link."""
    d, a, alpha, theta = generic(rng, 4).tolist()
    fixed = 0.0
    if motion.kind == "prismatic":
        fixed = theta
    twist = _sine_cosine(alpha)
    link = dh.link(0.0, 1.0, 0.0, a, *twist)
    behind = turned_about_z(link, *_sine_cosine(fixed), d)
    return turned_about_z(behind, motion.sine, motion.cosine, motion.shift)


def generic_structure(chain: Chain, tool: bool) -> Structure:
    """A chain of the same joints with general alpha, a and d, as the structured formulas take it.

    Base and tip are the frames of the first and last joint, but for a tool.
    """
    n = len(chain.kinds)
    rng = generator()
    first = (0.0, 1.0, 0.0, 0.0)
    between = generic(rng, n - 1, 2).tolist()
    links = [(*_sine_cosine(alpha), a, 0.0) for a, alpha in between]
    d_offsets = generic(rng, n).tolist()
    base = IDENTITY
    end = IDENTITY
    if tool:
        base = generic_pose(rng)
        end = generic_pose(rng)
    return Structure(
        links=(first, *links),
        d_offsets=tuple(d_offsets),
        parallel=(0,) * n,
        rotates=tuple(chain.local.rotates.tolist()),
        slides=tuple(chain.local.slides.tolist()),
        coupling=tuple(map(tuple, chain.coupling.tolist())),
        shift=tuple(chain.offset.tolist()),
        offsets=(0.0,) * n,
        quarters=(0,) * n,
        base=base,
        tool=end,
        frames=(IDENTITY,) * n,
        coordinates=chain.dof,
    )


def generator() -> np.random.Generator:
    """A source of generic numbers, which are the same at every call."""
    return np.random.default_rng(0)


def generic(rng: np.random.Generator, *shape: int) -> Array:
    """Numbers (...) that are neither 0 nor 1 nor like another."""
    return rng.uniform(0.2, 0.9, shape)


def generic_pose(rng: np.random.Generator) -> tuple[float, ...]:
    """A pose without any structure."""
    T = se3.exp(generic(rng, 6))
    R = T[:3, :3].ravel()
    return (*R.tolist(), *T[:3, 3].tolist())


def generic_screw(kind: str, rng: np.random.Generator) -> Row:
    """A joint's screw without any structure but its kind's: a prismatic joint's omega is zero."""
    axis, point = generic(rng, 2, 3)
    if kind == "prismatic":
        way = screw.prismatic(axis)[3:]
        return (0, 0, 0, *way.tolist())
    if kind == "helical":
        return tuple(screw.helical(axis, point, 0.1).tolist())
    return tuple(screw.revolute(axis, point).tolist())


def structure(chain: Chain) -> tuple[Sequence[float], Sequence[float]]:
    """r and s of the joints, 0 and 1 as integers."""
    rotates = list(map(_plain, chain.local.rotates.tolist()))
    slides = list(map(_plain, chain.local.slides.tolist()))
    return rotates, slides


def _plain(x: float) -> float:
    """A number, 0 and 1 as integers."""
    if x in (0.0, 1.0):
        return int(x)
    return x


def _sine_cosine(angle: float) -> tuple[float, float]:
    return math.sin(angle), math.cos(angle)


def _run(
    algorithm: Algorithm,
    chain: Chain,
    poses: Sequence[Row],
    with_pose: bool,
) -> tuple[Rows, Row]:
    """J and the pose, which is empty where it is not asked for."""
    rng = generator()
    screws = [generic_screw(kind, rng) for kind in chain.kinds]
    tool = generic_pose(rng)
    rotates, slides = structure(chain)
    links = Links(len(poses), rotates, slides, screws, poses, tool)
    J, finish = algorithm(links)
    if not with_pose:
        return J, ()
    return J, finish()


def _count(
    graph: Graph,
    angles: Angles,
    T: Row,
    J: Rows,
) -> Count:
    entries = (x for row in J for x in row)
    return program(graph, angles, [*T, *entries]).count
