"""`pk.view`: whatever can be shown becomes a page, all else is refused with what can."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, PoekinError, UnknownName
from poekin.solve.path.joint_path import joint_path

pytest.importorskip("k3d", reason="no k3d: no page was made")
ROBOT = pk.load("ur5")
ARM = ROBOT.chain()
T = ARM.fk([0.1, -1.0, 1.2, 0.4, 0.9, -0.3])


def calibrated():
    made = pk.calibration.simulated(ARM, 20, seed=2)
    return pk.calibrate(ARM, made.q, made.measurements, folds=0)


KINDS = {
    "robot": lambda: ROBOT,
    "chain": lambda: ARM,
    "compiled": ARM.compile,
    "comparison": lambda: pk.compare(ARM, ARM.rebased(pk.se3.exp([0, 0, 1, 0, 0, 0]))),
    "path": lambda: joint_path(ARM, np.zeros((3, 6))),
    "ik": lambda: pk.ik(ARM, T),
    "ik_all": lambda: pk.ik_all(ARM, T, method="search", min_hits=1, restarts=5),
    "singularity": lambda: pk.singularity(ARM, np.zeros(6)),
    "calibration": calibrated,
}


@pytest.mark.parametrize("kind", KINDS)
def test_everything_that_can_be_shown_becomes_a_page(kind, tmp_path):
    page = pk.view(KINDS[kind]())
    assert "poekin-scene" in page.html
    assert page.save(tmp_path / "page.html").read_text(encoding="utf-8") == page.html


@pytest.mark.parametrize("x", [None, 1, "panda", np.eye(4), pk, pk.se3])
def test_what_cannot_be_shown_is_refused_with_what_can(x):
    with pytest.raises(InputError, match="view: expected a Robot or a Chain, or what compare"):
        pk.view(x)


@pytest.mark.parametrize(
    ("kind", "option"),
    [
        ("robot", {"robot": ROBOT}),
        ("comparison", {"tip": "tool"}),
        ("comparison", {"robot": ROBOT}),
        ("ik", {"q": np.zeros(6)}),
        ("singularity", {"cloud": 10}),
        ("path", {"meshes": False}),
        ("calibration", {"q": [0] * 6}),
        ("calibration", {"meshes": False}),
        ("ik", {"meshes": False}),
    ],
)
def test_an_option_that_does_not_go_with_it_is_refused_by_its_name(kind, option):
    (name,) = option
    with pytest.raises(InputError, match=f"{name}: no option of a page of"):
        pk.view(KINDS[kind](), **option)


@pytest.mark.parametrize(
    ("kind", "options", "words"),
    [
        ("ik", {"robot": "ur5"}, "robot: expected a Robot, got 'ur5'"),
        ("ik", {"robot": ARM}, "robot: expected a Robot"),
        ("robot", {"meshes": "no"}, "meshes: expected True or False"),
        ("robot", {"cloud": 10**12}, "cloud: expected at most"),
        ("robot", {"tip": ["tool"]}, "no tip link"),
    ],
)
def test_an_option_of_another_kind_is_refused_by_its_name(kind, options, words):
    with pytest.raises(PoekinError, match=words):
        pk.view(KINDS[kind](), **options)


def test_q_and_tip_are_checked_as_elsewhere():
    with pytest.raises(InputError):
        pk.view(ARM, q=[0, 1])
    with pytest.raises(UnknownName):
        pk.view(ROBOT, tip="gripper")
    with pytest.raises(InputError):
        pk.view(KINDS["comparison"](), q=[0, np.nan, 0, 0, 0, 0])


def test_a_result_that_was_made_by_hand_says_that_it_lacks_its_chain():
    from dataclasses import replace

    for found in (pk.ik(ARM, T), KINDS["ik_all"]()):
        with pytest.raises(
            InputError,
            match=r"^view: (Solution|AllSolutions): expected one that ik or ik_all returned, with its chain$",
        ):
            pk.view(replace(found, chain=None))


def test_neither_poekin_nor_its_view_loads_k3d_before_a_page_is_made():
    code = "import sys, poekin, poekin.view.view; print({'k3d', 'trimesh'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_an_option_that_does_not_go_with_a_page_says_of_which():
    with pytest.raises(InputError, match=r"^cloud: no option of a page of 'Comparison'$"):
        pk.view(KINDS["comparison"](), cloud=3)
