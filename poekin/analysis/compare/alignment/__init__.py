"""Alignment of two arms' axes."""
