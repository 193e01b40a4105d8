"""Error model of an arm: how its free parameters move the screws, the home pose and the readings.

    A_i <- Ad(e^eta_i) A_i,  M <- M e^eta,  q <- (1 + g) q + o,  v_i <- v_i + h_i omega_i

Moving a screw by conjugation leaves its axis unit and its pitch as it is. Of the six directions of
eta_i only those that move the axis are parameters: two tilts and two shifts across it for a
revolute or helical joint, two tilts for a prismatic one. They are taken in the joint's z-aligned
frame of the local form, so the numbers stay small.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError
from ....groups import se3
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.checks import read_only
from .last_result import LastResult
from .parameters import free_parameters, names, parse_joints, parse_kinds
from .tsqr import blocked_product


class Errors(NamedTuple):
    """Parameters p by what they move: eta_i (n, 6), pitches (n,), eta of the home pose (6,), offsets
    (m,), gains (m,); 0 where they are not free.
    """

    screws: Array
    pitches: Array
    home: Array
    offsets: Array
    gains: Array


class PosesAndTwists(NamedTuple):
    """T_base_tip (N, 4, 4), and the space twists dT T^-1 (N, 6, P) per unit of each parameter."""

    T: Array
    D: Array


class ErrorModel:
    """A chain and those of its parameters p that are free; p = 0 is the chain itself.

    `parameters` in the order of p; `kinds` and `moving`, names of joints, as they were asked for.
    Joints whose axes may move, coordinates whose zero or gain may, are those in `joints` (all where
    None).
    """

    def __init__(self, nominal: Chain, kinds: Sequence[str], joints: Sequence[str] | None) -> None:
        kinds = parse_kinds(kinds)
        chosen = parse_joints(nominal, joints)
        self.nominal = nominal
        self.kinds = kinds
        self.moving = tuple(np.array(nominal.joint_names, object)[chosen])
        self._free = free_parameters(nominal, kinds, chosen)
        frames = _joint_frames(nominal)
        # (n, 6, 4): columns tilt, tilt, shift, shift
        self._across = se3.adjoint(frames)[..., [0, 1, 3, 4]]
        self.parameters = names(nominal, self._free, frames)
        if not self.parameters:
            listed = ", ".join(map(repr, kinds))
            raise InputError(f"parameters: {listed} of these joints: nothing to calibrate")
        ends = np.cumsum([0, *self._free.counts]).tolist()
        self._parts = [slice(start, stop) for start, stop in pairwise(ends)]
        self._coupling = nominal.nontrivial_coupling
        self._plain = self._coupling is None and not nominal.offset.any()
        self._named_as: dict[str, Any] = {
            "joint_names": nominal.joint_names,
            "q_names": nominal.q_names,
            "limits": nominal.limits,
            "offset": nominal.offset,
            "base": nominal.base,
            "tip": nominal.tip,
        }
        self._last_joints = LastResult[Chain]()
        self._last_poses = LastResult[Array]()
        self._last_twists = LastResult[PosesAndTwists]()

    def errors(self, p: Array) -> Errors:
        """The parameters by what they move."""
        moves, pitches, home, offsets, gains = (p[part] for part in self._parts)
        free = self._free
        n = len(free.screws)
        m = self.nominal.dof
        across = np.zeros((n, 4))
        across[free.screws] = moves
        return Errors(
            screws=(self._across @ across[..., None])[..., 0],
            pitches=_scattered(n, free.pitches, pitches),
            home=home if free.home else np.zeros(6),
            offsets=_scattered(m, free.offsets, offsets),
            gains=_scattered(m, free.gains, gains),
        )

    def joints(self, p: Array) -> Chain:
        """The moved screws and home pose as a chain of joint values x, without coupling."""
        if self._plain and not p.any():
            return self.nominal
        return self._last_joints(p.tobytes(), lambda: self._moved(p))

    def _moved(self, p: Array) -> Chain:
        errors = self.errors(p)
        A = (se3.adjoint(se3.exp(errors.screws)) @ self.nominal.screws[..., None])[..., 0]
        M = self.nominal.home @ se3.exp(errors.home)
        named = self._named_as if self._plain else {}
        return Chain.from_space(A, M, pitches=self.nominal.pitches + errors.pitches, **named)

    def values(self, p: Array, q: Array) -> Array:
        """Joint values x = C ((1 + g) q + o) + c of the readings q (N, m)."""
        errors = self.errors(p)
        x = (1.0 + errors.gains) * q + errors.offsets
        if self._coupling is not None:
            x = x @ self._coupling.T
        return x + self.nominal.offset

    def chain(self, p: Array) -> Chain:
        """The arm with these parameters, in coordinates, names and limits of the nominal one.

        Offsets go into screws and home pose (f(q + o), `Chain.rezeroed`), gains into C.
        """
        moved = self.joints(p)
        errors = self.errors(p)
        if self._plain and not errors.offsets.any() and not errors.gains.any():
            return moved
        arm = self._rebuilt(moved, self._coupling)
        if errors.offsets.any():
            arm = arm.rezeroed(errors.offsets)
        if not errors.gains.any():
            return self._rebuilt(arm, self._coupling)
        return self._rebuilt(arm, self.nominal.coupling * (1.0 + errors.gains))

    def _rebuilt(self, arm: Chain, C: Array | None) -> Chain:
        """A chain of these screws, named as the nominal one."""
        return Chain.from_space(
            arm.screws,
            arm.home,
            coupling=C,
            pitches=arm.pitches,
            **self._named_as,
        )

    def poses(self, p: Array, q: Array) -> Array:
        """T_base_tip (N, 4, 4) at the readings q (N, m)."""
        return self._last_poses(_key(p, q), lambda: read_only(self.joints(p).fk(self.values(p, q))))

    def poses_and_twists(self, p: Array, q: Array) -> PosesAndTwists:
        """Poses at the readings q (N, m), and how the parameters move them.

        At p the motion of joint i is e^eta_i with d(e^eta) e^-eta = J_l(eta) d eta, and the home
        pose's M e^eta with J_r(eta); a pitch slides along the joint's moved axis.
        """
        return self._last_twists(
            _key(p, q),
            lambda: PosesAndTwists(self.poses(p, q), read_only(self._twists(p, q))),
        )

    def _twists(self, p: Array, q: Array) -> Array:
        """Space twists (N, 6, P) per unit of each parameter."""
        joints = self.joints(p)
        x = self.values(p, q)
        errors = self.errors(p)
        free = self._free
        derivatives = joints.screw_derivatives(x)
        parts = [self._screw_twists(errors.screws, derivatives.screws)]
        if any(map(len, (free.pitches, free.offsets, free.gains))):
            J = joints.jacobian(x, frame="space")
            slides = np.zeros_like(J)
            slides[:, 3:] = J[:, :3] * x[:, None]
            parts.append(slides[..., free.pitches])
        if free.home:
            parts.append(derivatives.home @ se3.right_jacobian(errors.home))
        if len(free.offsets) or len(free.gains):
            J_q = J
            if self._coupling is not None:
                J_q = J @ self._coupling
            parts.append(J_q[..., free.offsets])
            parts.append(J_q[..., free.gains] * q[:, None, free.gains])
        return np.concatenate(parts, axis=2)

    def _screw_twists(self, eta: Array, derivatives: Array) -> Array:
        """Space twists (N, 6, k) of the tilts and shifts, from those of the screws (N, 6, n, 6)."""
        n = len(eta)
        N = len(derivatives)
        count = self._free.counts[0]
        each = np.arange(n)
        across = np.zeros((n, 6, n, 4))
        across[each, :, each] = se3.left_jacobian(eta) @ self._across
        moves = across[:, :, self._free.screws].reshape(6 * n, count)
        twists = blocked_product(derivatives.reshape(N * 6, 6 * n), moves)
        return twists.reshape(N, 6, count)


def _joint_frames(nominal: Chain) -> Array:
    """Pose (n, 4, 4) of each joint's z-aligned frame in the base at home."""
    frames = np.empty((len(nominal.local.frames) - 1, 4, 4))
    F = np.eye(4)
    for i, M_i in enumerate(nominal.local.frames[:-1]):
        F = F @ M_i
        frames[i] = F
    return frames


def _scattered(count: int, indices: NDArray[np.integer], values: Array) -> Array:
    """Zeros (count,), and the values at these indices."""
    array = np.zeros(count)
    array[indices] = values
    return array


def _key(p: Array, q: Array) -> tuple[bytes, int, bytes]:
    """Key of parameters and readings (N, m): without coordinates N tells the readings apart."""
    return p.tobytes(), len(q), q.tobytes()
