"""How long `compile()` takes in a fresh process: the first time, from disk, and for a chain of
fifty joints.
"""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import Any

from ..fresh import run
from ..report import Figure, Table, Topic, short

JOINTS = 50

PANDA = """
import json, time
import poekin as pk, numpy as np
chain = pk.load("panda").chain(tip="panda_hand")
q = np.linspace(-1, 1, chain.dof)
"""

LONG = f"""
import json, time
import poekin as pk, numpy as np
rng = np.random.default_rng(0)
axes, points = rng.normal(size=(2, {JOINTS}, 3))
chain = pk.Chain.from_space([pk.screw.revolute(w / np.linalg.norm(w), p) for w, p in zip(axes, points / 3)], np.eye(4))
q = rng.uniform(-np.pi, np.pi, chain.dof)
"""

CLOCKED = """
start = time.perf_counter()
arm = chain.compile()
made = time.perf_counter() - start
T, J = arm.fk_jacobian(q, "hybrid")
called = time.perf_counter() - start
start = time.perf_counter()
other = pk.Chain.from_space(chain.screws, chain.home).compile()
other.fk_jacobian(q, "body")
again = time.perf_counter() - start
from poekin.testing.oracles import exact
error = float(np.abs(T - exact.rounded(exact.forward(chain.screws, chain.home, q))).max() / chain.reach)
print(json.dumps({"made": made, "called": called, "again": again, "error": error}))
"""


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    repetitions = 2 if quick else 5
    with tempfile.TemporaryDirectory() as name:
        shared = Path(name)
        ever = _clocked(PANDA, shared)
        say("first ever")
        first = min((_first(PANDA, shared) for _ in range(repetitions)), key=_called)
        say("first time")
        disk = min((_clocked(PANDA, shared) for _ in range(repetitions)), key=_called)
        say("from disk")
        long = _first(LONG, shared)
        say(f"{JOINTS} joints")
    rows = [
        ("Panda, first ever: the kernels that all arms share, too", ever),
        ("Panda, first time", first),
        ("Panda, from disk", disk),
        (f"{JOINTS} joints, first time", long),
    ]
    judged = "judged: compile() and the first call of fk_jacobian, by the wall clock, poekin imported before"
    return Topic(
        "compile() in a fresh process",
        "An arm's machine code is made at the first use of a frame, not by compile() itself, so what a user waits for "
        "is compile() and the first fk_jacobian: that is judged. It holds the import of Numba and the loading of the "
        "kernels which all arms share; these are compiled once for a machine, by Numba, which a row of its own shows. "
        f"Each is the fastest of {repetitions} processes, the first ever and the long chain of one. The error is that "
        "of the pose, ÷ R, against 60 digits.",
        figures=[
            _figure("compile() of a Panda, first time in a fresh process", first, 2.0, judged),
            _figure("compile() of a Panda, from disk in a fresh process, after import", disk, 0.3, judged),
            _figure(f"compile() of a random chain of {JOINTS} revolute joints", long, 20.0, judged),
            _figure("first ever on a machine: the kernels that all arms share, too", ever, None, "empty cache"),
        ],
        tables=[
            Table(
                "Parts, by the wall clock",
                ("what", "compile() alone (s)", "compile() and the first call (s)",
                 "the next frame, from disk where it was there (s)", "pose error ÷ R"),
                [(what, *(x[part] for part in ("made", "called", "again", "error"))) for what, x in rows],
            )
        ],
    )  # fmt: skip


def _first(script: str, cache: Path) -> dict[str, float]:
    """As `_clocked`, with the kernels that all arms share in the cache, and no arm's code."""
    for file in cache.glob("arm-*"):
        file.unlink()
    return _clocked(script, cache)


def _clocked(script: str, cache: Path) -> dict[str, float]:
    return json.loads(_clean(run(script + CLOCKED, {"POEKIN_CACHE_DIR": str(cache)})))


def _clean(outcome: Any) -> str:
    if outcome.code:
        raise RuntimeError(outcome.err)
    return outcome.out


def _called(parts: dict[str, float]) -> float:
    return parts["called"]


def _figure(what: str, parts: dict[str, float], bar: float | None, note: str) -> Figure:
    return Figure(
        what, parts["called"], bar, "s", error=f"{short(parts['error'])} R",
        note=f"{note}; compile() alone {short(parts['made'])} s",
    )  # fmt: skip
