"""Refusals of `poekin emit`, word for word: options that exclude each other, places, files that exist."""

from __future__ import annotations

from pathlib import Path

import pytest

from poekin.cli.models import emit
from poekin.errors import FileError, InputError

C_FILES = {"arm.c": "int a;", "arm.h": "int b;", "arm_test.c": "int c;"}


def refusal(function, *arguments) -> str:
    with pytest.raises((InputError, FileError)) as refused:
        function(*arguments)
    return str(refused.value)


@pytest.mark.parametrize("language", ["python", "javascript", "cuda", "jax"])
def test_ik_is_of_c_alone_and_without_what_is_of_a_jacobian(language):
    assert refusal(emit._check_inverse, language, {}) == (
        f"--ik: expected together with --lang c only, it is not written in {language} yet"
    )
    nothing = {"--frame": None, "--float": False, "--all-links": False}
    emit._check_inverse("c", nothing)
    for option, value in (("--frame", "body"), ("--float", True), ("--all-links", True)):
        assert refusal(emit._check_inverse, "c", nothing | {option: value}) == (
            f"--ik: expected without {option}, which is of pose and Jacobian"
        )


@pytest.mark.parametrize("option", ["precision", "measure"])
def test_numbers_and_measure_of_a_sweep_are_of_cuda_and_jax(option):
    given = {"precision": None, "measure": None} | {option: "x"}
    for language in ("cuda", "jax"):
        emit._check_accelerated(language, given)
    for language in ("c", "python", "javascript"):
        emit._check_accelerated(language, {"precision": None, "measure": None})
        assert refusal(emit._check_accelerated, language, given) == (
            f"--{option}: expected together with --lang cuda or jax only"
        )


def test_all_links_are_of_javascript_and_of_no_chain():
    nothing: dict[str, object] = {
        "--tip": None,
        "--base": None,
        "--frame": None,
        "--idealise": None,
    }
    emit._check_all_links("javascript", nothing)
    for language in ("c", "python", "cuda", "jax"):
        assert refusal(emit._check_all_links, language, nothing) == (
            "--all-links: expected together with --lang javascript only"
        )
    for option in nothing:
        for value in ("hand", 0.0):
            assert refusal(emit._check_all_links, "javascript", nothing | {option: value}) == (
                f"--all-links: expected without {option}, which is of one chain"
            )


@pytest.mark.parametrize(
    ("language", "place", "expected"),
    [
        ("c", "a.c", "a directory"),
        ("c", "a.py", "a directory"),
        ("python", "a.H", "a directory or a .py file"),
        ("python", "a.cu", "a directory or a .py file"),
        ("jax", "a.js", "a directory or a .py file"),
        ("javascript", "a.py", "a directory or a .js file or a .mjs file"),
        ("cuda", "a.mjs", "a directory or a .cu file"),
    ],
)
def test_a_file_of_another_language_is_told_with_what_is_expected(language, place, expected):
    assert refusal(emit._places, Path(place), language, {"x": ""}) == (
        f"--output: {expected} expected with --lang {language}, got {place!r}"
    )


@pytest.mark.parametrize(
    ("language", "place", "texts", "places", "directory"),
    [
        ("c", "out/arm", C_FILES, [f"out/arm/{name}" for name in C_FILES], "out/arm"),
        ("python", "out/a.PY", {"arm.py": "x"}, ["out/a.PY"], "out"),
        ("python", "out/v1.2", {"arm.py": "x"}, ["out/v1.2/arm.py"], "out/v1.2"),
        ("javascript", "out/a.mjs", {"arm.js": "x"}, ["out/a.mjs"], "out"),
        ("cuda", "a.cu", {"arm.cu": "x"}, ["a.cu"], "."),
    ],
)
def test_texts_go_into_a_directory_or_into_the_file_of_their_language(
    language, place, texts, places, directory
):
    found, where = emit._places(Path(place), language, texts)
    assert where == Path(directory)
    assert found == dict(zip(map(Path, places), texts.values(), strict=True))


def test_all_files_that_exist_are_named_and_none_is_written_without_force(tmp_path):
    places = {tmp_path / name: text for name, text in C_FILES.items()}
    (tmp_path / "arm.c").write_text("mine")
    (tmp_path / "arm_test.c").symlink_to("nowhere")
    assert refusal(emit._write, places, tmp_path, False) == (
        f"'{tmp_path}/arm.c', '{tmp_path}/arm_test.c': exists already; --force replaces it"
    )
    assert (tmp_path / "arm.c").read_text() == "mine"
    assert not (tmp_path / "arm.h").exists()
    emit._write(places, tmp_path, True)
    assert {name: (tmp_path / name).read_text() for name in C_FILES} == C_FILES
    below = tmp_path / "arm.c" / "below"
    assert refusal(emit._write, {below / "a.c": ""}, below, False).startswith(
        f"cannot make the directory '{below}': "
    )
    new = tmp_path / "new" / "newer"
    emit._write({new / "a.c": "int d;"}, new, False)
    assert (new / "a.c").read_text() == "int d;"
