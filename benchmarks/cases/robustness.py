"""Right results and no error when the source was edited, the cache was damaged, or nothing can be
written.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

from ..fresh import ROOT, Outcome, run
from ..report import Figure, Table, Topic

# A pose, a Jacobian, exp and log, of which the cache keeps a kernel each: all are kept alike, and
# each process compiles its own. Prints the sum of all.
CALL = """
import poekin as pk, numpy as np
arm = pk.load("panda").chain(tip="panda_hand")
q = np.linspace(-1, 1, arm.dof)
values = [arm.fk(q), arm.jacobian(q, "body")]
values += [pk.se3.exp(np.arange(6.0) / 5), pk.se3.log(arm.fk(q))]
print(repr(float(sum(np.sum(v) for v in values))))
"""

# An edit that every pose passes through, and that leaves screws screws: a product's translation
# comes out doubled.
EDIT = """

_compose_before = compose


def compose(T_ab, T_bc):
    T = _compose_before(T_ab, T_bc)
    return (*T[:9], 2.0 * T[9], 2.0 * T[10], 2.0 * T[11])
"""

Check = tuple[str, bool, str]


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(2) as pool:
        base = Path(name)
        without = pool.submit(run, CALL, {"POEKIN_CACHE_DIR": ""})
        filled = run(CALL, {"POEKIN_CACHE_DIR": str(base / "whole")})
        right = _value(without.result())
        say("a cache to edit and damage")
        checks = [("without a cache", right is not None, _said(without.result()))]
        checks.append(("cache filled", _value(filled) == right, _said(filled)))
        for part in [pool.submit(f, base, right) for f in (_edit, *_damages(), *_nowhere(base))]:
            checks += part.result()
            say(checks[-1][0])
    failed = [what for what, good, _ in checks if not good]
    return Topic(
        "Edited source, damaged cache, nowhere to write",
        "Each line is a fresh process that calls the compiled kernels in such a place. Its results must equal those "
        "without any cache, bit for bit (or change with the edit), and it must end without an error.",
        figures=[
            Figure(
                "an edit in algebra.py, every cache file truncated or flipped, a read-only home",
                len(failed), 0, shown=f"{len(checks) - len(failed)} of {len(checks)} right", bar_shown="all right",
                note="; ".join(failed),
            )
        ],
        tables=[Table("What was tried", ("what", "", "what the process said"), [_row(*check) for check in checks])],
    )  # fmt: skip


def _row(what: str, good: bool, said: str) -> tuple[str, str, str]:
    return what, "right" if good else "WRONG", said


def _edit(base: Path, right: float | None) -> list[Check]:
    """A copy of the package is edited, where the cache holds its old kernels, and then the edit is
    taken back.
    """
    home, environment = base / "copy", {"POEKIN_CACHE_DIR": str(base / "whole")}
    shutil.copytree(ROOT / "poekin", home / "poekin", ignore=shutil.ignore_patterns("__pycache__"))
    algebra = home / "poekin" / "algebra.py"
    text = algebra.read_text(encoding="utf-8")
    algebra.write_text(text + EDIT, encoding="utf-8")
    expected = _value(run(CALL, {"POEKIN_CACHE_DIR": ""}, package_home=home))
    edited = run(CALL, environment, package_home=home)
    algebra.write_text(text, encoding="utf-8")
    after = run(CALL, environment, package_home=home)
    changed = expected is not None and expected != right and _value(edited) == expected
    return [
        ("algebra.py edited: the new formula runs", changed, _said(edited)),
        ("the edit taken back: the old formula runs", _value(after) == right, _said(after)),
    ]


def _damages() -> list[Callable[[Path, float | None], list[Check]]]:
    """One check for each way to damage every file of a cache; the byte that flips is elsewhere in
    each file.
    """

    def truncated(content: bytes, number: int) -> bytes:
        return content[: len(content) // 2]

    def flipped(content: bytes, number: int) -> bytes:
        at = (0, len(content) // 2, len(content) - 1, 40)[number % 4]
        return content[:at] + bytes([content[at] ^ 255]) + content[at + 1 :]

    def check(
        damage: Callable[[bytes, int], bytes], base: Path, right: float | None
    ) -> list[Check]:
        cache = base / damage.__name__
        shutil.copytree(base / "whole", cache)
        files = sorted(path for path in cache.rglob("*") if path.is_file())
        for number, path in enumerate(files):
            path.write_bytes(damage(path.read_bytes(), number))
        outcome = run(CALL, {"POEKIN_CACHE_DIR": str(cache)})
        good = bool(files) and _value(outcome) == right
        return [(f"every one of {len(files)} cache files {damage.__name__}", good, _said(outcome))]

    return [partial(check, damage) for damage in (truncated, flipped)]


def _nowhere(base: Path) -> list[Callable[[Path, float | None], list[Check]]]:
    """Homes that cannot be written to. Root may write to any directory, but neither into a file nor
    to /proc.
    """
    file, closed = base / "file", base / "closed"
    file.write_text("not a directory", encoding="utf-8")
    closed.mkdir(mode=0o555)
    places = {"home in a file": file}
    if not hasattr(os, "geteuid") or os.geteuid() != 0:
        places["read-only home"] = closed
    elif Path("/proc/self").exists():
        places["read-only home (/proc)"] = Path("/proc/self")

    def check(what: str, home: Path, base: Path, right: float | None) -> list[Check]:
        nowhere = {
            "HOME": str(home),
            "LOCALAPPDATA": str(home),
            "XDG_CACHE_HOME": None,
            "POEKIN_CACHE_DIR": None,
        }
        outcome = run(CALL, nowhere)
        return [(what, right is not None and _value(outcome) == right, _said(outcome))]

    return [partial(check, what, home) for what, home in places.items()]


def _value(outcome: Outcome) -> float | None:
    """The result that a process printed, or None where it ended with an error."""
    return float(outcome.out) if outcome.code == 0 and outcome.out.strip() else None


def _said(outcome: Outcome) -> str:
    lines = outcome.err.strip().splitlines()
    return "" if not lines else lines[-1] if outcome.code else lines[0]
