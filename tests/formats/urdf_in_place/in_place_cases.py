"""A URDF as robots have them, calibrations of it, and what of a text is joints' origins and axes."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any, NamedTuple
from xml.parsers import expat

import numpy as np

import poekin as pk
from poekin.errors import PoekinWarning
from poekin.formats import urdf
from poekin.model.chain import Chain
from poekin.model.robot import Robot

ARM = """<?xml version="1.0" encoding="UTF-8"?>
<!-- <origin xyz="9 9 9"/> of nothing: ü -->
<robot name="arm">
  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="base"/>
  <link name="one">
    <visual><origin xyz="0 0 0.1" rpy="0 0 0"/><geometry><box size="1 1 1"/></geometry></visual>
    <inertial><mass value="2.5"/><origin xyz="0 0 1"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <link name="two"/><link name="bracket"/><link name="hand"/>
  <joint name="turn" type="revolute">
    <origin xyz="0  0 0.30" rpy="0 0 0" />
    <parent link="base"/>
    <child link="one"/>
    <axis xyz="0 0 1"/>
    <limit lower="-2.9" upper="2.9" effort="330" velocity="2.094"/>
    <dynamics damping="0.5" friction="0.1"/>
  </joint>
  <joint name="lift" type="revolute"><!-- <axis xyz="1 1 1"/> -->
    <parent link="one"/><child link="two"/>
    <axis xyz="0 1 0"/><origin
       rpy="0 1.5707963267948966 3.141592653589793"
       xyz="1e-1 0 0.4"
    ></origin>
    <limit lower="-1" upper="1" effort="150" velocity="1"/>
  </joint>
  <joint name="held" type="fixed"><parent link="one"/><child link="bracket"/>
    <origin xyz="0.25 0 0" rpy="0 0 0.7853981633974483"/></joint>
  <joint name="flange" type="fixed">
    <parent link="two"/>
    <child link="hand"/>
    <origin xyz="0.5 0 0"/>
  </joint>
  <transmission name="t"><joint name="turn"><origin xyz="3 3 3"/></joint></transmission>
  <gazebo><joint name="turn"><axis xyz="3 3 3"/></joint></gazebo>
</robot>
"""


def quietly(make: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
    """What `make` makes, whatever it warns of."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        return make(*arguments, **options)


def read(data: bytes | str) -> Robot:
    return quietly(urdf.read_text, data)


def perturbed(chain: Chain, rng: np.random.Generator, size: float = 1e-3) -> Chain:
    """The chain with each axis, and the tool, moved by a twist of about that size."""
    twists = rng.normal(scale=size, size=(len(chain.screws), 6))
    moved = [pk.se3.adjoint(pk.se3.exp(t)) @ S for t, S in zip(twists, chain.screws, strict=True)]
    home = chain.home @ pk.se3.exp(rng.normal(scale=size, size=6))
    return chain.replace(screws=np.array(moved).reshape(-1, 6), home=home)


def longest(robot: Robot) -> Chain | None:
    """The chain with the most joints that ends at a leaf, from the root or a floating joint on."""
    above = {joint.child: joint for joint in robot.joints}
    found: list[Chain] = []
    for leaf in robot.leaves:
        base = leaf
        while base in above and above[base].kind not in ("floating", "planar"):
            base = above[base].parent
        found.append(robot.chain(base, leaf))
    return max(
        (chain for chain in found if chain.joint_names),
        key=lambda chain: len(chain.joint_names),
        default=None,
    )


class Places(NamedTuple):
    """Texts of the origin and the axis of each joint, and all that is between them."""

    parts: dict[tuple[str, str], bytes]
    spans: list[tuple[str, int, int]]


def places(data: bytes) -> Places:
    """Where joints have origins and axes, by expat and nothing of poekin's; UTF-8 only."""
    data = data.lstrip()
    parser = expat.ParserCreate()
    above: list[str] = []
    joint = ""
    found = Places({}, [])

    def start(tag: str, values: dict[str, str]) -> None:
        nonlocal joint
        if above == ["robot"] and tag == "joint":
            joint = values["name"]
        if above == ["robot", "joint"] and tag in ("origin", "axis"):
            at = parser.CurrentByteIndex
            end = at + len(data[at:].split(b">")[0]) + 1  # no attribute here holds a ">"
            found.parts[joint, tag] = data[at:end]
            found.spans.append((joint, at, end))
        above.append(tag)

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda tag: above.pop()
    parser.Parse(data, True)
    return found


def moved_joints(old: bytes, new: bytes) -> set[str]:
    """Joints whose origin or axis has another text."""
    a, b = places(old).parts, places(new).parts
    return {key[0] for key in a.keys() | b.keys() if a.get(key) != b.get(key)}


def without(data: bytes, joints: set[str]) -> bytes:
    """The text without the origins and axes of some joints."""
    data = data.lstrip()
    kept = []
    at = 0
    for joint, start, end in places(data).spans:
        if joint in joints:
            kept.append(data[at:start])
            at = end
    return b"".join([*kept, data[at:]])
