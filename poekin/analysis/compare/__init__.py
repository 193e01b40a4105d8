"""Comparison of two models of one arm."""
