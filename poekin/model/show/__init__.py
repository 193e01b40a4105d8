"""Chains and robots as a figure for print and as tables for a notebook."""
