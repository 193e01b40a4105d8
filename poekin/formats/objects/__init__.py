"""Models out of objects of other libraries, known by their attributes; none is imported."""

from .dh_robot import make_table
from .from_object import from_object

__all__ = ["from_object", "make_table"]
