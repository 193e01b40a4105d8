"""`count` and `count_table`: every column by its formula in n, and that what is counted computes
the Jacobian.
"""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.analysis.counting import count_methods, count_scalars
from poekin.analysis.counting import count_table as tables
from poekin.analysis.counting.count import METHODS, Count
from poekin.analysis.counting.count_table import PRINTED, count_table, printed

JOINTS = range(2, 13)


def arm(kinds, seed=0, **options):
    """A chain without any structure: one letter a joint, r, p or h."""
    rng = np.random.default_rng(seed)
    make = {
        "r": lambda: pk.screw.revolute(*rng.normal(size=(2, 3))),
        "p": lambda: pk.screw.prismatic(rng.normal(size=3)),
        "h": lambda: pk.screw.helical(*rng.normal(size=(2, 3)), pitch=0.1),
    }
    return pk.Chain.from_space(
        [make[kind]() for kind in kinds], pk.se3.exp(rng.normal(size=6)), **options
    )


def numbers(cost):
    return cost.multiplications, cost.additions


def counts(chain, method, frame, charged, pose=False):
    return numbers(pk.count(chain, method=method, frame=frame, counting=charged, pose=pose))


# Multiplications and additions of J alone, from 3 joints on; at 2 joints no product is there to
# leave something out.
NEEDED = {
    ("direct", "space", "live"): (60, -96, 45, -72),
    ("direct", "body", "live"): (60, -96, 45, -72),
    ("recursive", "body", "live"): (42, -81, 30, -60),
    ("recursive_by_cross", "body", "live"): (39, -75, 27, -54),
    ("recursive_with_tool", "body", "live"): (42, -45, 30, -33),
    ("recursive_general_frames", "body", "live"): (60, -96, 45, -72),
    ("dh_recursive", "body", "live"): (42, -3, 30, -3),
    ("dh_paul", "body", "live"): (42, -39, 30, -30),
    ("dh_modified", "body", "live"): (42, -81, 30, -60),
    ("structured", "body", "live"): (36, -72, 21, -45),
    # 15 + 13 for each of n - 1 exponentials
    ("direct", "space", "everything"): (60 + 15, -96 - 15, 45 + 13, -72 - 13),
    ("direct", "body", "everything"): (60 + 15, -96 - 15, 45 + 13, -72 - 13),
}
# From q on, in general link frames and on DH frames, whose constants have zeros.
EVERYTHING = {
    "recursive": (54, -101, 36, -67),
    "recursive_with_tool": (54, -69, 36, -39),
    "dh_modified": (42, -86, 26, -56),
    "dh_recursive": (44, -20, 26, -7),
}
# The pose takes two products more of the direct method, one of the recursions, none where they have
# it anyway.
WITH_POSE = {
    ("direct", "body", "paper"): (60, -24, 45, -18),
    ("recursive", "body", "paper"): (42, -42, 30, -30),
    ("recursive_with_tool", "body", "paper"): (42, -6, 30, -3),
    ("recursive_by_cross", "body", "paper"): (39, -39, 27, -27),
    ("dh_recursive", "body", "live"): (42, 0, 30, 0),
    ("dh_paul", "body", "live"): (42, -36, 30, -27),
    # 15 + 13 for each of n exponentials, 12 + 6 for each moved link
    ("direct", "space", "everything"): (60 + 15, -24, 45 + 13, -18),
}


@pytest.mark.parametrize("n", JOINTS)
@pytest.mark.parametrize("way", NEEDED, ids="-".join)
def test_what_reaches_the_jacobian_costs_this_many_operations(way, n):
    a, b, c, d = NEEDED[way]
    if n == 2 and way[0] in ("recursive", "recursive_by_cross", "dh_modified", "structured"):
        assert counts(arm("rr"), *way) == ((6, 2) if way[0] == "structured" else (6, 3))
    else:
        assert counts(arm("r" * n), *way) == (a * n + b, c * n + d)


@pytest.mark.parametrize("n", range(4, 13))
@pytest.mark.parametrize("method", EVERYTHING)
def test_a_recursion_from_q_on_costs_this_many_operations(method, n):
    a, b, c, d = EVERYTHING[method]
    assert counts(arm("r" * n), method, "body", "everything") == (a * n + b, c * n + d)


@pytest.mark.parametrize("n", JOINTS)
@pytest.mark.parametrize("way", WITH_POSE, ids="-".join)
def test_jacobian_and_pose_together_cost_this_many_operations(way, n):
    a, b, c, d = WITH_POSE[way]
    assert counts(arm("r" * n), *way, pose=True) == (a * n + b, c * n + d)


@pytest.mark.parametrize("n", range(4, 13))
def test_moved_links_cost_at_most_12_and_6_each_and_a_sine_and_cosine(n):
    given = pk.count(arm("r" * n), method="recursive", counting="live")
    whole = pk.count(arm("r" * n), method="recursive", counting="everything")
    # the last link's constant entries meet constants of the one before: some products are none
    assert 12 * (n - 1) - 8 == whole.multiplications - given.multiplications
    assert 6 * (n - 1) - 1 == whole.additions - given.additions
    assert (given.sine_cosine_pairs, whole.sine_cosine_pairs) == (0, n - 1)


@pytest.mark.parametrize("n", JOINTS)
def test_direct_and_recursive_cost_the_same_in_arbitrary_link_frames(n):
    for charged in ("paper", "live"):
        general = counts(arm("r" * n), "recursive_general_frames", "body", charged)
        assert general == counts(arm("r" * n), "direct", "body", charged)


@pytest.mark.parametrize("n", range(3, 13))
@pytest.mark.parametrize("frame", ["body", "space"])
def test_general_links_with_two_planar_rotations_keep_the_bar(n, frame):
    cost = pk.count(arm("r" * n), method="structured", frame=frame)
    assert cost.multiplications <= 36 * n - 68
    assert cost.additions <= 21 * n - 44
    if n == 6:
        assert numbers(cost) == (144, 81)


@pytest.mark.parametrize("n", [3, 6, 9])
def test_the_pose_costs_the_structured_way_one_link_more(n):
    alone, both = (
        pk.count(arm("r" * n), method="structured", frame="space", pose=pose)
        for pose in (False, True)
    )
    assert both.multiplications - alone.multiplications == 21
    assert both.additions - alone.additions == 12


def test_prismatic_helical_and_mixed_joints_are_counted():
    # an adjoint of (0; v) is R v: 9 and 6; a column of a sliding joint is a column of R
    assert counts(arm("pp"), "direct", "body", "paper") == (9, 6)
    assert counts(arm("pp"), "recursive", "body", "paper") == (0, 0)
    assert counts(arm("rprr"), "recursive", "body", "paper") == (42 * 4 - 78 - 6, 30 * 4 - 57 - 3)
    assert counts(arm("rprr"), "direct", "body", "paper") == (60 * 4 - 96 - 15, 45 * 4 - 72 - 12)
    assert counts(arm("rhrr"), "recursive", "body", "paper") == (42 * 4 - 78 + 3, 30 * 4 - 57 + 3)
    assert pk.count(arm("rprr"), counting="everything").sine_cosine_pairs == 2
    # the pitch: one product for the shift, three for where it goes
    straight, pitched = (counts(arm(k), "direct", "space", "everything") for k in ("rrr", "rhr"))
    assert (pitched[0] - straight[0], pitched[1] - straight[1]) == (3, 3)


def test_a_coupled_joint_costs_its_coupling_and_no_second_sine():
    def cost(*C):
        return pk.count(arm("rrr", coupling=C), counting="everything")

    free = pk.count(arm("rrr"), counting="everything")
    # columns 1 and 2 become one: six sums
    tied = cost([1.0, 0.0], [1.0, 0.0], [0.0, 1.0])
    assert numbers(tied) == (free.multiplications, free.additions + 6)
    # joints 2 and 3 turn by the same angle
    assert (free.sine_cosine_pairs, tied.sine_cosine_pairs) == (2, 2)
    assert cost([1.0, 0.0], [0.0, 1.0], [0.0, 1.0]).sine_cosine_pairs == 1
    # a ratio: of the four entries of column 2 that are no constants, and of the angle
    geared = cost([1.0, 0.0], [0.5, 0.0], [0.0, 1.0])
    assert numbers(geared) == (tied.multiplications + 4 + 1, tied.additions)


def test_a_sum_of_angles_is_an_addition():
    planar = pk.Chain.from_space(
        [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0.0, 1.0)],
        [[1, 0, 0, 2], *np.eye(4)[1:]],
    )
    cost = pk.count(planar, method="specialised", frame="space", pose=True)
    # q1 and q1 + q2; x = c1 + c12, y = s1 + s12
    assert (cost.multiplications, cost.additions, cost.sine_cosine_pairs) == (0, 3, 2)


@pytest.mark.parametrize("name, tip, frames", [
    ("puma560", None, {"body": (55, 26, 5), "cheapest": (15, 3, 4)}),
    ("ur5", None, {"body": (46, 21, 5), "cheapest": (10, 5, 4)}),
    ("panda", "panda_link8", {"body": (92, 47, 6), 3: (39, 12, 5)}),
])  # fmt: skip
def test_the_catalogue_s_arms_keep_their_bars(name, tip, frames):
    chain = pk.load(name).chain(tip=tip)
    for frame, bar in frames.items():
        cost = pk.count(chain, method="specialised", frame=frame)
        assert all(
            a <= b for a, b in zip((*numbers(cost), cost.sine_cosine_pairs), bar, strict=True)
        ), (frame, cost)


def evaluated(program, q):
    """What a program computes, step by step, and how many operations that took."""
    angles, values, done = [], {}, [0, 0]
    for angle in program.angles:
        angles.append(
            (0.0 if angle.base is None else angles[angle.base])
            + sum(f * q[k] for k, f in angle.terms)
            + angle.offset
        )
        parts = len(angle.terms) + (angle.base is not None) + (angle.offset != 0)
        done[1] += max(parts - 1, 0)
        done[0] += sum(abs(f) != 1 for _, f in angle.terms)
    for number, node in program.steps:
        first = int(node.first)
        if node.kind == "input" and first >= 0:
            values[number] = (math.cos if first % 2 else math.sin)(angles[first // 2])
        elif node.kind == "input":
            values[number] = q[-1 - first]
        elif node.kind == "constant":
            values[number] = node.first
        elif node.kind == "scaled":
            values[number] = node.first * values[node.second]
            done[0] += 1
        elif node.kind == "product":
            values[number] = values[first] * values[node.second]
            done[0] += 1
        else:
            values[number] = values[first] + node.sign * values[node.second]
            done[1] += 1
    results = [x if number is None else x * values[number] for number, x in program.outputs]
    return np.array(results), tuple(done)


@pytest.mark.parametrize(
    "name, tip", [("ur5e", "tool0"), ("panda", "panda_hand"), ("stanford", None), (None, None)]
)
@pytest.mark.parametrize("frame", ["space", "body", "hybrid", 1])
def test_the_program_that_is_counted_computes_the_arm_s_jacobian_and_pose(name, tip, frame):
    chain = arm("rphr", coupling=[[1, 0, 0], [0, 1, 0], [0.5, 0, 2], [0, 0, 1]]) if name is None else (
        pk.load(name).chain(tip=tip)
    )  # fmt: skip
    q = np.random.default_rng(1).uniform(-2, 2, chain.dof)
    for pose in (False, True):
        values, done = evaluated(chain.compile().program(frame, pose=pose), q)
        assert done == counts(chain, "specialised", frame, "everything", pose=pose)
        # 30 roundings of numbers up to the reach, in another order than the chain's own
        tolerance = 30 * 2.0**-52 * chain.reach
        np.testing.assert_allclose(
            values[-6 * chain.dof :].reshape(6, -1),
            chain.jacobian(q, frame),
            rtol=0,
            atol=tolerance,
        )
        if pose:
            T = chain.fk(q)
            np.testing.assert_allclose(
                values[:12], [*T[:3, :3].ravel(), *T[:3, 3]], rtol=0, atol=tolerance
            )


def row(T):
    return [*T[:3, :3].ravel().tolist(), *T[:3, 3].tolist()]


@pytest.mark.parametrize("kinds", [*("r" * n for n in JOINTS), "rp", "prrp", "rprrr"])
def test_the_variants_compute_one_and_the_same_jacobian(kinds):
    n = len(kinds)
    rng = np.random.default_rng(n)
    chain, q = arm(kinds, n), rng.uniform(-np.pi, np.pi, n)
    rotates, slides = ([int(kind == letter) for kind in kinds] for letter in "rp")
    turns = [
        pk.se3.exp([0, 0, r * x, 0, 0, p * x]) for x, r, p in zip(q, rotates, slides, strict=True)
    ]
    local = chain.local
    links = [row(M @ Z) for M, Z in zip(local.frames, turns, strict=False)]
    bare = chain.retooled(pk.se3.inverse(local.frames[n]))
    given = count_methods.Links(n, rotates, slides, (), links, row(local.frames[n]))
    # link frames attached anywhere: M_i = G_{i-1}^-1 G_i, S_i = Ad(G_i)^-1 A_i, the last one being
    # the tool's
    G = [np.eye(4), *(pk.se3.exp(rng.normal(size=6)) for _ in range(n - 1)), chain.home]
    S = [pk.se3.adjoint(pk.se3.inverse(g)) @ A for g, A in zip(G[1:], chain.screws, strict=True)]
    moved = [
        row(pk.se3.inverse(a) @ b @ pk.se3.exp(s * x))
        for a, b, s, x in zip(G, G[1:], S, q, strict=False)
    ]
    general = count_methods.Links(n, (), (), [s.tolist() for s in S], moved, ())
    # Paul's frames: the joint before its link, no tool
    behind = [row(Z @ M) for Z, M in zip(turns, local.frames[1:], strict=True)]
    paul = count_methods.Links(n, rotates, slides, (), behind, ())
    from_first = chain.rebased(pk.se3.inverse(local.frames[0]))
    in_space, in_body = (
        count_methods.Links(
            n, (), (), screws.tolist(),
            [row(pk.se3.exp(S * x)) for S, x in zip(screws, q, strict=True)], row(chain.home),
        )
        for screws in (chain.screws, chain.screws @ pk.se3.adjoint(pk.se3.inverse(chain.home)).T)
    )  # fmt: skip
    ways: list[tuple[Any, Any, Any]] = [
        (count_methods.direct_space, in_space, "space"),
        (count_methods.direct_body, in_body, "body"),
    ]
    for direct, arm_, frame in ways:
        J, finish = direct(arm_)
        np.testing.assert_allclose(J, chain.jacobian(q, frame), atol=1e-13 * chain.reach)
        np.testing.assert_allclose(finish(), row(chain.fk(q)), atol=1e-13 * chain.reach)
    with_end = count_methods.Links(
        n, rotates, slides, (), behind, row(pk.se3.exp([0.1, 0.2, 0.3, 1, 2, 3]))
    )
    J, finish = count_methods.orin_schrader(with_end)
    tooled = from_first.retooled(pk.se3.exp([0.1, 0.2, 0.3, 1, 2, 3]))
    np.testing.assert_allclose(J, tooled.jacobian(q, "body"), atol=1e-13 * tooled.reach)
    np.testing.assert_allclose(finish(), row(tooled.fk(q)), atol=1e-13 * tooled.reach)
    for algorithm, arm_, expected in (
        (count_methods.z_aligned, given, bare),
        (count_methods.by_cross, given, bare),
        (count_methods.with_tool, given, chain),
        (count_methods.general_frames, general, chain),
        (count_methods.paul, paul, from_first),
    ):
        J, finish = algorithm(arm_)
        # n products and as many columns, a few roundings each
        tolerance = 20 * n * 2.0**-52 * chain.reach
        np.testing.assert_allclose(J, expected.jacobian(q, "body"), rtol=0, atol=tolerance)
        np.testing.assert_allclose(finish(), row(expected.fk(q)), rtol=0, atol=tolerance)


def test_the_forms_of_links_are_poses():
    rng = np.random.default_rng(0)
    for form in ("exponential", "general_link", "z_link", "paul_link", "craig_link"):
        for kind, x in (("revolute", 0.3), ("prismatic", 0.4), ("helical", 0.5)):
            turns = kind != "prismatic"
            shift = 0.0 if kind == "revolute" else 0.1 * x
            sine, cosine = (math.sin(x), math.cos(x)) if turns else (0.0, 1.0)
            T = getattr(count_scalars, form)(
                count_scalars.JointMotion(kind, x, sine, cosine, shift), rng
            )
            R = np.array(T[:9], float).reshape(3, 3)
            np.testing.assert_allclose(R @ R.T, np.eye(3), rtol=0, atol=1e-14)


def test_the_table_has_every_column_and_is_plain_data():
    chain = pk.load("ur5e").chain(tip="tool0")
    table = count_table(chain, idealise=1e-3)
    for method in PRINTED:
        frame = "space" if method == "direct" else "body"
        assert printed(method, 6) == table[method, "body", "printed"].jacobian
        assert numbers(table[method, frame, "paper"].jacobian) == numbers(printed(method, 6))
    used = {(r.method, r.counting) for r in table.rows}
    assert {m for m, _ in used} == set(METHODS)
    assert {c for _, c in used} == {"printed", "paper", "live", "everything"}
    programs = [r.frame for r in table.of("this arm's own program")]
    assert programs == ["space", "body", "hybrid", *range(6), "cheapest"]
    assert [r.frame for r in table.of("the idealised arm's own program")] == programs
    assert table.idealised is not None
    document = json.loads(table.to_json())
    assert len(document["rows"]) == len(table.rows)
    assert document["idealised"]["position_bound"] == table.idealised.position_bound
    assert document["rows"][0]["jacobian"]["multiplications"] == 264
    assert set(document["groups"]) == set(table.groups)
    with pytest.raises(KeyError):
        table["direct", "hybrid", "paper"]
    with pytest.raises(
        pk.errors.InputError, match=r"^group: expected 'printed in the paper', .* or .*, got 'x'$"
    ):
        table.of("x")
    row = table["recursive", "body", "paper"]
    assert row.summary() == f"{row.what}, body: 174 multiplications, 123 additions"
    lines = str(table).splitlines()
    assert lines[0] == "Operations of one Jacobian: 6 joints, 6 coordinates"
    assert len(lines) == 1 + len(table.groups) + len(table.rows) + len(table.verdict)
    assert lines[-1] == table.verdict[-1]
    assert table.cheapest is not None
    assert document["cheapest"]["joint"] == table.cheapest.joint


def test_the_summary_has_each_heading_and_its_rows_below_it_indented():
    table = count_table(arm("rrr"))
    _, *lines = table.summary().split("\n")
    expected = []
    for group in table.groups:
        expected += [f"{group}:", *(f"  {row.summary()}" for row in table.of(group))]
    assert lines == [*expected, *table.verdict]


@pytest.mark.parametrize(
    "more, words",
    [
        ((0, 0), "nothing"),
        ((3, 0), "3 multiplications and 0 additions"),
        ((0, 2), "0 multiplications and 2 additions"),
        ((0, -2), "0 multiplications and -2 additions"),
    ],
)
def test_a_gap_is_nothing_where_neither_multiplications_nor_additions_differ(
    more, words, monkeypatch
):
    def cost(_chain, *, method, **_):
        return Count(10, 7) if method == "recursive" else Count(10 + more[0], 7 + more[1])

    monkeypatch.setattr(tables, "count", cost)
    first, *_ = tables._verdict(arm("rrr"))
    assert first == f"The paper's way of counting gives POE an advantage of {words} over DH."


def test_the_verdict_is_in_the_arm_s_own_numbers():
    revolute = " ".join(count_table(arm("rrrrrr")).verdict)
    for words in (
        "an advantage of 78 multiplications and 57 additions over DH",
        "on modified frames costs nothing more",
        "On standard frames 42 multiplications and 30 additions stay",
        "A constant tool costs POE 36 multiplications and 27 additions",
        "the recursion costs nothing more than the direct method",
    ):
        assert words in revolute
    # with two joints that is many times what POE costs
    assert "an advantage of 78 multiplications and 57 additions over DH" in " ".join(
        count_table(arm("rr")).verdict
    )
    # a last joint that slides has a column that costs nothing
    assert "an advantage of 72 multiplications and 54 additions" in " ".join(
        count_table(arm("rrrrrp")).verdict
    )


def test_each_row_says_what_it_is_of_which_joint():
    rows = count_table(arm("rrr", joint_names=["a", "b", "c"])).rows
    assert [row.what for row in rows[:3]] == [
        "POE, direct: 60n - 96 and 45n - 72", "POE, recursive: 42n - 78 and 30n - 57", "DH, recursive: 42n and 30n",
    ]  # fmt: skip
    *programs, cheapest = [row for row in rows if row.group == "this arm's own program"]
    assert [row.what for row in programs] == [
        "space Jacobian", "body Jacobian", "hybrid Jacobian",
        *(f"J in the frame of {name}" for name in "abc"),
    ]  # fmt: skip
    best = min(programs[3:], key=lambda row: row.jacobian.multiplications + row.jacobian.additions)
    assert cheapest.what == f"J in the cheapest frame, that of {best.what[-1]}"
    assert (
        cheapest.jacobian.multiplications < best.jacobian.multiplications
    )  # it may stand anywhere on that axis
    for row in programs:
        assert row.with_pose is not None
        assert row.with_pose.multiplications > row.jacobian.multiplications
    assert count_table(arm("r")).verdict == ()
    assert count_table(arm("")).cheapest is None


def test_formulas_of_revolute_joints_are_not_printed_for_other_chains():
    tied = arm("rrr", coupling=[[1.0, 0.0], [0.0, 1.0], [0.0, 1.0]])
    for chain in (arm("rpr"), tied, arm("h" * 3), arm("r")):
        assert all(r.counting != "printed" for r in count_table(chain).rows)


def test_short_chains_have_their_own_program_only():
    assert {r.method for r in count_table(arm("r")).rows} == {"specialised"}
    nothing = count_table(pk.Chain.from_space(np.empty((0, 6)), np.eye(4)))
    assert [numbers(r.with_pose) for r in nothing.rows] == [(0, 0)] * 3
    assert nothing.cheapest is None
    assert nothing.verdict == ()


def test_a_rounded_model_costs_more_than_its_idealised_arm():
    exact = pk.load("ur5").chain()
    noise = np.random.default_rng(0).normal(size=(6, 6)) * 1e-7
    rounded = pk.Chain.from_space(
        [pk.se3.adjoint(pk.se3.exp(e)) @ A for e, A in zip(noise, exact.screws, strict=True)],
        exact.home,
    )
    table = count_table(rounded, idealise=1e-5)
    costs = [
        next(r.jacobian for r in table.of(g) if r.frame == "body")
        for g in ("this arm's own program", "the idealised arm's own program")
    ]
    assert costs[1] == pk.count(exact, method="specialised")
    assert costs[0].multiplications > 2 * costs[1].multiplications


@pytest.mark.parametrize("options, words", [
    ({"method": "fast"}, r"no method 'fast'; there are: direct, recursive, .*specialised"),
    ({"method": ["direct"]}, r"no method .*; there are"),
    ({"method": "direct", "frame": "hybrid"}, r"no method 'direct' in frame 'hybrid'; its frames: body, space"),
    ({"method": "recursive", "frame": 2}, r"no method 'recursive' in frame 2; its frames: body"),
    ({"counting": "all"}, r"counting: expected 'paper', 'live' or 'everything', got 'all', for method 'recursive'"),
    ({"method": "specialised", "counting": "paper"}, r"counting: expected 'everything', got 'paper', for method"),
    ({"method": "specialised", "frame": "tool"}, r"frame"),
    ({"method": "specialised", "frame": 3}, r"frame"),
    ({"pose": 1}, r"pose: expected True or False, got 1"),
], ids=str)  # fmt: skip
def test_what_is_unknown_is_refused_with_what_there_is(options, words):
    with pytest.raises(pk.errors.PoekinError, match=words):
        pk.count(arm("rrr"), **options)


def test_a_frame_of_none_is_the_pose_alone():
    cost = pk.count(pk.load("ur5").chain(), method="specialised", frame=None)
    assert (
        cost.multiplications
        < pk.count(pk.load("ur5").chain(), method="specialised", pose=True).multiplications
    )
    assert cost.sine_cosine_pairs == 6


def test_the_paper_s_methods_count_from_two_joints_on():
    with pytest.raises(
        pk.errors.InputError, match=r"'recursive' counts from 2 joints on, the chain has 1"
    ):
        pk.count(arm("r"))
    robot: Any = pk.load("ur5e")
    with pytest.raises(
        pk.errors.InputError, match=r"expected a Chain, as Robot.chain\(tip=...\) makes it, got"
    ):
        pk.count(robot)
    with pytest.raises(pk.errors.InputError, match=r"expected a Chain"):
        count_table(robot)
    with pytest.raises(pk.errors.InputError, match=r"tol"):
        count_table(arm("rrr"), idealise=1.0)


def test_generic_numbers_are_neither_0_nor_1_nor_alike_and_the_same_every_time():
    some, again = (
        count_scalars.generic(count_scalars.generator(), 4, 50).ravel() for _ in range(2)
    )
    assert some.tolist() == again.tolist()
    assert 0.2 <= some.min() < 0.25
    assert 0.85 < some.max() < 0.9
    assert len(set(some.tolist())) == 200


@pytest.mark.parametrize("tool", [False, True])
def test_a_generic_arm_has_the_joints_and_the_coupling_of_the_user_s_and_links_of_its_own(tool):
    chain = arm(
        "rphr", coupling=[[1, 0, 0], [0, 1, 0], [0.5, 0, 2], [0, 0, 1]], offset=[0, 0.5, 0, 1]
    )
    found = count_scalars.generic_structure(chain, tool)
    assert (found.rotates, found.slides) == ((1, 0, 1, 1), (0, 1, pytest.approx(0.1), 0))
    assert found.coupling == ((1, 0, 0), (0, 1, 0), (0.5, 0, 2), (0, 0, 1))
    assert (found.shift, found.coordinates) == ((0, 0.5, 0, 1), 3)
    assert (found.parallel, found.quarters, found.offsets) == ((0,) * 4, (0,) * 4, (0,) * 4)
    assert found.links[0] == (0, 1, 0, 0)
    for sine, cosine, d, rest in found.links[1:]:
        assert (np.hypot(sine, cosine), rest) == (pytest.approx(1), 0)
        assert 0.2 <= d <= 0.9
        assert 0.2 <= np.arctan2(sine, cosine) <= 0.9
    assert len({*found.d_offsets, *(link[2] for link in found.links[1:])}) == 7
    here = (*np.eye(3).ravel(), 0, 0, 0)
    assert found.frames == (here,) * 4
    assert (found.base == here, found.tool == here) == (not tool, not tool)
    if tool:
        assert found.base != found.tool
        assert np.linalg.det(np.reshape(found.base[:9], (3, 3))) == pytest.approx(1)


@pytest.mark.parametrize("kind", ["revolute", "prismatic", "helical"])
def test_a_generic_screw_is_one_of_its_kind(kind):
    S = np.array(count_scalars.generic_screw(kind, count_scalars.generator()))
    w, v = S[:3], S[3:]
    assert np.linalg.norm(v if kind == "prismatic" else w) == pytest.approx(1)
    assert w.any() == (kind != "prismatic")
    if kind != "prismatic":
        assert w @ v == pytest.approx(0.1 * (kind == "helical"), abs=1e-15)
        assert np.linalg.norm(np.cross(w, v)) > 0.1  # away from the origin


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
def test_the_links_of_a_form_turn_or_slide_as_their_joint_does(kind):
    def link(form, x):
        turns = kind == "revolute"
        sine, cosine, shift = (math.sin(x), math.cos(x), 0.0) if turns else (0.0, 1.0, x)
        T = np.eye(4)
        flat = getattr(count_scalars, form)(
            count_scalars.JointMotion(kind, x, sine, cosine, shift), count_scalars.generator()
        )
        T[:3, :3], T[:3, 3] = np.reshape(flat[:9], (3, 3)), flat[9:]
        return T

    z = [0, 0, 0.7, 0, 0, 0] if kind == "revolute" else [0, 0, 0, 0, 0, 0.7]
    for form, before in (("z_link", False), ("craig_link", False), ("paul_link", True)):
        at_rest, moved = link(form, 0.2), link(form, 0.9)
        expected = pk.se3.exp(z) @ at_rest if before else at_rest @ pk.se3.exp(z)
        np.testing.assert_allclose(moved, expected, atol=1e-15)
    for form in ("exponential", "general_link"):
        moved = pk.se3.inverse(link(form, 0.2)) @ link(form, 0.9)
        assert np.linalg.norm(
            pk.se3.log(moved)[slice(0, 3) if kind == "revolute" else slice(3, 6)]
        ) == pytest.approx(0.7)


@pytest.mark.parametrize("form, zeros", [("paul_link", [6]), ("craig_link", [2])])
def test_the_link_of_a_slide_is_turned_about_its_axis_by_a_general_angle(form, zeros):
    motion = count_scalars.JointMotion("prismatic", 0.4, 0.0, 1.0, 0.4)
    T = getattr(count_scalars, form)(motion, count_scalars.generator())
    assert np.flatnonzero(np.array(T[:9]) == 0).tolist() == zeros


METHODS_SAID = ", ".join(METHODS)
REFUSED = {
    "method": ({"method": "fast"}, f"no method 'fast'; there are: {METHODS_SAID}"),
    "no method": ({"method": ["direct"]}, f"no method ['direct']; there are: {METHODS_SAID}"),
    "frame": ({"method": "direct", "frame": "hybrid"},
              "no method 'direct' in frame 'hybrid'; its frames: body, space"),
    "joint": ({"method": "structured", "frame": 2},
              "no method 'structured' in frame 2; its frames: body, space, hybrid"),
    "counting": ({"counting": "all"},
                "counting: expected 'paper', 'live' or 'everything', got 'all', for method 'recursive'"),
    "charged 5": ({"method": "specialised", "counting": 5},
                  "counting: expected 'everything', got 5, for method 'specialised'"),
    "pose": ({"pose": 1}, "pose: expected True or False, got 1"),
}  # fmt: skip


@pytest.mark.parametrize("options, message", REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_counted_is_said_whole(options, message):
    with pytest.raises(pk.errors.PoekinError) as caught:
        pk.count(arm("rrr"), **options)
    assert str(caught.value) == message


@pytest.mark.parametrize("kinds", ["", "r"])
def test_too_few_joints_are_said_whole(kinds):
    with pytest.raises(pk.errors.InputError) as caught:
        pk.count(arm(kinds), method="direct")
    assert (
        str(caught.value) == f"method 'direct' counts from 2 joints on, the chain has {len(kinds)}"
    )
    assert pk.count(arm(kinds), method="specialised").multiplications == 0
