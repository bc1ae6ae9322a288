"""A TOML file to its pydantic model; whatever is wrong with it is told at once, by key."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from reduction.campaign.faults import faults_of, in_toml, listed, open_questions
from reduction.campaign.textfiles import read_small_text
from reduction.errors import LogError

# what the parser takes minutes or gigabytes for, and no setting has
_DEEP = re.compile(r"""(?<![\w-])(?:(?:[\w-]+|"[^"\n]*"|'[^'\n]*')[ \t]*\.[ \t]*){40}""")
_MOST_LINES = 500_000
_Model = TypeVar("_Model", bound=BaseModel)


def read_toml(
    path: Path,
    model: type[_Model],
    *,
    what: str,
    needed: str,
    keys: str,
    text: str | None = None,
    hint: Callable[[Path], str | None] = lambda path: None,
) -> _Model:
    """Read and validate.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    model : type of BaseModel
        What it has to be.
    what, needed, keys : str
        For the messages: ``the campaign``; what would do where there is no file; where the
        keys are listed.
    text : str, optional
        What the file is to hold; it is read where left out.
    hint : callable
        What to do about a file that is not TOML.

    Returns
    -------
    file : BaseModel
        An instance of the model.

    Raises
    ------
    SettingsError
        If the file cannot be read, a value is still ``?``, or a key or value cannot be used:
        up to ten places, one a line.
    """
    try:
        table = _tables(read_small_text(path) if text is None else text)
    except LogError as error:
        raise in_toml(path, error.problem, found=error.found, needed=error.needed) from error
    except OSError as error:
        raise in_toml(
            path, f"{what} cannot be read", found=error.strerror or str(error), needed=needed
        ) from error
    except (ValueError, RecursionError) as error:  # a number of too many digits is no TOML error
        raise in_toml(path, f"{what} is not TOML", found=str(error), hint=hint(path)) from error
    places = open_questions(path.parent, table)
    if places:
        count = f"{len(places)} values are" if len(places) > 1 else "1 value is"
        raise in_toml(path, listed(f"{count} still '?', first {places[0]}", places))
    try:
        return model.model_validate(table)
    except ValidationError as error:
        faults = faults_of(error, table)
        count = f"{len(faults)} settings" if len(faults) > 1 else "1 setting"
        headline = f"{count} cannot be used, first '{faults[0].place}' ({keys})"
        raise in_toml(path, listed(headline, faults)) from error


def _tables(text: str) -> dict[str, Any]:
    """What TOML says; `ValueError` where it is none, or more than anybody writes."""
    if text.count("\n") > _MOST_LINES:
        raise ValueError(f"more than {_MOST_LINES:,} lines")
    if deep := _DEEP.search(text):
        line = text.count("\n", 0, deep.start()) + 1
        raise ValueError(f"a key of more than 40 parts (at line {line})")
    return tomllib.loads(text)
