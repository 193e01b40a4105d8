"""The topics of the report, in order; a new topic is one file here and one line below.

Each is a module with `topic(quick, say) -> Topic`: quick asks for a shorter run, say prints a line of progress.
"""

from . import (
    accuracy,
    accuracy_by_angle,
    compile_time,
    compiled,
    compiled_robots,
    derivatives,
    exp_log,
    exponential_table,
    follow,
    ik_all,
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
)

TOPICS = {
    "robots": robots,
    "accuracy": accuracy,
    "accuracy_by_angle": accuracy_by_angle,
    "model_truth_tables": model_truth_tables,
    "model_truth_robots": model_truth_robots,
    "model_truth_compare": model_truth_compare,
    "derivatives": derivatives,
    "operation_counts": operation_counts,
    "exponential_table": exponential_table,
    "compiled": compiled,
    "compile_time": compile_time,
    "compiled_robots": compiled_robots,
    "peers": peers,
    "scaling": scaling,
    "panda_hand": panda_hand,
    "inverse_kinematics": inverse_kinematics,
    "exp_log": exp_log,
    "ik_all": ik_all,
    "follow": follow,
    "start": start,
    "robustness": robustness,
}
