"""The URDFs that readers are tried on: poekin's reader, and Pinocchio, find in them what the numbers say."""

from __future__ import annotations

import warnings
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from benchmarks.subjects import Poekin
from poekin.errors import PoekinWarning
from poekin.formats.urdf import read_text
from poekin.testing import exact
from poekin.testing.conform import Subject, of_arms, small_urdf
from poekin.testing.conform.law import Case
from poekin.testing.conform.urdf_cases import URDF_LAWS
from poekin.testing.pinocchio_oracle import PinocchioOracle
from tests.testing.drawing import drawn

SUBJECT = Subject(Poekin)


@pytest.mark.parametrize("law", URDF_LAWS, ids=lambda law: law.name)
def test_what_the_numbers_say_is_what_pinocchio_and_poekin_read(law):
    for case in drawn(law.cases(SUBJECT), 12):
        arm, q, names = small_urdf.arm(case)
        truth = exact.rounded(of_arms.pose(arm, q))
        text = small_urdf.text(case)
        oracle = PinocchioOracle(text)
        given = {name: [value] for name, value in small_urdf.coordinates(case).items()}
        assert set(given) == set(oracle.coordinates)
        assert [given[name] for name in names] == [[value] for value in q]
        if law.needs == "read_robot":
            for k in range(len(small_urdf.rows_of(case))):
                own, values, _ = small_urdf.arm(case, k)
                found = oracle.poses(given, small_urdf.link(case, k), "base")[0]
                np.testing.assert_allclose(found, exact.rounded(of_arms.pose(own, values)), rtol=0, atol=1e-13)
        # The lengths go up to 3 m a joint, and more by 10 m that a joint may slide.
        np.testing.assert_allclose(oracle.poses(given, "tip", "base")[0], truth, rtol=0, atol=1e-13)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", PoekinWarning)
            chain = read_text(text).chain(base="base", tip="tip")
        np.testing.assert_allclose(chain.fk(dict(zip(names, q, strict=True))), truth, rtol=0, atol=1e-13)


def test_each_law_draws_what_its_name_says():
    def joints(name):
        law = next(law for law in URDF_LAWS if law.name == name)
        for case in drawn(law.cases(SUBJECT), 25):
            yield case, list(ElementTree.fromstring(small_urdf.text(case)).iter("joint"))

    assert all(joint.find("axis") is None for _, found in joints("urdf missing axis") for joint in found)
    assert all(sum(j.find("mimic") is not None for j in found) == 1 for _, found in joints("urdf mimic"))
    assert all(j.get("type") == "continuous" for _, found in joints("urdf continuous") for j in found)
    turned = [abs(value) for case, _ in joints("urdf continuous") for value in small_urdf.coordinates(case).values()]
    assert max(turned) > np.pi
    for case, found in joints("robot mimic"):
        (master,) = [mimic.get("joint") for j in found for mimic in j.iter("mimic")]
        assert master not in [small_urdf.layout_of(case).joints[k].name for k in small_urdf.path(case, small_urdf.TIP)]
    trees = [small_urdf.layout_of(case) for case, _ in joints("robot")]
    assert all(tree.after != tuple(range(-1, len(tree.joints) - 1)) for tree in trees)
    assert len({tree.after for tree in trees}) > 3
    orders = {tuple(j.get("name") for j in found) for _, found in joints("urdf order")}
    assert len(orders) > 5
    lengths = [np.linalg.norm(case.numbers[:3]) for case, _ in joints("urdf long axis")]
    assert min(lengths) < 0.1
    assert max(lengths) > 10


def test_a_case_of_something_else_is_refused():
    with pytest.raises(TypeError, match=r"a case of a URDF expected"):
        small_urdf.text(Case(np.zeros(12)))
