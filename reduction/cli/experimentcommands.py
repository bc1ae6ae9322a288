"""Commands of designed experiments: plan the runs, fit what came of them."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from reduction.cli.commandoutput import CommandOutput, guarded
from reduction.cli.options import Json, Quiet, SpecPath, Units
from reduction.cli.usage import here, written_here

OptionalSpecPath = Annotated[
    Path | None, typer.Argument(metavar="[SPEC.toml]", show_default=False, callback=here)
]


class DesignName(StrEnum):
    """Designs that the command line knows."""

    BOX_BEHNKEN = "box-behnken"
    PLACKETT_BURMAN = "plackett-burman"


def experiment(
    kind: Annotated[DesignName, typer.Argument(help="Design.", show_default=False)],
    spec: SpecPath,
    out: Annotated[
        Path | None, typer.Option(help="Write the run sheet as a CSV too.", callback=written_here)
    ] = None,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Plan an experiment: run sheet, cautions, expected precision."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.experiments import plan_runs

        plan_runs(kind.value, spec, out=out, output=output)


def surface(
    runs: Annotated[Path, typer.Argument(metavar="RUNS.csv", show_default=False, callback=here)],
    spec: OptionalSpecPath = None,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Fit response surfaces, or effects of a screening, to a table of runs from anywhere."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.surfaces import fit_runs

        fit_runs(runs, spec, output=output)
