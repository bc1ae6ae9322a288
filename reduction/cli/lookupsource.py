"""What the text SOURCE of a look-up names: a published line, an archive, a campaign's folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from reduction.archive.campaignlines import archives_of_lines, lines_of_archive, told_apart
from reduction.errors import ArchiveError, SettingsError
from reduction.lookup.product import LineSource
from reduction.published.linesource import published_sources
from reduction.vocabulary import SINGLE_QUANTITIES

_OF_CYCLES = (
    "apparent_spring_constant", "hysteresis_energy", "quasi_static_spring_constant",
    "dissipation_spring_constant", "relaxation_time", "dashpot_coefficient",
)  # fmt: skip
# tension along a curve over strain is kept by the name of its branches
_OF_CURVES = {"tension": "branch_tension"}
_ENDINGS = (".nc", ".toml", ".csv")


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
        lines = told_apart([(one.stem, lines_of_archive(one)) for one in archives_of_lines(path)])
        if lines:
            return lines
    if _is_path(source):
        raise _no_products(path)
    words = source.lower().replace("-", " ").split()
    near = [name for name in published if all(word in name for word in words)]
    raise SettingsError(
        f"no line is called '{source}'",
        needed="an archive, a folder of a processed campaign, or "
        + (f"one of {', '.join(near)}" if near else f"one of {len(published)} published lines"),
        hint="`reduction lookup published --list` says what there is.",
    )


def name_of_quantity(text: str) -> str:
    """Name of a quantity that is asked for by the symbol of its source, or as ``tension``.

    Parameters
    ----------
    text : str
        A name, or a symbol; K_0 or K0; ``tension`` is that of a branch over strain.

    Returns
    -------
    name : str
        The text itself where it is neither ``tension`` nor a symbol of a number of the
        three-parameter line.

    Examples
    --------
    >>> [name_of_quantity(text) for text in ("K_ap", "tension", "loss_factor")]
    ['apparent_spring_constant', 'branch_tension', 'loss_factor']
    """
    symbols = {
        SINGLE_QUANTITIES[name].symbol.split(",")[0].split()[-1].replace("_", ""): name
        for name in _OF_CYCLES
    } | _OF_CURVES
    return symbols.get(text.replace("_", ""), text)


def _is_path(source: str) -> bool:
    return "/" in source or "\\" in source or source.endswith(_ENDINGS) or Path(source).exists()


def _no_products(path: Path) -> SettingsError:
    """Why a path has nothing to look up, and which command makes it."""
    if path.is_dir():
        problem, found = "the folder holds no archive with values to look up", str(path)
    else:
        problem, found = "there is no such folder or archive", str(path)
    campaign = path.parent.name if path.suffix == ".nc" else path.name
    return SettingsError(
        problem,
        found=found,
        needed="the products of a campaign, which are made first",
        hint=f"`reduction run raw/{campaign}/campaign.toml` makes processed/{campaign}.",
    )


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
        # of "T-1 new" the test or the specimen alone, as far as it leaves one
        named = [
            line
            for line in lines
            if line.name.startswith(f"{name} ") or line.name.endswith(f" {name}")
        ]
    if not named:
        raise SettingsError(
            f"there is no line '{name}'",
            needed=", ".join(dict.fromkeys(line.name for line in lines)),
            hint=f'Such as `--line "{lines[0].name}"`.',
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
            hint=f'Such as `--line "{having[0].name}"`.',
        )
    return having[0] if having else named[0]
