"""Kinematics as functions of a chain: poses, Jacobians, derivatives, and the compiled chain."""
