"""Compiled kernels: each runs a formula over the rows of arrays."""
