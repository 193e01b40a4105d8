"""The libraries beside poekin: each computes the same arm; absent and broken ones are named, and
nothing else stops.
"""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from benchmarks import peers
from benchmarks.cases import compiled
from benchmarks.cases import peers as topic
from benchmarks.page import html, markdown
from benchmarks.peers.peer import Group, Kinematics, Peer
from poekin import se3
from tests.versions import needs

HOSTILE = '<script>alert("x")</script>\n| \x1b[31m $x$'
EVERY = peers.STANDARD | peers.OPTIONAL
ABOUT = {"when": "now", "commit": "c", "processor": "p", "cores": 2, "load": 0.0, "system": "s", "python": "3",
         "versions": {}}  # fmt: skip


@pytest.fixture(autouse=True)
def same_choice():
    yield
    peers.use(["standard"])


def usable(name: str) -> Peer:
    (found,) = peers.find([EVERY[name]])
    if found.problem:
        pytest.skip(f"{name} is {found.problem}")
    if name == "scipy":
        needs("scipy", "1.16")
    return found.peer


def arm(*kinds: str) -> pk.Chain:
    rng = np.random.default_rng(1)
    make = {"revolute": lambda: pk.screw.revolute(rng.normal(size=3), rng.normal(size=3)),
            "prismatic": lambda: pk.screw.prismatic(rng.normal(size=3))}  # fmt: skip
    return pk.Chain.from_space([make[kind]() for kind in kinds], se3.exp(rng.normal(size=6)))


ARMS = {
    "one joint": arm("revolute"),
    "a slide": arm("prismatic"),
    "mixed": arm("revolute", "prismatic", "revolute", "revolute"),
    "seven": arm(*["revolute"] * 7),
}
# A few roundings of numbers up to 10, and those of roll, pitch and yaw in the URDF.
# pytorch_kinematics rounds what it reads to float32, a unit of 6e-8: that times 7 joints times 10.
DIGITS = {"pytorch_kinematics": 5e-6}


def test_a_peer_whose_sources_warn_when_they_are_first_compiled_is_used(tmp_path, monkeypatch):
    (tmp_path / "odd_escape.py").write_text("text = '\\m'\nimport warnings\nwarnings.warn('old')\n")
    monkeypatch.syspath_prepend(tmp_path)
    (found,) = peers.find([Peer("odd", "numpy", "odd_escape", None, wrong)])
    assert found.problem == ""


@pytest.mark.parametrize("name", EVERY)
def test_exp_and_log_of_a_peer_are_those_of_poekin_in_order_and_meaning(name):
    peer = usable(name)
    if peer.group is None:
        assert name in ("mujoco", "pytorch_kinematics")
        return
    group = peer.group()
    xi = np.random.default_rng(0).normal(size=(4, 6)) / 2
    # Moderate angles, where every library has at least ten digits: what is compared is the order of
    # the numbers.
    np.testing.assert_allclose(group.exp_of(xi), se3.exp(xi), rtol=0, atol=1e-10)
    np.testing.assert_allclose(group.log_of(se3.exp(xi)), xi, rtol=0, atol=1e-10)


@pytest.mark.parametrize("which", ARMS)
@pytest.mark.parametrize("name", [name for name, peer in EVERY.items() if peer.kinematics])
def test_pose_and_jacobian_of_a_peer_are_those_of_the_chain(name, which):
    chain = ARMS[which]
    make = usable(name).kinematics
    assert make is not None
    k = make(peers.Arm(chain))
    q = np.random.default_rng(2).uniform(-1, 1, (3, chain.dof))
    native, atol = k.native(q), DIGITS.get(name, 1e-13)
    for i, x in enumerate(q):
        one = native[i : i + 1] if k.batch else native[i]
        np.testing.assert_allclose(
            np.reshape(k.pose(k.fk(one)), (4, 4)), chain.fk(x), rtol=0, atol=atol
        )
        if k.fk_jacobian is not None:
            T, J = k.arrays(*k.fk_jacobian(one))
            np.testing.assert_allclose(np.reshape(T, (4, 4)), chain.fk(x), rtol=0, atol=atol)
            J_own = chain.jacobian(x, k.frame)
            np.testing.assert_allclose(np.reshape(J, J_own.shape), J_own, rtol=0, atol=atol)


@pytest.mark.parametrize("name", ["robotics_toolbox", "mujoco", "modern_robotics"])
@pytest.mark.parametrize(
    ("chain", "words"),
    [
        (pk.Chain.from_space([[0, 0, 1, 0, 0, 0.1]], np.eye(4)), "helical"),
        (pk.Chain.from_space([[0, 0, 1, 0, 0, 0]], np.eye(4), offset=[0.5]), "without offset"),
        (
            pk.Chain.from_space([[0, 0, 1, 0, 0, 0]] * 2, np.eye(4), coupling=[[1.0], [1.0]]),
            "coordinate of its own",
        ),
    ],
    ids=["helical", "offset", "coupled"],
)
def test_an_arm_that_a_peer_cannot_have_is_refused(name, chain, words):
    make = usable(name).kinematics
    assert make is not None
    with pytest.raises(ValueError, match=words):
        make(peers.Arm(chain))


def broken(arm: peers.Arm) -> Kinematics:
    raise RuntimeError(HOSTILE)


def breaks_at_a_call(arm: peers.Arm) -> Kinematics:
    return Kinematics("hybrid", broken, broken)  # type: ignore[arg-type]


def wrong(arm: peers.Arm) -> Kinematics:
    chain = arm.chain
    return Kinematics("hybrid", chain.fk, lambda q: (chain.fk(q), chain.jacobian(q, "space")))


PLANTED = [
    Peer(HOSTILE, "numpy", "numpy", None, broken),
    Peer("late", "numpy", "numpy", None, breaks_at_a_call),
    Peer("missing", "no-such-distribution", "no_such_module", None, wrong),
    Peer("no module", "numpy", "numpy.no_such_module", None, wrong),
    Peer("wrong", "numpy", "numpy", None, wrong),
    Peer("group only", "numpy", "numpy", lambda: Group(se3.exp, se3.log, linear_first=False)),
]


@pytest.fixture(scope="module")
def planted():
    """The topic with nothing but planted peers."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(peers, "_chosen", PLANTED)
        patch.setattr(topic, "MANY", 100)
        patch.setattr(
            topic, "in_turn", lambda cases, **_: topic_in_turn(cases, rounds=1, slice_s=0.0)
        )
        return topic.topic(True, lambda _: None)


topic_in_turn = topic.in_turn


def test_broken_and_absent_peers_say_why_and_the_run_goes_on(planted):
    said = {row[0]: row[1] for row in planted.tables[0].rows}
    version = f" {np.__version__}"
    assert (
        said[HOSTILE + version]
        == 'broken: RuntimeError: <script>alert("x")</script> | \x1b[31m $x$'
    )
    assert said["late" + version].startswith("broken: RuntimeError")
    assert said["missing"] == "absent: not installed"
    assert said["no module" + version].startswith("broken: ModuleNotFoundError")
    assert said["group only" + version] == "has no kinematics of arms"
    assert [figure.value is None for figure in planted.figures] == [True, True, True, True, False]


def test_poekin_s_own_rows_are_exact_to_the_last_digits(planted):
    # Where arrays are reused, each result has to be judged before the next one is written over it.
    errors = [row[i] for row in planted.tables[0].rows[:3] for i in (3, 6, 8)]
    assert max(errors) < 1e-14


def test_a_peer_that_is_wrong_is_shown_to_be(planted):
    (figure,) = (f for f in planted.figures if f.what.startswith("wrong"))
    assert float(figure.error.split()[0]) > 0.1
    assert "(poekin" in figure.error


def test_hostile_words_of_a_peer_are_harmless_on_the_page_and_in_the_picture(planted):
    page = html([planted], ABOUT, 1.0)
    assert "<script>alert" not in page
    assert "\x1b" not in page + markdown([planted], ABOUT, 1.0)
    assert "poekin, compiled" in planted.pictures[0].svg


def test_a_hostile_label_is_no_markup_and_no_formula_in_a_picture():
    svg = topic.bars("c", {HOSTILE: {"<b>one</b>": 1.0, "many": None}}, x_label="time (µs)").svg
    assert not any(word in svg for word in ("<script", "<b>", "\x1b"))
    assert "$x$" in svg


def test_peers_are_chosen_by_name():
    peers.use(["all"])
    assert [found.peer.name for found in peers.chosen()] == [peer.name for peer in EVERY.values()]
    peers.use(["jaxlie", "scipy"])
    assert [found.peer.name for found in peers.chosen()] == ["SciPy", "jaxlie"]
    peers.use(["standard"])
    assert [found.peer.name for found in peers.chosen()] == [
        peer.name for peer in peers.STANDARD.values()
    ]


def test_pinocchio_s_rows_say_why_where_it_is_absent():
    absent = peers.Found(peers.STANDARD["pinocchio"], "absent: not installed")
    assert compiled._pinocchio(absent, None, None, None) == ([], [], "absent: not installed")  # type: ignore[arg-type]
    (figure,) = compiled._figures("w", None, [], 0.5, note="absent: not installed")  # type: ignore[arg-type]
    assert (figure.text, figure.verdict, figure.note) == (
        "not measured",
        False,
        "absent: not installed",
    )
