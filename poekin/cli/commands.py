"""The commands of `poekin`, put together."""

from __future__ import annotations

from typing import Annotated

import typer

from . import axes, compare, fk, info, jacobian, urdf, validate

app = typer.Typer(
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    help="Kinematics of robots by the product of exponentials: rad and m, twists (omega; v).",
)

# Unknown options pass through to q, so that -0.5 is a number; there are no one-letter options that it could be.
NUMBERS = {"ignore_unknown_options": True}

app.command("info")(info.command)
app.command("fk", context_settings=NUMBERS)(fk.command)
app.command("jacobian", context_settings=NUMBERS)(jacobian.command)
app.command("validate")(validate.command)
app.command("urdf")(urdf.command)
app.command("compare")(compare.command)
app.command("axes")(axes.command)


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
