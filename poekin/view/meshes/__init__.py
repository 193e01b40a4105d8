"""Meshes of a robot: found, read and reduced to triangles."""
