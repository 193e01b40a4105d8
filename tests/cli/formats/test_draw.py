"""--draw: the result is printed as ever, and its page is written beside it."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

import poekin as pk
from poekin.cli.formats import draw
from poekin.view.view import view

pytest.importorskip("k3d", reason="no k3d: no page was made")
Q = [0, -0.5, 0, -2.0, 0, 1.6, 0.8]
TIP = ["panda", "--tip", "panda_hand"]


@pytest.fixture
def lines(tmp_path):
    """Command lines that can be drawn, by their names."""
    arm = pk.load("panda").chain(tip="panda_hand")
    T = np.tile(arm.fk(Q), (4, 1, 1))
    T[:, 0, 3] += [0, 0.01, 0.02, 0.03]
    pk.motion.write_poses(tmp_path / "T.csv", T, "12")
    ur = pk.load("ur5").chain()
    made = pk.calibration.simulated(ur, 30, seed=1)
    pk.calibration.write(tmp_path / "data.csv", ur, made.q, made.measurements)
    pose = [f"{x:.17g}" for x in T[0, :3].ravel()]
    of_file = [*TIP, "--format", "12", "--input", tmp_path / "T.csv"]
    return {
        "compare": ["compare", "ur5", "ur5e"],
        "singularity": ["singularity", *TIP, "--at", ",".join(map(str, Q))],
        "ik": ["ik", *TIP, "--format", "12", "--", *pose],
        "ik of many": ["ik", *of_file],
        "follow": ["follow", *of_file],
        "fastest": ["follow", *of_file, "--fastest", "--acceleration", "5"],
        "calibrate": ["calibrate", "ur5", tmp_path / "data.csv", "--folds", "0"],
    }


def with_options(line, *options):
    """A command line with options in front of its numbers."""
    return [*line[:1], *options, *line[1:]]


NAMES = ("compare", "singularity", "ik", "ik of many", "follow", "fastest", "calibrate")


@pytest.mark.parametrize("name", NAMES)
def test_the_page_is_written_and_the_result_printed_as_without(name, lines, poekin, tmp_path):
    page = tmp_path / "page.html"
    code, out, err = poekin(*lines[name])
    drawn = poekin(*with_options(lines[name], "--draw", page))
    told = {"calibrate": f"written: '{page}'\n"}.get(name, f"drawn in '{page}'\n")
    if name in ("ik of many", "follow", "fastest"):  # a table is what is on stdout
        assert drawn == (code, out, f"{err}poekin: {told}")
    else:
        assert drawn == (code, out + told, err)
    text = page.read_text(encoding="utf-8")
    (data,) = re.findall(r'id="poekin-scene">(.*?)</script>', text)
    scene = json.loads(data)
    assert len(scene["arms"]) == (2 if name in ("compare", "calibrate") else 1)
    if name in ("singularity", "ik", "follow"):  # in its robot, with the fingers
        assert len(scene["q"]) == 8


def test_json_stays_json(lines, poekin, tmp_path):
    for name in ("compare", "singularity", "follow", "calibrate"):
        page = tmp_path / f"{name}.html"
        _, out, err = poekin(*with_options(lines[name], "--draw", page, "--json"))
        assert err == ""
        assert json.loads(out)
        assert page.is_file()


@pytest.mark.parametrize("name", ["compare", "singularity", "ik", "follow", "calibrate"])
def test_what_cannot_be_written_is_refused_before_any_work(name, lines, refused, tmp_path):
    before = sorted(tmp_path.iterdir())
    for place, said in (
        ("page.svg", "a name that ends in .html or .htm"),
        ("no/page.html", "there is no directory"),
        (".", "a name that ends in .html"),
    ):
        assert said in refused(*with_options(lines[name], "--draw", tmp_path / place))
    assert sorted(tmp_path.iterdir()) == before


def test_a_page_is_no_other_file_of_the_command(lines, refused, tmp_path):
    table = tmp_path / "both.html"
    line = with_options(lines["calibrate"], "--draw", table, "--report", table)
    assert "it is named twice" in refused(*line)
    model = tmp_path / "arm.html"
    model.write_text(pk.to_urdf(pk.load("ur5")), encoding="utf-8")
    assert "it is the file of the b" in refused("compare", "ur5", model, "--draw", model)
    assert "it is the file of the model" in refused(
        "singularity", model, "--draw", model, "--at", "0,0,0,0,0,0"
    )


def test_without_a_page_or_a_place_for_it_nothing_is_written_or_told(tmp_path):
    told: list[str] = []
    draw.save(None, tmp_path / "page.html", told.append)
    draw.save(view(pk.load("ur5").chain()), None, told.append)
    assert told == []
    assert list(tmp_path.iterdir()) == []
