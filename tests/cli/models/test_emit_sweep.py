"""`poekin emit --lang cuda` and `--lang jax`: one file of kernels, in a precision, with a measure or without."""

from __future__ import annotations

import pytest

import poekin as pk
from poekin.formats import emit

PANDA = ("emit", "panda", "--tip", "panda_hand")
OPTIONS = {"precision": "float32", "measure": "manipulability"}
WORDS = [word for name, value in OPTIONS.items() for word in (f"--{name}", value)]


@pytest.mark.parametrize("options", [{}, OPTIONS], ids=["default", "given"])
def test_cuda_is_one_file_and_says_what_it_costs(poekin, tmp_path, options):
    words = WORDS if options else []
    code, out, err = poekin(*PANDA, "--lang", "cuda", "--output", tmp_path / "made", *words)
    assert (code, err) == (0, "")
    chain = pk.load("panda").chain(tip="panda_hand")
    text = emit.cuda(chain, "hybrid", name="panda", origin="the robot panda", **options)
    assert [path.name for path in (tmp_path / "made").iterdir()] == ["panda.cu"]
    assert (tmp_path / "made" / "panda.cu").read_text(encoding="ascii") == text
    assert out.startswith("panda_fk: 80 multiplications, 45 additions or subtractions, 7 pairs")
    assert ("panda_measured: " in out) is bool(options)


@pytest.mark.parametrize("options", [{}, OPTIONS], ids=["default", "given"])
def test_jax_is_one_file_of_a_frame(poekin, tmp_path, options):
    words = [*(WORDS if options else []), "--frame", "2"]
    assert poekin(*PANDA, "--lang", "jax", "--output", tmp_path / "arm.py", *words)[0] == 0
    chain = pk.load("panda").chain(tip="panda_hand")
    text = emit.jax(chain, 2, origin="the robot panda", **options)
    assert (tmp_path / "arm.py").read_text(encoding="ascii") == text


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--lang", "c", "--precision", "float32"), "--precision: expected together with --lang cuda or jax only"),
        (("--lang", "python", "--measure", "reach"), "--measure: expected together with --lang cuda or jax only"),
        (("--lang", "cuda", "--precision", "half"), "precision: expected 'float64' or 'float32', got 'half'"),
        (("--lang", "jax", "--measure", "best"), "measure: expected 'reach' or 'manipulability', got 'best'"),
        (("--lang", "cuda", "--float"), "--float: expected together with --lang c only"),
        (("--lang", "cuda", "--ik"), "--ik: expected together with --lang c only, it is not written in cuda yet"),
        (("--lang", "jax", "--all-links"), "--all-links: expected together with --lang javascript only"),
    ],
    ids=lambda x: "-".join(x) if isinstance(x, tuple) else "",
)  # fmt: skip
def test_what_cannot_be_is_refused_and_nothing_is_written(refused, tmp_path, words, message):
    assert message in refused(*PANDA, *words, "--output", tmp_path / "made")
    assert list(tmp_path.iterdir()) == []


def test_a_file_of_another_language_is_refused(refused, tmp_path):
    said = refused(*PANDA, "--lang", "cuda", "--output", tmp_path / "arm.c")
    assert "--output: a directory or a .cu file expected with --lang cuda, got " in said
    assert list(tmp_path.iterdir()) == []
