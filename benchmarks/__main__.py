"""`python -m benchmarks [--quick] [--output DIR] [--only TOPIC …] [--peers PEER …]`: measure, and
write the report.

Ctrl-C ends the measuring; the report is written with what there is.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
import traceback
from pathlib import Path

from . import peers
from .cases import TOPICS
from .machine import machine
from .page import html, markdown, plain_table, results, summary
from .report import Topic

INTERRUPTED = 130


def main() -> int:
    """The exit code: 0 when every topic ran to its end (whether or not its bars hold), 130 after
    Ctrl-C, else 1.
    """
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks", description="Measure poekin and write the report."
    )
    parser.add_argument(
        "--quick", action="store_true", help="fewer samples: a look, not a measurement"
    )
    parser.add_argument(
        "--output", type=Path, default=Path("build/report"), help="directory of the report"
    )
    parser.add_argument(
        "--only", nargs="+", choices=TOPICS, metavar="TOPIC", help=f"some of: {', '.join(TOPICS)}"
    )
    parser.add_argument(
        "--peers", nargs="+", choices=peers.names(), metavar="PEER", default=["standard"],
        help=f"libraries to measure beside poekin, where installed: some of {', '.join(peers.names())}",
    )  # fmt: skip
    options = parser.parse_args()
    peers.use(options.peers)
    options.output.mkdir(parents=True, exist_ok=True)

    start = time.monotonic()

    def say(line: str) -> None:
        print(f"[{time.monotonic() - start:5.0f} s] {line}", flush=True)

    about = machine()
    names = list(options.only or TOPICS)
    topics: list[Topic] = []
    for name in names:
        say(f"{name} …")
        try:
            topics.append(_run(name, options.quick, say))
        except KeyboardInterrupt:
            left = ", ".join(names[len(topics) :])
            topics.append(Topic(name, failure=f"Ctrl-C: not measured: {left}"))
            say(f"Ctrl-C; the report is written without {left}")
            break
    interrupted = len(topics) < len(names) or topics[-1].failure.startswith("Ctrl-C")
    seconds = time.monotonic() - start
    pages = {"index.html": html, "report.md": markdown, "results.json": results}
    for file, write in pages.items():
        _write(options.output / file, write(topics, about, seconds))
    print(
        f"\n{plain_table(topics)}\n\n{summary(topics)}\nThe report: {(options.output / 'index.html').resolve()}"
    )
    return INTERRUPTED if interrupted else 1 if any(topic.failure for topic in topics) else 0


def _write(path: Path, text: str) -> None:
    """The whole file or, after a second Ctrl-C, the one that was there."""
    new = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        new.write_text(text, encoding="utf-8")
        new.replace(path)
    finally:
        new.unlink(missing_ok=True)


def _run(name: str, quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    try:
        return TOPICS[name].topic(quick, say)
    except Exception:  # noqa: BLE001  the other topics' figures must not be lost, and this failure stands in the report
        failure = traceback.format_exc()
        say(f"{name} broke off:\n{failure}")
        return Topic(name, failure=failure)


if __name__ == "__main__":
    sys.exit(main())
