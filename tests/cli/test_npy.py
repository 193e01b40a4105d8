"""A .npy file is read as NumPy wrote it, and a damaged one is refused before anything is allocated."""

from __future__ import annotations

import io

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.cli.npy import configurations
from poekin.errors import FileError, InputError


def _file(header: str | bytes, data: bytes = b"", version: bytes = b"\1\0") -> bytes:
    header = header.encode("latin-1") if isinstance(header, str) else header
    return (
        b"\x93NUMPY"
        + version
        + len(header).to_bytes(2 if version == b"\1\0" else 4, "little")
        + header
        + data
    )


def _saved(array: np.ndarray) -> bytes:
    out = io.BytesIO()
    np.save(out, array)
    return out.getvalue()


@pytest.mark.parametrize("dtype", ["<f8", ">f8", "<f4", "f2", "<i8", ">i2", "u1", np.longdouble])
@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("shape", [(5, 2), (1, 2), (0, 2), (2,)])
def test_what_numpy_writes_is_read(dtype, order, shape):
    array = np.asarray(np.arange(np.prod(shape)).reshape(shape), dtype, order=order)
    read = configurations(_saved(array), 2, "q")
    assert read.dtype == np.float64
    np.testing.assert_array_equal(read, array.reshape(-1, 2))


def test_a_signalling_nan_and_what_is_too_large_are_read_without_a_warning():
    signalling = np.frombuffer(b"\x01\x00\xa0\x7f" * 2, "<f4")
    assert np.isnan(configurations(_saved(signalling), 2, "q")).all()
    large = np.array([np.finfo(np.longdouble).max, -np.finfo(np.longdouble).max])
    if large.dtype.itemsize > 8:
        assert configurations(_saved(large), 2, "q").tolist() == [[np.inf, -np.inf]]


@pytest.mark.parametrize(
    "shape", [(3,), (1,), (3, 3), (3, 1), (0, 3), (2, 2, 2), (1, 2, 1), (2, 1), ()]
)
def test_another_shape_is_refused(shape):
    with pytest.raises(InputError, match=r"^q: an array of shape \(N, 2\) expected, got \("):
        configurations(_saved(np.zeros(shape)), 2, "q")


def test_what_follows_the_elements_is_left_unread():
    assert configurations(_saved(np.ones((3, 2))) + b"more", 2, "q").tolist() == [[1.0, 1.0]] * 3


@pytest.mark.parametrize("version", [(1, 0), (2, 0), (3, 0)])
def test_every_version_of_the_format_is_read(version):
    out = io.BytesIO()
    np.lib.format.write_array(out, np.ones((3, 2)), version)
    np.testing.assert_array_equal(configurations(out.getvalue(), 2, "q"), np.ones((3, 2)))


DAMAGED = {
    "an open bracket": "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2",
    "an open text": "{'descr': '<f8",
    "a call": "__import__('os').abort()",
    "nothing": "",
    "zeros": "\0" * 60,
    "brackets without end": "(" * 5000,
    "minus signs without end": "-" * 9000 + "1",
    "an escape that is none": "{'descr': '\\d', 'fortran_order': False, 'shape': (3, 2)}",
    "a key that cannot be one": "{[]: 1}",
    "a list": "[1, 2]",
    "a key too few": "{'descr': '<f8', 'shape': (3, 2)}",
    "a type that is none": "{'descr': '<f3', 'fortran_order': False, 'shape': (3, 2)}",
    "a type of objects": "{'descr': '|O', 'fortran_order': False, 'shape': (3, 2)}",
    "a type of parts": "{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (3, 2)}",
    "a type that is empty": "{'descr': (), 'fortran_order': False, 'shape': (3, 2)}",
    "an order that is none": "{'descr': '<f8', 'fortran_order': 2, 'shape': (3, 2)}",
    "a shape that is a number": "{'descr': '<f8', 'fortran_order': False, 'shape': 3}",
    "a shape of fractions": "{'descr': '<f8', 'fortran_order': False, 'shape': (3.0, 2)}",
    "a shape of truths": "{'descr': '<f8', 'fortran_order': False, 'shape': (True, 2)}",
    "a shape below 0": "{'descr': '<f8', 'fortran_order': False, 'shape': (-3, 2)}",
    "a shape that is inferred": "{'descr': '<f8', 'fortran_order': False, 'shape': (-1, 2)}",
    "a shape too large for C": "{'descr': '<f8', 'fortran_order': False, 'shape': ("
    + "9" * 40
    + ", 2)}",
    "more rows than memory": "{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000, 2)}",
    "one row too many": "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 2)}",
    "a header without end": "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2)}"
    + " " * 20_000,
}


@pytest.mark.parametrize("header", DAMAGED.values(), ids=DAMAGED.keys())
def test_a_damaged_header_is_one_error_that_names_the_file(header):
    with pytest.raises(FileError, match=r"^'q\.npy' is "):
        configurations(_file(header, bytes(48)), 2, "'q.npy'")


KEYS = "its header does not say descr, fortran_order and shape"
REASONS = {
    "a call": "its header cannot be read",
    "nothing": "its header cannot be read",
    "minus signs without end": "its header cannot be read",
    "a key that cannot be one": "its header cannot be read",
    "a list": KEYS,
    "a key too few": KEYS,
    "a type that is none": "an array of real numbers expected, its elements are '<f3'",
    "a type of objects": "an array of real numbers expected, its elements are '|O'",
    "an order that is none": "its header's fortran_order is neither True nor False",
    "a shape that is a number": "its header's shape is not valid",
    "a shape of truths": "its header's shape is not valid",
    "a shape below 0": "its header's shape is not valid",
    "a shape that is inferred": "its header's shape is not valid",
    "a shape too large for C": "its header's shape is not valid",
    "a header without end": "its header is longer than 10000 bytes",
}


@pytest.mark.parametrize("name", REASONS)
def test_what_is_wrong_with_a_header_is_said(name):
    with pytest.raises(FileError) as caught:
        configurations(_file(DAMAGED[name], bytes(48)), 2, "'q.npy'")
    assert str(caught.value) == f"'q.npy' is no .npy file of numbers: {REASONS[name]}"


def test_what_is_wrong_with_the_whole_is_said():
    good = _saved(np.ones((3, 2)))
    for content, reason in (
        (b"PK\3\4" + good, "its first bytes are not those of a .npy file"),
        (good[:6] + b"\7\0" + good[8:], "its version is unknown"),
        (good[:100], "it ends within its header"),
        (good[:9], "it ends within its header"),
        (good[:8], "it ends within its header"),
        (_file(""), "its header cannot be read"),
    ):
        with pytest.raises(FileError) as caught:
            configurations(content, 2, "q")
        assert str(caught.value) == f"q is no .npy file of numbers: {reason}"
    with pytest.raises(
        FileError, match=r"^q is damaged: its header says 48 bytes, the file has 47$"
    ):
        configurations(good[:-1], 2, "q")
    with pytest.raises(
        FileError, match=r"^q is damaged: its header says 320 bytes, the file has 200$"
    ):
        configurations(_saved(np.ones((20, 2)))[:-120], 2, "q")
    with pytest.raises(InputError, match=r"^q: an array of shape \(N, 3\) expected, got \(3, 2\)$"):
        configurations(good, 3, "q")


def test_what_is_as_long_as_it_may_be_is_read():
    header = "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2)}"
    assert configurations(_file(header.ljust(10_000), bytes(48)), 2, "q").shape == (3, 2)
    with pytest.raises(FileError, match="longer than 10000 bytes"):
        configurations(_file(header.ljust(10_001), bytes(48)), 2, "q")
    many = header.replace("(3, 2)", f"({2**40}, 0)")
    assert configurations(_file(many), 0, "q").shape == (2**40, 0)
    with pytest.raises(FileError, match="its header's shape is not valid"):
        configurations(_file(header.replace("(3, 2)", f"({2**40 + 1}, 0)")), 0, "q")
    long = header.replace("'<f8'", f"'{'x' * 50}'")
    with pytest.raises(FileError, match=rf"its elements are '{'x' * 40}'$"):
        configurations(_file(long), 2, "q")
    nested = "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2)}" + " #" + "(" * 97
    assert configurations(_file(nested + "-", bytes(48)), 2, "q").shape == (
        3,
        2,
    )  # a hundred in all
    with pytest.raises(FileError, match="its header cannot be read"):
        configurations(_file(nested + "--", bytes(48)), 2, "q")


def test_last_axes_that_make_up_a_row_are_taken_where_they_are_said():
    T = np.arange(32.0).reshape(2, 4, 4)
    np.testing.assert_array_equal(configurations(_saved(T), 16, "q", (4, 4)), T.reshape(2, 16))
    np.testing.assert_array_equal(
        configurations(_saved(T[1]), 16, "q", (4, 4)), T[1].reshape(1, 16)
    )
    np.testing.assert_array_equal(
        configurations(_saved(T.reshape(2, 16)), 16, "q", (4, 4)), T.reshape(2, 16)
    )
    with pytest.raises(
        InputError, match=r"^q: an array of shape \(N, 16\) expected, got \(1, 2, 4, 4\)$"
    ):
        configurations(_saved(T[None]), 16, "q", (4, 4))


@pytest.mark.parametrize(
    ("content"), [_file("{}", version=b"\7\0"), _file(b"\xff{}", version=b"\3\0")]
)
def test_an_unknown_version_and_a_header_that_is_no_text_are_refused(content):
    with pytest.raises(FileError, match=r"^'q\.npy' is no \.npy file"):
        configurations(content, 2, "'q.npy'")


@given(st.integers(0, 127), st.binary(max_size=4), st.integers(0, 220))
def test_a_byte_or_an_end_anywhere_is_read_or_refused(at, bytes_there, length):
    content = _saved(np.ones((5, 2)))
    content = content[:at] + bytes_there + content[at + len(bytes_there) :]
    try:
        outcome = configurations(content[:length], 2, "'q.npy'")
    except (FileError, InputError) as error:
        outcome = str(error)
    assert "'q.npy'" in outcome if isinstance(outcome, str) else outcome.shape[1] == 2


def test_the_command_names_the_file(tmp_path, crane, refused):
    path = tmp_path / "q.npy"
    path.write_bytes(_file(DAMAGED["more rows than memory"]))
    message = refused("fk", crane, "--tip", "hook", "--input", path)
    assert f"'{path}' is damaged: its header says 16000000000000 bytes, the file has 0" in message
