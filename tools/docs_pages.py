"""Live pages of docs/: models and results of poekin as pages that move, and a still of each.

Run it to look at them: python -m tools.docs_pages DIRECTORY. Without a directory it makes README.md's
picture anew.
"""

from __future__ import annotations

import functools
import io
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np

import poekin as pk
from poekin.view import Page

OTHER, MARKED, PALE = "#0072B2", "#D55E00", "#9a9a9a"
PANDA = (0.0, -0.5, 0.0, -2.0, 0.0, 1.6, 0.8)
UR5E = (0.4, -1.2, 1.5, -0.3, 0.8, 0.0)
README_PICTURE = Path(__file__).parent.parent / "docs" / "_static" / "panda.svg"
TIGHT = {"bbox_inches": "tight", "pad_inches": 0.05}
ENLARGED = 20
"""Factor by which the stills draw a difference of two arms."""

Made = tuple[Page, Any]
"""A page, and a figure of Matplotlib."""


@functools.cache
def arm(name: str, tip: str) -> pk.Chain:
    """A chain of a built-in robot."""
    return pk.load(name).chain(tip=tip)


def skeleton(figure: Any, chain: pk.Chain, q: Any, color: str = PALE, width: float = 1.5) -> None:
    """Draws the chain at one more configuration."""
    points = np.array([np.zeros(3), *chain.joint_poses(q)[:, :3, 3], chain.fk(q)[:3, 3]])
    figure.axes[0].plot(*points.T, color=color, linewidth=width, zorder=2)


def arrows(figure: Any, places: Any, vectors: Any, color: str) -> None:
    """Draws vectors (n, 3) at places (n, 3), m."""
    figure.axes[0].quiver(*np.transpose(places), *np.transpose(vectors), color=color, linewidth=1.2)


def fit(figure: Any, points: Any) -> None:
    """Makes the axes hold points (n, 3), m, in equal scales."""
    low, high = np.min(points, axis=0), np.max(points, axis=0)
    half = 0.55 * np.max(high - low)
    box = np.stack([(low + high) / 2 - half, (low + high) / 2 + half], axis=1)
    figure.axes[0].set(xlim=box[0], ylim=box[1], zlim=box[2])


def panda() -> Made:
    """The Panda, with its meshes where example-robot-data is installed."""
    page = pk.view(pk.load("panda"), q=[*PANDA, 0.02])
    return page, arm("panda", "panda_hand").plot(PANDA)


def ur5e() -> Made:
    """The UR5e as a chain."""
    chain = arm("ur5e", "tool0")
    return pk.view(chain, q=UR5E), chain.plot(UR5E)


def stanford() -> Made:
    """The Stanford arm: its third joint slides."""
    chain = pk.load("stanford").chain()
    q = [0.4, 0.5, 0.4, 0.3, 0.6, 0.0]
    return pk.view(chain, q=q), chain.plot(q)


def lifted(chain: pk.Chain, height: float) -> pk.Chain:
    """The chain whose fourth axis is too high by a height, m."""
    screws = chain.screws.copy()
    screws[3] = pk.se3.adjoint(pk.se3.exp([0, 0, 0, 0, 0, height])) @ screws[3]
    return chain.replace(screws=screws)


def compare() -> Made:
    """Two Pandas, one of which has an axis 3.2 mm too high and stands elsewhere."""
    chain = arm("panda", "panda_hand")
    moved = lifted(chain, 0.0032).rebased(pk.se3.exp([0, 0, 0.3, 0.1, 0, 0]))
    figure = chain.plot(PANDA)
    skeleton(figure, lifted(chain, ENLARGED * 0.0032), PANDA, MARKED, 2.5)
    return pk.view(pk.compare(chain, moved), q=PANDA), figure


def calibrated() -> Made:
    """A UR10e as its factory measured it, over the nominal one."""
    nominal = pk.dh.published("ur10e")
    own = pk.ur.add_deltas(
        nominal,
        delta_theta=[-2.41e-07, 1.60233952, -1.68607191, 0.0837331148, -1.01e-07, 3.9e-08],
        delta_d=[-0.000160188, 439.140974080, -446.027059806, 6.886186896, -3.87e-05, -0.000879083],
        delta_a=[2.12e-05, 0.632017133, 0.002298336, -4.61e-05, -6.39e-05, 0],
        delta_alpha=[-0.000650247, 0.001394167, 0.006938188, -0.000811642, 0.000411121, 0],
    )
    true = pk.ur.from_dh(own, nominal=nominal).to_chain()
    chain = pk.dh.to_chain(nominal)
    figure = chain.plot(UR5E)
    moves = ENLARGED * (true.screws - chain.screws)
    seen = pk.Chain.from_space(pk.screw.normalised(chain.screws + moves), true.home)
    skeleton(figure, seen, UR5E, MARKED, 2.5)
    return pk.view(pk.compare(chain, true, strict=True), q=UR5E), figure


def path() -> Made:
    """A straight line that the Panda's hand follows."""
    chain = arm("panda", "panda_hand")
    start = chain.fk(PANDA)
    end = start.copy()
    end[:3, 3] += [0.1, 0.5, -0.2]
    t = np.linspace(0, 4, 150)
    found = pk.follow(chain, pk.motion.line(start, end, t / 4), times=t)
    figure = chain.plot(found.q[0])
    for k in (37, 75, 112, 149):
        skeleton(figure, chain, found.q[k])
    figure.axes[0].plot(*chain.fk(found.q)[:, :3, 3].T, color=OTHER, linewidth=2)
    return pk.view(found), figure


def solutions() -> Made:
    """Every solution of one pose of a UR5e."""
    chain = arm("ur5e", "tool0")
    found = pk.ik_all(chain, chain.fk(UR5E), method="search")
    figure = chain.plot(found.solutions[0])
    for q in found.solutions[1:]:
        skeleton(figure, chain, q, OTHER, 1.2)
    fit(figure, [p for q in found.solutions for p in chain.joint_poses(q)[:, :3, 3]])
    return pk.view(found), figure


def target() -> Made:
    """A pose as a controller writes it, and joints that reach it."""
    chain = arm("panda", "panda_hand")
    found = pk.ik(chain, pk.poses.from_numbers([400, 200, 350, 30, 10, 170], "kuka"))
    return pk.view(found), chain.plot(found.q)


def singularity() -> Made:
    """The Panda stretched, and the motion that is lost."""
    chain = arm("panda", "panda_hand")
    found = pk.singularity(chain, np.zeros(7))
    figure = chain.plot(found.q)
    twist = found.singular_subspace[0]
    arrows(figure, chain.fk(found.q)[None, :3, 3], 0.3 * twist[None, :3], MARKED)
    return pk.view(found), figure


def workspace() -> Made:
    """What a UR5e reaches, and from how many directions."""
    chain = arm("ur5e", "tool0")
    found = pk.sweep.reach(chain, resolution=0.1, samples=1_000_000, side=2)
    figure = chain.plot(UR5E)
    points = found.cells.centres()[found.reached]
    shares = found.capability[found.reached]
    layer = np.abs(points[:, 1]) <= 0.5 * found.cells.resolution
    figure.axes[0].scatter(*points[layer].T, c=shares[layer], s=12, linewidths=0, depthshade=False)
    fit(figure, points)
    return pk.view(found), figure


def calibration() -> Made:
    """A Panda calibrated from 60 measured poses, with what is left of their errors."""
    chain = arm("panda", "panda_hand")
    made = pk.calibration.simulated(chain, 60, kind="poses", noise=(1e-4, 1e-4), seed=1)
    found = pk.calibrate(chain, made.q, made.measurements, folds=0)
    figure = chain.plot(PANDA)
    if found.residuals is not None:  # which a calibration out of a file is without
        places = found.residuals.places
        fit(figure, [*places, np.zeros(3)])
        arrows(figure, places, ENLARGED * found.residuals.before, MARKED)
        arrows(figure, places, ENLARGED * found.residuals.after, OTHER)
    return pk.view(found), figure


def humanoid() -> Made:
    """A humanoid of example-robot-data, all branches, without meshes."""
    robot = pk.load("erd:talos_full_v2")
    poses = robot.fk(np.zeros(robot.dof))
    figure = robot.chain(tip=robot.root).plot()
    for joint in robot.joints:
        ends = np.array([poses[joint.parent][:3, 3], poses[joint.child][:3, 3]])
        figure.axes[0].plot(*ends.T, color=PALE, linewidth=3, solid_capstyle="round")
    fit(figure, [pose[:3, 3] for pose in poses.values()])
    return pk.view(robot, meshes=False), figure


def cloud() -> Made:
    """A UR5e and 3000 places that its tool reaches."""
    chain = arm("ur5e", "tool0")
    figure = chain.plot(UR5E)
    points = chain.fk(chain.random(0, size=800))[:, :3, 3]
    figure.axes[0].scatter(*points.T, s=3, color=OTHER, alpha=0.5, linewidths=0, depthshade=False)
    fit(figure, points)
    return pk.view(chain, q=UR5E, cloud=3000), figure


EXAMPLES: dict[str, Callable[[], Made]] = {
    example.__name__: example
    for example in (
        panda,
        ur5e,
        stanford,
        humanoid,
        cloud,
        compare,
        calibrated,
        calibration,
        path,
        target,
        solutions,
        singularity,
        workspace,
    )
}
"""What is shown, by the name of its page."""


def svg_of(figure: Any, **how: Any) -> str:
    """A figure of Matplotlib as SVG text, the same for the same figure; how: as for `savefig`."""
    out = io.StringIO()
    with matplotlib.rc_context({"svg.hashsalt": "poekin"}):
        figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None}, **how)
    return out.getvalue()


def write(folder: Path, names: Iterable[str] = EXAMPLES) -> None:
    """Write NAME.html and NAME.svg of each example into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in names:
        page, figure = EXAMPLES[name]()
        page.save(folder / f"{name}.html")
        (folder / f"{name}.svg").write_text(svg_of(figure, **TIGHT), encoding="utf-8")


def readme_picture() -> str:
    """The picture that the first code of README.md makes, as SVG text."""
    return svg_of(arm("panda", "panda_hand").plot(PANDA, size=(4, 4)))


if __name__ == "__main__":
    if sys.argv[1:]:
        write(Path(sys.argv[1]))
    else:
        README_PICTURE.write_text(readme_picture(), encoding="utf-8")
