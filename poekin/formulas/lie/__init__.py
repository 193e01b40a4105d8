"""exp and log on SO(3) and SE(3), the Jacobians of exp, and the numerics that keep them exact."""
