"""Which tests a mutant of a module meets first, where those that are called like the module are not the quickest.

A key is a module, or what its path begins with; the longest one counts.
"""

from __future__ import annotations

_MATRICES = "tests/formulas/test_algebra_matrices.py"
_CHAIN_MATRICES = "tests/formulas/test_chain_matrices.py"
_GROUP_MATRICES = "tests/formulas/test_group_matrices.py"
_KINDS = "tests/formulas/test_kinds.py"
_SAID, _EXACT = "tests/model/test_refusals.py", "tests/model/test_idealised.py"
_ROBOTS = tuple(f"tests/model/test_{name}.py" for name in ("tree", "robot", "robot_coordinates"))
GROUPS = ("tests/groups/test_near.py", "tests/groups/test_so3.py", "tests/groups/test_se3.py")
CHAINS = ("tests/model/test_chain.py", "tests/model/test_chain_laws.py")
DH = tuple(f"tests/formats/test_{name}.py" for name in ("dh_values", "dh_files", "dh", "dh_published"))
_SLOW = "test_every_chain_of_the_real_robots_has_a_table"  # left for the end
_SMALL_ANGLES = (_GROUP_MATRICES, "tests/formulas/test_coefficients.py", *GROUPS)
BY_ARMS = ("tests/solve/test_ik.py", "tests/solve/test_ik_all.py", "tests/solve/test_follow.py")
_BY_BYTES = ("tests/testing/test_bytes_read.py", "tests/testing/test_arguments.py", "tests/testing/test_strategies.py")
_CALIBRATION = {  # of test files of a calibration those that see a module soonest
    "calibrate": ("folds", "calibrate", "refusals", "fitting", "files"),
    "calibration": ("page", "calibrate", "files", "fitting"),
    "losses": ("noise", "fitting", "second_look", "exchange"),
    "page_style": ("page",),
    "points": ("measurements", "data", "noise", "simulated", "choose"),
    "poses": ("measurements", "data", "noise", "simulated", "choose"),
    "problem": ("measurements", "shared_frames", "refusals", "fitting", "calibrate", "choose"),
}
_BY_LAWS = ("tests/testing/test_laws.py", "tests/groups/test_planted.py")
_CASES = tuple(f"tests/testing/conform/test_{name}.py" for name in ("shrink", "false_findings", "subject"))
_COMPARES = tuple(f"tests/analysis/test_{name}.py" for name in ("compare", "compare_figures", "compare_slides"))
_CONFORM = (*_CASES, "tests/testing/conform/test_faults.py")

NEAR: dict[str, tuple[str, ...]] = {
    "poekin/algebra.py": (_MATRICES, _KINDS, _CHAIN_MATRICES, *GROUPS, *CHAINS),
    "poekin/formulas/": (_CHAIN_MATRICES, _KINDS, *CHAINS, *GROUPS),
    "poekin/formulas/coefficients.py": ("tests/formulas/test_coefficients.py", *_SMALL_ANGLES, _KINDS),
    "poekin/formulas/logarithm.py": (*_SMALL_ANGLES, _KINDS),
    "poekin/formulas/quaternion.py": ("tests/formulas/test_quaternion.py", *_SMALL_ANGLES, _KINDS),
    "poekin/formulas/arctangent.py": ("tests/formulas/test_arctangent.py", *_SMALL_ANGLES, _KINDS),
    "poekin/formulas/exponential.py": (
        "tests/formulas/test_exponential_closed.py", _MATRICES, _CHAIN_MATRICES, *_SMALL_ANGLES, _KINDS),
    "poekin/formulas/exp_jacobian.py": (*_SMALL_ANGLES, _KINDS),
    "poekin/formulas/elementary.py": (_KINDS, *_SMALL_ANGLES),
    "poekin/formulas/defect.py": (_MATRICES, "tests/groups/test_batches.py", *_SMALL_ANGLES),
    "poekin/formulas/derivatives.py": (
        "tests/formulas/test_derivative_differences.py", "tests/formulas/test_derivative_counts.py",
        "tests/model/test_derivatives.py"),
    "poekin/formulas/screw_changes.py": (
        "tests/formulas/test_derivative_differences.py", "tests/model/test_derivatives.py"),
    "poekin/formulas/structured.py": ("tests/formulas/test_structured_matrices.py", "tests/model/test_compiled.py"),
    "poekin/formulas/recursive.py": (_CHAIN_MATRICES, _MATRICES, _KINDS, *CHAINS),
    "poekin/formulas/least_squares.py": ("tests/formulas/test_least_squares.py", "tests/formulas/test_kinds.py"),
    "poekin/formulas/dh.py": (_MATRICES, _CHAIN_MATRICES, "tests/formulas/test_dh_route.py", *DH[1:]),
    "poekin/groups/": ("tests/groups/test_values.py", "tests/groups/test_batches.py", "tests/groups/test_objects.py",
                       *GROUPS),
    "poekin/groups/rpy.py": ("tests/groups/test_values.py", "tests/formats/test_rpy.py"),
    "poekin/engine/chain_kernels.py": CHAINS,
    "poekin/engine/group_kernels.py": ("tests/groups/test_values.py", "tests/groups/test_batches.py", *GROUPS),
    "poekin/engine/program.py": ("tests/engine/test_trace.py", "tests/engine/test_interpret.py",
                                 "tests/formulas/test_structured_matrices.py", "tests/model/test_compiled.py"),
    "poekin/engine/specialise.py": ("tests/engine/test_interpret.py", "tests/engine/test_count.py",
                                    "tests/model/test_compiled.py"),
    "poekin/engine/source.py": ("tests/engine/test_cache.py",),
    "poekin/engine/ik_kernels.py": ("tests/engine/test_ik_kernels.py", *BY_ARMS, "tests/solve/test_aims.py"),
    "poekin/engine/ik_all_kernel.py": ("tests/engine/test_ik_kernels.py", "tests/solve/test_ik_all.py"),
    "poekin/engine/follow_kernels.py": ("tests/engine/test_ik_kernels.py", "tests/solve/test_follow.py"),
    **{f"poekin/formats/emit/{name}.py": (f"tests/formats/test_emit_{first}.py", "tests/formats/test_emit_words.py",
                                          "tests/formats/test_emit_python.py", "tests/formats/test_emit_c.py",
                                          "tests/cli/test_emit.py")
       for name, first in (("c", "text"), ("c_selftest", "text"), ("python", "text"), ("statements", "text"),
                           ("vectors", "vectors"), ("words", "words"))},
    "poekin/formats/dh/": (*DH, "tests/formats/test_dh_calibrated.py", f"--deselect={DH[2]}::{_SLOW}"),
    **{f"poekin/solve/calibration/{name}.py": tuple(f"tests/solve/calibration/test_{test}.py" for test in tests)
       for name, tests in _CALIBRATION.items()},
    "poekin/testing/exact.py": ("tests/testing/test_exact.py", "tests/testing/test_attainable.py"),
    "poekin/testing/extended.py": ("tests/testing/test_extended.py", "tests/groups/test_accuracy.py"),
    "poekin/testing/suspects.py": ("tests/testing/test_accuracy_cases.py", "tests/groups/test_accuracy.py"),
    "poekin/testing/accuracy.py": ("tests/testing/test_accuracy_cases.py", "tests/groups/test_accuracy.py"),
    "poekin/testing/group_laws.py": ("tests/testing/test_group_laws.py", *_BY_LAWS),
    "poekin/testing/near_laws.py": ("tests/testing/test_group_laws.py", *_BY_LAWS, "tests/groups/test_near.py"),
    "poekin/testing/measures.py": ("tests/testing/test_laws.py", "tests/testing/test_group_laws.py", *_BY_LAWS),
    "poekin/testing/chain_laws.py": ("tests/testing/test_chain_laws.py", "tests/model/test_chain_laws.py"),
    "poekin/testing/change_laws.py": ("tests/testing/test_chain_laws.py", "tests/model/test_chain_laws.py"),
    "poekin/testing/method_laws.py": ("tests/testing/test_chain_laws.py", "tests/model/test_chain_laws.py"),
    "poekin/testing/derivative_laws.py": ("tests/testing/test_chain_laws.py", "tests/model/test_derivatives.py"),
    **{f"poekin/testing/{name}.py": (f"tests/testing/test_{name}.py", *_BY_BYTES) for name in (
        "chain_strategies", "configuration_strategies", "near_strategies", "robot_strategies", "strategies")},
    "poekin/testing/decoders.py": _BY_BYTES,
    "poekin/testing/planted_changes.py": ("tests/testing/test_planting.py", "tests/analysis/test_compare.py"),
    "poekin/testing/reader.py": _BY_BYTES,
    "poekin/testing/urdf_errors.py": ("tests/formats/test_urdf_text.py", "tests/testing/test_pinocchio_errors.py"),
    "poekin/testing/conform/": _CONFORM,
    **{f"poekin/testing/conform/{name}.py": (f"tests/testing/conform/test_{name}.py", *_CASES) for name in (
        "arm_cases", "confirm", "grades", "group_cases", "named", "plugin", "precision", "small_urdf",
        "subject")},
    "poekin/testing/conform/of_arms.py": ("tests/testing/conform/test_parts.py", *_CASES),
    "poekin/testing/conform/of_groups.py": (
        "tests/testing/conform/test_parts.py", "tests/testing/conform/test_of_groups.py", *_CASES),
    "poekin/testing/conform/calls.py": (
        "tests/testing/conform/test_calls.py", "tests/testing/conform/test_child.py", *_CONFORM),
    "poekin/testing/conform/child.py": (
        "tests/testing/conform/test_calls.py", "tests/testing/conform/test_child.py", *_CASES),
    "poekin/testing/conform/limits.py": (
        "tests/testing/conform/test_calls.py", "tests/testing/conform/test_child.py"),
    "poekin/testing/conform/misspelt.py": ("tests/testing/conform/test_subject.py",),
    "poekin/testing/conform/urdf_cases.py": (
        "tests/testing/conform/test_urdf_cases.py", "tests/testing/conform/test_small_urdf.py", *_CASES),
    "poekin/testing/conform/search.py": (
        "tests/testing/conform/test_search.py", "tests/testing/conform/test_precision.py", *_CASES),
    "poekin/testing/conform/law.py": ("tests/testing/conform/test_urdf_cases.py", *_CASES),
    "poekin/testing/conform/of_urdf.py": (
        "tests/testing/conform/test_of_urdf.py", "tests/testing/conform/test_small_urdf.py", *_CONFORM),
    "poekin/testing/conform/report.py": (
        "tests/testing/conform/test_report.py", *_CONFORM, "tests/testing/conform/test_plugin.py",
        "tests/cli/test_conform.py"),
    "poekin/testing/conform/run.py": ("tests/testing/conform/test_conform_run.py", *_CONFORM),
    "poekin/testing/conform/worker.py": (
        "tests/testing/conform/test_calls.py", "tests/testing/conform/test_child.py"),
    "poekin/engine/rows.py": ("tests/groups/test_batches.py", *CHAINS),
    "poekin/engine/derivative_kernels.py": (
        "tests/model/test_derivatives.py", "tests/model/test_derivatives_pinocchio.py", "tests/model/test_chain.py"),
    "poekin/engine/sincos.py": ("tests/engine/test_sincos.py", "tests/engine/test_interpret.py"),
    "poekin/engine/interpret.py": (
        "tests/engine/test_interpret.py", "tests/engine/test_program.py", "tests/model/test_compiled.py"),
    "poekin/engine/trace.py": (
        "tests/engine/test_trace.py", "tests/engine/test_program.py", "tests/analysis/test_count.py",
        "tests/model/test_compiled.py"),
    "poekin/engine/tree_kernels.py": ("tests/model/test_tree.py", "tests/model/test_robot.py"),
    **{f"poekin/analysis/{name}.py": (f"tests/analysis/test_{first}.py", "tests/analysis/test_results.py", *_COMPARES)
       for name, first in (("comparison", "wording"), ("lines", "lines"), ("reading", "reading"))},
    **{f"poekin/analysis/{name}.py": ("tests/analysis/test_axes.py", "tests/analysis/test_results.py",
                                      "tests/cli/test_axes.py", "tests/analysis/test_compare_extra.py")
       for name in ("axes", "shapes")},
    **{f"poekin/analysis/{name}.py": ("tests/analysis/test_count.py", "tests/analysis/test_results.py",
                                      "tests/cli/test_count.py")
       for name in ("count", "count_methods", "count_scalars", "count_table")},
    **{f"poekin/analysis/{name}.py": (f"tests/analysis/test_{name}.py", "tests/analysis/test_results.py",
                                      f"tests/cli/test_{name}.py")
       for name in ("singularity", "validate")},
    "poekin/model/chain.py": (*CHAINS, _SAID, "tests/model/test_coordinates.py", "tests/model/test_pitches.py"),
    **{f"poekin/model/{name}.py": (*(f"tests/model/test_{first}.py" for first in files), _SAID, *CHAINS)
       for name, *files in (("analytic", "analytic"), ("coordinates", "coordinates", "parts"), ("hp", "hp"),
                            ("derivatives", "derivatives", "derivatives_pinocchio"), ("parts", "parts", "joint"))},
    **{f"poekin/model/{name}.py": (*(f"tests/model/test_{first}.py" for first in files), _SAID, *_ROBOTS)
       for name, *files in (("coupling", "coupling"), ("joint", "joint", "pitches"), ("robot",), ("source",),
                            ("tree",))},
    "poekin/model/local.py": ("tests/model/test_local.py", *CHAINS, "tests/model/test_pitches.py", _EXACT),
    "poekin/model/walk.py": ("tests/model/test_walk.py", "tests/model/test_idealised.py"),
    "poekin/model/idealise.py": ("tests/model/test_idealise.py", "tests/model/test_walk.py", _EXACT),
    "poekin/model/normals.py": ("tests/model/test_walk.py", "tests/model/test_idealised.py", "tests/model/test_hp.py",
                                DH[0], DH[2]),
    "poekin/model/evaluation.py": ("tests/model/test_evaluation.py", _SAID, *CHAINS),
    "poekin/model/compiled.py": (_SAID, "tests/model/test_compiled.py", "tests/model/test_chain_laws.py"),
    "poekin/model/structure.py": ("tests/model/test_structure.py", "tests/model/test_compiled.py"),
    "poekin/model/screw.py": (
        "tests/model/test_screw_values.py", "tests/model/test_screw.py", _SAID, "tests/model/test_pitches.py",
        "tests/model/test_parts.py", *CHAINS),
}  # fmt: skip
