"""Four numbers at once: a scalar of compiled code in which a formula runs for all of them together.

A formula that chooses by `elementary.where_less` instead of branching takes such a scalar, and rows
of such scalars, as it takes numbers and rows of numbers. Plain Python takes one at once.
"""


def at_once():
    """Number of numbers that a scalar of `rows` holds."""
    return 1


def rows(array):
    """An array (n,) of numbers as n / `at_once()` scalars."""
    return array


def table(array):
    """An array (r, n) of numbers as r rows of n / `at_once()` scalars."""
    return array
