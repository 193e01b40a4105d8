"""First-order effects of errors of an arm's screws, from `Chain.screw_derivatives` in NumPy."""

import numpy as np


def effects(chain, q, error, part):
    """How far each source of an error moves the tool (N, K), m or rad."""
    changes = chain.screw_derivatives(q)
    D = np.concatenate([changes.screws, changes.home[..., None, :]], axis=-2)
    V = np.einsum("Nrie,Kie->NKr", D, np.array(error.sources))
    w, v = V[..., :3], V[..., 3:]
    if part == "orientation":
        return np.linalg.norm(w, axis=-1)
    p = chain.fk(q)[:, None, :3, 3]
    return np.linalg.norm(v + np.cross(w, p), axis=-1)
