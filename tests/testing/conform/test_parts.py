"""What a verdict is made of: each number of a result is in its part, and each part has its scale
and its bound.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import numpy as np
import pytest

from poekin.testing.accuracy import error_bounds
from poekin.testing.conform.laws import of_arms, of_groups
from poekin.testing.conform.subjects.precision import DOUBLE, SINGLE
from poekin.testing.laws.laws import LawViolation
from poekin.testing.oracles import exact, exact_chain


def called(bound: Callable[[], float] | None) -> float:
    """Value of a bound, which there is."""
    assert bound is not None
    return bound()


U = 2.0**-53
N = np.array([2.0, 3.0, -6.0]) / 7
XI = np.concatenate([2.5 * N, [2.0, 3.0, 6.0]])
POSE = exact.rounded(exact.exp(XI))
# A revolute joint whose |v| is 1.5, a prismatic and a helical one of pitch -0.25; |t| of the home
# pose is 7.
SCREWS = np.array(
    [[0, 0, 1.0, 0.9, 1.2, 0], [0, 0, 0, 0.36, 0.48, 0.8], [0, -1.0, 0, 0.6, 0.25, 0.6]]
)
HOME = exact.rounded(exact.exp(np.concatenate([0.5 * N, np.zeros(3)])))
HOME[:3, 3] = [2.0, 3.0, 6.0]
ARM, Q = of_arms.arm(SCREWS, HOME), np.array([0.7, -1.3, 0.4])


def test_an_arm_has_the_lengths_of_what_turns_and_of_its_home():
    assert ARM.reach == pytest.approx(7 + 1.5 + math.hypot(0.6, 0.25, 0.6), rel=1e-15)
    assert (ARM.dof, ARM.turned) == (3, 0.0)
    assert np.array_equal(ARM.coupling, np.eye(3))
    assert not ARM.offset.any()


@pytest.mark.parametrize(("turned", "unit"), [(0.0, U), (2.0, U), (0.0, 2.0**-24)])
def test_what_is_attainable_of_a_pose(turned, unit):
    missed = np.linalg.norm(HOME[:3, :3] @ HOME[:3, :3].T - np.eye(3))
    arm = ARM._replace(turned=turned, offset=np.array([0.1, 0.2, -0.3]))
    angular, lengths = of_arms.error_bound(arm, Q, unit)
    assert angular == pytest.approx(
        unit * (5 + math.sqrt(2) * (0.8 + 0.1 + turned)) + missed, rel=1e-12, abs=0
    )
    assert lengths == pytest.approx(ARM.reach + 1.1, rel=1e-12, abs=0)


@pytest.mark.parametrize("precision", [DOUBLE, SINGLE])
def test_each_number_of_a_pose_is_in_its_part(precision):
    T = exact.rounded(exact_chain.pose(ARM, Q))
    angular, lengths = of_arms.error_bound(ARM, Q, precision.unit)
    for i, j in np.ndindex(4, 4):
        error = np.zeros((4, 4))
        error[i, j] = -2.0
        parts = of_arms.pose_parts(ARM, Q, T + error, precision)
        expected = [2.0 * (i < 3 and j < 3), 2.0 * (i < 3 and j == 3), 2.0 * (i == 3)]
        assert [part.error for part in parts] == pytest.approx(expected, abs=1e-14)
        assert [part.scale for part in parts] == [2**0.5, lengths, 1.0]
        assert [part.least for part in parts] == [angular, angular * lengths, 0.0]
        assert [part.error_bound for part in parts] == [None] * 3
        assert {part.precision for part in parts} == {precision}
        assert [part.what for part in parts] == ["R (rad)", "t ÷ the arm's lengths", "last row"]


@pytest.mark.parametrize("frame", ["space", "body", "hybrid"])
def test_the_worst_column_of_a_jacobian_counts(frame):
    truth = exact.rounded(exact_chain.jacobians(ARM, exact.exactly(Q)))
    angular, lengths = of_arms.error_bound(ARM, Q)
    J = truth[["space", "body", "hybrid"].index(frame)]
    for i, j in np.ndindex(6, 3):
        error = np.zeros((6, 3))
        error[i, j], error[i, (j + 1) % 3] = -2.0, 1.0
        w, v = of_arms.jacobian_parts(frame, ARM, Q, J + error, SINGLE)
        assert [w.error, v.error] == pytest.approx([2.0 * (i < 3), 2.0 * (i >= 3)], abs=1e-13)
    w, v = of_arms.jacobian_parts(frame, ARM, Q, J)
    ratios = 1 + math.sqrt(3)
    assert (w.scale, w.error_bound) == (1.0, None)
    assert w.least == pytest.approx(ratios * angular, rel=1e-12, abs=0)
    assert (v.scale, v.error_bound) == (2 * lengths + 1, None)
    assert v.least == pytest.approx(ratios * angular * (2 * lengths + 1), rel=1e-12, abs=0)
    turning = of_arms.arm(SCREWS[[0, 2]], HOME)
    J = exact.rounded(exact_chain.jacobians(turning, exact.exactly(Q[:2])))[0]
    assert of_arms.jacobian_parts("space", turning, Q[:2], J)[1].scale == 2 * turning.reach
    fixed = ARM._replace(coupling=np.zeros((3, 0)), dof=0)
    parts = of_arms.jacobian_parts("space", fixed, np.zeros(0), np.zeros((6, 0)))
    assert [(part.what, part.error) for part in parts] == [
        ("ω of a column", 0.0), ("v of a column ÷ the arm's lengths", 0.0)
    ]  # fmt: skip


def test_each_number_of_exp_is_in_its_part():
    for precision, unit in ((DOUBLE, U), (SINGLE, 2.0**-24)):
        bound = error_bounds.exp_bound(XI)
        for i, j in np.ndindex(4, 4):
            X = POSE.copy()
            X[i, j] -= 2.0
            R, t, last = of_groups.exp_parts(XI, X, precision)
            expected = [2.0 * (i < 3 and j < 3), 2.0 * (i < 3 and j == 3), 2.0 * (i == 3)]
            assert [R.error, t.error, last.error] == pytest.approx(expected, abs=1e-14)
        angular = unit * (1 + math.sqrt(2) * 2.5)
        assert (R.scale, R.least) == pytest.approx((math.sqrt(2), angular), rel=1e-12, abs=0)
        assert R.error_bound is None
        linear = unit / U * float(bound.linear)
        assert (t.scale, t.least, called(t.error_bound)) == pytest.approx(
            (7.0, 7 * unit, linear), rel=1e-12, abs=0
        )
        assert (last.scale, last.least, last.error_bound) == (1.0, 0.0, None)
        assert len(of_groups.exp_parts(XI[:3], POSE[:3, :3], precision)) == 1


def test_each_number_of_log_is_in_its_part():
    truth = exact.rounded(exact.log(POSE))
    t = float(np.linalg.norm(POSE[:3, 3]))
    bound = error_bounds.log_bound(exact.log(POSE))
    for precision, unit in ((DOUBLE, U), (SINGLE, 2.0**-24)):
        for k in range(6):
            xi = truth.copy()
            xi[k] += 2.0
            w, v = of_groups.log_parts(POSE, xi, precision)
            assert [w.error, v.error] == pytest.approx([2.0 * (k < 3), 2.0 * (k >= 3)], abs=1e-13)
        coarser = unit / U
        expected = (1.0, unit * 2.5, coarser * float(bound.angular))
        assert (w.scale, w.least, called(w.error_bound)) == pytest.approx(
            expected, rel=1e-12, abs=0
        )
        expected = (max(7.0, t), unit * 7, coarser * float(bound.linear))
        assert (v.scale, v.least, called(v.error_bound)) == pytest.approx(
            expected, rel=1e-12, abs=0
        )


@pytest.mark.parametrize(("gap", "either"), [(2.0**-52, True), (2e-15, False)])
@pytest.mark.parametrize("size", [3, 6])
def test_within_the_last_bits_of_pi_both_signs_are_right_each_with_its_v(gap, either, size):
    n = exact.exactly([0.6, 0, 0.8])
    n = n / exact.norm(n)
    X = np.eye(4)
    X[:3, :3] = exact.rounded(exact.exp(n * (exact.mp.pi - exact.mp.mpf(gap))))
    X[:3, 3] = [2.0, 3.0, 6.0]
    X = X[:3, :3] if size == 3 else X
    truth = exact.rounded(exact.log(X))
    w = -exact.exactly(truth[:3])
    back = exact.rounded(exact.left_jacobian_inverse(w) @ exact.exactly([2.0, 3.0, 6.0]))
    other = np.concatenate([-truth[:3], back])[:size]
    assert max(part.grade for part in of_groups.log_parts(X, truth)) == 0
    assert (max(part.grade for part in of_groups.log_parts(X, other)) == 0) == either
    if size == 6:
        mixed = np.concatenate([other[:3], truth[3:]])
        assert max(part.grade for part in of_groups.log_parts(X, mixed)) == 3
    noise = of_groups.log_forgives_noise(lambda R: other[:3], X[:3, :3], of_groups.Grade.BROKEN)
    assert (noise.grade == 0) == either


def test_a_tiny_angle_is_held_to_the_smallest_one():
    xi = np.concatenate([1e-200 * N, [1.0, 0, 0]])
    T = exact.rounded(exact.exp(xi))
    w, _ = of_groups.log_parts(T, xi)
    assert w.least == DOUBLE.smallest
    assert called(w.error_bound) == DOUBLE.smallest


def test_each_block_of_an_adjoint_is_in_its_part():
    T = POSE.copy()
    T[:3, 3] = [2.0, 3.0, 6.0]
    right, found = exact.rounded(exact.adjoint(T)), []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(of_groups, "graded", lambda law, parts, *_, **seen: found.append(parts))
        for i, j in np.ndindex(6, 6):
            Ad = right.copy()
            Ad[i, j] += 2.0
            of_groups.adjoint_is_its_matrix(lambda T, Ad=Ad: Ad, T)
            R, corner = found[-1]
            expected = [2.0 * (i < 3 or j >= 3), 2.0 * (i >= 3 > j)]
            assert [R.error, corner.error] == pytest.approx(expected, abs=1e-14)
    assert (R.scale, R.least, R.error_bound) == (1.0, U, None)
    assert (corner.scale, corner.least, corner.error_bound) == (7.0, 14 * U, None)


def test_each_block_of_a_jacobian_of_exp_is_in_its_part():
    right, found = exact.rounded(exact.left_jacobian(XI)), []
    law = of_groups.jacobian_of_exp("left_jacobian")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(of_groups, "graded", lambda law, parts, *_, **seen: found.append(parts))
        for i, j in np.ndindex(6, 6):
            J = right.copy()
            J[i, j] += 14.0
            law(lambda xi, J=J: J, XI)
            P, Q = found[-1]
            expected = [14.0 * (i < 3 or j >= 3), 2.0 * (i >= 3 > j)]
            assert [P.what, Q.what] == ["3×3 block", "Q block ÷ |v|"]
            assert [P.error, Q.error] == pytest.approx(expected, abs=1e-13)
        law(lambda xi: right[:3, :3], XI[:3], precision=SINGLE)
        (alone,) = found[-1]
    assert [part.scale for part in (P, Q, alone)] == [1.0, 1.0, 1.0]
    assert P.least == Q.least == of_groups.JACOBIAN_BAR / of_groups.EXP_LOG_BAR
    assert [part.error_bound for part in (P, Q, alone)] == [None] * 3
    assert alone.least == pytest.approx(2.0**29 * P.least, rel=1e-15, abs=0)


def wrong(size: tuple[int, ...]):
    return lambda x: np.full(size, 7.0)


def laws():
    """Each law as a function of the subject's function, the shape of what that has to return, and
    its names.
    """
    group = {
        name: (of_groups.jacobian_of_exp(name), XI, 6)
        for name in ("left_jacobian", "right_jacobian_inverse")
    }
    laws = {
        "exp is e to the xi: R (rad)": (of_groups.exp_is_e_to_the_xi, {3: XI[:3], 4: XI}),
        "log is the principal logarithm: ω (rad)": (
            of_groups.log_is_the_principal_logarithm, {(3,): POSE[:3, :3], (6,): POSE}),
        "adjoint is its matrix: R": (of_groups.adjoint_is_its_matrix, {6: POSE}),
        "log forgives noise: ω (rad)": (of_groups.log_forgives_noise, {(3,): POSE[:3, :3]}),
        **{f"{name.replace('_', ' ')} is attained: 3×3 block": (law, {3: XI[:3], 6: XI})
           for name, (law, _, _) in group.items()},
    }  # fmt: skip
    for message, (law, arguments) in laws.items():
        for shape, x in arguments.items():
            yield message, law, shape if isinstance(shape, tuple) else (shape, shape), x


@pytest.mark.parametrize(
    ("message", "law", "shape", "x"),
    list(laws()),
    ids=[f"{m.split(':')[0]}, {s}" for m, _, s, _ in laws()],
)
def test_a_violation_says_which_law_and_a_wrong_shape_is_none_of_its_numbers(
    message, law, shape, x
):
    with pytest.raises(LawViolation, match=rf"^{re.escape(message)}: error"):
        law(wrong(shape), x)
    other = (*shape[:-1], shape[-1] + 1)
    verdict = law(wrong(other), x, of_groups.Grade.BROKEN)
    assert verdict.fault == f"shape {other} where {shape} was expected"


def test_a_law_of_a_jacobian_is_called_after_it():
    law = of_groups.jacobian_of_exp("left_jacobian")
    assert law.__name__ == "left_jacobian_is_attained"
    assert str(law.__doc__).startswith("left_jacobian of a twist (6,) or rotation vector (3,): ")


@pytest.mark.parametrize(("law", "columns"), [("fk", 4), ("jacobian", 3)])
def test_a_law_of_an_arm_says_which_and_a_wrong_shape_is_none_of_its_numbers(law, columns):
    def held(function, grade):
        if law == "fk":
            return of_arms.fk_is_the_product_of_exponentials(function, ARM, Q, grade)
        return of_arms.jacobian_is_the_derivative(function, "body", ARM, Q, grade)

    shape = (4, 4) if law == "fk" else (6, 3)
    said = {"fk": "fk is the product of exponentials", "jacobian": "jacobian is the derivative"}[
        law
    ]
    with pytest.raises(LawViolation, match=rf"^{said}: .*error"):
        held(wrong(shape), of_groups.Grade.EXACT)
    for other in ((shape[0] + 1, columns), (shape[0], columns + 1)):
        assert (
            held(wrong(other), of_groups.Grade.BROKEN).fault
            == f"shape {other} where {shape} was expected"
        )
