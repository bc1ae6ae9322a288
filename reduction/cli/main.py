"""The command ``reduction``: options in, exit status out; the work is elsewhere.

Heavy packages are imported inside the commands, so that ``--help`` answers at once.
"""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from reduction import __version__
from reduction.cli.outcome import Outcome, guarded
from reduction.cli.usage import Commands, here

__all__ = ["app"]

app = typer.Typer(
    cls=Commands,
    name="reduction",
    help="Reduces cyclic tension tests of compliant mooring elements.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

Json = Annotated[bool, typer.Option("--json", help="One JSON object on standard output, SI.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Nothing but errors.")]
Units = Annotated[str, typer.Option("--units", help="What is shown: si or us (psi, lbf, ft).")]


class DesignName(StrEnum):
    """Designs that the command line knows."""

    BOX_BEHNKEN = "box-behnken"
    PLACKETT_BURMAN = "plackett-burman"


class BranchName(StrEnum):
    """Branches of a cycle."""

    ASCENDING = "ascending"
    DESCENDING = "descending"


class Extrapolation(StrEnum):
    """What is done outside the tested range."""

    REFUSE = "refuse"
    FLAG = "flag"


class PredictionName(StrEnum):
    """Predictions that the command line knows."""

    HOSE = "hose"
    ARMOUR = "armour"
    WAVE_LOAD = "wave-load"


SpecPath = Annotated[Path, typer.Argument(metavar="SPEC.toml", show_default=False, callback=here)]
OptionalSpecPath = Annotated[
    Path | None, typer.Argument(metavar="[SPEC.toml]", show_default=False, callback=here)
]
CampaignPath = Annotated[
    Path, typer.Argument(metavar="CAMPAIGN.toml", show_default=False, callback=here)
]


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


@app.command()
def init(
    folder: Annotated[
        Path, typer.Argument(help="Folder of logs.", show_default=False, callback=here)
    ],
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Write a starter campaign into a folder of logs, for a person to complete."""
    with guarded(Outcome(json=json, quiet=quiet)) as outcome:
        from reduction.cli.starter import start_campaign

        start_campaign(folder, outcome)


@app.command()
def sniff(
    file: Annotated[
        Path, typer.Argument(help="An unknown log.", show_default=False, callback=here)
    ],
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Look at an unknown log and print a starter layout in TOML, to be confirmed."""
    with guarded(Outcome(json=json, quiet=quiet)) as outcome:
        from reduction.cli.starter import print_layout

        print_layout(file, outcome)


@app.command()
def check(
    campaign: CampaignPath,
    test: Annotated[list[str] | None, typer.Option("--test", help="Only this test.")] = None,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Read and validate everything, print what was found, write nothing."""
    with guarded(Outcome(json=json, quiet=quiet, units=units)) as outcome:
        from reduction.cli.runs import check_campaign

        check_campaign(campaign, tests=tuple(test or ()), outcome=outcome)


@app.command()
def run(
    campaign: CampaignPath,
    processed: Annotated[Path, typer.Option(help="Where products go.")] = Path("processed"),
    reports: Annotated[Path, typer.Option(help="Where the report goes.")] = Path("reports"),
    jobs: Annotated[int, typer.Option(min=1, help="Accepted; tests run one by one.")] = 1,
    test: Annotated[list[str] | None, typer.Option("--test", help="Only this test.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Redo unchanged tests too.")] = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Reduce a campaign: archive, tables and report."""
    with guarded(Outcome(json=json, quiet=quiet, units=units)) as outcome:
        from reduction.cli.runs import run_campaign

        run_campaign(
            campaign,
            processed=processed,
            reports=reports,
            tests=tuple(test or ()),
            force=force,
            outcome=outcome,
        )


@app.command()
def experiment(
    kind: Annotated[DesignName, typer.Argument(help="Design.", show_default=False)],
    spec: SpecPath,
    out: Annotated[Path | None, typer.Option(help="Write the run sheet as a CSV too.")] = None,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Plan an experiment: run sheet, cautions, expected precision."""
    with guarded(Outcome(json=json, quiet=quiet, units=units)) as outcome:
        from reduction.cli.experiments import plan_runs

        plan_runs(kind.value, spec, out=out, outcome=outcome)


@app.command()
def surface(
    runs: Annotated[Path, typer.Argument(metavar="RUNS.csv", show_default=False, callback=here)],
    spec: OptionalSpecPath = None,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Fit response surfaces, or effects of a screening, to a table of runs from anywhere."""
    with guarded(Outcome(json=json, quiet=quiet, units=units)) as outcome:
        from reduction.cli.surfaces import fit_runs

        fit_runs(runs, spec, outcome=outcome)


@app.command()
def predict(
    kind: Annotated[PredictionName, typer.Argument(help="Of what.", show_default=False)],
    spec: SpecPath,
    out: Annotated[
        Path | None, typer.Option(help="Write archive, tables and figures to this folder.")
    ] = None,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Predict a stretch hose, a helical armour or a wave load from construction alone."""
    with guarded(Outcome(json=json, quiet=quiet, units=units)) as outcome:
        if kind is PredictionName.HOSE:
            from reduction.cli.predictions import predict_hose as predict_it
        elif kind is PredictionName.ARMOUR:
            from reduction.cli.armour import predict_cable as predict_it
        else:
            from reduction.cli.waveload import predict_wave as predict_it

        predict_it(spec, out=out, outcome=outcome)


@app.command()
def compare(
    measured: Annotated[
        Path, typer.Argument(metavar="MEASURED.nc", show_default=False, callback=here)
    ],
    spec: SpecPath,
    out: Annotated[
        Path | None, typer.Option(help="Write archive, tables and figures to this folder.")
    ] = None,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Hold the archive of a test against the predicted hose of SPEC.toml."""
    with guarded(Outcome(json=json, quiet=quiet, units=units)) as outcome:
        from reduction.cli.comparisons import compare_test

        compare_test(measured, spec, out=out, outcome=outcome)


@app.command()
def export(
    source: Annotated[
        str,
        typer.Argument(
            help="A published line, or an archive of a test or of hoses.", show_default=False
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
    out: Annotated[Path, typer.Option("--out", help="The file.", show_default=False)],
    form: Annotated[
        str | None, typer.Option(help="Where a format has several, such as table.")
    ] = None,
    curve: Annotated[
        str | None, typer.Option(help="mean (unless said), ascending or descending.")
    ] = None,
    specimen: Annotated[str | None, typer.Option(help="Which one, or which hose.")] = None,
    diameter: Annotated[str | None, typer.Option(help='With a unit, "26 mm".')] = None,
    linear_density: Annotated[str | None, typer.Option(help='In air, "0.6 kg/m".')] = None,
    wet_linear_density: Annotated[
        str | None, typer.Option(help="Less the water it displaces.")
    ] = None,
    rated_break_strength: Annotated[str | None, typer.Option(help='"28 kN".')] = None,
    frequency: Annotated[str | None, typer.Option(help='Of the stiffness, "0.3 Hz".')] = None,
    mean_tension: Annotated[str | None, typer.Option(help='"4000 lbf" or "21 %RBS".')] = None,
    tension_amplitude: Annotated[str | None, typer.Option(help="Half the range.")] = None,
    extrapolate: Annotated[
        str, typer.Option(help="Outside the levels: refuse or flag.")
    ] = "refuse",
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Write a curve for a mooring code, or as a table."""
    with guarded(Outcome(json=json, quiet=quiet, units=units)) as outcome:
        from reduction.cli.export import export_source

        export_source(
            source,
            to=to,
            out=out,
            form=form,
            curve=curve,
            specimen=specimen,
            stated={
                "diameter": diameter,
                "linear_density": linear_density,
                "wet_linear_density": wet_linear_density,
                "rated_break_strength": rated_break_strength,
            },
            levels={
                "frequency": frequency,
                "mean_tension": mean_tension,
                "tension_amplitude": tension_amplitude,
            },
            extrapolate=extrapolate,
            outcome=outcome,
        )


@app.command()
def lookup(
    source: Annotated[
        str,
        typer.Argument(
            help="A published line, `published`, an archive, or a processed campaign.",
            show_default=False,
        ),
    ],
    quantity: Annotated[str | None, typer.Option(help="What is wanted.")] = None,
    frequency: Annotated[str | None, typer.Option(help='"0.3 Hz".')] = None,
    mean_tension: Annotated[str | None, typer.Option(help='"4000 lbf" or "21 %RBS".')] = None,
    tension_amplitude: Annotated[str | None, typer.Option(help="Half the range.")] = None,
    tension: Annotated[str | None, typer.Option(help="Of a load-strain curve.")] = None,
    strain: Annotated[str | None, typer.Option(help='"100 %".')] = None,
    branch: Annotated[BranchName | None, typer.Option(help="Of a cycle.")] = None,
    line: Annotated[str | None, typer.Option(help="Which line of SOURCE.")] = None,
    extrapolate: Annotated[
        Extrapolation, typer.Option(help="Outside what was tested.")
    ] = Extrapolation.REFUSE,
    table: Annotated[
        bool, typer.Option("--table", help="A grid; values of a level parted by commas.")
    ] = False,
    what_there_is: Annotated[bool, typer.Option("--list", help="What SOURCE holds.")] = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """One design value with its interval, range check and source, or a table of them."""
    with guarded(Outcome(json=json, quiet=quiet, units=units)) as outcome:
        from reduction.cli.lookup import list_sources, look_up_values

        if what_there_is or quantity is None:
            list_sources(source, outcome=outcome)
            return
        levels = {
            "frequency": frequency,
            "mean_tension": mean_tension,
            "tension_amplitude": tension_amplitude,
            "tension": tension,
            "strain": strain,
        }
        look_up_values(
            source,
            quantity,
            {name: text for name, text in levels.items() if text is not None},
            name=line,
            branch=None if branch is None else branch.value,
            extrapolate=extrapolate.value,
            grid=table,
            outcome=outcome,
        )


@app.command()
def report(
    processed_dir: Annotated[
        Path,
        typer.Argument(
            help="processed/CAMPAIGN, or processed/ for all.", show_default=False, callback=here
        ),
    ],
    reports: Annotated[Path, typer.Option(help="Where the report goes.")] = Path("reports"),
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Make the HTML report again, from the archives alone."""
    with guarded(Outcome(json=json, quiet=quiet, units=units)) as outcome:
        from reduction.cli.runs import report_again

        report_again(processed_dir, reports=reports, outcome=outcome)


@app.command()
def reproduce(
    report: Annotated[
        str | None, typer.Argument(metavar="[REPORT]", help="All unless said.", show_default=False)
    ] = None,
    out: Annotated[Path | None, typer.Option(help="Write page and table to this folder.")] = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Recompute every printed number of the published reports: counts, errata, open cells."""
    with guarded(Outcome(json=json, quiet=quiet)) as outcome:
        from reduction.cli.reproduce import reproduce_reports

        reproduce_reports(report, out=out, outcome=outcome)


@app.command()
def schema(
    json: Annotated[bool, typer.Option("--json", help="As it is in any case.")] = False,
    quiet: Quiet = False,
) -> None:
    """Print the JSON Schema of campaign.toml."""
    with guarded(Outcome(json=not quiet or json, quiet=quiet)) as outcome:
        from reduction.campaign.model import CampaignFile

        outcome.answer(CampaignFile.model_json_schema())
