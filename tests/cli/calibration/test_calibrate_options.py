"""Options of `poekin calibrate` as they reach the library, its page, and its messages as options."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.cli.calibration import calibrate as command
from poekin.cli.calibration.options import columns
from poekin.errors import InputError, join_names
from poekin.solve.calibration.measurements import data

UR5E = pk.load("ur5e").chain(tip="tool0")
MADE = pk.calibration.simulated(UR5E, 30, noise=(1e-4, 1e-4), seed=1)
WORDS = ("calibrate", "ur5e", "--tip", "tool0", "--folds", "0")


@pytest.fixture(scope="module")
def csv(tmp_path_factory):
    place = tmp_path_factory.mktemp("data") / "poses.csv"
    data.write(place, UR5E, MADE.q, MADE.measurements)
    return place


def test_a_page_is_drawn_where_it_is_asked_for_and_said_to_be_written(csv, tmp_path, poekin):
    pytest.importorskip("k3d", reason="no k3d: no page was made")
    place = tmp_path / "page.html"
    code, out, _ = poekin(*WORDS, csv, "--draw", place)
    assert code == 0
    assert f"\nwritten: '{place}'\n" in out
    assert "<title>Calibration: base → tool0</title>" in place.read_text(encoding="utf-8")


def test_no_page_is_made_where_none_is_asked_for(csv, monkeypatch, poekin):
    monkeypatch.setattr(command, "view", None)
    code, out, _ = poekin(*WORDS, csv)
    assert code == 0
    assert "written" not in out


@pytest.mark.parametrize(
    ("message", "said"),
    [
        ("pass on_rank_deficiency='fix'", "pass --on-rank-deficiency fix"),
        ("with the readings coupled, 'J3'", "with --coupling 'J3'"),
        ("expected covariance= of", "expected --sigma-angle and --sigma-length of"),
        ("with folds=0 too", "with --folds 0 too"),
        ("in degrees: give radians (numpy.deg2rad)", "in degrees: --deg says so"),
        ("points: expected", "--point: expected"),
        ("points=(0, 0, 0)", "--point (0, 0, 0)"),
        ("with frame='unknown'", "with --frame unknown"),
        ("with centre=None", "with no --centre"),
        ("use loss='huber'", "use --loss huber"),
        ("prior={'rad': 1e-3}", "--prior-angle and --prior-length {'rad': 1e-3}"),
        ("rename={'x': 'y'}", "--rename{'x': 'y'}"),
        ("rename: no column", "--rename: no column"),
        ("parameters='auto'", "--parameters'auto'"),
        ("conditions['gravity'] is", "--gravity is"),
        ("joints=['a']", "--joints['a']"),
        ("prior['rad'] and prior['m']", "--prior-angle and --prior-length"),
        ("ignore=['x_t'] passes it over", "--ignore x_t passes it over"),
        ("ignore=['a.b:c/d+e-f'] passes it over", "--ignore a.b:c/d+e-f passes it over"),
        ("ignore=['a b'] passes it over", "--ignore 'a b' passes it over"),
        ("nothing of these", "nothing of these"),
    ],
)
def test_a_message_of_the_library_names_the_options(message, said):
    assert command.as_options(message) == said


def test_a_list_may_have_commas_and_may_be_repeated():
    assert columns.listed(None) is None
    assert columns.listed(["a, b", "c"]) == ["a", "b", "c"]
    assert command._kinds(None) == ("screws", "home")
    assert command._kinds(["auto"]) == "auto"
    assert command._kinds(["screws,home", "offsets"]) == ("screws", "home", "offsets")
    for words, wrong in ((["screws", "auto"], "auto"), (["a"], "a"), (["auto", "b"], "auto")):
        with pytest.raises(InputError) as refused:
            command._kinds(words)
        assert str(refused.value) == (
            f"--parameters: expected some of {join_names(command.KNOWN, len(command.KNOWN))}, or auto"
            f" alone, got {wrong!r}"
        )


def test_what_is_known_before_has_its_unit():
    assert command._prior(None, None) is None
    assert command._prior(1e-3, None) == {"rad": 1e-3}
    assert command._prior(None, 0.0) == {"m": 0.0}
    assert command._prior(1e-3, 2e-3) == {"rad": 1e-3, "m": 2e-3}


def test_conditions_that_nothing_depends_on_are_all_named(capsys):
    found = pk.calibrate(UR5E, MADE.q, MADE.measurements, folds=0)
    given = {"temperature": np.zeros(30), "payload": np.zeros(30)}
    for conditions, parameters, said in (
        (given, ("screws", "home"), "temperature, payload"),
        ({"load": given["payload"]}, "screws", "load"),
        (given, "auto", ""),
        (None, ("screws", "home"), ""),
    ):
        options = {"conditions": conditions, "parameters": parameters}
        command._complain_of_unread(found, options)
        wanted = f"poekin: nothing depends on {said}: --parameters auto, or the name of a term, takes it\n"
        assert capsys.readouterr().err == (wanted if said else "")


def test_each_file_is_named_once_with_its_lines():
    sources = ["a.csv:2", "b:1.csv:7", "a.csv:3"]
    assert command._locations(sources) == "a.csv:2, 3; b:1.csv:7"
    assert command._locations([]) == ""
