"""Torques with which gravity moves the joints of an arm, by its screws in the base frame.

`bodies` are rows (mass, x, y, z): what joint i moves and the next one does not, and its centre of mass at
x = 0, both in the base frame; `gravity` is the force on a unit of mass there. Gravity is turned
outward and the first moments are moved inward, each joint by e^{A_i x_i} (Lemma 2), so that every
screw stays where it is at x = 0.
Accuracy: 24 (n + 1) u of |g| sum m (|c| + sum (2 |v_i| + |s_i|)), u = 2^-53, c a centre of mass and s_i
what joint i slides (tests/formulas/statics/test_gravity.py). Source: the principle of virtual work.
"""

from ...algebra import add, angular, cross, dot, linear, rotate, scale, translation, unrotate
from ..lie.exponential import joint


def torques(screws, bodies, x, sines, cosines, gravity, count, forces):
    """Writes tau_i into forces[i][0] (N m, N of a sliding joint): positive where the arm sinks as x_i grows.

    `forces` are `count` rows of three numbers; sines and cosines those of x.
    """
    g = gravity
    for i in range(count):
        forces[i][0] = g[0]
        forces[i][1] = g[1]
        forces[i][2] = g[2]
        g = unrotate(motion(screws[i], x[i], sines[i], cosines[i]), g)
    mass = 0.0
    moment = (0.0, 0.0, 0.0)
    for i in range(count - 1, -1, -1):
        m = bodies[i][0]
        mass = mass + m
        centre = (bodies[i][1], bodies[i][2], bodies[i][3])
        moment = add(moment, scale(m, centre))
        T = motion(screws[i], x[i], sines[i], cosines[i])
        moment = add(rotate(T, moment), scale(mass, translation(T)))
        g = (forces[i][0], forces[i][1], forces[i][2])
        turning = dot(angular(screws[i]), cross(moment, g))
        sliding = mass * dot(linear(screws[i]), g)
        forces[i][0] = turning + sliding


def motion(screw, x, sine, cosine):
    """e^{A x} of a screw."""
    return joint(angular(screw), linear(screw), x, sine, cosine)
