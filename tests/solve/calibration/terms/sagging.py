"""Simulated arms whose joints yield to gravity, and their measurements."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

import poekin as pk
from poekin.solve.calibration import Parameter, Points, Term
from poekin.solve.calibration.terms.gravity import levers, wrist

ARMS = {
    "ur5": {}, "panda": {"tip": "panda_hand"}, "puma560": {}, "irb140": {}, "kr5": {}, "iiwa14": {},
}  # fmt: skip
POINT = np.array([0.05, 0.03, 0.1])
NOISE = 5e-5


class Case(NamedTuple):
    """Readings and measured points, and fresh ones with the truth of them, m."""

    q: np.ndarray
    points: Points
    fresh: np.ndarray
    truth: np.ndarray

    def error(self, found):
        """Root mean square error of the calibrated arm on the fresh poses, m."""
        p = at_point(found.chain, found.true_joints(self.fresh))
        return np.sqrt(np.mean(np.sum((p - self.truth) ** 2, axis=1)))


def arm(name):
    return pk.load(name).chain(**ARMS[name])


def at_point(chain, q):
    return chain.fk(q)[:, :3] @ [*POINT, 1.0]


def lever(chain, q):
    """Levers of a weight at the wrist."""
    point = chain.home[:3, :3].T @ (wrist(chain) - chain.home[:3, 3])
    return levers(chain, q, np.tile([0.0, 0.0, -1.0], (len(q), 1)), point)


def loaded(chain):
    """The two joints that carry most."""
    squares = np.mean(lever(chain, chain.random(0, 200)) ** 2, axis=0)
    return np.sort(np.argsort(-squares)[:2])


def sagged(chain, q, size):
    """True joint values where the two joints yield, the second to 0.7 of the first."""
    added = np.zeros_like(q)
    for joint, part in zip(loaded(chain), (1.0, 0.7), strict=True):
        added[:, joint] = size * part * lever(chain, q)[:, joint]
    return q + added


def true_term(chain):
    """The two stiffnesses, and nothing else."""
    joints = loaded(chain)

    def basis(q, conditions):
        B = np.zeros((*q.shape, 2))
        B[:, joints, [0, 1]] = lever(chain, q)[:, joints]
        return B

    return Term("true", tuple(Parameter(chain.q_names[i], "sag", "rad/m") for i in joints), basis)


def case(chain, seed, sag=0.0, count=60):
    """Measured points of an arm with other axes, whose tool sags by so much, m rms."""
    rng = np.random.default_rng([seed, 7])
    true = pk.calibration.simulated(chain, 1, seed=seed).truth
    size = 0.0
    if sag:
        everywhere = chain.random(0, 500)
        small = 1e-6
        off = at_point(true, sagged(chain, everywhere, small)) - at_point(true, everywhere)
        size = small * sag / np.sqrt(np.mean(np.sum(off**2, axis=1)))
    q = chain.random(rng, count)
    p = at_point(true, sagged(chain, q, size)) + rng.normal(scale=NOISE, size=(count, 3))
    fresh = chain.random(rng, 300)
    return Case(q, Points(p, POINT), fresh, at_point(true, sagged(chain, fresh, size)))
