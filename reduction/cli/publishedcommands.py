"""Commands of numbers that stand already: export them, hold them against the reports."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from reduction.cli.commandoutput import CommandOutput, guarded
from reduction.cli.options import AllowRemote, Json, Quiet, Units
from reduction.cli.usage import written_here


def export(
    sources: Annotated[
        list[str],
        typer.Argument(
            metavar="SOURCE...",
            help="A published line, an archive of a test or of hoses; of several archives, "
            "processed/CAMPAIGN or a published tether without the test: the composite curve.",
            show_default=False,
        ),
    ],
    to: Annotated[
        str,
        typer.Option(
            "--to",
            help="csv, json, latex, markdown, netcdf, moordyn, moorpy, openfast, orcaflex, "
            "whoi-cable or abaqus.",
            show_default=False,
        ),
    ],
    out: Annotated[
        Path, typer.Option("--out", help="The file.", show_default=False, callback=written_here)
    ],
    form: Annotated[
        str | None, typer.Option(help="Where a format has several, such as table.")
    ] = None,
    curve: Annotated[
        str | None, typer.Option(help="mean (unless said), ascending or descending.")
    ] = None,
    precedence: Annotated[
        str | None,
        typer.Option(help="Of a composite, as in `reduction composite`.", show_default=False),
    ] = None,
    specimen: Annotated[str | None, typer.Option(help="Which one, or which hose.")] = None,
    diameter: Annotated[str | None, typer.Option(help='With a unit, "26 mm".')] = None,
    linear_density: Annotated[str | None, typer.Option(help='In air, "0.6 kg/m".')] = None,
    wet_linear_density: Annotated[
        str | None, typer.Option(help="Less the water it displaces.")
    ] = None,
    rated_break_strength: Annotated[str | None, typer.Option(help='"28 kN".')] = None,
    drag: Annotated[
        str | None, typer.Option(help='Across and along the line, "1.6, 0.02"; else a cylinder.')
    ] = None,
    added_mass: Annotated[str | None, typer.Option(help='The same, "1, 0".')] = None,
    hydrodynamics_source: Annotated[
        str | None, typer.Option(help="Where these are from, for the header.")
    ] = None,
    frequency: Annotated[str | None, typer.Option(help='Of the stiffness, "0.3 Hz".')] = None,
    mean_tension: Annotated[str | None, typer.Option(help='"4000 lbf" or "21 %RBS".')] = None,
    tension_amplitude: Annotated[str | None, typer.Option(help="Half the range.")] = None,
    working_curve: Annotated[
        str | None, typer.Option(help='Of a Syrope line: form, k1, k2, "QUADRATIC, 0.2, 0.5".')
    ] = None,
    greatest_mean_tension: Annotated[
        str | None, typer.Option(help="Of a Syrope line: that it has had before.")
    ] = None,
    extrapolate: Annotated[
        str, typer.Option(help="Outside the levels: refuse or flag.")
    ] = "refuse",
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Write a curve for a mooring code, or as a table."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.export import export_source
        from reduction.cli.remote import local_sources

        with local_sources(sources, allow_remote=allow_remote, output=output) as here:
            export_source(
                here,
                to=to,
                out=out,
                form=form,
                curve=curve,
                precedence=precedence,
                specimen=specimen,
                stated={
                    "diameter": diameter,
                    "linear_density": linear_density,
                    "wet_linear_density": wet_linear_density,
                    "rated_break_strength": rated_break_strength,
                },
                water=(drag, added_mass, hydrodynamics_source),
                syrope=(working_curve, greatest_mean_tension),
                levels={
                    "frequency": frequency,
                    "mean_tension": mean_tension,
                    "tension_amplitude": tension_amplitude,
                },
                extrapolate=extrapolate,
                output=output,
            )


def reproduce(
    report: Annotated[
        str | None, typer.Argument(metavar="[REPORT]", help="All unless said.", show_default=False)
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(help="Write page and table to this folder.", callback=written_here),
    ] = None,
    erratum: Annotated[
        str | None, typer.Option(help="One fault of a page with its evidence, such as CG-39.")
    ] = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Recompute every printed number of the published reports: counts, errata, open cells."""
    with guarded(CommandOutput(json=json, quiet=quiet)) as output:
        from reduction.cli.reproduce import reproduce_erratum, reproduce_reports

        if erratum is not None:
            reproduce_erratum(report, erratum, output=output)
            return
        reproduce_reports(report, out=out, output=output)
