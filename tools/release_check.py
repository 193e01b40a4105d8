"""Build the source distribution and the wheel twice, and leave them in dist/ if both builds are the
same to the byte.

Run by `make release-check`. The second build is made from the first's source distribution, in
another directory, time zone and umask: so it is the same as the tree's, and its wheel too. Then
twine looks at both as an index would.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import tomllib
import zipfile
from collections.abc import Mapping
from email import message_from_string
from pathlib import Path

try:
    from tools.wheel_check import ROOT, faults_of_sdist, faults_of_wheel
except ModuleNotFoundError:  # run as a file
    from wheel_check import ROOT, faults_of_sdist, faults_of_wheel  # pyright: ignore[reportMissingImports]


def when() -> str:
    """SOURCE_DATE_EPOCH: as it is set, else the time of the last commit, else hatchling's own
    (2020-02-02).
    """
    if given := os.environ.get("SOURCE_DATE_EPOCH"):
        return given
    asked = subprocess.run(
        ["git", "log", "-1", "--format=%ct"], cwd=ROOT, text=True, capture_output=True
    )
    return asked.stdout.strip() or "1580601600"


def build(tree: Path, out: Path, kind: str, mask: int, zone: str) -> Path:
    """The distribution of this kind ("sdist" or "wheel") of a source tree."""
    environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
    environment |= {"SOURCE_DATE_EPOCH": when(), "TZ": zone}
    # No isolation: the build uses the pinned hatchling of this environment.
    command = [
        sys.executable,
        "-m",
        "build",
        "--no-isolation",
        f"--{kind}",
        "--outdir",
        str(out),
        str(tree),
    ]
    done = subprocess.run(
        command, cwd=out.parent, env=environment, text=True, capture_output=True, umask=mask
    )
    if done.returncode:
        sys.exit(f"{done.stdout}{done.stderr}the {kind} of {tree} was not built")
    (made,) = out.glob("*.whl" if kind == "wheel" else "*.tar.gz")
    return made


def faults_of_two(first: Path, second: Path) -> list[str]:
    """Where two builds of one distribution differ."""
    same = first.name == second.name and first.read_bytes() == second.read_bytes()
    return (
        []
        if same
        else [f"{first.name} and {second.name}, built anew elsewhere, are not the same to the byte"]
    )


def faults_of_metadata(text: str, project: Mapping) -> list[str]:
    """Where the metadata of a wheel say something else than pyproject.toml."""
    said = message_from_string(text)
    wanted = {
        "Name": project["name"],
        "Version": project["version"],
        "Requires-Python": project["requires-python"],
        "License-Expression": project["license"],
        "Description-Content-Type": "text/markdown",
    }
    faults = [
        f"metadata: {k} {said[k]!r}, and not {v!r}" for k, v in wanted.items() if said[k] != v
    ]
    lists = {
        "Classifier": project["classifiers"],
        "Provides-Extra": project["optional-dependencies"],
    }
    for key, values in lists.items():
        faults += [f"metadata: no {key} {v}" for v in values if v not in said.get_all(key, [])]
    return faults if said.get_payload() else [*faults, "metadata: no description"]


def main() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    with tempfile.TemporaryDirectory(prefix="poekin-release-") as place:
        first, second = Path(place) / "first", Path(place) / "second" / "dist"
        first.mkdir()
        second.mkdir(parents=True)
        print("Building from the tree, and from its source distribution", flush=True)
        sdist, wheel = (
            build(ROOT, first, "sdist", 0o022, "UTC"),
            build(ROOT, first, "wheel", 0o022, "UTC"),
        )
        with tarfile.open(sdist) as t:
            names = t.getnames()
            t.extractall(second.parent, filter="data")
        unpacked = second.parent / sdist.name.removesuffix(".tar.gz")
        again = [
            build(unpacked, second, kind, 0o077, "Asia/Kathmandu") for kind in ("sdist", "wheel")
        ]
        with zipfile.ZipFile(wheel) as z:
            metadata = z.read(f"poekin-{project['version']}.dist-info/METADATA").decode()
            faults = (
                faults_of_wheel(z.namelist())
                + faults_of_sdist(names)
                + faults_of_metadata(metadata, project)
            )
        for one, other in zip((sdist, wheel), again, strict=True):
            faults += faults_of_two(one, other)
        if faults:
            sys.exit("\n".join(faults))
        if subprocess.run(
            [sys.executable, "-m", "twine", "check", "--strict", sdist, wheel]
        ).returncode:
            sys.exit("twine does not take them")
        (ROOT / "dist").mkdir(exist_ok=True)
        for made in (sdist, wheel):
            shutil.copy(made, ROOT / "dist")
            print(f"{hashlib.sha256(made.read_bytes()).hexdigest()}  dist/{made.name}")


if __name__ == "__main__":
    main()
