"""The page "From ROS 2": each command on it is run, by programs that print what those of ROS print."""

from __future__ import annotations

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from poekin.formats import catalogue
from tests.formats import ros_text
from tests.formats.ros_text import PRINTED

PAGE = Path(__file__).resolve().parents[2] / "docs" / "howto" / "from_ros.md"
TEXT = PAGE.read_text(encoding="utf-8")
COMMANDS = re.findall(r"^- `(.*)`$", TEXT, re.MULTILINE)
DESCRIPTION = catalogue.text("ur5e").decode()
pytestmark = pytest.mark.skipif(os.name != "posix", reason="programs and pipes of a POSIX shell")

# What each program prints, by its words.
PROGRAMS = {
    "ros2 topic echo --once --full-length /robot_description": PRINTED["topic echo"],
    "ros2 topic echo --once --full-length --field data /robot_description": PRINTED[
        "topic echo --field data"
    ],
    "ros2 topic echo --once /robot_description": ros_text.echo_cut,
    "ros2 param get /robot_state_publisher robot_description": PRINTED["param get"],
    "ros2 param get --hide-type /robot_state_publisher robot_description": PRINTED[
        "param get --hide-type"
    ],
    "ros2 param dump /robot_state_publisher": PRINTED["param dump"],
    "rosparam get /robot_description": PRINTED["rosparam get"],
}
NAMESPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'


@pytest.fixture
def shell(tmp_path, poekin, monkeypatch):
    """Run a line in a directory with the page's files, and with its programs on the path; what is
    piped into poekin is read in this process.
    """
    programs = tmp_path / "programs"
    programs.mkdir()
    for name in ("ros2", "rosparam"):
        cases = []
        for k, (words, printed) in enumerate(PROGRAMS.items()):
            (programs / f"{k}.txt").write_bytes(printed(DESCRIPTION).encode())
            program, _, rest = words.partition(" ")
            if program == name:
                cases.append(f"'{rest}') cat '{programs}/{k}.txt';;")
        _program(programs / name, "\n".join(['case "$*" in', *cases, "*) exit 3;;", "esac"]))
    itself = f"exec '{sys.executable}' -m poekin.cli \"$@\""
    kept = 'printf "%s\\n" "$@" > words; exec cat > piped'
    # what is behind <( ) ends with the line, and has to be read in it
    _program(programs / "poekin", f'case "$*" in */dev/fd/*) {itself};; *) {kept};; esac')
    _program(programs / "xacro", f"exec '{sys.executable}' -c 'import xacro; xacro.main()' \"$@\"")
    (tmp_path / "factory.urdf").write_text(DESCRIPTION)
    arm = DESCRIPTION.replace("<robot ", f"<robot {NAMESPACE} ", 1)
    begin = arm.index(">", arm.index("<robot ")) + 1
    arm = f'{arm[:begin]}<xacro:arg name="length" default="1"/>{arm[begin:]}'
    (tmp_path / "arm.urdf.xacro").write_text(arm)
    environment = os.environ | {"PATH": f"{programs}{os.pathsep}{os.environ['PATH']}"}

    def run(line: str) -> subprocess.CompletedProcess:
        done = subprocess.run(
            ["bash", "-c", line],
            cwd=tmp_path,
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=300,
        )
        words = tmp_path / "words"
        if not words.exists():
            return done
        monkeypatch.chdir(tmp_path)
        with open(tmp_path / "piped", encoding="utf-8") as piped:
            monkeypatch.setattr(sys, "stdin", piped)
            code, out, err = poekin(*words.read_text().splitlines())
        return subprocess.CompletedProcess(
            line, done.returncode or code, done.stdout + out, done.stderr + err
        )

    return run


def _program(path: Path, body: str) -> None:
    path.write_text(f"#!/bin/sh\n{body}\n")
    path.chmod(0o755)


def test_the_page_has_every_way_that_there_is():
    assert len(COMMANDS) >= 10
    piped = {command.partition(" | ")[0] for command in COMMANDS}
    assert set(PROGRAMS) - piped == {"ros2 topic echo --once /robot_description"}


@pytest.fixture(scope="module")
def info_of_the_file(tmp_path_factory):
    """Text that `poekin info` prints of the file that the programs print."""
    path = tmp_path_factory.mktemp("file") / "factory.urdf"
    path.write_text(DESCRIPTION)
    line = [sys.executable, "-m", "poekin.cli", "info", path.name]
    return subprocess.run(
        line, cwd=path.parent, capture_output=True, text=True, check=True, timeout=300
    ).stdout


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_of_the_page_does_what_it_says(command, shell, tmp_path, info_of_the_file):
    if "xacro" in command and importlib.util.find_spec("xacrodoc") is None:
        pytest.skip("xacrodoc is not installed")
    done = shell(f"set -o pipefail; {command}")
    assert (done.returncode, done.stderr) == (0, "")
    if " info " in command:
        assert done.stdout == info_of_the_file
    elif " compare " in command:
        assert "The models are the same" in done.stdout
    else:
        assert {path.name for path in (tmp_path / "controller").iterdir()} >= {"ur5e.c", "ur5e.h"}


ROWS = [line.split("|")[1].strip() for line in TEXT.splitlines() if line.startswith("| ")][1:]
WRONG = {
    "the text was cut by `ros2 topic echo`": "ros2 topic echo --once /robot_description | poekin info -",
    "expected the text, got its length": "echo \"data: '<string length: <4711>>'\" | poekin info -",
    "the text is empty (did the command before the pipe fail?)": "ros2 gone | poekin info -",
    "a model may begin on line 3": (
        "(printf 'A note\\nof two lines\\n'; ros2 param get /robot_state_publisher robot_description)"
        " | poekin info -"
    ),
    "… is xacro that was not processed yet": f"echo '<robot {NAMESPACE}><xacro:m/></robot>' | poekin info -",
    "there is no package …": "poekin info package://my_arm/arm.urdf",
}


@pytest.mark.parametrize("message", WRONG)
def test_what_may_go_wrong_goes_wrong_with_the_message_of_the_page(message, shell):
    assert set(ROWS) - {"---"} == set(WRONG)
    done = shell(WRONG[message])
    assert (done.returncode, done.stdout) == (2, "")
    assert message.strip("… ") in done.stderr
    assert len(done.stderr.splitlines()) == 1
