"""Forward kinematics in the paper's local form with z-aligned link frames, and the joint axes in
the same pass.

    f = M_1 e^{S x_1} M_2 e^{S x_2} ... M_n e^{S x_n} M_{n+1},  S = (0, 0, r; 0, 0, s)

`links` holds the n + 1 constant poses. A joint turns by r x and slides by s x along its own z axis:
(r, s) is (1, 0) for a revolute, (0, 1) for a prismatic, (1, pitch) for a helical joint. sin(r x),
cos(r x) and the shift s x are given. Accuracy: rounding of the products, u (8 (n + 1) + 4 sum |x|),
u = 2^-53, lengths times the reach (tests/model/test_chain_laws.py).
Source: Park 1994, Section IV; M_{n+1} is the constant tool that z-aligned frames need.
"""

from ...algebra import angular, compose, linear, pose, set_column, turned_about_z
from ..lie.exponential import joint


def frame(links, sines, cosines, shifts, count):
    """Pose of the frame of joint number `count` (1 ... n) in the base frame, after the joint's own
    motion.
    """
    first = pose(links[0])
    T = turned_about_z(first, sines[0], cosines[0], shifts[0])
    for i in range(1, count):
        link = links[i]
        T = next_frame(T, link, sines[i], cosines[i], shifts[i])
    return T


def next_frame(T, link, sine, cosine, shift):
    """Pose of the next joint's frame after its motion, from that of the joint before it."""
    unmoved = compose(T, link)
    return turned_about_z(unmoved, sine, cosine, shift)


def tip(links, sines, cosines, shifts, count):
    """f(x), the pose of the tool in the base frame, of a chain of `count` joints."""
    T = pose(links[0])
    for i in range(count):
        moved = turned_about_z(T, sines[i], cosines[i], shifts[i])
        T = compose(moved, links[i + 1])
    return T


def tip_and_axes(links, sines, cosines, shifts, count, axes):
    """f(x); writes each joint's z axis into axes[0..2] and its origin into axes[3..5], both in the
    base frame.

    The sines, cosines and shifts may be rows of `axes` itself: each is read before its place is
    written.
    """
    T = pose(links[0])
    for i in range(count):
        sine = sines[i]
        cosine = cosines[i]
        shift = shifts[i]
        set_column(axes, i, (T[2], T[5], T[8], T[9], T[10], T[11]))
        moved = turned_about_z(T, sine, cosine, shift)
        T = compose(moved, links[i + 1])
    return T


def child(T_parent, origin, screw, q, sine, cosine):
    """Pose of a tree's link: its parent's, times the joint's constant pose, times e^{S q} in the
    joint's own frame.
    """
    at_zero = compose(T_parent, origin)
    motion = joint(angular(screw), linear(screw), q, sine, cosine)
    return compose(at_zero, motion)
