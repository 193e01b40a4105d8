"""Park's table by counting: the three Jacobian algorithms run on scalars that count their operations."""

from __future__ import annotations

import numpy as np

from poekin import Chain, count, se3
from poekin.formulas import dh_recursive, direct, recursive

from ..draw import lines
from ..report import Figure, Table, Topic

JOINTS = range(2, 13)

# The table as printed: multiplications and additions (a n - b).
PRINTED = {
    "direct": ((60, 96), (45, 72)),
    "recursive": ((42, 78), (30, 57)),
    "dh_recursive": ((42, 0), (30, 0)),
}
NAMES = {"direct": "POE, direct", "recursive": "POE, recursive", "dh_recursive": "DH, recursive"}


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    rng = np.random.default_rng(0)
    arms = {n: _arm(rng, n) for n in JOINTS}
    counted = {m: [count(arms[n][0], method=m) for n in JOINTS] for m in PRINTED}
    rows, wrong, cells = [], 0, 0
    for i, n in enumerate(JOINTS):
        row: list[int | str] = [n]
        for method, formulas in PRINTED.items():
            found = counted[method][i]
            for value, (a, b) in zip((found.multiplications, found.additions), formulas, strict=True):
                cells += 1
                wrong += value != a * n - b
                row.append(value if value == a * n - b else f"{value} (printed {a * n - b})")
        rows.append(row)
    error = max(_disagreement(rng, *arm) for arm in arms.values())
    say(f"{cells} counts")
    heads = [f"{NAMES[m]}: {what}" for m in PRINTED for what in ("×", "+")]
    return Topic(
        "Operation counts: Park's table by counting",
        "Each algorithm runs once on scalars that count multiplications and additions; making the links' poses (sines, "
        f"cosines, exponentials) is not charged, as in the paper. Printed there: {_printed()}. The same functions on "
        "floats give the same Jacobian of random DH arms.\n\n"
        "The gap to DH is bookkeeping at the two ends of the chain, not the formula: where neither the first link nor "
        "the last is charged, the recursion on modified DH frames is the POE recursion, and costs the same. The "
        "constant tool that z-aligned frames need in practice is counted in the last two columns.",
        figures=[
            Figure(
                "the paper's table by counting, n = 2 … 12", wrong, 0,
                shown="exact" if not wrong else f"{wrong} of {cells} counts differ", bar_shown="exact",
                error=f"{error:.1e}", note="the error is the largest difference between the three algorithms' J, ÷ R",
            )
        ],
        tables=[
            Table(
                "Counted multiplications (×) and additions (+) of one body Jacobian",
                ("n", *heads, "POE, recursive, with tool: ×", "+"),
                [
                    (*row, *_with_tool(arms[n][0]))
                    for n, row in zip(JOINTS, rows, strict=True)
                ],
            )
        ],
        pictures=[
            lines(
                "Multiplications of one Jacobian, counted",
                list(JOINTS),
                {NAMES[m]: [c.multiplications for c in counted[m]] for m in PRINTED},
                x_label="number of joints n",
                y_label="multiplications",
            )
        ],
    )  # fmt: skip


def _printed() -> str:
    """The paper's table in words."""
    texts = []
    for method, formulas in PRINTED.items():
        mult, add = (f"{a}n" + (f" − {b}" if b else "") for a, b in formulas)
        texts.append(f"{NAMES[method]} {mult} multiplications and {add} additions")
    return "; ".join(texts)


def _with_tool(arm: Chain) -> tuple[int, int]:
    found = count(arm, method="recursive_with_tool")
    return found.multiplications, found.additions


def _arm(rng: np.random.Generator, n: int) -> tuple[Chain, np.ndarray]:
    """A random revolute arm in standard DH form: the same arm as a POE chain, and its rows (d, a, alpha)."""
    table = rng.uniform(-1, 1, (n, 3))
    z = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    T, screws = np.eye(4), []
    for row in table:
        screws.append(se3.adjoint(T) @ z)
        T = T @ _link(0.0, *row)
    return Chain(screws, T), table


def _link(theta: float, d: float, a: float, alpha: float) -> np.ndarray:
    """Paul's A = Rz(theta) Tz(d) Tx(a) Rx(alpha)."""
    return se3.exp([0, 0, theta, 0, 0, d]) @ se3.exp([alpha, 0, 0, a, 0, 0])


def _disagreement(rng: np.random.Generator, arm: Chain, table: np.ndarray) -> float:
    """Largest difference ÷ R between the body Jacobians of the counted algorithms, run on floats at a random q."""
    n = arm.dof
    q = rng.uniform(-np.pi, np.pi, n)
    ones, zeros, unit = [1.0] * n, [0.0] * n, _twelve(np.eye(4))
    by_dh, by_direct, by_recursion = ([[0.0] * n for _ in range(6)] for _ in range(3))
    links = [_twelve(_link(x, *row)) for x, row in zip(q, table, strict=True)]
    dh_recursive.body(links, unit, ones, zeros, n, by_dh)
    B = arm.body.screws
    direct.body(B.tolist(), [_twelve(se3.exp(b * x)) for b, x in zip(B, q, strict=True)], n, by_direct)
    frames = [M @ se3.exp([0, 0, x, 0, 0, 0]) for M, x in zip(arm.local.frames[:-1], q, strict=True)]
    recursive.body_with_tool([_twelve(T) for T in frames], _twelve(arm.local.frames[-1]), ones, zeros, n, by_recursion)
    J = arm.jacobian(q, "body")
    return max(float(np.abs(np.array(found) - J).max()) for found in (by_dh, by_direct, by_recursion)) / arm.reach


def _twelve(T: np.ndarray) -> list[float]:
    return [*T[:3, :3].ravel().tolist(), *T[:3, 3].tolist()]
