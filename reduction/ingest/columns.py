"""What every reader checks of declared columns: found once, right unit, numbers, one length.

`reduction.ingest.table` puts these together for the binary formats; readers of cells
and text use them one by one.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tokenize import TokenError
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.errors import LogError, SettingsError
from reduction.ingest.layout import CLOCK, Layout
from reduction.record import Floats
from reduction.units import Dimension, scale_to_si

_BRACKETS = {"(": ")", "[": "]", "{": "}", "<": ">"}
_SHOWN = 40
_LONGEST_SHOWN = 200
_LONGEST_UNIT = 30
_POWER = re.compile(r"\*\*|\^")  # one at most: 9**9**9 would take for ever


@dataclass(frozen=True)
class Wanted:
    """One column that a layout asks for; ``key`` is its name in `RawLog.columns`."""

    key: str
    column: str | int
    unit: str
    dimension: Dimension
    is_compared: bool = True
    """Whether a unit that the file states must agree: not for a clock, nor for a voltage."""


def wanted_columns(layout: Layout) -> tuple[Wanted, ...]:
    """Columns of a layout in its order; own time stamps follow their channel."""
    wanted = []
    for key, channel in layout.channels.items():
        is_compared = channel.unit != CLOCK and channel.factor == 1
        dimension = Layout.dimension(key)
        wanted.append(Wanted(key, channel.column, channel.unit, dimension, is_compared))
        if channel.time_column is not None:
            wanted.append(Wanted(f"{key}.time", channel.time_column, channel.time_unit, "time"))
    return tuple(wanted)


def _listing(names: Sequence[str]) -> str:
    if not names:
        return "no columns"
    if not any(names):
        return f"columns without names, numbers 1 to {len(names)}"
    shown = ", ".join(repr(name[:_LONGEST_SHOWN]) for name in names[:_SHOWN])
    return shown if len(names) <= _SHOWN else f"{shown} and {len(names) - _SHOWN} more"


def find_column(
    path: Path,
    wanted: Wanted,
    names: Sequence[str],
    *,
    where: str = "the file",
    in_order: bool = True,
    row: int | None = None,
) -> int:
    """Place from 0 of a declared column among the names of a file.

    Names count without the blanks around them.

    Raises
    ------
    LogError
        If the column is not there (with what is there), or is there twice.
    """
    stripped = [name.strip() for name in names]
    if isinstance(wanted.column, int):
        if in_order and 1 <= wanted.column <= len(names):
            return wanted.column - 1
        needed = f"a number from 1 to {len(names)}" if in_order else "a name"
        raise LogError(
            path,
            f"column {wanted.column} is not in {where}",
            row=row,
            channel=wanted.key,
            found=_listing(stripped),
            needed=needed,
        )
    places = [place for place, name in enumerate(stripped) if name == wanted.column.strip()]
    if len(places) == 1:
        return places[0]
    if places:
        raise LogError(
            path,
            f"column '{wanted.column}' is {len(places)} times in {where}",
            row=row,
            channel=wanted.key,
            found="numbers " + ", ".join(str(place + 1) for place in places),
            needed="one column of that name",
            hint="Give the column by its number." if in_order else None,
        )
    raise LogError(
        path,
        f"column '{wanted.column}' is not in {where}",
        row=row,
        channel=wanted.key,
        found=_listing(stripped),
        needed=f"'{wanted.column}'",
    )


def stated_scale(text: str, dimension: Dimension) -> tuple[float, float]:
    """Factor and offset to SI of a unit that a file states, which may be any text at all.

    Raises
    ------
    SettingsError
        If it is no unit of that dimension.
    """
    try:
        if len(text) <= _LONGEST_UNIT and len(_POWER.findall(text)) < 2:
            return scale_to_si(text, dimension)
    except (AssertionError, TokenError, ArithmeticError):  # pint's answers to "kN/" and "m/0"
        pass
    raise SettingsError(
        f"unit '{text[:_LONGEST_UNIT]}' is not known", needed=f"a unit of {dimension}"
    )


def check_unit(path: Path, wanted: Wanted, found: str, *, row: int | None = None) -> None:
    """Compare the unit that a file states with the declared one; blank states nothing.

    Two spellings of one unit agree: ``(sec)`` and ``s``, ``lb`` and ``lbf`` of a force.

    Raises
    ------
    LogError
        If they differ, or the file's unit is not known.
    """
    text = found.strip()
    if text[:1] in _BRACKETS and text.endswith(_BRACKETS[text[0]]):
        text = text[1:-1].strip()
    if text in ("", "-", wanted.unit.strip()) or not wanted.is_compared:
        return
    try:
        stated = stated_scale(text, wanted.dimension)
    except SettingsError as error:
        problem = error.problem
    else:
        declared = scale_to_si(wanted.unit, wanted.dimension)
        if all(math.isclose(a, b, rel_tol=1e-9) for a, b in zip(stated, declared, strict=True)):
            return
        problem = "the unit in the file is not the declared one"
    raise LogError(
        path,
        problem,
        row=row,
        channel=str(wanted.column),
        found=f"'{found.strip()}'",
        needed=f"'{wanted.unit}', as the layout declares",
    )


def check_lengths(path: Path, columns: dict[str, Floats]) -> int:
    """Number of rows that the columns share; a channel with own time stamps has its own.

    Raises
    ------
    LogError
        If columns differ in length, or there are no rows.
    """
    pairs = [(key, f"{key}.time") for key in columns if f"{key}.time" in columns]
    shared = [key for key in columns if not any(key in pair for pair in pairs)]
    for group in (shared, *pairs):
        if len({columns[key].size for key in group}) > 1:
            raise LogError(
                path,
                "the columns have two time bases",
                found=", ".join(f"{key} {columns[key].size} values" for key in group),
                needed="columns of one length",
                hint="Give a channel with its own time stamps a time_column.",
            )
    if not columns:
        raise LogError(path, "the layout declares no channels", needed="at least one channel")
    n_rows = columns[shared[0]].size if shared else max(columns[key].size for key in columns)
    if n_rows == 0:
        raise LogError(path, "there are no data rows", found="0 rows", needed="at least one")
    return n_rows


def without_marks(values: NDArray[Any], layout: Layout) -> Floats:
    """As float64, with NaN where a missing mark that is a number stands (-9999), shape as given.

    Marks are compared in the column's own precision: -99.9 of a float32 column is found.
    """
    marks = []
    for mark in layout.missing:
        try:
            value = float(mark.replace(layout.decimal, "."))
        except ValueError:
            continue
        if math.isfinite(value):
            marks.append(value)
    array = values.astype(np.float64, copy=bool(marks))
    for value in marks:
        array[values == value] = np.nan
    return array
