"""What must work with an installed poekin and its core dependencies alone; `wheel_check.py` runs it
elsewhere.
"""

import subprocess
import sys
from importlib.metadata import distribution
from pathlib import Path

OPTIONAL = (
    "pinocchio",
    "scipy",
    "hypothesis",
    "mpmath",
    "typer",
    "rich",
    "matplotlib",
    "jinja2",
    "yaml",
    "sympy",
)


def expect(holds: bool, what: str) -> None:
    if not holds:
        sys.exit(f"not so with the installed wheel: {what}")


tree = Path(sys.argv[1]).resolve()

import numpy as np  # noqa: E402

import poekin as pk  # noqa: E402

home = Path(pk.__file__).resolve().parent
expect(not home.is_relative_to(tree), f"poekin comes from the environment and not from {tree}")
expect((home / "py.typed").exists(), "the package is marked as typed")
expect(
    distribution("poekin").version == pk.__version__,
    f"__version__ is {distribution('poekin').version}",
)

robot = pk.load("panda")
arm = (
    robot.chain(tip="panda_hand")
    if "panda_hand" in robot.links
    else robot.chain(tip=robot.leaves[0])
)
q = arm.random(np.random.default_rng(1), size=5)
T = arm.fk(q)
J = arm.jacobian(q, frame="body")
expect(
    T.shape == (5, 4, 4) and J.shape == (5, 6, arm.dof),
    f"poses {T.shape} and Jacobians {J.shape} of five configurations",
)
R = T[:, :3, :3]
expect(
    np.allclose(R @ R.swapaxes(-1, -2), np.eye(3), rtol=0, atol=1e-14),
    "the rotations are orthonormal",
)
expect(np.allclose(arm.fk(np.zeros(arm.dof)), arm.home, rtol=0, atol=1e-14), "f(0) = M")
expect(np.allclose(pk.se3.exp(pk.se3.log(T)), T, rtol=0, atol=1e-14), "exp(log T) = T")

expect(len(pk.dh.published("puma560")) == 6, "the published tables are in the wheel")

loaded = sorted(name for name in OPTIONAL if name in sys.modules)
expect(not loaded, f"no optional package was imported (found: {', '.join(loaded)})")

command = Path(sys.executable).parent / "poekin"
asked = subprocess.run([command, "--help"], text=True, capture_output=True)
expect(
    asked.returncode == 2,
    f"`poekin` without its extra ends with exit code 2 (it was {asked.returncode})",
)
expect(
    "poekin[cli]" in asked.stderr, f"`poekin` without its extra names the extra: {asked.stderr!r}"
)
expect(
    "Traceback" not in asked.stderr,
    f"`poekin` without its extra shows no traceback: {asked.stderr}",
)

print(
    f"poekin {pk.__version__} works from the wheel: {robot.name}, {arm.dof} coordinates, tip {arm.tip}"
)
