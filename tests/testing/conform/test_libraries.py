"""The libraries as subjects: at an ordinary case each computes what its adapter says: no convention
is blamed.
"""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks import peers, subjects
from benchmarks.cases import conformance
from benchmarks.page import html
from benchmarks.report import Topic
from benchmarks.subjects import FAULTS, LIBRARIES, Poekin, held
from benchmarks.subjects.__main__ import main
from poekin.testing.conform import LAWS, Case, Grade, Subject, applicable, conform
from poekin.testing.conform.laws.small_urdf import UrdfJoint, chain
from poekin.testing.conform.subjects.subject import SO3
from tests.versions import needs

XI = np.array([0.7, -0.5, 0.8, 0.3, -0.2, 0.6])
ARM = Case(
    np.array([0, 0, 1, 0.3, 0.1, 0, 0.5, 0, 0, 1, 0, 0, 0, 0, 0.2, 0, *XI]),
    ("revolute", "prismatic"),
)
ROW = [0, 0, 1, 0.3, 0.1, 0.2, 0, 0, math.pi / 2, 0, 0, 0.5]
URDF = Case(
    np.array([*ROW, *ROW]), chain((UrdfJoint("revolute", "j0"), UrdfJoint("prismatic", "j1")))
)
# The versions that the report measures, where tests are run with older ones.
MEASURED = {"scipy": [("scipy", "1.16")], "pinocchio": [("pin", "4")]}
NAMES = [(name, kind) for name, kinds in LIBRARIES.items() for kind in kinds]


def ordinary(law):
    """A case in the middle of the law's range, without what the law is about where that is one
    thing of a URDF.
    """
    if law.needs in SO3:
        return Case(XI[:3])
    return {"fk": ARM, "jacobian": ARM, "read_urdf": URDF, "read_robot": URDF}.get(
        law.needs, Case(XI)
    )


@pytest.mark.parametrize(("name", "kind"), NAMES, ids=lambda x: getattr(x, "__name__", x))
def test_a_library_computes_what_its_adapter_says_at_an_ordinary_case(name, kind):
    (found,) = peers.find([(peers.STANDARD | peers.OPTIONAL)[name]])
    if found.problem:
        pytest.skip(f"{name} is {found.problem}")
    for package, least in MEASURED.get(name, ()):
        needs(package, least)
    subject = Subject(kind)
    assert subject.version not in ("", "absent")
    laws = applicable(subject)
    assert laws
    for law in laws:
        verdict = law.check(subject, ordinary(law))
        assert verdict.grade <= Grade.GOOD, (law.name, verdict)


def test_every_peer_is_a_subject_unless_it_has_nothing_of_one():
    assert set(peers.STANDARD) <= set(LIBRARIES)


def test_the_page_shows_grades_counterexamples_and_what_could_not_be_run():
    peers.use(["standard"])
    reports = [
        held.held(Poekin, 2, 30.0, "poekin"),
        conform(FAULTS["d"][0], examples=60),
        "gone: broken",
    ]
    caught = [held.Caught("d", "exp = I", reports[1]["so3_exp"], 1.0)]
    figures = conformance._figures(reports, caught, 7, 0, 0)
    assert [figure.verdict for figure in figures] == [True, True, True]
    assert figures[0].text == "1 of 1"
    assert f"{len(LAWS)} laws" in figures[2].note
    late = conformance._figures(reports, [caught[0]._replace(seconds=61.0)], 7, 1, 2)
    assert [figure.verdict for figure in late] == [False, False, True]
    tables = conformance._tables(reports, caught)
    assert "gone: broken" in tables[0].caption
    assert len(tables[1].rows) == 1
    about = {"when": "now", "commit": "c", "processor": "p", "cores": 2, "load": 0.0, "system": "s", "python": "3",
             "versions": {}}  # fmt: skip
    page = html([Topic("Who holds which law", conformance.WORDS, figures, tables)], about, 1.0)
    assert "ExpOfNothing().so3_exp" in page


def test_the_false_findings_are_counted_over_so_many_examples(monkeypatch, capsys):
    laws = [law for law in LAWS if law.name in ("so3_exp", "fk")]
    monkeypatch.setattr(held, "applicable", lambda subject: laws)
    said = []
    total, false, not_exact = held.false_findings(held.tries(20), said.append)
    assert total >= 20
    assert (false, not_exact) == (0, 0)
    assert len(said) == 2 * len(laws)
    assert main(["1"]) == 0
    monkeypatch.setattr(subjects, "Angular", FAULTS["d"][0])
    assert main(["200"]) == 1
    assert "poor so3_exp" in capsys.readouterr().out


def test_a_subject_that_cannot_be_made_is_said_and_ends_nothing():
    said = str(held.held(SimpleNamespace, 1, 1.0, "x"))
    assert said.startswith("x: broken: InputError")
