"""Mutation testing: how many planted errors does the suite catch?

`python -m tools.mutate`, or `make mutate`. cosmic-ray's operators say what can be changed, one place at a time; each
change is judged by the project's own tests, in a copy of the tree, without compiled code (NUMBA_DISABLE_JIT), so what
runs is the changed source. Hypothesis draws the same examples for every mutant and does not shrink.
"""
