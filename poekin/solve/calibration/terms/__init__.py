"""Non-geometric errors of an arm: q_true = q + B(q, conditions) c, linear in the coefficients c."""
