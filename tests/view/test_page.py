"""The file of a page: the same for the same scene, names escaped, nothing fetched, its size."""

from __future__ import annotations

import base64
import dataclasses
import json
import re
import sys
import zlib
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from poekin.errors import FileError, InputError, MissingExtra
from poekin.view import k3d_objects
from poekin.view.nodes import Attachment, Cloud, Label, Polyline
from poekin.view.page import SCRIPTS, Page, page, page_script
from poekin.view.scene_json import scene_json
from tests.view import sliding_arm

pytest.importorskip("k3d", reason="no k3d: no page was made")
EVIL = "</script ></script><!--<script><img src=x onerror=\"document.title='cut'\">&amp;\u202e\n"


@pytest.fixture(scope="module")
def made() -> Page:
    return page(sliding_arm.scene())


class Elements(HTMLParser):
    """Elements of a page with their attributes, and the text of each script."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[str] = []
        self.feed(html)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))
        self.texts.append("")

    def handle_data(self, data: str) -> None:
        if self.texts:
            self.texts[-1] += data

    def count(self, tag: str) -> int:
        return sum(name == tag for name, _ in self.found)

    def scene(self) -> Any:
        places = [k for k, (_, a) in enumerate(self.found) if a.get("id") == "poekin-scene"]
        return json.loads(self.texts[places[0]])


def geometry(html: str) -> list[dict[str, np.ndarray]]:
    """Arrays of k3d's objects, flat."""
    msgpack = pytest.importorskip("msgpack")
    packed = re.search("var data = '([^']*)'", html)
    assert packed is not None
    objects = msgpack.unpackb(zlib.decompress(base64.b64decode(packed[1])))["objects"]
    found = []
    for one in objects:
        arrays = {}
        for name in ("vertices", "indices"):
            stored = one[name]
            raw = stored["data"] if "data" in stored else zlib.decompress(stored["compressed_data"])
            arrays[name] = np.frombuffer(raw, stored["dtype"])
        found.append(arrays)
    return found


def test_the_same_scene_gives_the_same_bytes(made):
    assert page(sliding_arm.scene()).html == made.html
    assert not re.search(r"\d{4}-\d\d-\d\d \d\d:\d\d", made.html)  # k3d's title has the time


def test_a_page_of_a_small_scene_has_less_than_2_megabytes(made):
    assert 5e5 < len(made.html.encode()) < 2e6


def test_a_page_names_nothing_outside_itself(made):
    attributes = [value for _, a in Elements(made.html).found for value in a.items()]
    fetched = [v for name, v in attributes if name in {"src", "href", "srcset", "action", "data"}]
    assert fetched == ["data:,"]
    policy = next(str(v) for name, v in attributes if name == "content" and "default-src" in str(v))
    assert "default-src 'none'" in policy
    assert "http" not in policy


def test_names_out_of_files_stay_text(made):
    own = Elements(made.html)
    evil = sliding_arm.scene(EVIL, words=(EVIL,))
    found = Elements(page(evil).html)
    assert [tag for tag, _ in found.found] == [tag for tag, _ in own.found]
    assert found.scene()["title"] == EVIL.replace("\u202e", "\\u202e").replace("\n", "\\n")
    assert not set("<>&") & set(scene_json(evil, []))


def test_a_program_whose_comment_ends_a_script_does_not_end_it(made):
    evil = f"// {EVIL.strip()}\n{sliding_arm.PROGRAM}"
    scene = sliding_arm.scene(arms=(sliding_arm.arm(program=evil),))
    assert Elements(page(scene).html).count("script") == Elements(made.html).count("script")


def test_the_json_has_all_but_geometry_and_no_number_that_json_has_not(made):
    found = Elements(made.html).scene()
    assert found["arms"][0]["coordinates"][1] == {
        "name": "elbow", "unit": "rad", "lower": None, "upper": None,
    }  # fmt: skip
    assert found["arms"][0]["base"] == np.eye(4).ravel().tolist()
    assert "program" not in found["arms"][0]
    assert [one["id"] for one in found["objects"]] == list(range(1, len(found["objects"]) + 1))
    assert len(found["labels"]) == 2
    assert found["motion"]["marks"] == [
        {"first": 10, "last": 20, "kind": "singular", "text": "Near a singularity."}
    ]


def test_nodes_that_move_and_look_alike_are_one_object():
    boxes = [
        sliding_arm.box(Attachment("meshes", "first", 1, name=n), [0, 0, 0], [1, 1, 1])
        for n in "ab"
    ]
    other = sliding_arm.box(Attachment("meshes", "first", 2), [0, 0, 0], [1, 1, 1])
    objects = k3d_objects.grouped([boxes[0], other, boxes[1]])
    assert [[n.attachment.name for n in one.nodes] for one in objects] == [["a", "b"], [""]]
    scene = sliding_arm.scene(nodes=(*boxes, other))
    drawn = geometry(page(scene).html)
    assert [len(one["vertices"]) for one in drawn] == [2 * 36 * 3, 36 * 3]
    faces = drawn[0]["indices"]
    assert np.array_equal(faces, np.arange(72))
    assert json.loads(scene_json(scene, objects))["objects"][0]["names"] == ["a", "b"]


@pytest.mark.parametrize(("length", "shown"), [(200, "x" * 200), (201, "x" * 199 + "…")])
def test_a_title_of_two_hundred_characters_is_whole_and_a_longer_one_is_cut(length, shown):
    html = page(sliding_arm.scene(title="x" * length)).html
    assert f"<title>{shown}</title>" in html


@pytest.mark.parametrize(("layer", "flat"), [("meshes", True), ("skeleton", False)])
def test_meshes_keep_their_edges_and_bones_are_round_from_both_sides(layer, flat):
    msgpack = pytest.importorskip("msgpack")
    body = sliding_arm.box(Attachment(layer, "first", 1), [0, 0, 0], [1, 1, 1])
    (packed,) = re.findall("var data = '([^']*)'", page(sliding_arm.scene(nodes=(body,))).html)
    (one,) = msgpack.unpackb(zlib.decompress(base64.b64decode(packed)))["objects"]
    assert (one["flat_shading"], one["side"]) == (flat, "double")


def test_a_page_is_saved_whole_and_says_where(made, tmp_path):
    path = made.save(tmp_path / "arm.html")
    assert path == tmp_path / "arm.html"
    assert path.read_text(encoding="utf-8") == made.html
    with pytest.raises(FileError, match="no such folder"):
        made.save(tmp_path / "no such folder" / "arm.html")


def test_a_notebook_shows_the_page_in_a_frame_that_it_cannot_leave(made):
    (tag, attributes), *others = Elements(made._repr_html_()).found
    assert (tag, others) == ("iframe", [])
    assert attributes["srcdoc"] == made.html
    assert attributes["sandbox"] == "allow-scripts"
    assert attributes["style"] == "width:100%;height:640px;border:0"


def test_a_page_is_as_wide_as_the_screen_that_it_is_on(made):
    found = Elements(made.html).found
    (content,) = [words["content"] for tag, words in found if words.get("name") == "viewport"]
    assert content == "width=device-width, initial-scale=1"


def test_a_page_says_what_it_is_in_one_line(made):
    assert re.fullmatch(r"<Page 'sliding arm', 1\.\d MB>", repr(made))


def test_each_arm_s_functions_have_its_number():
    scene = sliding_arm.scene()
    twice = dataclasses.replace(scene, arms=(*scene.arms, *scene.arms))
    numbers = re.findall(
        r"window\.poekinKinematics\[(\d+)\] = \{ links, tips \};", page(twice).html
    )
    assert numbers == ["0", "1"]


def test_without_k3d_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "k3d", None)
    with pytest.raises(MissingExtra) as caught:
        page(sliding_arm.scene())
    assert str(caught.value) == ("drawing a page needs the package k3d: pip install 'poekin[view]'")


def test_no_name_of_the_page_s_script_is_declared_twice():
    declared = re.findall(r"^(?:const|let|class|(?:async )?function) (\w+)", page_script(), re.M)
    assert len(declared) > 80
    assert {name for name in declared if declared.count(name) > 1} == set()
    assert not re.search(r"^(import|export)\b", page_script(), re.MULTILINE)


def packed(html: str) -> dict[str, Any]:
    """What k3d put into a page."""
    msgpack = pytest.importorskip("msgpack")
    (data,) = re.findall("var data = '([^']*)'", html)
    return msgpack.unpackb(zlib.decompress(base64.b64decode(data)))


def test_the_page_has_its_own_style_and_every_script(made):
    web = Path(k3d_objects.__file__).with_name("web")
    assert (web / "page.css").read_text(encoding="utf-8") in made.html
    files = {path.relative_to(web).with_suffix("").as_posix() for path in web.rglob("*.js")}
    assert sorted(SCRIPTS) == sorted(files)


def test_the_canvas_is_bare_and_the_camera_is_the_page_s_own(made):
    plot = packed(made.html)["plot"]
    wanted = {
        "grid_visible": False,
        "menu_visibility": False,
        "camera_auto_fit": False,
        "camera_mode": "orbit",
        "camera_up_axis": "z",
        "camera_fov": 35.0,
        "axes_helper": 0.0,
        "colorbar_object_id": 0,
        "lighting": 1.4,
    }
    named = {re.sub("[A-Z]", lambda m: f"_{m[0].lower()}", k): v for k, v in plot.items()}
    assert {name: named[name] for name in wanted} == wanted


def test_the_points_of_a_cloud_are_coloured_from_blue_to_orange():
    cloud = Cloud(Attachment("cloud", "first", 0), np.eye(3), 0.25, np.array([1.0, 2, 3]))
    plain = Cloud(Attachment("cloud", "path", 0), np.eye(3), 0.25)
    with_values, without = packed(page(sliding_arm.scene(nodes=(cloud, plain))).html)["objects"]
    scale = np.frombuffer(with_values["color_map"]["data"], np.float32)
    wanted = [0, 0, 0x72 / 255, 0xB2 / 255, 1, 0xE6 / 255, 0x9F / 255, 0]
    np.testing.assert_allclose(scale, wanted, rtol=0, atol=1e-7)
    for one in (with_values, without):
        assert (one["point_size"], one["shader"]) == (0.25, "3d")
    assert without["color"] == 0x0072B2


def test_a_colour_is_split_into_its_three_bytes():
    assert k3d_objects._rgb(0xFF0103) == (1, 1 / 255, 3 / 255)


def test_a_line_is_drawn_piece_by_piece_from_point_to_point():
    places = np.array([[0, 0, 0], [1, 0, 0], [1, 2, 0], [1, 2, 3]], float)
    lines = [Polyline(Attachment("path", "path", 1), places[:n], 0.25) for n in (4, 2)]
    scene = sliding_arm.scene(nodes=tuple(lines))
    (one,) = geometry(page(scene).html)
    assert one["vertices"].reshape(-1, 3).tolist() == [*places.tolist(), *places[:2].tolist()]
    assert one["indices"].reshape(-1, 2).tolist() == [[0, 1], [1, 2], [2, 3], [4, 5]]


def test_what_looks_different_or_moves_otherwise_is_another_object():
    plain = Attachment("path", "path", 1)
    nodes = [
        Polyline(plain, np.eye(3), 0.25),
        Polyline(plain, np.eye(3), 0.5),
        Polyline(dataclasses.replace(plain, choice=1), np.eye(3), 0.25),
        Cloud(plain, np.eye(3), 0.25),
        Cloud(plain, np.eye(3), 0.25),
        Label(plain, np.zeros(3), "no object"),
        Polyline(dataclasses.replace(plain, name="alike"), np.eye(3), 0.25),
    ]
    objects = k3d_objects.grouped(nodes)
    assert [[nodes.index(node) for node in one.nodes] for one in objects] == [
        [0, 6],
        [1],
        [2],
        [3],
        [4],
    ]
    assert [one.number for one in objects] == [1, 2, 3, 4, 5]


def test_a_line_is_a_tube_of_its_width_in_the_colour_and_opacity_of_what_it_stands_for():
    held = Attachment("path", "marked", 1, opacity=0.5)
    line = Polyline(held, np.eye(3), 0.25)
    (one,) = packed(page(sliding_arm.scene(nodes=(line,))).html)["objects"]
    looks = {"color": 0xD55E00, "opacity": 0.5, "width": 0.25, "shader": "mesh"}
    assert {name: one[name] for name in looks} == looks
    body = sliding_arm.box(dataclasses.replace(held, color=0x123456), [0, 0, 0], [1, 1, 1])
    (one,) = packed(page(sliding_arm.scene(nodes=(body,))).html)["objects"]
    assert (one["color"], one["opacity"], one["roughness"]) == (0x123456, 0.5, 0.7)


@pytest.mark.parametrize(("length", "shown"), [(60, "x" * 60), (61, "x" * 59 + "…")])
def test_sixty_characters_of_a_title_stand_in_the_line_of_a_page(made, length, shown):
    assert repr(Page("x" * length, "y" * 2_250_000)) == f"<Page '{shown}', 2.2 MB>"
    frame = Page("x" * (length + 140), "")._repr_html_()
    assert f'title="{shown[:1] * 140 + shown}"' in frame


def test_a_page_of_a_k3d_that_is_not_known_is_refused(monkeypatch):
    for text in ("<title></title></head>", "<title></title></body>"):
        monkeypatch.setitem(page.__globals__, "snapshot", lambda *_, text=text: text)
        with pytest.raises(InputError, match=r"^k3d's page has no title, head or body: this k3d"):
            page(sliding_arm.scene())
