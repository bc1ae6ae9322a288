"""Implements the commands check, run, report, init and sniff."""

from __future__ import annotations

import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import asdict, replace
from functools import partial
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.markup import escape
from rich.table import Table

from reduction.archive.atomic_write import atomic_file
from reduction.archive.product_files import (
    CLIENT_PAGE_NAME,
    DESIGN_PAGE_NAME,
    processed_folders,
)
from reduction.batch.campaign_status import (
    CampaignResult,
    PartStatus,
    ShownAnswers,
    TestStatus,
    status_csv,
)
from reduction.batch.finished_run import finished_run, keep_finished
from reduction.batch.run_lock import run_lock
from reduction.batch.workers import Workers, keep_freed_memory, local_workers
from reduction.cli.output import CommandOutput
from reduction.cli.progress import campaign_progress
from reduction.record.errors import ArchiveError, SettingsError
from reduction.record.plain_text import toml_comment

if TYPE_CHECKING:  # a run that finds nothing changed imports none of these
    from reduction.archive.open import Opener
    from reduction.campaign.plan import Campaign
    from reduction.quantities.units import UnitSystem
    from reduction.stages.strain.strain_model import StrainModel


def print_layout(file: Path, output: CommandOutput) -> None:
    """Print a proposed layout in TOML, with its guesses."""
    from reduction.readers.sniff import sniff_layout

    sniffed = sniff_layout(file)
    output.say(sniffed.toml, is_verbatim=True)
    for remark in sniffed.remarks:
        output.say(f"# {toml_comment(remark)}", is_verbatim=True)
    output.say("# `reduction init FOLDER` writes it into a campaign.toml beside the logs")
    output.answer({"layout": sniffed.toml, "remarks": list(sniffed.remarks)})


def start_campaign(folder: Path, output: CommandOutput) -> None:
    """Write campaign.toml and tests.csv to a folder of logs; existing files are never replaced."""
    from reduction.readers.starter_campaign import starter_campaign

    if not folder.is_dir():
        raise SettingsError(f"{folder}: is not a folder", needed="a folder of logs")
    texts = starter_campaign(folder)
    standing = sorted(name for name in texts if (folder / name).exists())
    if standing:
        raise SettingsError(
            f"{folder}: the folder already contains a campaign",
            found=", ".join(standing),
            needed="a folder without these files",
            hint="Move them away first; existing files are not overwritten.",
        )
    for name, text in texts.items():
        with (folder / name).open("x", encoding="utf-8", newline="") as file:
            file.write(text)
        output.say(f"wrote {folder / name}")
    output.say("next: replace every ? in these files, then run:")
    # quoted, so that it can be copied
    output.say(f"reduction check {_quoted(folder / 'campaign.toml')}")
    output.answer({"written": [str(folder / name) for name in texts]})


def _quoted(path: Path) -> str:
    """A path as a shell reads it."""
    text = str(path)
    return f'"{text}"' if re.search(r"[^\w./\\:-]", text) else text


_NAMES = (
    "chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome",
    "microsoft-edge", "microsoft-edge-stable", "msedge",
)  # fmt: skip

# where installers put a browser outside the path
_PLACES = (
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    "/Applications/Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
    r"C:\Program Files\Google\Chrome\Application\chrome.exe",
    r"C:\Program Files (x86)\Microsoft\Edge\Application\msedge.exe",
)

# restrict it to the page: no network, no profile, no background activity
_ALONE = (
    "--headless", "--disable-gpu", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-default-apps", "--disable-extensions",
    "--disable-sync", "--proxy-server=127.0.0.1:9", "--proxy-bypass-list=<-loopback>",
    "--host-resolver-rules=MAP * ~NOTFOUND",
    "--no-pdf-header-footer",
)  # fmt: skip

_LONGEST = 180.0

_BY_HAND = "Open the page in any browser and print it to PDF, without headers and footers."


def _find_browser() -> str:
    """Return the browser for printing: ``BROWSER_PROGRAM``, or the first one found."""
    asked = os.environ.get("BROWSER_PROGRAM")
    if asked:
        found = shutil.which(asked)
        if found is None:
            raise SettingsError(
                "BROWSER_PROGRAM is not a program", found=repr(asked),
                needed="Chromium, Chrome or Edge", hint=_BY_HAND,
            )  # fmt: skip
        return found
    candidates = (shutil.which(name) for name in (*_NAMES, *_PLACES))
    program = next(filter(None, candidates), None)
    if program is None:
        raise SettingsError(
            "no browser found to print the report",
            found="neither Chromium nor Chrome nor Edge",
            needed="one of them on the path, or its path in BROWSER_PROGRAM",
            hint=_BY_HAND,
        )
    return program


def _print_page(page: Path, pdf: Path, *, browser: str) -> None:
    """Print a page to PDF; the file is written completely or not at all."""
    with (
        tempfile.TemporaryDirectory(prefix="reduction-print-") as profile,
        atomic_file(pdf) as part,
    ):
        # a browser run by root refuses to use its sandbox
        is_root = sys.platform != "win32" and os.geteuid() == 0
        printed = Path(profile) / "printed.pdf"
        command = [
            browser, *_ALONE, *(["--no-sandbox"] if is_root else []),
            f"--user-data-dir={Path(profile) / 'profile'}", f"--print-to-pdf={printed}",
            page.absolute().as_uri(),
        ]  # fmt: skip
        said = _run(command, browser)
        if not (printed.is_file() and printed.read_bytes()[:5] == b"%PDF-"):
            raise ArchiveError(
                f"{pdf} was not printed", found=f"{browser}: {said or 'no reason given'}",
                needed="a browser that can print without a window", hint=_BY_HAND,
            )  # fmt: skip
        shutil.copyfile(printed, part)


def _run(command: list[str], browser: str) -> str:
    """Run the browser; return its last line of output."""
    try:
        done = subprocess.run(  # noqa: S603  # a list, no shell; the page is one of ours
            command, capture_output=True, timeout=_LONGEST, check=False
        )
    except subprocess.TimeoutExpired as error:
        raise ArchiveError(
            "the browser did not finish the report", found=f"{browser}, ended after {_LONGEST:g} s",
            hint=_BY_HAND,
        ) from error  # fmt: skip
    except OSError as error:
        raise ArchiveError(
            "the browser cannot be started", found=f"{browser}: {error.strerror or error}",
            hint=_BY_HAND,
        ) from error  # fmt: skip
    lines = done.stderr.decode("utf-8", "replace").strip().splitlines()
    return lines[-1] if lines else ""


def _address_of_design_page(processed: Path, reports: Path, output: CommandOutput) -> str:
    """Address of the design-value page from a report folder; empty if none is written."""
    return "" if _is_copy(processed, reports, output) else f"../{DESIGN_PAGE_NAME}"


def _refresh_design_page(
    processed: Path,
    reports: Path,
    output: CommandOutput,
    *,
    made: str = "",
    opener: Opener | None = None,
) -> str | None:
    """Rewrite the design-value page of a folder of products, and report its location."""
    from reduction.archive.open import reading
    from reduction.pages.design_values import write_design_page

    if _is_copy(processed, reports, output):
        return None
    left_out: dict[Path, str] = {}

    def unreadable(archive: Path, why: str) -> None:
        if archive.parent.name == made:
            raise ArchiveError(
                f"{archive} cannot be read, so the design-value page was not updated",
                found=why.removesuffix("."),
                hint="Check the disk, and run again.",
            )
        left_out[archive] = why

    path = str(
        write_design_page(processed, reports, unreadable=unreadable, opener=opener or reading)
    )
    for archive, why in left_out.items():
        output.error(f"{archive} is not on the page of design values: {why}")
    output.say(f"design values: {path}")
    return path


def _is_copy(processed: Path, reports: Path, output: CommandOutput) -> bool:
    return any(str(folder) in output.names for folder in (processed, reports))


def _errors_stand_below() -> bool:
    """Whether answers and errors share one screen, file or pipe, so that each is printed once."""
    try:
        out, errors = (os.fstat(stream.fileno()) for stream in (sys.stdout, sys.stderr))
    except (AttributeError, OSError, ValueError):  # streams that are not files
        return False
    is_screen = sys.stdout.isatty() and sys.stderr.isatty()
    return is_screen or os.path.samestat(out, errors)


def _status_table(tests: Sequence[TestStatus]) -> Table:
    rows = []
    is_below = _errors_stand_below()
    for test in tests:
        message = escape(test.message)  # untrusted text from files: no markup is interpreted
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
    # hanging weights have no rate, and a run keeps none for a reduced log
    shown = [name for name in rows[0] if any(row[name] for row in rows)] if rows else []
    for name in shown:
        is_count = name not in ("test", "status", "worker", "message")
        table.add_column(escape(name), justify="right" if is_count else "left")
    for row in rows:
        table.add_row(*(row[name] for name in shown))
    return table


def _report_failures(output: CommandOutput, ended: Iterable[TestStatus | PartStatus]) -> None:
    for one in ended:
        if one.exit_status:
            output.error(one.message)
            output.raise_status(one.exit_status)


def _part_table(kind: str, parts: Sequence[PartStatus]) -> Table:
    table = Table(box=None, pad_edge=False)
    for heading in (kind, "status", "message"):
        table.add_column(heading)
    is_below = _errors_stand_below()
    for one in parts:
        is_told = is_below and bool(one.exit_status)
        table.add_row(one.id, one.status, "see below" if is_told else escape(one.message))
    return table


def _model_lines(
    models: dict[tuple[str, str], StrainModel], tests: Sequence[TestStatus], units: UnitSystem
) -> Table:
    from reduction.quantities.units import display_unit

    table = Table(box=None, pad_edge=False)
    length, factor = display_unit("m", units)
    for heading in ("test", "specimen", "strain method", "marks", f"marked range [{length}]"):
        table.add_column(escape(heading))
    shown = {test.test for test in tests}
    for (test, specimen), model in models.items():
        if test in shown:
            low, high = factor * model.position_low, factor * model.position_high
            marked = "-" if math.isnan(low) else f"{low:.3f} to {high:.3f}"
            table.add_row(test, specimen, _method(model), model.marks_from, marked)
    return table


def _method(model: StrainModel) -> str:
    """Strain method; for an average, the laws with the highest and second weights."""
    for one in model.notes:
        if one.code == "splice-laws":
            laws = [str(one.numbers["law"]), str(one.numbers["second"])]
            return f"{model.method}: {', '.join(filter(None, laws))}"
    return model.method


def _say_results(output: CommandOutput, results: dict[str, Any] | None) -> None:
    """Print the number of outcomes without a log, and each of them."""
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


def _say_experiments(output: CommandOutput, experiments: list[dict[str, Any]]) -> None:
    """Print runs, slow pulls and possible slack before anything is run."""
    force, factor = output.unit("N")
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


@contextmanager
def _chosen_workers(jobs: int | None, scheduler: str | None) -> Iterator[Workers | None]:
    """Start the workers requested by ``--jobs`` or ``--scheduler``, and stop them afterwards."""
    if jobs is not None and scheduler is not None:
        raise SettingsError(
            "--jobs and --scheduler exclude each other",
            found=f"--jobs {jobs} --scheduler {scheduler}",
            hint="The number of workers of a scheduler is set where they are started.",
        )
    if scheduler is None:
        with local_workers(jobs) if jobs is not None and jobs > 1 else nullcontext() as workers:
            yield workers
        return
    try:
        from reduction.batch.dask_cluster import users_cluster
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in ("dask", "distributed"):
            raise
        raise SettingsError(
            "--scheduler needs Dask, which is not installed",
            found=f"no package '{error.name}'",
            hint="Install it: pip install 'mooring-reduction[cluster]'. --jobs does not need it.",
        ) from error
    with users_cluster(scheduler) as workers:
        yield workers


def check_campaign(campaign: Campaign, *, tests: tuple[str, ...], output: CommandOutput) -> None:
    """Read and validate everything, print the findings, write nothing."""
    from reduction.batch.experiment_product import experiments_found
    from reduction.batch.requested_products import check_campaign as check_tests
    from reduction.batch.run_campaign import results_found

    with campaign_progress(output) as progress:
        statuses, models = check_tests(campaign, tests=tests, progress=progress)
    if statuses or not (campaign.outcomes or campaign.hoses):
        output.show(_status_table(statuses))
    force, factor = output.unit("N")
    for test in statuses:
        for channel, masks in test.found.get("flags", {}).items():
            listed = ", ".join(f"{name} {count}" for name, count in masks.items())
            output.say(f"  {test.test}: {channel}: samples flagged: {listed}")
        loads = test.found.get("load_at_slack", {})
        known = [
            f"{name} {factor * one['value']:.3g} {force}" for name, one in loads.items() if one
        ]
        if known:
            output.say(f"  {test.test}: load at slack rests: {', '.join(known)}")
        for note in test.found.get("notes", ()):
            output.say(f"  {test.test}: {note}")
    lines = _model_lines(models, statuses, output.system)
    if lines.row_count:  # hanging weights and failed logs have no strain model
        output.show(lines)
    results = results_found(campaign)
    _say_results(output, results)
    for note in (results or {}).get("notes", ()):  # a run lists them among the items to check
        output.say(f"  {note}")
    experiments = experiments_found(campaign, statuses)
    _say_experiments(output, experiments)
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
) -> dict[str, Any]:
    """Reduce a campaign and print the status of each test; return the document for ``--json``."""
    from reduction.archive.open import ReadOnce
    from reduction.batch.run_campaign import run_campaign as run_tests

    opener = ReadOnce()
    with (
        _chosen_workers(jobs, scheduler) as workers,
        campaign_progress(output) as progress,
    ):
        if workers is None:  # with workers, this process holds the pages of many tests
            keep_freed_memory()
        if scheduler is not None:
            # the workers have their own working folders
            campaign = replace(campaign, path=campaign.path.absolute())
            processed = processed.absolute()
        result = run_tests(
            campaign,
            processed=processed,
            reports=reports,
            clock=time.perf_counter,
            tests=tests,
            force=force,
            # without paths, jobs and selected tests, so that equal inputs give equal bytes
            command="reduction run campaign.toml",
            units=output.system,
            values_page=_address_of_design_page(processed, reports, output),
            workers=workers,
            progress=progress,
            opener=opener,
        )
    _say_run(result, output)
    page = _refresh_design_page(processed, reports, output, made=campaign.id, opener=opener)
    if not tests and not output.names:
        keep_finished(result, _choices(processed, reports, output))
    return _document_of(result, campaign.id, page, output)


def say_unchanged(path: Path, *, processed: Path, reports: Path, output: CommandOutput) -> bool:
    """Report that nothing has changed since the last run; False if something has."""
    choices = _choices(processed, reports, output)
    result = finished_run(path, processed, reports, choices)
    page = reports / DESIGN_PAGE_NAME
    if result is None or not page.is_file():
        return False
    with run_lock(result.processed), campaign_progress(output) as progress:
        progress.stage("reduce", len(result.tests))
        for one in result.tests:
            progress.ended(one.test, one)
        if result.tests:
            with atomic_file(result.processed / "status.csv") as part:
                part.write_text(status_csv(result.tests), encoding="utf-8", newline="")
    name = result.processed.name
    _say_run(result, output)
    output.say(f"design values: {page}")
    output.answer(_document_of(result, name, str(page), output))
    return True


def _choices(processed: Path, reports: Path, output: CommandOutput) -> dict[str, str]:
    """Options of a run that affect a product, beside its campaign."""
    return {
        "units": output.units,
        "values_page": _address_of_design_page(processed, reports, output),
    }


def _say_run(result: CampaignResult, output: CommandOutput) -> None:
    """Print the status of each test and part, and the location of the products."""
    answered = _show_answers(output, result.answers)
    others = [
        replace(one, message=one.message or result.answers.withheld.get(one.test, ""))
        for one in result.tests
        if one.test not in answered
    ]
    has_other_answers = bool((result.results or {}).get("outcomes") or result.parts.get("hoses"))
    if others or not (answered or has_other_answers):
        output.show(_status_table(others))
    _say_results(output, result.results)
    for kind, parts in result.parts.items():
        # the answers of successful ones are printed above
        told = [one for one in parts if one.exit_status or one.status in ("no_work", "failed")]
        if told:
            output.show(_part_table(kind.removesuffix("s"), told))
    for stray in result.stray:
        output.error(
            f"{result.processed / stray}: a step of a log that failed in this run; left where it is"
        )
    if result.replaced is not None:
        output.error(
            f"{result.processed}: replaced the results of {result.replaced}, which has the same id."
            " Give each campaign its own id, or another --processed and --reports"
        )
    for path in result.superseded:
        output.error(
            f"{path}: this campaign no longer makes it; it was moved there and is not used"
        )
    has_failed = bool(result.tests) and all(one.status == "failed" for one in result.tests)
    output.say(f"archives: {'none; all tests failed' if has_failed else result.processed}")
    if result.tables and not has_failed:
        number, folder = len(result.tables) - 1, result.tables[0].parent
        output.say(f"tables:   {folder}: {number} tables, and columns.csv, which explains them")
    if result.report is None:
        output.say("report:   none; there is nothing to show")
    else:
        output.say(f"report:   {result.report}{', which says why' if has_failed else ''}")
        _say_client_report(_client_report(result.report), output)


def _document_of(
    result: CampaignResult, name: str, design_page: str | None, output: CommandOutput
) -> dict[str, Any]:
    """Return the JSON object of a run, after printing its failures."""
    client = None if result.report is None else _client_report(result.report)
    _report_failures(output, [*result.tests, *chain(*result.parts.values())])
    return {
        "campaign": name,
        "tests": [test.document() for test in result.tests],
        **{kind: [asdict(one) for one in parts] for kind, parts in result.parts.items()},
        "results": result.results,
        "processed": str(result.processed),
        "superseded": [str(path) for path in result.superseded],
        "tables": [str(path) for path in result.tables],
        "report": None if result.report is None else str(result.report),
        "client_report": None if client is None else str(client),
        "design_values": design_page,
    }


_MOST_DOUBTS = 5


def _show_answers(output: CommandOutput, found: ShownAnswers) -> Sequence[str]:
    """Print the answers of a run, then the items to check; return the tests with a row."""
    if not output.is_text:
        return ()
    if found.is_synthetic:
        output.say("SYNTHETIC DATA: no specimen was tested.")
    for answers in found.tables:
        output.say(answers.caption)
        table = Table(box=None, pad_edge=False)
        for heading, is_number in zip(answers.columns, answers.number_columns, strict=True):
            table.add_column(escape(heading), justify="right" if is_number else "left")
        for row in answers.rows:
            table.add_row(*map(escape, row))
        output.show(table)
        output.say("")
    lacking = [test for test in found.answered if found.withheld.get(test)]
    if lacking:
        output.say("Withheld:")
    for test in lacking[:_MOST_DOUBTS]:
        output.say(f"  {test}: {found.withheld[test]}")
    if len(lacking) > _MOST_DOUBTS:
        output.say("  The report lists the others.")
    if found.doubts:
        output.say("Check:")
    for tests, text in found.doubts[:_MOST_DOUBTS]:
        output.say(f"  {tests}: {text}")
    if len(found.doubts) > _MOST_DOUBTS:
        output.say("  The report lists the others.")
    return found.answered


def report_again(
    processed: Path, *, reports: Path, is_printed: bool = False, output: CommandOutput
) -> None:
    """Rebuild the reports of one campaign, or of all below a folder, from archives only."""
    from reduction.report.campaign_page import write_report

    folders = processed_folders(processed)
    written: dict[str, list[str]] = {"reports": [], "client_reports": [], "pdfs": []}
    for folder in folders:
        page = write_report(
            folder, reports / folder.resolve().name, units=output.system,
            values_page=_address_of_design_page(processed, reports, output),
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
            "there is no client report to print", found=f"no report.json in {processed}",
            needed="[report] in campaign.toml",
            hint="Add it and run the campaign again; unchanged tests are not reduced again.",
        )  # fmt: skip
    root = processed.resolve().parent if folders == [processed] else processed
    output.answer(written | {"design_values": _refresh_design_page(root, reports, output)})


def _say_unreadable(output: CommandOutput, folder: Path, name: str, why: str) -> None:
    output.error(f"{folder / name} is not in the report: {why}")
    output.raise_status(ArchiveError.exit_status)


def _client_report(page: Path) -> Path | None:
    """Client report beside the page of a campaign, if there is one."""
    client = page.with_name(CLIENT_PAGE_NAME)
    return client if client.exists() else None


def _say_client_report(client: Path | None, output: CommandOutput) -> None:
    if client is not None:
        output.say(f"report to the client: {client}")


def _printed(client: Path, output: CommandOutput) -> Path:

    pdf = client.with_suffix(".pdf")
    _print_page(client, pdf, browser=_find_browser())
    output.say(f"printed: {pdf}")
    return pdf


_DEMO_NAMES = ("tmt-synthetic", "nylon-synthetic", "hose-synthetic")

_PACKAGE = Path(__file__).parents[1]

_MADE_HERE = shutil.ignore_patterns("__pycache__")


def _demo_campaigns() -> Path:
    """Location of the campaigns: in an installed package, or in its checkout."""
    installed = _PACKAGE / "demo"
    return installed if installed.is_dir() else _PACKAGE.parent / "raw"


def run_demo(folder: Path, output: CommandOutput) -> None:
    """Copy each campaign to ``raw`` in a folder and run it; existing files are not replaced."""
    from reduction.campaign.load import load_campaign

    raw = folder / "raw"
    standing = [name for name in _DEMO_NAMES if (raw / name).exists()]
    if standing:
        raise SettingsError(
            f"{raw}: campaigns are there already", found=", ".join(standing),
            needed="a folder without them",
            hint="Name another folder, or run them as they are: "
            f'reduction run "{raw / standing[0] / "campaign.toml"}"',
        )  # fmt: skip
    for name in _DEMO_NAMES:
        shutil.copytree(_demo_campaigns() / name, raw / name, ignore=_MADE_HERE)
    documents = []
    for name in _DEMO_NAMES:
        campaign = load_campaign(raw / name / "campaign.toml")
        output.say(f"{campaign.attributes['title']}: {raw / name / 'campaign.toml'}\n")
        documents.append(
            run_campaign(
                campaign, processed=folder / "processed", reports=folder / "reports", tests=(),
                force=False, jobs=None, scheduler=None, output=output,
            )
        )  # fmt: skip
        output.say("")
    output.answer({"folder": str(folder), "campaigns": documents})
