"""Inverse kinematics by other libraries, each called as its documentation does; what they return is
judged elsewhere.

- Robotics Toolbox: `ETS.ik_LM`, its C solver: method "chan", 30 iterations, 100 random starts,
  limits on. Its tolerance is of E = ½ |e|²: the default 1e-6 lets an error of 1.4e-3 pass, ½
  (1e-9)² asks for what poekin is asked for.
- Pinocchio: the loop of its example "Inverse kinematics (clik)", with that example's numbers: from
  the neutral configuration, damping 1e-12, step 0.1, at most 1000 steps, no limits, no restart. Its
  eps is 1e-4 there, of |e|.
- EAIK: all solutions in closed form, for the arms whose axes it can use; solved where one of them
  holds the limits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from poekin import Chain
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle, pinocchio

from ..peers import STANDARD, Arm, Peer, find
from ..peers.links import z_aligned
from ..peers.peer import attempt, module
from .inverse_kinematics_judge import TOLERANCE

EQUAL_E = 0.5 * TOLERANCE**2
CLIK_EPS, CLIK_STEP, CLIK_DAMPING, CLIK_STEPS = 1e-4, 0.1, 1e-12, 1000

EAIK = Peer("EAIK", "eaik", "eaik.IK_HP")
TURN, EXACT = 2 * np.pi, 1e-6


@dataclass(frozen=True)
class Solver:
    """A peer's solver of one arm.

    native(T): targets (N, 4, 4) in its own form; run(targets) -> result, what is timed;
    joints(result, T) -> q (N, m), NaN where it found none, and claimed (N).
    """

    label: str
    native: Callable[[np.ndarray], Any]
    run: Callable[[Any], Any]
    joints: Callable[[Any, np.ndarray], tuple[np.ndarray, np.ndarray]]


def robotics_toolbox(chain: Chain, *, tol: float = 1e-6) -> Solver:
    """The C solver. A joint without limits is given one turn, as the library draws its starts
    within limits.
    """
    rtb = module("roboticstoolbox")
    fixed, last = z_aligned(chain)
    sequence = rtb.ETS()
    for (T, turns), (lower, upper) in zip(fixed, chain.limits, strict=True):
        bounds = [lower, upper] if np.isfinite([lower, upper]).all() else [-np.pi, np.pi]
        sequence = (
            sequence * rtb.ET.SE3(T) * (rtb.ET.Rz(qlim=bounds) if turns else rtb.ET.tz(qlim=bounds))
        )
    sequence = sequence * rtb.ET.SE3(last)

    def joints(found: list[Any], _: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.array([one.q for one in found]), np.array([one.success for one in found])

    return Solver(
        "Robotics Toolbox", list, lambda targets: [sequence.ik_LM(T, tol=tol, joint_limits=True) for T in targets],
        joints,
    )  # fmt: skip


def pinocchio_clik(chain: Chain, *, eps: float = CLIK_EPS) -> Solver:
    """The loop, for the frame of the last joint as in the example: what is behind it is taken off
    the target.
    """
    pin, oracle = pinocchio(), PinocchioOracle(Arm(chain).urdf)
    model, data = oracle.model, oracle.data
    last = model.getJointId(chain.joint_names[-1])
    behind = model.frames[model.getFrameId(chain.tip, pin.FrameType.BODY)].placement.inverse()
    neutral, eye = pin.neutral(model), CLIK_DAMPING * np.eye(6)
    places = [model.joints[model.getJointId(name)] for name in chain.q_names]

    def solve(target: Any) -> tuple[np.ndarray, bool]:
        q = neutral.copy()
        for _ in range(CLIK_STEPS):
            pin.forwardKinematics(model, data, q)
            off = data.oMi[last].actInv(target)
            error = pin.log6(off).vector
            if np.linalg.norm(error) < eps:
                return q, True
            J = -pin.Jlog6(off.inverse()) @ pin.computeJointJacobian(model, data, q, last)
            q = pin.integrate(model, q, -CLIK_STEP * J.T @ np.linalg.solve(J @ J.T + eye, error))
        return q, False

    def angles(q: np.ndarray) -> list[float]:
        # A joint without limits is (cos q, sin q) here.
        return [
            float(q[j.idx_q] if j.nq == 1 else np.arctan2(q[j.idx_q + 1], q[j.idx_q]))
            for j in places
        ]

    def joints(found: list[Any], _: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.array([angles(q) for q, _ in found]), np.array([ended for _, ended in found])

    return Solver(
        "Pinocchio", lambda targets: [pin.SE3(T) * behind for T in targets], lambda targets: [*map(solve, targets)],
        joints,
    )  # fmt: skip


class ClosedForm:
    """EAIK's solver of one arm. Raises ValueError where it knows no decomposition of its axes."""

    def __init__(self, chain: Chain):
        if chain.dof != 6 or set(chain.kinds) != {"revolute"}:
            raise ValueError("no closed form: six revolute joints expected")
        hp = chain.to_hp()
        self.chain, self._R_tn = chain, hp.R_nt.T
        self._solver = module("eaik.IK_HP").HPRobot(hp.H, hp.P)
        family = self._solver.getKinematicFamily()
        if not self._solver.hasKnownDecomposition() or "unknown" in family.lower():
            raise ValueError(f"no closed form: {family}")

    def native(self, T: np.ndarray) -> list[np.ndarray]:
        """Targets as EAIK takes them: of the tool before its last, constant rotation."""
        T = T.copy()
        T[:, :3, :3] = T[:, :3, :3] @ self._R_tn
        return list(T)

    def all_of(self, target: np.ndarray) -> np.ndarray:
        """What EAIK returns for one target (s, m); least squares where there is no solution."""
        return np.reshape(np.asarray(self._solver.IK(target).Q, float), (-1, self.chain.dof))

    def solver(self) -> Solver:
        """Judged is, of its solutions, one within the limits; else the best one."""
        return Solver("EAIK", self.native, lambda targets: [*map(self.all_of, targets)], self._best)

    def _best(self, found: list[np.ndarray], T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        q, claimed = np.full((len(T), self.chain.dof), np.nan), np.zeros(len(T), bool)
        for k, (each, target) in enumerate(zip(found, T, strict=True)):
            exact = self.exact(each, target)
            if len(exact):
                beyond, turned = outside(self.chain.limits, exact)
                best = int(beyond.argmin())
                q[k], claimed[k] = turned[best], beyond[best] == 0
        return q, claimed

    def exact(self, q: np.ndarray, target: np.ndarray) -> np.ndarray:
        """Those that are solutions, and no least squares: within 1e-6 m and of each entry of the
        rotation.
        """
        return q[np.abs(self.chain.fk(q) - target).max(axis=(1, 2)) < EXACT]


def outside(limits: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """By how much (rad) angles q (s, m) miss the limits whatever whole turns are added, the worst
    joint of each (s,); and q with turns added, within the limits where that can be.
    """
    lower, upper = limits.T
    held = np.isfinite(lower) & np.isfinite(upper)
    low, high = np.where(held, lower, -np.pi), np.where(held, upper, np.inf)
    turned = q + TURN * np.ceil((low - q) / TURN)  # the first one that is not below
    beyond = np.where(turned > high, np.minimum(turned - high, low - (turned - TURN)), 0.0)
    return beyond.max(axis=1), turned


def ready(peer: str, make: Callable[[], Any]) -> tuple[Any, str]:
    """What is made with a peer, as its solver of an arm; or None and what is wrong with it."""
    (found,) = find([EAIK if peer == "eaik" else STANDARD[peer]])
    if found.problem:
        return None, found.problem
    made, problem = attempt(make)
    return made, problem.removeprefix(
        "broken: ValueError: "
    )  # an arm that it does not take is no fault of its own
