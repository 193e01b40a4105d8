"""Every law of a chain on chains of all joint kinds, 0 to 12 joints, coupled too; and errors that
break each.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings, target
from hypothesis import strategies as st

from poekin.groups import se3
from poekin.model.chain import Chain
from poekin.model.kinematics.pose_jacobian import Frame
from poekin.testing.accuracy import falsify
from tests.model.laws import change_laws, method_laws
from tests.model.laws.chain_cases import chain_cases
from tests.model.laws.chain_laws import CHAIN_LAWS
from tests.model.laws.change_laws import CHANGE_LAWS
from tests.model.laws.method_laws import METHOD_LAWS

LAWS = {law.name: law for law in (*CHAIN_LAWS, *CHANGE_LAWS, *METHOD_LAWS)}
# A chain and its truth in 60 digits take some hundredths of a second.
FEWER = settings(max_examples=max(settings().max_examples // 3, 20))


@pytest.mark.parametrize("name", LAWS)
@FEWER
@given(data=st.data())
def test_chains_keep_the_law(name, data):
    target(LAWS[name].check(*data.draw(chain_cases(LAWS[name].kinds))))


def test_methods_agree_where_the_home_pose_is_turned_by_no_exact_rotation():
    R = [
        [-0.9926931592388943, 0.12015119179235847, 0.011134752407684486],
        [0.12012144058298033, 0.9752393783084397, 0.18568520271911168],
        [0.011451249389218323, 0.18566595301089525, -0.9825461937130402],
    ]
    home = np.vstack(
        [
            np.c_[R, [5.253805835942181e-11, -8.628119445893364e-11, -2.4077806466076623]],
            [0, 0, 0, 1],
        ]
    )
    assert np.linalg.norm(home[:3, :3] @ home[:3, :3].T - np.eye(3)) > 1.7e-15
    chain = Chain.from_space([[1.0, 0, 0, 0, -0.06345643296552192, 0.03801836574876627]], home)
    # M e^{B x} moves the tool by 4.8 m and back, along directions that are that far off.
    LAWS["methods_agree"].check(
        chain, np.array([-3.01684376787039]), np.array([-1.3431296253910125]), 0
    )


@pytest.mark.parametrize("kinds", [("revolute",), ("prismatic",), ("helical",)], ids=lambda k: k[0])
@settings(max_examples=max(settings().max_examples // 10, 5))
@given(data=st.data())
def test_chains_of_one_kind_keep_every_law(kinds, data):
    name = data.draw(st.sampled_from(sorted(LAWS)))
    chain, *arguments = data.draw(chain_cases(LAWS[name].kinds, joint_kinds=kinds))
    assert set(chain.kinds) <= set(kinds)
    LAWS[name].check(chain, *arguments)


@pytest.mark.parametrize("joints", [0, 1, 12])
@pytest.mark.parametrize("name", [name for name in LAWS if "joint" not in LAWS[name].kinds])
@settings(max_examples=2)
@given(data=st.data())
def test_the_shortest_and_the_longest_chains_keep_the_law(name, joints, data):
    LAWS[name].check(
        *data.draw(chain_cases(LAWS[name].kinds, min_joints=joints, max_joints=joints))
    )


def test_example_1_of_the_paper():
    # A 3R arm with L1 = 0.4, L2 = 0.3: M, ω_i and v_i as printed.
    arm = Chain.from_space(
        [[0, 0, 1, 0, 0, 0], [0, -1, 0, 0, 0, 0], [0, -1, 0, 0, 0, -0.4]],
        se3.exp([0, 0, 0, 0.4 + 0.3, 0, 0]),
    )
    q1, q2, q3 = q = np.array([0.3, 0.8, -1.1])
    along = 0.4 * np.cos(q2) + 0.3 * np.cos(q2 + q3)
    up = 0.4 * np.sin(q2) + 0.3 * np.sin(q2 + q3)
    T = arm.fk(q)
    assert np.abs(T[:3, 3] - [along * np.cos(q1), along * np.sin(q1), up]).max() < 1e-15
    assert (
        np.abs(
            T[:3, 0] - [np.cos(q1) * np.cos(q2 + q3), np.sin(q1) * np.cos(q2 + q3), np.sin(q2 + q3)]
        ).max()
        < 1e-15
    )
    assert np.array_equal(arm.jacobian(q, "space")[:, 0], [0, 0, 1, 0, 0, 0])
    assert np.abs(arm.jacobian(np.zeros(3), "space") - arm.screws.T).max() < 1e-15


class Planted:
    """A chain with some of its attributes and methods replaced."""

    def __init__(self, chain: Any, **wrong: Any):
        self._chain, self._wrong = chain, wrong

    def __getattr__(self, name: str) -> Any:
        wrong = self.__dict__["_wrong"]
        return wrong[name] if name in wrong else getattr(self._chain, name)


def with_screws(chain: Chain, screws: Any, **changes: Any) -> Chain:
    data = {"home": chain.home, "coupling": chain.coupling, "offset": chain.offset, **changes}
    return Chain(screws, frame="space", q_names=chain.q_names, **data)


def without_pitch(chain: Chain) -> Any:
    """The pitch of helical joints is lost wherever the screw is used."""
    S = chain.screws.copy()
    turning = np.any(S[:, :3] != 0, axis=1)
    S[turning, 3:] -= (
        np.sum(S[turning, :3] * S[turning, 3:], axis=1, keepdims=True) * S[turning, :3]
    )
    wrong = with_screws(chain, S)
    return Planted(wrong, screws=chain.screws)


def frames_swapped(chain: Chain, asked: Frame, given_: Frame) -> Any:
    def jacobian(q, frame, **options):
        return chain.jacobian(q, given_ if frame == asked else frame, **options)

    return Planted(chain, jacobian=jacobian)


def jacobian_changed(chain: Chain, change: Callable[[np.ndarray], np.ndarray]) -> Any:
    return Planted(
        chain, jacobian=lambda q, frame, **options: change(chain.jacobian(q, frame, **options))
    )


def home_first(chain: Chain) -> Any:
    """f = M e^{A_1 x_1} ⋯ e^{A_n x_n}."""
    wrong = with_screws(chain, chain.screws, home=np.eye(4))
    return Planted(chain, fk=lambda q: chain.home @ wrong.fk(q))


def backwards(chain: Chain) -> Any:
    wrong = with_screws(
        chain, chain.screws[::-1], coupling=chain.coupling[::-1], offset=chain.offset[::-1]
    )
    return Planted(chain, fk=wrong.fk)


def adjoint_of_the_pose(chain: Chain) -> Any:
    """J_b = Ad(f) J_s."""

    def jacobian(q, frame, **options):
        J = chain.jacobian(q, "space" if frame == "body" else frame, **options)
        return se3.adjoint(chain.fk(q)) @ J if frame == "body" else J

    return Planted(chain, jacobian=jacobian)


def rebased(chain: Chain, P: np.ndarray) -> Chain:
    return with_screws(chain, chain.screws, home=P @ chain.home)


def rebased_backwards(chain: Chain, P: np.ndarray) -> Chain:
    return chain.rebased(se3.inverse(P))


def retooled(chain: Chain, Q: np.ndarray) -> Chain:
    return with_screws(chain, chain.screws @ se3.adjoint(Q).T, home=chain.home @ Q)


def stale_batch(function: Callable[..., np.ndarray], tail: int) -> Callable[..., np.ndarray]:
    """The first configuration's result for the whole batch."""

    def wrong(q, *arguments):
        result = function(q, *arguments)
        if result.ndim == tail or not result.size:
            return result
        return np.broadcast_to(result.reshape(-1, *result.shape[-tail:])[0], result.shape)

    return wrong


def one_joint_late(chain: Chain, q: np.ndarray, dq: np.ndarray, frame: Any) -> np.ndarray:
    """V_{n-1} in place of V_n: the index as printed."""
    rates = dq.copy()
    rates[-1:] = 0
    return chain.velocity(q, rates, frame)


def leaking(chain: Chain, frames: np.ndarray) -> Any:
    """The joint's axis is read in the parent's frame."""
    other = change_laws.reattached(chain, frames)
    S = other.screws.copy()
    if len(S):
        R = frames[0, 0, :3, :3]
        S[0] = np.concatenate([R @ S[0, :3], R @ S[0, 3:]])
    return with_screws(other, S)


PLANTED: dict[str, tuple[str, Callable[[Chain], Any]]] = {
    "the pitch is missing": ("fk_is_the_product_of_exponentials", without_pitch),
    "home on the wrong side": ("fk_is_the_product_of_exponentials", home_first),
    "joints in reverse order": ("fk_is_the_product_of_exponentials", backwards),
    "the coupling's offset is forgotten": (
        "fk_is_the_product_of_exponentials",
        lambda c: Planted(c, fk=with_screws(c, c.screws, offset=np.zeros(len(c.screws))).fk),
    ),
    "the offset is forgotten at zero": (
        "home_is_where_zero_leads",
        lambda c: Planted(c, fk=with_screws(c, c.screws, offset=np.zeros(len(c.screws))).fk),
    ),
    "fk in float32": (
        "home_is_where_zero_leads",
        lambda c: Planted(c, fk=lambda q: np.float64(np.float32(c.fk(q)))),
    ),
    "body screws are the space screws": ("forms_agree", lambda c: Planted(c, body=c.space)),
    "the trailing tool is lost": (
        "forms_agree",
        lambda c: Planted(
            c, local=Planted(c.local, frames=np.concatenate([c.local.frames[:-1], np.eye(4)[None]]))
        ),
    ),
    "hybrid returned as space": (
        "jacobian_is_the_derivative",
        lambda c: frames_swapped(c, "hybrid", "space"),
    ),
    "space returned as hybrid": (
        "space_jacobian_is_not_hybrid",
        lambda c: frames_swapped(c, "space", "hybrid"),
    ),
    "body returned as hybrid": (
        "jacobian_is_the_derivative",
        lambda c: frames_swapped(c, "body", "hybrid"),
    ),
    "linear part first": (
        "jacobian_is_the_derivative",
        lambda c: jacobian_changed(c, lambda J: np.roll(J, 3, axis=-2)),
    ),
    "ratios of the coupling ignored": (
        "jacobian_is_the_derivative",
        lambda c: Planted(
            c, jacobian=with_screws(c, c.screws, coupling=np.sign(c.coupling)).jacobian
        ),
    ),
    "the last column is lost": (
        "jacobian_is_the_derivative",
        lambda c: jacobian_changed(
            c, lambda J: J * ([1] * (J.shape[-1] - 1) + [0] if J.shape[-1] else 1)
        ),
    ),
    "an error of 1e-9": (
        "jacobian_is_the_derivative",
        lambda c: jacobian_changed(c, lambda J: J * (1 + 1e-9)),
    ),
    "Ad(f) for Ad(f⁻¹)": ("body_jacobian_is_space_seen_from_the_tool", adjoint_of_the_pose),
    "joint frames at home": (
        "joint_poses_are_partial_products",
        lambda c: Planted(c, joint_poses=lambda q: c.joint_poses(np.zeros_like(q))),
    ),
    "joint frames one late": (
        "joint_poses_are_partial_products",
        lambda c: Planted(c, joint_poses=lambda q: np.roll(c.joint_poses(q), 1, axis=-3)),
    ),
    "a joint's frame in space axes": (
        "jacobian_in_a_joints_frame_is_space_seen_from_it",
        lambda c: Planted(
            c, jacobian=lambda q, f, **o: c.jacobian(q, "space" if isinstance(f, int) else f, **o)
        ),
    ),
    "V of the last joint but one": (
        "velocity_is_the_jacobian_times_rates",
        lambda c: Planted(c, velocity=lambda q, dq, f: one_joint_late(c, q, dq, f)),
    ),
    "velocity always of the body": (
        "velocity_is_the_jacobian_times_rates",
        lambda c: Planted(c, velocity=lambda q, dq, f: c.velocity(q, dq, "body")),
    ),
    "one pass with the home pose": (
        "one_pass_gives_both",
        lambda c: Planted(c, fk_jacobian=lambda q, f, **o: (c.home, c.jacobian(q, f, **o))),
    ),
    "one pass in another frame": (
        "one_pass_gives_both",
        lambda c: Planted(
            c, fk_jacobian=lambda q, f, **o: c.fk_jacobian(q, "body" if f == "space" else f, **o)
        ),
    ),
    "at is ignored": (
        "a_point_moves_as_the_tools_origin_would",
        lambda c: Planted(c, jacobian=lambda q, f, at=None: c.jacobian(q, f)),
    ),
    "at is a point of the base": (
        "a_point_moves_as_the_tools_origin_would",
        lambda c: Planted(
            c,
            jacobian=lambda q, f, at=None: c.jacobian(
                q, f, at=None if at is None else c.fk(q)[:3, :3].T @ at
            ),
        ),
    ),
    "the first configuration for all": (
        "batches_are_made_of_single_configurations",
        lambda c: Planted(c, fk=stale_batch(c.fk, 2)),
    ),
    "a flat batch": (
        "batches_are_made_of_single_configurations",
        lambda c: Planted(c, fk=lambda q: c.fk(q).reshape(-1, 4, 4) if q.ndim > 1 else c.fk(q)),
    ),
    "rebased without its screws": (
        "a_rebased_chain_is_seen_from_another_base",
        lambda c: Planted(c, rebased=lambda P: rebased(c, P)),
    ),
    "rebased by the inverse": (
        "a_rebased_chain_is_seen_from_another_base",
        lambda c: Planted(c, rebased=lambda P: rebased_backwards(c, P)),
    ),
    "retooled with its screws": (
        "a_retooled_chain_carries_another_tool",
        lambda c: Planted(c, retooled=lambda Q: retooled(c, Q)),
    ),
    "retooled in the base": (
        "a_retooled_chain_carries_another_tool",
        lambda c: Planted(c, retooled=lambda Q: with_screws(c, c.screws, home=Q @ c.home)),
    ),
    "rezeroed backwards": (
        "a_rezeroed_chain_starts_elsewhere",
        lambda c: Planted(c, rezeroed=lambda q: c.rezeroed(-q)),
    ),
    "rezeroed with its limits where they were": (
        "a_rezeroed_chain_starts_elsewhere",
        lambda c: Planted(
            c,
            limits=np.tile([-1.0, 1.0], (c.dof, 1)),
            rezeroed=lambda q: Planted(c.rezeroed(q), limits=np.tile([-1.0, 1.0], (c.dof, 1))),
        ),
    ),
}


# A hunt ends with what it finds, mostly at once.
MOST = 400


def catch(law: str, wrong: Callable[[Chain], Any]):
    return falsify.first_violation(
        [LAWS[law]],
        lambda law, chain, *arguments: law.check(wrong(chain), *arguments),
        chain_cases,
        MOST,
    )


@pytest.mark.parametrize("error", PLANTED)
def test_a_planted_error_is_caught(error):
    law, wrong = PLANTED[error]
    assert catch(law, wrong) is not None


def test_a_link_frame_that_leaks_into_the_screws_is_caught():
    law = LAWS["link_frames_do_not_matter"]
    check = lambda law, chain, frames: law.check(chain, frames, built=leaking)  # noqa: E731
    assert falsify.first_violation([law], check, chain_cases, MOST) is not None


@pytest.mark.parametrize("method", method_laws.METHODS)
def test_a_method_with_a_wrong_column_is_caught(method):
    def wrong(chain, x):
        T, J = method_laws.METHODS[method](chain, x)
        return T, J @ np.diag([1 + 1e-12] + [1] * (len(x) - 1))

    methods = {**method_laws.METHODS, method: wrong}
    check = lambda law, *case: law.check(*case, methods=methods)  # noqa: E731
    assert falsify.first_violation(METHOD_LAWS, check, chain_cases, 60) is not None


def test_every_law_catches_an_error():
    assert set(LAWS) - {law for law, _ in PLANTED.values()} == {
        "link_frames_do_not_matter",
        "methods_agree",
    }
