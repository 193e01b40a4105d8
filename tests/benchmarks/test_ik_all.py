"""What judges every solution in the report sees what is missing, what is off, and what is no solution
of EAIK's.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import poekin as pk
from benchmarks.calibrated_arm import calibrated_ur10e
from benchmarks.cases import ik_all, ik_all_judge, ik_all_time
from benchmarks.cases.ik_all_judge import Eaik, errors, missed
from benchmarks.cases.ik_all_time import OURS, measured
from tests.solve.ik_all import perturbed

COUNT = 20


@pytest.fixture(scope="module")
def ur5():
    return pk.load("ur5").chain()


@pytest.fixture(scope="module")
def targets(ur5):
    return ur5.fk(np.random.default_rng(2).uniform(-np.pi, np.pi, (COUNT, ur5.dof)))


@pytest.fixture(scope="module")
def found(ur5, targets):
    return pk.ik_all(ur5, targets, limits=False)


def test_a_solution_that_is_not_listed_is_counted_as_missed(found):
    assert not missed(found, found).any()
    fewer = found.counts.copy()
    fewer[3] -= 1
    start = found.counts[:3].sum()
    shorter = replace(found, q=np.delete(found.q, start, axis=0), counts=fewer)
    assert missed(shorter, found).tolist() == [int(k == 3) for k in range(COUNT)]
    assert not missed(found, shorter).any()


def test_a_solution_that_is_off_shows_in_the_errors_by_fk(ur5, targets, found):
    assert max(errors(ur5, found.q, found.counts, targets)) <= 1e-10
    # The tool turns by as much as the last joint is off.
    off = found.q.copy()
    off[3, 5] += 1e-6
    _, rotation = errors(ur5, off, found.counts, targets)
    assert rotation == pytest.approx(1e-6, rel=1e-3)


def test_the_solutions_of_eaik_are_those_that_reach_the_target(ur5, targets, found):
    pytest.importorskip("eaik")
    eaik = Eaik(ur5)
    own = eaik.targets(targets)
    far = targets.copy()
    far[0, :3, 3] += 10 * ur5.reach
    for answers in (eaik.each(own), eaik.batch(own, 1)):
        q, counts = eaik.own(answers, targets)
        assert counts.tolist() == found.counts.tolist()
        assert max(errors(ur5, q, counts, targets)) <= 1e-10
        assert eaik.own(answers, far)[1][0] == 0
    assert eaik.own(eaik.each(eaik.targets(far)), far)[1][0] == 0


def test_each_way_stands_with_its_time_and_its_solutions(ur5):
    pytest.importorskip("eaik")
    one = measured("UR5", ur5, COUNT, 1)
    assert one.ways[0].name == OURS
    assert len({*one.solutions}) == 1
    assert one.fastest is min(one.ways[1:], key=lambda way: way.time.median)
    assert all(way.error <= 1e-10 for way in one.ways)


def test_the_calibrated_arm_is_that_of_the_readme_and_none_of_eaiks():
    chain = calibrated_ur10e()
    # The README rounds its lengths to 1e-9 m and its angles to 1e-8 rad; links are up to 1.2 m long.
    other = perturbed.calibrated_ur10e()
    assert np.abs(chain.screws - other.screws).max() <= 1e-6
    assert np.abs(chain.home - other.home).max() <= 1e-6
    pytest.importorskip("eaik")
    assert not Eaik(chain).solves


@pytest.mark.parametrize("case", [ik_all, ik_all_time])
def test_without_eaik_the_page_says_what_is_not_measured_and_that_no_bar_holds(case, monkeypatch):
    monkeypatch.setattr(ik_all_judge.importlib.util, "find_spec", lambda name: None)
    topic = case.topic(True, lambda line: None)
    (figure,) = topic.figures
    assert figure.note == "EAIK is not installed"
    assert "EAIK" in figure.what
    assert not figure.holds
