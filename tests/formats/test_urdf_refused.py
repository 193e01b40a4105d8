"""URDF: what is refused, with file and line, and nothing outside of the file is read or fetched."""

from __future__ import annotations

import os
import socket
import warnings
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.errors import (
    FileError,
    InputError,
    ModelError,
    PoekinError,
    PoekinWarning,
    escape_unprintable,
)
from poekin.formats import urdf
from poekin.formats.text import xml
from poekin.model.robot import Robot
from tests.formats.texts import LIMIT, chain_of, one_joint
from tests.messages import says


def joint_of(
    attributes: str = 'name="j" type="fixed"', ends: str = '<parent link="a"/><child link="b"/>'
) -> str:
    return f'<robot name="r">\n<link name="a"/><link name="b"/>\n<joint {attributes}>\n{ends}\n</joint></robot>'


LOL = '<!DOCTYPE r [<!ENTITY a "x">' + "".join(
    f'<!ENTITY {n} "{f"&{m};" * 10}">' for m, n in zip("abcdefghijk", "bcdefghijkl", strict=True)
)
REFUSED = {
    # XML
    "nothing": ("", r"^x\.urdf: the text is empty$"),
    "blanks": (" \n ", r"^x\.urdf: the text is empty$"),
    "binary": (b"\x7fELF\0\0\0\1", r"^x\.urdf:1: malformed XML \(binary data\?\)"),
    "an STL file": (b"solid nothing\n" * 10, r"^x\.urdf:1: malformed XML"),
    "zeros": (b"\0" * 100, r"^x\.urdf:1: malformed XML"),
    "bytes that are no UTF-8": (b'<robot name="\xff"/>', r"^x\.urdf:1: malformed XML"),
    "a lone surrogate": ('<robot name="\ud800"/>', r"^x\.urdf:1: malformed XML"),
    "an unknown encoding": (
        b'<?xml version="1.0" encoding="klingon"?><robot/>',
        "malformed XML.*klingon",
    ),
    "cut off": (one_joint()[:80], r"^x\.urdf:3: malformed XML"),
    "tags crossed": ("<robot>\n<link>\n</robot>", r"^x\.urdf:3: malformed XML.*link"),
    "an attribute twice": (
        '<robot>\n<link name="a" name="a"/></robot>',
        r"^x\.urdf:2: malformed XML",
    ),
    "two documents": ("<robot/>\n<robot/>", r"^x\.urdf:2: malformed XML"),
    "an undefined entity": ("<robot>\n&who;</robot>", r"^x\.urdf:2: malformed XML.*who"),
    "an undeclared prefix": (
        "<robot>\n<xacro:macro/></robot>",
        r"^x\.urdf:2: malformed XML.*xacro",
    ),
    "nesting without end": (
        "<robot>" + "<a>" * 5000 + "</a>" * 5000 + "</robot>",
        r"^x\.urdf:1: malformed XML",
    ),
    "a DTD": (
        "\n<!DOCTYPE robot><robot/>",
        (
            r"^x\.urdf:2: a document type declaration \(DOCTYPE\) is refused: no DTD, entity or "
            r"external reference is read$"
        ),
    ),
    "a DTD from a file": (
        '<!DOCTYPE robot SYSTEM "/etc/passwd"><robot/>',
        (
            r"^x\.urdf:1: a document type declaration \(DOCTYPE\) is refused: no DTD, entity or "
            r"external reference is read$"
        ),
    ),
    "a DTD from the net": (
        '<!DOCTYPE robot PUBLIC "x" "http://127.0.0.1/x"><robot/>',
        (
            r"^x\.urdf:1: a document type declaration \(DOCTYPE\) is refused: no DTD, entity or "
            r"external reference is read$"
        ),
    ),
    "an entity": (
        '<!DOCTYPE r [<!ENTITY e SYSTEM "file:///etc/passwd">]><robot name="&e;"/>',
        (
            r"^x\.urdf:1: a document type declaration \(DOCTYPE\) is refused: no DTD, entity or "
            r"external reference is read$"
        ),
    ),
    "a parameter entity": (
        '<!DOCTYPE r [<!ENTITY % e SYSTEM "http://127.0.0.1/"> %e;]><robot/>',
        (
            r"^x\.urdf:1: a document type declaration \(DOCTYPE\) is refused: no DTD, entity or "
            r"external reference is read$"
        ),
    ),
    "a billion laughs": (
        LOL + "]><robot>&l;</robot>",
        (
            r"^x\.urdf:1: a document type declaration \(DOCTYPE\) is refused: no DTD, entity or "
            r"external reference is read$"
        ),
    ),
    "a billion laughs in an attribute": (
        LOL + ']><robot name="&l;"/>',
        (
            r"^x\.urdf:1: a document type declaration \(DOCTYPE\) is refused: no DTD, entity or "
            r"external reference is read$"
        ),
    ),
    "a billion laughs in UTF-16": (
        ("\n\n" + LOL + "]><robot>&l;</robot>").encode("utf-16"),
        (
            r"^x\.urdf:3: a document type declaration \(DOCTYPE\) is refused: no DTD, entity or "
            r"external reference is read$"
        ),
    ),
    # the robot
    "another root": (
        "<sdf><robot/></sdf>",
        r"^x\.urdf:1: expected the root element <robot>, got 'sdf'$",
    ),
    "no links": (
        '\n<robot name="r"/>',
        r"^x\.urdf:2: robot 'r': expected at least one <link>, there is none$",
    ),
    "xacro": (
        '<robot xmlns:x="http://ros.org/xacro"><x:macro/></robot>',
        r"^x\.urdf:1: <xacro:macro> is xacro that was not processed yet, which may hold joints: ",
    ),
    "xacro in a joint": (
        '<robot xmlns:x="http://www.ros.org/wiki/xacro">\n<link name="a"/><link name="b"/>\n'
        '<joint name="j" type="fixed"><parent link="a"/><child link="b"/>\n<x:insert_block name="o"/></joint></robot>',
        r"^x\.urdf:4: <xacro:insert_block> is xacro that was not processed yet",
    ),
    "xacro among links": (
        '<robot xmlns:x="http://www.ros.org/wiki/xacro">\n<link name="a"/>\n<x:arm prefix="left"/></robot>',
        (
            r"^x\.urdf:3: <xacro:arm> is xacro that was not processed yet, which may hold joints: "
            r"pk\.xacro\(path\) evaluates it, and --xacro, in a file that is not compressed$"
        ),
    ),
    "a nameless link": (
        "<robot>\n<link/></robot>",
        r'^x\.urdf:2: <link>: expected an attribute name="\.\.\.", there is none$',
    ),
    "an empty name": (
        '<robot>\n<link name=""/></robot>',
        r'^x\.urdf:2: <link>: expected an attribute name="\.\.\.", it is empty$',
    ),
    "a link twice": (
        '<robot>\n<link name="a"/>\n<link name="a"/></robot>',
        r"^x\.urdf:3: the link name 'a' is used twice \(first: x\.urdf:2\)$",
    ),
    "two roots": (
        '<robot>\n<link name="a"/>\n<link name="b"/></robot>',
        (
            r"^x\.urdf:3: a robot has one root, but 2 links have no parent: 'a' \(x\.urdf:2\), 'b' "
            r"\(x\.urdf:3\)$"
        ),
    ),
    "a joint twice": (
        chain_of("", "").replace("j1", "j0"),
        r"^x\.urdf:3: the joint name 'j0' is used twice \(first: x\.urdf:2\)$",
    ),
    "two parents": (
        chain_of("", "").replace('child link="l2"', 'child link="l1"'),
        r"^x\.urdf:3: link 'l1' has two parents: joint 'j1' and joint 'j0' \(x\.urdf:2\)$",
    ),
    "a cycle": (
        chain_of("", "")
        .replace('child link="l2"', 'child link="l0"')
        .replace('<link name="l2"/>', ""),
        r"^x\.urdf:2: the links form a cycle of 2 joint\(s\): 'l0' -> 'l1'$",
    ),
    "an unknown parent": (
        chain_of("").replace('parent link="l0"', 'parent link="l7"'),
        r"^x\.urdf:2: joint 'j0': its parent link 'l7' does not exist; available: 'l0', 'l1'$",
    ),
    "an unknown child": (
        chain_of("").replace('child link="l1"', 'child link="l7"'),
        r"^x\.urdf:2: joint 'j0': its child link 'l7' does not exist; available: 'l0', 'l1'$",
    ),
    # the joint
    "a nameless joint": (
        joint_of('type="fixed"'),
        r'^x\.urdf:3: <joint>: expected an attribute name="\.\.\.", there is none$',
    ),
    "no type": (joint_of('name="j"'), r"^x\.urdf:3: joint 'j': expected an attribute type"),
    "an unknown type": (
        joint_of('name="j" type="ball"'),
        (
            r"^x\.urdf:3: joint 'j': type must be one of revolute, continuous, prismatic, fixed, "
            r"floating, planar, got 'ball'$"
        ),
    ),
    "no parent": (joint_of(ends='<child link="b"/>'), r"^x\.urdf:3: joint 'j': .*<parent"),
    "no child": (joint_of(ends='<parent link="a"/>'), r"^x\.urdf:3: joint 'j': .*<child"),
    "a parent without a link": (
        joint_of(ends='<parent/><child link="b"/>'),
        r"^x\.urdf:4: joint 'j': <parent>: .*link",
    ),
    "two children": (
        joint_of(ends='<parent link="a"/><child link="b"/><child link="b"/>'),
        r"^x\.urdf:4: joint 'j': <child>: it appears 2 times, expected once$",
    ),
    "two numbers": (
        one_joint('<origin xyz="0 0"/>'),
        r"^x\.urdf:4: joint 'j': <origin>: xyz must be three numbers, got 2: '0 0'$",
    ),
    "four numbers": (
        one_joint('<origin rpy="0 0 0 0"/>'),
        r"^x\.urdf:4: joint 'j': <origin>: rpy must be three numbers, got 4: '0 0 0 0'$",
    ),
    "no number": (
        one_joint('<origin xyz="0 0 x"/>'),
        r"^x\.urdf:4: joint 'j': <origin>: xyz must be three finite numbers, got '0 0 x'$",
    ),
    "commas": (
        one_joint('<origin xyz="0,0,0"/>'),
        r"^x\.urdf:4: joint 'j': <origin>: xyz must be three numbers, got 1: '0,0,0'$",
    ),
    "empty": (
        one_joint('<origin xyz=""/>'),
        r"^x\.urdf:4: joint 'j': <origin>: xyz must be three numbers, got 0: ''$",
    ),
    "an underscore": (
        one_joint('<origin xyz="0 0 1_0"/>'),
        r"^x\.urdf:4: joint 'j': <origin>: xyz must be three finite numbers, got '0 0 1_0'$",
    ),
    "foreign digits": (
        one_joint('<origin xyz="0 0 \u0661"/>'),
        r"^x\.urdf:4: joint 'j': <origin>: xyz must be three finite numbers, got '0 0 ١'$",
    ),
    "NaN in xyz": (
        one_joint('<origin xyz="0 nan 0"/>'),
        r"^x\.urdf:4: joint 'j': <origin>: xyz must be three finite numbers, got '0 nan 0'$",
    ),
    "infinity in rpy": (
        one_joint('<origin rpy="0 -inf 0"/>'),
        r"^x\.urdf:4: joint 'j': <origin>: rpy must be three finite numbers, got '0 -inf 0'$",
    ),
    "too large": (
        one_joint('<origin xyz="0 0 1e999"/>'),
        r"^x\.urdf:4: joint 'j': <origin>: xyz must be three finite numbers, got '0 0 1e999'$",
    ),
    "a xacro expression": (
        one_joint('<origin xyz="${x} 0 0"/>'),
        (
            r"^x\.urdf:4: joint 'j': <origin>: xyz must be three finite numbers, got '\$\{x\} 0 0' "
            r"\(an unprocessed xacro expression\?\)$"
        ),
    ),
    "an argument of xacro": (
        one_joint('<origin xyz="$(arg x) 0 0"/>'),
        (
            r"^x\.urdf:4: joint 'j': <origin>: xyz must be three numbers, got 4: '\$\(arg x\) 0 0' "
            r"\(an unprocessed xacro expression\?\)$"
        ),
    ),
    "a zero axis": (
        one_joint('<axis xyz="0 0 -0.0"/>'),
        r"^x\.urdf:4: joint 'j': <axis>: xyz must not be zero$",
    ),
    "an axis without xyz": (
        one_joint("<axis/>"),
        r"^x\.urdf:4: joint 'j': <axis>: expected an attribute xyz=",
    ),
    "an axis by angles": (one_joint('<axis rpy="0 0 1"/>'), "<axis>: expected an attribute xyz="),
    "an axis as text": (
        one_joint("<axis>0 0 1</axis>", "continuous"),
        "<axis>: expected an attribute xyz=",
    ),
    "a planar axis without xyz": (
        one_joint("<axis/>", "planar"),
        "<axis>: expected an attribute xyz=",
    ),
    "a length without a square": (
        one_joint('<origin xyz="0 -1e155 0"/>'),
        (
            r"^x\.urdf:4: joint 'j': <origin>: xyz: expected lengths of at most 1e\+100 m, got \(0\.0, "
            r"-1e\+155, 0\.0\)$"
        ),
    ),
    "the largest length of all": (
        one_joint('<origin xyz="1e308 0 0"/>', "fixed"),
        (
            r"^x\.urdf:4: joint 'j': <origin>: xyz: expected lengths of at most 1e\+100 m, got "
            r"\(1e\+308, 0\.0, 0\.0\)$"
        ),
    ),
    "NaN in the axis": (
        one_joint('<axis xyz="0 0 nan"/>'),
        r"^x\.urdf:4: joint 'j': <axis>: xyz must be three finite numbers, got '0 0 nan'$",
    ),
    "four angles": (
        one_joint('<origin rpy="0 0 0 0"/>'),
        r"^x\.urdf:4: joint 'j': <origin>: rpy must be three numbers, got 4: '0 0 0 0'$",
    ),
    "angles and a quaternion": (
        one_joint('<origin rpy="0 0 0" quat_xyzw="0 0 0 1"/>').replace('name="r"', 'version="1.1"'),
        r"^x\.urdf:4: joint 'j': <origin>: either rpy or quat_xyzw expected, got both$",
    ),
    "a quaternion of zeros": (
        one_joint('<origin quat_xyzw="0 0 0 0"/>').replace('name="r"', 'version="1.1"'),
        r"^x\.urdf:4: joint 'j': <origin>: quat_xyzw must not be zero$",
    ),
    "a quaternion of three numbers": (
        one_joint('<origin quat_xyzw="0 0 0"/>'),
        r"^x\.urdf:4: joint 'j': <origin>: quat_xyzw must be four numbers, got 3: '0 0 0'$",
    ),
    "a quaternion that is not finite": (
        one_joint('<origin quat_xyzw="0 0 0 inf"/>'),
        r"^x\.urdf:4: joint 'j': <origin>: quat_xyzw must be four finite numbers, got '0 0 0 inf'$",
    ),
    "NaN in limits": (
        one_joint('<limit lower="nan" upper="1"/>'),
        r"^x\.urdf:4: joint 'j': <limit>: lower must be a number, got 'nan'$",
    ),
    "text in limits": (
        one_joint('<limit lower="0" upper="high"/>'),
        r"^x\.urdf:4: joint 'j': <limit>: upper must be a number, got 'high'$",
    ),
    "a xacro expression in limits": (
        one_joint('<limit lower="${-x}" upper="1"/>'),
        r"^x\.urdf:4: joint 'j': <limit>: lower must be a number, got '\${-x}' \(an unprocessed xacro expression\?\)$",
    ),
    "a mimic of nothing": (
        one_joint(LIMIT + "<mimic/>"),
        r"^x\.urdf:4: joint 'j': <mimic>: expected an attribute joint",
    ),
    "an infinite multiplier": (
        one_joint(LIMIT + '<mimic joint="j" multiplier="inf"/>'),
        r"^x\.urdf:4: joint 'j': <mimic>: multiplier must be a finite number, got 'inf'$",
    ),
    "an offset that is none": (
        one_joint(LIMIT + '<mimic joint="j" offset="x"/>'),
        r"^x\.urdf:4: joint 'j': <mimic>: offset must be a finite number, got 'x'$",
    ),
    "a floating mimic": (
        one_joint('<mimic joint="j"/>', "floating"),
        (
            r"^x\.urdf:4: joint 'j': <mimic>: a floating joint has no single value and cannot mimic "
            r"another joint$"
        ),
    ),
    "a mimic of itself": (
        chain_of('<mimic joint="j0"/>'),
        r"^x\.urdf:2: joint 'j0' mimics itself$",
    ),
    "mimics in a circle": (
        chain_of('<mimic joint="j1"/>', '<mimic joint="j0"/>'),
        r"^x\.urdf:2: joint 'j0' mimics itself, through others$",
    ),
    "a mimic of a floating joint": (
        chain_of("", '<mimic joint="j0"/>').replace("continuous", "floating", 1),
        r"^x\.urdf:3: joint 'j1' mimics 'j0', but a floating joint has no single value$",
    ),
}


@pytest.mark.parametrize("text, message", REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_understood_is_refused_with_file_and_line(text, message, monkeypatch):
    monkeypatch.setattr(socket, "socket", _no_network)
    with pytest.raises(ModelError, match=message) as caught:
        urdf.read_text(text, "x.urdf")
    assert str(caught.value).isprintable()


def _no_network(*arguments: object) -> None:
    raise AssertionError("a URDF was about to open a connection")


@pytest.mark.parametrize("text", [None, 5, ["<robot/>"]])
def test_what_is_no_text_is_refused(text):
    with pytest.raises(InputError, match=r"^x\.urdf: expected a text, str or bytes, got "):
        urdf.read_text(text, "x.urdf")


def test_what_is_no_name_or_path_is_refused():
    with pytest.raises(
        InputError, match=r"^name: expected what to call the text in messages, a str, got None$"
    ):
        urdf.read_text(one_joint(), None)  # pyright: ignore[reportArgumentType]
    with pytest.raises(InputError, match=r"^expected the path of a file, got 5$"):
        urdf.read(5)  # pyright: ignore[reportArgumentType]


def test_no_entity_is_ever_expanded_and_no_file_is_read(tmp_path):
    secret = tmp_path / "secret.txt"
    secret.write_text("the secret", encoding="utf-8")
    included = f'<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="{secret.as_uri()}" parse="text"/>'
    robot = urdf.read_text(one_joint().replace("</robot>", included + "</robot>"))
    assert robot.links == ("a", "b")
    with pytest.raises(ModelError) as caught:
        urdf.read_text(f'<!DOCTYPE r [<!ENTITY e SYSTEM "{secret.as_uri()}">]><robot name="&e;"/>')
    assert "secret" not in str(caught.value)


HOSTILE = "[/b]<script>\u202e{0}%s\u200b\n\x85"


@pytest.mark.parametrize(
    "spoil",
    [
        (lambda text, name: text.replace('link name="b"', f'link name="{name}"')),
        (lambda text, name: text.replace('name="j" type="revolute"', f'name="{name}" type="ball"')),
        (lambda text, name: text.replace('type="revolute"', f'type="{name}"')),
        lambda text, name: text.replace("<limit", f'<mimic joint="{name}"/><limit').replace(
            'parent link="a"', "parent"
        ),
        (lambda text, name: text.replace('lower="-1"', f'lower="{name}"')),
        (lambda text, name: text.replace("<limit", f'<origin xyz="{name}"/><limit')),
    ],
    ids=["link", "joint", "kind", "mimic", "limit", "origin"],
)
def test_hostile_names_are_shown_harmlessly(spoil: Callable[[str, str], str]):
    escaped = HOSTILE.replace("<", "&lt;").replace("\n", "&#10;")
    with pytest.raises(ModelError) as caught:
        urdf.read_text(spoil(one_joint(), escaped), "dir/\x1b[31m\u202e.urdf")
    assert str(caught.value).isprintable()
    assert "\\x1b" in str(caught.value)


def test_hostile_names_in_a_good_robot_are_kept_as_they_are():
    robot = urdf.read_text(one_joint().replace('"b"', '"[/b]\u202e&lt;"'))
    assert robot.leaves == ("[/b]\u202e<",)
    assert repr(robot).isprintable()


@given(st.binary(max_size=200))
def test_bytes_of_any_kind_are_read_or_refused(data):
    _read_or_refuse(data)


@given(st.integers(0, 400), st.integers(0, 400), st.text(max_size=4))
def test_a_robot_with_any_piece_replaced_is_read_or_refused(start, stop, piece):
    text = one_joint('<origin xyz="0 0 1"/><axis xyz="0 0 1"/>' + LIMIT)
    _read_or_refuse(text[:start] + piece + text[stop:])


def _read_or_refuse(text: str | bytes) -> None:
    message = ""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        try:
            assert isinstance(urdf.read_text(text), Robot)
        except ModelError as error:
            message = str(error)
    assert message.isprintable()


def test_a_file_that_cannot_be_read_is_refused_by_name(tmp_path):
    empty, large = tmp_path / "empty.urdf", tmp_path / "large.urdf"
    empty.touch()
    with large.open("wb") as stream:
        stream.truncate(
            xml.MAX_BYTES + 1
        )  # a hole: no byte of it is written, and none must be read
    cases = [
        (tmp_path / "gone.urdf", "cannot be read: No such file or directory"),
        (tmp_path, "expected a file, this is a directory"),
        (empty, "the file is empty"),
        (large, "expected at most 64 MiB, the file has 64.0 MiB"),
        (str(tmp_path / "a\0b"), "cannot be read: ..."),
        (str(tmp_path / ("x" * 5000)), "cannot be read: File name too long"),
    ]
    for path, message in cases:
        with pytest.raises(FileError) as caught:
            urdf.read(path)
        assert str(caught.value).isprintable()
        if len(str(path)) < 400:
            assert says(caught.value, f"{escape_unprintable(path, None)}: {message}")
        assert isinstance(caught.value, PoekinError)
        assert isinstance(caught.value, OSError)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
def test_a_pipe_is_refused_without_waiting_for_it(tmp_path):
    pipe = tmp_path / "pipe.urdf"
    os.mkfifo(pipe)
    with pytest.raises(FileError) as caught:
        urdf.read(pipe)
    assert says(caught.value, f"{pipe}: expected a file, this is a device, pipe or socket")


def test_a_text_over_the_limit_is_refused(monkeypatch):
    monkeypatch.setattr(xml, "MAX_BYTES", 100)
    with pytest.raises(ModelError, match=r"^<text>: expected at most 64 MiB, got 0\.0 MiB$"):
        urdf.read_text(one_joint())


def test_a_file_that_has_grown_since_it_was_measured_is_refused_and_not_cut(tmp_path, monkeypatch):
    path, before = tmp_path / "a.urdf", tmp_path / "before.urdf"
    path.write_text(one_joint())
    before.write_text("<robot/>")
    status = before.stat()
    monkeypatch.setattr(xml, "MAX_BYTES", len(one_joint()) - 1)
    with monkeypatch.context() as patched:
        patched.setattr(xml.os, "stat", lambda path: status)
        data = xml.read_bytes(path)
    with pytest.raises(ModelError, match=r"^<text>: expected at most 64 MiB, got 0\.0 MiB$"):
        urdf.read_text(data)


SENTENCES = {
    "root": ("<mujoco/>", "x.urdf:1: expected the root element <robot>, got 'mujoco'"),
    "empty name": ('<robot>\n<link name=""/></robot>',
                   "x.urdf:2: <link>: expected an attribute name=\"...\", it is empty"),
    "no type": (joint_of('name="j"'), "x.urdf:3: joint 'j': expected an attribute type=\"...\", there is none"),
    "type": (joint_of('name="j" type="ball"'),
             "x.urdf:3: joint 'j': type must be one of revolute, continuous, prismatic, fixed, floating, planar,"
             " got 'ball'"),
    "no child": (joint_of(ends='<parent link="a"/>'),
                 "x.urdf:3: joint 'j': expected an element <child link=\"...\"/>, there is none"),
    "two": (joint_of(ends='<parent link="a"/><child link="b"/><child link="b"/>'),
            "x.urdf:4: joint 'j': <child>: it appears 2 times, expected once"),
    "count": (one_joint('<origin xyz="0 1"/>'),
              "x.urdf:4: joint 'j': <origin>: xyz must be three numbers, got 2: '0 1'"),
    "xacro": (one_joint('<origin rpy="${x} 0 0"/>'),
              "x.urdf:4: joint 'j': <origin>: rpy must be three finite numbers, got '${x} 0 0'"
              " (an unprocessed xacro expression?)"),
    "far": (one_joint('<origin xyz="0 -1e155 0"/>'),
            "x.urdf:4: joint 'j': <origin>: xyz: expected lengths of at most 1e+100 m, got (0.0, -1e+155, 0.0)"),
    "axis": (one_joint("<axis/>"), "x.urdf:4: joint 'j': <axis>: expected an attribute xyz=\"...\", there is none"),
    "velocity": (one_joint('<limit lower="0" upper="1" velocity="fast"/>'),
                 "x.urdf:4: joint 'j': <limit>: velocity must be a number, got 'fast'"),
    "effort": (one_joint('<limit lower="0" upper="1" effort="nan"/>'),
               "x.urdf:4: joint 'j': <limit>: effort must be a number, got 'nan'"),
    "damping": (one_joint(LIMIT + '<dynamics damping="inf"/>'),
                "x.urdf:4: joint 'j': <dynamics>: damping must be a finite number, got 'inf'"),
    "safety": (one_joint(LIMIT + '<safety_controller k_velocity="1,5"/>'),
               "x.urdf:4: joint 'j': <safety_controller>: k_velocity must be a finite number, got '1,5'"),
    "limit": (one_joint('<limit lower="0" upper="high"/>'),
              "x.urdf:4: joint 'j': <limit>: upper must be a number, got 'high'"),
    "multiplier": (one_joint(LIMIT + '<mimic joint="j" multiplier="inf"/>'),
                   "x.urdf:4: joint 'j': <mimic>: multiplier must be a finite number, got 'inf'"),
}  # fmt: skip


@pytest.mark.parametrize("case", SENTENCES)
def test_a_refusal_says_file_line_element_what_was_expected_and_what_arrived(case):
    text, message = SENTENCES[case]
    with pytest.raises(ModelError) as caught:
        urdf.read_text(text, "x.urdf")
    assert str(caught.value) == message


def test_a_mimic_of_a_joint_that_does_not_exist_is_said_with_both_names():
    text = one_joint(LIMIT + '<mimic joint="k"/>')
    with pytest.warns(PoekinWarning) as caught:
        urdf.read_text(text, "x.urdf")
    assert (
        str(caught[0].message)
        == "x.urdf:4: joint 'j' mimics 'k', which does not exist, and stays independent"
    )
