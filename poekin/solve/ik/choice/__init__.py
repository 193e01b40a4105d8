"""Choice among the solutions of a target: the nearest, or the best by an objective."""
