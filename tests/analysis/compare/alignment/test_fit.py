"""fit steps many starts at once, each as if it were alone, along the residuals' true derivatives."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.planted_changes import planted, random_arm
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.alignment import fit as fitting
from poekin.analysis.compare.alignment.alignments import Alignments
from poekin.analysis.compare.alignment.fit import _linearised, _step, fit
from poekin.analysis.compare.alignment.lines import sides
from poekin.groups import se3

KINDS = ("revolute", "revolute", "prismatic", "revolute", "revolute")


def near(seed, count):
    """Two arms that differ in one axis, alignments that all but hold, and joints free and used at
    random.
    """
    rng = np.random.default_rng(seed)
    chain = random_arm(seed + 50, KINDS)
    pair = sides(chain, planted(chain, "shift", 3, rng), Tolerances(1e-5, 1e-5))
    P, z = se3.exp(1e-3 * rng.normal(size=(count, 6))), 1e-3 * rng.normal(size=(count, 5))
    return pair, Alignments(P, z), rng.random((count, 5)) < 0.4, rng.random((count, 5)) < 0.8


def moved(at, xi, change):
    """Alignments whose bases a twist moves, and whose zero offsets change."""
    return Alignments(se3.exp(xi) @ at.P, at.z + change)


@pytest.mark.parametrize("hinge", [-1, 0, 1, 2, 3])
def test_the_derivatives_are_those_of_the_residuals(hinge):
    pair, at, free, used = near(0, 4)
    pair, h = replace(pair, suspect_joint=hinge), 1e-6
    shares = used.astype(float)
    J = _linearised(pair, at, free, shares).J
    for c, xi in enumerate(np.eye(11)):
        ahead, back = (
            _linearised(pair, moved(at, t * xi[:6], t * xi[6:] * free), free, shares).r
            for t in (h, -h)
        )
        # 1e5 tolerances a metre or radian: of central differences they leave h^2 and, by rounding,
        # u / h.
        assert J[:, :, c] == pytest.approx((ahead - back) / (2 * h), abs=1e-3)
    assert np.abs(J).max() > 1e4


def test_starts_fitted_together_come_out_as_each_alone():
    pair, at, free, used = near(1, 6)
    together = fit(pair, at, free, used)
    for i in range(6):
        alone = fit(pair, at[i : i + 1], free[i], used[i])
        assert together.P[i] == pytest.approx(alone.P[0], abs=1e-12)
        assert together.z[i] == pytest.approx(alone.z[0], abs=1e-12)
    assert (together.z == at.z)[~free].all()


def test_a_fit_takes_the_base_and_the_free_zero_offsets_to_where_the_used_axes_agree():
    pair, at, _, _ = near(2, 3)
    inner = np.array([False, True, True, True, False])
    used = np.arange(5) != 3
    fitted = fit(pair, Alignments(at.P, at.z * inner), inner, used)
    miss = pair.deviations(fitted)
    assert miss[:, used].max() < 1e-6
    assert miss[:, ~used].min() > 99  # the shift of 1 mm, in tolerances of 0.01 mm
    base = np.eye(4)
    base[:3, 3] = pair.b.centre - pair.a.centre
    assert pytest.approx(np.tile(base, (3, 1, 1)), abs=1e-9) == fitted.P
    assert fitted.z == pytest.approx(np.zeros((3, 5)), abs=1e-9)


def test_axes_of_two_kinds_are_fitted_to_no_place():
    pair, at, _, _ = near(2, 3)
    unlike = replace(pair, alike=np.arange(5) != 3)
    fitted = fit(unlike, Alignments(at.P, 0.0 * at.z), False, True)
    # the one axis that was shifted is not told apart: the others agree
    assert unlike.deviations(fitted)[:, unlike.alike].max() < 1e-6


def test_a_step_lessens_residuals_held_back_by_each_coordinate_s_own_size():
    rng = np.random.default_rng(0)
    r, J, damping = (
        rng.normal(size=(4, 9)),
        rng.normal(size=(4, 9, 3)) * [1, 50, 0.02],
        np.array([0, 1e-6, 0.1, 7.0]),
    )
    for step, e, D, held in zip(_step(r, J, damping), r, J, damping, strict=True):
        damped = np.concatenate([D, np.sqrt(held) * np.diag(np.linalg.norm(D, axis=0))])
        assert step == pytest.approx(
            np.linalg.lstsq(damped, -np.append(e, np.zeros(3)), rcond=None)[0], rel=1e-9
        )


@pytest.mark.parametrize("size, held", [(2e-6, 2e-6), (0.5e-6, 1.0), (0.0, 1.0)])
def test_a_coordinate_that_moves_nothing_is_held_back_by_the_size_of_the_largest(size, held):
    J = 1e-3 * np.diag([1.0, size])[None]  # beside the largest, a millionth is nothing
    step = _step(np.array([[1.0, 1.0]]), J, np.array([0.25]))[0]
    assert 1e-3 * step == pytest.approx([-1 / 1.25, -size / (size * size + 0.25 * held * held)])
    assert (_step(np.ones((1, 2)), np.zeros((1, 2, 2)), np.array([0.25])) == 0).all()


def counted(monkeypatch, most, *arguments):
    """What a fit of so many steps at most finds, and how many it takes."""
    taken = []
    monkeypatch.setattr(fitting, "STEPS", most)
    monkeypatch.setattr(fitting, "_linearised", lambda *x: taken.append(1) or _linearised(*x))
    return fit(*arguments), len(taken) - 1


def test_a_fit_that_starts_near_takes_few_steps_and_ends_where_none_helps(monkeypatch):
    pair, at, _, _ = near(2, 3)
    free, used = np.array([False, True, True, True, False]), np.arange(5) != 3
    start = Alignments(at.P, at.z * free)
    there, taken = counted(monkeypatch, 60, pair, start, free, used)
    assert taken <= 6
    # The error squares itself: from 100 tolerances beyond 1e-9 in four steps.
    fitted, _ = counted(monkeypatch, 4, pair, start, free, used)
    assert pair.deviations(fitted)[:, used].max() < 1e-8
    # With the axis that differs too, the least squares are none that vanish: from there no step
    # promises a gain, so that no shorter ones are tried.
    least, _ = counted(monkeypatch, 60, pair, start, free, used | True)
    again, taken = counted(monkeypatch, 60, pair, least, free, used | True)
    assert pytest.approx(least.P, abs=1e-9) == again.P
    assert 1 <= taken <= 3
    assert counted(monkeypatch, 60, pair, there, free, used)[1] <= 1
    # A tenth of a tolerance is still too much, and nothing at all is not.
    chain = random_arm(50, KINDS)
    same = sides(chain, chain, Tolerances(1e-5, 1e-5))
    here = same.as_they_stand
    off = se3.exp(np.array([[0, 0, 0, 1e-6, 0, 0]]))
    found, _ = counted(monkeypatch, 60, same, Alignments.rigid(off, 5), free, used)
    assert pytest.approx(here.P, abs=1e-12) == found.P
    assert counted(monkeypatch, 60, same, here, free, used)[1] == 0


def scripted(monkeypatch, costs, size=1.0):
    """The dampings of the steps of a fit whose start and trials cost that much, and the number of the
    alignments that it ends at; every step promises a gain of `size` or so.
    """
    pair, at, _, _ = near(0, 1)
    script, seen, dampings = iter(costs), [], []

    def linearised(_pair, tried, *_):
        seen.append(tried.z.copy())
        r = np.full((1, 30), np.sqrt(size))
        return fitting.Linearised(tried, r, np.eye(30, 11)[None], np.array([next(script)]))

    def step(r, J, damping):
        dampings.append(damping[0])
        return _step(r, J, damping)

    monkeypatch.setattr(fitting, "_linearised", linearised)
    monkeypatch.setattr(fitting, "_step", step)
    found = fit(pair, at, True, True)
    (number,) = [k for k, z in enumerate(seen) if (z == found.z).all()]
    return np.array(dampings), number


def test_damping_grows_after_a_loss_and_eases_after_a_gain(monkeypatch):
    costs = [90.0, 95.0, 99.0, 80.0, 70.0, 85.0, 60.0, 1e-17]
    dampings, end = scripted(monkeypatch, costs)
    assert end == len(costs) - 1
    best = np.minimum.accumulate(costs)
    lost = np.array(costs[1:]) > best[:-1]
    changes = np.log10(dampings[1:] / dampings[:-1])
    assert (changes[lost[:-1]] > 0.5).all()
    assert (changes[~lost[:-1]] < -0.5).all()


def test_a_step_that_promises_a_gain_is_tried_ever_shorter_until_the_damping_is_a_thousand(
    monkeypatch,
):
    dampings, end = scripted(monkeypatch, [90.0] + 30 * [91.0])
    assert end == 0
    assert (dampings[1:] > 3 * dampings[:-1]).all()
    assert 900 < dampings[-1] < 20_000
    # One that promises nothing to speak of is not.
    assert len(scripted(monkeypatch, [90.0] + 30 * [91.0], size=1e-13)[0]) == 1


@pytest.mark.parametrize("costs, end", [
    ([90.0, 90.0 - 2 * 90e-12, 50.0, 1e-17], 3),
    ([90.0, 90.0 - 0.5 * 90e-12, 50.0], 1),
    ([90.0, 2e-16, 1e-17], 2),
    ([90.0, 0.5e-16, 1e-17], 1),
    ([2e-16, 1e-17], 1),
    ([0.5e-16, 1e-17], 0),
])  # fmt: skip
def test_a_fit_ends_where_a_gain_is_a_millionth_of_a_millionth_or_nothing_is_left(
    monkeypatch, costs, end
):
    assert scripted(monkeypatch, costs)[1] == end
