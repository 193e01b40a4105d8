"""The cache of kernels: whatever happens to it, results are right and no call raises.

What one process leaves and the next one finds, and what is fixed when a process begins, is asked of
fresh processes; all else of a `session`: a kernel of this process's own, made as if nothing had
been loaded or said before.
"""

import os
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from numba.core import config

import poekin
from poekin.engine.jit import cache, source_hash
from poekin.engine.jit.kernel import Kernel
from poekin.engine.jit.source_hash import KERNELS, PROGRAMS, source_key
from poekin.engine.kernels import group_kernels
from poekin.model.chain import Chain

PACKAGE = Path(poekin.__file__).parent
SCREWS, HOME = (
    [[0, 0, 1, 0, 0, 0], [0, 1, 0, 0, 0, -1]],
    [[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
)
PROGRAM = f"""
from poekin.groups import so3
from poekin.model.chain import Chain
print(so3.hat([1, 2, 3])[0].tolist(), so3.exp([0.0, 0.0, 0.0]).tolist())
chain = Chain.from_space({SCREWS}, {HOME})
print((chain.compile().fk([[0.0, 0.0]])[0, 0] + 0.0).tolist())
"""
RIGHT = "[0.0, -3.0, 2.0] [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]\n[1.0, 0.0, 0.0, 2.0]"

COMPILING = "compiling kernels for this machine"
DAMAGED = "is damaged, or others may write it"


def run(home: Path, program: str = PROGRAM, path: Path = PACKAGE.parent, **environment: str):
    """A fresh process whose home and cache are below `home`; returns what it prints and what it
    logs.
    """
    variables = {
        k: v
        for k, v in os.environ.items()
        if k not in ("POEKIN_CACHE_DIR", "XDG_CACHE_HOME", "PYTHONPATH")
    }
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


def entries(home: Path, name: str = "*") -> list[Path]:
    return sorted((home / ".cache" / "poekin").glob(f"{name}-*.kernel"))


@pytest.fixture(scope="module")
def filled(tmp_path_factory):
    """A home in which the program has run once."""
    home = tmp_path_factory.mktemp("home")
    out, log = run(home)
    assert out == RIGHT
    assert log.count("\n") == 1
    assert COMPILING in log
    return home


@pytest.fixture
def home(filled, tmp_path):
    shutil.copytree(filled, tmp_path / "home")
    return tmp_path / "home"


class Session:
    """Calls as the first ones of a process: each returns what was logged, and sees that the result
    is right.
    """

    def __init__(self, monkeypatch, caplog):
        self.monkeypatch, self.caplog = monkeypatch, caplog

    def kernel(self, begin: bool = True) -> list[str]:
        """exp on SO(3), by a kernel that has to be loaded or compiled; begin: as the first call."""
        if begin:
            self._begin()
        known, R = group_kernels.so3_exp, np.full((1, 3, 3), np.nan)
        new = Kernel(
            known.function, known.arguments, known.returns, known.quick, known.bare, known.portable
        )
        new.call(np.zeros((1, 3)), R)
        np.testing.assert_array_equal(R, np.eye(3)[None])
        return self.caplog.messages

    def arm(self) -> list[str]:
        """The pose of an arm whose machine code has to be loaded or made."""
        self._begin()
        T = Chain.from_space(SCREWS, HOME).compile().fk([[0.0, 0.0]])
        np.testing.assert_array_equal(T[0], HOME)
        return self.caplog.messages

    def _begin(self) -> None:
        self.caplog.clear()
        self.monkeypatch.setattr(cache, "_logged", set())


@pytest.fixture
def session(home, tmp_path, monkeypatch, caplog):
    """Sessions of this process in that home."""
    for name in ("POEKIN_CACHE_DIR", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.chdir(tmp_path)
    made = Session(monkeypatch, caplog)
    assert (
        made.arm() == []
    )  # the kernel that runs arms is loaded: what is logged from here on is of the arm
    return made


def test_the_second_process_compiles_nothing(filled):
    kept = {entry: entry.read_bytes() for entry in entries(filled)}
    assert run(filled) == (RIGHT, "")
    assert {entry: entry.read_bytes() for entry in entries(filled)} == kept


def test_a_session_compiles_nothing_either(session):
    assert session.kernel() == session.arm() == []


def test_what_is_kept_nobody_else_may_write(filled):
    assert (filled / ".cache" / "poekin").stat().st_mode & 0o777 == 0o700
    for name in ("so3_exp", "arm"):
        assert entries(filled, name)
    assert all(entry.stat().st_mode & 0o777 == 0o644 for entry in entries(filled))


DAMAGE = {
    "emptied": lambda data: b"",
    "cut in the digest": lambda data: data[:20],
    "cut in the middle": lambda data: data[: len(data) // 2],
    "one bit flipped": lambda data: data[:-100] + bytes([data[-100] ^ 1]) + data[-99:],
    "digest flipped": lambda data: bytes([data[0] ^ 1]) + data[1:],
    "another pickle": lambda data: b"cos\nsystem\n(S'touch owned'\ntR.",
}


def test_several_damaged_entries_are_made_anew_in_one_process_with_one_log_line(
    session, home, tmp_path
):
    for name, damage in (("so3_exp", "another pickle"), ("arm", "one bit flipped")):
        (entry,) = entries(home, name)
        entry.write_bytes(DAMAGE[damage](entry.read_bytes()))
    (damaged,) = session.arm()
    assert DAMAGED in damaged
    *_, compiling = session.kernel(begin=False)
    assert [message for message in session.caplog.messages if DAMAGED in message] == [damaged]
    assert COMPILING in compiling
    assert not list(tmp_path.rglob("owned"))
    assert session.kernel() == session.arm() == []


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_entry_is_compiled_anew_with_one_log_line_and_mended(
    session, home, tmp_path, damage
):
    (entry,) = entries(home, "so3_exp")
    entry.write_bytes(DAMAGE[damage](entry.read_bytes()))
    damaged, compiling = session.kernel()
    assert DAMAGED in damaged
    assert COMPILING in compiling
    assert not list(tmp_path.rglob("owned"))
    assert session.kernel() == []


@pytest.mark.parametrize("damage", DAMAGE)
def test_an_arm_s_machine_code_that_is_damaged_is_made_anew_with_one_log_line_and_mended(
    session, home, damage
):
    (entry,) = entries(home, "arm")
    whole = entry.read_bytes()
    entry.write_bytes(DAMAGE[damage](whole))
    (damaged,) = session.arm()
    assert DAMAGED in damaged
    assert entry.read_bytes() == whole
    assert session.arm() == []


def test_an_entry_that_others_can_write_is_not_read(session, home):
    for entry in entries(home):
        entry.chmod(0o666)
    for log in (session.kernel(), session.arm()):
        assert DAMAGED in log[0]


def test_an_entry_that_is_a_link_is_not_followed(session, home, tmp_path):
    for entry in entries(home):
        shutil.move(entry, tmp_path / entry.name)
        entry.symlink_to(tmp_path / entry.name)
    for log in (session.kernel(), session.arm()):
        assert "cannot be read" in log[0]


def test_a_directory_that_others_can_write_is_not_used(session, home):
    for mode in (0o777, 0o720, 0o702):
        (home / ".cache" / "poekin").chmod(mode)
        for log in (session.kernel(), session.arm()):
            assert "others may write it (expected mode 0755 or 0700)" in log[0]


def test_a_directory_that_others_may_read_is_used(session, home):
    (home / ".cache" / "poekin").chmod(0o755)
    for entry in entries(home):
        entry.chmod(0o644)
    assert session.kernel() == session.arm() == []


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="users have no numbers there")
@pytest.mark.parametrize(
    ("owner", "me", "mode", "trusted"),
    [
        (1000, 1000, 0o700, True),
        (1000, 1000, 0o755, True),
        (0, 1000, 0o755, True),
        (0, 0, 0o700, True),
        (1001, 1000, 0o755, False),
        (1000, 0, 0o755, False),
        (1000, 1000, 0o775, False),
        (0, 1000, 0o757, False),
    ],
)
def test_what_nobody_but_the_user_or_root_may_write_is_trusted(
    monkeypatch, owner, me, mode, trusted
):
    monkeypatch.setattr(os, "geteuid", lambda: me)
    assert cache._trusted(os.stat_result((mode, 0, 0, 0, owner, 0, 0, 0, 0, 0))) == trusted


def test_a_named_directory_is_made_for_all_to_read(tmp_path, monkeypatch):
    monkeypatch.setenv("POEKIN_CACHE_DIR", str(tmp_path / "made" / "kernels"))
    before = os.umask(0o022)
    try:
        assert cache.usable_directory() == tmp_path / "made" / "kernels"
    finally:
        os.umask(before)
    assert (tmp_path / "made" / "kernels").stat().st_mode & 0o777 == 0o755


PLACES = {
    "a file in place of the directory": lambda place: str(place),
    "a place below a file": lambda place: str(place / "below"),
    "no place at all": lambda place: "",
}


@pytest.mark.parametrize("place", PLACES)
def test_a_place_that_cannot_be_made_costs_a_compilation(session, tmp_path, monkeypatch, place):
    (tmp_path / "place").write_text("")
    monkeypatch.setenv("POEKIN_CACHE_DIR", PLACES[place](tmp_path / "place"))
    nowhere = [] if place == "no place at all" else ["in each run: no cache in"]
    for log, said in ((session.kernel(), [*nowhere, COMPILING]), (session.arm(), nowhere)):
        assert [part for part, message in zip(said, log, strict=True) if part not in message] == []


NO_PLACES = {
    "the home of nobody": lambda folder: "~nobody of that name/kernels",
    "a place in a working directory that is gone": lambda folder: folder.rmdir() or "kernels",
    "a pipe": lambda folder: os.mkfifo(folder / "pipe") or str(folder / "pipe"),
}


@pytest.mark.skipif(
    not hasattr(os, "mkfifo"), reason="there are no pipes with a name, and a directory in use stays"
)
@pytest.mark.parametrize("place", NO_PLACES)
def test_what_names_no_place_is_one_log_line(tmp_path, monkeypatch, caplog, place):
    folder = tmp_path / "folder"
    folder.mkdir()
    monkeypatch.chdir(folder)
    monkeypatch.setattr(cache, "_logged", set())
    monkeypatch.setenv("POEKIN_CACHE_DIR", NO_PLACES[place](folder))
    assert cache.entry("arm", 0) is None
    assert cache.entry("arm", 1) is None
    (said,) = caplog.messages
    assert "kernels are compiled anew in each run: no cache in" in said


@pytest.fixture
def place(tmp_path, monkeypatch, caplog):
    """A cache that is empty."""
    monkeypatch.setenv("POEKIN_CACHE_DIR", str(tmp_path / "kernels"))
    monkeypatch.setattr(cache, "_logged", set())
    return tmp_path / "kernels"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes with a name")
def test_an_entry_that_is_a_pipe_is_not_waited_for_and_is_replaced(place, caplog):
    entry = cache.entry("arm", 0)
    assert entry is not None
    os.mkfifo(entry, 0o600)
    reader = threading.Thread(target=cache.read, args=[entry], daemon=True)
    reader.start()
    reader.join(20)
    waits = reader.is_alive()
    if waits:
        os.close(os.open(entry, os.O_WRONLY | os.O_NONBLOCK))  # it ends
    assert not waits
    assert DAMAGED in caplog.text
    cache.write(entry, b"code")
    assert cache.read(entry) == b"code"


def test_an_entry_of_two_mib_is_read(place):
    entry = cache.entry("arm", 0)
    assert entry is not None
    cache.write(entry, bytes(2 * cache.MIB))
    assert cache.read(entry) == bytes(2 * cache.MIB)


def test_an_entry_larger_than_any_is_not_read(place, monkeypatch, caplog):
    entry = cache.entry("arm", 0)
    assert entry is not None
    cache.write(entry, bytes(68))
    monkeypatch.setattr(cache, "MAX_ENTRY", 100)
    assert cache.read(entry) == bytes(68)
    cache.write(entry, bytes(69))
    assert cache.read(entry) is None
    assert DAMAGED in caplog.text


@pytest.mark.skipif(os.name == "nt", reason="there are no modes")
@pytest.mark.parametrize("mode", [0o620, 0o602, 0o664, 0o646])
def test_an_entry_that_anybody_else_may_write_is_not_read(place, caplog, mode):
    entry = cache.entry("arm", 0)
    assert entry is not None
    cache.write(entry, b"code")
    assert cache.read(entry) == b"code"
    entry.chmod(mode)
    assert cache.read(entry) is None
    assert DAMAGED in caplog.text


def test_the_bound_counts_the_bytes_of_the_file_written(place, monkeypatch):
    told = []
    monkeypatch.setattr(cache.cache_size, "bound", lambda *of: told.append(of))
    entry = cache.entry("arm", 0)
    assert entry is not None
    cache.write(entry, b"code")
    assert told == [(place, entry.stat().st_size, cache.size_limit())]


def test_an_entry_is_kept_by_name_key_source_versions_and_options(place, monkeypatch):
    entries = [cache.entry("arm", 0), cache.entry("exp", 0), cache.entry("arm", 1)]
    assert [entry.name.partition("-")[0] for entry in entries if entry] == ["arm", "exp", "arm"]
    monkeypatch.setattr(cache.source_hash, "LOADED", "edited")
    entries.append(cache.entry("arm", 0))
    versions = [(module, "__version__", "another") for module in (np, cache.numba, cache.llvmlite)]
    python = [
        (sys, "version", "another"),
        (cache.platform, "machine", lambda: "another"),
        (sys, "platform", "linux2"),
    ]
    options = [
        (config, name, "another")
        for name in ("OPT", "LOOP_VECTORIZE", "SLP_VECTORIZE", "BOUNDSCHECK")
    ]
    for module, what, value in [*versions, *python, *options]:
        monkeypatch.setattr(module, what, value)
        entries.append(cache.entry("arm", 0))
    assert len({str(entry) for entry in entries}) == len(entries)


def kept(place: Path) -> list[str]:
    """The names of all entries, the sizes of which are together within the bound."""
    files = list(place.iterdir())
    assert sum(file.stat().st_size for file in files) <= cache.size_limit()
    return sorted(file.name.partition(".")[0] for file in files)


def filled_up(place: Path, names: str, of: str = "exp") -> None:
    """Entries of 90 kB, one second older than the other."""
    place.mkdir(mode=0o700, exist_ok=True)
    for age, name in zip(range(len(names), 0, -1), names, strict=True):
        entry = place / f"{of}-{name}.kernel"
        cache.write(entry, bytes(90_000))
        if entry.exists():
            os.utime(entry, (time.time() - age, time.time() - age))


def test_what_was_not_used_for_the_longest_time_is_removed_where_the_cache_is_too_large(
    place, monkeypatch
):
    monkeypatch.setenv("POEKIN_CACHE_SIZE", "1")
    filled_up(place, "abcdefghij")
    assert kept(place) == [f"exp-{name}" for name in "abcdefghij"]
    assert cache.read(place / "exp-b.kernel") is not None  # it is in use
    cache.write(place / "exp-k.kernel", bytes(90_000))
    cache.write(place / "exp-l.kernel", bytes(90_000))
    assert kept(place) == [f"exp-{name}" for name in "bdefghijkl"]


def test_the_code_of_many_arms_does_not_remove_what_all_arms_need(place, monkeypatch):
    monkeypatch.setenv("POEKIN_CACHE_SIZE", "1")
    filled_up(place, "abcde")
    filled_up(place, "fghijklmnopqrst", of="arm")
    assert kept(place) == [
        *(f"arm-{name}" for name in "pqrst"),
        *(f"exp-{name}" for name in "abcde"),
    ]


def test_what_a_process_left_half_written_is_removed_in_its_turn(place, monkeypatch):
    filled_up(place, "a")
    left = place / "exp-b.kernelx1y2z3"
    left.write_bytes(bytes(10))
    os.utime(left, (0, 0))
    monkeypatch.setenv("POEKIN_CACHE_SIZE", "0.2")
    filled_up(place, "c")
    assert kept(place) == ["exp-a", "exp-c"]


@pytest.mark.parametrize(
    ("said", "size"), [("", 100), ("0", 0), ("2.5", 2.5), (" 7 ", 7), ("inf", np.inf)]
)
def test_the_size_of_the_cache_is_the_user_s_in_mib(monkeypatch, caplog, said, size):
    monkeypatch.setenv("POEKIN_CACHE_SIZE", said)
    assert cache.size_limit() == size * 2**20
    assert not caplog.messages


@pytest.mark.parametrize("said", ["-1", "nan", "much", "1 GiB"])
def test_a_size_that_is_none_is_one_log_line_and_the_usual_size(monkeypatch, caplog, said):
    monkeypatch.setattr(cache, "_logged", set())
    monkeypatch.setenv("POEKIN_CACHE_SIZE", said)
    assert cache.size_limit() == cache.size_limit() == 100 * 2**20
    (message,) = caplog.messages
    assert f"POEKIN_CACHE_SIZE={said} is no number of MiB from 0 on: 100 are taken" in message


def test_a_size_of_0_keeps_nothing(place, monkeypatch):
    monkeypatch.setenv("POEKIN_CACHE_SIZE", "0")
    filled_up(place, "ab")
    assert kept(place) == []


def test_a_home_that_cannot_be_made_costs_a_compilation(session, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("HOME", str(tmp_path / "file" / "home"))
    nowhere, compiling = session.kernel()
    assert "in each run: no cache in" in nowhere
    assert COMPILING in compiling
    assert len(session.arm()) == 1


USUAL_PLACES = {
    "linux": ("XDG_CACHE_HOME", ".cache"),
    "win32": ("LOCALAPPDATA", "AppData/Local"),
    "darwin": (None, "Library/Caches"),
}


@pytest.mark.parametrize("system", USUAL_PLACES)
def test_kernels_are_kept_in_the_cache_directory_of_the_system(monkeypatch, tmp_path, system):
    variable, below = USUAL_PLACES[system]
    monkeypatch.delenv("POEKIN_CACHE_DIR", raising=False)
    variables = [name for name, _ in USUAL_PLACES.values() if name]
    for name in variables:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(cache.sys, "platform", system)
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    assert cache.directory() == tmp_path / below / "poekin"
    for name in variables:
        monkeypatch.setenv(name, str(tmp_path / name))
    assert cache.directory() == tmp_path / (variable or below) / "poekin"


def test_a_cache_directory_that_is_not_absolute_is_none(monkeypatch):
    monkeypatch.delenv("POEKIN_CACHE_DIR", raising=False)
    monkeypatch.setattr(cache.sys, "platform", "linux")
    monkeypatch.setenv("XDG_CACHE_HOME", "kernels")
    assert cache.directory() is None


def test_no_home_at_all_costs_a_compilation(session, monkeypatch):
    def unknown(_):
        raise KeyError("uid not found")

    pwd = pytest.importorskip("pwd", reason="without it nobody's home is looked up there")
    monkeypatch.delenv("HOME")
    monkeypatch.setattr(pwd, "getpwuid", unknown)
    (compiling,) = session.kernel()
    assert f"{COMPILING}, a few seconds each (not kept)" in compiling
    assert session.arm() == []


@pytest.mark.parametrize(
    ("file", "rooms"),
    [
        ("algebra.py", KERNELS),
        ("formulas/lie/exponential.py", KERNELS),
        ("engine/kernels/group_kernels.py", KERNELS),
        ("model/kinematics/programs.py", PROGRAMS),
        ("sweep/measures/error_program.py", PROGRAMS),
        ("sweep/masks/self_collision.py", PROGRAMS),
    ],
)
def test_an_edit_of_what_is_compiled_makes_a_new_key(tmp_path, file, rooms):
    copy = tmp_path / "poekin"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    keys = [source_key(copy, which) for which in (KERNELS, PROGRAMS)]
    assert keys == [source_hash.LOADED, source_hash.LOADED_PROGRAMS]
    with (copy / file).open("rb+") as text:  # it is there
        text.seek(0, 2)
        text.write(b"\n")
    for which, key in zip((KERNELS, PROGRAMS), keys, strict=True):
        assert (source_key(copy, which) != key) is (which is rooms)


def test_another_name_of_a_file_makes_a_new_key(tmp_path):
    (tmp_path / "engine").mkdir()
    file = tmp_path / "engine" / "a.py"
    file.write_text("A = 1\n")
    before = source_key(tmp_path, ("engine",))
    file.rename(file.with_name("b.py"))
    assert before != source_key(tmp_path, ("engine",)) is not None


def test_an_edit_even_while_a_session_is_open_changes_the_result_of_the_next_process_alone(
    home, tmp_path
):
    # an edited file has another length, so its bytecode is not taken for the original's
    shutil.copytree(PACKAGE, tmp_path / "poekin", ignore=shutil.ignore_patterns("*.pyc.*"))
    algebra = tmp_path / "poekin" / "algebra.py"
    edit = f"""
from pathlib import Path
from poekin.groups import so3
algebra = Path({str(algebra)!r})
text = algebra.read_text()
algebra.write_text(text.replace("return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]", "return 0.0 * a[0]"))
assert algebra.read_text() != text
"""
    call = """
from poekin.groups import so3
print(so3.exp([0.0, 0.0, 1.0])[0, 0])
"""
    assert run(home, edit + call, tmp_path) == ("0.5403023058681398", "")
    edited, log = run(home, call, tmp_path)
    assert edited == "0.5"
    assert COMPILING in log


def test_what_is_compiled_with_other_options_is_kept_apart(session, home, monkeypatch):
    monkeypatch.setenv("NUMBA_OPT", "0")
    config.reload_config()
    try:
        (compiling,) = session.kernel()
        assert session.kernel() == []
    finally:
        monkeypatch.delenv("NUMBA_OPT")
        config.reload_config()
    assert COMPILING in compiling
    assert len(entries(home, "so3_exp")) == 2
    assert session.kernel() == []


def test_arms_of_a_month_ago_are_forgotten(session, home):
    (old,) = entries(home, "arm")
    long_ago = old.with_name(f"arm-{'0' * 32}.kernel")
    young = old.with_name(f"arm-{'1' * 32}.kernel")
    shutil.copy2(old, young)
    old.rename(long_ago)
    os.utime(long_ago, (0, 0))
    others = set(entries(home)) - {long_ago, young}
    session.arm()
    assert entries(home, "arm") == sorted([old, young])
    assert set(entries(home)) == others | {old, young}


def test_a_link_to_a_private_directory_is_followed(session, home, tmp_path):
    place = home / ".cache" / "poekin"
    shutil.move(place, tmp_path / "kept")
    place.symlink_to(tmp_path / "kept")
    assert session.kernel() == session.arm() == []


def test_threads_may_call_a_kernel_for_the_first_time_together(home):
    # two kernels and an arm that are kept, and two kernels that are not
    program = (
        PROGRAM.partition("print")[0]
        + f"""
import sys, threading
import numpy as np
from poekin.groups import se3
sys.setswitchinterval(1e-6)
arm, q, got = Chain.from_space({SCREWS}, {HOME}), np.zeros(2), []
calls = [lambda: so3.left_jacobian(q @ np.zeros((2, 3))), lambda: so3.exp(np.zeros(3)), lambda: arm.compile().fk([q]),
         lambda: arm.joint_poses(q)]
threads = [threading.Thread(target=lambda call=call: got.append(call())) for call in calls * 2]
[t.start() for t in threads]
[t.join() for t in threads]
print(len(got))
"""
    )
    out, log = run(home, program)
    assert out == "8"
    assert log.count("\n") == 1, log


def test_without_compiling_everything_still_runs_and_an_arm_s_program_is_interpreted(tmp_path):
    program = (
        PROGRAM
        + "print([chain.compile().jacobian([0.3, 0.4], f)[0].round(3).tolist() for f in ('body', 'cheapest')])"
    )
    arm = Chain.from_space(SCREWS, HOME).compile()
    compiled = [
        arm.jacobian([0.3, 0.4], frame)[0].round(3).tolist() for frame in ("body", "cheapest")
    ]
    assert run(tmp_path, program, NUMBA_DISABLE_JIT="1") == (f"{RIGHT}\n{compiled}", "")
    assert not (tmp_path / ".cache" / "poekin").exists()


def test_where_a_system_has_no_flags_for_links_and_pipes_files_are_opened_as_they_are(monkeypatch):
    opened: list[int] = []
    monkeypatch.setattr(os, "open", lambda path, flags: opened.append(flags))
    cache._open_regular("file", os.O_RDONLY)
    monkeypatch.delattr(os, "O_NOFOLLOW", raising=False)
    monkeypatch.delattr(os, "O_NONBLOCK", raising=False)
    cache._open_regular("file", os.O_RDWR)
    assert opened[1] == os.O_RDWR
