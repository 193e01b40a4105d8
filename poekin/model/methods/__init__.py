"""Methods of `Chain` by topic, each one call of a function of its data."""
