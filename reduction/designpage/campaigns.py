"""Lines of every campaign below a folder of products, read anew where an archive has changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from hashlib import file_digest, sha256
from pathlib import Path
from typing import Any

from reduction.archive.campaignlines import (
    archives_of_lines,
    lines_of_open_archive,
    names_apart,
)
from reduction.archive.open import Opener, reading
from reduction.designpage.linedata import json_text, line_data
from reduction.errors import ReductionError

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
        By the name of the archive without its end: ``state``, a digest of its bytes by which a
        change is seen, and ``lines``, none where there is nothing to look up.
    faults : dict of str to str
        Archives that cannot be read, with the reason.
    left_out : int
        Archives that a page has no room for; they are not read.
    """

    name: str
    files: dict[str, dict[str, Any]] = field(default_factory=dict)
    faults: dict[str, str] = field(default_factory=dict)
    left_out: int = 0

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
    processed: Path,
    known: Mapping[str, Mapping[str, Any]] | None = None,
    *,
    room: int,
    opener: Opener = reading,
) -> list[CampaignLines]:
    """Lines of every campaign below a folder, as far as a page has room.

    Parameters
    ----------
    processed : pathlib.Path
        Folder in which campaigns have theirs.
    known : mapping of str to mapping, optional
        ``files`` of campaigns by name, as they were read before: an archive that has not changed
        is not read again.
    room : int
        For all of them. Surfaces come first, which are of all tests of an experiment, then tests,
        those of the campaign that was written last before others. [bytes]
    opener : Opener
        How archives are opened.

    Returns
    -------
    campaigns : list of CampaignLines
        By name; an archive that cannot be read is among the faults of its own.
    """
    found = [
        _Reading(folder, (known or {}).get(folder.name, {}), opener)
        for folder in _folders(processed)
    ]
    newest = sorted(found, key=lambda one: -one.changed)
    for is_surfaces in (True, False):
        for one in newest:
            for path in one.paths:
                if (path.stem == _SURFACES) != is_surfaces:
                    continue
                # what comes behind the first that has no room is not read to see how large it is
                room -= one.read(path) if room > 0 else one.leave(path)
                if room < 0:
                    one.leave(path)
    return [one.campaign for one in found]


class _Reading:
    """A campaign while its archives are read."""

    def __init__(self, folder: Path, known: Mapping[str, Any], opener: Opener) -> None:
        self.paths = archives_of_lines(folder)
        self._stamps = {path: _stamp(path) for path in self.paths}
        self.changed = max(int(stamp.split()[0]) for stamp in self._stamps.values())
        self._digests: dict[Path, str] = {}
        self._name, self._known, self._opener = folder.name, known, opener
        self._files: dict[Path, dict[str, Any]] = {}
        self._faults: dict[str, str] = {}
        self._left: set[Path] = set()

    def read(self, path: Path) -> int:
        """Read an archive, or take it from what is known; the room that it takes. [bytes]."""
        # surfaces have what the tests beside them say of their specimens
        rests_on = self.paths if path.stem == _SURFACES else (path,)
        state = sha256(" ".join(map(self._digest, rests_on)).encode()).hexdigest()
        before = self._known.get(path.stem)
        if before is not None and before["state"] == state:
            self._files[path] = dict(before)
        else:
            try:
                self._files[path] = {"state": state, "lines": _lines(path, self._opener)}
            except _FAULTS as error:
                text = str(error) if isinstance(error, ReductionError) else repr(error)
                self._faults[path.name] = text.replace(str(path), path.name)
                return 0
        return len(json_text(self._files[path]))

    def _digest(self, path: Path) -> str:
        """Of all bytes: by times and numbers of files the page would not be the same elsewhere."""
        if path not in self._digests:
            try:
                with path.open("rb") as file:
                    self._digests[path] = file_digest(file, "sha256").hexdigest()
            except OSError:
                self._digests[path] = ""
        return self._digests[path]

    def leave(self, path: Path) -> int:
        """Leave an archive out; it takes no room."""
        self._files.pop(path, None)
        self._left.add(path)
        return 0

    @property
    def campaign(self) -> CampaignLines:
        """What was read, in the order of the folder."""
        files = {path.stem: self._files[path] for path in self.paths if path in self._files}
        return CampaignLines(self._name, files, self._faults, len(self._left))


def _folders(processed: Path) -> list[Path]:
    try:
        # a folder that may not be read is no empty one, as `Path.glob` has it
        found = sorted(processed.iterdir())
    except FileNotFoundError:
        return []
    return [one for one in found if (one / _STATUS).is_file() and archives_of_lines(one)]


def _stamp(path: Path) -> str:
    """Time, size and number of a file; zeros where it was taken away meanwhile."""
    try:
        found = path.stat()
    except OSError:
        return "0 0 0"
    return f"{found.st_mtime_ns} {found.st_size} {found.st_ino}"


def _lines(path: Path, opener: Opener) -> list[dict[str, Any]]:
    with opener(path) as archive:
        return [line_data(line) for line in lines_of_open_archive(archive, path, opener)]
