"""What is read and written as a table: by its ending, to the byte, and nothing over what is read."""

from __future__ import annotations

import io
import os
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

from poekin.cli import array_files
from poekin.errors import FileError, InputError
from poekin.formats.text import csv_rows

ROWS = np.array([[1.5, 2.0], [-3.0, 1e-9]])


@pytest.mark.parametrize("name", ["r.csv", "r.CSV", "r.npy", "r.NPY", "r.json", "r.JSON"])
def test_a_result_is_what_its_ending_says(name, tmp_path):
    place = tmp_path / name
    array_files.write_result(place, lambda: "é,1\n", ROWS, lambda: '{"é": 1}')
    content = place.read_bytes()
    if name.lower().endswith(".npy"):
        np.testing.assert_array_equal(np.load(io.BytesIO(content), allow_pickle=False), ROWS)
    else:
        text = "é,1\n" if name.lower().endswith(".csv") else '{"é": 1}\n'
        assert content == text.encode("utf-8")


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("a.txt", "a name that ends in .csv or .npy or .json expected"),
        ("a", "a name that ends in .csv or .npy or .json expected"),
        ("folder.csv", "it is a directory"),
        ("none/a.csv", "there is no directory '{}'"),
        ("a.csv", ""),
        ("a.NPY", ""),
    ],
)
def test_a_place_that_cannot_be_written_is_told_with_the_reason(name, why, tmp_path):
    (tmp_path / "folder.csv").mkdir()
    place = tmp_path / name
    if not why:
        array_files.check_place(place)
        return
    with pytest.raises(FileError) as refused:
        array_files.check_place(place)
    assert str(refused.value) == f"cannot write '{place}': {why.format(place.parent)}"


def test_no_place_is_no_fault_and_other_endings_are_those_that_are_named(tmp_path):
    array_files.check_place(None)
    array_files.check_place(tmp_path / "a.svg", (".svg",))
    with pytest.raises(FileError, match=r"a name that ends in \.svg expected$"):
        array_files.check_place(tmp_path / "a.csv", (".svg",))


@pytest.mark.parametrize("name", array_files.STDIN)
def test_standard_input_is_read_for_one_thing(name):
    array_files.check_apart([], model=name, poses="p.csv")
    array_files.check_apart([], model="m.urdf", poses=["p.csv", name])
    array_files.check_apart([], model=None, poses=name)
    with pytest.raises(InputError, match=r"^poses: standard input is read for the model alr"):
        array_files.check_apart([], model=name, poses=name)
    with pytest.raises(InputError, match=r"^poses: standard input is read for the poses"):
        array_files.check_apart([], model="m.urdf", poses=[name, name])


def test_a_file_that_is_read_is_not_written_over_by_any_name_and_no_result_by_another(tmp_path):
    read = tmp_path / "q.csv"
    read.touch()
    other = tmp_path / "link.csv"
    other.symlink_to(read)
    for place in (read, other, tmp_path / "." / "q.csv"):
        with pytest.raises(FileError) as refused:
            array_files.check_apart([None, place], model=None, poses=["p.csv", str(read)])
        assert str(refused.value) == f"cannot write '{place}': it is the file of the poses"
    new = tmp_path / "new.csv"
    with pytest.raises(FileError) as refused:
        array_files.check_apart([new, tmp_path / "other.csv", new], poses=str(read))
    assert str(refused.value) == f"cannot write '{new}': it is named twice"
    array_files.check_apart([new, tmp_path / "other.csv", None], poses=str(read), model=None)


def test_what_is_no_file_can_be_read_twice_and_written_to(tmp_path):
    for name in (os.devnull, "panda", "\0", str(tmp_path)):
        assert array_files._file_identity(name) is None
    array_files.check_apart([Path(os.devnull)], model="panda", poses=os.devnull)


def test_the_file_that_standard_input_is_is_known(tmp_path, monkeypatch):
    place = tmp_path / "q.csv"
    place.touch()
    with place.open() as stream:
        monkeypatch.setattr(sys, "stdin", stream)
        assert array_files._file_identity("-") == array_files._file_identity(place)
        assert array_files._file_identity(place) == (
            place.stat().st_dev,
            place.stat().st_ino,
        )
    monkeypatch.setattr(sys, "stdin", None)
    assert array_files._file_identity("-") is None


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes with a name")
@pytest.mark.parametrize("more", [0, 1])
def test_an_array_in_a_pipe_may_have_so_many_bytes_and_no_more(more, tmp_path, monkeypatch):
    content = array_files.npy_bytes(ROWS)
    monkeypatch.setattr(csv_rows, "MOST", len(content) - more)
    place = tmp_path / "q.npy"
    os.mkfifo(place)
    writer = threading.Thread(target=place.write_bytes, args=(content,))
    writer.start()
    columns = csv_rows.Columns(("a", "b"), "coordinate")
    if more:
        with pytest.raises(FileError) as refused:
            array_files.read_rows(str(place), columns, lambda *_: None)
        assert str(refused.value) == (
            f"'{place}': at most {len(content) - 1} bytes expected from a pipe; a file may be larger"
        )
    else:
        rows, lines = array_files.read_rows(str(place), columns, lambda *_: None)
        np.testing.assert_array_equal(rows, ROWS)
        assert lines is None
    writer.join()


def test_places_are_called_by_their_names_in_quotes_and_standard_input_by_its_own():
    assert array_files.called("a b.csv") == "'a b.csv'"
    assert {array_files.called(name) for name in array_files.STDIN} == {"standard input"}
    assert array_files.to_open("a.csv") == "a.csv"
