"""Commands that make one curve of many tests: the composite, the deployed assembly."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from reduction.cli.commandoutput import CommandOutput, guarded
from reduction.cli.options import AllowRemote, Json, Quiet, SpecPath, Units
from reduction.cli.usage import written_here


class CurveName(StrEnum):
    """What of a cycle becomes one curve."""

    MEAN = "mean"
    ASCENDING = "ascending"
    DESCENDING = "descending"


def composite(
    sources: Annotated[
        list[str],
        typer.Argument(
            metavar="SOURCE...",
            help="processed/CAMPAIGN, archives of tests, or a published tether without the test.",
            show_default=False,
        ),
    ],
    specimen: Annotated[str | None, typer.Option(help="Where the archives hold several.")] = None,
    branch: Annotated[
        CurveName | None, typer.Option(help="Of the cycles; mean unless said.", show_default=False)
    ] = None,
    precedence: Annotated[
        str | None,
        typer.Option(
            help="Kinds of pieces, the first one first: cyclic,static,first-loading unless said; "
            "what is not named is not used.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Every node as .csv, .json, .nc, .md or .tex; a page as .html.",
            callback=written_here,
        ),
    ] = None,
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """One curve of tension against strain from zero, out of all tests of a specimen."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.composite import compose_tests
        from reduction.cli.remote import local_sources

        with local_sources(sources, allow_remote=allow_remote, output=output) as here:
            compose_tests(
                here,
                specimen=specimen,
                branch=None if branch is None else branch.value,
                precedence=precedence,
                out=out,
                output=output,
            )


def assembly(
    spec: SpecPath,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Every node as .csv, .json, .nc, .md or .tex; a page as .html.",
            callback=written_here,
        ),
    ] = None,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Tethers as they are deployed: tension against length, stiffness, load of each tether."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.assembly import assemble_spec

        assemble_spec(spec, out=out, output=output)
