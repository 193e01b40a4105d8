"""Several numbers at once, as one scalar of compiled code."""
