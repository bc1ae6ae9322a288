"""Commands of a campaign of tests: from a folder of logs to archive, tables and report."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from reduction.cli.commandoutput import CommandOutput, guarded
from reduction.cli.options import (
    AllowRemote,
    CampaignPath,
    Json,
    ProcessedOut,
    Quiet,
    ReportsOut,
    Units,
)
from reduction.cli.usage import here


def init(
    folder: Annotated[
        Path, typer.Argument(help="Folder of logs.", show_default=False, callback=here)
    ],
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Write a starter campaign into a folder of logs, for a person to complete."""
    with guarded(CommandOutput(json=json, quiet=quiet)) as output:
        from reduction.cli.starter import start_campaign

        start_campaign(folder, output)


def sniff(
    file: Annotated[
        Path, typer.Argument(help="An unknown log.", show_default=False, callback=here)
    ],
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Look at an unknown log and print a starter layout in TOML, to be confirmed."""
    with guarded(CommandOutput(json=json, quiet=quiet)) as output:
        from reduction.cli.starter import print_layout

        print_layout(file, output)


def check(
    campaign: CampaignPath,
    test: Annotated[
        list[str] | None, typer.Option("--test", help="Only this test; may be repeated.")
    ] = None,
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Read and validate everything, print what was found, write nothing."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.remote import campaign_at
        from reduction.cli.runs import check_campaign

        with campaign_at(campaign, allow_remote=allow_remote, output=output) as loaded:
            check_campaign(loaded, tests=tuple(test or ()), output=output)


def run(
    campaign: CampaignPath,
    processed: ProcessedOut = Path("processed"),
    reports: ReportsOut = Path("reports"),
    jobs: Annotated[
        int | None,
        typer.Option(min=1, help="Worker processes on this machine; 1 where left out."),
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Dask scheduler with workers, tcp://HOST:PORT."),
    ] = None,
    test: Annotated[
        list[str] | None, typer.Option("--test", help="Only this test; may be repeated.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Redo unchanged tests too.")] = False,
    allow_remote: AllowRemote = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Reduce a campaign: archive, tables and report."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.remote import campaign_at
        from reduction.cli.runs import run_campaign

        with campaign_at(campaign, allow_remote=allow_remote, output=output) as loaded:
            run_campaign(
                loaded,
                processed=processed,
                reports=reports,
                tests=tuple(test or ()),
                force=force,
                jobs=jobs,
                scheduler=scheduler,
                output=output,
            )


def report(
    processed_dir: Annotated[
        Path,
        typer.Argument(
            help="processed/CAMPAIGN, or processed/ for all.", show_default=False, callback=here
        ),
    ],
    reports: ReportsOut = Path("reports"),
    pdf: Annotated[
        bool, typer.Option("--pdf", help="Print the report to the client to PDF, by a browser.")
    ] = False,
    json: Json = False,
    quiet: Quiet = False,
    units: Units = "si",
) -> None:
    """Make the reports again, from the archives alone."""
    with guarded(CommandOutput(json=json, quiet=quiet, units=units)) as output:
        from reduction.cli.remote import in_order
        from reduction.cli.runs import report_again

        with in_order():
            report_again(processed_dir, reports=reports, is_printed=pdf, output=output)


def schema(
    json: Annotated[bool, typer.Option("--json", help="As it is in any case.")] = False,
    quiet: Quiet = False,
) -> None:
    """Print the JSON Schema of campaign.toml."""
    with guarded(CommandOutput(json=not quiet or json, quiet=quiet)) as output:
        from reduction.campaign.model import CampaignFile

        output.answer(CampaignFile.model_json_schema())
