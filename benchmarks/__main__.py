"""`python -m benchmarks [--quick] [--output DIR] [--only TOPIC …]`: measure, and write the report to build/report/."""

from __future__ import annotations

import argparse
import sys
import time
import traceback
from pathlib import Path

from .cases import TOPICS
from .machine import machine
from .page import html, markdown, plain_table, results, summary
from .report import Topic


def main() -> int:
    """The exit code: 0 when every topic ran to its end (whether or not its bars hold), else 1."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description="Measure poekin and write the report.")
    parser.add_argument("--quick", action="store_true", help="fewer samples: a look, not a measurement")
    parser.add_argument("--output", type=Path, default=Path("build/report"), help="directory of the report")
    parser.add_argument("--only", nargs="+", choices=TOPICS, metavar="TOPIC", help=f"some of: {', '.join(TOPICS)}")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)

    start = time.monotonic()

    def say(line: str) -> None:
        print(f"[{time.monotonic() - start:5.0f} s] {line}", flush=True)

    about = machine()
    topics = []
    for name in options.only or TOPICS:
        say(f"{name} …")
        topics.append(_run(name, options.quick, say))
    seconds = time.monotonic() - start
    pages = {"index.html": html, "report.md": markdown, "results.json": results}
    for file, write in pages.items():
        (options.output / file).write_text(write(topics, about, seconds), encoding="utf-8")
    print(f"\n{plain_table(topics)}\n\n{summary(topics)}\nThe report: {(options.output / 'index.html').resolve()}")
    return 1 if any(topic.failure for topic in topics) else 0


def _run(name: str, quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    try:
        return TOPICS[name].topic(quick, say)
    except Exception:  # noqa: BLE001  the other topics' figures must not be lost, and this failure stands in the report
        failure = traceback.format_exc()
        say(f"{name} broke off:\n{failure}")
        return Topic(name, failure=failure)


if __name__ == "__main__":
    sys.exit(main())
