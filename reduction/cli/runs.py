"""The commands that read a campaign: check, run, report."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import Any, cast

from rich.markup import escape
from rich.table import Table

from reduction.archive.open import read_once
from reduction.batch.check import check_campaign as check_tests
from reduction.batch.part import PartStatus
from reduction.batch.planned import experiments_found
from reduction.batch.results import results_found
from reduction.batch.run import run_campaign as run_tests
from reduction.batch.status import TestStatus
from reduction.campaign.plan import Campaign
from reduction.cli.commandoutput import CommandOutput
from reduction.cli.designvalues import address_of_design_page, refresh_design_page
from reduction.cli.processed import processed_folders
from reduction.cli.progress import campaign_progress
from reduction.cli.workers import chosen_workers
from reduction.errors import ArchiveError, SettingsError
from reduction.report.clientreport import PAGE_NAME
from reduction.report.page import write_report
from reduction.strain.model import StrainModel
from reduction.units import UnitSystem, display_unit


def _status_table(tests: Sequence[TestStatus]) -> Table:
    rows = []
    # on one screen the errors stand right below the table
    is_below = sys.stdout.isatty() and sys.stderr.isatty()
    for test in tests:
        message = escape(test.message)  # text from files of strangers: no markup is read in it
        if is_below and test.exit_status:
            message = "see below"
        rate = test.found.get("rate", {}).get("value")
        rows.append(
            {
                "test": test.test,
                "status": "checked" if test.status == "no_work" else test.status,
                "rows": str(test.n_rows),
                "rate [Hz]": "" if rate is None else f"{rate:.4g}",
                "gaps": str(test.found.get("gaps", "")),
                "cycles": str(test.n_cycles),
                "seconds": f"{test.seconds:.1f}" if test.worker else "",
                "worker": test.worker,
                "message": message,
            }
        )
    table = Table(box=None, pad_edge=False)
    # weights hung by hand have no rate, and of a log that was reduced a run keeps none
    shown = [name for name in rows[0] if any(row[name] for row in rows)] if rows else []
    for name in shown:
        is_count = name not in ("test", "status", "worker", "message")
        table.add_column(escape(name), justify="right" if is_count else "left")
    for row in rows:
        table.add_row(*(row[name] for name in shown))
    return table


def _report_failures(
    output: CommandOutput, tests: Sequence[TestStatus], parts: Sequence[PartStatus] = ()
) -> None:
    ended = [(test.exit_status, test.message) for test in tests]
    ended += [(one.exit_status, one.message) for one in parts]
    for exit_status, message in ended:
        if exit_status:
            output.error(message)
            output.raise_status(exit_status)


def _part_table(kind: str, parts: Sequence[PartStatus]) -> Table:
    table = Table(box=None, pad_edge=False)
    for heading in (kind, "status", "message"):
        table.add_column(heading)
    for one in parts:
        table.add_row(one.id, one.status, escape(one.message))
    return table


def _model_lines(
    models: dict[tuple[str, str], StrainModel], tests: Sequence[TestStatus], units: UnitSystem
) -> Table:
    table = Table(box=None, pad_edge=False)
    length, factor = display_unit("m", units)
    for heading in ("test", "specimen", "strain method", "marks", f"marked range [{length}]"):
        table.add_column(escape(heading))
    shown = {test.test for test in tests}
    for (test, specimen), model in models.items():
        if test in shown:
            low, high = factor * model.position_low, factor * model.position_high
            marked = "-" if math.isnan(low) else f"{low:.3f} to {high:.3f}"
            table.add_row(test, specimen, model.method, model.marks_from, marked)
    return table


def _say_results(output: CommandOutput, results: dict[str, Any] | None) -> None:
    """How many outcomes without a log there are, and what each is."""
    if results is None:
        return
    output.say(f"{results['file']}: {results['outcomes']} outcomes")
    for quantity, uses in results["quantities"].items():
        listed = [
            f"{count} {use.replace('_', ' ')}{'' if count == 1 or use == 'excluded' else 's'}"
            for use, count in uses.items()
            if count
        ]
        output.say(f"  {quantity}: {', '.join(listed)}")


def _say_experiments(
    output: CommandOutput, experiments: list[dict[str, Any]], units: UnitSystem
) -> None:
    """Runs, slow pulls and what would go slack, before anything is run."""
    force, factor = display_unit("N", units)
    for one in experiments:
        output.say(
            f"experiment {one['id']}: {one['kind']} of {', '.join(one['factors'])}; "
            f"{len(one['runs_found'])} of {len(one['runs'])} runs found"
        )
        if one["runs_failed"]:
            output.say(f"  failed: {', '.join(one['runs_failed'])}")
        for pull in one["quasi_static"]:
            states = {True: "", False: ", which failed", None: ", which was not asked for"}
            said = states[pull["found"]]
            output.say(f"  slow pull of {pull['specimen']}: {pull['test']}{said}")
        for slack in one["slack_runs"]:
            least = factor * slack["planned_minimum_tension"]["value"]
            output.say(
                f"  {slack['run']} {slack['specimen']}: planned minimum tension {least:.4g} "
                f"{force}: the line goes slack in every cycle"
            )
        for note in one["notes"]:
            output.say(f"  {note}")


def check_campaign(campaign: Campaign, *, tests: tuple[str, ...], output: CommandOutput) -> None:
    """Read and validate everything, print what was found, write nothing."""
    units = cast("UnitSystem", output.units)
    with campaign_progress(output) as progress:
        statuses, models = check_tests(campaign, tests=tests, progress=progress)
    if statuses or not (campaign.outcomes or campaign.hoses):
        output.show(_status_table(statuses))
    for test in statuses:
        for channel, masks in test.found.get("flags", {}).items():
            listed = ", ".join(f"{name} {count}" for name, count in masks.items())
            output.say(f"  {test.test}: {channel}: samples flagged: {listed}")
        for note in test.found.get("notes", ()):
            output.say(f"  {test.test}: {note}")
    lines = _model_lines(models, statuses, units)
    if lines.row_count:  # weights hung by hand, and logs that failed, have no strain model
        output.show(lines)
    results = results_found(campaign)
    _say_results(output, results)
    experiments = experiments_found(campaign, statuses)
    _say_experiments(output, experiments, units)
    for comparison in campaign.comparisons.values():
        output.say(
            f"comparison {comparison.name}: {comparison.measured} of {comparison.specimen} "
            f"against hose {comparison.predicted}"
        )
    output.answer(
        {
            "campaign": campaign.id,
            "tests": [test.document() for test in statuses],
            "experiments": experiments,
            "hoses": list(campaign.hoses),
            "comparisons": [asdict(one) for one in campaign.comparisons.values()],
            "results": results,
        }
    )
    _report_failures(output, statuses)


def run_campaign(
    campaign: Campaign,
    *,
    processed: Path,
    reports: Path,
    tests: tuple[str, ...],
    force: bool,
    jobs: int | None,
    scheduler: str | None,
    output: CommandOutput,
) -> None:
    """Reduce a campaign and say what became of each test."""
    opener = read_once()
    with (
        chosen_workers(jobs, scheduler) as workers,
        campaign_progress(output) as progress,
    ):
        if scheduler is not None:
            # the workers have working folders of their own
            campaign = replace(campaign, path=campaign.path.absolute())
            processed = processed.absolute()
        result = run_tests(
            campaign,
            processed=processed,
            reports=reports,
            clock=time.perf_counter,
            tests=tests,
            force=force,
            # paths, jobs and choices of tests are left out, so that equal inputs give equal bytes
            command="reduction run campaign.toml",
            units=cast("UnitSystem", output.units),
            values_page=address_of_design_page(processed, reports, output),
            workers=workers,
            progress=progress,
            opener=opener,
        )
    client = None if result.report is None else _client_report(result.report)
    if result.tests or not (campaign.outcomes or campaign.hoses):
        output.show(_status_table(result.tests))
    _say_results(output, results_found(campaign))
    for kind, parts in (
        ("experiment", result.experiments), ("hose", result.hoses),
        ("comparison", result.comparisons),
    ):  # fmt: skip
        if parts:
            output.show(_part_table(kind, parts))
    for name in result.stray:
        output.error(f"{result.processed / name}: belongs to no test of this campaign; left alone")
    output.say(f"products: {result.processed}")
    if result.tables:
        number, folder = len(result.tables) - 1, result.tables[0].parent
        output.say(f"tables:   {folder}: {number} tables, and columns.csv, which explains them")
    document: dict[str, Any] = {
        "campaign": campaign.id,
        "tests": [test.document() for test in result.tests],
        "experiments": [asdict(one) for one in result.experiments],
        "hoses": [asdict(one) for one in result.hoses],
        "comparisons": [asdict(one) for one in result.comparisons],
        "results": results_found(campaign),
        "processed": str(result.processed),
        "tables": [str(path) for path in result.tables],
        "report": None if result.report is None else str(result.report),
        "client_report": None if client is None else str(client),
    }
    if result.report is None:
        output.say("report:   none; nothing was made that could be shown")
    else:
        output.say(f"report:   {result.report}")
    _say_client_report(client, output)
    document["design_values"] = refresh_design_page(
        processed, reports, output, made=campaign.id, opener=opener
    )
    output.answer(document)
    _report_failures(output, result.tests, result.parts)


def report_again(
    processed: Path, *, reports: Path, is_printed: bool = False, output: CommandOutput
) -> None:
    """Make the reports of one campaign, or of all below a folder, from archives alone."""
    folders = processed_folders(processed)
    written: dict[str, list[str]] = {"reports": [], "client_reports": [], "pdfs": []}
    for folder in folders:
        page = write_report(
            folder, reports / folder.resolve().name, units=cast("UnitSystem", output.units),
            values_page=address_of_design_page(processed, reports, output),
            unreadable=partial(_say_unreadable, output, folder),
        )  # fmt: skip
        output.say(f"report: {page}")
        written["reports"].append(str(page))
        client = _client_report(page)
        _say_client_report(client, output)
        if client is not None:
            written["client_reports"].append(str(client))
            if is_printed:
                written["pdfs"].append(str(_printed(client, output)))
    if is_printed and not written["client_reports"]:
        raise SettingsError(
            "there is no report to a client to print", found=f"no report.json in {processed}",
            needed="[report] in campaign.toml",
            hint="Add it and run the campaign again: what did not change is not reduced again.",
        )  # fmt: skip
    root = processed.resolve().parent if folders == [processed] else processed
    output.answer(written | {"design_values": refresh_design_page(root, reports, output)})


def _say_unreadable(output: CommandOutput, folder: Path, name: str, why: str) -> None:
    output.error(f"{folder / name} is not in the report: {why}")
    output.raise_status(ArchiveError.exit_status)


def _client_report(page: Path) -> Path | None:
    """Report to the client beside the page of a campaign, where there is one."""
    client = page.with_name(PAGE_NAME)
    return client if client.exists() else None


def _say_client_report(client: Path | None, output: CommandOutput) -> None:
    if client is not None:
        output.say(f"report to the client: {client}")


def _printed(client: Path, output: CommandOutput) -> Path:
    from reduction.cli.printing import find_browser, print_page

    pdf = client.with_suffix(".pdf")
    print_page(client, pdf, browser=find_browser())
    output.say(f"printed: {pdf}")
    return pdf
