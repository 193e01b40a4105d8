"""What a scene holds at most, and from where on something is drawn or said: the last and the next."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.formats.visuals.visual import LeftOut
from poekin.view import kinematics
from poekin.view.nodes import Attachment, Triangles
from poekin.view.scenes import arm, calibration, comparison, path, singular, solutions, targets
from poekin.view.scenes.arm_parts import jacobian, missing, regular, skeleton
from poekin.view.scenes.arm_parts.of_chain import chain_geometry
from poekin.view.scenes.stage import make_stage

ARM = pk.load("ur5").chain()
Q = np.array([0.1, -1.0, 1.2, 0.4, 0.9, -0.3])

LIMITS: list[tuple[ModuleType, dict[str, float]]] = [
    (arm, {"MOST_CLOUD": 1_000_000, "POINT": 1e-6}),
    (calibration, {"MOST": 400, "SIDES": 5}),
    (comparison, {"MOST_WORDS": 8, "ALWAYS": 7}),
    (path, {"ROWS": 2000, "FRAMES": 24, "SECONDS": 10}),
    (singular, {"LENGTH": 0.25, "SMALL": 1e-3}),
    (solutions, {"GHOST": 0.3}),
    (targets, {"MOST": 32}),
    (jacobian, {"NEAR": 0.1, "HANDLE": 0.018}),
    (missing, {"MOST": 6, "THICK": 0.02}),
    (regular, {"MOST": 1500, "TURN": np.pi / 2, "GOOD": 2}),
    (skeleton, {"LARGEST": 0.04, "SMALLEST": 0.006, "COINCIDENT": 0.01, "BONE": 0.3}),
    (kinematics, {"MOST_TIPS": 12}),
]


@pytest.mark.parametrize(("module", "values"), LIMITS, ids=[m.__name__ for m, _ in LIMITS])
def test_the_limits_and_shares_are_those_that_pages_were_looked_at_with(module, values):
    assert {name: getattr(module, name) for name in values} == values


@pytest.mark.parametrize(("length", "drawn"), [(0.99e-4, False), (1.01e-4, True), (0.0, False)])
def test_an_arrow_is_drawn_from_a_ten_thousandth_of_the_size_on(length, drawn):
    found = calibration._arrows(np.zeros((1, 3)), np.array([[0, 0, 2 * length]]), 2.0)
    assert (found is not None) is drawn


@pytest.mark.parametrize(
    ("length", "thick", "head"), [(1.0, 0.006, 0.036), (0.06, 0.006, 0.024), (0.02, 0.002, 0.008)]
)
def test_an_arrow_is_thick_by_the_size_and_a_short_one_by_its_length(length, thick, head):
    """Shaft, and a head 2.5 times as thick: its base has five corners on a circle and its middle."""
    start = np.array([1.0, 2.0, 3.0])
    found = calibration._arrows(start[None], np.array([[0, 0, length]]), 2.0)
    assert found is not None
    away = found.vertices - start
    across = np.linalg.norm(away[:, :2], axis=1)
    assert {round(r, 9) for r in across} == {0.0, round(thick, 9), round(2.5 * thick, 9)}
    assert away[:, 2].max() == pytest.approx(length, rel=1e-9)
    assert away[across > 2 * thick, 2].max() == pytest.approx(length - head, rel=1e-9)
    assert len({tuple(row) for row in away[across > 2 * thick].round(9).tolist()}) == 5


def test_the_arrows_that_are_too_short_are_left_out_and_the_others_are_one_surface():
    ways = np.array([[0, 0, 1.0], [0, 0, 0], [0, 0, 1.0]])
    three = calibration._arrows(np.arange(9.0).reshape(3, 3), ways, 1.0)
    one = calibration._arrows(np.zeros((1, 3)), ways[:1], 1.0)
    assert three is not None
    assert one is not None
    assert (len(three.faces), len(three.vertices)) == (2 * len(one.faces), 2 * len(one.vertices))


def test_a_part_of_a_lost_motion_is_drawn_from_a_thousandth_of_it_on():
    """Of a unit twist over 2 m; each part has an arrow and its words."""
    stage = make_stage(ARM, Q, None)
    for share, count in ((0.99e-3, 2), (1.01e-3, 4), (1.0, 4)):
        for twist in ([1, 0, 0, 0, 0, 2 * share], [share, 0, 0, 0, 0, 2.0]):
            nodes = list(singular._arrows(np.array(twist), 2.0, np.zeros(3), stage))
            assert len(nodes) == count
            lengths = [n.vertices[-1] for n in nodes if isinstance(n, Triangles)]
            longest = max(np.linalg.norm(end) for end in lengths)
            assert longest == pytest.approx(0.25 * stage.size, rel=1e-9)


@pytest.mark.parametrize("count", [5, 6, 7, 8])
def test_six_shapes_are_named_and_the_others_counted(count):
    lost = [LeftOut("arm", "a:1", f"'m{k}'", "why") for k in range(count)]
    (words,) = missing.left_out_words(lost)
    names = ", ".join(f"'m{k}'" for k in range(min(count, 6)))
    more = f" and {count - 6} more" if count > 6 else ""
    assert words == f"Not drawn: {names}{more}: why."


def test_a_singularity_is_spoken_of_up_to_a_tenth_of_a_radian_away(monkeypatch):
    found = pk.singularity(ARM, Q)
    assert not found.singular
    for distance, spoken in ((0.1, True), (0.1001, False)):
        other = replace(found, distance=distance)
        monkeypatch.setattr(jacobian, "singularity", lambda *_, other=other: other)
        assert bool(jacobian.singular_words(ARM, Q)) is spoken


def test_a_million_points_are_a_cloud_and_one_more_is_refused(monkeypatch):
    monkeypatch.setattr(arm, "MOST_CLOUD", 3)
    assert "cloud" in arm.arm_scene(ARM, cloud=3).shown
    with pytest.raises(InputError, match=r"^cloud: expected at most 3 points, got 4$"):
        arm.arm_scene(ARM, cloud=4)


def test_an_arm_up_to_a_micrometre_is_a_point():
    for length, size in ((1e-6, 1.0), (1.5e-6, 1.5e-6)):
        point = pk.Chain.from_space(
            [pk.screw.revolute([0, 0, 1], [0, 0, 0])], pk.se3.exp([0, 0, 0, 0, 0, length])
        )
        assert arm.arm_size(chain_geometry(point), np.zeros(1)) == pytest.approx(size)


def test_the_corners_of_a_body_count_where_its_link_is():
    """A bar of 5 m on a link that is turned by a right angle and lifted by 1 m."""
    bar = Triangles(Attachment("meshes", "first", 1), np.array([[0, 0, 0], [5.0, 0, 0]]), np.eye(3))
    post = pk.Chain.from_space(
        [pk.screw.revolute([0, 0, 1], [0, 0, 0])], pk.se3.exp([0, 0, 0, 0, 0, 2])
    )
    size = arm.arm_size(chain_geometry(post), np.array([np.pi / 2]), [bar])
    assert size == pytest.approx(np.hypot(5, 2))


@pytest.mark.parametrize("count", [targets.MOST, targets.MOST + 1])
def test_of_more_targets_than_a_reader_chooses_from_it_is_said_how_many_there_are(count):
    found = pk.ik(ARM, np.tile(ARM.fk(Q), (count, 1, 1)), q0=Q)
    words = targets.solution_scene(found).words
    said = [line for line in words if line.startswith("The first")]
    assert said == ([f"The first 32 of {count} targets are shown."] if count > 32 else [])


@pytest.mark.parametrize("most", [7, 8])
def test_of_more_solutions_than_a_reader_chooses_from_it_is_said_how_many_there_are(
    most, monkeypatch
):
    monkeypatch.setattr(solutions, "MOST", most)
    scene = solutions.solutions_scene(pk.ik_all(ARM, ARM.fk(Q), method="search"))
    said = [line for line in scene.words if line.startswith("The first")]
    assert said == (["The first 7 of 8 solutions are shown."] if most == 7 else [])
    assert len(scene.choices) == most
