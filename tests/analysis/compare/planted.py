"""Differences planted into an arm, of every kind, and whether a comparison names them and nothing
else.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from benchmarks.planted_changes import planted
from poekin.analysis.compare.comparison import Comparison, Outcome
from poekin.analysis.compare.length_unit import rescaled
from poekin.groups import se3
from poekin.model.chain import Chain

KINDS = (
    "zero",
    "direction",
    "tool",
    "base",
    "limit",
    "tilt",
    "shift",
    "link length",
    "mm file",
)
SEVERE = {"limit", "tilt", "shift", "link length", "mm file"}


class Case(NamedTuple):
    """An arm with differences planted, and what they are: (kind, number of the joint or 0)."""

    chain: Chain
    planted: tuple[tuple[str, int], ...]

    @property
    def outcome(self) -> Outcome:
        """What a comparison with the arm as it was has to come to."""
        if any(kind in SEVERE for kind, _ in self.planted):
            return "differ"
        return "conventions"


def with_limits(chain: Chain) -> Chain:
    """The arm with limits of two radians about 0 wherever it states none."""
    limits = np.where(np.isfinite(chain.limits), chain.limits, [-2.0, 2.0])
    return chain.replace(limits=limits)


def plant(case: Case, kind: str, k: int, rng: np.random.Generator) -> Case:
    """One more difference, in joint k + 1 or between it and the next one."""
    chain = case.chain
    number = k + 1
    way = rng.normal(size=3)
    way /= np.linalg.norm(way)
    if kind == "zero":
        # A file's author turns a link: the limits' numbers stay.
        turned = np.where(np.arange(chain.dof) == k, np.radians(5.0), 0.0)
        made = chain.rezeroed(turned).replace(limits=chain.limits)
    elif kind in ("tilt", "shift"):
        made = planted(chain, kind, k, rng)
    elif kind == "direction":
        made = planted(chain, "flip", k, rng)
    elif kind == "tool":
        number = 0
        made = chain.retooled(se3.exp([*np.zeros(3), *(0.003 * way)]))
    elif kind == "base":
        number = 0
        made = chain.rebased(se3.exp([*(0.3 * way), *(0.1 * rng.normal(size=3))]))
    elif kind == "limit":
        limits = chain.limits.copy()
        limits[k, 1] -= np.radians(10)
        made = chain.replace(limits=limits)
    elif kind == "link length":
        made = _longer(chain, k, way)
    else:
        number = 0
        made = rescaled(chain, 1000.0)
    return Case(made, (*case.planted, (kind, number)))


def _longer(chain: Chain, k: int, way: np.ndarray) -> Chain:
    """The arm with everything behind joint k + 1 moved by 5 mm, across its axis."""
    w = chain.screws[k, :3]
    across = np.cross(w, way)
    across *= 0.005 / np.linalg.norm(across)
    T = se3.exp([*np.zeros(3), *across])
    screws = chain.screws.copy()
    screws[k + 1 :] = screws[k + 1 :] @ se3.adjoint(T).T
    return chain.replace(screws=screws, home=T @ chain.home)


def is_named(result: Comparison, kind: str, number: int) -> bool:
    """Whether a comparison names a planted difference."""
    joint = result.joints[number - 1] if result.joints else None
    at = f"joint {number} ("
    said = [text for text in result.findings if text.startswith(at)]
    text = " ".join(said)
    if joint is None:
        return False
    assert joint.effect is not None
    named: dict[str, Callable[[], bool]] = {
        "zero": lambda: joint.zero_differs and "has its zero 5" in text,
        "direction": lambda: joint.reversed and "sign of q flipped" in text,
        "tool": lambda: any("the tool frame is moved by 3 mm" in t for t in result.findings),
        "base": lambda: any("the base frame is moved by" in t for t in result.findings),
        "limit": lambda: "its upper limit 10° lower in model b" in text,
        "tilt": lambda: (
            joint.axis_differs and math.isclose(joint.angle, np.radians(0.1), rel_tol=0.05)
        ),
        "shift": lambda: (
            joint.axis_differs and math.isclose(joint.shift or 0.0, 1e-3, rel_tol=0.05)
        ),
        "link length": lambda: any(
            f"the link between joint {number} (" in text for text in result.findings
        ),
        "mm file": lambda: result.mistake == "millimetres",
    }
    return named[kind]()


def blamed_wrongly(result: Comparison, case: Case) -> list[int]:
    """Numbers of joints that differ in no way that was planted but are said to."""
    right = {number for _, number in case.planted}
    for kind, number in case.planted:
        if kind == "link length":
            right |= set(range(number + 1, len(result.joints) + 1))
    return [joint.number for joint in result.differing if joint.number not in right]


def fault(result: Comparison, case: Case) -> str:
    """What is wrong with a comparison of the arm with the one that was changed, or empty."""
    if result.outcome != case.outcome:
        return f"outcome {result.outcome}: {result.verdict}"
    for kind, number in case.planted:
        if not is_named(result, kind, number):
            return f"{kind} of joint {number} not named: {result.verdict}"
    wrong = blamed_wrongly(result, case)
    if wrong:
        return f"blames {wrong}: {result.verdict}"
    return ""
