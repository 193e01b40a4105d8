"""Every law of a chain's derivatives on chains of all joint kinds, coupled too; and errors that
break each.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings, target
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, ShapeError, UnknownName
from poekin.model.kinematics.derivatives import JacobianChanges, PoseChanges
from poekin.testing.laws.laws import LawViolation
from tests.model.laws.chain_cases import chain_cases
from tests.model.laws.derivative_laws import DERIVATIVE_LAWS

LAWS = {law.name: law for law in DERIVATIVE_LAWS}
# A chain and its truth in 80 digits take some tenths of a second.
FEW = settings(max_examples=max(settings().max_examples // 5, 10))
METHODS = (
    "jacobian_rate",
    "hessian",
    "acceleration",
    "joint_velocities",
    "jacobian_screw_derivatives",
)


@pytest.mark.parametrize("name", LAWS)
@FEW
@given(data=st.data())
def test_derivatives_keep_the_law(name, data):
    options = {"max_joints": 6} if name.startswith(("screw", "hessian_is")) else {}
    target(LAWS[name].check(*data.draw(chain_cases(LAWS[name].kinds, **options))))


@pytest.mark.parametrize("kind", ["revolute", "prismatic", "helical"])
@settings(max_examples=5)
@given(data=st.data())
def test_chains_of_one_kind_keep_every_law(kind, data):
    name = data.draw(st.sampled_from(sorted(LAWS)))
    LAWS[name].check(*data.draw(chain_cases(LAWS[name].kinds, joint_kinds=(kind,), max_joints=5)))


@pytest.mark.parametrize("joints", [0, 1, 12])
@pytest.mark.parametrize("name", [name for name in LAWS if "joint" not in LAWS[name].kinds])
@settings(max_examples=2)
@given(data=st.data())
def test_the_shortest_and_the_longest_chains_keep_the_law(name, joints, data):
    LAWS[name].check(
        *data.draw(chain_cases(LAWS[name].kinds, min_joints=joints, max_joints=joints))
    )


def crane() -> pk.Chain:
    """Turn, slide, screw and a joint that follows the first at half its rate, none of them at a
    special place.
    """
    A = [
        [0, 0.6, 0.8, 0.3, 0.8, -0.6],
        [0, 0, 0, 0.8, 0, 0.6],
        [1, 0, 0, 0.1, 0.2, -0.4],
        [0.8, 0, 0.6, 0.6, 1.0, -0.8],
    ]
    home = pk.se3.exp([0.3, -0.4, 0.9, 0.5, 0.2, -0.7])
    return pk.Chain.from_space(
        A,
        home,
        q_names=["a", "b", "c"],
        coupling=[[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0, 0]],
        offset=[0, 0, 0.1, 0],
    )


class Wrong:
    """A chain, one of whose methods answers wrongly."""

    def __init__(self, chain: Any, method: str, answer: Any):
        self._inner, self._method, self._answer = chain, method, answer

    def __getattr__(self, name: str) -> Any:
        chain = self.__dict__["_inner"]
        if name != self.__dict__["_method"]:
            return getattr(chain, name)
        return lambda *arguments, **options: self.__dict__["_answer"](chain, *arguments, **options)


def classical_for_spatial(chain, q, dq, ddq, frame):
    """R^T p'' in the body frame's linear part."""
    A, V = chain.acceleration(q, dq, ddq, frame), chain.velocity(q, dq, frame)
    return A + np.concatenate([np.zeros(3), np.cross(V[:3], V[3:])]) if frame == "body" else A


def by_body(chain, q, wrt="twist"):
    motion = chain.screw_derivatives(q, wrt)
    return PoseChanges(motion.screws, pk.se3.adjoint(pk.se3.inverse(chain.fk(q))) @ motion.home)


def tail_of_screws(chain, q, wrt="twist"):
    """Only the joint's own exponential moves, not what carries it back: Ad(P_{i-1})."""
    motion = chain.screw_derivatives(q, wrt)
    return PoseChanges(0.999999999 * motion.screws, motion.home)


def without_home(chain, q, frame):
    change = chain.jacobian_screw_derivatives(q, frame)
    return JacobianChanges(change.screws, np.zeros_like(change.home))


PLANTED = {
    "a rate 1e-12 off": ("jacobian_rate", lambda c, *a: c.jacobian_rate(*a) * (1 + 1e-12), "jacobian_rate_is"),
    "hybrid for body": ("jacobian_rate", lambda c, q, dq, f: c.jacobian_rate(q, dq, "hybrid"), "jacobian_rate_is"),
    "indices swapped": ("hessian", lambda c, *a: np.swapaxes(c.hessian(*a), -1, -2), "hessian_is"),
    "half of the Hessian": ("hessian", lambda c, *a: np.tril(c.hessian(*a)), "hessian_of"),
    "classical for spatial": ("acceleration", classical_for_spatial, "acceleration"),
    "without ddq": ("acceleration", lambda c, q, dq, ddq, f: c.acceleration(q, dq, 0 * ddq, f), "acceleration"),
    "one joint late": (
        "joint_velocities", lambda c, *a: np.roll(c.joint_velocities(*a), 1, axis=-2), "joint_velocities"
    ),
    "home by its body twist": ("screw_derivatives", by_body, "screw_derivatives"),
    "screws 1e-9 short": ("screw_derivatives", tail_of_screws, "screw_derivatives"),
    "a home that moves nothing": ("jacobian_screw_derivatives", without_home, "screw_derivatives"),
    "the first of a batch for all": (
        "hessian",
        lambda c, q, f: np.broadcast_to(c.hessian(q, f).reshape(-1, 6, 3, 3)[0], (*q.shape[:-1], 6, 3, 3)),
        "derivatives_of_batches",
    ),
}  # fmt: skip


@pytest.mark.parametrize("fault", PLANTED)
def test_the_laws_see_what_is_wrong(fault):
    method, answer, start = PLANTED[fault]
    (law,) = (law for name, law in LAWS.items() if name.startswith(start))
    batch = np.array([[0.3, -0.2, 0.5], [1.0, 0.4, -0.7]])
    given_ = {"q": batch[0], "dq": np.array([0.7, 0.4, -1.1]), "joint": 2, "batch": batch}
    arguments = [given_[kind] for kind in law.kinds]
    assert law.check(crane(), *arguments) <= 1
    with pytest.raises(LawViolation):
        law.check(Wrong(crane(), method, answer), *arguments)


def test_configurations_and_rates_broadcast_and_may_be_dicts():
    arm, rng = crane(), np.random.default_rng(0)
    q, dq = rng.normal(size=(4, 1, 3)), rng.normal(size=(2, 3))
    assert arm.jacobian_rate(q, dq, "space").shape == (4, 2, 6, 3)
    assert arm.acceleration(q, dq, dq, "body").shape == (4, 2, 6)
    assert arm.jacobian_rate(q[0, 0], dq, "space").shape == (2, 6, 3)
    named = dict(zip("abc", q[0, 0], strict=True))
    np.testing.assert_array_equal(arm.hessian(named, "hybrid"), arm.hessian(q[0, 0], "hybrid"))


def test_nan_in_one_configuration_stays_there():
    arm = crane()
    H = arm.hessian([[0.1, 0.2, 0.3], [np.nan, 0, 0]], "space")
    assert np.isfinite(H[0]).all()
    assert np.isnan(H[1]).any()


def test_the_acceleration_on_a_circle_points_to_its_centre():
    arm = pk.Chain.from_space([[0, 0, 1, 0, 0, 0]], pk.se3.exp([0, 0, 0, 2.0, 0, 0]))
    np.testing.assert_allclose(
        arm.acceleration([0.0], [3.0], [0.0], "hybrid"), [0, 0, 0, -18, 0, 0], rtol=0, atol=1e-14
    )
    # the twist of a steady turn does not change, in either of the frames that are rigid with base
    # or tool
    for frame in ("space", "body"):
        np.testing.assert_allclose(
            arm.acceleration([0.4], [3.0], [0.0], frame), np.zeros(6), rtol=0, atol=1e-14
        )


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("frame", ["tool", 0, None, ["body"]])
def test_a_frame_that_is_none_is_refused(method, frame):
    rates = {"jacobian_rate": 1, "acceleration": 2, "joint_velocities": 1}.get(method, 0)
    with pytest.raises(InputError, match=r"^frame: expected 'space', 'body' or 'hybrid', got "):
        getattr(crane(), method)(np.zeros(3), *[np.zeros(3)] * rates, frame)


def test_what_does_not_fit_is_said_with_its_name():
    arm = crane()
    with pytest.raises(ShapeError, match=r"^dq: expected 3 coordinates on the last axis"):
        arm.jacobian_rate(np.zeros(3), np.zeros(4), "body")
    with pytest.raises(
        ShapeError, match=r"^q, dq, ddq do not broadcast: shapes \(2, 3\), \(4, 3\), \(3,\)"
    ):
        arm.acceleration(np.zeros((2, 3)), np.zeros((4, 3)), np.zeros(3), "body")
    with pytest.raises(UnknownName, match=r"no coordinate 'd'"):
        arm.hessian({"a": 0, "b": 0, "d": 0}, "body")
    with pytest.raises(InputError, match=r"^wrt: expected 'twist' or 'components', got 'eta'"):
        arm.screw_derivatives(np.zeros(3), wrt="eta")  # type: ignore[arg-type]
