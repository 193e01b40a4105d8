"""What a FILE may be: a URDF, MJCF, table or built-in name everywhere, and xacro where --xacro says
so.
"""

from __future__ import annotations

import importlib.util
import inspect

import pytest

from poekin.cli.model import model, takes_models
from poekin.errors import ModelError

needs_xacro = pytest.mark.skipif(
    importlib.util.find_spec("xacrodoc") is None, reason="xacrodoc is not installed"
)
needs_mujoco = pytest.mark.skipif(
    importlib.util.find_spec("mujoco") is None, reason="mujoco is not installed"
)
needs_pin = pytest.mark.skipif(
    importlib.util.find_spec("pinocchio") is None, reason="pin is not installed"
)

XACRO = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="length" default="${1/2}"/>
<link name="a"/><link name="b"/><joint name="j" type="continuous"><parent link="a"/><child link="b"/>
<origin xyz="$(arg length) 0 0"/><axis xyz="0 0 1"/></joint></robot>"""

MJCF = """<mujoco model="m"><worldbody><body name="a" pos="1 0 0"><geom size="1"/>
<joint name="j" axis="0 0 1" pos="0.5 0 0" ref="30"/></body></worldbody></mujoco>"""


def test_a_command_that_takes_models_keeps_its_name_and_its_text():
    def command(model: str) -> None:
        """What it does."""

    made = takes_models(command)
    assert (made.__name__, made.__doc__) == ("command", "What it does.")
    assert {"model", "xacro", "arm"} <= inspect.signature(made).parameters.keys()


COMMANDS = {
    "info": ([], []), "fk": ([], ["0.5"]), "jacobian": ([], ["--frame", "body", "0.5"]), "urdf": ([], []),
    "axes": ([], []), "compare": (["puma560"], []), "validate": ([], ["--samples", "2"]),
}  # fmt: skip


@pytest.fixture
def arm(tmp_path):
    """The path of a xacro file."""
    path = tmp_path / "arm.urdf.xacro"
    path.write_text(XACRO)
    return path


@pytest.mark.parametrize("command", [c for c in COMMANDS if c != "validate"])
def test_no_command_evaluates_xacro_unasked(command, refused, arm):
    before, after = COMMANDS[command]
    assert "xacro evaluates expressions" in refused(command, *before, arm, *after)


def test_validate_does_not_either(poekin, arm):
    code, _, err = poekin("validate", arm)
    assert code == 2
    assert "xacro evaluates expressions" in err


@needs_xacro
@needs_pin
@pytest.mark.parametrize("command", [c for c in COMMANDS if c != "compare"])
def test_every_command_takes_xacro_when_asked(command, poekin, arm):
    before, after = COMMANDS[command]
    code, out, err = poekin(command, *before, arm, "--xacro", *after)
    assert (code, err) == (0, "")
    assert out


@needs_xacro
@pytest.mark.parametrize("words", [["0"], ["a"]])
def test_what_is_read_after_a_command_is_evaluated_only_if_asked_again(poekin, arm, words):
    assert poekin("fk", arm, *words, "--xacro")[0] == (0 if words == ["0"] else 2)
    with pytest.raises(ModelError, match="xacro evaluates expressions"):
        model(str(arm))


@needs_xacro
def test_arguments_go_to_xacro_and_only_for_that_command(as_json, refused, arm):
    def place(*words):
        return as_json("fk", arm, "0", *words)["T"][0][3]

    assert place("--xacro") == 0.5
    assert place("--xacro", "--xacro-arg", "length=0.25") == 0.25
    assert "xacro evaluates expressions" in refused("info", arm)
    assert "--xacro-arg: expected together with --xacro only" in refused(
        "info", arm, "--xacro-arg", "length=1"
    )
    for bad in ("length", "=1"):
        assert f"--xacro-arg: expected NAME=VALUE, got '{bad}'" in refused(
            "info", arm, "--xacro", "--xacro-arg", bad
        )
    assert "division by zero" in refused("info", arm, "--xacro", "--xacro-arg", "length=${1/0}")


@needs_xacro
def test_a_model_may_be_named_by_its_package(poekin, refused, tmp_path, monkeypatch):
    package = tmp_path / "share" / "my_arm"
    package.mkdir(parents=True)
    index = tmp_path / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "my_arm").touch()
    (package / "arm.xacro").write_text(XACRO)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    code, text, err = poekin("urdf", "package://my_arm/arm.xacro", "--xacro")
    assert (code, err) == (0, "")
    (package / "arm.urdf").write_text(text)
    assert poekin("urdf", "package://my_arm/arm.urdf")[1] == text
    out = tmp_path / "out"
    words = ("--lang", "python", "--output", out)
    assert poekin("emit", "package://my_arm/arm.urdf", *words)[0] == 0
    head = (out / "r.py").read_text().replace("\n", " ")
    assert "file arm.urdf with the SHA-256 " in head
    for name, message in (
        (
            "package://no_arm/arm.urdf",
            "there is no package 'no_arm' in AMENT_PREFIX_PATH (folders: 1)",
        ),
        ("package://my_arm/../arm.urdf", "expected package://PACKAGE/PATH"),
        ("package://my_arm/gone.urdf", "gone.urdf: cannot be read: No such file"),
    ):
        assert message in refused("urdf", name, "--output", tmp_path / "gone")
        assert not (tmp_path / "gone").exists()


@needs_xacro
def test_compare_reads_xacro_beside_other_models(poekin, arm, tmp_path):
    code, text, _ = poekin("urdf", arm, "--xacro")
    assert code == 0
    (tmp_path / "arm.urdf").write_text(text)
    assert poekin("compare", arm, tmp_path / "arm.urdf", "--xacro", "--samples", 3)[0] == 0
    assert "is a tree" in poekin("compare", arm, "panda", "--xacro")[2]


@needs_mujoco
@needs_pin
def test_validate_takes_mjcf_tables_and_built_in_names(poekin, as_json, tmp_path):
    (tmp_path / "m.xml").write_text(MJCF)
    (tmp_path / "t.csv").write_text(
        "convention,theta,d,a,alpha\nstandard,0,1,0.5,1\nstandard,1,0,0.5,0\n"
    )
    code, out, err = poekin(
        "validate", tmp_path / "m.xml", tmp_path / "t.csv", "puma560", "--samples", 3
    )
    assert (code, err) == (0, "")
    assert out.endswith("3 of 3 robots pass\n")
    (robot,) = as_json("validate", tmp_path / "m.xml", "--samples", 3)["robots"]
    assert (robot["robot"], robot["moving"]) == ("m", 1)
    assert as_json("fk", tmp_path / "m.xml", "0.5235987755982988")["T"][0][3] == pytest.approx(
        1, abs=1e-15
    )
