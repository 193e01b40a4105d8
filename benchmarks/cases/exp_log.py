"""exp and log of 100 000 twists and poses, to and from 4×4 matrices: poekin against SciPy's
RigidTransform.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from poekin import se3
from poekin.testing.oracles import exact

from ..harness import Case, Comparison, compare
from ..report import Figure, Table, Topic, short

COUNT, JUDGED = 100_000, 200


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    title = f"exp and log of {COUNT} poses"
    try:
        from scipy.spatial.transform import RigidTransform
    except ImportError:
        note = "the peer is absent: SciPy with RigidTransform (1.16 or later) is not installed"
        return Topic(
            title,
            figures=[Figure(f"{what} ÷ SciPy", None, 1 / 3, note=note) for what in ("exp", "log")],
        )
    rng = np.random.default_rng(0)
    xi = np.concatenate(
        [_directions(rng) * rng.uniform(0, np.pi, (COUNT, 1)), rng.normal(size=(COUNT, 3))], 1
    )
    T = se3.exp(xi)
    say("references to 60 digits")
    exact_exp, exact_log = _references(xi[:JUDGED], T[:JUDGED])

    def worst(exact: np.ndarray) -> Any:
        return lambda state, result: float(np.abs(result[:JUDGED] - exact).max())

    pairs = 5 if quick else 21
    pairs_of_cases = [
        ("exp", Case("poekin", lambda: xi, se3.exp, worst(exact_exp)),
         Case("SciPy", lambda: xi, lambda x: RigidTransform.from_exp_coords(x).as_matrix(), worst(exact_exp))),
        ("log", Case("poekin", lambda: T, se3.log, worst(exact_log)),
         Case("SciPy", lambda: T, lambda x: RigidTransform.from_matrix(x).as_exp_coords(), worst(exact_log))),
    ]  # fmt: skip
    figures, rows = [], []
    for what, own, peer in pairs_of_cases:
        c = compare(own, peer, pairs=pairs)
        say(f"{what}: {short(c.ratio.median)}")
        figures.append(_figure(f"{what} over an array of {COUNT} ÷ SciPy RigidTransform", c))
        rows += [
            _times(f"poekin {what}", c.first, c.first_error),
            _times(f"SciPy {what}", c.second, c.second_error),
        ]
    return Topic(
        title,
        "Angles uniform from 0 to π about random axes, translations normal with 1 m. Both go to and from 4×4 matrices. "
        "Time is the processor's, over all threads of the process, so that other processes do not disturb it. "
        f"The error is the largest entry that differs from the exact result (60 digits) over the first {JUDGED}.",
        figures=figures,
        tables=[
            Table(
                "Time of each",
                ("what", "time (ns each)", "lower quartile", "upper quartile", "error"),
                rows,
            )
        ],
    )


def _figure(what: str, c: Comparison) -> Figure:
    error = f"{short(c.first_error)} (SciPy {short(c.second_error)})"
    spread = (c.ratio.lower, c.ratio.upper)
    return Figure(what, c.ratio.median, 1 / 3, spread=spread, error=error, bar_shown="≤ 1/3")


def _times(what: str, t: Any, error: float) -> tuple[str | float, ...]:
    return (what, *(1e9 * value / COUNT for value in (t.median, t.lower, t.upper)), error)


def _references(xi: np.ndarray, T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """exp of the twists and log of the poses, to 60 digits, rounded once."""
    exps, logs = (
        [exact.rounded(f(x)) for x in some] for f, some in ((exact.exp, xi), (exact.log, T))
    )
    return np.stack(exps), np.stack(logs)


def _directions(rng: np.random.Generator) -> np.ndarray:
    x = rng.normal(size=(COUNT, 3))
    return x / np.linalg.norm(x, axis=1, keepdims=True)
