"""The command ``lookup`` with its options; the work is elsewhere."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from reduction.cli.commandoutput import CommandOutput, guarded
from reduction.cli.options import AllowRemote, Json, Quiet, Units
from reduction.cli.usage import written_here


class BranchName(StrEnum):
    """Branches of a cycle."""

    ASCENDING = "ascending"
    DESCENDING = "descending"


class Extrapolation(StrEnum):
    """What is done outside the tested range."""

    REFUSE = "refuse"
    FLAG = "flag"


def lookup(
    source: Annotated[
        str,
        typer.Argument(
            help="A published line, `published`, an archive, or a processed campaign.",
            show_default=False,
        ),
    ],
    quantity: Annotated[
        str | None,
        typer.Option(help="What is wanted: its name, or K_ap, H, K_0, K_1, tau, N, tension."),
    ] = None,
    frequency: Annotated[str | None, typer.Option(help='"0.3 Hz".')] = None,
    mean_tension: Annotated[str | None, typer.Option(help='"4000 lbf" or "21 %RBS".')] = None,
    tension_amplitude: Annotated[str | None, typer.Option(help="Half the range.")] = None,
    tension: Annotated[str | None, typer.Option(help="Of a load-strain curve.")] = None,
    strain: Annotated[str | None, typer.Option(help='"100 %".')] = None,
    branch: Annotated[BranchName | None, typer.Option(help="Of a cycle.")] = None,
    line: Annotated[str | None, typer.Option(help="Which line of SOURCE.")] = None,
    against: Annotated[
        str | None, typer.Option(help="Another line: both values, difference, ratio.")
    ] = None,
    material: Annotated[str | None, typer.Option(help='Search: "nylon".')] = None,
    construction: Annotated[str | None, typer.Option(help='Search: "double braid".')] = None,
    condition: Annotated[str | None, typer.Option(help='Search: "new", "5 years".')] = None,
    diameter: Annotated[str | None, typer.Option(help='Search: "0.5 in".')] = None,
    tolerance: Annotated[str | None, typer.Option(help='Of the diameter, "3 %" if unsaid.')] = None,
    extrapolate: Annotated[
        Extrapolation, typer.Option(help="Outside what was tested.")
    ] = Extrapolation.REFUSE,
    table: Annotated[
        bool, typer.Option("--table", help="A grid; values of a level parted by commas.")
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write the values: FILE.csv, .json, .tex, .md or .nc.", callback=written_here
        ),
    ] = None,
    what_there_is: Annotated[bool, typer.Option("--list", help="What SOURCE holds.")] = False,
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """One design value with its interval, range check and source, or a table of them."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.lookup import list_sources, look_up_values
        from reduction.cli.lookupagainst import look_up_against
        from reduction.cli.lookuppoints import Wanted, parsed_search
        from reduction.cli.lookupsource import name_of_quantity
        from reduction.cli.remote import local_sources

        words = {"material": material, "construction": construction, "condition": condition}
        search = parsed_search(words, diameter, tolerance)
        if what_there_is or quantity is None:
            with local_sources([source], allow_remote=allow_remote, output=output) as (here,):
                list_sources(here, search, output=output)
            return
        levels = {
            "frequency": frequency,
            "mean_tension": mean_tension,
            "tension_amplitude": tension_amplitude,
            "tension": tension,
            "strain": strain,
        }
        wanted = Wanted(
            quantity=name_of_quantity(quantity),
            levels={name: text for name, text in levels.items() if text is not None},
            search=search,
            name=line,
            branch=None if branch is None else branch.value,
            extrapolate=extrapolate.value,
            grid=table,
            out=out,
        )
        named = [source] if against is None else [source, against]
        with local_sources(named, allow_remote=allow_remote, output=output) as here:
            if against is None:
                look_up_values(here[0], wanted, output=output)
            else:
                look_up_against(here[0], here[1], wanted, output=output)
