"""Non-geometric terms: their bases are what they say, and the motion of the tool is their derivative."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.solve.calibration import Conditions, Parameter, Term
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.terms.conditions import at_rest, parse_conditions
from poekin.solve.calibration.terms.gravity import STANDARD_GRAVITY, levers, wrist
from poekin.solve.calibration.terms.named import BUILDERS
from poekin.testing.oracles.differences import derivative

UR5 = pk.load("ur5").chain()
PUMA = pk.load("puma560").chain()
COUPLED = pk.Chain.from_space(
    [pk.screw.revolute([0, 1, 0], [0.1, 0, 0.5]), pk.screw.prismatic([0, 0.6, 0.8]),
     pk.screw.revolute([0, 1, 0], [0.7, 0, 0.5])],
    pk.se3.exp([0.1, -0.2, 0.3, 0.9, 0.1, 0.4]), coupling=[[1, 0], [0, 1], [1, 0.5]], q_names=["u", "v"],
)  # fmt: skip
NAMED = tuple(BUILDERS)
GIVEN = {"payload": [0.0, 1.0, 2.0, 4.0, 0.5], "temperature": [290.0, 291, 294, 293, 292]}


@pytest.mark.parametrize("chain", [UR5, PUMA, COUPLED], ids=["ur5", "puma", "coupled"])
def test_the_twists_of_all_parameters_are_the_slopes_of_the_poses(chain):
    q = chain.random(0, 5) if chain is not COUPLED else np.linspace(-1, 1, 10).reshape(5, 2)
    conditions, reference = parse_conditions(GIVEN, q)
    model = ErrorModel(chain, ("screws", "home", "gains", "offsets", *NAMED), None, reference)
    p = 1e-2 * np.random.default_rng(1).normal(size=len(model.parameters))
    B = model.basis(q, conditions)
    T, D = model.poses_and_twists(p, q, B)
    for k in range(len(p)):
        rate = 2.0 + np.abs(B).max() + np.abs(q).max()
        dT = derivative(lambda at: model.poses(at, q, B), p, np.eye(len(p))[k], rate)
        X = dT @ np.linalg.inv(T)
        slopes = np.stack([X[:, 2, 1], X[:, 0, 2], X[:, 1, 0], *X[:, :3, 3].T], axis=-1)
        # differences are right to 1e-11 of the rate, as rounding of poses is 1e-15
        np.testing.assert_allclose(D[..., k], slopes, rtol=0, atol=1e-9 * rate**2)


@pytest.mark.parametrize("chain", [UR5, PUMA, COUPLED], ids=["ur5", "puma", "coupled"])
def test_the_chain_at_the_true_joints_is_where_the_model_has_the_arm(chain):
    q = chain.random(0, 5) if chain is not COUPLED else np.linspace(-1, 1, 10).reshape(5, 2)
    conditions, reference = parse_conditions(GIVEN, q)
    model = ErrorModel(chain, ("screws", "home", "gains", "offsets", *NAMED), None, reference)
    p = 1e-2 * np.random.default_rng(2).normal(size=len(model.parameters))
    T = model.poses(p, q, model.basis(q, conditions))
    found = model.chain(p).fk(model.true_joints(p, q, conditions))
    np.testing.assert_allclose(found, T, rtol=0, atol=1e-12)


@pytest.mark.parametrize("chain", [UR5, PUMA, COUPLED], ids=["ur5", "puma", "coupled"])
def test_the_lever_of_a_weight_is_how_much_lower_it_gets(chain):
    q = np.random.default_rng(3).uniform(-1, 1, (6, chain.dof))
    point = np.array([0.1, -0.05, 0.2])
    down = np.array([0.6, 0.0, -0.8])
    found = levers(chain, q, np.tile(down, (6, 1)), point)
    h = 1e-6
    for i in range(chain.dof):
        step = h * np.eye(chain.dof)[i]
        lower = [(chain.fk(q + s * step)[:, :3] @ [*point, 1.0]) @ down for s in (1, -1)]
        # a central difference: h^2 of curvature, and 1e-16 / h of rounding
        np.testing.assert_allclose(found[:, i], (lower[0] - lower[1]) / (2 * h), atol=1e-8)


def test_the_wrist_is_where_the_last_three_axes_meet():
    found = wrist(PUMA)
    for ω, v in zip(PUMA.screws[-3:, :3], PUMA.screws[-3:, 3:], strict=True):
        np.testing.assert_allclose(np.cross(ω, found) + v, 0, atol=1e-12)


def test_joints_that_carry_nothing_have_no_compliance():
    owners = [p.owner for p in ErrorModel(PUMA, ("compliance",), None).parameters]
    assert owners == [PUMA.q_names[1], PUMA.q_names[2]]
    sideways = {"gravity": [0.0, -1.0, 0.0]}
    owners = [p.owner for p in ErrorModel(PUMA, ("compliance",), None, sideways).parameters]
    assert owners == list(PUMA.q_names[:3])


def test_a_payload_is_one_more_number_a_joint_by_its_torque_at_the_tip():
    q = UR5.random(0, 5)
    conditions, reference = parse_conditions(GIVEN, q)
    model = ErrorModel(UR5, ("compliance",), None, reference)
    mine = [k for k, p in enumerate(model.parameters) if p.unit == "rad/(N m)"]
    B = model.basis(q, conditions)[..., mine]
    torques = levers(UR5, q, conditions.gravity, np.zeros(3)) * STANDARD_GRAVITY
    torques *= np.array(GIVEN["payload"])[:, None]
    owners = [UR5.q_names.index(model.parameters[k].owner) for k in mine]
    np.testing.assert_allclose(B.sum(axis=1), torques[:, owners], atol=1e-12)


def of(name, q, conditions, owner=1):
    """Columns of the coefficients of one coordinate, in their order."""
    model = ErrorModel(UR5, (name,), None)
    mine = [k for k, p in enumerate(model.parameters) if p.owner == UR5.q_names[owner]]
    B = model.basis(q, conditions)[..., mine]
    assert not np.delete(B, owner, axis=1).any()
    return B[:, owner]


def test_each_term_is_what_it_says():
    q = UR5.random(0, 5)
    c, _ = parse_conditions(None, q)
    x = q[:, 1]
    np.testing.assert_array_equal(of("coupling", q, c), q[:, [0, 2]])
    np.testing.assert_array_equal(of("harmonics", q, c), np.column_stack([np.sin(x), np.cos(x)]))
    twice = np.column_stack([np.sin(2 * x), np.cos(2 * x)])
    np.testing.assert_array_equal(of("second harmonics", q, c), twice)
    np.testing.assert_array_equal(of("backlash", q, c)[:, 0], c.approach[:, 1] / 2)
    np.testing.assert_array_equal(of("lag", q, c)[:, 0], x - c.previous[:, 1])
    np.testing.assert_array_equal(of("drift", q, c)[:, 0], c.drift)
    rest = at_rest(q, {})
    assert not any(of(name, q, rest).any() for name in ("backlash", "lag", "drift"))


def test_only_the_joints_that_may_change_have_coefficients():
    for name in NAMED:
        owners = {p.owner for p in ErrorModel(UR5, (name,), [UR5.joint_names[2]]).parameters}
        assert owners == {UR5.q_names[2]}, name


def ripple(q, conditions):
    assert isinstance(conditions, Conditions)
    return np.sin(50 * q)[:, :, None] * [1.0]


def test_a_basis_of_another_shape_or_not_finite_is_refused():
    own = Term("ripple", (Parameter("a", "ripple", "rad"),), ripple)
    q = UR5.random(0, 5)
    np.testing.assert_array_equal(ErrorModel(UR5, (own,), None).basis(q), ripple(q, at_rest(q, {})))
    for basis, error in (
        (lambda q, c: q, ShapeError),
        (lambda q, c: np.nan * q[..., None], InputError),
    ):
        bad = Term("bad'\n", own.parameters, basis)
        with pytest.raises(error, match=r"basis of the term"):
            ErrorModel(UR5, (bad,), None).basis(q)
    with pytest.raises(InputError, match="expected a name and at least one coefficient"):
        Term("none", (), ripple)
