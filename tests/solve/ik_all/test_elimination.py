"""Elimination: the configuration that a pose was made of is among the solutions, of every kind of arm."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from benchmarks.calibrated_arm import calibrated_ur10e
from poekin.errors import InputError
from poekin.solve.ik_all.elimination import elimination

CLOSE = 1e-6  # rad: before Newton's rule, of roots whose margin is 1e-7 and more


def arm(seed, kind):
    """An arm whose axes meet or are parallel where the kind says."""
    rng = np.random.default_rng(seed)
    h = rng.normal(size=(6, 3))
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    o = 0.4 * rng.normal(size=(6, 3))
    where = {"meet": o, "parallel": h}
    for what, i, k in kind:
        where[what][k] = where[what][i]
    home = np.eye(4)
    home[:3] = pk.se3.exp(rng.normal(size=6))[:3]
    return pk.Chain(np.hstack([h, np.cross(o, h)]), home, frame="space")


KINDS = {
    "any": (),
    "5 and 6 meet": (("meet", 4, 5),),
    "1 and 2 meet": (("meet", 0, 1),),
    "3 and 4 meet": (("meet", 2, 3),),
    "2 and 3 parallel": (("parallel", 1, 2),),
    "4 and 5 parallel": (("parallel", 3, 4),),
    "pairs meet": (("meet", 0, 1), ("meet", 4, 5)),
    "parallel and meeting": (("parallel", 1, 2), ("meet", 4, 5)),
}


def solved(chain, T):
    solver = elimination(chain)
    assert solver is not None
    return solver.rows(T)


def apart(a, b):
    return np.abs((a - b + np.pi) % (2 * np.pi) - np.pi).max(axis=-1)


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
@given(st.integers(0, 10**6))
@settings(max_examples=10)
def test_the_configuration_of_a_pose_is_found_wherever_it_is_sure(kind, seed):
    chain = arm(seed, kind)
    q = np.random.default_rng(seed + 1).uniform(-np.pi, np.pi, (40, 6))
    T = chain.fk(q)
    found = solved(chain, T)
    known = found.margin >= 0
    off = np.where(known, apart(found.q, q[:, None]), np.inf).min(axis=1)
    assert (off[found.sure] < CLOSE).all()
    # what it is not sure of is rare
    assert found.sure.mean() > 0.8
    owner, row = np.nonzero(found.margin > 0)
    errors = np.abs(chain.fk(found.q[owner, row]) - T[owner]).max(axis=(1, 2))
    assert errors.max() <= 1e-6 * max(1.0, chain.reach)


def test_all_that_a_search_finds_is_found():
    chain = pk.load("jaco").chain()
    q = np.random.default_rng(3).uniform(-np.pi, np.pi, (4, 6))
    T = chain.fk(q)
    found = solved(chain, T)
    searched = pk.ik_all(chain, T, method="search", min_hits=20, limits=False)
    for k in range(len(T)):
        ours = found.q[k][found.margin[k] >= 0]
        assert len(ours) == len(searched.solutions[k])
        for solution in searched.solutions[k]:
            assert apart(ours, solution).min() < CLOSE


def test_where_the_determinant_spans_many_orders_no_solution_is_lost_unsaid():
    # more roots of what is 0 but for rounding, far from a quarter, than there is room for
    chain = pk.load("jaco").chain()
    q = [-0.6296941, -1.94355181, -0.15500742, 0.07573711, -0.0093472, -2.83831676]
    found = solved(chain, chain.fk(q)[None])
    assert (found.margin >= 0).sum() == 12 or not found.sure[0]


def singular(chain, count, seed):
    """Singular configurations (count, 6): between two whose Jacobians' determinants differ in sign."""
    rng = np.random.default_rng(seed)
    ends = rng.uniform(-np.pi, np.pi, (2, 8 * count, 6))

    def sign(q):
        return np.sign(np.linalg.det(chain.jacobian(q, frame="space")))

    first, second = ends[:, np.prod(sign(ends), axis=0) < 0][:, :count]
    before = sign(first)
    for _ in range(60):
        middle = 0.5 * (first + second)
        same = (sign(middle) == before)[:, None]
        first = np.where(same, middle, first)
        second = np.where(same, second, middle)
    assert len(first) == count
    return first


@pytest.mark.parametrize("name", ["jaco", "jaco with its wrist folded", "calibrated", "any"])
def test_a_singular_solution_is_listed_or_the_list_is_not_said_to_be_complete(name):
    """It is a double root of the determinant, which rounding parts, or takes away."""
    chains = {"calibrated": calibrated_ur10e(), "any": arm(7, ())}
    chain = chains.get(name, pk.load("jaco").chain())
    q = singular(chain, 30, seed=5)
    if "folded" in name:
        q = np.random.default_rng(1).uniform(-np.pi, np.pi, (30, 6))
        q[:, 3:5] = np.pi
    found = pk.ik_all(chain, chain.fk(q), limits=False, method="elimination", restarts=20)
    missed = []
    for k, solutions in enumerate(found.solutions):
        listed = len(solutions) and apart(solutions, q[k]).min() < 1e-3
        if not listed and found.complete[k]:
            missed.append(k)
    # Of 1900 such targets one was; three of 30 are by a chance of 1e-6, where rounding is another.
    # Before, some ten were.
    assert len(missed) <= 2


def test_out_of_reach_there_is_no_solution_and_that_is_sure():
    chain = arm(1, ())
    T = np.eye(4)
    T[0, 3] = 3 * chain.reach
    found = solved(chain, T[None])
    assert not (found.margin >= 0).any()
    assert found.sure[0]


def test_offsets_of_the_joints_are_taken_in():
    chain = arm(2, ())
    turned = pk.Chain(
        chain.screws, chain.home, frame="space", offset=[0.3, -1.0, 0.2, 2.0, -0.4, 0.1]
    )
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (5, 6))
    found = solved(turned, turned.fk(q))
    assert (
        apart(found.q, q[:, None]).min(axis=1, initial=9, where=found.margin >= 0) < CLOSE
    ).all()


def test_other_numbers_of_joints_have_no_elimination():
    assert elimination(arm(0, ()).replace(tip="x")) is not None
    five = arm(0, ())
    assert elimination(pk.Chain(five.screws[:5], five.home, frame="space")) is None


def test_slides_are_refused():
    screws = arm(0, ()).screws.copy()
    screws[2] = [0, 0, 0, 0, 0, 1]
    with pytest.raises(InputError, match="revolute"):
        elimination(pk.Chain(screws, np.eye(4), frame="space"))


def test_of_a_wrist_with_errors_hardly_a_pose_is_left_to_the_search():
    wrist = pk.load("irb140").chain()
    rng = np.random.default_rng(5)
    moved = pk.se3.exp(rng.normal(scale=[np.radians(0.3)] * 3 + [1e-3] * 3, size=(6, 6)))
    screws = (pk.se3.adjoint(moved) @ wrist.screws[:, :, None])[:, :, 0]
    chain = pk.Chain(screws, wrist.home, frame="space")
    q = np.random.default_rng(2).uniform(-np.pi, np.pi, (20_000, 6))
    found = solved(chain, chain.fk(q))
    # loops begun at four of the joints are unsure of eight, those begun at any joint of none
    assert (~found.sure).sum() <= 3
