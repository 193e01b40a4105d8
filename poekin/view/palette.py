"""Colours of what a node stands for, out of the palette of Okabe and Ito (2008)."""

from __future__ import annotations

from .nodes import Attachment, Role

PALETTE: dict[Role, int] = {
    "first": 0xB4BEC9,
    "second": 0x56B4E9,
    "joint": 0xE69F00,
    "linear": 0x009E73,
    "angular": 0xCC79A7,
    "differs": 0xD55E00,
    "path": 0x0072B2,
    "marked": 0xD55E00,
    "x": 0xD55E00,
    "y": 0x009E73,
    "z": 0x0072B2,
}
"""Colours 0xRRGGBB that the colour-blind can tell apart, on light and on dark; grey for an arm."""


CLOUD = (0x0072B2, 0xE69F00)
"""Colours of the least and the largest value of a cloud, seen on light and on dark."""


def color(attachment: Attachment) -> int:
    """Colour of a node: its own, or its role's."""
    if attachment.color is not None:
        return attachment.color
    return PALETTE[attachment.role]
