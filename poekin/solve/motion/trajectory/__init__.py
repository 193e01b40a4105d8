"""Trajectories of the coordinates, as robot controllers take them."""
