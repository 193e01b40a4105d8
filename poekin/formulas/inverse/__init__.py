"""Inverse kinematics: the error of a pose, and the damped step that makes it smaller."""
