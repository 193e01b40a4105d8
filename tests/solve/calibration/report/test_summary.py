"""The printed report of a calibration: its head, its table of residuals, its outliers and its words."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration.report import summary
from poekin.solve.calibration.result import Outlier

ARM = pk.load("ur5").chain()
MADE = pk.calibration.simulated(ARM, 20, seed=2)
# without a diagnosis, which has tests of its own
FOUND = replace(pk.calibrate(ARM, MADE.q, MADE.measurements, folds=2), evidence=None)
KNOWN = FOUND.workspace(20)


@pytest.fixture(autouse=True)
def other_lines(monkeypatch):
    """What takes long and has tests of its own: uncertainties, joints, and frames to be typed in."""
    monkeypatch.setattr(type(FOUND), "workspace", lambda found: KNOWN)
    monkeypatch.setattr(summary.changes, "aligned_joints", lambda found: ["joints"])
    monkeypatch.setattr(summary.pendant, "lines", lambda found: ["to be typed"])


def lines(found):
    return summary.text_of(found).splitlines()


def sizes(residuals):
    """Median and root mean square of distances, mm, and of angles, mrad."""
    for errors in (residuals.length, residuals.angle):
        yield 1e3 * np.median(errors)
        yield 1e3 * np.sqrt(np.mean(errors**2))


def test_the_table_has_the_residuals_before_and_after_and_those_that_were_held_out():
    text = lines(FOUND)
    head = text.index(f"{'':29}{'median mm':>13}{'rms mm':>13}{'median mrad':>13}{'rms mrad':>13}")
    held_out = FOUND.cross_validation
    assert held_out is not None
    rows = {
        "before": FOUND.before,
        "after": FOUND.after,
        "held out (2 folds), before": held_out.before,
        "held out, after": held_out.after,
    }
    for line, (name, residuals) in zip(text[head + 1 :], rows.items(), strict=False):
        assert line == f"{name:29}" + "".join(f"{x:13.3g}" for x in sizes(residuals))


def test_of_points_the_table_has_no_angles():
    points = pk.calibration.simulated(ARM, 20, kind="points", seed=2)
    found = pk.calibrate(ARM, points.q, points.measurements, folds=0)
    text = lines(replace(found, evidence=None))
    head = text.index(f"{'':29}{'median mm':>13}{'rms mm':>13}")
    after = list(sizes(found.after))[:2]
    assert text[head + 2] == f"{'after':29}" + "".join(f"{x:13.3g}" for x in after)
    assert not any(line.startswith("held out") for line in text)


def test_a_centre_that_was_not_known_is_told_in_the_base_and_points_of_the_tool_in_the_tip():
    centre, point = np.array([1.0, 0.2, -0.3]), np.array([0.0, 0.05, 0.1])
    for name, place, frame in (("centre", centre, "base"), ("point 1", point, "tool")):
        parameters = tuple(
            p._replace(owner=name) if k < 3 else p for k, p in enumerate(FOUND.parameters)
        )
        found = replace(FOUND, parameters=parameters, frames={name: place})
        told = ", ".join(f"{1e3 * x:.3f}" for x in place)
        (line,) = (x for x in lines(found) if x.startswith(f"{name} at"))
        assert line.startswith(f"{name} at ({told}) mm in '{frame}', standard deviations (")


def test_the_head_says_how_many_steps_and_whether_it_converged():
    words = f"{len(FOUND.parameters)} parameters, 20 measurements, "
    steps = len(FOUND.steps)
    assert lines(FOUND)[0] == f"{words}converged in {steps} steps"
    assert lines(replace(FOUND, success=False))[0] == (
        f"{words}NOT converged: the best that was found in {steps} steps"
    )


@pytest.mark.parametrize(
    ("count", "ending"),
    [(1, "0"), (12, "11"), (13, "11 and 1 more"), (30, "11 and 18 more")],
)
def test_twelve_outliers_are_named_and_the_others_counted(count, ending):
    outliers = tuple(Outlier(0, k // 2, k) for k in range(count))  # by their rows of q
    (line,) = (x for x in lines(replace(FOUND, outliers=outliers)) if x.startswith("outliers"))
    named = ", ".join(str(k) for k in range(min(count, 12) - 1))
    assert line == f"outliers: rows {named}{', ' * (count > 1)}{ending}"
    assert not any(x.startswith("outliers") for x in lines(replace(FOUND, outliers=())))


def test_what_forbids_its_use_comes_before_warnings_and_remarks_and_no_word_obeys_a_terminal():
    found = replace(FOUND, verdict=("a",), warnings=("b\x1b[2J",), remarks=("c", "d"))
    text = lines(found)
    assert text.index("joints") + 1 == text.index("to be typed") > text.index(KNOWN.summary())
    assert text[-4:] == ["do not use it: a", "warning: b\\x1b[2J", "c", "d"]
