"""Drawings stay as they were when somebody looked at them: sizes, places, colours and words of
scenes of each kind, beside this file.

Whoever changes a drawing on purpose looks at the pages, in light and dark and in a narrow window,
and writes the new ones with POEKIN_UPDATE=1.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterable
from dataclasses import astuple
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.view.nodes import Cloud, Label, Node, Polyline, Triangles
from poekin.view.palette import color
from poekin.view.scene import Scene
from poekin.view.scenes.arm import arm_scene
from poekin.view.scenes.comparison import comparison_scene
from poekin.view.scenes.solutions import solutions_scene
from poekin.view.scenes.targets import solution_scene
from tests.view.scenes import test_scale as scaled

SEEN = Path(__file__).with_name("drawn.json")
CLOSE = 1e-5
"""Of the size: fits and solutions end within 1e-6 of it, and what is drawn is coarser."""
SHAPES = """<robot name="shapes">
  <link name="base"><visual><geometry><box size="0.2 0.4 0.6"/></geometry></visual>
    <visual><origin xyz="1 0 0"/><geometry><capsule radius="0.1" length="0.3"/></geometry></visual>
  </link>
  <link name="arm"><visual><geometry><cylinder radius="0.1" length="0.5"/></geometry>
    <material name="m"><color rgba="0.1 0.2 0.3 0.5"/></material></visual></link>
  <link name="ball"><visual><geometry><sphere radius="0.2"/></geometry></visual></link>
  <link name="lost"><visual><geometry><mesh filename="package://nowhere/l.stl"/></geometry></visual></link>
  <link name="end"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/>
    <axis xyz="0 0 1"/><origin xyz="0 0 0.3"/></joint>
  <joint name="tilt" type="revolute"><parent link="arm"/><child link="ball"/>
    <axis xyz="0 1 0"/><origin xyz="0.5 0.1 0.5"/><limit lower="0.2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="to_lost" type="fixed"><parent link="ball"/><child link="lost"/><origin xyz="0 0.3 0"/></joint>
  <joint name="last" type="fixed"><parent link="lost"/><child link="end"/><origin xyz="0.3 0 0"/></joint>
</robot>"""


HALF = pk.se3.exp([0, 0, 0, 0, 0, 0.5])


def crane() -> pk.Robot:
    """A tree with a slide, a left-handed thread, a coupled finger and joints at a single place."""
    there = pk.se3.exp([0.3, -0.2, 0.5, 0.1, 0.2, 0.3])
    return pk.Robot(
        "crane",
        ["base", "spin", "slid", "screwed", "left", "right"],
        [
            pk.Joint("turn", "revolute", "base", "spin", there, (1, 2, 0), limits=(-1, 2)),
            pk.Joint("slide", "prismatic", "spin", "slid", there, limits=(0.1, 0.4)),
            pk.Joint("thread", "helical", "slid", "screwed", there, (0, 0, 1), pitch=-0.02),
            pk.Joint("left", "prismatic", "screwed", "left", there, limits=(0.0, 0.05)),
            pk.Joint("right", "prismatic", "screwed", "right", there, mimic=pk.Mimic("left", -2)),
        ],
    )


def many() -> Scene:
    """More targets than a choice holds, one of them out of reach."""
    chain = scaled.arm(1.0)
    targets = chain.fk(chain.random(5, size=34) * 0.2 + scaled.Q)
    targets[1, :3, 3] = [5, 0, 0]
    return solution_scene(pk.ik(chain, targets, q0=scaled.Q))


def moved_tool() -> Scene:
    """Another base and tool, a slide, and joints that count the other way or from elsewhere."""
    a = pk.load("stanford").chain()
    up = pk.se3.exp([0, 0, 0, 0, 0, 0.1])
    b = a.rebased(up).retooled(pk.se3.exp([0, 0, 0.2, 0, 0.02, 0.003]))
    return comparison_scene(pk.compare(a, b), q=[0.1, 0.5, 0.6, 0.2, 0.9, 0.3], title="two")


SCENES = {
    **{
        kind: lambda make=make: make(1.0)
        for kind, make in scaled.SCENES.items()
        if kind != "solutions"  # found by another method where a package is not installed
    },
    "crane": lambda: arm_scene(crane(), tip="left"),
    "shapes": lambda: arm_scene(pk.from_text(SHAPES)),
    "zero": lambda: arm_scene(pk.load("ur5e"), q=np.zeros(6), meshes=False),
    "targets": many,
    "target": lambda: solution_scene(pk.ik(scaled.UR5, scaled.UR5.fk(scaled.Q), q0=scaled.Q)),
    "solutions": lambda: solutions_scene(
        pk.ik_all(scaled.UR5, scaled.UR5.fk(scaled.Q), method="search")
    ),
    "stanford": lambda: arm_scene(pk.load("stanford").chain(), cloud=3),
    "moved tool": moved_tool,
    "post": lambda: arm_scene(
        pk.Robot("post", ["base", "top"], [pk.Joint("weld", "fixed", "base", "top", HALF)])
    ),
    "same": lambda: comparison_scene(pk.compare(scaled.UR5, scaled.UR5)),
    "given": lambda: arm_scene(pk.load("panda"), q=[0, 0, 0, 0, 0, 0, 0, 1.0], meshes=False),
}


def measured(scene: Scene) -> dict[str, Any]:
    """A scene in numbers and words, as JSON."""
    return json.loads(
        json.dumps(
            {
                "title": scene.title,
                "words": [told(words) for words in scene.words],
                "size": scene.size,
                "q": scene.q.tolist(),
                "shown": sorted(scene.shown),
                "exaggerated": scene.exaggerated,
                "arms": [
                    [arm.name, arm.links, [s.name for s in arm.coordinates]] for arm in scene.arms
                ],
                "tips": [[astuple(tip)[:3] for tip in arm.tips] for arm in scene.arms],
                "choices": [told(choice.text) for choice in scene.choices],
                "marks": [astuple(m)[:3] for m in scene.motion.marks] if scene.motion else None,
                "tables": [
                    [t.title, t.heads, [[told(c) for c in r] for r in t.rows]] for t in scene.tables
                ],
                "nodes": [looks(node) for node in scene.nodes],
                "numbers": [numbers(node) for node in scene.nodes],
            }
        )
    )


def masked(words: str) -> str:
    """Words without their decimals, which may be rounded either way."""
    return re.sub(r"[-−]?\d+(\.\d+(e[-+]?\d+)?|e[-+]?\d+)", "#", words)


def told(words: str) -> str:
    """A sentence without any number, and without what stands in brackets."""
    return re.sub(r"[-+−]?\d+(\.\d+)?(e[-+]?\d+)?", "#", re.sub(r"\([^)]*\)", "()", words))


def looks(node: Node) -> list[Any]:
    """What does not depend on lengths."""
    held = node.attachment
    counts: list[Any] = [type(node).__name__]
    if isinstance(node, Triangles):
        counts += [len(node.vertices), len(node.faces)]
    elif isinstance(node, Label):
        counts.append(node.text)
    else:
        counts.append(len(node.points))
    place = (held.layer, held.role, held.link, held.arm, held.rule, held.index, held.choice)
    return [*counts, masked(held.name), *place, f"{color(held):06x}", held.opacity]


def numbers(node: Node) -> list[float]:
    """Box, mean and measure of a node: area, width, or size and values."""
    if isinstance(node, Label):
        # a lost motion has two senses, and either is one
        return [] if node.attachment.layer == "singular" else rounded(node.point)
    points = node.vertices if isinstance(node, Triangles) else node.points
    found = [*points.min(axis=0), *points.max(axis=0), *points.mean(axis=0)]
    if isinstance(node, Triangles):
        a, b, c = (node.vertices[node.faces[:, k]] for k in range(3))
        found.append(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
        if node.attachment.layer == "singular":
            found = found[-1:]
    elif isinstance(node, Polyline):
        found.append(node.width)
    else:
        assert isinstance(node, Cloud)
        found.append(node.size)
        if node.values is not None:
            found += [*node.values[:3]]
    return rounded(found)


def rounded(values: Iterable[float]) -> list[float]:
    return [float(f"{x:.6g}") for x in values]


@pytest.fixture(scope="module")
def seen() -> dict[str, Any]:
    if os.environ.get("POEKIN_UPDATE"):
        made = {kind: measured(make()) for kind, make in SCENES.items()}
        lines = [
            f"{json.dumps(k)}: {json.dumps(v, separators=(',', ':'))}" for k, v in made.items()
        ]
        SEEN.write_text("{\n" + ",\n".join(lines) + "\n}\n")
    return json.loads(SEEN.read_text())


@pytest.mark.parametrize("kind", SCENES)
def test_a_scene_is_drawn_as_it_was_when_it_was_looked_at(seen, kind):
    made, before = measured(SCENES[kind]()), seen[kind]
    names = [node[3] for node in before["nodes"]]
    for value in ("size", "q"):
        np.testing.assert_allclose(made.pop(value), before.pop(value), rtol=CLOSE, atol=CLOSE)
    lengths = zip(made.pop("numbers"), before.pop("numbers"), names, strict=True)
    assert made == before
    for now, then, name in lengths:
        np.testing.assert_allclose(now, then, rtol=0, atol=CLOSE, err_msg=str(name))
