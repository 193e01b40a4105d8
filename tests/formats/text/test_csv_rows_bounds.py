"""CSV of numbers: what has no end is refused, out of a pipe, a device or a file without line
breaks.
"""

import io
import os

import numpy as np
import pytest

from poekin.cli import array_files
from poekin.errors import FileError
from poekin.formats.text import csv_rows
from poekin.solve.motion import read_joints, read_poses


@pytest.fixture
def zeros(tmp_path):
    """The name of a device that has no end, as a file of arrays would be called."""
    if not os.path.exists("/dev/zero"):
        pytest.skip("there is no device without an end")
    os.symlink("/dev/zero", tmp_path / "zero.npy")
    return tmp_path / "zero.npy"


def read(stream):
    return csv_rows.read(stream, csv_rows.Columns(("a", "b"), "coordinate"), "q.csv")


def piped(text):
    """A stream out of a pipe that holds a text."""
    out, into = os.pipe()
    os.write(into, text.encode())
    os.close(into)
    return open(out, newline="")


def test_a_device_without_an_end_is_no_csv(zeros):
    for refused in (lambda: read_poses(zeros, format="12"), lambda: read_joints(zeros, ["a", "b"])):
        with pytest.raises(
            FileError, match=r"zero\.npy:1: not CSV: a line of at most 1048576 characters expected"
        ):
            refused()


def test_a_device_without_an_end_is_no_array(zeros, monkeypatch):
    monkeypatch.setattr(csv_rows, "MOST", 4096)
    with pytest.raises(
        FileError, match=r": at most 4096 bytes expected from a pipe; a file may be larger$"
    ):
        array_files.read_configurations(
            str(zeros), csv_rows.Columns(("a",), "coordinate"), lambda done, total: None
        )


def test_an_array_out_of_a_pipe_is_read(tmp_path, monkeypatch):
    content = array_files.npy_bytes(np.ones((3, 2)))
    monkeypatch.setattr(csv_rows, "MOST", len(content))
    out, into = os.pipe()
    os.write(into, content)
    os.close(into)
    os.symlink(f"/dev/fd/{out}", tmp_path / "q.npy")
    try:
        np.testing.assert_array_equal(
            array_files.read_configurations(
                str(tmp_path / "q.npy"), csv_rows.Columns(("a", "b"), "coordinate"), print
            ),
            1,
        )
    finally:
        os.close(out)


@pytest.mark.parametrize("more", [0, 1])
def test_a_line_may_be_as_long_as_the_longest(monkeypatch, more):
    monkeypatch.setattr(csv_rows, "LONGEST", 8)
    text = "1,2\n" + "1" * (5 + more) + ",2\n"
    if more:
        with pytest.raises(
            FileError,
            match=r"^q\.csv:2: not CSV: a line of at most 8 characters expected, this is longer$",
        ):
            read(io.StringIO(text))
    else:
        rows, lines = read(io.StringIO(text))
        assert (rows.tolist(), lines.tolist()) == ([[1, 2], [11111, 2]], [1, 2])


@pytest.mark.parametrize("more", [0, 1])
def test_a_pipe_is_read_up_to_a_bound(monkeypatch, more):
    monkeypatch.setattr(csv_rows, "MOST", 8)
    with piped("1,2\n3,4" + "\n" * (1 + more)) as stream:
        if more:
            with pytest.raises(
                FileError,
                match=r"^q\.csv:3: at most 8 characters expected from a pipe; a file may be larger$",
            ):
                read(stream)
        else:
            assert read(stream)[0].tolist() == [[1, 2], [3, 4]]


def test_a_file_may_be_larger_than_what_a_pipe_gives(monkeypatch, tmp_path):
    monkeypatch.setattr(csv_rows, "MOST", 8)
    monkeypatch.setattr(csv_rows, "AT_ONCE", 2)
    (tmp_path / "q.csv").write_text("a,b\n" + "1,2\n" * 5)
    with csv_rows.opened(tmp_path / "q.csv") as (stream, where, size):
        rows, lines = csv_rows.read(stream, csv_rows.Columns(("a", "b"), "coordinate"), where)
    assert (rows.tolist(), lines.tolist(), size) == ([[1, 2]] * 5, [2, 3, 4, 5, 6], 24)


def test_a_text_in_memory_may_be_larger_than_what_a_pipe_gives(monkeypatch):
    monkeypatch.setattr(csv_rows, "MOST", 8)
    assert read(io.StringIO("1,2\n" * 5))[0].tolist() == [[1, 2]] * 5


def test_a_line_has_a_mebi_of_characters_a_pipe_256_and_ten_thousand_lines_are_taken_together():
    assert (csv_rows.LONGEST, csv_rows.MOST, csv_rows.AT_ONCE) == (1_048_576, 268_435_456, 10_000)
