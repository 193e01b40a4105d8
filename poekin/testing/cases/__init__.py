"""Robots to test on, and changes planted in them."""
