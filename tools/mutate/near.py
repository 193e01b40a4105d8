"""Tests that a mutant meets first, where those called like its module are not the quickest.

A key holds names of modules or of folders, a value names of tests; `names` says what they mean.
`own` stands for the tests that are called like the module; of a folder, those of all of it follow.
"""

from __future__ import annotations

GROUPS = "groups/near groups/so3 groups/se3"
CHAINS = "model/chain model/chain_laws"
_TABLES = "formats/dh_files formats/dh formats/dh_published"
DH = f"formats/dh_values {_TABLES}"
BY_ARMS = "solve/ik solve/ik_all solve/follow"

_KINDS = "formulas/kinds"
_SMALL_ANGLES = (
    f"formulas/exponential formulas/logarithm formulas/exp_jacobian formulas/coefficients {GROUPS}"
)
_ANGLES = f"{_SMALL_ANGLES} {_KINDS}"
_REFUSALS = "model/refusals"
_ROBOTS = f"{_REFUSALS} model/tree model/robot model/robot_coordinates model/peer_names"
_EMITTED = "formats/emit_words formats/emit_python formats/emit_c cli/emit"
_FRAMES = "solve/measurements solve/shared_frames"
_POINTS = "solve/measurements solve/data solve/noise solve/simulated solve/choose"
_BY_BYTES = "testing/bytes_read testing/arguments testing/group_strategies"
_LAWS = "testing/laws groups/planted"
_CASES = "testing/shrink testing/false_findings testing/subject"
_CONFORM = f"{_CASES} testing/faults"
_CALLS = "testing/calls testing/child"
_AXES = "analysis/axes analysis/results cli/axes analysis/compare_extra"
_COUNTS = "analysis/count analysis/results cli/count"
_COMPARES = "analysis/results analysis/compare analysis/compare_figures analysis/compare_slides"
_SCENES = (
    "view/arm_scene view/comparison_scene view/calibration_scene view/path_scene"
    " view/singularity_scene view/solution_scenes view/exaggerated"
)
_DRAWN = "view/limits view/drawn view/scale"
_ERRORS = "sweep/measures/measures sweep/monte_carlo sweep/error_sources"
_MEASURED = "sweep/dexterity sweep/labels sweep/measures/measures sweep/histogram sweep/maps/reach"
_SWEPT = (
    "sweep/cells sweep/samples sweep/sobol sweep/measures/measures sweep/totals sweep/run sweep/top"
    " sweep/histogram sweep/solutions sweep/pose_sweep sweep/self_collision"
)
_TRANSPILED = (
    "engine/statements engine/refusals engine/function_source engine/layout engine/values"
    " engine/translation_unit engine/whole_numbers"
)
_SLOW_LEAVES = (  # left for the end
    "view/kinematics::test_links_and_jacobians_of_all_leaves_of_every_other_example_robot_are_the_robots"
)
_SLOW = "formats/dh::test_every_chain_of_the_real_robots_has_a_table"  # left for the end

NEAR = {
    "__init__": "model/peer_names errors",
    "algebra": f"algebra formulas/forward formulas/recursive formulas/columns {_KINDS} {GROUPS} {CHAINS}",
    "formulas/": f"own {_KINDS} {CHAINS} {GROUPS}",
    "formulas/arctangent formulas/coefficients formulas/quaternion": f"own {_ANGLES}",
    "formulas/damped_step formulas/least_squares formulas/pose_error": f"own {_KINDS}",
    "formulas/circle_conic": f"formulas/conic_of_lines own {_KINDS}",
    "formulas/defect": f"own groups/batches {_SMALL_ANGLES}",
    "formulas/derivatives formulas/screw_changes": "own model/derivatives",
    "formulas/dh": f"own {_TABLES}",
    "formulas/elementary": f"own {_KINDS} {_SMALL_ANGLES}",
    "formulas/exp_jacobian formulas/exponential formulas/logarithm": f"own {_ANGLES}",
    "formulas/structured": "own model/compiled",
    "groups/": f"groups/values groups/batches groups/objects groups/nearest groups/axis_angle {GROUPS}",
    "groups/vectors": "own",
    "groups/rpy": "groups/values formats/rpy",
    "groups/euler": "own formats/poses/numbers formats/rpy",
    "engine/array_io": f"own groups/batches {CHAINS}",
    "engine/chain_kernels": CHAINS,
    "engine/derivative_kernels": "model/derivatives model/derivatives_pinocchio model/chain",
    "engine/follow_kernels": "engine/ik_kernels solve/follow",
    "engine/group_kernels": f"groups/values groups/batches {GROUPS}",
    "engine/ik_all_kernel": "engine/ik_kernels solve/ik_all",
    "engine/ik_kernels": f"engine/solve_one own {BY_ARMS} solve/redundancy",
    "engine/interpret": "own engine/program model/compiled",
    "engine/program": "own engine/trace engine/interpret formulas/structured model/compiled",
    "engine/sincos": "own engine/interpret",
    "engine/source_hash": "engine/cache",
    "engine/specialise": "engine/program engine/interpret engine/count model/compiled",
    "engine/trace": "own engine/program analysis/count model/compiled",
    "engine/transpile/": f"engine/layout {_TRANSPILED}",
    "engine/values engine/c_types engine/translation_unit": f"engine/values {_TRANSPILED}",
    "engine/function_source": f"engine/function_source {_TRANSPILED} engine/array_functions",
    "engine/transpile/arrays/": "engine/array_functions formats/jax",
    "engine/tree_kernels": "model/tree model/robot",
    "model/analytic model/hp model/pose_jacobian": f"own {_REFUSALS} {CHAINS}",
    "model/arm": "own formats/emit_python solve/ik",
    "model/axis_walk": "own model/idealised",
    "model/chain model/chain_data model/outputs": (
        f"{CHAINS} model/chain_data {_REFUSALS} model/coordinates model/pitches"
    ),
    "model/other_frames": (
        f"{CHAINS} model/chain_data model/link_masses model/coupled {_REFUSALS} model/pitches"
    ),
    "model/checks": f"own model/joint model/link_masses {_REFUSALS} {CHAINS}",
    "model/compiled": f"{_REFUSALS} own model/chain_laws",
    "model/configurations": f"model/degrees {_REFUSALS} model/derivatives {CHAINS}",
    "model/coordinates": f"own model/checks {_REFUSALS} {CHAINS}",
    "model/coupling": f"own {_ROBOTS}",
    "model/derivatives": f"own model/derivatives_pinocchio {_REFUSALS} {CHAINS}",
    "model/idealise": "own model/axis_walk model/idealised",
    "model/joint": f"own model/pitches {_ROBOTS}",
    "model/local": f"own {CHAINS} model/pitches model/idealised",
    "model/normals": "model/axis_walk model/idealised model/hp formats/dh_values formats/dh",
    "model/all_poses": f"model/robot model/tree model/degrees {_REFUSALS}",
    "model/provenance": f"own {_ROBOTS}",
    "model/robot model/tree": _ROBOTS,
    "model/sampling": f"model/coupled model/idealise {CHAINS} {_REFUSALS}",
    "model/screw": f"model/screw_values own {_REFUSALS} model/pitches model/checks {CHAINS}",
    "model/unit_screws": f"model/screw_values model/pitches {_REFUSALS}",
    "model/structure": "own model/compiled",
    "formats/dh/": f"{DH} formats/dh_calibrated --deselect={_SLOW}",
    "formats/erd": "formats/load",
    "formats/relinked": "own formats/coupled_files",
    "formats/chain_toml": "own solve/toml_io solve/document formats/dh_calibrated",
    "formats/emit/c formats/emit/c_selftest": f"formats/emit_text {_EMITTED}",
    "formats/emit/python formats/emit/statements": f"formats/emit_text {_EMITTED}",
    "formats/emit/messages": _EMITTED,
    "formats/emit/ik/": (
        "formats/emit_ik/c_ik_text formats/emit_ik/placed_branch formats/emit_ik/c_ik"
    ),
    "formats/emit/correction/": "solve/emission cli/true_joints cli/emit",
    "formats/poses/layout": "formats/poses/numbers formats/pose_rows formats/poses/read cli/poses",
    "formats/emit/vectors": f"formats/emit_vectors {_EMITTED}",
    "solve/calibrate": (
        "solve/cross_validation own solve/refusals solve/fitting solve/toml_io solve/masses"
    ),
    "solve/calibration": (
        "solve/document solve/emission solve/compensation solve/html_report solve/calibrate solve/toml_io"
        " solve/fitting"
    ),
    "solve/circles/": "own solve/fitting",
    "solve/csv_io": "own solve/motions solve/path_result solve/trajectory cli/array_files",
    "solve/effects/search": "own solve/effects/diagnosis solve/outliers_explained solve/calibrate",
    "solve/exact/errors solve/exact/bounds": (
        "solve/judge solve/hints solve/bounds solve/errors solve/digits solve/from_fk cli/exact"
    ),
    "solve/timing": "solve/motions solve/time_optimal solve/path_result solve/follow solve/plot",
    "solve/error_model": (
        "solve/model/problem solve/auto solve/calibrate solve/covariance solve/masses solve/fitting"
    ),
    "solve/ik_all/ik_all": (
        "own solve/swivel solve/ik_all_places solve/ik_all_search solve/ik solve/ik_few_coordinates"
    ),
    "solve/ik_structure/ik_structure solve/neighbours": (
        "solve/ik_structure/cases solve/neighbours solve/ik_structure/ik_structure"
    ),
    "solve/ik_problem": (
        "own solve/coupled_limits solve/chain_cache solve/every_solution solve/ik solve/follow"
        " solve/follower"
    ),
    "solve/losses": "solve/noise solve/fitting solve/refit solve/exchange",
    "view/k3d_objects view/page view/palette view/scene_json": (
        "view/page view/drawn view/scene view/page_parts"
    ),
    "view/mesh_nodes": f"own view/shape_reader {_DRAWN} view/arm_scene",
    "view/kinematics": f"view/arm_scene {_DRAWN} own --deselect={_SLOW_LEAVES}",
    "view/nodes view/scene view/shapes": f"view/shapes view/scene {_DRAWN} {_SCENES}",
    "view/arm view/arm_parts/ view/stage": (
        f"{_DRAWN} view/stage view/axis_lines {_SCENES} view/scene cli/view"
    ),
    "view/regular": f"own {_DRAWN}",
    "view/scenes/calibration": f"view/calibration_scene {_DRAWN}",
    "view/scenes/comparison": f"view/comparison_scene {_DRAWN} view/view",
    "view/scenes/path": f"view/path_scene view/path_parts {_DRAWN}",
    "view/scenes/singular": f"view/singularity_scene {_DRAWN}",
    "view/scenes/solutions view/scenes/targets": f"view/solution_scenes {_DRAWN} view/path_scene",
    "view/exaggerated view/overlay": (
        f"view/exaggerated view/exaggerated_parts {_DRAWN} {_SCENES}"
    ),
    "view/scenes/sweep_map": "view/sweep_map_scene view/view",
    "engine/kernels/sweep/": f"own {_SWEPT}",
    "engine/samples": "own sweep/samples sweep/sobol",
    "engine/tiles": "own sweep/cells sweep/tile_centres",
    "sweep/error_program": f"sweep/measures/error_program {_ERRORS}",
    "sweep/error_sources": "sweep/error_sources_parts own",
    "sweep/pose_uncertainty": f"sweep/dexterity {_ERRORS} sweep/totals",
    "sweep/measures/dexterity sweep/measure sweep/measures/names": _MEASURED,
    "sweep/joints": f"own {_MEASURED}",
    "sweep/bins": "own sweep/histogram sweep/top sweep/histogram_parts sweep/top_parts",
    "sweep/cells": "own sweep/cells_borders sweep/pose_samples sweep/sweep_map",
    "sweep/fused": "sweep/solutions sweep/self_collision sweep/run sweep/totals",
    "sweep/base_placement": "own",
    "sweep/histogram": "own sweep/histogram_parts sweep/pose_maps",
    "sweep/labelled sweep/map_files": "sweep/map_files sweep/map_files_parts",
    "sweep/maps/reach": "sweep/reach_parts own",
    "sweep/top": "own sweep/top_parts sweep/pose_maps",
    "sweep/covering": "sweep/covering_parts own sweep/self_collision",
    "sweep/spheres sweep/touching": "sweep/spheres sweep/self_collision_parts sweep/self_collision",
    "sweep/samples": "sweep/samples_parts own sweep/sobol sweep/histogram",
    "sweep/pose_samples": "own sweep/samples_parts sweep/pose_maps sweep/maps/reach",
    "sweep/self_collision": "sweep/self_collision_parts own sweep/covering",
    "sweep/store": "sweep/store_files own",
    "sweep/execution/run": "sweep/run_parts own sweep/pose_sweep",
    "sweep/totals": (
        "own sweep/totals_poses sweep/totals_calls sweep/run sweep/top sweep/top_parts sweep/pose_sweep"
    ),
    "sweep/tile_centres": "own",
    "sweep/sweep_map": (
        "sweep/sweep_map_parts own sweep/pose_maps sweep/map_files sweep/self_collision sweep/maps/reach"
    ),
    "view/view": "own",
    "cli/__init__ cli/__main__ cli/commands": "cli/run cli/pipes",
    "cli/arm": "cli/fk cli/units cli/poses cli/run cli/options",
    "cli/calibration/outputs": "cli/calibrate cli/apply cli/calibrate_options cli/options",
    "cli/histogram": "cli/top cli/sweep_options",
    "cli/jacobian": "cli/fk cli/coupling cli/options cli/run",
    "cli/fk": "own cli/units cli/poses",
    "cli/follow": "own cli/follow_told cli/pages_told cli/poses_units cli/units cli/options cli/fastest_files",
    "cli/ik": "own cli/ik_told cli/pages_told cli/poses_units cli/units cli/options",
    "cli/show": "own cli/reach cli/options",
    "cli/sweep/options": "cli/sweep_options cli/options cli/reach cli/top",
    "cli/measured": "own cli/measured_told cli/repeats cli/calibrate",
    "cli/model": "own cli/coupling cli/vendor_files cli/from_ros cli/poses cli/options",
    "cli/poses": "own cli/poses_units cli/options cli/ik cli/units",
    "cli/draw": "own cli/compare",
    "cli/view": "own",
    "engine/tree": "own model/link_program",
    "html_page": "own solve/html_report",
    "solve/last_result": "own solve/fitting",
    "checks": "own model/refusals solve/refusals solve/choose analysis/axes",
    "solve/reweighted solve/flatness": "own solve/initial_guess_parts solve/initial_guess",
    "solve/measurement": f"{_POINTS} own solve/most_likely solve/bounds solve/cross_validation",
    "solve/path_events": "solve/path_interval solve/path_result solve/coupled_limits solve/follow view/path_scene",
    "solve/points solve/poses": _POINTS,
    "solve/calibration/result": "solve/uncertainty solve/calibrate solve/html_report solve/toml_io",
    "solve/summary": (
        "solve/report/summary solve/unknown_points_told solve/uncertainty solve/calibrate solve/toml_io"
    ),
    "solve/problem": (
        f"own {_FRAMES} solve/refusals solve/outliers_explained solve/fitting solve/calibrate solve/choose"
        " solve/residual_vectors"
    ),
    "solve/fitted_problem": (
        "solve/refusals solve/fitting solve/calibrate solve/compensation solve/covariance"
    ),
    "solve/residual_vectors": "own solve/unknown_points",
    "solve/separations": "own solve/unknown_points",
    "analysis/axes analysis/shapes": _AXES,
    "analysis/axis_lines": f"own analysis/lines {_COMPARES}",
    "analysis/compare/compare": (
        f"{_COMPARES} analysis/length_unit analysis/rpy_degrees analysis/mirror"
    ),
    "analysis/comparison": f"own analysis/messages {_COMPARES}",
    "analysis/count analysis/count_methods": _COUNTS,
    "analysis/count_scalars analysis/count_table": _COUNTS,
    "analysis/findings": f"analysis/links analysis/messages {_COMPARES}",
    "analysis/hypotheses analysis/lines": f"own {_COMPARES}",
    "analysis/singularity": "own analysis/results cli/singularity",
    "analysis/validate": "own analysis/results cli/validate",
    "testing/bytes_reader testing/decoders": _BY_BYTES,
    "testing/chain_strategies testing/configuration_strategies": f"own {_BY_BYTES}",
    "testing/arrays testing/batch_strategies": _BY_BYTES,
    "testing/group_strategies testing/near_strategies": f"own {_BY_BYTES}",
    "testing/robot_strategies": f"own {_BY_BYTES}",
    "testing/adjoint_laws": f"testing/group_laws {_LAWS}",
    "testing/exact": "own testing/error_bounds",
    "testing/exact_chain": "model/law_bounds model/derivatives",
    "testing/exact_jacobians testing/exact_numbers": "testing/exact testing/error_bounds",
    "testing/group_laws": f"own {_LAWS}",
    "testing/pinocchio_urdf": "testing/pinocchio_oracle",
    "testing/measures": f"testing/laws testing/group_laws {_LAWS}",
    "testing/conform/": _CONFORM,
    "testing/conform/arm_cases testing/conform/group_cases": f"own {_CASES}",
    "testing/conform/calls": f"{_CALLS} {_CONFORM}",
    "testing/conform/child": f"{_CALLS} {_CASES}",
    "testing/conform/confirm testing/conform/grades": f"own {_CASES}",
    "testing/conform/law": f"testing/urdf_cases {_CASES}",
    "testing/conform/limits testing/conform/worker": _CALLS,
    "testing/conform/declarations testing/conform/misspelt": "testing/subject",
    "testing/conform/named testing/conform/plugin testing/conform/precision": f"own {_CASES}",
    "testing/conform/of_arms": f"testing/parts {_CASES}",
    "testing/conform/of_groups": f"testing/parts own {_CASES}",
    "testing/conform/of_urdf": f"own testing/small_urdf {_CONFORM}",
    "testing/conform/report": f"own {_CONFORM} testing/plugin cli/conform",
    "testing/conform/run": f"testing/conform_run {_CONFORM}",
    "testing/conform/search": f"own testing/precision {_CASES}",
    "testing/conform/small_urdf testing/conform/subject": f"own {_CASES}",
    "testing/conform/urdf_cases": f"own testing/small_urdf {_CASES}",
}

# Claims about many modules, which are met last; where nothing is said, those of all.
EVERYWHERE = "defaults frozen"
LAST = {
    "solve/": f"{EVERYWHERE} solve/shapes",
    "solve/calibration/": f"{EVERYWHERE} solve/shapes solve/brief",
}
