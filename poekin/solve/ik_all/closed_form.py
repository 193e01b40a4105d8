"""Joints in closed form by EAIK, where the axes of an arm allow it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import MissingExtra
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.geometry.hp import HPForm
from ...model.geometry.idealise import Idealised

EXACT = 1e-5
"""rad and m: an arm whose axes are parallel or meet within this is solved as if they were so, to
start from there.
"""


# sines of angles
_SLANT = 0.01
_PARALLEL = 1e-14
_TILT = 1e-4
# poses, and rad: roots of a polynomial may be as bad, and are starts only
_ASKED = 8
_FOUND = 1e-3


@dataclass(frozen=True, eq=False)
class ClosedForm:
    """EAIK's solver of one arm: starts that are solutions to rounding, or of an arm that is nearly
    the given one.

    Attributes: form, the arm's axes; solver, EAIK's; position_bound, rotation_bound, how far (m,
    rad) the arm that is solved is from the given one: 0 where it is the same.
    Source: Ostermeier, Külz and Althoff 2025, Automatic Geometric Decomposition for Analytical
    Inverse Kinematics.
    """

    form: HPForm
    solver: Any
    position_bound: float
    rotation_bound: float

    @property
    def family(self) -> str:
        """Name that EAIK has for the arm's kind."""
        return self.solver.getKinematicFamily()

    def said(self) -> str:
        """The way to the solutions, in words."""
        if not self.position_bound and not self.rotation_bound:
            return f"closed form (EAIK, {self.family})"
        return (
            f"closed form (EAIK, {self.family}) of the arm made exact, at most {self.position_bound:.1g} m and "
            f"{self.rotation_bound:.1g} rad away, tried down to the target"
        )

    def starts(self, T: Array) -> Array:
        """Configurations (s, m) for one target (4, 4), s = 0 and more, which the caller has to try
        and to check.

        Solutions, and nearest ones where there are none (EAIK's least squares). Raises:
        RuntimeError where EAIK gives up.
        """
        target = T.copy()
        target[:3, :3] = T[:3, :3] @ self.form.R_nt.T
        Q = np.asarray(self.solver.IK(target).Q, np.float64)
        Q = Q.reshape(-1, len(self.solver.getOriginal_H().T))
        return Q[np.isfinite(Q).all(axis=1)]


def closed_form(chain: Chain) -> ClosedForm | None:
    """The closed form of an arm, or None where EAIK knows none.

    It is looked for of the arm itself, then of the arm with its geometry made exact within `EXACT`
    (`Chain.idealised`).

    Raises: MissingExtra without EAIK; InputError, as `Chain.to_hp`, for joints that are not
    revolute or are coupled.
    """
    try:
        from eaik.IK_HP import HPRobot
    except ImportError as missing:
        raise MissingExtra("EAIK", "ik", "inverse kinematics in closed form") from missing
    if chain.dof != 6:
        chain.to_hp()  # says what else is in the way
        return None
    exact = Idealised(chain, 0.0, 0.0, ())
    return _of(exact, HPRobot) or _of(chain.idealised(EXACT), HPRobot)


def _of(near: Idealised, HPRobot: Any) -> ClosedForm | None:
    form = near.chain.to_hp()
    if not _is_safe(form):
        return None
    try:
        solver = HPRobot(form.H, form.P)
        # it calls a class that it does not know a known one where there are five joints, and has no
        # solutions then
        if not solver.hasKnownDecomposition() or "unknown" in solver.getKinematicFamily().lower():
            return None
        found = ClosedForm(form, solver, near.position_bound, near.rotation_bound)
        if _finds_what_is_known(found, near.chain):
            return found
    except RuntimeError:  # of axes that it takes to meet and cannot say where
        return None
    return None


def _is_safe(form: HPForm) -> bool:
    """Whether EAIK sees at once that the last three axes meet in a point, or that the second to
    fourth are parallel.

    Other arms it turns round and looks at again, and those whose two ways round look alike, by a
    rounding, for ever: that ends the process (1.2.2). It does not where it has an answer before:
    for three parallel axes, all sines below 1e-13 by its own reckoning, and for a wrist, whose two
    steps are exactly 0 and stay so, with slanted axes, so that no three of the last four are
    parallel. Two axes that are neither parallel nor clearly slanted (a sine below 3e-5) it may take
    to meet and then refuses.
    """
    H = form.H
    P = form.P
    sines = np.linalg.norm(np.cross(H[:-1], H[1:]), axis=1)
    clear = ((sines <= _PARALLEL) | (sines >= _TILT)).all()
    wrist = not P[4:6].any() and sines[3:].min() > _SLANT
    return bool(clear and (wrist or sines[1:3].max() <= _PARALLEL))


def _finds_what_is_known(solver: ClosedForm, chain: Chain) -> bool:
    """Whether the configurations that poses were made of are among the starts for them."""
    rng = np.random.default_rng(0)
    for q in rng.uniform(-np.pi, np.pi, (_ASKED, chain.dof)):
        off = solver.starts(chain.fk(q)) - q
        off = np.abs((off + np.pi) % (2 * np.pi) - np.pi)
        if not (off.max(axis=1, initial=0.0) < _FOUND).any():
            return False
    return True
