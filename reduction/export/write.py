"""An export as files: the one that was asked for, and what belongs beside it."""

from __future__ import annotations

import re
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import get_args

from reduction.archive.write import write_whole
from reduction.errors import SettingsError
from reduction.export.abaqus import abaqus_text
from reduction.export.moordyn import MoorDynForm, moordyn_files
from reduction.export.moorpy import MoorPyForm, moorpy_files
from reduction.export.netcdftable import write_netcdf
from reduction.export.openfast import openfast_files
from reduction.export.orcaflex import orcaflex_text
from reduction.export.product import ExportLine
from reduction.export.table import ValueTable, curve_table, table_text_of
from reduction.export.whoicable import WhoiCableForm, whoicable_text
from reduction.units import UnitSystem

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
    """Write a line in a format.

    Parameters
    ----------
    line : ExportLine
        What is exported.
    to : str
        One of `FORMATS`.
    path : pathlib.Path
        The file. What it names stands beside it, its name begins with that of the file.
    form : str, optional
        One of `FORMS` of the format; the first of them where it is not given.
    units : {"si", "us"}
        Of csv, json, latex and markdown; the others are SI.

    Returns
    -------
    paths : list of pathlib.Path
        What was written, ``path`` last.

    Raises
    ------
    SettingsError
        If the format or the form is not known, or the line has not what the format needs.
    DataError
        If the curve cannot be exported.
    ArchiveError
        If the disk refuses.
    """
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
        write_whole(place, text)
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
        write_whole(path, table_text_of(table, to, units=units))
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
