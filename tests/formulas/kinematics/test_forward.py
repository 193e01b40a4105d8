"""Poses and axes of a chain against products of 4x4 matrices."""

from __future__ import annotations

import numpy as np
from scipy.linalg import expm

from poekin.formulas.kinematics import forward
from tests.formulas.four_joints import (
    COUNTS,
    FRAMES,
    LINKS,
    MOTION,
    MOVES,
    PARENT,
    TOOL,
    rows,
    same,
)
from tests.formulas.matrices import brackets, flat


@COUNTS
def test_the_pose_is_the_product_of_links_and_motions(count):
    links = [flat(T) for T in LINKS]
    same(forward.frame(links, *MOTION, count), flat(FRAMES[count - 1]))
    f = FRAMES[count - 1] @ LINKS[count]
    same(forward.tip(links, *MOTION, count), flat(f))
    axes = rows(count)
    same(forward.tip_and_axes(links, *MOTION, count, axes), flat(f))
    begins = [F @ np.linalg.inv(E) for F, E in zip(FRAMES, MOVES, strict=True)]
    same(axes, np.transpose([np.r_[B[:3, 2], B[:3, 3]] for B in begins[:count]]))


def test_a_link_of_a_tree_is_behind_its_parent_and_its_joint():
    S = np.array([0.6, 0.0, 0.8, 0.3, -0.2, 0.5])
    got = forward.child(flat(PARENT), flat(TOOL), S, 0.7, np.sin(0.7), np.cos(0.7))
    same(got, flat(PARENT @ TOOL @ expm(brackets(S * 0.7))))
