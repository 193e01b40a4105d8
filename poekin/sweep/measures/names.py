"""Measures by their names, and the names in words."""

from __future__ import annotations

from typing import Literal, get_args

from ...checks import choice
from .dexterity import InverseCondition, PoseManipulability, SmallestSingularValue
from .joints import JointTravel, LimitMargin
from .measure import Measure, MeasureLabel, Reach
from .solutions import SolutionCount

MeasureName = Literal[
    "reach",
    "manipulability",
    "inverse_condition",
    "smallest_singular_value",
    "limit_margin",
    "travel",
    "solutions",
]
_MADE: dict[str, Measure] = {
    made.name: made
    for made in (
        Reach(),
        PoseManipulability(),
        InverseCondition(),
        SmallestSingularValue(),
        LimitMargin(),
        JointTravel(),
        SolutionCount(),
    )
}
LABELS = {
    "manipulability": MeasureLabel("manipulability"),
    "inverse_condition": MeasureLabel("inverse condition number"),
    "smallest_singular_value": MeasureLabel("smallest singular value"),
    "limit_margin": MeasureLabel("distance to the joint limits", "% of half the range", 100.0),
    "travel": MeasureLabel("joint travel", "rad or m", sign=-1),
    "travel_time": MeasureLabel("joint travel", "s", sign=-1),
    "solutions": MeasureLabel("number of IK solutions"),
    "position_error": MeasureLabel("standard deviation of the position", "mm", 1e3, -1),
    "orientation_error": MeasureLabel("standard deviation of the orientation", "mrad", 1e3, -1),
    "position_bound": MeasureLabel("worst-case error of the position", "mm", 1e3, -1),
    "orientation_bound": MeasureLabel("worst-case error of the orientation", "mrad", 1e3, -1),
}


def measure_of(measure: Measure | MeasureName) -> Measure:
    """A measure, by its name if need be. Raises: InputError."""
    if isinstance(measure, Measure):
        return measure
    choice(
        measure,
        get_args(MeasureName),
        "measure",
        "; or one of poekin.sweep, such as PoseUncertainty",
    )
    return _MADE[measure]
