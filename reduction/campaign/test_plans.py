"""Tests of campaign.toml and tests.csv: files, specimens, settings, steps."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from reduction.campaign.model import (
    CampaignFile,
    Defaults,
    Identifier,
    StepSection,
    TestSection,
    apply_numbers,
)
from reduction.campaign.plan import StepPlan, TestPlan
from reduction.campaign.toml_file import (
    faults_of,
    file_inside,
    in_toml,
    listed,
    quantity_of,
    read_csv_rows,
)
from reduction.readers.remote_files import allowed
from reduction.record.errors import SettingsError
from reduction.record.plain_text import cut, shown_address
from reduction.record.settings import CycleSettings, ReductionSettings, StrainSettings

_LISTS = ("specimens", "target_strain")

_WHOLE = ("order", "n_cycles", "unlogged_cycles", "n_flex_cycles")

# as many digits as a netCDF integer holds
_WHOLE_NUMBER = re.compile(r"[-+]?[0-9]{1,9}")

_STRAIN = ("method", "marks")

# tables of campaign.toml, which no cell can hold
_TABLES = ("strain", "reduction", "steps")

_COLUMNS = ("id", *(name for name in TestSection.model_fields if name not in _TABLES), *_STRAIN)


def _in_table(
    path: Path, problem: str, *, row: int | None = None, channel: str = "", **kwargs: Any
) -> SettingsError:
    """An error of the table of tests, ``FILE:ROW [COLUMN]``."""
    place = ("" if row is None else f":{row}") + (f" [{channel}]" if channel else "")
    return SettingsError(f"{path}{place}: {problem}", **kwargs)


def _cells(path: Path, row: int, cells: dict[str, str]) -> dict[str, Any]:
    """The filled cells of one row, as TOML would have given them."""
    table: dict[str, Any] = {}
    for name, cell in cells.items():
        text = cell.strip()
        if not text or name == "id":
            continue
        if name in _LISTS:
            table[name] = [entry.strip() for entry in text.split(";")]
        elif name in _STRAIN:
            table.setdefault("strain", {})[name] = text
        elif name in _WHOLE:
            if not _WHOLE_NUMBER.fullmatch(text):
                raise _in_table(
                    path, f"{name} is not a whole number", row=row, channel=name,
                    found=repr(cut(text, 60)), needed="a whole number",
                )  # fmt: skip
            table[name] = int(text)
        else:
            table[name] = text
    return table


def read_test_table(path: Path) -> dict[str, TestSection]:
    """Read a table of tests."""
    header, rows = read_csv_rows(path, "the table of tests", fault=_in_table)
    if "id" not in header or "file" not in header or len(set(header)) != len(header):
        raise _in_table(
            path, "the table of tests has no usable header", row=1, found=", ".join(header),
            needed="id, file and keys of [tests.ID], each once",
        )  # fmt: skip
    for name in header:
        if name not in _COLUMNS:
            raise _in_table(
                path, "a column is no key of a test", row=1, channel=name,
                needed="one of " + ", ".join(_COLUMNS),
                hint=f"{' and '.join(_TABLES[1:])} stand in campaign.toml, as [tests.ID]."
                if name in _TABLES else None,
            )  # fmt: skip
    tests: dict[str, TestSection] = {}
    identifier = TypeAdapter(Identifier)
    for number, texts in rows:
        cells = dict(zip(header, texts, strict=True))
        name = cells["id"].strip()
        if name in tests:
            raise _in_table(path, "a test stands twice", row=number, channel="id", found=repr(name))
        filled = _cells(path, number, cells)
        if "file" not in filled:
            raise _in_table(path, "a test has no file", row=number, channel="file")
        try:
            identifier.validate_python(name)
            tests[name] = TestSection.model_validate(filled)
        except ValidationError as error:
            first, *others = faults_of(error, filled)
            raise _in_table(
                path, "a row of tests cannot be used", row=number, channel=first.place or "id",
                found=first.found or None, needed=first.needed.removeprefix("Input should be "),
                hint=f"Also {', '.join(map(str, others))}." if others else None,
            ) from error  # fmt: skip
    return tests


def merge_tests(
    path: Path, table: str, rows: dict[str, TestSection], sections: dict[str, TestSection]
) -> dict[str, TestSection]:
    """Tests of the table and of campaign.toml; a test may stand in both, a key of it in one."""
    twice = [
        f"tests.{name}.{key}"
        for name in rows.keys() & sections.keys()
        for key in sorted(rows[name].model_fields_set & sections[name].model_fields_set)
    ]
    if twice:
        count = f"{len(twice)} settings stand" if len(twice) > 1 else "1 setting stands"
        headline = f"{count} both in {table} and in [tests], first {min(twice)}"
        raise in_toml(path, listed(headline, sorted(twice)))
    tests = rows | sections
    for name in rows.keys() & sections.keys():
        section = sections[name]
        own = {key: getattr(section, key) for key in section.model_fields_set}
        tests[name] = rows[name].model_copy(update=own)
    missing = [f"tests.{name}.file: is required" for name, test in tests.items() if not test.file]
    if missing:
        count = f"{len(missing)} tests have" if len(missing) > 1 else "1 test has"
        where = f", here or as a row of {table}" if table else ""
        raise in_toml(path, listed(f"{count} no file{where}", missing))
    return tests


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
