"""The correction of readings as a Python function for NumPy, JAX and PyTorch arrays."""

from __future__ import annotations

from ..python import stack
from .correction import Correction, assignments


def python_text(correction: Correction, origin: str) -> str:
    """A module with the function `true_joints`."""
    head = [
        '"""True joint values of readings. Generated: change the calibration instead.',
        *correction.lines(origin),
        "",
        "q is (..., m), an array of floats of the module xp: numpy, jax.numpy, torch.",
        '"""',
        "",
        "",
    ]
    return "\n".join(line.rstrip() for line in head) + python_function(correction)


def python_function(correction: Correction) -> str:
    """The function `true_joints`, without what its numbers are."""
    arguments = "q, conditions, xp" if correction.conditions else "q, xp"
    said = f"True joint values (..., {correction.chain.dof}) of readings q"
    if correction.conditions:
        said += f", under conditions (..., {len(correction.conditions)})"
    pairs = assignments(correction, "xp.sin", "xp.cos", "{}[..., {}]")
    body = [f"    {variable} = {text}" for variable, text in pairs]
    outputs = list(map(str, correction.statements.outputs))
    lines = [f"def true_joints({arguments}):", f'    """{said}."""', *body]
    return "\n".join([*lines, *stack("return", outputs), ""])
