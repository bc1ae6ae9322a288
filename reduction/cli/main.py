"""The command ``reduction``: its commands in the order of ``--help``.

Each stands with its options in the module of its group; the work is elsewhere. Heavy
packages are imported inside the commands, so that ``--help`` answers at once.
"""

from __future__ import annotations

import gc
import os
import sys
from typing import Annotated, Any

import typer

from reduction import __version__
from reduction.cli.budgetcommand import budget
from reduction.cli.campaigncommands import check, init, report, run, schema, sniff
from reduction.cli.cataloguecommand import catalogue
from reduction.cli.commandoutput import INTERRUPTED
from reduction.cli.curvecommands import assembly, composite
from reduction.cli.diffcommand import diff
from reduction.cli.experimentcommands import experiment, surface
from reduction.cli.explorecommand import explore
from reduction.cli.lookupcommand import lookup
from reduction.cli.predictioncommands import compare, predict
from reduction.cli.publishedcommands import export, reproduce
from reduction.cli.usage import Commands
from reduction.cli.verifycommand import verify


class _Application(typer.Typer):
    """The command, which ends in words also where it is interrupted before it has begun."""

    def __call__(self, *words: Any, **options: Any) -> Any:
        """Run it."""
        # numpy, which is not loaded yet, takes this as it is: threads for matrices as small as
        # those of a reduction wait for each other, and longer than the products take
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        # an archive is many small objects without circles: looked through for those less often
        gc.set_threshold(100_000, 20, 50)
        try:
            return super().__call__(*words, **options)
        except KeyboardInterrupt:
            typer.echo("interrupted", err=True)
            sys.exit(INTERRUPTED)


app = _Application(
    cls=Commands,
    name="reduction",
    help="Reduces cyclic tension tests of compliant mooring elements.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _version(value: bool) -> None:
    if value:
        typer.echo(f"reduction {__version__}")
        raise typer.Exit


@app.callback()
def main(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print and exit.")
    ] = False,
) -> None:
    """Reduces cyclic tension tests of compliant mooring elements."""


app.command()(init)
app.command()(sniff)
app.command()(check)
app.command()(run)
app.command()(experiment)
app.command()(surface)
app.command()(predict)
app.command()(compare)
app.command()(composite)
app.command()(assembly)
app.command()(export)
app.command()(lookup)
app.command()(budget)
app.command()(catalogue)
app.command()(report)
app.command()(explore)
app.command()(verify)
app.command()(diff)
app.command()(reproduce)
app.command()(schema)
