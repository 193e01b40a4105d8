"""Names that the vendors' descriptions give to the links and joints of an arm."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

Vendor = Literal["Universal Robots", "UFACTORY", "Flexiv"]
VENDORS: tuple[Vendor, ...] = get_args(Vendor)


@dataclass(frozen=True)
class Naming:
    """Names in a vendor's files and robot description, from the base on.

    Parameters
    ----------
    vendor : {"Universal Robots", "UFACTORY", "Flexiv"}
        Vendor.
    bases : tuple of str
        Links that stand for the base frame, the first of them in robots made here.
    entries : tuple of str
        Names that the calibration's file gives to the origins of the joints.
    links, joints : tuple of str
        Names of the links and joints that they belong to.
    tip : str or None
        Link of the flange, None where the file leaves it out.
    tip_joint : str
        Joint that holds the flange.
    """

    vendor: Vendor
    bases: tuple[str, ...]
    entries: tuple[str, ...]
    links: tuple[str, ...]
    joints: tuple[str, ...]
    tip: str | None
    tip_joint: str

    @property
    def last(self) -> str:
        """The flange, or the last link where the file leaves the flange out."""
        return self.tip or self.links[-1]


LINKS = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")
"""The links of a calibration of Universal Robots, from the base on, as the files call them."""
JOINTS = (
    *("shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint"),
    *("wrist_1_joint", "wrist_2_joint", "wrist_3_joint"),
)
"""The joints that move them, as the driver calls them."""

UR = Naming(
    "Universal Robots",
    ("base", "base_link_inertia"),
    LINKS,
    tuple(f"{link}_link" for link in LINKS),
    JOINTS,
    "tool0",
    "tool0_joint",
)
"""Names of ur_description."""


def ufactory(n: int) -> Naming:
    """Names of xarm_description for an arm of n joints."""
    return _numbered("UFACTORY", "link_base", n, "link_eef", "joint_eef")


def flexiv(n: int, *, flange: bool = True) -> Naming:
    """Names of flexiv_description for an arm of n joints, without the flange where not asked for."""
    tip = None
    if flange:
        tip = "flange"
    return _numbered("Flexiv", "base_link", n, tip, f"link{n}_to_flange")


def _numbered(
    vendor: Vendor,
    base: str,
    n: int,
    tip: str | None,
    tip_joint: str,
) -> Naming:
    joints = tuple(f"joint{i}" for i in range(1, n + 1))
    links = tuple(f"link{i}" for i in range(1, n + 1))
    return Naming(vendor, (base,), joints, links, joints, tip, tip_joint)
