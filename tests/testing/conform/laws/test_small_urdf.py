"""The URDFs that readers are tried on: poekin's reader, and Pinocchio, find in them what the
numbers say.
"""

from __future__ import annotations

import re
import warnings
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from benchmarks.subjects import Poekin
from poekin.errors import PoekinWarning
from poekin.formats.urdf import read_text
from poekin.testing.conform import Subject
from poekin.testing.conform.laws import small_urdf
from poekin.testing.conform.laws.law import Case
from poekin.testing.conform.laws.small_urdf import EACH, UrdfJoint, UrdfLayout, chain
from poekin.testing.conform.laws.urdf_cases import URDF_LAWS
from poekin.testing.oracles import exact, exact_chain
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle
from tests.testing.drawing import drawn
from tests.testing.small_tree import CASE, JOINTS, ROWS

SUBJECT = Subject(Poekin)


@pytest.mark.parametrize("law", URDF_LAWS, ids=lambda law: law.name)
def test_what_the_numbers_say_is_what_pinocchio_and_poekin_read(law):
    for case in drawn(law.cases(SUBJECT), 12):
        arm, q, names = small_urdf.arm(case)
        truth = exact.rounded(exact_chain.pose(arm, q))
        text = small_urdf.text(case)
        oracle = PinocchioOracle(text)
        given = {name: [value] for name, value in small_urdf.coordinates(case).items()}
        assert set(given) == set(oracle.coordinates)
        assert [given[name] for name in names] == [[value] for value in q]
        if law.needs == "read_robot":
            for k in range(len(small_urdf.rows_of(case))):
                own, values, _ = small_urdf.arm(case, k)
                found = oracle.poses(given, small_urdf.link(case, k), "base")[0]
                np.testing.assert_allclose(
                    found, exact.rounded(exact_chain.pose(own, values)), rtol=0, atol=1e-13
                )
        # The lengths go up to 3 m a joint, and more by 10 m that a joint may slide.
        np.testing.assert_allclose(oracle.poses(given, "tip", "base")[0], truth, rtol=0, atol=1e-13)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", PoekinWarning)
            chain = read_text(text).chain(base="base", tip="tip")
        np.testing.assert_allclose(
            chain.fk(dict(zip(names, q, strict=True))), truth, rtol=0, atol=1e-13
        )


def test_each_law_draws_what_its_name_says():
    def joints(name):
        law = next(law for law in URDF_LAWS if law.name == name)
        for case in drawn(law.cases(SUBJECT), 25):
            yield case, list(ElementTree.fromstring(small_urdf.text(case)).iter("joint"))

    assert all(
        joint.find("axis") is None for _, found in joints("urdf missing axis") for joint in found
    )
    assert all(
        sum(j.find("mimic") is not None for j in found) == 1 for _, found in joints("urdf mimic")
    )
    assert all(
        j.get("type") == "continuous" for _, found in joints("urdf continuous") for j in found
    )
    turned = [
        abs(value)
        for case, _ in joints("urdf continuous")
        for value in small_urdf.coordinates(case).values()
    ]
    assert max(turned) > np.pi
    for case, found in joints("robot mimic"):
        (master,) = [mimic.get("joint") for j in found for mimic in j.iter("mimic")]
        assert master not in [
            case.layout.joints[k].name for k in small_urdf.path(case, small_urdf.TIP)
        ]
    trees = [case.layout for case, _ in joints("robot")]
    assert all(tree.after != tuple(range(-1, len(tree.joints) - 1)) for tree in trees)
    assert len({tree.after for tree in trees}) > 3
    orders = {tuple(j.get("name") for j in found) for _, found in joints("urdf order")}
    assert len(orders) > 5
    lengths = [np.linalg.norm(case.numbers[:3]) for case, _ in joints("urdf long axis")]
    assert min(lengths) < 0.1
    assert max(lengths) > 10


LIMIT = '<limit lower="-10" upper="10" effort="1" velocity="1"/>'


def test_a_urdf_says_what_the_numbers_say_and_nothing_that_need_not_be_said():
    assert small_urdf.text(CASE) == "".join([
        '<robot name="small"><link name="base"/><link name="link1"/><link name="link2"/><link name="link3"/>',
        '<link name="link4"/><link name="tip"/>',
        '<joint name="j3" type="revolute"><parent link="link3"/><child link="link4"/>',
        f'<origin xyz="0 0 0" rpy="0.2 0 0"/><axis xyz="0 1 0"/>{LIMIT}',
        '<mimic joint="j0" multiplier="2" offset="0.25"/></joint>',
        '<joint name="j1" type="fixed"><parent link="link1"/><child link="link2"/><origin xyz="0 0 0.25"/></joint>',
        '<joint name="j0" type="revolute"><parent link="base"/><child link="link1"/>',
        f'<axis xyz="0 0 1"/>{LIMIT}</joint>',
        '<joint name="j2" type="prismatic"><parent link="base"/><child link="link3"/>',
        f'<origin xyz="0.5 0 0" rpy="0 0 0.1"/>{LIMIT}</joint>',
        '<joint name="j4" type="prismatic"><parent link="link2"/><child link="tip"/><origin xyz="0 0.75 0"/>',
        f'<axis xyz="0 0 -1"/>{LIMIT}<mimic joint="j2" multiplier="-1"/></joint></robot>',
    ])  # fmt: skip


@pytest.mark.parametrize("place", range(3, 9))
def test_an_origin_is_written_where_a_number_of_it_is_not_0(place):
    row = np.zeros(EACH)
    row[[2, place, 11]] = 1.0, 0.5, 2.0
    (origin,) = re.findall(
        r"<origin .*?/>", small_urdf.text(Case(row, chain((UrdfJoint("continuous", "a"),))))
    )
    three = [["0.5" if place == at + k else "0" for k in range(3)] for at in (3, 6)]
    rpy = f' rpy="{" ".join(three[1])}"' if place > 5 else ""
    assert origin == f'<origin xyz="{" ".join(three[0])}"{rpy}/>'


def test_a_follower_may_have_an_offset_alone_and_no_origin():
    rows = np.zeros((2, EACH))
    rows[:, 2], rows[0, 11], rows[1, 10] = 1.0, 0.5, -1.0
    twins = chain((UrdfJoint("continuous", "a"), UrdfJoint("continuous", "b", follows=0)))
    found = small_urdf.text(Case(rows.ravel(), twins))
    assert '<axis xyz="0 0 1"/><mimic joint="a" offset="-1"/></joint>' in found
    assert "origin" not in found
    assert "limit" not in found
    rows[1, 9] = 0.5
    assert '<mimic joint="a" multiplier="1.5" offset="-1"/>' in small_urdf.text(
        Case(rows.ravel(), twins)
    )


@pytest.mark.parametrize(
    ("k", "path", "coupling", "offset", "reach", "turned"),
    [
        (0, [0], [[1]], [0], 0, 1),
        (1, [0, 1], [[1]], [0], 0.25, 2),
        (2, [2], [[1]], [0], 0.5, 1.1),
        (3, [2, 3], [[0, 1], [2, 0]], [0, 0.25], 0.5, 2.3),
        (4, [0, 1, 4], [[1, 0], [0, -1]], [0, 0], 1, 3),
        (small_urdf.TIP, [0, 1, 4], [[1, 0], [0, -1]], [0, 0], 1, 3),
    ],
)
def test_the_arm_to_a_link_is_that_of_the_joints_before_it(
    k, path, coupling, offset, reach, turned
):
    assert small_urdf.path(CASE, k) == path
    arm, q, names = small_urdf.arm(CASE, k)
    assert np.array_equal(arm.coupling, coupling)
    assert np.array_equal(arm.offset, offset)
    assert (arm.reach, arm.turned, arm.dof) == (
        pytest.approx(reach),
        pytest.approx(turned),
        len(names),
    )
    every = {"j0": 0.5, "j2": -1.0}
    assert small_urdf.coordinates(CASE) == every
    assert names == (list(every) if len(coupling[0]) == 2 else ["j0" if k < 2 else "j2"])
    assert q.tolist() == [every[name] for name in names]


def test_links_are_called_by_the_place_of_their_joint():
    assert [small_urdf.link(CASE, k) for k in range(-1, 5)] == [
        "base",
        "link1",
        "link2",
        "link3",
        "link4",
        "tip",
    ]
    assert small_urdf.moving(CASE) == [0, 2]
    assert list(small_urdf.axes(CASE)) == [0, 12, 24, 36, 48]
    assert list(small_urdf.triples(CASE)) == [3, 6, 15, 18, 27, 30, 39, 42, 51, 54]


def test_a_simpler_case_has_a_joint_or_a_mimic_less_or_is_in_order():
    def without(k: int) -> list[list[float]]:
        return [row for j, row in enumerate(ROWS) if j != k]

    def free(k: int) -> tuple[list[list[float]], tuple[UrdfJoint, ...]]:
        rows = [[*row[:9], 0, 0, *row[11:]] if j == k else row for j, row in enumerate(ROWS)]
        return rows, tuple(
            joint._replace(follows=-1) if j == k else joint for j, joint in enumerate(JOINTS)
        )

    a, b, c, d, e = JOINTS
    order, after = (3, 1, 0, 2, 4), (-1, 0, -1, 2, 1)
    assert [
        (case.numbers.reshape(-1, EACH).tolist(), case.layout) for case in small_urdf.simpler(CASE)
    ] == [
        (without(1), UrdfLayout((a, c, d, e._replace(follows=1)), (2, 0, 1, 3), (-1, -1, 1, 0))),
        (without(3), UrdfLayout((a, b, c, e), (1, 0, 2, 3), (-1, 0, -1, 1))),
        (without(4), UrdfLayout((a, b, c, d), (3, 1, 0, 2), (-1, 0, -1, 2))),
        (free(3)[0], UrdfLayout(free(3)[1], order, after)),
        (free(4)[0], UrdfLayout(free(4)[1], order, after)),
        (ROWS, chain(JOINTS)),
        (ROWS, UrdfLayout(JOINTS, (0, 1, 2, 3, 4), after)),
        (ROWS, UrdfLayout((a, b, c._replace(axis=True), d, e), order, after)),
    ]
    assert not list(small_urdf.simpler(Case(np.array(ROWS[0]), chain((a,)))))
    twins = Case(np.array(ROWS[0] * 2), chain((a, a)))
    assert [case.layout for case in small_urdf.simpler(twins)] == [chain((a,))] * 2


@pytest.mark.parametrize(
    ("q", "multiplier", "offset", "allowed"),
    [(10.0, 0, 0, True), (-10.0, 0, 0, True), (10.1, 0, 0, False), (-10.1, 0, 0, False), (5.0, 1, 0, True),
     (5.0, 1, 0.25, False), (5.0, 1, -0.25, True), (-5.0, -3, 0.25, False), (9.9, -1, 9.9, True)],
)  # fmt: skip
def test_every_value_stays_within_the_limits(q, multiplier, offset, allowed):
    rows = np.zeros((2, EACH))
    rows[:, 2], rows[0, 11], rows[1, 9:11] = 1.0, q, (multiplier, offset)
    twins = chain((UrdfJoint("revolute", "a"), UrdfJoint("revolute", "b", follows=0)))
    assert small_urdf.allowed(Case(rows.ravel(), twins)) is allowed
    fixed = Case(np.array([*np.zeros(11), 11.0]), chain((UrdfJoint("fixed", "a"),)))
    assert small_urdf.allowed(fixed)
    assert not small_urdf.allowed(Case(np.zeros(0), UrdfLayout((), (), ())))


def test_a_value_is_the_multiplier_as_it_is_written_times_the_master_and_the_offset():
    x = [exact.rounded(factor).tolist() for factor in small_urdf.factors(CASE)]
    # j0; the origins of j1 and j4; j4, which slides along -z by -1 times -1
    assert x == [
        [0, 0, 0.5, 0, 0, 0],
        [0, 0, 0, 0, 0, 0.25],
        [0, 0, 0, 0, 0.75, 0],
        [0, 0, 0, 0, 0, -1.0],
    ]
    x = [exact.rounded(factor).tolist() for factor in small_urdf.factors(CASE, 3)]
    # xyz, then yaw, of j2; j2, whose axis is x where none is written; roll of j3; j3 turns by 2
    # times 0.5 and 0.25
    assert x == [[0, 0, 0, 0.5, 0, 0], [0, 0, 0.1, 0, 0, 0], [0, 0, 0, -1.0, 0, 0], [0.2, 0, 0, 0, 0, 0],
                 [0, 1.25, 0, 0, 0, 0]]  # fmt: skip
