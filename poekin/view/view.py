"""`view`: the page of a model or of a result."""

from __future__ import annotations

from typing import Any

from ..errors import InputError, safe_repr
from ..model.chain import Chain
from ..model.robot import Robot
from .page import Page, page
from .scenes.arm import arm_scene


def view(model: Robot | Chain, **options: Any) -> Page:
    """Page in which a robot or a chain moves.

    Parameters
    ----------
    model : Robot or Chain
        What to show.
    **options
        See `poekin.view.scenes.arm.arm_scene`.

    Returns
    -------
    page : Page
        Shows itself in a notebook; `save` writes it to a file.

    Raises
    ------
    InputError
        If it is neither a robot nor a chain.
    MissingExtra
        If k3d is not installed.
    """
    if not isinstance(model, Robot | Chain):
        raise InputError(f"view: expected a Robot or a Chain, got {safe_repr(model)}")
    return page(arm_scene(model, **options))
