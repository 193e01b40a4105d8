"""Calls of somebody else's function: what comes of each, what is asked again, and what stays as it
was.
"""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.errors import InputError
from poekin.testing.conform.process import calls, child, limits, worker
from poekin.testing.conform.process.calls import Attempt, Fault, called, made, real, untouched
from poekin.testing.conform.process.limits import Limits
from poekin.testing.conform.process.worker import Reply


def raises(error: BaseException) -> Callable[..., Any]:
    def call(*_: Any) -> Any:
        raise error

    return call


@pytest.mark.parametrize(
    ("error", "fault"),
    [
        (ValueError("no  good\nat all"), "ValueError: no good at all"),
        (ValueError(), "ValueError"),
        (SystemExit(3), "SystemExit: 3"),
        (Fault("ended the process"), "ended the process"),
        (ValueError("x" * 300), f"ValueError: {'x' * 199}…"),
        (ValueError("a\x1bb"), r"ValueError: a\x1bb"),
    ],
    ids=["words", "none", "exit", "said already", "long", "control"],
)
def test_what_a_call_raises_is_one_line(error, fault):
    assert made(raises(error)) == (None, fault)
    with Attempt() as attempt:
        raise error
    assert attempt.fault == fault


def test_who_interrupts_is_not_held_up():
    with pytest.raises(KeyboardInterrupt):
        made(raises(KeyboardInterrupt()))


def test_warnings_are_no_fault_and_no_result_is_one():
    def warns() -> float:
        warnings.warn("careful", stacklevel=1)
        return float(np.log(np.array(0.0)))

    assert made(warns) == (-np.inf, "")
    with Attempt() as attempt:
        pass
    assert (attempt.fault, attempt.place) == ("", "")


def test_the_place_is_that_of_what_raised_outside_of_the_package():
    with Attempt() as attempt:
        contextlib.ExitStack().close()
        raises(ValueError("here"))()
    line = raises.__code__.co_firstlineno + 2
    assert attempt.place == f"test_calls.py, line {line}"


def test_a_function_may_not_write_into_what_it_is_given():
    def writes(a: np.ndarray, b: np.ndarray) -> float:
        b[0] = 7.0
        return 1.0

    x = np.zeros(2)
    with pytest.raises(calls.ArgumentChanged, match=r"^it writes into its argument 2 of 2$"):
        untouched(writes)(x, x.copy())
    with pytest.raises(calls.ArgumentChanged, match=r"^it writes into its argument$"):
        untouched(lambda b: writes(x, b))(x.copy())
    assert untouched(lambda a, b: 3.0)(x, x) == 3.0


@pytest.mark.parametrize(
    ("value", "fault"),
    [
        (np.ones((2, 3)), ""), ([[1, 2, 3], [4, 5, 6]], ""), (np.ones((2, 3), complex), ""),
        (np.ones((3, 2)), "shape (3, 2) where (2, 3) was expected"), (None, "shape () where (2, 3) was expected"),
        (object(), "TypeError: "),
        (np.full((2, 3), np.nan), "NaN"),
        (np.diag([1, np.inf, 1])[:2], "infinite"), (np.diag([np.nan, np.inf, 1])[:2], "NaN"),
        (np.full((2, 3), 1j), "TypeError: real numbers expected, got complex128"),
        (np.full((2, 3), "1"), "TypeError: real numbers expected, got str32"),
        (np.full((2, 3), b"1"), "TypeError: real numbers expected, got bytes8"),
    ],
)  # fmt: skip
def test_a_result_is_an_array_of_finite_numbers_in_the_shape_expected(value, fault):
    result = called(lambda x: value, (2, 3), np.zeros(1))
    if fault:
        assert result.value is None
        assert result.fault.startswith(fault)
    else:
        assert result.fault == ""
        np.testing.assert_array_equal(result.value, np.real(np.array(value)).astype(float))


def test_arguments_are_copies():
    x, seen = np.zeros(2), list[np.ndarray]()
    called(seen.append, (), x)
    assert seen[0] is not x


@pytest.mark.parametrize(
    ("value", "kind"),
    [(np.ones(2, np.float32), np.float32), (np.ones(2, np.float16), np.float16), (np.ones(2), float), ([1, 2], float),
     (np.ones(2, np.longdouble), float), (np.ones(2, bool), float), (np.ones(2, complex), float), (1 + 0j, float)],
)  # fmt: skip
def test_numbers_are_floats_of_their_own_precision(value, kind):
    found = real(value)
    assert found.dtype == kind
    assert (found == 1).any()
    assert found is not value
    with pytest.raises(TypeError, match=r"^real numbers expected, got complex64$"):
        real(np.array([1j], np.complex64))


class Scripted:
    """A child without a process, whose answers are known."""

    def __init__(self, *answers: Any):
        self.child = object.__new__(child.Child)
        self.answers, self.asked, self.started = list(answers), list[tuple[Any, ...]](), 0
        more = {"_thing": "m:C", "_limits": Limits(), "_process": object(), "_lost": "", "_answered": False,
                "seconds": 3.0, "_received": self.received, "_started": self.start}  # fmt: skip
        vars(self.child).update(more)

    def received(self, seconds: float, message: Any) -> Any:
        self.asked.append((seconds, message))
        answer = self.answers.pop(0)
        if isinstance(answer, BaseException):
            self.child._process = None
            raise answer
        return answer

    def start(self) -> Any:
        self.started += 1
        self.child._process = object()  # type: ignore[assignment]


LATE = Fault(f"{calls.UNANSWERED} 3 s")


def test_a_first_call_that_is_late_is_made_again_once():
    s = Scripted(LATE, Reply(5), LATE)
    assert s.child.ask("function", "exp", 1) == 5
    assert s.asked == [(3.0, ("function", "exp", 1))] * 2
    assert s.started == 1
    with pytest.raises(Fault, match="no answer in 3 s"):
        s.child.ask("function", "exp", 1)
    assert len(s.asked) == 3
    s = Scripted(LATE, LATE, Reply(5))
    with pytest.raises(Fault, match="no answer in 3 s"):
        s.child.ask("names")
    assert len(s.asked) == 2
    s = Scripted(Reply(1), LATE)
    assert s.child.ask("names") == 1
    with pytest.raises(Fault, match="no answer in 3 s"):
        s.child.ask("names")


def test_a_process_that_ended_is_not_asked_again_but_made_anew_for_the_next_call():
    s = Scripted(Fault(f"{calls.ENDED} (SIGSEGV)"), Reply(7))
    with pytest.raises(Fault, match="SIGSEGV"):
        s.child.ask("names")
    assert (len(s.asked), s.started) == (1, 0)
    assert s.child.ask("names") == 7
    assert s.started == 1


def test_what_cannot_be_made_again_is_lost_for_good():
    s = Scripted()
    s.child._process = None
    vars(s.child)["_started"] = raises(InputError("made before"))
    for _ in range(2):
        with pytest.raises(Fault, match=r"^cannot be made again: made before$"):
            s.child.ask("names")
    assert s.asked == []


def test_faults_and_interrupts_of_a_reply_are_raised():
    s = Scripted(Reply(fault="ValueError"), Reply(interrupted=True))
    with pytest.raises(Fault, match=r"^ValueError$"):
        s.child.ask("names")
    with pytest.raises(KeyboardInterrupt):
        s.child.ask("names")


def test_calls_are_given_less_time_within_a_context_and_never_more():
    s = Scripted(Reply(1), Reply(1), Reply(1))
    remote = child.Remote(s.child)
    with remote.within(2.0):
        remote.so3_exp(1)
    with remote.within(5.0):
        remote.so3_log(2)
    remote.so3_exp(3)
    assert s.asked == [
        (2.0, ("function", "so3_exp", 1)), (3.0, ("function", "so3_log", 2)), (3.0, ("function", "so3_exp", 3))
    ]  # fmt: skip


def test_what_was_read_far_away_has_the_members_that_it_has_there():
    s = Scripted(
        Reply(["fk"]), Reply(["a"]), Reply(2), Reply({"tip": Reply(3), "base": Reply(fault="NaN")})
    )
    read = child.Remote(s.child).read_urdf("text", "base", "tip")
    assert read.jacobian is None
    assert read.names == ["a"]
    assert read.fk("q") == 2
    poses = read.poses("q")
    assert (len(poses), sorted(poses), poses["tip"]) == (2, ["base", "tip"], 3)
    with pytest.raises(Fault, match=r"^NaN$"):
        poses["base"]
    assert [message for _, message in s.asked] == [
        ("read", "read_urdf", "text", "base", "tip"), ("names",), ("member", "fk", "q"), ("poses", "q"),
    ]  # fmt: skip
    assert callable(child.RemoteRead(s.child, ["fk", "jacobian"]).jacobian)


@pytest.mark.parametrize(
    ("code", "said"),
    [
        (0, "exit code 0"),
        (7, "exit code 7"),
        (-1, "SIGHUP"),
        (-11, "SIGSEGV"),
        (-9, "SIGKILL"),
        (-200, "signal 200"),
    ],
)
def test_an_exit_code_is_told_as_a_number_or_a_signal(code, said):
    assert child._said(code) == said


def test_a_subject_is_called_after_its_name_or_its_class():
    assert [child._title(x) for x in ("m:C", Reply, Reply())] == ["m:C", "Reply", "Reply"]


def test_a_subject_runs_in_a_fork_where_nothing_is_lost_by_it(monkeypatch):
    assert child.obstacle("m:C") == ""
    monkeypatch.setattr(child, "os", SimpleNamespace(fork=None))
    monkeypatch.setattr(child, "sys", SimpleNamespace(platform="linux", modules={}))
    monkeypatch.setattr(child, "_numba_has_threads", lambda: False)
    assert child.obstacle(Reply) == ""
    monkeypatch.setattr(
        child, "sys", SimpleNamespace(platform="linux", modules={"jax": None, "torch": None})
    )
    assert (
        child.obstacle(Reply) == "the threads of jax and torch, loaded here, do not survive a fork"
    )
    monkeypatch.setattr(child, "_numba_has_threads", lambda: True)
    assert (
        child.obstacle(Reply)
        == "the threads of jax and torch and numba, loaded here, do not survive a fork"
    )
    monkeypatch.setattr(child.sys, "platform", "darwin")
    assert child.obstacle(Reply) == "this system forks no process that is sure to work"
    assert child.obstacle("m:C") == ""
    monkeypatch.setattr(child, "os", SimpleNamespace())
    monkeypatch.setattr(child.sys, "platform", "linux")
    assert child.obstacle(Reply) == "this system forks no process that is sure to work"


@pytest.mark.parametrize("value", [0, -1.0, np.inf, np.nan, "1", None])
@pytest.mark.parametrize("what", ["seconds", "memory"])
def test_limits_are_positive_numbers(what, value):
    with pytest.raises(InputError, match=rf"^{what}: expected a positive number, got "):
        Limits(**{what: value}).checked()
    ok = Limits(0.5, 1)
    assert ok.checked() is ok


def test_a_subject_is_given_two_minutes_to_begin_or_as_long_as_a_call():
    assert (Limits().seconds, Limits().memory) == (60.0, 4 * 2**30)
    assert [Limits(seconds).starting for seconds in (1.0, 120.0, 121.0)] == [120.0, 120.0, 121.0]


def test_a_process_may_take_so_many_bytes_more_than_it_has(monkeypatch):
    resource = pytest.importorskip("resource")
    set_to: list[tuple[int, tuple[int, int]]] = []
    monkeypatch.setattr(resource, "setrlimit", lambda what, pair: set_to.append((what, pair)))
    monkeypatch.setattr(resource, "getrlimit", lambda what: (3, 5))
    monkeypatch.setattr(limits, "_data", lambda: 1000)
    for platform, expected in (
        ("linux", [(resource.RLIMIT_CORE, (0, 0)), (resource.RLIMIT_DATA, (1234, 5))]),
        ("darwin", [(resource.RLIMIT_CORE, (0, 0))]),
    ):
        monkeypatch.setattr(limits, "sys", SimpleNamespace(platform=platform))
        set_to.clear()
        limits.restrict(234)
        assert set_to == expected
    monkeypatch.setattr(resource, "setrlimit", raises(ValueError()))
    limits.restrict(234)


def test_bytes_of_data_are_told_in_kilobytes(monkeypatch, tmp_path):
    status = "Name:\tpython\nVmPeak:\t  9 kB\nVmData:\t     123 kB\nThreads:\t1\n"
    (tmp_path / "status").write_text(status)
    monkeypatch.setattr(
        limits, "open", lambda *_, **__: (tmp_path / "status").open(), raising=False
    )
    assert limits._data() == 123 * 1024


def messages(stream: io.BytesIO) -> list[Any]:
    """All messages in a stream."""
    stream.seek(0)
    found = []
    with contextlib.suppress(EOFError):
        while True:
            found.append(worker.receive(stream))
    return found


def test_messages_come_whole_or_the_other_side_is_gone():
    stream = io.BytesIO()
    for message in ("one", {"two": np.arange(3)}, None):
        worker.send(stream, message)
    first, second, third = messages(stream)
    assert (first, list(second), third) == ("one", ["two"], None)
    content = stream.getvalue()
    length = 8 + int.from_bytes(content[:8], "little")
    for end in (0, 7, 8, length - 1):
        with pytest.raises(EOFError):
            worker.receive(io.BytesIO(content[:end]))
    assert worker.receive(io.BytesIO(content[:length])) == "one"


class Reads:
    """What a reader makes of a URDF: with one function, and poses one of which is none."""

    names = ("a", 2)

    def fk(self, q: np.ndarray) -> np.ndarray:
        return q + 1

    def poses(self, q: np.ndarray) -> dict[str, Any]:
        return {"tip": q, "base": "none"}


class Subjected:
    def so3_exp(self, w: np.ndarray) -> Any:
        if w[0] > 1:
            raise KeyboardInterrupt
        w[0] += w[1]
        return [True, False]

    def read_robot(self, text: str) -> Reads:
        return Reads()


def test_requests_are_answered_until_there_are_no_more():
    requests, replies = io.BytesIO(), io.BytesIO()
    for request in (
        ("function", "so3_exp", np.zeros(3)), ("function", "so3_exp", np.ones(3)),
        ("function", "so3_exp", 2 * np.ones(3)), ("function", "so3_log", 1), ("names",), ("read", "read_robot", "text"),
        ("names",), ("member", "fk", np.zeros(1)), ("poses", np.zeros(1)),
    ):  # fmt: skip
        worker.send(requests, request)
    requests.seek(0)
    worker.serve(Subjected, requests, replies)
    subject, *found = messages(replies)
    assert (subject.title, subject.functions) == ("Subjected", ("so3_exp", "read_robot"))
    assert found[0].value.tolist() == [1.0, 0.0]
    faults = [reply.fault for reply in found]
    assert faults[1:4] == [
        "ArgumentChanged: it writes into its argument", "",
        "AttributeError: 'Subjected' object has no attribute 'so3_log'",
    ]  # fmt: skip
    assert [reply.interrupted for reply in found] == [False, False, True, *[False] * 6]
    assert faults[4].startswith("AttributeError: 'NoneType' object has no attribute 'names'")
    assert [reply.value for reply in found[5:8]] == [["fk", "poses"], ["a", "2"], np.ones(1)]
    assert found[8].value["tip"].value.tolist() == [0.0]
    assert found[8].value["base"].fault == "TypeError: real numbers expected, got str128"
    assert Reply() == (None, "", False)


def test_a_subject_that_cannot_be_made_is_the_one_reply():
    class Nothing:
        pass

    replies = io.BytesIO()
    worker.serve(Nothing, io.BytesIO(), replies)
    (error,) = messages(replies)
    assert isinstance(error, InputError)
    assert str(error).startswith("Nothing has none of the functions of a subject: ")
