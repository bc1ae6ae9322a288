"""What a file says of itself, as far as it is kept with the product."""

from __future__ import annotations

from collections.abc import Mapping

_LONGEST = 100_000


def short_metadata(found: Mapping[str, str]) -> tuple[dict[str, str], tuple[str, ...]]:
    """Return the texts that are short enough to be kept, and a note on each that is not.

    Parameters
    ----------
    found : mapping of str to str
        Attributes or properties of a file.

    Returns
    -------
    metadata : dict
        Those of 100,000 characters or fewer.
    notes : tuple of str
        One a text that is left out.

    Examples
    --------
    >>> short_metadata({"operator": "KH", "picture": "x" * 200_000})
    ({'operator': 'KH'}, ("'picture' of the file is left out: it has 200,000 characters",))
    """
    metadata, notes = {}, []
    for key, text in found.items():
        if len(key) + len(text) <= _LONGEST:
            metadata[key] = text
        else:
            notes.append(f"{key[:40]!r} of the file is left out: it has {len(text):,} characters")
    return metadata, tuple(notes)
