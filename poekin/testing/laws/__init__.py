"""Laws as plain functions that raise `LawViolation` with the error and its bound, and batteries of
them.
"""
