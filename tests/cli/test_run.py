"""How the command ends: codes, messages, interrupts, pipes, and what is missing."""

from __future__ import annotations

import builtins
import os
import shlex
import signal
import subprocess
import sys
import time

import pytest

import poekin as pk


def test_the_version(poekin):
    assert poekin("--version") == (0, f"poekin {pk.__version__}\n", "")


@pytest.mark.parametrize(
    "words",
    [
        ["--help"],
        ["fk", "--help"],
        ["jacobian", "--help"],
        ["info", "--help"],
        ["validate", "--help"],
    ],
)
def test_help_is_no_error(poekin, words):
    code, out, err = poekin(*words)
    assert (code, err) == (0, "")
    assert "Usage: poekin" in out


def test_no_command_is_help(poekin):
    assert poekin() == poekin("--help")


def test_an_unknown_command_is_one_message(refused):
    assert "fks" in refused("fks")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["jacobian", "ur5e"], "Missing option '--frame': space | body | hybrid "),
        (["emit", "ur5e"], "Missing option '--lang': c (C99, math.h only) | python "),
        (["fk"], "Missing argument 'FILE': A URDF, MJCF, "),
    ],
    ids=["frame", "language", "file"],
)
def test_a_required_choice_that_is_left_out_lists_the_choices(refused, words, message):
    said = refused(*words).replace(" (env var: 'None')", "")  # which older versions of Typer add
    assert message in said


@pytest.mark.parametrize("command", ["info", "fk", "jacobian", "validate"])
@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "empty"),
        (b"<robot>\n<", ":2"),
        (b"\x00\xff\xfe", "bad.urdf"),
        (b"<robot name='r'/>", "<link>"),
        (b'<!DOCTYPE r [<!ENTITY e "x">]><robot name="r"><link name="&e;"/></robot>', "bad.urdf"),
    ],
)
def test_a_file_that_is_no_robot_is_one_message(poekin, tmp_path, command, content, message):
    path = tmp_path / "bad.urdf"
    path.write_bytes(content)
    more = ["--frame", "body"] if command == "jacobian" else []
    code, _, err = poekin(command, path, *more)
    assert code == 2
    assert err.startswith("poekin: error: ")
    assert message in err
    assert len(err.splitlines()) == 1


@pytest.mark.parametrize("package", ["typer", "rich"])
def test_a_missing_package_of_the_command_line_is_named(package, monkeypatch, refused):
    real = builtins.__import__

    def without(name, *rest):
        if name == package:
            raise ModuleNotFoundError(f"No module named '{package}'", name=package)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    said = f"the command line needs the package {package}: pip install 'poekin[cli]'"
    assert refused("info", "panda") == f"poekin: error: {said}\n"


def test_memory_that_runs_out_is_one_message(monkeypatch, refused, crane):
    from poekin.cli.kinematics import arm

    def out_of_memory(*_):
        raise MemoryError

    monkeypatch.setattr(arm, "model_and_chain", out_of_memory)
    assert "not enough memory" in refused("fk", crane, "0", "0", "--tip", "hook")


def test_an_interrupt_ends_with_130_and_no_traceback(monkeypatch, poekin, crane):
    from poekin.cli.models import info

    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(info, "model", interrupt)
    assert poekin("info", crane) == (130, "", "")


def test_a_fault_of_poekin_s_own_ends_with_python_s_traceback(monkeypatch, poekin, capsys, crane):
    from poekin.cli.models import info

    def fault(*_):
        raise RuntimeError("a fault")

    monkeypatch.setattr(info, "model", fault)
    monkeypatch.setattr(sys, "excepthook", sys.excepthook)  # typer puts its own in that place
    with pytest.raises(RuntimeError) as caught:
        poekin("info", crane)
    sys.excepthook(caught.type, caught.value, caught.tb)
    lines = capsys.readouterr().err.splitlines()
    assert (lines[0], lines[-1]) == ("Traceback (most recent call last):", "RuntimeError: a fault")


def _command(*words):
    return [sys.executable, "-m", "poekin.cli", *words]


def test_a_reader_that_goes_away_is_no_error(tmp_path, crane):
    (tmp_path / "q.csv").write_text("0.1,0.2\n" * 20_000)
    words = _command("fk", crane, "--tip", "hook", "--input", str(tmp_path / "q.csv"))
    # Unbuffered, Python 3.11 takes what a pipe did not accept for written, and there is nothing to
    # notice.
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONUNBUFFERED"}
    with subprocess.Popen(
        words, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.read(100)
        process.stdout.close()
        err = process.stderr.read()
    assert process.returncode == 141
    assert b"Traceback" not in err
    assert b"BrokenPipe" not in err


def test_a_closed_stdout_is_no_error(crane):
    words = f"exec {shlex.join(_command('info', crane))} >&-"
    done = subprocess.run(["sh", "-c", words], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_closed_stderr_changes_neither_result_nor_code(crane):
    for words, code in ((["info", crane], 0), (["fk", crane, "--tip", "no"], 2)):
        line = f"exec {shlex.join(_command(*words))} 2>&-"
        done = subprocess.run(["sh", "-c", line], capture_output=True, text=True)
        assert done.returncode == code
        assert bool(done.stdout) == (code == 0)
    line = f"exec {shlex.join(_command('info', 'nowhere.urdf'))} <&- >&- 2>&-"
    assert subprocess.run(["sh", "-c", line]).returncode == 2


def test_configurations_come_from_standard_input(crane, poekin, refused, tmp_path, monkeypatch):
    words = _command("fk", crane, "--tip", "hook", "--input", "-")
    done = subprocess.run(words, input="slide,turn\n0.2,0.1\n", capture_output=True, text=True)
    # a new machine, or one that keeps nothing, compiles kernels and says so
    said = [line for line in done.stderr.splitlines() if "kernels" not in line]
    assert (done.returncode, said, len(done.stdout.splitlines())) == (0, [], 2)
    (tmp_path / "q.csv").write_text("0.2,0.1\n0.2,x\n")
    with open(tmp_path / "q.csv") as given:
        monkeypatch.setattr(sys, "stdin", given)
        said = refused("fk", crane, "--tip", "hook", "--input", "-")
    assert said == "poekin: error: standard input:2, column 2: a number expected, got 'x'\n"
    done = subprocess.run(
        ["sh", "-c", f"exec {shlex.join(words)} <&-"], capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (
        2,
        "poekin: error: cannot read standard input: it is closed\n",
    )
    monkeypatch.setattr(sys, "stdin", None)  # closed, and a file needs none
    monkeypatch.chdir(tmp_path)
    for name in ("q.csv", "+.csv"):
        (tmp_path / name).write_text("0.2,0.1\n")
        assert poekin("fk", crane, "--tip", "hook", "--input", name)[0] == 0


def test_an_encoding_that_lacks_a_character_is_no_error(crane):
    environment = os.environ | {"PYTHONIOENCODING": "ascii"}
    done = subprocess.run(_command("info", crane), env=environment, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert "turn (continuous) \\u2192 a" in done.stdout


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="a disk that is full, as Linux has it")
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_a_full_disk_is_one_message(crane, unbuffered):
    environment = os.environ | {"PYTHONUNBUFFERED": unbuffered}
    words = _command("info", crane)
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            words, stdout=full, stderr=subprocess.PIPE, text=True, env=environment
        )
    assert done.returncode == 2
    assert done.stderr == "poekin: error: [Errno 28] No space left on device\n"


def _heed_interrupts() -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.skipif(os.name != "posix", reason="pipes with a name, and signals, as POSIX has them")
def test_ctrl_c_in_a_process_of_its_own(tmp_path, crane):
    os.mkfifo(tmp_path / "q.csv")
    words = _command("fk", crane, "--tip", "hook", "--input", str(tmp_path / "q.csv"))
    # The pipe opens here when the command opens it there, which then waits for a line.
    with (
        # a test run in the background hands on that SIGINT is ignored
        subprocess.Popen(
            words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=_heed_interrupts
        ) as process,
        open(tmp_path / "q.csv", "w"),
    ):
        # Python itself may lose a signal while it opens a file: by now it waits for the line.
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    assert (process.returncode, out, err) == (130, b"", b"")
