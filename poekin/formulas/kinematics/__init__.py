"""Poses and Jacobians of a chain, and their derivatives: the algorithms that `Chain` runs."""
