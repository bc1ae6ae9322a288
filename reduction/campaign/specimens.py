"""Specimens and their tape readings: [specimens] and marks.csv."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from reduction.campaign.model import SpecimenSection
from reduction.campaign.toml_file import file_inside, in_toml, quantity_of, read_csv_rows
from reduction.quantities.units import scale_to_si
from reduction.record.errors import LogError
from reduction.record.measurement import Specimen, SpliceMarks
from reduction.record.plain_text import cut


def _length(text: str, where: str, path: Path) -> float:
    value = quantity_of(path, where, text, "length")
    if not value > 0:
        raise in_toml(path, f"{where} is not positive", found=text, needed="above zero")
    return value


def _linear_densities(
    path: Path, name: str, section: SpecimenSection
) -> tuple[float | None, float | None]:
    """Mass a length in air and in water; in water it is less, and of what floats below zero."""
    dry, wet = (
        None if text is None else quantity_of(path, where, text, "linear_density")
        for where, text in (
            (f"specimens.{name}.linear_density", section.linear_density),
            (f"specimens.{name}.wet_linear_density", section.wet_linear_density),
        )
    )
    if dry is not None and not dry > 0:
        raise in_toml(
            path, f"specimens.{name}.linear_density is not positive", found=section.linear_density,
            needed="above zero",
        )  # fmt: skip
    if dry is not None and wet is not None and not wet < dry:
        raise in_toml(
            path, f"specimens.{name}.wet_linear_density is not below linear_density",
            found=f"{section.wet_linear_density}, {section.linear_density}",
            needed="the mass in air less that of the displaced water",
        )  # fmt: skip
    return dry, wet


def specimen_of(path: Path, name: str, section: SpecimenSection) -> Specimen:
    """The specimen before its first test; an error names campaign.toml and the key."""
    readings = (section.diameter,) if isinstance(section.diameter, str) else section.diameter
    where = f"specimens.{name}.diameter"
    stretched = tuple(
        (
            quantity_of(path, f"specimens.{name}.stretched_diameter", stretch, "strain"),
            _length(reading, f"specimens.{name}.stretched_diameter", path),
        )
        for stretch, at_stretch in section.stretched_diameter.items()
        for reading in at_stretch
    )
    strength = section.rated_break_strength
    dry, wet = _linear_densities(path, name, section)
    gauge, spread = section.gauge_length, section.gauge_length_standard_uncertainty
    if gauge is None and spread is not None:
        raise in_toml(
            path, f"specimens.{name}.gauge_length_standard_uncertainty stands alone",
            found=spread, needed="gauge_length beside it",
        )  # fmt: skip
    return Specimen(
        name=name,
        kind=section.kind,
        material=section.material,
        construction=section.construction,
        condition=section.condition,
        diameter=tuple(_length(reading, where, path) for reading in readings),
        stretched_diameters=stretched,
        rated_break_strength=None
        if strength is None
        else quantity_of(path, f"specimens.{name}.rated_break_strength", strength, "force"),
        rated_break_strength_source=section.rated_break_strength_source,
        linear_density=dry,
        wet_linear_density=wet,
        gauge_length=None
        if gauge is None
        else _length(gauge, f"specimens.{name}.gauge_length", path),
        gauge_length_standard_uncertainty=None
        if spread is None
        else _length(spread, f"specimens.{name}.gauge_length_standard_uncertainty", path),
        earlier_cycles=section.earlier_cycles,
        earlier_flex_cycles=section.earlier_flex_cycles,
        notes=(section.note,) if section.note else (),
    )


_LENGTHS = ("near_toe", "far_toe", "far_thimble")

_SUFFIXES = {"ft": "ft", "in": "inch", "m": "m", "mm": "mm", "cm": "cm"}

# as a person reads a tape: the digits behind the point say how finely
_NUMBER = re.compile(r"[-+]?([0-9]{1,9}(\.[0-9]{0,9})?|\.[0-9]{1,9})")

_HOLDS = ("slack", "min", "centre", "max")


@dataclass
class _Rows:
    test: list[str] = field(default_factory=list)
    hold: list[str] = field(default_factory=list)
    lengths: list[tuple[float, float, float]] = field(default_factory=list)
    decimals: list[float] = field(default_factory=list)


def _columns(path: Path, header: list[str]) -> dict[str, tuple[int, float]]:
    """Column index and factor to metre of each length."""
    found: dict[str, tuple[int, float]] = {}
    for index, name in enumerate(header):
        stem, _, suffix = name.strip().rpartition("_")
        if stem in _LENGTHS and suffix in _SUFFIXES:
            if stem in found:
                raise LogError(path, f"two columns hold {stem}", row=1, channel=name)
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
    if hold in _HOLDS:
        return
    if _NUMBER.fullmatch(hold.rstrip("% ")) is None:
        raise LogError(
            path, "a hold has no known name", row=row, channel="hold", found=repr(cut(hold, 60)),
            needed="slack, min, centre, max or a strain",
        )  # fmt: skip


def _read_marks(path: Path) -> dict[str, SpliceMarks]:
    """Read a marks file."""
    header, filled = read_csv_rows(path, "the marks file")
    columns = _columns(path, header)
    where = {name: header.index(name) for name in ("test", "specimen", "hold")}
    rows: dict[str, _Rows] = {}
    for number, cells in filled:
        entry = rows.setdefault(cells[where["specimen"]].strip(), _Rows())
        hold = cells[where["hold"]].strip()
        _check_hold(path, number, hold)
        entry.test.append(cells[where["test"]].strip())
        entry.hold.append(hold)
        values = []
        for name in _LENGTHS:
            index, factor = columns[name]
            cell = cells[index].strip()
            values.append(factor * _reading(path, number, header[index], cell))
            decimals = len(cell.partition(".")[2])
            entry.decimals.append(factor * 10.0**-decimals)
        entry.lengths.append((values[0], values[1], values[2]))
    if not rows:
        raise LogError(path, "the marks file has no rows", needed="one row a reading")
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
            # trailing zeros are dropped by spreadsheets, so the finest digit counts
            reading_uncertainty=min(entry.decimals) / math.sqrt(12) * math.sqrt(2),
        )
    return marks


def pooled_marks(
    path: Path, names: Iterable[str], specimens: Iterable[str]
) -> dict[str, SpliceMarks]:
    """Return all marks of each specimen over the campaign, from every marks file it names."""
    pooled: dict[str, SpliceMarks] = {}
    for name in dict.fromkeys(names):
        for specimen, marks in _read_marks(path.parent / file_inside(path, name)).items():
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
