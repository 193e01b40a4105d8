"""Runs emitted text by JAX itself: `python by_jax.py FOLDER` reads FOLDER/TEXT.py and FOLDER/TEXT.json, and
writes FOLDER/TEXT.npz. JAX has threads, so that a process of its own is no trouble to other tests.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np


def run(text: Path) -> None:
    """What the functions of a text give by jit, vmap and grad."""
    given = json.loads(text.with_suffix(".json").read_text())
    functions: dict = {}
    exec(text.read_text(), functions)
    real = given["precision"]
    samples, cells = tuple(given["samples"]), tuple(given["cells"])
    bounds, place = jnp.array(given["bounds"]), jnp.array(given["place"])
    state = [jnp.zeros(given["room"], jnp.int64)]
    if "measured" in functions:
        state += [jnp.full(given["room"], -jnp.inf, real)]
        state += [jnp.full(given["room"], 2**63 - 1, jnp.int64)]
    sweep = jax.jit(functions["sweep"], static_argnums=(1, 2, 4))
    half = given["count"] // 2
    for first, count in ((0, half), (half, given["count"] - half)):
        found = sweep(first, count, samples, bounds, cells, place, *state)
        state = list(found) if isinstance(found, tuple) else [found]
    q = jnp.array(given["q"], real)
    np.savez(
        text.with_suffix(".npz"),
        *map(np.asarray, state),
        q=functions["configurations"](jnp.arange(given["count"]), samples, bounds),
        poses=jax.vmap(lambda x: functions["fk"](x, jnp))(q),
        slopes=jax.vmap(jax.jacfwd(lambda x: functions["fk"](x, jnp)[:3, 3]))(q),
        pulled=jax.vmap(jax.grad(lambda x: functions["fk"](x, jnp)[2, 3]))(q),
    )


def refused(text: Path) -> str:
    """What is said where numbers have 32 bits."""
    jax.config.update("jax_enable_x64", False)
    functions: dict = {}
    exec(text.read_text(), functions)
    try:
        functions["configurations"](jnp.arange(3), (1, 0), jnp.zeros((2, 7)))
    except RuntimeError as error:
        return str(error)
    return ""


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    jax.config.update("jax_enable_x64", True)
    texts = sorted(folder.glob("*.py"))
    for text in texts:
        run(text)
    (folder / "refused.txt").write_text(refused(texts[0]))
