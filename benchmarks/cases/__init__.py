"""The topics of the report by section, in order; a new topic is one file here and one line below.

Each is a module with `topic(quick, say) -> Topic`: quick asks for a shorter run, say prints a line
of progress.
"""

from . import (
    accuracy,
    accuracy_by_angle,
    accuracy_hunted,
    calibration,
    calibration_claim,
    calibration_coverage,
    calibration_franka,
    calibration_outliers,
    calibration_poses,
    calibration_time,
    calibration_ur5,
    compile_time,
    compiled,
    compiled_robots,
    conformance,
    derivatives,
    exp_log,
    exponential_table,
    follow,
    ik_all,
    ik_all_time,
    inverse_kinematics,
    model_truth_compare,
    model_truth_robots,
    model_truth_tables,
    operation_counts,
    panda_hand,
    peers,
    robots,
    robustness,
    scaling,
    start,
    sweep,
)

_SECTIONS = {
    "Paper": (operation_counts, exponential_table),
    "Truth": (
        accuracy,
        accuracy_by_angle,
        accuracy_hunted,
        derivatives,
        conformance,
        model_truth_tables,
        model_truth_robots,
        model_truth_compare,
    ),
    "Speed": (
        peers,
        panda_hand,
        scaling,
        exp_log,
        compiled,
        compiled_robots,
        compile_time,
        start,
        sweep,
    ),
    "Solve": (inverse_kinematics, ik_all, ik_all_time, follow),
    "Calibrate": (
        calibration,
        calibration_claim,
        calibration_coverage,
        calibration_outliers,
        calibration_franka,
        calibration_ur5,
        calibration_time,
        calibration_poses,
    ),
    "Robots": (robots, robustness),
}
TOPICS = {
    module.__name__.rpartition(".")[2]: module
    for modules in _SECTIONS.values()
    for module in modules
}
SECTION_OF = {
    module.__name__.rpartition(".")[2]: section
    for section, modules in _SECTIONS.items()
    for module in modules
}
OPENING = (
    "operation_counts",
    "accuracy_by_angle",
    "peers",
    "inverse_kinematics",
    "calibration_claim",
)
"""The topics whose pictures answer the questions at the top of the page: a quick look at them comes
first.
"""
UNTIMED = (
    "calibration_poses",
    "calibration_coverage",
    "accuracy_hunted",
    "derivatives",
    "accuracy_by_angle",
    "ik_all",
    "calibration_outliers",
    "robots",
    "model_truth_compare",
    "accuracy",
    "calibration_claim",
    "model_truth_robots",
    "calibration_franka",
    "calibration_ur5",
    "calibration",
    "model_truth_tables",
    "operation_counts",
)
"""The topics that hold no bar of time and start no processes of their own, the longest first: they
run side by side, and before any that is timed.
"""
