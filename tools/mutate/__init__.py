"""Mutation testing: how many planted errors does the suite catch?

`python -m tools.mutate`, or `make mutate`. cosmic-ray's operators, and three of our own for
messages, say what can be changed, one place at a time; each change is judged by the project's own
tests, in a copy of the tree. What runs is the changed source: without compiled code where that can
be, else compiled from it (`suites.Mode`, `kernels`). Hypothesis draws the same examples for every
mutant and does not shrink.
"""
