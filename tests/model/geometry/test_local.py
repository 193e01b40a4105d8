"""The local form: link frames on the joints' axes, the nearest ones turned least, and the numbers
of the kernels.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from poekin.engine.kernels import chain_kernels
from poekin.groups import se3, so3
from poekin.model import screw
from poekin.model.chain import Chain
from poekin.model.geometry.local import kernel_table, turned_least
from poekin.testing.strategies import chain_strategies

Z = np.array([0.0, 0.0, 1.0])
DOWN = np.diag([1.0, -1.0, -1.0])


def smallest(a, b):
    """The smallest rotation from a unit vector to another one less than a right angle away."""
    axis = np.cross(a, b)
    sine = np.linalg.norm(axis)
    return so3.exp(axis / sine * np.arctan2(sine, a @ b)) if sine else np.eye(3)


DIRECTIONS = [[0, 0, 1], [0, 0, -1], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0.6, 0, 0.8], [0, 0.6, -0.8], [1, 2, 2],
              [2, -1, -2], [-1, 2, -2], [1e-9, 0, -1], [3, 4, 1e-9], [3, 4, -1e-9]]  # fmt: skip


@pytest.mark.parametrize("way", DIRECTIONS, ids=str)
def test_a_direction_is_turned_to_least_or_from_below_where_it_points_down(way):
    z = np.array(way) / np.linalg.norm(way)
    expected = smallest(Z, z) if z[2] >= 0 else smallest(-Z, z) @ DOWN
    found = np.reshape(turned_least(*map(float, way)), (3, 3))  # of any length
    np.testing.assert_allclose(found, expected, rtol=0, atol=4e-16)


@given(chain_strategies.chains(min_joints=1, max_joints=5))
def test_link_frames_stand_on_their_axes_nearest_to_the_frame_before(chain):
    T = np.eye(4)
    for i, (S, M) in enumerate(zip(chain.screws, chain.local.frames, strict=False)):
        before, T = T[:3, 3], T @ M
        z, p = T[:3, 2], T[:3, 3]
        size = 1e-14 * (chain.reach + np.linalg.norm(S[3:]))
        np.testing.assert_allclose(
            z, S[:3] if chain.local.rotates[i] else S[3:], rtol=0, atol=1e-14
        )
        assert abs((p - before) @ z) <= size
        if chain.local.rotates[i]:
            assert np.abs(np.cross(p, z) + chain.pitches[i] * z - S[3:]).max() <= size
        else:
            assert np.abs(p - before).max() <= size
    np.testing.assert_allclose(
        T @ chain.local.frames[-1], chain.home, rtol=0, atol=1e-14 * chain.reach
    )


@pytest.mark.parametrize("turned", [[-1, -1, 1, 1], [1, -1, -1, 1], [-1, 1, -1, 1]], ids=str)
def test_no_zero_of_the_local_form_has_a_sign(turned):
    screws = [
        screw.prismatic(-Z),
        screw.revolute([0, -1, 0], [0, 0, 1]),
        screw.revolute(-Z, [0, 1, 0]),
    ]
    for part in Chain.from_space(screws, np.diag(turned)).local:
        assert not np.signbit(part[part == 0]).any()


def test_joints_turn_and_slide_by_their_kind():
    rows = [
        screw.revolute(Z, [1, 0, 0]),
        screw.prismatic([0, 1, 0]),
        screw.helical([1, 0, 0], [0, 0, 2], -0.3),
    ]
    chain = Chain.from_space(rows, se3.exp([0, 0, 0, 1, 2, 3]))
    assert chain.local.rotates.tolist() == [1, 0, 1]
    assert chain.local.slides.tolist() == [0, 1, -0.3]
    assert not any(part.flags.writeable for part in chain.local)


@pytest.mark.parametrize(
    "C, c", [(None, 0.0), (None, 0.5), ([[1.0], [2.0]], 0.0), ([[1.0], [2.0]], 0.5)]
)
def test_the_table_of_the_kernels_has_a_row_a_link_and_columns_for_what_is_needed(C, c):
    chain = Chain.from_space(
        [screw.revolute(Z, [1, 0, 0]), screw.helical([1, 0, 0], [0, 0, 2], -0.3)],
        np.diag([-1, -1, 1, 1]),
    )
    coupling, offset = None if C is None else np.array(C), np.array([0.0, c])
    table = kernel_table(chain.local, coupling, offset)
    np.testing.assert_array_equal(table[:, :9].reshape(3, 3, 3), chain.local.frames[:, :3, :3])
    np.testing.assert_array_equal(table[:, 9:12], chain.local.frames[:, :3, 3])
    np.testing.assert_array_equal(table[:, chain_kernels.ROTATES], [1, 1, 0])
    np.testing.assert_array_equal(table[:, chain_kernels.SLIDES], [0, -0.3, 0])
    if coupling is None and not c:
        assert table.shape == (3, chain_kernels.OFFSET)
        return
    used = np.eye(2) if coupling is None else coupling
    assert table.shape == (3, chain_kernels.COUPLING + used.shape[1])
    np.testing.assert_array_equal(table[:, chain_kernels.OFFSET], [0, c, 0])
    np.testing.assert_array_equal(
        table[:, chain_kernels.COUPLING :], np.concatenate([used, np.zeros_like(used[:1])])
    )
