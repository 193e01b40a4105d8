"""Each effect has its name, its sentence, its chance and its size in words."""

from __future__ import annotations

from typing import get_args

import pytest

from poekin.solve.calibration.diagnostics.effects.columns import EffectKind
from poekin.solve.calibration.diagnostics.effects.effect_test import EffectTest, chance

WORDS = {
    "gravity": ("gravity lever of W", "W sags"),
    "angle": ("angle of W", "the error of W repeats with its angle"),
    "lag": ("the move before", "readings lag the motion"),
    "backlash": (
        "direction of the move before",
        "joints stop by the side that they come from (backlash)",
    ),
    "drift": ("time", "the base drifts"),
    "place": ("place in space", "the device errs by the place in space (its scale, or its field)"),
    "set": ("W against the others", "W stands elsewhere than the others"),
    "reflector": ("place of W on the tool", "W is not where it is said to be"),
    "loose": ("scatter of W against the others", "W is loose"),
}


def test_every_kind_is_called_by_its_words():
    assert set(get_args(EffectKind)) == set(WORDS)
    for kind in get_args(EffectKind):
        test = EffectTest(kind, "W", 0.00312, 1.26e-4)
        assert (test.what, test.verdict) == WORDS[kind]
        assert str(test) == f"{WORDS[kind][1]} (p = 0.0031, 0.13 mm)"


def test_a_joint_that_turns_against_its_load_does_not_sag():
    test = EffectTest("gravity", "joint 2 (lift)", 1e-9, 2e-3, against=True)
    assert str(test) == "joint 2 (lift) turns against its load (p = 1e-09, 2 mm)"
    assert test.what == "gravity lever of joint 2 (lift)"


@pytest.mark.parametrize(
    ("p", "said"),
    [(1.0, "p = 1"), (1e-300, "p = 1e-300"), (9e-301, "p < 1e-300"), (0.0, "p < 1e-300")],
)
def test_a_chance_that_is_next_to_nothing_is_told_as_less(p, said):
    assert chance(p) == said
