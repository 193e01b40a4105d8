"""Pages of models and results in a browser: tables fit, labels keep off buttons, what is shown is seen."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.analysis.compare.comparison import Comparison

pytest.importorskip("k3d", reason="no k3d: no page was opened")
ARM = pk.load("ur5e").chain()
Q = np.array([0, -1.2, 1.4, -1.7, -1.57, 0])
STRETCHED = [0, -1.2, 0, -1.7, -1.57, 0]


def compared() -> Comparison:
    screws = ARM.screws.copy()
    screws[2, 3:] += np.cross([0, 0, -0.003], screws[2, :3])
    return pk.compare(ARM, ARM.replace(screws=screws))


PAGES = {
    "cloud": lambda: pk.view(ARM, q=Q, cloud=500),
    "comparison": lambda: pk.view(compared()),
    "solutions": lambda: pk.view(pk.ik_all(ARM, ARM.fk(Q), method="search")),
    "singularity": lambda: pk.view(pk.singularity(ARM, STRETCHED)),
}


@pytest.fixture(scope="module", params=PAGES)
def opened(request: pytest.FixtureRequest, open_page: Any) -> Any:
    return open_page(PAGES[request.param]())


@pytest.fixture(scope="module")
def robot(open_page: Any) -> Any:
    return open_page(pk.view(pk.load("panda")))


def drawn(opened: Any) -> np.ndarray:
    """Points of all that is shown, on the screen from -1 to 1: those of lines, surfaces and clouds."""
    script = """() => { const { THREE } = poekin.K.Provider;
        const { camera } = poekin.K.getWorld();
        const points = [];
        poekin.drawing.three.forEach((object) => object.visible && object.traverse((part) => {
            const position = part.geometry?.attributes.position;
            if (!position || object.matrix.determinant() === 0) return;
            for (let k = 0; k < position.count; k++) {
                const p = new THREE.Vector3().fromBufferAttribute(position, k);
                points.push(p.applyMatrix4(part.matrixWorld).project(camera).toArray());
            }
        }));
        return points; }"""
    return np.array(opened.ask(script))


@pytest.mark.parametrize("width", [1280, 480])
def test_tables_fit_labels_keep_off_the_buttons_and_the_camera_sees_all(opened, width):
    opened.look(width)
    opened.ask("new Promise((done) => setTimeout(done, 150))")  # k3d waits before it resizes
    opened.settle()
    tables = opened.ask("""[...document.querySelectorAll("table.words")]
        .map((t) => [t.parentElement.scrollWidth, t.parentElement.clientWidth])""")
    assert all(wide <= room for wide, room in tables)
    kept = opened.boxes("#poekin-toolbar, .badge")
    for label in opened.boxes(".label"):
        for box in kept:
            across = label["left"] < box["right"] and box["left"] < label["right"]
            assert not (across and label["top"] < box["bottom"] and box["top"] < label["bottom"])
    seen = drawn(opened)[:, :2]
    (canvas,) = opened.boxes("#canvasTarget")
    bar = opened.boxes("#poekin-toolbar")[0]["bottom"] / canvas["bottom"]
    assert np.abs(seen).max() <= 1
    assert seen[:, 1].max() <= 1 - 2 * bar + 0.02
    # from side to side, or from the lower edge to the buttons; but for the room of labels
    wide, high = np.ptp(seen, axis=0)
    assert wide >= 0.75 * 2 or high >= 0.8 * (2 - 2 * bar)
    cut = (
        "[...document.querySelectorAll('.slider label')].some((e) => e.scrollWidth > e.clientWidth)"
    )
    assert not opened.ask(cut)


def test_a_camera_that_the_reader_moved_stays_when_the_window_changes(robot):
    robot.look()
    robot.ask("poekin.K.setCamera([3, 3, 3, 0, 0, 0, 0, 0, 1])")
    robot.look(480)
    robot.ask("new Promise((done) => setTimeout(done, 150))")
    place = robot.ask("poekin.K.getWorld().camera.position.toArray()")
    np.testing.assert_allclose(place, [3, 3, 3], atol=1e-9)
    robot.look()
    robot.ask("poekin.drawing.fit()")


def test_the_handle_of_the_tool_is_there_without_the_frames(robot):
    script = """(on) => { poekin.show("frames", on); poekin.drawing.update();
        return poekin.scene.objects.filter((o) => o.layer === "frames")
            .map((o) => [o.rule, poekin.K.getObjectById(o.id).visible]); }"""
    seen = robot.ask(script, False)
    assert sorted({(rule or "", visible) for rule, visible in seen}) == [
        ("", False),
        ("target", True),
    ]
    robot.ask(script, True)


def test_a_box_holds_no_negative_zero(robot):
    robot.move(np.full(len(robot.ask("[...poekin.q]")), -1e-9))
    boxes = robot.ask(
        "[...document.querySelectorAll('.slider input[type=number]')].map((e) => e.value)"
    )
    assert boxes
    assert not [text for text in boxes if float(text) == 0 and "-" in text]
    robot.ask("poekin.set(poekin.scene.q)")


def test_ellipsoids_stay_within_a_quarter_of_the_arm_and_the_angular_one_is_the_smaller(robot):
    robot.move(
        robot.ask(
            "poekin.coordinates.map((c, k) => [0.3, -1.2, 1.4, -1.2, 0.9, 0.6, 0.2, 0.01][k])"
        )
    )
    script = """() => { poekin.show("ellipsoids", true); poekin.drawing.update();
        const half = (rule) => { const { id } = poekin.scene.objects.find((o) => o.rule === rule);
            const e = poekin.K.getObjectById(id).matrix.elements;
            return Math.max(...[0, 4, 8].map((k) => Math.hypot(e[k], e[k + 1], e[k + 2]))); };
        return [half("ellipsoid_v"), half("ellipsoid_w"), poekin.scene.size]; }"""
    linear, angular, size = robot.ask(script)
    assert 0.05 * size < angular < linear <= 0.25 * size * (1 + 1e-12)
