"""Formulas as functions of arrays: scalar Python, of which both ways of a branch are computed."""
