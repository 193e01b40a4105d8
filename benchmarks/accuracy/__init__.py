"""Worst errors of exp, log and the Jacobians of exp: the search for the cases, and the rows of the report."""
