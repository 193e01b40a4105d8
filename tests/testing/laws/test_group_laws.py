"""The laws of the groups are as sharp as they say: each bound is the stated one, and no entry is
left unmeasured.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from poekin.groups import se3, so3
from poekin.testing.laws import group_laws, laws, measures
from poekin.testing.laws.group import Group, make_group
from poekin.testing.laws.group_laws import GROUP_LAWS
from tests.groups import near_laws
from tests.groups.near_laws import NEAR_LAWS

U = 2.0**-53
GROUPS = {6: make_group(se3, 6), 3: make_group(so3, 3)}
LAWS = {law.name: law for law in (*GROUP_LAWS, *NEAR_LAWS)}
N = np.array([2.0, 3.0, -6.0]) / 7
# |ω| = 2.5, 0.75 and 1.25; |v| = 7, 3 and 5; |t| = 11 and 13.
XI = np.concatenate([2.5 * N, [2.0, 3.0, 6.0]])
ETA = np.concatenate([0.75 * N[::-1], [1.0, -2.0, 2.0]])
ZETA = np.concatenate([-1.25 * np.roll(N, 1), [3.0, 0, -4.0]])
X, Y = se3.exp(XI), se3.exp(ZETA)
X[:3, 3], Y[:3, 3] = [2.0, 6.0, 9.0], [3.0, 4.0, -12.0]
ARGUMENTS = {
    "ad_is_the_bracket": (XI, ETA),
    "identity_is_neutral": (X,),
    "inverse_undoes": (X,),
    "products_associate": (XI, ETA, ZETA),
    "exp_undoes_log": (X,),
    "adjoint_is_a_homomorphism": (X, Y),
    "adjoint_conjugates": (X, XI),
    "near_picks_the_closest_branch": (XI, ETA),
}
# In the order (R, t), (ω, v), or P, P, the corner of zeros and Q.
BOUNDS: dict[str, list[float]] = {
    "hat_and_vee_are_inverse": [0, 0],
    "ad_is_the_bracket": [8 * U * 2.5 * 0.75, 8 * U * (2.5 * 3 + 0.75 * 7)],
    "exp_lands_in_the_group": [12 * U * 4.75, 12 * U * 4.75, 0],
    "identity_is_neutral": [0, 0, 0],
    "inverse_undoes": [36 * U, 36 * U * 11, 36 * U, 36 * U * 11],
    "exp_of_minus_is_inverse": [12 * U * 3.5, 12 * U * 3.5 * 7],
    "exp_adds_along_a_line": [12 * U * 3.5, 12 * U * 3.5 * 7],
    "products_associate": [48 * U * 5.5, 96 * U * 5.5 * 15],
    "log_undoes_exp": [24 * U * 2.5, 64 * U * 7],
    "exp_undoes_log": [36 * U, 36 * U * 11],
    "adjoint_of_exp_is_exp_of_ad": [16 * U * 3.5, 16 * U * 3.5, 0, 64 * U * 3.5 * 7],
    "adjoint_is_a_homomorphism": [24 * U, 24 * U, 0, 64 * U * 24],
    "adjoint_conjugates": [32 * U * 2.5, 64 * U * (7 + 2.5 * 11)],
    "jacobians_meet_in_the_adjoint": [32 * U * 3.5, 32 * U * 3.5, 0, 128 * U * 3.5 * 7],
    "jacobians_have_inverses": [32 * U, 32 * U, 0, 64 * U * 7] * 2,
    "left_jacobian_is_lemma_5s_integral": [64 * U * 3.5, 64 * U * 3.5, 0, 256 * U * 3.5 * 7],
    "a_logarithm_is_nearest_to_itself": [24 * U * 2.5, 512 * U * 3.5**2 * 7],
}
# What a law does not look at, and why: (law, function, which calls) -> the places of the numbers.
T = {3, 7, 11}  # of 16
DIAGONAL = {*range(0, 9, 4), *range(0, 16, 5)}
UNREAD: dict[tuple[str, str, tuple[int, ...]], set[int]] = {
    ("exp_lands_in_the_group", "exp", (0,)): T,  # a translation is never outside
    ("products_associate", "exp", (0, 1, 2)): set(range(16)),  # of any three elements
    ("near_picks_the_closest_branch", "exp", (0,)): T,  # v is that of the logarithm found
    ("near_picks_the_closest_branch", "log", (0,)): {3, 4, 5},
    **{
        (law, "hat", (0, 1)): DIAGONAL for law in ("ad_is_the_bracket", "adjoint_conjugates")
    },  # read by vee
}
LAST_ROW = {12, 13, 14, 15}  # of 16, where R and t alone are compared
READ_WHOLE = {
    "hat_and_vee_are_inverse",
    "exp_lands_in_the_group",
    "identity_is_neutral",
    "inverse_undoes",
}

Pairs = list[tuple[float, float]]


def measured(law: str, group: Group, monkeypatch, *arguments: Any) -> Pairs:
    """The pairs (error, bound) that a law holds."""
    pairs: Pairs = []

    def check_bounds(name: str, *found: tuple[float, float], **seen: object) -> float:
        pairs.extend(found)
        return 0.0

    monkeypatch.setattr(laws, "check_bounds", check_bounds)
    monkeypatch.setattr(near_laws, "check_bounds", check_bounds)
    LAWS[law].check(group, *arguments)
    return pairs


def arguments_of(law: str, size: int) -> tuple[np.ndarray, ...]:
    cut = slice(None) if size == 6 else slice(3)
    return tuple(x[(cut,) * x.ndim] for x in ARGUMENTS.get(law, (XI,)))


@pytest.mark.parametrize("law", BOUNDS)
def test_the_bounds_of_a_law_are_those_that_are_stated(law, monkeypatch):
    pairs = measured(law, GROUPS[6], monkeypatch, *arguments_of(law, 6))
    assert [bound for _, bound in pairs] == pytest.approx(BOUNDS[law], rel=1e-12, abs=0)
    assert all(error <= bound for error, bound in pairs)


@pytest.mark.parametrize("law", BOUNDS)
def test_a_law_of_rotations_has_the_bounds_of_the_rotation_of_a_pose(law, monkeypatch):
    bounds = [bound for _, bound in measured(law, GROUPS[3], monkeypatch, *arguments_of(law, 3))]
    stated = BOUNDS[law]
    if len(bounds) < len(stated):
        stated = [stated[k] for k in range(0, len(stated), len(stated) // len(bounds))]
    assert bounds == pytest.approx(stated, rel=1e-12, abs=0)


def spoilt(function: Callable[..., np.ndarray], call: int, place: int) -> Callable[..., np.ndarray]:
    """The function, of whose call number `call` one number is too large by 1e-8, which a pose may
    be off.
    """
    calls = 0

    def wrong(*arguments: Any, **options: Any) -> np.ndarray:
        nonlocal calls
        result = np.array(function(*arguments, **options))
        if calls == call:
            result.flat[place] += 1e-8
        calls += 1
        return result

    return wrong


def calls_of(
    law: str, group: Group, monkeypatch, arguments: tuple[np.ndarray, ...]
) -> dict[str, tuple[int, int]]:
    """The functions that a law calls: how often, and how many numbers they return."""
    found: dict[str, tuple[int, int]] = {}

    def counted(name: str, function: Callable[..., np.ndarray]) -> Callable[..., np.ndarray]:
        def one(*arguments: Any, **options: Any) -> np.ndarray:
            result = function(*arguments, **options)
            found[name] = (found.get(name, (0, 0))[0] + 1, result.size)
            return result

        return one

    recording = {name: counted(name, getattr(group, name)) for name in Group._fields[1:]}
    measured(law, Group(group.size, **recording), monkeypatch, *arguments)
    return found


@pytest.mark.parametrize("size", [3, 6])
@pytest.mark.parametrize("law", LAWS)
def test_a_law_sees_every_number_of_every_function(law, size, monkeypatch):
    group, arguments = GROUPS[size], arguments_of(law, size)
    right = measured(law, group, monkeypatch, *arguments)
    unseen: dict[tuple[str, int], set[int]] = {}
    for name, (count, numbers) in calls_of(law, group, monkeypatch, arguments).items():
        for call in sorted({0, 1, count // 2, count - 1} & set(range(count))):
            for place in range(numbers):
                if numbers == 16 and place in LAST_ROW and law not in READ_WHOLE:
                    continue
                wrong = group._replace(**{name: spoilt(getattr(group, name), call, place)})
                pairs = measured(law, wrong, monkeypatch, *arguments)
                if (
                    max(
                        (abs(a - b) for (a, _), (b, _) in zip(pairs, right, strict=True)), default=0
                    )
                    < 1e-11
                ):
                    unseen.setdefault((name, call), set()).add(place)
    for (called, name, calls), places in UNREAD.items():
        for call in calls if called == law else ():
            unseen[name, call] = unseen.get((name, call), set()) - places
    assert {key: places for key, places in unseen.items() if places} == {}


def test_errors_are_measured_in_every_entry_and_halves_apart():
    for k in range(6):
        error = np.zeros(6)
        error[k] = -2.0
        assert measures.of_twist(error, 3.0, 5.0) == [(2.0 * (k < 3), 3.0), (2.0 * (k >= 3), 5.0)]
    assert measures.of_twist(np.array([0.0, 3.0, -4.0]), 3.0, 5.0) == [(5.0, 3.0)]
    for i, j in np.ndindex(4, 4):
        error = np.zeros((4, 4))
        error[i, j] = -2.0
        R, t = i < 3 and j < 3, i < 3 and j == 3
        unit = [(2.0 * R, 12 * U * 3.0), (2.0 * t, 12 * U * 5.0)]
        assert measures.of_elements(np.eye(4) + error, np.eye(4), 3.0, 5.0) == unit
        if R:
            assert measures.of_elements(np.eye(3), np.eye(3) + error[:3, :3], 3.0, 5.0) == unit[:1]
    for i, j in np.ndindex(6, 6):
        error = np.zeros((6, 6))
        error[i, j] = -2.0
        block = {(0, 0): 0, (1, 1): 1, (0, 1): 2, (1, 0): 3}[i // 3, j // 3]
        assert measures.of_blocks(error, 3.0, 5.0) == [
            (2.0 * (block == k), bound) for k, bound in enumerate((3.0, 3.0, 0.0, 5.0))
        ]
    assert measures.of_blocks(np.diag([0, 3.0, 4.0]), 3.0, 5.0) == [(5.0, 3.0)]


def test_angles_lengths_and_shifts_are_norms():
    assert [measures.angle(x) for x in (XI, ETA, ZETA, XI[:3])] == pytest.approx(
        [2.5, 0.75, 1.25, 2.5], rel=1e-15
    )
    assert [measures.length(x) for x in (XI, ETA, ZETA, XI[:3])] == pytest.approx(
        [7, 3, 5, 0], rel=1e-15
    )
    assert [measures.shift(x) for x in (X, Y, X[:3, :3])] == pytest.approx([11, 13, 0], rel=1e-15)


def test_towards_pi_either_sign_is_a_logarithm():
    n = np.array([0.6, 0, 0.8])
    flipped = GROUPS[3]._replace(log=lambda R, near=None: -so3.log(R))
    for law in (group_laws.log_undoes_exp, near_laws.a_logarithm_is_nearest_to_itself):
        assert law(flipped, n * (math.pi - 5e-15)) == 0
        with pytest.raises(AssertionError):
            law(flipped, n * (math.pi - 5e-14))


def test_what_is_near_a_whole_turn_has_no_bound(monkeypatch):
    for angle, looked_at in (
        (0.05, True),
        (2 * math.pi - 0.09, False),
        (2 * math.pi + 0.09, False),
        (5.5, True),
        (6.4, True),
    ):
        xi = np.array([angle, 0, 0, 0, 1.0, 0])
        assert (
            bool(measured("a_logarithm_is_nearest_to_itself", GROUPS[6], monkeypatch, xi))
            == looked_at
        )
    beyond = measured("a_logarithm_is_nearest_to_itself", GROUPS[6], monkeypatch, XI * 2)
    assert [bound for _, bound in beyond] == pytest.approx(
        [64 * U * 5, 512 * U * 6**2 * 14], rel=1e-12, abs=0
    )


@pytest.mark.parametrize(
    ("angle", "factor"), [(3.0, 24), (math.pi - 5e-10, 24), (math.pi + 5e-10, 24), (4.0, 64)]
)
def test_beyond_half_a_turn_a_logarithm_may_err_more(angle, factor, monkeypatch):
    ((_, bound),) = measured("a_logarithm_is_nearest_to_itself", GROUPS[3], monkeypatch, angle * N)
    assert bound == pytest.approx(factor * U * angle, rel=1e-12, abs=0)


def test_near_what_lies_on_the_line_too_the_bounds_are_those_of_the_branch_that_is_found(
    monkeypatch,
):
    asked: list[np.ndarray] = []

    def log(X: np.ndarray, near: np.ndarray | None = None) -> np.ndarray:
        asked.extend([] if near is None else [near])
        return se3.log(X, near=near)

    group = GROUPS[6]._replace(log=log)
    found = iter(measured("near_picks_the_closest_branch", group, monkeypatch, XI, ETA))
    n = np.concatenate([N, np.zeros(3)])
    along = [0.75 * n, 3.0 * n, 6.0 * n]
    assert asked == pytest.approx(np.array([ETA, *along, *(-x for x in along)]), rel=1e-12, abs=0)
    branches = 2.5 + 2 * math.pi * np.arange(-4, 5)
    seen = set()
    for near in asked:
        angle = abs(branches[np.argmin(np.abs(branches - near[:3] @ N))])
        extent, shift = 1 + angle, measures.shift(se3.exp(XI))
        stretch = 1 / math.sin(1.25) if angle > math.pi else 1
        bounds = [
            24 * U * extent,
            48 * U * extent**2 * stretch * shift,
            16 * U * extent,
            64 * U * extent,
        ]
        assert [next(found)[1] for _ in bounds] == pytest.approx(bounds, rel=1e-12, abs=0)
        seen.add(round(angle, 1))
    assert seen == {2.5, 3.8, 8.8}
    assert not list(found)


def test_a_rotation_that_is_hardly_one_has_no_closest_branch(monkeypatch):
    for angle, pairs in ((1e-13, 0), (1e-11, 28)):
        xi = np.array([angle, 0, 0, 0, 1.0, 0])
        assert (
            len(measured("near_picks_the_closest_branch", GROUPS[6], monkeypatch, xi, ETA)) == pairs
        )
    assert (
        near_laws.near_picks_the_closest_branch(GROUPS[6], np.array([1e-13, 0, 0, 0, 1.0, 0]), ETA)
        == 0
    )


@pytest.mark.parametrize("turns", range(-4, 5))
def test_of_all_branches_up_to_four_turns_off_the_closest_is_asked_for(turns):
    xi, near = XI[:3], (2.5 + 2 * math.pi * turns + 0.4) * N
    near_laws.near_picks_the_closest_branch(GROUPS[3], xi, near)
    for off in (-1, 1):
        beside = GROUPS[3]._replace(
            log=lambda R, near=None, off=off: so3.log(
                R, near=near if near is None else near + off * 2 * math.pi * N
            )
        )
        with pytest.raises(AssertionError, match="near picks the closest branch"):
            near_laws.near_picks_the_closest_branch(beside, xi, near)
