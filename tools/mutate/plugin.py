"""What pytest does differently when it judges a mutant: the first failure ends it, and so does what
takes too long.

A property that is broken is broken: its smallest counterexample would take minutes, and nobody
would read it.
"""

from __future__ import annotations

import resource
import signal
from collections.abc import Callable

import pytest
from hypothesis import Phase, settings

SECONDS = 30.0  # of the processor, for one test: three times what the slowest needs
COMPILING = 120.0  # where it may have to compile kernels: the largest one takes 26 s alone
_BEYOND = 30  # then the signal that Python sees has not helped: the loop is inside a C function


class Judge:
    """Calls `said` with "caught" or "timeout" and the test, once, and the process is to end there."""

    def __init__(self, said: Callable[[str, str], None], seconds: float):
        self._said, self._seconds, self._running = said, seconds, "collection"
        signal.signal(signal.SIGPROF, lambda *_: said("timeout", self._running))
        self._limit()

    def _limit(self) -> None:
        usage = resource.getrusage(resource.RUSAGE_SELF)
        hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
        resource.setrlimit(
            resource.RLIMIT_CPU,
            (int(usage.ru_utime + usage.ru_stime + self._seconds) + _BEYOND, hard),
        )
        signal.setitimer(signal.ITIMER_PROF, self._seconds)

    @pytest.hookimpl(trylast=True)
    def pytest_configure(self, config):
        """After tests/conftest.py, before any test is imported."""
        settings.register_profile(
            "mutants",
            settings.get_profile("quick"),
            derandomize=True,
            database=None,
            phases=(Phase.explicit, Phase.generate, Phase.target),
            report_multiple_bugs=False,
            print_blob=False,
        )
        settings.load_profile("mutants")

    def pytest_runtest_logstart(self, nodeid, location):
        """Before each test."""
        self._running = nodeid
        self._limit()

    def pytest_runtest_logreport(self, report):
        """After each part of a test."""
        self._note(report)

    def pytest_collectreport(self, report):
        """After a file was read: a mutant may not even let it be imported."""
        self._note(report)

    def _note(self, report) -> None:
        if report.failed:
            self._said("caught", report.nodeid)
