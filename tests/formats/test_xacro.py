"""Xacro: evaluated only when asked for, relative to the file, and refused in one line."""

from __future__ import annotations

import gzip
import importlib.util
import locale
import sys

import pytest

from poekin.errors import FileError, InputError, MissingExtra, ModelError, PoekinWarning
from poekin.formats.load import load
from poekin.formats.xacro import is_xacro, xacro

needs_utf8 = pytest.mark.skipif(
    locale.getpreferredencoding(False).upper() != "UTF-8",
    reason="xacro reads files in the encoding of the locale",
)
needs_xacro = pytest.mark.skipif(
    importlib.util.find_spec("xacrodoc") is None, reason="xacrodoc is not installed"
)

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
ARM = (
    HEAD + '<xacro:arg name="length" default="0.5"/><xacro:include filename="parts/link.xacro"/>'
    '<xacro:body n="a"/><xacro:body n="b"/><joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
    '<origin xyz="$(arg length) ${height} 0" rpy="${pi/2} 0 0"/></joint></robot>'
)


@pytest.fixture
def arm(tmp_path):
    """A xacro file that includes another one, which includes a third from its own folder."""
    parts = tmp_path / "parts"
    parts.mkdir()
    (tmp_path / "arm.xacro").write_text(ARM)
    (parts / "link.xacro").write_text(
        HEAD + '<xacro:macro name="body" params="n"><link name="${n}"/></xacro:macro>'
        '<xacro:include filename="size.xacro"/></robot>'
    )
    (parts / "size.xacro").write_text(HEAD + '<xacro:property name="height" value="0.75"/></robot>')
    return tmp_path / "arm.xacro"


@needs_xacro
def test_a_file_is_evaluated_with_its_arguments_and_includes_of_its_own_folder(arm):
    robot = xacro(arm)
    assert (robot.name, robot.links) == ("r", ("a", "b"))
    assert robot.joints[0].origin[:3, 3].tolist() == [0.5, 0.75, 0]
    assert xacro(arm, length=0.25).joints[0].origin[0, 3] == 0.25
    assert xacro(str(arm), length="0.25") == xacro(arm, length=0.25)


@needs_xacro
@needs_xacro
def test_an_argument_that_the_file_has_not_is_warned_of(arm):
    with pytest.warns(PoekinWarning) as caught:
        xacro(arm, lenght=2)
    [said] = caught
    assert str(said.message).endswith(
        "xacro: it has no <xacro:arg> 'lenght'; did you mean 'length'?"
    )


def test_truth_values_are_xacros(tmp_path):
    path = tmp_path / "t.xacro"
    path.write_text(
        HEAD + '<xacro:arg name="x" default="false"/><link name="a"/><xacro:if value="$(arg x)">'
        '<link name="b"/></xacro:if></robot>'
    )
    assert xacro(path).links == xacro(path, x=False).links == ("a",)
    with pytest.raises(ModelError, match="has one root, but 2 links have no parent"):
        xacro(path, x=True)
    with pytest.raises(
        InputError, match=r"^xacro: x: expected a text, number or truth value, got \[1\]$"
    ):
        xacro(path, x=[1])  # type: ignore[arg-type]


@needs_xacro
def test_the_version_of_the_root_element_stays(tmp_path):
    """Without it URDF has no quat_xyzw."""
    text = ARM[ARM.index("<joint") :].replace('rpy="${pi/2} 0 0"', 'quat_xyzw="0 0 ${s} ${s}"')
    (tmp_path / "arm.xacro").write_text(
        f'<robot version="1.1" {HEAD.removeprefix("<robot ")}<xacro:arg name="length" default="1"/>'
        '<xacro:property name="height" value="2"/><xacro:property name="s" value="${sqrt(0.5)}"/>'
        f'<link name="a"/><link name="b"/>{text}'
    )
    R = xacro(tmp_path / "arm.xacro").joints[0].origin[:3, :3]
    assert abs(R - [[0, -1, 0], [1, 0, 0], [0, 0, 1]]).max() < 1e-15


@needs_xacro
def test_a_path_of_special_characters_is_a_path(tmp_path):
    folder = tmp_path / 'a [1] ${x} $(find y) "q" & *'
    folder.mkdir()
    (folder / "r.xacro").write_text(HEAD + '<link name="a"/></robot>')
    assert xacro(folder / "r.xacro").links == ("a",)


@needs_xacro
def test_a_package_is_found_above_the_file_and_is_not_that_of_the_next_file(tmp_path):
    for name, length in (("one", "1"), ("two", "2")):
        (tmp_path / name / "urdf").mkdir(parents=True)
        (tmp_path / name / "package.xml").write_text("<package><name>some_arm</name></package>")
        (tmp_path / name / "urdf" / "p.xacro").write_text(
            HEAD + f'<link name="l{length}"/></robot>'
        )
        (tmp_path / name / "urdf" / "r.xacro").write_text(
            HEAD + '<xacro:include filename="$(find some_arm)/urdf/p.xacro"/></robot>'
        )
    assert [xacro(tmp_path / name / "urdf" / "r.xacro").links for name in ("one", "two", "one")] == [
        ("l1",), ("l2",), ("l1",),
    ]  # fmt: skip


USES = HEAD + '<xacro:include filename="$(find my_arm)/urdf/p.xacro"/></robot>'


def _package(folder, link: str) -> None:
    """A package with a file of one link."""
    (folder / "urdf").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>my_arm</name></package>")
    (folder / "urdf" / "p.xacro").write_text(HEAD + f'<link name="{link}"/></robot>')


def _installed(prefix, link: str) -> None:
    """The package as colcon installs it."""
    _package(prefix / "share" / "my_arm", link)
    index = prefix / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "my_arm").touch()


@needs_xacro
def test_a_package_is_found_beside_the_file_then_where_the_environment_says(tmp_path, monkeypatch):
    file = tmp_path / "ws" / "mine" / "r.xacro"
    file.parent.mkdir(parents=True)
    file.write_text(USES)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    with pytest.raises(ModelError) as caught:
        xacro(file)
    assert str(caught.value) == (
        f"{file}: xacro: there is no package 'my_arm' in the folders above the file and beside these, in"
        " AMENT_PREFIX_PATH (not set) or ROS_PACKAGE_PATH (not set), and where xacrodoc.packages.look_in"
        " was told to"
    )
    _package(tmp_path / "src" / "my_arm", "ros1")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "src"))
    assert xacro(file).links == ("ros1",)
    _installed(tmp_path / "install", "ros2")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "install"))
    assert xacro(file).links == ("ros2",)
    told = tmp_path / "told"
    _package(told / "my_arm", "told")
    packages = pytest.importorskip("xacrodoc").packages
    packages.look_in(str(told))
    try:
        assert xacro(file).links == ("told",)
        _package(tmp_path / "ws" / "my_arm", "beside")
        assert xacro(file).links == ("beside",)
    finally:
        packages.reset()
    packages.update_package_cache({"my_arm": told / "my_arm"})
    try:
        (tmp_path / "ws" / "my_arm" / "package.xml").write_text("<package><name>x</name></package>")
        assert xacro(file).links == ("told",)
    finally:
        packages.reset()


@needs_xacro
def test_a_file_may_be_named_by_its_package(tmp_path, monkeypatch):
    _installed(tmp_path, "a")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    assert xacro("package://my_arm/urdf/p.xacro").links == ("a",)
    with pytest.raises(FileError, match="there is no package 'no_arm' in AMENT_PREFIX_PATH"):
        xacro("package://no_arm/urdf/p.xacro")


@needs_xacro
def test_a_file_of_macros_says_that_it_is_no_robot(tmp_path):
    file = tmp_path / "m.xacro"
    file.write_text(
        HEAD + '<xacro:macro name="m" params="n"><link name="${n}"/></xacro:macro></robot>'
    )
    with pytest.raises(ModelError) as caught:
        xacro(file)
    assert str(caught.value) == (
        f"{file}: xacro: the file defines macros only, and no robot: evaluate the file that uses them"
    )
    file.write_text(HEAD + "</robot>")
    with pytest.raises(ModelError, match="expected at least one <link>"):
        xacro(file)


REFUSED = {
    "an unknown package": (
        '<link name="$(find nopkg)"/>',
        r"xacro: there is no package 'nopkg' in the folders above",
    ),
    "an unknown package of a long name": (
        f'<link name="$(find {"p" * 81})"/>',
        rf"there is no package '{'p' * 79}…' in the folders",
    ),
    "an expression": (
        '<link name="${1/0}"/>',
        r"xacro: division by zero when evaluating expression '1/0'$",
    ),
    "an unknown name": ('<link name="${nope}"/>', r"xacro: name 'nope' is not defined"),
    "an unknown macro": ("<xacro:nope/>", r"xacro: unknown macro name: xacro:nope$"),
    "an unknown argument": (
        '<link name="$(arg u)"/>',
        r"xacro: Undefined substitution argument u$",
    ),
    "an unknown variable": (
        '<link name="$(env PK_NOPE)"/>',
        r"xacro: environment variable 'PK_NOPE' is not set$",
    ),
    "a macro of itself": (
        '<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>',
        r"xacro: it goes round in circ",
    ),
    "a missing attribute": ("<xacro:if/>", r"xacro: xacro:if: missing attribute 'value'$"),
    "a name that a terminal would obey": ('<link name="$(arg \x9b31m)"/>', r"argument \\x9b31m$"),
    "no robot in it": (
        '<link name="${1}"/><joint/>',
        r"\(evaluated\):\d+: <joint>: expected an attribute name",
    ),
    "malformed": ("<link", r"x:1: malformed XML"),
}


@needs_xacro
@needs_utf8
@pytest.mark.parametrize(("text", "message"), REFUSED.values(), ids=REFUSED.keys())
def test_what_cannot_be_evaluated_is_refused_in_one_line(tmp_path, text, message):
    path = tmp_path / "x"
    path.write_text(HEAD + text + "</robot>", encoding="utf-8")
    with pytest.raises(ModelError, match=message) as caught:
        xacro(path)
    assert str(caught.value).startswith(str(path))
    assert str(caught.value).isprintable()


@needs_xacro
@needs_utf8
def test_what_xacro_warns_of_is_a_warning_once_and_harmless(tmp_path, capfd):
    path = tmp_path / "w.xacro"
    path.write_text(
        HEAD + '<link name="a"/><xacro:include filename="no\x9b31m*.xacro"/></robot>',
        encoding="utf-8",
    )
    with pytest.warns(
        PoekinWarning, match=r"w\.xacro: xacro: Include tag's filename .*no\\x9b31m.* no files"
    ) as caught:
        assert xacro(path).links == ("a",)
    assert len(caught) == 1
    assert capfd.readouterr().err == ""


def test_a_dtd_is_refused_before_anything_is_evaluated(tmp_path):
    path = tmp_path / "x.xacro"
    path.write_text('<!DOCTYPE robot [<!ENTITY a "b">]>' + HEAD + "</robot>")
    with pytest.raises(ModelError, match="document type declaration"):
        xacro(path)
    with pytest.raises(FileError, match="No such file"):
        xacro(tmp_path / "gone.xacro")


def test_load_evaluates_nothing_and_says_what_does(tmp_path):
    for name in ("arm.xacro", "arm.urdf.XACRO"):
        (tmp_path / name).write_text(HEAD + '<link name="a"/></robot>')
        with pytest.raises(
            ModelError,
            match=r"(?i)arm.*\.xacro: xacro evaluates .*pk\.xacro\(path\) does, and --xacro",
        ):
            load(tmp_path / name)
    with pytest.raises(FileError, match=r"^gone\.xacro: no such file$"):
        load("gone.xacro")


def test_a_xacro_file_is_known_by_its_ending_or_its_namespace(tmp_path):
    for name, text, answer in (
        ("a.xacro", "<robot/>", True),
        ("b.urdf", HEAD, True),
        ("c.urdf", "<robot/>", False),
    ):
        (tmp_path / name).write_text(text)
        assert is_xacro(tmp_path / name) is answer


def test_without_xacrodoc_the_extra_is_named(tmp_path, monkeypatch):
    (tmp_path / "a.xacro").write_text(HEAD + '<link name="a"/></robot>')
    monkeypatch.setitem(sys.modules, "xacrodoc", None)
    monkeypatch.setitem(sys.modules, "xacro", None)
    with pytest.raises(
        MissingExtra,
        match=r"^evaluating xacro needs the package xacrodoc: pip install 'poekin\[xacro\]'$",
    ):
        xacro(tmp_path / "a.xacro")


def test_compressed_xacro_is_refused_with_what_to_do(tmp_path):
    text = HEAD + '<link name="a"/></robot>'
    path = tmp_path / "arm.urdf.gz"
    path.write_bytes(gzip.compress(text.encode()))
    assert is_xacro(path)
    with pytest.raises(
        ModelError, match=r"arm\.urdf\.gz: xacro is evaluated where .*: decompress it first$"
    ):
        xacro(path)
