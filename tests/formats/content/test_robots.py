"""from_text: every kind of model as a text, equal to the file of it."""

from __future__ import annotations

import gzip
import importlib.util
import os

import pytest

import poekin as pk
from poekin.errors import InputError, ModelError, PoekinError
from poekin.formats import chain_toml, urdf
from poekin.formats.content.robots import from_text
from poekin.formats.load import load
from poekin.formats.text import xml
from tests.formats.texts import one_joint
from tests.formats.vendors import origins

MJCF = """<mujoco model="m"><worldbody><body name="a" pos="1 0 0"><geom size="1"/>
<joint name="j" axis="0 0 1"/></body></worldbody></mujoco>"""
needs_mujoco = pytest.mark.skipif(
    importlib.util.find_spec("mujoco") is None, reason="mujoco is not installed"
)


def calibration() -> str:
    """The text of a file of a calibration: a chain, and what it was before."""
    chain = chain_toml.to_data(load("ur5e").chain(tip="tool0"))
    data = {"format": chain_toml.FORMAT, "version": chain_toml.VERSION}
    return chain_toml.toml_text.make_text(data | {chain_toml.CALIBRATED: chain})


@pytest.fixture
def files(tmp_path):
    """A file of each kind of model."""
    made = {
        "a.urdf": one_joint(),
        "b.toml": "",
        "c.csv": "",
        "d.toml": calibration(),
        "e.yaml": "",
    }
    for name, text in made.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    for name in ("b.toml", "c.csv"):
        pk.dh.write(pk.dh.published("ur10e"), tmp_path / name)
    table = pk.dh.published("ur10e")
    pk.vendors.write(pk.ur.from_dh(table, nominal=table), tmp_path / "e.yaml")
    if importlib.util.find_spec("mujoco"):
        (tmp_path / "f.xml").write_text(MJCF)
    return sorted(tmp_path.iterdir())


def test_every_kind_of_file_is_the_same_robot_as_a_text(files):
    assert len({path.suffix for path in files}) >= 4
    for path in files:
        expected = load(path)
        text = path.read_text(encoding="utf-8")
        for content in (
            text,
            text.encode(),
            bytearray(text.encode()),
            gzip.compress(text.encode()),
        ):
            robot = from_text(content, path.name)  # type: ignore[arg-type]
            assert robot == expected
            if path.suffix == ".xml":
                continue
            # and where the name of a file says nothing
            plain = path.with_name("model.txt")
            plain.write_bytes(bytes(content) if not isinstance(content, str) else content.encode())
            assert load(plain).joints == expected.joints


def test_a_text_is_named_in_messages_and_is_no_file():
    robot = from_text(one_joint(), "the topic")
    assert robot.source is not None
    assert (str(robot.source), robot.source.text) == ("the topic", one_joint())
    assert str(from_text(one_joint()).source) == "<text>"
    with pytest.raises(ModelError, match=r"^the topic:3: joint 'j': type must be"):
        from_text(one_joint(kind="odd"), "the topic")
    with pytest.raises(ModelError, match=r"^c:2: .*expected"):
        from_text("convention,theta,d,a,alpha\nstandard,x,0,0,0\n", "c")
    with pytest.raises(ModelError, match=r"^t: .*convention"):
        from_text('convention = "odd"\n', "t")
    with pytest.raises(ModelError, match=r"^y:2: kinematics: "):
        from_text("kinematics:\n  shoulder: 1\n", "y")


def test_xml_keeps_its_own_encoding_as_bytes():
    text = one_joint().replace('name="a"', 'name="ü"').replace('link="a"', 'link="ü"')
    for encoding in ("iso-8859-1", "utf-16"):
        declared = f'<?xml version="1.0" encoding="{encoding}"?>{text}'
        assert from_text(declared.encode(encoding)) == from_text(declared) == from_text(text)


def test_the_text_of_a_robot_is_the_urdf_in_a_message(tmp_path):
    path = tmp_path / "arm.txt"
    for content in (
        one_joint(),
        one_joint() + "\n---\n",
        "data: "
        + one_joint("", "fixed", "<link name='a'/><link name='b'/>").replace("\n", " ")
        + "\n---\n",
    ):
        path.write_text(content, encoding="utf-8")
        robot = load(path)
        assert robot.source is not None
        text = robot.source.text
        assert isinstance(text, str) or content == one_joint()
        plain = text.decode() if isinstance(text, bytes) else text
        assert plain.startswith("<robot")
        assert plain.rstrip().endswith("</robot>")
        assert urdf.read_text(plain) == robot


def test_a_message_in_a_yaml_file_is_no_calibration(tmp_path):
    path = tmp_path / "robot.yaml"
    text = one_joint().replace("\n", " ").replace('"', "'")
    for message in (
        f'data: "{text}"\n---\n',
        f'node:\n  ros__parameters:\n    robot_description: "{text}"\n',
    ):
        path.write_text(message, encoding="utf-8")
        assert load(path).name == "r"
    path.write_text("joints:\n  a: 1\n")
    with pytest.raises(ModelError, match="kinematics"):
        load(path)


@needs_mujoco
def test_a_model_of_mujoco_is_a_text_but_no_file_of_another_ending(tmp_path):
    assert from_text(MJCF).links == from_text(MJCF.encode()).links == ("world", "a")
    (tmp_path / "arm.txt").write_text(MJCF)
    with pytest.raises(ModelError, match="expected the root element <robot>, got 'mujoco'"):
        load(tmp_path / "arm.txt")
    mentioned = one_joint().replace("<link", "<!-- no <mujoco here --><link", 1)
    assert from_text(mentioned) == from_text(one_joint())


REFUSED = {
    "a number": (7, "from_text: expected a text, str or bytes, got 7"),
    "nothing": (None, "from_text: expected a text, str or bytes, got None"),
    "a path": (os.curdir.__class__, "from_text: expected a text, str or bytes, got <class 'str'>"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_no_text_is_refused(case):
    given, message = REFUSED[case]
    with pytest.raises(InputError) as caught:
        from_text(given)
    assert str(caught.value) == message
    with pytest.raises(InputError, match=r"^from_text: name: expected a str, got 7$"):
        from_text(one_joint(), 7)  # type: ignore[arg-type]


EXPECTED = (
    "expected a URDF, an MJCF, /robot_description as ROS prints it, a DH table or a calibration"
)
UNKNOWN = {
    "empty": ("", "<text>: the text is empty"),
    "blank": (b" \n", "<text>: the text is empty"),
    "blank as Unicode has it": (b"\x1f\n", "<text>: the text is empty"),
    "words": ("\n\nhello all\n", f"<text>:3: {EXPECTED}, got 'hello all'"),
    "a name": (
        "panda",
        f"<text>:1: {EXPECTED}, got 'panda'; the name of a robot or file is for load",
    ),
    "a path": (
        "a/arm.urdf\n",
        f"<text>:1: {EXPECTED}, got 'a/arm.urdf'; the name of a robot or file is for load",
    ),
    "binary": (b"\x7fELF\0\0", f"<text>:1: {EXPECTED}, got '\\x7fELF\\x00\\x00'"),
    "no UTF-8": (b"\xff\xfa", "<text>: not UTF-8 at byte 0"),
}


@pytest.mark.parametrize("case", UNKNOWN)
def test_a_text_that_is_no_model_is_refused(case):
    text, message = UNKNOWN[case]
    with pytest.raises(ModelError) as caught:
        from_text(text)
    assert str(caught.value) == message


def test_a_text_over_the_limit_is_refused(monkeypatch):
    monkeypatch.setattr(xml, "MAX_BYTES", 100)
    for text in (one_joint(), "data: " + "x" * 95):
        with pytest.raises(ModelError, match=r"^<text>: expected at most 64 MiB, got 0\.0 MiB$"):
            from_text(text)
    long = "kinematics:\n  a: 1\n" + "# comment\n" * 10_000
    monkeypatch.undo()
    with pytest.raises(ModelError) as caught:
        from_text(long)
    assert str(caught.value) == (
        f"<text>: expected a calibration of at most 65536 characters, got {len(long)}"
    )


def test_the_time_for_a_text_grows_with_its_length_only():
    # with a square of it, each of these would take minutes
    many = 1_000_000
    for text in (
        "\n" * many + "hello all",
        "a: 1\n" + "\n" * many,
        "---\n" + "\n" * many,
        "---\n" + " " * many,
        "<robot>" + "\n" * many + "\n---\n",
        "<robot>" + "<a/>\n" * (many // 5) + "...",
        "</" * (many // 2) + "\n---",
        "# x\n" * (many // 4),
        "x" * many + ":",
        "[" * many,
        "a," * (many // 2),
    ):
        with pytest.raises(PoekinError):
            from_text(text)


def test_every_vendor_s_calibration_is_a_text():
    for text in (
        origins.yaml(origins.UFACTORY["xarm6"]),
        origins.yaml(origins.RIZON_4S, axes=origins.RIZON_AXES, flange=origins.RIZON_FLANGE),
        origins.yaml(origins.UR5E, names=origins.UR_LINKS) + "  hash: calib_1\n",
    ):
        assert from_text(text) == pk.vendors.yaml_io.read_text(text).to_robot()


def test_what_is_hostile_in_a_text_stays_refused():
    doctype = '<!DOCTYPE r [<!ENTITY e "x">]><robot name="r"><link name="&e;"/></robot>'
    with pytest.raises(ModelError, match="document type declaration"):
        from_text(doctype)
    with pytest.raises(ModelError, match="document type declaration"):
        from_text("data: '" + doctype.replace("'", "''") + "'\n---\n")
    with pytest.raises(ModelError, match=r"xacro that was not processed yet"):
        from_text('<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:m/></robot>')
    with pytest.raises(ModelError) as caught:
        from_text("\x1b[31mred\n")
    assert str(caught.value).isprintable()
