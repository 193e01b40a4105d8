"""`python -m benchmarks.subjects [EXAMPLES]`: look for false findings against the subjects that
compute in 60 digits.

10⁵ examples take twenty minutes. The exit code is 1 where there is a finding.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from .held import FALSE_EXAMPLES, false_findings, tries


def main(arguments: Sequence[str] | None = None) -> int:
    """The exit code; each law is said as it is done."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.subjects", description="Look for false findings."
    )
    parser.add_argument(
        "examples", type=int, nargs="?", default=FALSE_EXAMPLES, help="of all laws together"
    )

    def say(line: str) -> None:
        print(line, flush=True)

    _, false, _ = false_findings(tries(parser.parse_args(arguments).examples), say)
    return int(false > 0)


if __name__ == "__main__":
    sys.exit(main())
