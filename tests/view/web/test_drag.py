"""The tool dragged in the page: reached within limits, and said so where it is not."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.formats.erd import example_robots
from tests.formats.urdf_in_place.in_place_cases import longest
from tests.view.web.page_scripts import run, sliders, write_kinematics

REACHED = 1e-6  # m and rad
COUNT = 100
ARMS = ("panda", "ur5e", "puma560", "scara", "kinova", "gantry")
SCRIPT = """
import { drag, follow, reach, solve } from "./drag.js";
import { fk_jacobian_hybrid } from "./chain.js";
const tip = { fk_jacobian: (q) => fk_jacobian_hybrid(q) };
const moved = given.sliders.map((_, k) => k);
const limits = { ...page.limitsOf(given.sliders), size: given.size };
const middle = page.spread(given.sliders, 0);
"""


@functools.cache
def arm(name: str) -> pk.Chain:
    """An arm with limits, of a robot's file, of a table, or of screws."""
    rx, rz = [-1, 0, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0]
    home = np.eye(4)
    home[:3, 3] = 0.75, 0, 0.3
    arms: dict[str, Any] = {
        "panda": lambda: pk.load("panda").chain(tip="panda_hand"),
        "ur5e": lambda: pk.load("ur5e").chain(tip="tool0"),
        "puma560": lambda: pk.dh.to_chain(pk.dh.published("puma560")),
        "scara": lambda: pk.Chain.from_space(
            [rz, [0, 0, 1, 0, -0.4, 0], [0, 0, 0, 0, 0, -1], [0, 0, -1, 0, 0.75, 0]],
            home,
            limits=[[-2.3, 2.3], [-2.5, 2.5], [0, 0.2], [-np.pi, np.pi]],
        ),
        "kinova": lambda: longest(pk.load(example_robots()[0]["kinova"])),
        "gantry": lambda: pk.Chain.from_space(
            [*np.eye(6)[3:], rz, rx], home, limits=[[0, 3], [0, 2], [-1, 0], [-3, 3], [-1.5, 1.5]]
        ),
    }
    if name == "kinova" and "kinova" not in example_robots()[0]:
        pytest.skip("example-robot-data has no kinova: it was not dragged")
    return arms[name]()


def ask(tmp_path: Any, chain: pk.Chain, script: str, **given: Any) -> Any:
    write_kinematics(chain, tmp_path / "chain.js")
    own = {"sliders": sliders(chain), "size": chain.reach}
    return run(tmp_path, SCRIPT + script, own | given)


def errors(chain: pk.Chain, q: Any, targets: np.ndarray) -> np.ndarray:
    """Distance (m) and angle (rad) of the tool from each target."""
    T = chain.fk(np.array(q))
    turns = np.swapaxes(T[..., :3, :3], -1, -2) @ targets[..., :3, :3]
    away = np.linalg.norm(T[..., :3, 3] - targets[..., :3, 3], axis=-1)
    return np.stack([away, np.linalg.norm(pk.so3.log(turns), axis=-1)], axis=-1)


def is_within_limits(chain: pk.Chain, q: Any) -> bool:
    lower, upper = chain.limits.T
    return bool(((np.array(q) >= lower) & (np.array(q) <= upper)).all())


@pytest.mark.parametrize("name", ARMS)
def test_poses_that_can_be_reached_are_reached_from_the_middle_of_the_limits(name, tmp_path):
    chain = arm(name)
    targets = chain.fk(chain.random(30, COUNT))
    script = "print(given.T.map((T) => reach(tip, middle, T, moved, given.sliders, given.size)));"
    found = ask(tmp_path, chain, script, T=targets.reshape(COUNT, 16))
    reached = np.array([one["reached"] for one in found])
    assert reached.sum() >= 0.99 * COUNT
    q = [one["q"] for one in found]
    true = errors(chain, q, targets)
    assert is_within_limits(chain, q)
    # what the page says of itself is what Python finds, but for the rounding of both
    said = np.array([[one["error"]["position"], one["error"]["rotation"]] for one in found])
    assert np.abs(said - true).max() <= 1e-13
    assert ((true <= REACHED).all(axis=1) == reached).all()


@pytest.mark.parametrize("name", ["panda", "ur5e", "scara"])
def test_a_point_is_reached_with_the_rotation_left_free(name, tmp_path):
    chain = arm(name)
    targets = chain.fk(chain.random(31, 50))
    points = targets[:, :3, 3]
    script = "print(given.p.map((p) => reach(tip, middle, p, moved, given.sliders, given.size)));"
    found = ask(tmp_path, chain, script, p=points)
    assert all(one["reached"] for one in found)
    assert errors(chain, [one["q"] for one in found], targets)[:, 0].max() <= REACHED


@pytest.mark.parametrize("name", ["panda", "ur5e"])
def test_a_pose_out_of_reach_is_said_to_be_and_the_nearest_is_kept(name, tmp_path):
    chain = arm(name)
    q0 = chain.random(32)
    far = chain.fk(q0)[None].copy()
    far[0, :3, 3] *= 3 * chain.reach / np.linalg.norm(far[0, :3, 3])
    script = """
    const found = reach(tip, given.q0, given.T, moved, given.sliders, given.size);
    print([found, follow(tip, given.q0, given.T, moved, limits)]);"""
    both = ask(tmp_path, chain, script, T=far[0].ravel(), q0=q0)
    sizes = [np.hypot(*one["error"].values()) for one in both]
    assert sizes[0] <= sizes[1]
    for found in both:
        assert not found["reached"]
        assert is_within_limits(chain, found["q"])
        away, turned = errors(chain, [found["q"]], far)[0]
        assert found["error"]["position"] == pytest.approx(away, rel=1e-12)
        assert found["error"]["rotation"] == pytest.approx(turned, abs=1e-12)
        assert 2 * chain.reach <= away <= 3 * chain.reach


def test_a_way_of_small_steps_has_no_jump(tmp_path):
    chain = arm("panda")
    q = [0.3, -0.6, 0.2, -2.0, 0.4, 1.7, 0.5]
    t = np.linspace(0, 2 * np.pi, 200)
    targets = np.tile(chain.fk(q), (200, 1, 1))
    targets[:, 1, 3] += 0.15 * np.sin(t)
    targets[:, 2, 3] -= 0.15 * (1 - np.cos(t))
    script = """
    let q = given.q;
    print(given.T.map((T) => {
        const found = follow(tip, q, T, moved, { ...limits, steps: 12 });
        q = found.q;
        return found;
    }));"""
    found = ask(tmp_path, chain, script, T=targets.reshape(200, 16), q=q)
    assert all(one["reached"] for one in found)
    ways = np.abs(np.diff([one["q"] for one in found], axis=0)).max()
    # the tool goes 5 mm a step; 10 rad per m is less than the arm needs near a singularity
    assert ways <= 0.05


def test_a_coordinate_stays_at_its_limit_while_the_others_go_on(tmp_path):
    chain = arm("ur5e").replace(limits=[[-3, 3], [-2, 0], [0, 2.5], [-3, 3], [-3, 3], [-3, 3]])
    q = np.array([0.4, -1.0, 2.5, -1.5, -1.5, 0.2])  # the elbow is at its limit
    target = chain.fk(q)[None]
    start = q + np.array([0.3, -0.3, -0.2, 0.2, 0.3, -0.4])
    script = "print(follow(tip, given.q, given.T, moved, limits));"
    found = ask(tmp_path, chain, script, T=target[0].ravel(), q=start)
    assert found["reached"]
    assert is_within_limits(chain, found["q"])
    assert errors(chain, [found["q"]], target).max() <= REACHED


def test_a_step_never_makes_the_error_larger_and_ends_where_none_makes_it_smaller(tmp_path):
    chain = arm("ur5e").replace(limits=[[-0.5, 0.5]] * 6)
    q = chain.random(35, 40)
    T = chain.fk(arm("ur5e").random(36, 40))  # hardly one within these limits
    script = """
    const ways = given.T.map((T, k) => [1, 2, 4, 8, 400].map((steps) =>
        solve(tip, given.q[k], T, moved, { ...limits, steps })));
    print(ways.map((way) => way.map(({ q, error }) => {
        const { J } = tip.fk_jacobian(q);
        return { q, error, J, e: page.poseError(tip.fk_jacobian(q).T, given.T[ways.indexOf(way)]) };
    })));"""
    for way in ask(tmp_path, chain, script, T=T.reshape(40, 16), q=q):
        sizes = [np.hypot(*one["error"].values()) for one in way]
        assert (np.diff(sizes) <= 1e-12).all()
        end = np.array(way[-1]["q"])
        slope = np.reshape(way[-1]["J"], (6, 6)).T @ way[-1]["e"]
        outward = (np.abs(end) >= 0.5) & (slope * end > 0)
        # the error changes by slope² near a least one: 1e-12 of itself
        assert np.abs(slope[~outward]).max(initial=0) <= 1e-6 * sizes[-1]


def test_a_long_way_ends_where_its_small_steps_lead(tmp_path):
    chain = arm("ur5e")
    starts = 0.7 * chain.random(38, 60)
    targets = chain.fk(chain.random(39, 60))
    script = """
    const dense = (q, T) => {
        let found = { q, reached: true };
        for (let k = 1; k <= 300 && found.reached; k++) {
            const pose = page.between(tip.fk_jacobian(q).T, T, k / 300);
            found = solve(tip, found.q, pose, moved, limits);
        }
        return found;
    };
    print(given.T.map((T, k) => [dense(given.q[k], T), follow(tip, given.q[k], T, moved, limits)]));"""
    found = ask(tmp_path, chain, script, T=targets.reshape(60, 16), q=starts)
    ends = [(dense["q"], way["q"]) for dense, way in found if dense["reached"]]
    assert len(ends) >= 15  # the others leave the workspace on the way
    same = [np.abs(np.subtract(*pair)).max() <= 1e-3 for pair in ends]
    # beside a singularity a step of 0.15 rad takes the other branch at times
    assert np.mean(same) >= 0.8


def test_coordinates_that_do_not_move_the_tip_stay(tmp_path):
    chain = arm("ur5e")
    targets = chain.fk(chain.random(33, 30))
    script = """
    const branch = { fk_jacobian: (q) => fk_jacobian_hybrid([q[2], q[4], q[1], q[7], q[6], q[5]]) };
    const places = [2, 4, 1, 7, 6, 5];
    const all = Array(8).fill({ unit: "rad", lower: null, upper: null });
    places.forEach((place, k) => { all[place] = given.sliders[k]; });
    print(given.T.map((T) => reach(branch, Array(8).fill(0.3), T, places, all, 1)));"""
    found = ask(tmp_path, chain, script, T=targets.reshape(30, 16))
    assert all(one["reached"] for one in found)
    q = np.array([one["q"] for one in found])
    assert (q[:, [0, 3]] == 0.3).all()
    own = q[:, [2, 4, 1, 7, 6, 5]]
    assert is_within_limits(chain, own)
    assert errors(chain, own, targets).max() <= REACHED


def test_dragging_moves_the_page_to_what_was_found(tmp_path):
    chain = arm("ur5e")
    targets = chain.fk(chain.random(34, 2))
    script = """
    globalThis.poekinKinematics = [{ tips: [null, tip] }];
    const scene = { size: 1, arms: [{ coordinates: given.sliders, tips: [null, { coordinates: moved }] }] };
    const poekin = { scene, selectedTip: 1, q: Float64Array.from(middle), set(q) { this.q.set(q); } };
    print(given.T.map((T) => [drag(poekin, T), [...poekin.q]]));"""
    given = [targets[0].ravel().tolist(), targets[1, :3, 3].tolist()]
    (pose, q_pose), (point, q_point) = ask(tmp_path, chain, script, T=given)
    assert pose["reached"]
    assert point["reached"]
    assert (pose["q"], point["q"]) == (q_pose, q_point)
    assert errors(chain, [q_pose], targets[:1]).max() <= REACHED
    assert errors(chain, [q_point], targets[1:])[0, 0] <= REACHED
