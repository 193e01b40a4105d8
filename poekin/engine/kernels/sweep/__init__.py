"""Kernels of sweeps: what is done for each sample, with nothing written between."""
