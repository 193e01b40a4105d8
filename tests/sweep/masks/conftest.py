"""The robot whose links have all shapes, once a file."""

from __future__ import annotations

import pytest

from tests.sweep.masks.arm_of_all_shapes import robot_in


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    return robot_in(tmp_path_factory.mktemp("robot"))


@pytest.fixture(scope="module")
def arm(robot):
    return robot.chain(tip="hand")
