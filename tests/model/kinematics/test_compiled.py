"""A chain's own machine code gives what the chain gives, for every kind of chain, frame, batch and
mistake.
"""

import multiprocessing
import pickle
import threading
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, PoekinError, ShapeError, UnknownName
from poekin.model import screw
from poekin.model.geometry.structure import structure
from poekin.model.kinematics import compiled, programs
from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.strategies import chain_strategies
from tests.model.laws import chain_bounds
from tests.model.laws.chain_cases import chain_cases
from tests.model.laws.chain_laws import CHAIN_LAWS

ARM = pk.load("panda").chain(tip="panda_hand")
FAST = ARM.compile()
Q = ARM.random(0, 70)
NAMED = ("space", "body", "hybrid")
# Machine code for a new chain takes a tenth of a second a frame.
FEW = settings(max_examples=max(settings().max_examples // 10, 5))
# How many times the budget of a chain, u (8 (n + 1) + 4 sum |x|), machine code may be off, because
# a constant within
# e = 2 u of 0 or ±1 is taken for it. Of a frame R, o (Frobenius norm, e = 2 u), a link changes so:
# - turned by a constant angle: two axes, each by e where sine or cosine is taken for 0 or ±1, and
# by e an entry where its constant part is taken for 0: sqrt(2) (1 + sqrt(3)) e = 3.9 e;
# - turned by a joint: sqrt(2) e where its offset is taken for a right angle, and sqrt(6) e where
# the axes that it turns are constants: 3.9 e;
# - shifted along each axis: by e where the length is, by sqrt(3) e where the constant part of an
# entry is: 8.2 e m.
# A base or tool adds 6 e. So R is off by 8 e (n + 1) = 16 u (n + 1), and o by that times the reach
# and 16 u (n + 1) m: at most 32 u (n + 1) reach, four times the 8 u (n + 1) of rounding.
FOLDS = 5
# No length of the structure is more than so many times the distance of two axes: as much as their
# slant, 0.1, allows.
LONGER = 10


class Swapped:
    """A chain whose poses and Jacobians come from its machine code."""

    def __init__(self, chain):
        self._chain = chain
        self._fast = chain.compile()

    def __getattr__(self, name):
        source = self._fast if name in ("fk", "jacobian", "fk_jacobian") else self._chain
        return getattr(source, name)


LAWS = {law.name: law for law in CHAIN_LAWS}


@pytest.mark.parametrize("name", LAWS)
@FEW
@given(data=st.data())
def test_machine_code_keeps_the_laws_of_chains(name, data):
    chain, *arguments = data.draw(chain_cases(LAWS[name].kinds, max_joints=5))
    with within(FOLDS):
        LAWS[name].check(Swapped(chain), *arguments)


@contextmanager
def within(times: float):
    """The laws of chains, with so many times their bounds."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(chain_bounds, "UNIT", times * chain_bounds.UNIT)
        yield


def near(chain, q):
    """How far both ways may differ at each configuration of q (rows, m), lengths in reaches:
    (rows,).

    A column is an axis and its moment about a point, so it may be off by twice what a pose is,
    times what a coordinate's joints turn and slide by.
    """
    with within(1 + FOLDS):
        bounds = np.transpose(chain_bounds.budget(chain, q)) / [1, chain.reach]
    return bounds.max(axis=1) * 2 * max(1.0, np.abs(chain.coupling).sum(0).max(initial=0))


# How far both ways may differ for this arm, wherever it is within its limits, in m.
NEAR = near(ARM, np.abs(ARM.limits).max(axis=1)[None])[0] * ARM.reach


@pytest.mark.parametrize(
    "tool", [[2.2e-16] * 3 + [0] * 3, [9.9e-16] * 3 + [0] * 3, [3e-16] * 6], ids=str
)
def test_a_chain_without_joints_is_its_tool(tool):
    chain = pk.Chain.from_space(np.empty((0, 6)), pk.se3.exp(tool))
    np.testing.assert_allclose(chain.compile().fk([]), chain.home, rtol=0, atol=2 * UNIT)


def test_what_is_taken_for_a_right_angle_is_within_the_bound():
    # every constant of the arm is as far from 0 and ±1 as it may be, and all errors add up
    lean, A, home = 1.98 * UNIT, [], np.eye(4)
    for i in range(6):
        A.append(pk.se3.adjoint(home) @ [0, 0, 1, 0, 0, 0])
        home = (
            home
            @ pk.se3.exp([0, 0, lean, 0, 0, 0])
            @ pk.se3.exp([lean + (i % 2) * np.pi / 2, 0, 0, lean, lean, lean])
        )
    chain = pk.Chain.from_space(A, home)
    q = np.random.default_rng(0).uniform(-3, 3, (20, 6))
    assert apart(chain, q, NAMED).max() <= 1


def apart(chain, q, frames, alone=True):
    """Largest difference from the chain's own results ÷ `near` in each row of q, of pose and
    Jacobian `alone` too.
    """
    fast, size = chain.compile(), np.array([1.0] * 3 + [chain.reach] * 3)[:, None]
    found = [np.abs(fast.fk(q) - chain.fk(q))[..., :3, :] / [1, 1, 1, chain.reach]] if alone else []
    for frame in frames:
        T, J = fast.fk_jacobian(q, frame)
        expected = chain.fk_jacobian(q, frame)
        found.append(np.abs(T - expected[0])[..., :3, :] / [1, 1, 1, chain.reach])
        found.append(np.abs(J - expected[1]) / size)
        if alone:
            found.append(np.abs(fast.jacobian(q, frame) - expected[1]) / size)
    return np.max([x.max(axis=(1, 2), initial=0) for x in found], axis=0) / near(chain, q)


@FEW
@given(st.data())
def test_every_joint_s_frame_is_the_chain_s(data):
    chain = data.draw(chain_strategies.chains(min_joints=1, max_joints=6))
    k = data.draw(st.integers(0, len(chain.joint_names) - 1))
    q = data.draw(chain_strategies.coordinates(chain, (5,)))
    assert apart(chain, q, (k,)).max() <= 1


@settings(max_examples=max(settings().max_examples // 5, 10))
@given(
    st.lists(st.floats(-13, 0).map(lambda e: 10.0**e), min_size=2, max_size=5),
    st.sampled_from([1.0, -1.0]),
    st.integers(0, 2**32 - 1),
)
@example([1e-16, 0.1], 1.0, 1)
@example([0.1, 0.05], -1.0, 2)
@example([1e-6, 1e-6], 1.0, 3)
def test_nearly_parallel_axes_do_not_blow_up(tilts, sign, seed):
    rng = np.random.default_rng(seed)
    axes, z = [], np.array([0.0, 0.0, 1.0])
    for tilt in tilts:
        axis = z + tilt * rng.normal(size=3)
        axes.append(screw.revolute(sign * axis / np.linalg.norm(axis), rng.normal(size=3)))
        sign = -sign if rng.random() < 0.5 else sign
    chain = pk.Chain.from_space(axes, pk.se3.exp(rng.normal(size=6)))
    arm = structure(chain)
    lengths = [*(x for link in arm.links for x in link[2:]), *arm.d_offsets]
    assert np.abs(lengths).max() <= chain.reach * (1 + LONGER)
    # a d that long is rounded that much more coarsely
    q = rng.uniform(-3, 3, (20, chain.dof))
    assert apart(chain, q, NAMED, alone=False).max() <= 1 + LONGER


@pytest.mark.parametrize("shape", [(), (0,), (1,), (3,), (4,), (3, 1, 2), (200,)], ids=str)
@pytest.mark.parametrize("frame", [*NAMED, 0, 3, 6, "cheapest"])
def test_batches_of_every_shape_go_straight_through(shape, frame):
    q = ARM.random(1, shape)
    T, J = FAST.fk_jacobian(q, frame)
    assert (T.shape, J.shape) == ((*shape, 4, 4), (*shape, 6, 7))
    np.testing.assert_allclose(T, ARM.fk(q), rtol=0, atol=NEAR)
    np.testing.assert_allclose(FAST.jacobian(q, frame), J, rtol=0, atol=NEAR)
    out = np.empty_like(T), np.empty_like(J)
    assert FAST.fk_jacobian(q, frame, out=out)[1] is out[1]
    np.testing.assert_array_equal(out[1], J)
    alone = np.empty_like(J)
    assert FAST.jacobian(q, frame, out=alone) is alone
    assert FAST.fk(q, out=out[0]) is out[0]


@pytest.mark.skipif(FAST._interpreted, reason="nothing is compiled")
def test_one_plain_configuration_goes_straight_to_the_machine_code(monkeypatch):
    for name in ("fk", "jacobian", "fk_jacobian"):  # the way that takes everything, and longer
        monkeypatch.setattr(compiled.pose_jacobian, name, None)
    q, T, J = Q[0].copy(), np.empty((4, 4)), np.empty((6, 7))
    assert FAST.fk(q, out=T) is T
    np.testing.assert_array_equal(FAST.fk(q), T)
    for frame in (*NAMED, 0, "cheapest"):
        assert FAST.jacobian(q, frame, out=J) is J
        np.testing.assert_array_equal(FAST.jacobian(q, frame), J)
        both = FAST.fk_jacobian(q, frame)
        results = FAST.fk_jacobian(q, frame, out=(T, J))
        assert results[0] is T
        assert results[1] is J
        np.testing.assert_array_equal(both[0], T)
        np.testing.assert_array_equal(both[1], J)
    with pytest.raises(TypeError):
        FAST.fk(q.astype(np.float32))
    assert (
        FAST.hybrid_address == FAST._both["hybrid"][1] > 0
    )  # the same code, as other kernels take it


def test_the_cheapest_frame_is_where_it_says():
    k, _, T_km = FAST.cheapest
    np.testing.assert_allclose(
        pk.se3.adjoint(T_km) @ FAST.jacobian(Q, "cheapest"), ARM.jacobian(Q, k), rtol=0, atol=NEAR
    )
    costs = [sum(vars(FAST.program(frame).count).values()) for frame in ("cheapest", *range(7))]
    assert costs[0] == min(costs)


@pytest.mark.parametrize(
    "name, tip", [("puma560", None), ("ur5", None), ("panda", "panda_link8"), ("stanford", None)]
)
def test_four_at_a_time_are_those_of_one_at_a_time(name, tip):
    arm = pk.load(name).chain(tip=tip).compile()
    q = arm.chain.random(3, 67)
    many, within = arm.fk_jacobian(q, "body"), near(arm.chain, q) * arm.chain.reach
    for k, row in enumerate(q):
        for a, b in zip(arm.fk_jacobian(row.copy(), "body"), many, strict=True):
            # both are fused where the processor likes
            np.testing.assert_allclose(a, b[k], rtol=0, atol=within[k])


def forms_of(q):
    frozen = q.copy()
    frozen.flags.writeable = False
    wide = np.zeros((len(q), 2 * q.shape[1]))
    wide[:, ::2] = q
    odd = np.zeros(q.size * 8 + 1, np.uint8)[1:].view(np.float64).reshape(q.shape)
    odd[...] = q
    return {
        "list": q.tolist(),
        "read-only": frozen,
        "strided": wide[:, ::2],
        "fortran": np.asfortranarray(q),
        "unaligned": odd,
        "big-endian": q.astype(">f8"),
        "dict": dict(zip(ARM.q_names, q.T, strict=True)),
    }


@pytest.mark.parametrize("form", forms_of(Q))
def test_configurations_of_every_form_are_taken(form):
    given_q = forms_of(Q)[form]
    np.testing.assert_array_equal(
        FAST.fk_jacobian(given_q, "hybrid")[1], FAST.fk_jacobian(Q, "hybrid")[1]
    )
    one = forms_of(Q[:1])[form]
    one = {k: v[0] for k, v in one.items()} if isinstance(one, dict) else one[0]
    np.testing.assert_allclose(FAST.fk(one), FAST.fk(Q[0]), rtol=0, atol=NEAR)


MISTAKES = {
    "few": (lambda arm: arm.fk(Q[0, :5]), ShapeError, "expected 7 coordinates"),
    "name": (lambda arm: arm.fk({"elbow": 1.0}), UnknownName, "no coordinate 'elbow'"),
    "frame": (
        lambda arm: arm.jacobian(Q[0], "Body"),
        InputError,
        "expected 'space', 'body', 'hybrid' or the index",
    ),
    "joint": (lambda arm: arm.jacobian(Q[0], 7), InputError, "0 to 6, got 7"),
    "list": (lambda arm: arm.jacobian(Q[0], ["body"]), InputError, "frame: expected"),
    "shape": (
        lambda arm: arm.fk(Q[0], out=np.empty((4, 3))),
        ShapeError,
        r"float64 array of shape \(4, 4\)",
    ),
    "single": (
        lambda arm: arm.fk(Q[0], out=np.empty((4, 4), np.float32)),
        ShapeError,
        "got float32",
    ),
    "bytes": (lambda arm: arm.fk(Q[0], out=np.empty((4, 4), ">f8")), ShapeError, "got >f8"),
    "fortran": (
        lambda arm: arm.fk(Q[0], out=np.empty((4, 4), order="F")),
        InputError,
        "C-contiguous",
    ),
    "array": (
        lambda arm: arm.fk_jacobian(Q[0], "body", out=np.empty((4, 4))),
        InputError,
        r"a pair of arrays \(T, J",
    ),
    "three": (
        lambda arm: arm.fk_jacobian(Q[0], "body", out=(1, 2, 3)),
        InputError,
        r"a pair of arrays \(T, J\)",
    ),
    "at": (
        lambda arm: arm.fk_jacobian(Q[0], "space", at=[0, 0, 1]),
        InputError,
        "at: a point of the tool",
    ),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_mistakes_are_told_as_the_chain_tells_them(mistake):
    call, error, message = MISTAKES[mistake]
    for arm in (ARM, FAST, FAST):  # FAST once before its code is there and once after
        with pytest.raises(error, match=message):
            call(arm)
        arm.fk_jacobian(Q[0], "body")


def test_memory_that_is_shared_is_refused():
    memory = np.zeros(200)
    T, J = memory[4:20].reshape(4, 4), memory[10:52].reshape(6, 7)
    FAST.fk(Q[0])
    FAST.jacobian(Q[0], "body")
    FAST.fk_jacobian(Q[0], "body")
    for call in (
        lambda: FAST.fk(memory[:7], out=T),
        lambda: FAST.jacobian(memory[51:58], "body", out=J),
        lambda: FAST.fk_jacobian(memory[60:67], "body", out=(T, J)),
        lambda: FAST.fk_jacobian(memory[13:20], "body", out=(T, np.empty((6, 7)))),
    ):
        with pytest.raises(InputError, match="share"):
            call()


def test_no_frame_is_none():
    for call in (FAST.jacobian, FAST.fk_jacobian):
        for q in (Q, Q[0]):
            with pytest.raises(InputError, match="got None"):
                call(q, None)  # type: ignore[arg-type]


def test_an_offset_of_a_right_angle_costs_nothing_and_any_other_an_addition():
    def additions(offset):
        arm = ARM.replace(offset=np.full(7, offset)).compile()
        np.testing.assert_allclose(
            arm.fk(Q[:3]), ARM.fk(Q[:3] + offset), rtol=0, atol=NEAR, err_msg=str(offset)
        )
        return arm.program(None).count.additions

    assert additions(0.0) == additions(np.pi / 2) == additions(-np.pi)
    for offset in (np.pi / 3, np.pi / 2 + 1e-9):
        assert additions(offset) > additions(0.0)


def test_where_nothing_is_compiled_an_arm_computes_the_same():
    arm = compiled.CompiledChain(ARM)
    arm._interpreted = True
    for q in (Q, Q[0], Q[:1]):
        np.testing.assert_allclose(arm.fk(q), ARM.fk(q), rtol=0, atol=NEAR)
        for frame in ("space", "body", "hybrid", 3):
            T, J = arm.fk_jacobian(q, frame)
            np.testing.assert_allclose(T, ARM.fk(q), rtol=0, atol=NEAR)
            np.testing.assert_allclose(J, ARM.jacobian(q, frame), rtol=0, atol=NEAR)
            np.testing.assert_allclose(arm.jacobian(q, frame), J, rtol=0, atol=NEAR)
    assert (arm.fk(Q)[:, 3] == [0, 0, 0, 1]).all()
    assert not arm._arms


def test_a_point_of_the_tool_is_taken():
    for frame in ("body", "hybrid"):
        for q in (Q, Q[0]):
            np.testing.assert_allclose(
                FAST.jacobian(q, frame, at=[0.1, 0, 0.2]),
                ARM.jacobian(q, frame, at=[0.1, 0, 0.2]),
                rtol=0,
                atol=NEAR,
            )


def test_nan_stays_in_its_configuration_and_large_angles_are_exact():
    q = Q.copy()
    q[5, 1] = np.nan
    q[9, 2], q[20, 0] = 1e7, -3e12
    T, J = FAST.fk_jacobian(q, "hybrid")
    bad = np.isnan(T).any(axis=(1, 2)) | np.isnan(J).any(axis=(1, 2))
    assert np.flatnonzero(bad).tolist() == [5]
    good = ~bad
    np.testing.assert_allclose(T[good], ARM.fk(q[good]), rtol=0, atol=NEAR)
    np.testing.assert_allclose(J[good], ARM.jacobian(q[good], "hybrid"), rtol=0, atol=NEAR)


def test_it_pickles_as_chain_and_options_and_never_as_code():
    arm = ARM.compile(parallel=True)
    arm.fk_jacobian(Q, "hybrid")
    data = pickle.dumps(arm)
    again = pickle.loads(data)
    assert again == arm
    assert again != FAST
    assert hash(again) == hash(arm)
    assert len(data) < len(pickle.dumps(ARM)) + 200
    np.testing.assert_array_equal(again.fk(Q), arm.fk(Q))


def test_threads_give_what_one_gives():
    q = ARM.random(2, 100_000)
    for a, b in zip(
        ARM.compile(parallel=True).fk_jacobian(q, "body"), FAST.fk_jacobian(q, "body"), strict=True
    ):
        np.testing.assert_array_equal(a, b)


def test_many_threads_may_ask_for_the_first_code_at_once():
    arm, results = ARM.rezeroed(Q[1]).compile(), []
    threads = [
        threading.Thread(target=lambda: results.append(arm.fk_jacobian(Q[0], "space")[1]))
        for _ in range(8)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 8
    assert all(np.array_equal(J, results[0]) for J in results)


@pytest.mark.skipif(
    "fork" not in multiprocessing.get_all_start_methods(), reason="this system cannot fork"
)
@pytest.mark.filterwarnings("ignore:.*multi-threaded.*fork:DeprecationWarning")
def test_a_forked_worker_has_threads_of_its_own():
    arm, q = ARM.compile(parallel=True), ARM.random(2, 40_000)
    expected = arm.fk(q)  # the pool of this process is at work
    with multiprocessing.get_context("fork").Pool(1) as workers:
        got = workers.apply_async(arm.fk, (q,)).get(timeout=120)
    np.testing.assert_array_equal(got, expected)


@pytest.mark.parametrize("parallel", [1, None, "yes"])
def test_parallel_is_a_truth_value(parallel):
    with pytest.raises(InputError, match="parallel: expected True or False"):
        ARM.compile(parallel=parallel)


def test_a_chain_without_joints_compiles():
    chain = pk.Chain.from_space(np.empty((0, 6)), pk.se3.exp([0.1, 0.2, 0.3, 1, 2, 3]))
    fast = chain.compile()
    np.testing.assert_allclose(
        fast.fk(np.empty((3, 0))), chain.fk(np.empty((3, 0))), rtol=0, atol=2 * UNIT
    )
    assert fast.jacobian(np.empty(0), "body").shape == (6, 0)
    with pytest.raises(PoekinError, match="the chain has no joint"):
        fast.jacobian(np.empty(0), "cheapest")


def test_joints_that_follow_and_slide_and_turn_backwards():
    z = [0.0, 0.0, 1.0]
    joints = [screw.revolute(z, [0, 0, 0]), screw.revolute([0, 0, -1], [1, 0, 0]), screw.prismatic(z),
              screw.helical([0, 1, 0], [0, 0, 1], 0.2)]  # fmt: skip
    chain = pk.Chain.from_space(joints, pk.se3.exp([0, 0, 0, 1, 1, 1]), coupling=[[1, 0], [-0.5, 0], [0, 1], [2, 0]],
                     offset=[0, 0.3, 0.1, 0], q_names=["a", "b"])  # fmt: skip
    q = np.random.default_rng(0).normal(size=(50, 2))
    assert apart(chain, q, (*NAMED, 0, 1, 2, 3)).max() <= 1


def test_an_angle_made_from_another_keeps_its_own_offset():
    # three parallel axes: the angles q2, q2 + q3 and q2 + q3 + q4, each with an offset
    arm = pk.load("ur5e").chain().rezeroed([0.0, 0.1, 0.2, 0.3, 0.0, 0.0])
    assert any(
        angle.base is not None and angle.offset for angle in arm.compile().program("hybrid").angles
    )
    assert apart(arm, arm.random(0, 9), (*NAMED, 3, 5)).max() <= 1


@pytest.mark.parametrize("name, tip, nominal, middle", [
    ("puma560", None, (55, 26, 5), (15, 3, 4)),
    ("ur5", None, (46, 21, 5), (10, 5, 4)),
    ("panda", "panda_link8", (92, 47, 6), (39, 12, 5)),
])  # fmt: skip
def test_nominal_arms_cost_no_more_than(name, tip, nominal, middle):
    arm = pk.load(name).chain(tip=tip).compile()

    def within(frames, bar):
        counts = [arm.program(frame).count for frame in frames]
        return any(
            c.multiplications <= bar[0] and c.additions <= bar[1] and c.sines <= bar[2]
            for c in counts
        )

    assert within(("space", "body"), nominal)
    assert within(("cheapest", *range(len(arm.joint_names))), middle)


def test_the_code_that_is_kept_is_that_of_the_arm_s_structure(monkeypatch, tmp_path):
    # what `structure` makes of the same chain may change with poekin's version
    monkeypatch.setenv("POEKIN_CACHE_DIR", str(tmp_path / "cache"))
    chain = pk.load("puma560").chain()
    before = chain.compile().fk(chain.random(0))
    longer = replace(structure(chain), tool=(*structure(chain).tool[:9], 1.0, 2.0, 3.0))
    monkeypatch.setattr(programs, "structure", lambda chain: longer)
    again = type(chain).from_space(
        chain.screws, chain.home, joint_names=chain.joint_names, limits=chain.limits
    )
    assert np.abs(again.compile().fk(chain.random(0)) - before).max() > 1.0


def test_results_of_another_order_of_bytes_are_refused_whatever_q_is():
    arm = pk.load("ur5e").chain().compile()
    q = np.zeros(6)
    native = q.dtype
    swapped = native.newbyteorder()
    for order in (native, swapped):
        for T, J in ((swapped, native), (native, swapped)):
            out = (np.empty((4, 4), T), np.empty((6, 6), J))
            with pytest.raises(InputError, match="expected"):
                arm.fk_jacobian(q.astype(order), "body", out=out)
