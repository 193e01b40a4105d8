"""`poekin emit`: source text of an arm into files, whole or not at all."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

import numpy as np
import pytest

import poekin as pk
from poekin.formats import emit

PANDA = ("emit", "panda", "--tip", "panda_hand")


def test_c_is_three_files_and_says_what_they_cost(poekin, tmp_path):
    code, out, err = poekin(*PANDA, "--lang", "c", "--output", tmp_path / "made")
    assert (code, err) == (0, "")
    source = emit.c(
        pk.load("panda").chain(tip="panda_hand"),
        "hybrid",
        name="panda",
        origin="the robot panda",
    )
    written = {
        path.name: path.read_text(encoding="ascii") for path in (tmp_path / "made").iterdir()
    }
    assert written == source.files
    count = pk.load("panda").chain(tip="panda_hand").compile().program("hybrid", pose=True).count
    assert out.splitlines()[2] == (
        f"panda_fk_jacobian_hybrid: {count.multiplications} multiplications, "
        f"{count.additions} additions or subtractions, {count.sines} pairs of sine and cosine"
    )
    assert out.splitlines()[3].startswith(f"Written: '{tmp_path / 'made' / 'panda.h'}', ")


@pytest.mark.parametrize(
    "options", [("--frame", "cheapest"), ("--frame", "3"), ("--float",), ("--name", "My Arm")]
)
def test_options_reach_the_text(poekin, tmp_path, options):
    assert poekin(*PANDA, "--lang", "c", "--output", tmp_path, *options)[0] == 0
    given = dict([options]) if len(options) == 2 else {}
    name = {"--name": "my_arm"}.get(options[0], "panda")
    frame = given.get("--frame", "hybrid")
    text = (tmp_path / f"{name}.h").read_text(encoding="ascii")
    real = "float" if options == ("--float",) else "double"
    suffix = "joint3" if frame == "3" else frame
    assert f"void {name}_fk_jacobian_{suffix}(const {real} *q, {real} *T, {real} *J);" in text


def test_directories_are_made_and_the_head_says_the_file_and_its_checksum(poekin, tmp_path, crane):
    place = tmp_path / "some" / "where"
    words = ("emit", crane, "--tip", "hook", "--lang", "c", "--output", place)
    assert poekin(*words)[0] == 0
    digest = hashlib.sha256(Path(crane).read_bytes()).hexdigest()
    head = (place / "crane.h").read_text(encoding="ascii").replace("\n * ", " ")
    said = f"from the robot crane, file crane.urdf with the SHA-256 {digest}"
    assert f"Made by poekin {pk.__version__} {said}" in head
    assert str(tmp_path) not in head


def test_a_robot_s_name_takes_80_characters_of_the_head(poekin, tmp_path):
    for length in (80, 81):
        file = tmp_path / "arm.urdf"
        robot = pk.Robot("x" * length, ["a", "b"], [pk.Joint("j", "revolute", "a", "b")])
        file.write_text(pk.to_urdf(robot), encoding="utf-8")
        words = ("emit", file, "--lang", "python", "--name", "arm", "--output", tmp_path, "--force")
        assert poekin(*words)[0] == 0
        text = (tmp_path / "arm.py").read_text(encoding="ascii")
        assert re.findall(r"from the robot\s+(x+), file arm", text) == ["x" * 80]


def test_the_idealised_arm_is_written_and_what_that_changed_is_said(poekin, tmp_path):
    arm = pk.load("panda").chain(tip="panda_hand")
    bent = arm.screws.copy()
    bent[3] = pk.se3.adjoint(pk.se3.exp([1e-5, 0, 0, 0, 0, 0])) @ bent[3]
    file = tmp_path / "bent.urdf"
    file.write_text(pk.to_urdf(pk.Chain.from_space(bent, arm.home)), encoding="utf-8")
    _, as_it_is, _ = poekin("emit", file, "--lang", "c", "--output", tmp_path / "a")
    code, out, _ = poekin(
        *("emit", file, "--lang", "c", "--output", tmp_path / "b", "--idealise", "1e-4")
    )
    assert code == 0
    ideal = pk.load(file).chain().idealised(1e-4)
    assert ideal.changes
    assert f"The idealised arm: {ideal.summary().splitlines()[0]}" in out
    assert int(out.split()[1]) < int(as_it_is.split()[1])
    _, code_of_it = emit.c(ideal.chain, "hybrid", name="base_to_tool").source.split("#include", 1)
    assert (tmp_path / "b" / "base_to_tool.c").read_text(encoding="ascii").endswith(code_of_it)
    head = (tmp_path / "b" / "base_to_tool.h").read_text(encoding="ascii")
    assert "from the robot base_to_tool, file bent.urdf with" in head.replace("\n * ", " ")
    assert ", idealised within 0.0001 (rad and m)" in head.replace("\n * ", " ")


@pytest.mark.parametrize("place", ["arm.py", "somewhere"])
def test_python_goes_to_a_file_or_into_a_directory(poekin, tmp_path, place):
    assert (
        poekin(*PANDA, "--lang", "python", "--frame", "body", "--output", tmp_path / place)[0] == 0
    )
    path = tmp_path / place if place == "arm.py" else tmp_path / place / "panda.py"
    namespace: dict = {}
    exec(path.read_text(encoding="ascii"), namespace)
    chain = pk.load("panda").chain(tip="panda_hand")
    q = chain.random(0)
    np.testing.assert_allclose(
        namespace["jacobian_body"](q, np), chain.jacobian(q, "body"), rtol=0, atol=1e-14
    )


@pytest.mark.parametrize("place", ["arm.js", "arm.MJS", "some.where"])
def test_javascript_goes_to_a_file_or_into_a_directory(poekin, tmp_path, place):
    words = ("--lang", "javascript", "--frame", "2", "--output", tmp_path / place)
    assert poekin(*PANDA, *words)[0] == 0
    path = tmp_path / place if "arm" in place else tmp_path / place / "panda.js"
    chain = pk.load("panda").chain(tip="panda_hand")
    text = emit.javascript(chain, 2, origin="the robot panda")
    assert path.read_text(encoding="ascii") == text


def test_all_links_of_a_robot_with_many_leaves_are_one_module(poekin, tmp_path):
    words = ("--lang", "javascript", "--all-links", "--output", tmp_path)
    code, out, err = poekin("emit", "panda", *words)
    assert (code, err) == (0, "")
    text = emit.javascript(pk.load("panda"), origin="the robot panda")
    assert (tmp_path / "panda.js").read_text(encoding="ascii") == text
    assert out.startswith("link_poses: 98 multiplications, ")


def test_all_links_have_no_frame_of_a_jacobian(refused, tmp_path):
    words = ("emit", "panda", "--lang", "javascript", "--all-links", "--frame", "body")
    said = refused(*words, "--output", tmp_path / "made")
    assert "--all-links: expected without --frame, which is of one chain" in said
    assert list(tmp_path.iterdir()) == []


def test_a_mimic_joint_is_in_the_text(poekin, tmp_path, crane):
    assert (
        poekin("emit", crane, "--tip", "hook", "--lang", "python", "--output", tmp_path / "arm.py")[
            0
        ]
        == 0
    )
    namespace: dict = {}
    exec((tmp_path / "arm.py").read_text(encoding="ascii"), namespace)
    chain = pk.load(crane).chain(tip="hook")
    q = chain.random(0, 5)
    np.testing.assert_allclose(namespace["fk"](q, np), chain.fk(q), rtol=0, atol=1e-14)


def test_files_that_exist_are_replaced_by_force_only(poekin, refused, tmp_path):
    (tmp_path / "panda.c").write_text("mine", encoding="ascii")
    words = (*PANDA, "--lang", "c", "--output", tmp_path)
    assert "panda.c': exists already; --force replaces it" in refused(*words)
    assert [path.name for path in tmp_path.iterdir()] == ["panda.c"]
    assert (tmp_path / "panda.c").read_text(encoding="ascii") == "mine"
    assert poekin(*words, "--force")[0] == 0
    assert "panda_fk" in (tmp_path / "panda.c").read_text(encoding="ascii")
    (tmp_path / "arm.py").write_text("mine", encoding="ascii")
    assert "--force" in refused(*PANDA, "--lang", "python", "--output", tmp_path / "arm.py")
    assert (tmp_path / "arm.py").read_text(encoding="ascii") == "mine"


def test_a_name_that_points_nowhere_exists_already(refused, tmp_path):
    (tmp_path / "arm.py").symlink_to(tmp_path / "nowhere")
    assert "exists already" in refused(*PANDA, "--lang", "python", "--output", tmp_path / "arm.py")
    assert not (tmp_path / "nowhere").exists()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ("--lang", "rust"),
            "--lang: 'c', 'python', 'javascript', 'cuda' or 'jax' expected, got 'rust'",
        ),
        (("--lang", "python", "--float"), "--float: expected together with --lang c only"),
        (
            ("--lang", "c", "--all-links"),
            "--all-links: expected together with --lang javascript only",
        ),
        (
            ("--lang", "javascript", "--all-links"),
            "--all-links: expected without --tip, which is of one chain",
        ),
        (("--lang", "c", "--frame", ""), "--frame: space, body, hybrid, cheapest or the number"),
        (
            ("--lang", "c", "--frame", "world"),
            "--frame: space, body, hybrid, cheapest or the number of a joint (from 0) expected, got 'world'",
        ),
        (("--lang", "c", "--frame", "7"), "0 to 6, got 7"),
        (("--lang", "c", "--frame", "-1"), "0 to 6, got -1"),
        (("--lang", "c", "--tip", "nose"), "nose"),
        (("--lang", "c", "--idealise", "1"), "a number from 0 to 0.05 expected"),
        (("--lang", "c", "--idealise", "-1e-4"), "a number from 0 to 0.05 expected"),
    ],
    ids=lambda x: "-".join(x) if isinstance(x, tuple) else "",
)
def test_what_cannot_be_is_refused_and_nothing_is_written(refused, tmp_path, words, message):
    assert message in refused(*PANDA, *words, "--output", tmp_path / "made")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("language", "place", "expected"),
    [
        ("c", "arm.c", "a directory expected with --lang c, got "),
        ("c", "arm.h", "a directory expected with --lang c, got "),
        ("python", "arm.MJS", "a directory or a .py file expected with --lang python, got "),
        ("javascript", "arm.py", "a directory or a .js file or a .mjs file expected with --lang "),
    ],
)
def test_a_file_of_another_language_is_refused_and_no_directory_made(
    refused, tmp_path, language, place, expected
):
    said = refused(*PANDA, "--lang", language, "--output", tmp_path / place)
    assert said.startswith(f"poekin: error: --output: {expected}")
    assert list(tmp_path.iterdir()) == []


def test_places_that_cannot_be_written_are_refused(refused, tmp_path):
    (tmp_path / "file").write_text("mine", encoding="ascii")
    for place, reason in (("file/deeper", "Not a directory"), ("file", "File exists")):
        said = refused(*PANDA, "--lang", "c", "--output", tmp_path / place)
        assert f"cannot make the directory '{tmp_path / place}': {reason}" in said
    (tmp_path / "arm.py").mkdir()
    assert "cannot write" in refused(
        *PANDA, "--lang", "python", "--force", "--output", tmp_path / "arm.py"
    )


def test_a_robot_s_hostile_name_names_no_other_place(poekin, tmp_path):
    path, made = tmp_path / "hostile.urdf", tmp_path / "made"
    path.write_text(
        '<robot name="../../*/ x&#10;??/"><link name="a"/><link name="*/b"/><joint name="??/" type="continuous">'
        '<parent link="a"/><child link="*/b"/><axis xyz="0 0 1"/></joint></robot>',
        encoding="utf-8",
    )
    assert poekin("emit", path, "--lang", "c", "--output", made)[0] == 0
    assert sorted(p.name for p in made.iterdir()) == ["x.c", "x.h", "x_selftest.c"]
    header = (made / "x.h").read_text(encoding="ascii")
    assert "'<U+003F><U+003F>/'" in header
    assert "'<U+002A>/b'" in header
    assert "??/" not in header


def test_ik_is_three_files_of_all_solutions(poekin, tmp_path):
    code, _, err = poekin("emit", "puma560", "--ik", "--lang", "c", "--output", tmp_path / "made")
    assert (code, err) == (0, "")
    chain = pk.load("puma560").chain()
    source = emit.c_ik(chain, name="puma560", origin="the robot puma560")
    written = {
        path.name: path.read_text(encoding="ascii") for path in (tmp_path / "made").iterdir()
    }
    assert written == source.files
    assert sorted(written) == ["puma560_ik.c", "puma560_ik.h", "puma560_ik_selftest.c"]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (
            ("--lang", "python"),
            "--ik: expected together with --lang c only, it is not written in python",
        ),
        (("--lang", "javascript"), "it is not written in javascript yet"),
        (("--lang", "c", "--float"), "--ik: expected without --float"),
        (("--lang", "c", "--frame", "body"), "--ik: expected without --frame"),
    ],
)
def test_ik_with_what_it_cannot_do_is_refused(options, said, poekin, tmp_path):
    code, _, err = poekin("emit", "puma560", "--ik", *options, "--output", tmp_path / "made")
    assert code != 0
    assert said in " ".join(err.split())


def test_ik_of_an_arm_without_a_closed_form_says_why(poekin, tmp_path):
    code, _, err = poekin(*PANDA, "--ik", "--lang", "c", "--output", tmp_path / "made")
    assert code != 0
    assert "expected an arm of one to six joints" in " ".join(err.split())
