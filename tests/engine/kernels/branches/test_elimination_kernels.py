"""The kernel of elimination: any beginning of the loop, either way round, gives the same solutions."""

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels.branches import elimination_kernels


def chain(seed):
    rng = np.random.default_rng(seed)
    h = rng.normal(size=(6, 3))
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    home = np.eye(4)
    home[:3] = pk.se3.exp(rng.normal(size=6))[:3]
    return pk.Chain(np.hstack([h, np.cross(rng.normal(size=(6, 3)), h)]), home, frame="space")


def table(arm, reverse, begin, by_quarters=0):
    form = arm.to_hp()
    rows = np.zeros((9, 9))
    rows[:6, :3] = form.H
    rows[:7, 3:6] = form.P
    rows[7] = form.R_nt.ravel()
    rows[8, :4] = (2.0, reverse, begin, by_quarters)
    return rows


def solved(arm, T, *how, run=None):
    rows = np.full((len(T), elimination_kernels.MOST, 7), np.nan)
    counts = np.empty((len(T), 2))
    run = elimination_kernels.eliminated.call if run is None else run
    run(table(arm, *how), T, rows, counts)
    return rows, counts


def plain(*arrays):
    """Not compiled."""
    elimination_kernels.eliminated.function(*arrays)


@pytest.mark.parametrize("reverse", [0, 1])
@pytest.mark.parametrize("begin", range(6))
def test_every_loop_finds_the_configuration_of_the_pose(reverse, begin):
    arm = chain(4)
    for run, count in ((plain, 4), (None, 20)):
        q = np.random.default_rng(0).uniform(-np.pi, np.pi, (count, 6))
        rows, counts = solved(arm, arm.fk(q), reverse, begin, run=run)
        known = rows[:, :, 6] >= 0
        off = np.abs((rows[:, :, :6] - q[:, None] + np.pi) % (2 * np.pi) - np.pi).max(axis=2)
        off = np.where(known, off, np.inf).min(axis=1)
        assert (off[counts[:, 1] == 0] < 1e-6).all()
        assert (counts[:, 1] == 0).sum() >= count // 2
        assert (known.sum(axis=1) == counts[:, 0]).all()


def test_a_loop_whose_first_axes_meet_is_said_to_degenerate():
    arm = pk.load("jaco").chain()
    T = arm.fk(np.array([[0.3, 1.0, -0.5, 0.7, 1.1, -2.0]]))
    rows, counts = solved(arm, T, 0, 0)
    assert counts[0, 0] == elimination_kernels.DEGENERATE
    assert (rows[..., 6] == -1).all()


def test_plain_python_which_takes_one_number_at_once_finds_the_same():
    arm = chain(4)
    T = arm.fk(np.random.default_rng(0).uniform(-np.pi, np.pi, (3, 6)))
    rows, counts = solved(arm, T, 1, 2)
    others, other_counts = solved(arm, T, 1, 2, run=plain)
    np.testing.assert_array_equal(counts, other_counts)
    known = rows[:, :, 6] >= 0
    # each within 1e-7 of its pose, to which Newton's rule has come quadratically
    np.testing.assert_allclose(others[known], rows[known], atol=1e-6)


def test_a_target_that_is_not_finite_has_no_solution_and_leaves_the_others_alone():
    arm = chain(4)
    T = arm.fk(np.random.default_rng(0).uniform(-np.pi, np.pi, (3, 6)))
    rows, _ = solved(arm, T, 0, 0)
    broken = T.copy()
    broken[0] = np.nan
    others, other_counts = solved(arm, broken, 0, 0)
    assert other_counts[0].tolist() == [elimination_kernels.DEGENERATE, 1.0]
    np.testing.assert_array_equal(others[1:], rows[1:])


def test_quarters_of_the_circle_tell_what_the_whole_is_not_sure_of():
    arm = pk.load("jaco").chain()
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (400, 6))
    T = arm.fk(q)
    _, whole = solved(arm, T, 1, 5)
    rows, counts = solved(arm, T, 1, 5, 1)
    told = (whole[:, 1] == 1) & (counts[:, 1] == 0)
    assert told.sum() > 20
    off = np.abs((rows[..., :6] - q[:, None] + np.pi) % (2 * np.pi) - np.pi).max(axis=2)
    off = np.where(rows[..., 6] >= 0, off, np.inf).min(axis=1)
    assert (off[counts[:, 1] == 0] < 1e-6).all()
