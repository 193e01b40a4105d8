"""Denavit-Hartenberg parameters and Hayati's as numbers that can be identified, and the arms to
identify.

A table of link parameters is itself a product of exponentials: of 4 n + 6 elementary motions e^{E_k
x_k}, turns about and shifts along x, y and z, whose coordinates are the parameters. So a chain of
that many joints gives its poses, and its Jacobian is the derivative of the pose by each parameter,
with no formula of its own.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from poekin import Chain, dh, se3
from poekin.groups.arrays import Array

ARM, SHOULDER, ELBOW = "puma560", 1, 2
"""The arm, and its two joints with parallel axes."""

UNITS = {
    "Rx": (1.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    "Ry": (0.0, 1.0, 0.0, 0.0, 0.0, 0.0),
    "Rz": (0.0, 0.0, 1.0, 0.0, 0.0, 0.0),
    "Tx": (0.0, 0.0, 0.0, 1.0, 0.0, 0.0),
    "Ty": (0.0, 0.0, 0.0, 0.0, 1.0, 0.0),
    "Tz": (0.0, 0.0, 0.0, 0.0, 0.0, 1.0),
}


@dataclasses.dataclass(frozen=True, eq=False)
class Elementary:
    """f = base prod e^{E_k x_k} tool, x_k = values_k, and + q_i where k is turned_by[i]; motions:
    names in `UNITS`.

    chain: that of one joint a parameter; its coordinates are the parameters, so that it stays as
    they change.
    """

    motions: tuple[str, ...]
    values: Array
    turned_by: tuple[int, ...]
    chain: Chain

    @property
    def lengths(self) -> Array:
        """(P,) whether a parameter is a length (m) and not an angle (rad)."""
        return np.array([motion.startswith("T") for motion in self.motions])

    def _coordinates(self, q: Array) -> Array:
        x = np.tile(self.values, (len(q), 1))
        x[:, list(self.turned_by)] += q
        return x

    def poses(self, q: Array) -> Array:
        """T_base_tool (N, 4, 4) at q (N, n)."""
        return self.chain.fk(self._coordinates(q))

    def columns(self, q: Array) -> Array:
        """(N, 6, P): the tool's turn and the shift of its origin, in base axes, per unit of each
        parameter.
        """
        return self.chain.jacobian(self._coordinates(q), "hybrid")

    def moved(self, step: Array) -> Elementary:
        """The arm with its parameters changed by step (P,)."""
        return dataclasses.replace(self, values=self.values + step)


def link_parameters(table: dh.Table, hayati: Sequence[int] = ()) -> Elementary:
    """The complete and minimal form of a standard table of revolute joints: 4 n + 6 parameters.

    Tx Ty Rx Ry place axis 1 in the base; link i is Rz(theta + q) Tz(d) Tx(a) Rx(alpha) or, where i
    is in `hayati`, Rz(theta + q) Tx(a) Rx(alpha) Ry(beta); Ty Ry complete the tool after the last
    link. Source: Hayati 1983.
    """
    motions, values, turned_by = ["Tx", "Ty", "Rx", "Ry"], [0.0] * 4, []
    for i, row in enumerate(table.rows):
        turned_by.append(len(motions))
        if i in hayati:
            if row.d:
                raise ValueError(
                    f"row {i + 1}: Hayati's link has no d, and this one is {row.d:g} m"
                )
            motions += ["Rz", "Tx", "Rx", "Ry"]
            values += [row.theta, row.a, row.alpha, 0.0]
        else:
            motions += ["Rz", "Tz", "Tx", "Rx"]
            values += [row.theta, row.d, row.a, row.alpha]
    values = np.array([*values, 0.0, 0.0])
    motions += ["Ty", "Ry"]
    chain = Chain.from_space([UNITS[motion] for motion in motions], table.tool)
    return Elementary(tuple(motions), values, tuple(turned_by), chain.rebased(table.base))


def table_with(twist: float) -> dh.Table:
    """The arm's table with alpha of the link between its parallel axes set to twist [rad]: 0 is the
    nominal arm.
    """
    rows = list(dh.published(ARM).rows)
    rows[SHOULDER] = dataclasses.replace(rows[SHOULDER], alpha=twist)
    return dh.Table("standard", rows)


def tilted(delta: float) -> Chain:
    """The nominal arm with the axis of its elbow turned by delta [rad] in the plane of that axis
    and the shoulder's.
    """
    nominal = dh.to_chain(table_with(0.0))
    A = np.array(nominal.screws)
    p = np.cross(A[:, :3], A[:, 3:])
    normal = np.cross(A[ELBOW, :3], p[ELBOW] - p[SHOULDER])
    normal = normal / np.linalg.norm(normal)
    A[ELBOW] = (
        se3.adjoint(se3.exp(delta * np.concatenate([normal, np.cross(p[ELBOW], normal)])))
        @ A[ELBOW]
    )
    return Chain.from_space(A, nominal.home, limits=nominal.limits)
