"""In single precision a calibrated arm is as exact by its screws as a nominal one; by a DH table it is not."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from benchmarks.calibrated_arm import calibrated_ur10e
from poekin.formats import emit
from tests.solve.ik_all.perturbed import perturbed

from ..emitted import arm
from .cuda_on_cpu import Device

CLAIMED = 1e-6  # m
COUNT = 20_000


def arms():
    """A UR10e as its factory measured it, and a Panda whose axes are off by half a degree and 1 mm."""
    return {"UR10e": calibrated_ur10e(), "Panda": perturbed(arm("panda"), 1)}


def drawn(chain: pk.Chain) -> np.ndarray:
    """Configurations within half a turn, which single precision holds exactly."""
    q = np.random.default_rng(5).uniform(-np.pi, np.pi, (COUNT, chain.dof))
    return q.astype(np.float32)


def by_table(table: pk.dh.Table, q: np.ndarray, kind: type) -> np.ndarray:
    """Points of the tool (N, 3): the product of the table's matrices in one kind of numbers."""
    T = np.tile(np.eye(4, dtype=kind), (len(q), 1, 1))
    for k in range(q.shape[1]):
        x = q[:, k].astype(kind) + kind(table.theta[k])
        c, s = np.cos(x), np.sin(x)
        ca, sa = np.cos(kind(table.alpha[k])), np.sin(kind(table.alpha[k]))
        M = np.zeros_like(T)
        M[:, 0] = np.stack([c, -s * ca, s * sa, kind(table.a[k]) * c], axis=1)
        M[:, 1] = np.stack([s, c * ca, -c * sa, kind(table.a[k]) * s], axis=1)
        M[:, 2, 1:] = [sa, ca, kind(table.d[k])]
        M[:, 3, 3] = 1
        T = T @ M
    assert T.dtype == kind
    return T[:, :3, 3]


@pytest.mark.parametrize("name", ["UR10e", "Panda"])
def test_emitted_poses_of_a_calibrated_arm_are_within_1e_6_m(name, tmp_path):
    chain = arms()[name]
    q = drawn(chain)
    text = emit.cuda(chain, "hybrid", name="a", precision="float32")
    found = Device(tmp_path, text, "float32").poses("a_fk_batch", q)
    error = np.linalg.norm(found[:, :3, 3] - chain.fk(q.astype(float))[:, :3, 3], axis=1)
    # rounding of some hundred operations adds up like a random walk: six standard deviations as well
    assert 6 * np.sqrt(np.mean(error**2)) < CLAIMED
    assert error.max() < CLAIMED


def test_the_table_of_the_calibrated_ur10e_is_off_by_1e_5_m_in_single_precision():
    chain = arms()["UR10e"]
    q = drawn(chain)
    table = pk.dh.from_chain(chain, convention="standard").table
    true = by_table(table, q, np.float64)
    # a hundred roundings of 446 m
    np.testing.assert_allclose(true, chain.fk(q.astype(float))[:, :3, 3], rtol=0, atol=5e-12)
    error = np.linalg.norm(by_table(table, q, np.float32) - true, axis=1)
    # numbers of 446 m have a last digit of 3e-5 m
    assert np.spacing(np.float32(np.abs(table.d).max())) > 3e-5
    assert error.max() > 1e-5
