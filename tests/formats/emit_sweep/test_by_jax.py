"""Emitted text for JAX, by JAX where it is installed: what `pk.sweep.run` counts, and derivatives."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from poekin.formats import emit

from ..emitted import bound
from .sweep_cases import CASES, arguments, case, check, samples_of


@pytest.fixture(scope="module")
def by_jax(tmp_path_factory):
    """A folder with what JAX computes of each case."""
    if importlib.util.find_spec("jax") is None:
        pytest.skip("no jax: the text was run by numpy alone")
    folder = tmp_path_factory.mktemp("jax")
    for key in CASES:
        sweep = case(key)
        (folder / f"{key}.py").write_text(emit.jax(sweep.chain, "body", measure=CASES[key][2]))
        samples, bounds, cells, place = arguments(sweep)
        given = {"samples": samples, "bounds": bounds.tolist(), "cells": cells}
        given |= {"place": place.tolist(), "count": sweep.samples.count, "precision": "float64"}
        given |= {"room": sweep.cells.count + 1, "q": sweep.chain.random(0, 5).tolist()}
        (folder / f"{key}.json").write_text(json.dumps(given))
    program = Path(__file__).with_name("by_jax.py")
    subprocess.run([sys.executable, program, folder], check=True, capture_output=True, text=True)
    return folder


@pytest.mark.parametrize("key", CASES)
def test_jax_jits_it_and_differentiates_it(key, by_jax):
    sweep = case(key)
    samples = samples_of(sweep)
    chain = sweep.chain
    with np.load(by_jax / f"{key}.npz") as found:
        check(sweep, *(found[f"arr_{k}"] for k in range(1 + 2 * sweep.is_measured)))
        wanted = samples.configurations(np.arange(samples.count))
        # a product and a sum of numbers up to the bounds, fused or not
        largest = np.abs(samples.bounds).sum()
        np.testing.assert_allclose(found["q"], wanted, rtol=0, atol=2 * 2.0**-53 * largest)
        q = chain.random(0, 5)
        allowed = bound(chain, q)
        J = chain.jacobian(q, "hybrid")
        np.testing.assert_allclose(found["poses"], chain.fk(q), rtol=0, atol=allowed)
        # derivatives of as many operations, each of at most two terms
        np.testing.assert_allclose(found["slopes"], J[:, 3:], rtol=0, atol=4 * allowed)
        np.testing.assert_allclose(found["pulled"], J[:, 5], rtol=0, atol=4 * allowed)


def test_jax_with_numbers_of_32_bits_is_told_how_to_have_64(by_jax):
    said = (by_jax / "refused.txt").read_text()
    assert 'jax.config.update("jax_enable_x64", True)' in said
