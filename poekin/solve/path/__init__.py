"""Joints along a path of poses."""
