"""What a chain is made of: names in an order, one pose, finite numbers; and messages no longer than
they need to be.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from poekin.errors import InputError, PoseError, ShapeError
from poekin.model import checks
from poekin.model.checks import LONGEST, distinct_names, finite, frame_name, one_pose, ordered_names
from poekin.model.coordinates import coordinates
from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.strategies.group_strategies import noisy_rotations, vectors

MANY = tuple(f"coordinate_{i}" for i in range(1000))


@pytest.mark.parametrize("names", [["b", "a"], ("b", "a"), np.array(["b", "a"])])
def test_names_keep_their_order(names):
    assert distinct_names(names, 2, "names", "q") == ("b", "a")
    assert all(type(name) is str for name in ordered_names(names, "names"))


def test_without_names_they_are_numbered():
    assert distinct_names(None, 2, "names", "q") == ("q1", "q2")
    assert ordered_names(None, "names") == ()


@pytest.mark.parametrize(
    "names, message",
    [
        ({"a", "b"}, "^names: expected a list of names"),
        ("ab", "^names: expected a list of names, got 'ab'"),
        (5, "^names: expected a list of names, got 5"),
        ((name for name in "ab"), "^names: expected a list of names"),
        (np.array("ab"), "^names: expected a list of names"),
        (["a", ""], r"names\[1\]: expected a name, a string that is not empty, got ''"),
        (["a", None], r"names\[1\]: .* got None"),
        ([1, "1"], r"names\[0\]: .* got 1"),
        ([b"a", "b"], r"names\[0\]: .* got b'a'"),
        (["a", "a"], "^names: 'a' appears more than once"),
    ],
)
def test_what_are_no_names_is_refused(names, message):
    with pytest.raises(InputError, match=message):
        distinct_names(names, 2, "names", "q")


@pytest.mark.parametrize("name", ["", None, 7, ["a"]])
def test_a_frame_needs_a_name(name):
    with pytest.raises(InputError, match="tip: expected a name, a string that is not empty, got "):
        frame_name(name, "tip")
    assert frame_name(np.str_("hand"), "tip") == "hand"


@given(R=noisy_rotations(), t=vectors())
def test_a_pose_made_exact_is_kept(R, t):
    """To the last bit where its rotation misses by 4e-15 at most; else that is put right by no more
    than it misses.

    The factors of the singular value decomposition, and their product, are off by 16 u.
    """
    T = np.block([[R, t[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])
    once, missed = one_pose(T), np.abs(R @ R.T - np.eye(3)).sum()
    np.testing.assert_array_equal(once[:, 3], T[:, 3])
    assert np.abs(once - T).max() <= (missed + 16 * UNIT if missed > 2e-15 else 0.0)
    np.testing.assert_array_equal(one_pose(once), once)


@pytest.mark.parametrize(
    "T, error, message",
    [
        (
            np.diag([1, 1, np.nan, 1]),
            PoseError,
            "P: expected finite numbers, row 2 is [0.0, 0.0, nan, 0.0]",
        ),
        (
            np.diag([1, 1, 1.1, 1]),
            PoseError,
            "P is no pose: its rotation misses orthonormality, max abs(R R^T - I) = 0.21, accepted up to 1e-05",
        ),
        (
            np.diag([1, 1, 1e200, 1]),
            PoseError,
            "P is no pose: its rotation misses orthonormality, max abs(R R^T - I) = inf, accepted up to 1e-05",
        ),
        (
            np.diag([1, 1, -1, 1]),
            PoseError,
            "P is no pose: its rotation is a reflection, det R = -1, expected 1",
        ),
        (
            np.diag([1, 1, 1, 2]),
            PoseError,
            "P is no pose: its last row is [0.0, 0.0, 0.0, 2.0], expected [0, 0, 0, 1]",
        ),
        (
            np.diag([1, 1, 1, 0]) + np.outer([0, 0, 0, 1], [1, 1, 1, 2]),
            PoseError,
            "P is no pose: its last row is [1.0, 1.0, 1.0, 2.0], expected [0, 0, 0, 1]",
        ),
        (
            np.zeros((4, 4)),
            PoseError,
            "P is no pose: its last row is [0.0, 0.0, 0.0, 0.0], expected [0, 0, 0, 1]",
        ),
        (np.zeros((2, 4, 4)), ShapeError, "P: expected one pose (4, 4), got shape (2, 4, 4)"),
    ],
)
def test_what_is_no_pose_is_refused(T, error, message):
    with pytest.raises(error) as caught:
        one_pose(T, "P")
    assert str(caught.value) == message


@pytest.mark.parametrize("length", [1e101, -1e155, 1e308])
def test_a_place_out_of_all_reach_is_refused(length):
    T = np.eye(4)
    T[1, 3] = length
    with pytest.raises(
        InputError, match=r"P: expected lengths of at most 1e\+100 m, got .* in row 1"
    ):
        one_pose(T, "P")
    T[1, 3] = LONGEST
    assert one_pose(T)[1, 3] == LONGEST


def test_no_zero_keeps_a_sign():
    assert not np.signbit(finite([-0.0, 0.0], "C")).any()


def test_of_many_numbers_the_first_that_is_not_finite_is_named():
    values = np.zeros((1000, 1000))
    values[3, 5], values[700, 2] = np.inf, np.nan
    with pytest.raises(InputError, match=r"^C\[3, 5\]: expected a finite number, got inf$"):
        finite(values, "C")
    with pytest.raises(InputError, match=r"^c: expected a finite number, got nan$"):
        finite(np.nan, "c")


def test_messages_do_not_grow_with_the_data():
    with pytest.raises(
        ShapeError, match=r"expected 1000 coordinates .*'coordinate_11' and 988 more\)"
    ) as caught:
        coordinates([0.0], MANY)
    assert len(str(caught.value)) < 400
    with pytest.raises(InputError, match=r"no value for 'coordinate_1', .* and 987 more") as caught:
        coordinates({MANY[0]: 0.0}, MANY)
    assert len(str(caught.value)) < 400
    with pytest.raises(ShapeError, match=r"broadcast: \(2,\), \(3,\), \(\)$"):
        coordinates(dict.fromkeys(MANY, 0.0) | {MANY[0]: [0, 0], MANY[1]: [0, 0, 0]}, MANY)
    with pytest.raises(ShapeError, match=r"expected 3 names, got 1000: .* and 988 more") as caught:
        distinct_names(MANY, 3, "names", "q")
    assert len(str(caught.value)) < 400


def test_a_dozen_coordinates_are_all_named():
    with pytest.raises(ShapeError, match=r"'coordinate_0', .*'coordinate_11'\), got"):
        coordinates([0.0], MANY[:12])


INF = np.inf


def test_limits_are_kept_as_they_are_given():
    given = [[-1, -1], [-INF, INF], [-INF, 0.5], [-0.0, INF]]
    found = checks.bounds(given, tuple("abcd"))
    assert found.tolist() == [[-1, -1], [-INF, INF], [-INF, 0.5], [0, INF]]
    assert not np.signbit(found[3, 0])
    assert checks.bounds(None, ("a", "b")).tolist() == [[-INF, INF]] * 2


@pytest.mark.parametrize(
    "limits, message",
    [
        ([[0, 1], [1, 0]], "limits: expected lower <= upper for 'b', got 1.0 and 0.0"),
        ([[INF, INF], [0, 1]], "limits: expected lower <= upper for 'a', got inf and inf"),
        ([[0, 1], [-INF, -INF]], "limits: expected lower <= upper for 'b', got -inf and -inf"),
        ([[0, 1], [np.nan, 1]], "limits: expected lower <= upper for 'b', got nan and 1.0"),
        ([[0, 1], [0, np.nan]], "limits: expected lower <= upper for 'b', got 0.0 and nan"),
        ([[0, 1]], "limits: expected shape (2, 2), lower and upper of each coordinate, got (1, 2)"),
    ],
)
def test_limits_that_leave_nothing_are_refused_by_name(limits, message):
    with pytest.raises(InputError) as caught:
        checks.bounds(limits, ("a", "b"))
    assert str(caught.value) == message


def test_a_coupling_that_is_the_identity_is_none_and_one_of_another_shape_is_refused():
    assert checks.coupling_matrix(np.eye(3), 3) is None
    assert checks.coupling_matrix([[1, 0], [0, 2]], 2).tolist() == [[1, 0], [0, 2]]  # type: ignore[union-attr]
    for C, shape in (([1, 2], (2,)), (np.eye(3), (3, 3))):
        with pytest.raises(ShapeError) as caught:
            checks.coupling_matrix(C, 2)
        assert str(caught.value) == f"coupling: expected shape (2, m), one row a joint, got {shape}"


@pytest.mark.parametrize("off, kept", [(0.9e-5, True), (1.1e-5, False)])
def test_a_pose_that_is_off_by_a_hundred_thousandth_is_made_exact(off, kept):
    turned, row = np.eye(4), np.eye(4)
    turned[0, 0] += off / 2  # R R^T is off by twice as much
    row[3, 2] = -off
    for T in (turned, row):
        if kept:
            np.testing.assert_allclose(
                one_pose(T), np.eye(4), atol=4e-15
            )  # what `one_pose` promises
            continue
        with pytest.raises(PoseError):
            one_pose(T)
