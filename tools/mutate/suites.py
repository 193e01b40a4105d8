"""Which tests judge a mutant: first those beside its module, then all that could possibly see it.

A mutant that the first set lets through has not survived until the second has let it through too.
"""

from __future__ import annotations

from collections.abc import Iterable

_MATRICES = "tests/formulas/test_algebra_matrices.py"
_CHAIN_MATRICES = "tests/formulas/test_chain_matrices.py"
_GROUP_MATRICES = "tests/formulas/test_group_matrices.py"
_KINDS = "tests/formulas/test_kinds.py"
_GROUPS = ("tests/groups/test_near.py", "tests/groups/test_so3.py", "tests/groups/test_se3.py")
_CHAINS = ("tests/model/test_chain.py", "tests/model/test_chain_laws.py")
_DH = tuple(f"tests/formats/test_{name}.py" for name in ("dh_values", "dh_files", "dh", "dh_published"))
_SLOW = "test_every_chain_of_the_real_robots_has_a_table"  # left for the end
_SMALL_ANGLES = (_GROUP_MATRICES, "tests/formulas/test_coefficients.py", *_GROUPS)

NEAR: dict[str, tuple[str, ...]] = {
    "poekin/algebra.py": (_MATRICES, _KINDS, _CHAIN_MATRICES, *_GROUPS, *_CHAINS),
    "poekin/formulas/": (_CHAIN_MATRICES, _KINDS, *_CHAINS, *_GROUPS),
    "poekin/formulas/coefficients.py": ("tests/formulas/test_coefficients.py", *_SMALL_ANGLES, _KINDS),
    "poekin/formulas/logarithm.py": (*_SMALL_ANGLES, _KINDS),
    "poekin/formulas/exponential.py": (_MATRICES, _CHAIN_MATRICES, *_SMALL_ANGLES, _KINDS),
    "poekin/formulas/exp_jacobian.py": (*_SMALL_ANGLES, _KINDS),
    "poekin/formulas/elementary.py": (_KINDS, *_SMALL_ANGLES),
    "poekin/formulas/defect.py": (_MATRICES, "tests/groups/test_batches.py", *_SMALL_ANGLES),
    "poekin/formulas/derivatives.py": (
        "tests/formulas/test_derivative_differences.py", "tests/formulas/test_derivative_counts.py",
        "tests/model/test_derivatives.py"),
    "poekin/formulas/screw_changes.py": (
        "tests/formulas/test_derivative_differences.py", "tests/model/test_derivatives.py"),
    "poekin/formulas/structured.py": ("tests/formulas/test_structured_matrices.py", "tests/model/test_compiled.py"),
    "poekin/formulas/recursive.py": (_CHAIN_MATRICES, _MATRICES, _KINDS, *_CHAINS),
    "poekin/formulas/least_squares.py": ("tests/formulas/test_least_squares.py", "tests/formulas/test_kinds.py"),
    "poekin/formulas/dh.py": (_MATRICES, _CHAIN_MATRICES, "tests/formulas/test_dh_route.py", *_DH[1:]),
    "poekin/groups/": ("tests/groups/test_values.py", "tests/groups/test_batches.py", "tests/groups/test_objects.py",
                       *_GROUPS),
    "poekin/groups/rpy.py": ("tests/groups/test_values.py", "tests/formats/test_rpy.py"),
    "poekin/formats/dh/": (*_DH, "tests/formats/test_dh_calibrated.py", f"--deselect={_DH[2]}::{_SLOW}"),
    "poekin/model/screw.py": (
        "tests/model/test_screw_values.py", "tests/model/test_screw.py", "tests/model/test_parts.py", *_CHAINS),
}  # fmt: skip

_ALL_FORMULAS = (
    "tests/formulas",
    "tests/groups",
    *(f"tests/model/test_{name}.py" for name in (
        "chain", "chain_laws", "compiled", "derivatives", "evaluation", "analytic", "hp", "tree", "robot_coordinates",
        "parts", "screw")),
    *(f"tests/engine/test_{name}.py" for name in ("count", "interpret", "trace")),
    *(f"tests/testing/test_{name}.py" for name in ("attainable", "exact", "laws", "differences", "pinocchio_oracle")),
    *(f"tests/analysis/test_{name}.py" for name in ("count", "axes", "manipulability", "singularity")),
    *(f"tests/formats/test_{name}.py" for name in ("dh", "rpy", "emit_python", "objects_pinocchio")),
)  # fmt: skip
_ALL_MODEL = (
    "tests/model",
    "--ignore=tests/model/test_idealised.py",
    *(f"tests/formats/test_{name}.py" for name in ("dh", "mjcf", "objects", "rpy", "serial", "ur", "urdf")),
    *(f"tests/analysis/test_{name}.py" for name in ("axes", "compare_extra")),
    "tests/testing/test_chain_strategies.py",
)
_ALL_DH = tuple(f"tests/formats/test_{name}.py" for name in ("dh_values", "dh_files", "dh", "dh_published"))
WHOLE: dict[str, tuple[str, ...]] = {
    "poekin/": _ALL_FORMULAS,
    "poekin/model/": _ALL_MODEL,
    "poekin/formats/dh/": _ALL_DH,
}

# Tests that say something about compiled code, and fail in the interpreter without any mutant.
APART = (
    # the scalars of a NumPy row warn where compiled code quietly gives NaN
    "tests/groups/test_near.py::test_a_reference_that_is_no_number_gives_nan",
    "tests/model/test_parts.py::test_what_is_no_pose_is_refused",
)


def near(path: str) -> list[list[str]]:
    """What pytest is given first for a module, in one run after the other: the quickest file, then the others."""
    files = NEAR[_longest(NEAR, path)]
    return [[*part, *_apart()] for part in (files[:1], files[1:]) if part]


def whole(path: str) -> list[str]:
    """What pytest is given to judge what is left."""
    return [*WHOLE[_longest(WHOLE, path)], *_apart()]


def _longest(known: Iterable[str], path: str) -> str:
    return max((start for start in known if path.startswith(start)), key=len)


def _apart() -> list[str]:
    return [f"--deselect={test}" for test in APART]
