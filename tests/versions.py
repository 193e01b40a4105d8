"""What a test needs of another package: its version, or the test is skipped by name."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version

import pytest
from packaging.version import Version

# Which example is left after shrinking is Hypothesis' affair: older versions stop at larger ones.
SHRINKS = "6.165"


def needs(package: str, least: str) -> None:
    """Skip the test that calls this unless the package is installed in this version or a newer one."""
    try:
        found = version(package)
    except PackageNotFoundError:
        pytest.skip(f"the package {package} is not installed")
    if Version(found) < Version(least):
        pytest.skip(f"{package} {least} or newer is not installed, but {found}")
