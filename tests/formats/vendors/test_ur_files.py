"""Files of calibrations: what is wrong in them is said with file and line, and none of it costs
anything.
"""

from __future__ import annotations

import builtins
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import FileError, InputError, MissingExtra, ModelError, PoekinError
from poekin.formats import vendors
from poekin.formats.text import xml
from poekin.formats.vendors import ur
from poekin.formats.vendors.ur import conf
from poekin.formats.vendors.yaml_io import make_text, read_text
from tests.messages import says

NOMINAL = pk.dh.published("ur10e")
CALIBRATION = ur.from_dh(NOMINAL, nominal=NOMINAL, hash="calib_1")
TEXT = make_text(CALIBRATION, rpy="moving")
LINES = TEXT.splitlines()
CONF = "[mounting]\n" + "".join(
    f"delta_{c} = [ 0, 1e-3, 0, 0, 0, -2.5e-4]\n" for c in ("theta", "a", "d", "alpha")
)


def changed(pattern: str, new: str, text: str = TEXT) -> str:
    """The text with the first match replaced."""
    result, count = re.subn(pattern, new, text, count=1)
    assert count == 1
    return result


def test_the_text_is_the_driver_s_form():
    assert LINES[0] == "kinematics:"
    assert LINES[1:4] == ["  shoulder:", "    x: 0.0", "    y: 0.0"]
    assert LINES[-1] == "  hash: calib_1"
    assert len(LINES) == 1 + 6 * 7 + 1
    assert make_text(CALIBRATION) == make_text(CALIBRATION, rpy="fixed")
    assert make_text(CALIBRATION).startswith("rpy: fixed\n")


def test_the_driver_s_own_way_of_writing_is_read():
    text = TEXT.replace("x: 0.0", "x: -0").replace("calib_1", '"calib_1"') + "# a comment\n"
    assert read_text(text) == CALIBRATION
    assert read_text("---\n" + TEXT + "...\n") == CALIBRATION
    assert read_text(TEXT.replace("\n", "\r\n")) == CALIBRATION


def test_a_file_says_about_which_axes_its_angles_turn_and_a_caller_may_know_better():
    tilted = vendors.FactoryCalibration(
        CALIBRATION.poses @ pk.se3.exp([0.1, 0.2, 0.3, 0, 0, 0]), "calib_1"
    )
    fixed, moving = make_text(tilted), make_text(tilted, rpy="moving")
    for text in (fixed, moving, "rpy: moving\n" + moving):
        assert np.abs(read_text(text).poses - tilted.poses).max() <= 1e-15
    assert np.abs(read_text(moving, rpy="fixed").poses - tilted.poses).max() > 0.05
    assert np.abs(read_text(fixed, rpy="moving").poses - tilted.poses).max() > 0.05


BAD = {
    "empty": ("", "f.yaml: the text is empty"),
    "comment": ("# nothing\n", "f.yaml: the text is empty"),
    "a word": (
        "kinematics\n",
        "f.yaml:1: expected a mapping, as in \"kinematics:\", got 'kinematics'",
    ),
    "a list": ("- 1\n- 2\n", "f.yaml:1: expected names and numbers, got a list"),
    "no yaml": ("kinematics: {\n", "f.yaml:2: not YAML: ..."),
    "tab": ("kinematics:\n\tshoulder: 1\n", "f.yaml:2: not YAML: ..."),
    "control character": ("kinematics: \x01\n", "f.yaml: not YAML: ..."),
    "no kinematics": (
        "joints:\n  a: 1\n",
        (
            "f.yaml:1: the file: 'joints' is not expected, only kinematics, rpy, "
            "calibration_metadata; available: 'kinematics', 'rpy', 'calibration_metadata'"
        ),
    ),
    "misspelt kinematics": (
        changed("kinematics", "kinematcs"),
        (
            "f.yaml:1: the file: 'kinematcs' is not expected, only kinematics, rpy, "
            "calibration_metadata; did you mean 'kinematics'?"
        ),
    ),
    "kinematics of nothing": (
        "kinematics:\n",
        (
            "f.yaml:1: kinematics: expected shoulder, upper_arm, forearm, wrist_1, wrist_2, "
            "wrist_3 and hash, or joint1, joint2, ... below it"
        ),
    ),
    "rpy of nothing known": ("rpy: zyx\n" + TEXT, "f.yaml:1: rpy: expected moving or fixed"),
    "rpy alone": (
        "rpy: fixed\n",
        "f.yaml:1: the file: kinematics missing; expected are kinematics, rpy, "
        "calibration_metadata",
    ),
    "misspelt link": (
        changed("forearm", "fore_arm"),
        (
            "f.yaml:16: kinematics: 'fore_arm' is not expected, only shoulder, upper_arm, "
            "forearm, wrist_1, wrist_2, wrist_3, hash; did you mean 'forearm'?"
        ),
    ),
    "missing link": (
        TEXT.replace("\n".join(LINES[36:43]) + "\n", ""),
        (
            "f.yaml:2: kinematics: wrist_3 missing; expected are shoulder, upper_arm, "
            "forearm, wrist_1, wrist_2, wrist_3, hash"
        ),
    ),
    "seventh link": (
        changed("  hash", "  wrist_4:\n    x: 1\n  hash"),
        (
            "f.yaml:44: kinematics: 'wrist_4' is not expected, only shoulder, upper_arm, "
            "forearm, wrist_1, wrist_2, wrist_3, hash; did you mean 'wrist_3' or 'wrist_2' "
            "or 'wrist_1'?"
        ),
    ),
    "link of nothing": (
        "kinematics:\n  shoulder:\n" + "\n".join(LINES[8:]),
        "f.yaml:2: shoulder: expected x, y, z, roll, pitch, yaw below it, got ''",
    ),
    "misspelt key": (
        changed("pitch", "ptich"),
        (
            "f.yaml:7: shoulder: 'ptich' is not expected, only x, y, z, roll, pitch, yaw; did you mean 'pitch'?"
        ),
    ),
    "missing key": (
        changed("    yaw: .*\n", ""),
        "f.yaml:3: shoulder: yaw missing; expected are x, y, z, roll, pitch, yaw",
    ),
    "key twice": (changed("    y: ", "    x: "), "f.yaml:4: 'x' appears twice (first: line 3)"),
    "link twice": (
        changed("upper_arm", "shoulder"),
        "f.yaml:9: 'shoulder' appears twice (first: line 2)",
    ),
    "kinematics twice": (TEXT + TEXT, "f.yaml:45: 'kinematics' appears twice (first: line 1)"),
    "nan": (
        changed("z: .*", "z: .nan"),
        "f.yaml:5: shoulder: z: expected a finite number, got '.nan'",
    ),
    "NaN": (
        changed("z: .*", "z: nan"),
        "f.yaml:5: shoulder: z: expected a finite number, got 'nan'",
    ),
    "infinite": (
        changed("z: .*", "z: 1e999"),
        "f.yaml:5: shoulder: z: expected a finite number, got '1e999'",
    ),
    "text": (
        changed("z: .*", "z: 18 cm"),
        "f.yaml:5: shoulder: z: expected a finite number, got '18 cm'",
    ),
    "nothing": (changed("z: .*", "z:"), "f.yaml:5: shoulder: z: expected a finite number, got ''"),
    "a mapping": (
        changed("z: .*", "z: {a: 1}"),
        "f.yaml:5: shoulder: z: expected a finite number, got 'more keys'",
    ),
    "far away": (
        changed("z: .*", "z: 1e200"),
        ("f.yaml: pose of shoulder: expected lengths of at most 1e+100 m, got 1e+200 in row 2"),
    ),
    "a list of numbers": (
        changed("z: .*", "z: [1, 2]"),
        "f.yaml:5: expected names and numbers, got a list",
    ),
    "a mapping for a key": (
        "? {a: 1}\n: 2\n",
        "f.yaml:1: expected the name of a key, got a mapping",
    ),
    "hash of keys": (changed("hash: .*", "hash: {a: 1}"), "f.yaml:44: hash: expected a text"),
    "anchor": (changed("z: ", "z: &a "), "f.yaml:5: tags and anchors are refused, got 'a'"),
    "alias": (changed("z: .*", "z: *a"), "f.yaml:5: expected names and numbers, got an alias"),
    "a tag": (
        changed("z: .*", "z: !!python/object/apply:os.system [id]"),
        "f.yaml:5: expected names and numbers, got a list",
    ),
    "a tagged scalar": (
        changed("z: .*", "z: !!python/name:os.system ''"),
        ("f.yaml:5: tags and anchors are refused, got 'tag:yaml.org,2002:python/name:os.system'"),
    ),
    "two documents": (
        TEXT + "---\na: 1\n",
        "f.yaml:45: expected one document, a second one begins here",
    ),
    "merge": (
        changed("    y: .*\n", "    <<: 1\n"),
        (
            "f.yaml:4: shoulder: '<<' is not expected, only x, y, z, roll, pitch, yaw; "
            "available: 'x', 'y', 'z', 'roll', 'pitch' and 1 more"
        ),
    ),
    "nine levels": (
        "".join(f"{'  ' * i}a:\n" for i in range(10)),
        "f.yaml:9: expected at most 8 levels, got more",
    ),
    "a terminal's name": (
        '"\\e[31m": 1\n',
        (
            "f.yaml:1: the file: '\\x1b[31m' is not expected, only kinematics, rpy, "
            "calibration_metadata; available: 'kinematics', 'rpy', 'calibration_metadata'"
        ),
    ),
}


@pytest.mark.parametrize(("text", "message"), BAD.values(), ids=BAD)
def test_a_fault_in_a_file_is_said_with_its_line(text, message):
    with pytest.raises(ModelError) as caught:
        read_text(text, "f.yaml")
    assert says(caught.value, message)
    assert str(caught.value).isprintable()


@pytest.mark.parametrize(
    "text",
    [
        "a: &a {x: 1}\n" + "".join(f"b{i}: [{', '.join(['*a'] * 9)}]\n" for i in range(9)),
        "[" * 60000,
        "{a: " * 15000,
        "? " * 30000,
        "a: " + "- " * 30000,
        "".join(f"{'  ' * i}a:\n" for i in range(200)),
        "!" * 60000,
    ],
    ids=["laughs", "brackets", "braces", "keys", "dashes", "levels", "tags"],
)
def test_a_file_made_to_explode_is_refused(text):
    with pytest.raises(ModelError, match=r"^f\.yaml(:\d+)?: "):
        read_text(text, "f.yaml")


@settings(max_examples=200)
@given(text=st.text(st.sampled_from("kinematics: \n-{}[]&*!|>'\"%@#,?0.e1shoulder\t"), max_size=80))
def test_any_text_at_all_is_read_or_refused_with_an_error_of_ours(text):
    with pytest.raises(PoekinError):
        read_text(text)


def test_files_that_cannot_be_read_are_refused_by_name(tmp_path):
    (tmp_path / "big.yaml").write_bytes(b"#" * (64 * 2**10 + 1))
    (tmp_path / "latin.yaml").write_bytes(b"kinematics: \xe9\n")
    (tmp_path / "empty.yaml").write_bytes(b"")
    for name, message in {
        "big.yaml": "expected at most 64 KiB, the file has 64 KiB",
        "latin.yaml": "not UTF-8 at byte 12",
        "empty.yaml": "the file is empty",
        "gone.yaml": "cannot be read: No such file or directory",
        ".": "expected a file, this is a directory",
    }.items():
        for read in (vendors.read, ur.read_deltas):
            with pytest.raises(FileError) as caught:
                read(tmp_path / name)
            assert says(caught.value, f"{tmp_path / name}: {message}")
    with pytest.raises(FileError, match=r"^gone\.yaml: no such file$"):
        pk.load("gone.yaml")
    (tmp_path / "a.yml").write_text("a: 1\n", encoding="utf-8")
    with pytest.raises(ModelError, match=r"a\.yml:1: the file: 'a' is not expected"):
        pk.load(tmp_path / "a.yml")


def test_a_byte_order_mark_is_passed_over(tmp_path):
    (tmp_path / "a.yaml").write_bytes(b"\xef\xbb\xbf" + TEXT.encode())
    assert vendors.read(tmp_path / "a.yaml") == CALIBRATION


def test_a_file_is_written_whole_or_not_at_all(tmp_path):
    path = tmp_path / "arm.yaml"
    vendors.write(CALIBRATION, path)
    assert vendors.read(path) == CALIBRATION
    assert [file.name for file in tmp_path.iterdir()] == ["arm.yaml"]
    with pytest.raises(FileError, match=r"cannot write '.*gone/arm\.yaml': No such file"):
        vendors.write(CALIBRATION, tmp_path / "gone" / "arm.yaml")
    with pytest.raises(
        InputError,
        match=r"^rpy: expected 'moving' or 'fixed', got 'zyx', the axes that roll, pitch and yaw turn about$",
    ):
        vendors.write(CALIBRATION, path, rpy="zyx")  # type: ignore[arg-type]
    with pytest.raises(
        InputError,
        match=r"^rpy: expected 'moving' or 'fixed', got 'zyx', the axes that roll, pitch and yaw turn about$",
    ):
        vendors.read(path, rpy="zyx")  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"^write: expected a FactoryCalibration, got Table$"):
        vendors.write(NOMINAL, path)  # pyright: ignore[reportArgumentType]
    assert vendors.read(path) == CALIBRATION


def test_without_pyyaml_its_extra_is_in_the_message(monkeypatch):
    original = builtins.__import__

    def refuse(name, *args, **options):
        if name == "yaml":
            raise ImportError(name)
        return original(name, *args, **options)

    monkeypatch.setattr(builtins, "__import__", refuse)
    with pytest.raises(
        MissingExtra,
        match=r"^reading YAML needs the package pyyaml: pip install 'poekin\[formats\]'$",
    ):
        read_text(TEXT)


def test_deltas_are_read_from_a_controller_s_file(tmp_path):
    path = tmp_path / "calibration.conf"
    commented = CONF.replace("-2.5e-4]", "-2.5e-4]  # of the wrist")
    path.write_text(
        commented + "joint_checksum = [ 0x6e0f7bf, 0x0]\nstatus = 2 # 0 == delta_a\n",
        encoding="utf-8",
    )
    found = ur.read_deltas(path)
    assert found == dict.fromkeys(
        ("delta_theta", "delta_a", "delta_d", "delta_alpha"), (0, 1e-3, 0, 0, 0, -2.5e-4)
    )
    table = ur.add_deltas(NOMINAL, **found)
    np.testing.assert_allclose(table.a - NOMINAL.a, found["delta_a"], rtol=0, atol=1e-16)


BAD_CONF = {
    "missing": (changed("delta_d .*\n", "", CONF), r"c\.conf: delta_d is missing; needed are delta_theta, delta_a"),
    "misspelt": (changed("delta_d ", "delta_dd ", CONF), r"c\.conf: delta_d is missing; .*did you mean 'delta_dd'"),
    "twice": (CONF + CONF, r"c\.conf:7: delta_theta: it appears twice \(first: line 2\)"),
    "seven": (changed("0, 0,", "0, 0, 0,", CONF),
              r"c\.conf:2: delta_theta: expected 6 numbers, one a joint, got 7: the calibration of another arm\?$"),
    "no bracket": (changed(r"-4\]", "-4", CONF), r"c\.conf:2: delta_theta: expected numbers in brackets, got '\[ 0,"),
    "a word": (changed("1e-3", "one", CONF), r"c\.conf:2: delta_theta: expected a finite number, got 'one'"),
    "nan": (changed("1e-3", "nan", CONF), r"c\.conf:2: delta_theta: expected a finite number, got 'nan'"),
    "infinite": (changed("1e-3", "-inf", CONF), r"c\.conf:2: delta_theta: expected a finite number, got '-inf'"),
    "hexadecimal": (changed("1e-3", "0x10", CONF), r"c\.conf:2: delta_theta: expected a finite number, got '0x10'"),
}  # fmt: skip


@pytest.mark.parametrize(("text", "message"), BAD_CONF.values(), ids=BAD_CONF)
def test_a_fault_in_a_controller_s_file_is_said_with_its_line(text, message, tmp_path):
    (tmp_path / "c.conf").write_text(text, encoding="utf-8")
    with pytest.raises(ModelError, match=message):
        ur.read_deltas(tmp_path / "c.conf")


def test_a_file_of_64_kib_is_read_and_a_longer_one_is_not(tmp_path):
    path = tmp_path / "c.conf"
    path.write_bytes(b"#" * 2**16)
    assert xml.read_text(path, conf.LARGEST) == ("#" * 2**16, str(path))
    path.write_bytes(b"#" * (2**16 + 1))
    with pytest.raises(FileError, match=r"c\.conf: expected at most 64 KiB, the file has 64 KiB$"):
        xml.read_text(path, conf.LARGEST)
