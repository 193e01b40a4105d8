"""Inverse kinematics: one solution of a target."""
