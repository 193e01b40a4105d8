"""Small URDF texts, laid out so that a test knows the line of each fault."""

from __future__ import annotations

LIMIT = '<limit lower="-1" upper="1"/>'


def one_joint(
    inside: str = LIMIT, kind: str = "revolute", links: str = '<link name="a"/><link name="b"/>'
) -> str:
    """A robot of one joint, on line 3, and what is inside of it, on line 4."""
    ends = '<parent link="a"/><child link="b"/>'
    return f'<robot name="r">\n{links}\n<joint name="j" type="{kind}">{ends}\n{inside}\n</joint>\n</robot>'


def chain_of(*joints: str) -> str:
    """Continuous joints j0, j1, ... one below the other, each on its own line from 2 on, with
    something inside.
    """
    links = "".join(f'<link name="l{i}"/>' for i in range(len(joints) + 1))
    lines = [
        f'<joint name="j{i}" type="continuous"><parent link="l{i}"/><child link="l{i + 1}"/>{inside}</joint>'
        for i, inside in enumerate(joints)
    ]
    return f"<robot>{links}\n" + "\n".join(lines) + "</robot>"
