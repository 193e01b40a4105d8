"""The laws of chains are as sharp as they say: each bound is the stated one, and no entry is left
unmeasured.
"""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from benchmarks import exact_derivatives
from poekin.groups import se3
from poekin.model.chain import Chain
from poekin.model.robot import Robot
from poekin.testing.laws import laws
from poekin.testing.laws.laws import LawViolation
from poekin.testing.oracles import exact_chain
from tests.model.laws import chain_bounds, chain_laws, change_laws, derivative_laws, jacobian_laws
from tests.model.laws.chain_laws import CHAIN_LAWS
from tests.model.laws.change_laws import CHANGE_LAWS
from tests.model.laws.derivative_laws import DERIVATIVE_LAWS
from tests.model.laws.method_laws import METHOD_LAWS

U = 2.0**-53
LAWS = {law.name: law for law in (*CHAIN_LAWS, *CHANGE_LAWS, *METHOD_LAWS, *DERIVATIVE_LAWS)}
SCREWS = [
    [0.6, 0, 0.8, 0.4, 0.3, -0.3],  # revolute
    [0, 0, 0, 0.36, 0.48, 0.8],  # prismatic
    [0.48, 0.6, 0.64, 0.5, -0.2, 0.1],  # helical
]
HOME = se3.exp([0.3, -0.4, 0.5, 0.7, 0.2, -0.6])
HOME[:3, :3] *= 1 + 2.0**-40  # R Rᵀ misses I, by far more than rounding
COUPLED = Chain.from_space(
    SCREWS, HOME, coupling=[[1.0, 0.5], [-2.0, 0], [0.25, 3.0]], offset=[0.1, -0.2, 0.3], q_names=["a", "b"],
    limits=[[-1.0, 2.0], [-3.0, 1.5]],
)  # fmt: skip
PLAIN = Chain.from_space(SCREWS, se3.exp([0.3, -0.4, 0.5, 0.7, 0.2, -0.6]))
Q, DQ, POINT = np.array([0.7, -1.3, 0.4]), np.array([1.5, -0.6, 0.9]), np.array([0.3, -0.4, 1.2])
POSE = se3.exp([0.5, 0.2, -0.7, 2.0, -1.0, 0.5])
FRAMES = np.stack(
    [
        [se3.exp(0.3 * np.sin(np.arange(6.0) + 7 * k + 3 * j)) for j in range(2)]
        for k in range(len(SCREWS))
    ]
)
Pairs = list[tuple[float, float]]


def measured(law: str, chain: Any, monkeypatch, **changed: Any) -> Pairs:
    """The pairs (error, bound) that a law holds."""
    pairs: Pairs = []

    def check_bounds(name: str, *found: tuple[float, float], **seen: object) -> float:
        pairs.extend(found)
        return 0.0

    for module in (laws, chain_bounds):
        monkeypatch.setattr(module, "check_bounds", check_bounds)
    m = chain.dof
    values = {
        "q": Q[:m], "dq": DQ[:m], "joint": 1, "point": POINT, "pose": POSE, "frames": FRAMES,
        "batch": np.stack([Q[:m], DQ[:m], -Q[:m]])[:, None],
    }  # fmt: skip
    LAWS[law].check(chain, *((values | changed)[kind] for kind in LAWS[law].kinds))
    return pairs


class Spoilt:
    """A chain of whose results, or of whose attributes, one number is wrong: at one call, of one
    function.

    What a chain returns that is a chain, and its forms, are spoilt in turn; names are then those of
    "rebased.fk".
    """

    def __init__(self, chain: Any, name: str = "", call: int = 0, place: int = 0):
        self._chain, self._wrong = chain, (name, call, place)
        self.calls: dict[str, tuple[int, int]] = {}

    def __getattr__(self, name: str) -> Any:
        return self._part(getattr(self._chain, name), name)

    def _part(self, value: Any, name: str) -> Any:
        if name in ("space", "body") or name.endswith((".space", ".body")):
            return _Part(self, value, name)
        if callable(value):
            return lambda *arguments, **options: self._result(value(*arguments, **options), name)
        return self._result(value, name) if "." in name else value

    def _result(self, result: Any, name: str) -> Any:
        if isinstance(result, Chain):
            return _Part(self, result, name)
        if isinstance(result, tuple):
            flat = self._result(np.concatenate([part.ravel() for part in result]), name)
            ends = np.cumsum([part.size for part in result])[:-1]
            parts = [
                p.reshape(part.shape) for p, part in zip(np.split(flat, ends), result, strict=True)
            ]
            return type(result)(*parts) if hasattr(result, "_fields") else tuple(parts)
        call, _ = self.calls.get(name, (0, 0))
        self.calls[name] = call + 1, np.size(result)
        if (name, call) == self._wrong[:2]:
            result = np.array(result)
            result.flat[self._wrong[2]] += 1e-3
        return result


class _Part:
    """A form of a spoilt chain, or a chain made of it."""

    def __init__(self, whole: Spoilt, part: Any, name: str):
        self._whole, self._part, self._name = whole, part, name

    def __getattr__(self, name: str) -> Any:
        return self._whole._part(getattr(self._part, name), f"{self._name}.{name}")


# What a law does not look at: of its functions the places of the numbers; of a pose that turns a
# twist the last row.
ALL, LAST, T = set(range(288)), {12, 13, 14, 15}, {3, 7, 11}
UNREAD: dict[str, dict[str, set[int]]] = {
    "jacobian_is_the_derivative": {"fk": LAST | T},  # the translation in the middle of a difference
    "space_jacobian_is_not_hybrid": {"fk": ALL - T},
    "body_jacobian_is_space_seen_from_the_tool": {"fk": LAST},
    "joint_poses_are_partial_products": {"joint_poses": ALL - set(range(16, 32))},  # of joint 1
    "jacobian_in_a_joints_frame_is_space_seen_from_it": {"joint_poses": ALL - set(range(16, 28))},
    "a_point_moves_as_the_tools_origin_would": {"fk": LAST | T},  # the rotation turns the point
    # of ω, and d²p/dq_j²
    "hessian_of_a_point_is_symmetric": {"hessian": {*range(12), 12, 15, 16, 19, 20, 23}},
    "screw_derivatives_are_differences_on_the_group": {  # of joint 1 of 3
        "screw_derivatives": {k for k in range(108) if k // 6 % 3 != 1},
        "jacobian_screw_derivatives": {k for k in range(216) if k // 6 % 3 != 1},
    },
    # of two parts one is looked at
    "derivatives_of_batches_are_those_of_single_configurations": {
        "screw_derivatives": ALL, "jacobian_screw_derivatives": ALL
    },
}  # fmt: skip


@pytest.mark.parametrize("law", LAWS)
def test_a_law_sees_every_number_of_every_function(law, monkeypatch):
    sound = Spoilt(COUPLED)
    right = measured(law, sound, monkeypatch)
    assert all(error <= bound for error, bound in right)
    if law == "screw_derivatives_are_differences_on_the_group":
        truth = exact_derivatives.screw_changes(COUPLED, Q[:2], 1)  # which takes long
        home = exact_derivatives.home_changes(COUPLED, Q[:2])
        monkeypatch.setattr(exact_derivatives, "screw_changes", lambda *_: truth)
        monkeypatch.setattr(exact_derivatives, "home_changes", lambda *_: home)
    unseen: dict[str, set[int]] = {}
    for name, (count, numbers) in sound.calls.items():
        for call in {0, 1, count - 1} & set(range(count)):
            # Every number at the first call; at others, where the same is called again, some.
            step = 3 if call else 1
            for place in range(0, numbers, step if numbers < 60 else 7):
                pairs = measured(law, Spoilt(COUPLED, name, call, place), monkeypatch)
                if (
                    max(
                        (abs(a - b) for (a, _), (b, _) in zip(pairs, right, strict=True)), default=0
                    )
                    < 1e-7
                ):
                    unseen.setdefault(name, set()).add(place)
    assert {
        name: places
        for name, seen in unseen.items()
        if (places := seen - UNREAD.get(law, {}).get(name, set()))
    } == {}


ROTATES, PITCH = np.array([1.0, 0, 1.0]), 0.48 * 0.5 - 0.6 * 0.2 + 0.64 * 0.1
SLIDES = np.array([0, 1.0, PITCH])


def norm(x: Any) -> float:
    return float(np.linalg.norm(np.ravel(x)))


def budget(q: np.ndarray, chain: Chain = COUPLED) -> tuple[float, float]:
    """As it is stated, for the three joints."""
    x, R = chain.coupling @ q + chain.offset, chain.home[:3, :3]
    turned, missed = np.abs(x).sum(), norm(R @ R.T - np.eye(3))
    angular = U * (8 * 4 + 4 * turned) + missed * (1 + turned / 2)
    return angular, (angular + missed) * (chain.reach + np.abs(SLIDES * x).sum())


def pose(q: np.ndarray, factor: float = 1.0) -> list[float]:
    a, b = budget(q)
    return [factor * a, factor * b, 0.0]


def twist(factor: float = 1.0) -> list[float]:
    (a, b), rates = budget(Q2), C @ DQ2
    turning, sliding = norm(ROTATES * rates), norm(SLIDES * rates)
    return [4 * factor * a * turning, 4 * factor * b * (turning + sliding)]


def columns(rates: float) -> list[float]:
    a, b = budget(Q2)
    return [8 * rates * (1 + norm(C)) * a, 8 * rates * (1 + norm(C)) * b]


def differences() -> list[float]:
    rate = max(np.abs(ROTATES * (C @ DQ2)).sum(), 1.0)
    return [30 * rate * b for b in budget(Q2)]


def changed(pose_bounds: list[float], screws: int, q: np.ndarray, factor: float) -> list[float]:
    rows = [(1 + norm(C)) * b for b in budget(q)]
    return [factor * b for b in (*pose_bounds, *rows * screws)]


def of_screws() -> list[float]:
    a, b = budget(Q2)
    reach, x = 1 + b / a, C[1] @ Q2 + COUPLED.offset[1]
    weights = [1, 1 + abs(x), 1, 1, *[reach * (1 + norm(C))] * 6]
    return [16 * weight * reach * bound for weight in weights for bound in (a, b)]


def of_frames() -> list[float]:
    a, b = budget(np.zeros(2))
    return [8 * a, 8 * b * (1 + norm(FRAMES[:, :, :3, 3]))] * 2


C, Q2, DQ2 = COUPLED.coupling, Q[:2], DQ[:2]
BOUNDS: dict[str, Callable[[], list[float]]] = {
    "fk_is_the_product_of_exponentials": lambda: pose(Q2),
    "home_is_where_zero_leads": lambda: pose(np.zeros(2)),
    "forms_agree": lambda: pose(Q2) * 3,
    "jacobian_is_the_derivative": lambda: differences() * 3,
    "space_jacobian_is_not_hybrid": twist,
    "body_jacobian_is_space_seen_from_the_tool": twist,
    "joint_poses_are_partial_products": lambda: pose(Q2),
    "jacobian_in_a_joints_frame_is_space_seen_from_it": lambda: twist(4),
    "velocity_is_the_jacobian_times_rates": lambda: twist() * 3 + twist(4) * 3,
    "one_pass_gives_both": lambda: (pose(Q2) + twist()) * 6,
    "a_point_moves_as_the_tools_origin_would": lambda: (twist(4 * 2.3) * 2 + pose(Q2, 2.3)) * 2,
    "batches_are_made_of_single_configurations": lambda: [budget(q)[1] * (1 + norm(q)) for q in (Q2, DQ2, -Q2)] * 6,
    "a_rebased_chain_is_seen_from_another_base": lambda: changed(pose(Q2) * 2, 4, Q2, 8 * (1 + norm(POSE[:3, 3]))),
    "a_retooled_chain_carries_another_tool": lambda: changed(pose(Q2) * 2, 4, Q2, 8 * (1 + norm(POSE[:3, 3]))),
    "a_rezeroed_chain_starts_elsewhere": lambda: [
        *changed(pose(Q2 + DQ2) + pose(DQ2), 3, Q2 + DQ2, 4 * (1 + norm(Q2) + norm(DQ2))), 0.0
    ],
    "link_frames_do_not_matter": of_frames,
    "methods_agree": lambda: (pose(Q2) + twist(4)) * 5 + twist(4),
    "jacobian_rate_is_the_derivative": lambda: columns(np.abs(C @ DQ2).sum()) * 3,
    "hessian_is_the_derivative": lambda: [*columns(np.abs(C[:, 0]).sum()) * 3, *columns(np.abs(C[:, 1]).sum()) * 3],
    "hessian_of_a_point_is_symmetric": lambda: [8 * budget(Q2)[1] * (1 + norm(C) ** 2)],
    "acceleration_is_the_derivative_of_the_velocity": lambda: columns(
        np.abs(C @ DQ2).sum() ** 2 + np.abs(C @ (DQ2[::-1] + Q2)).sum()
    ) * 3,
    "joint_velocities_are_those_of_the_joint_poses": lambda: columns(np.abs(C @ DQ2).sum()) * 9,
    "screw_derivatives_are_differences_on_the_group": of_screws,
}  # fmt: skip


@pytest.mark.parametrize("law", BOUNDS)
def test_the_bounds_of_a_law_are_those_that_are_stated(law, monkeypatch):
    bounds = [bound for _, bound in measured(law, COUPLED, monkeypatch)]
    assert bounds == pytest.approx(BOUNDS[law](), rel=1e-9, abs=0)


def test_the_budget_grows_with_joints_angles_slides_and_what_home_misses():
    for chain, q in ((COUPLED, Q2), (PLAIN, Q)):
        assert chain_bounds.budget(chain, q) == pytest.approx(budget(q, chain), rel=1e-9, abs=0)


def test_slow_rates_do_not_make_a_difference_more_exact(monkeypatch):
    slow = measured("jacobian_is_the_derivative", COUPLED, monkeypatch, dq=np.array([1e-3, 0]))
    assert [bound for _, bound in slow] == pytest.approx([30 * b for b in budget(Q2)] * 3, rel=1e-9)


def test_a_hessian_of_a_plain_chain_is_symmetric_to_the_last_bit(monkeypatch):
    assert measured("hessian_of_a_point_is_symmetric", PLAIN, monkeypatch) == [(0.0, 0.0)]


def test_frames_of_too_few_joints_are_no_frames_of_the_chain():
    with pytest.raises(ValueError, match="zip"):
        change_laws.link_frames_do_not_matter(PLAIN, FRAMES[:2])


def test_another_number_of_joints_is_no_chain_of_other_frames():
    fewer = Chain.from_space(SCREWS[:2], PLAIN.home)
    more = Chain.from_space([*SCREWS, SCREWS[0]], PLAIN.home)
    for other in (fewer, more):
        with pytest.raises(LawViolation, match="link frames do not matter: error inf exceeds 0\n"):
            change_laws.link_frames_do_not_matter(
                PLAIN, FRAMES, built=lambda chain, frames, other=other: other
            )
    none = Chain.from_space(np.zeros((0, 6)), PLAIN.home)
    assert change_laws.link_frames_do_not_matter(none, np.zeros((0, 2, 4, 4))) <= 1


@pytest.mark.parametrize("chain", [PLAIN, COUPLED], ids=["plain", "coupled"])
def test_with_other_frames_every_number_of_screws_and_home_is_looked_at(chain):
    def built(k: int | None) -> Any:
        numbers = np.concatenate([chain.screws.ravel(), chain.home[:3].ravel()])
        if k is not None:
            numbers[k] += 1e-6
        home = np.vstack([numbers[18:].reshape(3, 4), [0, 0, 0, 1]])
        return lambda chain, frames: SimpleNamespace(screws=numbers[:18].reshape(3, 6), home=home)

    assert change_laws.link_frames_do_not_matter(chain, FRAMES, built=built(None)) == 0
    for k in range(30):
        with pytest.raises(LawViolation, match="link frames do not matter"):
            change_laws.link_frames_do_not_matter(chain, FRAMES, built=built(k))


def test_joints_are_attached_anew_where_their_axes_pass_the_given_frames(monkeypatch):
    found: list[Any] = []

    def robot(name: str, links: Any, joints: Any) -> Any:
        found.extend(joints)
        return Robot(name, links, joints)

    monkeypatch.setattr(change_laws, "Robot", robot)
    assert change_laws.reattached(PLAIN, FRAMES).kinds == PLAIN.kinds
    T = np.eye(4)
    for joint, S, (P, G) in zip(found[::2], PLAIN.screws, FRAMES, strict=False):
        at, turns = T @ joint.origin, joint.kind != "prismatic"
        axis = S[:3] if turns else S[3:]
        assert at[:3, :3] == pytest.approx(P[:3, :3], abs=1e-14)
        assert at[:3, :3] @ joint.axis == pytest.approx(axis, abs=1e-14)
        gap = P[:3, 3] - at[:3, 3]
        assert gap == pytest.approx(
            np.zeros(3) if not turns else gap - axis * (axis @ gap), abs=1e-14
        )
        if turns:
            assert np.cross(at[:3, 3], axis) + axis * (axis @ S[3:]) == pytest.approx(
                S[3:], abs=1e-14
            )
        T = G
    assert T @ found[-1].origin == pytest.approx(PLAIN.home, abs=1e-14)


@pytest.mark.parametrize("joint", range(3))
def test_every_joints_frame_is_looked_at(joint):
    for chain in (PLAIN, COUPLED):
        q = Q[: chain.dof]
        assert chain_laws.joint_poses_are_partial_products(chain, q, joint) <= 1
        poses = chain.joint_poses(q)
        poses[joint, 0, 3] += 1e-6
        wrong = Replaced(chain, joint_poses=lambda q, poses=poses: poses)
        with pytest.raises(LawViolation, match="joint poses are partial products"):
            chain_laws.joint_poses_are_partial_products(wrong, q, joint)


class Replaced:
    """A chain with some of its functions replaced."""

    def __init__(self, chain: Chain, **others: Any):
        self._chain, self._others = chain, others

    def __getattr__(self, name: str) -> Any:
        return self._others[name] if name in self._others else getattr(self._chain, name)


@pytest.mark.parametrize("shape", [(4,), (3, 2), (5, 2), (4, 2, 1)])
@pytest.mark.parametrize(
    ("law", "name"),
    [
        (chain_laws.batches_are_made_of_single_configurations, "jacobian"),
        (derivative_laws.derivatives_of_batches_are_those_of_single_configurations, "hessian"),
    ],
)
def test_a_batch_of_another_shape_is_refused_with_both_shapes(law, name, shape):
    batch = np.zeros((4, 2, 3))
    right = getattr(PLAIN, name)
    tail = right(Q, "space").shape

    def wrong(q: np.ndarray, frame: str) -> np.ndarray:
        return np.zeros((*shape, *tail)) if q.ndim > 1 else right(q, frame)

    with pytest.raises(
        LawViolation, match="batches have their shape: error inf exceeds 0\n"
    ) as caught:
        law(Replaced(PLAIN, **{name: wrong}), batch)
    assert caught.value.seen["shape"] == (*shape, *tail)
    assert caught.value.seen["expected"] == (4, 2, *tail)


def test_a_violation_says_how_joints_are_coupled_where_they_are():
    one = np.eye(3)
    for coupling, told in (
        (one, False),
        (np.diag([1, 1, 0.5]), True),
        (np.diag([1, 1, 2.0]), True),
        (one[::-1], True),
    ):
        chain = Chain.from_space(SCREWS, PLAIN.home, coupling=coupling, q_names=["a", "b", "c"])
        with pytest.raises(LawViolation) as caught:
            chain_bounds.check_chain_bounds("a law", chain, (1.0, 0.5), q=Q)
        assert ("coupling" in caught.value.seen) == ("offset" in caught.value.seen) == told
        assert np.array_equal(caught.value.seen["screws"], SCREWS)


def test_adjoint_and_inverse_of_a_pose_are_those_of_the_definition():
    R, t = POSE[:3, :3], POSE[:3, 3]
    inverse, adjoint = chain_bounds.inverse(POSE), chain_bounds.adjoint(POSE)
    assert inverse @ POSE == pytest.approx(np.eye(4), abs=1e-15)
    assert inverse[3].tolist() == [0, 0, 0, 1]
    V = np.arange(1.0, 7.0)
    moved = np.concatenate([R @ V[:3], np.cross(t, R @ V[:3]) + R @ V[3:]])
    assert adjoint @ V == pytest.approx(moved, abs=1e-14)


@pytest.mark.parametrize("joint", [0, 2])
def test_screw_derivatives_are_looked_at_of_every_joint(joint):
    assert derivative_laws.screw_derivatives_are_differences_on_the_group(PLAIN, Q, joint) <= 1


def test_without_a_coordinate_there_is_no_column():
    chain = Chain.from_space(np.zeros((0, 6)), PLAIN.home)
    assert exact_chain.jacobians(chain, np.zeros(0)).shape == (3, 6, 0)


@pytest.mark.parametrize("row", range(6))
def test_halves_are_measured_apart(row, monkeypatch):
    error, halves = np.eye(6)[row], [float(row < 3), float(row >= 3)]
    assert [e for e, _ in chain_bounds.of_twists(PLAIN, Q, DQ, error)] == halves
    assert [e for e, _ in derivative_laws._of_columns(PLAIN, Q, error[:, None], 1.0)] == halves
    assert [e for e, _ in change_laws._of_screws(PLAIN, Q, [error[None]])] == halves
    monkeypatch.setattr(
        jacobian_laws.differences,
        "velocity",
        lambda fk, q, dq, frame, rate: PLAIN.jacobian(q, frame) @ dq - error,
    )
    pairs = measured("jacobian_is_the_derivative", PLAIN, monkeypatch)
    assert [e for e, _ in pairs] == pytest.approx(halves * 3, abs=1e-12)
    motion, entries = PLAIN.screw_derivatives(Q), PLAIN.screw_derivatives(Q, wrt="components")
    frames = [PLAIN.jacobian_screw_derivatives(Q, frame) for frame in ("space", "body", "hybrid")]
    right = (
        motion.screws[:, 1], entries.screws[:, 1], np.stack([c.screws[:, :, 1] for c in frames]),
        motion.home, np.stack([c.home for c in frames]),
    )  # fmt: skip
    for k, part in enumerate(right):
        wrong = part.copy()
        wrong[(row, 0) if wrong.ndim == 2 else (1, row, 0, 0)] += 1.0
        parts = [*right[:k], wrong, *right[k + 1 :]]
        truth = exact_derivatives.ScrewChanges(*parts[:3])
        home = exact_derivatives.HomeChanges(*parts[3:])
        monkeypatch.setattr(exact_derivatives, "screw_changes", lambda *_, truth=truth: truth)
        monkeypatch.setattr(exact_derivatives, "home_changes", lambda *_, home=home: home)
        pairs = measured("screw_derivatives_are_differences_on_the_group", PLAIN, monkeypatch)
        places = [(0,), (1,), (6,), (2, 3), (7,)][k]
        expected = [part * (place in places) for place in range(10) for part in halves]
        assert [e for e, _ in pairs] == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize(("i", "j"), list(np.ndindex(4, 4)))
def test_rotation_translation_and_last_row_of_a_pose_are_measured_apart(i, j):
    T = np.eye(4)
    T[i, j] += 1.0
    expected = [float(i < 3 and j < 3), float(i < 3 and j == 3), float(i == 3)]
    assert [e for e, _ in chain_bounds.of_poses(PLAIN, Q, T, np.eye(4))] == expected


def test_derivatives_of_a_batch_may_differ_by_rounding_of_their_size(monkeypatch):
    bounds = []
    for frame in ("space", "body", "hybrid"):
        for part in range(6):
            for q in (Q2, DQ2, -Q2):
                screws = COUPLED.jacobian_screw_derivatives(q, frame)
                values = (
                    COUPLED.jacobian_rate(q, q, frame), COUPLED.hessian(q, frame), COUPLED.acceleration(q, q, q, frame),
                    COUPLED.joint_velocities(q, q, frame), screws.screws, screws.home,
                )  # fmt: skip
                bounds.append(1e-14 * (1 + norm(values[part])))
    for wrt in ("twist", "components"):
        for part in ("screws", "home"):
            for q in (Q2, DQ2, -Q2):
                bounds.append(
                    1e-14 * (1 + norm(getattr(COUPLED.screw_derivatives(q, wrt=wrt), part)))
                )
    pairs = measured(
        "derivatives_of_batches_are_those_of_single_configurations", COUPLED, monkeypatch
    )
    assert [bound for _, bound in pairs] == pytest.approx(bounds, rel=1e-9, abs=0)
