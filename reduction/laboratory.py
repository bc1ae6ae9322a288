"""What a laboratory states in its report beside the numbers: who, what, when, with which limits.

A text that is empty was not stated; a report shows it as such and never leaves it out.

References
----------
.. [1] ISO/IEC 17025:2017, 7.8 (what a report of tests holds).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

__all__ = [
    "DecisionRule",
    "Instrument",
    "Item",
    "Limit",
    "Paper",
    "Party",
    "ReportDetails",
]

DecisionRule = Literal["simple acceptance", "guard band"]
Paper = Literal["A4", "Letter"]


@dataclass(frozen=True)
class Party:
    """Laboratory or client.

    ``accreditation`` is a laboratory's, ``order`` a client's; ``location`` is where the tests
    were made, where that is not the address.
    """

    name: str = ""
    address: str = ""
    contact: str = ""
    location: str = ""
    accreditation: str = ""
    order: str = ""


@dataclass(frozen=True)
class Item:
    """One item that was tested, as it came in; ``specimen`` is its name in the archives."""

    specimen: str
    identification: str = ""
    description: str = ""
    condition: str = ""
    received: str = ""


@dataclass(frozen=True)
class Instrument:
    """One instrument with its last calibration."""

    name: str
    identification: str = ""
    certificate: str = ""
    traceable_to: str = ""
    calibrated: str = ""
    due: str = ""


@dataclass(frozen=True)
class Limit:
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
    at: dict[str, str] = field(default_factory=dict)
    lower: float | None = None
    upper: float | None = None
    source: str = ""


@dataclass(frozen=True)
class ReportDetails:
    """``[report]`` of a campaign; dates are as the laboratory writes them.

    ``revision`` counts from 0, the first issue; ``amendment`` says what a later one changed.
    """

    number: str = ""
    revision: int = 0
    amendment: str = ""
    issued: str = ""
    received: str = ""
    tested: str = ""
    method: str = ""
    deviations: str = ""
    sampling: str = ""
    environment: str = ""
    opinions: str = ""
    laboratory: Party = Party()
    client: Party = Party()
    authorised_by: str = ""
    authorised_function: str = ""
    authorised_on: str = ""
    items: tuple[Item, ...] = ()
    instruments: tuple[Instrument, ...] = ()
    decision_rule: DecisionRule | None = None
    limits: tuple[Limit, ...] = ()
    paper: Paper = "A4"
