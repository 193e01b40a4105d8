"""idealised: rounded geometry becomes the exact one, nothing else moves, and the pose stays within
the bound.
"""

from __future__ import annotations

import functools
import math
import pickle
import warnings

import numpy as np
import pytest
from hypothesis import example, given, settings, target
from hypothesis import strategies as st

import poekin as pk
from poekin.analysis.axes import axes
from poekin.analysis.validate import routes
from poekin.errors import InputError, PoekinWarning
from poekin.formats import catalogue, dh
from poekin.formats.dh import Row, Table, published_tables
from poekin.formats.erd import example_robots
from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.strategies import chain_strategies
from tests.model.laws.chain_bounds import budget

TOL = 1e-4
FEW = settings(max_examples=max(settings().max_examples // 2, 20))
MULTIPLES = st.integers(-11, 12).map(lambda k: k * math.pi / 12)
LENGTHS = st.one_of(st.just(0.0), st.floats(0.05, 1.0), st.floats(-1.0, -0.05))
ROWS = st.builds(
    Row,
    MULTIPLES,
    LENGTHS,
    LENGTHS,
    MULTIPLES,
    st.sampled_from(["revolute", "revolute", "prismatic"]),
)


def apart(a, b, q):
    """Distances [m] and angles [rad] between two chains' tips at configurations (rows, m)."""
    ours, theirs = a.fk(q), b.fk(q)
    turn = pk.so3.log(np.swapaxes(ours[:, :3, :3], 1, 2) @ theirs[:, :3, :3])
    return np.linalg.norm((ours - theirs)[:, :3, 3], axis=1), np.linalg.norm(turn, axis=1)


def pose_errors(a, b, q):
    """Largest distance [m] and angle [rad] between two chains' tips."""
    far, turned = apart(a, b, q)
    return far.max(), turned.max()


def shares(chain, result, q):
    """Error ÷ what is allowed at configurations (rows, m): the bound, and the rounding of both
    chains' `fk`.

    The product of two rotations, and its logarithm, are off by 8 u more.
    """
    far, turned = apart(chain, result.chain, q)
    angular, linear = np.add(budget(chain, q), budget(result.chain, q))
    return np.maximum(
        far / (result.position_bound + linear),
        turned / (result.rotation_bound + angular + 8 * UNIT),
    )


def excess(chain, result, samples=200):
    """The worst of the shares at random configurations."""
    return shares(chain, result, chain.random(1, samples)).max()


def ways(chain):
    return np.where(chain.screws[:, :3].any(1)[:, None], chain.screws[:, :3], chain.screws[:, 3:])


@functools.cache
def arms():
    """The arms that come with the package: as URDF, and as published tables with all their digits
    rounded to six.
    """
    found = {
        name: pk.load(name).chain(tip={"panda": "panda_hand"}.get(name)) for name in catalogue.NAMES
    }
    for name in published_tables.NAMES:
        table = dh.published(name)
        rows = [
            Row(round(r.theta, 6), round(r.d, 6), round(r.a, 6), round(r.alpha, 6), r.kind, r.flip)
            for r in table.rows
        ]
        found[f"{name}, six digits"] = dh.to_chain(
            Table(table.convention, rows, base=table.base, tool=table.tool)
        )
    return found


@st.composite
def exact_and_noisy(draw):
    """A table of exact angles and zeros, and the same off by so little that no sum of it reaches
    the tolerance.
    """
    rows = draw(st.lists(ROWS, min_size=1, max_size=6))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))

    def off():
        # Where axes are parallel the turns and lengths of two rows add up, and over 1 m angles move
        # lengths.
        return rng.uniform(-1, 1) * TOL / 50

    noisy = [
        Row(
            r.theta + off(),
            r.d + off() * (r.d == 0),
            r.a + off() * (r.a == 0),
            r.alpha + off(),
            r.kind,
        )
        for r in rows
    ]
    return [dh.to_chain(Table("modified", some)) for some in (rows, noisy)]


def two_joints(screws, home):
    """A chain of numbers that a failure was printed with."""
    return pk.Chain.from_space(screws, [*home, [0, 0, 0, 1]])


# A place of 1 m, missed by its last digit, was made exact once more.
EXACT = two_joints(
    [[0.0, 0.0, 1.0, 0.0, -1.0, 0.0],
     [-0.4829629131445341, -0.12940952255126034, 0.8660254037844387,
      -0.39341316728486964, -1.4890782344552311, -0.4419095225512603]],
    [[0.25881904510252074, 0.8365163037378079, -0.4829629131445341, 1.1617619031890754],
     [-0.9659258262890683, 0.2241438680420134, -0.12940952255126034, -0.6037036414306677],
     [0.0, 0.49999999999999994, 0.8660254037844387, 1.0]],
)  # fmt: skip
NOISY = two_joints(
    [[0.0, -1.794597788548012e-06, 0.9999999999983897, 0.0, -0.9999999999983897, -1.794597788548012e-06],
     [-0.482962603199571, -0.12941101814642728, 0.8660253531467764,
      -0.39341332886632063, -1.4890773671588375, -0.44191193968503983]],
    [[0.2588184611533405, 0.8365166633587824, -0.482962603199571, 1.161762079857938],
     [-0.9659259827552863, 0.22414233027373362, -0.12941101814642728, -0.6037053886887201],
     [-2.109785491787355e-06, 0.5000000877025423, 0.8660253531467764, 0.9999986509882272]],
)  # fmt: skip


@FEW
@given(exact_and_noisy())
@example([EXACT, NOISY])
def test_exact_geometry_comes_back_from_a_rounded_one(pair):
    exact, noisy = pair
    result = noisy.idealised(TOL)
    # The exact table's own screws carry the rounding of their sines.
    np.testing.assert_allclose(ways(result.chain), ways(exact), rtol=0, atol=2e-15)
    np.testing.assert_allclose(result.chain.home[:3, :3], exact.home[:3, :3], rtol=0, atol=2e-15)
    before, after = axes(exact, tol_position=1e-12), axes(result.chain, tol_position=1e-12)
    for old, new in zip(before.pairs, after.pairs, strict=True):
        # Axes with one between them may also meet by chance, by lengths that are not 0 and stay as
        # they are.
        assert not (old.intersecting and old.fixed) or new.intersecting, old.relation
        apart = [pair.distance or 0.0 for pair in (old, new)]
        assert not old.fixed or abs(apart[0] - apart[1]) < TOL
    assert {(s.kind, s.joints) for s in before.shapes} <= {(s.kind, s.joints) for s in after.shapes}
    assert excess(noisy, result) <= 1
    again = result.chain.idealised(TOL)
    assert (again.chain, again.position_bound, again.rotation_bound, again.changes) == (
        result.chain,
        0.0,
        0.0,
        (),
    )


@FEW
@given(chain_strategies.chains(), st.sampled_from([1e-9, 1e-5, 1e-3, 0.05]))
def test_the_pose_of_any_chain_stays_within_the_bound_and_a_second_time_changes_nothing(chain, tol):
    result = chain.idealised(tol)
    share = excess(chain, result)
    target(share)
    assert share <= 1
    assert result.chain.kinds == chain.kinds
    assert result.chain.idealised(tol).chain == result.chain
    for ours, theirs in (
        (result.chain.limits, chain.limits),
        (result.chain.coupling, chain.coupling),
    ):
        np.testing.assert_array_equal(ours, theirs)


def test_the_bound_is_at_most_20_times_the_worst_error_of_the_package_s_arms_and_is_needed():
    shares = {}
    for name, chain in arms().items():
        result = chain.idealised(1e-5)
        shares[name] = excess(chain, result, 2000)
        far, turned = pose_errors(chain, result.chain, chain.random(0, 2000))
        if result.changes:
            assert result.position_bound <= 20 * far, name
            assert result.rotation_bound <= 20 * turned, name
    assert max(shares.values()) <= 1
    # A bound of half the size would not hold: so the comparison is able to fail.
    assert max(shares.values()) > 0.5


def test_chains_of_every_real_robot_are_as_exact_as_floats_can_say():
    count = 0
    for name in sorted(example_robots()[0]):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", PoekinWarning)
            robot = pk.load(f"erd:{name}")
        # Every third: the chains of a robot share most of their joints.
        for base, tip, _ in [*routes(robot)][::3]:
            chain, count = robot.chain(base=base, tip=tip), count + 1
            result = chain.idealised(TOL)
            assert excess(chain, result) <= 1, (name, tip)
            assert result.chain.idealised(TOL).chain == result.chain, (name, tip)
            before = axes(chain, tol_position=TOL, tol_rotation=TOL).pairs
            new = ways(result.chain)
            for pair, after in zip(before, axes(result.chain).pairs, strict=True):
                a, b = new[pair.first - 1], new[pair.second - 1]
                if not pair.fixed:
                    continue
                if pair.parallel:
                    assert (a == b).all() or (a == -b).all(), (name, tip, pair)
                if pair.perpendicular:
                    assert abs(a @ b) <= 4e-16, (
                        name,
                        tip,
                        pair,
                    )  # two ulp: rounding of six products' sum
                if (
                    pair.intersecting
                    and not pair.parallel
                    and pair.angle > math.radians(15)
                    and chain.reach < 3
                ):
                    assert after.distance is not None
                    assert after.distance <= 1e-14, (
                        name,
                        tip,
                        pair,
                    )  # mm; the screws' own digits over sin 15 degrees
    assert count > 240


@pytest.mark.parametrize("name", ["erd:panda", "panda"])
def test_the_panda_s_local_form_is_zeros_ones_and_half_right_angles_only(name):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        chain = pk.load(name).chain(tip="panda_hand")
    exact = {0.0, 1.0, math.sqrt(0.5)}
    assert set(np.abs(chain.local.frames[:, :3, :3]).ravel()) - exact
    assert set(np.abs(chain.idealised(1e-6).chain.local.frames[:, :3, :3]).ravel()) == exact


def test_pi_halves_of_five_digits_are_put_right_where_they_are_and_said_in_words():
    right, up = 1.5708, np.array([0.0, 0.0, 1.0])
    T = np.eye(4)
    screws = []
    for d in (0.3, 0.0, 0.4):
        T = T @ pk.se3.exp([0, 0, 0, 0, 0, d])
        screws.append(pk.screw.revolute(T[:3, :3] @ up, T[:3, 3]))
        T = T @ pk.se3.exp([right, 0, 0, 0, 0, 0])
    chain = pk.Chain.from_space(screws, T, joint_names=["a", "b{0}", "c"])
    result = chain.idealised(1e-5)
    np.testing.assert_array_equal(ways(result.chain), [[0, 0, 1], [0, -1, 0], [0, 0, -1]])
    np.testing.assert_array_equal(
        np.abs(result.chain.home[:3, :3]), [[1, 0, 0], [0, 0, 1], [0, 1, 0]]
    )
    assert (
        result.changes[0]
        == "axis of 'b{0}' turned by 3.67e-06 rad to be perpendicular to axis of 'a'"
    )
    assert len(result.changes) == 3
    assert result.rotation_bound == pytest.approx(3 * 3.673e-6, rel=1e-3)
    # what is left to put right is at most the rounding of the products above, which is another one
    # in every BLAS
    kept = chain.idealised(1e-6)
    assert kept.changes == ()
    assert kept.rotation_bound < 1e-14


def test_the_bound_of_one_wrong_turn_is_reached():
    tilted = pk.screw.revolute([0, math.sin(1e-6), math.cos(1e-6)], [0, 0, 0])
    chain = pk.Chain.from_space([tilted], pk.se3.exp([0, 0, 0, 2.0, 0, 0]))
    result = chain.idealised(1e-5)
    far, turned = pose_errors(chain, result.chain, np.linspace(0, 2 * np.pi, 100)[:, None])
    assert 0.5 * result.position_bound < far <= result.position_bound
    assert 0.5 * result.rotation_bound < turned <= result.rotation_bound


def test_a_tilt_beyond_the_tolerance_stays_and_nearly_parallel_axes_throw_nothing_far():
    lean = math.radians(0.5)
    screws = [
        pk.screw.revolute([0, 0, 1], [0, 0, 0]),
        pk.screw.revolute([math.sin(lean), 1e-5, math.cos(lean)], [0.4, 1e-5, 0]),
        pk.screw.revolute([math.sin(lean), 1e-5, math.cos(lean) + 1e-5], [0.8, 0, 0]),
    ]
    result = pk.Chain.from_space(screws, np.eye(4)).idealised(1e-3)
    one, two, three = ways(result.chain)
    np.testing.assert_array_equal(one, [0, 0, 1])
    np.testing.assert_allclose(
        two, [math.sin(lean), 0, math.cos(lean)], rtol=0, atol=2e-10
    )  # 1e-5 squared, what y had
    np.testing.assert_array_equal(two, three)
    assert result.position_bound < 1e-4
    alone = pk.Chain.from_space(screws[:2], np.eye(4))
    np.testing.assert_allclose(ways(alone.idealised(1e-6).chain), ways(alone), rtol=0, atol=2e-16)


def test_far_away_and_very_small_numbers_are_no_trouble():
    far = pk.Chain.from_space([pk.screw.revolute([0, 1e-6, 1], [1e99, 0, 0])], np.eye(4)).idealised(
        1e-5
    )
    np.testing.assert_array_equal(far.chain.screws, [[0, 0, 1, 0, -1e99, 0]])
    assert far.position_bound == pytest.approx(1e93, rel=1e-6)
    assert (
        far.changes[0] == "axis of 'joint1' turned by 1e-06 rad to be parallel to the base's z axis"
    )
    near = pk.Chain.from_space([pk.screw.revolute([0, 0, 1], [1e-200, 0, 0])], np.eye(4))
    assert near.idealised(1e-300).chain is near
    np.testing.assert_array_equal(near.idealised(1e-9).chain.screws, [[0, 0, 1, 0, 0, 0]])


def test_a_joint_that_slides_counts_as_far_as_it_can():
    tilted = pk.screw.prismatic([0, 1e-6, 1.0])
    bounds = {
        length: pk.Chain.from_space([tilted], np.eye(4), limits=[[-length, length]])
        .idealised(1e-5)
        .position_bound
        for length in (1.0, 10.0, np.inf)
    }
    assert bounds[1.0] == pytest.approx(1e-6, rel=1e-6)
    assert bounds[10.0] == pytest.approx(1e-5, rel=1e-6)
    assert bounds[np.inf] == bounds[1.0]


def test_nothing_changes_without_a_tolerance_or_without_a_need():
    chain = pk.load("ur5e").chain(tip="tool0")
    nothing = chain.idealised(0)
    assert nothing.chain is chain
    assert (nothing.position_bound, nothing.rotation_bound, nothing.changes) == (0.0, 0.0, ())
    none = pk.Chain.from_space([], pk.se3.exp([0, 0, 1e-6, 1, 0, 0]))
    np.testing.assert_array_equal(none.idealised(1e-5).chain.home[:3, :3], np.eye(3))
    result = none.idealised(1e-5)
    assert pickle.loads(pickle.dumps(result)) == result


@pytest.mark.parametrize("tol", [-1e-9, 0.06, math.nan, math.inf, "1e-5", None, True])
def test_a_tolerance_that_is_none_is_refused(tol):
    with pytest.raises(
        InputError, match=r"tol: a number from 0 to 0.05 expected \(rad and m\), got "
    ):
        pk.load("ur5e").chain(tip="tool0").idealised(tol)
