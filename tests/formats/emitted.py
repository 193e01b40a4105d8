"""What the tests of emitted text share: arms of all sorts, the text as a module, and what it has to
compute.
"""

from __future__ import annotations

import ast
import functools
from types import SimpleNamespace
from typing import Any

import numpy as np

import poekin as pk
from poekin.groups import se3
from poekin.model.kinematics.pose_jacobian import AnyFrame

FRAMES = ("space", "body", "hybrid", "cheapest")
HOSTILE = (
    "*/ int main(void) { return 1; } /*",
    "*/#error broken",
    "line\nbreak */ #error broken",
    "\r#error broken",
    "trigraph ??/",
    "ends in a backslash \\",
    '"""\nimport os\nraise SystemExit(3)\n"""',
    "'''\nraise SystemExit(3)\n'''",
    "{q} %s %n // /* ",
    "</script><script>alert(1)</script>",
    "<!--<script>",
    "ü\u202eevil\u2028\x00\x1b[31m",
    "\ud800",
    "x" * 500,
)


@functools.cache
def arm(name: str) -> pk.Chain:
    """An arm by name; the catalogue's, and some that have what those have not."""
    rng = np.random.default_rng(4)
    home = se3.exp([0.3, -0.2, 0.5, 0.4, 0.1, 0.6])
    turning = [[*w, *np.cross(rng.normal(size=3), w)] for w in _units(rng, 6)]
    sliding = [[0, 0, 0, *w] for w in _units(rng, 2)]
    helical = [[*w, *(np.cross(rng.normal(size=3), w) + 0.1 * w)] for w in _units(rng, 1)]
    arms: dict[str, Any] = {
        "panda": lambda: pk.load("panda").chain(tip="panda_hand"),
        "ur5e": lambda: pk.load("ur5e").chain(tip="tool0"),
        "general 6R": lambda: pk.Chain.from_space(turning, home),
        "mixed": lambda: pk.Chain.from_space(
            [turning[0], sliding[0], helical[0], turning[1], sliding[1]], home
        ),
        "coupled": lambda: pk.Chain.from_space(
            [turning[0], sliding[0], turning[2]],
            home,
            coupling=[[1, 0], [0.5, 0], [-2, 1]],
            offset=[0.1, 0, -0.3],
            q_names=["a", "b"],
        ),
        "one joint": lambda: pk.Chain.from_space(turning[:1], home),
        "one slide": lambda: pk.Chain.from_space(sliding[:1], home),
        "no joint": lambda: pk.Chain.from_space(np.zeros((0, 6)), home),
    }
    return arms[name]()


ARMS = ("panda", "ur5e", "general 6R", "mixed", "coupled", "one joint", "one slide", "no joint")


def with_name(name: str) -> pk.Chain:
    """An arm of two joints that has one name wherever it can have one."""
    return pk.Chain.from_space(
        [[0, 0, 1, 0, 0, 0], [0, 1, 0, 0.2, 0, 0]],
        np.eye(4),
        joint_names=[name, name + "2"],
        base=name,
        tip=name + "3",
    )


def suffix(frame: str | int) -> str:
    """What the names of functions end in."""
    return frame if isinstance(frame, str) else f"joint{frame}"


def module(text: str) -> SimpleNamespace:
    """The functions of an emitted Python text."""
    namespace: dict[str, Any] = {}
    exec(compile(text, "emitted.py", "exec", dont_inherit=True), namespace)
    return SimpleNamespace(
        **{name: thing for name, thing in namespace.items() if name != "__builtins__"}
    )


def expected(chain: pk.Chain, frame: AnyFrame, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pose and Jacobian by the chain's general kernels; "cheapest" from the frame of its joint by the
    adjoint.
    """
    if frame != "cheapest":
        return chain.fk_jacobian(q, frame)
    middle = chain.compile().cheapest
    T, J = chain.fk_jacobian(q, middle.joint)
    return T, se3.adjoint(se3.inverse(middle.T_km)) @ J


def bound(chain: pk.Chain, q: np.ndarray, roundoff: float = 2.0**-53) -> float:
    """Twice what `Chain.fk` promises, at a unit roundoff: for the text, and for what it is compared
    to.
    """
    x = np.abs(q @ chain.coupling.T + chain.offset).sum(axis=-1).max(initial=0.0)
    return 2 * roundoff * (8 * (len(chain.kinds) + 1) + 4 * x) * chain.reach


def link_bounds(robot: pk.Robot, q: np.ndarray) -> np.ndarray:
    """Twice what rounding leaves of each link's pose: 8 u R for each product above it and 4 u R for
    each unit of x, R the lengths on its way (`bound`).
    """
    x = {}
    for leaf in robot.leaves:
        chain = robot.chain(tip=leaf)
        own = q[:, [robot.q_names.index(name) for name in chain.q_names]]
        moved = np.abs(own @ chain.coupling.T + chain.offset).max(axis=0)
        x.update(zip(chain.joint_names, moved, strict=True))
    above = {joint.child: joint for joint in robot.joints}
    bounds = []
    for link in robot.links:
        depth, moved, reach = 1, 0.0, 1.0
        while link in above:
            joint = above[link]
            depth += 1
            moved += x.get(joint.name, 0.0)
            reach += np.linalg.norm(joint.origin[:3, 3]) + (joint.kind == "prismatic")
            link = joint.parent
        bounds.append(2 * 2.0**-53 * (8 * depth + 4 * moved) * reach)
    return np.array(bounds)


def operations(function: ast.FunctionDef) -> tuple[int, int]:
    """Multiplications, and additions with subtractions, that a function of an emitted Python text
    spells out.
    """
    found = [node.op for statement in function.body if isinstance(statement, ast.Assign) and _scalar(statement)
             for node in ast.walk(statement.value) if isinstance(node, ast.BinOp)]  # fmt: skip
    return sum(isinstance(op, ast.Mult) for op in found), sum(
        isinstance(op, (ast.Add, ast.Sub)) for op in found
    )


def _scalar(statement: ast.Assign) -> bool:
    target = statement.targets[0]
    return isinstance(target, ast.Name) and target.id[0] in "vx"


def _units(rng: np.random.Generator, count: int) -> np.ndarray:
    w = rng.normal(size=(count, 3))
    return w / np.linalg.norm(w, axis=1)[:, None]
