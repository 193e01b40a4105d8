"""Accuracy of exp, log and the Jacobians of exp: laws, attainable errors, and the search for the
worst case.
"""
