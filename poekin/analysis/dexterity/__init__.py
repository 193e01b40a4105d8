"""Manipulability and singularities."""
