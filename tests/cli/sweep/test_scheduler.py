"""`poekin sweep reach --scheduler`: a cluster of Dask runs the sweep."""

from __future__ import annotations

import sys
from types import SimpleNamespace
from typing import Any

import pytest

import poekin as pk

WORDS = ("sweep", "reach", "ur5e", "--samples", "2e4", "--resolution", "0.2", "--tip", "tool0")


def test_the_scheduler_that_is_named_is_asked(poekin, refused, tmp_path):
    distributed = pytest.importorskip("distributed", reason="no distributed: no cluster was asked")
    place = tmp_path / "map.npz"
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=2, dashboard_address=None, processes=False, protocol="tcp"
    ) as cluster:
        there = ("--scheduler", cluster.scheduler_address, "--output", str(place))
        assert poekin(*WORDS, *there)[0] == 0
        assert cluster.scheduler.transition_counter > 0
    own = pk.sweep.reach(pk.load("ur5e").chain(tip="tool0"), samples=20_000, resolution=0.2)
    assert pk.sweep.load_map(place).counts.tobytes() == own.counts.tobytes()


def test_one_that_cannot_be_reached_is_said_to_give_no_answer(refused):
    pytest.importorskip("distributed", reason="no distributed: no cluster was asked")
    assert "--scheduler: 'nowhere' gives no answer" in refused(*WORDS, "--scheduler", "nowhere")


def test_without_the_extra_its_name_is_said(refused, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert "poekin[sweep]" in refused(*WORDS, "--scheduler", "tcp://localhost:8786")


@pytest.mark.parametrize("kind", [OSError, ValueError])
def test_why_there_is_no_answer_is_said_in_its_first_line(refused, monkeypatch, kind):
    def client(address: str, **_: Any) -> None:
        raise kind(f"no route to {address}\nin three attempts")

    monkeypatch.setitem(sys.modules, "distributed", SimpleNamespace(Client=client))
    said = " ".join(refused(*WORDS, "--scheduler", "tcp://x:1").split())
    assert said.endswith("--scheduler: 'tcp://x:1' gives no answer: no route to tcp://x:1")
