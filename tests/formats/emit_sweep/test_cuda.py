"""Emitted CUDA: a front end of CUDA takes it, and on the processor it counts what `pk.sweep.run` counts."""

from __future__ import annotations

import re
from itertools import pairwise

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.formats import emit
from poekin.formats.emit.sweep.cuda import Measure
from poekin.model.kinematics.pose_jacobian import AnyFrame
from poekin.sweep import Cells, Grid, Random, Sobol, Sweep, run
from tests.sweep.arms import measured

from ..emitted import HOSTILE, arm, bound, expected, suffix, with_name
from .cuda_on_cpu import KINDS, Device, check_as_cuda
from .sweep_cases import samples_of

ARMS = ("panda", "ur5e", "general 6R", "mixed", "coupled", "one slide")
ROUNDOFF = {"float64": 2.0**-53, "float32": 2.0**-24}
CELLS = Cells.box([-1.0, -1.0, -0.6], [1.0, 1.0, 1.3], 0.1, side=2)


def swept(device: Device, name: str, sweep: Sweep, pieces=1):
    """Counts, outside, best and attained that the kernels of a sweep leave."""
    counts = np.zeros(sweep.cells.count, np.uint64)
    outside = np.zeros(1, np.uint64)
    best = np.full(counts.shape, -np.inf, device.kind)
    attained = np.full(counts.shape, 2**64 - 1, np.uint64)
    samples = samples_of(sweep)
    given = (
        samples.numbers(),
        samples.bounds.astype(device.kind),
        sweep.cells.numbers(),
        sweep.cells.place().astype(device.kind),
    )
    ends = np.linspace(0, sweep.samples.count, pieces + 1).astype(int).tolist()
    for first, last in pairwise(ends):
        measured = [best] * sweep.is_measured
        device.launch(f"{name}_sweep", first, last, *given, counts, outside, *measured)
    if sweep.is_measured:
        device.launch(f"{name}_attained", 0, sweep.samples.count, *given, best, attained)
    return counts.astype(np.int64), int(outside[0]), best, attained.astype(np.int64)


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("precision", KINDS)
def test_a_front_end_of_cuda_takes_it_without_a_warning(name, precision, tmp_path):
    measure = "manipulability" if name in ("panda", "coupled") else "reach"
    check_as_cuda(tmp_path, emit.cuda(arm(name), "hybrid", precision=precision, measure=measure))


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("frame", ["hybrid", "cheapest", 0])
@pytest.mark.parametrize("precision", KINDS)
def test_batches_are_within_the_bound_of_their_precision(name, frame, precision, tmp_path):
    chain = arm(name)
    device = Device(tmp_path, emit.cuda(chain, frame, name="a", precision=precision), precision)
    q = np.random.default_rng(7).uniform(-3, 3, (37, chain.dof)).astype(device.kind)
    T, J = expected(chain, frame, q.astype(float))
    found_T = np.empty(T.shape, device.kind)
    found_J = np.empty(J.shape, device.kind)
    allowed = bound(chain, q.astype(float), ROUNDOFF[precision])
    device.launch(f"a_fk_jacobian_{suffix(frame)}_batch", len(q), q, found_T, found_J)
    np.testing.assert_allclose(found_T, T, rtol=0, atol=allowed)
    np.testing.assert_allclose(found_J, J, rtol=0, atol=allowed)
    np.testing.assert_allclose(device.poses("a_fk_batch", q), T, rtol=0, atol=allowed)
    found_J[:] = np.nan
    device.launch(f"a_jacobian_{suffix(frame)}_batch", len(q), q, found_J)
    np.testing.assert_allclose(found_J, J, rtol=0, atol=allowed)


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("kind", ["random", "grid"])
def test_counts_in_double_precision_are_those_of_the_sweep(name, kind, tmp_path):
    chain = arm(name)
    samples = Random.of(chain, 20_011, seed=2**40 + 3)
    if kind == "grid":
        samples = Grid.of(chain, [(9, 7, 5, 3, 2, 2, 4)[k % 7] for k in range(chain.dof)])
    sweep = Sweep(chain, samples, CELLS)
    device = Device(tmp_path, emit.cuda(chain, "hybrid", name="a"))
    counts, outside, *_ = swept(device, "a", sweep, pieces=3)
    found = run(sweep)
    assert counts.tobytes() == found.counts.tobytes()
    assert outside == found.outside
    assert counts.sum() > 0


@pytest.mark.parametrize("side", [0, 1, 3])
@pytest.mark.parametrize("name", ["panda", "coupled"])
def test_the_best_measure_and_its_first_sample_are_those_of_the_sweep(name, side, tmp_path):
    chain = arm(name)
    # of the panda's box the first cell is reached too
    low = {"panda": [-0.5, -0.5, 0.1]}.get(name, [-1.0, -1.0, -0.6])
    cells = Cells.box(low, [1.0, 1.0, 1.3], 0.4, side=side)
    sweep = Sweep(chain, Random.of(chain, 20_011, seed=4), cells, "manipulability")
    text = emit.cuda(chain, "body", name="a", measure="manipulability")
    counts, outside, best, attained = swept(Device(tmp_path, text), "a", sweep)
    found = run(sweep)
    wanted, samples = measured(found)
    assert (counts.tobytes(), outside) == (found.counts.tobytes(), found.outside)
    assert attained.tobytes() == samples.tobytes()
    there = counts > 0
    assert np.isinf(best[~there]).all()
    assert best[there].tobytes() == wanted.reshape(-1)[there].tobytes()


def test_samples_of_another_kind_lie_outside(tmp_path):
    chain = arm("panda")
    device = Device(tmp_path, emit.cuda(chain, "hybrid", name="a"))
    counts, outside, *_ = swept(device, "a", Sweep(chain, Sobol.of(chain, 100), CELLS))
    assert (counts.sum(), outside) == (0, 100)


def test_in_single_precision_samples_near_a_border_alone_fall_elsewhere(tmp_path):
    chain = arm("panda")
    cells = Cells.box([-1.0] * 3, [1.0] * 3, 0.02)
    sweep = Sweep(chain, Random.of(chain, 200_000), cells, "manipulability")
    text = emit.cuda(chain, "hybrid", name="a", precision="float32", measure="manipulability")
    counts, outside, best, _ = swept(Device(tmp_path, text, "float32"), "a", sweep)
    found = run(sweep)
    assert counts.sum() + outside == sweep.samples.count
    moved = np.abs(counts - found.counts.reshape(-1)).sum() + abs(outside - found.outside)
    # as many as have their point within its bound of a side of its cube, on either side of it, in one
    # of three directions; six standard deviations
    q = samples_of(sweep).configurations(np.arange(1000))
    near = 3 * 2 * bound(chain, q, ROUNDOFF["float32"]) / cells.resolution
    mean = near * sweep.samples.count
    # each is missed in one cell and counted in another
    assert 0 < moved <= 2 * (mean + 6 * np.sqrt(mean))
    same = (counts == found.counts.reshape(-1)) & (counts > 0)
    wanted, _ = measured(found)
    # a determinant that is 0 but for rounding has the root of that
    allowed = 8 * np.sqrt(ROUNDOFF["float32"]) * chain.reach**3
    np.testing.assert_allclose(best[same], wanted.reshape(-1)[same], rtol=0, atol=allowed)


def test_it_has_a_kernel_for_each_batch_and_those_of_the_sweep():
    batches = ["a_fk_batch", "a_jacobian_body_batch", "a_fk_jacobian_body_batch"]
    sweeps: dict[Measure, list[str]] = {
        "reach": ["a_sweep"],
        "manipulability": ["a_sweep", "a_attained"],
    }
    for measure, kernels in sweeps.items():
        text = emit.cuda(arm("one slide"), "body", name="a", measure=measure)
        assert re.findall(r"__global__ void (\w+)\(", text) == [*batches, *kernels]


def test_its_comment_names_the_arguments_of_the_kernels_that_it_has():
    chain = arm("one slide")
    kept: dict[Measure, str] = {"reach": "", "manipulability": ", best"}
    for measure, best in kept.items():
        text = emit.cuda(chain, "body", name="a", measure=measure)
        assert (
            f"a_sweep(first, last, samples, bounds, cells, place, counts, outside{best}):" in text
        )
        assert ("a_attained(" in text.partition("*/")[0]) == bool(best)
        assert "first ... last - 1 of a map" in text
        assert "and to outside[0]." in text
    frames: dict[AnyFrame, str] = {"body": "body", 0: "joint0"}
    for frame, called in frames.items():
        assert f"a_fk_jacobian_{called}_batch(count, q, T, J)" in emit.cuda(chain, frame, name="a")
    single = emit.cuda(chain, "body", precision="float32")
    assert "random numbers are whole numbers of 64 bits" in single
    digits = np.finfo(np.float32).nmant + 1
    assert re.search(rf"all else is rounded to {digits}[\n *]+bits", single)


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_name_stays_in_its_comment(name, tmp_path):
    chain = with_name(name)
    text = emit.cuda(chain, "hybrid", name=name, origin=name)
    text.encode("ascii")
    check_as_cuda(tmp_path, text)


def test_what_cannot_be_emitted_is_refused():
    chain = arm("panda")
    with pytest.raises(
        InputError, match=r"^precision: expected 'float64' or 'float32', got 'half'$"
    ):
        emit.cuda(chain, "body", precision="half")  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"^measure: expected 'reach' or 'manipulability', got"):
        emit.cuda(chain, "body", measure="best")  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"^name: expected a text, got 3$"):
        emit.cuda(chain, "body", name=3)  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"^emit: expected an arm with a coordinate, .* has none$"):
        emit.cuda(arm("no joint"), "body")
    far = np.eye(4)
    far[0, 3] = 1e39
    with pytest.raises(InputError, match="which single precision cannot hold"):
        emit.cuda(pk.Chain.from_space([[0, 0, 1, 0, 0, 0]], far), "body", precision="float32")
