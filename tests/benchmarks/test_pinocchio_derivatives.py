"""The oracle of derivatives judged by differences of the oracle of Jacobians, and what it makes of
an error.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from benchmarks.derivative_errors import DerivativeErrors, derivative_errors
from benchmarks.pinocchio_derivatives import derivatives
from poekin.errors import InputError
from poekin.formats import urdf
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle
from tests.testing.oracles.test_pinocchio_oracle import TWO_LINKS, URDF
from tests.versions import needs

FRAMES = ("space", "body", "hybrid")


@pytest.fixture(scope="module")
def oracle() -> PinocchioOracle:
    needs("pin", "3")  # Pinocchio 2 has no kinematic Hessians in Python
    return PinocchioOracle(URDF)


@pytest.mark.parametrize(
    ("base", "tip", "still"),
    [(None, "e", ()), ("root", "c", ()), ("b", "e", ("turn", "slide")), ("a", "b", ("turn",))],
)
def test_derivatives_are_those_of_jacobians_and_velocities(oracle, base, tip, still):
    rng = np.random.default_rng(3)
    q = oracle.random(rng, 2)
    names = oracle.coordinates
    dq, ddq = rng.uniform(-1, 1, (2, 2, len(names)))
    moves = [k for k, name in enumerate(names) if name not in still]
    for k in set(range(len(names))) - set(moves):
        dq[:, k] = ddq[:, k] = 0
    found = derivatives(oracle, q, dq, ddq, tip, base)

    def jacobians(t: float, rates: np.ndarray, grown: np.ndarray) -> dict[str, np.ndarray]:
        at = {
            name: q[name] + t * rates[:, k] + t * t / 2 * grown[:, k]
            for k, name in enumerate(names)
        }
        return oracle.evaluate(at, tip, base)[1]

    h = 1e-5
    for frame in FRAMES:
        dJ = (jacobians(h, dq, ddq)[frame] - jacobians(-h, dq, ddq)[frame]) / (2 * h)
        np.testing.assert_allclose(
            found.rate[frame][:, :, moves], dJ[:, :, moves], rtol=0, atol=1e-8
        )
        ahead, behind = (
            jacobians(s * h, dq, ddq)[frame] @ (dq + s * h * ddq)[:, :, None] for s in (1, -1)
        )
        np.testing.assert_allclose(
            found.acceleration[frame], ((ahead - behind) / (2 * h))[..., 0], rtol=0, atol=1e-8
        )
        for k in range(len(names)):
            unit = np.broadcast_to(np.eye(len(names))[k], dq.shape)
            dJ = (jacobians(h, unit, 0 * unit)[frame] - jacobians(-h, unit, 0 * unit)[frame]) / (
                2 * h
            )
            expected = np.where(np.isin(range(len(names)), moves), dJ, 0.0) * (k in moves)
            np.testing.assert_allclose(found.hessian[frame][..., k], expected, rtol=0, atol=1e-8)
        fixed = [k for k in range(len(names)) if k not in moves]
        assert not found.rate[frame][:, :, fixed].any()


@pytest.mark.parametrize("moving", ["rates", "accelerations"])
def test_a_base_that_is_set_moving_is_refused(oracle, moving):
    q, m = oracle.random(np.random.default_rng(4), 1), len(oracle.coordinates)
    zero, one = np.zeros((1, m)), np.eye(m)[[oracle.coordinates.index("turn")]]
    dq, ddq = (one, zero) if moving == "rates" else (zero, one)
    with pytest.raises(
        InputError, match="the base 'b' moves: rates of 0 expected for what moves it"
    ):
        derivatives(oracle, q, dq, ddq, "e", "b")
    assert derivatives(oracle, q, dq, ddq, "e", "root").rate["space"].shape == (1, 6, m)


def test_without_a_degree_of_freedom_nothing_has_a_rate():
    oracle = PinocchioOracle(TWO_LINKS.replace("continuous", "fixed"))
    found = derivatives(oracle, {}, np.zeros((1, 0)), np.zeros((1, 0)), "b")
    for frame in FRAMES:
        assert found.rate[frame].shape == (1, 6, 0)
        assert found.hessian[frame].shape == (1, 6, 0, 0)
        assert found.acceleration[frame].tolist() == [[0] * 6]


def test_the_worst_of_three_errors_counts_and_nan_most():
    for k in range(3):
        values = [0.1, 0.1, 0.1]
        values[k] = 0.3
        assert DerivativeErrors(*values).worst == 0.3
        values[k] = math.nan
        assert math.isnan(DerivativeErrors(*values).worst)


class Off:
    """A chain of whose answers one has one row off, in one frame; it notes where it is asked."""

    def __init__(self, chain: Any, name: str, row: int, frame: str):
        self._chain, self._wrong, self.asked = chain, (name, row, frame), []

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._chain, name)
        if name not in ("jacobian_rate", "hessian", "acceleration"):
            return value

        def answer(*arguments: Any) -> np.ndarray:
            self.asked.append(arguments)
            result = np.array(value(*arguments))
            if self._wrong[0] == name and self._wrong[2] == arguments[-1]:
                result[(-1, self._wrong[1], *[-1] * (result.ndim - 2))] -= 1e-3
            return result

        return answer


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize(
    ("k", "name"), list(enumerate(["jacobian_rate", "hessian", "acceleration"]))
)
def test_an_error_is_measured_where_it_is_and_lengths_by_the_reach(oracle, k, name, frame):
    chain = urdf.read_text(URDF).chain("root", "e")
    assert chain.reach != pytest.approx(1, rel=0.1)
    assert max(derivative_errors(chain, oracle, samples=2)) < 1e-13
    for row in range(6):
        found = derivative_errors(Off(chain, name, row, frame), oracle, samples=2)
        expected = np.zeros(3)
        expected[k] = 1e-3 / (chain.reach if row >= 3 else 1)
        assert found == pytest.approx(expected, rel=1e-6, abs=1e-13)


def test_the_first_configuration_is_zero_and_rates_are_up_to_one(oracle):
    chain = urdf.read_text(URDF).chain("root", "e")
    asked = {}
    for seed in (0, 1):
        seen = Off(chain, "", 0, "")
        derivative_errors(seen, oracle, samples=30, seed=seed)
        asked[seed] = next(arguments for arguments in seen.asked if len(arguments) == 4)
        q, dq, ddq, _ = asked[seed]
        assert not q[0].any()
        assert q[1:].all()
        for rates in (dq, ddq):
            assert -1 <= rates.min() < -0.9
            assert 0.9 < rates.max() <= 1
            assert abs(rates.mean()) < 0.3
        assert not np.array_equal(dq, ddq)
    assert not np.array_equal(asked[0][0], asked[1][0])
