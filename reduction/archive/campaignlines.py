"""Lines of an archive, and of the folder of a processed campaign, as sources of design values."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import xarray as xr

from reduction.archive.linecurves import CURVES
from reduction.archive.linesource import (
    Facts,
    facts_of_specimens,
    line_source_of_experiment,
    line_source_of_test,
    specimens_of,
)
from reduction.archive.open import Opener, reading
from reduction.archive.products import archives_of_tests
from reduction.lookup.product import LineSource

_SURFACES = "surfaces.nc"


def archives_of_lines(folder: Path) -> list[Path]:
    """Archives of a campaign's folder that may have something to look up, surfaces last."""
    surfaces = folder / _SURFACES
    return [*archives_of_tests(folder), *([surfaces] if surfaces.is_file() else [])]


def lines_of_archive(path: Path) -> list[LineSource]:
    """Every line of one archive that has something to look up.

    Parameters
    ----------
    path : pathlib.Path
        Of a reduced test, or of experiments.

    Returns
    -------
    lines : list of LineSource
        None where there is no surface and no curve.

    Raises
    ------
    ArchiveError
        If the archive cannot be read.
    """
    with reading(path) as archive:
        return lines_of_open_archive(archive, path)


def lines_of_open_archive(
    archive: xr.Dataset, path: Path, opener: Opener = reading
) -> list[LineSource]:
    """Every line of one archive that is open, as `lines_of_archive`.

    Parameters
    ----------
    archive : xarray.Dataset
        As `reduction.archive.open.open_archive` gives it.
    path : pathlib.Path
        Where it is: of an experiment the tests beside it say what its specimens are.
    opener : Opener
        How archives are opened.

    Returns
    -------
    lines : list of LineSource
        None where there is no surface and no curve.

    Raises
    ------
    ArchiveError
        If an archive beside it cannot be read.
    """
    if "experiment" in archive.sizes:
        names = archive.variables["experiment"].values.astype(str).tolist()
        kinds = archive.variables["experiment_kind"].values.astype(str).tolist()
        wanted = {one for name in names for one in specimens_of(archive, name)}
        known = _specimens(path, wanted, opener)
        return [
            line_source_of_experiment(archive, name, specimens=known)
            for name, kind in zip(names, kinds, strict=True)
            if kind == "box-behnken"
        ]
    if not any(name in archive for name in CURVES):
        return []
    names = archive.variables["specimen"].values.astype(str).tolist()
    return [line_source_of_test(archive, name) for name in names]


def told_apart(found: Sequence[tuple[str, Sequence[LineSource]]]) -> list[LineSource]:
    """Lines of a campaign by their files; a specimen that is in several is called TEST SPECIMEN.

    Parameters
    ----------
    found : sequence of (str, sequence of LineSource)
        Name of the test, and the lines of its archive.

    Returns
    -------
    lines : list of LineSource
        In that order.

    Examples
    --------
    >>> line = LineSource("new", "", "rubber", "", "", 0.025, 3e3)
    >>> [one.name for one in told_apart([("T-1", [line]), ("T-2", [line])])]
    ['T-1 new', 'T-2 new']
    """
    lines = [line for _, own in found for line in own]
    names = names_apart([(test, line.name) for test, own in found for line in own])
    return [replace(line, name=name) for line, name in zip(lines, names, strict=True)]


def names_apart(named: Sequence[tuple[str, str]]) -> list[str]:
    """Names of lines by their tests and specimens, as `told_apart` gives them."""
    count = Counter(name for _, name in named)
    return [f"{test} {name}" if count[name] > 1 else name for test, name in named]


def _specimens(path: Path, names: set[str], opener: Opener) -> dict[str, Facts]:
    """What the archives of tests beside an archive of experiments state of its specimens."""
    known: dict[str, Facts] = {}
    for one in archives_of_tests(path.parent):
        if names <= known.keys():
            break
        with opener(one) as archive:
            known |= facts_of_specimens(archive)
    return known
