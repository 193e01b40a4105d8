"""The commands of `poekin`, put together."""

from __future__ import annotations

from typing import Annotated

import typer

from . import conform
from .calibration import calibrate
from .kinematics import fk, follow, ik, jacobian, singularity
from .model import takes_models
from .models import axes, compare, count, dh, emit, info, urdf, validate

app = typer.Typer(
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    help="Kinematics of robots by the product of exponentials: rad and m, twists (omega; v).",
)

# Unknown options pass through to q, so that -0.5 is a number; there are no one-letter options that
# it could be.
NUMBERS = {"ignore_unknown_options": True}

app.command("info")(takes_models(info.command))
app.command("fk", context_settings=NUMBERS)(takes_models(fk.command))
app.command("jacobian", context_settings=NUMBERS)(takes_models(jacobian.command))
app.command("singularity", context_settings=NUMBERS)(takes_models(singularity.command))
app.command("ik", context_settings=NUMBERS)(takes_models(ik.command))
app.command("follow")(takes_models(follow.command))
app.command("calibrate")(takes_models(calibrate.command))
app.command("validate")(takes_models(validate.command))
app.command("urdf")(takes_models(urdf.command))
app.command("compare")(takes_models(compare.command))
app.command("conform")(conform.command)
app.command("axes")(takes_models(axes.command))
app.command("dh")(takes_models(dh.command))
app.command("count")(takes_models(count.command))
app.command("emit")(takes_models(emit.command))


def _version(wanted: bool) -> None:
    if wanted:
        from .. import __version__

        print(f"poekin {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass
