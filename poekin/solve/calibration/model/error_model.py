"""Error model of an arm: how its free parameters move the screws, the home pose and the readings.

    A_i <- Ad(e^eta_i) A_i,  M <- M e^eta,  q <- (1 + g) q + o + B(q) c,  v_i <- v_i + h_i omega_i

Moving a screw by conjugation leaves its axis unit and its pitch as it is. Of the six directions of
eta_i only those that move the axis are parameters: two tilts and two shifts across it for a
revolute or helical joint, two tilts for a prismatic one. They are taken in the joint's z-aligned
frame of the local form, so the numbers stay small. B is the basis of the non-geometric terms.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, compress, pairwise
from typing import NamedTuple

import numpy as np

from ....errors import InputError
from ....groups import se3
from ....groups.arrays import Array
from ....groups.vectors import applied
from ....model.chain import Chain
from ....model.checks import read_only
from ..terms.conditions import Conditions, Reference, at_rest
from ..terms.named import BUILDERS, make_terms
from ..terms.term import Term, checked_basis, name_of
from .last_result import LastResult
from .parameters import Parameter, free_parameters, names, parse_joints, parse_kinds
from .tsqr import blocked_product


class Errors(NamedTuple):
    """Geometric parameters p by what they move, in this order: eta_i (n, 6), pitches (n,), eta of the
    home pose (6,), offsets (m,), gains (m,); 0 where they are not free.
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


def joint_frames(chain: Chain) -> Array:
    """Poses (n, 4, 4) of the joints' z-aligned frames in the base at home."""
    local = chain.local.frames[:-1]
    poses = list(accumulate(local, np.matmul))
    return np.reshape(poses, (-1, 4, 4))


def across(frames: Array) -> Array:
    """Twists (n, 6, 4) of the two tilts and then the two shifts across the z axes of frames."""
    tilts_and_shifts = [0, 1, 3, 4]
    return se3.adjoint(frames)[..., tilts_and_shifts]


class ErrorModel:
    """A chain and those of its parameters p that are free; p = 0 is the chain itself.

    `parameters` in the order of p, the coefficients of the `terms` last; `kinds` and `moving`, names
    of joints, as they were asked for. Joints whose axes may move, coordinates whose readings may be
    wrong, are those in `joints` (all where None). `reference`: means of the conditions that were
    given.
    """

    def __init__(
        self,
        nominal: Chain,
        kinds: Sequence[str | Term],
        joints: Sequence[str] | None,
        reference: Reference | None = None,
    ) -> None:
        kinds = parse_kinds(kinds, tuple(BUILDERS))
        chosen = parse_joints(nominal, joints)
        self.nominal = nominal
        self.kinds = kinds
        self.moving = tuple(compress(nominal.joint_names, chosen))
        self._free = free_parameters(nominal, kinds, chosen)
        frames = joint_frames(nominal)
        self._across = across(frames)
        # where each parameter stands in `Errors`, and the parts of these
        masks = [mask.ravel() for mask in self._free]
        self._places = np.flatnonzero(np.concatenate(masks))
        ends = [0, *accumulate(map(len, masks))]
        self._parts = [slice(*pair) for pair in pairwise(ends)]
        of_joints = np.abs(nominal.coupling[chosen])
        coordinates = np.flatnonzero(of_joints.sum(axis=0))
        self.reference: Reference = reference or {}
        self.terms = make_terms(kinds, nominal, coordinates, self.reference)
        self._geometric = int(self._places.size)
        self.parameters = names(nominal, self._free, frames)
        for term in self.terms:
            self.parameters += term.parameters
        if not self.parameters:
            listed = ", ".join(map(repr, kinds))
            raise InputError(f"parameters: {listed} of these joints: nothing to calibrate")
        self._coupling = nominal.nontrivial_coupling
        self._plain = self._coupling is None and not nominal.offset.any()
        self._last_joints = LastResult[Chain]()
        self._last_poses = LastResult[Array]()
        self._last_twists = LastResult[PosesAndTwists]()

    def errors(self, p: Array) -> Errors:
        """The parameters by what they move."""
        every = np.zeros(self._parts[-1].stop)
        every[self._places] = p[: self._geometric]
        of_axes, *others = (every[part] for part in self._parts)
        screws = self._across @ of_axes.reshape(-1, 4, 1)
        return Errors(screws[..., 0], *others)

    def joints(self, p: Array) -> Chain:
        """The moved screws and home pose as a chain of joint values x, without coupling."""
        p = p[: self._geometric]
        if self._plain and not p.any():
            return self.nominal
        key = p.tobytes()
        return self._last_joints(key, lambda: self._moved(p))

    def _moved(self, p: Array) -> Chain:
        errors = self.errors(p)
        nominal = self.nominal
        moves = se3.adjoint(se3.exp(errors.screws))
        A = applied(moves, nominal.screws)
        M = nominal.home @ se3.exp(errors.home)
        pitches = nominal.pitches + errors.pitches
        if self._plain:
            return nominal.replace(screws=A, home=M, pitches=pitches, masses=nominal.masses)
        return Chain.from_space(A, M, pitches=pitches)

    @property
    def judged(self) -> tuple[str | Term, ...]:
        """Kinds of parameters that are about the readings, and may be left out: gains and terms."""
        return tuple(kind for kind in self.kinds if self.parameters_of(kind))

    def parameters_of(self, kind: str | Term) -> tuple[Parameter, ...]:
        """Parameters of one term, or the gains."""
        if kind == "gains":
            return tuple(p for p in self.parameters if p.what == "gain")
        named = (term for term in self.terms if term.name == name_of(kind))
        return tuple(p for term in named for p in term.parameters)

    def basis(self, q: Array, conditions: Conditions | None = None) -> Array:
        """B (N, m, k) of the terms' coefficients at readings q (N, m), at rest where no conditions are
        given.
        """
        if not self.terms:
            return np.empty((*q.shape, 0))
        if conditions is None:
            conditions = at_rest(q, self.reference)
        bases = [checked_basis(term, q, conditions) for term in self.terms]
        return np.concatenate(bases, axis=2)

    def true_joints(self, p: Array, q: Array, conditions: Conditions | None = None) -> Array:
        """Values q + B c / (1 + g) (N, m), at which `chain(p)` is where the arm is at readings q."""
        B = self.basis(q, conditions)
        added = B @ p[self._geometric :]
        gains = self.errors(p).gains
        return q + added / (1.0 + gains)

    def values(self, p: Array, q: Array, basis: Array | None = None) -> Array:
        """Joint values x = C ((1 + g) q + o + B c) + c of the readings q (N, m)."""
        errors = self.errors(p)
        x = (1.0 + errors.gains) * q + errors.offsets
        if self.terms:
            B = self.basis(q) if basis is None else basis
            x = x + B @ p[self._geometric :]
        if self._coupling is not None:
            x = x @ self._coupling.T
        return x + self.nominal.offset

    def chain(self, p: Array) -> Chain:
        """The arm with these parameters, in coordinates, names and limits of the nominal one.

        Offsets go into screws and home pose (f(q + o), `Chain.rezeroed`), gains into C.
        """
        moved = self.joints(p)
        errors = self.errors(p)
        is_off = errors.offsets.any() or errors.gains.any()
        if self._plain and not is_off:
            return moved
        arm = self.nominal.replace(
            screws=moved.screws,
            home=moved.home,
            pitches=moved.pitches,
            masses=self.nominal.masses,
        )
        if errors.offsets.any():
            arm = arm.rezeroed(errors.offsets)
        C = self.nominal.coupling * (1.0 + errors.gains)
        return arm.replace(
            coupling=C,
            limits=self.nominal.limits,
            joint_limits=self.nominal.joint_limits,
        )

    def screw_jacobian(self, p: Array) -> Array:
        """Derivatives (n, 6, k) of the screws in the base frame by the k tilts and shifts, which
        are the first parameters: dA = [d(e^eta) e^-eta, A].
        """
        screws = self.joints(p).screws
        moves = self._moves(self.errors(p).screws)
        return -se3.ad(screws) @ moves

    def poses(self, p: Array, q: Array, basis: Array | None = None) -> Array:
        """T_base_tip (N, 4, 4) at the readings q (N, m), with the terms' basis there: by default at
        rest.
        """
        B = self.basis(q) if basis is None else basis

        def poses() -> Array:
            moved = self.joints(p)
            x = self.values(p, q, B)
            return read_only(moved.fk(x))

        return self._last_poses(_Key.of(p, q, B), poses)

    def poses_and_twists(self, p: Array, q: Array, basis: Array | None = None) -> PosesAndTwists:
        """Poses at the readings q (N, m), and how the parameters move them.

        At p the motion of joint i is e^eta_i with d(e^eta) e^-eta = J_l(eta) d eta, and the home
        pose's M e^eta with J_r(eta); a pitch slides along the joint's moved axis.
        """
        B = self.basis(q) if basis is None else basis

        def poses_and_twists() -> PosesAndTwists:
            T = self.poses(p, q, B)
            D = self._twists(p, q, B)
            return PosesAndTwists(T, read_only(D))

        return self._last_twists(_Key.of(p, q, B), poses_and_twists)

    def _twists(self, p: Array, q: Array, basis: Array) -> Array:
        """Space twists (N, 6, P) per unit of each parameter."""
        joints = self.joints(p)
        x = self.values(p, q, basis)
        errors = self.errors(p)
        free = self._free
        derivatives = joints.screw_derivatives(x)
        parts = [self._screw_twists(errors.screws, derivatives.screws)]
        readings = []
        of_joints = (
            free.pitches,
            free.offsets,
            free.gains,
        )
        if self.terms or any(part.any() for part in of_joints):
            J = joints.jacobian(x, frame="space")
            slides = np.zeros_like(J)
            directions = J[:, :3]
            slides[:, 3:] = directions * x[:, None]
            parts.append(slides[..., free.pitches])
            if self._coupling is not None:
                J = J @ self._coupling
            offset_by = q[:, None, free.gains]
            gains = J[..., free.gains] * offset_by
            readings = [J[..., free.offsets], gains, J @ basis]
        if free.home.any():
            J_r = se3.right_jacobian(errors.home)
            parts.append(derivatives.home @ J_r)
        return np.concatenate([*parts, *readings], axis=2)

    def reading_twists(self, p: Array, q: Array, basis: Array) -> Array:
        """Space twists (N, 6, m) per unit of each coordinate."""
        x = self.values(p, q, basis)
        J = self.joints(p).jacobian(x, frame="space")
        if self._coupling is not None:
            J = J @ self._coupling
        return J

    def _screw_twists(self, eta: Array, derivatives: Array) -> Array:
        """Space twists (N, 6, k) of the tilts and shifts, from those of the screws (N, 6, n, 6)."""
        N = len(derivatives)
        moves = self._moves(eta)
        count = moves.shape[2]
        twists = blocked_product(
            derivatives.reshape(N * 6, 6 * len(eta)),
            moves.reshape(6 * len(eta), count),
        )
        return twists.reshape(N, 6, count)

    def _moves(self, eta: Array) -> Array:
        """Twists (n, 6, k) d(e^eta) e^-eta of the joints' screws per unit of each tilt and shift."""
        moves = se3.left_jacobian(eta) @ self._across
        own = np.eye(len(eta))
        of_all = moves[:, :, None] * own[:, None, :, None]
        return of_all[:, :, self._free.screws]


class _Key(NamedTuple):
    """Parameters, readings (N, m) and basis: without coordinates N tells readings apart."""

    p: bytes
    N: int
    q: bytes
    basis: bytes

    @classmethod
    def of(cls, p: Array, q: Array, basis: Array) -> _Key:
        return cls(p.tobytes(), len(q), q.tobytes(), basis.tobytes())
