"""Fits with terms predict what an independent fit predicts."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.solve.calibration import calibrate
from tests.solve.calibration.terms import independent_fit
from tests.solve.calibration.terms.sagging import POINT, arm, case, lever, loaded

PREDICTED = 1e-9  # m: what the bar of 1e-6 mm allows the two to differ


def bases(q, chain, names):
    """Bases by other code than the package's, but for the levers."""
    n = q.shape[1]
    own = np.eye(n)
    parts = []
    if "compliance" in names:
        joints = loaded(chain)
        parts.append(lever(chain, q)[:, None, :][:, :, joints] * own[:, joints])
    for order in (1, 2):
        if ("harmonics", "second harmonics")[order - 1] in names:
            parts += [f(order * q)[:, :, None] * own for f in (np.sin, np.cos)]
    return np.concatenate(parts, axis=2) if parts else np.empty((*q.shape, 0))


@pytest.mark.parametrize("names", [(), ("compliance", "harmonics")])
def test_an_independent_fit_predicts_the_same(names):
    chain = arm("irb140")
    made = case(chain, 3, sag=1e-3, count=80)
    found = calibrate(
        chain, made.q, made.points, parameters=("screws", "home", *names), folds=0,
        on_rank_deficiency="fix",
    )  # fmt: skip
    assert found.success
    other = independent_fit.fit(
        chain.screws, chain.home, POINT, made.q, made.points.p[:, 0],
        lambda q: bases(q, chain, names),
    )  # fmt: skip
    mine = found.chain.fk(found.true_joints(made.fresh))[:, :3] @ [*POINT, 1.0]
    off = np.linalg.norm(mine - other(made.fresh), axis=1)
    assert off.max() <= PREDICTED
