"""Vendors' calibrations as models of the command line: read everywhere, refused with one message."""

from __future__ import annotations

import gzip
import io
import json
import sys
import zipfile

import pytest

import poekin as pk
from tests.formats.vendors.origins import (
    RIZON_4S,
    RIZON_AXES,
    RIZON_FLANGE,
    UFACTORY,
    UR5E,
    UR_LINKS,
    yaml,
)

XARM6 = yaml(UFACTORY["xarm6"])
FILES = {
    "universal_robots": (yaml(UR5E, names=UR_LINKS), "tool0"),
    "ufactory": (XARM6, "link_eef"),
    "flexiv": (yaml(RIZON_4S, axes=RIZON_AXES, flange=RIZON_FLANGE), "flange"),
}
STAUBLI = '<arm><DhArray name="dhOffset"><DH index="0" beta="0.02"/></DhArray></arm>'
WRONG = {
    "UFACTORY: degrees": (
        XARM6.replace("-1.5708", "-90°", 1),
        "expected a finite number, got '-90°'",
    ),
    "UFACTORY: a joint twice": (XARM6.replace("joint6", "joint5"), "'joint5' appears twice"),
    "UFACTORY: cut off": (XARM6[:-60], "missing; expected are"),
    "Flexiv: an axis of two numbers": (
        yaml(RIZON_4S, axes=("0 1",)),
        "axis: expected three numbers, as 0 1 0, got '0 1'",
    ),
    "Flexiv: two arms": (
        "kinematics:\n  ARM_1:\n" + yaml(RIZON_4S, indent="  "),
        "it has the arms 'ARM_1', and none was named",
    ),
    "Flexiv: an arm that nobody knows": (
        yaml([(0, 0, 0.5, 0, 0, 0)] * 7),
        "this is near none that is known",
    ),
    "nobody's": ("kinematics:\n  a: 1\n", "expected shoulder, upper_arm, "),
}


@pytest.mark.parametrize(("text", "tip"), FILES.values(), ids=FILES)
def test_a_vendor_s_file_is_a_model(text, tip, as_json, tmp_path):
    path = tmp_path / "kinematics.yaml"
    path.write_text(text, encoding="utf-8")
    assert as_json("axes", path)["tip"] == tip


@pytest.mark.parametrize(("text", "said"), WRONG.values(), ids=WRONG)
def test_a_wrong_one_is_refused_and_nothing_is_written(text, said, refused, tmp_path):
    path = tmp_path / "kinematics.yaml"
    path.write_text(text, encoding="utf-8")
    assert said in refused("info", path)
    assert said in refused("urdf", path, "--output", tmp_path / "out.urdf")
    assert list(tmp_path.iterdir()) == [path]


def test_staubli_s_file_is_refused_with_what_to_do_instead(refused, tmp_path):
    path = tmp_path / "arm.cfx"
    path.write_text(STAUBLI, encoding="utf-8")
    assert "pk.calibration.from_fk" in refused("urdf", path, "--output", tmp_path / "out.urdf")
    assert list(tmp_path.iterdir()) == [path]


ONE = yaml(RIZON_4S, axes=RIZON_AXES, flange=RIZON_FLANGE, indent="  ").removeprefix(
    "kinematics:\n"
)
OTHER = ONE.replace("0.155", "0.156", 1)
TWO_ARMS = f"kinematics:\n  ARM_1:\n{ONE}  ARM_2:\n{OTHER}"


def test_an_arm_of_a_file_that_holds_several_is_a_model_and_a_calibration(poekin, tmp_path):
    path, nominal, out = (tmp_path / name for name in ("two.yaml", "one.urdf", "out.urdf"))
    path.write_text(TWO_ARMS, encoding="utf-8")
    for arm, height in (("ARM_1", 0.155), ("ARM_2", 0.156)):
        joint = pk.vendors.read(path, arm=arm).to_robot().joints[0]
        assert joint.origin[2, 3] == height
        urdf = poekin("urdf", path, "--arm", arm)[1]
        assert pk.from_text(urdf).joints[0].origin[2, 3] == height
    assert poekin("urdf", path, "--arm", "ARM_1", "--output", nominal)[0] == 0
    assert poekin("apply", nominal, path, "--arm", "ARM_2", "-o", out)[0] == 0
    compared = [poekin("compare", out, path, "--arm", arm)[0] for arm in ("ARM_1", "ARM_2")]
    assert compared == [3, 0]  # a base 1 mm higher is another convention


TWICE = ("--arm", "ARM_1", "--arm", "ARM_2")


def test_two_arms_of_one_file_are_compared_by_two_names(poekin, tmp_path):
    path = tmp_path / "two.yaml"
    path.write_text(TWO_ARMS, encoding="utf-8")
    for words, expected in ((TWICE, 3), (("--arm", "ARM_1"), 0), (("--arm", "ARM_2"), 0)):
        assert poekin("compare", path, path, *words)[0] == expected
    code, out, _ = poekin("compare", path, path, *TWICE, "--json")
    assert (code, json.loads(out)["base"][2][3]) == (3, pytest.approx(-0.001, abs=1e-9))
    code, out, _ = poekin("compare", path, path, *TWICE[2:], *TWICE[:2], "--json")
    assert (code, json.loads(out)["base"][2][3]) == (3, pytest.approx(0.001, abs=1e-9))


def test_an_arm_is_named_in_a_file_that_is_compressed_or_a_pipe(poekin, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    content = TWO_ARMS.encode()
    (tmp_path / "two.yaml.gz").write_bytes(gzip.compress(content))
    with zipfile.ZipFile("two.zip", "w") as archive:
        archive.writestr("two.yaml", content)
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(content)))
    for name in ("two.yaml.gz", "two.zip/two.yaml", "-"):
        code, urdf, _ = poekin("urdf", name, "--arm", "ARM_2")
        assert code == 0
        assert pk.from_text(urdf).joints[0].origin[2, 3] == 0.156
    assert poekin("compare", "two.zip/two.yaml", "two.yaml.gz", *TWICE)[0] == 3
    assert poekin("urdf", "two.yaml.gz", "--arm", "ARM_1", "--output", "one.urdf")[0] == 0
    assert poekin("apply", "one.urdf", "two.yaml.gz", "--arm", "ARM_2", "-o", "out.urdf")[0] == 0
    (tmp_path / "one.urdf.gz").write_bytes(gzip.compress((tmp_path / "one.urdf").read_bytes()))
    assert poekin("compare", "one.urdf.gz", "two.yaml.gz", "--arm", "ARM_1")[0] == 0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ["info", "two.yaml"],
            "'ARM_2', and none was named: arm= of pk.vendors.read says which, --arm on",
        ),
        (["info", "two.yaml", "--arm", "ARM_3"], "and got 'ARM_3'"),
        (["info", "ur5e", "--arm", "ARM_1"], "--arm: expected with a vendor's .yaml file"),
        (["info", "two.zip/two.yaml"], "and none was named"),
        (["info", "one.urdf.gz", "--arm", "ARM_1"], "--arm: expected with a vendor's .yaml file"),
        (
            ["compare", *["two.yaml"] * 2, *["--arm", "ARM_1"] * 3],
            "several arms, one name for each",
        ),
        (["compare", "two.yaml", "one.urdf.gz", *TWICE], "--arm: expected with a vendor's"),
        (["fk", "ur5e", "--arm", "ARM_1", "--input", "-"], "--arm: expected with a vendor's"),
        (["apply", "ur5e", "two.yaml", "-o", "out.urdf"], "and none was named"),
    ],
    ids=lambda x: " ".join(x) if isinstance(x, list) else "",
)
def test_an_arm_that_is_not_named_or_not_there_is_refused(
    words, message, refused, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "two.yaml").write_text(TWO_ARMS, encoding="utf-8")
    with zipfile.ZipFile("two.zip", "w") as archive:
        archive.write("two.yaml")
    (tmp_path / "one.urdf.gz").write_bytes(
        gzip.compress(b"<robot name='a'><link name='b'/></robot>")
    )
    assert message in refused(*words)
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "one.urdf.gz",
        "two.yaml",
        "two.zip",
    ]
