"""from_object: a model out of a living object of another library, known by its attributes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...errors import InputError
from ...model.chain import Chain
from ...model.robot import Robot
from ..dh.to_chain import to_chain
from . import dh_robot, ets, home_and_screws, pinocchio_model
from .attributes import type_name

# What is known: in words, by which attributes, and what is made of it.
_KNOWN: tuple[tuple[str, Callable[[Any], bool], Callable[[Any], Robot | Chain]], ...] = (
    ("a Pinocchio Model", pinocchio_model.fits, pinocchio_model.make_robot),
    (
        "a Robotics Toolbox DHRobot",
        dh_robot.fits,
        lambda robot: to_chain(dh_robot.make_table(robot)),
    ),
    ("a Robotics Toolbox Robot (ERobot)", ets.fits_tree, ets.make_robot),
    ("a Robotics Toolbox ETS", ets.fits, ets.make_chain),
)


def from_object(obj: Any, *, frame: str | None = None) -> Any:
    """A `Robot` or a `Chain` of what another library holds in memory; that library is not imported,
    nor asked to move.

    - Pinocchio `Model`: a Robot. Links, joints and their order are those of the URDF it was built
      from; where it has none, links are its frames. q is in its order, with one angle where
      Pinocchio has a cosine and a sine.
    - Robotics Toolbox `DHRobot`: a Chain, by its table (`poekin.formats.objects.make_table`). `Robot`
      (ERobot): a Robot. `ETS`: a Chain. q is in the toolbox's order, by `jindex`.
    - Modern Robotics: `from_object((M, Slist))`, a Chain, screws as columns (6, n); with
      frame="body" (M, Blist).

    Objects are known by their attributes, so anything that has the same ones will do. Poses
    (spatialmath, SciPy, Pinocchio's SE3) need no conversion: each function here that takes a pose
    takes them.

    Parameters: obj; frame, of the columns of (M, screws): "space" (the default) or "body".
    Returns: Robot or Chain. Raises: InputError that names the type of what arrived and what is
    known; ModelError, ScrewError, ShapeError, PoseError with the joint for what cannot be expressed
    or makes no sense.
    Warns: PoekinWarning for limits that bound nothing.
    Accuracy: within 1e-13 reach of the library's own pose (tests/formats/test_objects.py and those
    beside it).
    Source: the libraries' documentation.
    """
    for what, fits, make in _KNOWN:
        if fits(obj):
            if frame is not None:
                raise InputError(f"frame: it is that of a pair (M, screws), and this is {what}")
            return make(obj)
    if home_and_screws.fits(obj):
        return home_and_screws.make_chain(obj, "space" if frame is None else frame)
    known = ", ".join(what for what, _, _ in _KNOWN)
    raise InputError(
        f"from_object: expected {known}, or Modern Robotics' pair (M, Slist), got {type_name(obj)}; files are read by"
        f" load, and a chain of your own is made by Chain(screws, home)"
    )
