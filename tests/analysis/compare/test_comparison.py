"""A comparison has SI numbers, and a summary in mm and degrees."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np

import poekin as pk
from poekin.analysis.compare.comparison import JointComparison, PoseDifferences

JOINT = JointComparison(
    3, "elbow", "e", "revolute", "revolute", math.radians(0.5), 1e-3, 2e-3, math.radians(-4),
    False, (0.0, 0.1), True, False, "", "", False, 0.0, (0.0, 0.1),
)  # fmt: skip
SLIDE = replace(JOINT, kind_a="prismatic", kind_b="prismatic", normal=None, shift=None)


def test_a_joint_is_summed_up_in_mm_and_degrees():
    assert str(JOINT) == "joint 3 (elbow): axes 0.5°, 2 mm apart at the arm, zero offset -4°"
    slide = replace(SLIDE, zero_offset=0.004, reversed=True)
    assert slide.summary() == "joint 3 (elbow): axes 0.5°, zero offset 4 mm, sign of q flipped"
    assert (JOINT.unit, SLIDE.unit) == ("rad", "m")
    assert replace(SLIDE, kind_b="revolute").unit == "rad", "the offset is one of b's joint"


def test_a_joint_is_summed_up_to_four_digits_of_each_size():
    joint = replace(JOINT, angle=math.radians(1.23456), shift=0.01234567, zero_offset=-0.00123456)
    said = "joint 3 (elbow): axes 1.235°, 12.35 mm apart at the arm, zero offset -0.07074°"
    assert str(joint) == said


def test_pose_errors_are_summed_up_in_mm_and_degrees():
    errors = PoseDifferences(0.0123, 0.001, math.radians(2), math.radians(0.25))
    assert str(errors) == "worst 12.3 mm, 2°; mean 1 mm, 0.25°"


def test_the_rounding_of_poses_is_summed_up_as_no_difference():
    errors = PoseDifferences(7e-16, 1e-15, 1.2e-16, 0.0)
    assert str(errors) == "worst 0 mm, 0°; mean 0 mm, 0°"
    joint = replace(JOINT, angle=1e-16, shift=2e-15, zero_offset=-1.2e-16)
    assert str(joint) == "joint 3 (elbow): axes 0°, 0 mm apart at the arm, zero offset 0°"
    # A difference that can be measured is one, however small.
    assert str(PoseDifferences(1e-9, 0, 1e-9, 0)).startswith("worst 1e-06 mm, 5.73e-08°")


def test_a_comparison_ends_with_its_outcome_behind_errors_other_explanations_and_what_differs():
    arm = pk.load("ur5e").chain()
    zeros = arm.rezeroed([0.1, 0, 0.2, 0, 0, 0]).replace(limits=arm.limits)
    result = pk.compare(arm, zeros, samples=3)
    before, after, equivalent, elbow, base, outcome = str(result).splitlines()
    assert before == f"Pose error as they stand: {result.before}"
    assert after == f"Pose error aligned: {result.after}"
    assert equivalent == f"Equivalent: {result.alternatives[0]}"
    assert (elbow, base) == tuple(text[0].upper() + text[1:] for text in result.findings)
    assert outcome == "The models are the same arm in other conventions"
    assert result.verdict == "; ".join([outcome.replace("The", "the"), *result.findings])
    strict = pk.compare(arm, arm, strict=True, samples=1).summary()
    assert strict.splitlines()[1:] == ["The models are the same"]


def test_the_dict_of_a_comparison_has_all_of_it_in_si():
    arm = pk.load("ur5e").chain()
    result = pk.compare(arm, arm, samples=1)
    document = json.loads(result.to_json())
    assert document == result.to_dict()
    assert (document["tol_position"], document["tol_rotation"]) == (1e-5, math.radians(1e-3))
    assert np.shape(document["base"]) == (4, 4)
    joint = document["joints"][0]
    assert (joint["differs"], joint["unit"]) == (False, "rad")
    assert document["before"] == {
        "worst_position": 0.0, "mean_position": 0.0, "worst_rotation": 0.0, "mean_rotation": 0.0,
    }  # fmt: skip
