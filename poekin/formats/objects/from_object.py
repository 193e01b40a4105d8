"""Models out of objects of other libraries, known by their attributes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ...checks import REQUIRED
from ...errors import InputError
from ...model.chain import Chain
from ...model.robot import Robot
from ..dh.table import Table
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


def from_object(obj: Any, *, frame: ScrewFrame = REQUIRED) -> Any:
    """Model of an object of Pinocchio, the Robotics Toolbox or Modern Robotics.

    The other library is not imported: objects are known by their attributes, so anything that has
    the same ones will do. Poses (spatialmath, SciPy, Pinocchio's SE3) need no conversion: each
    function here that takes a pose takes them.

    Parameters
    ----------
    obj : object
        A Pinocchio `Model`, a Robotics Toolbox `DHRobot`, `Robot` (ERobot) or `ETS`, or the pair
        (M, screws) of Modern Robotics: the home pose (4, 4), and screws (omega; v) as columns
        (6, n), rad and m.
    frame : {"space", "body"}, optional
        Frame of the columns of (M, screws), required there: "space" for Slist, the base frame, or
        "body" for Blist, the tool frame. Other objects say it themselves.

    Returns
    -------
    model : Robot or Chain
        A Robot of a Pinocchio `Model` or a toolbox `Robot`, else a Chain.

    Raises
    ------
    InputError
        If nothing known has these attributes, with the type of what arrived; if `frame` is missing,
        unknown, or given for an object that says it itself.
    ModelError, ScrewError, ShapeError, PoseError
        If the object has what a model cannot express or what makes no sense, with the joint.

    Warns
    -----
    PoekinWarning
        For limits that bound nothing.

    Notes
    -----
    Pinocchio: links, joints and their order are those of the URDF that the model was built from;
    where it has none, links are its frames. q is in its order, with one angle where Pinocchio has a
    cosine and a sine. `DHRobot`: by its table (`poekin.formats.objects.make_table`). The toolbox's
    `Robot` and `ETS`: q is in its order, by `jindex`.

    Accuracy: within 1e-13 reach of the library's own pose (tests/formats/test_objects.py and those
    beside it). Source: the libraries' documentation.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> M = np.eye(4)
    >>> M[0, 3] = 2.0
    >>> Slist = np.transpose([[0, 0, 1, 0, 0, 0], [0, 0, 1, 0, -1, 0]])
    >>> arm = pk.from_object((M, Slist), frame="space")
    >>> arm.fk([0.0, np.pi / 2]).round(3)[:2, 3]
    array([1., 1.])
    """
    for what, fits, make in _KNOWN:
        if fits(obj):
            if frame is not REQUIRED:
                raise InputError(f"frame: it is that of a pair (M, screws), and this is {what}")
            return make(obj)
    if home_and_screws.fits(obj):
        return home_and_screws.make_chain(obj, frame)
    if isinstance(obj, (Robot, Chain, Table)):
        raise InputError(
            f"from_object: expected an object of another library, this {type(obj).__name__} is one of"
            " poekin already; of a dh.Table, dh.to_chain(table) is the chain"
        )
    known = ", ".join(what for what, _, _ in _KNOWN)
    raise InputError(
        f"from_object: expected {known}, or Modern Robotics' pair (M, Slist), got {type_name(obj)}; files are read by"
        f" load, and a chain of your own is made by Chain.from_space(screws, home)"
    )
