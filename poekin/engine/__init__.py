"""Engine that runs the formulas: compiled (Numba) with a cache of kernels, and counted."""
