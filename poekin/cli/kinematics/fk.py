"""`poekin fk`: the pose of a link."""

from __future__ import annotations

from .. import array_files
from ..output import name
from .arm import Base, File, Input, Json, Numbers, Output, Results, Tip, compute, give, take

# As columns of a CSV file: the 4×4 matrix, row by row.
ENTRIES = [f"T{i}{j}" for i in range(4) for j in range(4)]


def command(
    file: File,
    q: Numbers = None,
    tip: Tip = None,
    base: Base = None,
    given: Input = None,
    output: Output = None,
    json: Json = False,
) -> None:
    """Pose (4×4, in m) of the link --tip in the link --base, at Q or at every line of --input."""
    array_files.check_writable(output)
    array_files.check_apart([output], model=file, configurations=given)
    arm = take(file, tip, base, q, given)
    poses = compute(arm, arm.chain.fk, (4, 4))
    title = f"pose of {name(arm.chain.tip)} in {name(arm.chain.base)} (m)"
    give(arm, Results(poses, "T", title, ENTRIES), output, json)
