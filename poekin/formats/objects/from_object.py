"""Models out of objects of other libraries, known by their attributes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...errors import InputError
from ...model.chain import Chain
from ...model.robot import Robot
from ..dh.to_chain import to_chain
from . import dh_robot, ets, home_and_screws, pinocchio_model
from .attributes import type_name
from .home_and_screws import ScrewFrame

# Known objects: in words, the test of their attributes, and the function that makes the model.
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


def from_object(obj: Any, *, frame: ScrewFrame | None = None) -> Any:
    """`Robot` or `Chain` of an object of another library, which is not imported.

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
        if frame is None:
            return home_and_screws.make_chain(obj)
        return home_and_screws.make_chain(obj, frame)
    known = ", ".join(what for what, _, _ in _KNOWN)
    raise InputError(
        f"from_object: expected {known}, or Modern Robotics' pair (M, Slist), got {type_name(obj)}; files are read by"
        f" load, and a chain of your own is made by Chain(screws, home)"
    )
