"""Work that is shared out among threads."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from poekin.engine.threads import share_out


def test_every_part_is_run_once():
    x, y = np.arange(1000.0), np.zeros(1000)

    def run(a, b):
        b += a

    share_out(run, x, y, rows=7)
    np.testing.assert_array_equal(y, x)


def test_an_error_in_one_part_takes_those_that_wait_off_the_list():
    release, begun = threading.Event(), []

    def run(part):
        if part[0] == 0:
            raise KeyboardInterrupt
        begun.append(int(part[0]))
        release.wait(10)

    with pytest.raises(KeyboardInterrupt):
        share_out(run, np.arange(500), rows=1)
    release.set()
    share_out(lambda part: None, np.arange(2), rows=1)  # behind all that waits
    assert len(begun) < 250
