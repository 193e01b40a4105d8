"""`poekin warm` compiles every kernel there is and says where they lie."""

from __future__ import annotations

import re
from pathlib import Path

import poekin
from poekin.engine import warm
from poekin.engine.jit import cache


def in_the_source() -> int:
    folder = Path(poekin.__file__).parent / "engine" / "kernels"
    return sum(
        len(re.findall(r"(?m)^@kernel\(", file.read_text())) for file in folder.rglob("*.py")
    )


def test_every_kernel_is_compiled_and_kept(poekin):
    found = warm.kernels()
    assert len(found) == in_the_source() > 30
    code, out, err = poekin("warm")
    assert (code, err) == (0, "")
    assert re.fullmatch(
        rf"{len(found)} kernels in '{cache.usable_directory()}', \S+ MiB, \d+ s\n", out
    )
    assert all(kernel.call == kernel.ready() for kernel in found.values())
    place = cache.usable_directory()
    assert place is not None
    size = sum(file.stat().st_size for file in cache.used if file.parent == place)
    assert f", {size / 2**20:.1f} MiB, " in out
    names = {file.name.rpartition("-")[0] for file in place.glob("*.kernel")}
    assert {name.rpartition(".")[2] for name in found} <= names


def test_json_says_how_many_and_where(as_json):
    document = as_json("warm")
    assert document["kernels"] == in_the_source()
    assert Path(document["directory"]) == cache.usable_directory()


def test_where_nothing_is_kept_it_is_an_error(refused, tmp_path, monkeypatch):
    for kernel in warm.kernels().values():
        kernel.ready()
    # all of this process are compiled: nothing is added to another place, and what another version
    # left there does not count
    new = tmp_path / "new"
    new.mkdir(0o755)
    for k in range(in_the_source()):
        (new / f"old-{k}.kernel").write_bytes(b"")
    monkeypatch.setenv("POEKIN_CACHE_DIR", str(new))
    words = (
        f"error: {in_the_source()} kernels were compiled, and '{new}' keeps 0: it cannot be written"
    )
    assert words in refused("warm")


def test_without_a_directory_that_can_be_used_nothing_is_compiled(refused, tmp_path, monkeypatch):
    for place in ("", str(tmp_path / "open")):
        monkeypatch.setenv("POEKIN_CACHE_DIR", place)
        (tmp_path / "open").mkdir(exist_ok=True)
        (tmp_path / "open").chmod(0o777)
        words = refused("warm")
        assert "no cache directory can be used: POEKIN_CACHE_DIR=DIRECTORY names one" in words
