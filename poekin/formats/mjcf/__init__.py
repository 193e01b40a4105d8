"""MJCF in, Robot out."""
