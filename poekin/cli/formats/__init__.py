"""Formats of poses and units of numbers on the command line."""
