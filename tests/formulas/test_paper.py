"""The table from the paper to its formulas, users' functions, methods and tests: every name in it
exists, and no formula file is missing.
"""

from __future__ import annotations

import math
import pkgutil
import re
from importlib import import_module
from pathlib import Path

import pytest

import poekin as pk
from poekin import formulas
from poekin.formulas import BESIDE, PAPER, Place
from poekin.formulas.inverse.pose_error import angle
from poekin.formulas.lie.coefficients import d_of
from tools import docs_paper

TESTS = Path(__file__).resolve().parents[1]
MODULES = {
    info.name.removeprefix("poekin.formulas."): info.name
    for info in pkgutil.walk_packages(formulas.__path__, "poekin.formulas.")
    if not info.ispkg
}
PARTS = [
    *(f"eq. ({k})" for k in (1, 2, 3)), *(f"Lemma {k}" for k in range(1, 6)), "Remark 1", "Remark 2",
    "Example 1", "Section III", "Section IV", "the table", "the alternative by table lookup",
]  # fmt: skip


def module_of(formula: str) -> str:
    return formula.rpartition(".")[0]


def faults(row: Place) -> list[str]:
    """Names of a row that do not exist, and a test that does not name the formula."""
    module, _, function = row.formula.rpartition(".")
    found = []
    home = import_module(MODULES.get(module, f"poekin.{module}"))
    if not callable(getattr(home, function, None)):
        found.append(row.formula)
    user = pk
    for name in filter(None, row.user.split(".")):
        user = getattr(user, name, None)
    if user is None:
        found.append(row.user)
    if row.method and not hasattr(pk.Chain, row.method):
        found.append(row.method)
    file = TESTS / row.test
    text = file.read_text(encoding="utf-8") if file.is_file() else ""
    for word in (module.rpartition(".")[2], function):
        if not re.search(rf"\b{word}\b", text):
            found.append(f"{word} in {row.test}")
    return found


@pytest.mark.parametrize("row", PAPER, ids=lambda row: row.paper)
def test_every_name_in_the_table_exists_and_the_test_names_the_formula(row):
    assert faults(row) == []


def test_nothing_of_the_paper_is_missing():
    said = " ".join(row.paper for row in PAPER)
    assert [part for part in PARTS if part not in said] == []
    assert all(row.user or row.method for row in PAPER)


def test_every_formula_file_is_in_the_table_or_said_to_be_beside_it():
    assert {module_of(row.formula) for row in PAPER} | set(BESIDE) == {*MODULES, "algebra"}
    assert {module_of(row.formula) for row in PAPER} & set(BESIDE) == set()


@pytest.mark.parametrize("module", MODULES)
def test_every_formula_file_has_a_test_of_its_name_in_the_mirrored_place(module):
    folder, _, name = module.replace(".", "/").rpartition("/")
    file = TESTS / "formulas" / folder / f"test_{name}.py"
    assert re.search(rf"\b{name}\b", file.read_text(encoding="utf-8"))


@pytest.mark.parametrize("row", PAPER, ids=lambda row: row.paper)
def test_the_formula_s_file_names_its_place_in_the_paper(row):
    module = module_of(row.formula)
    text = Path(import_module(MODULES.get(module, f"poekin.{module}")).__file__ or "").read_text(
        encoding="utf-8"
    )
    place = row.paper.split(",")[0]
    number = re.search(r"eq\. \(\d\)", row.paper)
    assert (number.group() if number else place) in " ".join(text.split())


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"formula": "lie.logarithm.so4"}, "lie.logarithm.so4"),
        ({"user": "so3.logarithm"}, "so3.logarithm"),
        ({"method": "forward"}, "forward"),
        ({"test": "formulas/lie/test_arctangent.py"}, "so3 in formulas/lie/test_arctangent.py"),
        ({"test": "formulas/lie/test_gone.py"}, "logarithm in formulas/lie/test_gone.py"),
    ],
)
def test_a_name_that_does_not_exist_is_seen(change, fault):
    row = next(row for row in PAPER if row.paper == "Lemma 3")
    assert fault in faults(row._replace(**change))


def test_the_equations_that_are_numbers_say_what_the_formulas_compute():
    said = {row.paper: row.equation for row in PAPER}
    terms = said["Lemma 4, the coefficient"].removeprefix("D = ").replace(") cot", ") * cot")
    d = eval(terms.replace("^", "**"), {"phi": 2.5, "cot": lambda x: 1 / math.tan(x)})
    assert abs(d_of(2.5**2) - d) < 1e-15
    low, high = said["Remark 2"].removeprefix("|log R| = phi, ").split(" <= phi <= ")
    assert (float(low), high) == (angle((0.0, 0.0, 0.0)), "pi")
    assert angle((0.0, 0.0, 2.0)) == math.pi


def test_the_page_has_a_row_for_each():
    lines = docs_paper.page().splitlines()
    assert len(lines) == len(PAPER) + 2
    assert all(re.split(r"(?<!\\)\|", line)[5:] == [""] for line in lines)
    assert "`pk.se3.log`" in lines[2 + [row.paper for row in PAPER].index("Lemma 4")]
