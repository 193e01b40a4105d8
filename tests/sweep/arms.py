"""Arms of sweeps whose workspace is known."""

import numpy as np

import poekin as pk
from poekin.sweep import SweepMap

LIMITS = [[-np.pi, np.pi]] * 2


def two_links(a=0.5, b=0.3):
    """Two parallel axes: the tool reaches the annulus between |a - b| and a + b."""
    home = np.eye(4)
    home[0, 3] = a + b
    axes = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0.0, a)]
    return pk.Chain(np.array(axes), home, frame="space", limits=LIMITS)


def slide():
    """A slide along x and an axis across it."""
    axes = [pk.screw.prismatic([1, 0, 0]), pk.screw.revolute([0, 1, 0], [0, 0, 0.2])]
    return pk.Chain(np.array(axes), np.eye(4), frame="space", limits=[[0, 0.4], [-1, 2]])


def measured(found: SweepMap):
    """The best measures of a map, and the samples that have them."""
    assert found.best is not None
    assert found.attained is not None
    return found.best, found.attained


def bits(found: SweepMap):
    """All that a map with a measure has counted, to the last bit."""
    best, attained = measured(found)
    return found.counts.tobytes(), best.tobytes(), attained.tobytes(), found.outside
