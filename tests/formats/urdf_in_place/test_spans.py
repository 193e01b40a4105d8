"""Places of joints in a text: those that count, byte by byte."""

from __future__ import annotations

import re

import pytest

from poekin.errors import ModelError
from poekin.formats import urdf
from poekin.formats.urdf_in_place.spans import find, indent_before
from tests.formats.urdf_in_place.in_place_cases import ARM

CONTENT = ARM.encode()


def test_only_joints_of_the_robot_count_and_only_their_own_origin_and_axis():
    spans = find(CONTENT, "x")
    assert [joint.name for joint in spans.joints] == ["turn", "lift", "held", "flange"]
    assert [sorted(joint.tags) for joint in spans.joints] == [
        ["axis", "origin", "parent"],
        ["axis", "origin", "parent"],
        ["origin", "parent"],
        ["origin", "parent"],
    ]
    assert (spans.version, spans.prefix) == (None, "")
    assert CONTENT[spans.end :] == b"</robot>\n"
    for joint in spans.joints:
        assert CONTENT[joint.start :].startswith(f'<joint name="{joint.name}"'.encode())
        for name, tag in joint.tags.items():
            assert CONTENT[tag.start : tag.name_end] == f"<{name}".encode()
            for key, attribute in tag.attributes.items():
                before = CONTENT[tag.start : attribute.start]
                assert re.search(rf"\s{key}=[\"']\Z".encode(), before)
                value = CONTENT[attribute.start : attribute.end].decode()
                assert value == attribute.value


def test_values_are_found_whatever_stands_around_them():
    origin = "<origin\n note = \"a>b '\" xyz\r\n=\t'1&#32;2 3'/>"
    text = f'<robot version="1.1"><joint name="a&gt;b"\t>{origin}</joint></robot>'
    (joint,) = find(text.encode(), "x").joints
    assert joint.name == "a>b"
    xyz = joint.tags["origin"].attributes["xyz"]
    assert text[xyz.start : xyz.end] == "1&#32;2 3"
    assert xyz.value == "1 2 3"
    assert find(text.encode(), "x").version == "1.1"


def test_what_stands_behind_a_tag_is_no_attribute_of_it():
    text = b'<robot><joint name="j"><origin xyz="1 0 0" />="x"<axis xyz="0 0 1" >="y"</axis></joint></robot>'
    (joint,) = find(text, "x").joints
    assert [list(tag.attributes) for tag in joint.tags.values()] == [["xyz"], ["xyz"]]


def test_an_origin_in_something_else_or_of_another_prefix_is_none_of_the_joint():
    deep = (
        b'<robot><joint name="j"><x><origin xyz="1 0 0"/></x><origin xyz="2 0 0"/></joint></robot>'
    )
    (joint,) = find(deep, "x").joints
    assert joint.tags["origin"].attributes["xyz"].value == "2 0 0"
    named = (
        b'<u:robot xmlns:u="urdf"><joint name="i"/><u:joint name="j"><origin xyz="1 0 0"/>'
        b'<u:origin xyz="2 0 0"/></u:joint></u:robot>'
    )
    (joint,) = find(named, "x").joints
    assert joint.name == "j"
    assert joint.tags["origin"].attributes["xyz"].value == "2 0 0"


def test_the_first_of_several_counts():
    text = b'<robot><joint name="j"><origin xyz="1 0 0"/><origin xyz="2 0 0"/></joint></robot>'
    (joint,) = find(text, "x").joints
    assert joint.tags["origin"].attributes["xyz"].value == "1 0 0"


@pytest.mark.parametrize(
    ("blanks", "indent"),
    [
        (b"", b""),
        (b"  ", b"  "),
        (b"\n\t", b"\n\t"),
        (b"\r\n  ", b"\r\n  "),
        (b" \n\r\n \r\n    ", b"\r\n    "),
        (b"\r", b"\r"),
        (b"\n\n", b"\n"),
    ],
)
def test_an_indent_is_the_last_line_end_and_what_follows(blanks, indent):
    for before in (b"<a>", b"<a> text"):
        content = before + blanks + b"<b/>"
        assert indent_before(content, content.index(b"<b")) == indent


def test_a_name_that_only_newer_rules_of_xml_allow_is_refused():
    text = '<robot name="r">\n<link name="a"/><\U00010400/></robot>'
    assert urdf.read_text(text).links == ("a",)
    with pytest.raises(
        ModelError,
        match=r"^mine: line 2: cannot be edited in place: not well-formed \(invalid token\)$",
    ):
        find(text.encode(), "mine")
