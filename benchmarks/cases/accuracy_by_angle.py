"""exp and log of SO(3) and SE(3) against angle, to what float64 can attain: poekin and each
installed peer.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from poekin import se3
from poekin.testing.oracles import exact

from ..accuracy import longdouble_oracle, worst_cases
from ..accuracy.worst_errors import REPORT_BAR
from ..draw import Panel, panels
from ..report import Figure, Picture, Table, Topic, short
from . import accuracy_peers as libraries
from .accuracy_judge import (
    FUNCTIONS,
    Band,
    Case,
    Finding,
    band_of,
    bands,
    confirmed,
    judged,
    of_pose,
    of_twist,
    other_sign,
    referenced,
    twists,
)
from .accuracy_peers import Library

Cases = Mapping[str, list[Case]]
Findings = Sequence[tuple[Library, Mapping[str, Finding]]]
Before = Mapping[str, Mapping[str, Finding]]

WORDS = (
    "The same random cases for everybody: θ from 1e-12 to π, and π − θ from 1 to 1e-15; a third of the axes along or "
    "nearly along an axis of the frame; translations of 1 cm to 100 m, whatever the angle is. To these come more at "
    "the angles where somebody is worst, and the cases in which poekin is worst among many thousands more (no peer is "
    "hunted like that). The truth has "
    "60 digits and more: of exp at the float64 twist, of log at the float64 matrix as it stands. The unit is the error "
    "that float64 cannot avoid: 1 is as good as can be expected, 1e16 is all digits lost.\n\n"
    "Each library is called as its documentation says, with its own order of twists. One that is far off at an "
    "ordinary angle is not judged. Within 8 u of π (u = 1.1e-16) both signs of a logarithm count as right; further "
    "away, the other sign is a result on the wrong side of π, and the table says so. The exact result behind each "
    "worst case was confirmed by another matrix exponential, which shares no code with the first. NaN and exceptions "
    "stand at the upper edge of the pictures and are counted in the table."
)


ASKED = "log_se3"  # the hardest of the four opens the page


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    among = bands(2 if quick else 3)
    rng = np.random.default_rng(0)
    cases = _cases(rng, among, 1 if quick else 10, 5_000 if quick else 100_000)
    say(f"{sum(map(len, cases.values()))} exact results")
    everybody = [libraries.poekin(), *libraries.peers()]
    before = _add_where_somebody_is_worst(rng, cases, everybody, 2 if quick else 25)
    say(f"{sum(map(len, cases.values()))} exact results, with more where somebody is worst")
    return report(everybody, cases, among, say, before)


def report(  # type: ignore[no-untyped-def]
    everybody: Sequence[Library], cases: Cases, among: list[Band], say, before: Before | None = None
) -> Topic:
    """Judge these libraries, the first of which is poekin, on these cases, of which some are judged
    before.
    """
    found: list[tuple[Library, Mapping[str, Finding]]] = []
    for library in everybody:
        known = (before or {}).get(library.name)
        findings = judged(library.name, library.functions, cases, known)
        found.append((library, findings))
        worst = ", ".join(
            f"{FUNCTIONS[name]} {_worst(finding)}" for name, finding in findings.items()
        )
        say(f"{library.name}: {library.problem or worst}")
    return Topic(
        "Accuracy of exp and log against angle, with peers",
        WORDS,
        figures=figures(found),
        tables=[table(found, cases), counterexamples(found, cases)],
        pictures=[picture(name, found, cases, among) for name in reversed(FUNCTIONS)],
    )


def _cases(rng: np.random.Generator, among: list[Band], count: int, sweep: int) -> Cases:
    cases = referenced(twists(rng, among, count))
    many = worst_cases.twists(rng, sweep, math.pi)
    worst = [of_twist(xi, _band(xi[:3], among)) for xi in worst_cases.of_exp(se3, many)]
    for T in worst_cases.of_log(se3, longdouble_oracle.exp(many).astype(float)):
        worst.append(of_pose(T, _band(exact.rounded(exact.log(T[:3, :3])), among)))
    for some in worst:
        for name, case in some.items():
            cases[name].append(case)
    return cases


def _add_where_somebody_is_worst(
    rng: np.random.Generator, cases: Cases, everybody: Sequence[Library], count: int
) -> Before:
    """Add count twists in each band in which the worst case of some function of somebody lies, for
    everybody; what was found before that.
    """
    before = {one.name: judged(one.name, one.functions, cases) for one in everybody}
    worst = {
        cases[name][finding.worst].band
        for findings in before.values()
        for name, finding in findings.items()
        if finding.worst is not None
    }
    for name, more in referenced(twists(rng, sorted(worst), count)).items():
        cases[name].extend(more)
    return before


def _band(w: np.ndarray, among: list[Band]) -> Band:
    return band_of(float(np.linalg.norm(w)), among) or among[-1]


def figures(found: Findings) -> list[Figure]:
    """poekin's worst ratio with its bar; the best peer's beside it, for the two groups, as
    information.
    """
    _, own = found[0]
    place = max(own.values(), key=lambda finding: finding.figure)
    rows = [
        Figure(
            "exp and log of SO(3) and SE(3): poekin's worst error ÷ attainable",
            place.figure, REPORT_BAR, note=f"{FUNCTIONS[place.function]}; {len(place.ratios)} cases of each function",
        )
    ]  # fmt: skip
    for group in ("se3", "so3"):
        names = [f"exp_{group}", f"log_{group}"]
        peers = [
            (max(findings[name].figure for name in names), library)
            for library, findings in found[1:]
            if all(name in findings and not findings[name].not_judged for name in names)
        ]
        what = f"best peer's worst error ÷ attainable, exp and log of {'SE(3)' if group == 'se3' else 'SO(3)'}"
        if not peers:
            rows.append(Figure(what, None, note="no peer is installed that has both"))
            continue
        (value, best), *others = sorted(peers, key=lambda peer: peer[0])
        note = f"{best.name} {best.version}"
        note += (
            f"; the others: {', '.join(f'{peer.name} {_number(other)}' for other, peer in others)}"
            if others
            else ""
        )
        rows.append(Figure(what, value, shown=_number(value), note=note))
    return rows


def table(found: Findings, cases: Cases) -> Table:
    """Everybody's worst ratio, where it is, and what else is to be said."""
    rows: list[Sequence[str | int | float]] = []
    for library, findings in found:
        label = f"{library.name} {library.version}".strip()
        if library.problem:
            rows.append((label, "", "", "", "", "", library.problem))
        for name, finding in findings.items():
            rows.append((label, FUNCTIONS[name], *_row(finding, cases[name])))
    return Table(
        "Worst error ÷ attainable of each, and where",
        (
            "library",
            "function",
            "worst ratio",
            "at θ (rad)",
            "π − θ (rad)",
            f"cases above {REPORT_BAR:g}",
            "remarks",
        ),
        rows,
    )


def _row(finding: Finding, cases: list[Case]) -> tuple[str | int | float, ...]:
    if finding.not_judged:
        return "", "", "", "", f"not judged: {finding.not_judged}"
    above = f"{int(np.sum(finding.ratios > REPORT_BAR))} of {len(cases)}"
    remarks = [_faults(finding, cases)] if finding.faults else []
    worst = finding.worst
    if worst is None:
        return "none finite", "", "", above, *remarks
    case = cases[worst]
    if not confirmed(case):
        return "not printed", "", "", above, "the exact result could not be confirmed"
    if finding.ratios[worst] > REPORT_BAR and other_sign(case, finding.results[worst]):
        remarks.append("ω has the other sign")
    return (
        _number(finding.ratios[worst]),
        f"{case.angle:.4g}",
        f"{case.gap:.2g}",
        above,
        "; ".join(remarks),
    )


def _faults(finding: Finding, cases: list[Case]) -> str:
    """How many results were none, with the angle of the first of each kind."""
    kinds: dict[str, list[int]] = {}
    for k, fault in finding.faults.items():
        kinds.setdefault(fault, []).append(k)
    texts = []
    for fault, places in kinds.items():
        case = cases[places[0]]
        where = f"π − {case.gap:.2g}" if case.band.before_pi else f"{case.angle:.4g}"
        texts.append(f"{fault} at θ = {where} ({len(places)} of {len(cases)})")
    return "; ".join(texts)


def counterexamples(found: Findings, cases: Cases) -> Table:
    """Of each function above the bar its worst case, as text to paste, with the entry that is
    furthest off.

    The text was run again for this: it is printed only where it gives, bit for bit, what was
    judged.
    """
    rows = []
    for library, findings in found:
        for name, finding in findings.items():
            worst = finding.worst
            if (
                worst is None
                or finding.ratios[worst] <= REPORT_BAR
                or not confirmed(cases[name][worst])
            ):
                continue
            case, result = cases[name][worst], finding.results[worst]
            again = libraries.replayed(library.name, name, case.argument)
            if again is None or not np.array_equal(again, result):
                text = f"x = np.array({case.argument.tolist()!r})"
            else:
                text = libraries.typed(library.name, name, case.argument)
            truth = exact.rounded(case.truth)
            entry = np.unravel_index(np.argmax(np.abs(result - truth)), truth.shape)
            off = f"[{', '.join(map(str, entry))}]: {float(result[entry])!r}, exact {float(truth[entry])!r}"
            rows.append((library.name, FUNCTIONS[name], _number(finding.ratios[worst]), off, text))
    return Table(
        f"Counterexamples to paste: the worst case of each that is above {REPORT_BAR:g}",
        ("library", "function", "ratio", "entry that is furthest off", "Python"),
        rows,
        folded=True,
    )


def picture(name: str, found: Findings, cases: Cases, among: list[Band]) -> Picture:
    """The worst ratio in each band of angles, then of gaps, one curve a library."""
    parts = []
    for before_pi, label in ((False, "angle θ (rad)"), (True, "π − θ (rad)")):
        here = [band for band in among if band.before_pi is before_pi]
        curves = {
            library.name: findings[name].curve(cases[name], here)
            for library, findings in found
            if name in findings and not findings[name].not_judged
        }
        parts.append(Panel(label, [band.place for band in here], curves, falling=before_pi))
    caption = f"{FUNCTIONS[name]}: worst error ÷ attainable in each band of angles; right: on the way to π"
    drawn = panels(
        caption,
        parts,
        y_label="error ÷ attainable",
        bar=REPORT_BAR,
        off_scale="above: NaN, exception",
    )
    return drawn.answering("exact") if name == ASKED else drawn


def _worst(finding: Finding) -> str:
    return "not judged" if finding.not_judged else _number(finding.figure)


def _number(value: float) -> str:
    return short(value) if math.isfinite(value) else "no finite result somewhere"
