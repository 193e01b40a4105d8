"""SO(3) and SE(3) over arrays: exp, log, adjoints and Jacobians of exp, broadcasting over leading
axes.
"""
