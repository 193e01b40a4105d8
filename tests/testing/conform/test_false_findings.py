"""Who computes in 60 digits is never blamed: every law is graded exact. The report does the same
with 10⁵ examples.
"""

from __future__ import annotations

import pytest

from benchmarks.subjects import Angular, Linear, Poekin
from poekin.testing.conform import LAWS, Grade, Subject, applicable
from poekin.testing.conform.search import worst

SUBJECTS = {
    "angular first": Subject(Angular),
    "linear first": Subject(Linear),
    "poekin": Subject(Poekin),
}
PAIRS = [
    (name, law) for name, subject in SUBJECTS.items() for law in LAWS if law in applicable(subject)
]


@pytest.mark.parametrize(("name", "law"), PAIRS, ids=lambda x: getattr(x, "name", x))
def test_a_subject_without_fault_is_exact(name, law):
    found = worst(law, SUBJECTS[name], examples=6, seconds=60.0)
    assert found.examples > 1
    assert found.verdict.grade is Grade.EXACT, found


@pytest.mark.parametrize("law", applicable(SUBJECTS["poekin"]), ids=lambda law: law.name)
def test_the_two_oracles_agree_on_what_the_law_is_tried_on_and_it_runs_as_it_is_shown(law, capsys):
    subject = SUBJECTS["poekin"]
    found = worst(law, subject, examples=1, seconds=60.0)
    assert law.confirm(subject, found.case)
    shown = law.show(subject, found.case)
    assert shown.words
    assert "benchmarks.subjects.own import Poekin" in shown.paste
    exec(shown.paste, {})
    assert capsys.readouterr().out.strip()
