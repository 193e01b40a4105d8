"""One arm's machine code: its memory, which goes with the object that owns it, and its blocks."""

import ctypes
import gc

import numpy as np
import pytest
from llvmlite import binding

from poekin.engine.kernels import arm_kernels
from poekin.engine.straight_line import machine_code
from poekin.engine.straight_line.arm_code import ArmCode
from poekin.engine.straight_line.machine_code import object_code
from poekin.model.chain import Chain


class _Allocator(ctypes.Structure):
    """What glibc's mallinfo2 returns."""

    _fields_ = [(name, ctypes.c_size_t) for name in ("arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks",
                                                     "fsmblks", "uordblks", "fordblks", "keepcost")]  # fmt: skip


def _in_use() -> int:
    """Bytes that this process has allocated and not freed, whoever it was."""
    try:
        ask = ctypes.CDLL(None).mallinfo2
    except (AttributeError, OSError, TypeError):
        pytest.skip("only glibc from 2.33 on says how much of its memory is in use")
    ask.restype = _Allocator
    gc.collect()
    now = ask()
    return now.uordblks + now.hblkhd


def test_the_memory_of_an_arm_s_machine_code_is_freed_with_the_arm():
    # LLVM keeps about 10 kB of constants for each of these arms where they are all made in one
    # context. What is left without that is Python's own, a few hundred bytes on the average; other
    # threads of the test run may allocate too, though not in each of the rounds.
    rng = np.random.default_rng(0)
    programs = []
    for _ in range(20):
        axes = rng.normal(size=(2, 3))
        axes /= np.linalg.norm(axes, axis=1)[:, None]
        arm = Chain.from_space(
            np.hstack([axes, np.cross(rng.normal(size=(2, 3)), axes)]), np.eye(4)
        )
        programs.append(arm.compile().program("hybrid", pose=True))

    def use(programs):
        for program in programs:
            ArmCode(object_code(program, True), len(program.angles), 2)

    held = []
    for start in range(0, 20, 5):
        use(programs[start : start + 5])
        held.append(_in_use())
    assert min(np.diff(held)) < 5 * 4096


def test_a_long_program_is_compiled_in_blocks_and_computes_the_same(monkeypatch):
    # LLVM's scheduling takes time as the square of a block's length: 13 s for 200 joints in one
    # block
    rng = np.random.default_rng(0)
    screws = rng.normal(size=(5, 6))
    screws[:, :3] /= np.linalg.norm(screws[:, :3], axis=1)[:, None]
    screws[3] = 0, 0, 0, 1, 0, 0
    chain, q = Chain.from_space(screws, np.eye(4)), rng.normal(size=(7, 5))
    program = chain.compile().program("hybrid", pose=True)
    texts = []
    parse = binding.parse_assembly
    monkeypatch.setattr(machine_code, "LONGEST", 60)
    monkeypatch.setattr(
        binding, "parse_assembly", lambda text, *more: texts.append(text) or parse(text, *more)
    )
    arm = ArmCode(object_code(program, True), len(program.angles), 5)
    T, J = np.empty((7, 4, 4)), np.empty((7, 6, 5))
    arm_kernels.pose_jacobian_many.call(
        arm.address, q, T, J
    )  # four at once, and three one at a time
    # rounding: fused or not, in another order; the arm reaches less than 20 m
    for got, expected in zip((T, J), chain.fk_jacobian(q, "hybrid"), strict=True):
        np.testing.assert_allclose(got, expected, rtol=0, atol=5e-14)
    blocks = [
        [sum(1 for _ in block.instructions) for block in f.blocks]
        for f in parse(texts[0]).functions
    ]
    assert min(map(len, blocks[1:])) > 4
    assert max(map(max, blocks)) < 16 * 60  # of four lanes, a step may take that many instructions
