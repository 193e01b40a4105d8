"""One arm's machine code: its memory, which goes with the object that owns it."""

import ctypes
import gc

import numpy as np
import pytest

from poekin.engine.arm import Arm
from poekin.engine.machine_code import object_code
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
    # LLVM keeps about 10 kB of constants for each of these arms where they are all made in one context. What is left
    # without that is Python's own, a few hundred bytes on the average.
    rng = np.random.default_rng(0)
    programs = []
    for _ in range(20):
        axes = rng.normal(size=(2, 3))
        axes /= np.linalg.norm(axes, axis=1)[:, None]
        arm = Chain(np.hstack([axes, np.cross(rng.normal(size=(2, 3)), axes)]), np.eye(4))
        programs.append(arm.compile().program("hybrid", pose=True))

    def use(programs):
        for program in programs:
            Arm(object_code(program, True), len(program.angles), 2)

    use(programs[:8])
    before = _in_use()
    use(programs[8:])
    assert _in_use() - before < 12 * 4096
