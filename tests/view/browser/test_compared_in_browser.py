"""The page of a comparison in a browser: what is red is the joint that `compare` names."""

from __future__ import annotations

import io

import numpy as np
import pytest

import poekin as pk

pytest.importorskip("k3d", reason="no k3d: no page was opened")
Q = [0, -0.5, 0, -2.0, 0, 1.6, 0.8]
JOINT = 3
ARM = pk.load("panda").chain(tip="panda_hand")
RED = "#d55e00"


@pytest.fixture(scope="module")
def found():
    """Two models of which one axis is 3 mm off."""
    screws = ARM.screws.copy()
    screws[JOINT] = pk.se3.adjoint(pk.se3.exp([0, 0, 0, 0, 0, 0.003])) @ screws[JOINT]
    return pk.compare(ARM, ARM.replace(screws=screws))


@pytest.fixture(scope="module")
def opened(open_page, found):
    return open_page(pk.view(found, q=Q))


def differing(opened):
    """Objects of the layer of differences, with the place on the screen of each."""
    objects = opened.ask("poekin.scene.objects")
    return [o for o in objects if o["layer"] == "differences"]


def test_the_red_joint_of_words_labels_and_drawn_objects_is_the_one_that_compare_names(
    opened, found
):
    (joint,) = found.differing
    (sentence,) = found.findings
    assert joint.number == JOINT + 1
    words = opened.ask(
        "[...document.querySelectorAll('#poekin-panel p')].map((p) => p.textContent)"
    )
    assert [w for w in words if w.lower() == sentence.lower()]
    seen = opened.ask("""[...document.querySelectorAll(".label")]
        .filter((e) => e.checkVisibility({ visibilityProperty: true })).map((e) => e.textContent)""")
    (label,) = [text for text in seen if text in ARM.joint_names]
    assert label == joint.name_b
    objects = differing(opened)
    assert {name for o in objects for name in o["names"]} == {sentence}
    assert {(o["color"], o["role"], o["arm"]) for o in objects} == {(RED, "differs", 1)}
    red = [o for o in opened.ask("poekin.scene.objects") if o["role"] == "differs"]
    assert len(red) == len(objects)
    cells = opened.ask("""[...document.querySelectorAll("table")]
        .map((t) => [...t.querySelectorAll("tr")].map((r) => [...r.children].map((c) => c.textContent)))""")
    rows = [row for table in cells for row in table if "DIFFERS" in row]
    assert [row[1] for row in rows] == [joint.name_b]


def test_the_axis_is_drawn_where_k_times_the_difference_puts_it(opened):
    number = next(o["id"] for o in differing(opened) if o["kind"] == "line")
    script = """([id, k]) => { poekin.k = k; poekin.set(poekin.q);
        return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() =>
            done([...poekin.K.getObjectById(id).matrixWorld.elements])))); }"""
    at = {k: np.reshape(opened.ask(script, [number, k]), (4, 4)).T for k in (1, 10, 20)}
    carried = ARM.replace(home=np.eye(4), screws=ARM.screws).joint_poses(Q)
    rest = ARM.joint_poses(np.zeros(7))
    # the link before the joint, by its displacement from where it is at q = 0
    before = carried[JOINT - 1] @ pk.se3.inverse(rest[JOINT - 1])
    for k, M in at.items():
        true = before @ pk.se3.exp([0, 0, 0, 0, 0, 0.003 * k])
        np.testing.assert_allclose(M, true, atol=1e-9)


def test_its_red_is_on_the_screen_and_gone_with_its_layer(opened):
    image = pytest.importorskip("PIL.Image", reason="no Pillow: no screenshot was looked at")

    def red() -> int:
        opened.settle()
        shot = opened.tab.locator("#canvasTarget").screenshot()
        pixels = np.asarray(image.open(io.BytesIO(shot)).convert("RGB")).astype(int)
        r, g, b = np.moveaxis(pixels, -1, 0)
        return int(((r > 120) & (r > 1.7 * g) & (g > 1.5 * b)).sum())

    opened.ask("() => { poekin.show('frames', false); poekin.show('labels', false); }")
    with_it = red()
    opened.ask("poekin.show('differences', false)")
    without = red()
    opened.ask("poekin.show('differences', true)")
    assert with_it > without + 100
