"""A fork waits for whoever compiles: the child finds every lock free, and LLVM as it should be."""

import os
import signal
import threading
import time
import warnings

import numpy as np
import pytest
from llvmlite.binding import ffi
from numba.core.compiler_lock import global_compiler_lock

from poekin.engine.jit.locks import COMPILING
from poekin.engine.straight_line.arm_code import ArmCode
from poekin.engine.straight_line.machine_code import object_code
from poekin.model.chain import Chain

LOCKS = {"poekin's": COMPILING, "Numba's": global_compiler_lock, "LLVM's": ffi.lib._lock}


def _compile() -> None:
    with COMPILING, global_compiler_lock:
        pass
    program = Chain.from_space([[0, 0, 1, 0, 0, 0]], np.eye(4)).compile().program("hybrid")
    ArmCode(object_code(program, False), len(program.angles), 1)


def _forked(work) -> int:
    """How a forked process ends in which `work` is done: 0, or a signal where it hangs."""
    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore"
        )  # Python warns of a fork beside threads, which is what this is about
        child = os.fork()
    if child == 0:
        code = 1
        try:
            signal.signal(signal.SIGALRM, signal.SIG_DFL)
            signal.alarm(20)
            work()
            code = 0
        finally:
            os._exit(code)
    return os.waitpid(child, 0)[1]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="nothing forks here")
@pytest.mark.parametrize("lock", LOCKS)
def test_a_process_that_is_forked_while_another_thread_compiles_can_compile(lock):
    holding = threading.Event()

    def hold():
        with LOCKS[lock]:
            holding.set()
            time.sleep(0.1)

    thread = threading.Thread(target=hold)
    thread.start()
    holding.wait()
    end = _forked(_compile)
    thread.join()
    assert end == 0
    _compile()  # here the locks are free, too


@pytest.mark.skipif(not hasattr(os, "fork"), reason="nothing forks here")
def test_who_forks_while_it_compiles_itself_need_not_wait():
    with COMPILING, global_compiler_lock:
        assert _forked(_compile) == 0
    assert not global_compiler_lock.is_locked()
