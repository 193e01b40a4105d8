"""Emitted C and Python of one small arm, written out: what is compiled and run elsewhere, here
letter by letter.
"""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

import poekin as pk
from poekin.checks import REQUIRED
from poekin.errors import InputError
from poekin.formats import emit

from .emitted import bound

HOME = [[1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0.25], [0, 0, 0, 1]]
LISTS = str.maketrans("{}", "[]")
TURN, SLIDE = [0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0]
POLAR = pk.Chain.from_space(
    [TURN, SLIDE],
    HOME,
    limits=[[-1, 2.5], [0, 1]],
    joint_names=["turn", "slide"],
    base="w",
    tip="t",
)

HEADER = """\
/*
 * rod: the kinematics of one serial arm as straight-line C99, in double. Generated: change the arm instead.
 * Made by poekin VERSION
 *
 * rod_fk: 2 multiplications, 1 additions or subtractions, 1 pairs of sine and cosine
 * rod_jacobian_body: 0 multiplications, 1 additions or subtractions, 0 pairs of sine and cosine
 * rod_fk_jacobian_body: 2 multiplications, 1 additions or subtractions, 1 pairs of sine and cosine
 *
 * Base frame 'w', tip frame 't'; 2 joints, 2 coordinates. Units: rad, m.
 *
 *   q[0]  rad  'turn', -1 ... 2.5
 *   q[1]  m  'slide', 0 ... 1
 *
 * T = (R, p; 0, 1), 4 x 4 row by row: the pose of the tip in the base frame; p in m.
 * J, 6 x 2 row by row: V = J dq. Rows omega x, y, z (rad/s), then v x, y, z (m/s), per unit of dq.
 * J is the body Jacobian: axes of the tip, v of the origin of the tip.
 */
#ifndef ROD_H_INCLUDED
#define ROD_H_INCLUDED

#ifdef __cplusplus
extern "C" {
#endif

/*
 * rod_fk: from q[2] to T[16]; they may overlap q.
 * ..._sincos: the same from s[1] = sin x and c[1] = cos x, where the angles x are
 *   x[0] = q[0]
 * ..._angles: those angles from q.
 */
void rod_fk(const double *q, double *T);
void rod_fk_sincos(const double *s, const double *c, const double *q, double *T);
void rod_fk_angles(const double *q, double *x);

/*
 * rod_jacobian_body: from q[2] to J[12]; they may overlap q.
 * ..._sincos: the same from s[0] = sin x and c[0] = cos x, where the angles x are
 * ..._angles: those angles from q.
 */
void rod_jacobian_body(const double *q, double *J);
void rod_jacobian_body_sincos(const double *s, const double *c, const double *q, double *J);
void rod_jacobian_body_angles(const double *q, double *x);

/*
 * rod_fk_jacobian_body: from q[2] to T[16], J[12]; they may overlap q.
 * ..._sincos: the same from s[1] = sin x and c[1] = cos x, where the angles x are
 *   x[0] = q[0]
 * ..._angles: those angles from q.
 */
void rod_fk_jacobian_body(const double *q, double *T, double *J);
void rod_fk_jacobian_body_sincos(const double *s, const double *c, const double *q, double *T, double *J);
void rod_fk_jacobian_body_angles(const double *q, double *x);

#ifdef __cplusplus
}
#endif

#endif
""".replace("VERSION", pk.__version__)

FK = """\
void rod_fk_angles(const double *q, double *x)
{
    const double q0 = q[0];
    const double x0 = q0;
    x[0] = x0;
}

void rod_fk_sincos(const double *s, const double *c, const double *q, double *T)
{
    const double c0 = c[0];
    const double q1 = q[1];
    const double s0 = s[0];
    const double v0 = q1 + 0.5;
    const double v1 = s0 * v0;
    const double v2 = c0 * v0;
    T[0] = c0;
    T[1] = -s0;
    T[2] = 0.0;
    T[3] = v2;
    T[4] = s0;
    T[5] = c0;
    T[6] = 0.0;
    T[7] = v1;
    T[8] = 0.0;
    T[9] = 0.0;
    T[10] = 1.0;
    T[11] = 0.25;
    T[12] = 0.0;
    T[13] = 0.0;
    T[14] = 0.0;
    T[15] = 1.0;
}

void rod_fk(const double *q, double *T)
{
    double s[1], c[1];
    int j;
    rod_fk_angles(q, s);
    for (j = 0; j < 1; j++) {
        const double x = s[j];
        s[j] = sin(x);
        c[j] = cos(x);
    }
    rod_fk_sincos(s, c, q, T);
}
"""

JACOBIAN = """\
void rod_jacobian_body_angles(const double *q, double *x)
{
    (void)q;
    (void)x;
}

void rod_jacobian_body_sincos(const double *s, const double *c, const double *q, double *J)
{
    (void)s;
    (void)c;
    const double q1 = q[1];
    const double v0 = q1 + 0.5;
"""

MAIN = """\
int main(void)
{
    double T[16], J[12];
    int i;
    for (i = 0; i < VECTORS; i++) {
        rod_fk(Q[i], T);
        compare(T, T_EXPECTED[i], 16);
        rod_jacobian_body(Q[i], J);
        compare(J, J_EXPECTED[i], 12);
        rod_fk_jacobian_body(Q[i], T, J);
        compare(T, T_EXPECTED[i], 16);
        compare(J, J_EXPECTED[i], 12);
    }
"""

PYTHON_FK = '''\
def fk(q, xp):
    """T (..., 4, 4) at q (..., 2)."""
    x = fk_angles(q, xp)
    return fk_sincos(xp.sin(x), xp.cos(x), q, xp)


def fk_sincos(sines, cosines, q, xp):
    """T (..., 4, 4) from sines and cosines (..., 1) of the angles, and from q (..., 2)."""
    c0 = cosines[..., 0]
    q1 = q[..., 1]
    s0 = sines[..., 0]
    v0 = q1 + 0.5
    v1 = s0 * v0
    v2 = c0 * v0
    zero = xp.sum(q[..., :0], -1)
    k0 = xp.full_like(zero, 0.0)
    k1 = xp.full_like(zero, 1.0)
    k2 = xp.full_like(zero, 0.25)
    T = xp.stack([
        c0, -s0, k0, v2, s0, c0, k0, v1, k0, k0, k1, k2, k0, k0, k0, k1
    ], -1)
    T = xp.reshape(T, tuple(q.shape[:-1]) + (4, 4))
    return T


def fk_angles(q, xp):
    """The angles x (..., 1) whose sines and cosines are needed.

    x[0] = q[0]
    """
    q0 = q[..., 0]
    x0 = q0
    return xp.stack([
        x0
    ], -1)
'''

PYTHON_JACOBIAN = '''\
def jacobian_body_sincos(sines, cosines, q, xp):
    """J (..., 6, 2) from sines and cosines (..., 0) of the angles, and from q (..., 2)."""
    q1 = q[..., 1]
    v0 = q1 + 0.5
    zero = xp.sum(q[..., :0], -1)
    k0 = xp.full_like(zero, 0.0)
    k1 = xp.full_like(zero, 1.0)
    J = xp.stack([
        k0, k0, k0, k0, k1, k0, k0, k1, v0, k0, k0, k0
    ], -1)
    J = xp.reshape(J, tuple(q.shape[:-1]) + (6, 2))
    return J


def jacobian_body_angles(q, xp):
    """The angles x (..., 0) whose sines and cosines are needed."""
    return q[..., :0]
'''


def test_the_header_declares_three_functions_and_says_what_they_take():
    assert emit.c(POLAR, "body", name="rod").header == HEADER


def test_the_source_defines_them_as_straight_lines():
    source = emit.c(POLAR, "body", name="rod").source
    assert source.startswith(
        HEADER[: HEADER.index("\n *\n * Base")] + '\n */\n#include "rod.h"\n\n#include <math.h>\n\n'
    )
    assert FK in source
    assert JACOBIAN in source
    # without an angle there is no sine to take
    assert "double *J)\n{\n    rod_jacobian_body_sincos(q, q, q, J);\n}\n" in source
    single = emit.c(POLAR, "body", name="rod", real="float").source
    assert FK.replace("double", "float").replace("sin(x)", "sinf(x)").replace(
        "cos(x)", "cosf(x)"
    ) == re.sub(
        r"(\d\.\d+)f",
        r"\1",
        single[single.index("void rod_fk_angles") : single.index("\n\nvoid rod_jacobian")],
    )


def test_the_self_test_compares_every_result_with_the_chain_s():
    text = emit.c(POLAR, "body", name="rod").selftest
    assert MAIN in text
    assert "\n#define VECTORS 8\n#define ALLOWED 1.07e-14\n" in text
    assert text.startswith(
        "/*\n * Tests rod.c: compile both, link with the mathematical library, run. It prints the worst error and the"
        " error\n * allowed, which is 1.07e-14 (1, m or m per rad), and exits with 0 if that is kept, else with 1.\n"
        " */\n"
    )
    tables = re.findall(
        r"static const double (\w+)\[VECTORS\]\[(\d+)\] = \{\n(.*?)\n\};", text, flags=re.DOTALL
    )
    assert [(name, int(width)) for name, width, _ in tables] == [
        ("Q", 2),
        ("T_EXPECTED", 16),
        ("J_EXPECTED", 12),
    ]
    q, T, J = (np.array(json.loads(f"[{rows}]".translate(LISTS))) for _, _, rows in tables)
    assert np.abs(T - POLAR.fk(q).reshape(8, 16)).max() <= bound(POLAR, q)
    assert np.abs(J - POLAR.jacobian(q, "body").reshape(8, 12)).max() <= bound(POLAR, q)
    empty = emit.c(pk.Chain.from_space(np.zeros((0, 6)), HOME), "body").selftest
    assert "Q[VECTORS][1] = {\n    {0.0},\n" in empty
    assert "J_EXPECTED[VECTORS][1] = {\n    {0.0},\n" in empty
    assert "double T[16], J[1];" in empty
    assert "compare(J, J_EXPECTED[i], 0);" in empty


@pytest.mark.parametrize("write", [emit.c, emit.python])
def test_a_frame_that_is_left_out_is_asked_for_with_the_choices(write):
    for frame, got in ((REQUIRED, "it was left out"), (None, "got None"), (1.0, r"got 1\.0")):
        with pytest.raises(
            InputError,
            match=(
                rf"^frame: expected 'space', 'body', 'hybrid' or 'cheapest', {got}"
                r" \(or the index of a joint\)$"
            ),
        ):
            write(POLAR, frame)


def test_a_compiled_chain_is_written_as_its_chain():
    assert emit.python(POLAR.compile(), "body") == emit.python(POLAR, "body")
    assert emit.c(POLAR.compile(), "body") == emit.c(POLAR, "body")


def test_the_head_says_where_the_arm_is_from_and_nothing_ends_a_comment():
    origin = 'the robot */ \'\\""", file a.urdf with the SHA-256 ' + "0123456789abcdef" * 4
    for text in (
        emit.c(POLAR, "body", origin=origin).header,
        emit.python(POLAR, "body", origin=origin),
    ):
        head = re.sub(r"\n(?: \* )?", " ", text[:600])
        assert f"Made by poekin {pk.__version__} from the robot <U+002A>/ <U+0027>" in head
        assert f"a.urdf with the SHA-256 {'0123456789abcdef' * 4}" in head
        assert max(map(len, text[:600].splitlines())) < 115
    for write in (emit.c, emit.python):
        with pytest.raises(InputError, match=r"^origin: expected a text, got 3$"):
            write(POLAR, "body", origin=3)  # pyright: ignore[reportArgumentType]


def test_python_is_the_same_lines_on_arrays():
    text = emit.python(POLAR, "body")
    assert text.startswith(
        '"""The kinematics of one serial arm as straight-line code. Generated: change the arm instead.\n'
        f"Made by poekin {pk.__version__}\n\nfk: 2 mult"
    )
    assert (
        "\nJ is the body Jacobian: axes of the tip, v of the origin of the tip.\n\nq is (..., m), an array"
        in text
    )
    assert 'torch.\n"""\n\n\ndef fk' in text
    assert PYTHON_FK in text
    assert PYTHON_JACOBIAN in text
    assert "    return T, J\n" in text
    still = emit.python(pk.Chain.from_space(np.zeros((0, 6)), HOME), "body")
    assert "    J = xp.reshape(q, tuple(q.shape[:-1]) + (6, 0))\n" in still
    assert "J = xp.stack" not in still
