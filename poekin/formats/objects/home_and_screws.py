"""Modern Robotics: the home pose M and the matrix whose columns are the screws, `Slist` or `Blist`."""

from __future__ import annotations

from typing import Any, get_args

import numpy as np

from ...checks import choice
from ...errors import ShapeError
from ...groups.arrays import Array, numbers
from ...model.chain import Chain
from ...model.chain_data import ScrewFrame

FRAMES: tuple[ScrewFrame, ...] = get_args(ScrewFrame)


def fits(obj: Any) -> bool:
    """Whether an object is a pair, as in (M, Slist)."""
    return isinstance(obj, (tuple, list)) and len(obj) == 2


def make_chain(pair: Any, frame: ScrewFrame) -> Chain:
    """Chain e^{[S_1] q_1} ... e^{[S_n] q_n} M of (M, Slist), or M e^{[B_1] q_1} ... of (M, Blist).

    Parameters: pair (M, Slist): M (4, 4), m; Slist (6, n), a column (omega; v) a joint, as in
    Modern Robotics; frame, that of the columns: "space" (Slist) or "body" (Blist).
    Returns: Chain with joints joint1, joint2, ... without limits.
    Raises: ShapeError, PoseError; ScrewError for a column that is no unit screw, with its number;
    InputError.
    Accuracy: space: as given; body: as `Chain.from_body`. Source: Lynch and Park, Modern Robotics,
    2017, chapter 4.
    """
    choice(
        frame,
        FRAMES,
        "frame",
        "; the screws are in the space frame in Slist, in the body frame in Blist",
    )
    M, screws = pair
    return Chain(_rows(screws, M), M, frame=frame)


def _rows(screws: Any, M: Any) -> Array:
    """Screws as rows (n, 6), from columns (6, n)."""
    columns = numbers(screws, "screws")
    if columns.shape == (6,):
        return columns[None]
    if columns.ndim == 2 and columns.shape[0] == 6:
        return columns.T
    remedy = ""
    if columns.ndim == 2 and columns.shape[1] == 6:
        remedy = ": transpose it"
    elif columns.shape == (4, 4) and np.shape(M)[:1] == (6,):
        remedy = ": the pair is (M, screws), in this order"
    raise ShapeError(
        "screws: expected shape (6, n), a column (omega; v) a joint as in Slist,"
        f" got {columns.shape}{remedy}"
    )
