"""Sets that name a frame have it in common."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.groups import se3
from poekin.solve.calibration import EyeInHand, EyeToHand, Measurement, calibrate, identify
from poekin.solve.calibration.measurements.simulated import simulated
from poekin.solve.calibration.report.toml_io import load

PANDA = pk.load("panda").chain(tip="panda_link8")
MADE = simulated(PANDA, 50, noise=(0, 0), seed=1)
T, FRESH = MADE.truth.fk(MADE.q), PANDA.random(9, 100)
A, B = se3.exp([0.3, -0.5, 0.2, 1.0, 0.4, -0.3]), se3.exp([1.3, 0.5, -0.2, -0.6, 0.7, 0.1])
CAMERA = se3.exp([-0.1, 0.2, 1.4, 0.05, -0.08, 0.1])


def seen(board: np.ndarray, rows: slice, **names: str | np.ndarray) -> EyeInHand:
    return EyeInHand(se3.inverse(board) @ T[rows] @ CAMERA, rows=np.arange(50)[rows], **names)


def test_one_camera_sees_two_boards(tmp_path):
    """The second board in two images only, from which alone nothing could be had; it is given
    first.
    """
    with pytest.raises(
        InputError,
        match=r"^an initial guess of two unknown frames needs 3 measurements or more, got 2$",
    ):
        identify(PANDA, MADE.q, [seen(B, slice(48, 50)), seen(A, slice(48))])
    sets: list[Measurement] = [
        seen(B, slice(48, 50), camera="wrist"),
        seen(A, slice(48), camera="wrist"),
    ]
    found = calibrate(PANDA, MADE.q, sets, folds=0)
    names = [
        "T_base_board of measurement set 0",
        "T_tip_camera of 'wrist'",
        "T_base_board of measurement set 1",
    ]
    assert list(found.frames) == names
    assert len(found.parameters) == 34 + 18
    assert found.identification.rank == 34 + 6
    b, camera, a = found.frames.values()
    for board, true in ((a, A), (b, B)):
        again = se3.inverse(board) @ found.chain.fk(FRESH) @ camera
        np.testing.assert_allclose(
            again, se3.inverse(true) @ MADE.truth.fk(FRESH) @ CAMERA, rtol=0, atol=1e-11
        )
    found.save(tmp_path / "arm.toml")
    np.testing.assert_array_equal(
        load(tmp_path / "arm.toml").frames["T_tip_camera of 'wrist'"], camera
    )


def test_frames_in_common_are_fewer_unknowns_in_every_kind():
    for kind in (EyeInHand, EyeToHand):
        measured = se3.inverse(A) @ T @ CAMERA
        halves = [np.arange(25), np.arange(25, 50)]
        for names, unknown in (
            ({}, 24),
            ({"camera": "c"}, 18),
            ({"board": "b"}, 18),
            ({"camera": "c", "board": "c"}, 12),
        ):
            sets = [kind(measured[rows], rows=rows, **names) for rows in halves]
            seen = identify(PANDA, MADE.q, sets)
            assert (seen.size, seen.rank) == (34 + unknown, 34 + unknown - 12)


def test_the_folds_keep_frames_in_common():
    sets = [seen(A, slice(25), camera="wrist"), seen(B, slice(25, 50), camera="wrist")]
    found = calibrate(PANDA, MADE.q, sets, folds=2)
    assert found.cross_validation is not None
    # what each fold does not see of a board is taken up by the other's: rounding, some hundred
    # times
    assert found.cross_validation.after.rms_length < 1e-11


def test_a_name_of_nothing_is_no_name():
    with pytest.raises(
        InputError, match=r"^T_tip_camera: expected a pose, a name or None, got ''$"
    ):
        EyeInHand(T, camera="")
