"""Lines that are not data: kept as metadata; units in them checked against the layout."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path

from reduction.errors import LogError, SettingsError
from reduction.ingest.columns import Wanted, check_unit
from reduction.ingest.layout import Layout
from reduction.ingest.textrows import split_line
from reduction.units import scale_to_si
from reduction.visible import cut

_LONGEST_NAME = 200  # characters at the end of a name in which a unit may stand
_UNIT_IN_NAME = re.compile(r".*[\(\[]\s*([^()\[\]]*[^()\[\]\d\s][^()\[\]]*)[\)\]]\s*$")


def keep_line(metadata: dict[str, str], line: str, row: int, layout: Layout) -> None:
    """Keep a line as metadata: ``name: value`` or two fields by name, all else by row."""
    text = line.removeprefix(layout.comment).strip() if layout.comment else line.strip()
    fields = [field for field in split_line(text, layout) if field]
    if not fields:
        return
    key, value = fields[0].rstrip(": "), " ".join(fields[1:])
    if not value and ": " in text:
        key, value = (part.strip() for part in text.split(": ", 1))
    if not key or not value or line.startswith(layout.comment or "\n"):
        key, value = f"row {row}", text
    if key in metadata:
        key = f"{key} (row {row})"
    metadata[cut(key)] = cut(value)


def check_units(
    path: Path,
    wanted: Sequence[tuple[Wanted, int]],
    *,
    names: Sequence[str],
    units: Sequence[str],
    unit_row: int | None,
) -> None:
    """Compare the units that the file states with the declared ones.

    A unit row must agree.  A unit in brackets at the end of a column's name must
    agree where it is a unit of the channel's dimension; other words in brackets are
    part of the name.  Not compared are a channel with a factor, of which the file has
    the volts, and a counter, whose unit may be any word.

    Raises
    ------
    LogError
        If the file contradicts the layout.
    """
    for want, place in wanted:
        if not want.is_compared or want.dimension == "number":
            continue
        if unit_row is not None:
            check_unit(path, want, units[place] if place < len(units) else "", row=unit_row)
        elif isinstance(want.column, str) and (
            match := _UNIT_IN_NAME.match(names[place][-_LONGEST_NAME:])
        ):
            _check_unit_in_name(path, want, match[1])


def _check_unit_in_name(path: Path, want: Wanted, stated: str) -> None:
    try:
        found = scale_to_si(stated.strip(), want.dimension)
    except SettingsError:
        return
    declared = scale_to_si(want.unit, want.dimension)
    if not all(math.isclose(a, b, rel_tol=1e-9) for a, b in zip(found, declared, strict=True)):
        raise LogError(
            path,
            "the unit in the column's name is not the declared one",
            channel=str(want.column),
            found=f"'{stated}'",
            needed=f"'{want.unit}', as the layout declares",
            hint="Declare the unit of the file, or give the column by its number.",
        )
