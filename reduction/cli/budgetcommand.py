"""The command of uncertainty budgets."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from reduction.cli.commandoutput import CommandOutput, guarded
from reduction.cli.options import AllowRemote, Json, Quiet, Units


def budget(
    product: Annotated[
        str,
        typer.Argument(
            metavar="PRODUCT.nc",
            help="Archive of a reduced test, or surfaces.nc.",
            show_default=False,
        ),
    ],
    quantity: Annotated[
        str | None,
        typer.Option(help="Such as segment_modulus; left out: what there is.", show_default=False),
    ] = None,
    at: Annotated[
        list[str] | None,
        typer.Option(help='Which one: "specimen=new", "branch=ascending", "strain=100 %".'),
    ] = None,
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Where the uncertainty of a number comes from, largest source first."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.budget import list_budgets, show_budget
        from reduction.cli.remote import local_sources

        with local_sources([product], allow_remote=allow_remote, output=output) as (here,):
            if quantity is None:
                list_budgets(Path(here), output=output)
            else:
                show_budget(Path(here), quantity, at or [], output=output)
