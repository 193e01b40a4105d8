"""Names of other libraries, and what does it here: the end of an AttributeError's message."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from typing import NoReturn

_CHAIN_NAMES = {
    'acceleration(q, dq, ddq, frame="hybrid")': "getFrameClassicalAcceleration",
    'analytic_jacobian(q, "rpy")': "jacob0_analytical",
    "body.screws.T": "Blist",
    "dof": "nq nv",
    "fk(q)": (
        "FKinBody FKinSpace calc_fk compute_fk end_effector_transform fkine forward "
        "forwardKinematics forward_kinematics framesForwardKinematics get_fk"
    ),
    'hessian(q, frame="body")': "hessiane",
    'hessian(q, frame="hybrid")': "hessian0",
    "home": "M",
    'jacobian(q, frame="body")': "JacobianBody",
    'jacobian(q, frame="body"), rows (omega; v)': "jacobe",
    'jacobian(q, frame="hybrid"), rows (omega; v)': "jacob0",
    'jacobian(q, frame="space" | "body" | "hybrid")': (
        "calc_jacobian computeFrameJacobian computeJointJacobians compute_jacobian "
        "getFrameJacobian getJointJacobian get_jacobian"
    ),
    'jacobian(q, frame="space")': "JacobianSpace",
    "jacobian_rate(q, dq, frame)": (
        "computeJointJacobiansTimeVariation getFrameJacobianTimeVariation"
    ),
    'jacobian_rate(q, dq, frame="hybrid")': "jacob0_dot",
    "limits": "qlim",
    "pk.ik(chain, T)": (
        "IKinBody IKinSpace calc_ik ik ik_LM ikine ikine_LM inverseKinematics inverse_kinematics"
    ),
    "pk.manipulability(chain, q)": "manipulability",
    "pk.manipulability_gradient(chain, q)": "jacobm",
    "pk.singularity(chain, q)": "singularity",
    "screws.T": "Slist",
    "velocity(q, dq, frame)": "getFrameVelocity",
}
"""Expression with a chain, and its names in other libraries."""

_PACKAGE_NAMES = {
    "fk(q)": "fk",
    'jacobian(q, frame="space" | "body" | "hybrid")': "jacobian",
    "pk.dh.to_chain(table)": "DHRobot",
    "pk.load(path)": "URDF buildModelFromUrdf from_urdf load_urdf read_urdf",
    "pk.screw.helical(axis, point, pitch)": "ScrewToAxis",
    "pk.se3": "SE3",
    "pk.se3.ad(xi)": "ad",
    "pk.se3.adjoint(T)": "Adjoint",
    "pk.se3.exp(xi)": "MatrixExp6",
    "pk.se3.hat(xi)": "VecTose3",
    "pk.se3.inverse(T)": "TransInv",
    "pk.se3.log(T)": "MatrixLog6",
    "pk.se3.pose(R, p)": "RpToTrans",
    "pk.se3.vee(X)": "se3ToVec",
    "pk.so3": "SO3",
    "pk.so3.exp(w)": "MatrixExp3",
    "pk.so3.hat(w)": "VecToso3",
    "pk.so3.log(R)": "MatrixLog3",
    "pk.so3.vee(W)": "so3ToVec",
}
"""Expression with the package, and its names in other libraries."""


def _by_name(table: Mapping[str, str], prefix: str = "") -> dict[str, str]:
    """Expression by name, the prefix before what is no function of the package."""
    return {
        name: here if here.startswith("pk.") else prefix + here
        for here, names in table.items()
        for name in names.split()
    }


OF_CHAINS = _by_name(_CHAIN_NAMES)
OF_ROBOTS = _by_name(_CHAIN_NAMES, "chain(tip=...).")
OF_PACKAGE = _by_name(_CHAIN_NAMES, "Chain.") | _by_name(_PACKAGE_NAMES, "Chain.")


class _PeerName:
    """Attribute that is none: asked for, it says what does it here.

    `__getattr__` would do without these, and make every attribute of a chain slower.
    """

    __slots__ = ("message",)

    def __init__(self, message: str) -> None:
        self.message = message

    def __get__(self, instance: object, owner: type) -> NoReturn:
        raise AttributeError(self.message)


def answer_peer_names(owner: type, peers: Mapping[str, str]) -> None:
    """Make the attributes of a class that have these names say what does it here."""
    for name, here in peers.items():
        message = f"{owner.__name__} has no attribute {name!r}; here it is {here}"
        setattr(owner, name, _PeerName(message))


def no_attribute(
    owner: str,
    name: str,
    peers: Mapping[str, str],
    known: Iterable[str],
) -> AttributeError:
    """The error for a name that is none: with what does it here, or the closest names."""
    message = f"{owner} has no attribute {name!r}"
    if name.startswith("_"):
        return AttributeError(message)
    names = [word for word in known if not word.startswith("_")]
    close = difflib.get_close_matches(name[:60], [*peers, *names], n=1, cutoff=0.75)
    if name in peers:
        message += f"; here it is {peers[name]}"
    elif close:
        message += f"; did you mean {peers.get(close[0], close[0])}?"
    return AttributeError(message)
