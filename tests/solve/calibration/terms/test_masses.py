"""Compliance by the masses of the model, where it has those of all bodies, and else by levers."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration import Points, calibrate
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.terms.conditions import parse_conditions
from poekin.solve.calibration.terms.gravity import STANDARD_GRAVITY, levers, remarks

UR5 = pk.load("ur5").chain()
BODIES = np.column_stack(
    [[3.7, 8.4, 2.3, 1.2, 1.2, 0.2], np.random.default_rng(0).uniform(-0.4, 0.4, (6, 3))]
)
ARM = UR5.replace(masses=BODIES)
SLIDE = pk.Chain.from_space(
    [pk.screw.prismatic([0, 0, 1]), pk.screw.revolute([0, 1, 0], [0, 0, 0])],
    pk.se3.pose(np.eye(3), [1.0, 0, 0]), masses=[[2, 0, 0, 0.1], [3, 0.5, 0, 0]],
)  # fmt: skip
Q = UR5.random(0, 4)


def work(chain, q, g):
    """What gravity has done on all bodies at q, J."""
    P = np.eye(4)
    total = 0.0
    for screw, x, (mass, *c) in zip(chain.screws, q, chain.masses, strict=True):
        P = P @ pk.se3.exp(screw * x)
        total += mass * g @ (P @ [*c, 1.0])[:3]
    return total


@pytest.mark.parametrize("direction", [[0, 0, -1], [0, 2, 0]])
def test_joints_yield_by_the_gravity_torque_of_all_bodies(direction):
    conditions, reference = parse_conditions({"gravity": direction, "payload": 2.0}, Q)
    model = ErrorModel(ARM, ("compliance",), None, reference)
    B = model.basis(Q, conditions)
    g = STANDARD_GRAVITY * np.array(direction) / np.linalg.norm(direction)
    h = 1e-5
    for j, parameter in enumerate(model.parameters):
        assert parameter.unit == "rad/(N m)"
        i = UR5.q_names.index(parameter.owner)
        if parameter.what == "compliance":
            step = h * np.eye(6)[i]
            up, down = (np.array([work(ARM, q + sign * step, g) for q in Q]) for sign in (1, -1))
            # a central difference: h^2 of 100 J, and rounding of that over h
            torque = (up - down) / (2 * h)
            np.testing.assert_allclose(B[:, i, j], torque, rtol=0, atol=1e-8)
        else:
            lever = levers(UR5, Q, np.tile(g, (4, 1)), np.zeros(3))[:, i]
            np.testing.assert_allclose(B[:, i, j], 2.0 * lever, rtol=0, atol=1e-12)
    # the first joint stands upright, and carries what hangs sideways alone
    owners = [p.owner for p in model.parameters if p.what == "compliance"]
    assert owners == list(UR5.q_names[direction[2] != 0 :])


def test_what_slides_yields_in_metres():
    model = ErrorModel(SLIDE, ("compliance",), None)
    assert [p.unit for p in model.parameters] == ["m/N", "rad/(N m)"]
    weight = -5 * STANDARD_GRAVITY  # gravity pulls against a joint that slides up
    np.testing.assert_allclose(model.basis(np.zeros((1, 2)))[0, 0, 0], weight, rtol=1e-15)
    by_lever = ErrorModel(SLIDE.replace(masses=None), ("compliance",), None)
    # the weight is taken to be at the wrist, here on the only axis that turns
    assert [p.unit for p in by_lever.parameters] == ["m"]


def test_masses_that_are_not_known_of_all_bodies_are_not_used_and_that_is_told():
    partly = BODIES * np.array([[1], [1], [0], [1], [1], [0]])
    arm = UR5.replace(masses=partly)
    units = {p.unit for p in ErrorModel(arm, ("compliance",), None).parameters}
    assert units == {"rad/m"}
    (words,) = remarks(arm)
    assert words.startswith(
        "compliance is by levers of a weight at the wrist, not by the model's masses"
    )
    assert words.endswith("what these joints move has none: 'elbow_joint', 'wrist_3_joint'")
    assert remarks(ARM) == remarks(UR5) == ()


def test_true_stiffnesses_are_found_and_kept_in_a_file(tmp_path):
    q = UR5.random(np.random.default_rng(1), 60)
    conditions, reference = parse_conditions(None, q)
    term = ErrorModel(ARM, ("compliance",), None, reference)
    owners = [UR5.q_names.index(p.owner) for p in term.parameters]
    true = 1e-5 * np.arange(1.0, len(owners) + 1)  # rad/(N m)
    bent = q + term.basis(q, conditions) @ true
    point = [0.05, 0.03, 0.1]
    measured = Points(UR5.fk(bent)[:, :3] @ [*point, 1.0], point)
    kinds = ("screws", "home", "compliance")
    found = calibrate(ARM, q, measured, parameters=kinds, folds=0, on_rank_deficiency="fix")
    mine = [k for k, p in enumerate(found.parameters) if p.what == "compliance"]
    # joint 1 is upright and carries nothing; all others are told apart
    np.testing.assert_allclose(found.values[mine], true, rtol=1e-6)
    np.testing.assert_array_equal(found.chain.masses, BODIES)
    assert not any("levers" in remark for remark in found.remarks)
    found.save(tmp_path / "a.toml")
    again = pk.calibration.load(tmp_path / "a.toml")
    np.testing.assert_array_equal(again.nominal.masses, BODIES)
    fresh = UR5.random(3, 5)
    np.testing.assert_array_equal(again.true_joints(fresh), found.true_joints(fresh))
    partly = UR5.replace(masses=BODIES * (np.arange(6) > 0)[:, None])
    by_lever = calibrate(partly, q, measured, parameters=kinds, folds=0, on_rank_deficiency="fix")
    assert any("not by the model's masses" in remark for remark in by_lever.remarks)
