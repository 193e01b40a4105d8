"""`poekin info`: what is in a robot description: its tree, its chains, their screws."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...analysis.validate import routes
from ...model.chain import Chain
from ...model.joint import Joint
from ...model.robot import Robot
from ..kinematics.arm import Base, File, Json, Tip
from ..model import model
from ..output import as_json, matrix, name, number, say, table

SCREW = ("wx", "wy", "wz", "vx", "vy", "vz")


def command(file: File, tip: Tip = None, base: Base = None, json: Json = False) -> None:
    """The tree, its chains from root to leaf, and every joint's screw at home; of one chain with
    --tip or --base.
    """
    robot = model(file)
    if tip is None and base is None:
        chains = [(robot.chain(base=b, tip=t), note) for b, t, note in routes(robot)]
        print(as_json(_robot(robot, chains))) if json else _show_robot(robot, chains)
    else:
        chain = robot.chain(base=base, tip=tip)
        print(as_json(_chain(chain))) if json else _show_chain(chain)


def _show_robot(robot: Robot, chains: list[tuple[Chain, str]]) -> None:
    say(
        f"{name(robot.name)}: {len(robot.links)} links, {len(robot.joints)} joints, {robot.dof} coordinates\n"
    )
    for line in tree(robot):
        say(line)
    say("\nChains from root to leaf")
    heads = ("base", "tip", "joints", "coordinates", "reach (m)", "note")
    shown = slice(None if any(note for _, note in chains) else -1)
    rows = [
        (c.base, c.tip, len(c.joint_names), c.dof, number(c.reach), note)[shown]
        for c, note in chains
    ]
    table(heads[shown], rows, left=2)
    # A screw seen from the root is the same in every chain that has its joint.
    seen: dict[tuple[str, object], tuple[object, ...]] = {}
    for chain, _ in chains:
        for joint, *row in _screw_rows(chain):
            seen.setdefault((chain.base, joint), (joint, *row))
    if seen:
        say("\nScrews (w; v) at home, seen from each chain's base (rad, m)")
        table(("joint", "kind", "coordinate", *SCREW, "lower", "upper"), seen.values(), left=3)


def _show_chain(chain: Chain) -> None:
    say(f"{name(chain.base)} → {name(chain.tip)}: {len(chain.joint_names)} joints, {chain.dof} coordinates, "
        f"reach {number(chain.reach)} m\n")  # fmt: skip
    say(f"Screws (w; v) at home, seen from {name(chain.base)} (rad, m)")
    table(("joint", "kind", "coordinate", *SCREW, "lower", "upper"), _screw_rows(chain), left=3)
    say(f"\nHome pose of {name(chain.tip)} in {name(chain.base)} (m)")
    matrix(chain.home)


def _screw_rows(chain: Chain) -> Iterator[tuple[object, ...]]:
    C = chain.coupling
    for i, joint in enumerate(chain.joint_names):
        terms = [(float(C[i, k]), int(k)) for k in np.flatnonzero(C[i])]
        limits = chain.limits[terms[0][1]] if terms else np.zeros(2)
        yield (
            joint, chain.kinds[i], _coordinate(chain, terms, chain.offset[i]),
            *map(number, chain.screws[i]), *map(number, limits),
        )  # fmt: skip


def _coordinate(chain: Chain, terms: list[tuple[float, int]], offset: float) -> str:
    """A joint's value as a text of its coordinate: `a`, or `-0.5 a + 0.1` where it mimics."""
    text = " + ".join(
        chain.q_names[k] if c == 1 else f"{number(c)} {chain.q_names[k]}" for c, k in terms
    )
    shift = number(offset) if offset or not terms else ""
    return " + ".join(part for part in (text, shift) if part)


def tree(robot: Robot) -> Iterator[str]:
    """The tree as lines: links in a row stand below each other, and only a fork goes in by a step."""
    children: dict[str, list[Joint]] = {}
    for joint in robot.joints:
        children.setdefault(joint.parent, []).append(joint)
    yield name(robot.root)
    todo: list[tuple[Joint, str, str]] = []

    def push(link: str, indent: str) -> None:
        below = children.get(link, [])
        forks = (
            [("├ ", "│ ")] * (len(below) - 1) + [("└ ", "  ")]
            if len(below) > 1
            else [("", "")] * len(below)
        )
        todo.extend(
            (j, indent + here, indent + on)
            for j, (here, on) in reversed([*zip(below, forks, strict=True)])
        )

    push(robot.root, "  ")
    while todo:
        joint, here, on = todo.pop()
        yield f"{here}{name(joint.name)} ({_what(joint)}) → {name(joint.child)}"
        push(joint.child, on)


def _what(joint: Joint) -> str:
    if joint.mimic is None:
        return joint.kind
    shift = f" + {number(joint.mimic.offset)}" if joint.mimic.offset else ""
    return f"{joint.kind} = {number(joint.mimic.multiplier)} × {name(joint.mimic.joint)}{shift}"


def _robot(robot: Robot, chains: list[tuple[Chain, str]]) -> dict[str, object]:
    joints = [
        {
            "name": j.name, "kind": j.kind, "parent": j.parent, "child": j.child,
            "mimic": None if j.mimic is None else
            {"joint": j.mimic.joint, "multiplier": j.mimic.multiplier, "offset": j.mimic.offset},
        }
        for j in robot.joints
    ]  # fmt: skip
    return {
        "robot": robot.name, "root": robot.root, "links": list(robot.links), "joints": joints,
        "q_names": list(robot.q_names), "limits": robot.limits,
        "chains": [_chain(c) | ({"note": note} if note else {}) for c, note in chains],
    }  # fmt: skip


def _chain(chain: Chain) -> dict[str, object]:
    return {
        "base": chain.base, "tip": chain.tip, "reach": chain.reach, "joint_names": list(chain.joint_names),
        "kinds": list(chain.kinds), "q_names": list(chain.q_names), "limits": chain.limits, "screws": chain.screws,
        "home": chain.home, "coupling": chain.coupling, "offset": chain.offset,
    }  # fmt: skip
