"""Straight-line programs of one arm: traced, specialised, interpreted, and as machine code."""
