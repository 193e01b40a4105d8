"""Pipes are read once, to their end, and no further than is bounded."""

from __future__ import annotations

import io
import os
import threading

import pytest

from poekin.errors import FileError
from poekin.formats.content import pipes
from poekin.formats.load import load
from poekin.formats.text import xml
from tests.formats.texts import one_joint

TEXT = one_joint().encode()
needs_fifo = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")


@needs_fifo
def test_a_pipe_is_a_model_whatever_its_name_ends_in(tmp_path):
    for name in ("pipe", "pipe.urdf", "pipe.csv", "pipe.yaml"):
        path = tmp_path / name
        os.mkfifo(path)
        assert pipes.is_pipe(path)
        writer = threading.Thread(target=path.write_bytes, args=(TEXT,))
        writer.start()
        robot = load(path)
        writer.join()
        assert robot.links == ("a", "b")
        assert robot.source is not None
        assert (str(robot.source), robot.source.text) == (str(path), TEXT)


def test_what_is_no_pipe_is_none(tmp_path):
    (tmp_path / "file").touch()
    for name in (tmp_path, tmp_path / "file", tmp_path / "gone", "a\0b", "panda"):
        assert not pipes.is_pipe(name)


@needs_fifo
def test_a_pipe_that_is_gone_or_forbidden_is_refused(tmp_path, monkeypatch):
    with pytest.raises(FileError, match=r"gone: cannot be read: No such file or directory$"):
        pipes.read(tmp_path / "gone")


class _Broken(io.BytesIO):
    def read(self, _size=-1):
        raise OSError(5, "Input/output error")


class _Impatient(io.BytesIO):
    """A stream that does not wait, and has nothing yet."""

    def read(self, _size=-1):
        return None


class _Endless(io.BytesIO):
    """A stream that gives as much as it is asked for."""

    def read(self, size=-1):
        assert size is not None
        assert 0 < size <= xml.MAX_BYTES + 1
        return b"x" * size


@pytest.mark.parametrize(
    ("stream", "message"),
    [
        (io.BytesIO(), "s: the text is empty (did the command before the pipe fail?)"),
        (io.BytesIO(b" \n"), "s: the text is empty (did the command before the pipe fail?)"),
        (_Impatient(), "s: the text is empty (did the command before the pipe fail?)"),
        (_Broken(), "s: cannot be read: Input/output error"),
        (_Endless(), "s: expected at most 64 MiB, got more"),
    ],
    ids=["empty", "blank", "impatient", "broken", "endless"],
)
def test_a_stream_without_a_text_is_refused(stream, message, monkeypatch):
    monkeypatch.setattr(xml, "MAX_BYTES", 100)
    with pytest.raises(FileError) as caught:
        pipes.read_stream(stream, "s")
    assert str(caught.value) == message


def test_a_stream_of_just_the_most_is_read(monkeypatch):
    monkeypatch.setattr(xml, "MAX_BYTES", len(TEXT))
    assert pipes.read_stream(io.BytesIO(TEXT), "s") == TEXT
    monkeypatch.setattr(xml, "MAX_BYTES", len(TEXT) - 1)
    with pytest.raises(FileError, match="expected at most 64 MiB, got more"):
        pipes.read_stream(io.BytesIO(TEXT), "s")
