"""Chains as tables of TOML: every key there and back, and what is said of a file that is wrong."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import ModelError, PoekinWarning
from poekin.formats import chain_toml
from poekin.formats.text import toml_text
from poekin.formats.text.toml_text import Keys

SCREWS = [
    pk.screw.revolute([0, 0, 1], [0.1, 0, 0]),
    pk.screw.helical([0, 1, 0], [0.3, 0, 0.5], 0.05),
    pk.screw.prismatic([0, 0.6, 0.8]),
]
HOME = pk.se3.exp([0.1, -0.2, 0.3, 0.9, 0.1, 0.4])
PLAIN = pk.Chain.from_space(SCREWS[::2], HOME, base="floor", tip="flange")
WHOLE = pk.Chain.from_space(
    SCREWS,
    HOME,
    joint_names=["turn", "wind", "slide"],
    q_names=["u", "v"],
    coupling=[[1, 0], [0.5, 1], [0, 2]],
    offset=[0.1, 0.2, 0.3],
    limits=[[-1, 2], [-np.inf, 3]],
    masses=[[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12]],
    velocity_limits=[4, np.inf],
    joint_limits=[[-5, 6], [-np.inf, 7], [-8, np.inf]],
    joint_velocity_limits=[9, np.inf, 10],
    base="floor",
    tip="flange",
)
ALWAYS = ["base", "tip", "joint_names", "q_names", "screws", "home", "limits", "offset"]


def keys(data):
    return Keys(data, "arm.toml: nominal")


@pytest.mark.parametrize(
    ("chain", "further"),
    [
        (PLAIN, []),
        (PLAIN.replace(velocity_limits=[1, np.inf]), ["velocity_limits"]),
        (WHOLE, ["coupling", "pitches", "masses", *chain_toml._LIMITS]),
    ],
    ids=["plain", "a velocity", "all"],
)
def test_a_table_has_what_a_chain_has_and_gives_it_back(chain, further):
    data = chain_toml.to_data(chain)
    assert list(data) == [*ALWAYS, *further]
    for key in data:
        np.testing.assert_array_equal(data[key], getattr(chain, key), err_msg=key)
        assert isinstance(data[key], str if key in ("base", "tip") else list)
    again = chain_toml.to_chain(keys(data))
    for key in ("pitches", *chain_toml._LIMITS, "coupling", *data):
        np.testing.assert_array_equal(getattr(again, key), getattr(chain, key), err_msg=key)
    assert (again.masses is None) == (chain.masses is None)


@pytest.mark.parametrize(
    ("key", "shape"),
    [
        ("screws", (3, 6)), ("home", (4, 4)), ("offset", (3,)), ("limits", (2, 2)),
        ("coupling", (3, 2)), ("pitches", (3,)), ("masses", (3, 4)),
        ("velocity_limits", (2,)), ("joint_limits", (3, 2)), ("joint_velocity_limits", (3,)),
    ],
)  # fmt: skip
def test_each_table_of_numbers_has_its_shape(key, shape):
    found = [refusal(key, [])]
    if shape[1:]:
        found.append(refusal(key, [[]] * shape[0]))
    of = "lists" if shape[1:] else "numbers"
    assert found == [
        f"arm.toml: nominal: {key}: expected a list of {size} {what}, got 0 of them"
        for size, what in zip(shape, [of, "numbers"], strict=False)
    ]


def refusal(key, value):
    with pytest.raises(ModelError) as said:
        chain_toml.to_chain(keys(chain_toml.to_data(WHOLE) | {key: value}))
    return str(said.value)


@pytest.mark.parametrize("key", ["screws", "offset", "coupling", "pitches", "masses"])
def test_what_is_no_limit_is_finite(key):
    data = chain_toml.to_data(WHOLE)
    data[key] = np.full(np.shape(data[key]), np.inf).tolist()
    with pytest.raises(ModelError, match=rf"^arm\.toml: nominal: {key}: "):
        chain_toml.to_chain(keys(data))


def test_a_chain_that_is_refused_is_said_with_file_and_table():
    data = chain_toml.to_data(WHOLE) | {"limits": [[1.0, 0.0], [0.0, 1.0]]}
    with pytest.raises(ModelError) as said:
        chain_toml.to_chain(keys(data))
    with pytest.raises(pk.PoekinError) as bare:
        WHOLE.replace(limits=[[1.0, 0.0], [0.0, 1.0]])
    assert str(said.value).startswith("arm.toml: nominal: ")
    assert str(bare.value) in str(said.value)


def test_an_unknown_key_of_a_chain_is_refused_with_its_table():
    with pytest.raises(ModelError, match=r"^arm\.toml: nominal: .*colour"):
        chain_toml.to_chain(keys(chain_toml.to_data(PLAIN) | {"colour": "red"}))


def written(path, **changes):
    data = {
        "format": "poekin calibration", "version": 1, "kinds": ["screws", "home"],
        "nominal": chain_toml.to_data(PLAIN.replace(tip="nominal tip")),
        "calibrated": chain_toml.to_data(PLAIN),
    } | changes  # fmt: skip
    data = {key: value for key, value in data.items() if value is not None}
    path.write_text(toml_text.make_text(data), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("changes", "is_one"), [({}, True), ({"format": "other"}, False), ({"format": None}, False)]
)
def test_a_file_of_a_calibration_says_so(changes, is_one, tmp_path):
    assert chain_toml.is_calibration(written(tmp_path / "arm.toml", **changes)) is is_one


def test_what_cannot_be_read_is_no_calibration(tmp_path):
    assert chain_toml.is_calibration(tmp_path / "none.toml") is False


@pytest.mark.parametrize("version", [0, 2])
def test_a_file_of_another_version_is_refused(version, tmp_path):
    path = written(tmp_path / "arm.toml", version=version)
    with pytest.raises(ModelError) as said:
        chain_toml.read_chains(path)
    assert str(said.value) == (
        f"{path}: version: expected 1, got {version}: another version of poekin's"
    )


def test_both_chains_are_read_and_the_robot_is_the_calibrated(tmp_path):
    nominal, calibrated = chain_toml.read_chains(written(tmp_path / "arm.toml"))
    assert (nominal and nominal.tip, calibrated.tip) == ("nominal tip", "flange")
    alone = written(tmp_path / "alone.toml", nominal=None, kinds=None)
    assert chain_toml.read_chains(alone)[0] is None
    assert chain_toml.read(alone).chain("floor", "flange").joint_names == PLAIN.joint_names


@pytest.mark.parametrize("read", [chain_toml.read, chain_toml.read_chains])
def test_terms_of_the_readings_are_warned_of(read, tmp_path):
    kinds = [*chain_toml.GEOMETRIC, "backlash", "sag"]
    path = written(tmp_path / "arm.toml", kinds=kinds)
    with pytest.warns(PoekinWarning) as said:
        read(path)
    assert [str(warning.message) for warning in said] == [
        f"{path}: the calibration has non-geometric terms ('backlash', 'sag'): the arm takes true joint"
        " values, not readings; pk.calibration.load(path) has true_joints, compensate and emit for these"
    ]
