"""Measurements: joint readings and what was measured at them."""
