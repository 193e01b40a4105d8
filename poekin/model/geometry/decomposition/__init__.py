"""Decompositions of an arm that has a closed form: which axes meet or are parallel, which joints are
added to fewer than six, and the array that the kernel reads.
"""
