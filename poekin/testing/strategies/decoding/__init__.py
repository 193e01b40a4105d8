"""Numbers read off random bytes."""
