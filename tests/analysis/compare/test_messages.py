"""Sentences of a comparison name the joints and sizes that they are about."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare import messages
from poekin.analysis.compare.alignment.hypotheses import Hypothesis
from poekin.analysis.compare.compare import compare
from poekin.analysis.compare.comparison import JointComparison
from poekin.analysis.compare.messages import Said
from poekin.model.chain import Chain

UR = pk.load("ur5e").chain(tip="tool0")


def test_another_link_is_named_by_the_joints_at_both_of_its_ends():
    S = UR.screws.copy()
    S[3:] = (pk.se3.adjoint(pk.se3.exp([0, 0, 0, 0.01, 0.02, 0])) @ S[3:].T).T
    verdict = compare(
        UR, Chain.from_space(S, UR.home, joint_names=UR.joint_names), samples=1
    ).verdict
    names = UR.joint_names
    assert (
        f"the link between joint 3 ('{names[2]}') and joint 4 ('{names[3]}') differs: from joint 4 on"
        in verdict
    )


@pytest.mark.parametrize(
    "kind, words",
    [
        ("revolute", "a zero offset of 0.5°"),
        ("prismatic", "a zero offset of 8.727 mm"),
        ("helical", "a zero offset of 0.5°"),
    ],
)
def test_another_reading_says_the_size_of_its_zero_offset(kind, words):
    n, k, zero = 3, 1, np.radians(0.5)
    z, p = [0, 0, 1], [0, 0, 0]
    make = {"revolute": pk.screw.revolute, "prismatic": lambda z, p: pk.screw.prismatic(z),
            "helical": lambda z, p: pk.screw.helical(z, p, 0.1)}  # fmt: skip
    joint = make[kind](z, p)
    chain = Chain.from_space(
        [pk.screw.revolute([1, 0, 0], [0, 0, 0]), joint, pk.screw.revolute([0, 1, 0], [0, 0, 0])],
        np.eye(4),
    )
    marks, ones = np.zeros(n, bool), np.ones(n)
    same = Hypothesis(
        np.eye(4), np.eye(4), np.zeros(n), ones, marks, marks, chain.screws, np.zeros(n), 0
    )
    other = replace(same, zeros=zero * (np.arange(n) == k), offset=np.arange(n) == k)
    (sentence,) = messages.equivalents(
        chain, chain, range(1, n + 1), same, [other], Tolerances(1e-5, 1e-5)
    )
    assert sentence.startswith(f"{words} of joint 2 ('joint2'), ")


TURNS = JointComparison(
    2, "arm", "b2", "revolute", "revolute", 0.0, 0.0, 0.0, 0.0, False, (0.0, 0.0), False, False,
    "", "", False, 0.0, (0.0, 0.0),
)  # fmt: skip

TOL = Tolerances(1e-5, np.radians(1e-3))


def in_si(joint: JointComparison, **changes: Any) -> JointComparison:
    """The joint with changes that are given in mm and degrees."""
    angles = {"angle"} | ({"zero_offset"} if joint.unit == "rad" else set())
    lengths = {"normal", "shift", "zero_offset"} - angles
    for name, value in changes.items():
        if name in angles:
            changes[name] = np.radians(value)
        elif name in lengths:
            changes[name] = value / 1e3
    return replace(joint, **changes)


SLIDES = replace(TURNS, kind_a="prismatic", kind_b="prismatic", normal=None, shift=None)


@pytest.mark.parametrize("joint, changes, words", [
    (TURNS, {}, ""),
    (TURNS, {"kind_b": "prismatic", "axis_differs": True, "angle": 3.0, "reversed": True},
     "is revolute in one model and prismatic in the other"),
    (TURNS, {"axis_differs": True, "angle": 0.5, "normal": 3.25, "shift": 7.0},
     "has an axis that is 0.5° and 3.25 mm from the other model's (7 mm at the arm)"),
    (TURNS, {"axis_differs": True, "angle": 0.5, "normal": 3.25, "shift": 0.01},
     "has an axis that is 0.5° and 3.25 mm from the other model's"),
    (TURNS, {"axis_differs": True, "angle": 0.5, "normal": 0.01, "shift": 0.011},
     "has an axis that is turned by 0.5° from the other model's (0.011 mm at the arm)"),
    (SLIDES, {"axis_differs": True, "angle": 0.5}, "has an axis that is turned by 0.5° from the other model's"),
    (TURNS, {"axis_differs": True, "angle": 0.001, "normal": 3.0, "shift": 12.34567},
     "has an axis that is 12.35 mm from the other model's"),
    (TURNS, {"axis_differs": True, "angle": 0.001, "normal": 0.01, "shift": 0.01}, "has another pitch"),
    (SLIDES, {"axis_differs": True}, "has another pitch"),
    (TURNS, {"zero_differs": True, "zero_offset": -5.7}, "has its zero 5.7° elsewhere"),
    (SLIDES, {"zero_differs": True, "zero_offset": 5.7}, "has its zero 5.7 mm elsewhere"),
    (TURNS, {"reversed": True}, "has the sign of q flipped"),
    (TURNS, {"coupling_differs": True, "follows_a": "follows 2 × 'x'"},
     "follows 2 × 'x' in one model and moves by itself in the other"),
    (TURNS, {"coupling_differs": True, "follows_b": "does not move"},
     "moves by itself in one model and does not move in the other"),
    (TURNS, {"zero_differs": True, "zero_offset": 1.0, "reversed": True},
     "has its zero 1° elsewhere and has the sign of q flipped"),
])  # fmt: skip
def test_what_differs_in_a_joint_is_said_whole(joint, changes, words):
    assert messages.joint_words(in_si(joint, **changes), TOL) == words


def test_joints_that_differ_are_named_by_number_and_the_first_model_s_name():
    joints = tuple(
        in_si(TURNS, number=k + 1, name_a=f"a{k + 1}", axis_differs=k > 1, angle=1.0 + k)
        for k in range(4)
    )
    axis = "has an axis that is turned by {}° from the other model's"
    two = [f"joint 3 ('a3') {axis.format(3)}", f"joint 4 ('a4') {axis.format(4)}"]
    assert messages.joint_findings(joints, TOL, Said()) == two
    for link in (1, 2):
        (sentence,) = messages.joint_findings(joints, TOL, Said(), link)
        assert sentence == (
            f"the link between joint {link} ('a{link}') and joint {link + 1} ('a{link + 1}') differs: from joint 3 on "
            f"the axes have moved together, and joint 3 {axis.format(3)}"
        )
    coupled = (*joints[:3], replace(joints[3], axis_differs=False, coupling_differs=True))
    _, fourth = messages.joint_findings(coupled, TOL, Said(), 2)
    assert fourth == "joint 4 ('a4') moves by itself in one model and moves by itself in the other"


@pytest.mark.parametrize("xi, words", [
    ([0, 0, 0, 0, 0.012, 0], "the tool frame is moved by 12 mm"),
    ([0, np.radians(3), 0, 0, 0, 0], "the tool frame is turned by 3°"),
    ([0, np.radians(3), 0, 0, 0.012, 0], "the tool frame is moved by 12 mm and turned by 3°"),
    ([0, 0.9e-3, 0, 0.9e-5, 0, 0], ""),
    ([0, 1.1e-3, 0, 0.9e-5, 0, 0], "the tool frame is turned by 0.06303°"),
    ([0, 0.9e-3, 0, 1.1e-5, 0, 0], "the tool frame is moved by 0.011 mm"),
])  # fmt: skip
def test_how_a_frame_moved_is_said_in_mm_and_degrees_beyond_tolerance(xi, words):
    assert messages.frame_words("tool", pk.se3.exp(xi), Tolerances(1e-5, 1e-3)) == words


def test_the_model_with_longer_lengths_is_the_larger_one():
    assert messages.unit_words(1000.0).startswith(
        "lengths of model b are 1000 times those of model a ("
    )
    assert messages.unit_words(0.001).startswith(
        "lengths of model a are 1000 times those of model b ("
    )


def two_ends(kind):
    make = {
        "prismatic": pk.screw.prismatic,
        "revolute": lambda z: pk.screw.revolute(z, [0.1, 0.2, 0]),
        "helical": lambda z: pk.screw.helical(z, [0.1, 0.2, 0], 0.05),
    }[kind]
    rows = [make([0, 0, 1.0]), pk.screw.revolute([0, 1, 0], [0.3, 0, 0]), make([1.0, 0, 0])]
    return Chain.from_space(
        rows, pk.se3.exp([0.3, 0.2, 0.1, 1, 0, 0]), joint_names=["first", "mid", "last"]
    )


@pytest.mark.parametrize("kind, size, far", [
    ("revolute", 0.1, "5.73°"), ("revolute", -np.pi, "180°"), ("prismatic", -0.25, "-250 mm"),
    # just beyond half a turn, where the logarithm turns the other way about
    ("helical", np.pi + 1e-9, "180°"), ("helical", -np.pi - 1e-9, "180°"),
])  # fmt: skip
@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_a_frame_moved_along_or_about_an_end_joint_is_its_zero_offset(kind, size, far, direction):
    chain, marks = two_ends(kind), np.zeros(3, bool)
    same = Hypothesis(
        np.eye(4), np.eye(4), np.zeros(3), np.ones(3), marks, marks, chain.screws, np.zeros(3), 1
    )
    base = pk.se3.exp(direction * chain.screws[0] * size)
    tool = pk.se3.exp(pk.se3.adjoint(pk.se3.inverse(chain.home)) @ chain.screws[-1] * size)

    def said(**changes):
        words = messages.equivalents(
            chain, chain, (1, 2, 3), replace(same, **changes), [], Tolerances(1e-6, 1e-6)
        )
        return [line.replace("-180", "180") for line in words]

    def expected(what, number, name):
        return [f"the {what} moved by {far} along or about the axis of joint {number} ('{name}') is the same as a zero "
                f"offset of {far} of that joint"]  # fmt: skip

    assert said() == []
    assert said(base=base, directions=np.array([direction, 1, 1])) == expected("base", 1, "first")
    assert said(tool=tool) == expected("tool", 3, "last")
    for slip in ([0, 0, 0, 0, 2e-6, 0], [0, 2e-6, 0, 0, 0, 0]):
        assert said(base=pk.se3.exp(slip) @ base) == []


def test_a_moved_frame_has_the_unit_of_its_own_end_joint():
    turn, slide = pk.screw.revolute([0, 0, 1], [0.1, 0, 0]), pk.screw.prismatic([1, 0, 0])
    for rows, base, tool in (
        ([turn, slide], "5.73°", "100 mm"),
        ([slide, turn], "100 mm", "5.73°"),
    ):
        chain = Chain.from_space(rows, np.eye(4))
        marks = np.zeros(2, bool)
        moved = Hypothesis(
            pk.se3.exp(0.1 * rows[0]), pk.se3.exp(0.1 * rows[1]), np.zeros(2), np.ones(2), marks, marks,
            chain.screws, np.zeros(2), 2,
        )  # fmt: skip
        first, last = messages.equivalents(chain, chain, (1, 2), moved, [], Tolerances(1e-6, 1e-6))
        assert first.startswith(f"the base moved by {base} along")
        assert last.startswith(f"the tool moved by {tool} along")


def test_other_readings_say_which_joint_is_to_blame_instead_and_for_what():
    chain, ones, nothing = two_ends("revolute"), np.ones(3), np.zeros(3, bool)
    at = np.arange(3) == 2
    same = Hypothesis(
        np.eye(4), np.eye(4), np.zeros(3), ones, nothing, nothing, chain.screws, np.zeros(3), 0
    )
    others = [
        replace(same, moved=at), replace(same, directions=np.where(at, -1.0, 1.0)),
        replace(same, zeros=0.1 * at, offset=at), replace(same, zeros=0.1 * at, offset=at, moved=at),
    ]  # fmt: skip
    end = " of joint 3 ('last'), with the base and tool frames aligned to that, explains it as well"
    assert messages.equivalents(chain, chain, (1, 2, 3), same, others, Tolerances(1e-6, 1e-6)) == [
        f"{words}{end}" for words in ("another axis", "the other direction", "a zero offset of 5.73°",
                                      "another axis of 5.73°")
    ]  # fmt: skip


def test_another_explanation_has_its_zero_offset_in_b_whichever_model_that_is():
    rows = [
        pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.prismatic([1, 0, 0]),
        pk.screw.revolute([0, 1, 0], [0.5, 0, 0.3]),
    ]  # fmt: skip
    one = Chain.from_space(rows, np.eye(4))
    rows[0] = pk.screw.revolute([0, 0, 1], [0.05, 0, 0])
    other = Chain.from_space(rows, np.eye(4))
    for a, b, offset in ((one, other, "50 mm"), (other, one, "-50 mm")):
        said = compare(a, b, samples=1).alternatives
        (words,) = (text for text in said if text.startswith("a zero offset"))
        assert words.startswith(f"a zero offset of {offset} of joint 2 ('joint2'), with the base")


def test_other_readings_name_joints_as_the_first_model_does():
    other = UR.rezeroed([0.1, 0, 0, 0, 0, 0]).replace(joint_names=list("abcdef"), limits=UR.limits)
    (sentence,) = compare(UR, other, samples=1).alternatives
    assert f"the axis of joint 1 ('{UR.joint_names[0]}')" in sentence


def test_the_verdict_says_what_is_the_same_what_differs_and_what_was_aligned():
    base, tool = pk.se3.exp([0, 0, np.radians(10), 0, 0, 0]), pk.se3.exp([0, 0, 0, 0.05, 0, 0])
    S = UR.screws.copy()
    S[2, 3:] += np.cross([0, 0, 0.003], S[2, :3])
    bent = UR.replace(screws=S)
    name = UR.joint_names[2]
    third = f"joint 3 ('{name}') has an axis that is 3 mm from the other model's: "

    def said(b, **options):
        return compare(UR, b, samples=1, **options).verdict

    assert said(UR) == said(UR, strict=True) == "the models are the same"
    other = "the models are the same arm in other conventions"
    head, turned, moved = said(UR.rebased(base).retooled(tool)).split("; ")
    assert head == other
    assert turned.startswith("aligned: the base frame is turned by 10°: ")
    assert turned.endswith(" mm at the tool")
    assert moved == "aligned: the tool frame is moved by 50 mm"
    assert said(bent).startswith(f"the models differ; {third}")
    assert said(bent.retooled(tool)) == f"{said(bent)}; aligned: the tool frame is moved by 50 mm"
    assert said(bent, strict=True) == said(bent)
    assert said(UR.retooled(tool), strict=True) == f"{other}; the tool frame is moved by 50 mm"
    both = said(UR.rebased(base).retooled(tool), strict=True)
    assert both == "; ".join([head, turned, moved]).replace("aligned: ", "")
    free = said(UR.retooled(tool), same=("base", "zeros"))
    may = "the models are the same but for what may differ"
    assert free == f"{may}; aligned: the tool frame is moved by 50 mm"
    zero = said(UR.rezeroed([0, 0, 0.1, 0, 0, 0]))
    assert zero.startswith(f"{other}; joint 3 ('{name}') has its zero 5.73° elsewhere: ")


@pytest.mark.parametrize("limits, words", [
    ((0.1, 0.0), "has its lower limit 5.73° higher in model b"),
    ((0.0, -0.1), "has its upper limit 5.73° lower in model b"),
    ((-0.1, 0.1), "has its lower limit 5.73° lower in model b and its upper limit 5.73° higher in model b"),
    ((math.inf, -math.inf), "has a lower limit in model b alone and a upper limit in model b alone"),
    ((-math.inf, 0.0), "has a lower limit in model a alone"),
    ((0.0, math.inf), "has an upper limit in model a alone"),
])  # fmt: skip
def test_limits_are_said_by_how_much_and_in_which_model(limits, words):
    words = words.replace("a upper", "an upper")
    assert messages.limit_words(replace(TURNS, limits=limits)) == words


def test_limits_and_names_are_said_where_they_count():
    joint = replace(TURNS, name_a="j\n1", limits=(0.0, 0.1))
    assert messages.joint_findings((joint,), TOL, Said()) == []
    limits = Said(frozenset([2]))
    (words,) = messages.joint_findings((joint,), TOL, limits)
    assert words == "joint 2 ('j\\n1') has its upper limit 5.73° higher in model b"
    both = limits._replace(names=True)
    (words,) = messages.joint_findings((replace(joint, reversed=True, effect=0.1),), TOL, both)
    assert words == (
        "joint 2 ('j\\n1') has the sign of q flipped: 100 mm at the tool, and has its upper limit 5.73° higher in "
        "model b, and is called 'b2' in model b"
    )
    same = replace(joint, name_b="j\n1")
    assert messages.joint_findings((same,), TOL, Said(names=True)) == []


@pytest.mark.parametrize("effect, words", [
    (0.0, ""), (0.9e-5, ""), (1.1e-5, ": 0.011 mm at the tool"), (0.00994, ": 9.9 mm at the tool"),
    (0.01, ": 10 mm at the tool"), (0.06443, ": 64 mm at the tool"), (1.234, ": 1234 mm at the tool"),
    (math.nan, ""),
])  # fmt: skip
def test_an_effect_is_said_in_whole_mm_or_two_digits(effect, words):
    joint = replace(TURNS, reversed=True, effect=effect)
    (found,) = messages.joint_findings((joint,), TOL, Said())
    assert found == f"joint 2 ('arm') has the sign of q flipped{words}"
    frame = messages.frame_words("base", pk.se3.exp([0, 0, 0, 1, 0, 0]), TOL, effect)
    assert frame == f"the base frame is moved by 1000 mm{words}"


def test_behind_another_link_only_what_differs_by_itself_is_said():
    joints = tuple(
        in_si(TURNS, number=k + 1, name_a=f"a{k + 1}", axis_differs=k > 1, angle=1.0 + k)
        for k in range(5)
    )
    link, fifth = messages.joint_findings(joints, TOL, Said(apart=frozenset([3, 5])), 2)[::2]
    assert "from joint 4 on" in link
    assert fifth.startswith("joint 5 ('a5') has an axis that is turned by 5°")
    reversed_too = (*joints[:4], replace(joints[4], reversed=True))
    _, fifth = messages.joint_findings(reversed_too, TOL, Said(), 2)
    assert fifth == "joint 5 ('a5') has the sign of q flipped"


def test_a_zero_of_the_first_joint_behind_another_link_is_said_once():
    joints = tuple(in_si(TURNS, number=k, axis_differs=k > 1, angle=1.0) for k in (1, 2, 3))
    zero = in_si(joints[1], zero_differs=True, zero_offset=5.0)
    link, second = messages.joint_findings((joints[0], zero, joints[2]), TOL, Said(), 1)
    assert link.endswith("joint 2 has an axis that is turned by 1° from the other model's")
    assert second == "joint 2 ('arm') has its zero 5° elsewhere"


@pytest.mark.parametrize("kind, moved, said", [
    ("prismatic", False, True), ("prismatic", True, False), ("revolute", False, False),
    ("helical", False, False),
])  # fmt: skip
@pytest.mark.parametrize("k", [1, 2])
def test_a_link_in_front_of_a_slide_that_did_not_move_may_be_the_one_behind_it(
    k, kind, moved, said
):
    rows = [screw_of("revolute")] * 4
    rows[k] = screw_of(kind)
    chain = Chain.from_space(rows, np.eye(4), joint_names=["a", "b", "c", "d"])
    at, none = (np.arange(4) == k) & moved, np.zeros(4, bool)
    linked = Hypothesis(
        np.eye(4), np.eye(4), np.zeros(4), np.ones(4), at, none, chain.screws, np.zeros(4), 0, k
    )
    sentence = f"the link behind joint {k + 1} ('{'abcd'[k]}'), which slides, explains it as well"
    assert messages.equivalents(chain, chain, range(1, 5), linked, [], TOL) == [sentence] * said
    assert messages.equivalents(chain, chain, range(1, 5), replace(linked, link=0), [], TOL) == []


def screw_of(kind):
    if kind == "prismatic":
        return pk.screw.prismatic([0, 0, 1])
    return pk.screw.helical([0, 0, 1], [1, 0, 0], 0.1 * (kind == "helical"))


def test_what_was_aligned_and_the_mistakes_are_said():
    assert messages.alignment_words("agreeing axes") == "aligned"
    assert messages.alignment_words("nothing") == "aligned"
    assert "to all axes by least squares" in messages.alignment_words("all axes")
    assert messages.mirror_words("y").startswith("model b is a mirrored: y of its base is -y of")
    assert messages.degree_words("a").startswith("links of model a turn by as many radians")
