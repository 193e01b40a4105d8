"""The counting scalar: what it charges, and the paper's table by running the algorithms."""

import math
import operator

import numpy as np
import pytest

import poekin as pk
from poekin.algebra import adjoint, compose, turned_about_z
from poekin.analysis.counting.count import METHODS
from poekin.analysis.counting.count_methods import product_by_cross
from poekin.engine.count import Count, Counted, counted
from poekin.formulas import elementary
from poekin.formulas.kinematics import forward, recursive
from poekin.formulas.lie import exponential
from poekin.formulas.paper import dh_recursive, direct

POSE = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.1, 0.2, 0.3)


def cost(formula, *arguments):
    """Multiplications and additions of a formula of variables."""
    total = Count()
    formula(*(a if isinstance(a, (list, int)) else counted(a, total) for a in arguments))
    return total.multiplications, total.additions


def generic_arm(n, seed=0):
    rng = np.random.default_rng(seed)
    return pk.Chain.from_space(
        [pk.screw.revolute(*rng.normal(size=(2, 3))) for _ in range(n)],
        pk.se3.exp(rng.normal(size=6)),
    )


TABLE = {
    ("direct", "space"): lambda n: (60 * n - 96, 45 * n - 72),
    ("direct", "body"): lambda n: (60 * n - 96, 45 * n - 72),
    ("recursive", "body"): lambda n: (42 * n - 78, 30 * n - 57),
    ("recursive_with_tool", "body"): lambda n: (42 * n - 42, 30 * n - 30),
    ("recursive_by_cross", "body"): lambda n: (39 * n - 72, 27 * n - 51),
    ("recursive_general_frames", "body"): lambda n: (60 * n - 96, 45 * n - 72),
    ("dh_recursive", "body"): lambda n: (42 * n, 30 * n),
    ("dh_paul", "body"): lambda n: (42 * n - 36, 30 * n - 27),
    ("dh_modified", "body"): lambda n: (42 * n - 78, 30 * n - 57),
}


@pytest.mark.parametrize("n", range(2, 13))
@pytest.mark.parametrize("method, frame", TABLE)
def test_the_paper_s_table_comes_out_by_counting(method, frame, n):
    total = pk.count(generic_arm(n), method=method, frame=frame)
    assert (total.multiplications, total.additions) == TABLE[method, frame](n)


def test_every_method_is_in_the_table():
    counted_as_the_paper_does = {
        (m, f)
        for m, ways in METHODS.items()
        for w in ways
        for f in w.frames
        if "paper" in w.countings
    }
    assert counted_as_the_paper_does == set(TABLE)


def test_a_product_and_an_adjoint_cost_what_the_paper_says():
    assert cost(compose, POSE, POSE) == (36, 27)
    assert cost(product_by_cross, POSE, POSE) == (33, 24)
    assert cost(adjoint, POSE, POSE[:6]) == (24, 18)
    assert cost(recursive.z_column, POSE, 1, 0) == (6, 3)


def test_a_column_of_a_prismatic_joint_costs_nothing():
    assert cost(recursive.z_column, POSE, 0, 1) == (0, 0)


def test_the_v_recursion_costs_24_multiplications_a_joint_after_the_first():
    n, total = 6, Count()
    links, rates = counted([POSE] * n, total), counted([0.1] * n, total)
    V = recursive.body_velocity(links, POSE, [1] * n, [0] * n, n, rates)
    # the constant tool behind the last joint is one adjoint more
    assert (total.multiplications - 24, len(V)) == (24 * n - 24, 6)


def test_an_exponential_of_a_revolute_joint_costs_15_and_13_and_its_pitch_3_and_3():
    total = Count()
    q, s, c = counted((0.3, 0.1, 0.9), total)
    exponential.joint((0.6, 0.0, 0.8), (0.1, 0.2, 0.3), q, s, c)
    assert (total.multiplications, total.additions) == (15 + 3, 13 + 3)


def test_constants_among_themselves_negation_and_structure_are_free():
    total = Count()
    x = Counted(2.0, total)
    _ = -(x * 1) + 0 - 0 * x + (-1) * x
    assert total == Count(additions=1)


OPERATIONS = {
    "a + b": (lambda a, b: a + b, "additions"),
    "a - b": (lambda a, b: a - b, "additions"),
    "a * b": (lambda a, b: a * b, "multiplications"),
    "a / b": (lambda a, b: a / b, "divisions"),
    "a % b": (lambda a, b: a % b, "divisions"),
    "atan2": (elementary.atan2, "arctangents"),
}
FUNCTIONS = {
    "sqrt": (elementary.sqrt, math.sqrt, "square_roots"),
    "sin": (elementary.sin, math.sin, "sines"),
    "cos": (elementary.cos, math.cos, "cosines"),
    "abs": (abs, abs, None),
    "-": (operator.neg, operator.neg, None),
}


@pytest.mark.parametrize("name", OPERATIONS)
@pytest.mark.parametrize("kinds", [(True, True), (True, False), (False, True)])
def test_an_operation_of_counting_numbers_gives_what_floats_give_and_costs_one(name, kinds):
    operation, charged = OPERATIONS[name]
    total = Count()
    a, b = (
        Counted(x, total) if counting else x
        for x, counting in zip((7.5, -2.25), kinds, strict=True)
    )
    if name in ("a % b", "atan2") and not kinds[0]:
        pytest.skip("no formula has a plain number there")
    result = operation(a, b)
    assert (float(result), total) == (operation(7.5, -2.25), Count(**{charged: 1}))
    assert result.count is total


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_of_a_counting_number_gives_what_it_gives_of_a_float_and_costs_one_or_nothing(
    name,
):
    function, plain, charged = FUNCTIONS[name]
    total = Count()
    value = -0.75 if charged != "square_roots" else 0.75
    assert float(function(Counted(value, total))) == plain(value)
    assert total == Count(**({charged: 1} if charged else {}))


@pytest.mark.parametrize("name", ["lt", "le", "gt", "ge", "eq", "ne"])
@pytest.mark.parametrize("other", [1.0, 2.0, 3.0])
def test_counting_numbers_compare_as_floats_and_for_nothing(name, other):
    total, compare = Count(), getattr(operator, name)
    a, b = Counted(2.0, total), Counted(other, total)
    assert compare(a, b) == compare(a, other) == compare(2.0, other)
    assert compare(other, a) == compare(other, 2.0)
    assert total == Count()


def test_zero_minus_a_number_and_zero_plus_it_are_free():
    total = Count()
    x = Counted(2.0, total)
    assert float(0 - x) == -2.0
    assert (0 + x, x - 0, x + 0) == (x, x, x)
    assert total == Count()


@pytest.mark.parametrize("whole", [-2, -1, 0, 1, 2])
def test_of_whole_numbers_only_0_1_and_minus_1_are_free_as_factors_and_0_as_a_summand(whole):
    for operation, free, charged in (
        (operator.mul, (-1, 0, 1), "multiplications"),
        (operator.add, (0,), "additions"),
        (operator.sub, (0,), "additions"),
    ):
        for swapped in (False, True):
            total = Count()
            pair = (Counted(2.5, total), whole)
            a, b = pair[::-1] if swapped else pair
            x, y = map(float, (a, b))
            assert float(operation(a, b)) == operation(x, y)
            assert total == Count(**({} if whole in free else {charged: 1}))


def test_counting_numbers_in_lists_and_tuples_are_of_one_count():
    total = Count()
    found = counted([(1.0, 2.0), [3.0]], total)
    assert [type(part) for part in found] == [tuple, list]
    assert [float(x) for part in found for x in part] == [1, 2, 3]
    assert {id(x.count) for part in found for x in part} == {id(total)}


def test_a_moved_link_pose_costs_12_and_6():
    total = Count()
    sine, cosine = counted((0.1, 0.9), total)
    turned_about_z(POSE, sine, cosine, 0)
    assert (total.multiplications, total.additions) == (12, 6)


def test_a_count_is_a_dict_with_pairs_of_sines_and_cosines():
    cost = Count(multiplications=3, sines=2, cosines=1)
    assert cost.to_dict() == {
        "multiplications": 3, "additions": 0, "divisions": 0, "square_roots": 0, "sines": 2, "cosines": 1,
        "arctangents": 0, "sine_cosine_pairs": 2,
    }  # fmt: skip
    assert str(Count(12, 6, square_roots=1)) == "12 multiplications, 6 additions, 1 square roots"
    assert str(Count()) == "no operations"


@pytest.mark.parametrize("sines, cosines", [(0, 0), (1, 3), (3, 1), (2, 2)])
def test_an_angle_of_which_only_one_is_needed_is_a_pair(sines, cosines):
    count = Count(sines=sines, cosines=cosines)
    assert count.sine_cosine_pairs == max(sines, cosines)


def test_a_float_one_is_a_number_like_any_other():
    total = Count()
    _ = Counted(2.0, total) * 1.0
    assert total == Count(multiplications=1)


def test_counting_sees_one_operation_more():
    def padded(a, b):
        return compose(a, b), a[0] * b[0]

    assert cost(padded, POSE, POSE) == (37, 27)


def random_dh_arm(n, rng):
    """Random link constants and tool of a revolute arm in Paul's frames, and the same arm as a
    Chain.
    """
    constants = [pk.se3.exp(rng.normal(size=6)) for _ in range(n)]
    tool = pk.se3.exp(rng.normal(size=6))
    F, screws = np.eye(4), []
    for N in constants:
        screws.append(pk.se3.adjoint(F) @ [0, 0, 1, 0, 0, 0])
        F = F @ N
    return constants, tool, pk.Chain.from_space(screws, F @ tool)


def row(T):
    return [*T[:3, :3].ravel().tolist(), *T[:3, 3].tolist()]


@pytest.mark.parametrize("n", range(2, 13))
def test_the_counted_algorithms_give_one_and_the_same_jacobian(n):
    rng = np.random.default_rng(n)
    constants, tool, arm = random_dh_arm(n, rng)
    q = rng.uniform(-np.pi, np.pi, n)
    expected = arm.jacobian(q, "body")
    turns = [pk.se3.exp([0, 0, x, 0, 0, 0]) for x in q]
    results = {}

    def rows():
        return [[0.0] * n for _ in range(6)]

    J = results["dh_recursive"] = rows()
    dh_recursive.body(
        [row(Z @ N) for Z, N in zip(turns, constants, strict=True)],
        row(tool),
        [1] * n,
        [0] * n,
        n,
        J,
    )
    local = arm.local
    links = [row(M @ Z) for M, Z in zip(local.frames, turns, strict=False)]
    J = results["recursive_with_tool"] = rows()
    recursive.body_with_tool(links, row(local.frames[n]), [1] * n, [0] * n, n, J)
    bare = arm.retooled(pk.se3.inverse(local.frames[n]))
    J = rows()
    recursive.body(links, [1] * n, [0] * n, n, J)
    np.testing.assert_allclose(J, bare.jacobian(q, "body"), rtol=0, atol=2e-14 * arm.reach)
    J = results["direct body"] = rows()
    direct.body(
        arm.body.screws.tolist(),
        [row(pk.se3.exp(B * x)) for B, x in zip(arm.body.screws, q, strict=True)],
        n,
        J,
    )
    for J in results.values():
        np.testing.assert_allclose(J, expected, rtol=0, atol=2e-14 * arm.reach)
    J = rows()
    direct.space(
        arm.screws.tolist(),
        [row(pk.se3.exp(A * x)) for A, x in zip(arm.screws, q, strict=True)],
        n,
        J,
    )
    np.testing.assert_allclose(J, arm.jacobian(q, "space"), rtol=0, atol=2e-14 * arm.reach)


def test_the_pose_comes_out_of_the_same_pass():
    n, rng = 5, np.random.default_rng(3)
    arm, q = generic_arm(n, 3), rng.normal(size=5)
    E = [row(pk.se3.exp(A * x)) for A, x in zip(arm.screws, q, strict=True)]
    product = direct.space(arm.screws.tolist(), E, n, [[0.0] * n for _ in range(6)])
    np.testing.assert_allclose(
        compose(compose(product, E[-1]), row(arm.home)), row(arm.fk(q)), rtol=0, atol=1e-13
    )
    links = [
        row(M @ pk.se3.exp([0, 0, x, 0, 0, 0])) for M, x in zip(arm.local.frames, q, strict=False)
    ]
    inner = recursive.body_with_tool(
        links, row(arm.local.frames[n]), [1] * n, [0] * n, n, [[0.0] * n for _ in range(6)]
    )
    np.testing.assert_allclose(compose(links[0], inner), row(arm.fk(q)), rtol=0, atol=1e-13)
    moved = forward.tip([row(M) for M in arm.local.frames], np.sin(q), np.cos(q), 0 * q, n)
    np.testing.assert_allclose(moved, row(arm.fk(q)), rtol=0, atol=1e-13)
