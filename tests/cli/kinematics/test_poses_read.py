"""Poses on a command line: one, in words or lines; in files, text or arrays, by their endings."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.cli.kinematics import poses
from poekin.errors import InputError

CHAIN = pk.load("stanford").chain()
T = pk.se3.exp([[0.1, 0.2, 0.3, 0.4, 0.5, 0.6], [-0.6, 0.5, -0.4, 0.3, -0.2, 0.1]])
TEXT = "\n".join(",".join(map(repr, row)) for row in T[:, :3].reshape(2, 12).tolist())


def refusal(*arguments) -> str:
    with pytest.raises(InputError) as refused:
        poses.read(*arguments)
    return str(refused.value)


@pytest.mark.parametrize("name", ["T", "T.csv", "T.txt", "T.log", "T.npz", "T.yaml"])
def test_whatever_is_no_npy_file_is_read_as_text_that_a_controller_writes(name, tmp_path):
    (tmp_path / name).write_text(
        "p[1.0, 2.0, 3.0, 0.1, 0.2, 0.3]\np[4.0, 5.0, 6.0, 0.0, 0.0, 0.0]\n"
    )
    found = poses.read(None, str(tmp_path / name), "ur", None)
    np.testing.assert_array_equal(found[:, :3, 3], [[1, 2, 3], [4, 5, 6]])
    # a rotation vector of 0.4 rad there and back
    np.testing.assert_allclose(pk.so3.log(found[0, :3, :3]), [0.1, 0.2, 0.3], rtol=0, atol=1e-15)


@pytest.mark.parametrize("name", ["T.npy", "T.NPY"])
@pytest.mark.parametrize(("format", "shape"), [("12", (2, 12)), ("16", (2, 16)), ("16", (2, 4, 4))])
def test_an_array_has_the_columns_of_its_format_or_is_of_matrices(name, format, shape, tmp_path):
    with (tmp_path / name).open("wb") as stream:
        np.save(stream, T.reshape(2, 16)[:, : int(format)].reshape(shape))
    np.testing.assert_array_equal(poses.read(None, str(tmp_path / name), format, None), T)


@pytest.mark.parametrize(("format", "count"), [("12", 12), ("ros", 7), ("rpy", 6)])
def test_an_array_of_matrices_is_none_of_rows_of_fewer_numbers(format, count, tmp_path):
    place = str(tmp_path / "T.npy")
    np.save(place, T)
    assert refusal(None, place, format, None) == (
        f"{place!r}: an array of shape (N, {count}) expected, got (2, 4, 4)"
    )


def test_a_row_of_an_array_that_is_no_pose_is_told_with_its_number(tmp_path):
    place = str(tmp_path / "T.npy")
    np.save(place, T * [[[1.0]], [[2.0]]])
    assert refusal(None, place, "16", None).startswith(f"{place!r}, row 1: ")


def test_two_poses_on_a_command_line_are_refused():
    assert refusal([TEXT], None, "12", None) == "one pose expected, got 2; or --input with a file"
    assert len(poses.read([TEXT.splitlines()[1]], None, "12", None)) == 1


@pytest.mark.parametrize("text", ["", " , "])
def test_an_option_without_a_number_is_no_number_for_all(text):
    with pytest.raises(InputError, match=r"^--speed: 6 coordinates expected .*, got 0$"):
        poses.for_each(text, CHAIN, "--speed")
