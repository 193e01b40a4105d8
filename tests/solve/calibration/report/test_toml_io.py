"""A calibration in a file is the calibration, to the last bit; what is wrong in a file is said with
file and key.
"""

from __future__ import annotations

import re
import sys
from dataclasses import fields, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import FileError, MissingExtra, ModelError, PoekinError
from poekin.groups import se3
from poekin.solve.calibration import Parameter, Poses, Term, calibrate, load
from poekin.solve.calibration.measurements.simulated import simulated
from poekin.solve.calibration.report import toml_checks
from poekin.solve.calibration.selection.term_gain import TermGain

SCREWS = [
    pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.prismatic([0, 0.6, 0.8]),
    pk.screw.revolute([0, 1, 0], [0.3, 0, 0.5]), pk.screw.helical([1, 0, 0], [0.5, 0.1, 0.4], 0.05),
    pk.screw.revolute([0, 0, 1], [0.7, 0, 0.1]),
]  # fmt: skip
HOME = se3.exp([0.1, -0.2, 0.3, 0.9, 0.1, 0.4])
ARM = pk.Chain.from_space(
    SCREWS,
    HOME,
    limits=[[-np.inf, 2], [0, 1], [-1, 1], [-3, np.inf], [-2, 2]],
    base='b]\n"',
    tip="t",
)
# joint 1 follows two coordinates, joints 2 and 3 one; the last follows none
COUPLED = pk.Chain.from_space(
    SCREWS, HOME, coupling=[[1, 0, 0], [0.5, 1, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]], q_names=["u", "v", "w"],
    offset=[0.1, 0, 0.2, 0, 0.3],
)  # fmt: skip

RIPPLE = Term(
    "ripple",
    (Parameter("joint1", "ripple", "rad"),),
    lambda q, conditions: np.sin(9 * q[..., None]),
)
MASSES = np.column_stack([[3.0, 2, 2, 1, 1], np.linspace(-0.3, 0.5, 15).reshape(5, 3)])
CONDITIONS = {"payload": np.linspace(0, 3, 60), "gravity": [0.0, 1, -1], "time": np.arange(60.0)}


def case(name):
    if name == "coupled":
        q = COUPLED.random(0, 30)
        poses = Poses(COUPLED.fk(q * 1.01 + 0.002), rows=np.arange(30)[::-1])
        kinds = ("offsets", "gains")
        return calibrate(
            COUPLED, q[::-1], poses, parameters=kinds, folds=0, prior={"rad": 0.1, "m": 0.1}
        )
    if name == "pitch":
        q = ARM.random(0, 30)
        return calibrate(
            ARM, q, ARM.fk(q), parameters=("pitch", "home"), joints=["joint1", "joint4"], folds=3
        )
    if name == "terms":
        q = ARM.random(0, 60)
        kinds = ("home", "compliance", "backlash", RIPPLE)
        arm = ARM.replace(masses=MASSES)
        return calibrate(arm, q, arm.fk(q), parameters=kinds, conditions=CONDITIONS, folds=3)
    if name == "sags":
        q = ARM.random(1, 40)
        x = q + 1e-3 * np.sin(2 * q) * [0, 0, 1, 0, 0]
        p = ARM.fk(x)[:, :3, 3] + np.random.default_rng(0).normal(scale=1e-5, size=(40, 3))
        return calibrate(ARM, q, p, folds=0, on_rank_deficiency="fix")
    kind, _, unknown = name.partition(" ")
    s = simulated(ARM, 40, kind=kind, outliers=0.1, unknown=bool(unknown))
    return calibrate(ARM, s.q, s.measurements, loss="huber", folds=2, on_rank_deficiency="fix")


NAMES = [
    "poses",
    "eye-in-hand",
    "points unknown",
    "distances unknown",
    "coupled",
    "pitch",
    "terms",
    "sags",
]


@pytest.fixture(scope="module", params=NAMES)
def found(request):
    return case(request.param)


@pytest.fixture
def saved(tmp_path):
    path = tmp_path / "arm.toml"
    case("poses").save(path)
    return path


def same(a, b):
    """Equal to the last bit, whatever they are made of."""
    if isinstance(a, np.ndarray):
        return a.shape == b.shape and np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
    if isinstance(a, dict):
        return list(a) == list(b) and all(same(a[k], b[k]) for k in a)
    if hasattr(a, "__dataclass_fields__"):
        return all(same(getattr(a, f.name), getattr(b, f.name)) for f in fields(a))
    if isinstance(a, tuple):
        return len(a) == len(b) and all(map(same, a, b))
    return a == b


def test_a_calibration_comes_back_to_the_last_bit(found, tmp_path):
    found.save(tmp_path / "arm.toml")
    again = load(tmp_path / "arm.toml", [RIPPLE])
    for field in fields(found):
        # measurements are not in the file
        if field.name not in ("error_model", "residuals", "evidence"):
            assert same(getattr(found, field.name), getattr(again, field.name)), field.name
    assert again.error_model.parameters == found.error_model.parameters
    assert str(again) == str(found)
    assert again.to_dict() == found.to_dict()
    assert same(again.diagnosis, found.diagnosis)
    assert again.chain.masses is found.chain.masses is None or same(
        again.chain.masses, found.chain.masses
    )
    q = found.nominal.random(3, 4)
    np.testing.assert_array_equal(again.pose_covariance(q), found.pose_covariance(q))
    np.testing.assert_array_equal(again.true_joints(q), found.true_joints(q))
    assert again.error_model.reference == found.error_model.reference
    again.save(tmp_path / "again.toml")
    assert (tmp_path / "again.toml").read_text() == (tmp_path / "arm.toml").read_text()


def test_what_a_term_gains_comes_back_where_it_could_not_be_told_too(saved):
    terms = (
        TermGain("drift", True, 1, float("nan"), float("nan")),
        TermGain("lag", False, 5, -2e-3, 1e-4),
    )
    replace(case("poses"), terms=terms).save(saved)
    assert str(load(saved).terms) == str(terms)


def test_what_the_residuals_showed_is_in_the_file_with_its_chance(tmp_path):
    found = case("sags")
    found.save(tmp_path / "arm.toml")
    again = load(tmp_path / "arm.toml")
    assert again.diagnosis is not None
    findings = again.diagnosis.findings
    assert findings[0].verdict == "the error of joint 3 (joint3) repeats with its angle"
    assert findings[0].p < 1e-6
    assert len(again.diagnosis.tests) > len(findings)
    assert [frame.name for frame in again.tool_and_base] == ["base", "tool"]
    text = (tmp_path / "arm.toml").read_text()
    for old, new, message in (
        ('kind = "angle"', 'kind = "sag"', "finding 1: kind: expected 'gravity', 'angle', 'lag'"),
        ("against = false", "against = 1", "finding 1: against: expected true or false, got 1"),
        ("    [\n        0.0,\n        0.0,\n        0.0,\n    ],\n]\n\n[[diagnosis", "]\n[[diagnosis",
         "points: expected the points that were measured, got none"),
    ):  # fmt: skip
        assert old in text
        (tmp_path / "bad.toml").write_text(text.replace(old, new, 1))
        with pytest.raises(ModelError, match=re.escape(f"bad.toml: diagnosis: {message}")):
            load(tmp_path / "bad.toml")


def test_a_file_of_an_older_poekin_has_no_diagnosis(saved):
    text = saved.read_text()
    begin = text.index("[diagnosis]")
    saved.write_text(text[:begin])  # it is the last of the file
    assert load(saved).diagnosis is None
    assert load(saved).tool_and_base == ()


def test_a_term_of_ones_own_has_to_be_given_again(tmp_path):
    case("terms").save(tmp_path / "arm.toml")
    with pytest.raises(ModelError, match="got 'ripple'"):
        load(tmp_path / "arm.toml")


def test_the_robot_in_the_file_moves_as_the_calibrated_chain(saved):
    robot, chain = pk.load(saved), load(saved).chain
    assert robot.chain(tip="t").q_names == chain.q_names
    q = chain.random(0, 50)
    # the z-aligned frames of a robot are other numbers: some rounding for each of six frames
    np.testing.assert_allclose(
        robot.chain(tip="t").fk(q), chain.fk(q), rtol=0, atol=2e-15 * 10 * chain.reach
    )


def test_a_robot_that_a_chain_cannot_be_is_an_error_with_the_file(tmp_path):
    case("coupled").save(tmp_path / "c.toml")
    with pytest.raises(
        ModelError, match=r"c\.toml: calibrated: joint 'joint2' follows several coordinates"
    ):
        pk.load(tmp_path / "c.toml")


OFFSET, SCREW, ROW = "offset = [\n    ", "screws = [\n    ", "covariance = [\n    [\n        "
FAULTS = {
    "format": (
        '"poekin calibration"',
        '"DH"',
        r"format: expected 'poekin calibration', got 'DH'",
    ),
    "version": (
        "version = 1",
        "version = 2",
        r"version: expected 1, got 2: another version of poekin's",
    ),
    "half a version": (
        "version = 1",
        "version = 1.5",
        r"version: expected whole numbers from 0 on, got 1\.5",
    ),
    "success": ("success = true", "success = 1", r"success: expected true or false, got 1"),
    "loss": (
        'loss = "huber"',
        'loss = "none"',
        r"loss: expected 'linear', 'huber', 'cauchy' or 'tukey', got 'none'",
    ),
    "unknown key": (
        "version = 1",
        "version = 1\nversoin = 1",
        r"no such key: 'versoin'; did you mean 'version'\?",
    ),
    "not TOML": ("version = 1", "version = ", r"not TOML.*"),
    "two keys": ("version = 1", "version = 1\nversion = 1", r"not TOML.*"),
    "kinds": (
        '    "screws",\n',
        '    "screw",\n',
        r"parameters: expected some of 'screws', 'home', 'offsets', 'gains', 'pitch', 'compliance',"
        r" 'coupling', 'harmonics', 'second harmonics', 'backlash', 'lag', 'drift', got 'screw'",
    ),
    "joint": (
        'joints = [\n    "joint1"',
        'joints = [\n    "joint9"',
        (
            r"joints: no joint 'joint9'; did you mean 'joint5' or 'joint4' or 'joint3' or 'joint2' or "
            r"'joint1'\?"
        ),
    ),
    "a text as number": (
        f"{OFFSET}0.0",
        f'{OFFSET}"0.0"',
        r"nominal: offset: expected a number, got '0\.0'",
    ),
    "nan": (f"{OFFSET}0.0", f"{OFFSET}nan", r"nominal: offset: expected finite numbers, got nan"),
    "a number too large": (
        f"{OFFSET}0.0",
        f"{OFFSET}1{400 * '0'}",
        r"nominal: offset: expected finite numbers, got inf",
    ),
    "a column too many": (
        f"{OFFSET}0.0",
        f"{OFFSET}0.0, 0.0",
        r"nominal: offset: expected a list of 5 numbers, got 6 of them",
    ),
    "one list too few": (
        f"{SCREW}[",
        f"{SCREW}0,\n    [",
        r"nominal: screws: expected a list of 5 lists, got 6 of them",
    ),
    "no screw": (
        f"{SCREW}[\n        0.0",
        f"{SCREW}[\n        0.5",
        r".*nominal: screws\[0\] .*length 1.*",
    ),
    "limits": (
        "2.0,\n    ],",
        "-inf,\n    ],",
        r"nominal: limits: expected lower <= upper for 'joint1', got -inf and -inf",
    ),
    "parameter": (
        'owner = "joint1"',
        'owner = "joint2"',
        (
            r"parameter 1: what: expected 'joint1: tilt about \(1, 0, 0\)', the arm's parameter 1, got "
            r"'joint2: tilt about \(1, 0, 0\)'"
        ),
    ),
    "value": (
        "value = ",
        "value = 1 # ",
        r"calibrated: the chain is not what the parameters make of the nominal one",
    ),
    "deviation": (
        "deviation = ",
        "deviation = 1 # ",
        r".*parameter 1: deviation: expected .* as the covariance says.*",
    ),
    "covariance": (
        ROW,
        f"{ROW}-",
        r"covariance: expected a symmetric matrix with a diagonal that is not negative",
    ),
    "frame": (
        "[frames]",
        "[frames]\nhere = [0, 0, 0]",
        r"parameter: expected 27 of them, as arm and frames have, got 24",
    ),
    "pose": (
        "[frames]",
        "[frames]\nhere = [0, 0]",
        r"frames: here: expected a list of 3 numbers, got 2 of them",
    ),
    "no pose": (
        "[frames]",
        f"[frames]\nhere = {np.full((4, 4), 0.5).tolist()}",
        (
            r"frames: here: T is no pose: its last row is \[0\.5, 0\.5, 0\.5, 0\.5\], expected \[0, 0, "
            r"0, 1\]"
        ),
    ),
    "held out": (
        "folds = 2",
        "folds = -2",
        r"cross_validation: folds: expected whole numbers from 0 on, got -2",
    ),
    "identification": (
        "rank = ",
        "rang = ",
        r"identification: no such key: 'rang'; did you mean 'rank'\?",
    ),
    "noise_std": (
        "noise_std = [\n    {},",
        "noise_std = [\n    1,",
        r"noise_std 1: expected a table, got 1",
    ),
    "outlier": (
        "outliers = [\n",
        "outliers = [\n    [0, 40, 40],\n",
        r"outliers: expected set, index and row of a measurement, got \[0, 40, 40\]",
    ),
    "outlier beyond the last": (
        "outliers = [\n",
        "outliers = [\n    [0, 99, 99],\n",
        r"outliers: expected set, index and row of a measurement, got \[0, 99, 99\]",
    ),
    "outlier of another row": (
        "outliers = [\n",
        "outliers = [\n    [0, 3, 5],\n",
        r"outliers: expected set, index and row of a measurement, got \[0, 3, 5\]",
    ),
    "outlier of no set": (
        "outliers = [\n",
        "outliers = [\n    [7, 0, 0],\n",
        r"outliers: expected set, index and row of a measurement, got \[7, 0, 0\]",
    ),
    "sets": (
        "noise_std = [\n    {},",
        "noise_std = [",
        r"after: expected sets below 0, as there is a \[\[noise_std\]\] for each, got 0",
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_what_is_wrong_is_said_with_file_and_key(name, saved):
    old, new, message = FAULTS[name]
    text = saved.read_text()
    assert old in text
    saved.write_text(text.replace(old, new, 1))
    with pytest.raises(ModelError, match=rf"^{re.escape(str(saved))}: {message}$"):
        load(saved)


def test_a_parameter_of_a_frame_that_is_not_there_is_refused(tmp_path):
    path = tmp_path / "arm.toml"
    found = case("points unknown")
    found.save(path)
    owner = found.parameters[-1].owner
    assert owner in found.frames
    text, _, rest = path.read_text().rpartition(f'owner = "{owner}"')
    path.write_text(f'{text}owner = "nowhere"{rest}')
    count = len(found.parameters)
    said = f"parameter {count}: owner: expected a name in frames, got 'nowhere'"
    with pytest.raises(ModelError, match=said):
        load(path)


def test_a_key_that_is_missing_is_named(saved):
    lines = saved.read_text().splitlines()
    for name in ("success", "loss", "version"):
        saved.write_text("\n".join(line for line in lines if not line.startswith(f"{name} = ")))
        with pytest.raises(ModelError, match=rf"arm\.toml: {name} is missing"):
            load(saved)


@settings(deadline=None)
@given(data=st.data())
def test_a_damaged_file_is_an_error_of_its_own_or_none(data, tmp_path_factory):
    """Whatever stands in a line: a PoekinError or a calibration, nothing else."""
    path = tmp_path_factory.getbasetemp() / "damaged.toml"
    if not path.exists():
        case("poses").save(path)
        path.with_suffix(".lines").write_text(path.read_text())
    lines = path.with_suffix(".lines").read_text().splitlines()
    k = data.draw(st.integers(0, len(lines) - 1))
    left, equals, _ = lines[k].partition(" = ")
    other = data.draw(
        st.sampled_from(
            ["-1", "1e300", "nan", '"x"', "[]", "{}", "true", "1979-05-27", "[[1]]", "]", ""]
        )
    )
    lines[k] = f"{left}{equals}{other}" if equals else f"{other},"
    path.write_text("\n".join(lines))
    said = ""
    try:
        load(path)
    except PoekinError as fault:
        said = str(fault)
    assert not said or "damaged.toml: " in said


def test_what_is_no_calibration_is_refused(tmp_path):
    with pytest.raises(FileError, match=r"none\.toml: cannot be read"):
        load(tmp_path / "none.toml")
    (tmp_path / "dh.toml").write_text('convention = "standard"\n')
    with pytest.raises(ModelError, match=r"dh\.toml: format is missing"):
        load(tmp_path / "dh.toml")
    (tmp_path / "bytes.toml").write_bytes(b"format = '\xff'\n")
    with pytest.raises(FileError, match=r"bytes\.toml: not UTF-8 at byte 10"):
        load(tmp_path / "bytes.toml")


def test_a_file_that_cannot_be_written_leaves_nothing(tmp_path):
    found = case("pitch")
    with pytest.raises(FileError, match=r"cannot write"):
        found.save(tmp_path / "none" / "arm.toml")
    assert list(tmp_path.iterdir()) == []


def test_writing_without_tomli_w_names_the_extra(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "tomli_w", None)
    with pytest.raises(
        MissingExtra,
        match=r"^writing TOML needs the package tomli-w: pip install 'poekin\[formats\]'$",
    ):
        case("pitch").save(tmp_path / "arm.toml")
    assert list(tmp_path.iterdir()) == []


def test_a_set_of_residuals_beyond_those_with_a_noise_is_told_with_both_numbers():
    keys: Any = SimpleNamespace(fault=lambda name, words: ModelError(f"{name}: {words}"))
    found: Any = SimpleNamespace(
        noise_std=(None,), after=SimpleNamespace(set=np.array([0, 2])), outliers=()
    )
    with pytest.raises(ModelError) as caught:
        toml_checks.check_sets(keys, found)
    assert str(caught.value) == (
        "after: expected sets below 1, as there is a [[noise_std]] for each, got 2"
    )
