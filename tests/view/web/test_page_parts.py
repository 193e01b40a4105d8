"""Parts of a page that need no browser: links, numbers as words, labels apart, arrows, screws."""

from __future__ import annotations

from typing import Any

import numpy as np

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
    shown = ask(
        tmp_path, 'import { apart } from "./labels.js";', "print(apart(given.b, 3));", b=boxes
    )

    def meet(a: dict[str, float], b: dict[str, float]) -> bool:
        across = a["left"] < b["right"] + 3 and b["left"] < a["right"] + 3
        return across and a["top"] < b["bottom"] + 3 and b["top"] < a["bottom"] + 3

    assert 10 < len(shown) < 80
    for k, box in enumerate(boxes):
        met = any(meet(box, boxes[j]) for j in shown if j < k)
        assert met is (k not in shown)


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
