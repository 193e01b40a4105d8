"""Poses in a frame that is not known, of a probe that sits anywhere."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.groups import se3
from poekin.solve.calibration import EyeToHand, Poses, calibrate, identify, read, simulated, write

ARM = pk.load("ur5").chain()
MADE = simulated(ARM, 40, seed=3, kind="eye-to-hand")
assert isinstance(MADE.measurements, EyeToHand)
SEEN = MADE.measurements.T_camera_board
FRESH = ARM.random(9, 50)


def test_both_unknown_is_the_fit_of_a_camera_and_a_board():
    C = MADE.measurements.covariance
    probe = calibrate(ARM, MADE.q, Poses(SEEN, C, frame="unknown", tool="unknown"), folds=0)
    camera = calibrate(ARM, MADE.q, EyeToHand(SEEN, C), folds=0)
    assert list(probe.frames) == ["T_base_device", "T_tip_probe"]
    for mine, other in zip(probe.frames.values(), camera.frames.values(), strict=True):
        np.testing.assert_array_equal(mine, other)
    np.testing.assert_array_equal(probe.covariance, camera.covariance)


@pytest.mark.parametrize(("frame", "tool"), [("unknown", "tip"), ("base", "unknown")])
def test_one_unknown_frame_is_found_with_the_arm(frame, tool):
    """Six numbers more, none of which the poses tell apart from those of base or home."""
    exact = simulated(ARM, 40, seed=3, kind="eye-to-hand", noise=(0, 0))
    assert exact.X is not None
    assert exact.Z is not None
    truth = exact.truth.fk(exact.q)
    T = se3.inverse(exact.X) @ truth if frame == "unknown" else truth @ exact.Z
    poses = Poses(T, frame=frame, tool=tool)
    seen = identify(ARM, exact.q, poses)
    assert (seen.size, seen.rank, seen.identifiable) == (36, 30, 30)
    found = calibrate(ARM, exact.q, poses, folds=0)
    (F,) = found.frames.values()
    mine = found.chain.fk(FRESH)
    theirs = exact.truth.fk(FRESH)
    if frame == "unknown":
        mine = se3.inverse(F) @ mine
        theirs = se3.inverse(exact.X) @ theirs
    else:
        mine = mine @ F
        theirs = theirs @ exact.Z
    # rounding, some hundred times
    np.testing.assert_allclose(mine, theirs, rtol=0, atol=1e-12)


def test_a_file_of_poses_takes_them_too(tmp_path):
    write(tmp_path / "poses.csv", ARM, MADE.q, Poses(SEEN))
    _, poses = read(tmp_path / "poses.csv", ARM, frame="unknown", tool="unknown")
    assert isinstance(poses, Poses)
    assert [u.name for u in poses.unknown_frames] == ["T_base_device", "T_tip_probe"]
    np.testing.assert_allclose(poses.T, SEEN, rtol=0, atol=1e-15)
