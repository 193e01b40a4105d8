"""axes says how an arm's axes lie to each other, and by how much they miss it."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.analysis.axes import axes
from poekin.errors import InputError
from poekin.formats.load import load
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain


def made(*rows):
    return Chain([screw.revolute(w, p) for w, p in rows], np.eye(4))


WRIST = [((0, 0, 1), (1, 0, 0)), ((0, 1, 0), (1, 0, 0)), ((1, 0, 0), (0, 0, 0))]
PLANE = [((0, 0, 1), (x, 0, 0)) for x in (0.0, 0.5, 1.0)]
SHOULDER = [((0, 0, 1), (0, 0, 0)), ((0, 1, 0), (0, 0, 0)), ((1, 0, 0), (0, 0, 0))]
ELBOW = [((0, 1, 0), (0.5, 0, 0))]


@given(st.integers(0, 10**6))
def test_the_report_does_not_change_with_the_base_frame_or_the_joints_directions(seed):
    rng = np.random.default_rng(seed)
    chain = made(*[(rng.normal(size=3), rng.normal(size=3)) for _ in range(5)])
    other = chain.rebased(se3.exp(rng.normal(size=6)))
    flipped = Chain(other.screws * rng.choice([-1.0, 1.0], 5)[:, None], other.home)
    for p, q in zip(axes(chain).pairs, axes(flipped).pairs, strict=True):
        assert (p.angle, p.distance) == (pytest.approx(q.angle, abs=1e-6), pytest.approx(q.distance, abs=1e-6))


@given(st.floats(0.01, 89), st.floats(0.1, 500))
def test_two_axes_miss_by_what_was_built_in(angle, mm):
    a = np.radians(angle)
    (pair,) = axes(made(((0, 0, 1), (0, 0, 0)), ((0, np.sin(a), np.cos(a)), (mm / 1e3, 0, 0)))).pairs
    assert (pair.angle, pair.distance) == (pytest.approx(angle, rel=1e-9), pytest.approx(mm, rel=1e-9))
    assert not pair.intersecting
    assert "mm from intersecting" in pair.words


def test_parallel_perpendicular_intersecting_and_coaxial_are_said():
    pairs = axes(made(((0, 0, 1), (0, 0, 0)), ((0, 0, -1), (0, 0, 2)), ((1, 0, 0), (3, 0, 1)))).pairs
    assert [p.words for p in pairs] == ["coaxial", "perpendicular, intersecting", "perpendicular, intersecting"]
    assert {(p.first, p.second, p.fixed) for p in pairs} == {(1, 2, True), (2, 3, True), (1, 3, False)}
    assert axes(made(*PLANE)).pairs[0].words == "parallel, 500 mm apart"


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
    assert axes(made(*SHOULDER, *ELBOW, *off), tol_mm=1.0).has("S-R-S")
    assert not axes(made(((0, 0, 1), (0, 0, 0)), ((0, 0, 1), (0, 0, 1)), ((1, 0, 0), (0, 0, 0)))).shapes


def test_well_known_arms_are_known():
    ur = axes(load("ur5e").chain())
    assert [s.joints for s in ur.shapes if s.kind == "three parallel axes"] == [(2, 3, 4)]
    assert ur.has("Pieper")
    panda = axes(load("panda").chain(tip="panda_hand"))
    assert panda.has("spherical shoulder")
    assert not panda.has("spherical wrist")


def test_prismatic_axes_have_no_place():
    chain = Chain([screw.prismatic([0, 0, 1]), screw.revolute([1, 0, 0], [0, 1, 0])], np.eye(4))
    (pair,) = axes(chain).pairs
    assert (pair.distance, pair.words) == (None, "perpendicular")


def test_json_is_plain():
    document = json.loads(axes(made(*PLANE, *WRIST)).to_json())
    assert {"pairs", "shapes", "tol_mm", "tol_deg"} == set(document)


@pytest.mark.parametrize("options", [{"tol_mm": 0}, {"tol_deg": float("inf")}])
def test_tolerances_out_of_range_are_refused(options):
    with pytest.raises(InputError, match=next(iter(options))):
        axes(made(*PLANE), **options)
    with pytest.raises(InputError, match="Chain"):
        axes(load("panda"))  # type: ignore[arg-type]
