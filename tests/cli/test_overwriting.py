"""No command writes over a file that it reads, by whatever name; the file stays as it was, and
nothing is printed.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

POSE = "1,0,0,0,0,1,0,0,0,0,1,0\n"
TIP = ("--tip", "hook")

COMMANDS = {
    "urdf": (("urdf", "MODEL", "--output", "OUT"), "model", "model.urdf"),
    "urdf, the URDF": (("urdf", "ROWS", "--into", "MODEL", "--output", "OUT"), "URDF", "model.urdf"),
    "dh": (("dh", "MODEL", *TIP, "--output", "OUT"), "model", "model.csv"),
    "emit": (("emit", "MODEL", *TIP, "--lang", "python", "--force", "--output", "OUT"), "model", "model.py"),
    "fk": (("fk", "MODEL", *TIP, "--input", "ROWS", "--output", "OUT"), "configurations", "rows.csv"),
    "fk, the model": (("fk", "MODEL", *TIP, "--input", "ROWS", "--output", "OUT"), "model", "model.csv"),
    "jacobian": (("jacobian", "MODEL", *TIP, "--frame", "body", "--input", "ROWS", "--output", "OUT"),
                 "configurations", "rows.npy"),
    "ik": (("ik", "MODEL", *TIP, "--format", "12", "--input", "ROWS", "--output", "OUT"), "poses", "rows.csv"),
    "follow": (("follow", "MODEL", *TIP, "--format", "12", "--input", "ROWS", "--output", "OUT"), "poses", "rows.csv"),
    "follow, drawn": (("follow", "MODEL", *TIP, "--format", "12", "--input", "ROWS", "--plot", "OUT"),
                      "model", "model.svg"),
    "follow, fastest": (("follow", "MODEL", *TIP, "--format", "12", "--input", "ROWS", "--fastest", "--acceleration",
                         "1", "--output", "OUT"), "poses", "rows.csv"),
    "calibrate": (("calibrate", "MODEL", "ROWS", *TIP, "--output", "OUT"), "measurements", "rows.csv"),
    "apply": (("apply", "MODEL", "ROWS", "--output", "OUT"), "model", "model.urdf"),
    "apply, the calibration": (("apply", "MODEL", "ROWS", "--output", "OUT"), "calibration", "rows.urdf"),
    "calibrate, the model": (("calibrate", "MODEL", "ROWS", *TIP, "--output", "OUT"), "model", "model.urdf"),
    "calibrate, the separations": (("calibrate", "MODEL", "other.csv", *TIP, "--point", "unknown", "--separations",
                                    "ROWS", "--output", "OUT"), "separations", "rows.csv"),
    "choose-poses": (("choose-poses", "MODEL", "8", *TIP, "--candidates", "ROWS", "--output", "OUT"),
                     "candidates", "rows.csv"),
    "choose-poses, the measurements": (("choose-poses", "MODEL", "8", *TIP, "--measured", "ROWS", "--output", "OUT"),
                                       "measurements", "rows.csv"),
    "from-circles": (("from-circles", "ROWS", "--output", "OUT"), "sweeps", "rows.urdf"),
    "view": (("view", "MODEL", *TIP, "--path", "ROWS", "--output", "OUT"), "path", "rows.html"),
    "sweep reach": (("sweep", "reach", "MODEL", *TIP, "--output", "OUT"), "model", "model.npz"),
}  # fmt: skip

LINKS = {
    "the same name": lambda file: file,
    "another name": lambda file: file.parent / "." / ".." / file.parent.name / file.name,
    "a symbolic link": lambda file: _linked(file, os.symlink),
    "a hard link": lambda file: _linked(file, os.link),
}


def _linked(file, link):
    link(file, file.with_name("link" + file.suffix))
    return file.with_name("link" + file.suffix)


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("link", LINKS)
def test_what_a_command_reads_stays_as_it_is(command, link, crane, tmp_path, refused):
    words, what, name = COMMANDS[command]
    given = {"MODEL": crane, "ROWS": str(tmp_path / "rows.csv")}
    (tmp_path / "rows.csv").write_text(POSE)
    file = tmp_path / name
    models = ("model", "URDF")
    file.write_text(Path(crane).read_text() if what in models else POSE)
    given["MODEL" if what in models else "ROWS"] = str(file)
    given["OUT"] = str(LINKS[link](file))
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    assert f"it is the file of the {what}" in refused(*(given.get(word, word) for word in words))
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_file_that_is_read_on_standard_input_is_not_written_over(crane, tmp_path):
    rows = tmp_path / "rows.csv"
    rows.write_text("0.1,0.2\n")
    words = [
        sys.executable,
        "-m",
        "poekin.cli",
        "fk",
        crane,
        *TIP,
        "--input",
        "-",
        "--output",
        rows,
    ]
    with rows.open() as stdin:
        done = subprocess.run(words, stdin=stdin, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert "it is the file of the configurations" in done.stderr
    assert rows.read_text() == "0.1,0.2\n"


@pytest.mark.parametrize("link", LINKS)
def test_two_results_do_not_go_into_one_file(link, crane, tmp_path, refused):
    (tmp_path / "rows.csv").write_text(POSE)
    (tmp_path / "out.svg").write_text("old")
    plot = str(LINKS[link](tmp_path / "out.svg"))
    os.symlink(tmp_path / "out.svg", tmp_path / "out.csv")
    words = ("follow", crane, *TIP, "--format", "12", "--input", tmp_path / "rows.csv")
    assert "it is named twice" in refused(*words, "--output", tmp_path / "out.csv", "--plot", plot)


def test_two_results_do_not_go_into_one_new_file(crane, tmp_path, refused):
    (tmp_path / "rows.csv").write_text(POSE)
    os.symlink(tmp_path / "new.svg", tmp_path / "out.csv")
    words = ("follow", crane, *TIP, "--format", "12", "--input", tmp_path / "rows.csv")
    assert "it is named twice" in refused(
        *words, "--output", tmp_path / "out.csv", "--plot", tmp_path / "new.svg"
    )


def test_a_name_of_the_catalogue_is_no_file(poekin, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert poekin("urdf", "panda", "--output", "panda")[0] == 0
    assert "it is the file of the model" in poekin("urdf", "panda", "--output", "panda")[2]
