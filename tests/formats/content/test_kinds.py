"""The kind of a text is seen by how it begins, and only that of a model."""

from __future__ import annotations

import pytest

from poekin.errors import ModelError
from poekin.formats.content import kinds

KINDS = {
    "<robot/>": "xml",
    " \n\t<?xml version='1.0'?><robot/>": "xml",
    "String value is: <robot/>": "parameter",
    "data: <robot/>": "yaml",
    'data: "<robot/>"': "yaml",
    "---\ndata: 1": "yaml",
    "robot_description: '<robot/>'": "yaml",
    "/robot_state_publisher:\n  ros__parameters:\n": "yaml",
    "kinematics:\n  shoulder:\n": "yaml",
    "rpy: fixed\n\nkinematics:\n": "yaml",
    "# a comment\n\n  # another\nkinematics: \n": "yaml",
    "'<robot/>'": "yaml",
    '"<robot/>"': "yaml",
    "|\n  <robot/>": "yaml",
    ">-\n  <robot/>": "yaml",
    'convention = "standard"': "toml",
    "# published\nname='x'": "toml",
    "[[joint]]\ntheta = 0": "toml",
    "[base]\r\nx = 0": "toml",
    "[base] # of the arm": "toml",
    "[base]": "toml",
    "convention,name,theta,d,a,alpha\n": "csv",
    "alpha, a,d,theta\n": "csv",
}


@pytest.mark.parametrize("text", KINDS)
def test_a_text_is_of_the_kind_that_it_begins_as(text):
    for content in (
        text,
        "\ufeff" + text,
        text.encode(),
        text.encode("utf-8-sig"),
        text.encode("utf-16"),
        text.encode("utf-16-be"),
    ):
        assert kinds.kind_of(content) == KINDS[text]


@pytest.mark.parametrize(
    "text",
    ["", "hello", "WARNING: topic [/robot_description] does not appear to be published yet",
     "A message was lost!!!\n", "Parameter not set.", "ISO-10303-21;", "-- a comment", "q1,q2\n0,1\n",
     "solid cube\n", "# nothing\n", "{\"data\": 1}", "bash: xacro: command not found\n", "\x7fELF",
     "[WARN] no clock\n<robot/>", "[INFO] [launch]: log files\n<robot/>"],
)  # fmt: skip
def test_what_no_model_begins_as_is_of_no_kind(text):
    assert kinds.kind_of(text) is None
    assert kinds.kind_of(text.encode()) is None


def test_a_model_begins_within_65536_characters():
    assert kinds.kind_of("\n" * (2**16 - 1) + "<robot/>") == "xml"
    assert kinds.kind_of("\n" * 2**16 + "<robot/>") is None


def test_text_is_utf_8_or_utf_16_with_its_mark():
    for encoding in ("utf-8", "utf-8-sig", "utf-16"):
        assert kinds.decode("data: ü".encode(encoding), "f") == "data: ü"
    with pytest.raises(ModelError, match=r"^f: not UTF-8 at byte 6$"):
        kinds.decode("data: ü".encode("latin-1"), "f")
    with pytest.raises(ModelError, match=r"^f: not UTF-16 at byte \d$"):
        kinds.decode("da".encode("utf-16") + b"\0", "f")
