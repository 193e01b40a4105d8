"""How hard the property tests look: HYPOTHESIS_PROFILE=deep draws twenty times the examples of the default, quick."""

import os

from hypothesis import HealthCheck, settings

# Time decides nothing: a kernel may be compiled within an example, and the machine may be busy.
COMMON = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow], "print_blob": True}

settings.register_profile("quick", max_examples=100, derandomize=bool(os.environ.get("CI")), **COMMON)
settings.register_profile("deep", max_examples=2000, **COMMON)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "quick"))
