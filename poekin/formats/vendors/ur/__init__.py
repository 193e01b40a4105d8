"""DH tables and deltas of Universal Robots' controllers, and factory calibrations out of them."""

from ..naming import JOINTS, LINKS
from .conf import read_deltas
from .tables import add_deltas, from_dh

__all__ = [
    "JOINTS",
    "LINKS",
    "add_deltas",
    "from_dh",
    "read_deltas",
]
