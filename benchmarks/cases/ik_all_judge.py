"""What judges sets of solutions: their poses by `fk`, EAIK's sets, and the solutions of a search."""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from typing import Any

import numpy as np

import poekin as pk
from poekin.model.chain import Chain
from poekin.solve.ik_all.all_solutions import AllSolutions

from ..report import Figure, Topic

# Two solvers' ends of one solution: poses 1e-10 off make 1e-4 rad where the arm is singular within
# 1e-6.
SAME = 1e-4
# EAIK's own solutions are nearer to their target than this [m and rad], its least squares ones are
# not.
ITS_OWN = 1e-6
CALIBRATED = "UR10e, calibrated"


def absent(title: str, what: str) -> Topic | None:
    """The page of a topic whose judge, EAIK, is not installed, so that this is not measured; None
    where it is.
    """
    if importlib.util.find_spec("eaik") is not None:
        return None
    missing = Figure(what, None, note="EAIK is not installed", holds=False)
    return Topic(title, "EAIK is the judge of this topic.", figures=[missing])


def apart(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The largest difference of angles between each configuration of a and each of b, by the
    shorter way round.
    """
    return np.abs((a[:, None] - b[None] + np.pi) % (2 * np.pi) - np.pi).max(axis=-1)


def equal(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether each configuration of a is one of b, each of b one of a, and there are as many of
    them.
    """
    if not len(a) or len(a) != len(b):
        return len(a) == len(b)
    near = apart(a, b) <= SAME
    return bool(near.any(axis=0).all() and near.any(axis=1).all())


def missed(every: AllSolutions, others: AllSolutions) -> np.ndarray:
    """How many of the others are none of these, of each target."""
    return np.array(
        [
            len(b) - int((apart(a, b) <= SAME).any(axis=0).sum())
            for a, b in zip(every.solutions, others.solutions, strict=True)
        ]
    )


def errors(chain: Chain, q: np.ndarray, counts: np.ndarray, T: np.ndarray) -> tuple[float, float]:
    """The largest distance (m) and angle (rad) between solutions' poses, by `fk`, and their
    targets.
    """
    ours, wanted = chain.fk(q), np.repeat(T, counts, axis=0)
    turn = pk.so3.log(np.swapaxes(ours[:, :3, :3], 1, 2) @ wanted[:, :3, :3])
    return (
        float(np.linalg.norm((ours - wanted)[:, :3, 3], axis=1).max()),
        float(np.linalg.norm(turn, axis=1).max()),
    )


class Eaik:
    """EAIK's robot of a chain, and its two ways to solve it."""

    def __init__(self, chain: Chain):
        from eaik.IK_HP import HPRobot

        self._chain = chain
        self._form = chain.to_hp()
        self._robot = HPRobot(self._form.H, self._form.P)

    @property
    def solves(self) -> bool:
        """Whether it has a decomposition of this arm."""
        return bool(self._robot.hasKnownDecomposition())

    def targets(self, T: np.ndarray) -> list[np.ndarray]:
        """The targets in its own frame of the tip."""
        own = T.copy()
        own[:, :3, :3] = T[:, :3, :3] @ self._form.R_nt.T
        return list(own)

    def each(self, targets: Sequence[np.ndarray]) -> list[Any]:
        """Its answers by one call a target."""
        return [self._robot.IK(target) for target in targets]

    def batch(self, targets: Sequence[np.ndarray], workers: int) -> list[Any]:
        """Its answers by its batch, of so many threads."""
        return self._robot.IK_batched(targets, workers)

    def own(self, answers: Sequence[Any], T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Solutions (K, n) that are no least-squares ones, each once, and how many of each target."""
        sets = []
        for answer, target in zip(answers, T, strict=True):
            Q = np.asarray(answer.Q, float).reshape(-1, self._chain.dof)
            Q = Q[np.abs(self._chain.fk(Q) - target).max(axis=(1, 2)) <= ITS_OWN]
            sets.append(Q[[not (apart(Q[:k], Q[k : k + 1]) <= SAME).any() for k in range(len(Q))]])
        return np.concatenate(sets), np.array([len(Q) for Q in sets])
