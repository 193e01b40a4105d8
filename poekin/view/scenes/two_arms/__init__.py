"""Two arms in one scene, the second of which can differ more than it does."""
