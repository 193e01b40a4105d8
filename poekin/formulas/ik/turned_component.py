"""Component of a vector that turns, which is linear in the sine and cosine of its angle.

    w . e^{[k] theta} a = A cos(theta) + B sin(theta) + C

Accuracy: a few u = 2^-53 of |w| |a| (tests/formulas/ik/test_turned_component.py). Source: Rodrigues'
formula, Lemma 1.
"""

from ...algebra import cross, dot


def turned_component(w, k, a):
    """(A, B, C) of w . e^{[k] theta} a = A cos(theta) + B sin(theta) + C."""
    along = dot(w, k) * dot(k, a)
    cosine = dot(w, a) - along
    sine = dot(w, cross(k, a))
    return cosine, sine, along
