"""A cluster of Dask gives the same bytes, also where a worker dies."""

from __future__ import annotations

import os
import signal

import pytest

import poekin as pk
from poekin.sweep import Cells, Random, Sweep, run
from tests.sweep.arms import bits

distributed = pytest.importorskip("distributed", reason="no distributed: no cluster was asked")

ARM = pk.load("panda").chain(tip="panda_hand")
CELLS = Cells.box([-1.0, -1.0, -0.6], [1.0, 1.0, 1.3], 0.25, side=1)
SWEEP = Sweep(ARM, Random.of(ARM, 60_001, seed=5), CELLS, "manipulability")


@pytest.fixture(scope="module")
def cluster():
    """Two processes with a worker each, which a new one replaces when it dies."""
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True
    ) as made:
        yield made


@pytest.fixture(scope="module")
def client(cluster):
    with distributed.Client(cluster, set_as_default=False) as made:
        yield made


@pytest.mark.parametrize("chunk", [10, 2000])
def test_workers_give_the_same_bytes(client, chunk):
    assert bits(run(SWEEP, chunk=chunk, executor=client, workers=2)) == bits(run(SWEEP))


def test_a_worker_that_dies_costs_its_part_alone(client):
    killed = []

    def kill(done: int, _: int) -> None:
        if not killed:
            killed.extend(client.run(os.getpid).values())
            os.kill(killed[0], signal.SIGKILL)

    assert bits(run(SWEEP, chunk=2000, executor=client, progress=kill)) == bits(run(SWEEP))
    assert len(killed) == 2
