"""A compiled model of MuJoCo as a Robot: bodies, joints, sites and joint equalities out of its
arrays.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...errors import ModelError, join_names
from ...formulas.lie import exponential
from ...model.joint import Joint, Mimic
from ...model.provenance import Source
from ...model.robot import TWELVE, Robot

# By the number that MuJoCo gives to a joint's type (mjtJoint).
KINDS = ("floating", "floating", "prismatic", "revolute")
FREE_JOINT, BALL = 0, 1


def make_robot(
    model: Any, bodies: np.ndarray, sites: np.ndarray, name: str, source: Source, other: list[str]
) -> tuple[Robot, list[str]]:
    """The robot of a model, and what there is to warn of.

    Parameters: model, an mjModel; bodies, sites, the poses (N, 4, 4) [m] of each in its parent
    body's frame; name of the robot; source; other, what constraints the model had that are no joint
    equalities.
    Raises: what `Joint` and `Robot` raise.
    """
    return _Reader(model).robot(bodies, sites, name, source, other)


class _Reader:
    """The names of a model's parts, all different, and its joints as they are made one after the
    other.
    """

    def __init__(self, model: Any):
        self.model = model
        self.gone = _below_mocap(model)
        named = [model.body(i).name for i in range(model.nbody)]
        self.taken = {"link": set(named), "joint": {model.joint(j).name for j in range(model.njnt)}}
        self.links = [given or self.free("link", f"body{i}") for i, given in enumerate(named)]
        self.names = [model.joint(j).name or self._joint_name(j) for j in range(model.njnt)]
        self.warnings: list[str] = []
        self.found: list[Joint] = []
        self.order: list[str] = []

    def free(self, what: str, wanted: str) -> str:
        """The wanted name of a link or joint, or one like it that nothing else has; it is taken
        from now on.
        """
        while wanted in self.taken[what] or not wanted:
            wanted += "_"
        self.taken[what].add(wanted)
        return wanted

    def _joint_name(self, j: int) -> str:
        body = self.model.jnt_bodyid[j]
        single = self.model.body_jntnum[body] == 1
        return self.free(
            "joint",
            f"{self.links[body]}_joint{'' if single else j - self.model.body_jntadr[body] + 1}",
        )

    def robot(
        self, bodies: np.ndarray, sites: np.ndarray, name: str, source: Source, other: list[str]
    ) -> tuple[Robot, list[str]]:
        """The robot and the warnings."""
        model = self.model
        mimics, constants = self._equalities()
        for i in range(model.nbody):
            if i in self.gone:
                continue
            if i:
                self._body(i, bodies[i], mimics, constants)
            self.order.append(self.links[i])
        for s in range(model.nsite):
            site, body = model.site(s).name, int(model.site_bodyid[s])
            if site and body not in self.gone:
                link = self.free("link", f"{site}_site" if site in self.taken["link"] else site)
                self.order.append(link)
                joint = self.free("joint", f"{link}_fixed")
                self.found.append(Joint(joint, "fixed", self.links[body], link, sites[s]))
        balls = [
            self.names[j] for j in range(model.njnt) if model.jnt_type[j] == BALL and self._here(j)
        ]
        if balls:
            self.warnings.append(
                f"ball joints are floating ones here, which no chain can cross: {join_names(balls)}; Robot.fk takes the"
                " rotation of each as a pose"
            )
        mocap = [self.links[i] for i in range(model.nbody) if model.body_mocapid[i] >= 0]
        if mocap:
            self.warnings.append(
                f"mocap bodies are left out, with all that hangs on them: {join_names(mocap)}"
            )
        if other:
            self.warnings.append(
                f"constraints are left out (a robot here is a tree): {join_names(other)}"
            )
        return Robot(name, self.order, self.found, source), self.warnings

    def _here(self, j: int) -> bool:
        return int(self.model.jnt_bodyid[j]) not in self.gone

    def _body(
        self, i: int, T: np.ndarray, mimics: dict[int, Mimic], constants: dict[int, float]
    ) -> None:
        """The joints from a body's parent to itself.

        With T the body's pose at q = ref, a_j the anchor of joint j and S_j its screw at the
        anchor, it stands at
        T  prod_j  trans(a_j) e^{S_j (q_j - ref_j)} trans(-a_j)  in its parent. A joint's link has
        its origin at a_j.
        """
        model, link = self.model, self.links[i]
        parent = self.links[int(model.body_parentid[i])]
        first, count = int(model.body_jntadr[i]), int(model.body_jntnum[i])
        for j in range(first, first + count):
            number = int(model.jnt_type[j])
            kind = (
                "continuous"
                if KINDS[number] == "revolute" and not model.jnt_limited[j]
                else KINDS[number]
            )
            axis = model.jnt_axis[j].tolist()
            anchor = _anchor(KINDS[number], axis, model.jnt_pos[j])
            ref = float(model.qpos0[model.jnt_qposadr[j]])
            if number == FREE_JOINT:
                T = np.eye(
                    4
                )  # the pose in qpos is that in the world; the body's own is only where it starts
            T = T @ _shift(anchor)
            limits = (
                tuple(model.jnt_range[j].tolist())
                if model.jnt_limited[j]
                else (-math.inf, math.inf)
            )
            if j in constants:
                kind, limits, T = (
                    "fixed",
                    (-math.inf, math.inf),
                    T @ _moved(KINDS[number], axis, constants[j] - ref),
                )
            elif kind != "floating":
                T = T @ _moved(KINDS[number], axis, -ref)
            else:
                axis, limits = (
                    [1.0, 0.0, 0.0],
                    (-math.inf, math.inf),
                )  # as a joint without an axis has
            last = j == first + count - 1 and not anchor.any()
            child = link if last else self.free("link", f"{link}_after_{self.names[j]}")
            if not last:
                self.order.append(child)
            self.found.append(
                Joint(self.names[j], kind, parent, child, T, axis, limits, mimics.get(j))
            )
            parent, T = child, _shift(-anchor)
        if parent != link:
            self.found.append(Joint(self.free("joint", f"{link}_fixed"), "fixed", parent, link, T))

    def _equalities(self) -> tuple[dict[int, Mimic], dict[int, float]]:
        """Mimic joints, and joints that are held at a value: y - y_0 = a_0 + a_1 (x - x_0), 0
        stands for qpos0.
        """
        model = self.model
        mimics: dict[int, Mimic] = {}
        constants: dict[int, float] = {}
        masters: dict[int, int] = {}
        refused: dict[str, list[str]] = {}
        for e in range(model.neq):
            y, x = int(model.eq_obj1id[e]), int(model.eq_obj2id[e])
            if not model.eq_active0[e] or not self._here(y):
                continue
            a = model.eq_data[e, :5].tolist()
            y_0 = float(model.qpos0[model.jnt_qposadr[y]])
            if y in masters or y in constants:
                reason = "of which there is an earlier equality"
            elif x < 0:
                constants[y] = y_0 + a[0]
                continue
            elif any(a[2:]):
                reason = "whose polynomial is not linear"
            elif not self._here(x):
                reason = "that follow one that is left out"
            elif y in _ancestry(masters, x):
                reason = "that follow each other in a circle"
            else:
                masters[y] = x
                x_0 = float(model.qpos0[model.jnt_qposadr[x]])
                mimics[y] = Mimic(self.names[x], a[1], y_0 + a[0] - a[1] * x_0)
                continue
            refused.setdefault(reason, []).append(self.names[y])
        while held := [y for y in mimics if masters[y] in constants]:
            for y in held:  # it follows what does not move
                mimic = mimics.pop(y)
                constants[y] = mimic.multiplier * constants[masters[y]] + mimic.offset
        for reason, names in refused.items():
            self.warnings.append(
                f"equalities are left out for joints {reason}: {join_names(names)}"
            )
        return mimics, constants


def _below_mocap(model: Any) -> set[int]:
    """The mocap bodies and what hangs on them; a body's parent has a smaller number than itself."""
    gone: set[int] = set()
    for i in range(1, model.nbody):
        if model.body_mocapid[i] >= 0 or int(model.body_parentid[i]) in gone:
            gone.add(i)
    return gone


def _ancestry(masters: dict[int, int], joint: int) -> set[int]:
    """A joint, the one that it follows, the one which that follows, ..."""
    line = {joint}
    while joint in masters:
        joint = masters[joint]
        line.add(joint)
    return line


def _anchor(kind: str, axis: list[float], anchor: np.ndarray) -> np.ndarray:
    """Where a joint's frame must have its origin; the body's own where the joint moves it in the
    same way.
    """
    along = kind == "revolute" and not np.cross(axis, anchor).any()
    return np.zeros(3) if kind == "prismatic" or along else anchor


def _shift(by: np.ndarray) -> np.ndarray:
    T = np.eye(4)
    T[:3, 3] = by
    return T


def _moved(kind: str, axis: list[float], x: float) -> np.ndarray:
    """e^{S x} of a joint in its own frame."""
    if not math.isfinite(x):
        raise ModelError(f"ref and equality: expected a finite coordinate, got {x}")
    still = (0.0, 0.0, 0.0)
    w, v = (axis, still) if kind == "revolute" else (still, axis)
    T = np.eye(4)
    T.ravel()[TWELVE] = exponential.joint(w, v, x, math.sin(x), math.cos(x))
    return T
