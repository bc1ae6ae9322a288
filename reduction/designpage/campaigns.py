"""Lines of every campaign below a folder of products, read anew where an archive has changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Any

from reduction.archive.campaignlines import (
    archives_of_lines,
    lines_of_open_archive,
    names_apart,
)
from reduction.archive.open import open_archive
from reduction.designpage.exportdata import curves_of_archive, refusal_of_surfaces
from reduction.designpage.linedata import line_data
from reduction.errors import ReductionError
from reduction.lookup.product import LineSource

__all__ = ["CampaignLines", "read_campaigns", "state_of"]

_SURFACES = "surfaces"
_STATUS = "status.csv"
"""That every run leaves beside its archives."""
# what a file that was damaged, or made by hand, may end in
_FAULTS = (ReductionError, OSError, RuntimeError, KeyError, IndexError, ValueError, TypeError)


@dataclass(frozen=True)
class CampaignLines:
    """A campaign as the page keeps it.

    Parameters
    ----------
    name : str
        Of its folder.
    files : dict of str to dict
        By the name of the archive without its end: ``state``, by which a change is seen, and
        ``lines``, none where there is nothing to look up.
    faults : dict of str to str
        Archives that cannot be read, with the reason.
    changed : int
        When the newest archive was written; nanoseconds of its file system.
    """

    name: str
    files: dict[str, dict[str, Any]] = field(default_factory=dict)
    faults: dict[str, str] = field(default_factory=dict)
    changed: int = 0

    @property
    def names(self) -> list[str]:
        """Of the lines of all files, as a look-up in the folder calls them."""
        return names_apart(
            [(stem, line["name"]) for stem, one in self.files.items() for line in one["lines"]]
        )


def state_of(processed: Path) -> str:
    """Digest of which archives there are and when each was written; it changes with any of them."""
    text = "\n".join(
        f"{path.parent.name}/{path.name} {_stamp(path)}"
        for folder in _folders(processed)
        for path in archives_of_lines(folder)
    )
    return sha256(text.encode("utf-8", "surrogateescape")).hexdigest()


def read_campaigns(
    processed: Path, known: Mapping[str, Mapping[str, Any]] | None = None
) -> list[CampaignLines]:
    """Lines of every campaign below a folder.

    Parameters
    ----------
    processed : pathlib.Path
        Folder in which campaigns have theirs.
    known : mapping of str to mapping, optional
        ``files`` of campaigns by name, as they were read before: an archive that has not changed
        is not read again.

    Returns
    -------
    campaigns : list of CampaignLines
        By name; an archive that cannot be read is among the faults of its own.
    """
    return [_read(folder, (known or {}).get(folder.name, {})) for folder in _folders(processed)]


def _folders(processed: Path) -> list[Path]:
    return sorted(
        one for one in processed.glob("*/") if (one / _STATUS).is_file() and archives_of_lines(one)
    )


def _read(folder: Path, known: Mapping[str, Any]) -> CampaignLines:
    found = CampaignLines(folder.name)
    files, faults, changed = found.files, found.faults, 0
    paths = archives_of_lines(folder)
    stamps = {path: _stamp(path) for path in paths}
    for path in paths:
        # surfaces have what the tests beside them say of their specimens
        own = " ".join(stamps.values()) if path.stem == _SURFACES else stamps[path]
        state = sha256(own.encode()).hexdigest()
        changed = max(changed, int(stamps[path].split()[0]))
        before = known.get(path.stem)
        if before is not None and before["state"] == state:
            files[path.stem] = dict(before)
            continue
        try:
            files[path.stem] = {"state": state, "lines": _lines(path)}
        except _FAULTS as error:
            text = str(error) if isinstance(error, ReductionError) else repr(error)
            faults[path.name] = text.replace(str(path), path.name)
    return CampaignLines(folder.name, files, faults, changed)


def _stamp(path: Path) -> str:
    """Time, size and number of a file; zeros where it was taken away meanwhile."""
    try:
        found = path.stat()
    except OSError:
        return "0 0 0"
    return f"{found.st_mtime_ns} {found.st_size} {found.st_ino}"


def _lines(path: Path) -> list[dict[str, Any]]:
    with open_archive(path) as archive:

        def of(line: LineSource) -> dict[str, Any]:
            is_test = "experiment" not in archive.sizes
            made = (
                curves_of_archive(archive, path.stem, line.name)
                if is_test
                else refusal_of_surfaces(line)
            )
            return line_data(line) | {"export": made}

        return [of(line) for line in lines_of_open_archive(archive, path)]
