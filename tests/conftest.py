"""How hard the property tests look: HYPOTHESIS_PROFILE=deep, or `make test-deep`, draws twenty times the examples.

In CI both draw the same examples in every run; elsewhere new ones, and what failed is tried first in the next run.
"""

import gc
import os

# Two workers with two threads each for small matrices wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from hypothesis import HealthCheck, settings

# Time decides nothing: a kernel may be compiled within an example, and the machine may be busy.
COMMON = {
    "deadline": None,
    "suppress_health_check": [HealthCheck.too_slow],
    "print_blob": True,
    "derandomize": bool(os.environ.get("CI")),
}

settings.register_profile("quick", max_examples=100, **COMMON)
settings.register_profile("deep", max_examples=2000, **COMMON)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "quick"))


def pytest_collection_finish():
    """Look for garbage more seldom, and never among what was imported: a tenth of the time of all tests."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 50)
