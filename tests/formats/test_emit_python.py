"""Emitted Python: what the chain computes, statement by statement what the program says, on arrays
of any library.
"""

from __future__ import annotations

import ast
import re

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.engine.straight_line import interpret
from poekin.errors import InputError
from poekin.formats import emit
from poekin.testing.strategies import chain_strategies

from .emitted import (
    ARMS,
    FRAMES,
    HOSTILE,
    arm,
    bound,
    expected,
    module,
    operations,
    suffix,
    with_name,
)

# A chain is traced in eight ways and its text compiled: some tenths of a second.
FEWER = settings(max_examples=max(settings().max_examples // 3, 20))


@st.composite
def cases(draw):
    chain = draw(chain_strategies.chains(max_joints=7))
    n = len(chain.kinds)
    frames = [*FRAMES, *range(n)] if n else [*FRAMES[:3]]
    shape = draw(st.sampled_from([(), (0,), (1,), (3, 1, 2)]))
    return chain, draw(st.sampled_from(frames)), draw(chain_strategies.coordinates(chain, shape))


@FEWER
@given(cases())
def test_it_computes_what_the_chain_computes_in_any_batch_shape(case):
    chain, frame, q = case
    made, within = module(emit.python(chain, frame)), bound(chain, q)
    T, J = expected(chain, frame, q)
    both = getattr(made, f"fk_jacobian_{suffix(frame)}")(q, np)
    for got, wanted in (
        (made.fk(q, np), T),
        (getattr(made, f"jacobian_{suffix(frame)}")(q, np), J),
        (both[0], T),
        (both[1], J),
    ):
        assert got.shape == wanted.shape
        assert got.dtype == wanted.dtype
        assert np.abs(got - wanted).max(initial=0.0) <= within


# The angle of two parallel axes is q1 + q2 + 3 pi / 4, a sum of three.
TILTED = np.array([10, 1, -1]) / np.sqrt(102)
PARALLEL = pk.Chain(
    [[1, 0, 0, 0, 0, 0], [1, 0, 0, 0, 0, 0], [*TILTED, 0, 0, 0]],
    np.eye(4),
    frame="space",
)


@FEWER
@given(cases())
@example((PARALLEL, "space", np.array([3.0, 0.1, 0.0])))  # the order of the sum shows
def test_it_is_the_program_to_the_last_bit(case):
    chain, frame, q = case
    q = q.reshape(-1, chain.dof) if q.size else np.zeros((2, chain.dof))
    made, compiled = module(emit.python(chain, frame)), chain.compile()
    name = f"fk_jacobian_{suffix(frame)}"
    program = compiled.program(frame, pose=True)
    x = getattr(made, f"{name}_angles")(q, np)
    np.testing.assert_array_equal(x, interpret.angles(program, q))
    T, J = getattr(made, f"{name}_sincos")(np.sin(x), np.cos(x), q, np)
    outputs = interpret.outputs(program, np.sin(x), np.cos(x), q)
    np.testing.assert_array_equal(
        np.concatenate([T[:, :3, :3].reshape(-1, 9), T[:, :3, 3]], 1), outputs[:, :12]
    )
    np.testing.assert_array_equal(J.reshape(len(q), 6 * chain.dof), outputs[:, 12:])


@pytest.mark.parametrize("name", ARMS)
def test_its_statements_are_as_many_as_its_first_lines_say(name):
    chain = arm(name)
    frame = "cheapest" if chain.kinds else "space"
    text = emit.python(chain, frame)
    functions = {
        node.name: node for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)
    }
    for function, program in (
        ("fk", chain.compile().program(None)),
        (f"jacobian_{frame}", chain.compile().program(frame)),
        (f"fk_jacobian_{frame}", chain.compile().program(frame, pose=True)),
    ):
        parts = [operations(functions[f"{function}_{part}"]) for part in ("angles", "sincos")]
        m, a = (sum(part[i] for part in parts) for i in (0, 1))
        assert (m, a) == (program.count.multiplications, program.count.additions)
        sines = f"{program.count.sines} pairs of sine and"
        said = f"\n{function}: {m} multiplications, {a} additions or subtractions, {sines}"
        assert said in text


def test_panda_s_cheapest_frame_is_the_one_its_docstring_gives():
    chain = arm("panda")
    text = emit.python(chain, "cheapest")
    middle = chain.compile().cheapest
    assert (
        f"moves with joint {middle.joint} (counted from 0), '{chain.joint_names[middle.joint]}'"
        in text
    )
    after = text.split("base frame at q = 0, (R, p):\n")[1].splitlines()[:3]
    T = chain.joint_poses(np.zeros(7))[middle.joint] @ middle.T_km
    np.testing.assert_array_equal([[float(x) for x in line.split()] for line in after], T[:3])


OFF_ZERO = (
    pk.load("ur5e").chain().rezeroed([0.0, 0.1, 0.2, 0.3, 0.0, 0.0])
)  # J in the tip's frame has five angles


@pytest.mark.parametrize("task, results", [
    ("fk", "T (..., 4, 4)"), ("jacobian_body", "J (..., 6, 6)"), ("fk_jacobian_body", "T (..., 4, 4), J (..., 6, 6)"),
])  # fmt: skip
def test_its_functions_say_what_they_take_and_give(task, results):
    made = module(emit.python(OFF_ZERO, "body"))
    q = OFF_ZERO.random(0)
    x = getattr(made, f"{task}_angles")(q, np)
    assert getattr(made, task).__doc__ == f"{results} at q (..., 6)."
    takes = f"from sines and cosines (..., {len(x)}) of the angles, and from q (..., 6)."
    assert getattr(made, f"{task}_sincos").__doc__ == f"{results} {takes}"
    first, *equations = [
        line.strip() for line in getattr(made, f"{task}_angles").__doc__.split("\n") if line.strip()
    ]
    assert first == f"The angles x (..., {len(x)}) whose sines and cosines are needed."
    assert len(equations) == len(x) == (5 if task == "jacobian_body" else 6)
    for equation in equations:  # numbers are written to six digits
        left, right = equation.split(" = ")
        right = re.sub(r"(\d) q", r"\1 * q", right)
        assert abs(eval(left, {"x": x}) - eval(right, {"x": x, "q": q})) <= 1e-5


def test_its_first_lines_say_which_arm_it_is():
    text = emit.python(OFF_ZERO, "body")
    assert "Base frame 'base', tip frame 'tool0'; 6 joints, 6 coordinates. Units: rad, m.\n" in text
    for k, (name, (lower, upper)) in enumerate(
        zip(OFF_ZERO.q_names, OFF_ZERO.limits.tolist(), strict=True)
    ):
        assert f"\n  q[{k}]  rad  '{name}', {lower:.6g} ... {upper:.6g}\n" in text
    assert (
        "J, 6 x 6 row by row: V = J dq. Rows omega x, y, z (rad/s), then v x, y, z (m/s), per unit of dq.\n"
        in text
    )
    assert (
        "T = (R, p; 0, 1), 4 x 4 row by row: the pose of the tip in the base frame; p in m.\n"
        in text
    )
    slides = pk.load("stanford").chain()
    assert re.findall(r"\n  q\[\d\]  (\w+)  ", emit.python(slides, "body")) == [
        "rad",
        "rad",
        "m",
        "rad",
        "rad",
        "rad",
    ]


def test_float32_stays_float32():
    T, J = module(emit.python(arm("mixed"), "body")).fk_jacobian_body(
        np.zeros((2, 5), np.float32), np
    )
    assert (T.dtype, J.dtype) == (np.float32, np.float32)


def test_a_nan_coordinate_spoils_its_own_configuration_only():
    q = np.array([[0.1, 0.2], [np.nan, 0.2]])
    T = module(emit.python(arm("coupled"), "space")).fk(q, np)
    assert np.isfinite(T[0]).all()
    assert np.isnan(T[1, :3]).any()
    np.testing.assert_array_equal(T[:, 3], [[0, 0, 0, 1]] * 2)


def test_it_imports_nothing_and_runs_nothing():
    body = ast.parse(emit.python(arm("panda"), "hybrid")).body
    assert [type(node) for node in body] == [ast.Expr, *[ast.FunctionDef] * 9]


@pytest.mark.parametrize("name", HOSTILE, ids=range(len(HOSTILE)))
def test_a_hostile_name_changes_no_statement(name):
    text = emit.python(with_name(name), "hybrid")
    assert text.isascii()
    assert all(line.isprintable() for line in text.splitlines())
    without_words, of_plain_name = (
        ast.dump(ast.Module(ast.parse(t).body[1:], []))
        for t in (text, emit.python(with_name("a"), "hybrid"))
    )
    assert without_words == of_plain_name
    module(text)


def test_what_cannot_be_emitted_is_refused():
    with pytest.raises(
        InputError,
        match=r"^frame: expected 'space', 'body', 'hybrid' or the index of a joint, got 'world' ",
    ):
        emit.python(arm("panda"), "world")  # pyright: ignore[reportArgumentType]
    with pytest.raises(
        InputError,
        match=r"^frame: expected 'space', 'body', 'hybrid' or the index of a joint, 0 to 6, got 7$",
    ):
        emit.python(arm("panda"), 7)
    with pytest.raises(InputError, match=r"^frame 'cheapest': the chain has no joint$"):
        emit.python(arm("no joint"), "cheapest")
    with pytest.raises(
        InputError,
        match=(
            r"^chain: expected a Chain, as Robot.chain\(tip=...\) makes it, got "
            r"Robot\('panda': 12 links, 11 joints, dof 8, root 'panda_link0', 2 leaves: 'panda…$"
        ),
    ):
        emit.python(pk.load("panda"), "body")  # type: ignore[arg-type]


def position_gradient(chain, q):
    """How the tip's position changes with q, from the chain's hybrid Jacobian; rows x, y, z."""
    return chain.jacobian(q, "hybrid")[..., 3:, :]


@pytest.mark.parametrize("name", ["coupled", "mixed"])
def test_jax_batches_maps_compiles_and_differentiates_it(name):
    jax = pytest.importorskip("jax", reason="needs JAX")
    before = jax.config.jax_enable_x64
    jax.config.update("jax_enable_x64", True)
    try:
        jnp, chain = jax.numpy, arm(name)
        made, q = module(emit.python(chain, "hybrid")), chain.random(1, (3, 2))

        def all_of_it(x):
            mapped = jax.vmap(jax.vmap(lambda x: made.fk(x, jnp)))(x)
            gradient = jax.vmap(jax.jacobian(lambda x: made.fk(x, jnp)[:3, 3]))(x[:, 0])
            return *made.fk_jacobian_hybrid(x, jnp), mapped, gradient

        # compiled once, as JAX would by itself compile each operation of the maps; the smallest as
        # users would have it
        options = {} if name == "coupled" else {"xla_backend_optimization_level": 0}
        T, J, mapped, gradient = jax.jit(all_of_it, compiler_options=options)(q)
        wanted = expected(chain, "hybrid", q)
        close(T, wanted[0], chain, q)
        close(J, wanted[1], chain, q)
        close(mapped, wanted[0], chain, q)
        close(gradient, position_gradient(chain, q[:, 0]), chain, q)
    finally:
        jax.config.update("jax_enable_x64", before)


@pytest.mark.parametrize("name", ["panda", "coupled", "mixed"])
def test_pytorch_batches_maps_and_differentiates_it(name):
    torch = pytest.importorskip("torch", reason="needs PyTorch")
    chain = arm(name)
    made, q = module(emit.python(chain, "hybrid")), chain.random(1, (3, 2))
    given_q = torch.tensor(q)
    T, J = made.fk_jacobian_hybrid(given_q, torch)
    wanted = expected(chain, "hybrid", q)
    close(T, wanted[0], chain, q)
    close(J, wanted[1], chain, q)
    close(
        torch.func.vmap(torch.func.vmap(lambda x: made.fk(x, torch)))(given_q), wanted[0], chain, q
    )
    gradient = torch.func.vmap(torch.func.jacrev(lambda x: made.fk(x, torch)[:3, 3]))(given_q[:, 0])
    close(gradient, position_gradient(chain, q[:, 0]), chain, q)


def test_jax_and_pytorch_take_an_arm_without_joints():
    chain = arm("no joint")
    made = module(emit.python(chain, "body"))
    libraries = [
        pytest.importorskip(name, reason=f"needs {name}") for name in ("jax.numpy", "torch")
    ]
    for xp in libraries:
        T, J = made.fk_jacobian_body(xp.zeros((2, 0)), xp)
        assert tuple(J.shape) == (2, 6, 0)
        assert (
            np.abs(np.asarray(T) - chain.home).max() <= 1e-6
        )  # float32 is what both make by themselves


def close(got, wanted, chain, q):
    """Whether arrays of another library are what the chain computes: its sines may be off by some
    units (4 u).
    """
    got = np.asarray(got)
    assert (got.shape, got.dtype) == (wanted.shape, wanted.dtype)
    assert np.abs(got - wanted).max() <= 2 * bound(chain, q)
