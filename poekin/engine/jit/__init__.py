"""Compilation with Numba: the formulas registered, kernels, their cache, locks and threads."""
