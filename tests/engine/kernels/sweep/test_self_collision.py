"""Spheres of pairs of links, uncompiled, against distances in NumPy."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.engine.kernels.sweep.self_collision import collides, touches

LANES = 4


def distances(centres, radii, lane):
    """Distance of each sphere's surface from each other's."""
    p = centres[:, lane].reshape(-1, 3)
    return np.linalg.norm(p[:, None] - p, axis=2) - np.add.outer(radii, radii)


def test_spheres_touch_where_their_centres_are_no_farther_apart_than_both_radii():
    rng = np.random.default_rng(0)
    centres = rng.uniform(-1, 1, (21, LANES))
    radii = rng.uniform(0.1, 0.8, 7)
    for lane in range(LANES):
        gaps = distances(centres, radii, lane)
        assert np.abs(gaps[np.triu_indices(7, 1)]).min() > 1e-9
        found = [[touches(radii, centres, i, j, lane) for j in range(7)] for i in range(7)]
        np.testing.assert_array_equal(found, gaps <= 0)
    apart = np.zeros((6, LANES))
    apart[3:, 2] = 2, -3, 6  # 7 apart
    for radius, answer in ((3.0, True), (2.9999, False)):
        assert touches(np.array([4.0, radius]), apart, 0, 1, 2) == answer


@pytest.mark.parametrize("size", [0.12, 0.2, 0.4])
def test_links_collide_where_any_spheres_of_a_pair_do_and_touch_the_other_s_hull(size):
    # hulls 0, 3 and 5 stand before the spheres of three links; of four pairs one comes twice
    links = [(0, 1, 3), (3, 4, 5), (5, 6, 9)]
    pairs = [(0, 1), (1, 2), (2, 0), (0, 1)]
    numbers = np.array([number for pair in pairs for k in pair for number in links[k]])
    outcomes = set()
    rng = np.random.default_rng(0)
    for _ in range(200):
        centres = rng.uniform(-1, 1, (27, LANES))
        radii = size * rng.uniform(0.5, 2, 9)
        radii[[0, 3, 5]] *= 4
        for lane in range(LANES):
            is_near = distances(centres, radii, lane) <= 0
            expected = any(
                is_near[a, b] and is_near[i, b] and is_near[i, j]
                for (a, begin, end), (b, first, last) in ((links[m], links[n]) for m, n in pairs)
                for i in range(begin, end)
                for j in range(first, last)
            )
            assert collides(numbers, radii, centres, lane) == expected
            outcomes.add(expected)
    assert outcomes == {True, False}
    assert not collides(numbers[:0], radii, centres, 0)


def test_of_each_pair_alone_all_of_its_spheres_are_looked_at():
    radii = np.full(9, 0.1)
    radii[[0, 3, 5]] = 100.0
    far = np.arange(27.0).reshape(9, 3) * 5
    links = [(0, 1, 3), (3, 4, 5), (5, 6, 9)]
    for m, n in ((0, 1), (1, 2), (2, 0)):
        numbers = np.array([*links[m], *links[n]])
        for i in range(*links[m][1:]):
            for j in range(*links[n][1:]):
                centres = far.copy()
                centres[i] = centres[j] + [0, 0.15, 0]
                assert collides(numbers, radii, np.repeat(centres.reshape(-1, 1), LANES, 1), 3)
        assert not collides(numbers, radii, np.repeat(far.reshape(-1, 1), LANES, 1), 3)
