"""How configurations and output arrays get to the kernels, and what does not."""

from types import SimpleNamespace

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.formats import erd
from poekin.model.kinematics import pose_jacobian

ARM = pk.load("panda").chain(tip="panda_hand")
Q = ARM.random(0, 5)


def test_an_output_array_that_shares_memory_with_q_is_refused():
    memory = np.zeros(2000)
    q = memory[:35].reshape(5, 7)
    for call in (
        lambda: ARM.fk(q, out=memory[:80].reshape(5, 4, 4)),
        lambda: ARM.jacobian(q, "body", out=memory[30:240].reshape(5, 6, 7)),
        lambda: ARM.fk_jacobian(q[0], "body", out=(np.empty((4, 4)), memory[:42].reshape(6, 7))),
    ):
        with pytest.raises(InputError, match="shares memory with q"):
            call()
    with pytest.raises(InputError, match="T and J share memory"):
        ARM.fk_jacobian(Q[0], "body", out=(memory[:16].reshape(4, 4), memory[10:52].reshape(6, 7)))


def test_a_subclass_is_no_output_array():
    class Tagged(np.ndarray):
        shape = (4, 4)  # type: ignore[assignment]

    with pytest.raises(InputError, match="got float64"):
        ARM.fk(Q[0], out=np.empty(1).view(Tagged))


def test_what_passes_for_an_array_is_taken_for_its_numbers():
    class Proxy:
        __class__ = np.ndarray  # type: ignore[assignment]

        def __array__(self, dtype=None, copy=None):
            return Q[0].astype(dtype or float)

    np.testing.assert_allclose(
        ARM.fk_jacobian(Proxy(), "body")[1], ARM.fk_jacobian(Q[0], "body")[1], rtol=0, atol=1e-15
    )


@pytest.mark.parametrize("frame", ["body", "hybrid"])
def test_a_point_of_the_tool_leaves_the_pose_as_it_is(frame):
    for q in (Q, Q[0], Q.reshape(5, 1, 7)):
        T, J = ARM.fk_jacobian(q, frame, at=[1e6, 0, 0])
        np.testing.assert_allclose(T, ARM.fk(q), rtol=0, atol=1e-15)
        np.testing.assert_array_equal(ARM.jacobian(q, frame, at=[1e6, 0, 0]), J)
        out = np.empty_like(J)
        assert ARM.jacobian(q, frame, at=[1e6, 0, 0], out=out) is out
        np.testing.assert_allclose(out, J, rtol=1e-15)


@pytest.mark.parametrize("at", [[np.nan, 0, 0], [0, 0], [[0, 0, 0]]])
def test_a_bad_point_is_named(at):
    with pytest.raises(InputError, match="at: expected"):
        ARM.jacobian(Q, "body", at=at)


def test_comparing_coupled_and_uncoupled_chains_is_no_error():
    A = [[0, 0, 1, 0, 0, 0], [0, 1, 0, 0, 0, 0]]
    plain, coupled = (
        pk.Chain.from_space(A, np.eye(4)),
        pk.Chain.from_space(A, np.eye(4), coupling=2 * np.eye(2)),
    )
    assert plain != coupled
    assert coupled != plain
    assert coupled.q_names == ("q1", "q2")


def test_the_arrays_of_a_chain_cannot_be_made_writable_again():
    for array in (ARM.screws, ARM.home, ARM.limits, ARM.local.frames, ARM.coupling):
        with pytest.raises(ValueError, match="WRITEABLE"):
            array.flags.writeable = True


def test_a_small_pitch_is_kept():
    chain = pk.Chain.from_space([pk.screw.helical([0, 0, 1], [0, 0, 0], 5e-14)], np.eye(4))
    assert chain.kinds == ("helical",)
    assert chain.fk([3.0])[2, 3] == pytest.approx(1.5e-13, rel=1e-9)


def test_a_screw_made_exact_keeps_its_line():
    S = pk.screw.revolute([0, 0, 1], [5, 0, 0])
    point = pk.screw.axis_of((1 + 9e-10) * S).point
    assert point is not None
    np.testing.assert_allclose(point, [5, 0, 0], rtol=0, atol=2e-15)


@pytest.mark.filterwarnings("ignore::poekin.errors.PoekinWarning")
def test_no_joint_of_a_real_robot_looks_helical():
    for name in erd.available():
        if name != "ur3":
            robot = pk.load(f"erd:{name}")
            for tip in robot.leaves:
                base, link = robot.root, tip
                crossing = [j for j in robot.joints if j.kind in ("floating", "planar")]
                if not crossing:
                    assert "helical" not in robot.chain(base=base, tip=link).kinds


@pytest.mark.parametrize("kind", ["f4", ">f8", "g", "i8", "i1"])
@pytest.mark.parametrize("coupled", [False, True])
def test_numbers_of_any_kind_are_taken_for_what_they_are(kind, coupled):
    chain = pk.Chain.from_space(
        ARM.screws[:3], np.eye(4), coupling=[[1.0, 0, 0], [0, 2, 0], [1, 0, 1]] if coupled else None
    )
    q = np.array([2, -1, 3])
    given, expected = q.astype(kind), chain.fk(q.tolist())
    for one, same in (
        (given, expected),
        (given[None], expected[None]),
        (np.tile(given, (2, 1, 1)), expected),
    ):
        np.testing.assert_allclose(chain.fk(one) - same, 0, atol=1e-15)
        np.testing.assert_allclose(chain.fk_jacobian(one, "body")[0] - same, 0, atol=1e-15)
        np.testing.assert_allclose(
            chain.jacobian(one, "body") - chain.jacobian(q.tolist(), "body"), 0, atol=1e-15
        )


def test_a_way_in_for_one_configuration_minds_its_length():
    for wrong in (np.zeros(6), np.zeros(8), np.zeros((7, 1)), np.zeros((1, 6)), np.array(0.0)):
        for call in (
            ARM.fk,
            lambda q: ARM.jacobian(q, "body"),
            lambda q: ARM.fk_jacobian(q, "body"),
        ):
            with pytest.raises(ShapeError, match="q: expected 7 coordinates on the last axis"):
                call(wrong)


@pytest.mark.parametrize("frame", ["space", "body", "hybrid", 2])
def test_velocities_of_a_batch_are_those_of_its_configurations(frame):
    arm = pk.load("panda").chain(tip="panda_hand")
    q = arm.random(0, 10).reshape(2, 5, 7)
    dq = np.random.default_rng(1).normal(size=q.shape)
    found = arm.velocity(q, dq, frame)
    assert found.shape == (2, 5, 6)
    expected = np.einsum("...ij,...j->...i", arm.jacobian(q, frame), dq)
    # sums of seven products, of a Jacobian that is as exact
    assert np.abs(found - expected).max() <= 100 * 2.0**-53 * np.abs(dq).sum(axis=-1).max()


def test_where_the_jacobian_alone_is_asked_for_one_pose_holds_all_of_its_poses(monkeypatch):
    given = []
    kernel = SimpleNamespace(call=lambda table, rows, code, T, J: given.append(T.shape))
    monkeypatch.setattr(pose_jacobian.chain_kernels, "pose_jacobian_many", kernel)
    pose_jacobian.jacobian(ARM, Q, "body")
    assert given == [(1, 4, 4)]
