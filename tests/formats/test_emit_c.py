"""Emitted C99, by the system's compiler: to the last bit what the emitted Python computes, and safe
from any name.
"""

from __future__ import annotations

import ctypes
import functools
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.formats import emit
from poekin.formats.emit.messages import identifier

from .emitted import ARMS, FRAMES, HOSTILE, arm, bound, expected, module, suffix, with_name

STRICT = ("-std=c99", "-O2", "-Wall", "-Wextra", "-pedantic", "-Werror")
CASES = [
    (name, frame) for name in ARMS for frame in (("hybrid", "cheapest", 0) if arm(name).kinds else ("hybrid",))
] + [("panda", "space"), ("panda", "body"), ("coupled", "space"), ("mixed", "body")]  # fmt: skip


@pytest.fixture(scope="module")
def cc():
    """The system's C compiler."""
    found = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if found is None:
        pytest.skip("no C compiler: what is emitted was not compiled")
    return found


class Built:
    """What is built of an emitted text as it is asked for; each unit is compiled once."""

    def __init__(self, cc: str, folder: Path, source: emit.CSource, options: tuple[str, ...]):
        self.cc, self.folder, self.name, self.options = cc, folder, source.name, (*options, "-fPIC")
        for file_name, text in source.files.items():
            (folder / file_name).write_text(text, encoding="ascii")

    @functools.cached_property
    def library(self) -> Path:
        """The shared library."""
        return self._linked("library.so", self._unit, "-shared")

    @functools.cached_property
    def program(self) -> Path:
        """The self-test program."""
        return self._linked("selftest", self._unit, self._object("_selftest"))

    @functools.cached_property
    def _unit(self) -> str:
        return self._object("")

    def _object(self, end: str) -> str:
        unit = self.folder / f"{self.name}{end}.c"
        compiled(self.cc, *self.options, "-c", str(unit), "-o", str(unit.with_suffix(".o")))
        return str(unit.with_suffix(".o"))

    def _linked(self, name: str, *words: str) -> Path:
        compiled(self.cc, *self.options, *words, "-o", str(self.folder / name), "-lm")
        return self.folder / name


@pytest.fixture
def build(cc, tmp_path):
    """Compile an emitted text."""
    return lambda source, *options: Built(cc, tmp_path, source, options)


@pytest.fixture(scope="module")
def build_arm(cc, tmp_path_factory):
    """Compile the text of an arm, once for all tests."""

    @functools.cache
    def built(name, frame):
        source = emit.c(arm(name), frame, name="arm")
        return Built(cc, tmp_path_factory.mktemp("arm"), source, ("-ffp-contract=off",))

    return built


def compiled(compiler: str, *words: str) -> None:
    done = subprocess.run([compiler, *STRICT, *words], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def ran(program: Path) -> tuple[int, str, float]:
    """Exit code, what was printed, and the worst error in it."""
    done = subprocess.run([str(program)], capture_output=True, text=True, check=False)
    found = re.fullmatch(r"\w+: worst error (\S+), allowed \S+: (passed|FAILED)\n", done.stdout)
    assert found, done.stdout
    return done.returncode, found[2], float(found[1])


def called(library: Path, name: str, *arrays: np.ndarray) -> None:
    function = getattr(ctypes.CDLL(str(library)), name)
    function.restype = None
    function(*(a.ctypes.data_as(ctypes.c_void_p) for a in arrays))


@pytest.mark.parametrize(("name", "frame"), CASES)
def test_it_is_the_emitted_python_to_the_last_bit_given_the_same_sines(name, frame, build_arm):
    chain = arm(name)
    library = build_arm(name, frame).library
    python = module(emit.python(chain, frame))
    for function in ("fk", f"jacobian_{suffix(frame)}", f"fk_jacobian_{suffix(frame)}"):
        for q in chain.random(5, 20):
            x = getattr(python, f"{function}_angles")(q, np)
            same = np.empty_like(x)
            called(library, f"arm_{function}_angles", q, same)
            np.testing.assert_array_equal(same, x)
            s, c = np.sin(x), np.cos(x)
            wanted = getattr(python, f"{function}_sincos")(s, c, q, np)
            wanted = wanted if isinstance(wanted, tuple) else (wanted,)
            results = [np.full(w.shape, np.nan) for w in wanted]
            called(library, f"arm_{function}_sincos", s, c, q, *results)
            for got, w in zip(results, wanted, strict=True):
                np.testing.assert_array_equal(got, w)


@pytest.mark.parametrize(("name", "frame"), CASES)
def test_from_q_it_is_the_chain_within_1e_14_reach_and_its_own_test_passes(name, frame, build_arm):
    chain = arm(name)
    built = build_arm(name, frame)
    code, verdict, worst = ran(built.program)
    assert (code, verdict) == (0, "passed")
    assert worst <= 1e-14 * chain.reach
    for q in chain.random(6, 20):
        wanted = expected(chain, frame, q)
        T, J = np.empty((4, 4)), np.empty((6, chain.dof))
        called(built.library, f"arm_fk_jacobian_{suffix(frame)}", q, T, J)
        alone_T, alone_J = np.empty((4, 4)), np.empty((6, chain.dof))
        called(built.library, "arm_fk", q, alone_T)
        called(built.library, f"arm_jacobian_{suffix(frame)}", q, alone_J)
        for got, w in zip((T, J, alone_T, alone_J), (*wanted, *wanted), strict=True):
            assert np.abs(got - w).max(initial=0.0) <= 1e-14 * chain.reach


@pytest.mark.parametrize("name", ARMS)
def test_in_single_precision_it_keeps_the_bound_of_single_precision(name, build):
    # u = 2^-24 in the place of 2^-53: the arm's constants are rounded to it too, which is the
    # second half of `bound`
    chain = arm(name)
    built = build(emit.c(chain, "hybrid", name="single", real="float"))
    assert ran(built.program)[:2] == (0, "passed")
    for q in chain.random(7, 20).astype(np.float32):
        T, J = np.empty((4, 4), np.float32), np.empty((6, chain.dof), np.float32)
        called(built.library, "single_fk_jacobian_hybrid", q, T, J)
        exact = q.astype(float)
        for got, wanted in zip((T, J), expected(chain, "hybrid", exact), strict=True):
            assert np.abs(got - wanted).max(initial=0.0) <= bound(chain, exact, 2.0**-24)


def test_results_may_overlap_q(build):
    chain = arm("mixed")
    library = build(emit.c(chain, "body", name="lap")).library
    q, memory, T = chain.random(8), np.empty(16), np.empty(16)
    called(library, "lap_fk", q, T)
    memory[:5] = q
    called(library, "lap_fk", memory, memory)
    np.testing.assert_array_equal(memory, T)


@pytest.mark.parametrize("real", ["double", "float"])
def test_its_own_test_fails_where_one_digit_of_the_arm_is_wrong(real, build):
    source = emit.c(arm("panda"), "hybrid", name="wrong", real=real)
    assert source.source.count("0.333") == 2
    planted = emit.CSource(
        source.name, source.header, source.source.replace("0.333", "0.334", 1), source.selftest
    )
    code, verdict, worst = ran(build(planted).program)
    assert (code, verdict) == (1, "FAILED")
    assert worst == pytest.approx(1e-3, rel=1e-3)


def test_its_own_test_fails_where_a_result_is_no_number(build):
    source = emit.c(arm("panda"), "hybrid", name="nan")
    text = re.sub(r"J\[41\] = [^;]+;", "J[41] = sqrt(-1.0 - c[0] * c[0]);", source.source)
    assert text != source.source
    assert ran(build(emit.CSource(source.name, source.header, text, source.selftest)).program)[
        :2
    ] == (1, "FAILED")


def test_a_c_plus_plus_program_can_use_the_header(build, tmp_path):
    compiler = shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")
    if compiler is None:
        pytest.skip("no C++ compiler: the header was not compiled as C++")
    library = build(emit.c(arm("one joint"), "body", name="plus")).library
    unit = tmp_path / "use.cpp"
    unit.write_text(
        '#include "plus.h"\n#include "plus.h"\nint main() { double q[1] = {0}, T[16]; plus_fk(q, T); return 0; }\n'
    )
    options = ["-Wall", "-Wextra", "-pedantic", "-Werror"]
    subprocess.run(
        [compiler, *options, str(unit), str(library), "-o", str(tmp_path / "use")], check=True
    )


@pytest.mark.parametrize("name", HOSTILE, ids=range(len(HOSTILE)))
def test_a_hostile_name_stays_in_its_comment(name, build):
    source = emit.c(with_name(name), "cheapest", name=name)
    without, plain = (
        [re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL) for text in emitted.files.values()]
        for emitted in (source, emit.c(with_name("a"), "cheapest", name=source.name))
    )
    assert without == plain
    assert not any(
        "??" in text for text in source.files.values()
    )  # a trigraph is a character of its own
    assert all(
        text.isascii() and "\\" not in text.replace("\\n", "") for text in source.files.values()
    )
    assert ran(build(source).program)[:2] == (0, "passed")


@pytest.mark.parametrize(
    ("name", "made"),
    [
        ("Panda Arm-7", "panda_arm_7"),
        ("7dof", "arm_7dof"),
        ("", "arm"),
        ("__x__y__", "x_y"),
        ("ü/\u212a", "k"),  # the Kelvin sign in lower case is a k
        ("../../etc/passwd", "etc_passwd"),
        ("a" * 100, "a" * 40),
        ("a" * 39 + "-b", "a" * 39),
    ],
)
def test_names_are_made_of_letters_digits_and_single_underscores(name, made):
    assert identifier(name) == made
    assert re.fullmatch("[a-z][a-z0-9]*(_[a-z0-9]+)*", made)


@pytest.mark.parametrize(
    ("real", "mathematical"), [("double", {"sin", "cos"}), ("float", {"sinf", "cosf"})]
)
def test_it_needs_math_h_alone_and_no_memory(real, mathematical):
    for frame in FRAMES:
        source = emit.c(arm("panda"), frame, name="p", real=real)
        assert re.findall(r"#include (.*)", source.source) == ['"p.h"', "<math.h>"]
        assert re.findall(r"#include (.*)", source.header) == []
        code = re.sub(r"/\*.*?\*/", "", source.source, flags=re.DOTALL)
        functions = set(re.findall(r"(\w+)\(", code)) - {"for"}
        assert {name for name in functions if not name.startswith("p_")} == mathematical
        assert not re.search(r"\bstatic\b", code)
        assert real == "double" or not re.search(
            r"\bdouble\b|[0-9]\.[0-9]+(e-?[0-9]+)?(?![0-9ef])", code
        )


def test_the_header_says_the_sizes_of_all_arrays():
    arm = pk.load("ur5e").chain().rezeroed([0.0, 0.1, 0.2, 0.3, 0.0, 0.0])
    header = emit.c(arm, "body", name="a").header
    for task, results, n in (
        ("fk", "T[16]", 6),
        ("jacobian_body", "J[36]", 5),
        ("fk_jacobian_body", "T[16], J[36]", 6),
    ):
        first = f" * a_{task}: from q[6] to {results}; they may overlap q.\n"
        assert (
            f"{first} * ..._sincos: the same from s[{n}] = sin x and c[{n}] = cos x, where the angles x are\n"
            in header
        )


def test_the_first_comment_says_what_it_costs():
    chain = arm("panda")
    source = emit.c(chain, "cheapest", name="p")
    for text in (source.header, source.source):
        first = text[: text.index("*/")]
        programs: list[tuple[str, Any]] = [("fk", None), ("jacobian_cheapest", "cheapest")]
        for function, program in programs:
            count = chain.compile().program(program).count
            said = f"p_{function}: {count.multiplications} multiplications, {count.additions} additions or subtractions"
            assert f" * {said}, {count.sines} pairs of sine and cosine\n" in first


def test_what_cannot_be_emitted_is_refused():
    with pytest.raises(InputError, match=r"^real: expected 'double' or 'float', got 'half'$"):
        emit.c(arm("panda"), "body", real="half")  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"^name: expected a text, got None$"):
        emit.c(arm("panda"), "body", name=None)  # type: ignore[arg-type]
    home = np.eye(4)
    home[0, 3] = 1e39
    with pytest.raises(
        InputError,
        match=r"^emit: the arm needs the number 1e\+39, which single precision cannot hold$",
    ):
        emit.c(pk.Chain.from_space([[0, 0, 1, 0, 0, 0]], home), "body", real="float")
