"""The bounds that are hunted: cases, and the test's own function that measures error ÷ bound.

One case holds many draws where the test's arithmetic is that of arrays; drawing by Hypothesis takes
milliseconds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from hypothesis import reject
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError
from poekin.formats.dh import to_chain
from poekin.formats.dh.from_chain import FromChain, from_chain
from poekin.groups import se3
from poekin.model import screw
from poekin.model.robot import Robot
from poekin.testing.strategies import chain_strategies, dh_strategies
from poekin.testing.strategies.decoding import decoders
from poekin.testing.strategies.decoding.bytes_reader import BytesReader
from poekin.testing.strategies.group_strategies import pose
from tests.engine.straight_line import test_interpret
from tests.formats import dh_product, test_dh, test_rpy, test_urdf_text
from tests.formats.relink import test_relinked
from tests.model import test_chain, test_idealised, test_joint, test_robot, test_screw
from tests.model.geometry import test_hp
from tests.model.kinematics import test_analytic, test_compiled
from tests.solve import test_motions
from tests.solve.calibration.model import test_parameters

Cases = st.SearchStrategy[tuple[Any, ...]]
NUMBERS = st.integers(0, 2**64 - 1)
ROWS = 1000


class Bound(NamedTuple):
    """Cases, and error ÷ bound of each draw that one of them holds."""

    cases: Cases
    ratios: Callable[..., Any]


def configurations(chain: Any, number: int, rows: int) -> np.ndarray:
    """As `chain_strategies.coordinates` draws them, (rows, m): one in four a quarter turn or 0, the
    others up to ±π.
    """
    rng = np.random.default_rng(number)
    q = rng.uniform(-np.pi, np.pi, (rows, chain.dof))
    return np.where(rng.random(q.shape) < 0.25, rng.choice(chain_strategies.QUARTERS, q.shape), q)


def with_frames(chain: Any) -> Cases:
    return st.tuples(
        st.just(chain), st.sampled_from([*test_compiled.NAMED, *range(len(chain.kinds))]), NUMBERS
    )


@st.composite
def with_parameters(draw: st.DrawFn) -> tuple[Any, ...]:
    chain = draw(chain_strategies.chains(min_joints=1, max_joints=5))
    kinds = draw(st.lists(st.sampled_from(test_parameters.KINDS), min_size=1, unique=True))
    try:
        arm = test_parameters.ErrorModel(chain, kinds, None)
    except InputError:
        reject()
    rng = np.random.default_rng(draw(NUMBERS))
    return arm, 0.05 * rng.normal(size=len(arm.parameters)), rng.uniform(-2, 2, (50, chain.dof))


PARAMETERS = with_parameters()


def each(
    size: int, decode: Callable[[BytesReader], tuple[Any, ...]], ratio: Callable[..., float]
) -> Bound:
    """A bound of cases that are read off `size` random bytes each, five hundred at a time."""

    def ratios(number: int) -> list[float]:
        rng = np.random.default_rng(number)
        return [ratio(*decode(BytesReader(rng.bytes(size)))) for _ in range(500)]

    return Bound(st.tuples(NUMBERS), ratios)


def axis(r: BytesReader) -> np.ndarray:
    """A vector of any direction and length, from where floats end; never 0."""
    return decoders.axis(r) * 10.0 ** r.fraction(
        *r.pick([(-3.0, 3.0), (-300.0, -290.0), (-3.0, 150.0)])
    )


def point(r: BytesReader) -> np.ndarray:
    return decoders.vector(r, (1e-12, 1e5))


def pitch(r: BytesReader) -> float:
    return r.pick([0.0, 1.0, -1.0]) * r.magnitude(1e-6, 10.0)


def pairs(number: int) -> tuple[np.ndarray, np.ndarray]:
    """Two poses each, the turn from one to the other near 0, near half a turn, or any; 1e-6 to 1e3
    m.
    """
    rng = np.random.default_rng(number)

    def some() -> np.ndarray:
        w, places = rng.normal(size=(2, ROWS, 3))
        small, kind = 10.0 ** rng.uniform(-16, 0, ROWS), rng.integers(0, 3, ROWS)
        angles = np.choose(kind, [small, np.pi - small, rng.uniform(0, np.pi, ROWS)])
        lengths = 10.0 ** rng.uniform(-6, 3, (ROWS, 1))
        return se3.exp(
            np.hstack([w * (angles / np.linalg.norm(w, axis=1))[:, None], places * lengths])
        )

    first, turn = some(), some()
    return first, np.where(rng.random((ROWS, 1, 1)) < 0.5, some(), first @ turn)


def three_turns(number: int) -> np.ndarray:
    """Roll, ±1, π/2 less |pitch| and yaw (n, 4), from the lock on, half of them with roll and yaw of
    more than 2, which are rounded to most.
    """
    rng = np.random.default_rng(number)
    outer = rng.uniform(-np.pi, np.pi, (2, ROWS))
    wide = np.copysign(rng.uniform(2, np.pi, (2, ROWS)), outer)
    roll, yaw = np.where(rng.random(ROWS) < 0.5, outer, wide)
    off = rng.uniform(-2, 2, ROWS) * 10.0 ** -rng.uniform(0, 18, ROWS)
    return np.stack([roll, rng.choice([-1, 1], ROWS), off, yaw], axis=1)


def parts(number: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
    """A part of a path, and how much further it goes."""
    rng = np.random.default_rng(number)
    return rng.uniform(0, 1, rows), rng.uniform(0.01, 0.5, rows)


def share(result: FromChain) -> float:
    return result.error / result.bound


def placed(r: BytesReader, lengths: tuple[float, float] = chain_strategies.REACHES) -> np.ndarray:
    return pose(decoders.rotation(r), decoders.vector(r, lengths))


def turns(r: BytesReader, count: int) -> np.ndarray:
    """Values of coordinates, as `chain_strategies.coordinates` draws them."""
    return np.array(
        [
            r.pick(chain_strategies.QUARTERS) if r.byte() < 64 else r.fraction(-np.pi, np.pi)
            for _ in range(count)
        ]
    )


def redrawn(chain: pk.Chain, r: BytesReader) -> pk.Chain:
    """A chain of the same joints and couplings whose screws and home pose are others."""

    def made(kind: str) -> np.ndarray:
        w, p = decoders.axis(r), decoders.vector(r, chain_strategies.REACHES)
        if kind == "prismatic":
            return screw.prismatic(w)
        return (
            screw.helical(w, p, r.pick([0.1, 1e-3, -0.5]))
            if kind == "helical"
            else screw.revolute(w, p)
        )

    A = [made(kind) for kind in chain.kinds]
    return pk.Chain.from_space(
        np.reshape(A, (-1, 6)), placed(r), coupling=chain.coupling, offset=chain.offset, joint_names=chain.joint_names,
        q_names=chain.q_names,
    )  # fmt: skip


def each_of(chains: st.SearchStrategy[pk.Chain], ratio: Callable[..., float]) -> Bound:
    """A bound of chains: each that Hypothesis draws, and two hundred with its joints' kinds and
    couplings.
    """

    def ratios(chain: pk.Chain, number: int) -> list[float]:
        rng = np.random.default_rng(number)
        readers = [BytesReader(rng.bytes(1000)) for _ in range(200)]
        return [ratio(chain, readers[0]), *(ratio(redrawn(chain, r), r) for r in readers)]

    return Bound(st.tuples(chains, NUMBERS), ratios)


def relinkings(case: tuple[Robot, pk.Chain], number: int) -> Iterator[tuple[Robot, pk.Chain]]:
    """A robot and a chain for its branch, and fifty of the same joints that stand elsewhere."""
    yield case
    robot, chain = case
    rng = np.random.default_rng(number)
    for _ in range(50):
        r = BytesReader(rng.bytes(1000))
        joints = [replace(joint, origin=placed(r), axis=decoders.axis(r)) for joint in robot.joints]
        yield Robot(robot.name, robot.links, joints), redrawn(chain, r)


PAIRS = NUMBERS.map(pairs)
FOUR = chain_strategies.chains(min_joints=1, max_joints=4)
BOUNDS = {
    "roll, pitch, yaw": Bound(st.tuples(NUMBERS.map(three_turns)), test_rpy.angles_off),
    "machine code": Bound(
        chain_strategies.chains(min_joints=1, max_joints=6).flatmap(with_frames),
        lambda chain, frame, n: test_compiled.apart(
            chain, configurations(chain, n, 2000), (frame,), alone=False
        ),
    ),
    "program": Bound(
        chain_strategies.chains(max_joints=7).flatmap(with_frames),
        lambda chain, frame, n: test_interpret.apart(chain, frame, configurations(chain, n, 200)),
    ),
    "link poses": Bound(
        st.tuples(test_robot.robots(), NUMBERS),
        lambda robot, n: test_robot.link_errors(robot, robot, n, 500),
    ),
    "chains between links": Bound(
        st.tuples(test_robot.robots(max_joints=5), NUMBERS),
        lambda robot, n: test_robot.chain_errors(robot, robot, n, 500),
    ),
    "directions and steps": Bound(
        st.tuples(test_hp.REVOLUTE, NUMBERS),
        lambda chain, n: test_hp.excess(chain, chain.to_hp(), configurations(chain, n, 500)),
    ),
    "idealised geometry": Bound(
        st.tuples(chain_strategies.chains(), st.sampled_from([1e-9, 1e-5, 1e-3, 0.05]), NUMBERS),
        lambda chain, tol, n: test_idealised.shares(
            chain, chain.idealised(tol), chain.random(n, 500)
        ),
    ),
    "relinked branch": Bound(
        st.tuples(test_relinked.cases(), NUMBERS),
        lambda case, n: test_relinked.off(case, n, rows=500),
    ),
    "relinked frames": Bound(
        st.tuples(test_relinked.cases(), NUMBERS),
        lambda case, n: np.concatenate(
            [test_relinked.frames_off(one) for one in relinkings(case, n)]
        ),
    ),
    "maps of rates": Bound(
        st.tuples(chain_strategies.chains(max_joints=6), NUMBERS),
        lambda chain, n: test_analytic.maps_off(chain, configurations(chain, n, 500)),
    ),
    "numbers of a pose": Bound(
        st.tuples(chain_strategies.chains(max_joints=6), NUMBERS),
        lambda chain, n: test_analytic.numbers_off(chain, configurations(chain, n, 500)),
    ),
    "parameters' slopes": Bound(
        PARAMETERS, lambda arm, p, q: test_parameters.slopes_off(arm, p, q, np.arange(len(p)))
    ),
    "parameters' chain": Bound(PARAMETERS, test_parameters.chain_off),
    "robot out of its text": Bound(
        st.tuples(test_urdf_text.limited(), NUMBERS),
        lambda robot, n: test_urdf_text.text_off(robot, test_urdf_text.again(robot), n, 200),
    ),
    "chain in its text": Bound(
        st.tuples(test_urdf_text.scaled_chains(), NUMBERS),
        lambda chain, n: test_urdf_text.pinocchio_off(chain, n, 500),
    ),
    "table's screws": Bound(
        st.tuples(dh_strategies.tables(), NUMBERS),
        lambda table, n: test_dh.screws_off(table, n, (1000,), dh_product.LONG),
    ),
    "chain's table": each_of(
        chain_strategies.chains(joint_kinds=("revolute", "prismatic")),
        lambda chain, r: share(from_chain(chain, convention=r.pick(dh_strategies.CONVENTIONS))),
    ),
    "table of a table's chain": Bound(
        st.tuples(dh_strategies.tables().map(to_chain), test_dh.CONVENTIONS),
        lambda chain, convention: share(from_chain(chain, convention=convention)),
    ),
    "rebased screws": each_of(
        FOUR, lambda chain, r: test_chain.rebased_off(chain, placed(r, (1e-3, 1e6)))
    ),
    "rezeroed screws": each_of(
        FOUR,
        lambda chain, r: test_chain.rezeroed_off(
            chain, turns(r, chain.dof) * 10.0 ** r.fraction(-1.0, 4.0)
        ),
    ),
    "screw of an axis": each(60, lambda r: (axis(r), point(r), pitch(r)), test_screw.made_off),
    "axis of a screw": each(60, lambda r: (axis(r), point(r), pitch(r)), test_screw.read_off),
    "point on an axis": each(
        60, lambda r: (axis(r), point(r), r.fraction(-7.0, 7.0)), test_screw.moved_off
    ),
    "joint's axis": each(40, lambda r: (axis(r).tolist(),), test_joint.axis_off),
    "path's end": Bound(
        st.tuples(st.sampled_from(test_motions.PATHS), PAIRS),
        lambda f, T: test_motions.end_off(f, T[0], T[1]),
    ),
    "screw motion's twist": Bound(
        st.tuples(PAIRS, NUMBERS), lambda T, n: test_motions.twist_off(T[0], T[1], *parts(n, ROWS))
    ),
    "straight line": Bound(
        st.tuples(PAIRS, NUMBERS), lambda T, n: test_motions.line_off(T[0], T[1], parts(n, ROWS)[0])
    ),
}
