"""The calibration problem: parameters, errors and their Jacobian."""
