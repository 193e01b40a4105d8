"""What a calibration gives is one line where it is looked at, however many numbers it holds."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.groups import se3
from poekin.solve.calibration import JointSweep, Points, from_circles, from_fk
from poekin.solve.calibration.terms.conditions import at_rest

ARM = pk.load("ur5").chain()
MADE = pk.calibration.simulated(ARM, 30, kind="points", noise=(1e-4, 1e-4), seed=2)
FOUND = pk.calibrate(ARM, MADE.q, MADE.measurements, folds=2)
LEFT_OUT = pk.calibrate(
    ARM, MADE.q, Points(MADE.measurements.measured[5:], rows=range(5, 30)),
    loss="huber", folds=0, on_rank_deficiency="fix",
)  # fmt: skip
COMMAND = FOUND.compensate(ARM.fk(MADE.q[0]), nearest_to=MADE.q[0])


def sweeps():
    tool = ARM.retooled(se3.pose(np.eye(3), [0.1, 0.0, 0.2]))
    for joint in range(6):
        q = np.tile([0.0, -1.0, 1.0, 0.3, 0.2, 0.1], (9, 1))
        q[:, joint] += np.linspace(-1, 1, 9)
        yield JointSweep(joint, q, tool.fk(q)[:, :3, 3])


SWEEPS = list(sweeps())
CIRCLES = from_circles(SWEEPS)
MASSES = at_rest(MADE.q, {})._replace(payload=np.linspace(0.5, 3, 30))
CASES = {
    "<Calibration: 'base' -> 'tool', 30 parameters, 30 measurements, converged in": FOUND,
    "<Workspace: the tool is known to ": FOUND.workspace(50),
    "<ResidualVectors: 30 points, ": FOUND.residuals,
    "<Residuals: position ": FOUND.after,
    "CrossValidation(before=<Residuals: position ": FOUND.cross_validation,
    "<FrameEstimate: base at (": FOUND.tool_and_base[0],
    "<Command: q = (": COMMAND,
    "<Command: readings and poses of shape (2, 6) and (2, 4, 4)>": type(COMMAND)(
        MADE.q[:2], ARM.fk(MADE.q[:2])
    ),
    "<AxisFit: joint 2, direction ± ": CIRCLES.axes[2],
    "FromCircles(chain=<Chain 'device' -> 'tool'": CIRCLES,
    "<JointSweep: joint 3, 9 points over 2 rad>": SWEEPS[3],
    "<JointSweep: joint 0, 2 poses over 0.5 m>": JointSweep(
        0, [[0.0], [0.5]], np.tile(np.eye(4), (2, 1, 1)), kind="prismatic"
    ),
    "<Conditions: 30 readings, payload 0.5 to 3 kg>": MASSES,
    "<Simulated: 30 simulated Points, ": MADE,
    "<Choice: 6 of 20 configurations for ": pk.choose_poses(ARM, 6, 20, n_random=2),
    "<FitEvidence: 30 measurements at 30 readings, linear loss>": FOUND.evidence,
    "<FitEvidence: 25 measurements at 30 readings, huber loss>": LEFT_OUT.evidence,
    "<Estimate: 30 parameters, 0 unknown frames>": FOUND.estimate,
    "<FromFk: ": from_fk(ARM, MADE.q, ARM.fk(MADE.q)),
}  # fmt: skip


@pytest.mark.parametrize("begin", CASES)
def test_each_is_one_short_line(begin):
    line = repr(CASES[begin])
    assert line.startswith(begin)
    assert "\n" not in line
    assert "array" not in line
    assert len(line) < 420


def test_the_lines_say_how_well_things_are_known():
    known = FOUND.workspace(50)
    assert f"{1e3 * np.median(known.length):.3g} mm and {1e3 * np.median(known.angle):.3g}" in str(
        known
    )
    assert f"worst {1e3 * known.length.max():.3g} mm at q = ({known.worst[0]:.3g}, " in str(known)
    assert FOUND.workspace().summary() in str(FOUND)
    r = FOUND.residuals
    assert r is not None
    rms = [1e3 * np.sqrt(np.mean(np.sum(e**2, axis=1))) for e in (r.before, r.after)]
    assert r.summary() == f"30 points, {rms[0]:.3g} mm rms before, {rms[1]:.3g} mm after"
    axis = CIRCLES.axes[2]
    assert f"joint3: {axis.summary()}" in str(CIRCLES)
    frame = FOUND.tool_and_base[1]._replace(
        T=se3.exp([0, 0, np.pi / 6, 0, 0, 0]) + np.eye(4, k=3) * 0.25,
        covariance=np.diag([0, 9e-6, 16e-6, 0, 9e-8, 16e-8]),
        held=np.zeros((6, 2)),
    )
    assert frame.summary() == (
        "tool at (250.000, 0.000, 0.000) mm ± 0.5 mm, turned by 30.000° ± 5 mrad, 2 motions held"
    )
    command = str(COMMAND)
    assert command.endswith(f", {COMMAND.T[2, 3]:.6g})>")
    assert f"q = ({COMMAND.q[0]:.6g}, " in command
