"""A page in a browser: sliders, numbers, layers, links, light and dark, narrow and wide."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.view.page import Page, page
from tests.view import sliding_arm
from tests.view.sliding_arm import Q, jacobian, poses

pytest.importorskip("k3d", reason="no k3d: no page was opened")
u = 2.0**-53
# Sines, cosines and sums of three products of numbers of at most 1.3, in the page and here.
TIGHT = 20 * u
LINK = "#q=0.123456789,-2,0.05&tip=1"
OVERLAP = """(boxes) => boxes.some((a, k) => boxes.some((b, j) => j > k &&
    a.left < b.right - 0.5 && b.left < a.right - 0.5 && a.top < b.bottom - 0.5 && b.top < a.bottom - 0.5))"""


@pytest.fixture(scope="module")
def arm(open_page: Any) -> Any:
    """A page that was opened by a link, and where it was then."""
    opened = open_page(page(sliding_arm.scene()), hash_=LINK)
    opened.at_first = opened.ask("[[...poekin.q], poekin.selectedTip]")
    return opened


@pytest.fixture(autouse=True)
def afresh(request: pytest.FixtureRequest) -> None:
    """The shared page as it was when it opened."""
    if "arm" in request.fixturenames:
        opened = request.getfixturevalue("arm")
        opened.ask("""() => { poekin.choice = null; poekin.set(poekin.scene.q); poekin.select(0);
            delete document.documentElement.dataset.theme;
            document.querySelectorAll("details").forEach((d) => { d.open = true; }); }""")
        opened.look()
        opened.settle()


def matrix(opened: Any, number: int) -> np.ndarray:
    """World matrix of an object."""
    script = "(id) => [...poekin.K.getObjectById(id).matrixWorld.elements]"
    return np.array(opened.ask(script, number)).reshape(4, 4).T


def number_of(opened: Any, **wanted: Any) -> int:
    """Number of the first object with these fields."""
    objects = opened.ask("poekin.scene.objects")
    return next(o["id"] for o in objects if all(o[k] == v for k, v in wanted.items()))


def test_poses_and_jacobians_of_200_configurations_are_those_of_numpy(arm):
    rng = np.random.default_rng(17)
    q = rng.uniform([-2.5, -4, 0], [2.5, 4, 0.3], (200, 3))
    script = """(rows) => rows.map((q) => { poekin.set(q); const n = poekin.numbers();
        return [...poekin.links(0), ...n.matrix, ...n.J, ...n.position]; })"""
    found = np.array(arm.ask(script, q.tolist()))
    true = [
        np.r_[p.ravel(), p[3].ravel(), jacobian(x).ravel(), p[3, :3, 3]]
        for x in q
        for p in [poses(x)]
    ]
    assert np.abs(found - true).max() <= TIGHT


def test_the_objects_are_drawn_where_their_links_are(arm):
    arm.move([-1.2, 2.5, 0.25])
    for link in (0, 1, 2, 3):
        drawn = matrix(arm, number_of(arm, layer="meshes", link=link))
        assert np.abs(drawn - poses([-1.2, 2.5, 0.25])[link]).max() <= TIGHT


def test_arrows_and_ellipsoids_are_those_of_the_jacobian(arm):
    q = [0.3, 1.1, 0.2]
    arm.move(q)
    J = jacobian(q)
    p = poses(q)[3, :3, 3]
    for k in range(3):
        for rule, rows in (("column_w", J[:3, k]), ("column_v", J[3:, k])):
            drawn = matrix(arm, number_of(arm, rule=rule, index=k))
            if not rows.any():
                assert not drawn[:3].any()
                continue
            end = drawn[:3] @ [0, 0, 1, 1] - p
            assert np.abs(np.cross(end, rows)).max() <= TIGHT
            assert end @ rows > 0
    for rule, rows in (("ellipsoid_v", J[3:]), ("ellipsoid_w", J[:3])):
        M = matrix(arm, number_of(arm, rule=rule))
        assert np.abs(M[:3, 3] - p).max() <= TIGHT
        shape = M[:3, :3] @ M[:3, :3].T
        true = rows @ rows.T
        assert np.abs(shape / np.trace(shape) - true / np.trace(true)).max() <= 1e-6


def test_numbers_are_those_that_python_gives(arm):
    q = [0.5, 1.0, 0.1]
    arm.move(q)
    found = arm.ask("poekin.numbers()")
    T = poses(q)[3]
    J = jacobian(q)
    rpy = found["rpy"]
    assert np.abs(np.array(rpy) - [0, 0, 1.5]).max() <= TIGHT
    assert np.abs(np.array(found["quaternion"]) - [0, 0, np.sin(0.75), np.cos(0.75)]).max() <= TIGHT
    assert found["part"] == "translation"  # three coordinates that take the position all ways
    s = np.linalg.svd(J[3:], compute_uv=False)
    measures = found["manipulability"]
    expected = [s.prod(), s[0] / s[-1], s[-1]]
    got = [measures[name] for name in ("yoshikawa", "condition", "smallest")]
    assert np.allclose(got, expected, rtol=1e-13, atol=0)
    limits = [2.0, np.inf, 0.1]
    assert np.allclose([np.inf if x is None else x for x in found["limits"]], limits, rtol=1e-14)
    screws = pk.se3.adjoint(np.linalg.inv(np.r_[np.c_[np.eye(3), T[:3, 3]], [[0, 0, 0, 1]]]))
    space = np.linalg.solve(screws, J)
    got = np.array([[*screw["w"], *screw["v"]] for screw in found["screws"]]).T
    assert np.abs(got - space).max() <= TIGHT


def test_a_slider_moves_its_joint_by_the_keyboard_and_its_box_by_typing(arm):
    slider = arm.tab.get_by_role("slider", name="shoulder")
    slider.focus()
    slider.press("ArrowRight")
    assert arm.ask("poekin.q[0]") == pytest.approx(Q[0] + 0.05, rel=1e-14)
    arm.settle()
    box = arm.tab.get_by_role("spinbutton", name="elbow, value")
    box.fill("-90")
    box.press("Enter")
    arm.settle()
    assert arm.ask("poekin.q[1]") == pytest.approx(-np.pi / 2, rel=1e-15)
    assert box.input_value() == "-90.00"
    arm.tab.get_by_role("button", name="Switch the unit: ° / rad").click()
    assert box.input_value() == "-1.5708"
    box.fill("")
    box.press("Enter")
    assert box.input_value() == "-1.5708"
    arm.tab.get_by_role("button", name="Switch the unit: ° / rad").click()


def test_a_slider_is_moved_by_the_pointer(arm):
    slider = arm.tab.get_by_role("slider", name="shoulder")
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    y = box["y"] + box["height"] / 2
    arm.tab.mouse.move(box["x"] + 0.6 * box["width"], y)
    arm.tab.mouse.down()
    arm.tab.mouse.move(box["x"] + box["width"] + 5, y, steps=4)
    arm.tab.mouse.up()
    assert arm.ask("poekin.q[0]") == 2.5


def test_what_is_beyond_a_limit_goes_to_the_limit_and_no_number_changes_nothing(arm):
    arm.ask("poekin.set([99, 99, -99])")
    assert arm.ask("[...poekin.q]") == [2.5, 99, 0]
    arm.ask("poekin.set([NaN, 1, Infinity])")
    assert arm.ask("[...poekin.q]") == [2.5, 1, 0.3]


def test_the_panel_shows_what_the_numbers_are(arm):
    arm.move([0.5, 1.0, 0.1])
    rows = arm.ask("""() => [...document.querySelectorAll("#poekin-panel details")]
        .find((d) => d.querySelector("summary").textContent === "Jacobian (ω; v) at the tip")
        .querySelectorAll("tr").values().map((r) => [...r.cells].map((c) => c.textContent)).toArray()""")
    assert rows[0][1:3] == ["shoulder", "elbow"]
    shown = [[float(x.replace("−", "-")) for x in row[1:]] for row in rows[1:]]
    assert np.abs(np.array(shown) - jacobian([0.5, 1.0, 0.1])).max() <= 0.5001e-4


def test_a_table_has_a_row_of_heads_where_its_columns_have_names(arm):
    script = """() => [...document.querySelectorAll("table")].map(
        (t) => [...t.rows[0].querySelectorAll("th[scope=col]")].map((head) => head.textContent))"""
    pose, _, measures, *_ = arm.ask(script)
    assert pose == ["", "x", "y", "z", "w"]
    assert measures == []


def test_a_layer_is_switched_off_and_on(arm):
    number = number_of(arm, layer="axes")
    switch = arm.tab.locator('input[data-layer="axes"]')
    for on in (False, True):
        switch.click()
        arm.settle()
        assert arm.ask("(id) => poekin.K.getObjectById(id).visible", number) is on


def test_meshes_are_looked_through_and_a_cloud_is_cut(arm):
    material = "(id) => poekin.K.getObjectById(id).material"
    number = number_of(arm, layer="meshes")
    switch = arm.tab.get_by_label("See through")
    for opacity in (0.3, 1.0):
        switch.click()
        assert arm.ask(f"({material})({number}).opacity") == opacity
    arm.tab.get_by_label("Cut the cloud").select_option("3")
    planes = f"({material})({number_of(arm, kind='cloud')}).clippingPlanes"
    z = 0.3 * 0.8  # of all points of the cloud
    assert arm.ask(f"{planes}.map((p) => [...p.normal])") == [[0, 0, -1]]
    assert arm.ask(f"{planes}[0].constant") == pytest.approx(z, abs=0.02)
    arm.tab.get_by_label("Cut the cloud").select_option("0")
    assert arm.ask(planes) == []


def test_the_edges_of_meshes_are_sharp_and_shapes_of_the_page_round(arm):
    flat = "(id) => poekin.K.getObjectById(id).material.flatShading"
    assert arm.ask(flat, number_of(arm, layer="meshes")) is True
    assert arm.ask(flat, number_of(arm, rule="ellipsoid_v")) is False


def test_another_tip_has_its_own_jacobian(arm):
    arm.tab.locator("#poekin-tip").select_option("1")
    arm.settle()
    assert len(arm.ask("poekin.numbers().J")) == 6
    assert arm.ask("poekin.numbers().position") == [0, 0, 0.3]


def test_a_choice_moves_the_arm_and_its_ghost_gives_way(arm):
    ghosts = [number_of(arm, layer="solutions", choice=k) for k in range(2)]
    arm.ask('poekin.show("solutions", true)')
    arm.tab.get_by_role("button", name="elbow right").click()
    arm.settle()
    assert arm.ask("[...poekin.q]") == [1.1, -0.9, 0.1]
    seen = [arm.ask("(id) => poekin.K.getObjectById(id).visible", g) for g in ghosts]
    assert seen == [True, False]
    assert np.abs(matrix(arm, ghosts[0]) - poses(Q)[2]).max() <= TIGHT


def test_the_tool_is_dragged_to_a_pose(arm):
    target = poses([-0.5, 0.7, 0.2])[3]
    script = "(T) => poekin.drag(Float64Array.from(T))"
    found = arm.ask(script, target.ravel().tolist())
    assert found["reached"]
    assert np.abs(poses(found["q"])[3] - target).max() <= 1e-6


def test_a_link_holds_the_configuration_and_the_tip(arm):
    assert arm.at_first == [[0.123456789, -2.0, 0.05], 1]
    arm.ask("poekin.select(1)")
    arm.move(arm.at_first[0])
    arm.tab.get_by_role("button", name="Copy a link").click()
    arm.tab.wait_for_function("location.hash.length > 0")
    assert arm.ask("location.hash") == LINK
    arm.ask("() => { location.hash = '#q=1,2&tip=9'; }")
    arm.settle()
    assert arm.ask("[...poekin.q]") == arm.at_first[0]
    assert arm.ask("poekin.selectedTip") == 1
    arm.ask("() => { location.hash = '#q=0,0,0'; }")  # a link to the first tip does not name it
    arm.settle()
    assert arm.ask("[[...poekin.q], poekin.selectedTip]") == [[0, 0, 0], 0]


def test_a_page_in_a_notebook_s_frame_moves_too(open_page):
    made = page(sliding_arm.scene())
    notebook = Page("notebook", f"<!doctype html><title>notebook</title>{made._repr_html_()}")
    opened = open_page(notebook, framed=True)
    opened.move([0.2, 0.3, 0.1])
    assert opened.ask("poekin.numbers().position[2]") == pytest.approx(0.2, rel=1e-15)
    opened.tab.frame_locator("iframe").get_by_role("button", name="Copy a link").click()
    opened.settle()


@pytest.mark.parametrize("dark", [False, True])
def test_light_or_dark_is_the_reader_s_choice_then_the_button_s(arm, dark):
    def brightness() -> float:
        color = arm.ask("getComputedStyle(document.body).backgroundColor")
        return float(np.mean([int(x) for x in re.findall(r"\d+", color)]))

    arm.look(dark=dark)
    assert (brightness() < 128) is dark
    for darker in (not dark, dark):
        arm.tab.get_by_role("button", name="Light or dark").click()
        assert (brightness() < 128) is darker


@pytest.mark.parametrize("width", [1280, 480])
def test_nothing_is_cut_off_and_nothing_overlaps(arm, width):
    arm.look(width, 800)
    arm.settle()
    assert arm.ask("document.documentElement.scrollWidth <= innerWidth")
    (panel,) = arm.boxes("#poekin-panel")
    (canvas,) = arm.boxes("#canvasTarget")
    for box in (panel, canvas):
        assert 0 <= box["left"] < box["right"] <= width
        assert 0 <= box["top"] < box["bottom"] <= 800
    assert not arm.ask(OVERLAP, [panel, canvas])
    assert canvas["bottom"] - canvas["top"] >= 300
    inside = "#poekin-panel :is(h1, p, summary, label, input, button, select, .unit, .wide)"
    for box in arm.boxes(inside):
        assert panel["left"] <= box["left"]
        assert box["right"] <= panel["right"] + 0.5
    for group in (".slider > *", "#poekin-toolbar > *", ".layer", ".choice", ".label", "summary"):
        boxes = arm.boxes(group)
        assert boxes
        assert not arm.ask(OVERLAP, boxes), group
    assert arm.ask("""[...document.querySelectorAll("button, summary, h1")]
        .every((e) => e.scrollWidth <= e.clientWidth + 1)""")
