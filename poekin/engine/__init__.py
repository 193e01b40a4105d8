"""What makes the formulas run: compiled (Numba) with a cache of kernels, and counted."""
