"""JointTrajectory as text: read by YAML 1.1 as ROS does, by YAML 1.2 and by JSON, all alike."""

from __future__ import annotations

import json
from typing import NamedTuple

import numpy as np
import pytest
import yaml

from poekin.solve.motion.trajectory.joint_trajectory import json_text, number, yaml_text

NAMES = [
    "elbow", "1", "on", "no", "~", "1:30", "1e5", "a: b", "- a", '"', "\\", "'", "{x}", "#", "", " a ",
    "ü", "\u2028", "\ufeff", "\x85", "\x7f", "\n", "\t", "\x00", "😀", "%s{0}", "!tag", "&a", "*a",
]  # fmt: skip
NUMBERS = [0.0, -0.0, 1.0, 1e-5, -1e-5, 1.5e-7, 5e-324, 1e16, 1e22, 1.7976931348623157e308, 1 / 3]
TIMES = np.array([0.0, 1e-9, 0.9999999996, 1.9999999999, 2.5, 12345.678901234])


class Rows(NamedTuple):
    times: np.ndarray
    q: np.ndarray
    dq: np.ndarray


def rows(values) -> Rows:
    values = np.resize(values, (len(TIMES), len(NAMES)))
    return Rows(TIMES, values, values[:, ::-1])


@pytest.mark.parametrize("write", [yaml_text, json_text], ids=["yaml", "json"])
def test_yaml_1_1_reads_names_and_numbers_as_they_are(write):
    given = rows(NUMBERS)
    message = yaml.safe_load(write(NAMES, *given))
    assert list(message) == ["joint_names", "points"]
    names = NAMES
    if write is json_text:  # JSON has two halves for a character of more than 16 bits
        names = [name.replace("😀", "\ud83d\ude00") for name in NAMES]
    assert message["joint_names"] == names
    for k, point in enumerate(message["points"]):
        assert list(point) == ["positions", "velocities", "time_from_start"]
        for key, expected in (("positions", given.q), ("velocities", given.dq)):
            assert all(type(value) is float for value in point[key])
            assert point[key] == expected[k].tolist()
            assert not any(np.signbit(v) for v in point[key] if v == 0)


def test_a_message_is_a_point_after_the_other_with_its_rates_and_time():
    given = np.array([0.5, 2.25]), np.array([[0.5, -2.0], [3.0, 4.5]]), np.array([[6, 7], [8, 9.5]])
    assert yaml_text(["a ~b", "b"], *given) == (
        'joint_names: ["a ~b", "b"]\n'
        "points:\n"
        "- positions: [0.5, -2.0]\n"
        "  velocities: [6.0, 7.0]\n"
        "  time_from_start: {sec: 0, nanosec: 500000000}\n"
        "- positions: [3.0, 4.5]\n"
        "  velocities: [8.0, 9.5]\n"
        "  time_from_start: {sec: 2, nanosec: 250000000}\n"
    )
    assert json_text(["a ~b", "b"], *given) == (
        '{"joint_names": ["a ~b", "b"], "points": [\n'
        '{"positions": [0.5, -2.0], "velocities": [6.0, 7.0], '
        '"time_from_start": {"sec": 0, "nanosec": 500000000}},\n'
        '{"positions": [3.0, 4.5], "velocities": [8.0, 9.5], '
        '"time_from_start": {"sec": 2, "nanosec": 250000000}}\n'
        "]}\n"
    )


def test_json_reads_the_same_message():
    given = rows(NUMBERS)
    text = json_text(NAMES, *given)
    assert json.loads(text) == yaml.safe_load(yaml_text(NAMES, *given))
    assert text.isascii()
    assert yaml_text(NAMES, *given).isascii()


@pytest.mark.parametrize("write", [yaml_text, json_text], ids=["yaml", "json"])
def test_nanoseconds_carry_into_seconds(write):
    message = yaml.safe_load(write(NAMES, *rows(NUMBERS)))
    found = [
        (p["time_from_start"]["sec"], p["time_from_start"]["nanosec"]) for p in message["points"]
    ]
    assert found == [
        (0, 0), (0, 1), (1, 0), (2, 0), (2, 500_000_000), (12345, 678_901_234)
    ]  # fmt: skip


def test_every_number_has_a_dot():
    for value in NUMBERS:
        text = number(value)
        assert "." in text
        assert float(text) == value
    assert number(1e-5) == "1.0e-05"
    assert number(-0.0) == "0.0"
    assert number(1.5e-7) == "1.5e-07"


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_what_is_no_number_is_never_written(value):
    with pytest.raises(ValueError, match=str(value)):
        number(value)
