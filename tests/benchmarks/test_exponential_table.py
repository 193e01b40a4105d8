"""The case of tables of exponentials: what its ways compute, and that their errors go with the step
as they should.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from benchmarks.cases import exponential_table as case
from poekin import dh
from poekin.testing.oracles import exact

STEPS = (90, 360, 1440)


@pytest.fixture(scope="module")
def errors():
    """Largest error of the tool's position by way and number of entries, run as plain Python."""
    chain = dh.to_chain(dh.published("puma560"))
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (40, 6))
    q[0], q[1] = np.pi, -np.pi  # both ends of a table
    home = [*chain.home[:3, :3].ravel(), *chain.home[:3, 3]]
    expected = np.stack([exact.rounded(exact.forward(chain.screws, chain.home, x)) for x in q])[
        :, :3, 3
    ]

    def error(run, entries):
        out = np.empty((len(q), 12))
        run(chain.screws, home, case.tables(chain, entries).rows, q, out)
        return np.abs(out[:, 9:] - expected).max()

    return {(run, n): error(run, n) for run in (case.by_sines, *case.WAYS.values()) for n in STEPS}


def test_computing_the_sines_is_right_to_the_last_digits(errors):
    # a dozen products of numbers of one metre
    assert errors[case.by_sines, 90] < 24 * 2.0**-52


@pytest.mark.parametrize(
    "run, order", [(case.by_nearest, 1), (case.by_line, 2)], ids=["nearest", "line"]
)
def test_the_error_falls_with_the_step(errors, run, order):
    for coarse, fine in pairwise(STEPS):
        # the worst of forty configurations is not the worst of all: a factor of two either way
        assert 4**order / 2 < errors[run, coarse] / errors[run, fine] < 4**order * 2


def test_memory_is_twelve_numbers_an_entry_and_joint():
    chain = dh.to_chain(dh.published("puma560"))
    assert case.tables(chain, 360).megabytes == 6 * 361 * 12 * 8 / 1e6
