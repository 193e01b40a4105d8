"""Mistakes in a whole file that a comparison recognises."""
