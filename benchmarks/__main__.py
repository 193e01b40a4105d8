"""`python -m benchmarks [--quick] [--output DIR] [--only TOPIC …] [--peers PEER …]`: measure, and
write the report.

The kernels that this machine does not have are compiled first. The page is there after a quick look
at the topics that open it, and is written again after each topic. Those that are not timed come
first, side by side; of the others each has the machine for itself. Ctrl-C ends the measuring; the
report is written with what there is.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from . import peers
from .cases import OPENING, TOPICS
from .page import plain_table, summary
from .run import Run

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

    run = Run(options.output, options.only or list(TOPICS), say)
    looks = () if options.only or options.quick else OPENING
    interrupted = False
    try:
        if looks:
            run.compile_kernels()
        run.measure_all(looks, quick=True, look=True)
        run.measure_all(run.names, quick=options.quick)
    except KeyboardInterrupt:
        interrupted = True
        run.stop()
    topics = list(run.topics.values())
    print(
        f"\n{plain_table(topics)}\n\n{summary(topics)}\nThe report: {(options.output / 'index.html').resolve()}"
    )
    return INTERRUPTED if interrupted else 1 if any(topic.failure for topic in topics) else 0


if __name__ == "__main__":
    sys.exit(main())
