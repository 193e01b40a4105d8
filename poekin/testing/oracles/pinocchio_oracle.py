"""Pinocchio as an oracle: poses and Jacobians of a URDF by code that poekin shares nothing with.

Only the text of the URDF goes in. Pinocchio parses it, its `<mimic>` elements are found apart from
that (`pinocchio_urdf`), and everything is addressed by name, so that neither poekin's reader of
robots nor its order of joints can hide an error here. This is the one file of poekin that imports
Pinocchio.
"""

from __future__ import annotations

import functools
import os
import sys
import tempfile
import threading
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any

import numpy as np

from ...errors import InputError, MissingExtra, ModelError, UnknownName, quote, safe_repr, suggest
from ...formats.text import xml
from ...groups.arrays import Array
from ...model.kinematics.pose_jacobian import FRAME_NAMES
from . import pinocchio_urdf

# Pinocchio's rows are (v; omega); poekin's are (omega; v).
ANGULAR_FIRST = [3, 4, 5, 0, 1, 2]


@functools.cache
def pinocchio() -> ModuleType:
    """The module pinocchio, imported when it is first needed.

    Raises: MissingExtra when the package `pin` is not installed.
    """
    try:
        import pinocchio as pin  # pyright: ignore[reportMissingImports]  it lies behind a .pth file
    except ModuleNotFoundError as missing:
        raise MissingExtra("pin", "validate", "validation against Pinocchio") from missing
    return pin


class PinocchioOracle:
    """One URDF in Pinocchio: poses and Jacobians between two links, by named coordinates.

    Pinocchio knows neither encodings nor namespaces: it gets the text decoded, with the elements of
    the root's namespace under their plain names and those of others left out. No mesh is read.

    Coordinates are the moving one-degree joints that mimic no other, by name, in rad or m. The
    model is built with mimic=False: x = C q + c, and J_q = J_x C, are applied here (mimic of mimic
    composes; a mimic of a fixed joint is constant; a mimic of a joint that does not exist leaves
    its joint independent). A continuous joint is one angle, handed to Pinocchio as (cos, sin).
    Floating and planar joints stay at identity.

    Parameters
    ----------
    text : str or bytes
        The URDF itself, bytes in the encoding that it declares.

    Attributes
    ----------
    coordinates : tuple of str
        Names of the coordinates.
    slides : set of str
        Coordinates in m; the others are in rad.
    links : tuple of str
        Names of the links.
    coupling, offset : ndarray
        C (n, m) and c (n,) of x = C q + c.
    simple_joints : dict
        Pinocchio's numbers of the moving one-degree joints, by name.
    version : str
        Version of Pinocchio.

    Raises
    ------
    MissingExtra
        Without Pinocchio.
    ModelError
        For malformed XML, and if Pinocchio refuses the text; with its reasons.
    InputError
        For a path in place of the text.

    Notes
    -----
    Source: Pinocchio, https://github.com/stack-of-tasks/pinocchio, release 4.
    """

    def __init__(self, text: str | bytes) -> None:
        pin = pinocchio()
        if isinstance(text, str) and "<" not in text:
            raise InputError(
                f"text: expected a URDF itself, not where it is: Path(...).read_text(); got {safe_repr(text)}"
            )
        root = pinocchio_urdf.plain(xml.parse(text, "<text>", tell=False))
        content = pinocchio_urdf.text_of(root)
        self.model: Any = _built(lambda: pin.buildModelFromXML(content))
        self.data: Any = self.model.createData()
        self.version: str = pin.__version__
        self.links = tuple(f.name for f in self.model.frames if f.type == pin.FrameType.BODY)
        self.simple_joints = {
            self.model.names[i]: i
            for i in range(1, self.model.njoints)
            if self.model.joints[i].nv == 1
        }
        self.coordinates, self.coupling, self.offset = pinocchio_urdf.coupling_of(
            root,
            tuple(self.simple_joints),
        )
        self.slides = {name for name in self.coordinates if "JointModelP" in self._kind(name)}

    def _kind(self, joint: str) -> str:
        return self.model.joints[self.simple_joints[joint]].shortname()

    def random(self, rng: np.random.Generator, size: int) -> dict[str, Array]:
        """Random configurations: revolute within ±π rad, prismatic within ±1 m, whatever the limits.

        Parameters
        ----------
        rng : numpy.random.Generator
            Source of random numbers.
        size : int
            Number of configurations.

        Returns
        -------
        q : dict
            Values (size,) of each coordinate, rad or m.
        """
        return {
            name: rng.uniform(-1, 1, size) * (1.0 if name in self.slides else np.pi)
            for name in self.coordinates
        }

    def configurations(self, q: Mapping[str, Any]) -> Array:
        """Pinocchio's own configurations for coordinates by name; one that is not named is 0.

        Parameters
        ----------
        q : dict
            A number or N of them for each coordinate, rad or m.

        Returns
        -------
        x : (N, nq) ndarray
            Configurations in Pinocchio's order.

        Raises
        ------
        UnknownName
            For a name that is no coordinate.
        InputError
            For values of different lengths, or no numbers.
        """
        if not isinstance(q, Mapping):
            raise InputError(f"q: expected a dict from coordinate to value(s), got {safe_repr(q)}")
        for name in q:
            if name not in self.coordinates:
                raise UnknownName(
                    f"Pinocchio has no coordinate {quote(name)}; {suggest(name, self.coordinates)}"
                )
        lengths = {np.size(v) for v in q.values()} or {1}
        if len(lengths) > 1:
            raise InputError(
                f"values of one length for every coordinate expected, got lengths {sorted(lengths)}"
            )
        values = np.zeros((lengths.pop(), len(self.coordinates)))
        for name, value in q.items():
            try:
                values[:, self.coordinates.index(name)] = value
            except (TypeError, ValueError) as fault:
                raise InputError(
                    f"q: expected number(s) for {quote(name)}, got {safe_repr(value)}"
                ) from fault
        x = values @ self.coupling.T + self.offset
        result = np.tile(pinocchio().neutral(self.model), (len(values), 1))
        for column, index in enumerate(self.simple_joints.values()):
            joint = self.model.joints[index]
            if joint.nq == 2:  # a continuous joint: a point on the unit circle
                result[:, joint.idx_q] = np.cos(x[:, column])
                result[:, joint.idx_q + 1] = np.sin(x[:, column])
            else:
                result[:, joint.idx_q] = x[:, column]
        return result

    def poses(
        self,
        q: Mapping[str, Any],
        tip: str,
        base: str | None = None,
    ) -> Array:
        """Poses of a link at N configurations.

        Parameters
        ----------
        q : dict
            A number or N of them for each coordinate, rad or m.
        tip : str
            Name of the link.
        base : str, optional
            Link in whose frame the poses are, the root by default.

        Returns
        -------
        T : (N, 4, 4) ndarray
            Poses of tip in base, m.

        Raises
        ------
        UnknownName
            For a name that is no coordinate, or no link.
        InputError
            As `configurations`.
        """
        return self.evaluate(q, tip, base, jacobians=False)[0]

    def link_poses(self, q: Mapping[str, Any]) -> dict[str, Array]:
        """Poses of every link in the frame of the root.

        Parameters
        ----------
        q : dict
            A number or N of them for each coordinate, rad or m.

        Returns
        -------
        poses : dict
            Poses (N, 4, 4) of each link by its name, m.

        Raises
        ------
        UnknownName
            For a name that is no coordinate.
        InputError
            As `configurations`.
        """
        return {link: self.poses(q, link) for link in self.links}

    def evaluate(
        self,
        q: Mapping[str, Any],
        tip: str,
        base: str | None = None,
        *,
        jacobians: bool = True,
    ) -> tuple[Array, dict[Any, Array]]:
        """Poses and Jacobians of a link at N configurations.

        Motion is relative to base, which may itself move in the tree. Space: base axes, the point at
        base's origin; body: tip axes, tip's origin; hybrid: base axes, tip's origin.

        Parameters
        ----------
        q : dict
            A number or N of them for each coordinate, rad or m.
        tip : str
            Name of the link.
        base : str, optional
            Link in whose frame the poses are, the root by default.
        jacobians : bool, default True
            Whether Jacobians are wanted beside the poses.

        Returns
        -------
        T : (N, 4, 4) ndarray
            Poses of tip in base, m.
        J : dict
            Jacobians (N, 6, m) by "space", "body" and "hybrid": rows (ω; v), rad/s and m/s per unit
            rate, columns in the order of `coordinates` (those of joints off the way are zero).

        Raises
        ------
        UnknownName
            For a name that is no coordinate, or no link.
        InputError
            As `configurations`.

        Notes
        -----
        Accuracy: Pinocchio's own rounding; where base is the root link its arrays pass through
        unchanged.
        """
        pin = pinocchio()
        model = self.model
        data = self.data
        tip_id = self.frame_id(tip)
        base_id = None if base is None else self.frame_id(base)
        configurations = self.configurations(q)
        count = len(configurations)
        m = len(self.coordinates)
        T = np.empty((count, 4, 4))
        J = {frame: np.zeros((count, 6, m)) for frame in FRAME_NAMES}
        velocity = [model.joints[i].idx_v for i in self.simple_joints.values()]
        for k, configuration in enumerate(configurations):
            # Without a degree of freedom Pinocchio's getFrameJacobian ends the process: there is
            # nothing to ask for.
            moving = jacobians and model.nv > 0
            if moving:
                pin.computeJointJacobians(model, data, configuration)
            else:
                pin.forwardKinematics(model, data, configuration)
            T_0t = pin.updateFramePlacement(model, data, tip_id).copy()
            T_0b = pin.SE3.Identity()
            if base_id is not None:
                T_0b = pin.updateFramePlacement(model, data, base_id).copy()
            T[k] = T_0t.homogeneous if base_id is None else T_0b.actInv(T_0t).homogeneous
            if moving:
                for frame, value in self._jacobians(tip_id, T_0t, base_id, T_0b).items():
                    J[frame][k] = (value[:, velocity] @ self.coupling)[ANGULAR_FIRST]
        return T, J if jacobians else {}

    def _jacobians(
        self,
        tip_id: int,
        T_0t: Any,
        base_id: int | None,
        T_0b: Any,
    ) -> dict[str, Array]:
        """The three Jacobians in Pinocchio's row order, w.r.t. its own velocities, relative to the
        base frame.
        """
        pin = pinocchio()

        def jacobian(frame: int, reference: Any) -> Array:
            # With one degree of freedom Pinocchio's Python hands out a vector.
            J = pin.getFrameJacobian(self.model, self.data, frame, reference)
            return J.reshape(6, self.model.nv)

        reference = {"space": pin.WORLD, "body": pin.LOCAL, "hybrid": pin.LOCAL_WORLD_ALIGNED}
        result = {name: jacobian(tip_id, r) for name, r in reference.items()}
        if base_id is None:
            return result
        drag = jacobian(base_id, pin.WORLD)
        at_tip = drag.copy()
        at_tip[:3] += np.cross(drag[3:], T_0t.translation, axis=0)
        turn = np.kron(np.eye(2), T_0b.rotation.T)
        return {
            "space": T_0b.toActionMatrixInverse() @ (result["space"] - drag),
            "body": result["body"] - T_0t.toActionMatrixInverse() @ drag,
            "hybrid": turn @ (result["hybrid"] - at_tip),
        }

    def frame_id(self, link: str) -> int:
        """Pinocchio's number of the frame of a link.

        Parameters
        ----------
        link : str
            Name of the link.

        Returns
        -------
        frame : int
            The number.

        Raises
        ------
        UnknownName
            For an unknown link.
        """
        if link not in self.links:
            raise UnknownName(f"Pinocchio has no link {quote(link)}; {suggest(link, self.links)}")
        return self.model.getFrameId(link, pinocchio().FrameType.BODY)


_stderr = threading.Lock()


def _built(build: Callable[[], Any]) -> Any:
    """Object that Pinocchio builds; its reasons for a refusal, which it writes to the process's own
    stderr, are caught.
    """
    if sys.stderr is not None:
        sys.stderr.flush()
    # One at a time: of two that overlap, the second would put the first one's catch in the place of
    # stderr for good.
    with _stderr, tempfile.TemporaryFile() as said:
        try:
            before = os.dup(2)
        except OSError:  # stderr is closed
            before = None
        if before is not None:
            os.dup2(said.fileno(), 2)
        try:
            return build()
        except (ValueError, RuntimeError, IndexError) as refusal:
            said.seek(0)
            lines = said.read().decode(errors="backslashreplace").splitlines()
            reasons = [
                line.partition("Error:")[2].strip() for line in lines if line.startswith("Error:")
            ]
            raise ModelError(
                f"Pinocchio refuses this URDF: {quote('; '.join(reasons) or refusal, 300)}"
            ) from refusal
        finally:
            if before is not None:
                os.dup2(before, 2)
                os.close(before)
