"""What the text SOURCE of a look-up names: a published line, an archive, a campaign's folder."""

from __future__ import annotations

from pathlib import Path

from reduction.archive.linesource import (
    Facts,
    facts_of_specimens,
    line_of_experiment,
    line_of_test,
    specimens_of,
)
from reduction.archive.open import open_archive
from reduction.archive.products import archives_of_tests
from reduction.errors import SettingsError
from reduction.lookup.product import LineSource
from reduction.published.linesource import published_sources

__all__ = ["lines_of", "lines_of_archive"]


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
        If an archive cannot be read.
    """
    published = published_sources()
    if source == "published":
        return list(published.values())
    if source in published:
        return [published[source]]
    path = Path(source)
    if path.is_file():
        return lines_of_archive(path)
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
        if "tangent_modulus" not in archive and "branch_tension" not in archive:
            return []
        names = archive["specimen"].values.astype(str).tolist()
        return [line_of_test(archive, name) for name in names]


def _specimens(path: Path, names: set[str]) -> dict[str, Facts]:
    """What the archives of tests beside an archive of experiments state of its specimens."""
    known: dict[str, Facts] = {}
    for one in archives_of_tests(path.parent):
        if names <= known.keys():
            break
        with open_archive(one) as archive:
            known |= facts_of_specimens(archive)
    return known
