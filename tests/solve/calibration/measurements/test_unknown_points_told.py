"""Points of the tool that were not known, in what a calibration prints, saves and draws."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration import Distances, Points, Separations, calibrate
from poekin.solve.calibration.report.html_report import html
from tests.solve.calibration.diagnostics.effects.planted import diagnosis_of
from tests.solve.calibration.measurements.test_unknown_points import (
    APART,
    ARM,
    DEVICE,
    NOISE,
    TOOL,
    Q,
    T,
    plate,
    seen,
)


@pytest.fixture(scope="module")
def found():
    return plate([Separations(APART, "plate", 1e-5**2)])


def test_each_point_is_printed_with_its_deviations(found):
    told = [line for line in str(found).splitlines() if line.startswith("point ")]
    for line, (name, place) in zip(told, list(found.frames.items())[1:], strict=True):
        mine = [k for k, p in enumerate(found.parameters) if p.owner == name]
        a, b, c = 1e3 * np.sqrt(np.diag(found.covariance)[mine])
        x, y, z = 1e3 * place
        assert line == (
            f"{name} at ({x:.3f}, {y:.3f}, {z:.3f}) mm in 'tool', standard deviations ({a:.4f}, {b:.4f}, "
            f"{c:.4f}) mm while what is unidentifiable is fixed"
        )


def test_what_is_printed_is_saved_and_the_page_has_the_residuals_of_each(found, tmp_path):
    found.save(tmp_path / "a.toml")
    assert str(pk.calibration.load(tmp_path / "a.toml")) == str(found)
    page = html(found, "plate", ["row"] * len(Q))
    _, _, table = page.partition("Means in axes of the tool")
    # of three points, and none of the separations
    assert table.partition("</table>")[0].count("Points") == 3
    assert "Separations" not in table.partition("</table>")[0]


def test_points_that_are_fitted_are_tested_for_their_scatter_alone(found):
    tests = diagnosis_of(plate()).tests
    assert [test for test in tests if test.kind == "reflector"] == []
    # separations say where points are, and agree
    tests = diagnosis_of(found).tests
    assert min(test.p for test in tests if test.kind == "reflector") > 0.05
    loose = {test.whose for test in tests if test.kind == "loose"}
    assert loose == {f"reflector {k} of measurement set 0" for k in (1, 2, 3)}


def test_an_unknown_point_that_is_loose_is_found_beside_its_device():
    rng = np.random.default_rng(0)
    p = seen(T, device=DEVICE) + NOISE * rng.normal(size=(40, 3, 3))
    p[:, 1] += 1e-3 * rng.normal(size=(40, 3))
    for points in (None, "plate"):
        sets = Points(p, points, frame="unknown")
        finding = diagnosis_of(calibrate(ARM, Q, sets, folds=0)).findings[0]
        assert (finding.kind, finding.whose) == ("loose", "reflector 2")


def test_points_of_the_tool_are_those_that_were_found(found):
    evidence = found.evidence
    y = np.array(list(found.frames.values())[1:])
    np.testing.assert_array_equal(evidence.points, np.unique(y, axis=0))


def test_a_centre_that_was_not_known_stands_in_the_base():
    centre = np.array([1.0, 0.5, 0.2])
    d = np.linalg.norm(seen(T, TOOL[:1])[:, 0] - centre, axis=1)
    d += NOISE * np.random.default_rng(0).normal(size=len(d))
    measured = Distances(d, point=TOOL[0])
    made = calibrate(ARM, Q, measured, folds=0, on_rank_deficiency="fix")
    assert "\ncentre at (" in str(made)
    (line,) = (line for line in str(made).splitlines() if line.startswith("centre at "))
    assert " mm in 'base', standard deviations (" in line


def test_deviations_of_points_that_nothing_else_moves_stand_alone():
    points = Points(seen(T, TOOL[:1]), points=None)
    made = calibrate(ARM, Q, points, parameters=("gains",), folds=0, on_rank_deficiency="fix")
    (line,) = (line for line in str(made).splitlines() if line.startswith("point 1 at "))
    assert made.identification.unidentifiable == ()
    assert line.endswith(") mm")
