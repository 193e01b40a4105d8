"""Files as the ROS driver of Universal Robots writes them, and what ur_description makes of them."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import poekin as pk
from benchmarks.calibrated_arm import UR10E
from poekin.formats import vendors
from poekin.formats.dh import Table
from poekin.formats.vendors import ur
from poekin.formats.vendors.yaml_io import read_text
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle
from tests.formats.vendors.test_ur import ZERO, arms, conf_arm, worst


def about(axis: str, angle: float, x: float = 0.0, z: float = 0.0) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[0, 3], T[2, 3] = Rotation.from_euler(axis, angle).as_matrix(), x, z
    return T


def driver_poses(table: Table) -> np.ndarray:
    """The six poses that the driver writes for a table, by its ur_calibration/doc/algorithm.rst.

    Upper arm and forearm begin in the plane through the frame before them and across its axis: d is
    0, and the next axis, cut with that plane, says where the link ends and which way it points;
    what is left goes to the next d.
    """
    before = [about("z", r.theta, z=r.d) for r in table.rows]
    behind = [about("x", r.alpha, x=r.a) for r in table.rows]
    for k in (1, 2):
        frame = before[k] @ behind[k]
        point, along = frame[:3, 3], frame[:3, 2]
        up = -point[2] / along[2]
        end = point + up * along
        turn = math.atan2(-end[1], -end[0])
        before[k] = about("z", turn)
        behind[k] = about("z", table.theta[k] - turn) @ about("x", table.alpha[k])
        behind[k][0, 3] = -math.hypot(end[0], end[1])
        before[k + 1] = before[k + 1].copy()
        before[k + 1][2, 3] -= up
    return np.array([before[0], *(behind[i] @ before[i + 1] for i in range(5))])


def driver_text(table: Table, mark: str = "calib_1") -> str:
    """The driver's file for a table: lengths, and Eigen's eulerAngles(0, 1, 2), which are R = Rx Ry
    Rz.
    """
    lines = ["kinematics:"]
    for link, T in zip(ur.LINKS, driver_poses(table), strict=True):
        numbers = [*T[:3, 3], *Rotation.from_matrix(T[:3, :3]).as_euler("XYZ")]
        keys = ("x", "y", "z", "roll", "pitch", "yaw")
        lines += [f"  {link}:", *(f"    {k}: {v:.17g}" for k, v in zip(keys, numbers, strict=True))]
    return "\n".join([*lines, f"  hash: {mark}\n"])


@settings(max_examples=25)
@given(table=arms(), seed=st.integers(0, 2**32))
def test_the_driver_s_own_file_is_read_as_the_arm_that_it_is_of(table, seed):
    # The driver's frames are not ours where axes are tilted, its arm is: lengths come out of
    # divisions by tilts of
    # 1e-3 and less, so that its rounding is that of lengths of metres.
    assert worst(read_text(driver_text(table)).to_chain(), table, seed, 3) <= 1e-12


def test_the_driver_s_file_of_the_ur10e_is_read_as_its_table():
    assert worst(read_text(driver_text(UR10E)).to_chain(), UR10E, 0) <= 1e-12


@pytest.mark.parametrize(("arm", "low", "high"), [("ur10e", 3e-6, 4e-6), ("ur10", 1.3e-4, 1.5e-4)])
def test_a_urdf_made_of_the_driver_s_angles_as_they_stand_misses_the_arm(arm, low, high, tmp_path):
    table = UR10E if arm == "ur10e" else conf_arm(tmp_path)
    text = driver_text(table)
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (1000, 6))
    true, read = pk.dh.to_chain(table).fk(q), read_text(text).to_chain().fk(q)
    as_urdf = read_text(text, rpy="fixed").to_chain().fk(q)
    assert np.abs(read - true).max() <= 1e-12
    assert low <= np.linalg.norm((as_urdf - true)[:, :3, 3], axis=1).max() <= high


def test_a_file_for_ur_description_makes_a_urdf_of_the_arm_itself(tmp_path):
    calibration = ur.from_dh(conf_arm(tmp_path), nominal=pk.dh.published("ur10"), hash="calib_7")
    vendors.write(calibration, tmp_path / "arm.yaml")
    text = (tmp_path / "arm.yaml").read_text(encoding="utf-8")
    assert text.startswith("rpy: fixed\nkinematics:\n  shoulder:\n    x: ")
    # What ur_description does with it: the numbers go into xyz and rpy of the joints as they are.
    links = re.findall(
        r"  (\w+):\n    x: (.*)\n    y: (.*)\n    z: (.*)\n    roll: (.*)\n    pitch: (.*)\n    yaw: (.*)",
        text,
    )
    ends = ["base_link_inertia", *(f"{link}_link" for link in ur.LINKS)]
    joints = "".join(
        f'<joint name="{joint}" type="continuous"><parent link="{above}"/><child link="{link}_link"/>'
        f'<origin xyz="{" ".join(xyz)}" rpy="{" ".join(rpy)}"/><axis xyz="0 0 1"/></joint>'
        for joint, above, (link, *xyz), rpy in zip(
            ur.JOINTS,
            ends,
            [match[:4] for match in links],
            [match[4:] for match in links],
            strict=False,
        )
    )
    names = "".join(f'<link name="{link}"/>' for link in ends)
    oracle = PinocchioOracle(f'<robot name="ur10">{names}{joints}</robot>')
    q = np.random.default_rng(1).uniform(-np.pi, np.pi, (50, 6))
    poses = oracle.poses(dict(zip(ur.JOINTS, q.T, strict=True)), "wrist_3_link")
    assert np.abs(poses - calibration.to_chain().fk(q)).max() <= 1e-14


def test_load_takes_the_driver_s_file(tmp_path):
    for name in ("my_robot_calibration.yaml", "arm.YML"):
        (tmp_path / name).write_text(driver_text(UR10E), encoding="utf-8")
        robot = pk.load(tmp_path / name)
        assert robot.q_names == ur.JOINTS
        assert robot.links[0], robot.links[-1] == ("base", "tool0")
        assert np.abs(robot.chain().fk(ZERO) - pk.dh.to_chain(UR10E).fk(ZERO)).max() <= 1e-12
