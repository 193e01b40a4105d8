"""Pages that show an arm: a scene as data, drawn by k3d into one offline page."""

from .page import Page
from .view import view

__all__ = ["Page", "view"]
