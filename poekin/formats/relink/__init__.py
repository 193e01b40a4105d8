"""Robots with the screws of a chain: where link frames go, and what takes up the rest."""

from .relinked import relinked

__all__ = ["relinked"]
