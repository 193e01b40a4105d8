"""MJCF files that MuJoCo does not survive are refused before it opens them; what it says beside is
not written down.
"""

from __future__ import annotations

import itertools
import os

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]  (it is compiled and has no stubs)

from poekin.errors import FileError, ModelError
from poekin.formats.load import load
from poekin.formats.mjcf import mjcf, mjcf_files
from poekin.formats.mjcf.mjcf_files import MOST_COPIES

mujoco = pytest.importorskip("mujoco", reason="the package mujoco is not installed")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Writes files into an empty folder, which is the working directory as well."""
    monkeypatch.chdir(tmp_path)

    def write(**texts: str):
        for name, text in texts.items():
            path = tmp_path / f"{name.replace('__', '/')}.xml"
            path.parent.mkdir(exist_ok=True)
            path.write_text(f"<mujoco>{text}</mujoco>")
        return tmp_path

    return write


def model(name: str) -> str:
    return f'<asset><model name="m" file="{name}.xml"/></asset>'


def test_a_model_that_attaches_itself_is_refused(folder):
    there = folder(a=model("a"))
    with pytest.raises(ModelError, match=r"a\.xml:1: <model>: .*a\.xml includes itself"):
        load(there / "a.xml")


def test_models_that_attach_each_other_through_an_include_are_refused(folder):
    there = folder(a=model("sub/b"), sub__b='<include file="c.xml"/>', sub__c=model("../a"))
    with pytest.raises(ModelError, match=r"c\.xml:1: <model>: .*a\.xml includes itself"):
        load(there / "a.xml")
    with pytest.raises(ModelError, match="includes itself"):
        mjcf.read_text(f"<mujoco>{model('a')}</mujoco>")


def test_a_file_of_the_same_name_in_another_folder_is_another_file(folder):
    there = folder(
        a=model("sub/a") + '<worldbody><attach model="m" body="b" prefix="p_"/></worldbody>',
        sub__a='<include file="c.xml"/>',
        sub__c='<worldbody><body name="b"/></worldbody>',
        c=model("a"),
    )
    assert load(there / "a.xml").links == ("world", "p_b")


def test_files_that_name_the_next_one_twice_are_not_all_opened(folder):
    names = [chr(ord("a") + i) for i in range(20)]
    texts = {a: model(b) + model(b) for a, b in itertools.pairwise(names)}
    with pytest.raises(ModelError, match=r"<model>: expected at most 1000 files"):
        load(folder(**texts, t="") / "a.xml")


@pytest.mark.parametrize("most, refused", [(2, False), (1, True)])
def test_as_many_files_are_opened_as_are_allowed(folder, monkeypatch, most, refused):
    monkeypatch.setattr(mjcf_files, "MOST_FILES", most)
    there = folder(
        a='<include file="b.xml"/><include file="c.xml"/>', b="<worldbody/>", c="<worldbody/>"
    )
    if refused:
        with pytest.raises(ModelError, match=rf"a\.xml:\d: <include>: expected at most {most} files, one for each time "
                           "that one is named$"):  # fmt: skip
            load(there / "a.xml")
    else:
        assert load(there / "a.xml").links == ("world",)


def test_what_is_included_is_looked_through_as_well(folder):
    there = folder(a='<include file="b.xml"/>', b='<worldbody>\n<body pos="0 nan 0"/></worldbody>')
    with pytest.raises(
        ModelError, match=r"b\.xml:2: <body>: pos must be finite numbers, got '0 nan 0'"
    ):
        load(there / "a.xml")
    (there / "b.xml").write_text("<!DOCTYPE mujoco [<!ENTITY x 'y'>]><mujoco/>")
    with pytest.raises(ModelError, match=r"b\.xml:1: a document type declaration"):
        load(there / "a.xml")
    (there / "b.xml").write_text("")
    with pytest.raises(FileError, match=r"b\.xml: the file is empty"):
        load(there / "a.xml")


def test_a_file_is_looked_for_beside_the_model_wherever_the_process_stands(
    folder, tmp_path, monkeypatch
):
    there = folder(
        sub__a='<include file="b.xml"/>',
        sub__b='<worldbody><body pos="0 nan 0"/></worldbody>',
        b="",
    )
    for place, name in (
        (tmp_path, "sub/a.xml"),
        (tmp_path, str(there / "sub" / "a.xml")),
        (there / "sub", "a.xml"),
    ):
        monkeypatch.chdir(place)
        with pytest.raises(ModelError, match=r"sub.b\.xml:1: <body>: pos must be finite"):
            load(name)


def test_includes_are_looked_for_beside_the_model_first_and_models_beside_the_file_that_names_them(
    folder,
):
    bad = '<worldbody><body pos="0 nan 0"/></worldbody>'
    there = folder(a='<include file="sub/b.xml"/>', sub__b='<include file="c.xml"/>', c=bad)
    with pytest.raises(ModelError, match=r"c\.xml:1: <body>: pos must be finite"):
        load(there / "a.xml")
    there = folder(a='<include file="sub/b.xml"/>', sub__b=model("c"), c=model("a"), sub__c=bad)
    with pytest.raises(ModelError, match=r"sub.c\.xml:1: <body>: pos must be finite"):
        load(there / "a.xml")


def test_a_folder_or_device_that_is_included_is_refused(folder):
    for name in (".", "/dev/zero", "&#xE000;.xml"):
        there = folder(a=f'<include file="{name}"/>')
        with pytest.raises(ModelError, match="MuJoCo refuses this model"):
            load(there / "a.xml")
        assert os.listdir(there) == ["a.xml"]


def test_a_name_that_no_file_can_have_here_is_no_file(folder, monkeypatch):
    def latin_1(name):
        return name.encode("latin-1")

    there = folder(a='<include file="&#x10D;.xml"/>')
    monkeypatch.setattr(os, "fsencode", latin_1)  # as where the locale is not UTF-8
    monkeypatch.setattr(os.path, "isfile", latin_1)
    with pytest.raises(ModelError, match="MuJoCo refuses this model"):
        load(there / "a.xml")


@pytest.mark.parametrize(
    "count", [MOST_COPIES + 1, 10**9, "9" * 5000], ids=["one too many", "10^9", "10^5000"]
)
def test_copies_without_measure_are_refused(count):
    inner = f'<replicate count="{count}"><body/></replicate>'
    with pytest.raises(
        ModelError, match=f"<replicate>: expected at most {MOST_COPIES} elements in copies"
    ):
        mjcf.read_text(f"<mujoco><worldbody>{inner}</worldbody></mujoco>")


def test_copies_of_copies_are_counted():
    inner = '<replicate count="60"><body/></replicate>'
    text = f'<mujoco><worldbody><replicate count="{{}}">{inner}</replicate></worldbody></mujoco>'
    assert len(mjcf.read_text(text.format(5)).links) == 301
    with pytest.raises(
        ModelError, match=r"^<text>: <replicate>: expected at most 5000 elements in copies$"
    ):
        mjcf.read_text(text.format(600))


@st.composite
def replicas(draw, deep=3):
    """Elements, some of them <replicate>, below one another."""
    inside = [draw(replicas(deep - 1)) for _ in range(draw(st.integers(0, 2)))] if deep else []
    if not draw(st.booleans()):
        return f"<body>{''.join(inside)}</body>"
    count = draw(st.sampled_from(["0", "1", "2", "3", "0.5", "x", None]))
    said = "" if count is None else f' count="{count}"'
    return f"<replicate{said}>{''.join(inside)}</replicate>"


def copied(element, times=1):
    """The elements below one, each as often as it is copied there, where that is more than once."""
    own = element.get("count", "1") if element.tag == "replicate" else "1"
    times *= int(own) if own in ("2", "3") else 1
    for child in element:
        yield from [child] * times * (times > 1)
        yield from copied(child, times)


@given(st.lists(replicas(), max_size=3))
def test_elements_below_replicates_are_counted_as_often_as_they_are_copied(texts):
    root = etree.fromstring(f"<mujoco>{''.join(texts)}</mujoco>")
    assert mjcf_files._copies(root) == len(list(copied(root)))


@pytest.mark.parametrize(("most", "refused"), [(8, False), (7, True)])
def test_as_many_copies_are_made_as_are_allowed_in_all_files_together(
    folder, monkeypatch, most, refused
):
    monkeypatch.setattr(mjcf_files, "MOST_COPIES", most)
    twice = '<worldbody><body/><replicate count="{}"><body/></replicate></worldbody>'
    there = folder(a='<include file="b.xml"/>' + twice.format(3), b=twice.format(5))
    if refused:
        with pytest.raises(ModelError, match=f"expected at most {most} elements in copies$"):
            load(there / "a.xml")
    else:
        assert len(load(there / "a.xml").links) == 1 + 2 + 8


def test_keyframes_are_not_made():
    assert mjcf.read_text('<mujoco><size nkey="1000000000"/></mujoco>').links == ("world",)


@pytest.mark.parametrize(
    "joint",
    [
        'pos="7 1 inf"',
        'ref="inf"',
        'type="slide" ref="-1e999"',
        'axis="inf 0 0"',
        'pos="1e308 1e308 0" axis="0 0 1"',
    ],
)
def test_numbers_too_large_are_refused_without_a_warning(joint):
    with pytest.raises(ModelError, match=r"^m: "):
        mjcf.read_text(
            f"<mujoco><worldbody><body><joint {joint}/></body></worldbody></mujoco>", "m"
        )


def test_what_mujoco_warns_of_is_written_nowhere(folder, capfd):
    before = mujoco.get_mju_user_warning()
    there = folder(a='<option timestep="nan"/>')
    assert load(there / "a.xml").links == ("world",)
    assert os.listdir(there) == ["a.xml"]
    assert capfd.readouterr().err == ""
    assert mujoco.get_mju_user_warning() is before


def test_names_in_another_encoding_are_refused_as_mujoco_reads_utf_8_only(tmp_path):
    text = '<mujoco><worldbody><body name="\xfc"><geom size=".1"/></body></worldbody></mujoco>'
    path = tmp_path / "l.xml"
    path.write_bytes(b'<?xml version="1.0" encoding="iso-8859-1"?>' + text.encode("latin-1"))
    with pytest.raises(
        ModelError, match=r"l\.xml: MuJoCo reads UTF-8 only, and a name is in another"
    ):
        load(path)
    path.write_text(text, encoding="utf-8")
    assert load(path).links[-1] == "\xfc"


@pytest.mark.skipif(os.name == "nt", reason="paths are Unicode there")
def test_a_path_that_is_no_utf_8_is_refused(tmp_path):
    folder = os.fsencode(tmp_path) + b"/\xff"
    try:
        os.mkdir(folder)
    except OSError as fault:
        pytest.skip(f"this file system: {fault}")
    path = os.fsdecode(folder + b"/m.xml")
    with open(path, "w", encoding="utf-8") as file:
        file.write('<mujoco><worldbody><body name="a"/></worldbody></mujoco>')
    with pytest.raises(ModelError, match=r"m\.xml: MuJoCo refuses this model: 'utf-8' codec can't"):
        load(path)
