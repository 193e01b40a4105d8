"""Robots out of compiled models of MuJoCo: bodies, joints, sites and joint equalities."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ...errors import ModelError, join_names
from ...formulas.lie import exponential
from ...groups import se3
from ...groups.arrays import Array
from ...model.joint import Joint, JointKind, Mimic
from ...model.provenance import Source
from ...model.robot import Robot
from ...model.tree.link_masses import TWELVE, LinkMass
from ..common.limits import UNBOUNDED, known_effort, known_loss
from ..common.names import free_name

# By the number that MuJoCo gives to a joint's type (mjtJoint).
KINDS: tuple[JointKind, ...] = ("floating", "floating", "prismatic", "revolute")
OF_GIVEN_MASS = 2.0
"""Moments of inertia (kg m^2) by which a body's mass is known to be its own."""
FREE_JOINT = 0
BALL = 1


class _Motion(NamedTuple):
    """Motion of a joint: kind, axis, limits, and e^{-S ref}, None for a floating one."""

    kind: JointKind
    axis: list[float]
    limits: tuple[float, ...]
    at_zero: Array | None


class ModelReader:
    """Reader of an mjModel: the names of its parts, all different, and its joints one by one."""

    def __init__(self, model: Any) -> None:
        self.model = model
        self.gone = _below_mocap(model)
        named = [model.body(i).name for i in range(model.nbody)]
        called = [model.joint(j).name for j in range(model.njnt)]
        self.taken = {"link": set(named), "joint": set(called)}
        self.links = [given or self.free("link", f"body{i}") for i, given in enumerate(named)]
        self.names = [given or self._joint_name(j) for j, given in enumerate(called)]
        self.warnings: list[str] = []
        self.found: list[Joint] = []
        self.order: list[str] = []

    def free(self, what: str, wanted: str) -> str:
        """Name for a link or joint, the wanted one or one like it; it is taken from now on."""
        return free_name(wanted or "_", self.taken[what])

    def _joint_name(self, j: int) -> str:
        body = self.model.jnt_bodyid[j]
        name = f"{self.links[body]}_joint"
        if self.model.body_jntnum[body] > 1:
            name += str(j - self.model.body_jntadr[body] + 1)
        return self.free("joint", name)

    def robot(
        self,
        bodies: np.ndarray,
        sites: np.ndarray,
        name: str,
        source: Source,
        other: list[str],
    ) -> tuple[Robot, list[str]]:
        """Robot of the model, and the warnings.

        Parameters: bodies, sites, the poses (N, 4, 4) [m] of each in its parent body's frame; name
        of the robot; source; other, what constraints the model had that are no joint equalities.
        Raises: what `Joint` and `Robot` raise.
        """
        model = self.model
        mimics, constants = self._equalities()
        for i in range(model.nbody):
            if i in self.gone:
                continue
            if i:
                self._body(i, bodies[i], mimics, constants)
            self.order.append(self.links[i])
        for s in range(model.nsite):
            site = model.site(s).name
            body = int(model.site_bodyid[s])
            if site and body not in self.gone:
                self._site(site, self.links[body], sites[s])
        here = filter(self._here, range(model.njnt))
        balls = [self.names[j] for j in here if model.jnt_type[j] == BALL]
        if balls:
            self.warnings.append(
                f"ball joints are floating ones here, which no chain can cross: {join_names(balls)}; Robot.fk takes the"
                " rotation of each as a pose"
            )
        mocap = [self.links[i] for i in range(model.nbody) if model.body_mocapid[i] >= 0]
        left_out = {
            "mocap bodies are left out, with all that hangs on them": mocap,
            "constraints are left out (a robot here is a tree)": other,
        }
        self.warnings += [
            f"{text}: {join_names(names)}" for text, names in left_out.items() if names
        ]
        masses = [self._mass(i) for i in range(model.nbody) if self._has_mass(i)]
        return Robot(name, self.order, self.found, source, masses=masses), self.warnings

    def _has_mass(self, i: int) -> bool:
        return i not in self.gone and self.model.body_inertia[i, 0] == OF_GIVEN_MASS

    def _mass(self, i: int) -> LinkMass:
        x, y, z = self.model.body_ipos[i].tolist()
        return LinkMass(self.links[i], float(self.model.body_mass[i]), (x, y, z))

    def _site(
        self,
        site: str,
        parent: str,
        T: np.ndarray,
    ) -> None:
        """The link of a site, fixed to that of its body."""
        wanted = site
        if site in self.taken["link"]:
            wanted = f"{site}_site"
        link = self.free("link", wanted)
        self.order.append(link)
        self._fix(parent, link, T)

    def _fix(
        self,
        parent: str,
        link: str,
        T: np.ndarray,
    ) -> None:
        """The fixed joint from a link to another one."""
        name = self.free("joint", f"{link}_fixed")
        self.found.append(Joint(name, "fixed", parent, link, T))

    def _here(self, j: int) -> bool:
        return int(self.model.jnt_bodyid[j]) not in self.gone

    def _body(
        self,
        i: int,
        T: np.ndarray,
        mimics: dict[int, Mimic],
        constants: dict[int, float],
    ) -> None:
        """The joints from a body's parent to itself.

        With T the body's pose at q = ref, a_j the anchor of joint j and S_j its screw at the
        anchor, it stands at
        T  prod_j  trans(a_j) e^{S_j (q_j - ref_j)} trans(-a_j)  in its parent. A joint's link has
        its origin at a_j.
        """
        model = self.model
        link = self.links[i]
        parent = self.links[int(model.body_parentid[i])]
        first = int(model.body_jntadr[i])
        behind = first + int(model.body_jntnum[i])
        for j in range(first, behind):
            if model.jnt_type[j] == FREE_JOINT:  # its pose is in the world
                T = np.eye(4)
            motion = self._motion(j, constants)
            kind = KINDS[model.jnt_type[j]]
            anchor = _anchor(kind, model.jnt_axis[j], model.jnt_pos[j])
            T = T @ _shift(anchor)
            if motion.at_zero is not None:
                T = T @ motion.at_zero
            child = link
            if j < behind - 1 or anchor.any():
                child = self.free("link", f"{link}_after_{self.names[j]}")
                self.order.append(child)
            mimic = mimics.get(j)
            name = self.names[j]
            self.found.append(
                Joint(
                    name,
                    motion.kind,
                    parent,
                    child,
                    T,
                    motion.axis,
                    motion.limits,
                    mimic,
                    **self._drive(j, motion.kind),
                )
            )
            parent = child
            T = _shift(-anchor)
        if parent != link:
            self._fix(parent, link, T)

    def _motion(self, j: int, constants: dict[int, float]) -> _Motion:
        model = self.model
        kind = KINDS[model.jnt_type[j]]
        axis = model.jnt_axis[j].tolist()
        ref = self._at_home(j)
        if j in constants:
            held = _moved(kind, axis, constants[j] - ref)
            return _Motion("fixed", axis, UNBOUNDED, held)
        if kind == "floating":
            return _Motion(kind, [1.0, 0.0, 0.0], UNBOUNDED, None)
        at_zero = _moved(kind, axis, -ref)
        if model.jnt_limited[j]:
            limits = tuple(model.jnt_range[j].tolist())
            return _Motion(kind, axis, limits, at_zero)
        if kind == "revolute":
            kind = "continuous"
        return _Motion(kind, axis, UNBOUNDED, at_zero)

    def _drive(self, j: int, kind: JointKind) -> dict[str, Any]:
        """Damping, friction and effort of a joint; MJCF has no velocity limits.

        The effort is the range of the force of all actuators on the joint, where that is the same
        both ways.
        """
        model = self.model
        if kind == "fixed":
            return {}
        k = int(model.jnt_dofadr[j])
        drive = {
            "damping": known_loss(float(model.dof_damping[k])),
            "friction": known_loss(float(model.dof_frictionloss[k])),
        }
        lower, upper = model.jnt_actfrcrange[j].tolist()
        if model.jnt_actfrclimited[j] and lower == -upper:
            drive["effort"] = known_effort(upper)
        return drive

    def _equalities(self) -> tuple[dict[int, Mimic], dict[int, float]]:
        """Mimic joints and joints held at a value: y - y_0 = a_0 + a_1 (x - x_0), q_0 = qpos0."""
        model = self.model
        mimics: dict[int, Mimic] = {}
        constants: dict[int, float] = {}
        masters: dict[int, int] = {}
        refused: dict[str, list[str]] = {}
        for e in range(model.neq):
            y = int(model.eq_obj1id[e])
            x = int(model.eq_obj2id[e])
            if not model.eq_active0[e] or not self._here(y):
                continue
            a = model.eq_data[e, :5].tolist()
            y_0 = self._at_home(y)
            reason = ""
            if y in masters or y in constants:
                reason = "of which there is an earlier equality"
            elif x < 0:
                constants[y] = y_0 + a[0]
            else:
                reason = self._refusal(y, x, a, masters)
                if not reason:
                    masters[y] = x
                    offset = y_0 + a[0] - a[1] * self._at_home(x)
                    mimics[y] = Mimic(self.names[x], a[1], offset)
            if reason:
                refused.setdefault(reason, []).append(self.names[y])
        while held := [y for y in mimics if masters[y] in constants]:
            for y in held:  # it follows what does not move
                mimic = mimics.pop(y)
                followed = constants[masters[y]]
                constants[y] = mimic.multiplier * followed + mimic.offset
        self.warnings += [
            f"equalities are left out for joints {reason}: {join_names(names)}"
            for reason, names in refused.items()
        ]
        return mimics, constants

    def _at_home(self, j: int) -> float:
        """Coordinate of joint j in MuJoCo's reference configuration qpos0."""
        return float(self.model.qpos0[self.model.jnt_qposadr[j]])

    def _refusal(
        self,
        y: int,
        x: int,
        a: list[float],
        masters: dict[int, int],
    ) -> str:
        """Reason why joint y cannot mimic joint x by the polynomial a; none where it can."""
        if any(a[2:]):
            return "whose polynomial is not linear"
        if not self._here(x):
            return "that follow one that is left out"
        if y in _ancestry(masters, x):
            return "that follow each other in a circle"
        return ""


def _below_mocap(model: Any) -> set[int]:
    """The mocap bodies and what hangs on them; a body's parent has a smaller number than itself."""
    gone: set[int] = set()
    for i in range(1, model.nbody):
        if model.body_mocapid[i] >= 0 or int(model.body_parentid[i]) in gone:
            gone.add(i)
    return gone


def _ancestry(
    masters: dict[int, int],
    joint: int,
) -> set[int]:
    """Joint, its master, the master's own master, and so on."""
    line = {joint}
    while joint in masters:
        joint = masters[joint]
        line.add(joint)
    return line


def _anchor(kind: str, axis: Array, anchor: Array) -> Array:
    """Origin of a joint's frame; the body's own where the joint moves it in the same way."""
    on_axis = kind == "revolute" and not np.cross(axis, anchor).any()
    if kind == "prismatic" or on_axis:
        return np.zeros(3)
    return anchor


def _shift(by: Array) -> Array:
    return se3.pose(np.eye(3), by)


def _moved(kind: str, axis: list[float], x: float) -> Array:
    """Pose e^{S x} of a joint in its own frame."""
    if not math.isfinite(x):
        raise ModelError(f"ref and equality: expected a finite coordinate, got {x}")
    still = (0.0, 0.0, 0.0)
    w, v = (axis, still) if kind == "revolute" else (still, axis)
    T = np.eye(4)
    turn = math.sin(x), math.cos(x)
    T.ravel()[TWELVE] = exponential.joint(w, v, x, *turn)
    return T
