"""The command ``catalogue`` with its options; the work is elsewhere."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from reduction.cli.commandoutput import CommandOutput, guarded
from reduction.cli.options import Json, Quiet, Units
from reduction.cli.usage import here, written_here

Names = list[str] | None


def catalogue(
    processed: Annotated[
        Path,
        typer.Argument(
            metavar="PROCESSED_DIR", help="Holds a folder for each campaign.", callback=here
        ),
    ] = Path("processed"),
    campaign: Annotated[Names, typer.Option(help='Name or pattern: "tmt-*".')] = None,
    test: Annotated[Names, typer.Option(help='Name or pattern: "T-*".')] = None,
    kind: Annotated[Names, typer.Option(help="Of the test: cyclic, relaxation, ...")] = None,
    specimen: Annotated[Names, typer.Option(help="Name or pattern.")] = None,
    medium: Annotated[str | None, typer.Option(help='Words: "wet".')] = None,
    material: Annotated[str | None, typer.Option(help='Words: "nylon".')] = None,
    construction: Annotated[str | None, typer.Option(help='Words: "double braid".')] = None,
    condition: Annotated[str | None, typer.Option(help='Words: "new".')] = None,
    synthetic: Annotated[
        bool | None, typer.Option("--synthetic/--measured", help="Only these.", show_default=False)
    ] = None,
    where: Annotated[
        list[str] | None,
        typer.Option(help='"frequency >= 0.1 Hz", "mean_tension < 20 %RBS"; all have to hold.'),
    ] = None,
    quantity: Annotated[
        list[str] | None,
        typer.Option(
            help="A number of each test, such as apparent_spring_constant or loss_factor."
        ),
    ] = None,
    by_cycle: Annotated[
        bool, typer.Option("--by-cycle", help="Of cycles 1, 2, 5, 10, ..., last; not their mean.")
    ] = False,
    sort: Annotated[list[str] | None, typer.Option(help="By this column.")] = None,
    descending: Annotated[bool, typer.Option("--descending", help="From the greatest.")] = False,
    limit: Annotated[int | None, typer.Option(min=1, help="Rows at most.")] = None,
    export: Annotated[
        Path | None,
        typer.Option(help="Write the rows: FILE.csv or FILE.parquet, SI.", callback=written_here),
    ] = None,
    what_there_is: Annotated[
        bool, typer.Option("--list", help="Which quantities there are, and how many numbers.")
    ] = False,
    rebuild: Annotated[
        bool, typer.Option("--rebuild", help="First make the catalogues again, from the archives.")
    ] = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Tests, conditions and numbers of all campaigns."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.catalogue import list_quantities, query_of, show_catalogue

        if what_there_is:
            list_quantities(processed, rebuild=rebuild, output=output)
            return
        query = query_of(
            names={"campaign": campaign, "test": test, "test_kind": kind, "specimen": specimen},
            words={
                "medium": medium,
                "specimen_material": material,
                "specimen_construction": construction,
                "specimen_condition": condition,
            },
            synthetic=synthetic,
            where=where or [],
            quantity=quantity or [],
            by_cycle=by_cycle,
            sort=sort or [],
            descending=descending,
            limit=limit,
        )
        show_catalogue(processed, query, export=export, rebuild=rebuild, output=output)
