"""Every formula runs as floats, compiled, on counting scalars and in 60 digits, and gives the same."""

import inspect
import math
import pkgutil
from importlib import import_module

import numpy as np
import pytest

from poekin import algebra, formulas
from poekin.formulas import dh, elementary
from poekin.formulas.ik import (
    circle_conic,
    circle_line,
    cones,
    orientation,
    rotation_onto,
    rounding,
    three_parallel,
    turned_component,
    two_circles,
)
from poekin.formulas.ik.elimination import (
    circle_roots,
    joints,
    line_equations,
    null_rows,
    resultant,
)
from poekin.formulas.ik.slides import circle_and_line, planar, position, quadratic, two_lines
from poekin.formulas.inverse import confirmed, damped_step, least_squares, pose_error
from poekin.formulas.kinematics import (
    columns,
    derivatives,
    forward,
    gram,
    joint_ranges,
    recursive,
    screw_changes,
    singular_values,
    structured,
)
from poekin.formulas.lie import (
    arctangent,
    coefficients,
    compensated,
    defect,
    euler,
    exp_jacobian,
    exponential,
    logarithm,
    quaternion,
)
from poekin.formulas.paper import dh_recursive, direct
from poekin.formulas.statics import gravity
from tests.formulas.kinds import KINDS, floats, traced

rng = np.random.default_rng(1994)
W, V = (0.3, -0.4, 0.5), (1.0, -2.0, 0.5)
LONG = (1.9, -1.1, 0.8)
X = (*W, *V)
HALF_TURN = (2.0, 0.0, 0.0, *V)
T1 = tuple(map(float, exponential.se3(W, V)))
T2 = tuple(map(float, exponential.se3(LONG, V)))
R1, R2 = T1[:9], T2[:9]
TURNED = (1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0)
DOWNWARD = (0.0, -0.6, 0.8, 0.0, 0.8, 0.6, -1.0, 0.0, 0.0)  # Ry(90 deg) after a turn about z
N = 4
LINKS = [
    list(map(float, exponential.se3(tuple(w), tuple(v)))) for w, v in rng.normal(size=(N + 1, 2, 3))
]
AXES = [list(map(float, row)) for row in rng.normal(size=(6, N))]
SCREWS = [list(map(float, row)) for row in rng.normal(size=(N, 6))]
BODIES = np.random.default_rng(8).normal(size=(N, 4)).tolist()
ANGLES = rng.normal(size=N)
SINES, COSINES, SHIFTS = np.sin(ANGLES).tolist(), np.cos(ANGLES).tolist(), (0.3 * ANGLES).tolist()
MOTION = (LINKS, SINES, COSINES, SHIFTS, N)
ROTATES, SLIDES = [1.0, 0.0, 1.0, 1.0], [0.0, 1.0, 0.2, 0.0]
RATES = rng.normal(size=N).tolist()
COUPLING = rng.normal(size=(N, 2)).tolist()
SIZES = (1.2, 2.9)  # on either side of the switch
A = {t: math.sin(t) / t for t in SIZES}
B = {t: coefficients.b_of(t * t, t) for t in SIZES}


def rows(count=N):
    return [[0.0] * count for _ in range(6)]


def rows12():
    return [[0.0] * 12 for _ in range(N)]


def block(*sizes):
    """Nested lists of zeros, in six rows."""
    return [block_of(sizes) for _ in range(6)]


def block_of(sizes):
    return [block_of(sizes[1:]) for _ in range(sizes[0])] if sizes else 0.0


def square():
    return [[0.0] * N for _ in range(N)]


def pairs():
    return [[0.0] * 2 for _ in range(N)]


SQUARE = [list(map(float, row)) for row in 5 * np.eye(N) + rng.normal(size=(N, N))]
ALPHAS = rng.normal(size=N)
TWISTS = [
    [math.sin(t), math.cos(t), a, b]
    for t, a, b in zip(ALPHAS, *rng.normal(size=(2, N)), strict=True)
]
WALK = (algebra.axes(T2), TWISTS, RATES, [0, 0, 1, 0], SINES, COSINES)
SEEN = rng.normal(size=(N, 2)).tolist()
SLOPES = [list(map(float, row)) for row in np.random.default_rng(5).normal(size=(6, N))]
PRODUCTS = [list(map(float, exponential.se3(tuple(0.4 * k for k in W), V))) for _ in range(N + 2)]
MOVED = np.random.default_rng(6).normal(size=(6, N + 1, 6)).tolist()

UNTURNED = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
OPPOSITE = tuple(-x for x in UNTURNED)
FRAME_AXES = ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
SLIDING = [[0.0] * N for _ in range(3)] + AXES[3:]

# arms of joints that need no decimals, so that the exact kind meets the same arm
WRIST_AXES = ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 1.0, 0.0))
WRIST_STEPS = ((0.25, 0.125, 0.5), (0.0, 0.25, 1.0), (0.75, 0.0, 0.125))
UR_AXES = (
    (0.0, 0.0, 1.0),
    *[(0.0, 1.0, 0.0)] * 3,
    (0.0, 0.0, -1.0),
    (0.0, 1.0, 0.0),
)
UR_STEPS = (
    (0.0, 0.0, 0.0),
    (0.0, 0.125, 0.0),
    (0.5, 0.0, 0.0),
    (0.5, 0.0, 0.0),
    (0.0, 0.125, 0.0),
    (0.0, 0.0, -0.125),
)
REACHED = (0.5, 0.25, 0.375)
CIRCLES = ((0.5, -0.25, 0.75, 0.375, 0.25), (0.125, 0.625, -0.25, 0.5, 0.375))
CONICS = (
    (0.7, -0.3, 0.2, 0.4, -0.1, -0.3),  # two points
    (1.0, 0.3, -0.8, 0.1, -0.2, 0.05),  # four
    (1.0, 0.3, 0.8, 0.1, -0.2, 3.0),  # none
    (0.2, 0.4, 0.2, 0.5, -0.25, 0.125),  # a parabola
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
)
FIRST_LINE = (0.5, -0.25, 0.75, 0.0, 0.375)  # a c + a' s + b t = d
ALONG_NO_LINE = (0.5, -0.25, 0.0, 0.0, 0.375)
SECOND_LINES = (
    (0.125, 0.625, -0.25, 0.5, 0.375),
    (0.125, 0.625, -0.25, -0.5, -0.375),
    (0.125, 0.625, -0.25, 0.0, 0.375),
)
TWO_LINES = (
    (0.125, 0.5, 0.625, -0.5, 0.375),  # two roots
    (0.125, 0.5, 0.625, -0.5, 9.0),  # none
    (0.125, 0.0, 0.625, 0.0, 0.375),
    (1.0, 0.0, 1.5, 0.0, 0.5),  # parallel lines
)
ONE_ROOT = (0.125, 0.5, 0.625, -0.5, 0.375)  # on the line (1, 0, 1, 0, d), where the squares go out
THREE_JOINTS = [
    (first, second, third)
    for first in (False, True)
    for second in (False, True)
    for third in (False, True)
]
ACROSS_PLANE = ((0.6, 0.0, 0.8), (0.8, 0.0, -0.6), (0.0, 0.0, 1.0))


def planar_axes(slides):
    """`UR_AXES` of which the second to the fourth are prismatic where told so."""
    middle = [
        slide_axis if slide else (0.0, 1.0, 0.0)
        for slide, slide_axis in zip(slides, ACROSS_PLANE, strict=True)
    ]
    return (UR_AXES[0], *middle, *UR_AXES[4:])


# a loop of six revolute joints; what is written into rows begins as zeros
LOOP = np.random.default_rng(7)
LOOP_AXES = tuple(
    tuple(map(float, axis / np.linalg.norm(axis))) for axis in LOOP.normal(size=(6, 3))
)
LOOP_STEPS = tuple(tuple(map(float, step)) for step in LOOP.normal(size=(5, 3)))
LINE = (V, LOOP_AXES[2])
LOOP_POINTS = (0.6, 0.8, 0.28, -0.96, -0.8, 0.6)
SIGMA = LOOP.normal(size=168).tolist()
VECTOR = LOOP.normal(size=12).tolist()
EQUATIONS = LOOP.normal(size=54).tolist()
STACKED = LOOP.normal(size=81).tolist()
NEAR_SIDE = LOOP.normal(size=148).tolist()
FAR_SIDE = LOOP.normal(size=420).tolist()
FOURIER = LOOP.normal(size=24).tolist()
ON_ARCS = LOOP.normal(size=17 * 8).tolist()
ONE_BRACKET = [0.8, 0.6, -0.1, 0.2, 0.05, 1.0]  # of one root, in rows of one
SEEN_VALUES = LOOP.normal(size=circle_roots.SAMPLES).tolist()
ROOT_ROOM = ([0.0] * circle_roots.SCRATCH, [0.0] * (circle_roots.FIELDS * circle_roots.ROOM))


POSE = [[1.0, 0.0, 0.0, 0.3], [0.0, 1.0, 0.0, -0.2], [0.0, 0.0, 1.0, 0.5], [0.0, 0.0, 0.0, 1.0]]
TURNED_POSE = [[0.6, -0.8, 0.0, 0.1], [0.8, 0.6, 0.0, 0.4], *POSE[2:]]
CASES = [
    (circle_roots.fourier, circle_roots.WAVES, SEEN_VALUES, [0.0] * 24, 24),
    (circle_roots.size_and_noise, FOURIER),
    (circle_roots.value_and_slope, FOURIER, 0.6, 0.8),
    (circle_roots.steepest, FOURIER),
    (circle_roots.on_arcs, circle_roots.POLAR_FORMS, circle_roots.CENTRES, FOURIER, ON_ARCS, 8),
    *[(circle_roots.brackets, ON_ARCS, 1e-14, *ROOT_ROOM, whole) for whole in (True, False)],
    (circle_roots.half_of_root, ONE_BRACKET, 0, 1),
    (circle_roots.newton, FOURIER, ONE_BRACKET, 0, 1),
    *[(circle_roots.is_found, step, 0.5, 3.0) for step in (0.01, 1e-9)],
    *[(f, *a) for f in (joints.unit, joints.doubled) for a in ((0.3, -0.4), (0.0, 0.0))],
    *[(joints.outer, v) for v in (VECTOR, VECTOR[::-1])],
    (joints.second, LOOP_AXES, LOOP_STEPS, *LINE, W, LONG),
    (joints.every, LOOP_AXES, LOOP_STEPS, *LINE, R1, W, LOOP_POINTS),
    (joints.first, LOOP_AXES[0], V, W, LONG, LOOP_AXES[1]),
    (line_equations.moments, V, W, [0.0] * 16, 2),
    (line_equations.quarter_turns, LOOP_AXES[0], V),
    (line_equations.far_side, LOOP_AXES, LOOP_STEPS, [0.0] * 420, [0.0] * 14),
    (line_equations.near_side, LOOP_AXES[0], LOOP_STEPS[0], *LINE, [0.0] * 148),
    (line_equations.combine, NEAR_SIDE, FAR_SIDE, 28, [0.0] * 168),
    *[(null_rows.fill, NEAR_SIDE, 1, *shape) for shape in ((6, 2), (8, 6))],
    (resultant.equations, SIGMA, (0.36, 0.48, 0.64), [0.0] * 54),
    (resultant.factor, EQUATIONS, [0.0] * 81),
    (resultant.null_vector, EQUATIONS, STACKED, [0.0] * 12),
    *[(circle_conic.roots, *conic) for conic in CONICS],
    *[(circle_conic.points, conic, 16.0) for conic in CONICS],
    (circle_conic.derivatives, CONICS[0], 0.6, 0.8),
    *[(circle_line.roots, 0.3, -0.4, d) for d in (0.1, 0.7, -0.7)],
    *[(circle_line.roots, 0.0, 0.0, d) for d in (0.0, 1.0)],
    *[
        (f, (0.0, 0.6, 0.8), V, (1.0, 0.0, 0.0), b)
        for f in (cones.roots,)
        for b in ((0.5, -2.0, 1.0), (-2.0, 0.5, 1.0))
    ],
    (cones.roots, (0.0, 0.6, 0.8), V, (0.0, 0.6, 0.8), W),
    (cones.rotation_pair, (0.0, 0.6, 0.8), V, (1.0, 0.0, 0.0), W, LONG),
    (orientation.roots, ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), (1.0, 0.0, 0.0), R1),
    (turned_component.turned_component, W, (0.0, 0.6, 0.8), V),
    *[(rotation_onto.rotation_onto, (0.0, 0.6, 0.8), V, b) for b in (W, (0.0, 0.0, 0.0))],
    (rotation_onto.rotated, (0.0, 0.6, 0.8), 0.28, 0.96, V),
    *[(rounding.is_rounding, x, 1.0) for x in (0.0, 0.5)],
    *[(rounding.least, x, 1.0) for x in (0.5, 1.5)],
    *[(rounding.told, row, 2.0) for row in (CIRCLES[0], (0.0, 0.0, 0.0, 0.0, 0.5))],
    (three_parallel.outer, UR_AXES, UR_STEPS, R1, REACHED),
    (
        three_parallel.inner,
        UR_AXES,
        UR_STEPS,
        (0.0, 1.0, 0.0),
        (1.0, 0.0, 0.0),
        R1,
        REACHED,
        (0.6, 0.8, 0.96, 0.28, 0.5),
    ),
    *[
        (
            three_parallel.with_outer,
            UR_AXES,
            UR_STEPS,
            (1.0, 0.0, 0.0),
            R1,
            REACHED,
            (0.6, 0.8, c, 0.28, margin),
        )
        for c, margin in ((0.96, 0.5), (-0.96, -0.5))
    ],
    (two_circles.roots, *CIRCLES),
    (two_circles.roots, CIRCLES[0], (0.5, -0.25, 0.75, 0.375, 2.0)),
    (two_circles.roots, CIRCLES[0], CIRCLES[0]),
    (two_circles.roots, (0.5, -0.25, 0.0, 0.0, 0.25), (0.0, 0.0, -0.25, 0.5, 0.375)),
    *[(circle_and_line.roots, FIRST_LINE, second) for second in SECOND_LINES],
    *[(circle_and_line.roots, ALONG_NO_LINE, second) for second in SECOND_LINES],
    *[
        (
            planar.with_outer,
            slides,
            planar_axes(slides),
            UR_STEPS,
            (0.0, 1.0, 0.0),
            (1.0, 0.0, 0.0),
            R1,
            REACHED,
            (0.6, 0.8, 0.96, 0.28, 0.5),
        )
        for slides in THREE_JOINTS[1:-1]
    ],
    *[(quadratic.roots, 0.5, h, -0.25) for h in (0.75, -0.75)],
    *[(quadratic.roots, 0.5, 0.25, e) for e in (0.75, 0.125)],
    (quadratic.roots, 0.5, 0.0, 0.0),
    *[(position.roots, slides, WRIST_AXES, WRIST_STEPS, REACHED) for slides in THREE_JOINTS],
    *[(position.across, w) for w in (W, V, (0.0, 0.6, 0.8))],
    *[
        (f, slide, (0.0, 0.6, 0.8), 0.28, 0.96, V)
        for f in (position.moved, position.moved_back)
        for slide in (False, True)
    ],
    *[(two_lines.roots, (0.5, 0.0, 0.75, 0.0, 0.375), second) for second in TWO_LINES],
    (two_lines.roots, (1.0, 0.0, 1.0, 0.0, 0.375), ONE_ROOT),
    (two_lines.roots, (0.0, 0.0, 0.0, 0.0, 0.375), TWO_LINES[0]),
    *[(f, V, W) for f in (algebra.add, algebra.subtract, algebra.dot, algebra.cross)],
    (algebra.scale, 0.3, V),
    (algebra.rotate, R1, V),
    (algebra.unrotate, R1, V),
    *[(f, X) for f in (algebra.angular, algebra.linear)],
    (algebra.translation, T1),
    (algebra.twist, W, V),
    (algebra.pose, T1),
    (algebra.make_pose, R1, V),
    (algebra.transform, T1, V),
    (algebra.turn_axes, W, V, 0.6, 0.8),
    (algebra.axes, T1),
    (algebra.from_axes, *algebra.axes(T1)),
    (algebra.compose, T1, T2),
    (algebra.inverse, T1),
    (algebra.adjoint, T1, X),
    (algebra.adjoint_inverse, T1, X),
    (algebra.turned_about_z, T1, 0.6, 0.8, 0.3),
    (algebra.column, AXES, 2),
    (algebra.set_column, AXES, 2, X),
    (algebra.store_row, [0.0] * 8, X),
    *[(coefficients.e_of, t) for t in (0.0, 0.4, 3.0)],
    *[(coefficients.b_of, t * t, t) for t in (0.0, 0.4, 3.0)],
    *[(f, 0.7) for f in (coefficients.b_near, coefficients.c_near)],
    (compensated.upper, 0.375, 0.5),  # few digits: the exact kind keeps them all
    (compensated.square_rest, W, math.sqrt(0.5), 0.5),
    (compensated.quotient_rest, 0.7, 0.7 / 0.3, 0.3),
    (compensated.length, W, 0.5),
    (compensated.sum_rest, 0.7, -0.3, 0.7 - 0.3),
    *[(arctangent.angle, y, 0.8) for y in (0.1, 0.7, 5.0)],
    (coefficients.polynomial, (0.5, -0.25, 0.125), 0.3),
    *[(coefficients.c_of, t * t, A[t]) for t in SIZES],
    *[(coefficients.d_of, t * t) for t in SIZES],
    *[(coefficients.d_and_e, t * t, 1e-15) for t in SIZES],
    *[(coefficients.b_derivative, t * t, A[t], B[t]) for t in SIZES],
    *[(coefficients.c_derivative, t * t, B[t], coefficients.c_of(t * t, A[t])) for t in SIZES],
    *[(coefficients.d_derivative, t * t) for t in SIZES],
    (exponential.rotation, W, 0.3, 0.2),
    (exponential.rotation_by_cosine, W, 0.3, 0.2, 0.1),
    (exponential.linear_combination, 0.3, W, 0.2, V, 0.1, LONG),
    (exponential.closed_form, LONG, 5.46),
    *[(exponential.so3, w) for w in (W, LONG, (0.0, 0.0, 0.0))],
    *[(exponential.se3, w, V) for w in (W, LONG, (0.0, 0.0, 0.0))],
    *[
        (exponential.joint, w, V, 0.4, math.sin(0.4), math.cos(0.4))
        for w in ((0.6, 0.0, 0.8), (0.0, 0.0, 0.0))
    ],
    *[(f, R) for f in (quaternion.parts, quaternion.quaternion) for R in (R1, R2, TURNED)],
    *[(quaternion.unit_quaternion, R) for R in (R1, R2, TURNED)],
    (quaternion.rotation, 0.3, -0.4, 0.5, 0.7),
    *[(f, 0.6, 0.8, 0.28, 0.96, -0.8, 0.6) for f in (euler.zyx, euler.zyz)],
    *[(euler.zyx_turns, R) for R in (R1, R2, DOWNWARD)],
    *[(euler.zyz_turns, R) for R in (R1, R2, TURNED)],
    *[(logarithm.so3, R) for R in (R1, R2, TURNED)],
    *[(logarithm.se3, T) for T in (T1, T2)],
    *[(logarithm.so3_near, R, w) for R in (R1, R2, TURNED) for w in (W, (2.5, -4.0, 4.0))],
    *[(logarithm.se3_near, T, w, V) for T in (T1, T2) for w in (W, (2.5, -4.0, 4.0))],
    (
        logarithm.se3_near,
        algebra.make_pose((1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 2.0)),
        (0.0, 0.0, 6.0),
        V,
    ),
    *[(f, w) for f in (exp_jacobian.left, exp_jacobian.left_inverse) for w in (W, LONG)],
    *[
        (f, w, V)
        for f in (exp_jacobian.left_dual, exp_jacobian.left_inverse_dual)
        for w in (W, LONG)
    ],
    (forward.tip, *MOTION),
    (forward.frame, *MOTION[:4], 2),
    (forward.next_frame, T1, T2, 0.6, 0.8, 0.3),
    (forward.tip_and_axes, *MOTION, rows()),
    (forward.child, T1, T2, X, 0.4, 0.3, 0.9),
    (columns.about_point, AXES, ROTATES, SLIDES, N, V),
    (columns.rotate_columns, AXES, N, R1),
    (columns.coupled, AXES, COUPLING, N, 2, rows(2)),
    (gram.determinant, SCREWS, N, 6, square()),
    (singular_values.orthogonalise, SCREWS, N, 6),
    (singular_values.product, SCREWS, 1, 2, 6),
    *[(singular_values.turn, a, 1.0, 0.3) for a in (0.5, 1.5)],
    (singular_values.extreme_lengths, SCREWS, N, 6),
    *[(f, RATES, SINES, ROTATES, N) for f in (joint_ranges.travel, joint_ranges.limit_margin)],
    (screw_changes.source_twist, MOVED, V, [[0.3 * k for k in X] for _ in range(N + 1)], N),
    *[(f, X) for f in (screw_changes.squared_rotation, screw_changes.squared_displacement)],
    *[(f, SCREWS, LINKS, N, rows()) for f in (direct.space, direct.body)],
    (gravity.torques, SCREWS, BODIES, RATES, SINES, COSINES, V, N, [[0.0] * 3 for _ in range(N)]),
    (gravity.motion, X, 0.4, 0.3, 0.9),
    (recursive.z_column, T1, 1.0, 0.2),
    (recursive.body, LINKS, ROTATES, SLIDES, N, rows()),
    (recursive.body_with_tool, LINKS, T1, ROTATES, SLIDES, N, rows()),
    (recursive.body_velocity, LINKS, T1, ROTATES, SLIDES, N, RATES),
    (dh_recursive.body, LINKS, T1, ROTATES, SLIDES, N, rows()),
    (dh.link, 0.6, 0.8, 0.3, -0.2, 0.28, 0.96),
    (dh.screws, LINKS, ROTATES, SLIDES, N, SCREWS),
    (
        least_squares.normal_equations,
        AXES,
        list(X),
        ROTATES + SLIDES,
        0.3,
        [1.0, 0.0, 1.0, 1.0],
        N,
        square(),
        SINES,
    ),
    (
        damped_step.step,
        AXES,
        list(X),
        ROTATES + SLIDES,
        40.0,
        [1.0, 0.0, 1.0, 1.0],
        N,
        square(),
        SINES,
    ),
    (damped_step.half_square, list(X), ROTATES + SLIDES),
    (damped_step.descent, AXES, list(X), ROTATES + SLIDES, 2),
    *[(damped_step.is_blocked, q, -0.5, 0.5, -0.3) for q in (-0.5, 0.0)],
    (damped_step.ease_slides, SLIDING, ROTATES + SLIDES, 9.0, [1.0, 1.0, 0.0, 1.0], N, SQUARE),
    (damped_step.keep_regular, [1.0, 0.0, 1.0, 1.0], N, SQUARE),
    (pose_error.rotation_error, R1, R2),
    *[(pose_error.direction_error, R1, R, (0.6, 0.0, 0.8)) for R in (R2, R1)],
    *[(pose_error.direction_error, UNTURNED, OPPOSITE, axis) for axis in FRAME_AXES],
    *[(pose_error.planar_error, R1, R, (0.6, 0.0, 0.8)) for R in (R2, R1)],
    (pose_error.planar_error, UNTURNED, (1.0, 0, 0, 0, -1.0, 0, 0, 0, -1.0), (0.0, 0.0, 1.0)),
    *[(pose_error.angle, w) for w in (W, (0.0, 0.0, 0.0), (2.0, 0.0, 0.1))],
    (pose_error.distance, X),
    *[(pose_error.differentiate, e, AXES, N) for e in (X, HALF_TURN)],
    *[(pose_error.differentiate_direction, W, e, AXES, N) for e in (X, HALF_TURN)],
    (pose_error.remove_turn_about, W, AXES, N),
    (pose_error.across, W, V),
    (pose_error.keep_in_plane, W, AXES, N),
    (least_squares.solve, SQUARE, ANGLES.tolist(), N),
    (confirmed.pose_error, POSE, TURNED_POSE),
    (confirmed.size, X, 0.7),
    (structured.outward, *WALK, 0, rows12()),
    (structured.inward, *WALK, N - 1, rows12()),
    *[(structured.seen_outward, V, *WALK[1:], begin, pairs()) for begin in (0, 2)],
    (structured.seen_inward, V, *WALK[1:], N - 1, pairs()),
    (structured.tip_seen, V, *WALK[1:], N, pairs()),
    (structured.columns_of_axes, LINKS, SEEN, ROTATES, SLIDES, 1, N, AXES),
    (structured.link, TWISTS[0]),
    (structured.turn_coordinates, 0.3, -0.2, 0.6, 0.8),
    (structured.write, list(T1), W, V, LONG, V),
    *[
        (f, X, (*V, *LONG))
        for f in (derivatives.bracket, derivatives.add_twists, derivatives.subtract_twists)
    ],
    (derivatives.scale_twist, 0.3, X),
    (derivatives.at_point, X, LONG),
    (derivatives.cumulative_twists, AXES, RATES, N, rows()),
    *[
        (f, AXES, RATES, N, rows())
        for f in (derivatives.space_rate, derivatives.body_rate, derivatives.hybrid_rate)
    ],
    (derivatives.acceleration, AXES, SLOPES, RATES, ANGLES.tolist(), N),
    (derivatives.set_derivative, block(N, N), 2, 1, X),
    *[
        (f, AXES, N, block(N, N))
        for f in (derivatives.space_hessian, derivatives.body_hessian, derivatives.hybrid_hessian)
    ],
    (screw_changes.pose_row, rows12(), 2, T1),
    (screw_changes.products, LINKS, T1, N, [[0.0] * 12 for _ in range(N + 2)]),
    (screw_changes.pose_changes, PRODUCTS, N, block(N + 1, 6)),
    *[(screw_changes.column_change, AXES, PRODUCTS, MOVED, k, 1, 4) for k in (0, 1, 2)],
    *[
        (f, AXES, PRODUCTS, MOVED, N, block(N, N + 1, 6))
        for f in (
            screw_changes.space_changes,
            screw_changes.body_changes,
            screw_changes.hybrid_changes,
        )
    ],
    (defect.orthonormality, R1),
    (defect.determinant, R1),
]


def _name(case):
    return f"{case[0].__module__.rpartition('.')[2]}.{case[0].__name__}"


@pytest.mark.parametrize(
    "kind",
    # each formula is compiled by itself there
    [pytest.param(kind, marks=pytest.mark.slow) if kind == "compiled" else kind for kind in KINDS],
)
@pytest.mark.parametrize("case", CASES, ids=[f"{_name(case)}-{i}" for i, case in enumerate(CASES)])
def test_a_formula_gives_the_same_in_every_kind(case, kind):
    formula, *arguments = case
    expected, got = floats(formula, *arguments), KINDS[kind](formula, *arguments)
    # Counting is the same arithmetic; compiled code may differ in the last digits of sines, and the
    # exact kind differs from floats by their rounding: products of up to four poses with entries of
    # up to about 10.
    tolerance = 0.0 if kind == "counting" else 1e-13
    np.testing.assert_allclose(got, expected, rtol=tolerance, atol=tolerance)


# exp, log and what belongs to them divide and compare: they are not traced, but for what they share
# with the chains.
DIVIDE = (
    circle_conic,
    circle_line,
    cones,
    orientation,
    rotation_onto,
    rounding,
    three_parallel,
    two_circles,
    confirmed,
    circle_roots,
    joints,
    line_equations,
    null_rows,
    resultant,
    circle_and_line,
    planar,
    quadratic,
    position,
    two_lines,
    damped_step,
    least_squares,
    singular_values,
    joint_ranges,
    pose_error,
    coefficients,
    arctangent,
    compensated,
    exponential,
    quaternion,
    euler,
    logarithm,
    exp_jacobian,
    defect,
)
CHAIN_CASES = [
    case
    for case in CASES
    if inspect.getmodule(case[0]) not in DIVIDE or case[0] is exponential.joint
]


@pytest.mark.parametrize(
    "case", CHAIN_CASES, ids=[f"{_name(case)}-{i}" for i, case in enumerate(CHAIN_CASES)]
)
def test_a_chain_formula_recorded_and_computed_gives_the_same(case):
    formula, *arguments = case
    # the same sums and products, but for constants that meet: none do here, as every number is
    # recorded as unknown
    np.testing.assert_allclose(
        traced(formula, *arguments), floats(formula, *arguments), rtol=1e-13, atol=1e-13
    )


def test_every_formula_is_among_the_cases():
    modules = [algebra] + [
        import_module(m.name) for m in pkgutil.walk_packages(formulas.__path__, "poekin.formulas.")
    ]
    public = {
        f
        for module in modules
        if module is not elementary
        for name, f in inspect.getmembers(module, inspect.isfunction)
        if f.__module__ == module.__name__ and not name.startswith("_")
    }
    # which is given a function: tests/formulas/inverse/test_confirmed.py, tests/formats/emit_ik
    public.discard(confirmed.select)
    assert public - {case[0] for case in CASES} == set()


def test_the_comparison_of_kinds_sees_a_wrong_digit():
    expected = floats(exponential.so3, W)
    with pytest.raises(AssertionError):
        np.testing.assert_allclose(
            KINDS["exact"](exponential.so3, (*W[:2], 0.5 + 1e-12)), expected, 1e-13, 1e-13
        )
