"""`poekin calibrate` with terms: columns of conditions, terms by name, and auto."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.formats.text import csv_rows
from poekin.solve.calibration import Points, calibrate
from poekin.solve.calibration.terms.condition_columns import condition_columns
from tests.solve.calibration.terms.sagging import POINT, arm, case

CHAIN = arm("kr5")
MADE = case(CHAIN, 1, sag=1e-3)
COUNT = len(MADE.q)
PAYLOAD = np.linspace(0, 3, COUNT)
SECONDS = np.linspace(0, 600, COUNT)
ARM = ["calibrate", "kr5", "--point", ",".join(map(str, POINT)), "--on-rank-deficiency", "fix"]


@pytest.fixture
def csv(tmp_path):
    def write(name, names, columns, rows=slice(None)):
        table = np.column_stack([MADE.q, MADE.points.p[:, 0], *columns])[rows]
        path = tmp_path / name
        path.write_text(csv_rows.text((*CHAIN.q_names, "x", "y", "z", *names), table))
        return path

    return write


def test_columns_of_conditions_reach_the_fit_in_si_units(poekin, csv, tmp_path):
    file = csv("a.csv", ("Payload [g]", "time [min]"), (1e3 * PAYLOAD, SECONDS / 60))
    out = tmp_path / "a.toml"
    words = [
        "--parameters",
        "screws,home,compliance",
        "--parameters",
        "drift",
        "--gravity",
        "0,0,-2",
    ]
    code, said, _ = poekin(*ARM, file, *words, "--folds", 0, "-o", out)
    assert code in (0, 1)
    assert "non-geometric terms were fitted" in said
    found = pk.calibration.load(out)
    expected = calibrate(
        CHAIN, MADE.q, Points(MADE.points.p, [POINT]), on_rank_deficiency="fix", folds=0,
        parameters=("screws", "home", "compliance", "drift"),
        conditions={"payload": PAYLOAD, "time": SECONDS, "gravity": [0, 0, -1]},
    )  # fmt: skip
    assert found.parameters == expected.parameters
    np.testing.assert_allclose(found.values, expected.values, rtol=1e-6, atol=1e-9)
    reference = found.error_model.reference
    assert reference == {
        "payload": pytest.approx(1.5), "time": pytest.approx(300), "gravity": [0, 0, -1]
    }  # fmt: skip


def test_auto_finds_the_sag_and_says_what_it_brings(poekin, csv):
    code, out, err = poekin(*ARM, csv("a.csv", (), ()), "--parameters", "auto", "--folds", 4)
    assert (code, err) == (0, "")
    assert "compliance: in the fit, brings " in out
    assert "drift: not in the fit, would bring " in out


def test_conditions_of_several_files_go_on_from_one_to_the_next(poekin, csv, tmp_path, refused):
    first = csv("a.csv", ("payload",), (PAYLOAD,), slice(30))
    second = csv("b.csv", ("payload (kg)",), (PAYLOAD,), slice(30, None))
    out = tmp_path / "a.toml"
    words = ["--parameters", "screws,home,compliance", "--folds", 0, "-o", out]
    assert poekin(*ARM, first, second, *words)[0] in (0, 1)
    assert pk.calibration.load(out).error_model.reference["payload"] == pytest.approx(1.5)
    bare = csv("c.csv", (), (), slice(30, None))
    message = refused(*ARM, first, bare, *words).replace("\n", " ")
    assert (
        "c.csv': expected a column 'payload', as another file has one; --ignore payload" in message
    )
    assert poekin(*ARM, first, bare, *words, "--ignore", "payload")[0] in (0, 1)


def test_conditions_that_nothing_depends_on_are_told(poekin, csv):
    file = csv("a.csv", ("payload",), (PAYLOAD,))
    _, _, err = poekin(*ARM, file, "--folds", 0)
    assert "nothing depends on payload: --parameters auto, or the name of a term" in err
    _, _, err = poekin(*ARM, file, "--folds", 0, "--parameters", "screws,compliance")
    assert err == ""


REFUSED = [
    (
        ["--parameters", "screws,sag"],
        "expected some of 'screws', 'home', 'offsets', 'gains', 'pitch',",
    ),
    (["--parameters", "screws,sag"], "'backlash', 'lag', 'drift', or auto alone, got 'sag'"),
    (["--parameters", "auto,screws"], "or auto alone, got 'auto'"),
    (["--parameters", "auto", "--folds", 0], "--parameters: 'auto' judges by held-out readings"),
    (["--gravity", "0,0"], "--gravity: three numbers expected"),
    (["--gravity", "0,0,0"], "--gravity: expected directions in the base frame, got zero"),
]


@pytest.mark.parametrize(("words", "message"), REFUSED)
def test_what_there_is_not_is_refused_with_what_there_is(refused, csv, words, message):
    assert message in refused(*ARM, csv("a.csv", (), ()), *words).replace("\n", " ")


def test_exact_pairs_have_no_conditions(refused, csv):
    exact = (*ARM[:2], csv("a.csv", ("payload",), (PAYLOAD,)), "--exact")
    message = refused(*exact)
    assert "--exact: expected no column of payload; --ignore payload" in message.replace("\n", " ")
    assert "gravity: expected without --exact" in refused(*exact, "--gravity", "0,0,-1")


def test_a_cell_of_a_condition_that_is_no_number_is_named(refused, csv):
    bad = np.where(np.arange(COUNT) == 4, np.inf, PAYLOAD)
    message = refused(*ARM, csv("a.csv", ("payload",), (bad,))).replace("\n", " ")
    assert "a.csv:6, column 'payload': expected a finite number, got inf" in message


def test_a_header_is_read_by_name_and_unit_and_leaves_others_alone():
    words = ["q1", " Temperature [°C]", "time", "x", "payload_left", "payload(g)"]
    found = condition_columns(words, {"time"}, "a.csv:1")
    assert [column[:2] for column in found] == [("temperature", 1), ("payload", 5)]
    assert [column.factor for column in found] == [1.0, 1e-3]
    for wrong, message in (
        (["payload [lb]"], r"a.csv:1: the column 'payload \[lb\]': expected 'kg' or 'g', got 'lb'"),
        (["time", "Time [s]"], r"a.csv:1: both 'time' and 'Time \[s\]': expected one"),
    ):
        with pytest.raises(InputError, match=message):
            condition_columns(wrong, set(), "a.csv:1")


def test_the_library_s_reader_does_not_pass_conditions_over_in_silence(csv):
    file = csv("a.csv", ("payload",), (PAYLOAD,))
    with pytest.raises(pk.errors.UnknownName, match="the column 'payload' is neither"):
        pk.calibration.read(file, CHAIN)
