"""Every function of the groups over arrays: batch shapes, layouts, read-only input, NaN, and empty
batches.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from poekin.errors import PoseError
from poekin.groups import se3, so3
from poekin.testing.strategies import batch_strategies, group_strategies

OF_TWISTS = [
    "hat",
    "exp",
    "ad",
    "left_jacobian",
    "right_jacobian",
    "left_jacobian_inverse",
    "right_jacobian_inverse",
]
OF_ELEMENTS = ["log", "inverse", "adjoint"]
FUNCTIONS = [(m, name) for m in (so3, se3) for name in [*OF_TWISTS, *OF_ELEMENTS, "vee"]]
SHAPES = [(), (0,), (1,), (3, 1, 2)]


def identity(case) -> str:
    return case.__name__.split(".")[-1] if hasattr(case, "__name__") else str(case)


each_function = pytest.mark.parametrize(("module", "name"), FUNCTIONS, ids=identity)
each_shape = pytest.mark.parametrize("shape", SHAPES, ids=str)


def elements(module, name: str) -> group_strategies.Arrays:
    """Arguments of one function: twists, elements, or (vee) elements of the algebra."""
    twists = group_strategies.rotation_vectors() if module is so3 else group_strategies.twists()
    if name in OF_TWISTS:
        return twists
    if name == "vee":
        return twists.map(module.hat)
    return group_strategies.rotations() if module is so3 else group_strategies.poses()


def example(module, name: str, shape: tuple[int, ...]) -> np.ndarray:
    """One fixed batch of arguments."""
    rng = np.random.default_rng(0)
    twists = rng.normal(size=(*shape, 3 if module is so3 else 6))
    if name in OF_TWISTS:
        return twists
    return module.hat(twists) if name == "vee" else module.exp(twists)


def one_by_one(
    function: Callable[..., np.ndarray], batch: np.ndarray, tail: int
) -> list[np.ndarray]:
    return (
        [function(element) for element in batch.reshape(-1, *batch.shape[batch.ndim - tail :])]
        if batch.size
        else []
    )


@each_shape
@each_function
@settings(max_examples=max(settings().max_examples // 10, 5))
@given(data=st.data())
def test_a_batch_is_its_elements(module, name, shape, data):
    function, strategy = getattr(module, name), elements(module, name)
    batch = data.draw(batch_strategies.batches(strategy, shape))
    tail = batch.ndim - len(shape)
    single = function(example(module, name, ()))
    result = function(batch)
    assert result.dtype == np.float64
    assert result.shape == (*shape, *single.shape)
    parts = result.reshape(-1, *single.shape) if result.size else []
    for expected, part in zip(one_by_one(function, batch, tail), parts, strict=True):
        assert np.array_equal(expected, part)


@each_function
def test_any_layout_gives_the_same_and_the_argument_is_left_alone(module, name):
    function = getattr(module, name)
    batch = example(module, name, (4, 6))
    expected = function(batch)
    wide = np.zeros((*batch.shape[:-1], 2 * batch.shape[-1]))
    wide[..., ::2] = batch
    layouts = {
        "fortran": np.asfortranarray(batch),
        "strided": wide[..., ::2],
        "backwards": batch[::-1].copy()[::-1],
        "transposed": np.ascontiguousarray(np.swapaxes(batch, 0, 1)).swapaxes(0, 1),
        "big-endian": batch.astype(">f8"),
        "unaligned": np.frombuffer(b"\0" + batch.tobytes(), dtype=np.uint8)[1:]
        .view(float)
        .reshape(batch.shape),
    }
    for layout, argument in layouts.items():
        before = argument.copy()
        argument.flags.writeable = False
        assert np.array_equal(function(argument), expected), layout
        assert np.array_equal(argument, before), layout


@each_function
def test_a_result_is_a_new_array_that_can_be_written(module, name):
    argument = example(module, name, (2,))
    result = getattr(module, name)(argument)
    before = argument.copy()
    result[...] = 7.0
    assert np.array_equal(argument, before)


@each_function
def test_lists_and_integers_are_taken_as_numbers(module, name):
    function, size = getattr(module, name), 3 if module is so3 else 6
    if name in OF_TWISTS:
        assert np.array_equal(function([0] * (size - 1) + [1]), function(np.eye(size)[-1]))
    else:
        argument = (
            np.eye(3 if module is so3 else 4) if name != "vee" else module.hat(np.eye(size)[-1])
        )
        assert np.array_equal(function(argument.astype(int).tolist()), function(argument))


@each_function
@pytest.mark.parametrize("poison", [np.nan, np.inf])
def test_what_is_not_finite_stays_in_its_element(module, name, poison):
    function, batch = getattr(module, name), example(module, name, (5,))
    sound = function(batch)
    poisoned = batch.copy()
    poisoned.reshape(5, -1)[2, 1] = poison
    if poison == np.inf and name in OF_ELEMENTS:
        with pytest.raises(PoseError, match=r"\w+\[2\]"):
            function(poisoned)
        return
    with np.errstate(invalid="ignore"):
        result = function(poisoned)
    kept = [0, 1, 3, 4]
    assert np.array_equal(result[kept], sound[kept])
    assert not np.isfinite(result[2]).all()


@pytest.mark.parametrize("module", [so3, se3], ids=identity)
def test_the_log_of_nan_is_all_nan_in_omega(module):
    T = example(module, "log", (3,))
    T[1, 0, 0] = np.nan
    assert np.isnan(module.log(T)[1, :3]).all()


@pytest.mark.parametrize("module", [so3, se3], ids=identity)
def test_near_may_hold_nan_without_an_error(module):
    T, near = example(module, "log", (3,)), np.zeros((3, 3 if module is so3 else 6))
    near[1, 0] = np.nan
    result = module.log(T, near=near)
    assert np.abs(result - module.log(T))[[0, 2]].max() < 1e-15
    assert np.isnan(result[1]).any()


def spreads_nan(function):
    return lambda x: function(x) * (np.nan if np.isnan(x).any() else 1.0)


def writes_into_its_argument(function):
    def wrong(x):
        result = function(x)
        x.flags.writeable = True
        x += 1.0
        return result

    return wrong


def takes_the_first(function):
    return lambda x: np.repeat(function(x)[:1], len(x), axis=0)


PLANTED = {
    "the first element for all": (
        takes_the_first,
        test_what_is_not_finite_stays_in_its_element,
        (np.nan,),
    ),
    "NaN everywhere": (spreads_nan, test_what_is_not_finite_stays_in_its_element, (np.nan,)),
    "writes into its argument": (
        writes_into_its_argument,
        test_any_layout_gives_the_same_and_the_argument_is_left_alone,
        (),
    ),
    "a view of its argument": (
        lambda function: lambda x: x[..., None, :],
        test_a_result_is_a_new_array_that_can_be_written,
        (),
    ),
}


@pytest.mark.parametrize("error", PLANTED)
def test_a_planted_error_is_caught(error, monkeypatch):
    plant, test, arguments = PLANTED[error]
    monkeypatch.setattr(se3, "exp", plant(se3.exp))
    with pytest.raises(AssertionError):
        test(se3, "exp", *arguments)
