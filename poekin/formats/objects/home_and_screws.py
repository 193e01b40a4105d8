"""Modern Robotics: the home pose M and the matrix whose columns are the screws, `Slist` or `Blist`."""

from __future__ import annotations

from typing import Any, Literal, get_args

import numpy as np

from ...errors import InputError, ShapeError, safe_repr
from ...groups.arrays import numbers
from ...model.chain import Chain

ScrewFrame = Literal["space", "body"]
FRAMES: tuple[ScrewFrame, ...] = get_args(ScrewFrame)


def fits(obj: Any) -> bool:
    """Whether an object is a pair, as in (M, Slist)."""
    return isinstance(obj, (tuple, list)) and len(obj) == 2


def make_chain(pair: Any, frame: ScrewFrame = "space") -> Chain:
    """Chain e^{[S_1] q_1} ... e^{[S_n] q_n} M of (M, Slist), or M e^{[B_1] q_1} ... of (M, Blist).

    Parameters: pair (M, Slist): M (4, 4), m; Slist (6, n), a column (omega; v) a joint, as in
    Modern Robotics; frame, that of the columns: "space" (Slist) or "body" (Blist).
    Returns: Chain with joints joint1, joint2, ... without limits.
    Raises: ShapeError, PoseError; ScrewError for a column that is no unit screw, with its number;
    InputError.
    Accuracy: space: as given; body: as `Chain.rebased`. Source: Lynch and Park, Modern Robotics,
    2017, chapter 4.
    """
    if frame not in FRAMES:
        choices = " or ".join(map(repr, FRAMES))
        raise InputError(f"frame: expected {choices}, got {safe_repr(frame)}")
    M, screws = pair
    columns = numbers(screws, "screws")
    if columns.shape == (6,):
        columns = columns[:, None]
    if columns.ndim != 2 or columns.shape[0] != 6:
        message = (
            "screws: expected shape (6, n), a column (omega; v) a joint as in Slist,"
            f" got {columns.shape}"
        )
        if columns.ndim == 2 and columns.shape[1] == 6:
            message += ": transpose it"
        raise ShapeError(message)
    if frame == "space":
        return Chain(columns.T, M)
    # M e^{B q} = P f(q) with P = M and f(q) = e^{B q}: the tool's frame at home is the base of f.
    return Chain(columns.T, np.eye(4)).rebased(M)
