"""The cache of kernels: whatever happens to it, results are right and no call raises."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import poekin
from poekin.engine.source import source_key

PACKAGE = Path(poekin.__file__).parent
PROGRAM = """
from poekin.groups import so3
print(so3.hat([1, 2, 3])[0].tolist(), so3.exp([0.0, 0.0, 0.0]).tolist())
"""
RIGHT = "[0.0, -3.0, 2.0] [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]"

ARM = """
from poekin.model.chain import Chain
chain = Chain([[0, 0, 1, 0, 0, 0], [0, 1, 0, 0, 0, -1]], [[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
print((chain.compile().fk([[0.0, 0.0]])[0, 0] + 0.0).tolist())
"""
TIP = "[1.0, 0.0, 0.0, 2.0]"


def run(home: Path, program: str = PROGRAM, path: Path = PACKAGE.parent, **environment: str):
    """A fresh process whose home and cache are below `home`; returns what it prints and what it logs."""
    variables = {k: v for k, v in os.environ.items() if k not in ("POEKIN_CACHE_DIR", "XDG_CACHE_HOME", "PYTHONPATH")}
    variables |= {"HOME": str(home), "PYTHONPATH": str(path)} | environment
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", program],
        capture_output=True,
        text=True,
        env=variables,
        cwd=home,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip(), done.stderr


def entries(home: Path) -> list[Path]:
    return sorted((home / ".cache" / "poekin").glob("*.kernel"))


@pytest.fixture(scope="module")
def filled(tmp_path_factory):
    """A home in which the program has run once."""
    home = tmp_path_factory.mktemp("home")
    out, log = run(home)
    assert out == RIGHT
    assert log.count("\n") == 1
    assert "compiling kernels" in log
    return home


@pytest.fixture
def home(filled, tmp_path):
    shutil.copytree(filled, tmp_path / "home")
    return tmp_path / "home"


def test_the_second_process_compiles_nothing(home):
    assert run(home) == (RIGHT, "")


def test_what_is_kept_belongs_to_the_user_alone(filled):
    assert (filled / ".cache" / "poekin").stat().st_mode & 0o777 == 0o700
    assert entries(filled)
    assert all(entry.stat().st_mode & 0o777 == 0o600 for entry in entries(filled))


DAMAGE = {
    "emptied": lambda data: b"",
    "cut in the digest": lambda data: data[:20],
    "cut in the middle": lambda data: data[: len(data) // 2],
    "one bit flipped": lambda data: data[:-100] + bytes([data[-100] ^ 1]) + data[-99:],
    "digest flipped": lambda data: bytes([data[0] ^ 1]) + data[1:],
    "another pickle": lambda data: b"cos\nsystem\n(S'touch owned'\ntR.",
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_entry_is_compiled_anew_with_one_log_line_and_mended(home, damage):
    for entry in entries(home):
        entry.write_bytes(DAMAGE[damage](entry.read_bytes()))
    out, log = run(home)
    assert out == RIGHT
    assert log.count("is damaged or not this user's alone") == 1
    assert not list(home.glob("owned"))
    assert run(home) == (RIGHT, "")


@pytest.fixture(scope="module")
def with_arm(tmp_path_factory):
    """A home in which an arm has been compiled once."""
    home = tmp_path_factory.mktemp("arm")
    assert run(home, ARM)[0] == TIP
    return home


def test_an_arm_s_machine_code_is_kept_and_a_damaged_one_made_anew(with_arm, tmp_path):
    home = tmp_path / "home"
    shutil.copytree(with_arm, home)
    assert run(home, ARM) == (TIP, "")
    (arm,) = (home / ".cache" / "poekin").glob("arm-*")
    for damage in DAMAGE.values():
        arm.write_bytes(damage(arm.read_bytes()))
        out, log = run(home, ARM)
        assert out == TIP
        assert log.count("is damaged or not this user's alone") == 1
    assert run(home, ARM) == (TIP, "")
    assert run(home, ARM, POEKIN_CACHE_DIR="/nonexistent/cache")[0] == TIP


def test_an_entry_that_others_can_write_is_not_read(home):
    for entry in entries(home):
        entry.chmod(0o666)
    out, log = run(home)
    assert out == RIGHT
    assert "not this user's alone" in log


def test_an_entry_that_is_a_link_is_not_followed(home, tmp_path):
    for entry in entries(home):
        shutil.move(entry, tmp_path / entry.name)
        entry.symlink_to(tmp_path / entry.name)
    out, log = run(home)
    assert out == RIGHT
    assert "cannot be read" in log


def test_a_directory_that_others_can_write_is_not_used(home):
    (home / ".cache" / "poekin").chmod(0o777)
    out, log = run(home)
    assert out == RIGHT
    assert "others may read or write it (expected mode 0700)" in log


PLACES = {
    "a file in place of the directory": lambda home: (home / "place").write_text(""),
    "a place below a file": lambda home: (home / "place").write_text(""),
    "no place at all": lambda home: None,
}


@pytest.mark.parametrize("place", PLACES)
def test_a_place_that_cannot_be_made_costs_a_compilation(tmp_path, place):
    PLACES[place](tmp_path)
    named = {"a place below a file": str(tmp_path / "place" / "below"), "no place at all": ""}
    out, log = run(tmp_path, POEKIN_CACHE_DIR=named.get(place, str(tmp_path / "place")))
    assert out == RIGHT
    assert "compiling kernels" in log
    assert "Traceback" not in log


def test_no_home_at_all_costs_a_compilation(tmp_path):
    out, log = run(tmp_path, HOME="/nonexistent")
    assert out == RIGHT
    assert "Traceback" not in log


@pytest.mark.parametrize(
    "file", ["algebra.py", "formulas/exponential.py", "formulas/coefficients.py", "engine/rows.py"]
)
def test_an_edit_anywhere_in_the_formulas_makes_a_new_key(tmp_path, file):
    copy = tmp_path / "poekin"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    before = source_key(copy)
    with (copy / file).open("a") as text:
        text.write("\n")
    assert source_key(copy) != before


def test_an_edit_in_algebra_changes_the_result_of_the_next_process(home, tmp_path):
    program = "from poekin.groups import se3; import numpy; print(se3.inverse(numpy.eye(4))[0, 3] + 0.0)"
    shutil.copytree(PACKAGE, tmp_path / "poekin", ignore=shutil.ignore_patterns("__pycache__"))
    assert run(home, program, tmp_path)[0] == "0.0"
    algebra = tmp_path / "poekin" / "algebra.py"
    algebra.write_text(algebra.read_text().replace("R[5], R[8], -p[0],", "R[5], R[8], 7.0 - p[0],"))
    assert run(home, program, tmp_path)[0] == "7.0"


def test_an_edit_made_while_a_session_is_open_does_not_pass_for_the_code_it_runs(home, tmp_path):
    shutil.copytree(PACKAGE, tmp_path / "poekin", ignore=shutil.ignore_patterns("__pycache__"))
    algebra = tmp_path / "poekin" / "algebra.py"
    edit = f"""
from pathlib import Path
from poekin.groups import se3
import numpy
algebra = Path({str(algebra)!r})
algebra.write_text(algebra.read_text().replace("R[5], R[8], -p[0],", "R[5], R[8], 7.0 - p[0],"))
print(se3.inverse(numpy.eye(4))[0, 3] + 0.0)
"""
    assert run(home, edit, tmp_path)[0] == "0.0"
    after = "from poekin.groups import se3; import numpy; print(se3.inverse(numpy.eye(4))[0, 3] + 0.0)"
    assert run(home, after, tmp_path)[0] == "7.0"


def test_what_is_compiled_with_other_options_is_kept_apart(home):
    _, log = run(home, NUMBA_OPT="0")
    assert "compiling kernels" in log


def test_entries_of_a_month_ago_are_forgotten(home):
    (old,) = entries(home)
    long_ago = old.with_name(f"{old.name.partition('-')[0]}-{'0' * 32}.kernel")
    old.rename(long_ago)
    os.utime(long_ago, (0, 0))
    run(home)
    assert long_ago not in entries(home)
    assert len(entries(home)) == 1


def test_a_link_to_a_private_directory_is_followed(home, tmp_path):
    place = home / ".cache" / "poekin"
    shutil.move(place, tmp_path / "kept")
    place.symlink_to(tmp_path / "kept")
    assert run(home) == (RIGHT, "")


def test_threads_may_call_a_kernel_for_the_first_time_together(tmp_path):
    program = """
import sys, threading
import numpy as np
import poekin as pk
sys.setswitchinterval(1e-6)
arm, got = pk.load("panda").chain(tip="panda_hand"), []
q = np.zeros(7)
calls = [lambda: arm.fk(q), lambda: arm.joint_poses(q), lambda: arm.velocity(q, q, "body")]
threads = [threading.Thread(target=lambda call=call: got.append(call())) for call in calls * 2]
[t.start() for t in threads]
[t.join() for t in threads]
print(len(got))
"""
    assert run(tmp_path, program)[0] == "6"


def test_without_compilation_everything_still_runs(tmp_path):
    assert run(tmp_path, NUMBA_DISABLE_JIT="1") == (RIGHT, "")


def test_without_compiling_an_arm_s_program_is_interpreted(tmp_path):
    program = ARM + "print([chain.compile().jacobian([0.3, 0.4], f)[0].round(3).tolist() for f in ('body', 'middle')])"
    expected, _ = run(tmp_path, program)
    assert run(tmp_path, program, NUMBA_DISABLE_JIT="1") == (expected, "")
