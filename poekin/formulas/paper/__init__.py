"""Algorithms that the paper's table counts and that no `Chain` runs."""
