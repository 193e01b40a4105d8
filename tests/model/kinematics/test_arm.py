"""An arm as functions take it: a chain or a compiled one, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.model.kinematics.arm import chain_of, compiled

CHAIN = pk.load("ur5e").chain()
Q = np.array([0.4, -1.2, 1.5, -0.3, 0.8, 0.0])


def test_the_chain_of_an_arm_is_the_given_one():
    assert chain_of(CHAIN) is CHAIN
    assert chain_of(CHAIN.compile()) is CHAIN


def test_an_arm_is_compiled_once():
    fast = CHAIN.compile(parallel=True)
    assert compiled(fast) is fast
    assert compiled(CHAIN) is CHAIN.compile()


@pytest.mark.parametrize("what", ["ur5e", 5, None, pk.load("ur5e")])
def test_what_is_no_arm_is_refused_by_the_name_of_the_argument(what):
    for call in (lambda: chain_of(what, "b"), lambda: compiled(what)):
        with pytest.raises(InputError) as caught:
            call()
        name, _, rest = str(caught.value).partition(": ")
        assert name in ("b", "chain")
        assert rest.startswith("expected a Chain, as Robot.chain(tip=...) makes it, got ")


FUNCTIONS = {
    "axes": pk.axes,
    "compare": lambda arm: pk.compare(arm, arm, samples=5),
    "count": pk.count,
    "count_table": pk.count_table,
    "singularity": lambda arm: pk.singularity(arm, Q),
    "manipulability": lambda arm: pk.manipulability(arm, Q),
    "manipulability_gradient": lambda arm: pk.manipulability_gradient(arm, Q).tolist(),
    "dh": lambda arm: pk.dh.from_chain(arm, convention="standard", samples=5),
    "urdf": pk.to_urdf,
    "emit": lambda arm: pk.emit.python(arm, "body"),
    "choose_poses": lambda arm: pk.choose_poses(arm, 12, 15, n_random=2),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_compiled_chain_gives_what_the_chain_gives(name):
    call = FUNCTIONS[name]
    assert str(call(CHAIN.compile())) == str(call(CHAIN))
