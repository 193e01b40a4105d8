"""Scenes of what poekin knows: arms, comparisons, paths, solutions, calibrations."""
