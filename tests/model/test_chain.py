"""Chain: what it accepts, keeps and refuses. The laws of its kinematics stand in
test_chain_laws.py.
"""

import copy
import pickle
import re
import threading

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, PoseError, ScrewError, ShapeError, UnknownName
from poekin.model.sampling import sampling_range
from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.oracles import exact
from poekin.testing.strategies import chain_strategies
from poekin.testing.strategies.group_strategies import poses
from tests.model.laws.chain_cases import chain_cases

RZ = pk.screw.revolute([0, 0, 1], [0, 0, 0])
RY = pk.screw.revolute([0, 1, 0], [0, 0, 0.5])
PX = pk.screw.prismatic([1, 0, 0])
HOME = pk.se3.exp([0.1, 0.2, 0.3, 1, 2, 3])


def arm(**options):
    return pk.Chain.from_space([RZ, RY, PX], HOME, joint_names=["pan", "lift", "slide"], **options)


def test_a_chain_is_compiled_for_one_thread_once_and_for_several_where_that_is_asked_for():
    chain = arm()
    assert chain.compile() is chain.compile(parallel=False)
    assert [chain.compile(parallel=parallel).parallel for parallel in (False, True)] == [
        False,
        True,
    ]
    for none in (0, 1, None):
        with pytest.raises(InputError, match="parallel: expected True or False, got"):
            chain.compile(parallel=none)  # pyright: ignore[reportArgumentType]


def rebased_off(chain, P):
    """How far the screws of a rebased chain are from Ad(P) A, of unit length, ÷ what `rebased`
    says.

    A row of [p] R is off by 2.9 u |p| in its product with ω, and a sum of six products by
    6 u (|p| + |v|) in m and three by 3 u in rad. Lengths that miss 1 by 4.5e-16, 4.1 u, stay as
    they are. All of one sign would be 13 u |p| in m; a million draws come to 7.4 u, in rad.
    """
    moved = exact.exactly(chain.screws) @ exact.adjoint(P).T
    unit = np.array([S / exact.norm(S[:3] if S[:3].any() else S[3:]) for S in moved])
    off = np.abs(chain.rebased(P).screws - exact.rounded(unit))
    return max(off[:, :3].max(), off[:, 3:].max() / (chain.reach + np.linalg.norm(P[:3, 3]))) / (
        10 * UNIT
    )


@given(chain_strategies.chains(min_joints=1, max_joints=4), poses(lengths=(1e-3, 1e6)))
def test_a_rebased_chain_is_as_exact_as_the_way_is_long(chain, P):
    assert rebased_off(chain, P) <= 1


def test_a_chain_that_comes_back_from_far_has_the_rounding_of_the_way():
    """Neither the reach of the one nor that of the other chain bounds it."""
    there = pk.se3.exp([0.1, 0.2, 0.3, 1e5, -2e5, 3e5])
    back = arm().rebased(there)
    P = pk.se3.inverse(there)
    assert back.rebased(P).reach < 10
    assert 1e-3 < rebased_off(back, P) <= 1


def rezeroed_off(chain, q0):
    """How far screws and home pose of a rezeroed chain are from their definition in 60 digits ÷
    what `rezeroed` says.

    A product of poses and of an adjoint with a screw is off by 10 u a joint; the exponential of A
    d, where it turns, by 4 u |d| more.
    """
    T, A, found = exact.exactly(np.eye(4)), [], chain.rezeroed(q0)
    shifts = chain.coupling @ q0
    for S, d in zip(chain.screws, shifts, strict=True):
        A.append(exact.adjoint(T) @ exact.exactly(S))
        T = T @ exact.exp(exact.exactly(S) * exact.exactly(d)[()])
    off = np.abs(found.screws - exact.rounded(np.array(A)))
    home = np.abs(found.home - exact.rounded(T @ exact.exactly(chain.home)))
    within = UNIT * (10 * (len(A) + 1) + 4 * np.abs(chain.local.rotates * shifts).sum())
    far = chain.reach + np.abs(chain.local.slides * shifts).sum()
    turned, moved = (
        max(off[:, :3].max(), home[:3, :3].max()),
        max(off[:, 3:].max(), home[:3, 3].max()),
    )
    return max(turned, moved / far) / within


FAR = st.floats(-1, 4).map(lambda power: 10.0**power)


@given(chain_cases(("q",), min_joints=1, max_joints=4), FAR)
@example((pk.Chain.from_space([PX, RY, RZ], HOME), np.array([1.0, 2.0, 3.0])), 1e4)
@example(
    (
        pk.Chain.from_space([pk.screw.helical([0, 0, 1], [1, 0, 0], 0.5), RY], HOME),
        np.array([1.0, -2.0]),
    ),
    1e3,
)
def test_a_rezeroed_chain_is_as_exact_as_the_way_is_long(case, times):
    chain, q = case
    assert rezeroed_off(chain, q * times) <= 1


def test_example_1_of_the_paper():
    L1, L2 = 0.7, 0.4
    M = np.eye(4)
    M[0, 3] = L1 + L2
    screws = [[0, 0, 1, 0, 0, 0], [0, -1, 0, 0, 0, 0], [0, -1, 0, 0, 0, -L1]]
    chain = pk.Chain.from_space(screws, M)
    np.testing.assert_array_equal(pk.screw.revolute([0, -1, 0], [L1, 0, 0]), screws[2])
    q1, q2, q3 = 0.3, -0.8, 1.1
    R = pk.so3.exp([0, 0, q1]) @ pk.so3.exp([0, -(q2 + q3), 0])
    reach, height = L1 * np.cos(q2) + L2 * np.cos(q2 + q3), L1 * np.sin(q2) + L2 * np.sin(q2 + q3)
    T = chain.fk([q1, q2, q3])
    np.testing.assert_allclose(T[:3, :3], R, rtol=0, atol=1e-15)
    np.testing.assert_allclose(
        T[:3, 3], [reach * np.cos(q1), reach * np.sin(q1), height], rtol=0, atol=1e-15
    )
    expected = np.zeros((6, 3))
    expected[2, 0] = 1
    # both elbow axes are (0, -1, 0) turned by q1; the third passes L1 out along the upper arm
    axis = np.array([np.sin(q1), -np.cos(q1), 0])
    elbow = L1 * np.array([np.cos(q2) * np.cos(q1), np.cos(q2) * np.sin(q1), np.sin(q2)])
    expected[:3, 1] = expected[:3, 2] = axis
    expected[3:, 2] = np.cross(elbow, axis)
    np.testing.assert_allclose(chain.jacobian([q1, q2, q3], "space"), expected, rtol=0, atol=1e-15)


def test_equal_chains_are_equal_and_hash_and_pickle_alike():
    options = {"limits": [[-1, 1], [-2, np.inf], [0, 0.5]], "velocity_limits": [1, np.inf, 0.1]}
    a = arm(**options)
    for b in (
        arm(**options),
        copy.deepcopy(a),
        pickle.loads(pickle.dumps(a)),
    ):
        assert a == b
        assert hash(a) == hash(b)
    coupled = pk.Chain.from_space(
        [RZ, RY, PX], HOME, coupling=[[1, 0], [-2, 0], [0, 1]], offset=[0, 0.1, 0]
    )
    assert pickle.loads(pickle.dumps(coupled)) == coupled
    assert coupled != a


@pytest.mark.parametrize(
    "change",
    [
        {"base": "b"},
        {"limits": [[-1, 1]] * 3},
        {"offset": [0, 0, 1e-9]},
        {"velocity_limits": [np.inf, np.inf, 2]},
    ],
)
def test_chains_that_differ_are_not_equal(change):
    assert arm() != arm(**change)
    assert arm() != 1


def test_minus_zero_makes_no_difference():
    a, b = (
        pk.Chain.from_space([[0, 0, 1, 0, 0, 0]], np.eye(4)),
        pk.Chain.from_space([[-0.0, -0.0, 1, -0.0, 0, 0]], np.eye(4)),
    )
    assert a == b
    assert hash(a) == hash(b)


def test_making_exact_twice_changes_nothing():
    rng = np.random.default_rng(0)
    for _ in range(300):
        w, p = rng.normal(size=(2, 3))
        S = pk.screw.revolute(w, p) * (1 + rng.uniform(-1e-9, 1e-9) * 0.9)
        M = pk.se3.exp(rng.normal(size=6))
        M[:3, :3] += rng.uniform(-1e-7, 1e-7, (3, 3))
        chain = pk.Chain.from_space([S], M)
        again = pk.Chain.from_space(chain.screws, chain.home)
        assert again == chain
        assert (
            np.abs(chain.home[:3, :3] @ chain.home[:3, :3].T - np.eye(3)).max() < 4e-15
        )  # what the nearest rotation rounds to


def test_nothing_of_a_chain_can_be_changed():
    a = arm()
    arrays = (a.screws, a.home, a.limits, a.coupling, a.offset, a.velocity_limits)
    for array in (*arrays, *a.space, a.local.frames):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    with pytest.raises(
        AttributeError,
        match=r"^a Chain is frozen: cannot set 'home'; rebased, retooled and rezeroed",
    ):
        a.home = np.eye(4)
    with pytest.raises(AttributeError, match=r"^a Chain is frozen: cannot delete 'home'$"):
        del a.home


def test_the_arrays_given_are_copied():
    screws, home = np.array([RZ]), np.eye(4)
    chain = pk.Chain.from_space(screws, home)
    screws[0, 0], home[0, 3] = 7, 7
    assert chain == pk.Chain.from_space([RZ], np.eye(4))


def test_the_repr_says_where_from_where_to_and_how_far():
    assert repr(arm()) == "<Chain 'base' -> 'tool': 2 revolute, 1 prismatic joints, reach 4.85 m>"
    assert (
        repr(pk.Chain.from_space([], np.eye(4), tip="\x1b[31m"))
        == r"<Chain 'base' -> '\x1b[31m': no joints, reach 1 m>"
    )
    coupled = pk.Chain.from_space([RZ, RY], HOME, coupling=[[1], [-1]])
    assert "2 revolute joints, 1 coordinate," in repr(coupled)


def test_a_chain_without_joints_is_legal():
    chain = pk.Chain.from_space([], HOME)
    assert chain.dof == 0
    for q in ([], np.empty(0), {}):
        np.testing.assert_array_equal(chain.fk(q), HOME)
        assert chain.jacobian(q, "body").shape == (6, 0)
        assert chain.fk_jacobian(q, "hybrid")[1].shape == (6, 0)
    assert chain.fk(np.empty((3, 0))).shape == (3, 4, 4)
    assert chain.joint_poses(np.empty((3, 0))).shape == (3, 0, 4, 4)
    np.testing.assert_array_equal(chain.velocity([], [], "space"), np.zeros(6))
    assert chain.random(0, 4).shape == (4, 0)
    assert chain.rebased(HOME).retooled(HOME).rezeroed([]).dof == 0


def test_a_dict_an_array_and_a_list_of_coordinates_mean_the_same():
    a = arm()
    T = a.fk(np.array([0.1, 0.2, 0.3]))
    np.testing.assert_array_equal(a.fk({"slide": 0.3, "pan": 0.1, "lift": 0.2}), T)
    np.testing.assert_array_equal(a.fk([0.1, 0.2, 0.3]), T)
    np.testing.assert_array_equal(a.fk({"slide": [0.3, 0.3], "pan": 0.1, "lift": 0.2}), [T, T])


@pytest.mark.parametrize(
    "q, error, message",
    [
        (
            [1, 2],
            ShapeError,
            r"q: expected 3 coordinates on the last axis \('pan', 'lift', 'slide'\), got shape \(2,\)",
        ),
        (np.zeros((3, 2)), ShapeError, r"got shape \(3, 2\)"),
        (1.0, ShapeError, r"got shape \(\)"),
        (
            {"pan": 1, "lfit": 2, "slide": 3},
            UnknownName,
            "no coordinate 'lfit'; did you mean 'lift'?",
        ),
        ({"pan": 1}, InputError, "no value for 'lift', 'slide'"),
        ({"pan": [1, 2], "lift": [1, 2, 3], "slide": 0}, ShapeError, "do not broadcast"),
        (["a", "b", "c"], InputError, "expected real numbers, got"),
        ([1j, 0, 0], InputError, "complex"),
        ([[1, 2, 3], [1, 2]], ShapeError, "rows of different lengths"),
        (None, InputError, "expected real numbers, got object"),
        (np.array([True, False, True]), InputError, "bool"),
    ],
)
def test_a_configuration_that_does_not_fit_is_refused(q, error, message):
    a = arm()
    for call in (
        a.fk,
        lambda q: a.jacobian(q, "body"),
        lambda q: a.fk_jacobian(q, "body"),
        a.joint_poses,
    ):
        with pytest.raises(error, match=message):
            call(q)


@pytest.mark.parametrize("frame", ["spaec", 3, -1, None, 1.5, True, ["body"], np.zeros(2)])
def test_a_frame_that_does_not_exist_is_refused(frame):
    a, q = arm(), np.zeros(3)
    for call in (a.jacobian, a.fk_jacobian, lambda q, f: a.velocity(q, q, f)):
        with pytest.raises(
            InputError,
            match="expected 'space', 'body', 'hybrid' or the index of a joint",
        ):
            call(q, frame)


@pytest.mark.parametrize(
    ("theirs", "own"),
    [("world", "space"), ("LOCAL", "body"), ("local_world_aligned", "hybrid"), ("spatial", None)],
)
def test_a_frame_as_pinocchio_calls_it_is_refused_with_its_name_here(theirs, own):
    with pytest.raises(InputError) as refused:
        arm().jacobian(np.zeros(3), theirs)
    hint = f" (Pinocchio's {theirs.upper()} is {own!r})" if own else ""
    assert str(refused.value).endswith(f"got {theirs!r}{hint}")


@pytest.mark.parametrize(
    "screw, message",
    [
        (
            [0, 0, 1.1, 0, 0, 0],
            r"screws\[1\] \(joint 'b'\): omega must have length 1 to 1e-09, got 1.1",
        ),
        ([0, 0, 0, 0, 0, 2], r"v, where omega = 0, must have length 1"),
        ([0, 0, 0, 0, 0, 0], "length 1"),
        ([0, 0, np.nan, 0, 0, 0], "finite"),
        ([0, 0, 1 + 2e-9, 0, 0, 0], "length 1"),
    ],
)
def test_six_numbers_that_are_no_screw_are_refused(screw, message):
    with pytest.raises(ScrewError, match=message):
        pk.Chain.from_space([RZ, screw], np.eye(4), joint_names=["a", "b"])


@pytest.mark.parametrize(
    "options, error, message",
    [
        (
            {"home": np.diag([2, 1, 1, 1])},
            PoseError,
            "home is no pose: its rotation misses orthonormality",
        ),
        ({"home": np.diag([-1, 1, 1, 1])}, PoseError, "reflection, det R = -1"),
        ({"home": np.eye(3)}, ShapeError, "expected shape"),
        ({"home": np.full((4, 4), np.nan)}, InputError, "finite"),
        ({"screws": np.zeros((2, 5))}, ShapeError, r"expected shape \(n, 6\)"),
        ({"limits": [[0, 1]]}, ShapeError, r"expected shape \(3, 2\)"),
        (
            {"limits": [[0, 1], [2, 1], [0, 1]]},
            InputError,
            "lower <= upper for 'lift', got 2.0 and 1.0",
        ),
        ({"limits": [[0, 1], [np.nan, 1], [0, 1]]}, InputError, "'lift'"),
        (
            {"velocity_limits": [1, 2]},
            ShapeError,
            r"^velocity_limits: expected shape \(3,\), one of each coordinate, got \(2,\)$",
        ),
        ({"velocity_limits": [1, 2, 3, 4]}, ShapeError, r"expected shape \(3,\).*got \(4,\)"),
        ({"velocity_limits": np.ones((3, 1))}, ShapeError, r"expected shape \(3,\).*got \(3, 1\)"),
        (
            {"velocity_limits": [1, 0, 2]},
            InputError,
            "velocity_limits: expected a positive number for 'lift', infinite where it is not known, "
            "got 0.0",
        ),
        ({"velocity_limits": [1, 2, np.nan]}, InputError, "'slide'.*got nan"),
        ({"joint_names": ["a", "b"]}, ShapeError, "expected 3 names"),
        ({"joint_names": ["a", "b", "a"]}, InputError, "'a' appears more than once"),
        ({"coupling": np.eye(2)}, ShapeError, r"expected shape \(3, m\)"),
        ({"coupling": np.full((3, 1), np.inf)}, InputError, "finite"),
        ({"offset": [1, 2]}, ShapeError, r"expected shape \(3,\)"),
        ({"coupling": np.ones((3, 2)), "q_names": ["a"]}, ShapeError, "expected 2 names"),
    ],
)
def test_data_that_make_no_chain_are_refused(options, error, message):
    data = {"screws": [RZ, RY, PX], "home": HOME, "joint_names": ["pan", "lift", "slide"]} | options
    with pytest.raises(error, match=message):
        pk.Chain(**data, frame="space")


def test_results_go_into_the_arrays_that_are_given():
    a, q = arm(), np.array([0.1, 0.2, 0.3])
    for batch in ((), (5,), (2, 3)):
        qs = np.broadcast_to(q, (*batch, 3))
        T, J = np.empty((*batch, 4, 4)), np.empty((*batch, 6, 3))
        assert a.fk(qs, out=T) is T
        assert a.jacobian(qs, "body", out=J) is J
        np.testing.assert_array_equal(T, a.fk(qs))
        np.testing.assert_array_equal(J, a.jacobian(qs, "body"))
        T[...], J[...] = 0, 0
        got = a.fk_jacobian(qs, "body", out=(T, J))
        assert got[0] is T
        assert got[1] is J
        np.testing.assert_array_equal(J, a.jacobian(qs, "body"))


@pytest.mark.parametrize(
    "T",
    [
        np.empty((4, 3)),
        np.empty((4, 4), np.float32),
        np.empty((4, 4)).T[::-1],
        [[0.0] * 4] * 4,
        np.empty((1, 4, 4)),
    ],
)
def test_an_output_array_that_does_not_fit_is_refused(T):
    a, q = arm(), np.zeros(3)
    for call in (
        lambda: a.fk(q, out=T),
        lambda: a.fk_jacobian(q, "body", out=(T, np.empty((6, 3)))),
        lambda: a.fk_jacobian(q, "body", out=(np.empty((4, 4)), T)),
        lambda: a.jacobian(q, "body", out=T),
    ):
        with pytest.raises(InputError, match="out"):
            call()
    read_only = np.empty((4, 4))
    read_only.flags.writeable = False
    with pytest.raises(InputError, match="writable"):
        a.fk(q, out=read_only)


@pytest.mark.parametrize("at", [np.zeros(2), np.zeros((2, 3)), "here"])
def test_a_point_of_the_tool_is_one_point_in_a_frame_where_it_matters(at):
    a, q = arm(), np.zeros(3)
    with pytest.raises(InputError):
        a.jacobian(q, "body", at=at)
    with pytest.raises(
        InputError, match="in the frames 'body' and 'hybrid' only, got frame 'space'"
    ):
        a.jacobian(q, "space", at=[0, 0, 1])


def test_another_point_of_the_tool_moves_with_it():
    a, q, p = arm(), np.array([0.1, 0.2, 0.3]), np.array([0.3, -0.2, 0.5])
    T, J = a.fk_jacobian(q, "hybrid", at=p)
    J0 = a.jacobian(q, "hybrid")
    np.testing.assert_allclose(T, a.fk(q), rtol=0, atol=1e-15)
    np.testing.assert_allclose(
        J[3:], J0[3:] + np.cross(J0[:3].T, T[:3, :3] @ p).T, rtol=0, atol=1e-14
    )


def test_random_stays_within_the_limits_and_in_one_turn_where_there_are_none():
    a = arm(limits=[[-np.inf, np.inf], [1, np.inf], [-np.inf, np.inf]])
    q = a.random(np.random.default_rng(0), (2000,))
    assert q.shape == (2000, 3)
    assert np.abs(q[:, 0]).max() <= np.pi < np.abs(q[:, 0]).max() * 1.01
    assert q[:, 1].min() >= 1
    assert q[:, 1].max() <= 1 + 2 * np.pi
    assert 0.99 < np.abs(q[:, 2]).max() <= 1
    np.testing.assert_array_equal(a.random(7), a.random(7))
    assert a.random(0, (2, 0, 3)).shape == (2, 0, 3, 3)
    fixed = arm(limits=[[0.5, 0.5]] * 3)
    np.testing.assert_array_equal(fixed.random(0), [0.5] * 3)


@pytest.mark.parametrize("limits, low, high", [
    ([-np.inf, np.inf], [-np.pi, -1], [np.pi, 1]),
    ([-0.5, np.inf], [-0.5, -0.5], [2 * np.pi - 0.5, 1.5]),
    ([-np.inf, 0.25], [0.25 - 2 * np.pi, -1.75], [0.25, 0.25]),
    ([-9.0, 8.0], [-9, -9], [8, 8]),
])  # fmt: skip
def test_a_coordinate_without_a_limit_is_drawn_within_one_turn_or_two_metres(limits, low, high):
    turn, slide = [0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0]
    chain = pk.Chain.from_space([turn, slide], np.eye(4), limits=[limits] * 2)
    # of two joints on one coordinate the first says what it is
    coupled = pk.Chain.from_space(
        [turn, slide, slide, turn], np.eye(4), limits=[limits] * 2, coupling=[[1, 0], [2, 0], [0, 1], [0, 2]],
        q_names=["a", "b"],
    )  # fmt: skip
    for each in (chain, coupled):
        q = each.random(1, 2000)
        np.testing.assert_allclose(q.min(axis=0), low, atol=0.02)
        np.testing.assert_allclose(q.max(axis=0), high, atol=0.02)
        assert (q >= low).all()
        assert (q <= high).all()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((-1,), "rng, as a seed: expected a whole number from 0 on, got -1"),
        (("a",), "rng, as a seed: expected a whole number from 0 on, got 'a'"),
        ((0, -1), "size: expected a whole number from 0 on, got -1"),
        ((0, (2, 1.5)), "size: expected a whole number from 0 on, got 1.5"),
    ],
)
def test_random_names_the_seed_or_size_that_cannot_be(arguments, said):
    with pytest.raises(InputError, match=re.escape(said)):
        pk.load("ur5e").chain().random(*arguments)


def test_random_of_a_geared_coordinate_without_limits_is_one_turn_of_the_fastest_joint():
    plain = arm(limits=[[-np.inf, np.inf], [1, np.inf], [-np.inf, np.inf]])
    units = np.array([100.0, 1e-3, 1e3])
    geared = pk.Chain.from_space(plain.screws, plain.home, coupling=np.diag(1 / units), q_names=["a", "b", "c"],
                      limits=plain.limits * units[:, None])  # fmt: skip
    # low + (high - low) r of numbers up to 8, each factor rounded once more: within 8 · 8 u
    np.testing.assert_allclose(
        geared.random(3, 50) / units, plain.random(3, 50), rtol=0, atol=64 * 2.0**-53
    )
    one = pk.Chain.from_space(
        plain.screws, plain.home, coupling=[[0.5], [-2.0], [30.0]], q_names=["a"]
    )  # the last slides
    q = one.random(3, 2000)
    assert 0.99 * np.pi / 2 < np.abs(q).max() <= np.pi / 2


def test_limits_move_with_the_zero():
    a = arm(limits=[[-1, 1], [-2, np.inf], [0, 0.5]]).rezeroed([0.5, 1, 0.25])
    np.testing.assert_array_equal(a.limits, [[-1.5, 0.5], [-3, np.inf], [-0.25, 0.25]])


def test_velocity_limits_are_infinite_unless_given_and_a_copy_of_what_is_given():
    assert arm().velocity_limits.tolist() == [np.inf] * 3
    given = np.array([1.0, np.inf, 0.5])
    a = arm(velocity_limits=given)
    given[:] = 9
    assert a.velocity_limits.tolist() == [1, np.inf, 0.5]


@pytest.mark.parametrize(
    "change",
    [
        lambda a: a.rezeroed([0.5, 1, 0.25]),
        lambda a: a.rebased(HOME),
        lambda a: a.retooled(HOME, tip="hand"),
        lambda a: a.idealised(1e-3).chain,
        lambda a: a.replace(screws=a.screws.copy()),
    ],
    ids=["rezeroed", "rebased", "retooled", "idealised", "replaced"],
)
def test_another_frame_or_zero_leaves_the_velocity_limits(change):
    assert change(arm(velocity_limits=[1, np.inf, 0.5])).velocity_limits.tolist() == [
        1,
        np.inf,
        0.5,
    ]


def test_threads_share_a_chain():
    a = arm()
    q = a.random(0, (200, 50))
    expected, got = a.jacobian(q, "hybrid"), [None] * 8

    def work(k):
        got[k] = np.array([[a.fk_jacobian(row, "hybrid")[1] for row in block] for block in q[:20]])

    threads = [threading.Thread(target=work, args=(k,)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for result in got:
        np.testing.assert_array_equal(result, expected[:20])


def test_one_call_and_a_batch_give_the_same_bits():
    a = arm()
    q = a.random(0, 50)
    T, J = a.fk_jacobian(q, "body")
    for k in range(50):
        one = a.fk_jacobian(q[k].copy(), "body")
        np.testing.assert_allclose(one[0], T[k], rtol=0, atol=4e-16)
        np.testing.assert_allclose(one[1], J[k], rtol=0, atol=1e-15)


def test_twenty_thousand_joints_make_a_chain():
    n = 20_000
    chain = pk.Chain.from_space(np.tile(PX, (n, 1)), np.eye(4))
    assert chain.dof == n
    assert chain.fk(np.full(n, 1e-3))[0, 3] == pytest.approx(20)


def test_coordinates_without_limits_are_drawn_from_a_turn_or_a_metre_of_their_fastest_joint():
    bolt, pitched = (
        pk.screw.helical([0, 0, 1], [0, 0, 0], 0.1),
        pk.screw.helical([0, 1, 0], [0, 0, 0], -0.2),
    )
    for rows, C, most in (
        ([bolt], [[1.0]], np.pi),
        ([RZ, PX], [[2.0], [5.0]], np.pi / 2),
        ([PX, RZ], [[2.0], [5.0]], 1 / 2),
        ([bolt, PX], [[-3.0], [5.0]], np.pi / 3),
        ([PX, bolt], [[4.0], [5.0]], 1 / 4),
        ([bolt, pitched, RZ], [[1.0], [-4.0], [2.0]], np.pi / 4),
        ([RZ], [[0.0]], np.pi),
        ([PX], [[0.0]], np.pi),
    ):
        chain = pk.Chain.from_space(rows, np.eye(4), coupling=C, q_names=["q"])
        low, high = sampling_range(chain)
        assert (low, high) == (pytest.approx([-most]), pytest.approx([most]))
    for limits, span in (
        ([1, np.inf], (1, 1 + 2 * np.pi)),
        ([-np.inf, 2], (2 - 2 * np.pi, 2)),
        ([3, 4], (3, 4)),
    ):
        low, high = sampling_range(pk.Chain.from_space([bolt], np.eye(4), limits=[limits]))
        assert (low[0], high[0]) == pytest.approx(span)


def test_the_reach_is_the_length_of_all_links_a_metre_for_each_slide_and_one_at_least():
    x = pk.se3.exp([0, 0, 0, 3, 0, 4])
    assert pk.Chain.from_space([], np.eye(4)).reach == 1
    assert pk.Chain.from_space([], x).reach == pytest.approx(5)
    assert pk.Chain.from_space([PX, PX], x).reach == pytest.approx(7)
    turn = pk.screw.revolute([0, 0, 1], [3, 0, 0])
    assert pk.Chain.from_space([turn, PX], x).reach == pytest.approx(3 + 4 + 1)
