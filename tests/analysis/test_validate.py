"""Validation against Pinocchio: right robots pass, and every planted error fails, however small."""

from __future__ import annotations

import json
import math
import pickle
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from poekin.analysis.validate import BAR, ChainErrors, Validation, chain_errors, routes, validate
from poekin.errors import InputError, ModelError, PoekinWarning
from poekin.formats import urdf
from poekin.formats.content.robots import from_text
from poekin.formats.erd import example_robots
from poekin.formats.load import load
from poekin.formats.relink import relinked
from poekin.groups import se3
from poekin.model.chain import Chain
from poekin.model.joint import Joint
from poekin.model.robot import Robot
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle, pinocchio

URDF = """<robot name="r"><link name="root"/><link name="a"/><link name="b"/><link name="c"/><link name="tip"/>
<joint name="turn" type="continuous"><parent link="root"/><child link="a"/><origin xyz="0.1 0.2 0.3" rpy="0.2 0 1"/>
  <axis xyz="0.6 0 0.8"/></joint>
<joint name="slide" type="prismatic"><parent link="a"/><child link="b"/><origin rpy="1 0.3 0"/><axis xyz="0 1 0"/>
  <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
<joint name="bend" type="revolute"><parent link="b"/><child link="c"/><origin xyz="0 0.5 0"/><axis xyz="1 0 0"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="follow" type="revolute"><parent link="c"/><child link="tip"/><origin xyz="0 0 0.2"/><axis xyz="0 1 0"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="bend" multiplier="-2" offset="0.1"/></joint>
</robot>"""


@pytest.fixture(scope="module")
def oracle() -> PinocchioOracle:
    return PinocchioOracle(URDF)


@pytest.fixture(scope="module")
def chain() -> Chain:
    return urdf.read_text(URDF).chain()


@pytest.fixture(scope="module")
def q(oracle):
    return oracle.random(np.random.default_rng(0), 20)


def _with(chain: Chain, **changes: Any) -> Chain:
    data: dict[str, Any] = {
        n: getattr(chain, n)
        for n in (
            "screws",
            "home",
            "joint_names",
            "q_names",
            "limits",
            "coupling",
            "offset",
            "base",
            "tip",
        )
    }
    return Chain(**{**data, **changes}, frame="space")


def _add(array: np.ndarray, where: tuple[int, ...], amount: float) -> np.ndarray:
    array = array.copy()
    array[where] += amount
    return array


def test_a_right_chain_passes_in_pose_and_all_frames(chain, oracle, q):
    row = chain_errors(chain, oracle, q)
    assert 0 < row.worst <= BAR
    assert (row.base, row.tip, row.joints, row.dof) == ("root", "tip", 4, 3)


PLANTED = {
    "a screw's moment by 1e-12": lambda c: _with(c, screws=_add(c.screws, (2, 3), 1e-12)),
    "a screw's direction by 1e-12": lambda c: _with(c, screws=_add(c.screws, (0, 1), 1e-12)),
    "a slide's direction by 1e-12": lambda c: _with(c, screws=_add(c.screws, (1, 4), 1e-12)),
    "the home pose by 1e-12 m": lambda c: _with(c, home=_add(c.home, (0, 3), 1e-12)),
    "a mimic's multiplier by 1e-12": lambda c: _with(c, coupling=_add(c.coupling, (3, 2), 1e-12)),
    "a mimic's offset by 1e-12": lambda c: _with(c, offset=_add(c.offset, (3,), 1e-12)),
    "a mimic that is not honoured": lambda c: _with(c, coupling=_add(c.coupling, (3, 2), 2.0), offset=np.zeros(4)),
    "an axis the other way round": lambda c: _with(c, screws=c.screws * np.array([[-1], [1], [1], [1]])),
    "two coordinates exchanged": lambda c: _with(c, q_names=("bend", "slide", "turn")),
    "two joints exchanged": lambda c: _with(c, screws=c.screws[[0, 2, 1, 3]]),
    "another tip": lambda c: urdf.read_text(URDF).chain(tip="c").retooled(np.eye(4), tip="tip"),
    "a coordinate that does not exist": lambda c: _with(c, q_names=("turn", "slide", "bent")),
    "a joint that is missing": lambda c: _with(
        c, screws=c.screws[1:], joint_names=c.joint_names[1:], q_names=c.q_names[1:], limits=c.limits[1:],
        coupling=c.coupling[1:, 1:], offset=c.offset[1:],
    ),
}  # fmt: skip


@pytest.mark.parametrize("plant", PLANTED.values(), ids=PLANTED.keys())
def test_a_planted_error_fails(chain, oracle, q, plant):
    assert chain_errors(plant(chain), oracle, q).worst > BAR


class _Wrong:
    """A chain whose Jacobian of one frame is another one's."""

    def __init__(self, chain: Chain, wrong: Any, other: Any):
        self._chain, self._swap = chain, {wrong: other}

    def __getattr__(self, name):
        return getattr(self._chain, name)

    def jacobian(self, q, frame):
        return self._chain.jacobian(q, self._swap.get(frame, frame))


@pytest.mark.parametrize(
    ("wrong", "other"),
    [(a, b) for a in ("space", "body", "hybrid") for b in ("space", "body", "hybrid") if a != b],
)
def test_a_jacobian_of_the_wrong_frame_fails_in_that_frame_only(chain, oracle, q, wrong, other):
    row = chain_errors(_Wrong(chain, wrong, other), oracle, q)  # type: ignore[arg-type]
    bad = {frame for frame in ("space", "body", "hybrid") if getattr(row, frame) > BAR}
    assert bad == {wrong}
    assert row.pose <= BAR


@pytest.mark.parametrize("column", range(4))
def test_a_pose_is_judged_in_every_column_and_lengths_by_the_reach(column, chain, oracle, q):
    class Off(_Wrong):
        def fk(self, q):
            T = self._chain.fk(q)
            T[:, 0, column] += 1e-3
            return T

    expected = 1e-3 / (chain.reach if column == 3 else 1)
    assert chain_errors(Off(chain, "", ""), oracle, q).pose == pytest.approx(expected, rel=1e-9)  # type: ignore[arg-type]


@pytest.mark.parametrize("row", range(6))
@pytest.mark.parametrize("frame", ["space", "body", "hybrid"])
def test_a_jacobian_is_judged_in_every_row_and_linear_ones_by_the_reach(
    row, frame, chain, oracle, q
):
    class Off(_Wrong):
        def jacobian(self, q, named):
            J = self._chain.jacobian(q, named)
            J[:, row] += 1e-3 * (named == frame)
            return J

    expected = 1e-3 / (chain.reach if row >= 3 else 1)
    found = chain_errors(Off(chain, "", ""), oracle, q)  # type: ignore[arg-type]
    assert getattr(found, frame) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("base", ["root", "a", "b"])
def test_one_bad_configuration_among_good_ones_is_found_and_named(base, oracle, q):
    class Sick(_Wrong):
        def fk(self, q):
            T = self._chain.fk(q)
            T[7, 0, 0] = np.nan
            return T

    chain = urdf.read_text(URDF).chain(
        base=base, tip="tip"
    )  # of all coordinates, of the last two, and of the last
    row = chain_errors(Sick(chain, "", ""), oracle, q)  # type: ignore[arg-type]
    assert math.isnan(row.pose)
    assert row.worst == math.inf
    assert row.configuration == {name: q[name][7] for name in chain.q_names}
    assert (row.base, row.tip, row.dof) == (base, "tip", chain.dof)


def test_a_row_that_is_no_number_never_passes():
    row = ChainErrors("a", "b", 1, 1, 1.0, math.nan, 0.0, 0.0, 0.0)
    v = Validation("r", "", (row,), BAR, 1, 0, "")
    assert not v.passed
    assert json.loads(v.to_json())["chains"][0]["pose"] is None
    assert not Validation("r", "", (), BAR, 1, 0, "").passed


def test_a_validation_is_summed_up_by_its_largest_error_and_the_chains_that_fail():
    right = ChainErrors("a", "b", 1, 1, 1.0, 1e-15, 2e-15, 0.0, 0.0, note="starts below 'c'")
    wrong = ChainErrors("a", "d", 2, 2, 1.0, 0.0, 0.0, 3e-14, 0.0, {"x": 0.25, "y": -0.0})
    assert (right.passed, wrong.passed, replace(wrong, space=BAR, body=0.0).passed) == (
        True,
        False,
        True,
    )
    assert str(right) == "a → b is within 2e-15 R (starts below 'c')"
    off = "a → d is off by 3e-14 R; worst at x = 0.25, y = 0"
    assert wrong.summary() == off
    found = Validation("r", "", (right, wrong), BAR, 1, 0, "4.1")
    said = "r fails: 2 chains against Pinocchio 4.1, largest error 3e-14 R, the bar is 2e-14 R"
    assert str(found) == f"{said}\n{off}"
    assert str(replace(found, chains=(right,))).startswith("r passes: 1 chains against")
    document = found.to_dict()
    assert (document["passed"], document["error"]) == (False, 3e-14)
    assert [row["passed"] for row in document["chains"]] == [True, False]  # type: ignore[attr-defined]


def test_a_text_a_path_a_name_and_a_robot_are_validated_alike(tmp_path):
    path = tmp_path / "r.urdf"
    path.write_text(URDF)
    results = [validate(given, samples=5) for given in (URDF, path, str(path), load(path))]
    # not their errors: to the last bit these are the processor's
    rows = [
        [(row.base, row.tip, row.joints, row.dof, row.reach) for row in v.chains] for v in results
    ]
    assert rows == [rows[0]] * 4
    assert all(v.passed for v in results)
    assert validate("panda", samples=5).passed


def test_a_robot_with_coupled_readings_is_validated_by_its_joints():
    coupled = load("ur5e").coupled("elbow_joint = elbow_joint + shoulder_lift_joint")
    assert coupled.coupling
    assert validate(coupled, samples=3).passed


def test_the_same_seed_gives_the_same_result_and_another_one_another():
    first, again, other = (
        validate(URDF, samples=5),
        validate(URDF, samples=5),
        validate(URDF, samples=5, seed=1),
    )
    assert first == again
    assert first.chains[0].configuration != other.chains[0].configuration


def test_configurations_ignore_the_limits(oracle):
    q = oracle.random(np.random.default_rng(0), 1000)
    assert np.abs(q["bend"]).max() > 3
    assert 0.99 < np.abs(q["slide"]).max() <= 1


@pytest.mark.parametrize("kind", ["floating", "planar"])
def test_a_chain_starts_below_a_joint_that_it_cannot_cross(kind):
    text = URDF.replace('type="revolute"', f'type="{kind}"', 1)
    v = validate(text.replace('<mimic joint="bend" multiplier="-2" offset="0.1"/>', ""), samples=5)
    below, above = v.chains
    assert v.passed
    assert (below.base, below.tip, below.joints) == ("c", "tip", 1)
    assert below.note == f"starts below the {kind} joint 'bend'"
    assert (above.base, above.tip, above.joints) == ("root", "b", 2)
    assert above.note == f"ends above the {kind} joint 'bend'"


def _tree(*joints: tuple[Any, str, str]) -> Robot:
    """Joints (kind, parent, child), named by parent and child."""
    links = dict.fromkeys(link for _, parent, child in joints for link in (parent, child))
    return Robot(
        "t", links, [Joint(parent + child, kind, parent, child) for kind, parent, child in joints]
    )


def test_each_moving_joint_is_in_a_chain_and_no_chain_above_a_free_joint_is_idle():
    moving_above = _tree(("revolute", "a", "b"), ("floating", "b", "c"))
    assert list(routes(moving_above)) == [
        ("c", "c", "starts below the floating joint 'bc'"), ("a", "b", "ends above the floating joint 'bc'"),
    ]  # fmt: skip
    assert [way[:2] for way in routes(_tree(("fixed", "a", "b"), ("floating", "b", "c")))] == [
        ("c", "c")
    ]
    covered = _tree(("revolute", "a", "b"), ("floating", "b", "c"), ("revolute", "b", "d"))
    assert [way[:2] for way in routes(covered)] == [("c", "c"), ("a", "d")]
    nested = _tree(
        ("revolute", "a", "b"),
        ("floating", "b", "c"),
        ("prismatic", "c", "d"),
        ("planar", "d", "e"),
    )
    assert [way[:2] for way in routes(nested)] == [("e", "e"), ("a", "b"), ("c", "d")]
    assert [way[2] for way in routes(nested)][2] == (
        "starts below the floating joint 'bc', ends above the planar joint 'de'"
    )
    short_first = _tree(
        ("revolute", "a", "b"), ("floating", "b", "x"), ("revolute", "b", "c"), ("planar", "c", "y")
    )
    assert [way[:2] for way in routes(short_first)] == [("x", "x"), ("y", "y"), ("a", "c")]


def test_a_chain_without_a_joint_proves_nothing_about_a_robot_that_moves():
    idle, busy = (ChainErrors("a", "b", n, n, 1.0, 0.0, 0.0, 0.0, 0.0) for n in (0, 1))
    assert not Validation("r", "", (idle,), BAR, 1, 0, "", moving=1).passed
    assert Validation("r", "", (idle, busy), BAR, 1, 0, "", moving=1).passed
    assert Validation("r", "", (idle,), BAR, 1, 0, "", moving=0).passed


def test_the_oracle_reads_what_was_read_wherever_the_process_stands_by_then(tmp_path, monkeypatch):
    other = URDF.replace('xyz="0.1 0.2 0.3"', 'xyz="5 5 5"')
    for place in ("here", "there", "there/catalogue"):
        (tmp_path / place).mkdir()
    (tmp_path / "here" / "r.urdf").write_text(URDF)
    for shadow in ("there/r.urdf", "there/catalogue/panda.urdf", "there/panda"):
        (tmp_path / shadow).write_text(other)
    monkeypatch.chdir(tmp_path / "here")
    relative, built_in = load("r.urdf"), load("panda")
    monkeypatch.chdir(tmp_path / "there")
    assert validate(relative, samples=3).passed
    assert validate(built_in, samples=3).passed
    (tmp_path / "there" / "panda").unlink()
    assert validate("panda", samples=3).passed
    assert relative.source is not None
    assert relative.source.name == "r.urdf"
    assert validate(pickle.loads(pickle.dumps(relative)), samples=3).passed


def test_a_robot_out_of_a_text_that_is_called_like_a_file_is_not_read_from_that_file(tmp_path):
    path = tmp_path / "r.urdf"
    path.write_text(URDF)
    named_like_it = validate(
        urdf.read_text(URDF.replace('"turn"', '"twist"'), str(path)), samples=3
    )
    assert named_like_it.passed
    assert set(named_like_it.chains[0].configuration) == {"twist", "slide", "bend"}


ENCODED = {
    "ISO-8859-1": lambda t: ('<?xml version="1.0" encoding="ISO-8859-1"?>' + t).encode("latin-1"),
    "UTF-16": lambda t: ('<?xml version="1.0" encoding="UTF-16"?>' + t).encode("utf-16"),
    "UTF-8 with a mark": lambda t: ("\ufeff" + t).encode(),
    "a namespace": lambda t: t.replace("<robot ", '<robot xmlns="http://x" ').encode(),
    "a namespace with a prefix": lambda t: (
        t.replace("</", "</u:").replace("<", "<u:").replace("<u:/u:", "</u:")
        .replace("<u:robot ", '<u:robot xmlns:u="http://x" ').encode()
    ),
    "elements of another namespace": lambda t: (
        t.replace("</robot>", '<o:joint xmlns:o="http://o" name="turn"><mimic joint="b"/></o:joint></robot>').encode()
    ),
}  # fmt: skip


@pytest.mark.parametrize("encode", ENCODED.values(), ids=ENCODED.keys())
def test_any_encoding_and_namespace_that_xml_allows_is_validated(tmp_path, encode):
    path = tmp_path / "r.urdf"
    path.write_bytes(encode(URDF.replace('"bend"', '"b\xe9nd"')))
    v = validate(path, samples=3)
    assert v.passed
    assert (v.chains[0].joints, "b\xe9nd" in v.chains[0].configuration) == (4, True)


@pytest.mark.skipif(
    int(pinocchio().__version__.split(".")[0]) < 4, reason="an older Pinocchio reads no quaternion"
)
@pytest.mark.parametrize("quaternion", ["0 0 1 0", "0.5 -0.1 2 1", "0 0 0 -3"])
def test_a_quaternion_of_a_urdf_turns_as_pinocchio_says(quaternion):
    turned = URDF.replace("<robot ", '<robot version="1.1" ', 1)
    turned = re.sub('rpy="[^"]*"', f'quat_xyzw="{quaternion}"', turned, count=1)
    assert quaternion in turned
    assert validate(turned, samples=3).passed


def test_what_a_prefix_without_declaration_marks_is_passed_over_by_both():
    marked = URDF.replace("<robot ", '<robot a:b="1" ', 1)
    marked = marked.replace("</robot>", '<a:joint name="x"><a:axis/><axis/></a:joint></robot>')
    with pytest.warns(PoekinWarning, match="Namespace prefix a"):
        result = validate(marked, samples=3)
    assert result.passed


def test_progress_is_told_before_each_chain():
    told = []
    validate(URDF, samples=1, progress=lambda *words: told.append(words))
    assert told == [(0, 1, "tip")]


def test_a_robot_that_came_from_no_urdf_is_validated_by_the_text_that_it_is_written_as():
    v = validate("puma560", samples=3)
    assert v.passed
    assert v.moving == 6
    assert validate(Robot("r", ["a"], []), samples=3).passed
    with pytest.raises(InputError, match=r"helical joints, and these are: 'j'"):
        validate(Robot("r", ["a", "b"], [Joint("j", "helical", "a", "b", pitch=0.1)]))


def test_the_text_that_was_read_is_pinocchio_s_though_its_file_is_gone(tmp_path, monkeypatch):
    path = tmp_path / "r.urdf"
    path.write_text(URDF)
    robot = load(path)
    path.unlink()
    given = []

    def oracle(text):
        given.append(text)
        return PinocchioOracle(text)

    monkeypatch.setattr("poekin.analysis.validate.PinocchioOracle", oracle)
    assert validate(robot, samples=2).passed
    assert validate(from_text(URDF), samples=2).passed
    assert given == [URDF.encode(), URDF]


def test_a_robot_that_was_changed_since_it_was_read_is_validated_as_it_is():
    robot = urdf.read_text(URDF)
    chain = robot.chain(tip="tip")
    screws = chain.screws.copy()
    screws[0] = se3.adjoint(se3.exp([1e-3, 0, 0, 0, 1e-3, 0])) @ screws[0]
    changed = relinked(robot, chain.replace(screws=screws), tip="tip")
    assert changed != robot
    assert validate(changed, samples=2).passed


def test_fewer_than_no_samples_are_refused():
    with pytest.raises(InputError, match="samples"):
        validate(URDF, samples=-1)


@pytest.mark.filterwarnings("ignore::poekin.errors.PoekinWarning")
def test_every_root_to_leaf_chain_of_every_example_robot_is_taken():
    robots, empty = example_robots()
    loaded = [load(path) for path in robots.values()]
    chains = [robot.chain(base=base, tip=tip) for robot in loaded for base, tip, _ in routes(robot)]
    assert (len(robots), list(empty)) == (68, ["ur3"])
    assert len(chains) == 721
    assert sum(c.dof == 0 and not c.joint_names for c in chains) == 136
    assert max(len(c.joint_names) for c in chains) == 15


@pytest.mark.filterwarnings("ignore::poekin.errors.PoekinWarning")
@pytest.mark.parametrize("name", example_robots()[0])
def test_every_example_robot_passes(name):
    v = validate(f"erd:{name}", samples=5)
    assert v.passed, v.worst


def test_the_file_without_a_robot_is_refused():
    (path,) = example_robots()[1].values()
    with pytest.raises(ModelError, match="link"):
        load(path)


def test_what_a_chain_does_not_cross_is_said_whole():
    joints = [
        Joint("rail", "prismatic", "world", "cart"), Joint("fly", "floating", "cart", "body"),
        Joint("arm", "revolute", "body", "hand"), Joint("hop", "planar", "hand", "ball"),
        Joint("spin", "revolute", "ball", "tip"),
    ]  # fmt: skip
    robot = Robot("r", ["world", "cart", "body", "hand", "ball", "tip"], joints)
    assert list(routes(robot)) == [
        ("ball", "tip", "starts below the planar joint 'hop'"),
        ("world", "cart", "ends above the floating joint 'fly'"),
        (
            "body",
            "hand",
            "starts below the floating joint 'fly', ends above the planar joint 'hop'",
        ),
    ]


def test_samples_below_none_are_said_whole():
    with pytest.raises(InputError) as caught:
        validate("ur5e", samples=-1)
    assert str(caught.value) == "samples: expected a whole number from 0 on, got -1"


@pytest.mark.parametrize("samples", [0, 1, 4])
def test_the_zero_configuration_is_looked_at_and_as_many_random_ones_as_are_asked_for(
    samples, monkeypatch
):
    drawn, random = [], PinocchioOracle.random
    monkeypatch.setattr(
        PinocchioOracle, "random", lambda *arguments: drawn.append(random(*arguments)) or drawn[-1]
    )
    validate(URDF, samples=samples)
    (q,) = drawn
    for values in q.values():
        assert len(values) == samples + 1
        assert values[0] == 0
        assert (values[1:] != 0).all()


def test_a_tool_that_is_moved_alone_is_an_error_of_the_pose_by_the_arm_s_reach(chain, oracle, q):
    shift = np.eye(4)
    shift[:3, 3] = 1e-3, 0.0, 0.0
    moved = chain.retooled(shift)
    assert 0.3e-3 / moved.reach < chain_errors(moved, oracle, q).pose <= 1.001e-3 / moved.reach
