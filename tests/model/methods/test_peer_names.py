"""Who comes from another library is told the name that does it here; no such name exists."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import poekin as pk
from poekin.model.methods import peer_names

ARM = pk.load("ur5e")
CHAIN = ARM.chain()


def told(owner, name):
    """What is said of a name that is none."""
    assert not hasattr(owner, name)
    with pytest.raises(AttributeError) as caught:
        getattr(owner, name)
    return str(caught.value)


@pytest.mark.parametrize("name", [*peer_names.OF_CHAINS])
def test_a_chains_name_in_another_library_is_told(name):
    here = peer_names.OF_CHAINS[name]
    assert told(CHAIN, name) == f"Chain has no attribute '{name}'; here it is {here}"
    of_package = here if here.startswith("pk.") else f"Chain.{here}"
    if name not in pk.__all__:
        assert told(pk, name) == f"poekin has no attribute '{name}'; here it is {of_package}"
    of_robot = here if here.startswith("pk.") else f"chain(tip=...).{here}"
    assert told(ARM, name) == f"Robot has no attribute '{name}'; here it is {of_robot}"


def test_names_of_other_libraries_are_not_listed_and_others_are_pythons_own():
    assert not set(peer_names.OF_CHAINS) & set(dir(CHAIN))
    assert {"fk", "jacobian", "screws"} <= set(dir(CHAIN))
    assert told(CHAIN, "colour") == "'Chain' object has no attribute 'colour'"


def test_what_is_told_exists():
    for here in {*peer_names.OF_CHAINS.values(), *peer_names.OF_PACKAGE.values()}:
        owner, path = (pk, here.split("(")[0].removeprefix("pk."))
        if not here.startswith("pk."):
            owner, path = CHAIN, path.removeprefix("Chain.")
        for name in path.split("."):
            owner = getattr(owner, name)


def test_what_a_chain_of_a_robot_does_is_told_of_the_robot():
    assert (
        told(ARM, "jacobian")
        == "Robot has no attribute 'jacobian'; here it is chain(tip=...).jacobian"
    )


@pytest.mark.parametrize("owner, name, words", [
    (ARM, "jacobain", "Robot has no attribute 'jacobain'; did you mean chain(tip=...).jacobian?"),
    (ARM, "jonts", "Robot has no attribute 'jonts'; did you mean joints?"),
    (pk, "calibrte", "poekin has no attribute 'calibrte'; did you mean calibrate?"),
    (pk, "forwardKinematic", "poekin has no attribute 'forwardKinematic'; did you mean Chain.fk(q)?"),
    (ARM, "colour", "Robot has no attribute 'colour'"),
    (ARM, "_jacobian", "Robot has no attribute '_jacobian'"),
    (ARM, "x" * 10_000, f"Robot has no attribute '{'x' * 10_000}'"),
])  # fmt: skip
def test_a_name_that_nobody_has_is_answered_with_the_closest(owner, name, words):
    assert told(owner, name) == words


def test_chains_and_robots_are_copied_and_pickled_as_before():
    for thing in (CHAIN, ARM, CHAIN.compile()):
        assert (
            copy.copy(thing) == copy.deepcopy(thing) == pickle.loads(pickle.dumps(thing)) == thing
        )
    assert np.array_equal(np.asarray(CHAIN, dtype=object).item().screws, CHAIN.screws)
