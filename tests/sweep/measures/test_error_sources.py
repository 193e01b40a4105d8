"""Sources of errors: tolerances one by one, covariances, calibrations."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.sweep import Cells, PoseUncertainty, Random, Sweep, run
from poekin.sweep.measures.error_sources import (
    calibration_sources,
    covariance_sources,
    tolerance_sources,
)
from tests.sweep.arms import slide, two_links
from tests.sweep.measures.first_order import effects

NONE: dict[str, Any] = {"tilt": 0, "shift": 0, "offset": 0, "home_rotation": 0, "home_position": 0}
ARM = pk.load("ur5e").chain(tip="tool0")
ONE = Cells((-9.0, -9.0, -9.0), 18.0, (1, 1, 1))


def sigma(chain, q, sources, part):
    error = PoseUncertainty(tuple(tuple(map(tuple, s)) for s in sources.tolist()))
    return np.sqrt(np.square(effects(chain, q, error, part)).sum(axis=1))


def test_offsets_are_those_of_the_coordinates():
    coupled = two_links().replace(coupling=[[1, 0], [0.5, 2]])
    for chain in (ARM, slide(), coupled):
        q = chain.random(1, 4)
        error = PoseUncertainty.by_tolerances(chain, offset=1.0)
        J = chain.jacobian(q, "hybrid")
        moved = effects(chain, q, error, "position")
        turned = effects(chain, q, error, "orientation")
        np.testing.assert_allclose(moved, np.linalg.norm(J[:, 3:], axis=1), atol=1e-13)
        np.testing.assert_allclose(turned, np.linalg.norm(J[:, :3], axis=1), atol=1e-13)


def test_an_axis_is_tilted_and_shifted_across_itself_where_the_model_has_it():
    given: dict[str, Any] = NONE | {"tilt": [0, 2], "shift": [0, 3]}
    sources = tolerance_sources(two_links(), **given)
    assert sources.shape == (4, 3, 6)
    assert not sources[:, [0, 2]].any()
    # the second axis is along z at (0.5, 0, 0)
    T = pk.se3.pose(np.eye(3), [0.5, 0, 0])
    seen = np.linalg.inv(pk.se3.adjoint(T)) @ sources[:, 1].T
    np.testing.assert_allclose(np.abs(seen[[2, 5]]), 0, atol=1e-15)
    np.testing.assert_allclose(seen.T @ seen, np.diag([4.0, 4.0, 9.0, 9.0]), atol=1e-14)


def test_a_slide_is_tilted_and_has_no_place():
    sources = tolerance_sources(slide(), **NONE | {"tilt": 1, "shift": 1})
    assert np.count_nonzero(np.any(sources, axis=2)[:, 0]) == 2
    assert np.count_nonzero(np.any(sources, axis=2)[:, 1]) == 4


def test_the_home_pose_is_off_in_the_tool_s_axes():
    sources = tolerance_sources(ARM, **NONE | {"home_rotation": 2, "home_position": 3})
    np.testing.assert_array_equal(sources[:, -1], np.diag([2.0, 2, 2, 3, 3, 3]))
    assert not sources[:, :-1].any()
    q = ARM.random(1, 3)
    np.testing.assert_allclose(sigma(ARM, q, sources, "position"), 3 * np.sqrt(3))
    np.testing.assert_allclose(sigma(ARM, q, sources, "orientation"), 2 * np.sqrt(3))


def test_a_covariance_is_that_of_its_sources():
    root = np.random.default_rng(2).normal(size=(42, 5))
    C = root @ root.T
    sources = covariance_sources(ARM, C)
    flat = sources.reshape(-1, 42)
    np.testing.assert_allclose(flat.T @ flat, C, atol=1e-12)
    samples = Random.of(ARM, 64)
    error = PoseUncertainty.by_covariance(ARM, C, "orientation")
    (best,) = np.ravel(np.asarray(run(Sweep(ARM, samples, ONE, error)).best))
    q = samples.configurations(np.arange(64))
    assert best == pytest.approx(sigma(ARM, q, sources, "orientation").min(), rel=1e-12)


def test_a_calibration_has_the_covariance_of_its_poses():
    arm = pk.load("ur5").chain()
    made = pk.calibration.simulated(arm, 30, seed=2)
    found = pk.calibrate(arm, made.q, made.measurements, folds=0)
    q = arm.random(5, 20)
    C = found.pose_covariance(q)
    sources = calibration_sources(found)
    for part, rows in (("orientation", slice(3)), ("position", slice(3, 6))):
        expected = np.sqrt(np.trace(C[:, rows, rows], axis1=1, axis2=2))
        # differences of a step of 1e-4 are off by its square
        np.testing.assert_allclose(sigma(found.chain, q, sources, part), expected, rtol=1e-6)
    error = PoseUncertainty.by_calibration(found)
    assert np.array_equal(error.sources, sources)
    turned = PoseUncertainty.by_calibration(found, "orientation")
    assert (error.part, turned) == ("position", PoseUncertainty(error.sources, "orientation"))


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ("gains", r"^calibration: shoulder_pan_joint: gain is a gain, whose error no screw has$"),
        ("pitch", "a pitch is estimated"),
        ("backlash", r"^calibration: 'backlash' is no error of a screw: calibrate without it$"),
    ],
)
def test_a_calibration_of_what_no_screw_has_is_refused(parameters, words):
    arm = pk.load("ur5").chain()
    made = pk.calibration.simulated(arm, 40, seed=2)
    found = pk.calibrate(
        arm, made.q, made.measurements, folds=0, parameters=("screws", "home", parameters)
    )
    with pytest.raises(InputError, match=words):
        PoseUncertainty.by_calibration(found)


def test_no_errors_within_the_tolerances_move_the_tool_farther_than_the_bound():
    chain = two_links()
    bound = PoseUncertainty.by_tolerances(chain, offset=[1e-3, 2e-3], shift=1e-4, bound=True)
    samples = Random.of(chain, 1)
    q = samples.configurations([0])
    most = np.nanmax(np.asarray(run(Sweep(chain, samples, ONE, bound)).best))
    sources = np.array(bound.sources)
    changes = chain.screw_derivatives(q[0])
    D = np.concatenate([changes.screws, changes.home[:, None]], axis=1)
    moved = []
    for signs in product([-1, 1], repeat=len(sources)):
        V = np.einsum("rie,ie->r", D, np.tensordot(signs, sources, axes=1))
        moved.append(np.linalg.norm(V[3:] + np.cross(V[:3], chain.fk(q[0])[:3, 3])))
    assert most / len(sources) <= max(moved) <= most * (1 + 1e-12)
    alone = PoseUncertainty.by_tolerances(chain, offset=[1e-3, 0], bound=True)
    (reached,) = {
        float(x) for x in np.ravel(np.asarray(run(Sweep(chain, samples, ONE, alone)).best)) if x > 0
    }
    # the tip turns about the first axis
    assert reached == pytest.approx(1e-3 * np.linalg.norm(chain.fk(q[0])[:2, 3]), rel=1e-12)


@pytest.mark.parametrize(
    ("make", "kind", "words"),
    [
        (lambda: PoseUncertainty.by_tolerances(ARM), InputError, "expected an error above 0"),
        (lambda: PoseUncertainty.by_tolerances(ARM, tilt=-1), InputError, "tilt: .* from 0 on"),
        (lambda: PoseUncertainty.by_tolerances(ARM, shift=np.inf), InputError, "shift: .* finite"),
        (
            lambda: PoseUncertainty.by_tolerances(ARM, offset=[1, 2]),
            ShapeError,
            r"offset: expected one or 6 numbers, got \(2,\)",
        ),
        (lambda: PoseUncertainty.by_tolerances(ARM, home_position=-1), InputError, "home_position"),
        (
            lambda: PoseUncertainty.by_tolerances(ARM, tilt=1, part="pose"),  # type: ignore[arg-type]
            InputError,
            "part: expected 'position' or 'orientation'",
        ),
        (
            lambda: PoseUncertainty.by_covariance(ARM, np.eye(6)),
            ShapeError,
            r"expected \(42, 42\), got \(6, 6\)",
        ),
        (lambda: PoseUncertainty.by_covariance(ARM, -np.eye(42)), InputError, "no negative eigen"),
        (
            lambda: PoseUncertainty.by_covariance(ARM, np.triu(np.ones((42, 42)))),
            InputError,
            "a symmetric matrix",
        ),
    ],
)
def test_what_is_no_error_is_refused(make, kind, words):
    with pytest.raises(kind, match=words):
        make()
