"""Time-optimal parameterization of a path of the coordinates."""
