"""`poekin singularity`: exit codes, numbers wherever they stand, words and JSON."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from poekin.analysis.dexterity.manipulability import manipulability
from poekin.analysis.dexterity.singularity import singularity
from poekin.formats.load import load

AWAY = ["0.1", "-0.5", "0.3", "-1.9", "0.2", "1.4", "0.6"]


def panda(*words):
    return ["singularity", "panda", "--tip", "panda_hand", *words]


@pytest.mark.parametrize(
    "words",
    [
        ["--at", *AWAY],
        AWAY,
        ["--at", ",".join(AWAY)],
        ["--at", " ".join(AWAY)],
        ["--at=0.1", *AWAY[1:]],
    ],
)
def test_a_regular_arm_is_exit_code_0(poekin, words):
    code, out, err = poekin(*panda(*words))
    assert (code, err) == (0, "")
    assert out.startswith("panda_hand in panda_link0: regular (smallest ÷ largest singular value ")
    assert [line.split()[0] for line in out.splitlines()[-3:]] == [
        "pose",
        "translation",
        "rotation",
    ]


def test_a_singular_arm_is_exit_code_1_with_what_is_lost(poekin):
    code, out, err = poekin(*panda("--at", *["0"] * 7))
    assert (code, err.count("\n")) == (1, 1)
    assert err.endswith("panda_joint4 = 0 rad is outside its limits, -3.0718 to -0.0698\n")
    assert (
        "the tool cannot move by turning about the base's x axis. The rates 'panda_joint1' +0.82"
        in out
    )


def test_degrees_are_taken(poekin):
    degrees = (repr(float(x)) for x in np.degrees(list(map(float, AWAY))))
    assert poekin(*panda("--deg", *degrees))[1] == poekin(*panda(*AWAY))[1]


def test_json_is_in_radians_also_where_degrees_are_said(as_json):
    degrees = np.degrees(list(map(float, AWAY)))
    said = as_json(*panda("--deg", *degrees))
    np.testing.assert_allclose(said["q"], list(map(float, AWAY)), rtol=1e-15)


def test_the_tolerance_and_the_part_are_taken(poekin):
    assert poekin(*panda("--tolerance", "0.5", *AWAY))[0] == 1
    assert poekin(*panda("--part", "translation", *["0"] * 7))[0] == 0


def test_json_has_the_numbers_of_the_function(poekin):
    code, out, _ = poekin(*panda("--json", "--at", *["0"] * 7))
    said, result = json.loads(out), singularity(load("panda").chain(tip="panda_hand"), np.zeros(7))
    assert code == 1
    assert said["singular"] is True
    assert said["singular_direction"] == result.singular_direction.tolist()
    assert said["summary"] == result.summary()
    assert (
        said["manipulability"]["pose"]["condition"] is None
        or said["manipulability"]["pose"]["condition"] > 1e12
    )


def test_words_and_measures_are_those_of_the_functions(poekin):
    q = [float(x) for x in AWAY]
    chain = load("panda").chain(tip="panda_hand")
    measures = manipulability(chain, q)
    words = singularity(chain, q, part="rotation", tolerance=0.01).summary()
    lines = poekin(*panda("--part", "rotation", "--tolerance", 0.01, *AWAY))[1].splitlines()
    assert lines[0] == f"panda_hand in panda_link0: {words}"
    assert [re.split(r" {2,}", line) for line in lines[-3:]] == [
        [part, *(f"{float(x):.4g}" for x in vars(of).values())]
        for part, of in vars(measures).items()
    ]
    said = json.loads(poekin(*panda("--json", *AWAY))[1])
    assert (said["robot"], said["base"], said["tip"], said["q"]) == (
        "panda",
        "panda_link0",
        "panda_hand",
        q,
    )
    assert said["q_names"] == list(chain.q_names)
    assert said["manipulability"] == measures.to_dict()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--at", "0", "0"], "7 coordinates expected (panda_joint1, "),
        (["--at", "0", "0"], "panda_joint7), got 2\n"),
        (["--at", "0", "--tip", "panda_hand"], "panda_joint7), got 1\n"),
        (["--at", ""], "--at: coordinates expected, got nothing"),
        (["--at", "a", *AWAY[1:]], "coordinate 1: a number expected, got 'a'"),
        (["--at", "nan", *AWAY[1:]], "q: expected one finite configuration (7,)"),
        (["--tolerance", "3", *AWAY], "tolerance: expected a number between 0 and 1, got 3"),
        (["--part", "all", *AWAY], "--part"),
        (["--tipp", "x", *AWAY], "there is no option '--tipp'; did you mean '--tip'"),
    ],
)
def test_a_bad_command_line_is_one_message(refused, words, message):
    assert message in refused(*panda(*words))
