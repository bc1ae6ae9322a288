"""Formats of export, and the files that each one writes.

An export as files: the one that was asked for, and what belongs beside it.

How close a written curve is to the one that was given, for the screen.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import get_args

from reduction.archive.write import write_text_atomically
from reduction.lines.deck_moordyn import (
    MOST_POINTS,
    MoorDynForm,
    MoorPyForm,
    moordyn_files,
    moorpy_files,
    openfast_files,
)
from reduction.lines.deck_other_codes import (
    ABAQUS_POINTS,
    CABLE_POINTS,
    ORCAFLEX_POINTS,
    WhoiCableForm,
    abaqus_text,
    fit_smooth_curve,
    orcaflex_text,
    whoicable_text,
)
from reduction.lines.export_line import ExportLine, local_words, thin_curve
from reduction.lines.export_tables import ValueTable, curve_table, table_text_of, write_netcdf
from reduction.quantities.digits import plain_number
from reduction.quantities.units import UnitSystem
from reduction.record.errors import SettingsError

_TABLES = ("csv", "json", "latex", "markdown", "netcdf")

FORMS: dict[str, tuple[str, ...]] = {
    "moordyn": get_args(MoorDynForm),
    "openfast": get_args(MoorDynForm),
    "moorpy": get_args(MoorPyForm),
    "whoi-cable": get_args(WhoiCableForm),
    "orcaflex": (),
    "abaqus": (),
}
"""What a format can be told, the first where nothing is said."""

_WITH_OTHERS: dict[str, Callable[..., dict[str, str]]] = {
    "moordyn": moordyn_files,
    "openfast": openfast_files,
    "moorpy": moorpy_files,
}

_ALONE: dict[str, Callable[..., str]] = {
    "whoi-cable": whoicable_text,
    "orcaflex": orcaflex_text,
    "abaqus": abaqus_text,
}

_TAILS = ("_table", "_owc", "_syrope", "_moorpy")

_DIGITS = 8

FORMATS = (*_TABLES, *FORMS)


def export_line(
    line: ExportLine, to: str, path: Path, *, form: str | None = None, units: UnitSystem = "si"
) -> list[Path]:
    """Write a line in a format."""
    if to in _TABLES:
        _refuse_form(to, form, ())
        return export_table(curve_table(line), to, path, units=units)
    if to not in FORMS:
        raise SettingsError("the format is not known", found=repr(to), needed=", ".join(FORMATS))
    _refuse_form(to, form, FORMS[to])
    said = {} if form is None else {"form": form}
    if to in _ALONE:
        files = {"": _ALONE[to](line, **said)}
    else:
        files = _WITH_OTHERS[to](line, _stem_beside(path), **said)
    beside = {path.with_name(name): text for name, text in files.items() if name}
    # what is named is there before what names it
    for place, text in {**beside, path: files[""]}.items():
        write_text_atomically(place, text)
    return [*beside, path]


def export_table(table: ValueTable, to: str, path: Path, *, units: UnitSystem = "si") -> list[Path]:
    """Write a table of values as csv, json, latex, markdown or netcdf.

    Parameters
    ----------
    table : ValueTable
        What is written.
    to : str
        The format.
    path : pathlib.Path
        The file.
    units : {"si", "us"}
        netCDF is SI in any case.

    Returns
    -------
    paths : list of pathlib.Path
        The file.

    Raises
    ------
    SettingsError
        If the format is not one of them.
    ArchiveError
        If the disk refuses.
    """
    if to == "netcdf":
        write_netcdf(table, path)
    else:
        write_text_atomically(path, table_text_of(table, to, units=units))
    return [path]


def _stem_beside(path: Path) -> str:
    """How the names of the files beside one begin, other for every other file of a folder.

    A name in a deck ends at a blank or at a sign of its grammar; where one is left out, or the file
    does not end in ``.dat``, the name of the file is told apart by a digest of it.
    """
    stem = re.sub(r"[^A-Za-z0-9_]+", "_", path.stem).strip("_") or "line"
    # `leg_table.dat` beside `leg.dat` would else find its own name taken
    if path.name == f"{stem}.dat" and not stem.endswith(_TAILS):
        return stem
    return f"{stem}_{sha256(path.name.encode()).hexdigest()[:_DIGITS]}"


def _refuse_form(to: str, form: str | None, forms: tuple[str, ...]) -> None:
    if form is not None and form not in forms:
        raise SettingsError(
            f"{to} has no form '{form}'",
            found=form,
            needed="one of " + ", ".join(forms) if forms else f"no --form with {to}",
        )


_CLOSE = 0.05

_POINTS = {
    "moordyn": MOST_POINTS,
    "openfast": MOST_POINTS,
    "moorpy": MOST_POINTS,
    "whoi-cable": CABLE_POINTS,
    "orcaflex": ORCAFLEX_POINTS,
    "abaqus": ABAQUS_POINTS,
}


def closeness_of(line: ExportLine, to: str, form: str | None) -> tuple[str, ...]:
    """What is said of the errors of a curve in a format."""
    if to not in _POINTS or form in ("static-dynamic", "load-dependent", "syrope", "library"):
        return ()
    is_table = to != "whoi-cable" or form == "table"
    found = (
        thin_curve(line.strain, line.tension, most=_POINTS[to])
        if is_table
        else fit_smooth_curve(line.strain, line.tension)
    )
    doubt = "DOUBTFUL: " if found.local > _CLOSE else ""
    return (
        f"{doubt}the written curve is off by up to {plain_number(found.error, 3)} N, "
        f"{found.share:.2e} of the "
        f"greatest tension; {local_words(found)}",
    )
