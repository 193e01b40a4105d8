"""Damped least squares with few unknowns: the normal equations and their solution.

    (J^T W J + damping I) x = J^T W e

`J` is six rows of one number an unknown, W diagonal. `free` is 1 for the unknowns that may move
and 0 for those that stay: these have x = 0. Only the lower triangle of H is used.
Accuracy: about u times the condition of H, as of all normal equations
(tests/formulas/inverse/test_least_squares.py).
Source: Levenberg 1944; H = L D L^T without square roots.
"""


def normal_equations(J, e, weights, damping, free, count, H, g):
    """H and g of the equations."""
    for i in range(count):
        total = 0.0 * e[0]
        for r in range(6):
            total += J[r][i] * (weights[r] * e[r])
        g[i] = free[i] * total
        for k in range(i + 1):
            total = 0.0 * e[0]
            for r in range(6):
                total += J[r][i] * (weights[r] * J[r][k])
            H[i][k] = free[i] * free[k] * total
        H[i][i] += damping + (1 - free[i])


def solve(H, g, count):
    """The solution in place of g; H, positive definite, is lost."""
    for j in range(count):
        for i in range(j, count):
            total = H[i][j]
            for k in range(j):
                total -= H[i][k] * (H[j][k] * H[k][k])
            if i > j:
                total = total / H[j][j]
            H[i][j] = total
    for i in range(count):
        for k in range(i):
            g[i] -= H[i][k] * g[k]
    for i in range(count - 1, -1, -1):
        g[i] /= H[i][i]
        for k in range(i + 1, count):
            g[i] -= H[k][i] * g[k]
