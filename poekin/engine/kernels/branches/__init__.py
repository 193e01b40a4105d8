"""Kernels of inverse kinematics in closed form."""
