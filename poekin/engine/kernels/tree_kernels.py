"""Kernel of a tree of links."""

from ...algebra import IDENTITY
from ...formulas.kinematics import forward
from ..jit.array_io import load_matrix, store_matrix
from ..jit.kernel import kernel
from ..straight_line.sincos import sincos


@kernel("i1 r3 r2 r2 w4")
def tree_poses(parents, origins, screws, x, poses):
    """Poses of all links in the root's frame. Joint j hangs link j + 1 on link parents[j] <= j;
    link 0 is the root.
    """
    for k in range(x.shape[0]):
        store_matrix(poses[k][0], IDENTITY)
        for j in range(len(parents)):
            q = x[k][j]
            T = load_matrix(poses[k][parents[j]])
            sine, cosine = sincos(q)
            moved = forward.child(T, load_matrix(origins[j]), screws[j], q, sine, cosine)
            store_matrix(poses[k][j + 1], moved)
