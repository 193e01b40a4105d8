"""`poekin ik`: poses in, joints out, and reasons where there are none."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import poekin as pk
from poekin.cli.kinematics import ik as command
from poekin.solve import motion

PANDA = ["ik", "panda", "--tip", "panda_hand"]
HOSTILE = "[red]\x1b[31m"


@pytest.fixture(scope="module")
def arm():
    return pk.load("panda").chain(tip="panda_hand")


@pytest.fixture(scope="module")
def T(arm):
    rng = np.random.default_rng(0)
    return arm.fk(arm.random(rng, 5))


def words_of(row):  # type: ignore[no-untyped-def]
    return [repr(float(x)) for x in row]


@pytest.mark.parametrize(
    ("format", "order"), [("12", None), ("16", None), ("7", "wxyz"), ("7", "xyzw")], ids=str
)
@pytest.mark.parametrize("suffix", [".csv", ".npy"])
def test_poses_of_every_format_are_solved(format, order, suffix, as_json, arm, T, tmp_path):
    given = tmp_path / f"T{suffix}"
    motion.write_poses(tmp_path / "T.csv", T, format, quaternion=order)
    if suffix == ".npy":
        np.save(given, np.loadtxt(tmp_path / "T.csv", delimiter=",", skiprows=1))
    extra = ["--quaternion", order] if order else []
    result = as_json(*PANDA, "--input", given, "--format", format, *extra)
    assert result["success"] == [True] * 5
    np.testing.assert_allclose(arm.fk(result["q"]), T, rtol=0, atol=3e-9)
    assert result["why"] == [None] * 5
    assert result["q_names"] == list(arm.q_names)


def test_what_fk_writes_ik_reads(poekin, as_json, arm, tmp_path):
    q = arm.random(1, 3)
    motion.write_joints(tmp_path / "q.csv", q, arm)
    for suffix in (".csv", ".npy"):
        out = tmp_path / f"T{suffix}"
        assert (
            poekin(
                "fk", "panda", "--tip", "panda_hand", "--input", tmp_path / "q.csv", "--output", out
            )[0]
            == 0
        )
        found = as_json(*PANDA, "--input", out, "--format", 16)
        np.testing.assert_allclose(arm.fk(found["q"]), arm.fk(q), rtol=0, atol=3e-9)


def test_one_pose_on_the_command_line(poekin, as_json, arm, T):
    row = words_of(T[0, :3].ravel())
    code, out, err = poekin(*PANDA, "--format", 12, *row)
    assert (code, err) == (0, "")
    assert out.startswith("panda_hand in panda_link0: solved, ")
    assert "  panda_joint1 = " in out
    q = as_json(*PANDA, "--format", 12, *row)["q"]
    np.testing.assert_allclose(arm.fk(q), T[0], rtol=0, atol=3e-9)


def test_numbers_and_options_are_those_of_the_library(poekin, as_json, arm, T, tmp_path):
    given, options = tmp_path / "T.csv", {"seed": 3, "task": "position", "limits": False}
    motion.write_poses(given, T, "12")
    words = [
        *PANDA,
        "--input",
        given,
        "--format",
        12,
        "--seed",
        3,
        "--task",
        "position",
        "--no-limits",
    ]
    expected, result = pk.ik(arm, T, **options), as_json(*words)
    for name in (
        "q",
        "success",
        "reason",
        "position_error",
        "rotation_error",
        "iterations",
        "restarts",
    ):
        assert result[name] == getattr(expected, name).tolist()
    assert [result[name] for name in ("robot", "base", "tip")] == [
        "panda",
        "panda_link0",
        "panda_hand",
    ]
    columns = [expected.q, expected.success, expected.position_error, expected.rotation_error]
    for suffix in (".csv", None):
        out = tmp_path / "q.csv"
        text = poekin(*words, *(["--output", out] if suffix else []))[1]
        rows = np.loadtxt(
            (out.read_text() if suffix else text).splitlines(), delimiter=",", skiprows=1
        )
        np.testing.assert_array_equal(rows, np.column_stack(columns))
    q0 = arm.random(4)
    start = as_json(
        *PANDA, "--format", 12, "--q0", ",".join(words_of(q0)), *words_of(T[0, :3].ravel())
    )
    assert start["q"] == pk.ik(arm, T[0], q0=q0).q.tolist()


def test_what_is_missed_is_told_in_mm_and_degrees(poekin, arm, T, monkeypatch):
    found = replace(
        pk.ik(arm, T[:1]), position_error=np.array([0.00123]), rotation_error=np.array([0.00456])
    )
    monkeypatch.setattr(command, "ik", lambda *_, **__: found)
    _, out, _ = poekin(*PANDA, "--format", 12, *words_of(T[0, :3].ravel()))
    assert out.splitlines() == [
        "panda_hand in panda_link0: solved, 1.2 mm and 0.26° off",
        *(f"  {name} = {x:.9g}" for name, x in zip(arm.q_names, found.q[0], strict=True)),
    ]


def test_q0_and_nearest_to_are_taken(as_json, arm):
    q = np.array([0.1, -0.5, 0.2, -2.0, 0.1, 1.6, 0.8])
    row = words_of(arm.fk(q)[:3].ravel())
    for option in ("--q0", "--nearest-to"):
        result = as_json(*PANDA, "--format", 12, option, ",".join(words_of(q)), *row)
        np.testing.assert_allclose(result["q"], q, rtol=0, atol=0.2)


def test_what_is_not_solved_is_exit_code_1_with_reasons(poekin, arm, T, tmp_path):
    T = T.copy()
    T[1, 0, 3], T[3] = 9.0, np.nan
    np.savetxt(tmp_path / "T.csv", T[:, :3].reshape(5, 12), delimiter=",", fmt="%.17g")
    call = [*PANDA, "--input", tmp_path / "T.csv", "--format", 12]
    code, out, err = poekin(*call)
    assert code == 1
    assert len(out.splitlines()) == 6
    assert out.splitlines()[0] == ",".join(
        [*arm.q_names, "success", "position_error", "rotation_error"]
    )
    assert "poekin: pose 1: unreachable: the target is farther than the arm's reach by" in err
    assert "poekin: pose 3: bad target" in err
    code, out, _ = poekin(*call, "--json")
    assert code == 1
    result = json.loads(out)
    assert result["success"] == [True, False, True, False, True]
    assert result["why"][1].startswith("unreachable")
    assert result["q"][3] == [None] * 7
    code, out, _ = poekin(*call, "--output", tmp_path / "q.npy")
    assert (code, out) == (1, f"5 × q written to '{tmp_path}/q.npy', 3 of 5 solved\n")
    assert np.load(tmp_path / "q.npy").shape == (5, 7)
    code, out, _ = poekin(*call, "--output", tmp_path / "q.json", "--json")
    assert json.loads(out) == {"written": str(tmp_path / "q.json"), "poses": 5, "solved": 3}
    assert json.loads((tmp_path / "q.json").read_text())["success"] == result["success"]


def test_one_pose_out_of_reach_is_told_on_stderr(poekin):
    code, out, err = poekin(*PANDA, "--format", 7, "--quaternion", "wxyz", 9, 0, 0, 1, 0, 0, 0)
    assert code == 1
    assert "not solved" in out
    assert err.startswith("poekin: the pose: unreachable: ")


def test_of_very_many_reasons_the_first_are_told(poekin, tmp_path):
    motion.write_poses(tmp_path / "T.csv", pk.se3.exp(np.tile([0, 0, 0, 9.0, 0, 0], (30, 1))), "12")
    code, _, err = poekin(*PANDA, "--input", tmp_path / "T.csv", "--format", 12)
    assert code == 1
    assert len(err.splitlines()) == 21
    assert err.splitlines()[19].startswith("poekin: pose 19: unreachable: ")
    assert err.splitlines()[20] == "poekin: and 10 more poses; --json tells of each"


def test_a_file_with_names_alone_is_an_empty_batch(poekin, tmp_path):
    names = ",".join(f"T{i}{j}" for i in range(3) for j in range(4))
    (tmp_path / "T.csv").write_text(f"{names}\n")
    code, out, err = poekin(*PANDA, "--input", tmp_path / "T.csv", "--format", 12)
    assert (code, err, out.count("\n")) == (0, "", 1)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        ([1, 0, 0], "--format: expected one of matrix, quat"),
        (["--format", 9, 1], "--format: expected one of matrix, quat"),
        (["--format", 7, *range(7)], "--quaternion: the format 7 needs the order of its quaternion, wxyz or xyzw"),
        (["--format", 7, "--quaternion", "zyxw", 1], "got 'zyxw'"),
        (["--format", 12, "--quaternion", "wxyz", 1], "--quaternion: the format 12 does not take an order"),
        (["--format", 12, 1, 2], "the pose:1: 12 values expected (T00, T01"),
        (["--format", 7, "--quaternion", "wxyz", 0, 0, 0, 1, 0, 0, "x"],
         "the pose:1, column 7: a number expected, got 'x'"),
        (["--format", 7, "--quaternion", "wxyz", 0, 0, 0, 2, 0, 0, 0], "the pose:1: the quaternion's length is 2"),
        (["--format", 12, *range(12)], "the pose:1: its rotation misses orthonormality"),
        (["--format", 12, "--inptu", "x"], "there is no option '--inptu'; did you mean '--input'"),
        (["--format", 12, "--no-limit", "x"], "there is no option '--no-limit'; did you mean '--no-limits'"),
        (["--format", 12, "--task", "pos", *[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]], "task: expected 'pose'"),
        (["--format", 12, "--input", "T.csv", 1], "either a pose or --input expected, got both"),
        (["--format", 12, "--input", "no.csv"], "cannot read 'no.csv'"),
        (["--format", 12, "--q0", "1,2", *[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]], "--q0: 7 coordinates expected"),
        (["--format", 12, "--q0", "a", *[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]], "--q0: number 1: a number expected"),
        (["--format", 12, "--output", "/no/q.csv", 1], "there is no directory '/no'"),
        (["--format", 12, "--output", "q.txt", 1], "a name that ends in .csv or .npy or .json expected"),
    ],
    ids=lambda x: " ".join(map(str, x))[:40] if isinstance(x, list) else None,
)  # fmt: skip
def test_what_is_no_pose_is_refused(call, says, refused):
    assert says in refused(*PANDA, *call)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("1,2\n", "T.csv':1: 12 values expected"),
        ("\n" + ",".join("0" * 12), "T.csv':2: its rotation misses orthonormality"),
        (
            ",".join("0" * 11) + "," + HOSTILE,
            "T.csv':1, column 12: a number expected, got '[red]\\x1b[31m'",
        ),
    ],
    ids=["short", "no-rotation", "hostile"],
)
def test_a_bad_row_is_named_with_its_line(text, says, refused, tmp_path):
    (tmp_path / "T.csv").write_text(text)
    message = refused(*PANDA, "--input", tmp_path / "T.csv", "--format", 12)
    assert says in message
    assert "\x1b" not in message


def test_a_bad_row_of_an_array_is_named_with_its_number(refused, tmp_path):
    np.save(tmp_path / "T.npy", np.zeros((3, 12)))
    assert "T.npy', row 0: its rotation" in refused(
        *PANDA, "--input", tmp_path / "T.npy", "--format", 12
    )
    np.save(tmp_path / "T.npy", np.zeros((3, 4, 4)))
    assert "(N, 12) expected, got (3, 4, 4)" in refused(
        *PANDA, "--input", tmp_path / "T.npy", "--format", 12
    )


SCARA = """<robot name="scara"><link name="base"/><link name="a"/><link name="b"/><link name="tool"/>
<joint name="j1" type="continuous"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/></joint>
<joint name="j2" type="continuous"><parent link="a"/><child link="b"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/></joint>
<joint name="lift" type="prismatic"><parent link="b"/><child link="tool"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>
"""


def test_what_fits_an_arm_of_few_joints_can_be_asked_for(poekin, as_json, tmp_path):
    urdf, given = tmp_path / "scara.urdf", tmp_path / "T.csv"
    urdf.write_text(SCARA)
    T = pk.se3.exp([0.3, 0.2, 0.1, 0.5, 0.6, 0.2])
    motion.write_poses(given, T[None], "12")
    words = [urdf, "--input", given, "--format", 12]
    found = json.loads(poekin("ik", *words, "--json")[1])
    assert found["reason"] == ["unreachable"]
    assert found["reachable_tasks"] == [["position"]]
    assert found["why"][0].endswith("only with task='position'")
    q = as_json("ik", *words, "--task", "position")["q"][0]
    np.testing.assert_allclose(pk.load(urdf).chain().fk(q)[:3, 3], T[:3, 3], rtol=0, atol=2e-9)
    assert as_json("follow", *words, "--task", "position")["solved"] == 1
