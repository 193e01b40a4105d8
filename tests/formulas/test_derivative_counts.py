"""What the derivatives cost, by running them on scalars that count: the figures of their
docstrings.
"""

from __future__ import annotations

import pytest

from poekin.engine.count import Count, counted
from poekin.formulas.kinematics import derivatives

# multiplications and additions for n joints
COSTS = {
    derivatives.running: lambda n: (6 * n, 6 * n - 6),
    derivatives.space_rate: lambda n: (24 * n - 18, 18 * n - 18),
    derivatives.body_rate: lambda n: (24 * n - 18, 18 * n - 18),
    derivatives.hybrid_rate: lambda n: (24 * n - 12, 18 * n - 12),
    derivatives.acceleration: lambda n: (12 * n, 12 * n - 6),
    derivatives.space_hessian: lambda n: (9 * n * (n - 1), 6 * n * (n - 1)),
    derivatives.body_hessian: lambda n: (9 * n * (n - 1), 6 * n * (n - 1)),
    derivatives.hybrid_hessian: lambda n: (6 * n * n, 3 * n * n),
}


@pytest.mark.parametrize("n", [2, 6, 7])
@pytest.mark.parametrize("formula", COSTS, ids=lambda f: f.__name__)
def test_a_derivative_costs_what_it_says(formula, n):
    count = Count()

    def of(*sizes):
        return [of(*sizes[1:]) for _ in range(sizes[0])] if sizes else counted(0.5, count)

    J, rates = of(6, n), of(n)
    if formula is derivatives.acceleration:
        formula(J, of(6, n), rates, of(n), n)
    elif formula.__name__.endswith("hessian"):
        formula(J, n, of(6, n, n))
    else:
        formula(J, rates, n, of(6, n))
    assert (count.multiplications, count.additions) == COSTS[formula](n)
