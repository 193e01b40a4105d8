"""Geometry of a chain: lines of the axes, link frames, exact geometry, H and P matrices."""
