"""q as tables of names have it, as pandas does: labels are the coordinates' names, or there are
none.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError, UnknownName
from poekin.model.coordinates import one_configuration

ARM = pk.load("ur5e").chain(tip="tool0")
NAMES = ARM.q_names
Q = np.array([0.1, -1.2, 1.4, -0.6, 0.8, 0.3])


class Series:
    """A stand-in for a pandas Series: numbers with an index."""

    def __init__(self, values: Any, index: Any = None):
        self.values = np.asarray(values)
        self._labels = tuple(range(len(self.values))) if index is None else tuple(index)

    @property
    def index(self):
        return self._labels

    def to_numpy(self):
        return self.values

    def __array__(self, dtype=None, copy=None):
        return self.values

    def __len__(self):
        return len(self.values)


class DataFrame(Series):
    """A stand-in for a pandas DataFrame, which has its columns as attributes too."""

    def __init__(self, values: Any, columns: Any = None):
        super().__init__(values)
        self._columns = tuple(range(self.values.shape[1])) if columns is None else tuple(columns)
        for name, column in zip(self._columns, self.values.T, strict=True):
            setattr(self, str(name), Series(column))

    @property
    def columns(self):
        return self._columns


@pytest.mark.parametrize(
    "order", [range(6), [5, 0, 3, 1, 4, 2]], ids=["in order", "in another order"]
)
def test_labels_are_matched_with_the_names_of_the_coordinates(order):
    order = list(order)
    series: Any = Series(Q[order], [NAMES[k] for k in order])
    frame: Any = DataFrame(np.stack([Q, 2 * Q, 3 * Q])[:, order], [NAMES[k] for k in order])
    assert np.array_equal(ARM.fk(series), ARM.fk(Q))
    assert np.array_equal(ARM.fk(frame), ARM.fk(np.stack([Q, 2 * Q, 3 * Q])))
    assert np.array_equal(ARM.jacobian(series, "body"), ARM.jacobian(Q, "body"))
    assert np.array_equal(ARM.compile().fk(series), ARM.compile().fk(Q))
    assert ARM.rezeroed(series) == ARM.rezeroed(Q)


def test_a_table_without_labels_is_an_array_and_a_column_is_the_values_of_one_coordinate():
    series: Any = Series(Q)
    frame: Any = DataFrame([Q, Q])
    assert np.array_equal(ARM.fk(series), ARM.fk(Q))
    assert np.array_equal(ARM.fk(frame), ARM.fk([Q, Q]))
    columns = {name: Series([value, value]) for name, value in zip(NAMES, Q, strict=True)}
    assert np.array_equal(ARM.fk(columns), ARM.fk([Q, Q]))


@pytest.mark.parametrize(
    "q, error, message",
    [
        (Series(Q[::-1], range(5, -1, -1)), UnknownName, r"q: no coordinate '5'; available: "),
        (
            Series(Q, [*NAMES[:5], "wrist_3"]),
            UnknownName,
            r"q: no coordinate 'wrist_3'; did you mean ",
        ),
        (Series(Q[:5], NAMES[:5]), InputError, r"q: no value for 'wrist_3_joint'"),
        (
            Series([*Q, 1.0], [*NAMES, NAMES[2]]),
            InputError,
            r"q: the label 'elbow_joint' appears more than once",
        ),
        (DataFrame([[*Q, 0.0]], [*NAMES, "time"]), UnknownName, r"q: no coordinate 'time'"),
        (
            DataFrame([Q], ["A", "N", "linear", "angular", "homogeneous", "x"]),
            UnknownName,
            r"q: no coordinate 'A'",
        ),
        (Series(Q[:5]), ShapeError, r"q: expected 6 coordinates on the last axis"),
        (
            np.ma.array(Q, mask=Q == 1.4),
            InputError,
            r"q: expected numbers, got a masked array of which some",
        ),
        (
            {**dict(zip(NAMES, Q, strict=True)), NAMES[1]: np.ma.masked},
            InputError,
            r"q\['shoulder_lift_joint'\]: exp",
        ),
    ],
)
def test_labels_and_masks_that_do_not_fit_are_refused(q, error, message):
    with pytest.raises(error, match=message):
        ARM.fk(q)


@pytest.mark.parametrize("q", [[1.0, np.inf, 0.0], [[1.0, 2.0, 0.0]]], ids=["infinite", "a batch"])
def test_one_configuration_is_as_many_finite_numbers_as_there_are_names(q):
    with pytest.raises(InputError) as found:
        one_configuration(q, ("a", "b", "c"))
    assert str(found.value) == f"q: expected one finite configuration (3,), got {q}"
    assert one_configuration({"c": 3, "b": 2, "a": 1}, ("a", "b", "c")).tolist() == [1, 2, 3]
