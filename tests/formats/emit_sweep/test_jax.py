"""Emitted text for JAX, with NumPy for jax.numpy: what `pk.sweep.run` counts."""

from __future__ import annotations

import ast
import inspect
import re
from types import SimpleNamespace

import numpy as np
import pytest

from poekin.errors import InputError
from poekin.formats import emit
from poekin.sweep import Cells

from ..emitted import HOSTILE, arm, bound, module, with_name
from .jax_by_numpy import Updated, by_numpy
from .sweep_cases import CASES, CELLS, arguments, case, check, samples_of

ROUNDOFF = {"float64": 2.0**-53, "float32": 2.0**-24}


@pytest.mark.parametrize("key", CASES)
def test_by_numpy_the_map_is_that_of_the_sweep(key):
    sweep = case(key)
    functions = by_numpy(emit.jax(sweep.chain, "hybrid", measure=CASES[key][2]))
    room = sweep.cells.count + 1
    state = [np.zeros(room, np.int64).view(Updated)]
    if sweep.is_measured:
        state += [np.full(room, -np.inf).view(Updated)]
        state += [np.full(room, 2**63 - 1, np.int64).view(Updated)]
    count = sweep.samples.count
    for first, last in ((0, count // 3), (count // 3, count)):
        found = functions["sweep"](first, last - first, *arguments(sweep), *state)
        state = list(found) if isinstance(found, tuple) else [found]
    check(sweep, *state)


@pytest.mark.parametrize("key", CASES)
@pytest.mark.parametrize("precision", ROUNDOFF)
def test_by_numpy_configurations_are_those_of_the_sweep(key, precision):
    sweep = case(key)
    functions = by_numpy(emit.jax(sweep.chain, 0, precision=precision))
    numbers = np.arange(sweep.samples.count)
    samples, bounds, _, _ = arguments(sweep)
    q = functions["configurations"](numbers, samples, bounds)
    expected = samples_of(sweep).configurations(numbers)
    assert q.dtype == precision
    np.testing.assert_array_equal(q, expected.astype(precision))
    T = functions["fk"](q, np)
    assert T.dtype == precision
    allowed = bound(sweep.chain, q, ROUNDOFF[precision])
    np.testing.assert_allclose(T, sweep.chain.fk(q), rtol=0, atol=allowed)


@pytest.mark.parametrize("side", [0, 1, 3])
def test_by_numpy_cells_are_those_of_the_poses(side):
    chain = arm("panda")
    cells = Cells(CELLS.corner, 0.2, (5, 10, 10), side)
    T = chain.fk(chain.random(3, 4000))
    functions = by_numpy(emit.jax(chain, "body"))
    found = functions["cells_of"](T, tuple(cells.numbers().tolist()), cells.place())
    np.testing.assert_array_equal(found, cells.find(T))
    assert (found == -1).any()


def test_by_numpy_the_corner_has_the_precision_of_the_poses():
    functions = by_numpy(emit.jax(arm("panda"), "body", precision="float32"))
    T = np.eye(4, dtype=np.float32)
    T[:3, 3] = 0.7  # which float32 rounds down
    cells = Cells((0.7, 0.7, 0.7), 0.1, (1, 1, 1))
    assert functions["cells_of"](T, tuple(cells.numbers().tolist()), cells.place()) == 0


def test_samples_of_another_kind_are_refused():
    functions = by_numpy(emit.jax(arm("panda"), "body"))
    with pytest.raises(ValueError, match=r"^samples: expected those of pk\.sweep\.Random or Grid$"):
        functions["configurations"](np.arange(3), (2, 0), np.zeros((2, 7)))


@pytest.mark.parametrize("measure, more", [("reach", 0), ("manipulability", 2)])
def test_its_docstring_says_how_the_sweep_is_called_and_compiled(measure, more):
    text = emit.jax(arm("one slide"), "body", measure=measure)
    said = ast.get_docstring(ast.parse(text)) or ""
    functions = by_numpy(text)
    parameters = list(inspect.signature(functions["sweep"]).parameters)
    assert parameters[7:] == ["best", "attained"][:more]
    assert f"  sweep({', '.join(parameters)}): " in said
    (static,) = re.findall(r"static_argnums=\(([\d, ]+)\)", said)
    assert [parameters[int(k)] for k in static.split(",")] == ["count", "samples", "cells"]
    assert "with 64-bit numbers on" in said
    assert "counts, int64, has cells.count + 1 zeros before" in said
    assert (
        ("attained, 2**63 - 1 before" in said) == (functions.get("NONE") == 2**63 - 1) == (more > 0)
    )
    assert "at y = 0 say" in said
    assert "first ... first + count - 1 added" in functions["sweep"].__doc__
    assert functions["cells_of"].__doc__ == "Cells (...) of poses T (..., 4, 4); -1 outside."
    assert functions["configurations"].__doc__ == (
        "q (N, 1) of samples by their numbers (N,), 64-bit integers."
    )


def test_without_numbers_of_64_bits_no_sample_is_drawn():
    functions = by_numpy(emit.jax(arm("one slide"), "body"))
    functions["xp"] = SimpleNamespace(zeros=np.zeros, uint64=np.uint32)
    with pytest.raises(RuntimeError) as caught:
        functions["configurations"](np.arange(3), (0, 0), np.zeros((2, 1)))
    switch = 'jax.config.update("jax_enable_x64", True)'
    assert str(caught.value) == f"numbers have 32 bits: {switch} before"


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_name_stays_in_its_docstring(name):
    text = emit.jax(with_name(name), "hybrid", origin=name)
    text.encode("ascii")
    plain = emit.jax(with_name("a"), "hybrid")
    names = set(by_numpy(text))
    assert names == set(by_numpy(plain))
    assert vars(module(emit.python(with_name("a"), "hybrid"))).keys() <= names


def test_what_cannot_be_emitted_is_refused():
    with pytest.raises(InputError, match=r"^precision: expected 'float64' or 'float32', got 16$"):
        emit.jax(arm("panda"), "body", precision=16)  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"^measure: expected 'reach' or 'manipulability', got"):
        emit.jax(arm("panda"), "body", measure="")  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"^emit: expected an arm with a coordinate, .* has none$"):
        emit.jax(arm("no joint"), "body")
