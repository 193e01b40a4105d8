"""The report's rows of the real UR5: where the data is, and what is said where it is not."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from benchmarks.cases import TOPICS
from benchmarks.cases import calibration_ur5 as ur5


def silent(_text):
    """Nothing is said."""


def test_without_the_data_the_page_says_so_and_no_bar_is_missed(monkeypatch, tmp_path):
    monkeypatch.setenv(ur5.VARIABLE, str(tmp_path))
    page = ur5.topic(True, silent)
    assert [f.verdict for f in page.figures] == [None, None]
    assert all("not measured" in f.text and ur5.VARIABLE in f.note for f in page.figures)
    assert not any(str(tmp_path) in f.note for f in page.figures)
    assert TOPICS["calibration_ur5"] is ur5


def write(path, chain, q, rng):
    """A file as the source has it: mm and degrees, target and its difference from the truth."""
    sagged = q + 2e-3 * np.cos(q) * [0, 1, 0.5, 0, 0, 0]
    places = chain.fk(np.stack([q, sagged]))[..., :3, :] @ [*ur5.POINT, 1.0]
    target, true = 1e3 * places
    true += rng.normal(scale=0.05, size=true.shape)
    table = np.column_stack([np.arange(len(q)), target, target - true, np.rad2deg(q)])
    heads = ["step_order", "x_t", "y_t", "z_t", "x_dif", "y_dif", "z_dif"]
    heads += [f"joint_{k + 1}" for k in range(6)]
    np.savetxt(path, table, delimiter=",", header=",".join(heads), comments="")
    return true


def test_the_data_is_read_where_it_is_named(monkeypatch, tmp_path):
    chain = pk.dh.to_chain(pk.dh.published("ur5"))
    rng = np.random.default_rng(0)
    true = write(tmp_path / ur5.FIT, chain, chain.random(rng, 200), rng)
    write(tmp_path / ur5.JUDGE, chain, chain.random(rng, 20), rng)
    np.testing.assert_allclose(ur5.read(tmp_path / ur5.FIT).p, 1e-3 * true, atol=1e-12)
    monkeypatch.setenv(ur5.VARIABLE, str(tmp_path))
    page = ur5.topic(True, silent)
    geometry, terms, of_68, of_95 = np.array([figure.value for figure in page.figures], float)
    # noise of 0.05 mm along each axis is 0.08 mm on average; the sag is a millimetre
    assert geometry > 0.2
    assert terms == pytest.approx(0.08, rel=0.25)
    assert page.figures[1].verdict
    assert 8 < of_68 < of_95 <= 20
    assert any(row[1] == "yes" for row in page.tables[0].rows)
