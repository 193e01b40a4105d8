"""`poekin sweep base`: candidates for the base, ranked by what a map says they reach."""

from __future__ import annotations

import json

import numpy as np
import pytest

import poekin as pk

ARM = pk.load("ur5e").chain(tip="tool0")
DOWN = np.diag([1.0, -1.0, -1.0])
TARGETS = pk.se3.pose(DOWN, [[x, 0.0, 0.2] for x in (-0.6, 0.0, 0.6)])
BASES = pk.se3.pose(np.eye(3), [[x, y, 0.0] for x in (-0.5, 0.0) for y in (-1.2, -0.6)])


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    folder = tmp_path_factory.mktemp("map")
    pk.sweep.reach(ARM, resolution=0.1, samples=200_000, side=1).save(folder / "map.npz")
    np.savetxt(folder / "targets.csv", TARGETS.reshape(-1, 16), delimiter=",")
    np.savetxt(folder / "bases.csv", BASES.reshape(-1, 16), delimiter=",")
    np.savetxt(folder / "far.csv", BASES[:2].reshape(-1, 16), delimiter=",")
    return folder


def words(place, bases="bases.csv"):
    files = ("--input", str(place / "targets.csv"), "--bases", str(place / bases))
    return ("sweep", "base", str(place / "map.npz"), *files, "--format", "matrix")


def test_the_table_is_the_ranking_of_the_library(place, poekin):
    own = pk.sweep.base_placement(pk.sweep.load_map(place / "map.npz"), TARGETS, BASES)
    code, out, _ = poekin(*words(place))
    assert code == 0
    assert out.startswith(own.summary())
    rows = [line.split() for line in out.split("─\n")[1].strip().split("\n")]
    expected = np.stack([own.order, own.reached, own.rarest], axis=1)
    assert [list(map(int, row)) for row in rows] == expected.tolist()
    code, out, _ = poekin(*words(place), "--json")
    assert json.loads(out)["order"] == own.order.tolist()


def test_the_first_ten_candidates_are_listed(place, poekin):
    many = np.tile(BASES, (3, 1, 1))
    np.savetxt(place / "many.csv", many.reshape(-1, 16), delimiter=",")
    _, out, _ = poekin(*words(place, "many.csv"))
    assert len(out.split("─\n")[1].strip().split("\n")) == 10


def test_units_are_those_of_both_files(place, poekin):
    for name, T in (("targets", TARGETS), ("bases", BASES)):
        numbers = pk.poses.to_numbers(T, "rpy", mm=True, deg=True)
        np.savetxt(place / f"{name}_mm.csv", numbers, delimiter=",")
    files = ("--input", place / "targets_mm.csv", "--bases", place / "bases_mm.csv")
    said = ("--format", "rpy", "--mm", "--deg", "--json")
    found = json.loads(poekin("sweep", "base", place / "map.npz", *files, *said)[1])
    assert found == json.loads(poekin(*words(place), "--json")[1])


def test_the_exit_code_says_that_no_candidate_serves_all(place, poekin):
    own = pk.sweep.base_placement(pk.sweep.load_map(place / "map.npz"), TARGETS, BASES[:2])
    assert own.reached[0] < 3
    assert poekin(*words(place, "far.csv"))[0] == 1


def test_what_is_missing_is_named(place, refused):
    assert "--format" in refused(*words(place)[:-2])
    assert "none.csv" in refused(*words(place, "none.csv"))
