"""Commands that move an arm: fk, jacobian, ik, follow, singularity."""
