"""Examples of the property tests: the same everywhere in `make test`, forty times as many new in
`make test-deep`.

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
    """Let a seed be stronger than the profile that has its own."""
    if config.getoption("--hypothesis-seed", None) is not None:
        settings.register_profile("seeded", settings(), derandomize=False)
        settings.load_profile("seeded")


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
