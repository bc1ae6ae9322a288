"""What a laboratory states for its client, and ``report.json`` in which it is kept.

Who, what, when and with which limits stands apart from the archives: no number depends on it, so
that a report can be amended while every archive stays what it was.  A text that is empty was not
stated; a report shows it as such and never leaves it out.

References
----------
.. [1] ISO/IEC 17025:2017, 7.8 (what a report of tests holds).
"""

from __future__ import annotations

import datetime
from pathlib import Path
from typing import Annotated, Generic, Literal, TypeVar

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    StringConstraints,
    ValidationError,
)

from reduction.archive.whole import take_away
from reduction.archive.write import write_whole
from reduction.errors import ArchiveError
from reduction.uncertainty.conformity import DecisionRule

FILE_NAME = "report.json"
Paper = Literal["A4", "Letter"]
Text = Annotated[str, StringConstraints(max_length=4000, strip_whitespace=True)]


def _as_text(value: object) -> object:
    """A date of TOML as it is written there."""
    return value.isoformat() if isinstance(value, datetime.date) else value


Date = Annotated[Text, BeforeValidator(_as_text)]
"""A date of TOML, or text: ``2026-03-05``, ``"2 to 5 March 2026"``."""


class Section(BaseModel):
    """A table of ``[report]``."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Laboratory(Section):
    """``[report.laboratory]``."""

    name: Text = ""
    address: Text = ""
    contact: Text = ""
    location: Text = ""
    """Where the tests were made, where that is not the address."""
    accreditation: Text = ""


class Client(Section):
    """``[report.client]``."""

    name: Text = ""
    address: Text = ""
    contact: Text = ""
    order: Text = ""


class Item(Section):
    """``[report.items.SPECIMEN]``: what came in."""

    identification: Text = ""
    """What is written on it: a serial number, a tag."""
    description: Text = ""
    condition: Text = ""
    """On receipt."""
    received: Date = ""


class Authorised(Section):
    """``[report.authorised]``."""

    by: Text = ""
    function: Text = ""
    on: Date = ""


class Instrument(Section):
    """``[[report.instruments]]``: one instrument with its last calibration."""

    name: Text
    identification: Text = ""
    certificate: Text = ""
    traceable_to: Text = ""
    calibrated: Date = ""
    due: Date = ""


class Limit(Section):
    """A limit that a number of a test is held against; at least one end is given.

    Parameters
    ----------
    quantity : str
        Name of the vocabulary.
    test : str
        Id of the product: of a test, or of a step of one.
    at : dict of str to str
        Place of the number along each dimension, as `reduction budget` takes it.
    lower, upper : float or None
        In SI. [unit of the quantity]
    source : str
        Where the limit stands.
    """

    quantity: str
    test: str
    at: dict[str, str] = Field(default_factory=dict)
    lower: float | None = None
    upper: float | None = None
    source: str = ""


AnyLimit = TypeVar("AnyLimit")


class Statement(Section, Generic[AnyLimit]):
    """``[report]``: every key may be left out; the report then says that it is not stated."""

    number: Text = ""
    revision: int = Field(default=0, ge=0)
    amendment: Text = ""
    """What this revision changed, and which report it replaces."""
    issued: Date = ""
    received: Date = ""
    """When the items came in, where they came together."""
    tested: Date = ""
    method: Text = ""
    deviations: Text = ""
    """From the method: ``"none"`` where there were none."""
    sampling: Text = ""
    environment: Text = ""
    opinions: Text = ""
    """Opinions and interpretations, which the report marks as such."""
    decision_rule: DecisionRule | None = None
    """Required where a limit is given."""
    paper: Paper = "A4"
    laboratory: Laboratory = Laboratory()
    client: Client = Client()
    authorised: Authorised = Authorised()
    items: dict[str, Item] = Field(default_factory=dict)
    instruments: tuple[Instrument, ...] = ()
    limits: tuple[AnyLimit, ...] = ()


class ReportDetails(Statement[Limit]):
    """What the laboratory states, with limits in SI."""


def keep_details(folder: Path, details: ReportDetails | None) -> None:
    """Write what the laboratory states, or take away what an earlier run kept.

    Parameters
    ----------
    folder : pathlib.Path
        Of the archives of a campaign.
    details : ReportDetails or None
        None where the campaign has no ``[report]``.

    Raises
    ------
    ArchiveError
        If the disk refuses.
    """
    path = folder / FILE_NAME
    if details is None:
        take_away(path)
        return
    write_whole(path, details.model_dump_json(indent=1) + "\n")


def read_details(folder: Path) -> ReportDetails | None:
    """Read what the laboratory states.

    Parameters
    ----------
    folder : pathlib.Path
        Of the archives of a campaign.

    Returns
    -------
    details : ReportDetails or None
        None where nothing was kept.

    Raises
    ------
    ArchiveError
        If the file cannot be read.
    """
    path = folder / FILE_NAME
    if not path.is_file():
        return None
    try:
        return ReportDetails.model_validate_json(path.read_bytes())
    except (OSError, ValidationError) as error:
        raise ArchiveError(
            f"{path} cannot be read",
            found=str(error).splitlines()[0],
            needed="what a run keeps of [report]",
            hint="Run the campaign again.",
        ) from error
