"""The command ``diff`` with its options; the work is elsewhere."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from reduction.cli.commandoutput import CommandOutput, guarded
from reduction.cli.options import Json, Quiet, Units, here_if_given
from reduction.cli.usage import here


def diff(
    a: Annotated[
        Path,
        typer.Argument(
            metavar="A",
            help="Before: an archive, a table, a folder of products, or a CAMPAIGN.toml.",
            show_default=False,
            callback=here,
        ),
    ],
    b: Annotated[
        Path | None,
        typer.Argument(
            metavar="B",
            help="After: the same kind of thing.",
            show_default=False,
            callback=here_if_given,
        ),
    ] = None,
    against: Annotated[
        str | None,
        typer.Option(
            metavar="REV",
            help="Run the campaign A with this git revision of the software, and with this one.",
            show_default=False,
        ),
    ] = None,
    exact: Annotated[
        bool, typer.Option("--exact", help="A number moves with its last bit.")
    ] = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Which answers changed between two products, and by how many standard uncertainties."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.diff import show_differences

        show_differences(a, b, against=against, is_exact=exact, output=output)
