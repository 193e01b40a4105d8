"""The three forms of one arm make one chain, and a frame is never assumed."""

# pyright: reportArgumentType=false

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, PoseError, ScrewError, ShapeError
from poekin.groups import se3
from poekin.model.methods import entrances
from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.strategies import chain_strategies
from tests.messages import says

TURN = [0, 0, 1, 0, 0, 0]
SLIDE = [0, 0, 0, 1, 0, 0]
HOME = se3.exp([0.3, -0.2, 0.1, 0.5, 1.0, -0.4])
CONSTRUCTOR = pk.Chain
CHOICES = "; or write Chain.from_space(A, M), from_body(B, M) or from_local(S, M_i)"


def options(chain):
    """All that a chain has besides its screws and its home pose."""
    names = ("joint_names", "q_names", "limits", "offset", "base", "tip", "pitches")
    return {**{name: getattr(chain, name) for name in names}, "coupling": chain.coupling}


def local_screws(chain):
    """The chain's own local form: each screw is (0, 0, r; 0, 0, s) in its joint's frame."""
    S = np.zeros((len(chain.kinds), 6))
    S[:, 2] = chain.local.rotates
    S[:, 5] = chain.local.slides
    return S


def from_local(chain):
    *frames, tool = chain.local.frames
    return pk.Chain.from_local(local_screws(chain), frames, tool, **options(chain))


def distance(one, other):
    """Greatest difference of screws and home poses, in units of rounding of the reach."""
    rounding = UNIT * one.reach * 10 * (len(one.kinds) + 1)
    screws = np.abs(one.screws - other.screws).max(initial=0)
    return max(screws, np.abs(one.home - other.home).max()) / rounding


@given(chain_strategies.chains())
def test_each_form_of_a_chain_makes_it_again(chain):
    body = pk.Chain.from_body(chain.body.screws, chain.home, **options(chain))
    for again in (body, from_local(chain)):
        assert distance(chain, again) <= 1
        assert again.kinds == chain.kinds
        assert (again.q_names, again.base, again.tip) == (chain.q_names, chain.base, chain.tip)
        np.testing.assert_array_equal(again.limits, chain.limits)
        np.testing.assert_array_equal(again.coupling, chain.coupling)
    assert pk.Chain.from_space(*chain.space, **options(chain)) == chain
    assert pk.Chain(*chain.space, frame="space", **options(chain)) == chain


@given(st.floats(-1e6, 1e6))
def test_a_far_tool_makes_no_pitch_of_its_rounding(far):
    M = se3.exp([0.1, 0.2, 0.3, far, -far, far])
    for chain in (
        pk.Chain.from_body([TURN, SLIDE], M),
        pk.Chain.from_local([TURN, SLIDE], [M, M]),
    ):
        assert chain.kinds == ("revolute", "prismatic")


def test_the_tool_of_the_local_form_is_the_identity_where_it_is_left_out():
    chain = pk.Chain.from_local([TURN], [HOME])
    np.testing.assert_allclose(chain.home, HOME, rtol=0, atol=1e-15)
    assert pk.Chain.from_local([], [], HOME).home == pytest.approx(HOME, abs=1e-15)


@pytest.mark.parametrize("wrong", ["home first", "one link's frame for another"])
def test_a_planted_error_is_caught(wrong, monkeypatch):
    chain = pk.load("ur5e").chain()
    if wrong == "home first":
        body = pk.Chain.from_body(chain.screws, chain.home)
        assert distance(chain, body) > 1
        return
    adjoint = se3.adjoint
    monkeypatch.setattr(entrances.se3, "adjoint", lambda P: adjoint(se3.inverse(P)))
    assert distance(chain, from_local(chain)) > 1


REFUSED = {
    "no frame": (lambda: CONSTRUCTOR([TURN], HOME), InputError,
                 f"frame: expected 'space' or 'body', it was left out{CHOICES}"),
    "another frame": (lambda: pk.Chain([TURN], HOME, frame="hybrid"), InputError,
                      f"frame: expected 'space' or 'body', got 'hybrid'{CHOICES}"),
    "no text": (lambda: pk.Chain([TURN], HOME, frame=["space"]), InputError,
                f"frame: expected 'space' or 'body', got ['space']{CHOICES}"),
    "one pose too many": (lambda: pk.Chain.from_local([TURN], [HOME, HOME]), ShapeError,
                          "M_i: expected shape (1, 4, 4), one pose a joint and M_{n+1} as tool=, got (2, 4, 4)"),
    "no poses": (lambda: pk.Chain.from_local([TURN], []), ShapeError,
                 "M_i: expected shape (1, 4, 4), one pose a joint and M_{n+1} as tool=, got (0,)"),
    "a local screw": (lambda: pk.Chain.from_local([[0, 0, 3, 0, 0, 0]], [HOME], joint_names=["a"]), ScrewError,
                      "S[0] (joint 'a'): omega must have length 1 to 1e-09, got 3 in [0.0, 0.0, 3.0, 0.0, 0.0, 0.0]"),
    "a link": (lambda: pk.Chain.from_local([TURN, TURN], [HOME, np.diag([1, 1, -1, 1])]), PoseError,
               "M_i[1] is no pose: its rotation is a reflection, det R = -1, expected 1"),
    "a tool": (lambda: pk.Chain.from_local([TURN], [HOME], np.diag([1, 1, -1, 1])), PoseError,
               "tool is no pose: its rotation is a reflection, det R = -1, expected 1"),
}  # fmt: skip


@pytest.mark.parametrize("call, error, message", REFUSED.values(), ids=REFUSED)
def test_what_makes_no_chain_is_said(call, error, message):
    with pytest.raises(error) as caught:
        call()
    assert says(caught.value, message)
