"""Sweeps of an arm as source text for accelerators."""
