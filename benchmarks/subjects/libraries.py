"""The libraries beside poekin as subjects of `poekin.testing.conform`, each called as its
documentation says.
"""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from poekin import Chain
from poekin.testing.oracles.pinocchio_oracle import ANGULAR_FIRST
from poekin.testing.strategies.group_strategies import pose

from ..peers import links
from ..peers.peer import module
from .text import ByText


@dataclass(frozen=True)
class Arm:
    """What a reader of URDFs read: its coordinates, the pose of the tip in the base, and the
    Jacobian, (omega; v).
    """

    names: Sequence[str]
    fk: Callable[[Any], Any]
    jacobian: Callable[[Any], Any] | None = None


@dataclass(frozen=True)
class Whole:
    """What a reader of URDFs read: its coordinates, and the pose of each link in the root."""

    names: Sequence[str]
    poses: Callable[[Any], Mapping[str, Any]]


class SciPy(ByText):
    """Rotation and RigidTransform."""

    library = "SciPy"


class ModernRobotics(ByText):
    """The book's functions."""

    library = "Modern Robotics"
    jacobian_frame = "space"
    helical = True

    def fk(self, screws: np.ndarray, home: np.ndarray, q: np.ndarray) -> np.ndarray:
        return module("modern_robotics").FKinSpace(home, screws.T, q)

    def jacobian(self, screws: np.ndarray, home: np.ndarray, q: np.ndarray) -> np.ndarray:
        return module("modern_robotics").JacobianSpace(screws.T, q)


class Jaxlie(ByText):
    """In double precision."""

    library = "jaxlie"


class Pinocchio(ByText):
    """Its reader of URDFs as it is called by default: without `mimic`."""

    library = "Pinocchio"
    jacobian_frame = "hybrid"
    options: Mapping[str, bool] = MappingProxyType({})

    def _placed(self, text: str) -> tuple[Any, Any, list[str], Callable[[Any], np.ndarray]]:
        """Model, data, the coordinates, and what places all frames for their values and returns
        Pinocchio's q.
        """
        pin = module("pinocchio")
        model = pin.buildModelFromXML(text, **self.options)
        data = model.createData()
        joints = [
            (name, joint)
            for name, joint in zip(model.names[1:], list(model.joints)[1:], strict=True)
            if joint.nv
        ]

        def place(q: np.ndarray) -> np.ndarray:
            full = pin.neutral(model)
            for value, (_, joint) in zip(q, joints, strict=True):
                # A continuous joint is a point of the unit circle.
                own = [value] if joint.nq == 1 else [np.cos(value), np.sin(value)]
                full[joint.idx_q : joint.idx_q + joint.nq] = own
            pin.framesForwardKinematics(model, data, full)
            return full

        return model, data, [name for name, _ in joints], place

    def read_urdf(self, text: str, base: str, tip: str) -> Arm:
        model, data, names, place = self._placed(text)
        pin, frame = module("pinocchio"), model.getFrameId(tip)

        def fk(q: np.ndarray) -> np.ndarray:
            place(q)
            return data.oMf[frame].homogeneous

        def jacobian(q: np.ndarray) -> np.ndarray:
            J = pin.computeFrameJacobian(model, data, place(q), frame, pin.LOCAL_WORLD_ALIGNED)
            order = [model.joints[model.getJointId(name)].idx_v for name in names]
            return np.reshape(J, (6, model.nv))[np.ix_(ANGULAR_FIRST, order)]

        return Arm(names, fk, jacobian)

    def read_robot(self, text: str) -> Whole:
        model, data, names, place = self._placed(text)

        def poses(q: np.ndarray) -> dict[str, np.ndarray]:
            place(q)
            return {
                frame.name: T.homogeneous for frame, T in zip(model.frames, data.oMf, strict=True)
            }

        return Whole(names, poses)


class PinocchioMimic(Pinocchio):
    """Its reader of URDFs with mimic=True; the rest is judged above."""

    title = "Pinocchio, mimic=True"
    options = MappingProxyType({"mimic": True})

    def __init__(self) -> None:
        super().__init__()
        for name in self.paste:
            delattr(self, name)


class RoboticsToolbox(ByText):
    """spatialmath's functions; poses and Jacobians of elementary transform sequences; URDFs by
    `Robot.URDF`.
    """

    library = "Robotics Toolbox"
    jacobian_frame = "hybrid"

    def _sequence(self, screws: np.ndarray, home: np.ndarray) -> Any:
        rtb = module("roboticstoolbox")
        sequence = rtb.ETS()
        fixed, last = links.z_aligned(Chain.from_space(screws, home))
        for T, turns in fixed:
            sequence = sequence * rtb.ET.SE3(T) * (rtb.ET.Rz() if turns else rtb.ET.tz())
        return sequence * rtb.ET.SE3(last)

    def fk(self, screws: np.ndarray, home: np.ndarray, q: np.ndarray) -> np.ndarray:
        return self._sequence(screws, home).eval(q)

    def jacobian(self, screws: np.ndarray, home: np.ndarray, q: np.ndarray) -> np.ndarray:
        return np.asarray(self._sequence(screws, home).jacob0(q))[ANGULAR_FIRST]

    def _robot(self, text: str) -> tuple[Any, list[str]]:
        # It takes a file only.
        with tempfile.NamedTemporaryFile(
            "w", suffix=".urdf", delete=False, encoding="utf-8"
        ) as file:
            file.write(text)
        try:
            robot = module("roboticstoolbox").Robot.URDF(file.name)
        finally:
            os.unlink(file.name)
        moving = sorted(
            (link for link in robot.links if link.isjoint), key=lambda link: link.jindex
        )
        return robot, [link._joint_name for link in moving]

    def read_urdf(self, text: str, base: str, tip: str) -> Arm:
        robot, names = self._robot(text)
        return Arm(
            names,
            lambda q: robot.fkine(q, end=tip, start=base).A,
            lambda q: np.asarray(robot.jacob0(q, end=tip, start=base))[ANGULAR_FIRST],
        )

    def read_robot(self, text: str) -> Whole:
        robot, names = self._robot(text)
        links = [link.name for link in robot.links if link.parent is not None]
        return Whole(names, lambda q: {link: robot.fkine(q, end=link).A for link in links})


class Pytransform3d(ByText):
    """Its functions of one argument, and its transform manager for URDFs, which has no Jacobian."""

    library = "pytransform3d"

    def read_urdf(self, text: str, base: str, tip: str) -> Arm:
        manager = module("pytransform3d.urdf").UrdfTransformManager(check=False)
        manager.load_urdf(text)
        names = list(manager._joints)

        def fk(q: np.ndarray) -> np.ndarray:
            for name, value in zip(names, q, strict=True):
                manager.set_joint(name, value)
            return manager.get_transform(tip, base)

        return Arm(names, fk)


class Pytransform3dBatches(ByText):
    """Its functions for batches, which have formulas of their own."""

    library, texts = "pytransform3d", "pytransform3d, batches"
    title = texts
    batch = True


class MuJoCo(ByText):
    """Its reader of URDFs, and the kinematics at the head of its simulator."""

    library = "MuJoCo"
    jacobian_frame = "hybrid"
    leaves_out = MappingProxyType(
        dict.fromkeys(
            ("urdf mimic", "urdf mimic across", "robot mimic"),
            "a constraint of its dynamics, which kinematics alone does not solve",
        )
    )

    def _placed(self, text: str) -> tuple[Any, Any, list[str], Callable[[Any], None]]:
        """Model, data, the coordinates, and what places all bodies for their values."""
        mujoco = module("mujoco")
        # It merges links that stand still, and wants every other one to have a mass.
        mass = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
        text = re.sub(
            r'<link name="([^"]*)"/>', lambda found: f'<link name="{found[1]}">{mass}</link>', text
        )
        text = text.replace("><link", '><mujoco><compiler fusestatic="false"/></mujoco><link', 1)
        model = mujoco.MjModel.from_xml_string(text)
        data = mujoco.MjData(model)

        def place(q: np.ndarray) -> None:
            data.qpos[:] = q
            mujoco.mj_kinematics(model, data)

        return model, data, [model.joint(k).name for k in range(model.njnt)], place

    def read_urdf(self, text: str, base: str, tip: str) -> Arm:
        mujoco = module("mujoco")
        model, data, names, place = self._placed(text)
        body = model.body(tip).id
        linear, angular = np.zeros((3, model.nv)), np.zeros((3, model.nv))

        def fk(q: np.ndarray) -> np.ndarray:
            place(q)
            return pose(data.xmat[body].reshape(3, 3), data.xpos[body])

        def jacobian(q: np.ndarray) -> np.ndarray:
            place(q)
            mujoco.mj_comPos(model, data)
            mujoco.mj_jacBody(model, data, linear, angular, body)
            return np.concatenate([angular, linear])

        return Arm(names, fk, jacobian)

    def read_robot(self, text: str) -> Whole:
        model, data, names, place = self._placed(text)
        links = [model.body(k).name for k in range(model.nbody)]

        def poses(q: np.ndarray) -> dict[str, np.ndarray]:
            place(q)
            return {
                link: pose(data.xmat[k].reshape(3, 3), data.xpos[k]) for k, link in enumerate(links)
            }

        return Whole(names, poses)


LIBRARIES: dict[str, Sequence[type[ByText]]] = {
    "pinocchio": (Pinocchio, PinocchioMimic),
    "scipy": (SciPy,),
    "robotics_toolbox": (RoboticsToolbox,),
    "modern_robotics": (ModernRobotics,),
    "mujoco": (MuJoCo,),
    "jaxlie": (Jaxlie,),
    "pytransform3d": (Pytransform3d, Pytransform3dBatches),
}
"""The subjects by the names of the peers."""
