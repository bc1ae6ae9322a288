"""What SOURCE names for a composite curve: tests of one specimen, or a published tether."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import cast

import xarray as xr

from reduction.archive.open import failing_reads, open_archive
from reduction.archive.pieces import source_of_tests, specimens_of
from reduction.archive.products import archives_of_tests
from reduction.errors import SettingsError
from reduction.lookup.compositerule import CompositeRule
from reduction.lookup.pieces import PieceBranch, PieceKind
from reduction.lookup.source import PieceSource
from reduction.published.linesource import published_sources
from reduction.published.piecesource import published_piece_sources


def is_of_pieces(sources: Sequence[str]) -> bool:
    """Whether SOURCE names several tests: archives, a folder, a published tether."""
    return (
        len(sources) > 1
        or any(Path(one).is_dir() for one in sources)
        or any(one in published_piece_sources() for one in sources)
    )


def rule_of(precedence: str | None) -> CompositeRule:
    """The rule, from kinds parted by commas.

    Raises
    ------
    SettingsError
        If one of them is no kind.
    """
    if precedence is None:
        return CompositeRule()
    kinds = tuple(cast("PieceKind", part.strip()) for part in precedence.split(","))
    try:
        return CompositeRule(precedence=kinds)
    except SettingsError as error:
        raise SettingsError(
            f"--precedence: {error.problem}", found=error.found, needed=error.needed
        ) from error


def piece_source(
    sources: Sequence[str], *, specimen: str | None = None, branch: PieceBranch | None = None
) -> PieceSource:
    """Pieces of what SOURCE names.

    Parameters
    ----------
    sources : sequence of str
        A published tether by its name without the test, or archives and folders of processed
        campaigns.
    specimen : str, optional
        Which one; needed where the archives hold several.
    branch : {"mean", "ascending", "descending"}, optional
        "mean" of archives where it is not said; a published tether has its ascending one.

    Returns
    -------
    source : PieceSource
        With pieces, splices and notes.

    Raises
    ------
    SettingsError
        If nothing has that name, or the specimen is not there or not said.
    ArchiveError
        If an archive cannot be read.
    DataError
        If no test gives a piece.
    """
    published = published_piece_sources()
    if any(one in published for one in sources):
        return _published(sources, specimen, branch)
    paths = [path for one in sources for path in _archives(one)]
    named = {Path(one) for one in sources}
    with failing_reads(" or ".join(map(str, paths))), ExitStack() as opened:
        datasets = [opened.enter_context(open_archive(path)) for path in paths]
        name = _specimen(datasets, sources, specimen)
        for path, one in zip(paths, datasets, strict=True):
            # of a folder some are of other specimens; what was named was meant
            if path in named and name not in specimens_of(one):
                raise SettingsError(
                    f"{path} has no specimen '{name}'",
                    found=", ".join(specimens_of(one)) or "no archive of a test",
                    needed="tests of one specimen",
                )
        return source_of_tests(datasets, name, branch=branch or "mean")


def _published(
    sources: Sequence[str], specimen: str | None, branch: PieceBranch | None
) -> PieceSource:
    if len(sources) > 1:
        raise SettingsError(
            "a published tether stands alone", found=", ".join(sources), needed="one SOURCE"
        )
    found = published_piece_sources()[sources[0]]
    if specimen is not None:
        raise SettingsError(
            f"{found.name} is one tether", found=f"specimen {specimen}", needed="no specimen"
        )
    if branch not in (None, found.branch):
        raise SettingsError(
            f"{found.name} has its {found.branch} branch alone: no other is tabulated",
            found=str(branch),
            needed=found.branch,
        )
    return found


def _archives(source: str) -> list[Path]:
    path = Path(source)
    if path.is_file():
        return [path]
    if path.is_dir():
        found = archives_of_tests(path)
        if found:
            return found
        raise SettingsError(
            f"{path} holds no archive of a test", needed="processed/CAMPAIGN after `reduction run`"
        )
    tethers = published_piece_sources()
    if source in published_sources():
        near = [name for name in tethers if source.startswith(f"{name}-")]
        raise SettingsError(
            f"{source} is one published curve, no pieces of one",
            needed=", ".join(near or tethers),
            hint="`reduction export` and `reduction lookup` take it as it is.",
        )
    raise SettingsError(
        f"there is nothing called '{source}'",
        needed="archives, a folder of a processed campaign, or one of " + ", ".join(tethers),
    )


def _specimen(datasets: Sequence[xr.Dataset], sources: Sequence[str], specimen: str | None) -> str:
    names = list(dict.fromkeys(name for one in datasets for name in specimens_of(one)))
    where = ", ".join(sources)
    if not names:
        raise SettingsError(f"{where}: no archive of a test", needed="archives of reduced tests")
    if specimen is None and len(names) > 1:
        raise SettingsError(
            f"{where}: several specimens", found=", ".join(names), needed="one specimen",
            hint="Say which with --specimen, or in the specification.",
        )  # fmt: skip
    if specimen is not None and specimen not in names:
        raise SettingsError(f"{where}: there is no specimen '{specimen}'", needed=", ".join(names))
    return specimen or names[0]
