"""The named list: every arm proper, base to flange, of 5 to 7 joints in example-robot-data and the
catalogue.

Of two arms that mirror each other the left one; of models with equal axes those whose limits
differ. No legs, no heads, no fingers.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

from poekin import Chain, load
from poekin.errors import PoekinWarning

EXAMPLES: tuple[tuple[str, str, str], ...] = (
    ("alex_nub_hands", "Torso", "LeftGripperYawLink"),
    ("anymal-kinova", "j2s6s200_link_base", "j2s6s200_end_effector"),
    ("baxter", "left_arm_mount", "left_hand_link"),
    ("centauro", "torso_2", "arm1_6"),
    ("g1_29dof_rev_1_0", "torso_link", "left_wrist_yaw_link"),
    ("hextilt_flying_arm_5", "flying_arm_5__base_link", "flying_arm_5__link_5"),
    ("human", "left_clavicle", "left_hand"),
    ("icub", "chest", "l_hand"),
    ("kinova", "j2s6s200_link_base", "j2s6s200_end_effector"),
    ("panda", "panda_link0", "panda_link8"),
    ("pr2", "torso_lift_link", "l_wrist_roll_link"),
    ("romeo", "torso", "l_wrist"),
    ("romeo_laas_small", "torso", "l_wrist"),
    ("simple_humanoid", "torso", "l_wrist"),
    ("so100", "base", "gripper"),
    ("so101", "base_link", "gripper_link"),
    ("talos_full_v2", "torso_2_link", "arm_left_7_link"),
    ("talos_left_arm", "arm_left_1_link", "arm_left_7_link"),
    ("talos_reduced", "torso_2_link", "arm_left_7_link"),
    ("tiago", "torso_lift_link", "arm_7_link"),
    ("tiago_dual", "torso_lift_link", "arm_left_7_link"),
    ("tiago_pro", "torso_lift_link", "arm_left_7_link"),
    ("ur3_joint_limited_robot", "base_link", "tool0"),
    ("ur3_robot", "base_link", "tool0"),
    ("ur5_joint_limited_robot", "base_link", "tool0"),
    ("ur5_robot", "base_link", "tool0"),
    ("ur10_joint_limited_robot", "base_link", "tool0"),
    ("ur10_robot", "base_link", "tool0"),
    ("xarm7", "link_base", "link_eef"),
    ("z1", "link00", "link06"),
)
CATALOGUE = ("iiwa14", "irb140", "jaco", "kr5", "puma560", "stanford", "ur3", "ur3e", "ur5", "ur5e", "ur10", "ur10e",
             "ur16e")  # fmt: skip

LEFT_OUT = (
    "Twins, left out: the right arms; alex_psyonic_hands and alex_sake_hands (as alex_nub_hands), b1-z1 (z1), "
    "g1_29dof_with_hand_rev_1_0, icub_reduced, panda_collision and the catalogue's panda (panda), romeo_small (romeo), "
    "simple_humanoid_classical, talos_full_v2_box, talos_reduced_box and talos_reduced_corrected, "
    "tiago_no_hand, ur3_gripper and ur5_gripper (as the joint-limited ones). The catalogue's cobra600 has four joints, "
    "and the arms of the other robots fewer than five."
)


@dataclass(frozen=True)
class NamedArm:
    """An arm of the list: where it comes from, and its chain."""

    name: str
    chain: Chain

    @property
    def task(self) -> str:
        """What is asked of it: the pose, or of five joints the position and the direction of the
        tool's z axis.
        """
        return "pose" if self.chain.dof > 5 else "direction"


def named_arms() -> list[NamedArm]:
    """The list, loaded."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        found = [
            NamedArm(f"{name} → {tip}", load(f"erd:{name}").chain(base, tip))
            for name, base, tip in EXAMPLES
        ]
        return found + [NamedArm(f"{name} (catalogue)", load(name).chain()) for name in CATALOGUE]
