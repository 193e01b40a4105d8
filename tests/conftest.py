"""Examples of the property tests: the same everywhere in `make test`, forty times as many new in
`make test-deep`. Files that `make test` leaves to `make test-all`.

`--hypothesis-seed=N` draws others in either; CONTRIBUTING.md says how to keep one that fails.
"""

import gc
import importlib.metadata
import os

# Two workers with two threads each for small matrices wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest
from hypothesis import HealthCheck, settings
from hypothesis.internal import conjecture

from poekin.errors import MissingExtra

# Time decides nothing: a kernel may be compiled within an example, and the machine may be busy.
COMMON = {
    "deadline": None,
    "suppress_health_check": [HealthCheck.too_slow],
    "print_blob": True,
}
KEEP = """A failing example shows a fault of the code or of the bound. Mend it and keep the example: write it above its
test as @example(...), with the values printed; where st.data() drew it, write these values into a test of their own.
Until then @reproduce_failure(...) repeats it alone, and the next run of the deep profile tries it first."""

SLOW = (
    # browsers, notebooks, pages of the documentation, compilers
    *("test_notebooks.py", "test_docs.py", "view/browser", "view/web", "view/test_kinematics.py"),
    *("formats/emit_ik/test_c_ik.py", "formats/test_emit_c.py"),
    *("formats/emit_sweep/test_cuda.py", "formats/emit_sweep/test_by_jax.py"),
    # processes, one or many a test
    *("cli/test_pipes.py", "cli/test_run.py", "cli/test_conform.py", "cli/test_from_ros.py"),
    *("engine/jit/test_cache.py", "test_examples.py", "tools/test_fuzz.py", "tools/test_mutate.py"),
    *("testing/conform/process/test_child.py", "testing/conform/test_plugin.py"),
    *("sweep/execution/test_store.py", "sweep/execution/test_every_processor.py"),
    *("sweep/execution/test_dask.py", "cli/sweep/test_scheduler.py"),
    *("testing/conform/test_faults.py", "testing/conform/test_libraries.py"),
    # topics of the report, and other libraries
    *("benchmarks/test_report.py", "benchmarks/test_accuracy_by_angle.py"),
    *("benchmarks/test_inverse_kinematics.py", "groups/test_accuracy.py", "groups/test_objects.py"),
    # searches, and every robot of example-robot-data
    *("analysis/compare/test_planted.py", "analysis/compare/test_compare_extra.py"),
    *("analysis/compare/test_compare_slides.py", "analysis/compare/test_length_unit.py"),
    *("analysis/compare/mistakes/test_mirror.py", "analysis/compare/mistakes/test_rpy_degrees.py"),
    *("solve/ik_structure/test_ik_structure.py", "solve/calibration/design/test_choose.py"),
    *(
        "solve/calibration/fit/test_initial_guess.py",
        "solve/calibration/report/test_html_report.py",
        "solve/calibration/causes/test_wrong_data.py",
        "solve/calibration/diagnostics/effects/test_false_alarms.py",
        "solve/calibration/fit/test_coverage.py",
        "solve/calibration/fit/test_cubes.py",
        "solve/calibration/design/test_true_error.py",
    ),
    *("formats/urdf_in_place/test_in_place.py", "formats/relink/test_relinked.py"),
    *("formats/test_urdf_text.py", "cli/formats/test_draw.py"),
    *(
        "analysis/test_validate.py::test_every_root_to_leaf_chain_of_every_example_robot_is_taken",
        "formats/ros/test_description.py::test_the_robots_of_example_robot_data_come_through",
        "formats/test_dh.py::test_every_chain_of_the_real_robots_has_a_table",
        "formats/test_load.py::test_every_robot_of_example_robot_data_is_read",
        "model/kinematics/test_pose_jacobian.py::test_no_joint_of_a_real_robot_looks_helical",
        "model/test_idealised.py::test_chains_of_every_real_robot",
        "solve/ik_all/test_closed_form.py::test_no_solution_of_the_robots_of_example_robot_data",
        "view/meshes/test_find.py::test_every_mesh_of_example_robot_data",
    ),
    # 60 digits at degenerate inputs
    *("formulas/ik/test_circle_conic.py", "formulas/ik/test_two_circles.py"),
    "formulas/ik/test_three_parallel.py",
)
"""Files, folders and tests, below tests/, of three fifths of the time and an eighth of the tests;
`make test-all` runs them too.
"""

# In samples of mutants 50 examples let none through that 100 see. Where one number of many
# matters, as where a formula changes over, the test asks for twice as many.
settings.register_profile("quick", max_examples=50, derandomize=True, **COMMON)
settings.register_profile("few", max_examples=20, derandomize=True, **COMMON)
settings.register_profile("deep", max_examples=2000, **COMMON)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "quick"))

# Hypothesis also draws the numbers in the source of the modules loaded so far: they differ by
# worker, by the tests that are chosen, and by the name of the directory.
providers = getattr(conjecture, "providers", None)  # in newer versions of Hypothesis
if providers is not None and hasattr(providers, "_get_local_constants"):
    no_constants = type(providers._local_constants)()
    providers._get_local_constants = lambda: no_constants


def pytest_configure(config):
    """Name the marker of slow files; let a seed be stronger than the profile that has its own."""
    config.addinivalue_line(
        "markers", "slow: left to `make test-all`; see SLOW in tests/conftest.py"
    )
    if config.getoption("--hypothesis-seed", None) is not None:
        settings.register_profile("seeded", settings(), derandomize=False)
        settings.load_profile("seeded")


def pytest_collection_modifyitems(items):
    """Mark the tests of slow files."""
    for item in items:
        below = item.nodeid.removeprefix("tests/")
        if below.startswith(SLOW):
            item.add_marker(pytest.mark.slow)


def pytest_terminal_summary(terminalreporter):
    """Say how to keep an example that was drawn and will not be drawn again."""
    if terminalreporter.stats.get("failed") and not settings().derandomize:
        terminalreporter.write_line(KEEP)


def pytest_collection_finish():
    """Look for garbage more seldom, and never among what was imported: a tenth of the time of all
    tests.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 50)


def _skip_without_its_package():
    """A test that wants a package which is not installed, as Pinocchio is not to be had on Windows,
    is skipped.
    """
    try:
        return (yield)
    except MissingExtra as missing:
        if _installed(missing.package):
            raise
        pytest.skip(f"the package {missing.package} is not installed (extra {missing.extra})")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup(item):
    return (yield from _skip_without_its_package())


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    return (yield from _skip_without_its_package())


def _installed(package: str) -> bool:
    try:
        importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return False
    return True
