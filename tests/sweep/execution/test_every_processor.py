"""The same bytes on a processor without vectors or fused multiply-add as on this one."""

from __future__ import annotations

import os
import platform
import subprocess
import sys

import pytest

CODE = """
import hashlib
import poekin as pk
for name, tip in (("panda", "panda_hand"), ("ur5e", "tool0"), ("stanford", None)):
    arm = pk.load(name).chain(tip=tip)
    found = pk.sweep.reach(arm, samples=50_000, side=4, resolution=0.1, measure="manipulability")
    for numbers in (found.counts, found.best, found.attained):
        print(hashlib.sha256(numbers.tobytes()).hexdigest())
arm = pk.load("ur5e").chain(tip="tool0")
cells = pk.sweep.Cells.box([-1] * 3, [1] * 3, 0.2)
samples = pk.sweep.Sobol.of(arm, 20_000)
error = dict(tilt=1e-3, shift=1e-4, offset=1e-4)
for measure in (
    "inverse_condition",
    "limit_margin",
    "travel",
    pk.sweep.PoseUncertainty.by_tolerances(arm, **error),
    pk.sweep.PoseUncertainty.by_tolerances(arm, **error, bound=True),
):
    sweep = pk.sweep.Sweep(arm, samples, cells, measure, "mean")
    print(hashlib.sha256(pk.sweep.run(sweep).best.tobytes()).hexdigest())
"""


def hashes(**variables: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", CODE],
        env=os.environ | variables,
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout


@pytest.mark.skipif(
    platform.machine() not in ("x86_64", "AMD64"), reason="names an x86-64 processor"
)
@pytest.mark.parametrize("name", ["generic", "sandybridge"])
def test_a_sweep_has_the_same_bytes_as_another_processor_runs_it(name):
    here = hashes()
    assert len(here.split()) == 14
    assert hashes(NUMBA_CPU_NAME=name, NUMBA_CPU_FEATURES="") == here
