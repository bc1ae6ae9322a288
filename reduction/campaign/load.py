"""Loads campaign.toml and the files it names into a `Campaign` in SI."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from decimal import Decimal
from pathlib import Path, PureWindowsPath
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from reduction.archive.open import reading
from reduction.archive.product_files import OF_CAMPAIGN, archives_of_tests, campaign_of
from reduction.campaign.experiment_plans import agree_on_pulls, plan_experiment
from reduction.campaign.hose_spec import ComparisonSection, hose_of
from reduction.campaign.model import (
    CampaignFile,
    Defaults,
    Identifier,
    SpecimenSection,
    StepSection,
    TestSection,
    apply_numbers,
    report_details,
    stated_errors,
)
from reduction.campaign.outcome_results import outcomes_of
from reduction.campaign.plan import (
    Campaign,
    ComparisonPlan,
    StepPlan,
    TestPlan,
    cycles_of_kind,
    product_of,
)
from reduction.campaign.toml_file import (
    at_place,
    faults_of,
    in_toml,
    listed,
    noting_small_files,
    quantity_of,
    read_csv_rows,
    read_small_text,
    read_toml,
)
from reduction.quantities.units import scale_to_si
from reduction.readers.layout import check_regular
from reduction.readers.remote_files import allowed, base_name, fetch, renamed, scratch_folder
from reduction.record.errors import ArchiveError, LogError, SettingsError
from reduction.record.measurement import MarkPlace, Specimen, SpliceMarks
from reduction.record.plain_text import cut, is_address, shown_address
from reduction.record.settings import CycleSettings, Limits, ReductionSettings, StrainSettings


def _check_names(path: Path, campaign: str, tests: Mapping[str, TestPlan]) -> None:
    """Refuse names that would give two products the same file on some system."""
    for name in (campaign, *tests):
        if _DEVICE.fullmatch(name):
            raise in_toml(
                path, "a name is reserved for a device on Windows", found=repr(name),
                needed="another name: it is used for a file or a folder",
            )  # fmt: skip
    seen = dict.fromkeys(OF_CAMPAIGN, "")
    for name in tests:
        other = seen.setdefault(name.casefold(), name)
        if not other:
            raise in_toml(
                path, f"test '{name}' has the name of another archive of the campaign",
                needed="another name than " + ", ".join(OF_CAMPAIGN),
            )  # fmt: skip
        if other != name:
            raise in_toml(
                path, "the names of two tests differ only in capital letters",
                found=f"'{other}' and '{name}'", needed="names that are different on every disk",
            )  # fmt: skip
    for name, test in tests.items():
        if len({step.product(name).casefold() for step in test.steps}) < len(test.steps):
            raise in_toml(
                path, f"two steps of test '{name}' have the same name",
                needed="names that are different on every disk",
                hint="Blanks count as hyphens, and small letters as capitals.",
            )  # fmt: skip


_DEVICE = re.compile(
    r"(con|prn|aux|nul|conin\$|conout\$|com[0-9¹²³]|lpt[0-9¹²³]) *(\..*)?", re.IGNORECASE
)
"""Names of Windows devices in every folder, whatever their suffix."""


def _file_inside(path: Path, name: str, *, is_needed: bool = True) -> str:
    """A file name inside the campaign folder; others are refused."""
    shown = repr(cut(name, 200))
    if is_address(name):
        raise in_toml(
            path, "only the log of a test can be a URL",
            found=repr(shown_address(name)), needed="a file inside the folder of campaign.toml",
        )  # fmt: skip
    if any(map(_DEVICE.fullmatch, re.split(r"[/\\]", name))):
        raise _no_name(path, shown)
    try:
        folder = path.parent.resolve()
        target = (folder / name).resolve()
    except (ValueError, RuntimeError, OSError) as error:  # a null byte, circular links, length
        raise _no_name(path, shown) from error
    windows = PureWindowsPath(name)
    is_absolute = Path(name).is_absolute() or windows.drive or windows.root
    if not name or is_absolute or not target.is_relative_to(folder):
        raise in_toml(
            path, "a file lies outside the campaign folder", found=shown,
            needed="a path inside the folder of campaign.toml, links followed",
        )  # fmt: skip
    if is_needed:
        _check_there(path, target, path.parent / name)
    return name


def _no_name(path: Path, shown: str) -> SettingsError:
    return in_toml(
        path, "no file can have such a name", found=shown,
        needed="a path inside the folder of campaign.toml, links followed",
    )  # fmt: skip


def _check_there(path: Path, target: Path, shown: Path) -> None:
    try:
        mode = target.stat().st_mode
    except FileNotFoundError as error:
        raise LogError(shown, "the file is not there", needed=f"as {path} says") from error
    except OSError as error:  # a folder closed to this user, a name that is too long
        raise LogError(
            shown, "the file cannot be read", found=error.strerror or str(error),
            needed="a file that this user may read",
        ) from error  # fmt: skip
    check_regular(shown, mode)


def _readings(stated: tuple[float, ...] | float) -> tuple[float, ...]:
    """Readings of one dimension; a single one needs no list."""
    return stated if isinstance(stated, tuple) else (stated,)


def _cross_section(path: Path, place: str, section: SpecimenSection) -> tuple[float, ...]:
    """Area of a specimen without a diameter: stated, of a strip, or from its linear density."""
    width, thickness = _readings(section.width), _readings(section.thickness)
    stated = {
        "diameter": bool(section.diameter),
        "area": bool(section.area),
        "width and thickness": bool(width or thickness),
        "density": section.density is not None,
    }
    ways = [name for name, is_stated in stated.items() if is_stated]
    if len(ways) > 1:
        raise in_toml(
            path, f"{place} states its cross-section in two ways", found=", ".join(ways),
            needed="diameter, or area, or width and thickness, or linear_density and density",
        )  # fmt: skip
    if bool(width) != bool(thickness):
        raise in_toml(
            path, f"{place}.{'width' if width else 'thickness'} is stated alone",
            needed="width and thickness",
        )  # fmt: skip
    if width:
        if len(width) != len(thickness) and 1 not in (len(width), len(thickness)):
            raise in_toml(
                path, f"{place}: readings of width and thickness are not of the same places",
                found=f"{len(width)} and {len(thickness)}", needed="the same number of both",
            )  # fmt: skip
        return tuple((np.array(width) * np.array(thickness)).tolist())
    if section.density is not None:
        if section.linear_density is None:
            raise in_toml(path, f"{place}.density is stated alone", needed="linear_density too")
        return (section.linear_density / section.density,)
    return _readings(section.area)


def _specimen_of(path: Path, name: str, section: SpecimenSection) -> Specimen:
    """The specimen before its first test; errors name campaign.toml and the key."""
    place = f"specimens.{name}"
    dry, wet = section.linear_density, section.wet_linear_density
    if dry is not None and wet is not None and not wet < dry:
        raise in_toml(
            path, f"{place}.wet_linear_density is not below linear_density",
            found=f"{wet:g} kg/m, {dry:g} kg/m",
            needed="the mass in air less that of the displaced water",
        )  # fmt: skip
    if section.gauge_length is None and section.gauge_length_standard_uncertainty is not None:
        raise in_toml(
            path, f"{place}.gauge_length_standard_uncertainty is stated alone",
            needed="gauge_length beside it",
        )  # fmt: skip
    if section.gauge_length is None and section.reference_tension is not None:
        raise in_toml(
            path, f"{place}.reference_tension is stated alone",
            needed="gauge_length beside it, the length under that tension",
        )  # fmt: skip
    sizes = {"area", "width", "thickness", "density"}
    given = section.model_dump(exclude={"stretched_diameter", "note", *sizes})
    given["diameter"] = _readings(section.diameter)
    given["cross_section"] = _cross_section(path, place, section)
    if section.stretched_diameter and not section.diameter:
        raise in_toml(
            path, f"{place}.stretched_diameter is stated alone",
            needed="diameter beside it, the readings before stretch",
        )  # fmt: skip
    stretched = [
        (quantity_of(path, f"{place}.stretched_diameter", stretch, "strain"), reading)
        for stretch, readings in section.stretched_diameter.items()
        for reading in readings
    ]
    return Specimen(
        name=name,
        **given,
        stretched_diameters=tuple(stretched),
        notes=(section.note,) if section.note else (),
    )


_LENGTHS = ("near_toe", "far_toe", "far_thimble")

_SUFFIXES = {"ft": "ft", "in": "inch", "m": "m", "mm": "mm", "cm": "cm"}

# as read from a tape, with digits that show its resolution; or converted by a spreadsheet, up to
# twenty
_NUMBER = re.compile(r"[-+]?([0-9]{1,9}(\.[0-9]{0,20})?|\.[0-9]{1,20})([eE][-+]?[0-9]{1,2})?")

_HOLDS = ("slack", "min", "centre", "max")

_FINEST_TAPE = 0.0005  # m: default limit of tape resolution, whatever the digits


@dataclass
class _Rows:
    test: list[str] = field(default_factory=list)
    hold: list[str] = field(default_factory=list)
    lengths: list[tuple[float, float, float]] = field(default_factory=list)
    decimals: list[float] = field(default_factory=list)
    place: list[MarkPlace] = field(default_factory=list)


def _columns(path: Path, header: list[str]) -> dict[str, tuple[int, float]]:
    """Column index and factor to metres of each length."""
    found: dict[str, tuple[int, float]] = {}
    for index, name in enumerate(header):
        stem, _, suffix = name.strip().rpartition("_")
        if stem in _LENGTHS and suffix in _SUFFIXES:
            if stem in found:
                raise LogError(path, f"two columns contain {stem}", row=1, channel=name)
            found[stem] = (index, scale_to_si(_SUFFIXES[suffix], "length")[0])
    missing = [name for name in _LENGTHS if name not in found]
    missing += [name for name in ("test", "specimen", "hold") if name not in header]
    if missing:
        raise LogError(
            path,
            "the marks file lacks a column",
            row=1,
            found=", ".join(header),
            needed="test, specimen, hold, near_toe_ft, far_toe_ft, far_thimble_ft (or _in, _m, "
            "_mm, _cm); missing: " + ", ".join(missing),
        )
    return found


def _reading(path: Path, row: int, name: str, text: str) -> float:
    if _NUMBER.fullmatch(text) is None:
        raise LogError(
            path, "a mark is not a number", row=row, channel=name, found=repr(cut(text, 60)),
            needed="a length read from the near thimble, such as 6.25",
        )  # fmt: skip
    return float(text)


def _check_hold(path: Path, row: int, hold: str) -> None:
    level = hold.removesuffix(" down")
    if hold == "slack" or level in _HOLDS[1:]:
        return
    if _NUMBER.fullmatch(level.rstrip("% ")) is None:
        raise LogError(
            path, "unknown name of a hold", row=row, channel="hold", found=repr(cut(hold, 60)),
            needed="slack, min, centre, max or a strain; on the way down, min down, 75 % down, ...",
        )  # fmt: skip


def _read_marks(path: Path, name: str = "") -> dict[str, SpliceMarks]:
    """Read a marks file; ``name`` is its name in the campaign."""
    header, filled = read_csv_rows(path, "the marks file")
    columns = _columns(path, header)
    where = {name: header.index(name) for name in ("test", "specimen", "hold")}
    far_thimble = header[columns["far_thimble"][0]].strip()
    rows: dict[str, _Rows] = {}
    for number, cells in filled:
        entry = rows.setdefault(cells[where["specimen"]].strip(), _Rows())
        hold = cells[where["hold"]].strip()
        _check_hold(path, number, hold)
        entry.test.append(cells[where["test"]].strip())
        entry.hold.append(hold)
        values = []
        for length in _LENGTHS:
            index, factor = columns[length]
            cell = cells[index].strip()
            values.append(factor * _reading(path, number, header[index], cell))
            entry.decimals.append(factor * 10.0 ** int(Decimal(cell).as_tuple().exponent))
        entry.lengths.append((values[0], values[1], values[2]))
        entry.place.append(MarkPlace(name or path.name, number, far_thimble))
    if not rows:
        raise LogError(path, "the marks file has no rows", needed="one row per reading")
    marks = {}
    for specimen, entry in rows.items():
        table = np.array(entry.lengths)
        marks[specimen] = SpliceMarks(
            specimen=specimen,
            test=tuple(entry.test),
            hold=tuple(entry.hold),
            near_toe=table[:, 0],
            far_toe=table[:, 1],
            far_thimble=table[:, 2],
            # spreadsheets drop trailing zeros, so the finest digit counts; sixteenths of an inch in
            # decimal feet have more digits than a tape resolves
            reading_uncertainty=max(
                min(entry.decimals) / math.sqrt(12) * math.sqrt(2), _FINEST_TAPE
            ),
            place=tuple(entry.place),
        )
    return marks


def _pooled_marks(
    path: Path, names: Iterable[str], specimens: Iterable[str]
) -> dict[str, SpliceMarks]:
    """Return the pooled marks of each specimen from all marks files of the campaign."""
    pooled: dict[str, SpliceMarks] = {}
    for name in dict.fromkeys(names):
        file = path.parent / _file_inside(path, name)
        for specimen, marks in _read_marks(file, name).items():
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
                place=before.place + marks.place,
            )
    return pooled


_LISTS = ("specimens", "target_strain")

_WHOLE = ("order", "n_cycles", "unlogged_cycles", "n_flex_cycles")

# as many digits as fit in a netCDF integer
_WHOLE_NUMBER = re.compile(r"[-+]?[0-9]{1,9}")

_STRAIN = ("method", "marks")

# tables of campaign.toml that do not fit in a cell
_TABLES = ("strain", "reduction", "steps")

_COLUMNS = ("id", *(name for name in TestSection.model_fields if name not in _TABLES), *_STRAIN)


def _in_table(
    path: Path, problem: str, *, row: int | None = None, channel: str = "", **kwargs: Any
) -> SettingsError:
    """An error in the table of tests, ``FILE:ROW [COLUMN]``."""
    place = ("" if row is None else f":{row}") + (f" [{channel}]" if channel else "")
    return SettingsError(f"{path}{place}: {problem}", **kwargs)


def _cells(path: Path, row: int, cells: dict[str, str]) -> dict[str, Any]:
    """The non-empty cells of one row, in the types that TOML would give."""
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
    if "id" not in header or len(set(header)) != len(header):
        raise _in_table(
            path, "the table of tests has no usable header", row=1, found=", ".join(header),
            needed="id and keys of [tests.ID], such as file, each once",
        )  # fmt: skip
    for name in header:
        if name not in _COLUMNS:
            raise _in_table(
                path, "a column is not a key of a test", row=1, channel=name,
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
            raise _in_table(
                path, "a test appears twice", row=number, channel="id", found=repr(name)
            )
        filled = _cells(path, number, cells)
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


def _merge_tests(
    path: Path, table: str, rows: dict[str, TestSection], sections: dict[str, TestSection]
) -> dict[str, TestSection]:
    """Tests of the table and of campaign.toml; a test may be in both, each of its keys in one."""
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
    "rate", "frequency", "mean_tension", "medium", "soak", "temperature", "machine", "load_cell",
    "calibration_due",
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
    """Name of a log in messages and products: a path inside the folder, or an address."""
    with at_place(f"{path}: "):
        is_remote = allowed(entry, allow_remote, what=f"the log of test '{test}'")
    return shown_address(entry) if is_remote else _file_inside(path, entry, is_needed=False)


def _plan_test(
    path: Path,
    name: str,
    test: TestSection,
    defaults: Defaults,
    file: CampaignFile,
    *,
    allow_remote: bool = False,
) -> TestPlan:
    """Return a test in SI with the defaults of its campaign; errors name file and key."""

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
    strain, kind = given("strain"), test.kind or defaults.kind
    cycles = CycleSettings(
        control=given("control"), waveform=given("waveform"), expected_cycles=test.n_cycles
    )
    settings = ReductionSettings(
        strain=StrainSettings(method=strain.method), cycles=cycles_of_kind(cycles, kind)
    )
    for table in (defaults.reduction, test.reduction):
        try:
            settings = apply_numbers(settings, table, control=given("control"))
        except SettingsError as error:
            raise in_toml(path, f"test '{name}': {error}") from error
    attributes = {key: given(key) for key in _KEPT if given(key)}
    attributes |= {
        key: str(getattr(test, key))
        for key in _KEPT_OF_TEST
        if getattr(test, key) not in (None, "")
    }
    return TestPlan(
        id=name,
        kind=kind,
        # a missing log is an error of its test only
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


_HAVE_CURVE = ("cyclic", "fatigue", "quasi-static", "tensile")


def _plan_comparison(
    path: Path,
    name: str,
    section: ComparisonSection,
    *,
    tests: Mapping[str, TestPlan],
    hoses: Collection[str],
    specimens: Mapping[str, Specimen],
) -> ComparisonPlan:
    """A comparison with all its names resolved."""
    place = f"comparison '{name}'"
    found = product_of(section.measured, tests)
    if found is None:
        raise in_toml(
            path, f"{place}: measured is not a test of the campaign",
            found=section.measured, needed="a test, or test/step: " + ", ".join(tests),
        )  # fmt: skip
    product, kind = found
    if kind not in _HAVE_CURVE:
        raise in_toml(
            path, f"{place}: '{section.measured}' has no curve of tension against strain",
            found=kind, needed="one of " + ", ".join(_HAVE_CURVE),
        )  # fmt: skip
    if section.predicted not in hoses:
        raise in_toml(
            path, f"{place}: predicted is not a hose of the campaign",
            found=section.predicted, needed="one of [hoses]: " + (", ".join(hoses) or "none"),
        )  # fmt: skip
    pulled = tests[section.measured.partition("/")[0]].specimens
    if section.specimen is None and len(pulled) > 1:
        raise in_toml(
            path, f"{place}: '{section.measured}' has several specimens",
            needed="specimen = one of " + ", ".join(pulled),
        )  # fmt: skip
    specimen = section.specimen or pulled[0]
    if specimen not in pulled:
        raise in_toml(
            path, f"{place}: '{section.measured}' has no such specimen", found=specimen,
            needed="one of " + ", ".join(pulled),
        )  # fmt: skip
    if specimens[specimen].kind != "stretch hose":
        raise in_toml(
            path, f"{place}: '{specimen}' is not a stretch hose", found=specimens[specimen].kind,
            needed='kind = "stretch hose"',
        )  # fmt: skip
    if len(set(section.calibrate)) < len(section.calibrate):
        raise in_toml(
            path, f"{place}: a number is to be calibrated twice",
            found=", ".join(section.calibrate),
        )  # fmt: skip
    return ComparisonPlan(
        name=name,
        measured=product,
        specimen=specimen,
        predicted=section.predicted,
        loading=section.loading,
        calibrate=section.calibrate,
    )


def _hint(path: Path) -> str | None:
    """Advice for a name that TOML does not allow twice."""
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
    """Name of the table of results; empty if the campaign has none."""
    names = {name for name in (file.results, file.campaign.results) if name}
    if len(names) > 1:
        raise in_toml(
            path, "results is stated both above [campaign] and in it",
            found=" and ".join(sorted(names)),
            needed="one table of results",
        )  # fmt: skip
    return _file_inside(path, names.pop()) if names else ""


def _addresses(path: Path, tests: Mapping[str, TestSection]) -> dict[str, str]:
    """Full addresses of remote logs, by their names in messages and products."""
    found: dict[str, str] = {}
    for test in tests.values():
        entries = [test.file] if isinstance(test.file, str) else [one.file for one in test.file]
        for entry in filter(is_address, entries):
            name = shown_address(entry)
            if found.setdefault(name, entry) != entry:
                raise in_toml(
                    path, "two addresses of logs differ only in parts that are not stored",
                    found=repr(name), needed="another path for each log",
                    hint="User, password and everything after ? or # are not stored.",
                )  # fmt: skip
    return found


def load_campaign(path: Path, *, allow_remote: bool = False, text: str | None = None) -> Campaign:
    """Read campaign.toml, its tables and its marks, and check their consistency.

    ``text``: contents to use for campaign.toml; those of the file if omitted.
    """
    if path.is_dir():
        path /= "campaign.toml"
    with noting_small_files() as digests:
        campaign = _load(path, allow_remote=allow_remote, text=text)
    folder = path.parent.resolve()
    named = {file.relative_to(folder).as_posix(): one for file, one in digests.items()}
    return replace(campaign, small_files=named)


def _load(path: Path, *, allow_remote: bool, text: str | None) -> Campaign:
    file = _parse(path, text)
    tests: dict[str, TestSection] = {}
    table = file.tests if isinstance(file.tests, str) else file.campaign.tests
    if table:
        tests |= read_test_table(path.parent / _file_inside(path, table))
    tests = _merge_tests(path, table, tests, {} if isinstance(file.tests, str) else file.tests)
    if not (tests or file.results or file.campaign.results or file.hoses):
        raise in_toml(
            path, "the campaign has no tests",
            needed="at least one [tests.NAME], or results, or [hoses.NAME]",
        )  # fmt: skip
    plans = {
        name: _plan_test(path, name, test, file.defaults, file, allow_remote=allow_remote)
        for name, test in tests.items()
    }
    _check_names(path, file.campaign.id, plans)
    for name, plan in plans.items():
        if plan.part_of is not None and plan.part_of not in plans:
            raise in_toml(
                path, f"test '{name}' is part of a test that the campaign lacks",
                found=repr(plan.part_of), needed="one of " + ", ".join(plans),
            )  # fmt: skip
    marks_files = [
        section.strain.marks for section in (file.defaults, *tests.values()) if section.strain.marks
    ]
    marks = _pooled_marks(path, marks_files, tuple(file.specimens))
    if file.uncertainty.tape is not None:
        marks = {
            name: replace(one, reading_uncertainty=file.uncertainty.tape, is_reading_stated=True)
            for name, one in marks.items()
        }
    if file.uncertainty.splice_creep is not None:
        marks = {
            name: replace(one, splice_creep=file.uncertainty.splice_creep, is_creep_stated=True)
            for name, one in marks.items()
        }
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
    specimens = {
        name: _specimen_of(path, name, section) for name, section in file.specimens.items()
    }
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
        name: _plan_comparison(path, name, section, tests=plans, hoses=hoses, specimens=specimens)
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
        limits=Limits(**file.limits.model_dump(exclude_none=True)),
        addresses=_addresses(path, tests),
    )


_UNUSUAL = re.compile(r"[^\w.\-]")


@contextmanager
def staged_campaign(
    path: Path, *, allow_remote: bool = False, progress: Callable[[str, str], None] | None = None
) -> Iterator[Campaign]:
    """Load a campaign and fetch its remote logs.

    Yields
    ------
    campaign : Campaign
        As from `load_campaign`. A log that cannot be fetched is an error of its test. Copies are
        deleted at the end of the block.
    """
    campaign = load_campaign(path, allow_remote=allow_remote)
    if not campaign.addresses:
        yield campaign
        return
    names: dict[str, str] = {}
    copies: dict[str, Path] = {}
    unread: dict[str, LogError] = {}
    with scratch_folder() as scratch, renamed(names):
        # one after another: not every package is thread-safe, and an interruption takes effect at
        # once
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
    """Id of the campaign whose archives are in a folder."""
    archives = archives_of_tests(processed) if processed.is_dir() else []
    if archives:
        with reading(archives[0]) as archive:
            return str(archive.attrs.get("campaign", ""))
    folders = sorted(processed.iterdir()) if processed.is_dir() else []
    inside = [one.name for one in folders if archives_of_tests(one)]
    if inside:
        raise SettingsError(
            f"{processed} contains one folder per campaign", found=", ".join(inside),
            needed=f"one of them, such as {processed / inside[0]}",
        )  # fmt: skip
    raise ArchiveError(
        f"there is no archive of a test in {processed}",
        needed="the folder of a campaign, such as processed/CAMPAIGN",
        hint="Run the campaign first.",
    )


def find_campaign(processed: Path, stated: Path | None = None, *, name: str = "") -> Path:
    """Find the campaign.toml from which a folder of archives was made.

    It is searched for where the last run had it, and in the usual places: ``raw/ID/campaign.toml``
    and ``ID/campaign.toml``, beside ``processed`` and in the working folder.

    ``name``: id of the campaign; that of the first archive if omitted.
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
    recorded = campaign_of(processed)
    places = [
        *([recorded] if recorded is not None else []),
        *(
            root / folder / name / "campaign.toml"
            for root in (above, Path.cwd())
            for folder in ("raw", "")
        ),
    ]
    for path in dict.fromkeys(places):
        if _id_of(path) == name:
            return path
    raise SettingsError(
        f"the campaign.toml of '{name}' was not found",
        found="none at " + " or ".join(str(path) for path in dict.fromkeys(places)),
        needed="--campaign CAMPAIGN.toml",
        hint="It was moved since the run; archives store no path.",
    )


def _id_of(path: Path) -> str | None:
    """Id stated in a campaign.toml; None for any other file."""
    try:
        document = tomllib.loads(read_small_text(path))
        return str(document["campaign"]["id"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
