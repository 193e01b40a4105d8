"""An output file appears whole or not at all."""

from __future__ import annotations

import os
import re

import pytest

from poekin.cli import array_files
from poekin.errors import FileError
from poekin.formats.text import csv_rows
from poekin.formats.text.atomic_write import write_whole


@pytest.mark.parametrize(
    "error",
    [
        FileNotFoundError(2, "No such file or directory", "q.npy"),
        OSError("No such file or directory"),
    ],
    ids=["with a number", "words alone"],
)
def test_of_a_file_that_cannot_be_read_the_reason_is_said_without_a_number(error, monkeypatch):
    def fails(*_):
        raise error

    monkeypatch.setattr(array_files, "_content", fails)
    with pytest.raises(FileError) as refused:
        array_files.read_rows("q.npy", csv_rows.Columns(("a",), "coordinate"), lambda *_: None)
    assert str(refused.value) == "cannot read 'q.npy': No such file or directory"


def test_a_write_that_fails_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch):
    path = tmp_path / "T.csv"
    path.write_text("old")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(FileError, match="No space left"):
        write_whole(path, b"new")
    assert os.listdir(tmp_path) == ["T.csv"]
    assert path.read_text() == "old"


def test_an_interrupted_write_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch):
    path = tmp_path / "T.csv"

    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_whole(path, b"new")
    assert os.listdir(tmp_path) == []


@pytest.mark.skipif(os.name == "nt", reason="there are no modes")
@pytest.mark.parametrize(("mask", "mode"), [(0o022, 0o644), (0o077, 0o600), (0, 0o666)])
def test_a_new_file_has_the_usual_mode_and_an_old_one_keeps_its_own(tmp_path, mask, mode):
    before = os.umask(mask)
    try:
        write_whole(tmp_path / "new.csv", b"x")
        (tmp_path / "old.csv").write_text("x")
        (tmp_path / "old.csv").chmod(0o640)
        write_whole(tmp_path / "old.csv", b"y")
    finally:
        os.umask(before)
    assert oct((tmp_path / "new.csv").stat().st_mode & 0o777) == oct(mode)
    assert oct((tmp_path / "old.csv").stat().st_mode & 0o777) == "0o640"


def test_the_umask_of_the_process_is_not_touched(tmp_path, monkeypatch):
    # it holds for all threads: a file that another one makes meanwhile could be read or written by
    # anybody
    monkeypatch.setattr(os, "umask", None)
    write_whole(tmp_path / "new.csv", b"x")
    write_whole(tmp_path / "new.csv", b"y")
    assert (tmp_path / "new.csv").read_text() == "y"


@pytest.mark.skipif(os.name == "nt", reason="there are no modes")
def test_what_replaces_a_private_file_can_be_read_by_nobody_else_at_any_time(tmp_path, monkeypatch):
    path, modes = tmp_path / "private.csv", []
    path.write_text("old")
    path.chmod(0o600)
    sync = os.fsync
    monkeypatch.setattr(
        os, "fsync", lambda handle: modes.append(os.fstat(handle).st_mode & 0o777) or sync(handle)
    )
    write_whole(path, b"new")
    assert modes == [0o600]


def test_a_file_that_is_being_written_is_hidden_and_called_like_it(tmp_path, monkeypatch):
    found = []
    monkeypatch.setattr(
        os, "fsync", lambda handle: found.extend(path.name for path in tmp_path.iterdir())
    )
    write_whole(tmp_path / f"{'x' * 200}.csv", b"new")
    assert len(found) == 1
    assert re.fullmatch(r"\.x{50}\.[0-9a-f]{16}\.part", found[0])


def test_a_link_stays_a_link(tmp_path):
    (tmp_path / "real.csv").write_text("old")
    (tmp_path / "link.csv").symlink_to(tmp_path / "real.csv")
    write_whole(tmp_path / "link.csv", b"new")
    assert (tmp_path / "link.csv").is_symlink()
    assert (tmp_path / "real.csv").read_text() == "new"


def test_a_device_is_written_to_and_not_replaced(tmp_path):
    (tmp_path / "null.csv").symlink_to(os.devnull)
    write_whole(tmp_path / "null.csv", b"new")
    assert not os.path.isfile(os.devnull)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes with a name")
def test_a_pipe_gets_the_whole_content_and_stays_a_pipe(tmp_path):
    os.mkfifo(tmp_path / "pipe.csv")
    out = os.open(tmp_path / "pipe.csv", os.O_RDONLY | os.O_NONBLOCK)
    try:
        write_whole(tmp_path / "pipe.csv", b"1,2\n3,4\n")
        assert os.read(out, 100) == b"1,2\n3,4\n"
    finally:
        os.close(out)
    assert (tmp_path / "pipe.csv").is_fifo()


@pytest.mark.parametrize("name", ["x.csv", "missing/x.csv"])
def test_a_place_that_cannot_be_written_is_refused_before_any_work(tmp_path, name):
    (tmp_path / "x.csv").mkdir()
    with pytest.raises(FileError, match="cannot write"):
        array_files.check_place(tmp_path / name)


def test_a_file_that_somebody_else_has_under_the_temporary_name_is_not_written_over(
    tmp_path, monkeypatch
):
    monkeypatch.setattr("secrets.token_hex", lambda size: "0" * 2 * size)
    other = tmp_path / f".T.csv.{'0' * 16}.part"
    other.write_text("another's")
    with pytest.raises(FileError, match="File exists"):
        write_whole(tmp_path / "T.csv", b"new")
    assert other.read_text() == "another's"
    assert os.listdir(tmp_path) == [other.name]
