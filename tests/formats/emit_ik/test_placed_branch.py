"""The emitted pose of a branch against that of the chain: what Newton's rule would hide is seen."""

from __future__ import annotations

import ctypes

import numpy as np
import pytest

import poekin as pk
from poekin.formats.emit.ik.placed_branch import PlacedBranch, columns
from poekin.formats.emit.messages import make_tasks
from poekin.model import screw
from tests.engine.transpile.compiled_c import library

UR5 = pk.load("ur5").chain()
SLIDES = pk.Chain.from_space(
    [*map(screw.prismatic, np.eye(3))], pk.se3.exp([0.1, 0.2, 0.3, 1, 2, 3])
)
ARMS = {
    "ur5": UR5,
    "from other zeros": UR5.rezeroed(np.linspace(0.3, 1.1, 6)),
    "stanford": pk.load("stanford").chain(),
    "against its joints": pk.Chain.from_space(-UR5.screws, UR5.home),
    # a sum of angles has a term of the other sign, and a further joint one too
    "the elbow against its joint": pk.Chain.from_space(
        UR5.screws * np.array([1, 1, -1, 1, 1, 1])[:, None], UR5.home
    ),
    "the third of three parallel joints against it": pk.Chain.from_space(
        UR5.screws * np.array([1, 1, 1, -1, 1, 1])[:, None], UR5.home
    ),
    "slides": SLIDES,
    "one joint": pk.Chain.from_space(UR5.screws[:1], UR5.home),
}


@pytest.mark.parametrize("name", ARMS)
def test_it_is_the_pose_of_the_cosines_and_sines_and_of_no_angle(name, tmp_path):
    arm = ARMS[name]
    m = arm.dof
    placed = PlacedBranch("arm", make_tasks(arm.compile(), "hybrid")[0], m)
    text = placed.text().replace("static void arm_placed", "void arm_placed")
    declared = "void arm_placed(const double *branch, double *T);\n"
    function = library(tmp_path, declared + text).arm_placed
    angles = np.array([kind == "revolute" for kind in arm.kinds])
    for q in np.random.default_rng(1).uniform(-3, 3, (20, m)):
        branch = np.full(columns(m), np.nan)
        branch[:m][~angles] = q[~angles]
        branch[m:-1] = np.concatenate([np.cos(q), np.sin(q)])
        T = np.zeros((4, 4))
        function(*(a.ctypes.data_as(ctypes.c_void_p) for a in (branch, T)))
        assert np.abs(T - arm.fk(q)).max() <= 1e-14 * arm.reach
