"""Screws by their numbers: what is accepted, what is made exact, and what is said where it is not."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ScrewError, ShapeError
from poekin.model import screw
from poekin.model.screw_rows.unit_screws import pitch_of, pitches_of, unit_screws, with_pitches

Z, P = np.array([2.0, -3.0, 6.0]) / 7, np.array([0.3, -1.2, 2.5])
AXIS = np.array([2.0, -3.0, 6.0])


def test_a_screw_is_its_axis_and_the_moment_of_its_point_and_its_pitch_along_the_axis():
    np.testing.assert_allclose(screw.revolute(AXIS, P), [*Z, *-np.cross(Z, P)], rtol=0, atol=1e-15)
    np.testing.assert_allclose(
        screw.helical(AXIS, P, 0.4), [*Z, *(-np.cross(Z, P) + 0.4 * Z)], rtol=0, atol=1e-15
    )
    np.testing.assert_allclose(screw.prismatic(AXIS), [0, 0, 0, *Z], rtol=0, atol=1e-15)


def test_an_axis_keeps_its_direction_at_any_length():
    for length in (5e-324, 1e-308, 1e-160, 1.0, 1e160, 1.7e308):
        np.testing.assert_array_equal(screw.prismatic([0, -length, 0]), [0, 0, 0, 0, -1, 0])
        near = screw.prismatic([length, length, 0])
        np.testing.assert_allclose(near[3:], [0.5**0.5, 0.5**0.5, 0], rtol=0, atol=3e-16)


def test_the_axis_of_a_screw_is_its_line():
    foot = P - Z * (Z @ P)
    for pitch in (0.0, 0.4, -2.0):
        axis = screw.axis_of(screw.helical(AXIS, P, pitch))
        np.testing.assert_allclose(axis.direction, Z, rtol=0, atol=1e-15)
        assert axis.point is not None
        np.testing.assert_allclose(axis.point, foot, rtol=0, atol=2e-15)
        assert axis.pitch == pytest.approx(pitch, abs=2e-15)
    slide = screw.axis_of(screw.prismatic(AXIS))
    assert (slide.point, slide.pitch) == (None, np.inf)
    np.testing.assert_allclose(slide.direction, Z, rtol=0, atol=1e-15)


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, -1, 0), (0, 0, 1)], ids=str)
def test_an_axis_along_a_coordinate_is_no_slide(axis):
    found = screw.axis_of(screw.helical(axis, P, 0.5))
    assert np.array_equal(found.direction, axis)
    assert found.point is not None
    np.testing.assert_allclose(found.point, np.where(axis, 0.0, P), rtol=0, atol=1e-15)
    assert found.pitch == pytest.approx(0.5, abs=1e-15)
    with pytest.raises(ScrewError, match=r"omega must have length 1"):
        unit_screws([[*(2.0 * np.array(axis)), 0, 0, 0]])


@pytest.mark.parametrize("far", [0.0, 1.0, 3.0, 1000.0])
def test_a_pitch_is_nothing_up_to_4e_15_of_the_distance(far):
    """Relative to 1 m or to |v|, whichever is larger; one hair above it is a pitch."""
    limit = 4e-15 * max(1.0, far)
    for pitch, seen in (
        (0.9 * limit, False),
        (-0.9 * limit, False),
        (1.1 * limit, True),
        (-1.1 * limit, True),
    ):
        S = np.array([0, 0, 1, far, 0, pitch])
        assert pitch_of(S) == (pitch if seen else 0.0)
    assert pitch_of(np.array([0, 0, 1, 0, 0, 4e-15])) == 0.0


def test_screws_are_given_their_pitches_and_those_that_have_them_stay_to_the_last_bit():
    line, slide = np.array([*Z, *np.cross(P, Z)]), np.array([0, 0, 0, *Z])
    bolt = line + 0.3 * np.array([0, 0, 0, *Z])
    out = with_pitches(np.array([bolt, bolt, line, slide]), np.array([0.0, 0.3, -0.2, 0.0]))
    np.testing.assert_allclose(out[0], line, rtol=0, atol=2e-15)
    np.testing.assert_allclose(out[2], [*Z, *(np.cross(P, Z) - 0.2 * Z)], rtol=0, atol=2e-15)
    assert np.array_equal(out[[1, 3]], [bolt, slide])
    far = np.array([[0, 0, 1, 1000.0, 0, 3.9e-12], [0, 0, 1, 1000.0, 0, 4.1e-12]])
    assert with_pitches(far, np.zeros(2))[:, 5].tolist() == [3.9e-12, 0.0]


@pytest.mark.parametrize("far", [10.0, 1e3, 1e8])
def test_a_point_far_along_or_beside_the_axis_makes_no_pitch(far):
    rng = np.random.default_rng(0)
    for axis, aside in rng.normal(size=(200, 2, 3)):
        for point in (far * aside, far * axis + aside):
            assert screw.axis_of(screw.revolute(axis, point)).pitch == 0.0
            pitch = screw.axis_of(screw.helical(axis, point, 0.1)).pitch
            assert pitch == pytest.approx(0.1, abs=4e-15 * max(1.0, float(np.linalg.norm(point))))


def test_the_pitches_of_screws_are_those_given_or_those_that_they_have():
    S = np.array([[*Z, *np.cross(P, Z)], [*Z, *(np.cross(P, Z) + 0.3 * Z)], [0, 0, 0, *Z]])
    assert pitches_of(S) == pytest.approx([0.0, 0.3, 0.0], abs=1e-15)
    assert pitches_of(S)[[0, 2]].tolist() == [0.0, 0.0]
    assert pitches_of(S, [1e-20, -1, 0]).tolist() == [1e-20, -1.0, 0.0]
    assert pitches_of(np.zeros((0, 6)), []).shape == (0,)


@pytest.mark.parametrize("pitch", [1.1e100, -1e101])
def test_a_pitch_is_at_most_1e100(pitch):
    S = np.array([[*Z, 0, 0, 0]] * 2)
    assert pitches_of(S, [1e100, -1e100]).tolist() == [1e100, -1e100]
    with pytest.raises(ScrewError, match=r"^pitches\[1\] \(joint 'b'\): expected at most 1e\+100 "):
        pitches_of(S, [0, pitch], ("a", "b"))


def test_of_rows_of_which_one_alone_was_misread_the_message_reads_that_one():
    swapped = [*P, *Z]
    with pytest.raises(ScrewError, match=r": pass pk\.se3\.linear_first\(rows\[1\]\)$"):
        unit_screws([screw.revolute(Z, P), swapped], what="rows")


@pytest.mark.parametrize("off", [9e-10, -9e-10, 1e-12, -1e-14])
def test_a_screw_of_nearly_unit_length_is_made_exact_and_stays_on_its_line(off):
    S = np.array([*Z, *(np.cross(P, Z) + 0.3 * Z)]) * (1 + off)
    (exact,) = unit_screws([S])
    assert abs(np.linalg.norm(exact[:3]) - 1) <= 2.3e-16
    np.testing.assert_allclose(exact, S / (1 + off), rtol=1e-15, atol=1e-15)
    (slide,) = unit_screws([[0, 0, 0, *(Z * (1 + off))]])
    np.testing.assert_allclose(slide[3:], Z, rtol=0, atol=3e-16)


def test_a_screw_of_unit_length_is_kept_to_the_last_bit():
    S = np.array([[0.6, 0.0, 0.8, 0.1, 0.2, 0.3], [0, 0, 0, 0.6, 0.0, 0.8], [*Z, *P]])
    S[2, :3] /= np.linalg.norm(S[2, :3])
    assert abs(np.linalg.norm(S[2, :3]) - 1) <= 2.3e-16
    assert np.array_equal(unit_screws(S), S)
    # a length one unit in the last place above 1 is rounding, and dividing by it would only add to
    # it
    up = np.array([[1 + 2**-52, 0, 0, 0.1, 0.7, 0.3]])
    assert np.array_equal(unit_screws(up), up)
    lengths = 1 + np.array([2, 3, 4]) * 2.0**-52
    kept = [unit_screws([[0, x, 0, 0.1, 0, 0.3]])[0, 1] for x in lengths]
    assert kept == [lengths[0], 1.0, 1.0]


def test_minus_zero_becomes_zero_and_the_argument_stays_as_it_was():
    given = np.array([[-0.0, 0, 1, 0, -0.0, 0]])
    found = unit_screws(given)
    assert not np.signbit(found).any()
    found[0, 2] = 7.0
    assert np.signbit(given[0, 0])
    assert given[0, 2] == 1.0


def test_no_screws_are_screws_too():
    assert unit_screws([]).shape == (0, 6)
    assert unit_screws(np.zeros((0, 6))).shape == (0, 6)


ROUNDED = "; its rows are unit screws but for rounding: pass pk.screw.normalised(screws)"
REFUSED = [
    (
        [[0, 0, 1, 0, 0]],
        ShapeError,
        "screws: expected shape (n, 6), one row (omega; v) a joint, got (1, 5)",
    ),
    (
        [0, 0, 1, 0, 0, 0],
        ShapeError,
        "screws: expected shape (n, 6), one row (omega; v) a joint, got (6,)",
    ),
    (
        np.zeros((2, 2, 6)),
        ShapeError,
        "screws: expected shape (n, 6), one row (omega; v) a joint, got (2, 2, 6)",
    ),
    (
        [[0], [0], [1], [0], [0], [0]],
        ShapeError,
        "screws: expected shape (n, 6), one row (omega; v) a joint, got (6, 1); its columns are unit"
        " screws, as in a Slist: pass screws.T",
    ),
    (5.0, ShapeError, "screws: expected shape (n, 6), one row (omega; v) a joint, got ()"),
    (
        [[0, 0, 1, 0, 0, 0, 0]],
        ShapeError,
        "screws: expected shape (n, 6), one row (omega; v) a joint, got (1, 7)",
    ),
    (
        np.zeros((2, 6, 6)),
        ShapeError,
        "screws: expected shape (n, 6), one row (omega; v) a joint, got (2, 6, 6)",
    ),
    (
        np.zeros((0, 5)),
        ShapeError,
        "screws: expected shape (n, 6), one row (omega; v) a joint, got (0, 5)",
    ),
    (
        [[0, 0, 1 + 1.1e-9, 0, 0, 0]],
        ScrewError,
        "screws[0]: omega must have length 1 to 1e-09, got 1.0000000011 in [0.0, 0.0, 1.0000000011, 0.0, 0.0, 0.0]"
        + ROUNDED,
    ),
    (
        [[0, 0, 1 - 1.1e-9, 0, 0, 0]],
        ScrewError,
        "screws[0]: omega must have length 1 to 1e-09, got 0.9999999989 in [0.0, 0.0, 0.9999999989, 0.0, 0.0, 0.0]"
        + ROUNDED,
    ),
    (
        [[0, 0, 1, 0, 0, 0], [0, 0, 0, 0, 2, 0]],
        ScrewError,
        "screws[1]: v, where omega = 0, must have length 1 to 1e-09, got 2 in [0.0, 0.0, 0.0, 0.0, 2.0, 0.0]",
    ),
    (
        [[0, 0, 0, 0, 0, 0]],
        ScrewError,
        "screws[0]: v, where omega = 0, must have length 1 to 1e-09, got 0 in [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]",
    ),
    (
        [[1e-12, 0, 0, 0, 1, 0]],
        ScrewError,
        "screws[0]: omega must have length 1 to 1e-09, got 1e-12 in [1e-12, 0.0, 0.0, 0.0, 1.0, 0.0]"
        + ROUNDED,
    ),
    (
        [[0, 0, 1, 0, np.nan, 0]],
        ScrewError,
        "screws[0]: expected finite numbers of at most 1e+100, got [0.0, 0.0, 1.0, 0.0, nan, 0.0]",
    ),
    (
        [[0, 0, 1, -np.inf, 0, 0]],
        ScrewError,
        "screws[0]: expected finite numbers of at most 1e+100, got [0.0, 0.0, 1.0, -inf, 0.0, 0.0]",
    ),
    (
        [[0, 0, 1, -1.01e100, 0, 0]],
        ScrewError,
        "screws[0]: expected finite numbers of at most 1e+100, got [0.0, 0.0, 1.0, -1.01e+100, 0.0, 0.0]",
    ),
]


@pytest.mark.parametrize(
    "screws, error, message", REFUSED, ids=[f"{i}" for i in range(len(REFUSED))]
)
def test_what_is_no_screw_is_said(screws, error, message):
    with pytest.raises(error) as caught:
        unit_screws(screws)
    assert str(caught.value) == message


def test_the_longest_number_is_still_one():
    assert unit_screws([[0, 0, 1, 1e100, -1e100, 0]])[0, 3] == 1e100


def test_the_joint_is_named_where_its_name_is_known():
    bad = [[0, 0, 2, 0, 0, 0]]
    with pytest.raises(ScrewError, match=r"screws\[0\] \(joint 'elbow'\): omega"):
        unit_screws(bad, ("elbow",))
    with pytest.raises(ScrewError, match=r"screws\[1\]: omega"):
        unit_screws([[0, 0, 1, 0, 0, 0], *bad], ("elbow",))


@pytest.mark.parametrize(
    "call, error, message",
    [
        (
            lambda: pk.screw.prismatic([0, 0, 0]),
            ScrewError,
            "axis: expected a direction, got the zero vector",
        ),
        (
            lambda: pk.screw.prismatic([[0, 0, 1]]),
            InputError,
            "axis: expected one finite vector (3,), got [[0.0, 0.0, 1.0]]",
        ),
        (
            lambda: pk.screw.prismatic([0, np.inf, 0]),
            InputError,
            "axis: expected one finite vector (3,), got [0.0, inf, 0.0]",
        ),
        (
            lambda: pk.screw.revolute(Z, [[0, 0, 0]]),
            InputError,
            "expected a finite point (3,) and pitch, got point [[0.0, 0.0, 0.0]] and pitch 0.0",
        ),
        (
            lambda: pk.screw.revolute(Z, [0, 0]),
            ShapeError,
            "point: expected shape (..., 3), got (2,)",
        ),
        (
            lambda: pk.screw.helical(Z, P, np.nan),
            InputError,
            "expected a finite point (3,) and pitch, got point [0.3, -1.2, 2.5] and pitch nan",
        ),
        (
            lambda: pk.screw.helical(Z, [np.nan, 0, 0], 1.0),
            InputError,
            "expected a finite point (3,) and pitch, got point [nan, 0.0, 0.0] and pitch 1.0",
        ),
        (
            lambda: pk.screw.axis_of([0, 0, 1]),
            ShapeError,
            "screw: expected shape (..., 6), got (3,)",
        ),
    ],
    ids=[
        "zero",
        "two axes",
        "infinite",
        "two points",
        "short point",
        "pitch",
        "point",
        "short screw",
    ],
)
def test_what_makes_no_screw_is_said(call, error, message):
    with pytest.raises(error) as caught:
        call()
    assert str(caught.value) == message
