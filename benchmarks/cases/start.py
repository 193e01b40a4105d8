"""How soon poekin is there: its import in a fresh process, and the first call ever, which compiles."""

from __future__ import annotations

import tempfile

from ..fresh import run
from ..harness import spread
from ..report import Figure, Table, Topic, short

IMPORT = (
    "import time; start = time.perf_counter(); import poekin; print(time.perf_counter() - start)"
)

FIRST_CALL = """
import time; start = time.perf_counter()
import poekin as pk, numpy as np
arm = pk.load("panda").chain(tip="panda_hand")
imported = time.perf_counter() - start
T, J = arm.fk_jacobian(np.zeros(arm.dof), frame="hybrid")
print(imported, time.perf_counter() - start)
"""


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    with tempfile.TemporaryDirectory() as place:
        environment = {"POEKIN_CACHE_DIR": place}
        first = run(FIRST_CALL, environment)
        say("first call ever")
        second = run(FIRST_CALL, environment)
        imports = [float(run(IMPORT, environment).out) for _ in range(3 if quick else 12)]
        say("imports")
    for outcome in (first, second):
        if outcome.code:
            raise RuntimeError(outcome.err)
    time_of_import = spread(imports[1:])  # the first one warms the disk
    loaded, called = map(float, first.out.split())
    loaded_again, called_again = map(float, second.out.split())
    said = first.err.strip().splitlines()
    return Topic(
        "Import and first call",
        "Each in a new process. The first call ever starts with an empty cache of kernels and includes the import and "
        "the loading of the Panda's URDF; the second process finds the kernels that the first one left.",
        figures=[
            Figure(
                "import poekin in a fresh process, warm", time_of_import.median, 0.35, "s",
                spread=(time_of_import.lower, time_of_import.upper),
                note=f"slowest of {len(imports) - 1}: {short(max(imports[1:]))} s",
            ),
            Figure(
                "first call ever on a machine (it compiles, and says so)", called, 10.0, "s",
                holds=called <= 10 and bool(said), note=f"it says: {said[0]}" if said else "it says nothing",
            ),
        ],
        tables=[
            Table(
                "From the start of the process (interpreter not counted)",
                ("process", "imported and URDF loaded (s)", "first pose and Jacobian there (s)"),
                [("first ever", loaded, called), ("second", loaded_again, called_again)],
            )
        ],
    )  # fmt: skip
