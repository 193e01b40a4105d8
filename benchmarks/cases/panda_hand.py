"""Pose and hybrid Jacobian of the Panda's hand, fingers locked: poekin against Pinocchio's Python."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from poekin import load
from poekin.testing.oracles.pinocchio_oracle import ANGULAR_FIRST, pinocchio

from .. import exact_arm
from ..harness import Case, Comparison, compare
from ..report import Figure, Table, Topic, short

CONFIGURATIONS, CALLS, JUDGED = 20_000, 200, 50

Arrays = tuple[np.ndarray, np.ndarray]


class _Peer:
    """Pinocchio's model of the same arm, and the two usual ways to the two arrays (4×4 and 6×7),
    called for each q.
    """

    def __init__(self, text: str):
        pin = self.pin = pinocchio()
        full = pin.buildModelFromXML(text)
        fingers = [i for i, name in enumerate(full.names) if "finger" in name]
        self.model = pin.buildReducedModel(full, fingers, pin.neutral(full))
        self.data = self.model.createData()
        self.hand = self.model.getFrameId("panda_hand", pin.FrameType.BODY)

    def by_frame(self, configurations: list[np.ndarray]) -> Iterator[Arrays]:
        pin, model, data, hand, axes = (
            self.pin,
            self.model,
            self.data,
            self.hand,
            self.pin.LOCAL_WORLD_ALIGNED,
        )
        for q in configurations:
            pin.forwardKinematics(model, data, q)
            T = pin.updateFramePlacement(model, data, hand).homogeneous
            yield T, pin.computeFrameJacobian(model, data, q, hand, axes)

    def by_joints(self, configurations: list[np.ndarray]) -> Iterator[Arrays]:
        pin, model, data, hand, axes = (
            self.pin,
            self.model,
            self.data,
            self.hand,
            self.pin.LOCAL_WORLD_ALIGNED,
        )
        for q in configurations:
            pin.computeJointJacobians(model, data, q)
            T = pin.updateFramePlacement(model, data, hand).homogeneous
            yield T, pin.getFrameJacobian(model, data, hand, axes)


def _last(results: Iterator[Arrays]) -> Arrays:
    """All of them are computed, one call after the other, and the last one is kept."""
    return deque(results, maxlen=1)[0]


def _stacked(results: Iterator[Arrays], dof: int) -> Arrays:
    poses, columns = np.empty((CONFIGURATIONS, 4, 4)), np.empty((CONFIGURATIONS, 6, dof))
    for k, (T, J) in enumerate(results):
        poses[k], columns[k] = T, J
    return poses, columns


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    robot = load("erd:panda")
    arm = robot.chain(tip="panda_hand")
    with open(str(robot.source), encoding="utf-8") as stream:
        text = stream.read()
    peer = _Peer(text)
    many = np.random.default_rng(0).uniform(-np.pi, np.pi, (CONFIGURATIONS, arm.dof))
    each = [q.copy() for q in many]
    few = each[:CALLS]
    out = np.empty((4, 4)), np.empty((6, arm.dof))
    poses, columns = exact_arm.hybrid(text, "panda_hand", [*many[:JUDGED], few[-1], each[-1]])
    exact_last = poses[-1], columns[-1]
    poses, columns = poses[:-1], columns[:-1]

    def calls(configurations: list[np.ndarray]) -> Iterator[Arrays]:
        for q in configurations:
            yield arm.fk_jacobian(q, "hybrid")

    def reusing_calls(configurations: list[np.ndarray]) -> Iterator[Arrays]:
        for q in configurations:
            yield arm.fk_jacobian(q, "hybrid", out=out)

    def error_of_one(state: Any, result: Arrays) -> float:
        return _error(result[0], result[1], poses[-1], columns[-1], arm.reach)

    def error_of_last(state: Any, result: Arrays) -> float:
        return _error(result[0], result[1], *exact_last, arm.reach)

    def error_of_many(state: Any, result: Arrays) -> float:
        return _error(result[0][:JUDGED], result[1][:JUDGED], poses[:-1], columns[:-1], arm.reach)

    def angular_first(error: Callable[[Any, Arrays], float]) -> Callable[[Any, Arrays], float]:
        return lambda state, result: error(state, (result[0], result[1][..., ANGULAR_FIRST, :]))

    peer_error = angular_first(error_of_one)
    ways = [
        Case(
            "forwardKinematics, computeFrameJacobian",
            lambda: few,
            lambda q: _last(peer.by_frame(q)),
            peer_error,
        ),
        Case(
            "computeJointJacobians, getFrameJacobian",
            lambda: few,
            lambda q: _last(peer.by_joints(q)),
            peer_error,
        ),
    ]
    pairs = 11 if quick else 41
    between = compare(*ways, pairs=pairs)
    way_ratio = between.ratio.median
    faster = 0 if way_ratio < 1 else 1
    way = (peer.by_frame, peer.by_joints)[faster]
    say(f"Pinocchio's faster way is {ways[faster].name}")

    own = Case("poekin", lambda: few, lambda q: _last(calls(q)), error_of_one)
    reusing = Case("poekin, out=", lambda: few, lambda q: _last(reusing_calls(q)), error_of_one)
    batch = Case(
        "poekin, batch", lambda: many, lambda q: arm.fk_jacobian(q, "hybrid"), error_of_many
    )
    loop = Case(
        "Pinocchio", lambda: each, lambda q: _stacked(way(q), arm.dof), angular_first(error_of_many)
    )
    unkept = Case(
        "Pinocchio, nothing kept",
        lambda: each,
        lambda q: _last(way(q)),
        angular_first(error_of_last),
    )
    single = compare(own, ways[faster], pairs=pairs)
    say("one call")
    reused = compare(reusing, ways[faster], pairs=pairs)
    batched = compare(batch, loop, pairs=5 if quick else 15)
    unstored = compare(batch, unkept, pairs=5 if quick else 15)
    say(f"{CONFIGURATIONS} configurations")
    return Topic(
        "Pose and hybrid Jacobian of the Panda's hand, fingers locked",
        "Both yield the same two arrays, 4×4 and 6×7, from Python. Pinocchio takes the faster of its two usual ways, "
        f"found in this run: {ways[faster].name} (the other takes {short(max(way_ratio, 1 / way_ratio))} times as "
        f"long). One call means {CALLS} calls in a row, each at another q. Runs alternate; the ratio is the median "
        "over pairs. Time is the processor's, over all threads of the process, so that other processes do not disturb "
        "it. The error is the largest entry that differs from what 60 digits make of the URDF's text, lengths ÷ R.",
        figures=[
            _figure(
                "Panda's pose + hybrid Jacobian, one call from Python ÷ Pinocchio's Python",
                single,
                0.8,
                "0.8",
            ),
            _figure("the same, into arrays of the caller (out=)", reused),
            _figure(
                f"the same, {CONFIGURATIONS} configurations in one thread ÷ Pinocchio's Python loop "
                "that stores its results, as poekin's batch does",
                batched,
                1 / 6,
                "1/6",
            ),
            _figure(
                f"the same, {CONFIGURATIONS} configurations ÷ Pinocchio's Python loop that keeps none",
                unstored,
            ),
        ],
        tables=[
            Table(
                "Time of each",
                ("what", "time (µs a configuration)", "lower quartile", "upper quartile", "error"),
                [
                    _times("poekin, one call", single.first, single.first_error, CALLS),
                    _times("poekin, one call, out=", reused.first, reused.first_error, CALLS),
                    _times(
                        f"Pinocchio, one call: {ways[0].name}",
                        between.first,
                        between.first_error,
                        CALLS,
                    ),
                    _times(
                        f"Pinocchio, one call: {ways[1].name}",
                        between.second,
                        between.second_error,
                        CALLS,
                    ),
                    _times(
                        f"poekin, {CONFIGURATIONS} at once",
                        batched.first,
                        batched.first_error,
                        CONFIGURATIONS,
                    ),
                    _times(
                        f"Pinocchio, {CONFIGURATIONS} in a loop, results stored in two arrays",
                        batched.second,
                        batched.second_error,
                        CONFIGURATIONS,
                    ),
                    _times(
                        f"Pinocchio, {CONFIGURATIONS} in a loop, results dropped",
                        unstored.second,
                        unstored.second_error,
                        CONFIGURATIONS,
                    ),
                ],
            )
        ],
    )


def _figure(what: str, c: Comparison, bar: float | None = None, bar_text: str = "") -> Figure:
    error = f"{short(c.first_error)} (Pinocchio {short(c.second_error)})"
    spread = (c.ratio.lower, c.ratio.upper)
    return Figure(
        what,
        c.ratio.median,
        bar,
        spread=spread,
        error=error,
        bar_shown=bar_text and f"≤ {bar_text}",
    )


def _times(what: str, t: Any, error: float, count: int) -> tuple[str | float, ...]:
    return (what, *(1e6 * value / count for value in (t.median, t.lower, t.upper)), error)


def _error(
    T: np.ndarray, J: np.ndarray, T_exact: np.ndarray, J_exact: np.ndarray, reach: float
) -> float:
    """Largest entry of the differences, lengths ÷ reach."""
    pose = np.abs(T - T_exact)[..., :3, :] * np.array([1.0, 1.0, 1.0, 1 / reach])
    columns = np.abs(J - J_exact) * np.array([1.0] * 3 + [1 / reach] * 3)[:, None]
    return float(max(pose.max(), columns.max()))
