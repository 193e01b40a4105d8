"""No reader does more than refuse what it cannot read; and the fuzzer that says so finds one that
does.
"""

from __future__ import annotations

import importlib.util
import signal

import pytest

from tools.fuzz import campaign
from tools.fuzz import child as harness
from tools.fuzz.__main__ import main, table, told
from tools.fuzz.campaign import Row, counts_of, run
from tools.fuzz.child import Job
from tools.fuzz.inputs import make
from tools.fuzz.mutate import LARGEST
from tools.fuzz.readers import READERS, of_name
from tools.fuzz.shrink import smallest
from tools.fuzz.trial import SLOW, attempt
from tools.fuzz.watch import Child, Tally

EACH = 150
"""Inputs to each reader; CI gives them 10⁴ more (`make fuzz COUNT=10000`)."""
SEED = 7
PACKAGES = {"MJCF": "mujoco", "xacro": "xacrodoc", "calibration YAML": "yaml"}
HERE = "tests.tools.planted_readers"


def missing(reader: str) -> str:
    """The package that a reader needs and that is not installed."""
    package = PACKAGES.get(reader, "")
    return package if package and importlib.util.find_spec(package) is None else ""


@pytest.fixture(scope="module")
def child():
    with Child() as started:
        yield started


@pytest.mark.parametrize("name", READERS)
def test_a_reader_reads_refuses_and_does_nothing_else(child, name):
    if missing(name):
        pytest.skip(f"{missing(name)} is not installed")
    row, failures = Row(name), []
    row.add(child.run(Job(name, SEED, 0, EACH), failures.append), failures)
    assert not row.found, "\n".join(told(row, found, SEED) for found in row.found.values())
    assert row.tally.inputs == EACH
    assert 12 < row.tally.accepted < EACH - 12, (
        "inputs that are all refused, or all read, show little"
    )


ALIKE = "".join(f'<link name="{"x" * 190}{i}"/>' for i in range(600)).encode()
HUGE = b"0x" + b"f" * 5000
POINTS = ",".join(f"{axis}{i}" for i in range(1, 7000) for axis in "xyz").encode()
FOUND = {
    "a model that attaches itself": (
        "MJCF",
        b'<mujoco><asset><model file="input.xml"/></asset></mujoco>',
    ),
    "a replica a billion times": (
        "MJCF",
        b'<mujoco><worldbody><replicate count="1000000000"><body/></replicate></worldbody></mujoco>',
    ),
    "a billion keyframes": ("MJCF", b'<mujoco><size nkey="1000000000"/></mujoco>'),
    "plugins without a name": (
        "MJCF",
        b"<mujoco><worldbody><body><plugin/></body><body><plugin/></body></worldbody></mujoco>",
    ),
    "an infinite anchor": (
        "MJCF",
        b'<mujoco><worldbody><body><joint pos="7 1 inf"/></body></worldbody></mujoco>',
    ),
    "an infinite ref": (
        "MJCF",
        b'<mujoco><worldbody><body><joint ref="inf"/></body></worldbody></mujoco>',
    ),
    "a NaN that is no place": ("MJCF", b'<mujoco><option timestep="nan"/></mujoco>'),
    "a stack as small as the model asks": ("MJCF", b'<mujoco><size memory="1"/></mujoco>'),
    "a header of brackets": (
        "npy",
        b"\x93NUMPY\1\0" + (596).to_bytes(2, "little") + b"{1{" + b"{1:" * 197 + b"{1",
    ),
    "no arena at all, as the model asks": ("MJCF", b'<mujoco><size memory="0"/></mujoco>'),
    "a folder to include": ("MJCF", b'<mujoco><include file="."/></mujoco>'),
    "many long names that are much alike": (
        "URDF",
        b'<robot><link name="b"/>'
        + ALIKE
        + b'<joint name="j" type="fixed"><parent link="'
        + b"x" * 191
        + b'"/>'
        b'<child link="b"/></joint></robot>',
    ),
    "a whole number too long to be told": ("DH TOML", b"convention = " + HUGE),
    "a version too long to be told": ("calibration TOML", b"format = " + HUGE),
    "a key of as many parts as it has bytes": ("DH TOML", b"a." * 50_000 + b"a = 1"),
    "a column twenty thousand times": ("DH CSV", b"theta," * 20_000 + b"theta"),
    "columns of seven thousand points": ("measured CSV", b"q1,q2,q3," + POINTS),
    "a signalling NaN": (
        "npy",
        b"\x93NUMPY\x01\x00\x46\x00"
        + b"{'descr': '<f4', 'fortran_order': False, 'shape': (3,)}".ljust(69)
        + b"\n"
        + b"\x01\x00\xa0\x7f" * 3,
    ),
    "a character beyond Unicode": ("calibration YAML", rb'"\U00110000"'),
    "a character beyond all numbers": ("calibration YAML", rb'kinematics: "\UFFFFFFFF"'),
    "a quaternion without a square": ("poses CSV", b"5,3,1,1e308,9,1,2"),
}


@pytest.fixture(scope="module")
def patient():
    """A child that waits ten times as long: a slow machine is no fault of a reader, while a time
    that grows with the square of the input is still seen.
    """
    with Child(slow=10 * SLOW) as started:
        yield started


@pytest.mark.parametrize(("reader", "data"), FOUND.values(), ids=FOUND.keys())
def test_what_was_found_is_mended(patient, reader, data):
    assert len(data) <= LARGEST
    if missing(reader):
        pytest.skip(f"{missing(reader)} is not installed")
    failures = []
    patient.run(Job(reader, 0, 0, 1, data), failures.append)
    assert failures == []


PLANTED = {
    "value_error": "ValueError",
    "system_exit": "SystemExit",
    "recursion": "RecursionError",
    "raw_message": "raw message",
    "endless_message": "endless message",
    "foreign_warning": "RuntimeWarning",
    "hang": "hang",
    "memory": "MemoryError",
    "memory_at_once": "MemoryError",
    "left_file": "left a file",
    "crash": "crash (SIGABRT)",
    "in_use": "ZeroDivisionError",
}
INPUTS = 12


SEED_OF_TWO = 6  # inputs 2 and 5 have the fault, and 12 are made
COUNTS = {
    f"{HERE}:{name}": INPUTS * (5 if name == "in_use" else 1) for name in PLANTED
}  # what is read is seldom used


@pytest.fixture(scope="module")
def planted():
    """What came of all planted readers, by name: of the one that hangs soon, of all others in one
    campaign.
    """
    hang = f"{HERE}:hang"
    others = run(
        {name: count for name, count in COUNTS.items() if name != hang}, SEED_OF_TWO, workers=1
    )
    return {
        row.reader: row
        for row in (*others, *run({hang: COUNTS[hang]}, SEED_OF_TWO, workers=1, slow=0.05))
    }


@pytest.mark.parametrize(("name", "what"), PLANTED.items(), ids=PLANTED.keys())
def test_a_planted_fault_is_found_and_made_small(planted, name, what):
    row = planted[f"{HERE}:{name}"]
    assert row.tally.inputs == COUNTS[row.reader], (
        "it goes on behind the input that ended the child"
    )
    assert [found.first.what for found in row.found.values()] == [what]
    (found,) = row.found.values()
    assert found.again
    assert found.data == b"7"
    assert f"attempt(of_name('{HERE}:{name}'), b'7')" in told(row, found, SEED_OF_TWO)
    if name in ("hang", "crash"):
        assert found.count == 2, "the first of them is not the last of all"
        assert "planted_readers.py" in found.first.trace


def test_an_input_has_a_second_where_nothing_else_is_said(monkeypatch):
    started = []
    monkeypatch.setattr(Child, "run", lambda child, *_: started.append(child.slow) or Tally())
    run({f"{HERE}:sound": 1}, seed=0, workers=1)
    run({f"{HERE}:sound": 1}, seed=0, workers=1, slow=0.5)
    assert started == [1.0, 0.5]


def test_a_reader_that_waits_hangs_though_it_uses_no_processor(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(signal, "setitimer", lambda *_: None)
    failure = harness._timed(of_name(f"{HERE}:waiting"), b"7", False, slow=0.05).failure
    assert failure is not None
    assert (failure.what, failure.trace.endswith("s of waiting; trace.txt has where, if it was the processor")) == (
        "hang", True
    )  # fmt: skip


@pytest.mark.parametrize(
    ("name", "what"),
    [
        ("starved", "memory refused"),
        ("starved_in_words", "memory refused"),
        ("circular", "its own cause"),
    ],
    ids=["starved", "starved_in_words", "circular"],
)
def test_a_refusal_that_the_limit_of_memory_or_itself_brought_about_is_none(
    name, what, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    failure = attempt(of_name(f"{HERE}:{name}"), b"7").failure
    assert failure is not None
    assert failure.what == what


def test_a_sound_reader_has_no_failure():
    row = run({f"{HERE}:sound": 12}, seed=0, workers=1)[0]
    assert row.found == {}
    assert 0 < row.tally.accepted < row.tally.inputs == 12


def test_the_same_seed_gives_the_same_inputs_whatever_the_workers(monkeypatch):
    for name in READERS:
        inputs = [make(of_name(name), 3, i) for i in range(30)]
        assert inputs == [make(of_name(name), 3, i) for i in range(30)]
        assert inputs != [make(of_name(name), 4, i) for i in range(30)]
        assert max(map(len, inputs)) <= LARGEST
    monkeypatch.setattr(campaign, "CHUNK", 60)
    count = {f"{HERE}:sound": 61, f"{HERE}:in_use": 59}
    alone, together = (run(count, seed=5, workers=workers, shrink=False) for workers in (1, 2))
    assert 0 < alone[1].failures == together[1].failures
    assert [row.tally[:2] for row in alone] == [row.tally[:2] for row in together]
    assert [row.tally.inputs for row in alone] == list(count.values())


def test_an_interrupted_campaign_tells_what_there_is(monkeypatch):
    def interrupt(row: Row, count: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(campaign, "CHUNK", 60)
    row, rest = run(
        {f"{HERE}:sound": 180, f"{HERE}:in_use": 60}, seed=5, workers=1, progress=interrupt
    )
    assert (row.tally.inputs, rest.tally.inputs) == (60, 0)


@pytest.mark.parametrize(
    ("data", "needed"),
    [
        (b"<a><b x='1'>\n<c/></b><d/>\n</a>", b"<c/>"),
        (b"1, 2, 3\n4, 7, 6\n" * 40, b"7"),
        (b"", b""),
    ],
    ids=["xml", "rows", "empty"],
)
def test_what_is_not_needed_is_left_out(data, needed):
    assert smallest(data, lambda left: needed in left) == needed


def test_the_attempts_to_leave_something_out_are_counted():
    asked = []
    smallest(b"x" * 1000, lambda left: bool(asked.append(left)), most=17)
    assert len(asked) == 17


def test_the_command_prints_the_table_and_fails_where_a_reader_did(capsys, monkeypatch):
    assert counts_of(["URDF", "MJCF"], 1000) == {"URDF": 1000, "MJCF": 100}
    assert main(["--count", "200", "--reader", "UR conf", "--seed", "1"]) == 0
    out = capsys.readouterr().out
    assert "worst time" in out
    assert "20 inputs, 0 failures, seed 1" in out
    monkeypatch.setattr(
        "tools.fuzz.__main__.run", lambda *_, **__: run({f"{HERE}:value_error": 12}, 0, 1)
    )
    assert main(["--count", "1", "--reader", "UR conf"]) == 1
    assert "ValueError: 7" in capsys.readouterr().out


def test_the_table_has_a_line_for_each_reader():
    lines = table(
        [Row("a", Tally(1_000_000, 3, 0.5, 12), seconds=100), Row("a long name")]
    ).splitlines()
    assert [line.partition("  ")[0] for line in lines[1:]] == ["a", "a long name"]
    assert lines[1].split() == [
        "a",
        "1,000,000",
        "3",
        "999,997",
        "0",
        "0.500",
        "s",
        "(no.",
        "12)",
        "10,000",
    ]
    assert len({len(line) for line in lines}) == 1
