"""Loads campaign.toml and the files it names into a `Campaign` in SI."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from reduction.archive.open import reading
from reduction.archive.product_files import archives_of_tests
from reduction.campaign.experiment_plans import agree_on_pulls, plan_experiment
from reduction.campaign.hose_plans import hose_of, plan_comparison
from reduction.campaign.model import (
    CampaignFile,
    TestSection,
    check_names,
    report_details,
    stated_errors,
    stated_limits,
)
from reduction.campaign.outcome_results import outcomes_of
from reduction.campaign.plan import Campaign
from reduction.campaign.specimens import pooled_marks, specimen_of
from reduction.campaign.test_plans import merge_tests, plan_test, read_test_table
from reduction.campaign.toml_file import file_inside, in_toml, read_small_text, read_toml
from reduction.readers.remote_files import base_name, fetch, renamed, scratch_folder
from reduction.record.errors import ArchiveError, LogError, SettingsError
from reduction.record.plain_text import is_address, shown_address


def _hint(path: Path) -> str | None:
    """What to do about a name that TOML does not allow twice."""
    text = path.read_text(encoding="utf-8", errors="replace")
    if re.search(r"^tests *=", text, re.MULTILINE) and re.search(
        r"^\[+tests\.", text, re.MULTILINE
    ):
        return 'With [tests.ID] beside it, name the table of tests as tests = "..." in [campaign].'
    return None


def _parse(path: Path, text: str | None) -> CampaignFile:
    return read_toml(
        path,
        CampaignFile,
        text=text,
        what="the campaign",
        needed="a campaign.toml; `reduction init FOLDER` writes a first one",
        keys="`reduction schema` prints every key that is known",
        hint=_hint,
    )


def _results_file(path: Path, file: CampaignFile) -> str:
    """Name of the table of results; empty where the campaign has none."""
    names = {name for name in (file.results, file.campaign.results) if name}
    if len(names) > 1:
        raise in_toml(
            path, "results stands above [campaign] and in it", found=" and ".join(sorted(names)),
            needed="one table of results",
        )  # fmt: skip
    return file_inside(path, names.pop()) if names else ""


def _addresses(path: Path, tests: Mapping[str, TestSection]) -> dict[str, str]:
    """Whole addresses of logs on the net, by what names them in messages and products."""
    found: dict[str, str] = {}
    for test in tests.values():
        entries = [test.file] if isinstance(test.file, str) else [one.file for one in test.file]
        for entry in filter(is_address, entries):
            name = shown_address(entry)
            if found.setdefault(name, entry) != entry:
                raise in_toml(
                    path, "two addresses of logs differ only in what is not shown of them",
                    found=repr(name), needed="another path for each log",
                    hint="User, password and what stands behind ? or # are not kept.",
                )  # fmt: skip
    return found


def load_campaign(path: Path, *, allow_remote: bool = False, text: str | None = None) -> Campaign:
    """Read campaign.toml, its tables and its marks, and check that they fit together.

    Parameters
    ----------
    path : pathlib.Path
        The campaign.toml.
    allow_remote : bool
        Whether the log of a test may be an address on the net. Nothing is fetched here:
        `reduction.campaign.load.staged_campaign` does.
    text : str, optional
        What campaign.toml is to hold; what it does hold where left out.

    Returns
    -------
    campaign : Campaign
        In SI; every file it names is there and lies inside its folder.

    Raises
    ------
    SettingsError
        If a value is still ``?``, or a key, a value or a unit cannot be used: up to ten
        places, one a line.
    LogError
        If a file that it names is missing or cannot be read.
    """
    file = _parse(path, text)
    tests: dict[str, TestSection] = {}
    table = file.tests if isinstance(file.tests, str) else file.campaign.tests
    if table:
        tests |= read_test_table(path.parent / file_inside(path, table))
    if not isinstance(file.tests, str):
        tests = merge_tests(path, table, tests, file.tests)
    if not (tests or file.results or file.campaign.results or file.hoses):
        raise in_toml(
            path, "the campaign has no tests",
            needed="at least one [tests.NAME], or results, or [hoses.NAME]",
        )  # fmt: skip
    plans = {
        name: plan_test(path, name, test, file.defaults, file, allow_remote=allow_remote)
        for name, test in tests.items()
    }
    check_names(path, file.campaign.id, plans)
    for name, plan in plans.items():
        if plan.part_of is not None and plan.part_of not in plans:
            raise in_toml(
                path, f"test '{name}' is part of a test that the campaign lacks",
                found=repr(plan.part_of), needed="one of " + ", ".join(plans),
            )  # fmt: skip
    marks_files = [
        section.strain.marks for section in (file.defaults, *tests.values()) if section.strain.marks
    ]
    marks = pooled_marks(path, marks_files, tuple(file.specimens))
    for specimen, rows in marks.items():
        unknown = sorted(set(rows.test) - set(plans))
        if unknown:
            raise in_toml(
                path, f"the marks of '{specimen}' name a test that the campaign lacks",
                found=", ".join(unknown), needed="one of " + ", ".join(plans),
            )  # fmt: skip
    attributes = {
        key: str(value)
        for key, value in file.campaign.model_dump().items()
        if key not in ("id", "tests", "results", "synthetic") and value
    }
    if file.campaign.synthetic or "synthetic" in file.campaign.source.lower():
        attributes["synthetic"] = "yes"
    specimens = {name: specimen_of(path, name, section) for name, section in file.specimens.items()}
    results, outcomes = outcomes_of(path, _results_file(path, file), specimens)
    experiments = {
        name: plan_experiment(path, name, section, tests=plans, specimens=specimens)
        for name, section in file.experiments.items()
    }
    agree_on_pulls(path, experiments, plans)
    hoses = {
        name: hose_of(path, name, f"hoses.{name}", section, section.cord)
        for name, section in file.hoses.items()
    }
    comparisons = {
        name: plan_comparison(path, name, section, tests=plans, hoses=hoses, specimens=specimens)
        for name, section in file.comparisons.items()
    }
    return Campaign(
        path=path,
        id=file.campaign.id,
        attributes=attributes,
        specimens=specimens,
        layouts=file.layouts,
        tests=plans,
        marks=marks,
        experiments=experiments,
        results=results,
        outcomes=outcomes,
        hoses=hoses,
        comparisons=comparisons,
        uncertainty=stated_errors(path, file.uncertainty, specimens.values()),
        report=report_details(path, file.report, specimens=specimens, tests=plans),
        limits=stated_limits(path, file.limits),
        addresses=_addresses(path, tests),
    )


_UNUSUAL = re.compile(r"[^\w.\-]")


@contextmanager
def staged_campaign(
    path: Path, *, allow_remote: bool = False, progress: Callable[[str, str], None] | None = None
) -> Iterator[Campaign]:
    """Load a campaign with its logs at hand.

    Parameters
    ----------
    path : pathlib.Path
        The campaign.toml.
    allow_remote : bool
        Whether logs are fetched from the net.
    progress : callable, optional
        Called with ("fetch", name) before each file.

    Yields
    ------
    campaign : Campaign
        As `load_campaign` gives it. A log that cannot be fetched is its test's error. Copies
        are gone when the block ends.

    Raises
    ------
    SettingsError
        If a log is an address and addresses are not allowed; else as `load_campaign`.
    """
    campaign = load_campaign(path, allow_remote=allow_remote)
    if not campaign.addresses:
        yield campaign
        return
    names: dict[str, str] = {}
    copies: dict[str, Path] = {}
    unread: dict[str, LogError] = {}
    with scratch_folder() as scratch, renamed(names):
        # one after another: not every package bears threads, and an interruption ends at once
        for place, (name, address) in enumerate(campaign.addresses.items()):
            copy = scratch / str(place) / (_UNUSUAL.sub("_", base_name(name))[-100:] or "log")
            copies[name], names[str(copy)] = copy, name
            if progress is not None:
                progress("fetch", name)
            try:
                fetch(address, copy)
            except LogError as error:
                unread[name] = error
        yield replace(campaign, addresses={}, copies=copies, unread=unread, names=dict(names))


def _id_of_products(processed: Path) -> str:
    """Id of the campaign whose archives lie in a folder."""
    archives = archives_of_tests(processed) if processed.is_dir() else []
    if archives:
        with reading(archives[0]) as archive:
            return str(archive.attrs.get("campaign", ""))
    folders = sorted(processed.iterdir()) if processed.is_dir() else []
    inside = [one.name for one in folders if archives_of_tests(one)]
    if inside:
        raise SettingsError(
            f"{processed} holds a folder for each campaign", found=", ".join(inside),
            needed=f"one of them, such as {processed / inside[0]}",
        )  # fmt: skip
    raise ArchiveError(
        f"there is no archive of a test in {processed}",
        needed="the folder of a campaign, such as processed/CAMPAIGN",
        hint="Run the campaign first.",
    )


def find_campaign(processed: Path, stated: Path | None = None, *, name: str = "") -> Path:
    """Find the campaign.toml that a folder of archives was made from.

    It is looked for where it lies by habit: ``raw/ID/campaign.toml`` and ``ID/campaign.toml``,
    beside ``processed`` and in the working folder.

    Parameters
    ----------
    processed : pathlib.Path
        ``processed/CAMPAIGN``.
    stated : pathlib.Path, optional
        Where the user says that it is.
    name : str, optional
        Id of the campaign; that of the first archive where left out.

    Returns
    -------
    path : pathlib.Path
        Of a campaign of that id.

    Raises
    ------
    SettingsError
        If it is not found, or is another campaign.
    ArchiveError
        If there are no archives.
    """
    name = name or _id_of_products(processed)
    if stated is not None:
        found = _id_of(stated)
        if found != name:
            raise SettingsError(
                f"{stated} is not the campaign of {processed}",
                found="no campaign.toml" if found is None else f"campaign '{found}'",
                needed=f"campaign '{name}'",
            )
        return stated
    above = processed.absolute().parent.parent
    places = [
        root / folder / name / "campaign.toml"
        for root in (above, Path.cwd())
        for folder in ("raw", "")
    ]
    for path in dict.fromkeys(places):
        if _id_of(path) == name:
            return path
    raise SettingsError(
        f"the campaign.toml of '{name}' is not where it is looked for",
        found="none at " + " or ".join(str(path) for path in dict.fromkeys(places)),
        needed="--campaign CAMPAIGN.toml",
        hint="An archive keeps what its numbers were made with, and no path.",
    )


def _id_of(path: Path) -> str | None:
    """Id that a campaign.toml states; None of a file that is none."""
    try:
        document = tomllib.loads(read_small_text(path))
        return str(document["campaign"]["id"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
