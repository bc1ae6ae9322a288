"""Files that archives were made from: are they there, and as they were."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path, PurePath

from reduction.address import is_address
from reduction.archive.products import OF_CAMPAIGN
from reduction.campaign.plan import Campaign
from reduction.errors import LogError
from reduction.ingest.source import hash_source
from reduction.provenance import Source
from reduction.verify.archives import Looked
from reduction.verify.finding import Finding

__all__ = ["SourceCheck"]


class SourceCheck:
    """Compares stated sources with the files; a file that several archives name is read once.

    Parameters
    ----------
    folder : pathlib.Path
        Of the products.
    campaign : Campaign or None
        Where the raw files are; None where only sources among the products can be looked at.
    """

    def __init__(self, folder: Path, campaign: Campaign | None) -> None:
        self._folder = folder
        self._campaign = campaign
        self._seen: dict[Path, Source | LogError] = {}

    @property
    def n_read(self) -> int:
        """Files that were read."""
        return sum(isinstance(one, Source) for one in self._seen.values())

    def findings(self, looked: Looked) -> list[Finding]:
        """What is wrong with the sources of one archive."""
        if not looked.sources:
            return [
                Finding(
                    looked.path.name, "damaged", "it does not say what it was made from",
                    needed="names, sums and sizes of its raw files",
                )
            ]  # fmt: skip
        found = (self._compared(looked.path, stated) for stated in looked.sources)
        return [one for one in found if one is not None]

    def not_fetched(self, archives: Sequence[Looked]) -> list[str]:
        """Sources that lie on the net and of which there is no copy here."""
        names = dict.fromkeys(
            stated.name
            for looked in archives
            for stated in looked.sources
            if is_address(stated.name) and not self._is_copied(stated.name)
        )
        return list(names)

    def _is_copied(self, name: str) -> bool:
        return self._campaign is not None and name in self._campaign.copies

    def _compared(self, archive: Path, stated: Source) -> Finding | None:
        if not is_address(stated.name) and not _is_inside(stated.name):
            return Finding(
                archive.name, "damaged", "it names a source outside of the folder of its campaign",
                f"'{stated.name}'", "a path below that folder",
            )  # fmt: skip
        is_product = archive.stem in OF_CAMPAIGN and stated.name.endswith(".nc")
        path = self._folder / stated.name if is_product else self._raw(stated.name)
        if path is None:
            return None
        found = self._read(path, stated.name)
        if isinstance(found, LogError):
            return Finding(
                archive.name, "raw_file", f"{stated.name}, from which it was made, cannot be read",
                found.found or found.problem, _shown(stated),
            )  # fmt: skip
        if (found.sha256, found.size) == (stated.sha256, stated.size):
            return None
        return Finding(
            archive.name,
            "raw_file",
            f"{stated.name} is not the file from which it was made",
            _shown(found),
            _shown(stated),
            "Run the campaign again."
            if is_product
            else f"If {stated.name} should not have changed, take a copy of it that is as it was; "
            "if it should, run the campaign again.",
        )

    def _raw(self, name: str) -> Path | None:
        """Where a raw file lies; None where it cannot be looked at."""
        if self._campaign is None or (is_address(name) and not self._is_copied(name)):
            return None
        if name == self._campaign.path.name:
            return self._campaign.path
        return self._campaign.copies.get(name, self._campaign.folder / name)

    def _read(self, path: Path, name: str) -> Source | LogError:
        if path not in self._seen:
            try:
                self._seen[path] = hash_source(path, name)
            except LogError as error:
                self._seen[path] = error
        return self._seen[path]


def _is_inside(name: str) -> bool:
    path = PurePath(name)
    return not path.is_absolute() and ".." not in path.parts


def _shown(source: Source) -> str:
    return f"sha256 {source.sha256[:16]}... of {source.size} bytes"
