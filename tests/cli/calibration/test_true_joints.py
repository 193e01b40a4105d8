"""`poekin emit` of a calibration with non-geometric terms: what makes true joint values, too."""

from __future__ import annotations

import gzip
import hashlib
import sys

import numpy as np
import pytest

import poekin as pk
from poekin.errors import PoekinWarning
from poekin.formats import chain_toml, dh
from poekin.solve.calibration import Parameter, Term, calibrate
from poekin.solve.calibration.model.parameters import KINDS
from tests.formats.emitted import module
from tests.solve.calibration.terms.sagging import arm, case

CHAIN = arm("kr5")
MADE = case(CHAIN, 0, sag=1e-3)


def found(*kinds, geometry=("screws", "home")):
    return calibrate(
        CHAIN, MADE.q, MADE.points, parameters=(*geometry, *kinds), folds=0,
        on_rank_deficiency="fix",
    )  # fmt: skip


@pytest.fixture(scope="module")
def sagging():
    return found("compliance")


@pytest.fixture
def file(sagging, tmp_path):
    sagging.save(tmp_path / "arm.toml")
    return tmp_path / "arm.toml"


def test_c_is_six_files_of_which_three_are_the_terms(poekin, file, sagging, tmp_path):
    words = ("emit", file, "--lang", "c", "--name", "kr5", "--output", tmp_path / "c")
    code, out, err = poekin(*words)
    assert (code, err) == (0, "")
    assert "kr5_true_joints.c" in out
    made = {path.name for path in (tmp_path / "c").iterdir()}
    assert made == {f"kr5{end}" for end in (".h", ".c", "_selftest.c")} | {
        f"kr5_true_joints{end}" for end in (".h", ".c", "_selftest.c")
    }
    text = (tmp_path / "c" / "kr5_true_joints.c").read_text(encoding="ascii")
    assert "with the SHA-256" in text
    plain = sagging.emit("c", name="kr5").source
    assert text.partition("#include")[2] == plain.partition("#include")[2]


def test_python_has_one_more_function(poekin, file, sagging, tmp_path):
    words = ("emit", file, "--lang", "python", "--output", tmp_path / "a.py")
    assert poekin(*words)[0] == 0
    functions = module((tmp_path / "a.py").read_text(encoding="ascii"))
    q = MADE.fresh[:4]
    T = functions.fk(functions.true_joints(q, np), np)
    expected = sagging.chain.fk(sagging.true_joints(q))
    np.testing.assert_allclose(T, expected, rtol=0, atol=1e-12)


def test_calibrations_that_are_piped_zipped_or_of_another_name_have_their_terms(
    poekin, file, tmp_path, monkeypatch
):
    content = file.read_bytes()
    other, packed = tmp_path / "arm.calibration", tmp_path / "arm.toml.gz"
    other.write_bytes(content)
    packed.write_bytes(gzip.compress(content))
    made = tmp_path / "c" / "kr5_true_joints.c"
    sources = set()
    for given in (file, other, packed, "-"):
        with open(packed, encoding="latin-1") as stream:
            monkeypatch.setattr(sys, "stdin", stream)
            words = ("--lang", "c", "--name", "kr5", "--output", tmp_path / "c", "--force")
            code, _, err = poekin("emit", given, *words)
        assert (code, err) == (0, ""), given
        text = made.read_text(encoding="ascii")
        sources.add(text.partition("#include")[2])
        made.unlink()
    assert len(sources) == 1
    digest = hashlib.sha256(packed.read_bytes()).hexdigest()
    assert f"standard input with the SHA-256 {digest}" in " ".join(text.replace(" *", "").split())


def test_what_has_no_place_for_the_terms_says_that_they_are_missing(poekin, file, tmp_path):
    words = ("--lang", "javascript", "--all-links", "--output", tmp_path / "a.js")
    code, _, err = poekin("emit", file, *words)
    assert code == 0
    assert "non-geometric terms, of which --all-links has nothing" in err.replace("\n", " ")
    # axes that meet as the nominal ones do
    found("compliance", geometry=("home",)).save(tmp_path / "b.toml")
    words = ("--lang", "c", "--ik", "--output", tmp_path / "ik")
    code, _, err = poekin("emit", tmp_path / "b.toml", *words)
    assert code == 0
    said = err.replace("\n", " ")
    assert "of which --ik has nothing: its joint values are true ones, not readings" in said
    code, _, err = poekin("fk", file, *np.zeros(CHAIN.dof))
    assert code == 0
    assert err.count("the calibration has non-geometric terms ('compliance'): the arm takes") == 1


def test_a_loaded_arm_is_told_to_take_true_joint_values(file, tmp_path):
    for read in (pk.load, lambda path: pk.calibration.apply(pk.load("kr5"), path)):
        with pytest.warns(PoekinWarning, match=r"arm\.toml: the calibration .*load\(path\) has"):
            read(file)
    found().save(tmp_path / "plain.toml")
    pk.load(tmp_path / "plain.toml")
    assert chain_toml.GEOMETRIC == KINDS
    kinds = 'kinds = [\n    "screws",\n    "home",\n    "compliance",\n]\n'
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace(kinds, ""), encoding="utf-8")
    assert pk.load(file).q_names == CHAIN.q_names


def test_other_languages_and_no_terms_are_told_or_as_before(poekin, file, tmp_path):
    words = ("emit", file, "--lang", "javascript", "--output", tmp_path / "a.js")
    code, _, err = poekin(*words)
    assert code == 0
    assert "written in c and python only, not in javascript" in err.replace("\n", " ")
    found().save(tmp_path / "plain.toml")
    words = ("emit", tmp_path / "plain.toml", "--lang", "python", "--output", tmp_path / "b.py")
    assert poekin(*words)[::2] == (0, "")
    assert "true_joints" not in (tmp_path / "b.py").read_text(encoding="ascii")
    dh.write(dh.published("ur5"), tmp_path / "table.toml")
    words = ("emit", tmp_path / "table.toml", "--lang", "python", "--output", tmp_path / "c.py")
    assert poekin(*words)[::2] == (0, "")


def test_another_branch_and_a_term_of_the_user_s_own_are_refused(refused, file, tmp_path):
    with pytest.warns(PoekinWarning, match=chain_toml.TERMS):
        link = pk.load(file).links[3]
    for end in ("--tip", "--base"):
        words = ("emit", file, "--lang", "c", end, link, "--output", tmp_path / "c")
        said = refused(*words).replace("\n", " ")
        assert "the calibration's terms are of 'joint1', 'joint2'" in said
    own = Term("ripple", (Parameter("a", "sin", "rad"),), lambda q, c: np.sin(q)[..., None])
    found(own).save(tmp_path / "own.toml")
    words = ("emit", tmp_path / "own.toml", "--lang", "c", "--output", tmp_path / "c")
    assert "got 'ripple'" in refused(*words)
    assert not (tmp_path / "c").exists()
