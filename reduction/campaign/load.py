"""campaign.toml and the files it names, to a `Campaign` in SI."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from reduction.archive.products import OF_CAMPAIGN
from reduction.campaign.comparisons import plan_comparison
from reduction.campaign.experiments import agree_on_pulls, plan_experiment
from reduction.campaign.faults import in_toml, quantity_of
from reduction.campaign.hoses import hose_of
from reduction.campaign.marks import read_marks
from reduction.campaign.model import (
    CampaignFile,
    Defaults,
    StepSection,
    TestSection,
)
from reduction.campaign.numbers import apply_numbers
from reduction.campaign.outcomes import outcomes_of
from reduction.campaign.plan import Campaign, StepPlan, TestPlan
from reduction.campaign.specimens import specimen_of
from reduction.campaign.testtable import merge_tests, read_test_table
from reduction.campaign.toml import read_toml
from reduction.campaign.uncertaintyspec import stated_errors
from reduction.errors import LogError, SettingsError
from reduction.record import SpliceMarks
from reduction.settings import CycleSettings, ReductionSettings, StrainSettings

__all__ = ["load_campaign"]

_KEPT = (
    "rate", "medium", "soak", "temperature", "machine", "load_cell", "calibration_due",
    "operator", "procedure", "note",
)  # fmt: skip
_KEPT_OF_TEST = ("date", "rest", "unlogged_cycles", "n_flex_cycles", "flex_angle")


def _hint(path: Path) -> str | None:
    """What to do about a name that TOML does not allow twice."""
    text = path.read_text(encoding="utf-8", errors="replace")
    if re.search(r"^tests *=", text, re.MULTILINE) and re.search(
        r"^\[+tests\.", text, re.MULTILINE
    ):
        return 'With [tests.ID] beside it, name the table of tests as tests = "..." in [campaign].'
    return None


def _parse(path: Path) -> CampaignFile:
    return read_toml(
        path,
        CampaignFile,
        what="the campaign",
        needed="a campaign.toml; `reduction init FOLDER` writes a first one",
        keys="`reduction schema` prints every key that is known",
        hint=_hint,
    )


def _inside(path: Path, name: str, *, is_needed: bool = True) -> str:
    """A file name that stays inside the campaign folder, or `SettingsError`."""
    if "://" in name:
        raise in_toml(
            path, "URLs are not read by this version", found=repr(name),
            needed="a file inside the folder of campaign.toml",
            hint="Download it first.",
        )  # fmt: skip
    folder = path.parent.resolve()
    target = (folder / name).resolve()
    if not name or Path(name).is_absolute() or not target.is_relative_to(folder):
        raise in_toml(
            path, "a file lies outside the campaign folder", found=repr(name),
            needed="a path inside the folder of campaign.toml, links followed",
        )  # fmt: skip
    if is_needed and not target.is_file():
        raise LogError(path.parent / name, "the file is not there", needed=f"as {path} says")
    return name


def _range(path: Path, test: str, step: StepSection) -> dict[str, Any]:
    if isinstance(step.start, int) and isinstance(step.end, int):
        return {"time_range": None, "cycle_range": (step.start, step.end)}
    if isinstance(step.start, str) and isinstance(step.end, str):
        place = f"tests.{test}.steps '{step.name}'"
        times = (
            quantity_of(path, f"{place}: from", step.start, "time"),
            quantity_of(path, f"{place}: to", step.end, "time"),
        )
        if times[0] < times[1]:
            return {"time_range": times, "cycle_range": None}
    raise in_toml(
        path, f"step '{step.name}' of test '{test}' has no range",
        found=f"from {step.start!r} to {step.end!r}",
        needed='two rising times with units ("1200 s") or two cycle numbers',
    )  # fmt: skip


def _plan(
    path: Path,
    name: str,
    test: TestSection,
    defaults: Defaults,
    file: CampaignFile,
) -> TestPlan:
    def given(key: str) -> Any:
        return getattr(test, key) if key in test.model_fields_set else getattr(defaults, key)

    layout = given("layout")
    pieces = (
        ((test.file, layout),)
        if isinstance(test.file, str)
        else tuple((piece.file, piece.layout or layout) for piece in test.file)
    )
    for _, piece_layout in pieces:
        if piece_layout not in file.layouts:
            raise in_toml(
                path, f"test '{name}' has no layout", found=repr(piece_layout),
                needed="one of [layouts]: " + (", ".join(file.layouts) or "there are none"),
            )  # fmt: skip
    specimens = given("specimens")
    unknown = [entry for entry in specimens if entry not in file.specimens]
    if unknown or not specimens:
        raise in_toml(
            path, f"test '{name}' names no known specimen", found=", ".join(unknown) or "none",
            needed="one of [specimens]: " + ", ".join(file.specimens),
        )  # fmt: skip
    if len(set(specimens)) < len(specimens):
        raise in_toml(
            path, f"test '{name}' names a specimen twice", found=", ".join(specimens),
            needed="each specimen once, in the order of the tension channels",
        )  # fmt: skip
    strain = given("strain")
    settings = ReductionSettings(
        strain=StrainSettings(method=strain.method),
        cycles=CycleSettings(
            control=given("control"), waveform=given("waveform"), expected_cycles=test.n_cycles
        ),
    )
    for table in (defaults.reduction, test.reduction):
        try:
            settings = apply_numbers(settings, table, control=given("control"))
        except SettingsError as error:
            raise in_toml(path, f"test '{name}': {error}") from error
    kind = test.kind or defaults.kind
    if len({step.name.replace(" ", "-") for step in test.steps}) < len(test.steps):
        raise in_toml(path, f"two steps of test '{name}' have one name")
    attributes = {key: given(key) for key in _KEPT if given(key)}
    attributes |= {
        key: str(getattr(test, key))
        for key in _KEPT_OF_TEST
        if getattr(test, key) not in (None, "")
    }
    if test.flex_angle is not None:
        quantity_of(path, f"tests.{name}.flex_angle", test.flex_angle, "angle")
    return TestPlan(
        id=name,
        kind=kind,
        # a log that is not there is its test's error, and the other tests go on
        files=tuple((_inside(path, entry, is_needed=False), str(used)) for entry, used in pieces),
        specimens=specimens,
        order=test.order,
        control=given("control"),
        waveform=given("waveform"),
        target_strain=test.target_strain,
        attributes=attributes,
        settings=settings,
        part_of=test.part_of,
        log=name,
        failed=test.failed,
        unlogged_cycles=test.unlogged_cycles,
        n_flex_cycles=test.n_flex_cycles,
        steps=tuple(
            StepPlan(
                name=step.name,
                kind=step.kind or kind,
                expected_cycles=step.n_cycles,
                target_strain=step.target_strain,
                failed=step.failed,
                note=step.note,
                **_range(path, name, step),
            )
            for step in test.steps
        ),
    )


def _pool(path: Path, names: Iterable[str], specimens: Iterable[str]) -> dict[str, SpliceMarks]:
    """All marks of each specimen over the campaign, from every marks file it names."""
    pooled: dict[str, SpliceMarks] = {}
    for name in dict.fromkeys(names):
        for specimen, marks in read_marks(path.parent / _inside(path, name)).items():
            if specimen not in specimens:
                raise LogError(
                    path.parent / name, "a mark names an unknown specimen", channel="specimen",
                    found=repr(specimen), needed="one of " + ", ".join(specimens),
                )  # fmt: skip
            before = pooled.get(specimen)
            if before is None:
                pooled[specimen] = marks
                continue
            pooled[specimen] = replace(
                before,
                test=before.test + marks.test,
                hold=before.hold + marks.hold,
                near_toe=np.concatenate([before.near_toe, marks.near_toe]),
                far_toe=np.concatenate([before.far_toe, marks.far_toe]),
                far_thimble=np.concatenate([before.far_thimble, marks.far_thimble]),
                reading_uncertainty=max(before.reading_uncertainty, marks.reading_uncertainty),
            )
    return pooled


def _results_file(path: Path, file: CampaignFile) -> str:
    """Name of the table of results; empty where the campaign has none."""
    names = {name for name in (file.results, file.campaign.results) if name}
    if len(names) > 1:
        raise in_toml(
            path, "results stands above [campaign] and in it", found=" and ".join(sorted(names)),
            needed="one table of results",
        )  # fmt: skip
    return _inside(path, names.pop()) if names else ""


def load_campaign(path: Path) -> Campaign:
    """Read campaign.toml, its tables and its marks, and check that they fit together.

    Parameters
    ----------
    path : pathlib.Path
        The campaign.toml.

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
    file = _parse(path)
    tests: dict[str, TestSection] = {}
    table = file.tests if isinstance(file.tests, str) else file.campaign.tests
    if table:
        tests |= read_test_table(path.parent / _inside(path, table))
    if not isinstance(file.tests, str):
        tests = merge_tests(path, table, tests, file.tests)
    if not (tests or file.results or file.campaign.results or file.hoses):
        raise in_toml(
            path, "the campaign has no tests",
            needed="at least one [tests.NAME], or results, or [hoses.NAME]",
        )  # fmt: skip
    plans = {name: _plan(path, name, test, file.defaults, file) for name, test in tests.items()}
    taken = sorted(set(plans) & set(OF_CAMPAIGN))
    if taken:
        raise in_toml(
            path, f"test '{taken[0]}' has the name of a product of the campaign",
            needed="another name than " + ", ".join(OF_CAMPAIGN),
        )  # fmt: skip
    for name, plan in plans.items():
        if plan.part_of is not None and plan.part_of not in plans:
            raise in_toml(
                path, f"test '{name}' is part of a test that the campaign lacks",
                found=repr(plan.part_of), needed="one of " + ", ".join(plans),
            )  # fmt: skip
    marks_files = [
        section.strain.marks for section in (file.defaults, *tests.values()) if section.strain.marks
    ]
    marks = _pool(path, marks_files, tuple(file.specimens))
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
    )
