"""Maps over many configurations or poses: where a tool can be, from which directions, and how well it moves
there.
"""

from .cells import Cells
from .execution.run import run
from .maps.base_placement import BasePlacement, base_placement
from .maps.histogram import MeasureHistogram, histogram
from .maps.reach import reach
from .maps.sweep_map import SweepMap, load_map
from .maps.top import TopSamples, top
from .masks.self_collision import SelfCollision
from .measures.dexterity import InverseCondition, SmallestSingularValue
from .measures.joints import JointTravel, LimitMargin
from .measures.monte_carlo import DrawnErrors, monte_carlo
from .measures.pose_uncertainty import PoseUncertainty
from .pose_samples import PoseGrid, PoseSamples
from .samples import Grid, Random, Sobol
from .sweep import Sweep

__all__ = [
    "BasePlacement",
    "Cells",
    "DrawnErrors",
    "Grid",
    "InverseCondition",
    "JointTravel",
    "LimitMargin",
    "MeasureHistogram",
    "PoseGrid",
    "PoseSamples",
    "PoseUncertainty",
    "Random",
    "SelfCollision",
    "SmallestSingularValue",
    "Sobol",
    "Sweep",
    "SweepMap",
    "TopSamples",
    "base_placement",
    "histogram",
    "load_map",
    "monte_carlo",
    "reach",
    "run",
    "top",
]
