"""XML: slips of real files that other readers pass over are read and told; all else is refused."""

from __future__ import annotations

import warnings

import pytest

from poekin.errors import FileError, ModelError, PoekinWarning
from poekin.formats import urdf
from poekin.formats.mjcf import mjcf
from poekin.formats.text import xml
from tests.formats.texts import LIMIT, one_joint

TEXT = one_joint(LIMIT)
PREFIX = "Namespace prefix drake for acceleration on limit is not defined"
SLIPS = {
    "a version that there is not": (
        '<?xml version="0.0" ?>\n' + TEXT,
        "f:1: Unsupported version '0.0': the text is read as XML 1.0",
    ),
    "blanks before the declaration": (
        ' \n\n<?xml version="1.0"?>' + TEXT,
        "f:1: blanks before the XML declaration are passed over",
    ),
    "a prefix of an attribute": (
        one_joint('<limit lower="-1" upper="1" drake:acceleration="2"/>'),
        f"f:4: {PREFIX}: what the prefix marks is passed over",
    ),
    "a prefix of a joint": (
        one_joint(LIMIT + '\n</joint>\n<drake:joint name="k"><parent link="a"/>').replace(
            "\n</joint>\n</robot>", "\n</drake:joint>\n</robot>"
        ),
        "f:6: Namespace prefix drake on joint is not defined: what the prefix marks is passed over",
    ),
}


@pytest.mark.parametrize(("text", "words"), SLIPS.values(), ids=SLIPS)
def test_a_slip_that_others_pass_over_is_read_and_told_with_its_line(text, words):
    for content in (text, text.encode()):
        with pytest.warns(PoekinWarning) as caught:
            robot = urdf.read_text(content, "f")
        assert [str(warning.message) for warning in caught] == [words]
        assert robot.joints == urdf.read_text(TEXT).joints


def test_a_declaration_behind_blanks_still_says_the_encoding():
    text = '\n<?xml version="1.0" encoding="iso-8859-1"?>' + TEXT.replace('"a"', '"ä"')
    with pytest.warns(PoekinWarning, match="blanks before"):
        robot = urdf.read_text(text.encode("iso-8859-1"))
    assert robot.links[0] == "ä"


def test_faults_behind_a_slip_keep_their_lines():
    text = '\n\n<?xml version="0.0"?>\n' + one_joint('<axis xyz="0 0 0"/>')
    with (
        pytest.warns(PoekinWarning),
        pytest.raises(ModelError, match=r"^f:7: joint 'j': <axis>: xyz"),
    ):
        urdf.read_text(text, "f")


@pytest.mark.parametrize(
    "text",
    [
        '<?xml version="0.0"?><robot><link></robot>',
        '<!-- a comment --><?xml version="1.0"?><robot/>',
        '\n<?xml version="1.0"?><robot><?xml version="1.0"?></robot>',
        '<?xml version="0.0"?><robot a="1" a="2"/>',
        "<robot><a:b/></robot><robot/>",
        '<?xml version="0.0"?><robot/>text',
        '<robot xmlns:a="a" a:b="1" c:d="2"></robot>\n<a:b>',
    ],
)
def test_a_slip_hides_no_fault(text):
    with pytest.raises(ModelError, match=r"^f:\d: malformed XML: "):
        xml.parse(text, "f")


def test_binary_data_are_called_so():
    with pytest.raises(ModelError, match=r"^f:1: malformed XML \(binary data\?\): '"):
        xml.parse(b"<robot".ljust(1023) + b"\0", "f")
    with pytest.raises(ModelError, match=r"^f:1: malformed XML: '"):
        xml.parse(b"<robot".ljust(1024) + b"\0", "f")


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("<robot>\n<a:b/>\n<c></d></robot>", 3, "Opening and ending tag mismatch"),
        ("<robot>\n<a:b/>\n<c>&e;</c></robot>", 3, "Entity 'e' not defined"),
        ('<?xml version="2.0"?>\n<robot>\n<xacro:c/></robot>', 3, "Namespace prefix xacro"),
    ],
)
def test_of_a_slip_and_a_fault_the_fault_is_named(text, line, words):
    with pytest.raises(ModelError, match=rf"^f:{line}: malformed XML: .{words}"):
        xml.parse(text, "f")


@pytest.mark.parametrize("encoding", ["GB2312", "Shift_JIS", "Big5", "klingon"])
def test_a_slip_in_an_encoding_that_cannot_be_looked_through_is_refused(encoding):
    text = f'<?xml version="1.0" encoding="{encoding}"?><robot><a:b/></robot>'
    with pytest.raises(ModelError, match="malformed XML"):
        xml.parse(text.encode(), "f")


def test_xacro_without_its_namespace_is_refused_behind_any_number_of_slips():
    for inside in ("<xacro:insert_block/>", '<c xacro:if="1"/>'):
        with pytest.raises(ModelError, match="malformed XML"):
            xml.parse("<robot>" + "<a:b/>" * 120 + inside + "</robot>", "f")


def test_xml_1_1_is_read_with_and_without_a_slip():
    assert xml.parse('<?xml version="1.1"?><robot/>', "f").tag == "robot"
    with pytest.warns(PoekinWarning, match="prefix a"):
        assert xml.parse('<?xml version="1.1"?><robot><a:b/></robot>', "f").tag == "robot"


@pytest.mark.parametrize("head", ['<?xml version="0.0"?>', '\n<?xml version="1.0"?>', ""])
def test_a_document_type_is_refused_behind_a_slip(head):
    with pytest.raises(ModelError, match="DOCTYPE"):
        xml.parse(head + '<!DOCTYPE r [<!ENTITY e "x">]><r:robot name="&e;"/>', "f")


def test_no_option_lets_the_parser_resolve_fetch_or_validate_anything():
    asked = {name for name, value in xml.SAFE.items() if value}
    assert asked == {"no_network", "remove_comments", "remove_pis"}
    assert set(xml.SAFE) - asked == {
        *("resolve_entities", "load_dtd", "dtd_validation", "attribute_defaults", "huge_tree"),
    }


def test_only_meshes_may_be_as_deep_as_they_like():
    text = "<robot>" + "<a>" * 300 + "</a>" * 300 + "</robot>"
    with pytest.raises(ModelError, match=r"^f:1: malformed XML: '.*depth"):
        xml.parse(text, "f")
    assert len(list(xml.parse(text, "f", huge=True).iter())) == 301


def test_a_text_is_read_up_to_its_limit(monkeypatch):
    for text, most, size in (
        ("<robot/>", 8, "0.0"),
        ("<robot>" + " " * 2**20 + "</robot>", 0, "1.0"),
    ):
        monkeypatch.setattr(xml, "MAX_BYTES", most or len(text))
        assert xml.parse(text, "f").tag == "robot"
        monkeypatch.setattr(xml, "MAX_BYTES", (most or len(text)) - 1)
        with pytest.raises(ModelError) as caught:
            xml.parse(text, "f")
        assert str(caught.value) == f"f: expected at most 64 MiB, got {size} MiB"


def test_a_file_of_text_is_read_up_to_its_limit_and_in_utf_8(tmp_path):
    file = tmp_path / "a.txt"
    file.write_bytes(b"\xef\xbb\xbf" + b"a" * 5117)
    assert xml.read_text(file, 5120) == ("a" * 5117, str(file))
    with pytest.raises(FileError) as caught:
        xml.read_text(file, 3 * 2**10)
    assert str(caught.value) == f"{file}: expected at most 3 KiB, the file has 5 KiB"
    with pytest.raises(FileError, match=r"the file has 5 KiB$"):
        xml.read_text(file, 5119)
    file.write_bytes(b"a" * 37 + b"\xff")
    with pytest.raises(FileError) as caught:
        xml.read_text(file)
    assert str(caught.value) == f"{file}: not UTF-8 at byte 37"


def test_how_large_a_file_is_that_is_too_large_is_said_in_mib(tmp_path):
    file = tmp_path / "a.txt"
    with file.open("wb") as stream:
        stream.truncate(100 * 2**20 + 2**19)  # a hole, which takes no room
    with pytest.raises(FileError) as caught:
        xml.read_bytes(file)
    assert str(caught.value) == f"{file}: expected at most 64 MiB, the file has 100.5 MiB"


def test_asking_what_a_file_is_tells_nothing(tmp_path):
    file = tmp_path / "a.xml"
    file.write_text('<?xml version="0.0"?><mujoco/>')
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert mjcf.is_mjcf(file)
