"""A real factory calibration whose DH table has entries of 440 m, and what single precision makes
of both its forms.
"""

from __future__ import annotations

import numpy as np

import poekin as pk
from poekin.algebra import IDENTITY, compose
from poekin.formats.dh import Row, Table, to_chain
from poekin.formulas import dh
from poekin.formulas.lie import exponential
from poekin.model.chain import Chain

# Published in the documentation of the Universal Robots ROS 2 driver, package ur_calibration: a
# real UR10e-size arm.
D = [
    0.180539811714259,
    439.140974079901,
    -446.027059806332,
    7.0603368964236,
    0.119811341150314,
    0.115670917257426,
]
A = [
    2.12234865571206e-05,
    0.0193171326277006,
    -0.569251663611088,
    -4.61409023720934e-05,
    -6.39280053471802e-05,
    0.0,
]
ALPHA = [
    1.57014608044242,
    0.0013941666682559,
    0.00693818880325995,
    1.56998468543761,
    -1.57038520649543,
    0.0,
]
THETA = [
    *(-2.4147806894359e-07, 1.60233952386695, -1.68607190752171),
    *(0.0837331147700119, -1.01260355871158e-07, 3.91986209186124e-08),
]

UR10E = Table(
    "standard",
    [Row(*row) for row in zip(THETA, D, A, ALPHA, strict=True)],
    name="ur10e_calibrated",
)


def calibrated_ur10e() -> Chain:
    """The arm of the table, with the joints' zeros of the nominal one."""
    return pk.ur.from_dh(UR10E, nominal=pk.dh.published("ur10e")).to_chain()


def single_precision_errors(table: Table, q: np.ndarray) -> dict[str, np.ndarray]:
    """Position errors of the tool in float32 against float64, by the screws ("POE") and by the
    table ("DH").

    The package's own formulas run over float32 numbers alone: the arm's constants and q are rounded
    first, then everything else is. The truth is the chain in float64.

    Parameters: table, standard, revolute, without flips, base or tool; q (N, n) in rad.
    Returns: {"POE": (N,), "DH": (N,)}, the largest coordinate of the tool's position error in m.
    """
    chain = to_chain(table)
    single = np.float32
    true = chain.fk(q)[:, :3, 3]
    home = tuple(single(x) for x in (*chain.home[:3, :3].ravel(), *chain.home[:3, 3]))
    rows = np.array([table.theta, table.d, table.a, table.alpha], dtype=single).T
    poe = dh_pose = tuple(single(x) for x in IDENTITY)
    for S, (theta, d, a, alpha), x in zip(
        chain.screws.astype(single),
        rows,
        q.astype(single).T,
        strict=True,
    ):
        poe = compose(poe, exponential.joint(tuple(S[:3]), tuple(S[3:]), x, np.sin(x), np.cos(x)))
        turn = theta + x
        dh_pose = compose(
            dh_pose,
            dh.link(np.sin(turn), np.cos(turn), d, a, np.sin(alpha), np.cos(alpha)),
        )
    positions = {"POE": np.stack(compose(poe, home)[9:], -1), "DH": np.stack(dh_pose[9:], -1)}
    wider = [what for what, position in positions.items() if position.dtype != single]
    if wider:
        raise TypeError(f"{', '.join(wider)}: the formulas left single precision")
    return {
        what: np.abs(position.astype(float) - true).max(-1) for what, position in positions.items()
    }
