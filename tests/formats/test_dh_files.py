"""DH tables as TOML and CSV files."""

import math

import numpy as np
import pytest
from hypothesis import given, settings

import poekin as pk
from poekin.errors import FileError, InputError, ModelError
from poekin.formats.dh import Row, Table, table_io
from poekin.testing.strategies.dh_strategies import tables
from tests.messages import says

TOML = """
convention = "modified"
name = "two"
tool = [[1, 0, 0, 0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]

[[joint]]
theta = 0.5
d = 0.3
a = 0
alpha = 0

[[joint]]
name = "slide"
kind = "prismatic"
theta = 0
d = 0.1
a = 0.2
alpha = -1.5707963267948966
flip = true
limits = [0, 0.5]
"""
CSV = """convention,name,kind,theta,d,a,alpha,flip,lower,upper,pose
modified,,tool,,,,,,,,1 0 0 0.1 0 1 0 0 0 0 1 0
modified,,revolute,0.5,0.3,0,0,,,,
modified,slide,prismatic,0,0.1,0.2,-1.5707963267948966,true,0,0.5,
"""


@pytest.mark.parametrize("ending", [".toml", ".csv"])
@settings(max_examples=30)
@given(table=tables(max_joints=4))
def test_a_table_comes_back_from_its_file_to_the_last_digit(ending, table):
    again = table_io.read_text(table_io.make_text(table, ending), f"arm{ending}")
    assert again == table


@pytest.mark.parametrize("ending", [".toml", ".csv"])
def test_a_table_without_joints_comes_back_where_it_has_a_tool(ending):
    table = Table("modified", [], tool=pk.se3.exp([0.5, 0, 0, 0, 0, 0.25]))
    again = table_io.read_text(table_io.make_text(table, ending), f"arm{ending}")
    assert again == table


def test_both_files_say_the_same():
    a, b = table_io.read_text(TOML, "two.toml"), table_io.read_text(CSV, "two.csv")
    assert a == b
    assert a.rows[1] == Row(0, 0.1, 0.2, -math.pi / 2, "prismatic", True, "slide", (0, 0.5))
    assert a.tool[0, 3] == 0.1


def test_a_file_is_written_read_and_loaded_as_a_robot(tmp_path):
    table = table_io.read_text(TOML, "two.toml")
    for name in ("two.toml", "two.CSV"):
        pk.dh.write(table, tmp_path / name)
        assert pk.dh.read(tmp_path / name) == table
        robot = pk.load(tmp_path / name)
        assert robot.q_names == ("joint1", "slide")
        np.testing.assert_array_equal(robot.limits[1], [0, 0.5])
        x = [0.4, 0.2]
        np.testing.assert_allclose(
            robot.chain().fk(x), pk.dh.to_chain(table).fk(x), rtol=0, atol=1e-15
        )


def test_semicolons_and_decimal_commas_of_a_spreadsheet_are_read(tmp_path):
    lines = (
        "convention;kind;name;theta;d;a;alpha;upper;pose",
        "standard;revolute;b, 1,5;0;0,1807;-0,6;1,5;2,5;",
        "standard;tool;;;;;;;1 0 0 0,5 0 1 0 0 0 0 1 0",
    )
    (tmp_path / "a.csv").write_text("\n".join(lines))
    table = table_io.read(tmp_path / "a.csv")
    [row] = table.rows
    assert (row.name, row.d, row.a, row.limits[1]) == ("b, 1,5", 0.1807, -0.6, 2.5)
    assert table.tool[0, 3] == 0.5


def test_empty_lines_of_a_spreadsheet_are_passed_over():
    text = "convention,theta,d,a,alpha,lower\n,,,, ,\nstandard,0,1,0,0,\n,,,,,\nstandard,0,2,0,0,\n,,,,,\n"
    assert table_io.read_text(text, "a.csv").d.tolist() == [1, 2]


def test_columns_of_a_csv_may_stand_in_any_order():
    text = "d,a,alpha,theta,convention\n0.1,0.2,0.3,0.4,standard\n"
    assert table_io.read_text(text, "t.csv") == Table(
        "standard", [Row(0.4, 0.1, 0.2, 0.3)], name="t"
    )


POSED = "convention,theta,d,a,alpha,kind,pose\n"
UNIT = "1 0 0 0 0 1 0 0 0 0 1 0"
JOINT = "convention = 'standard'\n[[joint]]\ntheta = 0\nd = 0\na = 0\nalpha = 0\n"


@pytest.mark.parametrize(
    "text, message",
    [
        (
            "theta,d,a,alpha\n",
            "t.csv:1: convention is missing",
        ),
        (
            "convention,theta,d,a\n",
            "t.csv:1: alpha is missing",
        ),
        ("convention,theta,d,a,alhpa\n", "t.csv:1: no such key: 'alhpa'; did you mean 'alpha'?"),
        (
            "convention,theta,d,a,alpha\nstandard,1,2,3\n",
            "t.csv:2: expected 5 columns as in the header, got 4",
        ),
        (
            "convention,theta,d,a,alpha\nstandard,1,2,3,4,5\n",
            "t.csv:2: expected 5 columns as in the header, got 6",
        ),
        (
            "convention,theta,d,a,alpha\nstandard,1,2,3,x\n",
            "t.csv:2: alpha: expected a number, got 'x'",
        ),
        (
            "convention,theta,d,a,alpha\nstandard,1,2,nan,1\n",
            "t.csv:2: a: expected finite numbers, got nan",
        ),
        (
            "convention,theta,d,a,alpha\nstandard,1,2,3,1\nmodified,1,2,3,1\n",
            "t.csv:3: mixed conventions: 'modified' after 'standard'",
        ),
        (
            "convention,theta,d,a,alpha\ncraig,1,2,3,1\n",
            "t.csv: convention: expected 'standard' or 'modified', got 'craig'; ...",
        ),
        (
            "convention,theta,d,a,alpha,kind,pose\nstandard,,,,,base,1 2\n",
            "t.csv:2: pose: expected a list of 12 numbers, got 2 of them",
        ),
        (
            f"{POSED}standard,,,,,base,{UNIT} 0\n",
            "t.csv:2: pose: expected a list of 12 numbers, got 13 of them",
        ),
        (
            'convention,theta,d,a,alpha\nstandard,1,2,3,"0,5"\n',
            "t.csv:2: alpha: expected a number, got '0,5'",
        ),
        (
            "convention,theta,d,a,alpha,flip\nstandard,1,2,3,1,no\n",
            "t.csv:2: flip: expected true or false, got 'no'",
        ),
        (
            "convention,theta,d,a,alpha,kind\nstandard,1,2,3,1,ball\n",
            "t.csv:2: kind: expected 'revolute' or 'prismatic', got 'ball'",
        ),
        (
            "convention,theta,d,a,alpha,lower,upper\nstandard,1,2,3,1,2,1\n",
            "t.csv:2: limits: expected lower <= upper, got 2.0 and 1.0",
        ),
        (
            "convention,theta,theta,d,a,alpha\nstandard,1,2,3,4,5\n",
            "t.csv:1: theta: it appears 2 times, expected once",
        ),
        (
            f"{POSED}modified,1,2,3,1,,\nstandard,,,,,base,{UNIT}\n",
            "t.csv:3: mixed conventions: 'standard' after 'modified'",
        ),
        (
            f"{POSED}standard,,,,,tool,{UNIT}\n,,,,,tool,{UNIT}\n",
            "t.csv:3: a second row of the kind tool, expected one at most",
        ),
        ("convention,theta\rstandard,1\r", "t.csv:1: new-line character..."),
        ('convention,theta,d,a,alpha\n"standard\n', "t.csv:1: unexpected end of data..."),
        ("", "t.csv:1: convention is missing"),
    ],
)
def test_a_bad_csv_is_refused_with_its_line(text, message):
    with pytest.raises(ModelError) as caught:
        table_io.read_text(text, "t.csv")
    assert says(caught.value, message)


@pytest.mark.parametrize(
    "text, message",
    [
        ("convention =", "t.toml: not TOML: ..."),
        ("name = 'x'", "t.toml: convention: expected 'standard' or 'modified', got None; ..."),
        (
            "convention = 'standard'\ncolour = 1",
            "t.toml: no such key: 'colour'; available: 'convention', 'name', 'source', 'base', 'tool' and 2 more",
        ),
        ("convention = 'standard'\njoint = 3", "t.toml: joint: expected [[joint]] tables, got 3"),
        (
            "convention = 'standard'\n[[joint]]\ntheta = 0\nd = 0\na = 0",
            "t.toml: joint 1: alpha is missing",
        ),
        (
            "convention = 'standard'\n[[joint]]\ntheta = 'x'\nd = 0\na = 0\nalpha = 0",
            "t.toml: joint 1: theta: expected a number, got 'x'",
        ),
        (
            "convention = 'standard'\n[[joint]]\ntheta = 0\nd = nan\na = 0\nalpha = 0",
            "t.toml: joint 1: d: expected finite numbers, got nan",
        ),
        (
            f"convention = 'standard'\n[[joint]]\ntheta = {'9' * 400}\nd = 0\na = 0\nalpha = 0",
            "t.toml: joint 1: theta: expected finite numbers, got inf",
        ),
        (
            f"convention = 'standard'\n[[joint]]\ntheta = {'9' * 5000}\nd = 0\na = 0\nalpha = 0",
            "t.toml: not TOML: ...",
        ),
        (
            f"{JOINT}limits = [1, 0]",
            "t.toml: joint 1: limits: expected lower <= upper, got 1.0 and 0.0",
        ),
        (
            f"{JOINT}{JOINT.partition(chr(10))[2]}limits = [1, 0]",
            "t.toml: joint 2: limits: expected lower <= upper, got 1.0 and 0.0",
        ),
        (f"convention = {'[' * 5000}", "t.toml: not TOML: its brackets are nested too deeply"),
        (
            "convention = 'standard'\nbase = [[1, 2], [3, 4]]",
            "t.toml: base: expected shape (..., 4, 4), got (2, 2)",
        ),
        (
            "convention = 'standard'\n[[joint]]\ntheta=0\nd=0\na=0\nalpha=0\nlimits=[1]",
            "t.toml: joint 1: limits: expected a list of 2 numbers, got 1 of them",
        ),
        (
            "convention = 'standard'\n[[joint]]\ntheta=0\nd=0\na=0\nalpha=0\nflip=1",
            "t.toml: joint 1: flip: expected true or false, got 1",
        ),
        (
            "convention = 'standard'\n[[joint]]\ntheta=0\nd=0\na=0\nalpha=0\nkind=5",
            "t.toml: joint 1: kind: expected a text, got 5",
        ),
        (
            "convention = 'standard'\n[[joint]]\ntheta=0\nd=0\na=0\nalpha=0\nname=5",
            "t.toml: joint 1: name: expected a text, got 5",
        ),
    ],
)
def test_a_bad_toml_is_refused(text, message):
    with pytest.raises(ModelError) as caught:
        table_io.read_text(text, "t.toml")
    assert says(caught.value, message)


def test_a_place_that_cannot_be_written_and_an_ending_that_says_nothing_are_refused(tmp_path):
    table = Table("standard", [Row()])
    with pytest.raises(FileError) as unwritten:
        pk.dh.write(table, tmp_path / "none" / "t.csv")
    assert says(
        unwritten.value, f"cannot write '{tmp_path / 'none' / 't.csv'}': No such file or directory"
    )
    with pytest.raises(InputError) as caught:
        pk.dh.write(table, tmp_path / "t.txt")
    assert says(caught.value, f"{tmp_path / 't.txt'}: expected a file ending in .toml or .csv")
    with pytest.raises(
        InputError,
        match=(
            r"^write: expected a dh\.Table, got <Chain 'base' -> 'tool': 1 revolute joint, reach 1 m>; "
            r"dh\.read\(path\), dh\.published\(name\) and dh\.from_chain\(\.\.\.\)\.table make one$"
        ),
    ):
        pk.dh.write(pk.dh.to_chain(table), tmp_path / "t.csv")  # pyright: ignore[reportArgumentType]
    for call in (pk.dh.read, lambda path: pk.dh.write(table, path)):
        with pytest.raises(InputError, match=r"^expected the path of a file, got 5$"):
            call(5)  # pyright: ignore[reportArgumentType]
    (tmp_path / "t.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(FileError) as caught:
        pk.dh.read(tmp_path / "t.csv")
    assert says(caught.value, f"{tmp_path / 't.csv'}: not UTF-8 at byte 0")


def test_a_file_that_cannot_be_finished_leaves_the_one_that_was_there(tmp_path, monkeypatch):
    place = tmp_path / "t.csv"
    pk.dh.write(Table("standard", [Row(d=1.0)]), place)
    before = place.read_bytes()

    def full(_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(FileError, match="No space left on device"):
        pk.dh.write(Table("standard", [Row(d=2.0)]), place)
    assert [path.name for path in tmp_path.iterdir()] == ["t.csv"]
    assert place.read_bytes() == before
