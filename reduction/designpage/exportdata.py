"""What a MoorDyn line type is made of, as far as it does not depend on what a user states."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import asdict
from typing import Any, cast, get_args

import xarray as xr

from reduction import __version__
from reduction.designpage.linedata import numbers
from reduction.errors import ReductionError
from reduction.export.fromarchive import CurveName, line_from_open_archive
from reduction.export.fromlookup import line_from_lookup
from reduction.export.moordyn import NUMERICAL_DAMPING
from reduction.export.product import CYLINDER, FIBRE_DENSITY, SEA_WATER, ExportLine
from reduction.export.start import siblings_of
from reduction.lookup.product import LineSource

__all__ = ["EXPORT_CONSTANTS", "curves_of_archive", "curves_of_published", "refusal_of_surfaces"]

EXPORT_CONSTANTS: dict[str, Any] = {
    "version": __version__,
    "water": SEA_WATER,
    "fibres": FIBRE_DENSITY,
    "hydrodynamics": asdict(CYLINDER),
    "numerical_damping": NUMERICAL_DAMPING,
}
_OF_TEST = get_args(CurveName)


def curves_of_published(line: LineSource, others: tuple[LineSource, ...]) -> dict[str, Any]:
    """The one curve of a published line, or why there is none, by the option ``--curve``.

    Parameters
    ----------
    line : LineSource
        One of `reduction.published.linesource.published_sources`.
    others : tuple of LineSource
        All of them.

    Returns
    -------
    curves : dict of str to dict
        With the empty name; ``refused`` where it cannot be exported.
    """
    siblings = siblings_of(line, others)

    def made() -> dict[str, Any]:
        found = line_from_lookup(line, siblings=siblings)
        # with a strength that is stated the note on that of the source is left out
        bare = line_from_lookup(line, siblings=siblings, rated_break_strength=1.0)
        return _curve(found) | {
            "notes": [note for note in found.notes if note in bare.notes],
            "last_notes": [note for note in found.notes if note not in bare.notes],
        }

    return {"": _or_refused(made)}


def curves_of_archive(archive: xr.Dataset, stem: str, specimen: str) -> dict[str, Any]:
    """Curves of a specimen of a reduced test, or why there are none, by the option ``--curve``.

    Parameters
    ----------
    archive : xarray.Dataset
        Of the test.
    stem : str
        Of the name of its file.
    specimen : str
        One of its specimens.

    Returns
    -------
    curves : dict of str to dict
        ``mean``, ``ascending`` and ``descending``.
    """

    def of(curve: CurveName) -> dict[str, Any]:
        def made() -> dict[str, Any]:
            return _curve(line_from_open_archive(archive, stem, curve=curve, specimen=specimen))

        return _or_refused(made)

    return {name: of(cast("CurveName", name)) for name in _OF_TEST}


def refusal_of_surfaces(line: LineSource) -> dict[str, Any]:
    """Why a line that has surfaces alone is no line type."""
    return {"": _or_refused(lambda: _curve(line_from_lookup(line)))}


def _or_refused(made: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    try:
        return made()
    except ReductionError as error:
        return {"refused": str(error)}


def _curve(line: ExportLine) -> dict[str, Any]:
    stem = re.sub(r"[^A-Za-z0-9_]+", "_", line.identifier).strip("_")
    return {
        "name": line.name,
        "identifier": line.identifier,
        # an end that no name of a file beside it has
        "file": f"{stem}_line",
        "curve": line.curve,
        "tested": numbers(line.tested),
        "strain": numbers(line.strain),
        "tension": numbers(line.tension),
        "diameter": numbers(line.diameter),
        "linear_density": numbers(line.linear_density),
        "wet_linear_density": numbers(line.wet_linear_density),
        "material": line.material,
        "sources": list(line.sources),
        "notes": list(line.notes),
        "last_notes": [],
        "synthetic": line.is_synthetic,
    }
