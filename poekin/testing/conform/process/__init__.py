"""The process that a subject runs in."""
