"""One change planted in one joint of an arm, and whether a comparison names it, sizes it and blames
nothing else.
"""

from __future__ import annotations

import functools
import warnings
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from poekin.errors import PoekinWarning
from poekin.formats.load import load
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain

ARMS = {
    "panda": "panda_hand", "ur5e": "tool0", "erd:ur3_robot": "tool0", "erd:ur5_robot": "tool0",
    "erd:ur10_robot": "tool0", "erd:kinova": "j2s6s200_end_effector", "erd:xarm7": "link_eef", "erd:so100": "jaw",
    "erd:z1": "gripperMover", "erd:b1-z1": "gripperMover", "erd:baxter": "right_hand_camera_link",
    "erd:centauro": "arm1_8", "erd:alex_nub_hands": "LeftShoulderYawIMULink",
    "erd:talos_left_arm": "gripper_left_motor_double_link", "erd:romeo": "l_sole", "erd:icub": "l_sole",
    "random 6a": "", "random 6b": "", "random 7a": "", "random 7b": "",
}  # fmt: skip
"""Twenty arms of 6 or 7 revolute joints, and the link at which each ends."""
CHANGES = ("tilt", "shift", "zero", "flip")


def random_arm(seed: int, kinds: Sequence[str] = ("revolute",) * 6) -> Chain:
    """An arm with axes anywhere within some decimetres."""
    rng = np.random.default_rng(seed)
    rows = [
        screw.prismatic(rng.normal(size=3))
        if kind == "prismatic"
        else screw.revolute(rng.normal(size=3), p)
        for kind, p in zip(kinds, 0.3 * rng.normal(size=(len(kinds), 3)), strict=True)
    ]
    return Chain.from_space(rows, se3.exp(rng.normal(size=6)))


@functools.cache
def arm(name: str) -> Chain:
    """One of `ARMS`."""
    if name.startswith("random"):
        return random_arm(ord(name[-1]), ("revolute",) * int(name[7]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        robot = load(name)
    return robot.chain(tip=ARMS[name] if ARMS[name] in robot.links else None)


def planted(chain: Chain, change: str, k: int, rng: np.random.Generator) -> Chain:
    """The arm with one change in joint k: 0.1 deg, 1 mm across the axis, 0.5 deg of zero offset, or
    its direction.
    """
    S, limits = chain.screws.copy(), chain.limits.copy()
    if change == "zero":
        return chain.rezeroed(np.where(np.arange(chain.dof) == k, np.radians(0.5), 0.0))
    w, p = S[k, :3], np.cross(S[k, :3], S[k, 3:])
    across = np.cross(w, rng.normal(size=3))
    across /= np.linalg.norm(across)
    if change == "tilt":
        S[k] = screw.revolute(np.cos(np.radians(0.1)) * w + np.sin(np.radians(0.1)) * across, p)
    elif change == "shift":
        S[k] = screw.revolute(w, p + 1e-3 * across)
    else:
        S[k], limits[k] = -S[k], -limits[k, ::-1]
    return Chain.from_space(S, chain.home, joint_names=chain.joint_names, limits=limits)


def fault(result: Any, change: str, k: int) -> str:
    """What is wrong with a comparison of an arm with one change planted in joint k; empty where it
    is right.
    """
    if [j.number for j in result.differing] != [k + 1]:
        return f"blames {[j.number for j in result.differing]}"
    j = result.joints[k]
    if (j.axis_differs, j.zero_differs, j.reversed) != (
        change in ("tilt", "shift"),
        change == "zero",
        change == "flip",
    ):
        return f"says {result.verdict}"
    size = {
        "tilt": (j.angle, np.radians(0.1)),
        "shift": (j.normal, 1e-3),
        "zero": (-j.zero_offset, np.radians(0.5)),
        "flip": (1, 1),
    }[change]
    if not abs(size[0] - size[1]) <= 0.01 * size[1]:
        return f"size {size}"
    if change == "tilt" and j.normal > 1e-5:
        return f"tilt shifted by {j.normal} m"
    if result.same_arm != (change in ("zero", "flip")) or f"joint {k + 1} " not in result.verdict:
        return f"verdict {result.verdict}"
    if result.base is None or result.tool is None:
        return "matches nothing"
    if not (
        np.allclose(result.base, np.eye(4), atol=1e-6)
        and np.allclose(result.tool, np.eye(4), atol=1e-6)
    ):
        return "moves base or tool"
    return ""


def moves(
    chain: Chain, rng: np.random.Generator
) -> Iterator[tuple[str, Chain, np.ndarray, np.ndarray]]:
    """(what was moved, the moved arm, the base and the tool that a comparison ought to find)."""
    P, Q = se3.exp(rng.normal(size=(2, 6)))
    yield "base", chain.rebased(P), se3.inverse(P), np.eye(4)
    yield "tool", chain.retooled(Q), np.eye(4), se3.inverse(Q)
    yield "base and tool", chain.rebased(P).retooled(Q), se3.inverse(P), se3.inverse(Q)


def alignment_fault(result: Any, base: np.ndarray, tool: np.ndarray) -> str:
    """What is wrong with a comparison of an arm with its base or tool moved; empty where it is
    alignment only.
    """
    if result.differing or not result.same_arm:
        return f"blames {[j.number for j in result.differing]}: {result.verdict}"
    if "aligned" not in result.verdict:
        return f"verdict {result.verdict}"
    if result.base is None or result.tool is None or result.after is None:
        return "matches nothing"
    off = max(np.abs(result.base - base).max(), np.abs(result.tool - tool).max())
    if not off <= 1e-7:
        return f"alignment off by {off:.1g}"
    left = result.after.worst_position
    return "" if left < 1e-7 else f"{1e3 * left:.1g} mm are left"
