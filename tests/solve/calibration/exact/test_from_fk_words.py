"""Words of `from_fk` on pairs that are too few, that fit no arm, or whose digits are the limit."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.solve.calibration.exact.from_fk import _misfit, _remarks
from poekin.solve.calibration.exact.from_fk import from_fk as solved

ARM = pk.load("ur5").chain()


def fit(digits: str, angle: float, length: float, count: int = 20) -> Any:
    judged = SimpleNamespace(digits=digits, deviations=np.array([angle, length]))
    return SimpleNamespace(judged=judged, linear=SimpleNamespace(errors=np.zeros((count, 6))))


@pytest.mark.parametrize("digits", ["positions to 0.001 mm", ""])
def test_pairs_that_fit_no_arm_are_told_with_what_the_best_one_misses_them_by(digits):
    words = digits or "no digits that were rounded"
    # 999999 or 1000001 times one of these are other figures
    for size, said in ((1.2350005e-4, "124"), (1.2349995e-4, "123")):
        for angle, length in ((size, 3e-5), (3e-5, size)):
            figures = [said if x == size else "30" for x in (length, angle)]
            assert _misfit(fit(digits, angle, length)) == (
                f"no rigid arm explains these pairs to their digits ({words}): the best misses them by "
                f"{figures[0]} µm and {figures[1]} µrad (standard deviation); are they the controller's own "
                "forward kinematics, no measurement (that is what calibrate is for), with the joints "
                "at rest and one tool, and are its joint readings not coupled?"
            )


def test_frames_digits_and_a_small_number_of_pairs_are_remarked_on():
    limit = "the digits of the pairs are the limit: to 1 mm"
    few = "19 pairs: 20 and more say better whether the arm is a rigid one"
    assert _remarks("moved", fit("to 1 mm", 0, 0, 19)) == ["moved", limit, few]
    assert _remarks("", fit("to 1 mm", 0, 0, 20)) == [limit]
    assert _remarks("", fit("", 0, 0, 21)) == []


@pytest.mark.parametrize("count", [3, 4, 5])
def test_fewer_numbers_than_parameters_are_refused_as_too_few(count):
    q = ARM.random(0, count)
    with pytest.raises(InputError) as caught:
        solved(ARM, q, ARM.fk(q))
    assert str(caught.value) == (
        f"{count} pairs for 30 parameters: at least 6 are needed, and 20 to 60 say whether the arm is "
        "a rigid one"
    )
