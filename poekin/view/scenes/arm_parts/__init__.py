"""Parts of the scene of an arm, each drawn from the same description of its geometry."""
