"""`poekin view`: a page of what is asked for, and no file where something is wrong."""

from __future__ import annotations

import json
import re
import webbrowser
from pathlib import Path

import numpy as np
import pytest

import poekin as pk

pytest.importorskip("k3d", reason="no k3d: no page was made")


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    """Pages without a name of their own are written into an empty folder."""
    place = tmp_path / "here"
    place.mkdir()
    monkeypatch.chdir(place)
    return place


@pytest.fixture
def scene(poekin, tmp_path):
    """The scene in the page that a command line writes."""

    def call(*words):
        page = tmp_path / "page.html"
        code, out, err = poekin("view", *words, "-o", page)
        assert (code, err) == (0, "")
        assert out == f"written: '{page}'\n"
        text = page.read_text(encoding="utf-8")
        (data,) = re.findall(r'id="poekin-scene">(.*?)</script>', text)
        return json.loads(data)

    return call


def test_a_page_is_called_as_the_model_where_nothing_else_is_said(poekin, crane, here):
    assert poekin("view", crane) == (0, "written: 'crane.html'\n", "")
    assert (here / "crane.html").is_file()


def test_a_name_out_of_a_file_is_no_path(poekin, crane, here):
    file = Path(crane)
    file.write_text(file.read_text().replace('"crane"', '"../../a b"'))
    assert poekin("view", crane)[0] == 0
    assert [path.name for path in here.iterdir()] == ["a_b.html"]


def test_it_opens_at_q_with_the_tip_that_is_named(scene, crane):
    found = scene(crane, "--tip", "hook", "--q", "90,250", "--deg", "--mm")
    assert found["q"] == pytest.approx([np.pi / 2, 0.25])
    assert found["arms"][0]["tips"][0]["name"] == "hook"
    assert found["title"] == "crane"


def test_from_another_base_it_is_a_chain(scene, crane):
    found = scene(crane, "--tip", "hook", "--base", "a", "--q", "0.5")
    assert [s["name"] for s in found["arms"][0]["coordinates"]] == ["slide"]
    assert found["q"] == [0.5]


def test_a_second_model_is_laid_over_the_first(scene, crane, tmp_path):
    other = tmp_path / "other.urdf"
    text = Path(crane).read_text()
    other.write_text(
        text.replace('"crane"', '"other"').replace(
            '<axis xyz="1 0 0"/>', '<axis xyz="0.9999500004166653 0 0.009999833334166664"/>'
        )
    )
    found = scene(crane, "--tip", "hook", "--compare", other, "--q", "0.5,0.5")
    assert len(found["arms"]) == 2
    assert found["exaggerated"] > 1
    assert found["q"] == [0.5, 0.5]
    assert found["title"] == "crane and other"


def test_a_second_model_begins_at_the_same_base(scene, crane):
    found = scene(crane, "--base", "a", "--tip", "hook", "--compare", crane, "--q", "0.5")
    first, second = found["arms"]
    assert first["name"] == second["name"] == "a → hook"
    assert found["words"][0] == "The models are the same"


def test_a_path_is_played_with_its_times(scene, crane, tmp_path):
    file = tmp_path / "q.csv"
    file.write_text("time,turn,slide\n0,0,0\n0.5,0.1,0.2\n2,0.2,0.4\n")
    motion = scene(crane, "--tip", "hook", "--path", file)["motion"]
    assert motion["q"] == [[0, 0], [0.1, 0.2], [0.2, 0.4]]
    assert motion["times"] == [0, 0.5, 2]
    file.write_text("0,0\n90,1000\n")
    motion = scene(crane, "--tip", "hook", "--path", file, "--deg", "--mm")["motion"]
    assert motion["q"][1] == pytest.approx([np.pi / 2, 1.0])
    file.write_text("slide,time,turn,success\n0,1,0,1\n1000,4,90,1\n")
    motion = scene(crane, "--tip", "hook", "--path", file, "--deg", "--mm")["motion"]
    assert motion["q"][1] == pytest.approx([np.pi / 2, 1.0])
    assert motion["times"] == [1, 4]


def test_a_path_is_drawn_in_its_robot_and_without_meshes_as_a_skeleton_of_its_chain(
    scene, crane, tmp_path
):
    file = tmp_path / "q.csv"
    file.write_text("0,0\n0.1,0.2\n")
    words = (crane, "--tip", "hook", "--path", file)
    whole, chain = (scene(*words, *more)["arms"][0]["links"] for more in ((), ("--no-meshes",)))
    assert len(whole) == 5  # the lamp, which is no part of the chain, too
    assert len(chain) == 4


def test_a_pose_shows_all_solutions_of_six_joints_and_one_of_seven(scene):
    six = pk.load("ur5").chain()
    T = six.fk([0.1, -1.0, 1.2, 0.4, 0.9, -0.3])
    words = " ".join(f"{x:.17g}" for x in T[:3].ravel())
    found = scene("ur5", "--pose", words, "--format", "matrix")
    assert len(found["choices"]) == 8
    seven = pk.load("panda").chain(tip="panda_hand")
    q = [0, -0.5, 0, -2.0, 0, 1.6, 0.8]
    words = " ".join(f"{x:.17g}" for x in seven.fk(q)[:3].ravel())
    found = scene("panda", "--tip", "panda_hand", "--pose", words, "--format", "matrix")
    assert found["choices"] == []
    assert found["words"][0].startswith("solved")


def test_it_is_opened_where_that_is_asked(poekin, crane, here, monkeypatch):
    opened = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    assert poekin("view", crane, "--no-meshes")[0] == 0
    assert opened == []
    assert poekin("view", crane, "--open", "--no-meshes")[0] == 0
    assert opened == [(here / "crane.html").as_uri()]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--q", "1,2"], "tip"),
        (["--tip", "hook", "--q", "1"], "--q: 2 coordinates expected"),
        (["--tip", "hook", "--q", "1,x"], "a number expected, got 'x'"),
        (["--tip", "nothing"], "nothing"),
        (["--tip", "hook", "--path", "a.csv", "--pose", "1"], "--path and --pose: expected one"),
        (
            ["--tip", "hook", "--path", "a.csv", "--q", "1,2"],
            "--q: expected without --path, which says where the arm is",
        ),
        (["--tip", "hook", "--path", "no.csv"], "no.csv"),
        (["--format", "rpy"], "expected together with --pose"),
        (["--tip", "hook", "--pose", "1 2 3"], "--format: expected one of"),
        (["--tip", "hook", "--compare", "no.urdf"], "no.urdf"),
        (["-o", "page.txt"], "a name that ends in .html"),
        (["-o", "no/page.html"], "there is no directory 'no'"),
    ],
)
def test_what_is_wrong_is_one_message_and_nothing_is_written(words, said, refused, crane, here):
    assert said in refused("view", crane, *words)
    assert list(here.iterdir()) == []


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "rows of numbers expected, the file is empty"),
        ("turn,slide\n", "--path: expected a configuration at least"),
        ("time,turn,slide\n1,0,0\n0,0,0\n", "times: expected finite seconds"),
        ("turn,lower\n0,0\n", "neither a number nor a coordinate"),
        ("nan,0\n", "at least one finite pose"),
    ],
)
def test_what_is_no_path_is_refused(text, said, refused, crane, here, tmp_path):
    file = tmp_path / "q.csv"
    file.write_text(text)
    assert said in refused("view", crane, "--tip", "hook", "--path", file)
    assert list(here.iterdir()) == []


def test_a_model_is_not_overwritten_and_a_page_is(refused, poekin, crane, here):
    model = here / "crane.html"
    model.write_bytes(Path(crane).read_bytes())
    assert "it is the file of the model" in refused("view", model)
    model.write_text("an old page")
    assert poekin("view", crane)[0] == 0
    assert "poekin-scene" in model.read_text(encoding="utf-8")


def test_a_page_is_called_after_its_model_with_a_hundred_characters_at_most(poekin, here):
    for length in (100, 101):
        robot = pk.Robot("x" * length, ["a"], [])
        (here / "arm.urdf").write_text(pk.to_urdf(robot), encoding="utf-8")
        assert poekin("view", "arm.urdf", "--no-meshes")[0] == 0
    assert [page.stem for page in here.glob("*.html")] == ["x" * 100]
