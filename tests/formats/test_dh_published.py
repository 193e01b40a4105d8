"""The published tables: complete, with their sources, and the same arms as the URDF files of
others.
"""

import pkgutil

import numpy as np
import pytest

import poekin as pk
from poekin.errors import UnknownName
from poekin.formats.dh.published_tables import CATALOGUE, NAMES


@pytest.mark.parametrize("name", NAMES)
def test_a_published_table_states_its_source_tool_and_zero_and_loads_as_a_robot(name):
    head = (pkgutil.get_data(CATALOGUE, f"{name}.toml") or b"").decode().split("\n\n")[0]
    for word in ("# Source: ", "# Tool: ", "# Zero position: "):
        assert word in head
    table, robot = pk.dh.published(name), pk.load(name)
    assert table.name == robot.name == name
    assert robot.dof >= len(table)
    assert len(table) in (4, 6, 7)


# Where a URDF of the same arm comes with poekin, the two agree to rounding.
@pytest.mark.parametrize(
    "name, tip", [("panda", "panda_link8"), ("ur5e", "tool0"), ("stanford", "tool")]
)
def test_a_table_is_the_same_arm_as_poekin_s_own_urdf(name, tip):
    a, b = pk.dh.to_chain(pk.dh.published(name)), pk.load(name).chain(tip=tip)
    q = a.random(0, 100)
    np.testing.assert_allclose(a.fk(q), b.fk(q), rtol=0, atol=1e-15 * 10)
    np.testing.assert_array_equal(a.limits, b.limits)
    assert a.joint_names == b.joint_names or name == "stanford"


def geometry(chain):
    """Distances [m] and angles [rad] between consecutive axes, and how far along an axis its
    neighbours' feet are: what no choice of base, tool, zero or direction changes.
    """
    table = pk.dh.from_chain(chain, convention="standard").table
    return np.abs(np.concatenate([table.a[:-1], table.alpha[:-1] % np.pi, table.d[1:-1]]))


# Where example-robot-data has the same arm, the difference is rounding: these of its files hold
# pi/2 to all digits.
@pytest.mark.parametrize(
    "name, urdf, base, tip",
    [
        ("panda", "panda", "panda_link0", "panda_link8"),
        ("ur3", "ur3_robot", "base_link", "tool0"),
        ("ur5", "ur5_robot", "base_link", "tool0"),
        ("ur10", "ur10_robot", "base_link", "tool0"),
    ],
)
@pytest.mark.filterwarnings("ignore::poekin.errors.PoekinWarning")
def test_a_table_is_the_same_arm_as_the_urdf_of_others(name, urdf, base, tip):
    table = pk.dh.to_chain(pk.dh.published(name))
    other = pk.load(f"erd:{urdf}").chain(base=base, tip=tip)
    np.testing.assert_allclose(geometry(table), geometry(other), rtol=0, atol=1e-14)


@pytest.mark.filterwarnings("ignore::poekin.errors.PoekinWarning")
def test_the_kinova_of_example_robot_data_is_the_jaco_with_the_other_wrist():
    curved = pk.dh.published("jaco")
    spherical = pk.dh.from_chain(
        pk.load("erd:kinova").chain(tip="j2s6s200_end_effector"), convention="standard"
    ).table
    np.testing.assert_allclose(np.degrees(curved.alpha[3:5]), 60)
    np.testing.assert_allclose(np.degrees(np.abs(spherical.alpha[3:5])), 90)
    assert curved.a[1] == pytest.approx(spherical.a[1], abs=1e-12)


def test_an_unknown_table_names_the_closest():
    with pytest.raises(
        UnknownName, match=r"^no published table is named 'puma506'; did you mean 'puma560'\?$"
    ):
        pk.dh.published("puma506")
