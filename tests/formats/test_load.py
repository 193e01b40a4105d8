"""load: files, the arms that come with poekin, and the robots of example-robot-data."""

from __future__ import annotations

import importlib.metadata
import math
import pathlib
import warnings
from collections import Counter
from collections.abc import Mapping
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.errors import (
    FileError,
    InputError,
    MissingExtra,
    ModelError,
    PoekinWarning,
    UnknownName,
)
from poekin.formats import catalogue, erd, load
from poekin.formats.dh.published_tables import NAMES as TABLES
from poekin.model.robot import Robot
from tests.formats.texts import one_joint

HALF = math.pi / 2


def z(theta: float, d: float) -> np.ndarray:
    """Rz(theta) Tz(d)."""
    c, s = math.cos(theta), math.sin(theta)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, d], [0, 0, 0, 1]])


def x(alpha: float, a: float) -> np.ndarray:
    """Rx(alpha) Tx(a)."""
    c, s = math.cos(alpha), math.sin(alpha)
    return np.array([[1, 0, 0, a], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])


def panda(q: list[float]) -> np.ndarray:
    """Pose of the Panda's flange from Franka's table, modified (Craig) convention: a, d, alpha."""
    rows = [
        (0, 0.333, 0),
        (0, 0, -HALF),
        (0, 0.316, HALF),
        (0.0825, 0, HALF),
        (-0.0825, 0.384, -HALF),
        (0, 0, HALF),
    ]
    T = np.eye(4)
    for (a, d, alpha), theta in zip([*rows, (0.088, 0, HALF)], q, strict=True):
        T = T @ x(alpha, a) @ z(theta, d)
    return T @ z(0, 0.107)


def ur5e(q: list[float]) -> np.ndarray:
    """Pose of the UR5e's flange from Universal Robots' table, standard convention: a, d, alpha."""
    rows = [
        (0, 0.1625, HALF),
        (-0.425, 0, 0),
        (-0.3922, 0, 0),
        (0, 0.1333, HALF),
        (0, 0.0997, -HALF),
        (0, 0.0996, 0),
    ]
    T = np.eye(4)
    for (a, d, alpha), theta in zip(rows, q, strict=True):
        T = T @ z(theta, d) @ x(alpha, a)
    return T


def stanford(q: list[float]) -> np.ndarray:
    """Pose of the Stanford arm's tool from Paul's table, standard convention: theta, d, alpha."""
    q1, q2, q3, q4, q5, q6 = q
    rows = [
        (q1, 0.412, -HALF),
        (q2, 0.154, HALF),
        (-HALF, q3, 0),
        (q4, 0, -HALF),
        (q5, 0, HALF),
        (q6, 0.263, 0),
    ]
    T = np.eye(4)
    for theta, d, alpha in rows:
        T = T @ z(theta, d) @ x(alpha, 0)
    return T


ARMS = {
    "panda": (panda, "panda_link8", 7),
    "ur5e": (ur5e, "tool0", 6),
    "stanford": (stanford, "tool", 6),
}


@pytest.mark.parametrize("name", ARMS)
@given(data=st.data())
def test_a_built_in_arm_agrees_with_the_makers_table(name, data):
    table, tip, count = ARMS[name]
    q = data.draw(st.lists(st.floats(-7, 7), min_size=count, max_size=count))
    chain = load(name).chain(tip=tip)
    assert chain.dof == count
    assert np.abs(chain.fk(np.array(q)) - table(q)).max() <= 1e-14 * chain.reach


@pytest.mark.parametrize("name", ARMS)
def test_an_error_of_a_tenth_of_a_millimetre_in_an_arm_would_be_found(name, monkeypatch):
    table, tip, count = ARMS[name]
    q = [0.3] * count
    monkeypatch.setattr(
        "tests.formats.test_load.z", lambda theta, d, right=z: right(theta, d + 1e-4)
    )
    assert np.abs(load(name).chain(tip=tip).fk(q) - table(q)).max() > 1e-5


def test_every_built_in_arm_is_tested_and_says_where_it_is_from():
    assert set(catalogue.NAMES) == set(ARMS)
    folder = pathlib.Path(catalogue.__file__).parent
    assert {path.stem for path in folder.glob("*.urdf")} == set(ARMS)
    for path in folder.glob("*.urdf"):
        assert "Source" in path.read_text(encoding="utf-8")


def test_the_pandas_fingers_open_together():
    hand = load("panda")
    assert hand.q_names[-1] == "panda_finger_joint1"
    assert hand.limits[-1].tolist() == [0, 0.04]
    between = hand.chain("panda_leftfinger", "panda_rightfinger")
    assert between.q_names == ("panda_finger_joint1",)
    T = between.fk([0.03])
    assert np.abs(T[:3, 3] - [0, -0.06, 0]).max() <= 1e-16
    assert np.isfinite(load("panda").limits).all()


def test_an_arm_slides():
    assert load("stanford").chain().kinds == (
        "revolute",
        "revolute",
        "prismatic",
        "revolute",
        "revolute",
        "revolute",
    )


def test_a_path_is_a_text_or_a_path_object(tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(one_joint(), encoding="utf-8")
    assert load(path) == load(str(path)) == load(path.as_posix())


def test_an_existing_file_comes_before_a_built_in_name_and_a_folder_does_not(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ur5e").mkdir()
    assert load("ur5e").name == "ur5e"
    (tmp_path / "panda").write_text(one_joint(), encoding="utf-8")
    assert load("panda").name == "r"
    with pytest.raises(FileError, match="this is a directory"):
        load(tmp_path / "ur5e")
    (tmp_path / "robots").mkdir()
    with pytest.raises(FileError, match=r"^robots: expected a file, this is a directory$"):
        load("robots")


@pytest.mark.parametrize(
    "name", ["gone.urdf", "robots/panda", "./panda", "a\0b.urdf", "\x1b[31m.urdf", "ARM.URDF"]
)
def test_a_path_that_does_not_exist_is_refused_as_a_file(name):
    with pytest.raises(FileError, match="no such file") as caught:
        load(name)
    assert str(caught.value).isprintable()


@pytest.mark.parametrize("name", ["pnda", "", "erd", "\x1b[31m", "a\0b"])
def test_an_unknown_name_is_answered_with_those_that_exist(name):
    with pytest.raises(
        UnknownName, match=r"built in: cobra600, .*panda, .*ur5e; \"erd:NAME\""
    ) as caught:
        load(name)
    assert str(caught.value).isprintable()
    with pytest.raises(UnknownName) as caught:
        load("pandaa")
    assert str(caught.value) == (
        "no file and no built-in arm is named 'pandaa'; did you mean 'panda'?"
        f' (built in: {", ".join(sorted({*catalogue.NAMES, *TABLES}))}; "erd:NAME" is for example-robot-data)'
    )


@pytest.mark.parametrize(
    ("name", "guess"),
    [
        ("UR5", "; did you mean 'ur5'? ("),
        ("Panda", "; did you mean 'panda'? ("),
        ("UR 10 e", "; did you mean 'ur10e' or "),
        ("robots/ur5e.urdf", "robots/ur5e.urdf: no such file; did you mean 'ur5e'?"),
        ("franka", "named 'franka' (built in: "),
    ],
)
def test_the_closest_name_is_suggested_whatever_its_case_and_folder(name, guess):
    with pytest.raises((UnknownName, FileError)) as caught:
        load(name)
    assert guess in str(caught.value)


def test_the_prefix_of_example_robot_data_may_be_misspelt_too(monkeypatch):
    monkeypatch.setattr(erd, "available", lambda: {"panda": "panda.urdf", "ur5": "ur5.urdf"})
    with pytest.raises(UnknownName, match=r"named 'ERD:Panda'; did you mean 'erd:panda'\? \("):
        load("ERD:Panda")
    with pytest.raises(
        UnknownName, match=r"^example-robot-data has no robot 'Panda'; did you mean 'panda'\?$"
    ):
        load("erd:Panda")


@pytest.mark.parametrize("installed", [True, False])
def test_a_robot_of_example_robot_data_is_suggested_where_nothing_built_in_is(
    installed, monkeypatch
):
    def available():
        if not installed:
            raise MissingExtra("example-robot-data", "robots", "this")
        return {"talos_left_arm": "talos_left_arm.urdf"}

    monkeypatch.setattr(erd, "available", available)
    with pytest.raises(UnknownName) as caught:
        load("Talos_left_arm")
    assert ("did you mean 'erd:talos_left_arm'?" in str(caught.value)) is installed


def test_a_file_is_named_in_what_is_wrong_with_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(FileError, match=r"^gone\.urdf: no such file$"):
        load("gone.urdf")
    with pytest.raises(InputError, match=r"^load: expected a name or a path, got bytes$"):
        load(b"panda")  # type: ignore[arg-type]
    (tmp_path / "a.xacro").write_text(one_joint(), encoding="utf-8")
    with pytest.raises(
        ModelError,
        match=(
            r"^a\.xacro: xacro evaluates expressions that are in the file, which load never does: "
            r"pk\.xacro\(path\) does, and --xacro on the command line$"
        ),
    ):
        load("a.xacro")
    long = "x" * 240 + "/" + "y" * 240 + ".urdf"
    with pytest.raises(FileError) as caught:
        load(long)
    assert str(caught.value) == f"{long[:399]}…: no such file"


@pytest.mark.parametrize("name", [7, None, b"panda", ["panda"]])
def test_what_is_no_name_is_refused(name):
    with pytest.raises(InputError, match="expected a name or a path"):
        load(name)


def robots() -> Mapping[str, str]:
    try:
        return erd.available()
    except MissingExtra:
        return {}


needs_robots = pytest.mark.skipif(not robots(), reason="example-robot-data is not installed")


@needs_robots
def test_a_robot_of_example_robot_data_is_found_by_its_name():
    assert load("erd:panda").name == "panda"
    assert load("erd:panda") == load(erd.available()["panda"])
    with pytest.raises(
        UnknownName, match=r"no robot 'tallos_left_arm'; did you mean 'talos_left_arm'"
    ):
        load("erd:tallos_left_arm")


@needs_robots
def test_a_name_that_two_robots_share_needs_the_folder():
    with pytest.raises(
        UnknownName, match=r"one of 'anymal_b_simple_description/anymal', 'anymal_c_simple_desc"
    ):
        load("erd:anymal")
    b, c = (
        load("erd:anymal_b_simple_description/anymal"),
        load("erd:anymal_c_simple_description/anymal"),
    )
    assert b != c


@pytest.fixture
def packaged(monkeypatch):
    """Two robots `anymal` and one `banymal`, in the package example-robot-data."""

    def packed(path: str) -> importlib.metadata.PackagePath:
        file = importlib.metadata.PackagePath("robots", path)
        file.dist = SimpleNamespace(locate_file=pathlib.PurePosixPath("/site").joinpath)  # type: ignore[assignment]
        return file

    files = [packed(f"{path}.urdf") for path in ("d/urdf/banymal", "c/urdf/anymal", "a/b/anymal")]
    monkeypatch.setattr(importlib.metadata, "files", lambda package: files)
    erd.available.cache_clear()
    yield
    erd.available.cache_clear()


def test_robots_of_example_robot_data_are_in_alphabetical_order(packaged):
    assert list(erd.available().items()) == [
        ("a/anymal", "/site/robots/a/b/anymal.urdf"),
        ("banymal", "/site/robots/d/urdf/banymal.urdf"),
        ("c/anymal", "/site/robots/c/urdf/anymal.urdf"),
    ]


def test_a_file_whose_links_belong_to_something_else_than_the_robot_is_empty(tmp_path, monkeypatch):
    texts = {"arm": one_joint(), "none": "<robot><gazebo><link/></gazebo></robot>"}
    for name, text in texts.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    paths = {name: str(tmp_path / name) for name in texts}
    monkeypatch.setattr(erd, "available", lambda: paths)
    assert [list(found) for found in erd.example_robots()] == [["arm"], ["none"]]


def test_a_shared_name_is_answered_with_those_that_have_it_and_no_longer_name(packaged):
    with pytest.raises(UnknownName, match=r"; it is one of 'a/anymal', 'c/anymal'$"):
        load("erd:anymal")


def test_without_example_robot_data_its_name_is_in_the_message(monkeypatch):
    def missing(package: str):
        raise importlib.metadata.PackageNotFoundError(package)

    erd.available.cache_clear()
    monkeypatch.setattr(importlib.metadata, "files", missing)
    with pytest.raises(MissingExtra, match="needs the package example-robot-data"):
        load("erd:panda")


@needs_robots
def test_every_robot_of_example_robot_data_is_read_and_the_empty_one_is_refused():
    loaded: dict[str, Robot] = {}
    refused: dict[str, str] = {}
    said: dict[str, list[str]] = {}
    for name, path in robots().items():
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                loaded[name] = load(path)
            except ModelError as error:
                refused[name] = str(error)
        assert all(issubclass(w.category, PoekinWarning) and w.filename == __file__ for w in caught)
        if caught:
            said[name] = [str(w.message) for w in caught]
    assert list(refused) == ["ur3"]
    assert "ur3.urdf:6: <robot>: expected at least one <link>" in refused["ur3"]
    joints = [joint for robot in loaded.values() for joint in robot.joints]
    chains = [robot.chain(tip=leaf) for robot in loaded.values() for leaf in robot.leaves]
    assert len(loaded) == 68
    assert Counter(j.kind for j in joints) == {
        "revolute": 1190,
        "fixed": 849,
        "continuous": 27,
        "prismatic": 15,
    }
    assert (
        sum(j.mimic is not None for j in joints) == 120 - 8
    )  # eight mimic joints that do not exist
    assert len(chains) == 721
    assert sum(not chain.kinds for chain in chains) == 136
    assert max(len(chain.kinds) for chain in chains) == 15
    assert set(said) == {
        "alex_psyonic_hands", "centauro", "double_pendulum", "double_pendulum_simple", "iris", "pr2", "quadruped",
    }  # fmt: skip
    assert (
        "'Left_index_q2' mimics 'index_q1', which does not exist, and stays independent"
        in said["alex_psyonic_hands"][0]
    )
    assert "'iris__rotor_0_joint' (-1e+16 to 1e+16; line 15)" in said["iris"][0]
    assert "'r_gripper_l_finger_joint' have no interval in common" in said["pr2"][0]


@needs_robots
@pytest.mark.parametrize(
    "name", ["panda", "tiago", "romeo", "anymal-kinova", "alex_psyonic_hands", "pr2"]
)
def test_all_links_of_a_robot_are_where_pinocchio_puts_them(name):
    oracles = pytest.importorskip("poekin.testing.oracles.pinocchio_oracle")
    pytest.importorskip("pinocchio")
    oracle = oracles.PinocchioOracle(pathlib.Path(robots()[name]).read_bytes())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        robot = load(f"erd:{name}")
    q = oracle.random(np.random.default_rng(0), 5)
    found, expected = robot.fk(q), oracle.link_poses(q)
    assert set(found) == set(expected)
    for link in robot.links:
        assert np.abs(found[link] - expected[link]).max() <= 2e-14 * max(
            1.0, np.abs(expected[link][:, :3, 3]).max()
        )


@needs_robots
def test_the_built_in_panda_is_the_panda():
    ours, theirs = load("panda"), load("erd:panda")
    assert set(ours.links) <= set(theirs.links)
    q = np.random.default_rng(0).uniform(ours.limits[:, 0], ours.limits[:, 1], (10, ours.dof))
    named = dict(zip(ours.q_names, q.T, strict=True))
    mine, other = ours.fk(q), theirs.fk({name: named.get(name, 0.0) for name in theirs.q_names})
    for link in ours.links:
        assert (
            np.abs(mine[link] - other[link]).max() <= 1e-10
        )  # the other one rounds its right angles
