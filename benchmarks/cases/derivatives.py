"""Derivatives: rate and Hessian of the Jacobian against Pinocchio, of the pose by its screws
against 80 digits.
"""

from __future__ import annotations

import time
import warnings
from dataclasses import dataclass

import numpy as np

from poekin import Chain, load
from poekin.analysis.validate import routes
from poekin.errors import PoekinWarning
from poekin.formats.erd import example_robots
from poekin.formats.load import BUILT_IN
from poekin.model.kinematics.pose_jacobian import FRAME_NAMES
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle

from ..derivative_errors import DerivativeErrors, derivative_errors
from ..draw import dots
from ..exact_derivatives import home_changes, screw_changes
from ..report import Figure, Table, Topic

BAR, SCREW_BAR = 1e-13, 1e-12


@dataclass(frozen=True)
class ScrewErrors:
    """One arm's worst absolute errors of df f⁻¹ (by motion, by entries, by the home pose) and of
    dJ.
    """

    arm: str
    joints: int
    motion: float
    entries: float
    home: float
    columns: float


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    robots = list(example_robots()[0].items())[:: 6 if quick else 1]
    done: list[tuple[str, list[DerivativeErrors], float]] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        for number, (name, path) in enumerate(robots, 1):
            start = time.process_time()
            robot = load(path)
            with open(path, "rb") as stream:
                oracle = PinocchioOracle(stream.read())
            chains = [robot.chain(base, tip) for base, tip, _ in routes(robot)]
            done.append(
                (
                    name,
                    [derivative_errors(chain, oracle, 3) for chain in chains],
                    time.process_time() - start,
                )
            )
            if number % 10 == 0:
                say(f"{number} of {len(robots)} robots")
        arms = arms_of_the_catalogue()[:: 4 if quick else 1]
        screws = [screw_errors(name, chain) for name, chain in arms]
    every = [errors for _, chains, _ in done for errors in chains]
    kinds = {
        "dJ/dt": [e.rate for e in every],
        "dJ/dq (Hessian)": [e.hessian for e in every],
        "acceleration": [e.acceleration for e in every],
    }
    pose = [max(e.motion, e.entries, e.home) for e in screws]
    return Topic(
        "Derivatives: rate and Hessian of the Jacobian, and of the pose by its screws",
        f"{len(every)} chains of {len(robots)} robots, from the root to each leaf, in all three frames, at the zero "
        "configuration and two random ones, rates uniform in ±1, against Pinocchio's time variation and kinematic "
        "Hessian of the tip's frame and its accelerations; linear rows ÷ R. Then the catalogue's arms: the change of "
        "the pose with each screw (moved by conjugation, and by its six entries) and with the home pose, against "
        "central differences on the group in 80 digits, step 1e-20, at one random configuration.",
        figures=[
            *(
                Figure(f"{what} against Pinocchio, worst of all chains and frames", worst(errors), BAR, "R",
                       note=f"{len(errors)} chains")
                for what, errors in kinds.items()
            ),
            Figure(
                "df f⁻¹ by each screw and by the home pose against differences in 80 digits, worst", worst(pose),
                SCREW_BAR, note=f"{len(screws)} arms of the catalogue, {sum(e.joints for e in screws)} screws",
            ),
            Figure(
                "dJ by each screw and by the home pose, three frames, against the same, worst",
                worst([e.columns for e in screws]), SCREW_BAR,
            ),
        ],
        pictures=[
            dots("dJ/dt and dJ/dq: worst error of each chain ÷ R, in ascending order; exact at the lower edge",
                 [max(e.rate, e.hessian) for e in every], BAR, x_label="chain", y_label="error ÷ R"),
        ],
        tables=[
            Table(
                "Robots", ("robot", "chains", "dJ/dt ÷ R", "dJ/dq ÷ R", "acceleration ÷ R", "processor time (s)"),
                [(name, len(errors), *map(float, np.max(np.array(errors), axis=0)), seconds)
                 for name, errors, seconds in done if errors],
                folded=True,
            ),
            Table(
                "Screws of the catalogue's arms", ("arm", "joints", "by motion", "by entries", "by home pose", "dJ"),
                [(e.arm, e.joints, e.motion, e.entries, e.home, e.columns) for e in screws],
                folded=True,
            ),
        ],
    )  # fmt: skip


def worst(errors: list[float]) -> float | None:
    """The largest error, NaN if one is; None where there is none."""
    return float(np.max(errors)) if errors else None


def arms_of_the_catalogue() -> list[tuple[str, Chain]]:
    """The arms that have one chain and a joint, by name."""
    found = []
    for name in BUILT_IN:
        robot = load(name)
        chain = robot.chain(tip=robot.leaves[0])
        if chain.dof:
            found.append((name, chain))
    return found


def screw_errors(name: str, chain: Chain) -> ScrewErrors:
    """One arm at a random configuration within ±3 rad or m."""
    q = np.random.default_rng(0).uniform(-3, 3, chain.dof)
    motion, entries = chain.screw_derivatives(q), chain.screw_derivatives(q, wrt="components")
    columns = [chain.jacobian_screw_derivatives(q, frame) for frame in FRAME_NAMES]
    home = home_changes(chain, q)
    errors = []
    for i in range(len(chain.joint_names)):
        truth = screw_changes(chain, q, i)
        off = (
            [motion.screws[:, i] - truth.twist],
            [entries.screws[:, i] - truth.components],
            [motion.home - home.twist],
            [c.screws[:, :, i] - t for c, t in zip(columns, truth.columns, strict=True)]
            + [c.home - t for c, t in zip(columns, home.columns, strict=True)],
        )
        errors.append([max(float(np.abs(x).max()) for x in part) for part in off])
    return ScrewErrors(name, len(errors), *map(float, np.max(errors, axis=0)))
