"""Arms for the tests of nearly solvable ones: calibrated, with random errors, reversed."""

from __future__ import annotations

import numpy as np

import poekin as pk
from poekin.model.chain import Chain

ANGLE = np.radians(0.5)
LENGTH = 1e-3


def calibrated_ur10e() -> Chain:
    """The README's factory-calibrated UR10e."""
    nominal = pk.dh.published("ur10e")
    own = pk.ur.add_deltas(
        nominal,
        delta_theta=[-2.41e-07, 1.60233952, -1.68607191, 0.0837331148, -1.01e-07, 3.9e-08],
        delta_d=[-0.000160188, 439.140974080, -446.027059806, 6.886186896, -3.87e-05, -0.000879083],
        delta_a=[2.12e-05, 0.632017133, 0.002298336, -4.61e-05, -6.39e-05, 0],
        delta_alpha=[-0.000650247, 0.001394167, 0.006938188, -0.000811642, 0.000411121, 0],
    )
    return pk.ur.from_dh(own, nominal=nominal).to_chain()


def perturbed(
    chain: Chain,
    seed: int,
    angle: float = ANGLE,
    length: float = LENGTH,
) -> Chain:
    """The chain with each axis turned by an angle about its joint's origin, and shifted by a length."""
    rng = np.random.default_rng(seed)
    origins = chain.joint_poses(np.zeros(chain.dof))[:, :3, 3]
    screws = []
    for S, origin in zip(chain.screws, origins, strict=True):
        w = rng.normal(size=3)
        v = rng.normal(size=3)
        w *= angle / np.linalg.norm(w)
        v *= length / np.linalg.norm(v)
        motion = np.concatenate([w, v + np.cross(origin, w)])
        screws.append(pk.se3.adjoint(pk.se3.exp(motion)) @ S)
    home = np.concatenate([rng.normal(size=3) * angle / 2, rng.normal(size=3) * length])
    pitches = chain.pitches
    return chain.replace(screws=screws, home=chain.home @ pk.se3.exp(home), pitches=pitches)


def reversed_chain(chain: Chain) -> Chain:
    """The chain from the tip to the base: f^-1 = e^{-B_n x_n} ... e^{-B_1 x_1} M^-1."""
    return Chain.from_space(
        -chain.body.screws[::-1],
        pk.se3.inverse(chain.home),
        pitches=chain.pitches[::-1],
    )


def largest_differences(a: Chain, b: Chain, q: np.ndarray) -> tuple[float, float]:
    """Largest distance, m, and angle, rad, of two chains' tips at configurations."""
    T = a.fk(q)
    U = b.fk(q)
    apart = np.linalg.norm(T[:, :3, 3] - U[:, :3, 3], axis=1)
    # |R - R'| in Frobenius' norm is 2 √2 sin(θ / 2)
    chord = np.linalg.norm(T[:, :3, :3] - U[:, :3, :3], axis=(1, 2)) / np.sqrt(8)
    return float(apart.max()), float(2 * np.arcsin(np.minimum(chord, 1)).max())


def root_mean_square(a: Chain, b: Chain, q: np.ndarray) -> float:
    """Root mean square of √(θ² + d² / reach²), rad."""
    T = a.fk(q)
    U = b.fk(q)
    d = ((T[:, :3, 3] - U[:, :3, 3]) ** 2).sum(axis=1) / a.reach**2
    chord = np.linalg.norm(T[:, :3, :3] - U[:, :3, :3], axis=(1, 2)) / np.sqrt(8)
    return float(np.sqrt((4 * np.arcsin(chord) ** 2 + d).mean()))
