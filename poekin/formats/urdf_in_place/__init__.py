"""URDF edited in place: new origins and axes of joints in a user's own text, nothing else."""

from .in_place import edit

__all__ = ["edit"]
