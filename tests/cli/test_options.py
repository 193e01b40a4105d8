"""What options are where nobody says anything, and the smallest numbers that they take."""

from __future__ import annotations

import inspect
import re
import typing
from collections.abc import Iterator
from typing import Any

import pytest

from poekin.analysis.dexterity.singularity import TOLERANCE
from poekin.cli import commands, conform
from poekin.cli.calibration import calibrate
from poekin.cli.kinematics import ik, jacobian
from poekin.cli.models import emit
from poekin.cli.sweep import histogram, reach
from poekin.formats.poses.layout import FORMATS, layout
from poekin.sweep import Cells
from poekin.testing.conform import LAWS

DEFAULTS: dict[str, dict[str, object]] = {
    "apply": {"force": False, "json": False},
    "axes": {"tol_mm": 0.01, "tol_deg": 0.001, "json": False},
    "calibrate": {
        "loss": "linear",
        "on_rank_deficiency": "raise",
        "repeats": "keep",
        "folds": 5,
        "seed": 0,
        "convention": "standard",
        "exact": False,
        "json": False,
    },
    "choose_poses": {
        "candidates": "2000",
        "criterion": "prediction",
        "seed": 0,
        "json": False,
    },
    "compare": {
        "tol_mm": 0.01,
        "tol_deg": 0.001,
        "same": "base,tool,zeros,directions,limits",
        "strict": False,
        "samples": 200,
        "seed": 0,
        "json": False,
    },
    "conform": {"at_most": "good", "seconds": 600.0, "limit": 60.0, "json": False},
    "count": {"json": False},
    "dh": {"convention": "standard", "json": False},
    "emit": {"all_links": False, "inverse": False, "single": False, "force": False},
    "fk": {"json": False},
    "follow": {
        "fastest": False,
        "max_step": 0.1,
        "task": "pose",
        "no_limits": False,
        "seed": 0,
        "json": False,
    },
    "ik": {"task": "pose", "no_limits": False, "seed": 0, "json": False},
    "from_circles": {"json": False},
    "info": {"json": False},
    "jacobian": {"json": False},
    "singularity": {"tolerance": TOLERANCE, "json": False},
    "urdf": {},
    "warm": {"json": False},
    "names": {"json": False},
    "view": {"no_meshes": False, "show": False},
    "base": {"json": False},
    "show": {"json": False},
    "reach": {
        "samples": "1e7",
        "by": "configurations",
        "turns": 1,
        "resolution": 0.05,
        "side": 0,
        "measure": "reach",
        "keep": "best",
        "self_collision": False,
        "seed": 0,
        "resume": False,
        "json": False,
    },
    "top": {
        "measure": "manipulability",
        "count": 10,
        "by": "configurations",
        "keep": "best",
        "samples": "1e7",
        "self_collision": False,
        "seed": 0,
        "json": False,
    },
    "histogram": {
        "measure": "manipulability",
        "bins": 20,
        "by": "configurations",
        "samples": "1e7",
        "self_collision": False,
        "seed": 0,
        "json": False,
    },
    "validate": {"every": False, "samples": 100, "seed": 0, "json": False},
}
OF_ERRORS = {"sigma_angle": 0, "sigma_length": 0, "seed": 0, "workers": 1}
LEAST: dict[str, dict[str, float]] = {
    "calibrate": {"folds": 0, "seed": 0},
    "choose_poses": {"n": 1, "seed": 0},
    "compare": {"samples": 1, "seed": 0},
    "conform": {"examples": 1, "seconds": 0.1, "limit": 0.1},
    "follow": {"seed": 0},
    "ik": {"seed": 0},
    "reach": {"side": 0, "turns": 1, **OF_ERRORS},
    "top": {"count": 1, **OF_ERRORS},
    "histogram": {"bins": 1, **OF_ERRORS},
    "validate": {"samples": 0, "seed": 0},
}


def options(module: Any) -> Iterator[tuple[str, Any, object]]:
    """Name, typer's option and default of each."""
    hints = typing.get_type_hints(module.command, include_extras=True)
    for name, parameter in inspect.signature(module.command).parameters.items():
        yield name, hints[name].__metadata__[0], parameter.default


@pytest.mark.parametrize("name", DEFAULTS)
def test_an_option_that_is_not_given_is_what_the_help_says_or_nothing(name):
    given = {
        n: d
        for n, _, d in options(getattr(commands, name))
        if d is not None and d is not inspect.Parameter.empty
    }
    assert given == DEFAULTS[name]


@pytest.mark.parametrize("name", DEFAULTS)
def test_a_number_has_the_smallest_value_that_means_something(name):
    least = {
        n: option.min
        for n, option, _ in options(getattr(commands, name))
        if getattr(option, "min", None) is not None
    }
    assert least == LEAST.get(name, {})


def test_where_the_output_goes_is_said_by_o_everywhere():
    declared = {
        module.__name__.rpartition(".")[2]: (option.default, *option.param_decls)
        for module in (*commands.COMMANDS, reach)
        for name, option, _ in options(module)
        if name == "output"
    }
    assert {"fk", "ik", "follow", "emit", "urdf", "dh", "view", "apply", "reach"} <= set(declared)
    assert [name for name, words in declared.items() if "-o" not in words] == []


def help_of(module: Any, name: str) -> str:
    return next(str(option.help) for n, option, _ in options(module) if n == name)


def test_the_numbers_in_the_help_are_those_that_are_taken():
    examples = [law.examples for law in LAWS]
    assert f"default: {min(examples)} to {max(examples)}, each law its own" in help_of(
        conform, "examples"
    )
    tiles = [Cells((0.0, 0.0, 0.0), 1.0, (1, 1, 1), side).count for side in (1, 4)]
    assert help_of(reach, "side") == (
        f"Tell {tiles[0]} SIDE² directions of the tool's z axis apart (4: {tiles[1]} of them)."
    )
    assert help_of(reach, "samples") == "Number of samples, as 10000000 or 1e8."
    assert help_of(calibrate, "folds").endswith("; 0: none.")
    assert help_of(calibrate, "gravity").endswith("for compliance (default: 0,0,-1).")
    assert help_of(histogram, "ends") == (
        "Ends of the bins, in SI units (default: of 100000 configurations)."
    )
    assert help_of(jacobian, "frame").endswith("of joint K, counted from 0).")
    assert help_of(emit, "frame").endswith("of joint K, from 0). Default: hybrid.")
    names = layout("matrix").columns
    assert f"matrix (12 or 16, row by row: {' '.join(names[:5])} ..., m)" in help_of(ik, "format")
    assert (len(layout("12").columns), len(names)) == (12, 16)
    named = re.findall(r"\w+", help_of(ik, "format"))
    assert set(FORMATS) - set(named) == {"7", "zyz"}
    assert (
        help_of(ik, "quaternion") == "The order of the quaternion in --format quat; never guessed."
    )
