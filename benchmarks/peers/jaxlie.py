"""jaxlie: exp and log in JAX, compiled for whole arrays in double precision; twists (v; omega). No
kinematics.
"""

from __future__ import annotations

import numpy as np

from .peer import Group, Peer, module


def group() -> Group:
    """Batches are its documented use; `jit` compiles for each shape at the first call."""
    jax, jaxlie = module("jax"), module("jaxlie")
    jax.config.update("jax_enable_x64", True)
    exp = jax.jit(lambda xi: jaxlie.SE3.exp(xi).as_matrix())
    log = jax.jit(lambda T: jaxlie.SE3.from_matrix(T).log())
    return Group(
        # JAX returns before it has computed.
        lambda xi: exp(xi).block_until_ready(),
        lambda T: log(T).block_until_ready(),
        linear_first=True,
        batch=True,
        native=lambda x: jax.numpy.asarray(np.ascontiguousarray(x)),
    )


PEER = Peer("jaxlie", "jaxlie", "jaxlie", group)
