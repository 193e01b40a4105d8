"""The paper's equations (Park 1994, proof-read), in LaTeX, by the full name of what computes them.

They stand over the docstrings in the reference. A formula that is not the paper's has its own
equation, and its docstring says where it is from.
"""

_B, _C = r"\frac{1-\cos\theta}{\theta^2}", r"\frac{\theta-\sin\theta}{\theta^3}"
_D = r"\frac{1 - \frac{\theta}{2}\cot\frac{\theta}{2}}{\theta^2}"
_J = rf"I + {_B}[\omega] + {_C}[\omega]^2"
_HAT = (
    r"[\omega] = \begin{bmatrix} 0 & -\omega_3 & \omega_2 \\ \omega_3 & 0 & -\omega_1 \\ "
    r"-\omega_2 & \omega_1 & 0 \end{bmatrix}"
)
_SO3_EXP = rf"e^{{[\omega]}} = I + \frac{{\sin\theta}}{{\theta}}[\omega] + {_B}[\omega]^2, \quad \theta = \|\omega\|"
_SE3_EXP = (
    r"e^{[\xi]} = \begin{bmatrix} e^{[\omega]} & J(\omega)\,v \\ 0 & 1 \end{bmatrix}, \quad "
    rf"J(\omega) = {_J}"
)
_SO3_LOG = (
    r"\log R = \frac{\theta}{2\sin\theta}\,(R - R^T), \quad 1 + 2\cos\theta = \operatorname{tr} R, "
    r"\quad 0 \le \theta \le \pi"
)
_SE3_LOG = (
    r"\log T = \begin{bmatrix} [\omega] & J(\omega)^{-1} p \\ 0 & 0 \end{bmatrix}, \quad [\omega] = \log R, \quad "
    rf"J(\omega)^{{-1}} = I - \frac{{1}}{{2}}[\omega] + {_D}[\omega]^2"
)
_LEFT = rf"J(\omega) = \int_0^1 e^{{[\omega]s}}\,ds = {_J}"
_LEFT_INVERSE = rf"J(\omega)^{{-1}} = I - \frac{{1}}{{2}}[\omega] + {_D}[\omega]^2"
_POE = r"f(q) = e^{A_1 q_1} e^{A_2 q_2} \cdots e^{A_n q_n} M"
_BODY = r"f(q) = M e^{B_1 q_1} e^{B_2 q_2} \cdots e^{B_n q_n}, \quad B_i = M^{-1} A_i M"
_LOCAL = r"f(q) = M_1 e^{S_1 q_1} M_2 e^{S_2 q_2} \cdots M_n e^{S_n q_n} M_{n+1}"
_ADJOINT = r"\operatorname{Ad}(T) = \begin{bmatrix} R & 0 \\ [p]R & R \end{bmatrix}"
_AD = r"\operatorname{ad}(\xi) = \begin{bmatrix} [\omega] & 0 \\ [v] & [\omega] \end{bmatrix}"
_COLUMN = (
    r"J_s = \begin{bmatrix} A_1 & \operatorname{Ad}(e^{A_1 q_1}) A_2 & \cdots & "
    r"\operatorname{Ad}(e^{A_1 q_1} \cdots e^{A_{n-1} q_{n-1}}) A_n \end{bmatrix}"
)
_PAUL = (
    r"f = \prod_{i=1}^{n} R_z(\theta_i)\,T_z(d_i)\,T_x(a_i)\,R_x(\alpha_i) = \prod_{i=1}^{n} e^{P_i q_i} M_i, \quad "
    r"A_i = (M_1 \cdots M_{i-1})\,P_i\,(M_1 \cdots M_{i-1})^{-1}"
)

EQUATIONS: dict[str, str] = {
    # so3 and se3
    "poekin.so3.hat": _HAT,
    "poekin.so3.exp": _SO3_EXP,
    "poekin.so3.log": _SO3_LOG,
    "poekin.so3.left_jacobian": _LEFT,
    "poekin.so3.left_jacobian_inverse": _LEFT_INVERSE,
    "poekin.se3.hat": r"[\xi] = \begin{bmatrix} [\omega] & v \\ 0 & 0 \end{bmatrix}",
    "poekin.se3.exp": _SE3_EXP,
    "poekin.se3.log": _SE3_LOG,
    "poekin.se3.inverse": r"T^{-1} = \begin{bmatrix} R^T & -R^T p \\ 0 & 1 \end{bmatrix}",
    "poekin.se3.adjoint": _ADJOINT,
    "poekin.se3.ad": _AD,
    "poekin.se3.left_jacobian": r"J(\xi) = \int_0^1 \operatorname{Ad}(e^{[\xi]s})\,ds",
    # chains
    "poekin.Chain": _POE,
    "poekin.Chain.fk": _POE,
    "poekin.Chain.jacobian": _COLUMN,
    "poekin.Chain.velocity": r"V_i = \operatorname{Ad}(f_{i-1,i})^{-1} V_{i-1} + S_i \dot{q}{}_i, \quad V_0 = 0",
    "poekin.Chain.joint_poses": r"f_k = M_1 e^{S_1 q_1} \cdots M_k e^{S_k q_k}",
    "poekin.Chain.space": _POE,
    "poekin.Chain.body": _BODY,
    "poekin.Chain.rebased": r"f' = P f Q: \quad A_i' = P A_i P^{-1}, \quad B_i' = Q^{-1} B_i Q, \quad M' = P M Q",
    "poekin.Chain.retooled": r"f' = P f Q: \quad A_i' = P A_i P^{-1}, \quad B_i' = Q^{-1} B_i Q, \quad M' = P M Q",
    "poekin.screw.revolute": r"A = (\omega; v), \quad v = -\omega \times p, \quad \|\omega\| = 1",
    "poekin.screw.prismatic": r"A = (0; v), \quad \|v\| = 1",
    "poekin.screw.helical": r"A = (\omega; v), \quad v = -\omega \times p + h\,\omega, \quad \|\omega\| = 1",
    "poekin.screw.axis_of": r"p = \omega \times v, \quad h = \omega \cdot v",
    "poekin.dh.to_chain": _PAUL,
    # one for each module of formulas
    "poekin.formulas.lie.exponential": _SE3_EXP,
    "poekin.formulas.lie.exponential.so3": _SO3_EXP,
    "poekin.formulas.lie.exponential.joint": (
        r"e^{Aq} = \begin{bmatrix} e^{[\omega]q} & "
        r"(q I + (1-\cos q)[\omega] + (q - \sin q)[\omega]^2)\,v \\ 0 & 1 \end{bmatrix}, \quad \|\omega\| = 1"
    ),
    "poekin.formulas.lie.logarithm": _SE3_LOG,
    "poekin.formulas.lie.logarithm.so3": _SO3_LOG,
    "poekin.formulas.lie.euler": (r"R = R_z(A)\,R_y(B)\,R_x(C), \quad R = R_z(A)\,R_y(B)\,R_z(C)"),
    "poekin.formulas.lie.quaternion": (
        r"4 q q^T = \begin{bmatrix} p & q_v^T \\ q_v & M \end{bmatrix}, \quad p = 1 + \operatorname{tr} R, \quad "
        r"q_v = \operatorname{vee}(R - R^T)"
    ),
    "poekin.formulas.lie.arctangent": (
        r"\arctan t = \sum_{n \ge 0} \frac{2 (-1)^n p^{2n+1}}{2n+1}\,T_{2n+1}(2t), \quad p = \sqrt{5} - 2"
    ),
    "poekin.formulas.lie.exp_jacobian": _LEFT,
    "poekin.formulas.lie.exp_jacobian.left_inverse": _LEFT_INVERSE,
    "poekin.formulas.lie.coefficients": _LEFT_INVERSE,
    "poekin.formulas.kinematics.forward": _LOCAL,
    "poekin.formulas.kinematics.gram": r"\det(J J^T) = \prod_i \sigma_i^2",
    "poekin.formulas.kinematics.singular_values": (
        r"\tan 2\theta = \frac{2\,x^T y}{y^T y - x^T x}, \quad \sigma_i = \|x_i\|"
    ),
    "poekin.formulas.kinematics.joint_ranges": r"1 - \max_i |q_i - c_i|\,w_i",
    "poekin.formulas.kinematics.columns": r"V_h = \begin{bmatrix} I & 0 \\ -[p] & I \end{bmatrix} V_s",
    "poekin.formulas.paper.direct": _COLUMN,
    "poekin.formulas.kinematics.recursive": (
        r"J_b = \begin{bmatrix} \operatorname{Ad}(f_{1,2} \cdots f_{n-1,n})^{-1} S_1 & \cdots & "
        r"\operatorname{Ad}(f_{n-1,n})^{-1} S_{n-1} & S_n \end{bmatrix}, \quad f_{i-1,i} = M_i e^{S_i q_i}"
    ),
    "poekin.formulas.kinematics.recursive.body_velocity": (
        r"V_i = \operatorname{Ad}(f_{i-1,i})^{-1} V_{i-1} + S_i \dot{q}{}_i, \quad V_n = f^{-1}\dot{f}"
    ),
    "poekin.formulas.dh": _PAUL,
    "poekin.formulas.paper.dh_recursive": (
        r"f = e^{S q_1} N_1\, e^{S q_2} N_2 \cdots e^{S q_n} N_n, \quad N_i = T_z(d_i)\,T_x(a_i)\,R_x(\alpha_i)"
    ),
    "poekin.formulas.kinematics.structured": (
        r"F_i = F_{i-1}\, T_x(a_i)\, T_y(b_i)\, R_x(\alpha_i)\, R_z(\theta_i)\, T_z(d_i + s_i q_i)"
    ),
    "poekin.formulas.kinematics.derivatives": (
        r"\frac{\partial s_i}{\partial q_j} = [s_j, s_i] = \operatorname{ad}(s_j)\,s_i \quad (j < i), \quad "
        r"\dot{V} = J \ddot{q} + \dot{J} \dot{q}"
    ),
    "poekin.formulas.kinematics.screw_changes": (
        r"df\,f^{-1} = \sum_{i=1}^{n} (\operatorname{Ad}(P_{i-1}) - \operatorname{Ad}(P_i))\,\eta_i "
        r"+ \operatorname{Ad}(f)\,\eta, \quad P_i = e^{A_1 q_1} \cdots e^{A_i q_i}"
    ),
    "poekin.formulas.statics.gravity": (
        r"\tau_i = \omega_i \cdot (s_i \times g_i) + v_i \cdot \sum_{k \ge i} m_k g_i, \quad "
        r"s_i = e^{A_i x_i} \cdot (s_{i+1} + m_i c_i), \quad g_{i+1} = R_i^T g_i"
    ),
    "poekin.formulas.ik.circle_conic": (
        r"A c^2 + B c s + C s^2 + D c + E s + F = 0, \quad c = \cos\theta, \quad s = \sin\theta"
    ),
    "poekin.formulas.ik.circle_line": (
        r"(c, s) = \frac{d\,(a, b) \pm w\,(-b, a)}{r^2}, \quad r^2 = a^2 + b^2, \quad w^2 = (r - d)(r + d)"
    ),
    "poekin.formulas.ik.cones": (
        r"e^{[k]\theta} a = e^{[m]\varphi} b = (k \cdot a + m \cdot b) \frac{k + m}{\|k + m\|^2} "
        r"+ (k \cdot a - m \cdot b) \frac{k - m}{\|k - m\|^2} \pm \gamma\, k \times m"
    ),
    "poekin.formulas.ik.orientation": (
        r"R = e^{[h_1] x_1} e^{[h_2] x_2} e^{[h_3] x_3}, \quad "
        r"h_1 \cdot e^{[h_2] x_2} h_3 = h_1 \cdot R h_3"
    ),
    "poekin.formulas.ik.rotation_onto": (
        r"e^{[k]\theta} a = b, \quad "
        r"(\cos\theta, \sin\theta) \sim ((k \times a) \cdot (k \times b),\; k \cdot (a \times b))"
    ),
    "poekin.formulas.ik.turned_component": (
        r"w \cdot e^{[k]\theta} a = A \cos\theta + B \sin\theta + C"
    ),
    "poekin.formulas.ik.three_parallel": (
        r"h_2 \cdot R' h_6 = h_2 \cdot e^{[h_5] x_5} h_6, \quad "
        r"h_2 \cdot p' = h_2 \cdot (P_1 + P_2 + P_3 + P_4 + e^{[h_5] x_5} P_5)"
    ),
    "poekin.formulas.ik.two_circles": (
        r"a_i c + a_i' s + b_i x + b_i' y = d_i \quad (i = 1, 2), \quad c^2 + s^2 = x^2 + y^2 = 1"
    ),
    "poekin.formulas.ik.slides.circle_and_line": (
        r"a c + a' s + b t = d, \quad A c + A' s + B t + K t^2 = D, \quad c^2 + s^2 = 1"
    ),
    "poekin.formulas.ik.slides.planar": (
        r"\|y + t u\|^2 = \|z\|^2 \quad \text{or} \quad t u + w v = y"
    ),
    "poekin.formulas.ik.slides.position": (
        r"p = X_1 (P_1 + X_2 (P_2 + X_3 P_3)), \quad "
        r"X_i y = e^{[h_i] x_i} y \quad \text{or} \quad X_i y = y + h_i t_i"
    ),
    "poekin.formulas.ik.slides.quadratic": (
        r"k t^2 + 2 h t + e = 0: \quad t_1 = -\frac{h + \operatorname{sign}(h)\,w}{k}, \quad "
        r"t_2 = \frac{e}{k t_1}, \quad w^2 = h^2 - k e"
    ),
    "poekin.formulas.ik.slides.two_lines": (r"a t + b w = d, \quad A t + K t^2 + B w + L w^2 = D"),
    "poekin.formulas.inverse.pose_error": (
        r"e = \left(2 \sin\tfrac{\varphi}{2}\, n;\; p^* - p\right), \quad e^{[n]\varphi} R = R^*"
    ),
    "poekin.formulas.inverse.damped_step": (
        r"(J^T W J + \lambda I)\,\Delta q = J^T W e, \quad \lambda = \tfrac{1}{20}\, e^T W e"
    ),
    "poekin.formulas.inverse.least_squares": r"(J^T W J + \lambda I)\,x = J^T W e",
    "poekin.formulas.inverse.confirmed": r"J\,dq = (\sin(\phi)\,n;\ p^* - p),\quad e^{[n]\phi} R = R^*",
    "poekin.formulas.ik.elimination.circle_roots": (
        r"f(x) = a_0 + \sum_{k=1}^{8} (a_k \cos k x + b_k \sin k x) = 0"
    ),
    "poekin.formulas.ik.elimination.joints": (
        r"h_1 \cdot e^{[h_2] x_2} p = h_1 \cdot (W - P_1), \quad "
        r"h_1 \cdot e^{[h_2] x_2} d = h_1 \cdot d_0"
    ),
    "poekin.formulas.ik.elimination.line_equations": (
        r"e_3 e_4 e_5 L_6 = e_2^{-1} e_1^{-1} G L_6, \quad e_i = e^{A_i x_i}, \quad e_1 \cdots e_6 = G"
    ),
    "poekin.formulas.ik.elimination.null_rows": r"N N^T = I, \quad N B = 0",
    "poekin.formulas.ik.elimination.resultant": (
        r"\det M(x_3) = \sum_{k=-8}^{8} F_k e^{i k x_3} = 0, \quad M v = 0"
    ),
    "poekin.formulas.lie.defect": r"\|R^T R - I\|, \quad \det R",
}

# Modules of formulas that have no equation, each with its reason.
WITHOUT: dict[str, str] = {
    "poekin.formulas.ik.rounding": "comparisons that know the rounding of a scalar's kind",
    "poekin.formulas.lie.compensated": "the rounding errors of a length, a quotient and a sum",
    "poekin.formulas.elementary": "square root, sine, cosine and arctangent themselves",
}
