"""Statements of a client report: laboratory, client, items, instruments, limits, dates.

They are separate from the archives and affect no number, so that a report can be amended without
changing any archive.  An empty text was not stated; a report shows it as such and never omits it.

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

from reduction.archive.atomic_write import take_away, write_text_atomically
from reduction.record.errors import ArchiveError
from reduction.uncertainty.budget import DecisionRule

FILE_NAME = "report.json"

Paper = Literal["A4", "Letter"]

ReportText = Annotated[str, StringConstraints(max_length=4000, strip_whitespace=True)]


def _as_text(value: object) -> object:
    """A date of TOML as text, unchanged."""
    return value.isoformat() if isinstance(value, datetime.date) else value


Date = Annotated[ReportText, BeforeValidator(_as_text)]
"""A TOML date, or text: ``2026-03-05``, ``"2 to 5 March 2026"``."""


class ReportSection(BaseModel):
    """A table of ``[report]``."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Laboratory(ReportSection):
    """``[report.laboratory]``."""

    name: ReportText = ""
    address: ReportText = ""
    contact: ReportText = ""
    location: ReportText = ""
    """Place of the tests, if it is not the address."""
    accreditation: ReportText = ""


class Client(ReportSection):
    """``[report.client]``."""

    name: ReportText = ""
    address: ReportText = ""
    contact: ReportText = ""
    order: ReportText = ""


class ReportItem(ReportSection):
    """``[report.items.SPECIMEN]``: an item received."""

    identification: ReportText = ""
    """Marking on it: a serial number, a tag."""
    description: ReportText = ""
    condition: ReportText = ""
    """Condition on receipt."""
    received: Date = ""


class _Authorised(ReportSection):
    """``[report.authorised]``."""

    by: ReportText = ""
    function: ReportText = ""
    on: Date = ""


class Instrument(ReportSection):
    """``[[report.instruments]]``: one instrument with its last calibration."""

    name: ReportText
    identification: ReportText = ""
    certificate: ReportText = ""
    traceable_to: ReportText = ""
    calibrated: Date = ""
    due: Date = ""


class ReportLimit(ReportSection):
    """A limit for a number of a test, with at least one end.

    Parameters
    ----------
    quantity : str
        Name in the vocabulary.
    test : str
        Id of the product of a test or a step.
    at : dict of str to str
        Place of the number along each dimension, as for `reduction budget`.
    lower, upper : float or None
        Ends in SI. [unit of the quantity]
    source : str
        Source of the limit.
    """

    quantity: str
    test: str
    at: dict[str, str] = Field(default_factory=dict)
    lower: float | None = None
    upper: float | None = None
    source: str = ""


AnyLimit = TypeVar("AnyLimit")


class Statement(ReportSection, Generic[AnyLimit]):
    """``[report]``: all keys are optional; the report says which are not stated."""

    number: ReportText = ""
    revision: int = Field(default=0, ge=0)
    amendment: ReportText = ""
    """Changes in this revision, and the report it replaces."""
    issued: Date = ""
    received: Date = ""
    """Date of receipt, if the items arrived together."""
    tested: Date = ""
    method: ReportText = ""
    deviations: ReportText = ""
    """Deviations from the method: ``"none"`` if there were none."""
    sampling: ReportText = ""
    environment: ReportText = ""
    opinions: ReportText = ""
    """Opinions and interpretations, marked as such in the report."""
    decision_rule: DecisionRule | None = None
    """Required if a limit is given."""
    paper: Paper = "A4"
    laboratory: Laboratory = Laboratory()
    client: Client = Client()
    authorised: _Authorised = _Authorised()
    items: dict[str, ReportItem] = Field(default_factory=dict)
    instruments: tuple[Instrument, ...] = ()
    limits: tuple[AnyLimit, ...] = ()


class ReportDetails(Statement[ReportLimit]):
    """Statements of the laboratory, with limits in SI."""


def keep_details(folder: Path, details: ReportDetails | None) -> None:
    """Write the statements of the laboratory, or remove those of an earlier run."""
    path = folder / FILE_NAME
    if details is None:
        take_away(path)
        return
    write_text_atomically(path, details.model_dump_json(indent=1) + "\n")


def read_details(folder: Path) -> ReportDetails | None:
    """Read the statements of the laboratory."""
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
