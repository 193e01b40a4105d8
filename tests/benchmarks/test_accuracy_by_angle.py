"""The judgement of exp and log against angle: what is planted is found, who is sound is not blamed."""

from __future__ import annotations

import ast
import contextlib
import io
import math
from pathlib import Path

import numpy as np
import pytest

import poekin
from benchmarks.cases import accuracy_by_angle, accuracy_judge, accuracy_peers
from benchmarks.cases.accuracy_judge import (
    FUNCTIONS,
    Band,
    Case,
    bands,
    confirmed,
    judged,
    other_sign,
    ratio,
    referenced,
)
from benchmarks.cases.accuracy_peers import Library
from benchmarks.peers import OPTIONAL, STANDARD, Found, Peer, find
from poekin.testing.accuracy import error_bounds
from poekin.testing.oracles import exact

AMONG = [*bands(1)[::3], Band(1e-4, 1e-3, False), Band(1e-16, 5e-16, True)]
CASES = referenced(accuracy_judge.twists(np.random.default_rng(7), AMONG, 2))
SOUND = {
    "exp_so3": lambda x: exact.rounded(exact.exp(x)),
    "exp_se3": lambda x: exact.rounded(exact.exp(x)),
    "log_so3": lambda x: exact.rounded(exact.log(x)),
    "log_se3": lambda x: exact.rounded(exact.log(x)),
}
WITH_GROUPS = [peer for peer in (STANDARD | OPTIONAL).values() if peer.group]


@pytest.fixture
def unpictured(monkeypatch):
    """Reports without their pictures, which take most of the time."""
    monkeypatch.setattr(accuracy_by_angle, "picture", lambda *_: None)


def nothing(_: str) -> None:
    pass


def angle_of(xi: np.ndarray) -> float:
    return float(np.linalg.norm(xi[:3]))


def only(function: str, replacement, cases=CASES):  # type: ignore[no-untyped-def]
    return judged("fake", SOUND | {function: replacement}, cases)[function]


@pytest.mark.parametrize("function", FUNCTIONS)
def test_the_exact_result_rounded_once_is_within_what_float64_can_attain(function):
    finding = judged("sound", SOUND, CASES)[function]
    assert finding.figure <= 1
    assert not finding.faults
    assert not finding.not_judged


@pytest.mark.parametrize("size", [1e-13, 1e-10, 1e-3])
def test_an_error_planted_at_some_angles_is_found_there_with_its_size(size):
    def planted(xi):
        T = SOUND["exp_se3"](xi)
        T[0, 3] += size * (1e-4 <= angle_of(xi) <= 1e-3)
        return T

    finding = only("exp_se3", planted)
    assert finding.worst is not None
    worst = CASES["exp_se3"][finding.worst]
    assert 1e-4 <= worst.angle <= 1e-3
    # The rounding of the sound result adds at most one unit; the entry itself rounds to its own
    # spacing.
    spacing = np.spacing(abs(float(worst.truth[0, 3])))
    assert finding.figure == pytest.approx(
        size / float(worst.bound.linear), abs=1 + spacing / float(worst.bound.linear)
    )
    elsewhere = [
        r
        for r, case in zip(finding.ratios, CASES["exp_se3"], strict=True)
        if not 1e-4 <= case.angle <= 1e-3
    ]
    assert max(elsewhere) <= 1


def test_a_logarithm_that_is_lost_on_the_way_to_pi_is_found_at_its_gap():
    def acos_of_trace(R):
        theta = math.acos(min(1.0, max(-1.0, (np.trace(R) - 1) / 2)))
        w = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
        return w * (theta / 2 / math.sin(theta)) if math.sin(theta) else 0 * w

    finding = only("log_so3", acos_of_trace)
    assert finding.figure > 1e10
    curve = finding.curve(CASES["log_so3"], AMONG)
    by_gap = {band.place: y for band, y in zip(AMONG, curve, strict=True) if band.before_pi}
    assert max(y for gap, y in by_gap.items() if gap < 1e-6) > 1e6
    assert max(y for gap, y in by_gap.items() if gap > 1e-1) < 1e4


@pytest.mark.usefixtures("unpictured")
@pytest.mark.parametrize(
    ("result", "fault"),
    [
        (lambda x: 1 / 0, "ZeroDivisionError: division by zero"),
        (lambda x: np.full((4, 4), np.nan), "NaN"),
        (lambda x: np.full((4, 4), np.inf), "infinite"),
        (lambda x: np.eye(3), "shape (3, 3)"),
    ],
    ids=["raises", "NaN", "infinite", "shape"],
)
def test_a_peer_that_has_no_result_is_named_with_its_angle_and_the_run_goes_on(result, fault):
    def sometimes(xi):
        return result(xi) if 1e-4 <= angle_of(xi) <= 1e-3 else SOUND["exp_se3"](xi)

    finding = only("exp_se3", sometimes)
    assert set(finding.faults.values()) == {fault}
    assert finding.figure == math.inf
    assert finding.worst is not None
    assert finding.ratios[finding.worst] <= 1
    library = Library("fake", "1", SOUND | {"exp_se3": sometimes})
    topic = accuracy_by_angle.report([accuracy_peers.poekin(), library], CASES, AMONG, nothing)
    (row,) = [row for row in topic.tables[0].rows if row[:2] == ("fake 1", "exp SE(3)")]
    first = CASES["exp_se3"][min(finding.faults)]
    assert (
        row[-1]
        == f"{fault} at θ = {first.angle:.4g} ({len(finding.faults)} of {len(CASES['exp_se3'])})"
    )


def test_who_has_another_order_of_twists_is_not_judged():
    finding = only("exp_se3", lambda xi: SOUND["exp_se3"](np.roll(xi, 3)))
    assert finding.not_judged.startswith(
        "another convention than its adapter says, at the ordinary angle 1.17 rad"
    )


def test_who_raises_at_an_ordinary_angle_is_reported_and_not_judged():
    assert only("exp_se3", lambda xi: {}["gone"]).not_judged.startswith(
        "KeyError: 'gone', at the ordinary angle"
    )


def test_a_peer_that_changes_its_argument_does_not_spoil_the_next_one():
    def spoils(xi):
        T = SOUND["exp_se3"](xi)
        xi[:] = 7.0
        return T

    assert only("exp_se3", spoils).figure <= 1
    assert not any(np.all(case.argument == 7.0) for case in CASES["exp_se3"])


def near_pi(gap: float) -> Case:
    n = np.array([2.0, -1.0, 2.0]) / 3
    xi = np.concatenate([(math.pi - gap) * n, [0.3, 0.1, -0.5]])
    return accuracy_judge.of_pose(exact.rounded(exact.exp(xi)), Band(1e-16, 1.0, True))["log_se3"]


def test_both_signs_are_right_within_eight_u_of_pi_and_not_further_away():
    case = near_pi(0.0)
    assert case.gap < error_bounds.BOTH_SIGNS
    w = -case.truth[:3]
    v = exact.left_jacobian_inverse(w) @ exact.exactly(case.argument[:3, 3])
    assert ratio(case, exact.rounded(np.concatenate([w, v]))) <= 1
    case = near_pi(1e-12)
    assert ratio(case, exact.rounded(-case.truth)) > 1e12
    assert other_sign(case, exact.rounded(-case.truth))
    assert not other_sign(case, exact.rounded(case.truth))


@pytest.mark.parametrize("function", FUNCTIONS)
def test_a_reference_is_confirmed_and_a_wrong_one_is_not(function):
    for case in CASES[function][::7]:
        assert confirmed(case)
        wrong = case.truth.copy()
        wrong[(0,) * wrong.ndim] += exact.mp.mpf(10) ** -30
        assert not confirmed(case._replace(truth=wrong))


@pytest.mark.usefixtures("unpictured")
def test_a_finding_whose_reference_is_in_doubt_is_not_printed(monkeypatch):
    monkeypatch.setattr(accuracy_by_angle, "confirmed", lambda case: False)
    library = Library("fake", "1", SOUND | {"exp_so3": lambda x: SOUND["exp_so3"](x) + 1e-11})
    topic = accuracy_by_angle.report([accuracy_peers.poekin(), library], CASES, AMONG, nothing)
    assert {row[2] for row in topic.tables[0].rows} == {"not printed"}
    assert topic.tables[1].rows == []


def test_the_report_has_the_bar_the_best_peer_and_the_absent_one():
    worse = Library(
        "worse",
        "2",
        SOUND | {"exp_se3": lambda x: SOUND["exp_se3"](x) * (1 + 1e-13 * (np.eye(4) == 0))},
    )
    absent = Library("gone", "absent", problem="absent: not installed")
    some = [accuracy_peers.poekin(), worse, absent, Library("best", "1", SOUND)]
    topic = accuracy_by_angle.report(some, CASES, AMONG, nothing)
    own, pose, rotation = topic.figures
    assert own.bar == 1.5
    assert own.verdict
    assert pose.verdict is None
    assert pose.note.startswith("best 1; the others: worse ")
    for figure in (pose, rotation):
        assert figure.value is not None
        assert figure.value <= 1
    assert ("gone absent", "", "", "", "", "", "absent: not installed") in topic.tables[0].rows
    assert len(topic.pictures) == len(FUNCTIONS)


@pytest.mark.usefixtures("unpictured")
def test_without_a_peer_the_report_says_so():
    topic = accuracy_by_angle.report([accuracy_peers.poekin()], CASES, AMONG, nothing)
    assert [f.note for f in topic.figures[1:]] == ["no peer is installed that has both"] * 2


def test_a_broken_peer_is_a_row_and_not_the_end():
    def broken():
        raise OSError("no shared object")

    (library,) = accuracy_peers.peers([Found(Peer("fake", "numpy", "numpy", group=broken))])
    assert library.problem == "broken: OSError: no shared object"


@pytest.mark.parametrize("peer", WITH_GROUPS, ids=lambda peer: peer.name)
def test_the_text_to_paste_gives_what_the_adapter_gives(peer):
    (found,) = find([peer])
    if found.problem:
        pytest.skip(f"{peer.name} is {found.problem}")
    (library,) = accuracy_peers.peers([found])
    for name, function in library.functions.items():
        for case in CASES[name][::5]:
            expected = np.asarray(function(case.argument.copy()))
            np.testing.assert_array_equal(
                accuracy_peers.replayed(library.name, name, case.argument), expected
            )


def test_the_text_to_paste_runs_by_itself_and_prints_all_digits():
    case = CASES["exp_so3"][3]
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(accuracy_peers.typed("poekin", "exp_so3", case.argument), {})
    assert out.getvalue() == f"{poekin.so3.exp(case.argument).tolist()}\n"


def test_the_cases_reach_from_1e_12_to_pi_and_to_1e_15_before_it():
    cases = referenced(accuracy_judge.twists(np.random.default_rng(0), bands(1), 1))["exp_so3"]
    angles = [case.angle for case in cases]
    gaps = [case.gap for case in cases if case.band.before_pi]
    assert min(angles) < 1e-11
    assert min(gaps) < 2e-14
    assert not any(math.isnan(y) for y in judged("sound", SOUND, {"exp_so3": cases} | {
        name: CASES[name] for name in FUNCTIONS if name != "exp_so3"})["exp_so3"].curve(cases, bands(1)))  # fmt: skip


def test_the_oracle_shares_no_code_with_what_is_judged():
    testing = Path(exact.__file__).parents[1]
    for file, allowed in {
        testing / "oracles" / "exact.py": {"poekin.errors"},
        testing / "oracles" / "exact_jacobians.py": set(),
        testing / "oracles" / "exact_numbers.py": {"poekin.errors"},
        testing / "accuracy" / "error_bounds.py": {"oracles", "oracles.exact"},
        testing / "conform" / "confirm.py": {"oracles"},
        Path(accuracy_judge.__file__): {
            "poekin.testing.accuracy",
            "poekin.testing.conform",
            "poekin.testing.oracles",
        },
    }.items():
        tree = list(ast.walk(ast.parse(file.read_text(encoding="utf-8"))))
        imported = {
            node.module or node.names[0].name for node in tree if isinstance(node, ast.ImportFrom)
        }
        imported |= {
            alias.name for node in tree if isinstance(node, ast.Import) for alias in node.names
        }
        imported = {
            name
            for name in imported
            if name.partition(".")[0] in ("poekin", "oracles", "accuracy_peers")
        }
        assert imported <= allowed, file.name


def test_a_finding_goes_on_with_the_cases_that_it_does_not_have():
    called = []

    def exp(w):
        called.append(w)
        return SOUND["exp_so3"](w) * (np.nan if len(called) % 3 == 0 else 1 + 1e-15)

    whole = judged("fake", {"exp_so3": exp}, CASES)["exp_so3"]
    called.clear()
    half = len(CASES["exp_so3"]) // 2
    first = {"exp_so3": CASES["exp_so3"][:half]}
    before = judged("fake", {"exp_so3": exp}, first)
    found = judged("fake", {"exp_so3": exp}, CASES, before)["exp_so3"]
    # the ordinary twist, and each case once
    assert len(called) == 1 + len(CASES["exp_so3"])
    np.testing.assert_array_equal(found.ratios, whole.ratios)
    np.testing.assert_array_equal(found.results, whole.results)
    assert found.faults == whole.faults
    assert {k < half for k in found.faults} == {True, False}


def test_more_cases_are_added_at_the_angles_where_somebody_is_worst():
    cases = {name: list(some) for name, some in CASES.items()}
    library = Library(
        "fake",
        "1",
        {"exp_so3": lambda x: SOUND["exp_so3"](x) + 1e-9 * (1e-4 <= angle_of(x) <= 1e-3)},
    )
    accuracy_by_angle._add_where_somebody_is_worst(np.random.default_rng(0), cases, [library], 3)
    for name, some in cases.items():
        added = some[len(CASES[name]) :]
        assert len(added) == 3
        assert all(1e-4 <= case.angle <= 1e-3 for case in added)
