"""Emitted JavaScript, by Node: to the last bit what the emitted Python computes, and safe from any name.

All links and chains of the robots of example-robot-data: tests/view/test_kinematics.py.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.formats import emit
from tests.formats.emitted import (
    ARMS,
    FRAMES,
    HOSTILE,
    arm,
    bound,
    expected,
    link_bounds,
    module,
    suffix,
    with_name,
)
from tests.model.test_robot import two_arms
from tests.nodejs import Calls

CASES: list[tuple[str, Any]] = [
    (name, frame)
    for name in ARMS
    for frame in (*FRAMES, 0)
    if arm(name).kinds or frame in FRAMES[:3]
]


@pytest.fixture
def calls(tmp_path):
    return Calls(tmp_path)


def flat(T: np.ndarray, J: np.ndarray) -> np.ndarray:
    """Pose and Jacobian of each configuration, one behind the other."""
    return np.concatenate([T.reshape(len(T), 16), J.reshape(len(J), -1)], axis=1)


def test_it_is_the_emitted_python_to_the_last_bit_given_the_same_sines(calls):
    for name, frame in CASES:
        chain = arm(name)
        q = chain.random(5, 20)
        text, python = emit.javascript(chain, frame), module(emit.python(chain, frame))
        both = f"fk_jacobian_{suffix(frame)}"
        x = getattr(python, f"{both}_angles")(q, np)
        calls.add(text, f"{both}_angles", [[row] for row in q], x)
        s, c = np.sin(x), np.cos(x)
        T, J = getattr(python, f"{both}_sincos")(s, c, q, np)
        calls.add(
            text, f"{both}_sincos", [list(row) for row in zip(s, c, q, strict=True)], flat(T, J)
        )
    for got, wanted in calls.run():
        np.testing.assert_array_equal(got, wanted)


def test_from_q_it_is_the_chain(calls):
    bounds = []
    for name, frame in CASES:
        chain = arm(name)
        q = chain.random(6, 20)
        T, J = expected(chain, frame, q)
        text = emit.javascript(chain, frame)
        wanted = {
            "fk": T.reshape(20, 16),
            f"jacobian_{suffix(frame)}": J.reshape(20, -1),
            f"fk_jacobian_{suffix(frame)}": flat(T, J),
        }
        for function, values in wanted.items():
            calls.add(text, function, [[row] for row in q], values)
            bounds.append(bound(chain, q))
    for (got, wanted), within in zip(calls.run(), bounds, strict=True):
        assert np.abs(got - wanted).max(initial=0.0) <= within


def test_of_a_robot_it_is_the_poses_of_all_links(calls):
    bounds = []
    for robot in (pk.load("panda"), two_arms(), two_arms().coupled("r = r - 0.5 h")):
        q = np.random.default_rng(9).uniform(-2, 2, (5, robot.dof))
        T = np.stack(list(robot.fk(q).values()), axis=1).reshape(5, -1)
        text = emit.javascript(robot)
        calls.add(text, "link_poses", [[row] for row in q], T)
        calls.add(text, "link_poses", [[row, np.ones(T.shape[1])] for row in q], T)
        bounds += 2 * [np.repeat(link_bounds(robot, q), 16)]
    for (got, wanted), within in zip(calls.run(), bounds, strict=True):
        assert (np.abs(got - wanted) <= within).all()


def test_results_go_into_the_arrays_given_and_may_overlap_q(calls):
    chain = arm("mixed")
    text = emit.javascript(chain, "body") + (
        "export function given(q) {\n"
        "    const T = new Float64Array(16), J = new Float64Array(30), memory = new Float64Array(16);\n"
        "    memory.set(q);\n"
        "    fk_jacobian_body(q, T, J);\n"
        "    if (fk(memory, memory) !== memory) throw new Error('another array');\n"
        "    return { T: memory, J: J };\n"
        "}\n"
    )
    q = chain.random(8, 4)
    T, J = chain.fk_jacobian(q, "body")
    calls.add(text, "given", [[row] for row in q], flat(T, J))
    ((got, wanted),) = calls.run()
    assert np.abs(got - wanted).max() <= bound(chain, q)


@pytest.mark.parametrize("name", HOSTILE, ids=range(len(HOSTILE)))
def test_a_hostile_name_stays_in_its_comment(name):
    texts = (
        emit.javascript(with_name(name), "cheapest", origin=name[:400]),
        emit.javascript(with_name("a"), "cheapest"),
    )
    without, plain = (re.sub(r"/\*.*?\*/", "", text, count=1, flags=re.DOTALL) for text in texts)
    assert without == plain
    of_links = emit.javascript(pk.Robot(name, [name], []), origin=name)
    for text in (texts[0], of_links):
        assert text.isascii()
        assert "</" not in text
        assert "<!--" not in text


def test_the_head_says_where_an_arm_and_a_robot_are_from():
    of_arm = emit.javascript(arm("panda"), "body", origin="panda.urdf")
    for text in (of_arm, emit.javascript(pk.load("panda"), origin="panda.urdf")):
        assert f"\n * Made by poekin {pk.__version__} from panda.urdf\n" in text


def test_it_needs_sine_and_cosine_alone_and_says_what_it_costs():
    chain = arm("panda")
    for frame in FRAMES:
        text = emit.javascript(chain, frame)
        code = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
        functions = set(re.findall(r"([\w.]+)\(", code))
        own = {f"{name}{part}" for name in ("fk", f"jacobian_{frame}", f"fk_jacobian_{frame}")
               for part in ("", "_angles", "_sincos")}  # fmt: skip
        assert functions - own == {"Float64Array", "x.map"}
        assert set(re.findall(r"Math\.\w+", code)) == {"Math.sin", "Math.cos"}
        count = chain.compile().program(frame, pose=True).count
        said = (
            f"{count.multiplications} multiplications, {count.additions} additions or subtractions"
        )
        assert f" * fk_jacobian_{frame}: {said}, {count.sines} pairs of sine and cosine\n" in text


def test_what_cannot_be_emitted_is_refused():
    with pytest.raises(InputError, match=r"^frame: expected"):
        emit.javascript(arm("panda"))
    with pytest.raises(InputError, match=r"^origin: expected a text, got 3$"):
        emit.javascript(arm("panda"), "body", origin=3)  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"^frame: expected with a Chain only.*; got 'body'$"):
        emit.javascript(pk.load("panda"), "body")
