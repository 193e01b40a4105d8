"""Objects of other libraries: Modern Robotics' pairs, what is refused, and the lines that give
poekin's models back.
"""

from __future__ import annotations

import subprocess
import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given

import poekin as pk
from poekin.checks import REQUIRED
from poekin.errors import InputError, PoseError, ScrewError, ShapeError
from poekin.formats.objects import from_object
from poekin.formats.objects.attributes import type_name
from tests.groups.test_objects import Spatial, library
from tests.model.laws.chain_cases import chain_cases

CASES = chain_cases(("q",), coupled=False)
# The matrices of up to a dozen joints multiplied in another order, each rounding by u of the reach,
# times the turn.
ROUNDING = 1e-13


@given(CASES)
def test_home_and_screws_as_columns_are_a_chain(case):
    chain, _ = case
    made = from_object((chain.home, chain.screws.T), frame="space")
    np.testing.assert_array_equal(made.screws, chain.screws)
    np.testing.assert_array_equal(made.home, chain.home)
    assert made.kinds == chain.kinds


@given(CASES)
def test_home_and_body_screws_are_the_same_chain(case):
    chain, q = case
    made = from_object((chain.home, chain.body.screws.T), frame="body")
    assert np.abs(made.fk(q) - chain.fk(q)).max() <= ROUNDING * chain.reach


@given(CASES)
def test_a_pair_moves_as_modern_robotics_says(case):
    chain, q = case
    mr = library("modern_robotics")
    M, Slist, Blist = chain.home, chain.screws.T, chain.body.screws.T
    space, body = from_object((M, Slist), frame="space"), from_object((M, Blist), frame="body")
    q = np.where(np.abs(q) < 1e-3, 0.0, q)  # below 1e-6 its exponential is the identity
    assert np.abs(space.fk(q) - mr.FKinSpace(M, Slist, q)).max() <= ROUNDING * chain.reach
    assert np.abs(body.fk(q) - mr.FKinBody(M, Blist, q)).max() <= ROUNDING * chain.reach


def test_one_screw_may_be_a_vector_and_the_home_pose_an_object():
    one = from_object([Spatial(np.eye(4)), [0, 0, 1, 0, 0, 0]], frame="space")
    assert one.screws.tolist() == [[0, 0, 1, 0, 0, 0]]


@pytest.mark.parametrize(
    ("pair", "frame", "error", "message"),
    [
        (
            (np.eye(4), np.zeros((3, 6))),
            "space",
            ShapeError,
            r"expected shape \(6, n\), .*got \(3, 6\): transpose it",
        ),
        (
            (np.eye(4), np.zeros((4, 4))),
            "space",
            ShapeError,
            r"expected shape \(6, n\), .*got \(4, 4\)$",
        ),
        ((np.eye(4), [[0, 0, 2, 0, 0, 0]] * 6), "space", ScrewError, r"screws\[0\]"),
        (
            (np.eye(4), np.tile([0, 0, 1, 0, 0, 0], (6, 1))),
            "space",
            ScrewError,
            r"its columns are unit screws, as in a Slist: pass screws\.T$",
        ),
        (
            (np.eye(6), np.eye(4)),
            "space",
            ShapeError,
            r"got \(4, 4\): the pair is \(M, screws\), in this order$",
        ),
        (
            (np.eye(4), np.eye(6)),
            REQUIRED,
            InputError,
            r"^frame: expected 'space' or 'body', it was left out; the screws are in the space frame in"
            r" Slist, in the body frame in Blist$",
        ),
        ((np.ones((4, 4)), np.eye(6)[:, 2:3]), "space", PoseError, r"home"),
        (
            (np.eye(4), np.eye(6)),
            "tool",
            InputError,
            r"frame: expected 'space' or 'body', got 'tool'",
        ),
    ],
    ids=[
        *("transposed", "two poses", "no unit screw", "six transposed", "swapped", "no frame"),
        *("no pose", "no such frame"),
    ],
)
def test_a_pair_that_makes_no_sense_is_refused(pair, frame, error, message):
    with pytest.raises(error, match=message):
        from_object(pair, frame=frame)


TRANSPOSED, SWAPPED = ": transpose it", ": the pair is (M, screws), in this order"


@pytest.mark.parametrize(
    ("shape", "home", "remedy"),
    [
        ((), (4, 4), ""),
        ((5,), (4, 4), ""),
        ((7,), (4, 4), ""),
        ((3, 6), (4, 4), TRANSPOSED),
        ((7, 6), (4, 4), TRANSPOSED),
        ((5, 7), (4, 4), ""),
        ((7, 5), (4, 4), ""),
        ((6, 2, 2), (4, 4), ""),
        ((2, 6, 2), (4, 4), ""),
        ((4, 4), (6,), SWAPPED),
        ((4, 4), (6, 3), SWAPPED),
        ((4, 4), (5, 3), ""),
        ((4, 4), (7, 3), ""),
        ((3, 3), (6, 3), ""),
        ((5, 5), (6, 3), ""),
    ],
)
def test_a_remedy_is_named_where_screws_are_rows_or_stand_before_the_home_pose(shape, home, remedy):
    with pytest.raises(ShapeError) as caught:
        from_object((np.zeros(home), np.zeros(shape)), frame="space")
    assert str(caught.value) == (
        "screws: expected shape (6, n), a column (omega; v) a joint as in Slist, got"
        f" {shape}{remedy}"
    )


@pytest.mark.parametrize(
    ("thing", "name"),
    [
        (3, "int"),
        ("arm.urdf", "str"),
        (np.eye(4), r"numpy\.ndarray"),
        ([], "list"),
        ((1, 2, 3), "tuple"),
        ({}, "dict"),
        (SimpleNamespace(links=[]), r"types\.SimpleNamespace"),
        (SimpleNamespace(links=3), r"types\.SimpleNamespace"),
    ],
    ids=["number", "text", "array", "list", "three", "dict", "no links", "links that are none"],
)
def test_what_is_not_known_is_refused_by_its_type_and_told_what_is(thing, name):
    message = rf"expected a Pinocchio Model, .*DHRobot, .*ETS, or Modern Robotics' pair \(M, Slist\), got {name};"
    with pytest.raises(InputError, match=message):
        from_object(thing)


@pytest.mark.parametrize("made", ["Robot", "Chain", "Table"])
def test_what_is_of_poekin_already_is_refused(made):
    table = pk.dh.published("puma560")
    models = {"Robot": pk.dh.to_robot(table), "Chain": pk.dh.to_chain(table), "Table": table}
    with pytest.raises(InputError, match=rf"this {made} is one of poekin already"):
        from_object(models[made])


@pytest.mark.parametrize("frame", ["body", None, np.eye(4)], ids=["a name", "None", "a matrix"])
def test_a_frame_is_that_of_a_pair(frame):
    joint = SimpleNamespace(isjoint=True, axis="Rz", A=None)
    with pytest.raises(
        InputError,
        match=r"^frame: it is that of a pair \(M, screws\), and this is a Robotics Toolbox ETS$",
    ):
        from_object([joint], frame=frame)


def test_no_other_library_is_imported_for_it():
    code = (
        "import sys, numpy as np; from poekin.formats.objects import from_object;"
        "from_object((np.eye(4), np.eye(6)[:, 2:3]), frame='space');"
        "print([m for m in ('pinocchio', 'roboticstoolbox', 'spatialmath', 'modern_robotics') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


# The documentation's lines *to* other libraries, executed as they stand there: what they need, the
# line, what it makes.
GIVEN = """
import numpy as np
import poekin as pk
arm = pk.load("ur5e").chain(tip="tool0")
q = np.array([0.3, -1.2, 1.5, -0.4, 0.7, 0.2])
T, J = arm.fk_jacobian(q, frame="hybrid")
"""
LINES = {
    "pinocchio": (
        "model = pinocchio.buildModelFromXML(pk.to_urdf(arm))",
        "frame = model.getFrameId(arm.tip); data = model.createData()\n"
        "pinocchio.framesForwardKinematics(model, data, q); found, expected = data.oMf[frame].homogeneous, T",
    ),
    "pinocchio motion": (
        "motion = pinocchio.Motion(pk.se3.linear_first(J[:, 0]))",
        "found, expected = np.append(motion.angular, motion.linear), J[:, 0]",
    ),
    "roboticstoolbox": (
        "table = pk.dh.from_chain(arm, convention='standard').table\n"
        "links = [roboticstoolbox.RevoluteDH(r.d, r.a, r.alpha, r.theta, r.limits, r.flip) for r in table.rows]\n"
        "robot = roboticstoolbox.DHRobot(links, base=SE3(table.base), tool=SE3(table.tool))",
        "found, expected = robot.fkine(q).A, T",
    ),
    "roboticstoolbox jacobian": (
        "table = pk.dh.from_chain(arm, convention='modified').table\n"
        "links = [roboticstoolbox.RevoluteMDH(r.d, r.a, r.alpha, r.theta, r.limits, r.flip) for r in table.rows]\n"
        "robot = roboticstoolbox.DHRobot(links, base=SE3(table.base), tool=SE3(table.tool))",
        "found, expected = robot.jacob0(q), pk.se3.linear_first(J, axis=-2)",
    ),
    "roboticstoolbox prismatic": (
        "table = pk.dh.published('stanford')\n"
        "links = [\n"
        "    roboticstoolbox.RevoluteDH(r.d, r.a, r.alpha, r.theta, r.limits, r.flip) if r.kind == 'revolute'\n"
        "    else roboticstoolbox.PrismaticDH(r.theta, r.a, r.alpha, r.d, r.limits, r.flip) for r in table.rows]\n"
        "robot = roboticstoolbox.DHRobot(links, base=SE3(table.base), tool=SE3(table.tool))",
        "found, expected = robot.fkine(q).A, pk.dh.to_chain(table).fk(q)",
    ),
    "modern_robotics": (
        "M, Slist = arm.home, arm.screws.T",
        "found, expected = modern_robotics.FKinSpace(M, Slist, q), T",
    ),
    "modern_robotics body": (
        "M, Blist = arm.body.home, arm.body.screws.T",
        "found, expected = modern_robotics.FKinBody(M, Blist, q), T",
    ),
    "spatialmath": ("pose = spatialmath.SE3(T)", "found, expected = pose.A, T"),
    "scipy": (
        "rotation = Rotation.from_matrix(T[:3, :3])",
        "found, expected = rotation.as_matrix(), T[:3, :3]",
    ),
}


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.parametrize("name", LINES)
def test_a_documented_line_to_another_library_makes_the_same_arm_there(name):
    package = name.split()[0]
    scope: dict[str, Any] = {package: library(package)}
    if package == "roboticstoolbox":
        scope["SE3"] = library("spatialmath").SE3
    if package == "scipy":
        scope["Rotation"] = library("scipy.spatial.transform").Rotation
    line, check = LINES[name]
    for code in (GIVEN, line, check):
        exec(code, scope)
    # Six joints, reach 1 m and a half; Pinocchio reads the roll, pitch and yaw of a text.
    np.testing.assert_allclose(scope["found"], scope["expected"], rtol=0, atol=1e-14)


def test_a_type_is_named_with_its_module_unless_it_is_built_in():
    for module in ("arms", "zoo.arms"):
        assert type_name(type("Arm", (), {"__module__": module})()) == f"{module}.Arm"
    assert [type_name(x) for x in (3, "text")] == ["int", "str"]
