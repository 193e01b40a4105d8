"""The text of /robot_description, out of everything that ROS prints it with."""

from __future__ import annotations

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from poekin.errors import ModelError, PoekinError
from poekin.formats import catalogue, erd, urdf
from poekin.formats.content.robots import from_text
from poekin.formats.load import load
from poekin.formats.ros import description
from tests.formats.ros_text import PRINTED, echo, echo_cut, echo_field, param_get

ARM = """<robot name="{name}">{gap}<link name="a"/>{gap}<link name="b"/>{gap}<joint name="j" type="continuous">
<parent link="a"/><child link="b"/><origin xyz="0.1 0 0"/></joint>{gap}</robot>"""

# YAML chooses another form of quotes for each of these, or none at all.
GAPS = {"on one line": "", "on lines": "\n", "indented": "\n  ", "tabs": "\n\t", "CR": "\r\n"}
QUOTES = {"on one line": "'<", "on lines": "'<", "indented": '"<', "tabs": '"<', "CR": '"<'}


def arm(gap: str, name: str = "r") -> str:
    text = ARM.format(name=name, gap=gap)
    if not gap:
        text = text.replace("\n", "")
    return text


@pytest.mark.parametrize("printed", PRINTED)
@pytest.mark.parametrize("gap", GAPS)
def test_a_description_is_the_robot_whatever_prints_it(printed, gap):
    text = arm(GAPS[gap])
    assert from_text(PRINTED[printed](text)) == urdf.read_text(text)


def test_the_texts_are_in_every_form_that_yaml_has():
    texts = {gap: echo(arm(GAPS[gap])) for gap in GAPS}
    plain = echo("<robot name='r'><link name='a'/></robot>")
    assert plain.startswith("data: <robot")
    starts = {gap: text.removeprefix("data: ")[:2] for gap, text in texts.items()}
    assert starts["on lines"] == "'<"
    assert {starts[gap] for gap in ("indented", "tabs", "CR")} == {'"<'}


@given(
    name=st.text(st.characters(codec="utf-8", exclude_characters='<>&"', exclude_categories=["C"])),
    gap=st.sampled_from(sorted(GAPS.values())),
    printed=st.sampled_from(sorted(PRINTED)),
)
def test_names_in_every_script_come_through(name, gap, printed):
    text = arm(gap, name or "r")
    whole = PRINTED[printed](text)
    for content in (whole, whole.encode(), whole.encode("utf-8-sig"), whole.encode("utf-16")):
        assert from_text(content) == urdf.read_text(text)


@pytest.mark.parametrize("name", catalogue.NAMES)
@pytest.mark.parametrize("printed", PRINTED)
def test_the_built_in_robots_come_through(name, printed):
    text = catalogue.text(name).decode()
    assert from_text(PRINTED[printed](text)) == load(name)


def test_the_robots_of_example_robot_data_come_through():
    try:
        paths, _ = erd.example_robots()
    except PoekinError:
        pytest.skip("example-robot-data is not installed")
    for path in list(paths.values())[::6]:
        with open(path, encoding="utf-8", newline="") as stream:
            text = stream.read()
        with pytest.warns() if "iris" in path else _quiet():
            expected = load(path)
            assert from_text(echo(text)) == expected, path


def _quiet():
    import warnings

    context = warnings.catch_warnings()
    warnings.simplefilter("ignore")
    return context


def test_a_message_names_the_line_in_the_description():
    text = arm("\n").replace('type="continuous"', 'type="odd"')
    with pytest.raises(ModelError) as caught:
        from_text(echo(text), "standard input")
    assert str(caught.value).startswith(
        "standard input (robot_description):4: joint 'j': type must"
    )


LONG = arm("\n  ", "r" * 200)
CURE = "add --full-length, as in ros2 topic echo --once --full-length /robot_description"
REFUSED = {
    "cut": (
        echo_cut(LONG),
        f"t:1: the text was cut by `ros2 topic echo` after 128 characters: {CURE}",
    ),
    "cut at another length": (
        echo_cut(LONG, 40),
        f"t:1: the text was cut by `ros2 topic echo` after 40 characters: {CURE}",
    ),
    "cut, of one field": (
        echo_field(LONG[:128] + "..."),
        f"t: the text was cut by `ros2 topic echo` after 128 characters: {CURE}",
    ),
    "cut, as CSV": (
        LONG[:128] + "...\n",
        f"t: the text was cut by `ros2 topic echo` after 128 characters: {CURE}",
    ),
    "its length": (
        echo("<string length: <4711>>"),
        "t:1: expected the text, got its length: ros2 topic echo --once --full-length"
        " /robot_description, without --no-str",
    ),
    "another text": (
        echo("hello"),
        "t:1: expected a URDF, which begins with <, got 'hello'",
    ),
    "no text": (param_get(""), "t: expected a URDF, which begins with <, got ''"),
    "another message": (
        "header:\n  stamp:\n    sec: 1\n---\n",
        "t: expected the text of /robot_description (data: or robot_description:), there is none in it",
    ),
    "a list": (
        "data:\n- 1\n- 2\n",
        "t: expected the text of /robot_description (data: or robot_description:), there is none in it",
    ),
    "an alias": (
        "---\na: &x '<robot/>'\ndata: *x\n",
        "t: expected the text of /robot_description (data: or robot_description:), there is none in it",
    ),
    "what ros2 says besides": (
        "A message was lost!!!\n\ttotal count change:1\n" + echo(arm("\n")),
        "t:1: expected a URDF, an MJCF, /robot_description as ROS prints it, a DH table or a calibration, got"
        " 'A message was lost!!!'; a model may begin on line 3: what stands before it is another program's word"
        " (2>/dev/null keeps errors out of a pipe; for a topic: ros2 topic echo --once --full-length"
        " /robot_description)",
    ),
    "no parameter": (
        "Parameter not set.\n",
        "t:1: expected a URDF, an MJCF, /robot_description as ROS prints it, a DH table or a calibration, got"
        " 'Parameter not set.'",
    ),
    "no YAML": ("data: '<robot\n", "t:2: not YAML: found unexpected end of stream"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_no_description_is_refused_with_the_cure(case):
    text, message = REFUSED[case]
    with pytest.raises(ModelError) as caught:
        from_text(text, "t")
    assert str(caught.value) == message


def test_what_comes_behind_the_first_message_is_not_read():
    text = arm("\n")
    assert from_text(echo(text) + "data: }{\n") == urdf.read_text(text)
    assert from_text(echo_field(text) * 2) == urdf.read_text(text)


def test_three_hyphens_in_a_text_of_the_urdf_end_nothing():
    text = "<robot name='r'><author>\n---\n</author><link name='a'/></robot>"
    assert from_text(text) == urdf.read_text(text)
    assert description.without_mark(echo_field(text), "t") == text + "\n"


def test_yaml_that_would_grow_or_run_does_not():
    with pytest.raises(ModelError, match="expected at most 8 levels"):
        from_text("---\na: " + "[" * 100_000)
    bomb = "---\na: &a [x, x]\n" + "".join(
        f"{chr(98 + k)}: &{chr(98 + k)} [*{chr(97 + k)}, *{chr(97 + k)}]\n" for k in range(20)
    )
    with pytest.raises(ModelError, match="there is none in it"):
        from_text(bomb)
    text = "data: !!python/object/apply:os.system ['exit 1']\n"
    assert yaml.compose(text) is not None
    with pytest.raises(ModelError, match="there is none in it"):
        from_text(text)
