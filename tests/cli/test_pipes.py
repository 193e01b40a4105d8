"""Models that are piped in: -, /dev/stdin and <( ) in every command, one of them only, once only."""

from __future__ import annotations

import contextlib
import gzip
import hashlib
import inspect
import os
import shlex
import subprocess
import sys
import threading
import zipfile
from pathlib import Path

import pytest

from poekin.cli import commands
from poekin.formats.load import load
from poekin.solve.calibration import calibrate, simulated
from tests.formats.ros_text import PRINTED, echo, echo_cut

TIP = ("--tip", "hook")
WORDS = {
    "info": (),
    "fk": ("0.1", "0.2", *TIP),
    "jacobian": ("--frame", "body", "0.1", "0.2", *TIP),
    "singularity": ("0.1", "0.2", *TIP),
    "ik": (*TIP, "--format", "12", "--input", "POSES"),
    "follow": (*TIP, "--format", "12", "--input", "POSES"),
    "calibrate": ("READINGS", *TIP, "--folds", "0", "--on-rank-deficiency", "fix"),
    "choose-poses": ("6", *TIP, "--candidates", "20", "--point=0.1,0,0"),
    "apply": ("CALIBRATION", "-o", "OUT.urdf"),
    "validate": ("--samples", "2"),
    "urdf": (),
    "compare": ("CRANE", *TIP, "--samples", "3"),
    "axes": (*TIP,),
    "dh": (*TIP,),
    "count": (*TIP,),
    "emit": (*TIP, "--lang", "c", "--output", "OUT", "--force"),
    "view": (*TIP, "--output", "OUT.html"),
}  # fmt: skip
NO_MODEL = {"conform", "list", "warm", "from-circles"}
posix = pytest.mark.skipif(not os.path.exists("/dev/fd/0"), reason="pipes as POSIX has them")


@pytest.fixture
def stdin(monkeypatch, tmp_path_factory):
    """Put a text or bytes on standard input."""
    path = tmp_path_factory.mktemp("stdin") / "content"
    with contextlib.ExitStack() as opened:

        def put(content):
            path.write_bytes(content.encode() if isinstance(content, str) else content)
            stream = opened.enter_context(open(path, encoding="utf-8"))
            monkeypatch.setattr(sys, "stdin", stream)

        yield put


@pytest.fixture
def words(crane, tmp_path, poekin):
    """The words of a command, with files in place of their names."""
    q = [[0.1 * i, 0.05 * i * i] for i in range(8)]
    header = "turn,slide,x,y,z\n"
    rows = "".join(f"{a},{b},{b * 0.9},{a * 0.1},{1 - b}\n" for a, b in q)
    (tmp_path / "readings.csv").write_text(header + rows)
    (tmp_path / "poses.csv").write_text("1,0,0,0.5,0,1,0,0,0,0,1,0.65\n")
    names = {
        "READINGS": tmp_path / "readings.csv",
        "POSES": tmp_path / "poses.csv",
        "CRANE": crane,
        "OUT": tmp_path / "out",
        "OUT.urdf": tmp_path / "out.urdf",
        "OUT.html": tmp_path / "out.html",
        "CALIBRATION": tmp_path / "c.toml",
    }

    def of(command):
        if "CALIBRATION" in WORDS[command]:
            chain = load(crane).chain(tip="hook")
            made = simulated(chain, 20, seed=1)
            calibrate(chain, made.q, made.measurements, folds=0, on_rank_deficiency="fix").save(
                names["CALIBRATION"]
            )
        return [str(names.get(word, word)) for word in WORDS[command]]

    return of


def test_every_command_that_takes_a_model_is_tried():
    named = {m.__name__.rpartition(".")[2].replace("_", "-") for m in commands.COMMANDS}
    assert named - NO_MODEL <= set(WORDS)
    for module in commands.COMMANDS:
        if module.__name__.rpartition(".")[2] in NO_MODEL:
            assert not {"file", "files", "a"} & set(inspect.signature(module.command).parameters)


@pytest.mark.parametrize("command", WORDS)
@pytest.mark.parametrize("name", ["-", "/dev/stdin"])
def test_a_model_on_standard_input_is_that_of_the_file(command, name, words, stdin, poekin, crane):
    expected = poekin(command, crane, *words(command))
    assert expected[0] in (0, 1)
    stdin(Path(crane).read_bytes())
    code, out, err = poekin(command, name, *words(command))
    assert (code, err) == (expected[0], expected[2])
    assert out == expected[1].replace(f"'{crane}'", "'standard input'")


def test_a_calibration_goes_into_the_text_that_was_piped(words, stdin, poekin, crane, tmp_path):
    own = Path(crane).read_text().replace("<link", "<!-- mine -->\n  <link", 1)
    Path(crane).write_text(own)
    assert poekin("apply", crane, *words("apply"))[0] == 0
    expected = (tmp_path / "out.urdf").read_text()
    assert "<!-- mine -->" in expected
    assert expected != own
    (tmp_path / "out.urdf").unlink()
    stdin(echo(own))
    assert poekin("apply", "-", *words("apply"))[0] == 0
    assert (tmp_path / "out.urdf").read_text() == expected


@posix
@pytest.mark.parametrize("command", ["info", "emit"])
def test_a_model_from_another_process_is_that_of_the_file(command, words, poekin, crane):
    expected = poekin(command, crane, *words(command))
    given = f"<(cat {shlex.quote(crane)})"
    line = f"{shlex.quote(sys.executable)} -m poekin.cli {command} {given} {shlex.join(words(command))}"
    done = _bash(line)
    assert (done.returncode, done.stdout) == expected[:2]


@posix
def test_two_models_from_two_processes_are_compared(crane):
    cat = f"<(cat {shlex.quote(crane)})"
    poekin = f"{shlex.quote(sys.executable)} -m poekin.cli compare --tip hook --samples 3"
    assert _bash(f"{poekin} {cat} {cat}").returncode == 0
    assert _bash(f"cat {shlex.quote(crane)} | {poekin} /dev/stdin {cat}").returncode == 0


def _bash(line: str) -> subprocess.CompletedProcess:
    return subprocess.run(["bash", "-c", line], capture_output=True, text=True, timeout=300)


@pytest.mark.parametrize("printed", PRINTED)
def test_what_ros_prints_is_a_model(printed, stdin, poekin, crane):
    expected = poekin("info", crane)
    stdin(PRINTED[printed](Path(crane).read_text()))
    assert poekin("info", "-") == expected
    stdin(gzip.compress(PRINTED[printed](Path(crane).read_text()).encode()))
    assert poekin("info", "-") == expected


TWICE = {
    "two models": ("compare", "-", "-", *TIP),
    "two names of it": ("compare", "-", "/dev/stdin", *TIP),
    "configurations": ("fk", "-", "--input", "-", *TIP),
    "configurations by another name": ("fk", "/dev/fd/0", "--input", "/dev/stdin", *TIP),
    "poses": ("ik", "-", "--input", "-", "--format", "12", *TIP),
    "a path": ("follow", "-", "--input", "-", "--format", "12", *TIP),
    "configurations of a Jacobian": ("jacobian", "-", "--input", "-", "--frame", "body", *TIP),
    "measurements": ("calibrate", "-", "/dev/stdin", *TIP),
}


@pytest.mark.parametrize("case", TWICE)
def test_standard_input_is_one_argument_only(case, stdin, refused, crane, tmp_path):
    command, *rest = TWICE[case]
    stdin(Path(crane).read_bytes())
    output = [] if command == "compare" else ["--output", tmp_path / "out.csv"]
    message = refused(command, *rest, *output)
    assert "only one argument of a command can be -" in message
    assert "standard input is read for the " in message
    assert not (tmp_path / "out.csv").exists()


@pytest.mark.parametrize("name", ["-", "/dev/stdin"])
def test_measurements_on_standard_input_are_those_of_the_file(
    name, words, stdin, poekin, refused, crane
):
    readings, *rest = words("calibrate")
    expected = poekin("calibrate", crane, readings, *rest)
    assert expected[0] == 1  # another crane's: the axes move farther than those of any arm are off
    content = Path(readings).read_text(encoding="utf-8")
    stdin(content)
    assert poekin("calibrate", crane, name, *rest) == expected
    stdin(content.replace("slide,", "glide,", 1))
    assert refused("calibrate", crane, name, *rest).startswith("poekin: error: standard input:1: ")


def test_validate_takes_standard_input_once(stdin, poekin, crane):
    stdin(Path(crane).read_bytes())
    code, _, err = poekin("validate", "-", "/dev/stdin", "--samples", 2)
    assert code == 2
    assert err == (
        "poekin: error: /dev/stdin: model: standard input is read for the model already:"
        " only one argument of a command can be -\n"
    )


def test_each_command_has_its_own_standard_input(stdin, poekin, crane):
    for _ in range(2):
        stdin(Path(crane).read_bytes())
        assert poekin("info", "-")[0] == 0


def test_the_head_of_a_source_says_the_checksum_of_what_was_piped(stdin, poekin, crane, tmp_path):
    content = gzip.compress(Path(crane).read_bytes())
    digest = hashlib.sha256(content).hexdigest()
    words = (*TIP, "--lang", "c", "--output", tmp_path / "out", "--force")

    def head():
        text = (tmp_path / "out" / "crane.h").read_text(encoding="ascii")
        return text.replace("\n * ", " ")

    stdin(content)
    assert poekin("emit", "-", *words)[0] == 0
    assert f"from the robot crane, standard input with the SHA-256 {digest}" in head()
    (tmp_path / "crane.urdf.gz").write_bytes(content)
    assert poekin("emit", tmp_path / "crane.urdf.gz", *words)[0] == 0
    assert f"file crane.urdf.gz with the SHA-256 {digest}" in head()
    with zipfile.ZipFile(tmp_path / "models.zip", "w") as archive:
        archive.write(crane, "a/crane.urdf")
    digest_of_archive = hashlib.sha256((tmp_path / "models.zip").read_bytes()).hexdigest()
    assert poekin("emit", tmp_path / "models.zip" / "a" / "crane.urdf", *words)[0] == 0
    assert f"file models.zip with the SHA-256 {digest_of_archive}" in head()
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe")
        writer = threading.Thread(target=(tmp_path / "pipe").write_bytes, args=(content,))
        writer.start()
        assert poekin("emit", tmp_path / "pipe", *words)[0] == 0
        writer.join()
        assert f"from the robot crane, a pipe with the SHA-256 {digest}" in head()
        assert str(tmp_path) not in head()


BAD = {
    "nothing": (b"", "standard input: the text is empty (did the command before the pipe fail?)"),
    "a cut message": (
        echo_cut("<robot name='r'>" + " " * 200).encode(),
        "standard input:1: the text was cut by `ros2 topic echo` after 128 characters: add --full-length",
    ),
    "another text": (b"hello\n", "standard input:1: expected a URDF, an MJCF, /robot_description"),
    "broken gzip": (gzip.compress(b"<robot/>")[:-4], "standard input: cannot be decompressed: "),
    "malformed": (b"<robot>\n<", "standard input:2: malformed XML"),
    "a broken message": (
        echo("<robot>\n<").encode(),
        "standard input (robot_description):2: malformed XML",
    ),
    "xacro": (
        b'<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:m/></robot>',
        "standard input:1: <xacro:m> is xacro that was not processed yet",
    ),
}


@pytest.mark.parametrize("case", BAD)
@pytest.mark.parametrize("command", ["info", "emit", "urdf"])
def test_what_is_no_model_on_standard_input_is_one_message(case, command, stdin, refused, tmp_path):
    content, message = BAD[case]
    out = tmp_path / "out"
    more = {"info": [], "emit": ["--lang", "c", "--output", out], "urdf": ["--output", out]}[
        command
    ]
    stdin(content)
    assert refused(command, "-", *more).startswith(f"poekin: error: {message}")
    assert not out.exists()


def test_xacro_in_a_pipe_is_refused_with_the_cure(stdin, refused, poekin, crane):
    stdin(BAD["xacro"][0])
    assert refused("info", "-", "--xacro") == (
        "poekin: error: --xacro: what is included is looked for from the file, and a pipe is none: give"
        " the file, or evaluate it before the pipe (xacro FILE | poekin ... -)\n"
    )
    stdin(gzip.compress(BAD["xacro"][0]))
    assert "--xacro, in a file that is not compressed" in refused("info", "-", "--xacro")
    stdin(Path(crane).read_bytes())  # evaluated already
    assert poekin("info", "-", "--xacro")[0] == 0


def test_a_terminal_is_not_waited_for(stdin, refused, monkeypatch):
    stdin("")
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
    assert refused("info", "-") == (
        "poekin: error: a model on standard input: expected a pipe or a file, got a terminal:"
        " as in xacro arm.urdf.xacro | poekin info -\n"
    )


def test_a_closed_standard_input_is_refused(refused, monkeypatch):
    monkeypatch.setattr(sys, "stdin", None)
    assert refused("info", "-") == "poekin: error: cannot read standard input: it is closed\n"


@posix
@pytest.mark.parametrize("name", ["-", "/dev/stdin"])
def test_the_file_that_standard_input_is_is_not_written_over(name, crane, refused, monkeypatch):
    before = Path(crane).read_bytes()
    with open(crane, encoding="utf-8") as given:
        monkeypatch.setattr(sys, "stdin", given)
        said = refused("urdf", name, "--output", crane)
    assert "it is the file of the model" in said
    assert Path(crane).read_bytes() == before


@posix
def test_a_reader_that_goes_away_ends_a_piped_model_quietly(crane):
    poekin = f"{shlex.quote(sys.executable)} -m poekin.cli"
    done = _bash(f"cat {shlex.quote(crane)} | {poekin} info - | head -1; echo ${{PIPESTATUS[1]}}")
    first, code = done.stdout.splitlines()
    assert first == "crane: 5 links, 4 joints, 2 coordinates"
    assert code in ("0", "141")
    assert done.stderr == ""
