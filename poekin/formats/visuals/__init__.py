"""Looks of a robot as data: shapes that hang on its links, and names of mesh files."""
