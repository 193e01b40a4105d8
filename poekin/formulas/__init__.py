"""The mathematics, one algorithm a file: undecorated scalar code for any kind of scalar (see
`poekin.algebra`).

`PAPER` leads from a lemma or equation of Park 1994 to the function here that computes it, to the
user's function and the method of `Chain` that run it, and to the test that holds it. Every other
file is in `BESIDE`, with the reason.
"""

from typing import NamedTuple


class Place(NamedTuple):
    """One row of the table: where something of the paper stands here; "" where there is nothing.

    `equation` is its text, `formula` a function of `poekin.formulas` or `algebra`, `user` one of
    `poekin`, `method` one of `poekin.Chain`, and `test` a file below tests/.
    """

    paper: str
    equation: str
    formula: str
    user: str
    method: str
    test: str


_LIE = "formulas/lie"
_KINEMATICS = "formulas/kinematics"

PAPER = (
    Place(
        "Section II, eq. (1)",
        "f = e^{A_1 q_1} ... e^{A_n q_n} M",
        "kinematics.screw_changes.products",
        "",
        "screw_derivatives",
        f"{_KINEMATICS}/test_screw_changes.py",
    ),
    Place(
        "Section II, eq. (2)",
        "f = M e^{B_1 q_1} ... e^{B_n q_n}",
        "paper.direct.body",
        "count",
        "",
        "formulas/paper/test_direct.py",
    ),
    Place(
        "Section II, eq. (3)",
        "Ad(T) (w; v) = (R w; R v + p x R w)",
        "algebra.adjoint",
        "se3.adjoint",
        "",
        "test_algebra.py",
    ),
    Place(
        "Section II, the bracket",
        "[X, Y] = ad(X) Y = (w_X x w_Y; w_X x v_Y + v_X x w_Y)",
        "kinematics.derivatives.bracket",
        "se3.ad",
        "hessian",
        f"{_KINEMATICS}/test_derivatives.py",
    ),
    Place(
        "Section II, f' = P f Q",
        "A' = Ad(P) A, M' = P M Q",
        "algebra.adjoint",
        "",
        "rebased",
        "test_algebra.py",
    ),
    Place(
        "Section II, Denavit-Hartenberg",
        "A_i = Ad(K_0 ... K_{i-1}) P_i, M = K_0 ... K_n",
        "dh.screws",
        "dh.to_chain",
        "",
        "formulas/test_dh.py",
    ),
    Place(
        "Example 1",
        "M, w_i and v_i of a 3R arm",
        "paper.direct.space",
        "screw.revolute",
        "screws",
        "formulas/paper/test_direct.py",
    ),
    Place(
        "Lemma 1",
        "e^{[w]} = I + A [w] + B [w]^2",
        "lie.exponential.so3",
        "so3.exp",
        "",
        f"{_LIE}/test_exponential.py",
    ),
    Place(
        "Lemma 2",
        "e^{A q} = (I + sin q [w] + (1 - cos q) [w]^2, p(q)), |w| = 1",
        "lie.exponential.joint",
        "",
        "screw_derivatives",
        f"{_LIE}/test_exponential.py",
    ),
    Place(
        "Lemma 2, any twist",
        "e^{(w; v)} = (e^{[w]}, J(w) v)",
        "lie.exponential.se3",
        "se3.exp",
        "",
        f"{_LIE}/test_exponential.py",
    ),
    Place(
        "Lemma 3",
        "log R = phi / (2 sin phi) (R - R^T), cos phi = (tr R - 1) / 2",
        "lie.logarithm.so3",
        "so3.log",
        "",
        f"{_LIE}/test_logarithm.py",
    ),
    Place(
        "Remark 1",
        "at tr R = -1 both w and -w are logarithms: the sign",
        "lie.quaternion.parts",
        "so3.log",
        "",
        f"{_LIE}/test_quaternion.py",
    ),
    Place(
        "Remark 1, all logarithms",
        "w (1 + 2 pi k / |w|)",
        "lie.logarithm.so3_near",
        "so3.log",
        "",
        f"{_LIE}/test_logarithm.py",
    ),
    Place(
        "Remark 2",
        "|log R| = phi, 0 <= phi <= pi",
        "inverse.pose_error.angle",
        "ik",
        "",
        "formulas/inverse/test_pose_error.py",
    ),
    Place(
        "Lemma 4",
        "log (R, p) = (w; J(w)^-1 p), w = log R",
        "lie.logarithm.se3",
        "se3.log",
        "",
        f"{_LIE}/test_logarithm.py",
    ),
    Place(
        "Lemma 4, the coefficient",
        "D = (1 - (phi/2) cot(phi/2)) / phi^2",
        "lie.coefficients.d_of",
        "se3.log",
        "",
        f"{_LIE}/test_coefficients.py",
    ),
    Place(
        "Lemma 5",
        "J(w) = integral of e^{[w] s} over s in 0..1 = I + B [w] + C [w]^2",
        "lie.exp_jacobian.left",
        "so3.left_jacobian",
        "",
        f"{_LIE}/test_exp_jacobian.py",
    ),
    Place(
        "Lemma 5, the remark on the linear part",
        "the lower left block of the integral of e^{ad(w; v) s}",
        "lie.exp_jacobian.left_dual",
        "se3.left_jacobian",
        "",
        f"{_LIE}/test_exp_jacobian.py",
    ),
    Place(
        "Section III",
        "J_i = Ad(e^{A_1 q_1} ... e^{A_{i-1} q_{i-1}}) A_i",
        "paper.direct.space",
        "count",
        "",
        "formulas/paper/test_direct.py",
    ),
    Place(
        "Section III, from the axes",
        "J_i = (r z; r z x (p - o) + s z)",
        "kinematics.columns.about_point",
        "",
        "jacobian",
        f"{_KINEMATICS}/test_columns.py",
    ),
    Place(
        "Section IV, the local form",
        "f = M_1 e^{S_1 q_1} M_2 e^{S_2 q_2} ... M_n e^{S_n q_n} M_{n+1}",
        "kinematics.forward.tip",
        "",
        "fk",
        f"{_KINEMATICS}/test_forward.py",
    ),
    Place(
        "Section IV, pose and axes in one pass",
        "the frames M_1 e^{S_1 q_1} ... M_i",
        "kinematics.forward.tip_and_axes",
        "",
        "fk_jacobian",
        f"{_KINEMATICS}/test_forward.py",
    ),
    Place(
        "Section IV, two planar rotations a link",
        "F_i = F_{i-1} Tx(a) Ty(b) Rx(alpha) Rz(theta_i) Tz(d)",
        "kinematics.structured.outward",
        "",
        "compile",
        f"{_KINEMATICS}/test_structured.py",
    ),
    Place(
        "Section IV, the recursion",
        "J_i = Ad(f_{i,i+1} ... f_{n-1,n})^-1 S_i",
        "kinematics.recursive.body",
        "count",
        "",
        f"{_KINEMATICS}/test_recursive.py",
    ),
    Place(
        "Section IV, velocities",
        "V_i = Ad(f_{i-1,i})^-1 V_{i-1} + S_i dq_i, V_0 = 0",
        "kinematics.recursive.body_velocity",
        "",
        "velocity",
        f"{_KINEMATICS}/test_recursive.py",
    ),
    Place(
        "Section IV, the table",
        "60 n - 96, 42 n - 78 and 42 n multiplications",
        "paper.dh_recursive.body",
        "count_table",
        "",
        "formulas/paper/test_dh_recursive.py",
    ),
    Place(
        "Section IV, the alternative by table lookup",
        "M_i e^{S_i q_i} from a sine and a cosine, whatever they come from",
        "algebra.turned_about_z",
        "",
        "fk",
        "test_algebra.py",
    ),
)

BESIDE = {
    "elementary": "sqrt, sin, cos, asin and atan2 of a kind of scalar",
    "lie.arctangent": "the angle of Lemma 3 to its last digit, with what rounding took",
    "lie.compensated": "what rounding took from lengths, quotients and sums, for Lemmas 1 to 4",
    "lie.defect": "whether nine numbers are a rotation; the paper takes it for granted",
    "lie.euler": "three turns, as controllers and URDF write a rotation; the paper has none",
    "ik.circle_line": "closed forms of inverse kinematics are none of the paper's subjects",
    "ik.circle_conic": "closed forms of inverse kinematics are none of the paper's subjects",
    "ik.two_circles": "closed forms of inverse kinematics are none of the paper's subjects",
    "ik.rotation_onto": "closed forms of inverse kinematics are none of the paper's subjects",
    "ik.cones": "closed forms of inverse kinematics are none of the paper's subjects",
    "ik.orientation": "closed forms of inverse kinematics are none of the paper's subjects",
    "ik.turned_component": "closed forms of inverse kinematics are none of the paper's subjects",
    "ik.three_parallel": "closed forms of inverse kinematics are none of the paper's subjects",
    "ik.rounding": "comparisons of the closed forms that know a scalar's rounding",
    "inverse.damped_step": "inverse kinematics is none of the paper's subjects",
    "inverse.least_squares": "inverse kinematics is none of the paper's subjects",
    "kinematics.joint_ranges": "how far a configuration is from limits and from another one",
    "kinematics.singular_values": "how well the tool can be moved in its worst direction",
    "kinematics.gram": "how well the tool can be moved; the paper takes Jacobians as they are",
    "statics.gravity": "torques of the arm's own weight; the paper's kinematics has no masses",
    "ik.elimination.circle_roots": "all real roots of a trigonometric polynomial of degree 8",
    "ik.elimination.joints": "the other five angles of a loop of six revolute joints, of one",
    "ik.elimination.line_equations": "a loop of six revolute joints as equations of one line",
    "ik.elimination.null_rows": "rows across the columns of what is eliminated",
    "ik.elimination.resultant": "the determinant that is 0 where a loop of six joints closes",
    "ik.slides.circle_and_line": "a subproblem of inverse kinematics, with a prismatic joint",
    "ik.slides.planar": "six joints of which three move in a plane, some of them prismatic",
    "ik.slides.position": "three joints that bring a point to a place, some of them prismatic",
    "ik.slides.quadratic": "both roots of a quadratic, for subproblems with prismatic joints",
    "ik.slides.two_lines": "a subproblem of inverse kinematics, with two prismatic joints",
    "inverse.confirmed": "inverse kinematics is none of the paper's subjects",
}
