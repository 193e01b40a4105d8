"""The oracle judged by itself: its Jacobians against finite differences of its poses, its mimics
against plain sums.
"""

from __future__ import annotations

import os
import sys
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import numpy as np
import pytest

from poekin.errors import InputError, MissingExtra, ModelError, UnknownName
from poekin.formats.text import xml
from poekin.testing.oracles import pinocchio_oracle, pinocchio_urdf
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle

URDF = """<robot name="r">
<link name="root"/><link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/>
<joint name="turn" type="continuous"><parent link="root"/><child link="a"/><origin xyz="0.1 0 0.3" rpy="0.2 0 1"/>
  <axis xyz="0.6 0 0.8"/></joint>
<joint name="slide" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/>
  <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
<joint name="bend" type="revolute"><parent link="b"/><child link="c"/><origin xyz="0 0.5 0"/><axis xyz="1 0 0"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="follow" type="revolute"><parent link="a"/><child link="d"/><origin xyz="0 0 0.2"/><axis xyz="1 0 0"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="bend" multiplier="-2" offset="0.1"/></joint>
<joint name="last" type="revolute"><parent link="d"/><child link="e"/><origin xyz="0 0.4 0.2"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="follow" multiplier="0.5" offset="1"/></joint>
</robot>"""

TWO_LINKS = """<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="continuous"><parent link="a"/>
<child link="b"/><origin xyz="1 2 3"/><axis xyz="0 0 1"/></joint></robot>"""


def test_elements_are_those_of_the_root_s_namespace_without_it():
    text = """<robot xmlns="http://ns" xmlns:o="http://other" o:key="1" name="r"><link name="a"/>
    <o:link name="b"><link name="c"/></o:link></robot>"""
    root = pinocchio_urdf.plain(xml.parse(text, "text", tell=False))
    assert (root.tag, dict(root.attrib)) == ("robot", {"name": "r"})
    assert [(element.tag, element.get("name")) for element in root] == [("link", "a")]


@pytest.fixture(scope="module")
def oracle() -> PinocchioOracle:
    return PinocchioOracle(URDF)


def _twist(dT, T):
    X = dT @ np.linalg.inv(T)
    return np.stack([X[:, 2, 1], X[:, 0, 2], X[:, 1, 0], X[:, 0, 3], X[:, 1, 3], X[:, 2, 3]], -1)


@pytest.mark.parametrize(
    ("base", "tip"),
    [(None, "c"), (None, "e"), ("root", "e"), ("c", "e"), ("e", "root"), ("b", "c")],
)
def test_jacobians_are_the_derivatives_of_the_poses(oracle, base, tip):
    q = oracle.random(np.random.default_rng(1), 5)
    T, J = oracle.evaluate(q, tip, base)
    h = 1e-6
    for k, name in enumerate(oracle.coordinates):
        ahead, behind = ({**q, name: q[name] + s * h} for s in (1, -1))
        dT = (oracle.poses(ahead, tip, base) - oracle.poses(behind, tip, base)) / (2 * h)
        space = _twist(dT, T)
        body = _twist(np.linalg.inv(T) @ dT, np.broadcast_to(np.eye(4), T.shape))
        hybrid = np.concatenate([space[:, :3], dT[:, :3, 3]], -1)
        for frame, expected in (("space", space), ("body", body), ("hybrid", hybrid)):
            np.testing.assert_allclose(J[frame][:, :, k], expected, rtol=0, atol=1e-8)


def test_a_base_that_is_the_root_changes_nothing(oracle):
    q = oracle.random(np.random.default_rng(2), 3)
    (T, J), (T_root, J_root) = oracle.evaluate(q, "e"), oracle.evaluate(q, "e", "root")
    np.testing.assert_array_equal(T, T_root)
    for frame, values in J.items():
        np.testing.assert_allclose(values, J_root[frame], rtol=0, atol=1e-15)


def test_mimics_compose_and_only_masters_are_coordinates(oracle):
    assert set(oracle.coordinates) == {"turn", "slide", "bend"}
    assert oracle.slides == {"slide"}
    by_hand = PinocchioOracle(_without_mimic(URDF))
    bend = np.array([0.3, -1.2])
    x = {
        "turn": 0.5,
        "slide": 0.2,
        "bend": bend,
        "follow": -2 * bend + 0.1,
        "last": 0.5 * (-2 * bend + 0.1) + 1,
    }
    x = {k: np.broadcast_to(v, 2) for k, v in x.items()}
    q = {k: x[k] for k in ("turn", "slide", "bend")}
    np.testing.assert_allclose(oracle.poses(q, "e"), by_hand.poses(x, "e"), rtol=0, atol=1e-15)


def _without_mimic(text: str) -> str:
    start = text.find("<mimic")
    return text if start < 0 else _without_mimic(text[:start] + text[text.index("/>", start) + 2 :])


def test_a_mimic_of_a_fixed_joint_is_constant_and_of_a_missing_one_independent():
    text = URDF.replace("continuous", "fixed").replace('joint="bend"', 'joint="nowhere"')
    oracle = PinocchioOracle(text.replace('joint="follow"', 'joint="turn"'))
    assert set(oracle.coordinates) == {"slide", "bend", "follow"}
    _, J = oracle.evaluate({"follow": np.array([0.4])}, "e")
    assert np.count_nonzero(np.abs(J["body"]).max((0, 1))) == 1


def test_without_a_degree_of_freedom_there_are_poses_and_empty_jacobians():
    oracle = PinocchioOracle(TWO_LINKS.replace("continuous", "fixed"))
    T, J = oracle.evaluate({}, "b")
    np.testing.assert_array_equal(T[:, :3, 3], [[1, 2, 3]])
    assert J["space"].shape == (1, 6, 0)


def test_a_floating_joint_stays_at_identity():
    text = URDF.replace('name="turn" type="continuous"', 'name="turn" type="floating"')
    oracle = PinocchioOracle(text)
    assert "turn" not in oracle.coordinates
    np.testing.assert_allclose(oracle.poses({}, "a")[0, :3, 3], [0.1, 0, 0.3], rtol=0, atol=1e-15)


def test_what_is_unknown_is_named(oracle):
    with pytest.raises(UnknownName, match="no coordinate 'bendd'; did you mean 'bend'"):
        oracle.poses({"bendd": 0.0}, "e")
    with pytest.raises(UnknownName, match=r"^Pinocchio has no link 'elbow'; available: '"):
        oracle.poses({}, "elbow")
    with pytest.raises(
        InputError,
        match=r"^values of one length for every coordinate expected, got lengths \[2, 3\]$",
    ):
        oracle.poses({"bend": np.zeros(2), "turn": np.zeros(3)}, "e")


def test_what_is_no_argument_is_refused(oracle):
    with pytest.raises(
        InputError, match=r"expected a URDF itself, not where it is: Path.* got 'arm\.urdf'$"
    ):
        PinocchioOracle("arm.urdf")
    with pytest.raises(
        InputError, match=r"q: expected a dict from coordinate to value\(s\), got \[0\.1\]"
    ):
        oracle.poses([0.1], "e")
    with pytest.raises(InputError, match=r"q: expected number\(s\) for 'bend', got 'up'"):
        oracle.poses({"bend": "up"}, "e")


def test_a_urdf_that_pinocchio_refuses_is_an_error():
    with pytest.raises(ModelError, match="Pinocchio refuses"):
        PinocchioOracle('<robot name="r"></robot>')
    with pytest.raises(ModelError, match="malformed XML"):
        PinocchioOracle("<robot")


def test_slips_of_a_text_are_not_told_a_second_time(recwarn):
    PinocchioOracle('\n<?xml version="0.0"?>' + URDF)
    assert not recwarn.list


def test_why_pinocchio_refuses_is_in_the_message_and_nowhere_else(capfd):
    with pytest.raises(
        ModelError,
        match=r"refuses this URDF: 'Joint \[j\] is of type REVOLUTE but it does not specify limits",
    ):
        PinocchioOracle(TWO_LINKS.replace("continuous", "revolute"))
    assert capfd.readouterr() == ("", "")


def test_joints_that_mimic_each_other_are_named():
    text = URDF.replace('joint="bend"', 'joint="last"')
    with pytest.raises(
        ModelError, match=r"the joints that mimic '(last|follow)' go round in a circle"
    ):
        PinocchioOracle(text)


def test_without_a_stderr_a_text_is_read_and_with_one_it_is_emptied_first(monkeypatch):
    flushed: list[int] = []
    monkeypatch.setattr(sys, "stderr", SimpleNamespace(flush=lambda: flushed.append(1)))
    PinocchioOracle(TWO_LINKS)
    assert flushed == [1]
    monkeypatch.setattr(sys, "stderr", None)
    assert PinocchioOracle(TWO_LINKS).coordinates == ("j",)


def test_where_stderr_is_closed_nothing_is_caught_from_it(monkeypatch):
    def closed(descriptor: int) -> int:
        raise OSError(f"{descriptor} is closed")

    with monkeypatch.context() as patch:
        patch.setattr(pinocchio_oracle.os, "dup", closed)
        patch.setattr(pinocchio_oracle.os, "dup2", None)
        found = PinocchioOracle(TWO_LINKS)
    assert found.coordinates == ("j",)


def test_a_continuous_joint_behind_another_one_is_one_angle():
    limits = '<limit lower="-3" upper="3" effort="1" velocity="1"/>'
    text = '<robot name="r"><link name="l0"/>'
    for k, kind in enumerate(("revolute", "continuous", "continuous")):
        text += f"""<link name="l{k + 1}"/><joint name="j{k}" type="{kind}"><parent link="l{k}"/>
            <child link="l{k + 1}"/><axis xyz="0 0 1"/>{limits if k == 0 else ""}</joint>"""
    T = PinocchioOracle(f"{text}</robot>").poses({"j0": 0.5, "j1": 0.25, "j2": -2.0}, "l3")[0]
    assert (T[0, 0], T[1, 0]) == pytest.approx((np.cos(-1.25), np.sin(-1.25)), abs=1e-15)


def test_a_mimic_follows_as_it_is_unless_it_says_how():
    text = URDF.replace(' multiplier="-2" offset="0.1"', "").replace(
        ' multiplier="0.5" offset="1"', ""
    )
    found, by_hand = PinocchioOracle(text), PinocchioOracle(_without_mimic(URDF))
    x: dict[str, float] = {"bend": 0.4, "follow": 0.4, "last": 0.4}
    np.testing.assert_allclose(
        found.poses({"bend": 0.4}, "e"), by_hand.poses(x, "e"), rtol=0, atol=1e-15
    )


def test_configurations_that_are_drawn_are_within_half_a_turn_and_a_metre(oracle):
    for name, values in oracle.random(np.random.default_rng(0), 400).items():
        most = 1.0 if name == "slide" else np.pi
        assert -most <= values.min() < -0.95 * most
        assert 0.95 * most < values.max() <= most


def test_stderr_is_its_own_again_after_many_threads_at_once(capfd):
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda _: PinocchioOracle(TWO_LINKS), range(40)))
    os.write(2, b"here")
    assert capfd.readouterr().err == "here"


def test_a_missing_pinocchio_is_named_with_its_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "pinocchio", None)
    pinocchio_oracle.pinocchio.cache_clear()
    message = (
        r"^validation against Pinocchio needs the package pin: pip install 'poekin\[validate\]'$"
    )
    with pytest.raises(MissingExtra, match=message):
        PinocchioOracle(URDF)
    pinocchio_oracle.pinocchio.cache_clear()


def test_one_degree_of_freedom_is_no_special_case():
    J = PinocchioOracle(TWO_LINKS).evaluate({"j": 0.5}, "b")[1]
    np.testing.assert_array_equal(J["space"], [[[0], [0], [1], [2], [-1], [0]]])
