"""Manipulability: values by other means, its gradient against differences, what it does at a
singularity.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.analysis.dexterity.jacobian_part import ROWS, generic_rank
from poekin.analysis.dexterity.manipulability import (
    Measures,
    manipulability,
    manipulability_gradient,
)
from poekin.errors import InputError
from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.oracles import differences
from tests.model.laws.chain_bounds import budget
from tests.model.laws.chain_cases import chain_cases

FEW = settings(max_examples=max(settings().max_examples // 3, 20))


def planar(*lengths):
    """A planar arm of revolute joints about z."""
    at = np.concatenate([[0.0], np.cumsum(lengths)])
    return pk.Chain.from_space(
        [[0, 0, 1, 0, -x, 0] for x in at[:-1]], pk.se3.exp([0, 0, 0, at[-1], 0, 0])
    )


def test_yoshikawa_of_a_planar_arm_is_l1_l2_sin_q2():
    # its 2 × 2 Jacobian has the determinant l1 l2 sin q2; the third row of translation is zero, the
    # two rates are not
    q = np.random.default_rng(0).uniform(-3, 3, (20, 2))
    np.testing.assert_allclose(
        manipulability(planar(0.4, 0.3), q).translation.yoshikawa,
        np.abs(0.12 * np.sin(q[:, 1])),
        rtol=0,
        atol=1e-15,
    )


@FEW
@given(data=st.data())
def test_the_six_rows_give_the_root_of_the_determinant_in_every_frame(data):
    chain, q = data.draw(chain_cases(("q",), min_joints=6, max_joints=9, coupled=False))
    if generic_rank(chain, "pose") < 6:
        return  # fewer singular values count, which are those of one frame
    value = manipulability(chain, q).pose.yoshikawa
    for frame in ("space", "body"):
        J = chain.jacobian(q, frame)
        size = np.linalg.norm(J, 2)
        # each of six factors is off by what either Jacobian is, its columns by twice the pose, and
        # by the decomposition
        off = 2 * 2 * budget(chain, q)[1] * np.sqrt(chain.dof) + 60 * UNIT * size
        assert abs(np.prod(np.linalg.svd(J, compute_uv=False)[:6]) - value) <= 6 * off * size**5


@FEW
@given(data=st.data(), part=st.sampled_from(sorted(ROWS)))
def test_the_gradient_is_the_derivative(data, part):
    chain, q, dq = data.draw(chain_cases(("q", "dq"), min_joints=1, max_joints=8))
    rate = max(float(np.abs(chain.coupling @ dq).sum()), 1e-3)
    here = chain.jacobian(q, "hybrid")
    size = max(float(np.linalg.norm(here, 2)), 1.0) ** 6
    values = getattr(manipulability(chain, q), part)
    # w is a product of absolute values: at a kink there is no derivative to compare with, and near
    # one the
    # stencil would reach across it
    assume(values.yoshikawa > 0 and values.condition < 30)
    step = 60 * rate
    wanted = differences.derivative(
        lambda at: getattr(manipulability(chain, at), part).yoshikawa, q, dq, step
    )
    found = manipulability_gradient(chain, q, part=part) @ dq
    # rounding of w over a step of 1/600 of the rate
    assert abs(found - wanted) <= 1e-9 * size * max(rate, 1)


@pytest.mark.parametrize(("q2", "slope"), [(0.0, 0.12), (np.pi, -0.12), (np.pi / 2, 0.0)])
def test_at_a_singularity_the_gradient_is_the_slope_of_one_side(q2, slope):
    found = manipulability_gradient(planar(0.4, 0.3), [0.7, q2], part="translation")
    np.testing.assert_allclose(np.abs(found), [0, abs(slope)], rtol=0, atol=1e-15)


def test_a_gradient_with_half_of_the_hessian_is_seen(monkeypatch):
    arm, q = (
        pk.load("panda").chain(tip="panda_hand"),
        np.array([0.1, -0.5, 0.3, -1.9, 0.2, 1.4, 0.6]),
    )
    wanted = differences.derivative(
        lambda at: manipulability(arm, at).pose.yoshikawa, q, np.ones(7), 60
    )
    assert abs(manipulability_gradient(arm, q).sum() - wanted) < 1e-10
    whole = pk.Chain.hessian
    monkeypatch.setattr(pk.Chain, "hessian", lambda self, q, frame: np.tril(whole(self, q, frame)))
    assert abs(manipulability_gradient(arm, q).sum() - wanted) > 1e-3


def test_condition_is_infinite_and_smallest_zero_where_the_arm_is_stretched():
    measures = manipulability(planar(1.0, 1.0, 1.0), np.zeros(3)).translation
    assert measures.smallest < 1e-16
    assert measures.yoshikawa == measures.smallest * 0
    assert measures.condition > 1e15


def test_lengths_in_other_units_change_the_six_rows_only():
    arm, q = (
        pk.load("panda").chain(tip="panda_hand"),
        np.array([0.1, -0.5, 0.3, -1.9, 0.2, 1.4, 0.6]),
    )
    metres, decimetres = manipulability(arm, q), manipulability(arm, q, length=0.1)
    np.testing.assert_allclose(decimetres.pose.yoshikawa, 1000 * metres.pose.yoshikawa, rtol=1e-12)
    assert decimetres.to_dict()["translation"] == metres.to_dict()["translation"]
    assert decimetres.to_dict()["rotation"] == metres.to_dict()["rotation"]


def test_the_gradient_of_the_six_rows_has_the_unit_of_length_that_is_asked_for():
    arm, q = pk.load("ur5e").chain(tip="tool0"), [0.1, -0.7, 0.9, 0.4, 0.8, 0.2]
    metres = manipulability_gradient(arm, q)
    np.testing.assert_allclose(
        manipulability_gradient(arm, q, length=0.1), 1000 * metres, rtol=1e-9, atol=1e-12
    )


def test_batches_have_their_shapes_and_nan_stays_where_it_is():
    arm = planar(0.4, 0.3, 0.2)
    for shape in ((), (0,), (3, 1, 2)):
        q = np.full((*shape, 3), 0.3)
        assert {
            np.shape(x)
            for measures in vars(manipulability(arm, q)).values()
            for x in vars(measures).values()
        } == {shape}
        assert manipulability_gradient(arm, q).shape == (*shape, 3)
    q = np.array([[0.1, 0.2, 0.3], [0.1, np.nan, 0.3]])
    assert np.array_equal(np.isnan(manipulability(arm, q).pose.yoshikawa), [False, True])
    assert np.array_equal(np.isnan(manipulability_gradient(arm, q)).any(-1), [False, True])


def test_what_cannot_be_judged_is_refused():
    with pytest.raises(InputError, match=r"^the chain has no coordinate"):
        manipulability(pk.Chain.from_space(np.zeros((0, 6)), np.eye(4)), [])
    with pytest.raises(InputError, match=r"^length: expected a positive number, got 0"):
        manipulability(planar(1.0), [0.0], length=0)
    with pytest.raises(
        InputError, match=r"^part: expected 'pose', 'translation' or 'rotation', got 'linear'"
    ):
        manipulability_gradient(planar(1.0), [0.0], part="linear")  # pyright: ignore[reportArgumentType]
    with pytest.raises(
        InputError, match=r"^chain: expected a Chain, as Robot.chain\(tip=...\) makes it, got 3"
    ):
        manipulability(3, [0.0])  # type: ignore[arg-type]


@pytest.mark.parametrize("length", [0, -1.0, float("inf"), float("nan"), "1", None, True])
def test_a_length_is_a_positive_number_of_metres(length):
    chain = pk.load("ur5e").chain(tip="tool0")
    with pytest.raises(InputError) as caught:
        pk.manipulability(chain, np.zeros(6), length=length)
    assert str(caught.value) == f"length: expected a positive number, got {length!r}"


def test_without_a_length_lengths_are_in_metres():
    chain, q = pk.load("ur5e").chain(tip="tool0"), np.array([0.1, -0.7, 0.9, 0.4, 0.8, 0.2])
    assert manipulability(chain, q).to_dict() == manipulability(chain, q, length=1.0).to_dict()
    np.testing.assert_array_equal(
        manipulability_gradient(chain, q), manipulability_gradient(chain, q, length=1.0)
    )
    other = manipulability(chain, q, length=2.0)
    assert other.pose.yoshikawa != manipulability(chain, q).pose.yoshikawa


def test_measures_of_a_batch_are_summed_up_by_the_worst_of_each_and_no_zero_has_a_sign():
    three = Measures(
        yoshikawa=np.array([0.25, 0.123456, 0.5]),
        condition=np.array([3.0, 4.5, 2.0]),
        smallest=np.array([0.2, 0.3, -0.0]),
    )
    assert three.summary() == "yoshikawa 0.1235, condition 4.5, smallest 0"
    one = Measures(*np.array([0.25, 3.0, 0.2]))
    assert str(one) == "yoshikawa 0.25, condition 3, smallest 0.2"
    none = Measures(*np.empty((3, 0)))
    assert none.summary() == "no configuration"
