"""Every encoding that a URDF is read in gives the same bytes again, or is refused by name."""

from __future__ import annotations

import codecs

import numpy as np
import pytest

import poekin as pk
from poekin.errors import ModelError
from poekin.formats import urdf_in_place
from poekin.formats.urdf_in_place.encoding import decode
from tests.formats.urdf_in_place.in_place_cases import ARM, perturbed, read

UNDECLARED = ARM.replace(' encoding="UTF-8"', "")


def declared(name: str, text: str = ARM) -> str:
    return text.replace("UTF-8", name)


FILES = {
    "UTF-8": ARM.encode(),
    "UTF-8 with a mark": codecs.BOM_UTF8 + ARM.encode(),
    "UTF-8 with a mark and blanks": codecs.BOM_UTF8 + b"\n\n" + ARM.encode(),
    "nothing declared": UNDECLARED.encode(),
    "single quotes": ARM.replace('"UTF-8"', "'UTF-8'").encode(),
    "UTF-16, little end first": codecs.BOM_UTF16_LE + UNDECLARED.encode("utf-16-le"),
    "UTF-16, big end first": codecs.BOM_UTF16_BE + UNDECLARED.encode("utf-16-be"),
    "UTF-16 without a mark": declared("UTF-16").encode("utf-16-le"),
    "UTF-16 without a mark, big end first": declared("UTF-16").encode("utf-16-be"),
    "Latin-1": declared("ISO-8859-1").encode("latin-1"),
    "Windows": declared("windows-1252").encode("cp1252"),
    "Chinese": declared("GB2312", ARM.replace("ü", "中文")).encode("gb2312"),
    "Windows line ends": ARM.replace("\n", "\r\n").encode(),
    "old line ends": ARM.replace("\n", "\r").encode(),
    "mixed line ends": ARM.replace("\n", "\r\n", 12).encode(),
    "blank lines first": b"\r\n \n" + ARM.encode(),
}


def _body(text: str) -> str:
    """A text without its declaration, blanks made one."""
    return " ".join(text.partition("?>")[2].split())


@pytest.mark.parametrize("kind", FILES)
def test_a_file_in_any_encoding_is_edited_in_it(kind):
    data = FILES[kind]
    robot = read(data)
    chain = perturbed(robot.chain(tip="hand"), np.random.default_rng(0))
    new = pk.to_urdf(chain, into=data)
    text, old = decode(new, "x"), decode(data, "x")
    assert (text.mark, text.encoding) == (old.mark, old.encoding)
    # the bytes of the plain file are what the other tests look at
    plain = pk.to_urdf(chain, into=ARM.encode()).decode()
    assert _body(text.content.decode().replace("中文", "ü")) == _body(plain)
    assert new.startswith(old.mark)
    for end in (b"\r\n", b"\r", b"\n"):
        assert new.count(end) == data.count(end)


def test_a_text_is_written_in_the_encoding_that_it_declares():
    text = declared("ISO-8859-1")
    robot = read(text)
    assert urdf_in_place.edit(text, robot) == text.encode("latin-1")
    assert urdf_in_place.edit(UNDECLARED, robot) == UNDECLARED.encode()


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        # to a Japanese terminal twice "ASCII from here on" is once
        (
            declared("ISO-2022-JP").replace("ü", "\x1b(B\x1b(B").encode(),
            "'ISO-2022-JP' does not give the same bytes again",
        ),
        (declared("ISO-8859-1", ARM.replace("ü", "中")), "'latin-1' codec can't encode character"),
        (declared("x-unknown"), "unknown encoding: x-unknown"),
        (declared("x-unknown").encode(), "unknown encoding: x-unknown"),
        (b"\xff" + ARM.encode(), "'utf-8' codec can't decode byte 0xff"),
    ],
)
def test_what_would_not_come_back_byte_for_byte_is_refused(data, reason):
    with pytest.raises(ModelError) as caught:
        decode(data, "mine.urdf")
    assert str(caught.value).startswith(f"mine.urdf: cannot be edited in place: {reason}")
    assert str(caught.value).endswith("; make it UTF-8")
