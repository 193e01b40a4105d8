"""A zero offset of an end joint is told from a turned base or tool by the joint's limits."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.analysis.compare.compare import compare
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain


def chain_of_kinds(first, last):
    """An arm of four joints with limits, of which the first and the last are of these kinds."""
    make = {"revolute": screw.revolute, "prismatic": lambda z, p: screw.prismatic(z)}
    rows = [
        make[first]([0, 0, 1], [0, 0, 0]),
        screw.revolute([0, 1, 0], [0, 0, 0.4]),
        screw.revolute([1, 0, 0], [0.1, 0, 0.8]),
        make[last]([0, 0.6, 0.8], [0.3, 0.1, 0.9]),
    ]
    limits = [[-1.0, 1.5]] * 4
    return Chain.from_space(rows, np.eye(4), limits=limits)


@pytest.mark.parametrize("kind, size", [("revolute", "5.73°"), ("prismatic", "100 mm")])
@pytest.mark.parametrize("end", [0, 3])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_limits_that_moved_by_as_much_say_that_it_is_the_zero(kind, size, end, way):
    kinds = ["revolute", "revolute"]
    kinds[bool(end)] = kind
    chain = chain_of_kinds(*kinds)
    q = np.zeros(4)
    q[end] = 0.1
    other = chain.rezeroed(q)
    if way < 0:
        signs = np.where(np.arange(4) == end, -1.0, 1.0)
        limits = np.sort(other.limits * signs[:, None], axis=1)
        other = other.replace(screws=other.screws * signs[:, None], limits=limits)
    result = compare(chain, other, samples=3)
    (joint,) = result.differing
    assert joint.number == end + 1
    assert joint.zero_differs
    assert joint.zero_offset == pytest.approx(-0.1 * way, abs=1e-12)
    assert joint.limits == pytest.approx((0, 0), abs=1e-12)
    assert f"has its zero {size} elsewhere" in result.verdict
    assert result.base == pytest.approx(np.eye(4))
    assert result.tool == pytest.approx(np.eye(4))
    assert result.after is not None
    assert result.after.worst_position < 1e-12
    # A first joint reversed is the base turned over about the second axis, too, which may be said.
    assert not any("is the same as a zero offset" in text for text in result.alternatives)
    assert result.outcome == "conventions"


@pytest.mark.parametrize("end, frame", [(0, "base"), (3, "tool")])
def test_limits_whose_numbers_stay_say_that_it_is_the_frame(end, frame):
    chain = chain_of_kinds("revolute", "revolute")
    q = np.zeros(4)
    q[end] = 0.1
    for limits in (chain.limits, np.full((4, 2), [-np.inf, np.inf])):
        one = chain.replace(limits=limits)
        result = compare(one, one.rezeroed(q).replace(limits=limits), samples=3)
        assert result.differing == ()
        assert f"the {frame} frame is " in result.verdict
        assert "turned by 5.73°" in result.verdict
        (alternative,) = result.alternatives
        assert "is the same as a zero offset of" in alternative


def test_limits_that_moved_by_another_amount_count_beside_the_frame():
    chain = chain_of_kinds("revolute", "revolute")
    limits = chain.limits.copy()
    limits[0] -= 0.2
    result = compare(chain, chain.rezeroed([0.1, 0, 0, 0]).replace(limits=limits), samples=3)
    assert "the base frame is turned" in result.verdict
    assert "its lower limit 11.46° lower in model b" in result.verdict


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
@pytest.mark.parametrize("end", [0, 3])
@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("moved", ["base", "tool", "base and tool"])
def test_the_limits_say_it_beside_any_motion_of_base_and_tool_too(kind, end, way, moved):
    """A base that is a free choice does not make limits differ that moved with their zero."""
    kinds = ["revolute", "revolute"]
    kinds[bool(end)] = kind
    chain = chain_of_kinds(*kinds)
    signs = np.where(np.arange(4) == end, way, 1.0)
    q = 0.1 * signs * (np.arange(4) == end)
    other = chain.replace(
        screws=signs[:, None] * chain.screws, limits=np.sort(signs[:, None] * chain.limits)
    ).rezeroed(q)
    motion = se3.exp([0.2, 0.1, -0.3, 0.1, 0, 0.2])
    if "base" in moved:
        other = other.rebased(motion)
    if "tool" in moved:
        other = other.retooled(motion)
    result = compare(chain, other, samples=3, same=("limits",))
    assert result.outcome == "same"
    joint = result.joints[end]
    assert joint.limits == pytest.approx((0, 0), abs=1e-12)
    assert joint.zero_offset == pytest.approx(-q[end], abs=1e-12)
    frames = {"base": result.base, "tool": result.tool}
    for frame, T in frames.items():
        assert T is not None
        assert np.allclose(T, np.eye(4), atol=1e-12) == (frame not in moved)
    assert result.after is not None
    assert result.after.worst_position < 1e-12


def test_limits_that_moved_by_unlike_amounts_leave_the_zero_where_it_is():
    chain = chain_of_kinds("revolute", "revolute")
    limits = chain.limits.copy()
    limits[0] += [-0.2, -0.1]
    other = chain.replace(limits=limits).rebased(se3.exp([0.2, 0.1, -0.3, 0.1, 0, 0]))
    result = compare(chain, other, samples=3)
    assert not any(joint.zero_differs for joint in result.joints)
    assert result.joints[0].limits == pytest.approx((-0.2, -0.1), abs=1e-12)
