"""One archive by itself: is it whole, is it the one that its name says, does it keep its rules."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from reduction.archive.check import check_archive
from reduction.archive.open import reading
from reduction.archive.seal import has_seal
from reduction.errors import ArchiveError
from reduction.provenance import Source
from reduction.verify.finding import Finding

__all__ = ["Looked", "look_at", "misplaced"]

_AGAIN = "Take a copy that is whole, or run the campaign again."


@dataclass(frozen=True)
class Looked:
    """What one archive says of itself; ``attributes`` is None where it cannot be read."""

    path: Path
    attributes: dict[str, str] | None
    findings: list[Finding] = field(default_factory=list)

    @property
    def sources(self) -> tuple[Source, ...]:
        """Files that it was made from, as it states them; none where it does not."""
        stated = self.attributes or {}
        names = stated.get("raw_file", "").splitlines()
        sums = stated.get("raw_file_sha256", "").splitlines()
        sizes = stated.get("raw_file_bytes", "").splitlines()
        if not len(names) == len(sums) == len(sizes) or not all(map(str.isdecimal, sizes)):
            return ()
        rows = zip(names, sums, sizes, strict=True)
        return tuple(Source(name, digest, int(size)) for name, digest, size in rows)


def look_at(path: Path) -> Looked:
    """Read one archive whole.

    Parameters
    ----------
    path : pathlib.Path
        An archive.

    Returns
    -------
    looked : Looked
        With what is wrong with it by itself.
    """
    name = path.name
    try:
        is_sealed = has_seal(path)
        with reading(path) as archive:
            attributes = {str(key): str(value) for key, value in archive.attrs.items()}
        faults = check_archive(path)
    except ArchiveError as error:
        return Looked(path, None, [_unreadable(path, error)])
    except (OSError, RuntimeError) as error:
        words = str(error).splitlines()[0] if str(error) else type(error).__name__
        finding = Finding(name, "damaged", "it cannot be read", words, hint=_AGAIN)
        return Looked(path, None, [finding])
    findings = []
    if not is_sealed:
        findings.append(
            Finding(
                name, "changed", "it does not end with the sum of its bytes",
                needed="the file as a run wrote it",
                hint="Another program wrote it or changed it; a run makes it again.",
            )
        )  # fmt: skip
    if faults:
        listed = "; ".join(faults[:5])
        findings.append(Finding(name, "damaged", "it breaks rules of its schema", listed))
    return Looked(path, attributes, findings)


def _unreadable(path: Path, error: ArchiveError) -> Finding:
    return Finding(
        path.name,
        "damaged",
        error.problem.replace(f"{path} ", "it ", 1),
        error.found or "",
        error.needed or "",
        error.hint or _AGAIN,
    )


def misplaced(looked: Looked, campaign: str) -> Finding | None:
    """Say where an archive is that of another test or campaign than its place tells.

    Parameters
    ----------
    looked : Looked
        An archive that can be read.
    campaign : str
        Id of the campaign whose folder it lies in.

    Returns
    -------
    finding : Finding or None
        None where it belongs there.
    """
    stated = (looked.attributes or {}).get("id", "")
    needed = f"{campaign}/{looked.path.stem}"
    if stated == needed:
        return None
    return Finding(
        looked.path.name,
        "misplaced",
        "it is another archive under this name",
        f"the archive '{stated}'" if stated else "no id",
        f"'{needed}'",
        "Was it renamed, copied or swapped with another? Put it where it belongs, or run the "
        "campaign again.",
    )
