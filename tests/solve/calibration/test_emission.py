"""Terms as C and Python: the text computes what `true_joints` does, and needs no poekin."""

from __future__ import annotations

import ast
import ctypes
import re
import shutil
import subprocess
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.solve.calibration import Parameter, Points, Term, calibrate
from poekin.solve.calibration.terms.named import BUILDERS
from tests.formats.emitted import HOSTILE, module
from tests.solve.calibration.terms.sagging import POINT, arm, at_point

STRICT = ("-std=c99", "-O2", "-Wall", "-Wextra", "-Wconversion", "-pedantic", "-Werror")
ALLOWED = (
    1e-12  # of the issue: true joint values of some rad are right to 1e-15 a sum of some terms
)
ARM = arm("ur5").replace(
    masses=np.column_stack(
        [[3.7, 8.4, 2.3, 1.2, 1.2, 0.2], np.linspace(-0.3, 0.4, 18).reshape(6, 3)]
    )
)
COUPLED = (
    pk.load("puma560")
    .chain()
    .coupled("joint3 = joint2 + joint3")
    .rebased(pk.se3.exp([0.1, 0.2, -0.1, 0.3, 0.1, 0.2]))
)
RNG = np.random.default_rng(5)
GIVEN = {
    "payload": np.linspace(0, 3, 90),
    "temperature": np.linspace(290, 300, 90),
    "gravity": [0.6, 0.0, -0.8],
    "previous": RNG.uniform(-1, 1, (90, 6)),
}  # fmt: skip
EVERY: Any = ("screws", "home", "gains", *BUILDERS)


def calibrated(chain, kinds, conditions=None):
    """A calibration of errors as large as those of a bad gear, so that each term matters."""
    q = chain.random(np.random.default_rng(3), 90)
    off = RNG.normal(scale=3e-3, size=q.shape)
    p = Points(at_point(chain, q + off), POINT)
    return calibrate(
        chain, q, p, parameters=kinds, folds=0, conditions=conditions, on_rank_deficiency="fix"
    )


CASES = {
    "every term": calibrated(ARM, EVERY, GIVEN),
    "coupled, upright": calibrated(COUPLED, ("screws", "home", "compliance", "harmonics", "drift")),
}
WIDTHS = {"every term": 17, "coupled, upright": 0}


def examples(found, width):
    """Fresh readings and conditions, by name and as the text takes them."""
    q = found.nominal.random(np.random.default_rng(9), 40)
    if not width:
        return q, {}, np.empty((40, 0))
    rng = np.random.default_rng(10)
    down = rng.normal(size=(40, 3))
    down /= np.linalg.norm(down, axis=1, keepdims=True)
    conditions = {
        "payload": rng.uniform(0, 5, 40), "gravity": down, "approach": np.sign(rng.normal(size=(40, 6))),
        "previous": rng.uniform(-2, 2, (40, 6)), "temperature": rng.uniform(280, 310, 40),
    }  # fmt: skip
    return q, conditions, np.column_stack(list(conditions.values()))


@pytest.mark.parametrize("name", CASES)
def test_the_python_text_is_true_joints(name):
    found = CASES[name]
    q, conditions, given = examples(found, WIDTHS[name])
    text = found.emit("python", origin="a test")
    function = module(text).true_joints
    got = function(q, given, np) if WIDTHS[name] else function(q, np)
    expected = found.true_joints(q, conditions)
    np.testing.assert_allclose(got, expected, rtol=0, atol=ALLOWED)
    assert np.abs(expected - q).max() > 1e6 * ALLOWED
    assert text.isascii()
    assert "Made by poekin" in text
    assert "from a test" in text
    first = function(q[0], given[0], np) if WIDTHS[name] else function(q[0], np)
    np.testing.assert_array_equal(first, got[0])


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("name", CASES)
def test_the_c_text_is_true_joints_without_a_warning(name, compiler, tmp_path):
    cc = shutil.which(compiler)
    if cc is None:
        pytest.skip(f"no {compiler}: what is emitted was not compiled")
    found = CASES[name]
    q, conditions, given = examples(found, WIDTHS[name])
    source = found.emit("c", name="My arm")
    for file, text in source.files.items():
        (tmp_path / file).write_text(text, encoding="ascii")
    word = source.name
    assert word == "my_arm_true_joints"
    library = tmp_path / "a.so"
    build = [cc, *STRICT, "-fPIC", "-I", str(tmp_path), str(tmp_path / f"{word}.c")]
    subprocess.run([*build, "-shared", "-o", str(library), "-lm"], check=True)
    function = getattr(ctypes.CDLL(str(library)), word)
    got = q.copy()
    for row, condition in zip(got, given, strict=True):  # in place, as the header allows
        pointers = [row.ctypes.data_as(ctypes.c_void_p)] * 2
        if WIDTHS[name]:
            pointers.insert(1, np.ascontiguousarray(condition).ctypes.data_as(ctypes.c_void_p))
        function(*pointers)
    np.testing.assert_allclose(got, found.true_joints(q, conditions), rtol=0, atol=ALLOWED)
    program = tmp_path / "selftest"
    test = str(tmp_path / f"{word}_selftest.c")
    subprocess.run([*build, test, "-o", str(program), "-lm"], check=True)
    ran = subprocess.run([str(program)], capture_output=True, text=True, check=True)
    assert ran.stdout.startswith(f"{word}: worst error ")
    assert ran.stdout.endswith("allowed 1e-12: passed\n")


def test_the_self_test_tells_a_wrong_text(tmp_path):
    cc = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if cc is None:
        pytest.skip("no C compiler: what is emitted was not compiled")
    source = CASES["coupled, upright"].emit("c")
    wrong = source.source.replace("q_true[5] = ", "q_true[5] = 1e-9 + ")
    for file, text in {**source.files, f"{source.name}.c": wrong}.items():
        (tmp_path / file).write_text(text, encoding="ascii")
    files = [str(path) for path in tmp_path.glob("*.c")]
    program = str(tmp_path / "selftest")
    subprocess.run([cc, "-std=c99", *files, "-o", program, "-lm"], check=True)
    ran = subprocess.run([program], capture_output=True, text=True, check=False)
    assert ran.returncode == 1
    assert ran.stdout == f"{source.name}: worst error 1e-09, allowed 1e-12: FAILED\n"


def test_the_header_says_the_conditions_in_order_with_their_means():
    header = CASES["every term"].emit("c").header
    assert " *   conditions[0]  payload, kg; 1.5\n" in header
    assert " *   conditions[3]  gravity, a unit vector in the base frame, z; -0.8\n" in header
    assert "conditions[5]  sign of the last move of 'shoulder_lift_joint'; 0 where it" in header
    assert (
        "conditions[15]  reading of 'wrist_3_joint' before the last move; its q at rest" in header
    )
    assert " *   conditions[16]  temperature, K; 295\n" in header
    assert "Terms: 'compliance', 'coupling', 'harmonics', 'second harmonics', 'backlash'" in header
    plain = CASES["coupled, upright"].emit("c").header
    assert "void arm_true_joints(const double *q, double *q_true);" in plain
    assert "conditions" not in plain


@pytest.mark.parametrize("name", CASES)
def test_the_text_says_its_own_operations(name):
    text = CASES[name].emit("python")
    (words,) = re.findall(r"': (\d+) multiplications, (\d+) additions or subtractions, (\d+)", text)
    nodes = list(ast.walk(ast.parse(text)))
    written = [node.op for node in nodes if isinstance(node, ast.BinOp)]
    products = sum(isinstance(op, ast.Mult) for op in written)
    sums = sum(isinstance(op, ast.Add | ast.Sub) for op in written)
    sines = sum(isinstance(node, ast.Call) and "sin(" in ast.unparse(node) for node in nodes)
    assert tuple(map(int, words)) == (products, sums, sines)


def test_a_term_of_the_user_s_own_and_no_term_at_all_cannot_be_written():
    own = Term("rip*/ple", (Parameter("a", "sin", "rad"),), lambda q, c: np.sin(q)[..., None])
    found = calibrated(ARM, ("screws", "home", own))
    with pytest.raises(InputError, match=r"the term 'rip\*/ple' is a function of arrays"):
        found.emit("c")
    with pytest.raises(InputError, match="there are no non-geometric terms"):
        calibrated(ARM, ("screws", "home")).emit("python")
    wrong: Any = "rust"
    with pytest.raises(InputError, match="language: expected 'c' or 'python', got 'rust'"):
        CASES["every term"].emit(wrong)
    wrong = 7
    with pytest.raises(InputError, match="name: expected a text, got 7"):
        CASES["every term"].emit("c", name=wrong)


@pytest.mark.parametrize("name", HOSTILE)
def test_names_out_of_files_stand_in_comments_only(name):
    chain = ARM.replace(q_names=[name, *ARM.q_names[1:]])
    found = replace(CASES["every term"], nominal=chain)
    plain = found.emit("c", origin=name).source
    assert plain.isascii()
    assert plain.count("*/") == plain.count("/*") == 1
    assert callable(module(found.emit("python", origin=name)).true_joints)


def test_python_says_of_what_shape_readings_conditions_and_values_are():
    told = {
        "every term": "True joint values (..., 6) of readings q, under conditions (..., 17).",
        "coupled, upright": "True joint values (..., 6) of readings q.",
    }
    for name, words in told.items():
        assert f'    """{words}"""\n' in CASES[name].emit("python", origin="a test")
