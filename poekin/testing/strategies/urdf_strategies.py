"""Hypothesis strategies for URDF texts as they are found in the wild: of a robot that is known,
with an oddity or none.

Raises: InputError, at the call, for oddities that there are not and for numbers of joints that are
none.
Source: 1206 URDFs of public collections, in which each of these was met; Pinocchio reads them all.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

from ...formats.urdf_text import to_urdf
from ...model.robot import Robot
from . import arguments
from .group_strategies import st
from .robot_strategies import robots


class OddURDF(NamedTuple):
    """URDF text as it is found in the wild, with the robot that it describes.

    Attributes
    ----------
    text : str
        The URDF.
    oddity : str
        Name of the oddity in it, of `ODDITIES`.
    robot : Robot
        The robot that it describes.
    """

    text: str
    oddity: str
    robot: Robot


def _prolog(text: str, prolog: str) -> str:
    return prolog + re.sub(r"^<\?xml[^>]*\?>\s*", "", text)


def _first_joint(text: str, more: str) -> str:
    """With more inside the first joint."""
    return re.sub(r"(<joint [^>]*>)", lambda found: found[1] + more, text, count=1)


def _longer_axes(text: str) -> str:
    """With axes of length 1.0000005, as rounding leaves them."""

    def longer(found: re.Match[str]) -> str:
        return f'<axis xyz="{" ".join(repr(float(x) * 1.0000005) for x in found[1].split())}"/>'

    return re.sub(r'<axis xyz="([^"]*)"\s*/>', longer, text)


def _mesh(text: str) -> str:
    mesh = '<visual><geometry><mesh filename="package://absent/a%20b.dae"/></geometry></visual>'
    return re.sub(
        r'<link name="([^"]*)"\s*/>',
        lambda found: f'<link name="{found[1]}">{mesh}</link>',
        text,
        count=1,
    )


ODDITIES: dict[str, Callable[[str], str]] = {
    "none": lambda text: text,
    "XML version 0.0": lambda text: _prolog(text, '<?xml version="0.0" ?>\n'),
    "blank line before the prolog": lambda text: _prolog(text, '\n<?xml version="1.0"?>\n'),
    "no prolog": lambda text: _prolog(text, ""),
    "comments and unknown elements": lambda text: _first_joint(
        text,
        "<!-- j --><unknown a='1'><b/></unknown>",
    ),
    "Windows line ends": lambda text: text.replace("\n", "\r\n"),
    "plus signs and exponents": lambda text: re.sub(r'upper="(\d[^"]*)"', r'upper="+\1e+00"', text),
    "more than one space between numbers": lambda text: re.sub(
        r'xyz="(\S+) (\S+) (\S+)"',
        r'xyz=" \1  \2   \3 "',
        text,
    ),
    "single quotes": lambda text: re.sub(r'(type|xyz|rpy)="([^"]*)"', r"\1='\2'", text),
    "axes off unit length": _longer_axes,
    "a mesh that is not there": _mesh,
    "a transmission and a gazebo element": lambda text: text.replace(
        "</robot>",
        '<transmission name="t"><joint name="absent"/></transmission><gazebo reference="absent"/></robot>',
    ),
}
"""What texts may have in them; none changes the robot that is described."""


def odd_urdfs(
    oddities: Sequence[str] = tuple(ODDITIES),
    max_joints: int = 4,
) -> st.SearchStrategy[OddURDF]:
    """URDFs of robots as in `robots`, each with one oddity.

    Parameters
    ----------
    oddities : sequence of str
        Names of oddities, of `ODDITIES`; all by default.
    max_joints : int, default 4
        Largest number of joints.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of `OddURDF`; shrinks to no oddity, and one link.

    Raises
    ------
    InputError
        For oddities or numbers of joints that there are not.
    """
    chosen = arguments.some("oddities", oddities, ODDITIES)
    return st.builds(_odd, st.sampled_from(chosen), robots(max_joints=max_joints))


def _odd(oddity: str, robot: Robot) -> OddURDF:
    return OddURDF(ODDITIES[oddity](to_urdf(robot)), oddity, robot)
