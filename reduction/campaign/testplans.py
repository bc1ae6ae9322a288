"""What a test of campaign.toml is to be: its files, specimens, numbers and steps."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from reduction.address import shown_address
from reduction.campaign.faults import in_toml, quantity_of
from reduction.campaign.files import file_inside
from reduction.campaign.model import (
    CampaignFile,
    Defaults,
    StepSection,
    TestSection,
)
from reduction.campaign.numbers import apply_numbers
from reduction.campaign.plan import StepPlan, TestPlan
from reduction.errors import SettingsError
from reduction.remote import allowed
from reduction.settings import CycleSettings, ReductionSettings, StrainSettings

_KEPT = (
    "rate", "medium", "soak", "temperature", "machine", "load_cell", "calibration_due",
    "operator", "procedure", "note",
)  # fmt: skip
_KEPT_OF_TEST = ("date", "rest", "unlogged_cycles", "n_flex_cycles", "flex_angle")


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


def _log_name(path: Path, test: str, entry: str, allow_remote: bool) -> str:
    """What names a log in messages and products: a path inside the folder, or an address."""
    try:
        is_remote = allowed(entry, allow_remote, what=f"the log of test '{test}'")
    except SettingsError as error:
        raise in_toml(
            path, error.problem, found=error.found, needed=error.needed, hint=error.hint
        ) from error
    return shown_address(entry) if is_remote else file_inside(path, entry, is_needed=False)


def plan_test(
    path: Path,
    name: str,
    test: TestSection,
    defaults: Defaults,
    file: CampaignFile,
    *,
    allow_remote: bool = False,
) -> TestPlan:
    """Return a test with the defaults of its campaign, in SI; an error names file and key."""

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
        files=tuple(
            (_log_name(path, name, entry, allow_remote), str(used)) for entry, used in pieces
        ),
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
