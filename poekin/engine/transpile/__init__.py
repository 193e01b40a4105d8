"""Formulas as C99: scalar Python over tuples and rows, one C function for each function and types."""
