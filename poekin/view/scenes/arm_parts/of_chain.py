"""Geometry of a chain: n + 1 bodies in base coordinates at q = 0, displaced by their joints.

Body k is what joint k moves; its pose on the page is its displacement T_k(q) = f_k(q) f_k(0)^-1.
"""

from __future__ import annotations

import numpy as np

from ....analysis.axis_lines import uncoupled_at_zero
from ....groups import se3
from ....groups.arrays import Array
from ....groups.vectors import translation_part
from ....model.chain import Chain
from ....model.readings.coupled import own_limits
from ...scene import Slider
from .geometry import ArmGeometry, Bone, JointGeometry, LinkFrame


def chain_geometry(chain: Chain) -> ArmGeometry:
    """Geometry of a chain."""
    zero = np.zeros(chain.dof)
    rest = chain.joint_poses(zero)
    back = se3.inverse(rest)
    tool = chain.fk(zero)
    joints = _joints(chain, rest)
    n = len(joints)

    def poses(q: Array) -> Array:
        moved = chain.joint_poses(q) @ back
        return np.concatenate([np.eye(4)[None], moved])

    origins = [np.zeros(3), *translation_part(rest), translation_part(tool)]
    places = np.array(origins)
    frames = [LinkFrame(0, np.eye(4), chain.base, "end")]
    frames += [LinkFrame(k + 1, rest[k], joints[k].name, "link") for k in range(n)]
    return ArmGeometry(
        name=f"{chain.base} → {chain.tip}",
        links=(chain.base, *(joint.name for joint in joints)),
        sliders=_sliders(chain),
        joints=joints,
        bones=tuple(Bone(k, places[k], places[k + 1]) for k in range(n + 1)),
        frames=(*frames, LinkFrame(n, tool, chain.tip, "end")),
        poses=poses,
    )


def _joints(chain: Chain, rest: Array) -> tuple[JointGeometry, ...]:
    """Joints whose axes are given by the z axes of the local frames (n, 4, 4) at q = 0."""
    screws = uncoupled_at_zero(chain).screws
    limits = own_limits(chain).tolist()
    points = translation_part(rest)
    joints = []
    for k, name in enumerate(chain.joint_names):
        direction = rest[k, :3, 2]
        joint = JointGeometry(
            name=name,
            kind=chain.kinds[k],
            parent=k,
            child=k + 1,
            point=points[k],
            direction=direction,
            child_point=points[k],
            child_direction=direction,
            pitch=float(chain.pitches[k]),
            limits=tuple(limits[k]),
            screw=screws[k],
        )
        joints.append(joint)
    return tuple(joints)


def _sliders(chain: Chain) -> tuple[Slider, ...]:
    bounds = chain.limits.tolist()
    return tuple(
        Slider(name, "rad" if chain.is_angle(k) else "m", *bounds[k])
        for k, name in enumerate(chain.q_names)
    )
