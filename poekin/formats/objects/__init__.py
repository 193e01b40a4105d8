"""Models out of the living objects of other libraries, known by their attributes; none of them is
imported.
"""

from .dh_robot import table_of
from .from_object import from_object

__all__ = ["from_object", "table_of"]
