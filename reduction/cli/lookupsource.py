"""What the text SOURCE of a look-up names: a published line, an archive, a campaign's folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from reduction.archive.linecurves import CURVES
from reduction.archive.linesource import (
    Facts,
    facts_of_specimens,
    line_of_experiment,
    line_of_test,
    specimens_of,
)
from reduction.archive.open import open_archive
from reduction.archive.products import archives_of_tests
from reduction.errors import ArchiveError, SettingsError
from reduction.lookup.product import LineSource
from reduction.published.linesource import published_sources

__all__ = ["lines_of", "lines_of_archive", "one_of"]


def lines_of(source: str) -> list[LineSource]:
    """Every line that SOURCE names.

    Parameters
    ----------
    source : str
        Name of a published line, or all of ``published``; path of an archive; folder of a
        processed campaign.

    Returns
    -------
    lines : list of LineSource
        One or more.

    Raises
    ------
    SettingsError
        If nothing has that name.
    ArchiveError
        If an archive cannot be read, or has nothing to look up.
    """
    published = published_sources()
    if source == "published":
        return list(published.values())
    if source in published:
        return [published[source]]
    path = Path(source)
    if path.is_file():
        lines = lines_of_archive(path)
        if not lines:
            raise ArchiveError(
                "the archive has nothing that can be looked up", found=str(path),
                needed="moduli of a cyclic test, a slow pull, or surfaces of an experiment",
            )  # fmt: skip
        return lines
    if path.is_dir():
        paths = archives_of_tests(path)
        paths += [path / "surfaces.nc"] if (path / "surfaces.nc").is_file() else []
        lines = [line for one in paths for line in lines_of_archive(one)]
        if lines:
            return lines
    words = source.lower().replace("-", " ").split()
    near = [name for name in published if all(word in name for word in words)]
    raise SettingsError(
        f"no line is called '{source}'",
        needed="an archive, a folder of a processed campaign, or one of "
        + ", ".join(near or published),
        hint="`reduction lookup published --list` says what there is.",
    )


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
    """
    with open_archive(path) as archive:
        if "experiment" in archive.sizes:
            names = archive["experiment"].values.astype(str).tolist()
            kinds = archive["experiment_kind"].values.astype(str).tolist()
            known = _specimens(path, {one for name in names for one in specimens_of(archive, name)})
            return [
                line_of_experiment(archive, name, specimens=known)
                for name, kind in zip(names, kinds, strict=True)
                if kind == "box-behnken"
            ]
        if not any(name in archive for name in CURVES):
            return []
        names = archive["specimen"].values.astype(str).tolist()
        return [line_of_test(archive, name) for name in names]


def one_of(lines: Sequence[LineSource], quantity: str, name: str | None) -> LineSource:
    """The line that was meant: by its name, else the only one that has the quantity.

    Parameters
    ----------
    lines : sequence of LineSource
        What SOURCE names.
    quantity : str
        That is wanted.
    name : str or None
        Of the line, where it was said.

    Returns
    -------
    line : LineSource
        One that is alone may not have the quantity; the look-up says why.

    Raises
    ------
    SettingsError
        If no line has the name, several have the quantity, or none of several has it.
    """
    named = [line for line in lines if name in (None, line.name)]
    if not named:
        raise SettingsError(
            f"there is no line '{name}'",
            needed=", ".join(dict.fromkeys(line.name for line in lines)),
        )
    having = [line for line in named if quantity in line.quantities]
    if not having and len(named) > 1:
        raise SettingsError(
            f"none of {len(named)} lines has {quantity}",
            needed="one of "
            + ", ".join(dict.fromkeys(name for line in named for name in line.quantities)),
        )
    if len(having) > 1:
        raise SettingsError(
            f"several lines have {quantity}",
            found=", ".join(dict.fromkeys(f"{line.name} ({line.source})" for line in having)),
            needed="one archive, --line NAME, or a search that leaves one",
        )
    return having[0] if having else named[0]


def _specimens(path: Path, names: set[str]) -> dict[str, Facts]:
    """What the archives of tests beside an archive of experiments state of its specimens."""
    known: dict[str, Facts] = {}
    for one in archives_of_tests(path.parent):
        if names <= known.keys():
            break
        with open_archive(one) as archive:
            known |= facts_of_specimens(archive)
    return known
