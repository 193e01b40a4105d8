"""Arms with more than six coordinates: some locked, or one of them at many values."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, ShapeError, UnknownName
from poekin.solve.ik_all import sources
from poekin.solve.ik_all.ik_all import ik_all
from poekin.solve.ik_all.swivel import curves, redundant_coordinate, sample_values

PANDA = pk.load("panda").chain(tip="panda_hand")
Q = np.array([0.1, -0.5, 0.2, -2.0, 0.3, 1.6, 0.8])
TOL = 1e-10  # m and rad: what is promised of every solution
TURN = 2 * np.pi


def srs(limits: float = 2.9) -> pk.Chain:
    """An arm with a spherical shoulder, an elbow and a spherical wrist."""
    z, y = [0, 0, 1.0], [0, 1.0, 0]
    heights = (0.36, 0.36, 0.36, 0.78, 1.18, 1.18, 1.18)
    axes = zip((z, y, z, y, z, y, z), heights, strict=True)
    screws = [pk.screw.revolute(axis, [0, 0, height]) for axis, height in axes]
    return pk.Chain.from_space(
        screws, pk.se3.exp([0, 0, 0, 0, 0, 1.3]), limits=np.tile([-limits, limits], (7, 1))
    )


def largest_error(chain: pk.Chain, q: np.ndarray, T: np.ndarray) -> float:
    ours = chain.fk(q)
    turn = pk.so3.log(np.swapaxes(ours[..., :3, :3], -1, -2) @ T[..., :3, :3])
    return max(np.abs(ours - T)[..., :3, 3].max(initial=0), np.abs(turn).max(initial=0))


def apart(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.abs((a[:, None] - b[None] + np.pi) % TURN - np.pi).max(axis=-1, initial=0)


@given(st.data())
@settings(max_examples=max(settings().max_examples // 8, 8))
def test_solutions_of_a_locked_arm_reach_the_target_with_what_is_locked_at_its_value(data):
    names = data.draw(st.sets(st.sampled_from(PANDA.q_names), min_size=1, max_size=6))
    seed = data.draw(st.integers(0, 2**31))
    q = PANDA.random(seed)
    T = PANDA.fk(q)
    lock = {name: q[PANDA.q_names.index(name)] for name in names}
    found = ik_all(PANDA, T, lock=lock, restarts=300)
    assert largest_error(PANDA, found.q, T) <= TOL
    for name, value in lock.items():
        assert (found.q[:, PANDA.q_names.index(name)] == value).all()
    assert (found.q >= PANDA.limits[:, 0]).all()
    assert (found.q <= PANDA.limits[:, 1]).all()
    free = [k for k, name in enumerate(PANDA.q_names) if name not in names]
    J = PANDA.jacobian(q, "hybrid")[:, free]
    if np.linalg.svd(J, compute_uv=False)[-1] > 0.02:
        assert np.abs(found.q - q).max(axis=1).min(initial=np.inf) <= 1e-6


@pytest.mark.parametrize("names", [["panda_joint1"], ["panda_joint7"]], ids=str)
def test_values_at_an_end_have_the_solutions_that_each_has_by_an_arm_of_its_own(monkeypatch, names):
    q = PANDA.random(11, 25)
    T = PANDA.fk(q)
    T[3, :3, 3] += 5.0  # out of reach
    lock = {name: q[:, PANDA.q_names.index(name)] for name in names}
    found = ik_all(PANDA, T, lock=lock, limits=False)
    with monkeypatch.context() as patch:
        patch.setattr(sources, "at_ends", lambda chain, free: np.zeros(7, bool))
        patch.setattr(sources, "brought_back", lambda chain, T, values, free: T)
        expected = ik_all(PANDA, T, lock=lock, limits=False)
    np.testing.assert_array_equal(found.counts, expected.counts)
    assert found.counts[3] == 0
    # rounding of a target by the least singular value of these poses, 1e-3 or more
    assert (np.abs((found.q - expected.q + np.pi) % TURN - np.pi) <= 1e-9).all()
    np.testing.assert_array_equal(found.complete, expected.complete)
    for name, values in lock.items():
        k = PANDA.q_names.index(name)
        np.testing.assert_array_equal(found.q[:, k], values[found.target_number])


def test_each_target_of_a_batch_may_have_its_own_locked_value():
    q = PANDA.random(3, 5)
    T = PANDA.fk(q)
    found = ik_all(PANDA, T, lock={"panda_joint7": q[:, 6]})
    for k in range(5):
        alone = ik_all(PANDA, T[k], lock={"panda_joint7": q[k, 6]})
        assert len(found.solutions[k]) == len(alone.solutions)
        assert (
            apart(found.solutions[k], alone.solutions).min(axis=1, initial=np.inf) <= 1e-6
        ).all()
        assert (found.solutions[k][:, 6] == q[k, 6]).all()
    # the same value for all, and one for each row of a batch of two axes
    whole = ik_all(
        PANDA, np.broadcast_to(T[0], (2, 3, 4, 4)), lock={"panda_joint7": [[q[0, 6]], [0.5]]}
    )
    assert (whole.of(0, 2)[:, 6] == q[0, 6]).all()
    assert (whole.of(1, 0)[:, 6] == 0.5).all()
    with pytest.raises(ShapeError, match=r"lock: 'panda_joint7': shape \(3,\) does not fit"):
        ik_all(PANDA, T, lock={"panda_joint7": [0.1, 0.2, 0.3]})


def test_each_target_of_a_batch_has_its_own_curves():
    T = PANDA.fk(PANDA.random(2, 2))
    found = ik_all(PANDA, T, n_swivel=16)
    for k in range(2):
        alone = ik_all(PANDA, T[k], n_swivel=16).families()
        assert len(alone) > 1
        for ours, curve in zip(found.families(k), alone, strict=True):
            np.testing.assert_array_equal(ours, curve)


def test_each_target_of_a_batch_has_its_own_locked_value_at_every_value_of_the_redundant_coordinate():
    rail = pk.Chain.from_space(np.vstack([pk.screw.prismatic([1, 0, 0]), srs().screws]), srs().home)
    q = rail.random(1, 2)
    T = rail.fk(q)
    found = ik_all(rail, T, lock={"joint1": q[:, 0]}, n_swivel=3, all_revolutions=True)
    for k, value in enumerate(q[:, 0]):
        alone = ik_all(rail, T[k], lock={"joint1": value}, n_swivel=3, all_revolutions=True)
        assert alone.counts > 0
        np.testing.assert_allclose(found.of(k), alone.q, rtol=0, atol=1e-9)


def test_a_locked_arm_with_a_closed_form_has_the_solutions_of_the_search():
    pytest.importorskip("eaik", reason="needs EAIK")
    chain = srs()
    q = chain.random(1, 10)
    T = chain.fk(q)
    lock = {"joint3": q[:, 2]}
    closed, searched = (
        ik_all(chain, T, lock=lock, method=method) for method in ("closed", "search")
    )
    assert closed.method == "closed form"
    assert closed.complete.all()
    assert not searched.complete.any()
    for a, b in zip(closed.solutions, searched.solutions, strict=True):
        assert len(a) == len(b)
        assert (apart(a, b).min(axis=1) <= 1e-5).all()


def test_a_locked_coordinate_is_not_turned_round_and_another_one_is():
    chain = srs(2 * np.pi)
    q = np.array([0.3, 0.5, 3.5, -1.0, 0.4, 0.7, 0.1])
    found = ik_all(chain, chain.fk(q), lock={"joint3": 3.5}, all_revolutions=True)
    assert (found.q[:, 2] == 3.5).all()
    assert np.abs(found.q - q).max(axis=1).min() <= 1e-6
    assert len(np.unique(np.round(found.q, 6), axis=0)) == len(found.q)


def test_six_coordinates_may_be_locked_of_six_too():
    chain = pk.load("ur5").chain()
    q = np.array([0.4, -1.2, 1.5, -0.3, 0.8, 0.0])
    found = ik_all(chain, chain.fk(q), lock={chain.q_names[5]: 0.0})
    assert np.abs(found.solutions - q).max(axis=1).min() <= 1e-6
    assert (found.solutions[:, 5] == 0).all()
    assert ik_all(chain, chain.fk(q), lock={}).counts == ik_all(chain, chain.fk(q)).counts


@pytest.mark.parametrize("limits", [True, False])
def test_the_values_of_the_redundant_coordinate_are_even_and_have_all_their_solutions(limits):
    T = PANDA.fk(Q)
    found = ik_all(PANDA, T, n_swivel=16, limits=limits)
    assert (found.redundant, len(found.q)) == ("panda_joint7", int(found.counts))
    if limits:
        values = np.linspace(-2.8973, 2.8973, 16)
    else:
        values = -np.pi + TURN / 16 * np.arange(16)
    assert found.sample is not None
    np.testing.assert_allclose(found.q[:, 6], values[found.sample], atol=1e-12)
    assert (np.diff(found.sample) >= 0).all()
    assert largest_error(PANDA, found.q, T) <= TOL
    for s in range(16):
        alone = ik_all(PANDA, T, lock={"panda_joint7": values[s]}, limits=limits)
        here = found.q[found.sample == s]
        assert len(here) == len(alone.solutions)
        assert (apart(here, alone.solutions).min(axis=1, initial=np.inf) <= 1e-5).all()
    assert found.continuum
    assert found.complete is False
    assert found.explanation.startswith("infinitely many solutions; ")
    assert " at 16 values of 'panda_joint7'" in found.summary()


def test_samples_of_a_batch_are_those_of_each_target():
    q = PANDA.random(4, 2)
    T = PANDA.fk(q)
    T[1, 0, 3] += 9.0
    found = ik_all(PANDA, T, redundant="panda_joint5")
    assert found.redundant == "panda_joint5"
    assert found.counts[0] > 0 == found.counts[1]
    assert found.continuum.tolist() == [True, False]
    alone = ik_all(PANDA, T[0], redundant="panda_joint5", n_swivel=64)
    np.testing.assert_array_equal(found.of(0), alone.solutions)
    assert [len(c) for c in found.families(0)] == [len(c) for c in alone.families()]
    assert found.families(1) == []


def test_curves_of_self_motion_hold_every_solution_once_and_stay_at_the_target_between_them():
    T = PANDA.fk(Q)
    found = ik_all(PANDA, T, n_swivel=128, limits=False)
    families = found.families()
    together = np.concatenate(families)
    assert len(together) == len(found.q)
    assert len(np.unique(together, axis=0)) == len(found.q)
    assert [len(c) for c in families] == sorted(map(len, families), reverse=True)
    assert len(families[0]) > 20
    step = TURN / 128
    for curve in families:
        change = (np.diff(curve, axis=0) + np.pi) % TURN - np.pi
        np.testing.assert_allclose(change[:, 6], step, atol=1e-9)
        halfway = curve[:-1] + 0.5 * change
        off = np.linalg.norm((PANDA.fk(halfway) - T)[:, :3, 3], axis=1)
        # an arc's middle is off its chord's by |change|^2 / 8 of a curvature; two curves are apart
        assert (off <= 0.5 * PANDA.reach * (change**2).sum(axis=1)).all()


def test_curves_of_self_motion_are_the_same_whatever_the_unit_of_the_coordinates():
    arm = PANDA.replace(limits=None)
    degrees = arm.replace(coupling=np.eye(7) * np.pi / 180)
    T = arm.fk(Q)
    ours, theirs = (ik_all(one, T, n_swivel=16).families() for one in (arm, degrees))
    assert max(map(len, ours)) > 4
    for curve, other in zip(ours, theirs, strict=True):
        np.testing.assert_allclose(np.radians(other), curve, rtol=0, atol=1e-9)


def test_where_solutions_of_two_curves_are_exchanged_they_are_not_linked():
    chain = srs()
    found = ik_all(chain, chain.fk([0.3, 0.5, 0.2, -1.0, 0.4, 0.7, 0.1]), redundant="joint7")
    assert found.sample is not None
    exchanged = found.q.copy()
    number = int(found.sample[len(found.q) // 2])
    rows = np.flatnonzero(found.sample == number)
    exchanged[rows] += 0.4 * (np.arange(7) != 6)
    free = np.tile([-np.inf, np.inf], (7, 1))
    whole = curves(chain, found.q, found.sample, "joint7", free)
    cut = curves(chain, exchanged, found.sample, "joint7", free)
    assert len(cut) > len(whole)


def test_the_redundant_coordinate_is_chosen_by_the_shape_of_the_arm():
    free = np.full(7, np.nan)
    assert redundant_coordinate(srs(), free, None) == 2
    assert redundant_coordinate(PANDA, free, None) == 6
    assert redundant_coordinate(PANDA, free, "panda_joint4") == 3
    # no three axes meet or are parallel: a coordinate that hardly moves along self-motions is not it
    rng = np.random.default_rng(1)
    screws = [pk.screw.revolute(w / np.linalg.norm(w), p) for w, p in rng.normal(size=(7, 2, 3))]
    odd = pk.Chain.from_space(screws, np.eye(4))
    k = redundant_coordinate(odd, free, None)
    J = odd.jacobian(odd.random(5, 200), "hybrid")
    v = np.abs(np.linalg.svd(J)[2][:, -1])
    assert np.median(v[:, k]) >= 0.5 * np.median(v, axis=0).max()
    # of eight, one locked
    rail = pk.Chain.from_space(np.vstack([pk.screw.prismatic([1, 0, 0]), srs().screws]), srs().home)
    assert redundant_coordinate(rail, np.array([0.3, *free]), None) == 3


def test_values_are_over_the_limits_or_a_turn():
    free = pk.Chain.from_space(srs().screws, srs().home)
    np.testing.assert_allclose(sample_values(srs(), 2, 5, True), np.linspace(-2.9, 2.9, 5))
    np.testing.assert_allclose(sample_values(srs(2.9), 2, 1, True), [0.0])
    turn = -np.pi + np.pi / 2 * np.arange(4)
    for chain, limits in ((srs(), False), (free, True), (srs(TURN), True)):
        np.testing.assert_allclose(sample_values(chain, 2, 4, limits), turn)
    shifted = srs().replace(limits=[[1.0, 20.0]] * 7)
    np.testing.assert_allclose(sample_values(shifted, 2, 4, True), 1.0 + np.pi / 2 * np.arange(4))
    rail = pk.Chain.from_space([pk.screw.prismatic([1, 0, 0])], np.eye(4))
    np.testing.assert_allclose(sample_values(rail, 0, 3, True), [-1, 0, 1])


@pytest.mark.parametrize(("options", "error", "words"), [
    ({}, InputError,
     r"^ik_all: expected an arm of up to six coordinates, got 7 \('panda_joint1', .*, 'panda_joint7'\): it has "
     r"infinitely many solutions; ik finds one of your choice; here `lock` keeps coordinates at given values, and "
     r"`n_swivel=64` gives one of seven 64 values$"),
    ({"lock": {"joint7": 0.1}}, UnknownName, r"lock: no coordinate 'joint7'"),
    ({"lock": {"panda_joint7": 9}}, InputError, r"lock: 'panda_joint7': expected a number within"),
    ({"lock": ["panda_joint7"]}, InputError, r"lock: expected a dict of names and values"),
    ({"lock": dict.fromkeys(PANDA.q_names, -1e-2)}, InputError, r"lock: 'panda_joint4': expected a number within"),
    ({"lock": dict(zip(PANDA.q_names, Q, strict=True))}, InputError,
     r"^ik_all: expected an arm of one to six coordinates, all of them are locked$"),
    ({"n_swivel": 0}, InputError, r"n_swivel: expected a whole number from 1 on, got 0"),
    ({"n_swivel": 8, "lock": {"panda_joint7": 0.1}}, InputError, r"n_swivel: expected an arm with seven .* got 6"),
    ({"redundant": "joint3"}, UnknownName, r"redundant: no coordinate 'joint3'"),
    ({"parallel": 1}, InputError, r"parallel: expected True or False, got 1"),
])  # fmt: skip
def test_what_leaves_no_question_is_refused(options, error, words):
    with pytest.raises(error, match=words):
        ik_all(PANDA, PANDA.fk(Q), **options)


def test_a_locked_coordinate_is_not_the_redundant_one():
    rail = pk.Chain.from_space(np.vstack([pk.screw.prismatic([1, 0, 0]), srs().screws]), srs().home)
    with pytest.raises(
        InputError, match="redundant: expected a coordinate that is free, 'joint1' is locked"
    ):
        ik_all(rail, np.eye(4), lock={"joint1": 0.1}, redundant="joint1")


def test_an_empty_batch_has_no_samples_and_nan_has_none_of_its_own():
    found = ik_all(PANDA, np.empty((0, 4, 4)), n_swivel=8)
    assert (found.counts.shape, found.q.shape, len(found.explanation)) == ((0,), (0, 7), 0)
    T = np.stack([PANDA.fk(Q), np.full((4, 4), np.nan)])
    found = ik_all(PANDA, T, n_swivel=8)
    assert found.counts[0] > 0 == found.counts[1]
    assert "bad target" in found.explanation[1]


def test_threads_find_what_one_thread_finds():
    chain = pk.load("ur5").chain()
    T = chain.fk(chain.random(2, 100))
    one, many = (ik_all(chain, T, method="search", parallel=parallel) for parallel in (False, True))
    np.testing.assert_array_equal(one.q, many.q)
    np.testing.assert_array_equal(one.counts, many.counts)


def test_a_curve_leaves_the_limits_at_no_place():
    """A step that is short but for a whole turn leads out of the limits and in again beyond them."""
    T = PANDA.fk([-1.1, -0.05, 2.26, -0.27, -0.82, 2.14, -1.03])
    for limits, crosses in ((True, False), (False, True)):
        families = ik_all(PANDA, T, n_swivel=64, limits=limits).families()
        changes = [np.abs(np.diff(curve, axis=0)).max(initial=0) for curve in families]
        assert (max(changes) > 4.0) == crosses
