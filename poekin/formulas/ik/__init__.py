"""Subproblems of inverse kinematics, and the arms that they solve in closed form.

An angle is held as the point (cosine, sine) of the unit circle throughout: only the joints that are
handed out need an arctangent. Every root comes with a margin, the distance to the double root: of a
margin below zero there is no root, and the point is the nearest to one.
"""
