"""A run of topics one after the other, and its page, which is written again after each of them."""

from __future__ import annotations

import json
import os
import time
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path

from poekin.engine.jit import cache
from poekin.engine.warm import kernels

from . import peers
from .cases import SECTION_OF, TOPICS, UNTIMED
from .machine import machine
from .page import html, markdown, results
from .report import Topic
from .workers import most_workers, workers

PAGES = {"index.html": html, "report.md": markdown, "results.json": results}


LATER = ("closed_kernels", "elimination_kernels", "ik_all_kernel", "listed_branches")
"""Modules of kernels that only `ik_all` runs: half of the time that compiling takes."""


class Run:
    """Topics that are to be measured, and those that are.

    topics: by name, in the order of the page; a topic of which there is a quick look alone is not
    done.
    """

    def __init__(self, folder: Path, names: Sequence[str], say: Callable[[str], None]):
        self.folder = folder
        self.names = list(names)
        self.say = say
        self.start = time.monotonic()
        self.about = machine()
        self.done: list[str] = []
        self.topics: dict[str, Topic] = {}
        self.seconds_before = _seconds_of(folder / "results.json")

    def measure(self, name: str, *, quick: bool, look: bool = False) -> None:
        """Run a topic and write the page; look: whether it is run again after it."""
        self.say(f"{name} …{self._time_left(look)}")
        self._keep(name, attempted(name, quick, self.say))
        if not look:
            self.done.append(name)
        self.write()

    def compile_kernels(self) -> None:
        """Compile the kernels that the cache does not have, in a process a core: each topic would
        wait for its own alone. Those of all solutions of a pose are left to their topic, which no
        picture waits for.
        """
        if cache.usable_directory() is None:
            return
        self.say("kernels for this machine …")
        with workers() as share:
            list(share(_ready, [name for name in kernels() if not name.startswith(LATER)]))

    def measure_all(self, names: Sequence[str], *, quick: bool, look: bool = False) -> None:
        """Run the topics that are not timed side by side, and each of the others after them."""
        together = [name for name in UNTIMED if name in names]
        if len(together) < 2:
            together = []
        self.measure_together(together, quick=quick, look=look)
        for name in names:
            if name not in together:
                self.measure(name, quick=quick, look=look)

    def measure_together(self, names: Sequence[str], *, quick: bool, look: bool = False) -> None:
        """Run topics that are not timed, in a process a core, and write the page after each."""
        if not names:
            return
        self.say(f"{', '.join(names)} …{self._time_left(look)}")
        count = len(names)
        with workers() as share:
            found = share(_apart, names, [quick] * count, [peers.chosen_names()] * count)
            for name, topic in zip(names, found, strict=True):
                self._keep(name, topic)
                if not look:
                    self.done.append(name)
                self.write()
                self.say(f"{name}: {topic.seconds:g} s")

    def stop(self) -> None:
        """Ctrl-C: the topics that are left are named, and quick looks stay."""
        left = [name for name in self.names if name not in self.done]
        words = ", ".join(left)
        if left:
            self._keep(left[0], Topic(left[0], failure=f"Ctrl-C: not measured: {words}"))
        self.say(f"Ctrl-C; the report is written without {words or 'nothing'}")
        self.done = self.names
        self.write()

    def write(self) -> None:
        """The pages with what there is."""
        taken = time.monotonic() - self.start
        left = len(self.names) - len(self.done)
        for file, page in PAGES.items():
            _write(self.folder / file, page(list(self.topics.values()), self.about, taken, left))

    def _keep(self, name: str, topic: Topic) -> None:
        topic.name = name
        topic.section = SECTION_OF.get(name, "")
        self.topics[name] = topic
        order = list(TOPICS)
        self.topics = dict(sorted(self.topics.items(), key=lambda item: order.index(item[0])))

    def _time_left(self, look: bool) -> str:
        """Words on the time left: that of the last report in the folder, where there was one, and
        else by the mean of what is measured.
        """
        left = [name for name in self.names if name not in self.done]
        if look or not left:
            return ""
        known = self.seconds_before | {
            name: self.topics[name].seconds for name in self.done if name in self.topics
        }
        if not known:
            return ""
        mean = sum(known.values()) / len(known)
        seconds = sum(known.get(name, mean) / _beside(name) for name in left)
        return f" ({len(left)} of {len(self.names)} to go, about {max(1, round(seconds / 60))} min)"


def _beside(name: str) -> int:
    """How many topics run side by side with a topic, and it among them."""
    return most_workers() if name in UNTIMED else 1


def attempted(name: str, quick: bool, say: Callable[[str], None]) -> Topic:
    """A topic that has run, or its failure, with the seconds that it took."""
    start = time.monotonic()
    try:
        topic = TOPICS[name].topic(quick, say)
    except Exception:  # noqa: BLE001  the other topics' figures must not be lost, and this failure stands in the report
        failure = traceback.format_exc()
        say(f"{name} broke off:\n{failure}")
        topic = Topic(name, failure=failure)
    topic.seconds = round(time.monotonic() - start, 1)
    topic.quick = quick
    return topic


def _apart(name: str, quick: bool, chosen: Sequence[str]) -> Topic:
    """A topic in a process of its own, whose lines have its name before them."""
    peers.use(chosen)
    return attempted(name, quick, lambda line: print(f"{name}: {line}", flush=True))


def _ready(kernel: str) -> None:
    """A kernel of this name, compiled and kept."""
    kernels()[kernel].ready()


def _seconds_of(path: Path) -> dict[str, float]:
    """Seconds of each topic of an earlier report that was no quick look; none where there is none."""
    try:
        topics = json.loads(path.read_text(encoding="utf-8"))["topics"]
        return {topic["name"]: float(topic["seconds"]) for topic in topics if not topic["quick"]}
    except (OSError, ValueError, KeyError, TypeError):
        return {}


def _write(path: Path, text: str) -> None:
    """The whole file or, after a second Ctrl-C, the one that was there."""
    new = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        new.write_text(text, encoding="utf-8")
        new.replace(path)
    finally:
        new.unlink(missing_ok=True)
