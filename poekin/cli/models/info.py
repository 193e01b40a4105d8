"""`poekin info`: tree, chains and screws of a robot description."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict

import numpy as np

from ...analysis.validate import routes
from ...model.chain import Chain
from ...model.joint import Joint
from ...model.robot import Robot
from ..kinematics.arm import Base, File, Json, Tip
from ..kinematics.jacobian import TWIST
from ..model import model
from ..output import as_json, matrix, name, number, say, table

DRIVES = ("joint", "velocity", "effort")
SCREWS = ("joint", "kind", "coordinate", *TWIST, "lower", "upper")


def command(file: File, tip: Tip = None, base: Base = None, json: Json = False) -> None:
    """The tree, its chains from root to leaf, and every joint's screw at home; of one chain with
    --tip or --base.
    """
    robot = model(file)
    if tip is None and base is None:
        chains = [(robot.chain(base=start, tip=end), note) for start, end, note in routes(robot)]
        if json:
            print(as_json(_robot(robot, chains)))
        else:
            _show_robot(robot, chains)
    else:
        chain = robot.chain(base=base, tip=tip)
        if json:
            print(as_json(_chain(chain)))
        else:
            _show_chain(chain)
            _show_drives([robot.joint(joint) for joint in chain.joint_names])


def _show_robot(robot: Robot, chains: list[tuple[Chain, str]]) -> None:
    say(
        f"{name(robot.name)}: {len(robot.links)} links, {len(robot.joints)} joints, {robot.dof} coordinates\n"
    )
    for line in tree(robot):
        say(line)
    say("\nChains from root to leaf")
    heads = ["base", "tip", "joints", "coordinates", "reach (m)"]
    noted = any(note for _, note in chains)
    if noted:
        heads.append("note")
    rows = []
    # A screw seen from the root is the same in every chain that has its joint.
    seen: dict[tuple[str, object], tuple[object, ...]] = {}
    for chain, note in chains:
        row = [chain.base, chain.tip, len(chain.joint_names), chain.dof, number(chain.reach)]
        if noted:
            row.append(note)
        rows.append(row)
        for screw in _screw_rows(chain):
            seen.setdefault((chain.base, screw[0]), screw)
    table(heads, rows, left=2)
    if seen:
        say("\nScrews (w; v) at home, seen from each chain's base (rad, m)")
        table(SCREWS, seen.values(), left=3)
        _tell_of_sums(chain for chain, _ in chains)
    _show_drives(robot.joints)


def _show_chain(chain: Chain) -> None:
    say(
        f"{name(chain.base)} → {name(chain.tip)}: {len(chain.joint_names)} joints, {chain.dof} coordinates, "
        f"reach {number(chain.reach)} m\n"
    )
    say(f"Screws (w; v) at home, seen from {name(chain.base)} (rad, m)")
    table(SCREWS, _screw_rows(chain), left=3)
    _tell_of_sums([chain])
    say(f"\nHome pose of {name(chain.tip)} in {name(chain.base)} (m)")
    matrix(chain.home)


def _tell_of_sums(chains: Iterable[Chain]) -> None:
    """A word on limits where a joint follows several coordinates."""
    followed = (np.count_nonzero(chain.coupling, axis=1) for chain in chains)
    if any((count > 1).any() for count in followed):
        say("Limits are those of each coordinate alone; solvers keep the joints' own, too")


def _show_drives(joints: Sequence[Joint]) -> None:
    """Velocity and effort limits, where one is known."""
    moving = [joint for joint in joints if joint.kind != "fixed"]
    known = [joint for joint in moving if min(joint.velocity, joint.effort) < math.inf]
    if known:
        say("\nLimits of velocity (rad/s or m/s) and effort (N m or N), inf where not known")
        rows = [(j.name, number(j.velocity), number(j.effort)) for j in known]
        table(DRIVES, rows, left=1)


def _screw_rows(chain: Chain) -> Iterator[tuple[object, ...]]:
    C = chain.coupling
    for i, joint in enumerate(chain.joint_names):
        row = C[i]
        terms = [(float(row[k]), int(k)) for k in np.flatnonzero(row)]
        limits = np.zeros(2)
        if terms:
            followed = [k for _, k in terms]
            own = [k for k in followed if chain.q_names[k] == joint]
            limits = chain.limits[(own or followed)[0]]
        yield (
            joint,
            chain.kinds[i],
            _coordinate(chain, terms, chain.offset[i]),
            *map(number, chain.screws[i]),
            *map(number, limits),
        )


def _coordinate(chain: Chain, terms: list[tuple[float, int]], offset: float) -> str:
    """Joint's value as a text of its coordinate: `a`, or `-0.5 a + 0.1` where it mimics."""
    parts = []
    for factor, k in terms:
        term = chain.q_names[k]
        if factor != 1:
            term = f"{number(factor)} {term}"
        parts.append(term)
    if offset or not terms:
        parts.append(number(offset))
    return " + ".join(part for part in parts if part)


def tree(robot: Robot) -> Iterator[str]:
    """Lines of the tree: links in a row stand below each other, a fork is indented by a step."""
    children: dict[str, list[Joint]] = {}
    for joint in robot.joints:
        children.setdefault(joint.parent, []).append(joint)
    yield name(robot.root)
    todo: list[tuple[Joint, str, str]] = []

    def push(link: str, indent: str) -> None:
        below = children.get(link, [])
        pushed = []
        for joint in below:
            here = "├ "
            on = "│ "
            if joint is below[-1]:
                here = "└ "
                on = "  "
            if len(below) < 2:
                here = ""
                on = ""
            pushed.append((joint, indent + here, indent + on))
        todo.extend(reversed(pushed))

    push(robot.root, "  ")
    while todo:
        joint, here, on = todo.pop()
        yield f"{here}{name(joint.name)} ({_what(joint)}) → {name(joint.child)}"
        push(joint.child, on)


def _what(joint: Joint) -> str:
    if joint.mimic is None:
        return joint.kind
    words = f"{joint.kind} = {number(joint.mimic.multiplier)} × {name(joint.mimic.joint)}"
    if joint.mimic.offset:
        words += f" + {number(joint.mimic.offset)}"
    return words


def _robot(robot: Robot, chains: list[tuple[Chain, str]]) -> dict[str, object]:
    documents = []
    for chain, note in chains:
        document = _chain(chain)
        if note:
            document["note"] = note
        documents.append(document)
    return {
        "robot": robot.name,
        "root": robot.root,
        "links": robot.links,
        "joints": [_joint(joint) for joint in robot.joints],
        "q_names": robot.q_names,
        "limits": robot.limits,
        "chains": documents,
    }


def _joint(joint: Joint) -> dict[str, object]:
    document = {column: getattr(joint, column) for column in _JOINT}
    for record in ("mimic", "safety_controller"):
        value = getattr(joint, record)
        document[record] = asdict(value) if value is not None else None
    return document


_JOINT = ("name", "kind", "parent", "child", "velocity", "effort", "damping", "friction")
_CHAIN = (
    *("base", "tip", "reach", "joint_names", "kinds", "q_names", "limits", "screws", "home"),
    *("coupling", "offset", "velocity_limits"),
)


def _chain(chain: Chain) -> dict[str, object]:
    return {key: getattr(chain, key) for key in _CHAIN}
