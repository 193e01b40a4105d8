"""The page's mathematics: the numbers of NumPy and of poekin, within bounds of their own rounding."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.analysis.dexterity.jacobian_part import ROWS, generic_rank
from poekin.formats import rpy
from poekin.formulas.lie import euler
from poekin.formulas.lie.quaternion import unit_quaternion
from poekin.groups import se3, so3
from poekin.model.sampling import sampling_range
from tests.formats.emitted import arm
from tests.view.web.page_scripts import run, sliders

U = 2.0**-53
ARMS = ("panda", "ur5e", "mixed", "one joint", "one slide")


def rotations() -> np.ndarray:
    """Turns of every size about every axis, among them none, half turns, and pitch ±90°."""
    rng = np.random.default_rng(1)
    axes = rng.normal(size=(400, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    sizes = np.concatenate([rng.uniform(0, np.pi, 200), 10.0 ** rng.uniform(-17, 0, 200)])
    near = np.pi - sizes[200:]
    exact = [np.eye(3), *(np.diag(d) for d in ([1, -1, -1], [-1, 1, -1], [-1, -1, 1]))]
    locks = [[0.3, s * np.pi / 2 + d, 1.1] for s in (-1, 1) for d in (0, 1e-15, 1e-12, 1e-9, 1e-6)]
    return np.concatenate(
        [
            so3.exp(axes * sizes[:, None]),
            so3.exp(axes[200:] * near[:, None]),
            exact,
            [rpy.pose((0, 0, 0), turns)[:3, :3] for turns in locks],
        ]
    )


def poses(count: int, seed: int, size: float = 1.0) -> np.ndarray:
    return se3.exp(size * np.random.default_rng(seed).normal(size=(count, 6)))


def pose(R: np.ndarray) -> np.ndarray:
    T = np.zeros((len(R), 4, 4))
    T[:, :3, :3] = R
    T[:, 3, 3] = 1
    return T


def flat(T: np.ndarray) -> np.ndarray:
    return T.reshape(len(T), 16)


def test_a_quaternion_is_the_rotation_and_back(tmp_path):
    R = rotations()
    script = "print(given.map(page.quaternionOf).map((q) => [q, page.poseOf(q)]));"
    found = run(tmp_path, script, flat(pose(R)))
    q = np.array([row[0] for row in found])
    # R misses a rotation by 4 u an entry; q is a sum of four entries over at least 1
    np.testing.assert_allclose(np.linalg.norm(q, axis=1), 1, rtol=0, atol=4 * U)
    assert (q[:, 3] >= 0).all()
    w, x, y, z = np.transpose([unit_quaternion(one.ravel().tolist()) for one in R])
    wanted = np.stack([x, y, z, w], axis=1)
    flipped = (w < 1e-15) & (np.sum(q * wanted, axis=1) < 0)  # half a turn: either sign is right
    wanted[flipped] *= -1
    assert np.abs(q - wanted).max() <= 16 * U
    back = np.array([row[1] for row in found]).reshape(-1, 4, 4)
    assert np.abs(back - pose(R)).max() <= 24 * U


def test_roll_pitch_yaw_are_those_that_poekin_prints(tmp_path):
    R = rotations()
    found = np.array(run(tmp_path, "print(given.map(page.rollPitchYaw));", flat(pose(R))))
    again = np.array([rpy.pose((0, 0, 0), turns)[:3, :3] for turns in found])
    # 8 u as poekin's own, and what R itself misses a rotation by
    assert np.abs(again - R).max() <= (8 + 4) * U
    wanted = np.array([rpy.angles(one) for one in R])
    off = np.abs(found - wanted)
    off = np.minimum(off, np.abs(off - 2 * np.pi))
    # two roundings of u apart, over the cosine of pitch by which the angles are read off
    cosine = np.hypot(R[:, 0, 0], R[:, 1, 0])
    assert (off <= (16 * U / np.maximum(cosine, 1e-15))[:, None]).all()
    locked = cosine < euler.LOCK
    assert locked.sum() >= 2
    assert (found[locked, 0] == 0).all()


def test_products_and_inverses_are_those_of_poses(tmp_path):
    A = poses(50, 2)
    B = poses(50, 3)
    script = "print(given.A.map((A, k) => [page.product(A, given.B[k]), page.inverse(A)]));"
    found = np.array(run(tmp_path, script, {"A": flat(A), "B": flat(B)})).reshape(50, 2, 4, 4)
    size = np.abs(A).max() * np.abs(B).max()
    assert np.abs(found[:, 0] - A @ B).max() <= 8 * U * size
    assert np.abs(found[:, 1] - se3.inverse(A)).max() <= 8 * U * np.abs(A).max()


def jacobians() -> list[np.ndarray]:
    """Regular ones, one that lost rank, nearly parallel rows, and sizes far apart."""
    rng = np.random.default_rng(4)
    found = [rng.normal(size=(6, m)) for m in (1, 2, 3, 6, 7, 50) for _ in range(5)]
    flat_one = rng.normal(size=(6, 2)) @ rng.normal(size=(2, 7))
    close = np.ones((6, 7)) + 1e-9 * rng.normal(size=(6, 7))
    apart = np.diag(10.0 ** np.arange(0, -18, -3)) @ rng.normal(size=(6, 7))
    return [*found, flat_one, close, apart, np.zeros((6, 4)), np.eye(6)]


def test_singular_values_and_ellipsoids_are_those_of_linear_algebra(tmp_path):
    J = jacobians()
    script = """
    const I = page.poseOf([0, 0, 0, 1], [1, 2, 3]);
    print(given.map((x) => Float64Array.from(x)).map((J) => ({
        ...page.singularValues(J, 0, 6),
        v: page.ellipsoid(I, J, "translation", 2), w: page.ellipsoid(I, J, "rotation"),
        thick: page.ellipsoid(I, J, "translation", 1, 0.5),
    })));"""
    found = run(tmp_path, script, [x.ravel() for x in J])
    for one, x in zip(found, J, strict=True):
        s = np.zeros(6)
        s[: min(x.shape)] = np.linalg.svd(x, compute_uv=False)
        # each of some ten sweeps turns every pair of rows once, by 4 u of the largest
        bound = 100 * U * s[0]
        assert np.abs(one["s"] - s).max() <= bound
        U_rows = np.array(one["U"])
        assert np.abs(U_rows @ U_rows.T - np.eye(6)).max() <= 100 * U
        assert np.abs(np.linalg.norm(U_rows @ x, axis=1) - s).max() <= bound
        for name, rows, factor in (("v", x[3:], 2.0), ("w", x[:3], 1.0)):
            M = np.reshape(one[name], (4, 4))
            A = factor * factor * rows @ rows.T
            assert np.abs(M[:3, :3] @ M[:3, :3].T - A).max() <= 200 * U * np.abs(A).max()
            # the eigenvalues of J J^T, as the squares of the half axes
            lengths = np.linalg.norm(M[:3, :3], axis=0)
            eigenvalues = np.linalg.eigvalsh(A)[::-1]
            assert np.abs(lengths**2 - eigenvalues).max() <= 200 * U * np.abs(A).max()
            assert np.linalg.det(M[:3, :3]) >= -200 * U * np.abs(A).max() ** 1.5
            assert M[:3, 3].tolist() == [1, 2, 3]
        thick = np.linalg.norm(np.reshape(one["thick"], (4, 4))[:3, :3], axis=0)
        halves = np.linalg.svd(x[3:])[1]
        wanted = np.maximum(np.pad(halves, (0, 3 - len(halves))), 0.5)
        np.testing.assert_allclose(thick, wanted, rtol=0, atol=max(bound, 4 * U))


def test_manipulability_is_that_of_poekin(tmp_path):
    given = []
    for name in ARMS:
        chain = arm(name)
        some = chain.jacobian(chain.random(8, 16), "hybrid").reshape(16, -1)
        J = chain.jacobian(chain.random(9, 20), "hybrid").reshape(20, -1)
        given.append({"some": some, "J": J})
    script = """
    const arrays = (rows) => rows.map((x) => Float64Array.from(x));
    print(given.map(({ some, J }) => ["pose", "translation", "rotation"].map((part) => {
        const rank = page.largestRank(arrays(some), part);
        return { rank, measures: arrays(J).map((x) => page.manipulability(x, part, rank, 0.7)) };
    })));"""
    for name, parts in zip(ARMS, run(tmp_path, script, given), strict=True):
        chain = arm(name)
        wanted = pk.manipulability(chain, chain.random(9, 20), length=0.7)
        for part, found in zip(ROWS, parts, strict=True):
            measures = getattr(wanted, part)
            assert found["rank"] == generic_rank(chain, part)
            for measure in ("yoshikawa", "smallest"):
                values = np.array([m[measure] for m in found["measures"]])
                np.testing.assert_allclose(
                    values, getattr(measures, measure), rtol=1e-12, atol=1e-14
                )
            inverse = [1 / (m["condition"] or np.inf) for m in found["measures"]]
            np.testing.assert_allclose(inverse, 1 / measures.condition, rtol=0, atol=1e-13)


@pytest.mark.parametrize("name", ["panda", "ur5e", "mixed"])
def test_the_worst_direction_is_that_of_poekin(name, tmp_path):
    chain = arm(name)
    q = chain.random(10, 20)
    J = chain.jacobian(q, "hybrid").reshape(20, -1)
    script = """
    const J = given.J.map((x) => Float64Array.from(x));
    const part = page.defaultPart(J);
    const rank = page.largestRank(J, part);
    print([part, ...J.map((x) => page.singularDirection(x, part, rank, given.length))]);"""
    part, *found = run(tmp_path, script, {"J": J, "length": chain.reach})
    for one, x in zip(found, q, strict=True):
        wanted = pk.singularity(chain, x)
        values = np.array(wanted.singular_values)
        last = wanted.generic_rank - 1
        others = np.delete(values, last)
        gap = np.abs(others - values[last]).min()
        assert part == wanted.part
        assert one["smallest"] == pytest.approx(wanted.smallest, abs=100 * U * values[0])
        assert one["ratio"] == pytest.approx(wanted.smallest / values[0], abs=200 * U)
        # a singular vector turns by the rounding of J over the gap to the next value
        atol = 1000 * U * values[0] / gap * max(1, chain.reach)
        np.testing.assert_allclose(one["twist"], wanted.singular_direction, rtol=0, atol=atol)


def test_an_arm_of_two_joints_in_a_plane_is_judged_by_its_translation(tmp_path):
    joints = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0.0, 0.5)]
    chain = pk.Chain.from_space(joints, se3.exp([0, 0, 0, 1, 0, 0]))
    J = chain.jacobian([[0.1, 1.2], [0.5, -0.7], [0, 0]], "hybrid").reshape(3, -1)
    script = """
    const J = given.map((x) => Float64Array.from(x));
    const part = page.defaultPart(J);
    print([part, page.singularDirection(J[2], part, page.largestRank(J, part), 1)]);"""
    part, stretched = run(tmp_path, script, J)
    assert part == pk.singularity(chain, [0.0, 0.0]).part == "translation"
    assert stretched["ratio"] <= 4 * U
    np.testing.assert_allclose(stretched["twist"], [0, 0, 0, 1, 0, 0], atol=4 * U)


def test_an_exaggerated_displacement_is_the_screw_gone_on(tmp_path):
    A = poses(40, 11)
    small = 10.0 ** np.random.default_rng(12).uniform(-12, 0, 40)
    log = small[:, None] * np.random.default_rng(13).normal(size=(40, 6))
    log[:3, :3] = 0  # no turn
    B = se3.exp(log) @ A
    k = [0, 1, 1.7, 20]
    C = poses(1, 14)[0]
    script = """
    print(given.A.map((A, n) => given.k.map((k) => [page.exaggerate(A, given.B[n], k),
        page.exaggerate(page.product(A, given.C), page.product(given.B[n], given.C), k)])));"""
    given = {"A": flat(A), "B": flat(B), "k": k, "C": C.ravel()}
    found = np.array(run(tmp_path, script, given)).reshape(40, 4, 2, 4, 4)
    for row, pose_a, xi in zip(found, A, log, strict=True):
        if np.linalg.norm(xi[:3]) > 3:
            continue  # beyond half a turn the short way is another
        for (one, moved), factor in zip(row, k, strict=True):
            wanted = se3.exp(factor * xi) @ pose_a
            # B A^-1 is wrong by some u of the size of A, and the factor enlarges that
            bound = 100 * U * (1 + factor) * (1 + np.abs(pose_a).max()) ** 2
            assert np.abs(one - wanted).max() <= bound
            assert np.abs(moved - wanted @ C).max() <= bound * (1 + np.abs(C).max())


def test_between_two_poses_the_origin_goes_straight_and_the_turn_is_even(tmp_path):
    A = poses(30, 15)
    B = poses(30, 16)
    shares = [0, 0.3, 1]
    script = "print(given.A.map((A, n) => given.k.map((k) => page.between(A, given.B[n], k))));"
    given = {"A": flat(A), "B": flat(B), "k": shares}
    found = np.array(run(tmp_path, script, given)).reshape(30, 3, 4, 4)
    turn = so3.log(B[:, :3, :3] @ np.swapaxes(A[:, :3, :3], 1, 2))
    for row, share in zip(np.swapaxes(found, 0, 1), shares, strict=True):
        R = so3.exp(share * turn) @ A[:, :3, :3]
        # near half a turn the axis is as exact as its sine
        assert np.abs(row[:, :3, :3] - R).max() <= 200 * U
        p = A[:, :3, 3] + share * (B[:, :3, 3] - A[:, :3, 3])
        assert np.abs(row[:, :3, 3] - p).max() <= 8 * U * np.abs(p).max()


def test_the_error_of_a_pose_is_the_logarithm_of_the_turn_and_the_way(tmp_path):
    A = poses(200, 17)
    B = poses(200, 18)
    R = rotations()[:600]
    near = np.concatenate([A, pose(R)])
    far = np.concatenate([B, np.broadcast_to(np.eye(4), (len(R), 4, 4))])
    script = "print(given.A.map((A, k) => page.poseError(A, given.B[k])));"
    found = np.array(run(tmp_path, script, {"A": flat(near), "B": flat(far)}))
    turns = far[:, :3, :3] @ np.swapaxes(near[:, :3, :3], 1, 2)
    wanted = so3.log(turns)
    flipped = np.linalg.norm(wanted, axis=1) > np.pi - 1e-9  # either sign is right there
    off = np.abs(found[:, :3] - wanted).max(axis=1)
    off[flipped] = np.minimum(off, np.abs(found[:, :3] + wanted).max(axis=1))[flipped]
    assert off.max() <= 40 * U * np.pi
    np.testing.assert_allclose(found[:, 3:], far[:, :3, 3] - near[:, :3, 3], rtol=0, atol=4 * U)


def test_a_damped_step_solves_its_equations_and_leaves_what_is_not_free(tmp_path):
    rng = np.random.default_rng(19)
    J = rng.normal(size=(20, 6, 7))
    e = rng.normal(size=(20, 6))
    free = rng.random((20, 7)) < 0.8
    script = """
    print(given.J.map((J, k) => [0, 3].map((first) =>
        page.dampedStep(Float64Array.from(J), given.e[k], 0.1, given.free[k], first))));"""
    given = {"J": J.reshape(20, -1), "e": e, "free": free}
    found = np.array(run(tmp_path, script, given))
    for k in range(20):
        for first, dq in zip((0, 3), found[k], strict=True):
            own = J[k][first:, free[k]]
            H = own.T @ own + 0.1 * np.eye(free[k].sum())
            wanted = np.zeros(7)
            wanted[free[k]] = np.linalg.solve(H, own.T @ e[k][first:])
            # normal equations: u times their condition
            bound = 100 * U * np.linalg.cond(H) * np.abs(wanted).max()
            assert np.abs(dq - wanted).max() <= bound
            assert (dq[~free[k]] == 0).all()


def test_a_step_of_more_joints_than_the_task_needs_goes_the_whole_way(tmp_path):
    J = np.random.default_rng(21).normal(size=(20, 6, 9))
    J[:, :, 8] = J[:, :, 7]
    script = """print(given.map((J) =>
        page.dampedStep(Float64Array.from(J), [1, 2, 3, 4, 5, 6], 1e-30, Array(9).fill(true))));"""
    dq = np.array(run(tmp_path, script, J.reshape(20, -1)))
    # the regularisation of 1e-14 shows as much as the squared condition, below 1e4 here
    np.testing.assert_allclose(np.einsum("kij,kj->ki", J, dq) - np.arange(1, 7), 0, atol=1e-8)


def test_ranges_and_distances_are_those_of_the_limits(tmp_path):
    chain = arm("mixed").replace(
        limits=[[-1, 2], [-np.inf, np.inf], [-np.inf, 1], [0.5, np.inf], [-0.1, 0.3]]
    )
    q = np.array([1.5, 7, -3, 0.4, 0.3])
    script = """
    print({ ranges: given.sliders.map(page.rangeOf), ...page.limitDistances(given.q, given.sliders),
        starts: [...Array(50).keys()].map((k) => page.spread(given.sliders, k)) });"""
    found = run(tmp_path, script, {"sliders": sliders(chain), "q": q})
    low, high = sampling_range(chain)
    np.testing.assert_allclose(found["ranges"], np.stack([low, high], 1), rtol=4 * U)
    np.testing.assert_allclose(
        np.array(found["distances"], float), [0.5, np.nan, 4, -0.1, 0], atol=4 * U
    )
    assert found["nearest"] == 3
    starts = (np.array(found["starts"]) - low) / (high - low)
    np.testing.assert_allclose(starts[0], 0.5)
    assert starts.min() >= 0
    assert starts.max() <= 1
    # even: each fifth of each range has its share
    shares = np.array([np.histogram(x, 5, (0, 1))[0] for x in starts.T])
    assert shares.min() >= 8


def test_a_path_is_linear_between_rows_of_unequal_times(tmp_path):
    rng = np.random.default_rng(20)
    times = np.array([0.5, 0.6, 2.0, 2.0, 5.0])
    rows = rng.normal(size=(5, 3))
    at = np.array([0, 0.5, 0.55, 0.6, 1.3, 1.99, 2.0, 3, 5, 9])
    script = "print(given.at.map((t) => page.alongPath(given.times, given.rows, t)));"
    found = run(tmp_path, script, {"times": times, "rows": rows, "at": at})
    wanted = np.stack([np.interp(at, times, x) for x in rows.T], axis=1)
    wanted[at == 2.0] = rows[3]
    np.testing.assert_allclose([one["q"] for one in found], wanted, atol=8 * U)
    assert [one["row"] for one in found] == [0, 0, 0, 1, 1, 1, 3, 3, 4, 4]
