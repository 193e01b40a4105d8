"""Run the numeric tests as other processors would: `make test-processors`, or `python -m
tools.processors NAME ...`.

Whatever rounds differently from processor to processor takes this one for another, by the
environment of the tests:

- Numba's kernels and an arm's machine code (NUMBA_CPU_NAME, NUMBA_CPU_FEATURES): vectors, fused
  multiply-add;
- NumPy's loops (NPY_DISABLE_CPU_FEATURES) and OpenBLAS (OPENBLAS_CORETYPE, OPENBLAS_NUM_THREADS):
  order of sums;
- the C library's sines and cosines (GLIBC_TUNABLES), where it is glibc.

The instructions of an older processor are among this one's, so they run here. Property tests draw
two fifths of the examples of `make test`, the same ones.
"""

from __future__ import annotations

import argparse
import os
import platform
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

from llvmlite import binding
from numpy._core import _multiarray_umath as numpy_core  # pyright: ignore[reportAttributeAccessIssue]

ROOT = Path(__file__).resolve().parent.parent
ROOMS = tuple(
    f"tests/{room}"
    for room in ("groups", "formulas", "engine", "model", "analysis", "solve", "sweep")
)
AVX, FMA, AVX512 = (
    frozenset({"AVX"}),
    frozenset({"AVX", "F16C", "FMA3", "AVX2", "X86_V3"}),
    frozenset({"AVX512F"}),
)


class Processor(NamedTuple):
    """One x86-64 processor: LLVM's name, OpenBLAS's name and threads, and what it has beyond SSE
    4.2, as NumPy says.

    `needs` are LLVM's names of what this machine must have to run its code.
    """

    llvm: str
    blas: str
    threads: int
    has: frozenset[str] = frozenset()
    needs: tuple[str, ...] = ()


PROCESSORS = {
    "generic": Processor("generic", "Prescott", 1),
    "nehalem": Processor("nehalem", "Nehalem", 4),
    "sandybridge": Processor("sandybridge", "Sandybridge", 4, AVX, ("avx",)),
    "haswell": Processor("haswell", "Haswell", 2, FMA, ("avx2", "fma")),
    "zen2": Processor("znver2", "Zen", 1, FMA, ("avx2", "fma")),
    "skylake-avx512": Processor("skylake-avx512", "SkylakeX", 1, FMA | AVX512 | {"X86_V4", "AVX512CD", "AVX512_SKX"},
                                ("avx512f", "avx512dq", "avx512bw", "avx512vl", "avx512cd")),
}  # fmt: skip
USUAL = ("generic", "sandybridge", "haswell")
"""The ones that run where none is named: without and with each of AVX and fused multiply-add, one
thread and many.
"""


def missing(processor: Processor) -> list[str]:
    """What this machine lacks to run as another processor; its architecture, where that is another."""
    if platform.machine() not in ("x86_64", "AMD64"):
        return [f"x86-64 (it is {platform.machine()})"]
    here = binding.get_host_cpu_features()
    return [feature for feature in processor.needs if not here.get(feature)]


def environment(processor: Processor) -> dict[str, str]:
    """The variables that make the tests run as on a processor."""
    features = numpy_core.__cpu_features__
    beyond = [
        name
        for name in numpy_core.__cpu_dispatch__
        if features.get(name) and name not in processor.has
    ]
    glibc = [f"-{name}" for name, named in (("AVX", "AVX"), ("AVX2", "AVX2"), ("FMA", "FMA3"), ("AVX512F", "AVX512F"))
             if named not in processor.has]  # fmt: skip
    return {
        "NUMBA_CPU_NAME": processor.llvm,
        "NUMBA_CPU_FEATURES": "",  # those that the name implies
        "NPY_DISABLE_CPU_FEATURES": " ".join(beyond),
        "OPENBLAS_CORETYPE": processor.blas,
        "OPENBLAS_NUM_THREADS": str(processor.threads),
        "GLIBC_TUNABLES": f"glibc.cpu.hwcaps={','.join([*glibc, '-FMA4'])}",
        "HYPOTHESIS_PROFILE": "few",
    }


def run(name: str, tests: list[str], fast: bool = False) -> bool:
    """Run the tests as on a processor, and say which; whether they pass."""
    changed = environment(PROCESSORS[name])
    print(f"\n=== {name}: {' '.join(f'{k}={v!r}' for k, v in changed.items())}", flush=True)
    start = time.monotonic()
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-n",
        "2",
        "--dist",
        "worksteal",
        "-p",
        "no:cacheprovider",
        *(("-m", "not slow") if fast else ()),
        *tests,
    ]
    passed = (
        subprocess.run(command, cwd=ROOT, env=os.environ | changed, check=False).returncode == 0
    )
    print(
        f"=== {name}: {'passed' if passed else 'FAILED'} after {time.monotonic() - start:.0f} s",
        flush=True,
    )
    return passed


def main(arguments: list[str] | None = None) -> int:
    """Run the tests on each processor named; 1 where a test fails on one of them."""
    parser = argparse.ArgumentParser(description="Run the numeric tests as other processors would.")
    parser.add_argument("processors", nargs="*", metavar="NAME", help=f"of {', '.join(PROCESSORS)}")
    parser.add_argument(
        "--tests",
        nargs="+",
        default=list(ROOMS),
        help="files or folders in place of the numeric ones",
    )
    parser.add_argument("--fast", action="store_true", help="leave the slow tests out")
    given = parser.parse_args(arguments)
    unknown = sorted(set(given.processors) - set(PROCESSORS))
    if unknown:
        parser.error(f"unknown processor {unknown[0]!r}: expected one of {', '.join(PROCESSORS)}")
    failed = []
    for name in given.processors or USUAL:
        lacking = missing(PROCESSORS[name])
        if lacking:
            print(f"=== {name}: left out, this machine has no {', '.join(lacking)}")
        elif not run(name, given.tests, given.fast):
            failed.append(name)
    if failed:
        print(f"=== failed as: {', '.join(failed)}")
    return int(bool(failed))


if __name__ == "__main__":
    sys.exit(main())
