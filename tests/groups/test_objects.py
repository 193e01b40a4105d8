"""Poses and rotations of other libraries, given where poekin takes an array: the same numbers come
in.
"""

from __future__ import annotations

import warnings
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.testing.strategies import group_strategies
from tests.versions import needs

POSES = group_strategies.poses(lengths=(1e-3, 3.0))
# The same numbers come in or others do, whatever they are.
FEW = settings(max_examples=max(settings().max_examples // 10, 5))


def library(name: str) -> Any:
    """A library that poekin itself never imports; what it warns of while it is imported is its own
    affair.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return pytest.importorskip(
            name, reason=f"{name} is not installed: its objects cannot be made"
        )


class Spatial:
    """What spatialmath's SO3, SE3 and Twist3 have: one value, or several, of which np.asarray sees
    the first only.
    """

    N: int = 3

    def __init__(self, *values: Any):
        self.values = [np.asarray(value) for value in values]
        self.shape = self.values[0].shape if values else (4, 4)
        self.A = self.values[0] if len(self.values) == 1 else self.values

    def __array__(self, dtype=None, copy=None):
        return self.values[0]

    def __len__(self):
        return len(self.values)


def of_pinocchio(T):
    return library("pinocchio").SE3(T)


def of_scipy(T):
    needs("scipy", "1.16")
    return library("scipy.spatial.transform").RigidTransform.from_matrix(T)


def of_spatialmath(T):
    return library("spatialmath").SE3(T, check=False)


MAKERS: dict[str, Any] = {
    "pinocchio": of_pinocchio,
    "scipy": of_scipy,
    "spatialmath": of_spatialmath,
    "stand-in for pinocchio": lambda T: SimpleNamespace(homogeneous=T),
    "stand-in for scipy": lambda T: SimpleNamespace(as_matrix=lambda: T),
    "stand-in for spatialmath": Spatial,
}
TAKERS: dict[str, Any] = {
    "log": pk.se3.log,
    "inverse": pk.se3.inverse,
    "adjoint": pk.se3.adjoint,
    "rebased": lambda T: pk.Chain.from_space(np.zeros((0, 6)), np.eye(4)).rebased(T).home,
    "retooled": lambda T: pk.Chain.from_space(np.zeros((0, 6)), np.eye(4)).retooled(T).home,
    "home": lambda T: pk.Chain.from_space(np.zeros((0, 6)), T).home,
    "origin": lambda T: pk.Joint("j", "fixed", "a", "b", T).origin,
    "base": lambda T: pk.dh.Table("standard", [], base=T).base,
    "tool": lambda T: pk.dh.Table("standard", [], tool=T).tool,
    "robot": lambda T: pk.Robot("r", ["a", "b"], [pk.Joint("j", "floating", "a", "b")]).fk(
        [], {"j": T}
    )["b"],
}


@pytest.mark.parametrize("maker", MAKERS)
@pytest.mark.parametrize("taker", TAKERS)
@FEW
@given(POSES)
def test_a_pose_of_another_library_is_taken_wherever_a_pose_is(maker, taker, T):
    # SciPy keeps a quaternion: its matrix is not the one that went in.
    thing = MAKERS[maker](T)
    kept = thing.as_matrix() if maker == "scipy" else T
    np.testing.assert_array_equal(TAKERS[taker](thing), TAKERS[taker](kept))


@given(POSES)
def test_a_rotation_of_another_library_is_taken_wherever_a_rotation_is(T):
    R = T[:3, :3]
    thing: Any
    for thing in (Spatial(R), SimpleNamespace(as_matrix=lambda: R)):
        np.testing.assert_array_equal(pk.so3.log(thing), pk.so3.log(R))
        np.testing.assert_array_equal(pk.so3.inverse(thing), R.T)


def test_the_rotations_of_scipy_and_spatialmath_are_taken():
    R = pk.so3.exp([0.3, -0.4, 1.2])
    turned = library("scipy.spatial.transform").Rotation.from_matrix(R)
    np.testing.assert_array_equal(pk.so3.log(turned), pk.so3.log(turned.as_matrix()))
    np.testing.assert_array_equal(pk.so3.log(library("spatialmath").SO3(R)), pk.so3.log(R))


@given(st.lists(POSES, max_size=3))
def test_an_object_or_a_list_of_several_poses_is_a_batch(several):
    expected = pk.se3.log(np.reshape(several, (-1, 4, 4)))
    np.testing.assert_array_equal(
        pk.se3.log(Spatial(*several)), expected if len(several) != 1 else expected[0]
    )
    things: list[Any] = [SimpleNamespace(homogeneous=T) for T in several]
    if several:
        np.testing.assert_array_equal(pk.se3.log(things), expected)


def test_the_objects_of_several_poses_are_batches():
    T = pk.se3.exp(np.random.default_rng(0).normal(size=(3, 6)))
    spatialmath = library("spatialmath")
    np.testing.assert_array_equal(pk.se3.log(spatialmath.SE3(list(T))), pk.se3.log(T))
    np.testing.assert_array_equal(pk.se3.log([spatialmath.SE3(t) for t in T]), pk.se3.log(T))
    assert pk.se3.log(spatialmath.SE3.Empty()).shape == (0, 6)
    moved = of_scipy(T)
    np.testing.assert_array_equal(pk.se3.log(moved), pk.se3.log(moved.as_matrix()))


LINEAR_FIRST = [1.0, 2.0, 3.0, 0.1, -0.2, 0.3]
TWISTS: dict[str, Any] = {
    "pinocchio": lambda: library("pinocchio").Motion(np.array(LINEAR_FIRST)),
    "spatialmath": lambda: library("spatialmath").Twist3(LINEAR_FIRST),
    "stand-in for pinocchio": lambda: SimpleNamespace(linear=1, angular=1, homogeneous=np.eye(4)),
    "stand-in for spatialmath": lambda: Spatial(LINEAR_FIRST),
}


@pytest.mark.parametrize("make", TWISTS)
def test_a_twist_in_the_other_order_is_refused_and_not_taken_for_one_of_ours(make):
    with pytest.raises(
        InputError,
        match=r"xi: expected an array, got a \w+, whose order is \(v; omega\); linear_first",
    ):
        pk.se3.exp(TWISTS[make]())


def test_an_object_of_the_wrong_size_gets_the_usual_shape_error():
    thing: Any
    for thing in (Spatial(np.eye(3)), SimpleNamespace(as_matrix=lambda: np.eye(3))):
        with pytest.raises(ShapeError, match=r"T: expected shape \(\.\.\., 4, 4\), got \(3, 3\)"):
            pk.se3.log(thing)
    thing = SimpleNamespace(homogeneous=np.eye(4))
    with pytest.raises(ShapeError, match=r"R: expected shape \(\.\.\., 3, 3\), got \(4, 4\)"):
        pk.so3.log(thing)


def test_a_planar_pose_is_refused_and_does_not_pass_for_a_rotation():
    planar = Spatial(np.eye(3))
    planar.N = 2
    with pytest.raises(InputError, match=r"R: expected something of space, got the planar Spatial"):
        pk.so3.log(planar)
    with pytest.raises(InputError, match=r"R: expected something of space, got the planar SE2"):
        pk.so3.log(library("spatialmath").SE2(0, 0, 0.3))


@pytest.mark.parametrize("name", ["A", "N"])
def test_an_array_that_has_one_of_the_two_names_of_a_spatial_object_is_an_array(name):
    named = np.eye(3).view(type("Named", (np.ndarray,), {name: np.zeros(3)}))
    np.testing.assert_array_equal(pk.so3.log(named), np.zeros(3))


def test_an_object_that_is_no_pose_is_refused_as_before():
    with pytest.raises(
        InputError, match=r"T: expected real numbers, got object \(SimpleNamespace\)"
    ):
        pk.se3.log(SimpleNamespace())  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize(
    "values",
    [
        np.ma.array(np.eye(4), mask=np.eye(4) == 1),
        [np.ma.array(np.eye(4)), np.ma.array(np.eye(4), mask=np.eye(4) == 1)],
    ],
    ids=["one", "in a list"],
)
def test_a_masked_array_is_refused_where_something_is_masked(values):
    with pytest.raises(
        InputError, match=r"^T: expected numbers, got a masked array of which some are masked"
    ):
        pk.se3.log(values)
    unmasked = np.ma.array(np.eye(4))
    assert np.array_equal(pk.se3.inverse(unmasked), np.eye(4))
    assert np.array_equal(pk.se3.inverse([unmasked, unmasked]), [np.eye(4)] * 2)


def test_a_table_whose_columns_have_names_is_no_array_and_one_that_numbers_them_is():
    class DataFrame:
        A = N = homogeneous = np.zeros(4)  # as pandas has columns of these names

        def __init__(self, names):
            self.names = names

        @property
        def columns(self):
            return self.names

        def to_numpy(self):
            return np.eye(4)

    with pytest.raises(
        InputError,
        match=r"^T: expected an array, got a DataFrame with the labels 'A', 'N', 'x', 'y'",
    ):
        pk.se3.log(cast(Any, DataFrame(["A", "N", "x", "y"])))
    assert np.array_equal(pk.se3.inverse(cast(Any, DataFrame(range(4)))), np.eye(4))


def test_a_method_called_index_makes_no_labels():
    class Column:
        def index(self, value):
            return 0

        def to_numpy(self):
            return np.zeros(3)

    assert np.array_equal(pk.so3.exp(cast(Any, Column())), np.eye(3))
