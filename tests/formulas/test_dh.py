"""The paper's route from DH to screws, held against the lines that the frames of the DH product
have as z axes.
"""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings

from poekin import algebra
from poekin.formats import dh
from poekin.formats.dh import Row, Table
from poekin.formulas import dh as formulas
from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.strategies.dh_strategies import angles, lengths, tables
from tests.formats import dh_product
from tests.formulas.four_joints import COUNTS, LINKS, LOCAL, ROTATES, SLIDES, same
from tests.formulas.matrices import Ad, flat, matrix, product

FEW = settings(max_examples=max(settings().max_examples // 2, 20))


def line(T, row):
    """(z; -z x p), or (0; z), of the z axis of a frame, in 50 digits; reversed where the joint
    counts backwards.
    """
    z, p = [T[i, 2] for i in range(3)], [T[i, 3] for i in range(3)]
    moment = [p[1] * z[2] - p[2] * z[1], p[2] * z[0] - p[0] * z[2], p[0] * z[1] - p[1] * z[0]]
    return [
        (-1) ** row.flip * value
        for value in ([*z, *moment] if row.kind == "revolute" else [0, 0, 0, *z])
    ]


def links(table):
    """K_0 ... K_n in 50 digits, by the formula that is under test: (M_i, P_i) of the paper, offsets
    in M_i.
    """

    def link(theta, d, a, alpha):
        return formulas.link(
            mpmath.sin(theta), mpmath.cos(theta), d, a, mpmath.sin(alpha), mpmath.cos(alpha)
        )

    base, tool = (
        [*map(mpmath.mpf, [*T[:3, :3].ravel(), *T[:3, 3]])] for T in (table.base, table.tool)
    )
    rows = [[mpmath.mpf(v) for v in (r.theta, r.d, r.a, r.alpha)] for r in table.rows]
    if table.convention == "modified":
        base = algebra.compose(base, link(0, 0, *rows[0][2:]))
        rows = [
            [*row[:2], *after[2:]]
            for row, after in zip(rows, [*rows[1:], [0, 0, 0, 0]], strict=True)
        ]
    found = [base, *(link(*row) for row in rows)]
    return [*found[:-1], algebra.compose(found[-1], tool)]


def route(table, body=False):
    """A_1 ... A_n (or B_1 ... B_n) and M by the paper's route in 50 digits."""
    signs = [mpmath.mpf(-1) ** row.flip for row in table.rows]
    turns = [row.kind == "revolute" for row in table.rows]
    rotates = [sign * turn for sign, turn in zip(signs, turns, strict=True)]
    slides = [sign * (not turn) for sign, turn in zip(signs, turns, strict=True)]
    A = [[mpmath.mpf(0)] * 6 for _ in table.rows]
    M = formulas.screws(links(table), rotates, slides, len(table.rows), A)
    return ([algebra.adjoint_inverse(M, S) for S in A] if body else A), M


def miss(ours, theirs):
    return float(
        max(
            abs(a - b) for x, y in zip(ours, theirs, strict=True) for a, b in zip(x, y, strict=True)
        )
    )


def far(table):
    """1 m, and all lengths of a table one after the other."""
    return (
        1
        + sum(np.linalg.norm(T[:3, 3]) for T in (table.base, table.tool))
        + np.abs([table.d, table.a]).sum()
    )


@FEW
@given(tables(max_joints=6))
def test_the_paper_s_screws_are_the_lines_of_the_frames_of_the_product(table):
    with mpmath.workdps(dh_product.DIGITS):
        *frames, tool = dh_product.frames(table, [0.0] * len(table))
        A, M = route(table)
        # 50 digits less what ten products and lengths of up to 20 m take; bases and tools are what
        # floats make of them.
        assert miss(A, [line(T, row) for T, row in zip(frames, table.rows, strict=True)]) < 1e-46
        assert (
            miss(
                [M],
                [
                    [
                        *(tool[i, j] for i in range(3) for j in range(3)),
                        *(tool[i, 3] for i in range(3)),
                    ]
                ],
            )
            < 1e-46
        )


@FEW
@given(tables(max_joints=6))
def test_the_body_screws_are_the_same_lines_seen_from_the_tool(table):
    with mpmath.workdps(dh_product.DIGITS):
        *frames, tool = dh_product.frames(table, [0.0] * len(table))
        B, _ = route(table, body=True)
        lines = [line(_seen_from(tool, T), row) for T, row in zip(frames, table.rows, strict=True)]
        # Base and tool are rotations to 1e-15 only, some 10 u each, which transpose and inverse
        # tell apart.
        assert miss(B, lines) <= 40 * UNIT * far(table)


def _seen_from(tool, T):
    return mpmath.inverse(mpmath.matrix(tool.tolist())) * mpmath.matrix(T.tolist())


@FEW
@given(tables(max_joints=6))
def test_the_chain_has_those_lines_to_its_own_rounding(table):
    chain = dh.to_chain(table)
    with mpmath.workdps(dh_product.DIGITS):
        frames = dh_product.frames(table, [0.0] * len(table))[:-1]
        lines = [line(T, row) for T, row in zip(frames, table.rows, strict=True)]
    # a product of i + 1 poses, 8 u each, and the moment of its axis
    off = np.abs(chain.screws - np.array(lines, float)) / (
        16 * UNIT * np.arange(2, len(table) + 2)[:, None]
    )
    assert off[:, :3].max() <= 1
    assert off[:, 3:].max() <= far(table)


@FEW
@given(angles(), lengths(), lengths(), angles())
def test_with_paul_s_frames_s_lies_across_z_wherever_the_link_is_twisted(theta, d, a, alpha):
    # S_i = Ad(M_i)^-1 P_i = (0, sin α, cos α; 0, a cos α, -a sin α): not (0, 0, 1; 0, 0, 0),
    # whatever theta and d.
    with mpmath.workdps(dh_product.DIGITS):
        theta, d, a, alpha = map(mpmath.mpf, (theta, d, a, alpha))
        s, c = mpmath.sin(alpha), mpmath.cos(alpha)
        M = formulas.link(mpmath.sin(theta), mpmath.cos(theta), d, a, s, c)
        assert (
            miss([algebra.adjoint_inverse(M, (0, 0, 1, 0, 0, 0))], [(0, s, c, 0, a * c, -a * s)])
            < 1e-48
        )
        assert miss([algebra.adjoint_inverse(M, (0, 0, 0, 0, 0, 1))], [(0, 0, 0, 0, s, c)]) < 1e-48


PLANTED = {
    "the other convention": lambda t: Table("modified", t.rows, base=t.base, tool=t.tool),
    "an offset of 1e-12 rad": lambda t: _turned(t, 1e-12),
    "the base left out": lambda t: Table(t.convention, t.rows, tool=t.tool),
}


def _turned(table, angle):
    first, *rest = table.rows
    turned = Row(first.theta + angle, first.d, first.a, first.alpha, first.kind, first.flip)
    return Table(table.convention, [turned, *rest], base=table.base, tool=table.tool)


@pytest.mark.parametrize("fault", PLANTED)
def test_the_lines_see_what_is_wrong_with_a_route(fault):
    mount = np.array(
        [[0.0, -1.0, 0.0, 0.25], [1.0, 0.0, 0.0, 0.5], [0.0, 0.0, 1.0, 0.125], [0.0, 0.0, 0.0, 1.0]]
    )
    table = Table(
        "standard",
        [Row(0.3, 0.1, 0.2, 1.0, flip=True), Row(0.5, 0.2, 0.1, -0.7, "prismatic"), Row()],
        base=mount,
    )
    with mpmath.workdps(dh_product.DIGITS):
        frames = dh_product.frames(table, [0.0] * 3)[:-1]
        lines = [line(T, row) for T, row in zip(frames, table.rows, strict=True)]
        assert miss(route(table)[0], lines) < 1e-46
        assert miss(route(PLANTED[fault](table))[0], lines) > 1e-13


def test_a_link_is_its_four_motions():
    turn = matrix([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]], (0, 0, 0.37))
    twist = matrix([[1, 0, 0], [0, 0.96, -0.28], [0, 0.28, 0.96]], (-0.2, 0, 0))
    same(formulas.link(0.6, 0.8, 0.37, -0.2, 0.28, 0.96), flat(turn @ twist))


@COUNTS
def test_the_screws_of_a_table_are_carried_by_the_links_before_them(count):
    A = np.full((count, 6), np.nan)
    home = formulas.screws([flat(T) for T in LINKS], ROTATES, SLIDES, count, A)
    same(A, [Ad(product(*LINKS[: i + 1])) @ LOCAL[i] for i in range(count)])
    same(home, flat(product(*LINKS[: count + 1])))
