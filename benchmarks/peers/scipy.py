"""SciPy's RigidTransform: exp and log of whole arrays; twists (omega; v). It has no kinematics."""

from __future__ import annotations

from .peer import Group, Peer


def group() -> Group:
    """To and from matrices, as poekin's own."""
    from scipy.spatial.transform import RigidTransform

    return Group(
        lambda xi: RigidTransform.from_exp_coords(xi).as_matrix(),
        lambda T: RigidTransform.from_matrix(T).as_exp_coords(),
        linear_first=False,
        batch=True,
    )


PEER = Peer("SciPy", "scipy", "scipy.spatial.transform", group)
