"""`poekin sweep reach` and `show`."""

from __future__ import annotations

import json
import sys
from typing import get_args

import numpy as np
import pytest

import poekin as pk
from poekin.sweep import load_map
from poekin.sweep.measures.names import MeasureName
from tests.sweep.masks.arm_of_all_shapes import robot_in

FEW = ("--samples", "2e4", "--resolution", "0.2", "--tip", "tool0")


def test_a_map_is_made_written_and_shown(tmp_path, poekin):
    place = tmp_path / "map.npz"
    code, out, _ = poekin("sweep", "reach", "ur5e", *FEW, "--side", "1", "--output", str(place))
    own = pk.sweep.reach(pk.load("ur5e").chain(tip="tool0"), samples=20_000, resolution=0.2, side=1)
    assert code == 0
    assert out == f"{own.summary()}\n\nthe map: '{place}'\n"
    read = load_map(place)
    np.testing.assert_array_equal(read.counts, own.counts)
    code, out, _ = poekin("sweep", "show", str(place))
    assert code == 0
    assert out.startswith(f"tool0 in {own.about['base']}\n{own.summary()}")
    layers = [line.split() for line in out.split("─\n")[1].strip().split("\n")]
    assert sum(float(area) for _, area in layers) * 0.2 == pytest.approx(
        own.reached_volume, rel=1e-3
    )
    code, out, _ = poekin("sweep", "show", str(place), "--json")
    assert json.loads(out)["about"]["samples"]["random"] == 20_000


def test_the_map_is_written_beside_json_too(tmp_path, as_json):
    place = tmp_path / "map.npz"
    said = as_json("sweep", "reach", "ur5e", *FEW, "--output", place)
    assert said == json.loads(load_map(place).to_json())


def test_options_reach_the_sweep_and_json_is_the_result(poekin):
    words = ("--measure", "manipulability", "--seed", "3", "--workers", "1", "--json")
    code, out, _ = poekin("sweep", "reach", "ur5e", *FEW, *words)
    document = json.loads(out)
    assert code == 0
    assert document["about"]["measure"] == "manipulability"
    assert document["about"]["samples"]["seed"] == 3
    assert document["outside"] == 0


def test_errors_are_those_of_the_tolerances_that_are_given(poekin):
    chain = pk.load("stanford").chain()
    words = ("--samples", "2e4", "--resolution", "0.2", "--keep", "worst")
    error = ("--measure", "orientation_error", "--sigma-angle", "1e-3", "--sigma-length", "1e-4")
    code, out, _ = poekin("sweep", "reach", "stanford", *words, *error)
    measure = pk.sweep.PoseUncertainty.by_tolerances(
        chain,
        tilt=1e-3,
        shift=1e-4,
        offset=[1e-4 if kind == "prismatic" else 1e-3 for kind in chain.kinds],
        part="orientation",
    )
    own = pk.sweep.reach(chain, samples=20_000, resolution=0.2, measure=measure, keep="worst")
    assert code == 0
    assert out.strip() == own.summary()
    assert "worst standard deviation of the orientation of a cell" in out


def test_every_measure_has_its_name(poekin):
    for name in get_args(MeasureName):
        words = ["--samples", "1e3", "--measure", name, "--keep", "mean", "--json"]
        if name == "solutions":
            words += ["--by", "poses"]
        code, out, _ = poekin("sweep", "reach", "ur5e", *words)
        assert code == 0
        about = json.loads(out)["about"]
        assert (about["measure"], about["keep"]) == (name, "mean")


def test_poses_are_tried_where_they_are_asked_for(tmp_path, poekin):
    place = tmp_path / "map.npz"
    words = ("--by", "poses", "--measure", "solutions", "--side", "1", "--output", str(place))
    code, out, _ = poekin("sweep", "reach", "ur5e", *FEW, *words)
    own = pk.sweep.reach(
        pk.load("ur5e").chain(tip="tool0"),
        samples=20_000,
        by="poses",
        resolution=0.2,
        side=1,
        measure="solutions",
    )
    assert (code, out) == (0, f"{own.summary()}\n\nthe map: '{place}'\n")
    assert load_map(place).to_dict() == own.to_dict()
    assert poekin("sweep", "show", str(place))[1].startswith("tool0 in base\n20000 poses, ")
    words = ("--by", "middles", "--turns", "2", "--resolution", "0.4", "--tip", "tool0", "--json")
    code, out, _ = poekin("sweep", "reach", "ur5e", *words)
    assert (code, json.loads(out)["about"]["samples"]["poses"]["turns"]) == (0, 2)


def test_a_store_is_gone_on_with_where_it_is_asked(tmp_path, poekin, refused):
    store = ("--store", str(tmp_path / "parts"))
    assert poekin("sweep", "reach", "ur5e", *FEW, *store)[0] == 0
    assert "resume=True goes on" in refused("sweep", "reach", "ur5e", *FEW, *store)
    assert poekin("sweep", "reach", "ur5e", *FEW, *store, "--resume")[0] == 0
    assert "these differ: samples" in refused(
        "sweep", "reach", "ur5e", *FEW, *store, "--resume", "--seed", "1"
    )


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (
            ("--samples", "some"),
            "--samples: expected a whole number from 1 on, as 10000000 or 1e8, got 'some'",
        ),
        (("--samples", "1.5"), "--samples: expected a whole number"),
        (("--samples", "0"), "--samples: expected a whole number from 1 on"),
        (("--output", "map.csv"), "--output: expected a .npz file or a .zarr directory"),
        (("--measure", "position_error"), "--sigma-angle, --sigma-length: expected, one or both"),
        (("--sigma-angle", "1e-3"), "--sigma-angle, --sigma-length: expected, one or both"),
        (("--sigma-length", "1e-3", "--measure", "travel"), "and with no other"),
        (("--resume",), "--resume: expected with --store"),
        (("--turns", "2"), "--turns: expected 1 unless by is 'middles', got 2"),
        (("--measure", "solutions"), "expected samples of poses, PoseSamples or PoseGrid"),
        (("--resolution", "0"), "resolution: expected a positive number"),
        (("--resolution", "1e-9"), "at most 2^40 cells"),
        (("--tip", "nobody"), "nobody"),
    ],
)
def test_what_cannot_be_used_is_refused(words, expected, refused):
    assert expected in refused("sweep", "reach", "ur5e", *words)


def test_a_map_that_could_not_be_written_is_refused_before_the_sweep(
    tmp_path, refused, monkeypatch
):
    monkeypatch.setattr("poekin.cli.sweep.reach.reach", None)
    (tmp_path / "taken.npz").mkdir()
    for place, words in (
        (tmp_path / "none" / "map.npz", "--output: there is no directory"),
        (tmp_path / "taken.npz", "taken.npz' is a directory"),
    ):
        assert words in refused("sweep", "reach", "ur5e", "--output", str(place))
    pytest.importorskip("zarr", reason="no zarr: no .zarr was refused")
    (tmp_path / "taken.zarr").mkdir()
    message = refused("sweep", "reach", "ur5e", "--output", str(tmp_path / "taken.zarr"))
    assert "is there already, and holds no map of a sweep" in message
    monkeypatch.setitem(sys.modules, "zarr", None)
    message = refused("sweep", "reach", "ur5e", "--output", str(tmp_path / "map.zarr"))
    assert "poekin[sweep]" in message


def test_a_map_is_not_written_over_the_model_and_what_is_no_map_is_refused(tmp_path, refused):
    model = tmp_path / "arm.npz"
    model.write_text(pk.to_urdf(pk.load("ur5e")))
    assert "it is the file of the model" in refused(
        "sweep", "reach", str(model), "--output", str(model)
    )
    assert "no map of a sweep" in refused("sweep", "show", str(model))


def test_configurations_in_which_the_arm_touches_itself_are_left_out(tmp_path, poekin):
    robot = robot_in(tmp_path)
    arm = robot.chain(tip="hand")
    mask = pk.sweep.SelfCollision.of_robot(robot, arm)
    words = ("--samples", "1000", "--resolution", "0.5", "--self-collision")
    code, out, _ = poekin("sweep", "reach", str(tmp_path / "r.urdf"), *words)
    own = pk.sweep.reach(arm, samples=1000, resolution=0.5, mask=mask)
    assert (code, own.masked > 0) == (0, True)
    assert out == f"{own.summary()}\n\n{mask.summary()}\n"
