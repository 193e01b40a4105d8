"""Subproblems with prismatic joints, whose place is a number t on a line in place of a point of the
circle.
"""
