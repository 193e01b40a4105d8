"""Files of meshes: found by every way in which robots name them, and by no other."""

from __future__ import annotations

import os

import pytest

from poekin.errors import FileError
from poekin.formats import erd, urdf
from poekin.formats.ros import packages
from poekin.formats.text import xml
from poekin.formats.visuals import urdf_visuals
from poekin.view.meshes.find import MeshFinder, erd_folder


@pytest.fixture(autouse=True)
def without_ros(monkeypatch):
    monkeypatch.delenv(packages.AMENT, raising=False)
    monkeypatch.delenv(packages.ROS, raising=False)


def touch(path):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.touch()
    return path


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("m.stl", "arm/urdf/m.stl"),
        ("meshes/m.stl", "arm/urdf/meshes/m.stl"),
        (r"meshes\m.stl", "arm/urdf/meshes/m.stl"),
        ("../meshes/m.stl", "arm/meshes/m.stl"),
        ("meshes/m.stl", "arm/meshes/m.stl"),
        ("file://m.stl", "arm/urdf/m.stl"),
        ("a%20mesh.stl", "arm/urdf/a mesh.stl"),
        ("package://arm/meshes/m.stl", "arm/meshes/m.stl"),
        ("package:///arm/meshes/m.stl", "arm/meshes/m.stl"),
        ("model://arm/meshes/m.stl", "arm/meshes/m.stl"),
        ("package://other/m.stl", "other/m.stl"),
        ("package://other/m.stl", "arm/other/m.stl"),
        ("PACKAGE://x/m.stl", "x/m.stl"),
    ],
)
def test_a_mesh_is_found_in_place_in_its_package_and_upward(name, place, tmp_path):
    wanted = touch(tmp_path / place)
    finder = MeshFinder(str(touch(tmp_path / "arm" / "urdf" / "arm.urdf")))
    assert os.path.samefile(finder.find(name), wanted)


def test_an_absolute_path_is_the_file_as_it_is_and_as_file(tmp_path):
    wanted = touch(tmp_path / "there" / "m.stl")
    finder = MeshFinder(str(tmp_path / "arm" / "arm.urdf"))
    for name in (str(wanted), f"file://{wanted}"):
        assert os.path.samefile(finder.find(name), wanted)


def test_a_package_is_where_ament_or_rospack_say(tmp_path, monkeypatch):
    new, old = tmp_path / "new", tmp_path / "old"
    touch(new / "share" / "ament_index" / "resource_index" / "packages" / "here")
    wanted = touch(new / "share" / "here" / "meshes" / "m.stl")
    also = touch(old / "src" / "there" / "m.stl")
    (also.parent / "package.xml").write_text("<package><name>there</name></package>")
    monkeypatch.setenv(packages.AMENT, str(new))
    monkeypatch.setenv(packages.ROS, str(old))
    finder = MeshFinder(str(tmp_path / "arm" / "arm.urdf"))
    assert os.path.samefile(finder.find("package://here/meshes/m.stl"), wanted)
    assert os.path.samefile(finder.find("package://there/m.stl"), also)


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("gone.stl", "^there is no such file$"),
        (".", "no such file"),
        ("a\0b.stl", "no such file"),
        ("package://gone/m.stl", r"^no package 'gone' near the model or in AMENT_PREFIX_PATH \(not set\)"),
        ("package://", "^no package ''"),
        ("package://../m.stl", "^no package '..'"),
        ("http://localhost/m.stl", "^only files are read, nothing over a network$"),
        ("ftp://localhost/m.stl", "nothing over a network"),
        ("a\x1b[2J.stl", "no such file"),
    ],
)  # fmt: skip
def test_what_is_not_found_says_where_it_was_looked_for(name, why, tmp_path):
    finder = MeshFinder(str(touch(tmp_path / "arm" / "arm.urdf")))
    with pytest.raises(FileError, match=why):
        finder.find(name)


@pytest.mark.skipif(os.name != "posix", reason="modes as POSIX has them")
def test_what_anybody_could_have_put_above_a_model_is_not_taken(tmp_path):
    touch(tmp_path / "open" / "other" / "m.stl")
    (tmp_path / "open").chmod(0o777)
    finder = MeshFinder(str(touch(tmp_path / "open" / "arm" / "arm.urdf")))
    for name in ("package://other/m.stl", "other/m.stl"):
        with pytest.raises(FileError):
            finder.find(name)


def test_a_built_in_arm_s_meshes_are_found_in_example_robot_data_or_the_extra_is_named(monkeypatch):
    finder = MeshFinder("catalogue/panda.urdf")
    name = f"package://{erd.PACKAGE}/robots/panda_description/meshes/visual/link0.dae"
    erd.available()
    assert os.path.isfile(finder.find(name))
    monkeypatch.setattr(erd, "available", dict)
    with pytest.raises(
        FileError,
        match=rf"^no package '{erd.PACKAGE}' near the model or in .+ has it: pip install 'poekin\[robots\]' brings it$",
    ):
        MeshFinder("catalogue/panda.urdf").find(name)


def test_every_mesh_of_example_robot_data_that_the_package_has_is_found():
    robots, _ = erd.example_robots()
    share = str(erd_folder())
    found = 0
    lost = set()
    for name, path in robots.items():
        finder = MeshFinder(path)
        for visual in urdf_visuals.read(xml.read_bytes(path), path).found:
            if visual.file:
                try:
                    assert finder.find(visual.file).startswith(share)
                    found += 1
                except FileError:
                    lost.add((name, visual.file.rpartition("/")[0]))
    # this one's files are said to be in an installation of Romeo's own tools
    assert {name for name, _ in lost} <= {"romeo_laas_small"}
    assert all(folder.startswith("file:///usr/Romeo/") for _, folder in lost)
    assert found > 1000


def test_a_mesh_is_no_part_of_loading(tmp_path):
    (tmp_path / "arm.urdf").write_text(
        '<robot name="r"><link name="a"><visual><geometry><mesh filename="gone.stl"/></geometry>'
        "</visual></link></robot>"
    )
    assert urdf.read(tmp_path / "arm.urdf").links == ("a",)


def test_another_package_is_not_looked_for_in_example_robot_data(tmp_path):
    folder = erd_folder()
    if folder is None:
        pytest.skip("no example-robot-data: no mesh was looked for in it")
    inside = next(name for name in sorted(os.listdir(folder)) if os.path.isdir(f"{folder}/{name}"))
    file = next(
        os.path.relpath(os.path.join(place, names[0]), folder)
        for place, _, names in os.walk(os.path.join(folder, inside))
        if names
    )
    finder = MeshFinder(str(tmp_path / "r.urdf"))
    assert finder.find(f"package://{erd.PACKAGE}/{file}") == os.path.join(folder, file)
    with pytest.raises(FileError, match="no package 'elsewhere'"):
        finder.find(f"package://elsewhere/{file}")
