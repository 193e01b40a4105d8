"""Calibration from a controller's own forward kinematics: pairs without noise, printed digits."""
