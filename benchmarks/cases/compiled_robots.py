"""Compiled kernels on every chain of the real robots, against Pinocchio: pose and Jacobians in
three frames.
"""

from __future__ import annotations

import time
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from poekin import Chain, load
from poekin.analysis.validate import BAR, ChainErrors, chain_errors, routes
from poekin.errors import PoekinWarning
from poekin.formats.erd import example_robots
from poekin.model.kinematics.pose_jacobian import Frame
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle

from ..draw import dots
from ..report import Figure, Table, Topic, short
from ..workers import workers

SAMPLES = 20


class Compiled:
    """What `chain_errors` asks of a chain, by the code compiled for it."""

    def __init__(self, chain: Chain):
        self.arm = chain.compile()
        self.base, self.tip, self.reach = chain.base, chain.tip, chain.reach
        self.joint_names, self.q_names, self.dof = chain.joint_names, chain.q_names, chain.dof

    def fk(self, q: np.ndarray) -> np.ndarray:
        """The pose that comes with the hybrid Jacobian."""
        return self.arm.fk_jacobian(q, "hybrid")[0]

    def jacobian(self, q: np.ndarray, frame: Frame) -> np.ndarray:
        """The Jacobian that comes with a pose."""
        return self.arm.fk_jacobian(q, frame)[1]


@dataclass(frozen=True)
class Way:
    """One chain of a robot, what came of it, and the processor seconds until its code was there."""

    robot: str
    errors: ChainErrors
    compiling: float


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    robots = list(example_robots()[0].items())[:: 6 if quick else 1]
    ways: list[Way] = []
    start = time.perf_counter()
    # Most of the time is LLVM's, which holds the interpreter's lock: so processes, each with some
    # of the robots.
    with workers() as share:
        for number, found in enumerate(share(ways_of, robots), 1):
            ways += found
            if number % 10 == 0:
                say(f"{number} of {len(robots)} robots")
    seconds, compiling = time.perf_counter() - start, sum(way.compiling for way in ways)
    worst = max(ways, key=lambda way: way.errors.worst)
    still = sum(way.errors.joints == 0 for way in ways)
    return Topic(
        "Compiled kernels on every chain of example-robot-data, against Pinocchio",
        f"{len(ways)} chains of {len(robots)} robots, from the root to each leaf. Each is compiled for pose and "
        "Jacobian in three frames, and compared with Pinocchio at the zero configuration and at "
        f"{SAMPLES} random ones (revolute over ±π, prismatic over ±1 m). Lengths are divided by the chain's reach R.",
        figures=[
            Figure(
                f"compiled kernels on every chain of {len(robots)} robots: pose and J (space, body, hybrid) against "
                "Pinocchio, worst", worst.errors.worst, BAR, "R",
                note=f"{len(ways)} chains, {still} of them without a moving joint; worst: {worst.robot}, "
                f"{worst.errors.base} → {worst.errors.tip}; {short(seconds)} s in all; {short(compiling)} s of "
                "processor time went into compiling, or fetching what the cache had",
            )
        ],
        pictures=[
            dots(
                "Compiled kernels: worst error of each chain ÷ R (pose and three Jacobians), in ascending order; exact "
                "at the lower edge",
                [way.errors.worst for way in ways], BAR, x_label="chain", y_label="error ÷ R",
            )
        ],
        tables=[
            Table(
                "Robots, compiled",
                ("robot", "chains", "longest (joints)", "pose ÷ R", "J space ÷ R", "J body ÷ R", "J hybrid ÷ R"),
                [_row(name, [way.errors for way in ways if way.robot == name]) for name, _ in robots], folded=True,
            )
        ],
    )  # fmt: skip


def ways_of(robot: tuple[str, str]) -> list[Way]:
    """All chains of a robot: (its name, the file of its URDF)."""
    name, path = robot
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        model = load(path)
    with open(path, "rb") as stream:
        oracle = PinocchioOracle(stream.read())
    q = oracle.random(np.random.default_rng(0), SAMPLES + 1)
    for values in q.values():
        values[0] = 0.0
    ways = []
    for base, tip, note in routes(model):
        start = time.process_time()
        arm: Any = Compiled(model.chain(base=base, tip=tip))
        for frame in ("space", "body", "hybrid"):
            arm.jacobian(np.zeros(arm.dof), frame)
        compiling = time.process_time() - start
        ways.append(Way(name, chain_errors(arm, oracle, q, note=note), compiling))
    return ways


def _row(name: str, rows: list[ChainErrors]) -> tuple[str | int | float, ...]:
    errors = (
        max(getattr(row, what) for row in rows) for what in ("pose", "space", "body", "hybrid")
    )
    return (name, len(rows), max(row.joints for row in rows), *errors)
