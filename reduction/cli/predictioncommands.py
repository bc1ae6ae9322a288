"""Commands of predictions: from construction alone, and against a test."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from reduction.cli.commandoutput import CommandOutput, guarded
from reduction.cli.options import AllowRemote, Json, Quiet, SpecPath, Units
from reduction.cli.usage import written_here


class PredictionName(StrEnum):
    """Predictions that the command line knows."""

    HOSE = "hose"
    ARMOUR = "armour"
    WAVE_LOAD = "wave-load"


def predict(
    kind: Annotated[PredictionName, typer.Argument(help="Of what.", show_default=False)],
    spec: SpecPath,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write archive, tables and figures to this folder.", callback=written_here
        ),
    ] = None,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Predict a stretch hose, a helical armour or a wave load from construction alone."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        if kind is PredictionName.HOSE:
            from reduction.cli.predictions import predict_hose as predict_it
        elif kind is PredictionName.ARMOUR:
            from reduction.cli.armour import predict_cable as predict_it
        else:
            from reduction.cli.waveload import predict_wave as predict_it

        predict_it(spec, out=out, output=output)


def compare(
    measured: Annotated[str, typer.Argument(metavar="MEASURED.nc", show_default=False)],
    spec: SpecPath,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write archive, tables and figures to this folder.", callback=written_here
        ),
    ] = None,
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Hold the archive of a test against the predicted hose of SPEC.toml."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.comparisons import compare_test
        from reduction.cli.remote import local_sources

        with local_sources([measured], allow_remote=allow_remote, output=output) as (here,):
            compare_test(Path(here), spec, out=out, output=output)
