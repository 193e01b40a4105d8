"""The commands of `poekin`, put together."""

from __future__ import annotations

from types import ModuleType
from typing import Annotated

import typer

from . import conform, warm
from . import list as names
from .calibration import apply, calibrate, choose_poses
from .calibration.circles import from_circles
from .kinematics import fk, follow, ik, jacobian, singularity
from .model import takes_models
from .models import axes, compare, count, dh, emit, info, urdf, validate, view
from .sweep import base, histogram, reach, show, top

app = typer.Typer(
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    help="Kinematics of robots by the product of exponentials: rad and m, twists (omega; v).",
)

COMMANDS: tuple[ModuleType, ...] = (
    *(info, fk, jacobian, singularity, ik, follow, calibrate, choose_poses, apply, validate, urdf),
    *(from_circles, compare, view, conform, axes, dh, count, emit, names, warm),
)
# Unknown options of these pass through to q, so that -0.5 is a number; no number has the letter of
# their one-letter option, -o.
TAKE_NUMBERS = (fk, jacobian, singularity, ik)

for module in COMMANDS:
    run = module.command
    if module not in (conform, names, warm, from_circles):
        run = takes_models(run)
    settings = {"ignore_unknown_options": module in TAKE_NUMBERS}
    name = module.__name__.rpartition(".")[2].replace("_", "-")
    app.command(name, context_settings=settings)(run)

sweeps = typer.Typer(
    rich_markup_mode=None,
    help="Maps over many configurations: where a tool can be.",
)
sweeps.command("reach")(takes_models(reach.command))
sweeps.command("top")(takes_models(top.command))
sweeps.command("histogram")(takes_models(histogram.command))
sweeps.command("show")(show.command)
sweeps.command("base")(base.command)
app.add_typer(sweeps, name="sweep")


def _version(wanted: bool) -> None:
    if wanted:
        from ..version import __version__

        print(f"poekin {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Print the version."),
    ] = False,
) -> None:
    pass


command = typer.main.get_command(app)
"""All of them, as one command that is called with `args`; an app itself makes them anew at every call."""
