"""Parts of a page that need no browser: links, numbers as words, labels apart, arrows, screws."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from tests.view.web.page_scripts import run

u = 2.0**-53


def ask(tmp_path: Any, imports: str, script: str, **given: Any) -> Any:
    return run(tmp_path, f"{imports}\n{script}", given)


def test_a_link_gives_back_every_bit_of_the_configuration(tmp_path):
    rng = np.random.default_rng(3)
    rows = rng.normal(size=(200, 7)) * 10.0 ** rng.integers(-300, 300, (200, 7))
    script = "print(given.q.map((q) => fromHash(toHash({ q, selectedTip: 2 }), 7)));"
    found = ask(tmp_path, 'import { fromHash, toHash } from "./main.js";', script, q=rows)
    assert np.array_equal(np.array([one["q"] for one in found], float), rows)
    assert {one["tip"] for one in found} == {2}


def test_a_link_that_is_no_configuration_is_passed_over(tmp_path):
    hashes = ["", "#q=", "#q=1,2", "#q=1,,3", "#q=1,2,x", "#q=1,2,Infinity"]
    script = "print(given.hashes.map((hash) => fromHash(hash, 3)));"
    found = ask(tmp_path, 'import { fromHash } from "./main.js";', script, hashes=hashes)
    assert found == [{"q": None, "tip": 0}] * len(hashes)


def test_labels_are_shown_unless_they_meet_one_that_is_shown(tmp_path):
    rng = np.random.default_rng(5)
    corner = rng.uniform(0, 400, (80, 2))
    size = rng.uniform([20, 10], [90, 20], (80, 2))
    boxes = [
        {"left": x, "top": y, "right": x + w, "bottom": y + h}
        for (x, y), (w, h) in zip(corner.tolist(), size.tolist(), strict=True)
    ]
    script = "print(apart(given.b.map((box) => [box]), [], 3).map((box) => box !== null));"
    taken = ask(tmp_path, 'import { apart } from "./labels.js";', script, b=boxes)
    shown = [k for k, one in enumerate(taken) if one]

    def meet(a: dict[str, float], b: dict[str, float]) -> bool:
        across = a["left"] < b["right"] + 3 and b["left"] < a["right"] + 3
        return across and a["top"] < b["bottom"] + 3 and b["top"] < a["bottom"] + 3

    assert 10 < len(shown) < 80
    for k, box in enumerate(boxes):
        met = any(meet(box, boxes[j]) for j in shown if j < k)
        assert met is (k not in shown)


def test_a_label_takes_the_first_place_that_is_free_of_buttons_and_of_labels_before_it(tmp_path):
    def box(left: float, top: float) -> dict[str, float]:
        return {"left": left, "top": top, "right": left + 10, "bottom": top + 10}

    lists = [[box(0, 0), box(20, 0)], [box(0, 0), box(22, 0), box(40, 0)], [box(40, 5)], []]
    script = "print(apart(given.lists, [given.button], 3));"
    found = ask(
        tmp_path, 'import { apart } from "./labels.js";', script, lists=lists, button=box(-5, -5)
    )
    assert found == [box(20, 0), box(40, 0), None, None]


def test_a_camera_sees_all_points_and_is_as_near_as_it_can_be(tmp_path):
    """By the planes that bound the view: a point is as far inside as slope times depth is more than
    its distance aside. The rounding is that of a few operations on numbers up to 30.
    """
    rng = np.random.default_rng(21)
    clouds = rng.normal(size=(40, 30, 3)) * 10.0 ** rng.uniform(-1, 0.5, (40, 1, 3))
    slopes = {"right": 0.4, "left": 0.3, "above": 0.15, "below": 0.25}
    script = "print(given.clouds.map((points) => framed(points, given.slopes, 0.01)));"
    script_of = 'import { framed } from "./drawing.js";'
    found = ask(tmp_path, script_of, script, clouds=clouds, slopes=slopes)
    for points, eye in zip(clouds, np.array(found), strict=True):
        x, y, depth = (np.array([1, 1, -1]) * (points - eye)).T
        inside = [0.4 * depth - x, 0.3 * depth + x, 0.15 * depth - y, 0.25 * depth + y]
        right, left, above, below = np.min(inside, axis=1)
        assert min(right, left, above, below) >= -1e-13
        assert min(right + left, above + below) <= 1e-13  # it touches both planes of a pair
        assert abs(right - left) <= 1e-13  # the other pair is as far off on both sides
        assert abs(above - below) <= 1e-13
    flat = np.array([[[0.0, 0.0, 2.0]]])
    (eye,) = ask(tmp_path, script_of, script, clouds=flat, slopes=slopes)
    assert eye[2] == 2.01


def test_numbers_are_words_without_a_negative_zero(tmp_path):
    script = """const { fixed, figures } = words;
        print([fixed(-1e-9, 4), fixed(-1.5, 2), fixed(NaN, 2), fixed(-Infinity, 2),
               figures(0, 4), figures(0.012345, 3), figures(-1.5e-7, 3), figures(123456, 3)]);"""
    found = ask(tmp_path, 'import * as words from "./panel/elements.js";', script)
    assert found == ["0.0000", "−1.50", "–", "−∞", "0", "0.0123", "−1.50e−7", "1.23e+5"]


def test_an_arrow_lies_along_its_vector_and_is_no_mirror(tmp_path):
    rng = np.random.default_rng(7)
    d = np.r_[rng.normal(size=(50, 3)), np.eye(3), -np.eye(3), np.zeros((1, 3))]
    script = """const T = Float64Array.of(0, -1, 0, 5, 1, 0, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1);
        print(given.d.map((d) => arrowMatrix(T, d, 2)));"""
    found = ask(tmp_path, 'import { arrowMatrix } from "./drawing.js";', script, d=d)
    for M, vector in zip(np.array(found).reshape(-1, 4, 4), d, strict=True):
        assert np.abs(M[:3, 2] - 2 * vector).max() <= 20 * u
        length = np.linalg.norm(2 * vector)
        assert np.abs(M[:3, :3].T @ M[:3, :3] - length**2 * np.eye(3)).max() <= 40 * u * 36
        assert np.linalg.det(M[:3, :3]) >= 0
        assert (M[:3, 3] == ([5, 6, 7] if length else 0)).all()


def test_the_floor_has_lines_of_a_round_length(tmp_path):
    x = 10.0 ** np.random.default_rng(9).uniform(-6, 6, 300)
    script = "print(given.x.map(roundLength));"
    found = np.array(ask(tmp_path, 'import { roundLength } from "./drawing.js";', script, x=x))
    assert ((found <= x * (1 + 4 * u)) & (found > x / 2.5)).all()
    assert {f"{y:.0e}"[0] for y in found} == {"1", "2", "5"}


def test_screws_are_read_off_the_jacobian(tmp_path):
    chain = pk.load("ur5e").chain(tip="tool0")
    q = chain.random(11, 5)
    script = "print(given.T.map((T, k) => screwsOf(T, Float64Array.from(given.J[k]))));"
    given = {"T": chain.fk(q).reshape(5, 16), "J": chain.jacobian(q, "hybrid").reshape(5, 36)}
    found = ask(tmp_path, 'import { screwsOf } from "./panel/numbers.js";', script, **given)
    for screws, A in zip(found, chain.jacobian(q, "space"), strict=True):
        got = np.array([[*screw["w"], *screw["v"]] for screw in screws]).T
        assert np.abs(got - A).max() <= 30 * u
        for screw in screws:
            w, v, p = (np.array(screw[name]) for name in ("w", "v", "point"))
            assert np.abs(np.cross(p, w) + screw["pitch"] * w - v).max() <= 30 * u


def test_only_a_tip_that_a_sliding_joint_moves_has_shorter_arrows(tmp_path):
    script = """const scene = { size: 0.5, arms: [{
            coordinates: [{ unit: "rad" }, { unit: "m" }],
            tips: [{ coordinates: [0] }, { coordinates: [0, 1] }] }] };
        print([0, 1].map((tip) => arrowScales(scene, tip).v));"""
    found = ask(tmp_path, 'import { arrowScales } from "./drawing.js";', script)
    assert found == [0.35, 0.1]


def test_the_worst_direction_is_weighed_by_the_reach_of_the_arm_whatever_the_scene_s_size(tmp_path):
    chain = pk.load("ur5e").chain(tip="tool0")
    q = chain.random(2)
    script = """
        const { T, J, reach } = given;
        const tip = { T, J: Float64Array.from(J), coordinates: [0, 1, 2, 3, 4, 5], part: "pose", rank: 6, reach };
        const sliders = given.limits.map(([lower, upper]) => ({ lower, upper }));
        const scene = { size: 40 * reach, arms: [{ coordinates: sliders }] };
        print([
            numbersOf(scene, given.q, tip).singular.twist,
            rulePose({ rule: "singular" }, tip, scene, { v: 1, w: 1 }),
        ]);"""
    twist, drawn = ask(
        tmp_path,
        'import { numbersOf } from "./panel/numbers.js"; import { rulePose } from "./drawing.js";',
        script,
        T=chain.fk(q).ravel(),
        J=chain.jacobian(q, "hybrid").ravel(),
        q=q,
        limits=chain.limits,
        reach=chain.reach,
    )
    wanted = pk.singularity(chain, q).singular_direction
    # the next singular value is a third away: a vector turns by a few u
    np.testing.assert_allclose(twist, wanted, rtol=0, atol=1e-13)
    w, v = wanted[:3], wanted[3:] / chain.reach
    larger = max(w, v, key=np.linalg.norm)
    arrow = np.array(drawn).reshape(4, 4)[:3, 2]
    assert np.linalg.norm(arrow) == pytest.approx(1.5, rel=1e-14)  # one and a half of a rad/rad
    unit = arrow / np.linalg.norm(arrow)
    np.testing.assert_allclose(unit, larger / np.linalg.norm(larger), rtol=0, atol=1e-13)


def test_the_nearest_limit_is_told_in_the_unit_of_the_tip_s_own_coordinate(tmp_path):
    arm = {
        "coordinates": [{"unit": "m"}, {"unit": "rad"}],
        "tips": [{"coordinates": [1]}, {"coordinates": [0, 1]}],
    }
    script = """
    const told = (selectedTip, limits, names) => Numbers.prototype.limit.call(
        { poekin: { selectedTip } }, Math.min(...limits), { limits }, names, given.arm);
    print([told(0, [0.5], ["elbow"]), told(1, [0.25, 0.5], ["lift", "elbow"])]);"""
    found = ask(tmp_path, 'import { Numbers } from "./panel/numbers.js";', script, arm=arm)
    assert found == ["28.6° (elbow)", "0.2500 m (lift)"]


def test_a_motion_is_named_for_its_larger_part_in_the_arm_s_own_length(tmp_path):
    twists = [[0, 0, 0.3, 0.2, 0, 0], [0, 0, 0.1, 0.2, 0, 0]]
    script = "print(given.twists.map((twist) => directionWords(twist, 0.5)));"
    found = ask(
        tmp_path, 'import { directionWords } from "./panel/numbers.js";', script, twists=twists
    )
    assert found == ["along (1.00, 0.00, 0.00)"] * 2
    script = "print(given.twists.map((twist) => directionWords(twist, 1)));"
    folder = tmp_path / "metre"
    folder.mkdir()
    found = ask(
        folder, 'import { directionWords } from "./panel/numbers.js";', script, twists=twists
    )
    assert found == ["turning about (0.00, 0.00, 1.00)", "along (1.00, 0.00, 0.00)"]
