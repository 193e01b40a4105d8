"""The parameters of an arm that a calibration may change, and what the pose makes of them.

    A_i <- Ad(e^eta_i) A_i,  M <- M e^eta,  q <- (1 + g) q + o,  v_i <- v_i + h_i omega_i

Moving a screw by conjugation leaves its axis unit and its pitch as it is. Of the six directions of
eta_i only those that move the axis are parameters: two tilts and two shifts across it for a
revolute or helical joint, two tilts for a prismatic one. They are taken in the joint's z-aligned
frame of the local form, so the numbers stay small.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, UnknownName, quote, safe_repr, suggest
from ....groups import se3
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.checks import read_only
from .tsqr import times

KINDS = ("screws", "home", "offsets", "gains", "pitch")
_MOTIONS = (
    "turn about x",
    "turn about y",
    "turn about z",
    "shift along x",
    "shift along y",
    "shift along z",
)


class Parameter(NamedTuple):
    """One number that a calibration finds: its owner (a joint, a coordinate, "home", a frame),
    what, and its unit.
    """

    owner: str
    what: str
    unit: str

    @property
    def name(self) -> str:
        """Owner and what, as messages and files call it."""
        return f"{self.owner}: {self.what}"


class Arm:
    """A chain and those of its parameters p that are free; p = 0 is the chain itself.

    `parameters` in the order of p; `kinds` and `moving`, names of joints, as they were asked for.
    Joints whose axes may move, coordinates whose zero or gain may, are those in `joints` (all where
    None).
    """

    def __init__(self, nominal: Chain, kinds: Sequence[str], joints: Sequence[str] | None):
        kinds = _kinds(kinds)
        chosen = _joints(nominal, joints)
        self.nominal, self.kinds = nominal, kinds
        self.moving = tuple(
            name for name, is_one in zip(nominal.joint_names, chosen, strict=True) if is_one
        )
        self._turns = nominal.local.rotates != 0
        self._frames = np.empty((len(self._turns), 4, 4))
        F = np.eye(4)
        for i, M_i in enumerate(nominal.local.frames[:-1]):
            F = F @ M_i
            self._frames[i] = F
        self._across = se3.adjoint(self._frames)[
            ..., [0, 1, 3, 4]
        ]  # (n, 6, 4): columns tilt, tilt, shift, shift
        free = np.zeros((len(self._turns), 4), bool)
        if "screws" in kinds:
            free[chosen] = True
            free[~self._turns, 2:] = False
        self._free = free
        self._pitched = np.flatnonzero(
            chosen & (np.array(nominal.kinds, "U9") != "prismatic") & ("pitch" in kinds)
        )
        self._home = "home" in kinds
        moved = np.flatnonzero(np.abs(nominal.coupling[chosen]).sum(0) > 0)
        self._offset = moved if "offsets" in kinds else moved[:0]
        self._gain = moved if "gains" in kinds else moved[:0]
        self.parameters = tuple(self._named())
        if not self.parameters:
            raise InputError(
                f"parameters: {', '.join(map(repr, kinds))} of these joints: nothing to calibrate"
            )
        counts = [
            free.sum(),
            len(self._pitched),
            6 * self._home,
            len(self._offset),
            len(self._gain),
        ]
        self._parts = list(pairwise(np.cumsum([0, *counts]).tolist()))
        self._plain = nominal.nontrivial_coupling is None and not nominal.offset.any()
        self._named_as: dict[str, Any] = {
            "joint_names": nominal.joint_names, "q_names": nominal.q_names, "limits": nominal.limits,
            "offset": nominal.offset, "base": nominal.base, "tip": nominal.tip,
        }  # fmt: skip
        self._moved: tuple[bytes, Chain] | None = None
        self._posed: tuple[_Key, Array] | None = None
        self._changed: tuple[_Key, Array, Array] | None = None

    def _named(self) -> list[Parameter]:
        names, found = self.nominal.joint_names, []
        axes = (np.round(self._frames[:, :3, :2], 6) + 0.0).tolist()
        for i, k in np.argwhere(self._free).tolist():
            what = ("tilt about", "shift along")[k // 2]
            along = ", ".join(f"{row[k % 2]:.3g}" for row in axes[i])
            found.append(Parameter(names[i], f"{what} ({along})", ("rad", "m")[k // 2]))
        found += [Parameter(names[i], "pitch", "m/rad") for i in self._pitched]
        if self._home:
            found += [
                Parameter("home", what, ("rad", "m")[k // 3]) for k, what in enumerate(_MOTIONS)
            ]
        q_names = self.nominal.q_names
        for k in self._offset:
            found.append(
                Parameter(q_names[k], "offset", "rad" if self.nominal.is_angle(int(k)) else "m")
            )
        return found + [Parameter(q_names[k], "gain", "1") for k in self._gain]

    def _split(self, p: Array) -> tuple[Array, Array, Array, Array, Array]:
        """eta_i (n, 6), pitches (n,), eta of the home pose (6,), offsets (m,), gains (m,)."""
        moves, pitches, home, offsets, gains = (p[a:b] for a, b in self._parts)
        across = np.zeros(self._free.shape)
        across[self._free] = moves
        h, o, g = np.zeros(len(self._turns)), np.zeros(self.nominal.dof), np.zeros(self.nominal.dof)
        h[self._pitched], o[self._offset], g[self._gain] = pitches, offsets, gains
        return (
            (self._across @ across[..., None])[..., 0],
            h,
            home if self._home else np.zeros(6),
            o,
            g,
        )

    def joints(self, p: Array) -> Chain:
        """The moved screws and home pose as a chain of joint values x, without coupling. The last
        is kept.
        """
        if self._plain and not p.any():
            return self.nominal
        kept, key = self._moved, p.tobytes()
        if kept is not None and kept[0] == key:
            return kept[1]
        eta, h, home, _, _ = self._split(p)
        A = (se3.adjoint(se3.exp(eta)) @ self.nominal.screws[..., None])[..., 0]
        named, pitches = self._named_as if self._plain else {}, self.nominal.pitches + h
        moved = Chain(A, self.nominal.home @ se3.exp(home), pitches=pitches, **named)
        self._moved = key, moved
        return moved

    def values(self, p: Array, q: Array) -> Array:
        """Joint values x = C ((1 + g) q + o) + c of the readings q (N, m)."""
        _, _, _, o, g = self._split(p)
        x = (1.0 + g) * q + o
        C = self.nominal.nontrivial_coupling
        return (x if C is None else x @ C.T) + self.nominal.offset

    def chain(self, p: Array) -> Chain:
        """The arm with these parameters, in coordinates, names and limits of the nominal one.

        Offsets go into screws and home pose (f(q + o), `Chain.rezeroed`), gains into C.
        """
        joints, nominal, same = self.joints(p), self.nominal, self._named_as
        _, _, _, o, g = self._split(p)
        if self._plain and not o.any() and not g.any():
            return joints
        arm = Chain(
            joints.screws,
            joints.home,
            coupling=nominal.nontrivial_coupling,
            pitches=joints.pitches,
            **same,
        )
        if o.any():
            arm = arm.rezeroed(o)
        coupling = nominal.coupling * (1.0 + g) if g.any() else nominal.nontrivial_coupling
        return Chain(arm.screws, arm.home, coupling=coupling, pitches=arm.pitches, **same)

    def poses(self, p: Array, q: Array) -> Array:
        """T_base_tip (N, 4, 4) at the readings q (N, m)."""
        kept, key = self._posed, _key(p, q)
        if kept is not None and kept[0] == key:
            return kept[1]
        T = read_only(self.joints(p).fk(self.values(p, q)))
        self._posed = key, T
        return T

    def changes(self, p: Array, q: Array) -> tuple[Array, Array]:
        """T_base_tip (N, 4, 4), and the space twists dT T^-1 (N, 6, P) per unit of each parameter.

        At p the motion of joint i is e^eta_i with d(e^eta) e^-eta = J_l(eta) d eta, and the home
        pose's M e^eta with J_r(eta); a pitch slides along the joint's moved axis. The last are
        kept: a fit asks for each several times.
        """
        kept, key = self._changed, _key(p, q)
        if kept is not None and kept[0] == key:
            return kept[1:]
        joints, x = self.joints(p), self.values(p, q)
        eta, _, home, _, _ = self._split(p)
        n, N = len(self._turns), len(x)
        D = joints.screw_derivatives(x)
        across, each = np.zeros((n, 6, n, 4)), np.arange(n)
        across[each, :, each] = se3.left_jacobian(eta) @ self._across
        free = across[:, :, self._free].reshape(6 * n, int(self._free.sum()))
        parts = [times(D.screws.reshape(N * 6, 6 * n), free).reshape(N, 6, free.shape[1])]
        if len(self._pitched) or len(self._offset) or len(self._gain):
            J = joints.jacobian(x, frame="space")
            slides = np.concatenate([np.zeros((N, 3, n)), J[:, :3] * x[:, None]], axis=1)
            J_q = (
                J
                if self.nominal.nontrivial_coupling is None
                else J @ self.nominal.nontrivial_coupling
            )
            parts.append(slides[..., self._pitched])
        if self._home:
            parts.append(D.home @ se3.right_jacobian(home))
        if len(self._offset) or len(self._gain):
            parts += [J_q[..., self._offset], J_q[..., self._gain] * q[:, None, self._gain]]
        T, changes = self.poses(p, q), read_only(np.concatenate(parts, axis=2))
        self._changed = key, T, changes
        return T, changes


_Key = tuple[bytes, int, bytes]


def _key(p: Array, q: Array) -> _Key:
    """What tells parameters and readings (N, m) from others; without coordinates N is all that
    there is of these.
    """
    return p.tobytes(), len(q), q.tobytes()


def _kinds(kinds: Sequence[str]) -> tuple[str, ...]:
    every = _several(kinds, "parameters")
    for kind in every:
        if kind not in KINDS:
            known = ", ".join(map(repr, KINDS))
            raise InputError(f"parameters: expected some of {known}, got {safe_repr(kind)}")
    if not every:
        raise InputError(
            f"parameters: nothing to calibrate; expected some of {', '.join(map(repr, KINDS))}"
        )
    return every


def _several(names: Sequence[str], what: str) -> tuple[str, ...]:
    if isinstance(names, str):
        return (names,)
    if not isinstance(names, Iterable):
        raise InputError(f"{what}: expected names, got {safe_repr(names)}")
    return tuple(names)


def _joints(chain: Chain, joints: Sequence[str] | None) -> NDArray[np.bool_]:
    """Which joints are chosen (n,), of all where None."""
    if joints is None:
        return np.ones(len(chain.joint_names), bool)
    named = _several(joints, "joints")
    for name in named:
        if name not in chain.joint_names:
            raise UnknownName(
                f"joints: no joint {quote(name)}; {suggest(str(name), chain.joint_names)}"
            )
    return np.array([name in named for name in chain.joint_names], bool)
