"""`poekin list` names what can be loaded without a file, all of it and nothing else."""

from __future__ import annotations

import importlib.resources

import pytest

from poekin.errors import MissingExtra
from poekin.formats import catalogue, erd
from poekin.formats.load import load


def test_every_built_in_robot_is_named_and_can_be_loaded(poekin, as_json):
    names = as_json("list")["built_in"]
    assert names == sorted(names)
    folder = importlib.resources.files(catalogue)
    files = {
        file.name.rpartition(".")[0]
        for file in folder.iterdir()
        if file.name.endswith((".urdf", ".toml"))
    }
    assert set(names) == files
    _, out, _ = poekin("list")
    for name in names:
        assert load(name).dof >= 4
        assert f"\n{name} " in out


def test_every_robot_of_example_robot_data_is_named_and_the_empty_one_is_not(
    monkeypatch, poekin, as_json, tmp_path
):
    for name, text in (("one", "<robot><link name='a'/></robot>"), ("empty", "<robot/>")):
        (tmp_path / name).write_text(text)
    paths = {name: str(tmp_path / name) for name in ("one", "empty")}
    monkeypatch.setattr(erd, "available", lambda: paths)
    assert as_json("list")["example_robot_data"] == ["erd:one"]
    code, out, err = poekin("list")
    assert (code, err) == (0, "")
    assert out.splitlines()[-1].split() == ["erd:one", "URDF", "of", "example-robot-data"]
    assert load("erd:one").links == ("a",)


def test_names_of_the_installed_package_can_be_loaded(as_json):
    try:
        available = erd.available()
    except MissingExtra:
        pytest.skip("example-robot-data is not installed")
    names = as_json("list")["example_robot_data"]
    assert len(names) == len(available) - 1
    assert {name.removeprefix("erd:") for name in names} <= set(available)
    assert load(names[0]).links


def test_without_the_package_the_extra_is_named_and_the_rest_is_there(monkeypatch, poekin, as_json):
    def missing():
        raise MissingExtra("example-robot-data", "robots", 'a model named "erd:..."')

    monkeypatch.setattr(erd, "available", missing)
    code, out, err = poekin("list")
    assert code == 0
    assert "\npanda " in out
    assert "erd:" not in out
    assert err == (
        'poekin: a model named "erd:..." needs the package example-robot-data:'
        " pip install 'poekin[robots]'\n"
    )
    assert as_json("list")["example_robot_data"] is None


@pytest.mark.parametrize("words", [["panda"], ["--xacro"], ["--tip", "a"]])
def test_list_takes_no_model(words, refused):
    assert refused("list", *words)


def test_where_the_names_come_from_stands_in_one_column_under_its_title(poekin):
    _, out, _ = poekin("list")
    title, _, *rows = out.splitlines()
    start = title.index("comes from")
    assert all(row[start - 1] == " " != row[start] for row in rows)


def test_a_robot_that_has_a_table_too_says_where_it_is(poekin):
    _, out, _ = poekin("list")
    rows = {line.split()[0]: line.split(None, 1)[1] for line in out.splitlines()[2:]}
    both = "URDF (its DH table: poekin.dh.published), with poekin"
    assert rows["panda"].strip() == both
    assert rows["ur10e"].strip() == "DH table, with poekin"
