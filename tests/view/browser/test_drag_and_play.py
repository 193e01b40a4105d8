"""A page in a browser: the tool taken by pointer and finger, paths that play, differences enlarged."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.formats import emit
from poekin.groups import se3
from poekin.view.nodes import Attachment, Label
from poekin.view.page import page
from poekin.view.scene import Scene, SceneArm, SceneTip, Slider
from tests.view import sliding_arm

pytest.importorskip("k3d", reason="no k3d: no page was opened")
REACHED = 1e-6  # m and rad
EVIL = "</script><img src=x onerror=\"document.title='cut'\">"
Q = [0.3, -1.2, 1.6, -1.4, -1.5, 0.2]
# Of the tool's origin: place on the screen (px), and the way from the camera along its view (m).
ON_SCREEN = """() => {
    const { camera, renderer } = poekin.K.getWorld();
    const { Vector3 } = poekin.K.Provider.THREE;
    const T = poekin.linkPose(0, 1, null);
    const box = renderer.domElement.getBoundingClientRect();
    const seen = new Vector3(T[3], T[7], T[11]).project(camera);
    const deep = new Vector3(T[3], T[7], T[11]).applyMatrix4(camera.matrixWorldInverse);
    return [box.left + (0.5 + 0.5 * seen.x) * box.width, box.top + (0.5 - 0.5 * seen.y) * box.height, deep.z];
}"""
CAMERA = "() => [...poekin.K.getWorld().camera.matrixWorld.elements]"


def ur5e() -> Scene:
    """An arm of six joints without a body."""
    chain = pk.load("ur5e").chain(tip="tool0")
    program = f"""{emit.javascript(chain, "hybrid")}
        export const links = (q) => Float64Array.of(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, ...fk(q));
        export const tips = [{{ fk_jacobian: (q) => fk_jacobian_hybrid(q) }}];
    """
    sliders = tuple(
        Slider(name, "rad", *map(float, limits))
        for name, limits in zip(chain.q_names, chain.limits, strict=True)
    )
    tips = (SceneTip("tool0", 1, tuple(range(6)), chain.reach),)
    arm = SceneArm(
        "ur5e",
        program,
        ("base", "tool"),
        sliders,
        tips,
        se3.exp([0.1, 0, 0.7, 0.2, -0.1, 0.3]),
        np.eye(6),
        np.zeros(6),
    )
    return Scene("ur5e", (), (arm,), np.array(Q), (), frozenset(), 1.2)


@pytest.fixture(scope="module")
def arm(open_page: Any) -> Any:
    return open_page(page(ur5e()))


@pytest.fixture(scope="module")
def path(open_page: Any) -> Any:
    """A page with a path, a second arm, raised by 10 mm and turned, and names that end its script."""
    base = np.eye(4)
    base[2, 3] = 0.01
    # the slide of the second arm is the factor k
    shift = np.array([0.01, 0.1, 1])
    second = sliding_arm.arm("second", base=base, factors=np.diag([1.0, 1, 0]), shift=shift)
    nodes = (
        *sliding_arm.nodes(EVIL),
        Label(Attachment("labels", "first"), np.zeros(3), EVIL),
        sliding_arm.box(Attachment("meshes", "second", 3, arm=1), [0.2, 0, 0], [0.4, 0.1, 0.1]),
    )
    arms = (sliding_arm.arm(EVIL), second)
    scene = sliding_arm.scene(EVIL, words=(EVIL,), arms=arms, nodes=nodes, exaggerated=200.0)
    return open_page(page(scene))


def pose(opened: Any) -> np.ndarray:
    return np.reshape(opened.ask("[...poekin.tip(0).T]"), (4, 4))


def pull(opened: Any, start: tuple[float, float], way: tuple[float, float]) -> None:
    """Press the mouse, move it and let it go."""
    mouse = opened.tab.mouse
    mouse.move(*start)
    mouse.down()
    mouse.move(start[0] + way[0], start[1] + way[1], steps=6)
    opened.settle()
    mouse.up()
    opened.settle()


@pytest.mark.parametrize("free", ["", "Shift", "switch"])
def test_the_tool_follows_the_mouse_in_the_plane_of_the_screen(arm, free):
    arm.move(Q)
    before = pose(arm)
    camera = arm.ask(CAMERA)
    x, y, deep = arm.ask(ON_SCREEN)
    if free == "Shift":
        arm.tab.keyboard.down("Shift")
    if free == "switch":
        arm.tab.get_by_label("Leave its rotation free").check()
    pull(arm, (x + 5, y - 4), (40, 30))  # not by its middle
    arm.tab.keyboard.up("Shift")
    arm.tab.get_by_label("Leave its rotation free").uncheck()
    now = arm.ask(ON_SCREEN)
    # the mouse goes by whole px
    assert np.abs(np.subtract(now[:2], (x + 40, y + 30))).max() <= 1.01
    assert now[2] == pytest.approx(deep, abs=2 * REACHED)
    turned = np.abs(pose(arm)[:3, :3] - before[:3, :3]).max()
    assert (turned > 1e-3) if free else (turned <= 2 * REACHED)
    assert arm.ask(CAMERA) == pytest.approx(camera, abs=1e-12)  # its controls round at each frame
    assert arm.ask("poekin.target") is None


def test_the_mouse_is_a_hand_over_the_tool_and_nowhere_else(arm):
    arm.move(Q)
    x, y, _ = arm.ask(ON_SCREEN)
    cursor = "poekin.K.getWorld().renderer.domElement.style.cursor"
    for away, shown in ((0, "grab"), (60, ""), (10, "grab")):
        arm.tab.mouse.move(x + away, y)
        assert arm.ask(cursor) == shown


def test_a_press_beside_the_handle_turns_the_camera_and_leaves_the_arm(arm):
    arm.move(Q)
    camera = arm.ask(CAMERA)
    x, y, _ = arm.ask(ON_SCREEN)
    pull(arm, (x + 60, y + 60), (40, 30))
    assert arm.ask("[...poekin.q]") == Q
    assert arm.ask(CAMERA) != pytest.approx(camera, abs=1e-3)


def test_a_finger_takes_the_tool_from_farther_off(arm):
    arm.move(Q)
    x, y, _ = arm.ask(ON_SCREEN)
    finger = arm.context.new_cdp_session(arm.tab)
    for kind, dx in (("touchStart", 0), ("touchMove", 12), ("touchMove", 25), ("touchEnd", None)):
        points = [] if dx is None else [{"x": x + 15 + dx, "y": y + 15, "id": 1}]
        finger.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        arm.settle()
    now = arm.ask(ON_SCREEN)
    assert np.abs(np.subtract(now[:2], (x + 25, y))).max() <= 1.01


def test_dragging_past_the_reach_ends_within_the_limits_and_without_a_fault(arm):
    arm.move(Q)
    x, y, _ = arm.ask(ON_SCREEN)
    pull(arm, (x, y), (-300, -200))
    q = np.array(arm.ask("[...poekin.q]"))
    limits = pk.load("ur5e").chain(tip="tool0").limits
    assert np.isfinite(q).all()
    assert ((q >= limits[:, 0]) & (q <= limits[:, 1])).all()


def test_poses_are_reached_by_the_page_itself(arm):
    chain = pk.load("ur5e").chain(tip="tool0")
    targets = chain.fk(chain.random(40, 20))
    script = "(all) => all.map((T) => [poekin.drag(T).reached, [...poekin.q]])"
    found = arm.ask(script, targets.reshape(20, 16).tolist())
    assert sum(reached for reached, _ in found) >= 19
    for (reached, q), T in zip(found, targets, strict=True):
        assert (np.abs(chain.fk(q) - T).max() <= 2 * REACHED) or not reached


def test_a_path_plays_stops_and_is_scrubbed(path):
    motion = path.ask("poekin.scene.motion")

    def at(t: float) -> np.ndarray:
        return np.array([np.interp(t, motion["times"], x) for x in np.transpose(motion["q"])])

    path.ask("() => { poekin.player.seek(0); document.activeElement.blur(); }")
    path.tab.keyboard.press("Space")
    path.tab.wait_for_function("poekin.player.time > 0.1")
    assert path.ask("poekin.player.playing")
    path.tab.keyboard.press("Space")
    t, q = path.ask("[poekin.player.time, [...poekin.q]]")
    assert not path.ask("poekin.player.playing")
    np.testing.assert_allclose(q, at(t), atol=1e-12)
    path.settle()
    assert path.ask("poekin.player.time") == t
    path.ask("""() => { const line = document.querySelector(".timeline input");
        line.value = 2.5; line.dispatchEvent(new Event("input")); }""")
    np.testing.assert_allclose(path.ask("[...poekin.q]"), at(2.5), atol=1e-12)
    path.ask("() => { poekin.player.seek(3.9); poekin.player.play(); }")
    path.tab.wait_for_function("!poekin.player.playing")
    np.testing.assert_allclose(path.ask("[...poekin.q]"), at(4), atol=1e-12)


def test_a_slider_that_is_moved_stops_the_path(path):
    path.ask("() => { poekin.player.seek(0); poekin.player.play(); poekin.set([0.1, 0.2, 0.1]); }")
    assert not path.ask("poekin.player.playing")
    path.settle()
    assert path.ask("[...poekin.q]") == [0.1, 0.2, 0.1]


def test_a_mark_is_a_band_of_its_times_and_a_sentence_that_leads_there(path):
    times = path.ask("poekin.scene.motion.times")
    band = path.ask("""() => { const { left, width } = document.querySelector(".band.singular").style;
        return [parseFloat(left), parseFloat(width)]; }""")
    assert band == pytest.approx([25 * times[10], 25 * (times[20] - times[10])], rel=1e-4)
    path.tab.click("button.mark.singular")
    assert path.ask("poekin.player.time") == pytest.approx(times[10])
    assert "Near a singularity." in path.ask("document.querySelector('.now').textContent")


def test_the_factor_moves_the_second_arm_and_is_on_the_screen(path):
    path.move([0.2, 0.5, 0.1])
    script = """(k) => {
        const slider = document.querySelector("[aria-label^=Differences]");
        slider.value = Math.log10(k);
        slider.dispatchEvent(new Event("input"));
        return [...poekin.linkPose(1, 3, null)];
    }"""
    for k in (1, 20, 200):
        second = np.reshape(path.ask(script, k), (4, 4))
        assert np.arctan2(second[1, 0], second[0, 0]) == pytest.approx(0.81, abs=1e-12)
        assert second[2, 3] == pytest.approx(0.31 - k, rel=1e-12)
        shown = path.boxes(".badge")
        assert len(shown) == (k > 1)
        if k > 1:
            assert path.ask("document.querySelector('.badge').textContent") == f"differences × {k}"


def test_a_second_arm_is_drawn_where_the_sliders_and_the_factor_put_it(path):
    objects = path.ask("poekin.scene.objects")
    number = next(o["id"] for o in objects if o["arm"] == 1)
    drawn = "(id) => [...poekin.K.getObjectById(id).matrixWorld.elements]"
    a, b, d = sliding_arm.Q
    for k in (2.0, 3.0):
        second = sliding_arm.poses([a + 0.01, b + 0.1, k])[3]
        second[2, 3] += 0.01
        path.ask("([k, q]) => { poekin.k = k; poekin.set(q); }", [k, [a, b, d]])
        path.settle()
        # a few sums and products of lengths of up to 3 m
        off = np.reshape(path.ask(drawn, number), (4, 4)).T - second
        assert np.abs(off).max() <= 200 * 2.0**-53


def test_names_out_of_files_are_words_in_the_page(path):
    assert path.ask("document.title") == EVIL
    assert path.ask('document.querySelector("h1").textContent') == EVIL
    assert path.ask('document.querySelectorAll("img").length') == 0


def test_a_choice_is_let_go_of_once_the_arm_leaves_it(path):
    path.ask("() => poekin.choose(1)")
    assert path.ask("poekin.choice") == 1
    path.ask("() => poekin.set(poekin.q)")
    assert path.ask("poekin.choice") == 1
    path.move([0, 0, 0])
    assert path.ask("poekin.choice") is None
