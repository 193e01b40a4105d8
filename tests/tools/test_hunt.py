"""The hunt for draws that break bounds: it counts them, keeps the worst, and fails where one
exceeds its bound.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import strategies as st

from tools.hunt import __main__ as command
from tools.hunt.bounds import Bound

NUMBERS = st.tuples(st.integers(0, 999))
HELD = Bound(NUMBERS, lambda n: np.array([0.25, n / 1000]))
BROKEN = Bound(NUMBERS, lambda n: [0.25, 2.0 if n > 900 else 0.5])
LOST = Bound(NUMBERS, lambda n: [0.25, float("nan") if n > 900 else 0.5])


def test_draws_are_counted_and_the_worst_is_kept():
    made, worst, holds = command.hunt(HELD, draws=300, seconds=60, first=1)
    assert made == 300
    assert 0.9 < worst < 1
    assert holds


@pytest.mark.parametrize("bound", [BROKEN, LOST], ids=["too large", "no number"])
def test_a_draw_beyond_its_bound_ends_the_hunt_and_is_printed(bound, capsys):
    _, _, holds = command.hunt(bound, draws=10_000, seconds=60, first=1)
    assert not holds
    assert "one(" in capsys.readouterr().out


def test_the_status_says_whether_all_bounds_hold(monkeypatch, capsys):
    monkeypatch.setattr(command, "BOUNDS", {"held": HELD, "broken": BROKEN})
    assert command.main(["held", "--draws", "10"]) == 0
    assert capsys.readouterr().out.split()[:3] == ["held", "10", "draws"]
    assert command.main(["--draws", "1000"]) == 1
    with pytest.raises(SystemExit):
        command.main(["other"])
    assert "no bound called 'other'; there are held, broken" in capsys.readouterr().err
