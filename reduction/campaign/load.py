"""campaign.toml and the files it names, to a `Campaign` in SI."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from reduction.address import is_address, shown_address
from reduction.campaign.comparisons import plan_comparison
from reduction.campaign.experiments import agree_on_pulls, plan_experiment
from reduction.campaign.faults import in_toml
from reduction.campaign.files import file_inside
from reduction.campaign.hoses import hose_of
from reduction.campaign.limits import stated_limits
from reduction.campaign.marks import pooled_marks
from reduction.campaign.model import (
    CampaignFile,
    TestSection,
)
from reduction.campaign.names import check_names
from reduction.campaign.outcomes import outcomes_of
from reduction.campaign.plan import Campaign
from reduction.campaign.reportspec import report_details
from reduction.campaign.specimens import specimen_of
from reduction.campaign.testplans import plan_test
from reduction.campaign.testtable import merge_tests, read_test_table
from reduction.campaign.toml import read_toml
from reduction.campaign.uncertaintyspec import stated_errors


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
        `reduction.campaign.staged.staged_campaign` does.
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
