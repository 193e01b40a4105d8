"""Operation counts, by running the algorithms."""
