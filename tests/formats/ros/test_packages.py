"""Packages of ROS by name: where ament, rospack and the file's own folder have them."""

from __future__ import annotations

import os
import stat

import pytest

from poekin.errors import FileError, InputError
from poekin.formats.load import load
from poekin.formats.ros import packages
from tests.formats.texts import one_joint

posix = pytest.mark.skipif(os.name != "posix", reason="modes and links as POSIX has them")


@pytest.fixture(autouse=True)
def without_ros(monkeypatch):
    monkeypatch.delenv(packages.AMENT, raising=False)
    monkeypatch.delenv(packages.ROS, raising=False)


def package(folder, name: str | None = None):
    """A package in a folder, of the folder's name where none is given."""
    folder.mkdir(parents=True, exist_ok=True)
    text = (
        f"<?xml version='1.0'?><package format='3'><name> {name or folder.name} </name></package>"
    )
    (folder / "package.xml").write_text(text, encoding="utf-8")
    return folder


def installed(prefix, name: str):
    """A package as colcon installs it: an entry in the index, which is empty, and a share folder."""
    index = prefix / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True, exist_ok=True)
    (index / name).touch()
    share = prefix / "share" / name
    share.mkdir()
    return share


def test_the_first_prefix_with_the_package_in_its_index_has_it(tmp_path, monkeypatch):
    prefixes = [tmp_path / name for name in ("gone", "other", "one", "two")]
    installed(prefixes[1], "some_package")
    first = installed(prefixes[2], "my_arm")
    installed(prefixes[3], "my_arm")
    monkeypatch.setenv(packages.AMENT, os.pathsep.join(["", *map(str, prefixes)]))
    assert packages.find("my_arm") == str(first)
    assert packages.find("no_arm") is None
    (prefixes[2] / "share" / "unlisted").mkdir()
    assert packages.find("unlisted") is None
    first.rmdir()  # listed, and not there
    assert packages.find("my_arm") == str(prefixes[3] / "share" / "my_arm")


def test_a_package_below_ros_package_path_is_found_depth_first_and_by_its_manifest(
    tmp_path, monkeypatch
):
    one, two = tmp_path / "one", tmp_path / "two"
    deep = package(one / "a" / "stack" / "folder", "my_arm")
    package(one / "b", "my_arm")
    package(two / "my_arm")
    old = two / "old_arm"
    old.mkdir()
    (old / "manifest.xml").write_text("<package/>")
    monkeypatch.setenv(packages.ROS, os.pathsep.join(map(str, (one, two))))
    assert packages.find("my_arm") == str(deep)
    assert packages.find("old_arm") == str(old)
    # only what has a manifest is a package here
    (two / "no_manifest").mkdir()
    assert packages.find("no_manifest") is None
    monkeypatch.setenv(packages.ROS, str(deep))
    assert packages.find("my_arm") == str(deep)


@pytest.mark.parametrize("case", ["in a package", "hidden", "CATKIN_IGNORE", "rospack_nosubdirs"])
def test_rospack_does_not_look_there(case, tmp_path, monkeypatch):
    outer = tmp_path / ("outer" if case != "hidden" else ".outer")
    package(outer / "inner", "my_arm")
    if case == "in a package":
        package(outer)
    elif case != "hidden":
        (outer / case).touch()
    package(tmp_path / "z" / "my_arm")
    monkeypatch.setenv(packages.ROS, str(tmp_path))
    assert packages.find("my_arm") == str(tmp_path / "z" / "my_arm")


def test_ros_2_comes_before_ros_1(tmp_path, monkeypatch):
    share = installed(tmp_path / "install", "my_arm")
    source = package(tmp_path / "src" / "my_arm")
    monkeypatch.setenv(packages.ROS, str(tmp_path / "src"))
    assert packages.find("my_arm") == str(source)
    monkeypatch.setenv(packages.AMENT, str(tmp_path / "install"))
    assert packages.find("my_arm") == str(share)


@posix
def test_links_that_go_round_end_and_a_crawl_is_bounded(tmp_path, monkeypatch):
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "again").symlink_to(tmp_path)
    found = package(tmp_path / "b" / "my_arm")
    monkeypatch.setenv(packages.ROS, str(tmp_path))
    assert packages.find("my_arm") == str(found)
    # the folder itself, a, b and b/my_arm
    monkeypatch.setattr(packages, "MOST_FOLDERS", 4)
    assert packages.find("my_arm") == str(found)
    monkeypatch.setattr(packages, "MOST_FOLDERS", 3)
    with pytest.raises(FileError) as caught:
        packages.find("my_arm")
    assert str(caught.value) == (
        "ROS_PACKAGE_PATH: expected at most 3 folders below it, there are more:"
        " name the folders that hold the packages"
    )


@posix
def test_a_folder_that_may_not_be_read_is_passed_over(tmp_path, monkeypatch):
    (tmp_path / "a").mkdir(mode=0)
    found = package(tmp_path / "b" / "my_arm")
    monkeypatch.setenv(packages.ROS, str(tmp_path))
    assert packages.find("my_arm") == str(found)
    names = packages._names_in
    monkeypatch.setattr(os, "listdir", _denied)  # as for anybody but root
    assert names(str(tmp_path)) == []


def _denied(_):
    raise PermissionError


NEAR = {
    "above, by its manifest": lambda top: package(top / "ws" / "clone", "my_arm") / "urdf",
    "above, by its name": lambda top: top / "ws" / "my_arm" / "urdf",
    "beside, by its name": lambda top: (package(top / "ws" / "my_arm"), top / "ws" / "mine" / "urdf")[1],
    "beside, without a manifest": lambda top: (
        (top / "ws" / "my_arm").mkdir(parents=True),
        top / "ws" / "mine" / "urdf",
    )[1],
    "beside, by its manifest": lambda top: (
        package(top / "ws" / "clone", "my_arm"),
        top / "ws" / "mine" / "urdf",
    )[1],
    "beside a folder further up": lambda top: (
        package(top / "ws" / "my_arm"),
        top / "ws" / "a" / "b" / "c",
    )[1],
}  # fmt: skip


@pytest.mark.parametrize("case", NEAR)
def test_a_package_is_found_near_a_file(case, tmp_path):
    folder = NEAR[case](tmp_path)
    folder.mkdir(parents=True)
    found = packages.find_near("my_arm", folder / "arm.xacro")
    assert found in (str(tmp_path / "ws" / "my_arm"), str(tmp_path / "ws" / "clone"))
    assert packages.find_near("no_arm", folder / "arm.xacro") is None


def test_a_folder_of_the_name_that_says_another_is_not_the_package(tmp_path):
    package(tmp_path / "my_arm", "your_arm")
    (tmp_path / "x").mkdir()
    assert packages.find_near("my_arm", tmp_path / "x" / "a.xacro") is None
    assert packages.find_near("your_arm", tmp_path / "x" / "a.xacro") == str(tmp_path / "my_arm")
    (tmp_path / "my_arm" / "package.xml").write_text("<package><name>my_arm</package>")
    assert packages.find_near("my_arm", tmp_path / "x" / "a.xacro") is None
    (tmp_path / "my_arm" / "package.xml").write_text("<package/>")
    assert packages.find_near("my_arm", tmp_path / "x" / "a.xacro") is None


def test_only_so_many_folders_beside_are_looked_at_for_their_manifest(tmp_path, monkeypatch):
    package(tmp_path / "b", "my_arm")
    (tmp_path / "a" / "x").mkdir(parents=True)
    file = tmp_path / "a" / "x" / "r.xacro"
    monkeypatch.setattr(packages, "MOST_BESIDE", 2)
    assert packages.find_near("my_arm", file) == str(tmp_path / "b")
    monkeypatch.setattr(packages, "MOST_BESIDE", 1)
    assert packages.find_near("my_arm", file) is None
    package(tmp_path / "my_arm")
    assert packages.find_near("my_arm", file) == str(tmp_path / "my_arm")


@posix
def test_what_anybody_could_have_put_beside_a_file_is_not_taken(tmp_path):
    package(tmp_path / "open" / "my_arm")
    mine = tmp_path / "open" / "mine"
    mine.mkdir()
    file = mine / "arm.xacro"
    assert packages.find_near("my_arm", file)
    (tmp_path / "open").chmod(0o1777)
    assert packages.find_near("my_arm", file) is None
    (tmp_path / "open").chmod(stat.S_IRWXU)


def test_a_package_url_is_a_file_of_a_package(tmp_path, monkeypatch):
    share = installed(tmp_path, "my_arm")
    (share / "urdf").mkdir()
    path = share / "urdf" / "arm.urdf"
    path.write_text(one_joint(), encoding="utf-8")
    monkeypatch.setenv(packages.AMENT, str(tmp_path))
    robot = load("package://my_arm/urdf/arm.urdf")
    assert robot == load(path)
    assert str(robot.source) == str(path)
    assert packages.local_path("panda") == "panda"
    assert packages.local_path(path) is path
    with pytest.raises(FileError, match=r"gone\.urdf: cannot be read: No such file"):
        load("package://my_arm/urdf/gone.urdf")


@pytest.mark.parametrize(
    "url",
    ["package://", "package://a/x.urdf", "package://../x.urdf", "package://my_arm", "package://my_arm/",
     "package://my_arm/../x.urdf", "package://my_arm/a\\..\\x.urdf", "package://-x/x.urdf"],
)  # fmt: skip
def test_a_package_url_that_leads_out_of_the_package_is_refused(url):
    with pytest.raises(InputError) as caught:
        load(url)
    assert str(caught.value) == (
        f"expected package://PACKAGE/PATH, with a path inside of the package, got '{url}'"
    )


def test_a_package_that_is_nowhere_says_where_it_was_looked_for(tmp_path, monkeypatch):
    monkeypatch.setenv(packages.AMENT, f"{tmp_path}{os.pathsep}{tmp_path / 'gone'}")
    with pytest.raises(FileError) as caught:
        load("package://my_arm/x.urdf")
    assert str(caught.value) == (
        "'package://my_arm/x.urdf': there is no package 'my_arm' in AMENT_PREFIX_PATH (folders: 1)"
        " or ROS_PACKAGE_PATH (not set)"
    )


@pytest.mark.parametrize("name", ["", "a", "../my_arm", "my_arm/..", ".", "my arm", "/tmp"])
def test_what_is_no_name_of_a_package_is_not_looked_for(name, tmp_path, monkeypatch):
    package(tmp_path / "my_arm")
    monkeypatch.setenv(packages.ROS, str(tmp_path))
    assert packages.find(name) is None
    assert packages.find_near(name, tmp_path / "my_arm" / "x.xacro") is None
