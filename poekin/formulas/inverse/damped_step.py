"""Step of inverse kinematics by damped least squares, scaled by the error itself.

    (J^T W J + lambda I) dq = J^T W e,   lambda = 0.1 E,   E = e^T W e / 2

`J` is the hybrid Jacobian, six rows of one number a coordinate, e the error of `pose_error` and W
the diagonal of `weights`. Far from the target the step is careful, near it Newton's. `free` is 1
for a coordinate that may move and 0 for one that stays.
Accuracy: that of `least_squares` (tests/formulas/inverse/test_damped_step.py).
Source: Chan and Lawrence, "General inverse kinematics with the error damped pseudoinverse", ICRA
1988; Sugihara, "Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt method", IEEE
Transactions on Robotics 27, 2011, whose constant bias of the damping is left out.
"""

from . import least_squares

_DAMPING = 0.1  # by trial: fewest steps over Panda, UR5 and Puma 560, within limits
_REGULAR = 1e-14  # of the largest: some ten times the rounding


def half_square(e, weights):
    """E = e^T W e / 2."""
    total = 0.0
    for r in range(6):
        total += 0.5 * weights[r] * e[r] * e[r]
    return total


def descent(J, e, weights, i):
    """J_i^T W e, which is -dE/dq_i: positive where a larger q_i makes the error smaller."""
    total = 0.0
    for r in range(6):
        total += J[r][i] * weights[r] * e[r]
    return total


def is_blocked(q, low, high, direction):
    """Whether a coordinate is at a limit and its direction of descent leads out."""
    return (q <= low and direction < 0.0) or (q >= high and direction > 0.0)


def step(J, e, weights, E, free, count, H, dq):
    """Writes the step into dq; H, count rows of count numbers, is scratch."""
    damping = _DAMPING * E
    least_squares.normal_equations(J, e, weights, damping, free, count, H, dq)
    ease_slides(J, weights, damping, free, count, H)
    keep_regular(free, count, H)
    least_squares.solve(H, dq, count)


def ease_slides(J, weights, damping, free, count, H):
    """Limits the damping of a prismatic coordinate to its column's own size, or to 1.

    Care is for turns, whose columns change on the way: over many metres a slide would hardly move.
    """
    for i in range(count):
        slides = J[0][i] == 0.0 and J[1][i] == 0.0 and J[2][i] == 0.0
        if damping > 1.0 and free[i] != 0.0 and slides:
            own = 0.0
            for r in range(3, 6):
                own += weights[r] * J[r][i] * J[r][i]
            H[i][i] -= max(damping - max(own, 1.0), 0.0)


def keep_regular(free, count, H):
    """Adds some ten times its rounding to the diagonal: with more joints than the task needs,
    J^T W J is singular.
    """
    top = 0.0
    for i in range(count):
        top = max(top, free[i] * H[i][i])
    for i in range(count):
        H[i][i] += _REGULAR * top
