"""A file appears whole or not at all, with the mode that it would have otherwise."""

from __future__ import annotations

import os
import secrets
import stat
import sys

import pytest

from poekin.errors import FileError
from poekin.formats.text.atomic_write import write_whole

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="modes are those of POSIX")


def mode(path):
    return stat.S_IMODE(path.stat().st_mode)


def test_a_new_file_has_the_mode_that_the_umask_leaves(tmp_path):
    before = os.umask(0o027)
    try:
        write_whole(tmp_path / "new", b"1")
    finally:
        os.umask(before)
    assert (mode(tmp_path / "new"), (tmp_path / "new").read_bytes()) == (0o640, b"1")


def test_an_old_file_keeps_its_mode_and_nothing_else(tmp_path):
    old = tmp_path / "old"
    old.write_bytes(b"a longer text")
    old.chmod(0o604)
    write_whole(old, b"2")
    assert (mode(old), old.read_bytes()) == (0o604, b"2")
    assert list(tmp_path.iterdir()) == [old]


@pytest.mark.parametrize("step", ["fsync", "replace", "chmod"])
def test_where_a_step_fails_the_old_file_stays_and_no_other(step, tmp_path, monkeypatch):
    old = tmp_path / "old"
    old.write_bytes(b"1")

    def fails(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, step, fails)
    with pytest.raises(FileError) as caught:
        write_whole(old, b"2")
    monkeypatch.undo()
    assert str(caught.value) == f"cannot write '{old}': No space left on device"
    assert old.read_bytes() == b"1"
    assert list(tmp_path.iterdir()) == [old]


def test_a_file_may_have_the_longest_name(tmp_path):
    path = tmp_path / ("n" * 255)
    write_whole(path, b"1")
    assert path.read_bytes() == b"1"


def test_what_a_link_leads_to_is_written(tmp_path):
    (tmp_path / "file").write_bytes(b"1")
    (tmp_path / "link").symlink_to("file")
    write_whole(tmp_path / "link", b"2")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "file").read_bytes() == b"2"


def test_a_device_stays_one():
    write_whole(os.devnull, b"1")
    assert stat.S_ISCHR(os.stat(os.devnull).st_mode)


def test_a_name_that_no_file_can_have_is_refused_in_words():
    with pytest.raises(FileError, match=r"^cannot write 'a\\x00': .*embedded null"):
        write_whole("a\0", b"1")


@pytest.mark.parametrize("link", [False, True])
def test_what_has_the_temporary_name_already_is_not_written_to(tmp_path, monkeypatch, link):
    monkeypatch.setattr(secrets, "token_hex", lambda size: "guessed")
    other = tmp_path / "other"
    other.write_bytes(b"another's")
    planted = tmp_path / ".new.guessed.part"
    if link:
        planted.symlink_to(other)
    else:
        planted.write_bytes(b"another's")
    with pytest.raises(FileError, match=r"^cannot write '.*new': File exists$"):
        write_whole(tmp_path / "new", b"1")
    assert planted.is_symlink() == link
    assert other.read_bytes() == planted.read_bytes() == b"another's"
    assert not (tmp_path / "new").exists()
