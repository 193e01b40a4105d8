"""Another link beside another difference is one link and that difference."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.planted_changes import arm, planted
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.alignment.hypotheses import make_hypotheses
from poekin.analysis.compare.alignment.lines import sides
from poekin.analysis.compare.alignment.links import with_front_link, with_link
from poekin.analysis.compare.alignment.search import _across_a_slide
from poekin.analysis.compare.compare import compare
from poekin.formats import dh
from poekin.groups import se3

TOL = Tolerances(1e-5, np.radians(1e-3))
LINK = se3.exp([0, 0, 0, 0.003, 0.004, 0.002])


def longer(chain, k, T=LINK):
    """The arm with everything behind joint k moved."""
    screws = chain.screws.copy()
    screws[k:] = screws[k:] @ se3.adjoint(T).T
    return chain.replace(screws=screws, home=T @ chain.home)


def as_it_stands(chain, other):
    pair = sides(chain, other, TOL)
    (reading,) = make_hypotheses(pair, pair.as_they_stand)
    return pair, reading


@pytest.mark.parametrize("k", [4, 5])
def test_the_last_axes_and_the_tool_that_moved_together_are_behind_one_link(k):
    chain = arm("panda")
    other = planted(longer(chain, k), "tilt", 1, np.random.default_rng(0))
    pair, reading = as_it_stands(chain, other)
    (reading,) = with_link(pair, [reading])
    assert (reading.link, reading.frames) == (k, 0)
    assert reading.tool == pytest.approx(np.eye(4), abs=1e-9)
    assert np.flatnonzero(reading.beside_link).tolist() == [1]


def test_a_slide_behind_a_link_may_seem_unmoved():
    chain = dh.to_chain(dh.published("stanford"))
    assert chain.kinds[2] == "prismatic"
    turned = LINK @ se3.exp([0.01, 0.02, 0.01, 0, 0, 0])
    for T, moved in ((LINK, False), (turned, True)):
        pair, reading = as_it_stands(chain, longer(chain, 2, T))
        assert reading.moved[2] == moved
        (reading,) = with_link(pair, [reading])
        assert reading.link == 2


def test_axes_that_moved_without_the_tool_or_apart_are_behind_no_link():
    chain = arm("panda")
    other = longer(chain, 5)
    apart = planted(other, "shift", 6, np.random.default_rng(0))
    # One axis and the tool are one axis, and a tool.
    for wrong in (other.replace(home=chain.home), apart, longer(chain, 6)):
        pair, reading = as_it_stands(chain, wrong)
        assert with_link(pair, [reading]) == []


def test_of_readings_looked_at_together_each_has_its_own_link_or_none():
    chain = arm("panda")
    pair, here = as_it_stands(chain, longer(chain, 4))
    wrong = replace(here, moved=np.zeros(7, bool))
    first, second = with_link(pair, [here, wrong, replace(here)])
    assert (first.link, second.link) == (4, 4)
    assert with_link(pair, []) == []


def behind(chain, k, other):
    """A reading aligned to what is behind link k."""
    pair = sides(chain, other, TOL)
    at = pair.as_they_stand
    at.P[0] = _about_centres(pair, se3.inverse(LINK))
    (reading,) = make_hypotheses(pair, at)
    assert reading.moved[:k].all()
    return pair, reading


def _about_centres(pair, T):
    P = T.copy()
    P[:3, 3] += T[:3, :3] @ pair.b.centre - pair.a.centre
    return P


def test_the_first_axes_that_agree_where_the_base_is_are_in_front_of_one_link():
    chain = arm("panda")
    other = planted(longer(chain, 2), "shift", 4, np.random.default_rng(0))
    pair, reading = behind(chain, 2, other)
    found = with_front_link(pair, reading)
    assert found is not None
    assert (found.link, found.frames) == (2, 0)
    assert np.flatnonzero(found.apart).tolist() == [4]
    assert np.flatnonzero(found.beside_link).tolist() == [4]
    assert found.base == pytest.approx(np.eye(4), abs=1e-9)
    assert found.deviations[4] == reading.deviations[4]
    assert with_front_link(pair, replace(reading, link=3)) is None
    turned = replace(reading, directions=-reading.directions)
    assert with_front_link(pair, turned) is None
    pair, reading = behind(chain, 2, planted(other, "tilt", 1, np.random.default_rng(1)))
    assert with_front_link(pair, reading) is None


def test_one_axis_and_a_frame_that_moved_are_a_link_across_a_slide_and_several_axes_are_none():
    chain = dh.to_chain(dh.published("stanford"))
    pair, reading = as_it_stands(chain, longer(chain, 3, se3.exp([0, 0.01, 0, 0.003, 0, 0])))
    assert reading.moved[3:].all()
    one = replace(reading, moved=reading.moved & (np.arange(6) == 5))
    tries = (reading, replace(one, frames=0), replace(one, moved=np.zeros(6, bool)))
    for kept in tries:
        assert _across_a_slide(pair, kept) is kept


def test_a_shift_behind_another_link_is_named_and_sized():
    chain = arm("panda")
    other = planted(longer(chain, 2), "shift", 5, np.random.default_rng(0))
    result = compare(chain, other, samples=5)
    link, joint = result.findings
    assert link.startswith("the link between joint 2 ('panda_joint2') and joint 3 ('panda_joint3')")
    assert joint.startswith("joint 6 ('panda_joint6') has an axis that is 1 mm from the other")
    assert result.outcome == "differ"


def test_the_direction_of_a_slide_is_its_last_three_numbers():
    chain = dh.to_chain(dh.published("stanford"))
    lines = as_it_stands(chain, chain)[0].a
    directions = np.array([axis[lines.part(k)] for k, axis in enumerate(lines.axes)])
    assert np.array_equal(directions, lines.ways)
    assert chain.kinds[2] == "prismatic"
