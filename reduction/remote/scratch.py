"""A folder for copies that are gone when the work is done."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from reduction.errors import ReductionError

__all__ = ["in_words", "renamed", "scratch_folder"]


@contextmanager
def scratch_folder() -> Iterator[Path]:
    """Make a folder for copies; it is taken away at the end, whatever happens.

    Yields
    ------
    folder : pathlib.Path
        In the folder for temporary files, which the variable ``TMPDIR`` names.
    """
    with TemporaryDirectory(prefix="reduction-", ignore_cleanup_errors=True) as name:
        yield Path(name).resolve()


def in_words(text: str, names: Mapping[str, str]) -> str:
    """A text with addresses instead of the paths of their copies.

    Parameters
    ----------
    text : str
        A message.
    names : mapping of str to str
        What may be shown of an address, by the path of its copy.

    Returns
    -------
    text : str
        The same where it names no copy.

    Examples
    --------
    >>> in_words("copies/0/T-1.csv:5 [time]: a gap", {"copies/0/T-1.csv": "s3://bucket/T-1.csv"})
    's3://bucket/T-1.csv:5 [time]: a gap'
    """
    for path in sorted(names, key=len, reverse=True):
        text = text.replace(path, names[path])
    return text


@contextmanager
def renamed(names: Mapping[str, str]) -> Iterator[None]:
    """Let errors from the ``with`` block name addresses instead of the paths of their copies."""
    try:
        yield
    except ReductionError as error:
        for part in ("problem", "found", "needed", "hint", "path"):
            value = getattr(error, part, None)
            if value is not None:
                setattr(error, part, in_words(str(value), names))
        raise
