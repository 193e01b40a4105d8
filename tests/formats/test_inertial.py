"""Masses out of <inertial>, and the gravity torques that Pinocchio makes of the same files."""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest

import poekin as pk
from poekin.errors import PoekinWarning
from poekin.formats import urdf
from poekin.formats.erd import available
from poekin.solve.calibration.terms.conditions import at_rest
from poekin.solve.calibration.terms.gravity import STANDARD_GRAVITY, torques
from poekin.solve.calibration.terms.scalars import of_rows

U = 2.0**-53
ARMS = {"ur5_robot": "tool0", "panda": "panda_hand", "kinova": "j2s6s200_link_6", "z1": None,
        "baxter": "left_gripper", "TwoDofs": None}  # fmt: skip


def read(inertial, more=""):
    text = f"""<robot name="r"><link name="a"/><link name="b">{inertial}</link><link name="c">{more}</link>
      <joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>
      <joint name="k" type="fixed"><parent link="b"/><child link="c"/></joint></robot>"""
    return urdf.read_text(text, "m.urdf")


def test_a_link_has_the_mass_and_the_centre_of_its_inertial():
    robot = read(
        '<inertial><origin xyz="0.5 -1 2" rpy="1 0 0"/><mass value="3.5"/></inertial>',
        '<inertial><mass value="1"/></inertial>',
    )
    assert robot.masses == (pk.LinkMass("b", 3.5, (0.5, -1, 2)), pk.LinkMass("c", 1.0))


NONE = [
    "",
    "<inertial/>",
    '<inertial><mass value="0.0"/></inertial>',
    "<inertial><mass/></inertial>",
]


@pytest.mark.parametrize("inertial", NONE)
def test_without_a_mass_or_with_none_a_link_has_none(inertial):
    one = '<inertial><mass value="1"/></inertial>'
    assert read(inertial, one).masses == (pk.LinkMass("c", 1.0),)


BAD = {
    '<mass value="-2"/>': "got [-2.0] at [0.0, 0.0, 0.0]",
    '<mass value="1e4"/>': "got [10000.0]",
    '<mass value="nan"/>': "got [nan]",
    '<mass value="heavy"/>': "got []",
    '<mass value="1"/><origin xyz="120 0 3"/>': "got [1.0] at [120.0, 0.0, 3.0]",
    '<mass value="1"/><origin xyz="0 0"/>': "at [0.0, 0.0]",
}


@pytest.mark.parametrize("inertial", BAD)
def test_a_mass_that_cannot_be_is_told_and_no_other_is_believed(inertial):
    words = re.escape(
        "m.urdf:1: link 'b': expected a mass from 0 to 10000 kg with its centre within 100 m"
    )
    with pytest.warns(PoekinWarning, match=words) as caught:
        robot = read(f"<inertial>{inertial}</inertial>", '<inertial><mass value="1"/></inertial>')
    assert BAD[inertial] in str(caught[0].message)
    assert "the masses of this robot are not used" in str(caught[0].message)
    assert robot.masses == ()


@pytest.mark.parametrize("name", ARMS)
def test_gravity_torques_are_pinocchio_s(name):
    pinocchio = pytest.importorskip("pinocchio", reason="the package pin is not installed")
    path = available()[name]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        chain = pk.load(path).chain(tip=ARMS[name])
    model = pinocchio.buildModelFromUrdf(path)
    data = model.createData()
    model.gravity.linear = g = np.array([0.3, -0.4, -STANDARD_GRAVITY])
    q = np.random.default_rng(3).uniform(-1, 1, (4, chain.dof))
    conditions = at_rest(q, {})._replace(gravity=np.tile(g, (4, 1)))
    masses = chain.masses
    assert masses is not None
    found = np.stack(torques(chain, of_rows(q, conditions), masses), axis=1)
    joints = [model.joints[model.getJointId(joint)] for joint in chain.q_names]
    # both compute: 24 u a joint (the formula's own bound), and 8 u for each origin read from the file
    far = np.linalg.norm(masses[:, 1:], axis=1).max() + 2 * np.abs(chain.screws[:, 3:]).sum()
    size = np.linalg.norm(g) * masses[:, 0].sum() * far
    bound = (2 * 24 * (chain.dof + 1) + 8 * model.nframes) * U * size
    for row, torque in zip(q, found, strict=True):
        configuration = pinocchio.neutral(model)
        for joint, x in zip(joints, row, strict=True):
            at = joint.idx_q
            configuration[at : at + joint.nq] = [x] if joint.nq == 1 else [np.cos(x), np.sin(x)]
        expected = -pinocchio.computeGeneralizedGravity(model, data, configuration)
        own = [joint.idx_v for joint in joints]
        assert np.abs(torque - expected[own]).max() <= bound
    assert np.abs(found).max() > 1e6 * bound
