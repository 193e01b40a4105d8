"""axes says how an arm's axes lie to each other, and by how much they miss it."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.analysis.axes import AxisPair, axes
from poekin.analysis.dexterity.singularity import singularity
from poekin.errors import InputError
from poekin.formats.load import load
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain


def made(*rows):
    return Chain.from_space([screw.revolute(w, p) for w, p in rows], np.eye(4))


WRIST = [((0, 0, 1), (1, 0, 0)), ((0, 1, 0), (1, 0, 0)), ((1, 0, 0), (0, 0, 0))]
PLANE = [((0, 1, 0), (x, 0, 0)) for x in (0.0, 0.5, 0.9)]
SHOULDER = [((0, 0, 1), (0, 0, 0)), ((0, 1, 0), (0, 0, 0)), ((1, 0, 0), (0, 0, 0))]
ELBOW = [((0, 1, 0), (0.5, 0, 0))]


@given(st.integers(0, 10**6))
def test_the_report_does_not_change_with_the_base_frame_or_the_joints_directions(seed):
    rng = np.random.default_rng(seed)
    chain = made(*[(rng.normal(size=3), rng.normal(size=3)) for _ in range(5)])
    other = chain.rebased(se3.exp(rng.normal(size=6)))
    flipped = Chain.from_space(other.screws * rng.choice([-1.0, 1.0], 5)[:, None], other.home)
    for p, q in zip(axes(chain).pairs, axes(flipped).pairs, strict=True):
        assert (p.angle, p.distance) == (
            pytest.approx(q.angle, abs=1e-6),
            pytest.approx(q.distance, abs=1e-6),
        )


@given(st.floats(2e-4, 1.55), st.floats(1e-4, 0.5))
def test_two_axes_miss_by_what_was_built_in(angle, distance):
    (pair,) = axes(
        made(((0, 0, 1), (0, 0, 0)), ((0, np.sin(angle), np.cos(angle)), (distance, 0, 0)))
    ).pairs
    assert (pair.angle, pair.distance) == (
        pytest.approx(angle, rel=1e-9),
        pytest.approx(distance, rel=1e-9),
    )
    assert not pair.intersecting
    assert "mm from intersecting" in pair.relation


def test_parallel_perpendicular_intersecting_and_coaxial_are_said():
    pairs = axes(
        made(((0, 0, 1), (0, 0, 0)), ((0, 0, -1), (0, 0, 2)), ((1, 0, 0), (3, 0, 1)))
    ).pairs
    assert [p.relation for p in pairs] == [
        "coaxial",
        "perpendicular, intersecting",
        "perpendicular, intersecting",
    ]
    assert {(p.first, p.second, p.fixed) for p in pairs} == {
        (1, 2, True),
        (2, 3, True),
        (1, 3, False),
    }
    assert axes(made(*PLANE)).pairs[0].relation == "parallel, 500 mm apart"


@pytest.mark.parametrize(
    "four",
    [
        [((0, 0, 1), (x, y, 0)) for x, y in ((0, 0), (0.5, 0), (0.9, 0.1), (1.0, 0.4))],
        [(w, (0, 0, 0)) for w in ((0, 0, 1), (0, 1, 0), (1, 0, 0), (0, 0.6, 0.8))],
    ],
    ids=["parallel", "through one point"],
)
def test_an_arm_with_four_such_axes_in_a_row_is_singular_and_no_arm_of_pieper(four):
    rest = [((0, 1, 0), (1.2, 0, 0.3)), ((1, 0, 0), (0.2, 0.4, 0.7))]
    for arm in (made(*four, *rest), made(*rest, *four), made(rest[0], *four, rest[1])):
        assert singularity(arm, np.array([0.3, 0.8, -0.5, 0.9, 0.4, -1.1])).rank < 6
        kinds = [shape.kind for shape in axes(arm).shapes]
        assert len(kinds) == 2
        assert "Pieper" not in kinds


def test_shapes_are_found_where_they_are_and_not_where_they_miss():
    assert axes(made(*PLANE, *WRIST)).has("spherical wrist")
    assert axes(made(*PLANE, *WRIST)).has("three parallel axes")
    assert axes(made(*PLANE, *WRIST)).has("Pieper")
    assert axes(made(*SHOULDER, *ELBOW, *WRIST)).has("S-R-S")
    off = [WRIST[0], WRIST[1], ((1, 0, 0), (0, 0, 1e-3))]
    report = axes(made(*SHOULDER, *ELBOW, *off))
    assert report.has("spherical shoulder")
    assert not report.has("spherical wrist")
    assert not report.has("S-R-S")
    assert axes(made(*SHOULDER, *ELBOW, *off), tol_position=1e-3).has("S-R-S")
    assert not axes(
        made(((0, 0, 1), (0, 0, 0)), ((0, 0, 1), (0, 0, 1)), ((1, 0, 0), (0, 0, 0)))
    ).shapes


def test_an_s_r_s_arm_misses_its_shape_by_as_much_as_the_worse_of_shoulder_and_wrist():
    off = [WRIST[0], WRIST[1], ((1, 0, 0), (0, 0, 1e-3))]
    high = [SHOULDER[0], SHOULDER[1], ((1, 0, 0), (0, 0, 1e-3))]
    for arm in (made(*SHOULDER, *ELBOW, *off), made(*high, *ELBOW, *WRIST)):
        errors = [shape.error for shape in axes(arm, tol_position=1e-3).shapes]
        assert errors[-1] == max(errors) == pytest.approx(5e-4)


def test_a_kind_of_shape_that_does_not_exist_is_refused_with_those_that_do():
    with pytest.raises(InputError) as caught:
        axes(made(*WRIST)).has("wrist")  # pyright: ignore[reportArgumentType]
    assert str(caught.value) == (
        "kind: expected 'spherical wrist', 'spherical shoulder', 'spherical joint', 'three parallel axes', "
        "'Pieper' or 'S-R-S', got 'wrist'"
    )


def test_well_known_arms_are_known():
    ur = axes(load("ur5e").chain())
    assert [s.joints for s in ur.shapes if s.kind == "three parallel axes"] == [(2, 3, 4)]
    assert ur.has("Pieper")
    panda = axes(load("panda").chain(tip="panda_hand"))
    assert panda.has("spherical shoulder")
    assert not panda.has("spherical wrist")


def test_axes_lie_as_they_do_where_the_coordinates_are_zero_and_not_where_the_joints_are():
    bent = made(*SHOULDER).replace(offset=[0.0, 0.3, 0.0])
    first_and_third = axes(bent).pairs[1]
    assert (first_and_third.first, first_and_third.second) == (1, 3)
    assert first_and_third.angle == pytest.approx(math.pi / 2 - 0.3)


def test_prismatic_axes_have_no_place():
    chain = Chain.from_space(
        [screw.prismatic([0, 0, 1]), screw.revolute([1, 0, 0], [0, 1, 0])], np.eye(4)
    )
    (pair,) = axes(chain).pairs
    assert (pair.distance, pair.relation) == (None, "perpendicular")


def test_json_is_plain():
    document = json.loads(axes(made(*PLANE, *WRIST)).to_json())
    assert {"pairs", "shapes", "tol_position", "tol_rotation"} == set(document)


@pytest.mark.parametrize("options", [{"tol_position": 0}, {"tol_rotation": float("inf")}])
def test_tolerances_out_of_range_are_refused(options):
    with pytest.raises(InputError, match=next(iter(options))):
        axes(made(*PLANE), **options)
    with pytest.raises(InputError, match="Chain"):
        axes(load("panda"))  # type: ignore[arg-type]


def test_every_shape_names_its_joints_and_by_how_much_it_misses():
    assert [(s.kind, s.joints, s.summary()) for s in axes(made(*PLANE, *WRIST)).shapes] == [
        ("three parallel axes", (1, 2, 3), "joints 1, 2 and 3: three parallel axes (within 0°)"),
        ("spherical wrist", (4, 5, 6), "joints 4, 5 and 6: spherical wrist, the axes meet in one point (within 0 mm)"),
        ("Pieper", (4, 5, 6), "Pieper: joints 4, 5 and 6: three axes meet in one point, so that the inverse kinematics "
         "has a closed form"),
    ]  # fmt: skip
    (parallel, pieper) = axes(load("ur5e").chain(), tol_rotation=1e-4).shapes
    assert (parallel.joints, pieper.joints) == ((2, 3, 4), (2, 3, 4))
    assert pieper.summary().startswith(
        "Pieper: joints 2, 3 and 4: three axes are parallel, so that"
    )
    arm = made(*SHOULDER, *ELBOW, *WRIST)
    kinds = {s.kind: s.joints for s in axes(arm).shapes}
    assert (kinds["spherical shoulder"], kinds["spherical wrist"]) == ((1, 2, 3), (5, 6, 7))
    assert kinds["S-R-S"] == (1, 2, 3, 4, 5, 6, 7)
    assert (
        axes(arm).shapes[-1].summary()
        == "S-R-S: a spherical shoulder, an elbow and a spherical wrist, like a human arm"
    )
    assert "Pieper" not in kinds
    middle = made(PLANE[1], *SHOULDER, PLANE[2])
    assert [(s.kind, s.joints) for s in axes(middle).shapes if s.kind.startswith("spherical")] == [
        ("spherical joint", (2, 3, 4))
    ]


@pytest.mark.parametrize("tol, found", [(0.35e-3, False), (0.36e-3, True)])
def test_axes_meet_that_pass_one_point_within_the_tolerance(tol, found):
    # Along x, y and z, each 0.5 mm from the others: the nearest point is 0.25 mm off each in two
    # directions.
    far = 5e-4
    three = made(((1, 0, 0), (0, 0, far)), ((0, 1, 0), (far, 0, 0)), ((0, 0, 1), (0, far, 0)))
    shapes = axes(three, tol_position=tol).shapes
    assert bool(shapes) == found
    if found:
        assert (shapes[0].kind, shapes[0].error) == (
            "spherical wrist",
            pytest.approx(0.25e-3 * np.sqrt(2)),
        )


@pytest.mark.parametrize("tilt, found", [(0.9, True), (1.1, False)])
def test_three_axes_are_parallel_whichever_way_they_point_within_the_tolerance(tilt, found):
    angle = np.radians(tilt)
    three = made(
        ((0, 0, 1), (0, 0, 0)),
        ((0, 0, -1), (1, 0, 0)),
        ((0, np.sin(angle), np.cos(angle)), (2, 0, 0)),
    )
    shapes = axes(three, tol_rotation=np.radians(1.0)).shapes
    assert [s.kind for s in shapes] == ["three parallel axes"] * found
    if found:
        assert shapes[0].error == pytest.approx(angle)
        assert shapes[0].summary().endswith("(within 0.9°)")


def test_what_slides_makes_no_shape_and_neighbours_on_one_line_no_spherical_joint():
    z, y = ((0, 0, 1), (0, 0, 0)), ((0, 1, 0), (0, 0, 0))
    assert not axes(made(z, z, y)).shapes
    assert not axes(made(y, z, z)).shapes
    assert axes(made(z, y, z)).shapes[0].kind == "spherical wrist"
    slide = Chain.from_space([screw.prismatic([1, 0, 0]), *made(z, y, z).screws], np.eye(4))
    assert [s.joints for s in axes(slide).shapes] == [(2, 3, 4)]
    assert not axes(
        Chain.from_space(
            [*made(z, y).screws, screw.prismatic([1, 0, 0]), *made(z).screws], np.eye(4)
        )
    ).shapes


ALONG = [((0, 0, 1), (0, 0, z)) for z in (0.0, 0.1, 0.2)]
ACROSS = [((1, 0, 0), (0, y, 0)) for y in (0.0, 0.1, 0.3)]


@pytest.mark.parametrize(
    "first, found",
    [
        (ALONG, 0),
        ([*ALONG[:2], ((0, 0, -1), (0.5, 0, 0))], 0),
        ([((0, 0, -1), (0.5, 0, 0)), *ALONG[:2]], 0),
        ([ALONG[0], ((0, 0, 1), (0.5, 0, 0)), ALONG[1]], 1),
        ([((0, 0, 1), (0.5, 0, 0)), *ALONG[:1], ((0, 0, 1), (2e-5, 0, 0))], 1),
        ([((0, 0, 1), (0.5, 0, 0)), *ALONG[:1], ((0, 0, 1), (0.9e-5, 0, 0))], 0),
    ],
    ids=["all", "first two", "last two", "first and last", "a hair apart", "within the tolerance"],
)
def test_parallel_neighbours_along_one_line_are_one_joint_and_solve_no_arm(first, found):
    """First and last may coincide at one q: as two links of equal lengths that are folded up."""
    assert [s.kind for s in axes(made(*first)).shapes] == ["three parallel axes"] * found
    shapes = [(s.kind, s.joints) for s in axes(made(*first, *ACROSS)).shapes]
    assert shapes == [
        *[("three parallel axes", (1, 2, 3))] * found,
        ("three parallel axes", (4, 5, 6)),
        *[("Pieper", (1, 2, 3))] * found,
    ]
    assert made(*first, *ACROSS).dof == 6


def test_three_parallel_axes_stay_a_shape_beside_another_along_the_last_of_them():
    shapes = axes(made(*PLANE, (PLANE[2][0], (0.9, 1.0, 0)))).shapes
    assert [(s.kind, s.joints) for s in shapes] == [("three parallel axes", (1, 2, 3))]


def test_neighbours_along_one_line_beside_a_shape_leave_no_arm_that_it_solves():
    x, y, z = np.eye(3)
    wrist = [(z, [2, 0, 0]), (y, [2, 0, 0]), (x, [2, 0, 0])]
    arm = made((z, [0, 0, 0]), (-z, [0, 0, 1]), (y, [1, 0, 0]), *wrist)
    assert [s.kind for s in axes(arm).shapes] == ["spherical wrist"]
    seven = made(*SHOULDER, (x, [0.5, 0, 0]), *wrist)
    kinds = [s.kind for s in axes(seven).shapes]
    assert kinds == ["spherical shoulder", "spherical joint", "spherical wrist"]
    # Axes that meet at an angle, or slides, are no neighbours along one line.
    assert axes(made((z, [0, 0, 0]), (y, [0, 0, 0]), (y, [1, 0, 0]), *wrist)).has("Pieper")


@pytest.mark.parametrize("angle, gap, words", [
    (30.0, 0.25, "30° from parallel, 250 mm from intersecting"), (44.5, 0.0, "44.5° from parallel, intersecting"),
    (45.5, 0.0, "44.5° from perpendicular, intersecting"), (150.0, 0.0, "30° from parallel, intersecting"),
    (90.0, 0.25, "perpendicular, 250 mm from intersecting"), (0.0, 0.25, "parallel, 250 mm apart"),
    (180.0, 0.0, "coaxial"),
])  # fmt: skip
def test_the_relation_of_two_axes_is_said_in_degrees_and_mm(angle, gap, words):
    turned = np.radians(angle)
    (pair,) = axes(
        made(((0, 0, 1), (0, 0, 0)), ((0, np.sin(turned), np.cos(turned)), (gap, 0, 0)))
    ).pairs
    assert pair.relation == words
    assert pair.angle == pytest.approx(min(turned, np.pi - turned), abs=1e-14)
    assert pair.distance == pytest.approx(gap, abs=1e-15)
    assert (
        str(axes(made(((0, 0, 1), (0, 0, 0)), ((0, 0, 1), (1, 0, 0)))))
        == "joint1 - joint2: parallel, 1000 mm apart"
    )


@pytest.mark.parametrize("tol", [0, -1.0, math.inf, math.nan, "1", True])
@pytest.mark.parametrize("name", ["tol_position", "tol_rotation"])
def test_a_tolerance_is_a_positive_number(name, tol):
    with pytest.raises(InputError) as caught:
        axes(made(*WRIST), **{name: tol})
    assert str(caught.value) == f"{name}: expected a positive number, got {tol!r}"


def test_an_arm_is_a_chain():
    with pytest.raises(InputError) as caught:
        axes(5)  # pyright: ignore[reportArgumentType]
    assert str(caught.value) == "chain: expected a Chain, as Robot.chain(tip=...) makes it, got 5"


def test_shapes_are_said_whole():
    x, y, z = np.eye(3)
    elbow = [(z, [0, 0, 0]), (y, [0, 0, 0]), (x, [0, 0, 0]), (y, [1, 0, 0]), (z, [2, 1e-6, 0]), (y, [2, 0, 0]),
             (x, [2, 0, 0])]  # fmt: skip
    assert [(shape.kind, shape.joints, shape.summary()) for shape in axes(made(*elbow)).shapes] == [
        ("spherical shoulder", (1, 2, 3), "joints 1, 2 and 3: spherical shoulder, the axes meet in one point (within "
         "0 mm)"),
        ("spherical wrist", (5, 6, 7), "joints 5, 6 and 7: spherical wrist, the axes meet in one point (within 0.0005 "
         "mm)"),
        ("S-R-S", (1, 2, 3, 4, 5, 6, 7), "S-R-S: a spherical shoulder, an elbow and a spherical wrist, like a human "
         "arm"),
    ]  # fmt: skip
    six = [*elbow[1:3], (x, [0, 1, 0]), (x, [0, 2, 0]), (z, [3, 0, 0]), (y, [4, 0, 1])]
    assert [(shape.kind, shape.joints, shape.summary()) for shape in axes(made(*six)).shapes] == [
        ("three parallel axes", (2, 3, 4), "joints 2, 3 and 4: three parallel axes (within 0°)"),
        ("Pieper", (2, 3, 4), "Pieper: joints 2, 3 and 4: three axes are parallel, so that the inverse kinematics has "
         "a closed form"),
    ]  # fmt: skip


@pytest.mark.parametrize("angle, words", [
    (44.9, "44.9° from parallel"), (45.0, "45° from perpendicular"), (45.1, "44.9° from perpendicular"),
])  # fmt: skip
def test_an_angle_is_told_from_what_it_is_nearer_to(angle, words):
    pair = AxisPair(1, 2, "a", "b", math.radians(angle), None, False, False, False, True)
    assert (pair.relation, pair.summary()) == (words, f"a - b: {words}")
    assert pair.to_dict()["relation"] == words


def test_shapes_behind_a_slide_and_behind_parallel_axes_are_found():
    x, y, z = np.eye(3)
    wrist = [(z, [2, 0, 0]), (y, [2, 0, 0]), (x, [2, 0, 0])]
    rail = Chain.from_space([screw.prismatic(x), *made(*wrist).screws], np.eye(4))
    assert [(shape.kind, shape.joints) for shape in axes(rail).shapes] == [
        ("spherical wrist", (2, 3, 4))
    ]
    both = axes(made(*((y, [0.5 * k, 0, 0]) for k in range(3)), *wrist)).shapes
    assert [(shape.kind, shape.joints) for shape in both] == [
        ("three parallel axes", (1, 2, 3)), ("spherical wrist", (4, 5, 6)), ("Pieper", (4, 5, 6)),
    ]  # fmt: skip
    # Neighbours along one line are no wrist, and neither are slides.
    assert axes(made((z, [0, 0, 0]), (z, [0, 0, 1]), (x, [0, 0, 0]))).shapes == ()
    assert axes(made((z, [0, 0, 0]), (x, [0, 0, 0]), (x, [1, 0, 0]))).shapes == ()


@pytest.mark.parametrize("degrees", [61.0, 80.0, 89.9])
def test_axes_at_less_than_a_right_angle_are_not_perpendicular(degrees):
    angle = math.radians(degrees)
    slant = screw.revolute([0, math.sin(angle), math.cos(angle)], [0.5, 0, 0])
    chain = Chain.from_space([screw.revolute([0, 0, 1], [0, 0, 0]), slant], np.eye(4))
    (pair,) = axes(chain).pairs
    assert not pair.perpendicular
    off = f"{90 - degrees:.4g}° from perpendicular"
    assert pair.relation == f"{off}, 500 mm from intersecting"
