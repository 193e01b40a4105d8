"""Distance of a configuration from limits, and from another one, by its worst coordinate."""

from .. import elementary


def travel(q, reference, weights, count):
    """The largest weighted change of a coordinate, max |q_i - r_i| w_i.

    Accuracy: 2 u of it.
    """
    most = 0.0
    for i in range(count):
        step = q[i] - reference[i]
        way = weights[i] * elementary.where_less(step, 0.0, -step, step)
        most = elementary.where_less(most, way, way, most)
    return most


def limit_margin(q, middles, weights, count):
    """Relative distance to the nearest limit, 1 - max |q_i - c_i| w_i: 0 at a limit, 1 where all are
    in the middle; w_i is 1 over half the range, 0 without limits.

    Accuracy: 4 u.
    """
    return 1.0 - travel(q, middles, weights, count)
