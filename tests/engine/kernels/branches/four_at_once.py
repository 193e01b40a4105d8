"""What takes four numbers at once, as plain Python: a scalar of four numbers is an array."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.engine.kernels.branches import sharpen
from poekin.engine.straight_line.machine_code import LANES
from poekin.model.chain import Chain


class _Row:
    """A row of scalars of four numbers; what is read does not change with the row."""

    def __init__(self, array: np.ndarray):
        self._numbers = array.reshape(-1, LANES)

    def __getitem__(self, k: int) -> np.ndarray:
        return self._numbers[k].copy()

    def __setitem__(self, k: int, value: Any) -> None:
        self._numbers[k] = value


FOUR = SimpleNamespace(
    at_once=lambda: LANES, rows=_Row, table=lambda array: [_Row(row) for row in array]
)


def _run_four(
    chain: Chain, q: np.ndarray, T: np.ndarray, J: np.ndarray, scratch: np.ndarray
) -> None:
    assert len(q) == LANES
    T[:] = chain.fk(q)
    J[:] = chain.jacobian(q, "hybrid")


@contextmanager
def plain() -> Iterator[None]:
    """The code of an arm is a chain here."""
    with pytest.MonkeyPatch.context() as patch, np.errstate(all="ignore"):
        patch.setattr(sharpen, "lanes", FOUR)
        patch.setattr(sharpen, "run_four", _run_four)
        yield
