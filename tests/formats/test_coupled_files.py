"""Coupled readings in files: DH tables, chains of calibrations, and what a URDF cannot say."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ModelError, PoekinWarning
from poekin.formats import chain_toml
from poekin.formats.serial import serial_robot
from poekin.formats.text.toml_text import Keys

PUMA = pk.dh.published("puma560")
TABLE = pk.dh.Table(
    PUMA.convention,
    PUMA.rows,
    base=PUMA.base,
    tool=PUMA.tool,
    name="fanuc",
    coupling="J3 = J2 + J3",
)
ARM = pk.dh.to_chain(TABLE)
SINGULAR = "different readings give the same values of the joints, the matrix is singular"
Q = np.random.default_rng(0).normal(size=(6, 6))


def test_a_table_carries_its_coupling_into_chain_and_robot():
    assert TABLE.coupling == ("joint3 = joint2 + joint3",)
    assert pk.dh.to_chain(PUMA).coupled("J3 = J2 + J3") == ARM
    np.testing.assert_allclose(pk.dh.to_robot(TABLE).chain().fk(Q), ARM.fk(Q), rtol=0, atol=1e-14)
    assert TABLE != PUMA
    assert pickle.loads(pickle.dumps(TABLE)) == TABLE
    assert repr(TABLE).endswith("\n  coupling: joint3 = joint2 + joint3>")


@pytest.mark.parametrize("ending", ["toml", "csv"])
def test_files_of_tables_keep_it(tmp_path, ending):
    path = tmp_path / f"fanuc.{ending}"
    pk.dh.write(TABLE, path)
    assert pk.dh.read(path) == TABLE
    robot = pk.load(path)
    assert robot.coupling == TABLE.coupling
    np.testing.assert_allclose(robot.chain().fk(Q), ARM.fk(Q), rtol=0, atol=1e-14)
    pk.dh.write(PUMA, path)
    assert "coupling" not in path.read_text()


def test_a_single_statement_may_be_a_text(tmp_path):
    path = tmp_path / "fanuc.toml"
    pk.dh.write(TABLE, path)
    said = 'coupling = "J3 = J2 + J3"\n' + path.read_text().replace(
        'coupling = [\n    "joint3 = joint2 + joint3",\n]\n', ""
    )
    path.write_text(said)
    assert pk.dh.read(path) == TABLE


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("coupling = 3", "expected a list of texts, got 3"),
        ('coupling = ["J3 = J2 3"]', "'J3 = J2 3': expected '+' or '-' between readings, got '3'"),
        ('coupling = "J3 = J2"', f"'J3 = J2': {SINGULAR}"),
        (
            'coupling = ["J3 J2"]',
            "'J3 J2': expected '=' after the name of a joint, got 'J2'; "
            "a statement is a joint as a sum of readings, as in 'J3 = J2 + J3'",
        ),
    ],
)
def test_a_bad_coupling_in_a_file_is_refused_with_the_file(tmp_path, line, message):
    path = tmp_path / "fanuc.toml"
    pk.dh.write(PUMA, path)
    path.write_text(f"{line}\n{path.read_text()}")
    with pytest.raises(ModelError) as caught:
        pk.load(path)
    assert str(caught.value) == f"{path}: coupling: {message}"


def test_a_bad_coupling_in_a_csv_is_refused(tmp_path):
    path = tmp_path / "fanuc.csv"
    pk.dh.write(TABLE, path)
    path.write_text(path.read_text().replace("joint2 + joint3", "joint2 + 3"))
    with pytest.raises(ModelError, match="expected the name of a reading, got nothing"):
        pk.dh.read(path)


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_a_coupled_chain_s_table_is_coupled(convention):
    found = pk.dh.from_chain(ARM, convention=convention)
    assert found.table.coupling == TABLE.coupling
    assert found.to_dict()["coupling"] == list(TABLE.coupling)
    assert found.error <= found.bound
    np.testing.assert_allclose(pk.dh.to_chain(found.table).fk(Q), ARM.fk(Q), rtol=0, atol=1e-13)
    own = pk.dh.to_chain(PUMA).limits
    for row, limits in zip(found.table.rows, own, strict=True):
        np.testing.assert_allclose(row.limits, limits, rtol=0, atol=1e-14)
    shifted = ARM.replace(offset=np.full(6, 0.1))
    assert pk.dh.from_chain(shifted, convention=convention).table.coupling == ()


def test_a_coupled_chain_is_a_robot_with_coupled_readings():
    offset = np.array([0.1, -0.2, 0.3, 0, 0, 0])
    chain = ARM.replace(offset=offset, joint_limits=ARM.joint_limits + offset[:, None])
    robot = serial_robot(chain)
    assert robot.coupling == TABLE.coupling
    np.testing.assert_allclose(robot.chain().fk(Q), chain.fk(Q), rtol=0, atol=1e-13)
    np.testing.assert_allclose(robot.limits, chain.limits, rtol=0, atol=1e-14)


def test_a_urdf_has_the_joints_own_values_and_says_so():
    robot = pk.dh.to_robot(TABLE)
    with pytest.warns(PoekinWarning, match=r"^robot 'fanuc': a URDF has the joints' own values, "):
        text = pk.to_urdf(robot)
    assert text == pk.to_urdf(pk.dh.to_robot(PUMA), name="fanuc")


def test_joints_of_a_coupled_chain_s_robot_are_as_fast_as_they_are_in_the_chain():
    chain = pk.dh.to_chain(PUMA).replace(velocity_limits=np.arange(1.0, 7.0))
    robot = serial_robot(chain.coupled("J3 = J2 + J3"))
    assert [robot.joint(name).velocity for name in chain.joint_names] == [1, 2, 3, 4, 5, 6]


def test_a_coupled_robot_goes_into_a_urdf_with_that_warning_too():
    mine = pk.to_urdf(pk.dh.to_robot(PUMA)).encode()
    with pytest.warns(PoekinWarning, match=r"^robot 'fanuc': a URDF has the joints' own values, "):
        assert pk.to_urdf(pk.dh.to_robot(TABLE), into=mine) == mine


def test_a_coupled_chain_goes_into_a_urdf_of_joints_with_a_warning():
    plain = pk.dh.to_robot(PUMA)
    mine = pk.to_urdf(plain).encode()
    moved = ARM.retooled(pk.se3.exp([0, 0, 0.1, 0, 0, 0.01]))
    says = (
        r"^robot 'puma560': its joints keep their own values, without the coupling of the chain's "
        r"readings: joint3 = joint2 \+ joint3$"
    )
    with pytest.warns(PoekinWarning, match=says):
        edited = pk.from_text(pk.to_urdf(moved, into=mine).decode())
    assert edited.coupling == ()
    expected = moved.fk(Q)
    x = Q @ ARM.coupling.T
    np.testing.assert_allclose(edited.chain().fk(x), expected, rtol=0, atol=1e-13)
    coupled = pk.dh.to_robot(TABLE)
    fixed = pk.relinked(coupled, moved)
    np.testing.assert_allclose(fixed.chain().fk(Q), expected, rtol=0, atol=1e-13)
    other = pk.dh.to_chain(PUMA).coupled("J3 = J3 - J2")
    with pytest.raises(InputError, match=r"follow its coordinates otherwise than the robot's"):
        pk.relinked(coupled, other)


def test_a_coupled_robot_is_validated_joint_by_joint():
    pytest.importorskip("pinocchio")
    assert pk.validate(pk.dh.to_robot(TABLE)).passed


def test_a_calibration_keeps_the_coupling(tmp_path):
    pytest.importorskip("tomli_w")
    robot = pk.dh.to_robot(TABLE)
    true = pk.calibration.simulated(pk.dh.to_chain(PUMA), 1, seed=1).truth.coupled("J3 = J2 + J3")
    q = ARM.random(0, 40)
    found = pk.calibration.from_fk(ARM, q, true.fk(q))
    np.testing.assert_allclose(found.chain.screws, true.screws, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(found.chain.coupling, true.coupling)
    fixed = found.calibration.to_robot(robot)
    assert fixed.coupling == robot.coupling
    np.testing.assert_allclose(fixed.chain().fk(q), true.fk(q), rtol=0, atol=1e-12)
    path = tmp_path / "arm.toml"
    found.calibration.save(path)
    np.testing.assert_allclose(pk.load(path).chain().fk(q), true.fk(q), rtol=0, atol=1e-12)
    assert pk.calibration.load(path).chain == found.chain


@pytest.mark.parametrize("places", [1, 3, 5])
def test_the_bound_of_a_coupled_arm_holds(places):
    true = pk.calibration.simulated(pk.dh.to_chain(PUMA), 1, seed=2).truth.coupled("J3 = J2 + J3")
    q = ARM.random(1, 40)
    T = true.fk(q)
    T[:, :3, 3] = (1e3 * T[:, :3, 3]).round(places) / 1e3
    found = pk.calibration.from_fk(ARM, np.radians(np.degrees(q).round(places)), T)
    assert found.digits.startswith(f"joint angles to {10.0**-places:g}°, positions to ")
    assert (np.abs(found.chain.screws - true.screws) <= found.screw_bounds).all()
    fresh = ARM.random(2, 200)
    moved = np.linalg.norm((found.chain.fk(fresh) - true.fk(fresh))[:, :3, 3], axis=1)
    assert (moved <= found.pose_bound(fresh).position).all()


def test_a_table_of_toml_keeps_the_joints_own_limits():
    chain = pk.dh.to_chain(PUMA).replace(velocity_limits=np.arange(1.0, 7.0))
    coupled = chain.coupled("J3 = J2 + J3")
    again = chain_toml.to_chain(Keys(chain_toml.to_data(coupled), "arm.toml"))
    assert again == coupled
    assert np.isfinite(again.joint_limits[2]).all()
    assert again.joint_velocity_limits[2] == 3.0
