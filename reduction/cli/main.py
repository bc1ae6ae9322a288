"""The command line: all commands with their options; code is imported when it is needed.

The implementations are in other modules. Heavy packages are imported inside the commands, so that
``--help`` responds at once.
"""

# annotations are values in this module: as texts, those of all commands would be evaluated twice at
# each start

import gc
import os
import sys
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from reduction import __version__
from reduction.cli.output import INTERRUPTED, CommandOutput, guarded
from reduction.cli.usage import Commands, here, written_here


def _here_if_given(path: Path | None) -> Path | None:
    """A local path, if given."""
    return None if path is None else here(path)


Json = Annotated[bool, typer.Option("--json", help="Print one JSON object, in SI.")]

Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print only errors.")]

Units = Annotated[str, typer.Option("--units", help="Units shown: si or us (psi, lbf, ft).")]

SpecPath = Annotated[Path, typer.Argument(metavar="SPEC.toml", show_default=False, callback=here)]

CampaignPath = Annotated[
    Path, typer.Argument(metavar="CAMPAIGN.toml", show_default=False, callback=here)
]

ProcessedOut = Annotated[
    Path, typer.Option(help="Folder for archives and tables.", callback=written_here)
]

ReportsOut = Annotated[Path, typer.Option(help="Folder for the report.", callback=written_here)]

AllowRemote = Annotated[
    bool,
    typer.Option("--allow-remote", help="Accept URLs for logs and archives: s3://bucket/T-1.csv."),
]

OwnCampaign = Annotated[
    Path | None,
    typer.Option(
        metavar="CAMPAIGN.toml",
        help="The campaign, if it was moved since the run.",
        show_default=False,
        callback=_here_if_given,
    ),
]


def init(
    folder: Annotated[
        Path, typer.Argument(help="Folder of logs.", show_default=False, callback=here)
    ],
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Write a draft campaign.toml for a folder of logs, for you to complete."""
    with guarded(CommandOutput(json=json, quiet=quiet)) as output:
        from reduction.cli.campaigns import start_campaign

        start_campaign(folder, output)


def sniff(
    file: Annotated[
        Path, typer.Argument(help="Log of unknown layout.", show_default=False, callback=here)
    ],
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Propose a layout (TOML) for an unknown log, for you to confirm."""
    with guarded(CommandOutput(json=json, quiet=quiet)) as output:
        from reduction.cli.campaigns import print_layout

        print_layout(file, output)


def check(
    campaign: CampaignPath,
    test: Annotated[
        list[str] | None, typer.Option("--test", help="Only this test; can be repeated.")
    ] = None,
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Read and check a campaign and its logs; write nothing."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.campaigns import check_campaign
        from reduction.cli.remote_paths import campaign_at

        with campaign_at(campaign, allow_remote=allow_remote, output=output) as loaded:
            check_campaign(loaded, tests=tuple(test or ()), output=output)


def run(
    campaign: CampaignPath,
    processed: ProcessedOut = Path("processed"),
    reports: ReportsOut = Path("reports"),
    jobs: Annotated[
        int | None,
        typer.Option(min=1, help="Worker processes on this machine; default 1."),
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Address of your Dask scheduler, tcp://HOST:PORT."),
    ] = None,
    test: Annotated[
        list[str] | None, typer.Option("--test", help="Only this test; can be repeated.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Reduce unchanged tests again.")] = False,
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Reduce a campaign: write archives, tables and report."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.campaigns import run_campaign, say_unchanged
        from reduction.cli.remote_paths import campaign_at

        is_whole = not (test or force or scheduler)
        if is_whole and say_unchanged(
            campaign, processed=processed, reports=reports, output=output
        ):
            return
        with campaign_at(campaign, allow_remote=allow_remote, output=output) as loaded:
            document = run_campaign(
                loaded,
                processed=processed,
                reports=reports,
                tests=tuple(test or ()),
                force=force,
                jobs=jobs,
                scheduler=scheduler,
                output=output,
            )
            output.answer(document)


def demo(
    folder: Annotated[
        Path, typer.Argument(help="A folder without campaigns.", callback=here)
    ] = Path("reduction-demo"),
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Copy the synthetic campaigns of this package to a folder, and run them there."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.campaigns import run_demo

        run_demo(folder, output)


def report(
    processed_dir: Annotated[
        Path,
        typer.Argument(
            help="processed/CAMPAIGN, or processed/ for all campaigns.",
            show_default=False,
            callback=here,
        ),
    ],
    reports: ReportsOut = Path("reports"),
    pdf: Annotated[
        bool,
        typer.Option("--pdf", help="Print the client report to PDF, with an installed browser."),
    ] = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Rewrite the reports from the archives."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.campaigns import report_again
        from reduction.cli.remote_paths import in_order

        with in_order():
            report_again(processed_dir, reports=reports, is_printed=pdf, output=output)


def schema(
    json: Annotated[bool, typer.Option("--json", help="The default output.")] = False,
    quiet: Quiet = False,
) -> None:
    """Print the JSON Schema of campaign.toml."""
    with guarded(CommandOutput(json=not quiet or json, quiet=quiet)) as output:
        from reduction.campaign.model import CampaignFile

        output.answer(CampaignFile.model_json_schema())


OptionalSpecPath = Annotated[
    Path | None, typer.Argument(metavar="[SPEC.toml]", show_default=False, callback=here)
]


class _DesignName(StrEnum):
    """Designs available on the command line."""

    BOX_BEHNKEN = "box-behnken"
    PLACKETT_BURMAN = "plackett-burman"


def experiment(
    kind: Annotated[_DesignName, typer.Argument(help="Design.", show_default=False)],
    spec: SpecPath,
    out: Annotated[
        Path | None,
        typer.Option(help="Also write the run sheet to a CSV file.", callback=written_here),
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
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write tables and a page with figures to this folder.", callback=written_here
        ),
    ] = None,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Fit response surfaces, or screening effects, to any table of runs."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.experiments import fit_runs

        fit_runs(runs, spec, out=out, output=output)


class _PredictionName(StrEnum):
    """Predictions available on the command line."""

    HOSE = "hose"
    ARMOUR = "armour"
    WAVE_LOAD = "wave-load"


def predict(
    kind: Annotated[_PredictionName, typer.Argument(help="What to predict.", show_default=False)],
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
    """Predict a stretch hose, helical armour or wave load from its construction."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        if kind is _PredictionName.HOSE:
            from reduction.cli.predictions import predict_hose as predict_it
        elif kind is _PredictionName.ARMOUR:
            from reduction.cli.predictions import predict_cable as predict_it
        else:
            from reduction.cli.predictions import predict_wave as predict_it

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
    """Compare a reduced test with the predicted hose in SPEC.toml."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.predictions import compare_test
        from reduction.cli.remote_paths import local_sources

        with local_sources([measured], allow_remote=allow_remote, output=output) as (here,):
            compare_test(Path(here), spec, out=out, output=output)


class _BranchName(StrEnum):
    """Branches of a cycle."""

    ASCENDING = "ascending"
    DESCENDING = "descending"


class _Extrapolation(StrEnum):
    """Treatment of values outside the tested range."""

    REFUSE = "refuse"
    FLAG = "flag"


def lookup(
    source: Annotated[
        str,
        typer.Argument(
            help="A published line, `published` for all, an archive, or a processed campaign.",
            show_default=False,
        ),
    ],
    quantity: Annotated[
        str | None,
        typer.Option(help="Quantity: full name, or K_ap, H, K_0, K_1, tau, N, tension."),
    ] = None,
    frequency: Annotated[str | None, typer.Option(help='Such as "0.3 Hz".')] = None,
    mean_tension: Annotated[
        str | None, typer.Option(help='Such as "4000 lbf" or "21 %RBS".')
    ] = None,
    tension_amplitude: Annotated[
        str | None, typer.Option(help="Amplitude, half the range.")
    ] = None,
    tension: Annotated[str | None, typer.Option(help="Tension on a load-strain curve.")] = None,
    strain: Annotated[str | None, typer.Option(help='Such as "100 %".')] = None,
    mean_strain: Annotated[
        str | None, typer.Option(help="Of surfaces over strain, of one's own experiment.")
    ] = None,
    strain_amplitude: Annotated[str | None, typer.Option(help="The same, half the range.")] = None,
    branch: Annotated[_BranchName | None, typer.Option(help="Branch of the cycle.")] = None,
    line: Annotated[str | None, typer.Option(help="Name of a line in SOURCE.")] = None,
    against: Annotated[
        str | None, typer.Option(help="Compare with another line: both values, difference, ratio.")
    ] = None,
    material: Annotated[str | None, typer.Option(help='Search: "nylon".')] = None,
    construction: Annotated[str | None, typer.Option(help='Search: "double braid".')] = None,
    condition: Annotated[str | None, typer.Option(help='Search: "new", "5 years".')] = None,
    diameter: Annotated[str | None, typer.Option(help='Search: "0.5 in".')] = None,
    tolerance: Annotated[
        str | None, typer.Option(help='Tolerance of --diameter; default "3 %".')
    ] = None,
    population: Annotated[
        str | None,
        typer.Option(help='All specimens combined; share for the tolerance limits: "95 %".'),
    ] = None,
    rank: Annotated[
        bool, typer.Option("--rank", help="All lines in order at one load, ties marked.")
    ] = False,
    medium: Annotated[str | None, typer.Option(help='Tested in: "wet", "dry".')] = None,
    temperature: Annotated[str | None, typer.Option(help='Tested at: "5 degC".')] = None,
    extrapolate: Annotated[
        _Extrapolation, typer.Option(help="Outside the tested range.")
    ] = _Extrapolation.REFUSE,
    table: Annotated[
        bool,
        typer.Option("--table", help="Table over several values of a level, separated by commas."),
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write the values: FILE.csv, .json, .tex, .md, .nc or .xlsx.",
            callback=written_here,
        ),
    ] = None,
    what_there_is: Annotated[
        bool, typer.Option("--list", help="List the contents of SOURCE.")
    ] = False,
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Look up design values, with interval, tested range and source."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.lookup import (
            LookupRequest,
            list_sources,
            look_up_against,
            look_up_population,
            look_up_ranked,
            look_up_values,
            parsed_search,
        )
        from reduction.cli.remote_paths import local_sources
        from reduction.quantities.names import name_of_quantity
        from reduction.quantities.units import parse_quantity
        from reduction.record.errors import SettingsError

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
            "mean_strain": mean_strain,
            "strain_amplitude": strain_amplitude,
        }
        wanted = LookupRequest(
            quantity=name_of_quantity(quantity),
            levels={name: text for name, text in levels.items() if text is not None},
            search=search,
            name=line,
            branch=None if branch is None else branch.value,
            extrapolate=extrapolate.value,
            grid=table,
            out=out,
            conditions={
                name: text
                for name, text in (("medium", medium), ("temperature", temperature))
                if text is not None
            },
        )
        named = [source] if against is None else [source, against]
        with local_sources(named, allow_remote=allow_remote, output=output) as here:
            ways = {"--population": population, "--against": against, "--rank": rank or None}
            asked = [name for name, said in ways.items() if said is not None]
            if len(asked) > 1 or (rank and (table or out is not None)):
                raise SettingsError(
                    "only one option that combines lines is allowed",
                    found=" and ".join([*asked, *(["--table or --out"] if rank else [])]),
                    needed="one of them, and of --rank a single load on the screen",
                )
            if rank:
                look_up_ranked(here[0], wanted, output=output)
            elif population is not None:
                share = parse_quantity(population, "number")
                look_up_population(here[0], wanted, share, output=output)
            elif against is None:
                look_up_values(here[0], wanted, output=output)
            else:
                look_up_against(here[0], here[1], wanted, output=output)


class _CurveName(StrEnum):
    """Part of a cycle used for one curve."""

    MEAN = "mean"
    ASCENDING = "ascending"
    DESCENDING = "descending"


def composite(
    sources: Annotated[
        list[str],
        typer.Argument(
            metavar="SOURCE...",
            help="processed/CAMPAIGN, test archives, or a published tether without its test.",
            show_default=False,
        ),
    ],
    specimen: Annotated[
        str | None, typer.Option(help="Required if the archives contain several.")
    ] = None,
    branch: Annotated[
        _CurveName | None,
        typer.Option(help="Branch of the cycles; default mean.", show_default=False),
    ] = None,
    precedence: Annotated[
        str | None,
        typer.Option(
            help="Kinds of pieces in order of precedence, default cyclic,static,first-loading; "
            "others are not used.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write all nodes to FILE.csv, .json, .nc, .md or .tex; or a page, FILE.html.",
            callback=written_here,
        ),
    ] = None,
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Join all tests of a specimen into one tension-strain curve from zero."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.curves import compose_tests
        from reduction.cli.remote_paths import local_sources

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
            help="Write all nodes to FILE.csv, .json, .nc, .md or .tex; or a page, FILE.html.",
            callback=written_here,
        ),
    ] = None,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Parallel tethers as deployed: tension against length, stiffness, load of each tether."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.curves import assemble_spec

        assemble_spec(spec, out=out, output=output)


def export(
    sources: Annotated[
        list[str],
        typer.Argument(
            metavar="SOURCE...",
            help="A published line, or an archive of a test or of hoses. Several archives, "
            "processed/CAMPAIGN or a published tether without its test give the composite curve.",
            show_default=False,
        ),
    ],
    to: Annotated[
        str,
        typer.Option(
            "--to",
            help="csv, json, latex, markdown, netcdf, xlsx, moordyn, moorpy, openfast, raft, "
            "orcaflex, "
            "whoi-cable or abaqus.",
            show_default=False,
        ),
    ],
    out: Annotated[
        Path, typer.Option("--out", help="Output file.", show_default=False, callback=written_here)
    ],
    form: Annotated[
        str | None, typer.Option(help="Form, if the format has several, such as table.")
    ] = None,
    curve: Annotated[
        str | None, typer.Option(help="mean (default), ascending or descending.")
    ] = None,
    precedence: Annotated[
        str | None,
        typer.Option(help="For a composite, as in `reduction composite`.", show_default=False),
    ] = None,
    specimen: Annotated[str | None, typer.Option(help="Name of the specimen or hose.")] = None,
    diameter: Annotated[str | None, typer.Option(help='Diameter, such as "26 mm".')] = None,
    linear_density: Annotated[
        str | None, typer.Option(help='Mass per length in air, such as "0.6 kg/m".')
    ] = None,
    wet_linear_density: Annotated[
        str | None, typer.Option(help="Mass per length minus displaced water.")
    ] = None,
    rated_break_strength: Annotated[str | None, typer.Option(help='Such as "28 kN".')] = None,
    drag: Annotated[
        str | None, typer.Option(help='Transverse and axial, "1.6, 0.02"; default: cylinder.')
    ] = None,
    added_mass: Annotated[str | None, typer.Option(help='Transverse and axial, "1, 0".')] = None,
    hydrodynamics_source: Annotated[
        str | None, typer.Option(help="Source of these coefficients, for the header.")
    ] = None,
    frequency: Annotated[
        str | None, typer.Option(help='Frequency of the stiffness, such as "0.3 Hz".')
    ] = None,
    mean_tension: Annotated[
        str | None, typer.Option(help='Such as "4000 lbf" or "21 %RBS".')
    ] = None,
    tension_amplitude: Annotated[
        str | None, typer.Option(help="Amplitude, half the range.")
    ] = None,
    working_curve: Annotated[
        str | None, typer.Option(help='For a Syrope line: form, k1, k2, "QUADRATIC, 0.2, 0.5".')
    ] = None,
    greatest_mean_tension: Annotated[
        str | None, typer.Option(help="For a Syrope line: highest earlier mean tension.")
    ] = None,
    extrapolate: Annotated[
        str, typer.Option(help="Outside the tested range: refuse or flag.")
    ] = "refuse",
    verify: Annotated[
        bool, typer.Option("--verify", help="Run the file in its program, and print the result.")
    ] = False,
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Export a line type for a mooring code, or a curve as a table."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.export import ExportRequest, export_source
        from reduction.cli.remote_paths import local_sources

        with local_sources(sources, allow_remote=allow_remote, output=output) as here:
            request = ExportRequest(
                sources=tuple(here),
                to=to,
                out=out,
                form=form,
                curve=curve,
                precedence=precedence,
                specimen=specimen,
                diameter=diameter,
                linear_density=linear_density,
                wet_linear_density=wet_linear_density,
                rated_break_strength=rated_break_strength,
                drag=drag,
                added_mass=added_mass,
                hydrodynamics_source=hydrodynamics_source,
                working_curve=working_curve,
                greatest_mean_tension=greatest_mean_tension,
                frequency=frequency,
                mean_tension=mean_tension,
                tension_amplitude=tension_amplitude,
                extrapolate=extrapolate,
                verify=verify,
                units=output.system,
            )
            export_source(request, output=output)


def reproduce(
    report: Annotated[
        str | None, typer.Argument(metavar="[REPORT]", help="Default: all.", show_default=False)
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(help="Write page and table to this folder.", callback=written_here),
    ] = None,
    erratum: Annotated[
        str | None, typer.Option(help="Show one erratum with its evidence, such as CG-39.")
    ] = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Recompute all numbers printed in the source reports: counts, errata, open cells."""
    with guarded(CommandOutput(json=json, quiet=quiet)) as output:
        from reduction.cli.reproduce import reproduce_erratum, reproduce_reports

        if erratum is not None:
            reproduce_erratum(report, erratum, output=output)
            return
        reproduce_reports(report, out=out, output=output)


def figures(
    report: Annotated[
        str | None, typer.Argument(metavar="[REPORT]", help="Default: all.", show_default=False)
    ] = None,
    figure: Annotated[
        str | None,
        typer.Option(metavar="N", help="Only this figure, without a page: 4, A-1, 9(a)."),
    ] = None,
    campaign: Annotated[
        Path | None,
        typer.Option(
            metavar="PROCESSED_DIR",
            help="Draw your own lines of this processed campaign on the same axes.",
            callback=_here_if_given,
        ),
    ] = None,
    out: Annotated[
        Path, typer.Option(help="Folder for pages and files.", callback=written_here)
    ] = Path("reports/figures"),
    json: Json = False,
    quiet: Quiet = False,
    units: Annotated[
        str | None, typer.Option("--units", help="si or us (psi, lbf); default: as the report.")
    ] = None,
) -> None:
    """Draw the figures of the source reports from corrected numbers, with your own data."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units or "si")) as output:
        from reduction.cli.figures import draw_figures

        draw_figures(report, figure, campaign=campaign, out=out, units=units, output=output)


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
        typer.Option(help="Such as segment_modulus; default: list them.", show_default=False),
    ] = None,
    at: Annotated[
        list[str] | None,
        typer.Option(help='Select a value: "specimen=new", "branch=ascending", "strain=100 %".'),
    ] = None,
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Uncertainty budget of a number, largest source first."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.budget import list_budgets, show_budget
        from reduction.cli.remote_paths import local_sources

        with local_sources([product], allow_remote=allow_remote, output=output) as (here,):
            if quantity is None:
                list_budgets(Path(here), output=output)
            else:
                show_budget(Path(here), quantity, at or [], output=output)


Names = list[str] | None


def catalogue(
    processed: Annotated[
        Path,
        typer.Argument(
            metavar="PROCESSED_DIR", help="Contains one folder per campaign.", callback=here
        ),
    ] = Path("processed"),
    campaign: Annotated[Names, typer.Option(help='Name or pattern: "tmt-*".')] = None,
    test: Annotated[Names, typer.Option(help='Name or pattern: "T-*".')] = None,
    kind: Annotated[Names, typer.Option(help="Kind of test: cyclic, relaxation, ...")] = None,
    specimen: Annotated[Names, typer.Option(help="Name or pattern.")] = None,
    medium: Annotated[str | None, typer.Option(help='Words: "wet".')] = None,
    material: Annotated[str | None, typer.Option(help='Words: "nylon".')] = None,
    construction: Annotated[str | None, typer.Option(help='Words: "double braid".')] = None,
    condition: Annotated[str | None, typer.Option(help='Words: "new".')] = None,
    synthetic: Annotated[
        bool | None,
        typer.Option(
            "--synthetic/--measured",
            help="Only synthetic, or only measured data.",
            show_default=False,
        ),
    ] = None,
    where: Annotated[
        list[str] | None,
        typer.Option(
            help='"frequency >= 0.1 Hz", "mean_tension < 20 %RBS"; repeat to combine (and).'
        ),
    ] = None,
    quantity: Annotated[
        list[str] | None,
        typer.Option(help="Quantity to show, such as apparent_spring_constant or loss_factor."),
    ] = None,
    by_cycle: Annotated[
        bool, typer.Option("--by-cycle", help="Cycles 1, 2, 5, 10, ..., last instead of the mean.")
    ] = False,
    sort: Annotated[list[str] | None, typer.Option(help="Sort by this column.")] = None,
    descending: Annotated[
        bool, typer.Option("--descending", help="Sort from the largest.")
    ] = False,
    limit: Annotated[int | None, typer.Option(min=1, help="Maximum number of rows.")] = None,
    export: Annotated[
        Path | None,
        typer.Option(help="Write the rows: FILE.csv or FILE.parquet, SI.", callback=written_here),
    ] = None,
    what_there_is: Annotated[
        bool, typer.Option("--list", help="List the quantities, and how many values each has.")
    ] = False,
    rebuild: Annotated[
        bool, typer.Option("--rebuild", help="Remake the catalogue files from the archives first.")
    ] = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """List and filter tests, conditions and results of all campaigns."""
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


def explore(
    processed_dir: Annotated[
        Path,
        typer.Argument(
            metavar="PROCESSED_DIR", help="processed/CAMPAIGN.", show_default=False, callback=here
        ),
    ],
    campaign: OwnCampaign = None,
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="Port on 127.0.0.1; 0: any free port.")
    ] = 0,
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Open the page in the browser.")
    ] = True,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Change the settings of a test on a local page, see the effect, save them."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.explore import serve

        serve(processed_dir, campaign=campaign, port=port, opens=browser, output=output)


def verify(
    processed_dir: Annotated[
        Path,
        typer.Argument(
            metavar="PROCESSED_DIR",
            help="processed/CAMPAIGN, or processed/ for all campaigns.",
            show_default=False,
            callback=here,
        ),
    ],
    campaign: OwnCampaign = None,
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Check that raw files and archives still match; change nothing."""
    with guarded(CommandOutput(json=json, quiet=quiet)) as output:
        from reduction.cli.verify import verify_products

        verify_products(processed_dir, campaign=campaign, allow_remote=allow_remote, output=output)


def diff(
    a: Annotated[
        Path,
        typer.Argument(
            metavar="A",
            help="Before: an archive, a table, a folder of archives, or a CAMPAIGN.toml.",
            show_default=False,
            callback=here,
        ),
    ],
    b: Annotated[
        Path | None,
        typer.Argument(
            metavar="B",
            help="After: the same kind as A.",
            show_default=False,
            callback=_here_if_given,
        ),
    ] = None,
    against: Annotated[
        str | None,
        typer.Option(
            metavar="REV",
            help="Run campaign A with this git revision of the software and the installed one.",
            show_default=False,
        ),
    ] = None,
    exact: Annotated[
        bool, typer.Option("--exact", help="Count any difference, down to the last bit.")
    ] = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Compare two sets of results, in standard uncertainties."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.diff import show_differences

        show_differences(a, b, against=against, is_exact=exact, output=output)


class _Application(typer.Typer):
    """The application, which ends with a message even if interrupted during start-up."""

    def __call__(self, *words: Any, **options: Any) -> Any:
        """Run the command."""
        # read by numpy on loading: for matrices as small as these, threads wait for each other
        # longer than the products take
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        # an archive has many small objects without reference cycles: collect less often
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
        bool,
        typer.Option(
            "--version", callback=_version, is_eager=True, help="Print the version and exit."
        ),
    ] = False,
) -> None:
    """Reduces cyclic tension tests of compliant mooring elements."""


for command in (
    demo, init, sniff, check, run, experiment, surface, predict, compare, composite, assembly,
    export, lookup, budget, catalogue, report, explore, verify, diff, reproduce, figures, schema,
):  # fmt: skip
    app.command()(command)
