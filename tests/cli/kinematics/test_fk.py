"""`poekin fk` and `poekin jacobian`: numbers on the command line, files in and out."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from poekin.formats.load import load
from tests.findings import dataclasses_of


@pytest.fixture
def arm(crane):
    return load(crane).chain(tip="hook")


@pytest.mark.parametrize(
    "words",
    [
        ["--tip", "hook", "-0.5", "-.25"],
        ["-0.5", "-.25", "--tip", "hook"],
        ["-0.5", "--tip", "hook", "-2.5e-1"],
        ["--tip=hook", "--", "-0.5", "-0.25"],
    ],
)
def test_negative_numbers_are_numbers_wherever_they_stand(crane, as_json, arm, words):
    path = Path(crane)
    path.write_text(path.read_text().replace('lower="0"', 'lower="-1"'))
    if "--" in words:
        words = ["--json", *words]
        from poekin.cli import run

        assert run(["fk", crane, *words]) == 0
        return
    result = as_json("fk", crane, *words)
    np.testing.assert_array_equal(result["T"], arm.fk([-0.5, -0.25]))
    assert (result["base"], result["tip"], result["q"]) == ("root", "hook", [-0.5, -0.25])


def test_the_panda_of_the_catalogue_by_name(as_json):
    q = [-0.5, 0, 0, -1, 0, 1, 0]
    result = as_json("fk", "panda", "--tip", "panda_hand", *q)
    np.testing.assert_array_equal(
        result["T"], load("panda").chain(tip="panda_hand").fk(np.array(q, float))
    )


def test_a_base_may_be_any_link(crane, as_json):
    result = as_json("fk", crane, "--tip", "lamp", "--base", "hook", 0.5)
    np.testing.assert_array_equal(result["T"], load(crane).chain(base="hook", tip="lamp").fk([0.5]))


@pytest.mark.parametrize("frame", ["space", "body", "hybrid", "1"])
def test_each_frame_of_the_jacobian(crane, as_json, arm, frame):
    result = as_json("jacobian", crane, "--tip", "hook", "--frame", frame, 0.3, 0.2)
    which = int(frame) if frame.isdigit() else frame
    np.testing.assert_array_equal(result["J"], arm.jacobian([0.3, 0.2], which))


def test_jacobian_takes_degrees_and_mm_and_tells_of_limits(crane, poekin, as_json, arm):
    words = ("jacobian", crane, "--tip", "hook", "--frame", "body")
    J = as_json(*words, "--deg", "--mm", 30, 200)["J"]
    np.testing.assert_array_equal(J, arm.jacobian([np.radians(30), 0.2], "body"))
    assert "slide = 200 m is outside its limits, 0 to 1; are these mm?" in poekin(*words, 0, 200)[2]
    assert poekin(*words, 0, 1.5)[2].endswith("slide = 1.5 m is outside its limits, 0 to 1\n")


def test_coordinates_of_one_word_have_commas_between(crane, as_json, arm, refused):
    T = as_json("fk", crane, "--tip", "hook", "0.3, 0.2")["T"]
    np.testing.assert_array_equal(T, arm.fk([0.3, 0.2]))
    assert "coordinate 1: a number expected, got '0,3'" in refused(
        *("fk", crane, "--tip", "hook", "0,3", "0,2")
    )


def test_an_empty_file_is_refused_and_not_an_empty_batch(crane, refused, tmp_path):
    (tmp_path / "q.csv").write_text("\n")
    words = ("fk", crane, "--tip", "hook", "--input", tmp_path / "q.csv")
    assert "q.csv': rows of numbers expected, the file is empty" in refused(*words)


def test_a_pose_is_printed_as_a_matrix(crane, poekin):
    code, out, err = poekin("fk", crane, "--tip", "hook", 0, 0)
    assert (code, err) == (0, "")
    assert "pose of hook in root (m), at\n  turn = 0\n  slide = 0\n" in out
    assert len(out.splitlines()[-5].split()) == 4


def test_a_jacobian_is_printed_with_the_names_of_rows_and_columns(crane, poekin):
    code, out, _ = poekin("jacobian", crane, "--tip", "hook", "--frame", "hybrid", 0, 0)
    lines = out.splitlines()
    assert code == 0
    assert lines[-7].split() == ["turn", "slide"]
    assert [line.split()[0] for line in lines[-6:]] == ["wx", "wy", "wz", "vx", "vy", "vz"]


@pytest.mark.parametrize("suffix", [".csv", ".npy", ".json"])
@pytest.mark.parametrize("source", [".csv", ".npy"])
def test_many_configurations_go_through_files_to_the_last_bit(
    crane, poekin, arm, tmp_path, source, suffix
):
    q = np.random.default_rng(0).normal(size=(5, 2))
    given, out = tmp_path / f"q{source}", tmp_path / f"T{suffix}"
    np.save(given, q) if source == ".npy" else given.write_text(
        "\n".join(f"{a!r},{b!r}" for a, b in q.tolist())
    )
    code, text, _ = poekin("fk", crane, "--tip", "hook", "--input", given, "--output", out)
    assert (code, text) == (0, f"5 × T written to '{out}'\n")
    read = {
        ".csv": lambda: np.loadtxt(out, delimiter=",", skiprows=1).reshape(-1, 4, 4),
        ".npy": lambda: np.load(out),
        ".json": lambda: np.array(json.loads(out.read_text())["T"]),
    }
    np.testing.assert_array_equal(read[suffix](), arm.fk(q))
    assert not list(tmp_path.glob(".*"))


@pytest.mark.parametrize("command", [["fk"], ["jacobian", "--frame", "body"]])
def test_json_says_what_was_written_and_of_how_many(command, crane, as_json, tmp_path):
    (tmp_path / "q.csv").write_text("0,0.1\n0.2,0.3\n0.4,0.5\n")
    out = tmp_path / "out.npy"
    said = as_json(*command, crane, "--tip", "hook", "--input", tmp_path / "q.csv", "-o", out)
    assert said == {"written": str(out), "configurations": 3}
    assert len(np.load(out)) == 3


def test_a_single_configuration_is_printed_to_nine_digits_and_the_jacobian_by_its_rows(
    crane, poekin, arm
):
    q = [1.23456789, -0.987654321]
    lines = poekin("jacobian", crane, "--tip", "hook", "--frame", "hybrid", *q)[1].splitlines()
    assert lines[1:3] == ["  turn = 1.23456789", "  slide = -0.987654321"]
    J = np.array([line.split()[1:] for line in lines[-6:]], float)
    np.testing.assert_allclose(
        J, arm.jacobian(q, "hybrid"), rtol=1e-8
    )  # nine digits, more at least than 1e-8


def test_a_single_configuration_is_in_a_file_what_many_are(crane, poekin, arm, tmp_path):
    out = tmp_path / "T.json"
    assert poekin("fk", crane, "--tip", "hook", 0.3, 0.4, "--output", out)[0] == 0
    document = json.loads(out.read_text())
    assert document["q"] == [[0.3, 0.4]]
    np.testing.assert_array_equal(document["T"], arm.fk([[0.3, 0.4]]))


def test_more_configurations_than_are_computed_at_once_are_in_their_order(
    crane, poekin, arm, tmp_path, monkeypatch
):
    from poekin.cli.kinematics import arm as arms

    monkeypatch.setattr(arms, "ROWS_AT_ONCE", 2)
    q = np.random.default_rng(0).normal(size=(5, 2))
    np.save(tmp_path / "q.npy", q)
    assert (
        poekin(
            "fk",
            crane,
            "--tip",
            "hook",
            "--input",
            tmp_path / "q.npy",
            "--output",
            tmp_path / "T.npy",
        )[0]
        == 0
    )
    np.testing.assert_allclose(
        np.load(tmp_path / "T.npy"), arm.fk(q), rtol=0, atol=1e-15
    )  # in another batch


def test_many_configurations_are_csv_on_stdout(crane, poekin, arm, tmp_path):
    given = tmp_path / "q.csv"
    given.write_text("0.1,0.2\n\n0.3,0.4\n")
    code, out, err = poekin("jacobian", crane, "--tip", "hook", "--frame", "body", "--input", given)
    lines = out.splitlines()
    assert (code, err, len(lines)) == (0, "", 3)
    assert lines[0].split(",")[:3] == ["wx turn", "wx slide", "wy turn"]
    J = np.array([line.split(",") for line in lines[1:]], float).reshape(2, 6, 2)
    np.testing.assert_array_equal(J, arm.jacobian([[0.1, 0.2], [0.3, 0.4]], "body"))


def test_a_header_orders_the_columns(crane, as_json, tmp_path):
    given = tmp_path / "q.csv"
    given.write_text("slide, turn\n0.2,0.1\n")
    assert as_json("fk", crane, "--tip", "hook", "--input", given)["q"] == [[0.1, 0.2]]


def test_what_ik_and_follow_write_beside_the_coordinates_is_passed_over(
    crane, as_json, poekin, tmp_path
):
    given = tmp_path / "q.csv"
    given.write_text(
        "time,turn,slide,success,position_error,rotation_error\n0.5,0.1,0.2,1.0,x,1e-9\n"
    )
    assert as_json("fk", crane, "--tip", "hook", "--input", given)["q"] == [[0.1, 0.2]]
    given.write_text("time,turn,slide,turn\n0.5,0.1,0.2,1.0\n")
    code, _, err = poekin("fk", crane, "--tip", "hook", "--input", given)
    assert (code, "a name appears twice" in err) == (2, True)
    given.write_text("time,turn,slide\n0.5,0.1\n")
    code, _, err = poekin("fk", crane, "--tip", "hook", "--input", given)
    assert (code, ":2: 3 values expected, as the header has, got 2" in err) == (2, True)


def test_a_file_of_ik_is_read_by_fk(poekin, as_json, tmp_path):
    q, T, back = (tmp_path / name for name in ("q.csv", "T.csv", "back.csv"))
    q.write_text("0.1,-1.2,1.3,-0.4,0.5,0.6\n")
    poekin("fk", "ur5e", "--tip", "tool0", "--input", q, "--output", T)
    assert (
        poekin("ik", "ur5e", "--tip", "tool0", "--input", T, "--format", "16", "--output", back)[0]
        == 0
    )
    again = as_json("fk", "ur5e", "--tip", "tool0", "--input", back)["T"][0]
    np.testing.assert_allclose(
        np.ravel(again), np.loadtxt(T, delimiter=",", skiprows=1), rtol=0, atol=1e-6
    )


def test_an_empty_batch_is_a_batch(crane, poekin, tmp_path):
    np.save(tmp_path / "q.npy", np.zeros((0, 2)))
    out = tmp_path / "T.npy"
    assert (
        poekin("fk", crane, "--tip", "hook", "--input", tmp_path / "q.npy", "--output", out)[0] == 0
    )
    assert np.load(out).shape == (0, 4, 4)


@pytest.mark.parametrize("command", [["fk"], ["jacobian", "--frame", "body"]])
def test_an_empty_batch_gives_a_header_and_no_line(crane, poekin, tmp_path, command):
    (tmp_path / "q.csv").write_text("turn,slide\n")
    np.save(tmp_path / "q.npy", np.zeros((0, 2)))
    for given in ("q.csv", "q.npy"):
        code, out, err = poekin(*command, crane, "--tip", "hook", "--input", tmp_path / given)
        assert (code, err, out.count("\n")) == (0, "", 1)
        assert (
            poekin(
                *command,
                crane,
                "--tip",
                "hook",
                "--input",
                tmp_path / given,
                "--output",
                tmp_path / "o.csv",
            )[0]
            == 0
        )
        assert (tmp_path / "o.csv").read_text() == out


def test_the_case_of_a_suffix_does_not_matter(crane, poekin, arm, tmp_path):
    with open(tmp_path / "Q.NPY", "wb") as stream:
        np.save(stream, [[0.1, 0.2]])
    for out in ("T.NPY", "T.CSV", "T.Json"):
        words = ["--input", tmp_path / "Q.NPY", "--output", tmp_path / out]
        assert poekin("fk", crane, "--tip", "hook", *words)[0] == 0
    np.testing.assert_array_equal(np.load(tmp_path / "T.NPY"), arm.fk([[0.1, 0.2]]))
    assert (tmp_path / "T.CSV").read_text().startswith("T00,T01")
    assert json.loads((tmp_path / "T.Json").read_text())["T"] == arm.fk([[0.1, 0.2]]).tolist()


def test_nan_gives_null_for_that_configuration_only(crane, as_json, tmp_path):
    given = tmp_path / "q.csv"
    given.write_text("nan,0\n0,0\n")
    T = as_json("fk", crane, "--tip", "hook", "--input", given)["T"]
    assert T[0][0][0] is None
    assert T[1] == load(crane).chain(tip="hook").fk([0, 0]).tolist()


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("1,2\n3\n", ":2: 2 values expected (turn, slide), got 1"),
        ("1,2\n3,x\n", ":2, column 2: a number expected, got 'x'"),
        ("1,2\n3,1_0\n", ":2, column 2: a number expected, got '1_0'"),
        ("1,2\n\u0661,1\n", ":2, column 1: a number expected, got '\u0661'"),
        ("1,x\n", ":1, column 2: a number expected, got 'x'"),
        (
            "turn,slyde\n1,2\n",
            ":1: 'slyde' is neither a number nor a coordinate; did you mean 'slide'?",
        ),
        (
            "turn\n1\n",
            ":1: the header has to name each of the 2 coordinates once; 'slide' is missing",
        ),
        (
            "turn,slide,turn\n1,2,3\n",
            ":1: the header has to name each of the 2 coordinates once; a name appears twice",
        ),
    ],
)
def test_a_bad_line_is_named_by_file_and_line(crane, refused, tmp_path, content, message):
    given = tmp_path / "q.csv"
    given.write_text(content, encoding="utf-8")
    assert f"'{given}'{message}" in refused("fk", crane, "--tip", "hook", "--input", given)


def test_a_header_of_numbers_is_a_header_where_it_is_the_names(tmp_path, as_json, crane):
    renamed = tmp_path / "numbers.urdf"
    renamed.write_text(Path(crane).read_text().replace('"turn"', '"2"').replace('"slide"', '"1"'))
    (tmp_path / "q.csv").write_text("1,2\n0.25,0.5\n")
    assert as_json("fk", renamed, "--tip", "hook", "--input", tmp_path / "q.csv")["q"] == [
        [0.5, 0.25]
    ]


@pytest.mark.parametrize(
    ("array", "message"),
    [
        (np.zeros((3, 5)), "an array of shape (N, 2) expected, got (3, 5)"),
        (np.zeros(0), "an array of shape (N, 2) expected, got (0,)"),
        (np.zeros((3, 2), complex), "an array of real numbers expected"),
        (np.array([{}, {}], object), "is no .npy file of numbers"),
    ],
)
def test_an_array_that_cannot_be_configurations_is_refused(
    crane, refused, tmp_path, array, message
):
    np.save(tmp_path / "q.npy", array)
    assert message in refused("fk", crane, "--tip", "hook", "--input", tmp_path / "q.npy")


@pytest.mark.parametrize("content", [b"", b"\x93NUMPY", b"PK\x03\x04junk", b"\x80\x04K\x01."])
def test_a_damaged_npy_is_refused(crane, refused, tmp_path, content):
    (tmp_path / "q.npy").write_bytes(content)
    assert "q.npy" in refused("fk", crane, "--tip", "hook", "--input", tmp_path / "q.npy")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--tip", "hook", "1"], "2 coordinates expected (turn, slide), got 1"),
        (["--tip", "hook", "1", "2", "3"], "2 coordinates expected (turn, slide), got 3"),
        (["--tip", "hook"], "2 coordinates expected (turn, slide), got 0; or --input with a file"),
        (["--tip", "hook", "1", "two"], "coordinate 2: a number expected, got 'two'"),
        (["--tip", "hook", "1", "1_0"], "coordinate 2: a number expected, got '1_0'"),
        (
            ["--tip", "hook", "1", "\u0661"],
            "coordinate 2: a number expected, got '\u0661'",
        ),
        (["--tip", "hok", "1", "2"], "did you mean 'hook'?"),
        (
            ["--tip", "hook", "--bse", "a", "1", "2"],
            "there is no option '--bse'; did you mean '--base'",
        ),
        (["1", "2"], "'hook', 'lamp'"),
        (
            ["--tip", "hook", "--input", "nowhere.csv"],
            "cannot read 'nowhere.csv': No such file or directory",
        ),
        (
            ["--tip", "hook", "1", "--input", "q.csv"],
            "either coordinates or --input expected, got both ('1' and 'q.csv')",
        ),
        (
            ["--tip", "hook", "1", "2", "--output", "T.txt"],
            "a name that ends in .csv or .npy or .json expected",
        ),
        (["--tip", "hook", "1", "2", "--output", "no/T.csv"], "there is no directory 'no'"),
    ],
)
def test_a_bad_command_line_is_one_message(crane, refused, words, message):
    assert message in refused("fk", crane, *words)


def test_the_frame_of_a_jacobian_has_no_default(crane, refused):
    assert "--frame" in refused("jacobian", crane, "--tip", "hook", 0, 0)
    expected = "--frame: space, body, hybrid or the number of a joint (from 0) expected, got"
    for frame, got in (
        ("tool", "'tool'"),
        ("1_0", "'1_0'"),
        ("\u0661", "'\u0661'"),
        ("9" * 5000, "'9"),
    ):
        assert f"{expected} {got}" in refused(
            "jacobian", crane, "--tip", "hook", "--frame", frame, 0, 0
        )


def test_the_frame_of_a_joint_is_named_by_number_and_joint(crane, poekin, refused):
    out = poekin("jacobian", crane, "--tip", "hook", "--frame", "1", 0, 0)[1]
    assert out.startswith(
        "Jacobian of hook relative to root in the frame of joint 1, slide (rows w rad/s, v m/s), at\n"
    )
    assert (
        "hybrid Jacobian of hook"
        in poekin("jacobian", crane, "--tip", "hook", "--frame", "hybrid", 0, 0)[1]
    )
    assert "0 to 2" in refused("jacobian", crane, "--tip", "hook", "--frame", "3", 0, 0)
    assert "counted from 0" in " ".join(poekin("jacobian", "--help")[1].split())


def test_a_directory_or_a_text_that_is_no_text_is_refused(crane, refused, tmp_path):
    assert "Is a directory" in refused("fk", crane, "--tip", "hook", "--input", tmp_path)
    (tmp_path / "q.csv").write_bytes(b"\xff\xfe\x00")
    assert "not UTF-8" in refused("fk", crane, "--tip", "hook", "--input", tmp_path / "q.csv")


@pytest.mark.parametrize("kind", dataclasses_of("poekin.cli.kinematics", "arm fk"))
def test_neither_arguments_nor_results_are_changed_on_the_way(kind):
    assert kind.__dataclass_params__.frozen
