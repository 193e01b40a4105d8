"""Relations of neighbouring axes, and arms of which a joint is locked."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.model.chain import Chain
from poekin.solve.ik_structure.neighbours import intersecting, locked, parallel
from poekin.testing import strategies


@given(data=st.data(), chain=strategies.chains(min_joints=2, max_joints=7, coupled=False))
def test_a_locked_joint_leaves_the_pose_of_the_others(data, chain):
    k = data.draw(st.integers(0, len(chain.kinds) - 1))
    q = data.draw(strategies.coordinates(chain))
    others = np.delete(q, k)
    fixed = locked(chain, k, float(q[k]))
    assert fixed.joint_names == tuple(np.delete(chain.joint_names, k))
    size = max(1.0, chain.reach, fixed.reach, float(np.abs(chain.fk(q)).max()))
    # products of a dozen motions, each within 1e-15 of its lengths, and |q| up to some turns
    np.testing.assert_allclose(
        fixed.fk(others), chain.fk(q), atol=1e-12 * size * (1 + abs(q).sum())
    )


@given(
    w=strategies.axes(),
    u=strategies.axes(),
    p=strategies.vectors(lengths=(1e-2, 1.0)),
    gap=st.floats(1e-6, 1.0),
)
def test_axes_through_a_point_intersect_and_moved_along_their_normal_do_not(w, u, p, gap):
    normal = np.cross(w, u)
    sine = np.linalg.norm(normal)
    if sine < 0.1:
        return
    through = [pk.screw.revolute(w, p), pk.screw.revolute(u, p)]
    assert intersecting(Chain.from_space(through, np.eye(4)), 0)
    apart = [through[0], pk.screw.revolute(u, p + gap * normal / sine)]
    assert not intersecting(Chain.from_space(apart, np.eye(4)), 0)


def test_parallel_axes_turn_and_do_not_intersect():
    z = pk.screw.revolute([0, 0, 1], [0, 0, 0])
    other = pk.screw.revolute([0, 0, -1], [1, 0, 0])
    chain = Chain.from_space([z, other, pk.screw.prismatic([0, 0, 1])], np.eye(4))
    assert parallel(chain, 0)
    assert not intersecting(chain, 0)
    assert not parallel(chain, 1)
    assert not intersecting(chain, 1)
