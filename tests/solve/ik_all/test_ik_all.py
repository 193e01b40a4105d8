"""ik_all: every listed solution is one, none is missing, and what cannot be listed is said."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, PoseError
from poekin.solve.ik_all import closed_form as closed_form_module
from poekin.solve.ik_all import ik_all as module
from poekin.solve.ik_all import sources
from poekin.solve.ik_all.ik_all import ik_all
from poekin.solve.ik_all.solution_sets import places as places_module
from poekin.testing.strategies import chain_strategies
from tests.solve.ik_all.perturbed import calibrated_ur10e, perturbed

TOL = 1e-10  # m and rad: what is promised of every solution
# rad or m: two solvers' ends of one solution, whose poses are 1e-10 off, away from singular ones
NEAR = 1e-6


def errors(chain, Q, T):
    """Largest distance (m) and angle (rad) of the poses of Q from a target, by `fk` and `so3.log`."""
    ours = chain.fk(Q)
    turn = pk.so3.log(np.swapaxes(ours[:, :3, :3], 1, 2) @ T[:3, :3])
    return np.linalg.norm(ours[:, :3, 3] - T[:3, 3], axis=1).max(initial=0), np.linalg.norm(
        turn, axis=1
    ).max(initial=0)


def apart(a, b):
    """Largest difference of angles between each of a and each of b, by the shorter way round."""
    return np.abs((a[:, None] - b[None] + np.pi) % (2 * np.pi) - np.pi).max(axis=-1, initial=0)


def same_sets(a, b, near=NEAR):
    """Whether two lists hold the same configurations of turning joints, each once."""
    if len(a) != len(b):
        return False
    d = apart(a, b) <= near
    return bool((d.sum(axis=0) == 1).all() and (d.sum(axis=1) == 1).all())


def arm(name):
    return pk.load(name).chain()


def targets(chain, seed, count):
    q = np.random.default_rng(seed).uniform(-np.pi, np.pi, (count, chain.dof))
    return q, chain.fk(q)


SIX = ("puma560", "ur5", "ur5e", "irb140", "jaco")


@pytest.mark.parametrize("method", ["auto", "search"])
@pytest.mark.parametrize("name", SIX)
def test_every_solution_reaches_its_target_and_the_known_one_is_among_them(name, method):
    chain = arm(name)
    q, T = targets(chain, 1, 200)
    result = ik_all(chain, T, method=method, limits=False)
    for k in range(len(T)):
        assert max(errors(chain, result.solutions[k], T[k])) <= TOL
    # nearly singular arms are known less well, and where a search has trouble it says so
    known = [
        apart(q[k : k + 1], result.solutions[k]).min(initial=np.inf) <= 1e-5 for k in range(len(T))
    ]
    assert np.mean(known) >= 0.995
    assert all(known | (result.p_missing > 1e-2))
    assert result.position_error.max() <= TOL
    assert result.rotation_error.max() <= TOL
    assert (result.counts == [len(Q) for Q in result.solutions]).all()


@given(st.data())
@settings(
    max_examples=max(settings().max_examples // 4, 12)
)  # each makes machine code for a new arm
def test_of_any_arm_the_known_solution_is_found_or_is_singular(data):
    chain = data.draw(chain_strategies.chains(1, 6, ("revolute", "prismatic"), coupled=False))
    q = data.draw(chain_strategies.coordinates(chain))
    T = chain.fk(q)
    result = ik_all(chain, T, limits=False, min_hits=40, method="search")
    assert max(errors(chain, result.solutions, T)) <= TOL
    sizes = np.linalg.svd(chain.jacobian(q, frame="hybrid"), compute_uv=False)
    if sizes[-1] > 1e-3 * sizes[0]:
        turns = np.array([kind == "revolute" for kind in chain.kinds])
        d = result.solutions - q
        d[:, turns] = (d[:, turns] + np.pi) % (2 * np.pi) - np.pi
        known = np.abs(d).max(axis=1).min(initial=np.inf) <= NEAR
        # of two solutions near each other one may be found at less than one try in a hundred: it is
        # missing then, and said to be
        assert known or "or one is missing" in result.summary()


def test_where_one_of_two_near_solutions_is_missing_the_odd_number_says_so():
    turn = np.array(
        [
            [0.63377431, 0.41247344, -0.65436671],
            [-0.57494888, 0.43846255, 0.69078533],
            [-0.49720289, -0.70713755, 0.50273827],
        ]
    )
    slide = np.array(
        [[0, -1, 0], [0.88363075, -0.46670382, 0.03720551], [-0.53920301, -0.7919606, 0.28645859]]
    )
    screws = [
        screw
        for w, v in zip(turn, slide, strict=True)
        for screw in (pk.screw.prismatic(v), pk.screw.revolute(w, [0, 0, 0]))
    ]
    order = [0, 1, 2, 3, 5, 4]
    chain = pk.Chain.from_space([screws[k] for k in order], np.eye(4))
    q = [0.0, -2.92187381, -3.0, np.pi, 0.07421988, -1.0]
    for min_hits, seed in ((40, 0), (40, 1), (16, 0)):
        result = ik_all(
            chain, chain.fk(q), limits=False, min_hits=min_hits, method="search", seed=seed
        )
        assert len(result.solutions) == 2 or "or one is missing" in result.summary()


@given(st.data())
@settings(max_examples=max(settings().max_examples // 4, 12))
def test_of_coupled_and_helical_joints_every_solution_reaches_the_target(data):
    chain = data.draw(chain_strategies.chains(1, 6).filter(lambda chain: chain.dof))
    T = chain.fk(data.draw(chain_strategies.coordinates(chain)))
    result = ik_all(chain, T, restarts=200)
    Q = np.reshape(result.solutions, (-1, chain.dof))
    assert max(errors(chain, Q, T)) <= TOL
    assert len(Q) <= 40


def test_targets_in_any_order_of_memory_have_the_same_solutions():
    chain = arm("ur5")
    T = targets(chain, 3, 2)[1]
    wanted = ik_all(chain, T).solutions
    for other in (np.asfortranarray(T), np.broadcast_to(T[:1], T.shape)):
        found = ik_all(chain, other).solutions
        np.testing.assert_array_equal(found[0], wanted[0])
    np.testing.assert_array_equal(ik_all(chain, np.asfortranarray(T[1])).solutions, wanted[1])


def test_a_long_arm_has_solutions_as_exact_as_its_poses():
    chain = arm("ur5")
    D = np.diag([1, 1, 1, 1e5, 1e5, 1e5])
    home = chain.home.copy()
    home[:3, 3] *= 1e5
    long = pk.Chain.from_space(chain.screws @ D, home)
    T = long.fk([0.1, -1.0, 1.2, 0.4, 0.9, -0.3])
    for method in ("auto", "search"):
        result = ik_all(long, T, method=method)
        assert result.counts == 8
        assert max(errors(long, result.solutions, T)) <= 1e-12 * long.reach


@pytest.mark.parametrize("name", ["puma560", "irb140", "kr5"])
def test_a_spherical_wrist_turned_over_is_a_solution_too(name):
    chain = arm(name)
    _, T = targets(chain, 2, 100)
    for Q in ik_all(chain, T, method="search", limits=False).solutions:
        assert same_sets(Q, Q * [1, 1, 1, 1, -1, 1] + [0, 0, 0, np.pi, 0, np.pi])


def eaik_solutions(chain, T):
    """EAIK's own solutions of a target, those that are near it."""
    solver = pytest.importorskip("eaik.IK_HP", reason="needs EAIK").HPRobot(*chain.to_hp()[:2])
    target = T.copy()
    target[:3, :3] = T[:3, :3] @ chain.home[:3, :3].T
    Q = solver.IK(target).Q
    return Q[np.abs(chain.fk(Q) - T).max(axis=(1, 2)) < 1e-7]


@pytest.mark.parametrize("chain", [
    calibrated_ur10e(), perturbed(arm("puma560"), 1), arm("jaco"),
], ids=["UR10e", "Puma 560", "Jaco"])  # fmt: skip
def test_six_revolute_joints_of_any_geometry_are_solved_by_elimination(chain):
    q, T = targets(chain, 31, 12)
    found = ik_all(chain, T, limits=False)
    assert found.method == "elimination"
    searched = ik_all(chain, T, limits=False, method="search", min_hits=40)
    assert found.complete.any()
    for k in range(len(T)):
        assert max(errors(chain, found.solutions[k], T[k])) <= TOL
        if found.complete[k]:
            assert same_sets(found.solutions[k], searched.solutions[k], 1e-5)
            assert found.p_missing[k] == 0
            assert "elimination" in found.explanation[k]
        assert (apart(found.solutions[k], q[k : k + 1]) <= 1e-5).any()


def test_a_method_that_does_not_solve_an_arm_is_refused_with_the_reason():
    with pytest.raises(
        InputError, match=r"has no closed form \(.*method='elimination' or 'search'"
    ):
        ik_all(arm("jaco"), np.eye(4), method="closed")
    with pytest.raises(InputError, match=r"not solved by elimination .*method='search' finds"):
        ik_all(arm("iiwa14"), np.eye(4), method="elimination", lock={"joint1": 0.3})
    with pytest.raises(InputError, match="expected revolute joints only"):
        ik_all(arm("stanford"), np.eye(4), method="elimination")


@pytest.mark.parametrize("method", ["closed", "search"])
@pytest.mark.parametrize("name", ["puma560", "ur5"])
def test_the_solutions_are_those_of_eaik(name, method):
    chain = arm(name)
    _, T = targets(chain, 3, 200)
    theirs = [eaik_solutions(chain, target) for target in T]
    result = ik_all(chain, T, method=method, limits=False)
    equal = [same_sets(a, b, 1e-5) for a, b in zip(result.solutions, theirs, strict=True)]
    # one in 200 may be so near a double solution that the two differ about it
    assert np.mean(equal) >= 0.995
    assert result.method == {"closed": "closed form", "search": "search"}[method]


@pytest.mark.parametrize("plant", ["one missing", "one moved", "one twice"])
def test_a_planted_difference_of_two_sets_is_seen(plant):
    chain = arm("ur5")
    _, T = targets(chain, 4, 1)
    Q = ik_all(chain, T[0], method="search", limits=False).solutions
    assert same_sets(Q, Q[::-1] + 2 * np.pi)
    other = {
        "one missing": Q[1:],
        "one moved": Q + 1e-4 * np.eye(len(Q), 6),
        "one twice": Q[[0, *range(len(Q) - 1)]],
    }
    assert not same_sets(Q, other[plant])


@pytest.mark.parametrize("plant", ["no solutions", "wrong ones", "not a number"])
def test_a_closed_form_that_errs_makes_no_false_solution(plant, monkeypatch):
    rows = {
        "no solutions": np.empty((0, 6)),
        "wrong ones": np.linspace(-3.0, 3.0, 48).reshape(8, 6),
        "not a number": np.full((3, 6), np.nan),
    }[plant]
    made = (rows, np.array([len(rows)]), np.zeros(1, bool))
    monkeypatch.setattr(closed_form_module.ClosedForm, "starts", lambda self, T: made)
    monkeypatch.setattr(sources, "_closed_form", closed_form_module.closed_form)
    chain = arm("ur5")
    _, T = targets(chain, 5, 1)
    Q = ik_all(chain, T[0], method="closed", limits=False).solutions
    assert max(errors(chain, Q, T[0])) <= TOL
    assert len(Q) < 8


def test_an_arm_with_rounded_right_angles_has_a_closed_form_and_its_own_solutions():
    whole = arm("ur5")
    tilt = pk.se3.adjoint(pk.se3.exp([2e-7, -3e-7, 0.0, 1e-7, 0.0, 2e-7]))
    chain = pk.Chain.from_space(
        [*whole.screws[:2], tilt @ whole.screws[2], *whole.screws[3:]], whole.home
    )
    assert closed_form_module.closed_form(chain) is not None
    _, T = targets(chain, 6, 50)
    closed, search = (
        ik_all(chain, T, method=method, limits=False) for method in ("closed", "search")
    )
    assert "of the arm made exact, at most " in closed.explanation[0]
    for k in range(len(T)):
        assert max(errors(chain, closed.solutions[k], T[k])) <= TOL
        assert same_sets(closed.solutions[k], search.solutions[k], 1e-5)


@pytest.mark.parametrize("tilt", [1e-12, 1e-8, 3e-5])
@pytest.mark.parametrize("joint", [0, 1])
def test_axes_that_are_parallel_but_for_a_rounding_are_solved(joint, tilt):
    home = pk.se3.exp([0.1, 0.2, 0.3, 0.5, 0, 0.8])
    turned = [np.sin(tilt), np.cos(tilt), 0]
    first = [[0, 1, 0], turned, [1, 0, 0]] if joint == 0 else [[0, 0, 1], [0, 1, 0], turned]
    wrist = [pk.screw.revolute(z, [0.9, 0, 0.3]) for z in ([1, 0, 0], [0, 1, 0], [1, 0, 0])]
    places = ([0, 0, 0], [0.1, 0, 0.2], [0.5, 0, 0.25])
    chain = pk.Chain.from_space([*map(pk.screw.revolute, first, places), *wrist], home)
    q, T = targets(chain, 21, 3)
    found, searched = (ik_all(chain, T, method=method) for method in ("auto", "search"))
    for k in range(3):
        assert same_sets(found.solutions[k], searched.solutions[k], 1e-5)
        assert apart(q[k : k + 1], found.solutions[k]).min() <= 1e-5
    assert found.method == "closed form"  # by its wrist


def test_where_solutions_become_one_the_closed_form_is_not_taken_at_its_word():
    chain = arm("ur5")
    usual, straight = ik_all(
        chain, chain.fk([[0.3, -1, 1.2, 0.4, 0.9, 0.1], [0.3, -1, 0, 0.4, 0.9, 0.1]])
    ).p_missing
    assert usual == 0
    assert 0 < straight < 2e-3  # of a search


@pytest.mark.parametrize("cross", [[1.0, 0.0, 0.0], [0.6, 0.8, 0.0]], ids=["square", "slanted"])
def test_an_arm_with_coaxial_neighbours_is_searched(cross):
    z, y = [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]
    axes = [
        (z, [0, 0, 0]),
        (cross, [0, 0, 0]),
        (cross, [0, 0, 0]),
        (z, [0, 0.4, 0]),
        (z, [0, 0.4, 0]),
        (y, [0, 0.4, 0]),
    ]
    chain = pk.Chain.from_space(
        [pk.screw.revolute(*axis) for axis in axes], pk.se3.exp([0.1, 0.2, 0.3, 0.5, 0, 0.8])
    )
    assert closed_form_module.closed_form(chain) is None
    T = chain.fk([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    assert max(errors(chain, ik_all(chain, T).solutions, T)) <= TOL


def test_a_target_that_the_closed_form_is_unsure_of_is_searched(monkeypatch):
    chain = arm("ur5")
    _, T = targets(chain, 5, 3)
    branches = closed_form_module.ClosedForm.branches

    def doubtful(self, T):
        rows = branches(self, T)
        rows[1, :, -1] = 0.0  # the margin of a double solution
        return rows

    def no_starts(self, T):
        return np.empty((0, 6)), np.zeros(len(T), int), np.ones(len(T), bool)

    expected = ik_all(chain, T, limits=False)
    monkeypatch.setattr(closed_form_module.ClosedForm, "branches", doubtful)
    monkeypatch.setattr(closed_form_module.ClosedForm, "starts", no_starts)
    found = ik_all(chain, T, limits=False)
    for a, b in zip(found.solutions, expected.solutions, strict=True):
        assert same_sets(a, b, 1e-5)
    assert "search, " in found.explanation[1]
    assert "search, " not in found.explanation[0]


def test_limits_are_kept_and_all_places_a_turn_apart_are_counted_or_listed():
    chain = arm("puma560")
    wide = pk.Chain.from_space(
        chain.screws, chain.home, limits=np.tile([-1.5 * np.pi, 2 * np.pi], (6, 1))
    )
    _, T = targets(wide, 7, 30)
    result, every = ik_all(wide, T), ik_all(wide, T, all_revolutions=True)
    for k in range(len(T)):
        Q = every.solutions[k]
        assert (wide.limits[:, 0] <= Q).all()
        assert (wide.limits[:, 1] >= Q).all()
        assert max(errors(wide, Q, T[k])) <= TOL
        assert len(np.unique(np.round(Q, 6), axis=0)) == len(Q) == result.n_revolutions[k].sum()
        assert (every.n_revolutions[k] == 1).all()
        # by hand: how many of q - 2 pi, q, q + 2 pi are within the limits
        by_hand = [
            np.prod(
                [
                    sum(-1.5 * np.pi <= x + 2 * np.pi * t <= 2 * np.pi for t in (-2, -1, 0, 1, 2))
                    for x in q
                ]
            )
            for q in result.solutions[k]
        ]
        assert result.n_revolutions[k].tolist() == by_hand


def test_solutions_outside_the_limits_are_left_out_and_said():
    chain = arm("puma560")
    result = ik_all(chain, chain.fk([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]))
    anywhere = ik_all(chain, chain.fk([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]), limits=False)
    assert len(anywhere.solutions) == result.anywhere == 8
    inside = (
        (anywhere.solutions >= chain.limits[:, 0]) & (anywhere.solutions <= chain.limits[:, 1])
    ).all(axis=1)
    assert 0 < inside.sum() <= len(result.solutions) < 8
    assert f"8 solutions, {len(result.solutions)} of them within the limits: " in result.explanation


def test_a_solution_at_a_limit_is_within_it():
    chain = arm("ur5")
    q = np.array([0.1, -1.0, 1.2, 0.4, 0.9, -0.3])
    below, above = np.array([0, 1, 1, 1, 1, 1]), np.array([1, 0, 1, 1, 1, 1])
    tight = pk.Chain.from_space(
        chain.screws, chain.home, limits=np.stack([q - below, q + above], axis=1)
    )
    result = ik_all(tight, tight.fk(q))
    assert apart(q[None], result.solutions).min() <= 1e-9
    assert (result.solutions >= tight.limits[:, 0]).all()
    assert (result.solutions <= tight.limits[:, 1]).all()


@pytest.mark.parametrize("method", ["auto", "search"])
@pytest.mark.parametrize(
    ("name", "q", "moving"),
    [
        pytest.param(
            "puma560", [0.1, -0.7, 0.5, 0.3, 0.0, 0.2], {"joint4", "joint6"}, id="straight wrist"
        ),
        pytest.param(
            "ur5",
            [0.1, -0.7, 0.5, 0.3, 0.0, 0.2],
            {"shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_3_joint"},
            id="four parallel axes",
        ),
    ],
)
def test_infinitely_many_solutions_are_said_and_one_is_listed(name, q, moving, method):
    chain = arm(name)
    result = ik_all(chain, chain.fk(q), method=method, limits=False)
    assert result.continuum
    assert result.complete is False
    assert set(result.self_motion_coordinates[0]) == moving
    assert np.isnan(result.p_missing)
    assert all(f"'{joint}'" in result.explanation for joint in moving)
    assert "infinitely many solutions" in result.explanation
    sizes = np.linalg.svd(chain.jacobian(result.solutions, "hybrid"), compute_uv=False)
    assert (sizes[:, -1] < 1e-6).sum() == 1
    assert max(errors(chain, result.solutions, chain.fk(q))) <= TOL


@pytest.mark.parametrize("method", ["auto", "search"])
def test_a_double_solution_is_one_and_no_continuum(method):
    # Puma's elbow stretched: elbow up and elbow down are the same
    chain = arm("puma560")
    q = np.array([0.3, -0.4, 0.0, 0.8, 0.9, -0.2])
    q[2] = -np.pi / 2 + np.arctan2(0.0203, 0.4318)
    sizes = np.linalg.svd(chain.jacobian(q, "hybrid"), compute_uv=False)
    q[2] = q[2] if sizes[-1] < 1e-3 else np.pi / 2 + np.arctan2(0.0203, 0.4318)
    result = ik_all(chain, chain.fk(q), method=method, limits=False)
    assert not result.continuum
    assert result.counts == 4
    assert apart(q[None], result.solutions).min() <= 1e-4  # the square root of the pose's error


@pytest.mark.parametrize("method", ["auto", "search"])
def test_a_continuum_does_not_depend_on_the_unit_of_length(method):
    chain = arm("ur5e")
    D = np.diag([1, 1, 1, 0.02, 0.02, 0.02])
    home = chain.home.copy()
    home[:3, 3] *= 0.02
    small = pk.Chain.from_space(chain.screws @ D, home)
    right = np.pi / 4
    # two solutions that lie close together, an ordinary pose, and one of a continuum
    q = np.array([[3 * right, right, -4 * right, 2 * right, right, 2 * right],
                  [0.1, -1.0, 1.2, 0.4, 0.9, -0.3], [0.1, -0.7, 0.5, 0.3, 0, 0]])  # fmt: skip
    found, expected = (ik_all(a, a.fk(q), method=method, limits=False) for a in (small, chain))
    np.testing.assert_array_equal(found.counts, expected.counts)
    np.testing.assert_array_equal(found.continuum, expected.continuum)
    assert expected.continuum.tolist() == [False, False, True]


@pytest.mark.parametrize("method", ["auto", "search"])
def test_of_an_unreachable_target_none_is_claimed(method):
    T = np.eye(4)
    T[0, 3] = 9.0
    result = ik_all(arm("ur5"), T, method=method)
    assert result.solutions.shape == (0, 6)
    assert result.explanation.startswith("0 solutions: ")
    assert result.complete is (result.method == "closed form")
    assert np.isnan(result.p_missing) == (result.method == "search")
    assert np.isnan(result.position_error)


@pytest.mark.parametrize("name", ["cobra600", "stanford"])
def test_an_arm_with_a_slide_is_solved_in_closed_form(name):
    chain = arm(name)
    q = chain.random(8, 20)
    result = ik_all(chain, chain.fk(q))
    assert result.method == "closed form"
    for k in range(len(q)):
        assert np.abs(result.solutions[k] - q[k]).max(axis=1).min() <= 1e-5


@pytest.mark.parametrize("joints", [1, 2, 3, 4, 5])
def test_an_arm_of_fewer_joints_has_its_solutions_where_it_reaches(joints):
    chain = arm("puma560")
    short = pk.Chain.from_space(chain.screws[:joints], chain.home)
    q, T = targets(short, 9, 20)
    for method in ("auto", "search"):
        result = ik_all(short, T, method=method)
        for k in range(len(q)):
            assert apart(q[k : k + 1], result.solutions[k]).min(initial=np.inf) <= 1e-5
            assert max(errors(short, result.solutions[k], T[k])) <= TOL
    far = T[0].copy()
    far[2, 3] += 0.1
    assert ik_all(short, far).counts == 0 or joints > 3


@pytest.mark.parametrize("shape", [(), (0,), (1,), (3, 1, 2)], ids=str)
def test_batches_of_any_shape(shape):
    chain = arm("ur5")
    T = chain.fk(chain.random(10, shape))
    result = ik_all(chain, T)
    for array in (
        result.counts,
        result.anywhere,
        result.continuum,
        result.p_missing,
        result.position_error,
    ):
        assert array.shape == shape
    if shape:
        assert (
            len(result.solutions)
            == len(result.explanation)
            == len(result.n_revolutions)
            == int(np.prod(shape))
        )
    for index in np.ndindex(*shape):
        assert max(errors(chain, result.of(*index), T[index])) <= TOL
        assert len(result.of(*index)) == result.counts[index]


def test_nan_in_one_target_is_that_targets_own_affair():
    chain = arm("ur5")
    _, T = targets(chain, 11, 3)
    T[1, 0, 3] = np.nan
    result = ik_all(chain, T, limits=False)
    assert result.counts[1] == 0
    assert not result.complete[1]
    assert "bad target" in result.explanation[1]
    assert result.counts[0] > 0 < result.counts[2]


def test_a_search_repeats_and_another_seed_finds_the_same():
    chain = arm("jaco")
    _, T = targets(chain, 12, 20)
    first, again, other = (
        ik_all(chain, T, seed=seed, limits=False, min_hits=40) for seed in (0, 0, 5)
    )
    for a, b, c in zip(first.solutions, again.solutions, other.solutions, strict=True):
        assert np.array_equal(a, b)
        assert same_sets(a, c, 1e-5)


def test_the_words_of_a_search_say_how_sure_it_is():
    chain = arm("ur5")
    _, T = targets(chain, 13, 1)
    result = ik_all(chain, T[0], method="search", limits=False)
    assert 0 < result.p_missing < 2e-3
    assert "each found 1" in result.explanation
    assert f"is missing with a chance of {result.p_missing:.1g}" in result.explanation
    assert ik_all(chain, T[0], method="search", limits=False, min_hits=60).p_missing < 1e-6


def test_a_compiled_arm_serves():
    chain = arm("ur5")
    _, T = targets(chain, 14, 2)
    for a, b in zip(ik_all(chain, T).solutions, ik_all(chain.compile(), T).solutions, strict=True):
        assert np.array_equal(a, b)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        pytest.param("jaco", r"has no closed form \(no three neighbouring axes", id="jaco"),
    ],
)
def test_a_closed_form_that_does_not_exist_is_refused(name, message):
    with pytest.raises(InputError, match=message):
        ik_all(arm(name), np.eye(4), method="closed")


def test_a_redundant_arm_is_refused_and_told_what_to_use():
    chain = pk.load("panda").chain(tip="panda_hand")
    with pytest.raises(InputError, match=r"got 7 .*infinitely many solutions; ik finds one"):
        ik_all(chain, np.eye(4))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        pytest.param(
            {"method": "eaik"},
            r"method: expected 'auto', 'closed', 'elimination' or 'search', got 'eaik'",
            id="method",
        ),
        pytest.param({"limits": 1}, r"limits: expected True or False, got 1", id="limits"),
        pytest.param(
            {"all_revolutions": None},
            r"all_revolutions: expected True or False",
            id="all_revolutions",
        ),
        pytest.param(
            {"min_hits": 0}, r"min_hits: expected a whole number from 1 on, got 0", id="min_hits"
        ),
        pytest.param({"seed": -1}, r"seed: expected a whole number from 0 on", id="seed"),
        pytest.param({"restarts": 1.5}, r"restarts: expected a whole number", id="restarts"),
    ],
)
def test_options_that_are_none_are_refused(options, message):
    with pytest.raises(InputError, match=message):
        ik_all(arm("ur5"), np.eye(4), **options)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"limits": 1}, "limits: expected True or False, got 1"),
        ({"all_revolutions": 0}, "all_revolutions: expected True or False, got 0"),
        ({"min_hits": 14.0}, "min_hits: expected a whole number"),
        ({"restarts": 2000.0}, "restarts: expected a whole number"),
        ({"iterations": 200.0}, "iterations: expected a whole number"),
        ({"seed": False}, "seed: expected a whole number"),
        ({"parallel": 0}, "parallel: expected True or False, got 0"),
    ],
    ids=str,
)
def test_a_setting_that_is_none_is_told_after_its_equal_was_accepted(options, message):
    chain = arm("ur5")
    T = chain.fk([0.4, -1.2, 1.5, -0.3, 0.8, 0.0])
    assert len(ik_all(chain, T).solutions) == 8
    with pytest.raises(InputError, match=message):
        ik_all(chain, T, **options)


def test_more_places_than_anybody_reads_are_refused():
    chain = arm("ur5")
    wide = pk.Chain.from_space(
        chain.screws, chain.home, limits=np.tile([-9 * np.pi, 9 * np.pi], (6, 1))
    )
    _, T = targets(wide, 16, 1)
    assert ik_all(wide, T[0]).n_revolutions.min() == 9**6
    places = ik_all(wide, T[0]).n_revolutions.sum()
    said = f"all_revolutions: {places} places for one target, more than 4096; `n_revolutions` of the result tells"
    with pytest.raises(InputError, match=f"^{said}$"):
        ik_all(wide, T[0], all_revolutions=True)


@pytest.mark.parametrize(
    ("bound", "places"),
    [
        pytest.param(90.0, None, id="counted"),
        pytest.param(9000.0, 2**63 - 1, id="2865 turns of six joints"),
        pytest.param(1e300, 2**63 - 1, id="any turns"),
    ],
)
def test_wide_limits_have_many_places_and_never_less_than_none(bound, places):
    chain = arm("ur5")
    wide = pk.Chain.from_space(chain.screws, chain.home, limits=np.tile([-bound, bound], (6, 1)))
    q, T = targets(wide, 16, 1)
    result = ik_all(wide, T[0])
    assert apart(q, result.solutions).min() <= 1e-5
    for k, numbers in enumerate(result.n_revolutions):
        each = [len(np.arange(np.ceil((-bound - x) / (2 * np.pi)), np.floor((bound - x) / (2 * np.pi)) + 1))
                for x in result.solutions[k]] if places is None else []  # fmt: skip
        assert numbers == (places or np.prod(each))


def test_as_many_places_are_listed_as_are_said_to_be_the_most(monkeypatch):
    chain = arm("ur5")
    wide = pk.Chain.from_space(
        chain.screws, chain.home, limits=np.tile([-2 * np.pi, 2 * np.pi], (6, 1))
    )
    _, T = targets(wide, 16, 1)
    most = int(ik_all(wide, T[0]).n_revolutions.sum())
    monkeypatch.setattr(places_module, "MOST", most)
    assert ik_all(wide, T[0], all_revolutions=True).counts == most
    monkeypatch.setattr(places_module, "MOST", most - 1)
    with pytest.raises(
        InputError, match=rf"all_revolutions: {most} places for one target, more than {most - 1}"
    ):
        ik_all(wide, T[0], all_revolutions=True)


@pytest.mark.parametrize("joint", [0, 5])
@pytest.mark.parametrize("turns", [1e8, 1e12])
def test_a_solution_so_many_turns_away_that_its_pose_is_lost_is_not_listed(joint, turns):
    # the last joint turns the tool about its own origin, the first one moves it, too
    chain = arm("ur5")
    limits = np.tile([-np.pi, np.pi], (6, 1))
    limits[joint] += 2 * np.pi * turns
    far = pk.Chain.from_space(chain.screws, chain.home, limits=limits)
    T = chain.fk([0.1, -1.0, 1.2, 0.4, 0.9, -0.3])
    result = ik_all(far, T)
    assert result.anywhere == 8
    assert max(errors(far, result.solutions, T)) <= TOL


def test_a_place_that_is_lost_by_so_many_turns_alone_is_not_listed_either():
    # two parallel axes that turn against each other: only the position shows it
    axes = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0.0, 0.5)]
    bounds = 2 * np.pi * 1e8 + np.array([[-np.pi, np.pi]])
    chain = pk.Chain.from_space(
        axes,
        pk.se3.exp([0, 0, 0, 0.7, 0, 0]),
        coupling=[[1.0], [-1.0]],
        q_names=["a"],
        limits=bounds,
    )
    T = chain.fk([0.3])
    result = ik_all(chain, T)
    assert result.anywhere == 1
    assert max(errors(chain, result.solutions, T)) <= TOL


def test_what_is_no_arm_and_what_is_no_pose_is_refused():
    with pytest.raises(InputError, match=r"chain: expected a Chain, as .* makes it, got 'ur5'"):
        ik_all("ur5", np.eye(4))  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"the chain has none"):
        ik_all(pk.Chain.from_space(np.empty((0, 6)), np.eye(4)), np.eye(4))
    with pytest.raises(PoseError, match=r"T\[1\] is no pose"):
        ik_all(arm("ur5"), [np.eye(4), 2 * np.eye(4)])


def test_a_target_is_named_from_the_end_too():
    chain = arm("ur5")
    found = ik_all(chain, targets(chain, 3, 4)[1].reshape(2, 2, 4, 4))
    np.testing.assert_array_equal(found.of(-1, 0), found.of(1, 0))
    with pytest.raises(IndexError, match="out of bounds"):
        found.of(0, 2)


def test_the_errors_are_the_largest_of_the_listed_solutions_in_place_and_in_direction(monkeypatch):
    chain = arm("ur5")
    _, T = targets(chain, 15, 3)
    T[1] = np.nan
    right = module.pose_errors

    def known(chain, task, q, wanted):
        assert right(chain, task, q, wanted).max() < 1e-10
        return np.arange(1.0, len(q) + 1)[:, None] * [1e-13, -2e-13] + [0, 1e-11]

    monkeypatch.setattr(module, "pose_errors", known)
    found = ik_all(chain, T, method="search", limits=False)
    first, _, last = (len(some) for some in found.solutions)
    np.testing.assert_allclose(
        found.position_error, [first * 1e-13, np.nan, (first + last) * 1e-13]
    )
    np.testing.assert_allclose(
        found.rotation_error, [1e-11 - 2e-13, np.nan, 1e-11 - 2e-13 * (first + 1)]
    )
    np.testing.assert_array_equal(found.counts, [first, 0, last])
    np.testing.assert_array_equal(found.anywhere, [first, 0, last])
    assert np.isnan(found.p_missing[1])
    assert found.explanation[1] == "0 solutions: bad target, it is not made of finite numbers"
