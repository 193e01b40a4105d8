"""What `poekin sweep show` prints of a map: layers by height, in numbers of four digits."""

from __future__ import annotations

import json

import numpy as np
import pytest

import poekin as pk

ARM = pk.load("ur5e").chain(tip="tool0")


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    found = pk.sweep.reach(ARM, resolution=0.1234567, samples=20_000)
    place = tmp_path_factory.mktemp("map") / "map.npz"
    found.save(place)
    return place, found


def test_each_layer_has_its_height_and_the_area_of_its_cubes(place, poekin):
    """A cube's centre is half a side above its lower face; layers without a cube are left out."""
    file, found = place
    side = found.cells.resolution
    code, out, err = poekin("sweep", "show", file)
    assert (code, err) == (0, "")
    head, _, rest = out.partition("height of the layer (m)")
    assert head.strip() == f"tool0 in {ARM.base}\n{found.summary()}"
    assert rest.split("\n")[0].strip() == "reached (m²)"
    expected = []
    for k in range(found.cells.shape[2]):
        cubes = int((found.counts[:, :, k] > 0).sum())
        if cubes:
            height = found.cells.corner[2] + (k + 0.5) * side
            expected.append(f"{height:.4g} {cubes * side**2:.4g}")
    rows = [" ".join(line.split()) for line in rest.split("─\n")[1].strip().splitlines()]
    assert rows == expected
    assert any(len(row.split()[1]) == 6 for row in rows)  # a point and five digits at most


def test_json_is_what_the_map_says_of_itself(place, poekin):
    file, found = place
    code, out, _ = poekin("sweep", "show", file, "--json")
    assert (code, json.loads(out)) == (0, json.loads(json.dumps(found.to_dict(), default=list)))


def test_empty_layers_are_left_out(tmp_path, poekin):
    """A slide of 1 m that is looked at in cubes of 0.3 m from 1 m below it to 1 m above it."""
    slide = pk.Chain.from_space([pk.screw.prismatic([0, 0, 1])], np.eye(4))
    slide = slide.replace(limits=[[0.0, 1.0]])
    cells = pk.sweep.Cells((-0.15, -0.15, -1.0), 0.3, (1, 1, 10))
    task = pk.sweep.Sweep(slide, pk.sweep.Random.of(slide, 1000), cells)
    pk.sweep.run(task).save(tmp_path / "map.npz")
    _, out, _ = poekin("sweep", "show", tmp_path / "map.npz")
    rows = [line.split() for line in out.split("─\n")[1].strip().splitlines()]
    assert rows == [[h, "0.09"] for h in ("0.05", "0.35", "0.65", "0.95")]
