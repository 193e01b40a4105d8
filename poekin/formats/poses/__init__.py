"""Poses as controllers, ROS and spreadsheets write them: arrays of numbers, text and files.

The convention is always named and never guessed: the same three angles are three rotations to KUKA,
Fanuc and Stäubli.
"""

from .layout import PoseFormat, QuaternionOrder
from .numbers import from_numbers, to_numbers
from .read import read
from .write import write

__all__ = ["PoseFormat", "QuaternionOrder", "from_numbers", "read", "to_numbers", "write"]
