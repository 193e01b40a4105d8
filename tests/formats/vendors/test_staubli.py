"""Stäubli's arm.cfx: what it holds is said, and no model is made of offsets of unknown order."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import ModelError
from poekin.formats.vendors import staubli
from tests.messages import says

# The shape of configs/arm.cfx of an RX160 (shfo2277/bead-grinding-system), whose offsets are all 0.
LINK = '<DH index="{}" theta="0" d="0" a="{}" b="0" alpha="0" beta="{}" />'
ARM = """<?xml version="1.0" encoding="utf-8" ?>
<arm>
  <String name="arm" value="rx160-S1" />
  <DhArray name="dhOffset" >
    {}
  </DhArray>
  <FloatArray name="zeroOffset"><Float index="0" value="3" /></FloatArray>
</arm>
"""
INSTEAD = (
    "f.cfx: Stäubli's offsets (dhOffset) are to a DH table that is not in the file, and the order of"
    " their turns is not published: pk.calibration.from_fk makes the calibrated arm out of the"
    " controller's own forward kinematics"
)


def arm(a="0", beta="0"):
    links = [LINK.format(i, "0", "0") for i in range(5)]
    return ARM.format("\n    ".join([*links, LINK.format(5, a, beta)]))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            arm(),
            "f.cfx: all 36 offsets (dhOffset) are 0: the axes of this arm are the nominal ones, and no"
            " calibrated model is needed",
        ),
        (arm(a="0.12"), INSTEAD),
        (arm(beta="-1e-3"), INSTEAD),
        (
            arm().replace("dhOffset", "dhOther"),
            "f.cfx: there are no offsets (dhOffset) in it: Stäubli did not calibrate this arm, and"
            " the nominal model is all there is",
        ),
    ],
    ids=["zeros", "a length", "a turn", "none"],
)
def test_what_it_holds_is_said(text, message):
    assert says(staubli.refusal(text, "f.cfx"), message)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (arm(a="0,1"), "f.cfx:10: a: expected a number, got '0,1'"),
        ("<robot/>", "f.cfx: expected Stäubli's <arm>, got <robot>"),
        ("<<<<<<< HEAD\n" + arm(), "f.cfx:1: malformed XML: ..."),
        ("<!DOCTYPE arm><arm/>", "f.cfx:1: a document type declaration (DOCTYPE) is refused: ..."),
        ("", "f.cfx: the text is empty"),
    ],
    ids=["a comma", "a robot", "conflict marks", "a DOCTYPE", "empty"],
)
def test_what_is_no_arm_cfx_is_refused_with_its_line(text, message):
    with pytest.raises(ModelError) as caught:
        staubli.refusal(text, "f.cfx")
    assert says(caught.value, message)


@given(st.text(max_size=40))
def test_any_text_in_an_offset_is_refused_with_an_error_of_ours(text):
    try:
        fault = staubli.refusal(arm(beta=text), "f.cfx")
    except ModelError as refusal:
        fault = refusal
    assert str(fault).isprintable()


@pytest.mark.parametrize("name", ["arm.cfx", "arm.CFX"])
def test_whoever_reads_it_is_told(name, tmp_path):
    path = tmp_path / name
    path.write_text(arm(beta="0.02"), encoding="utf-8")
    robot = pk.load("puma560")
    for read in (pk.load, pk.vendors.read, lambda file: pk.calibration.apply(robot, file)):
        with pytest.raises(ModelError) as caught:
            read(path)
        assert says(caught.value, INSTEAD.replace("f.cfx", str(path)))
