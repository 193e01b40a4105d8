"""Inverse kinematics of an arm in closed form as source text."""
