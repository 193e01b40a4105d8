"""Text in, models out: one file a format, and `load`, which finds the text."""

from .load import load

__all__ = ["load"]
