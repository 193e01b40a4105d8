"""Inverse kinematics: every solution of a target."""
