"""One printed number, and what is known against it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

ReportId = Literal["WHOI-2004-06", "Zhang-2015", "WHOI-2005-10", "CG-D-39-80", "Wang-2022"]
Confidence = Literal["", "certain", "high", "open"]
"""Of a correction; open: the page is wrong or doubtful, and nothing says what is right."""

_NUMBER = re.compile(r"[-+]?(?:\d[\d,]*\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_FRACTION = re.compile(r"([-+]?)(?:(\d+) )?(\d+)/([1-9]\d*)(?![/\d])")


@dataclass(frozen=True)
class Cell:
    """One printed number.

    Parameters
    ----------
    report : str
        Which of the five.
    table : str
        ``3``, ``A-2``, or the section of a claim of the text, ``sec 4.4.1``.
    row, column : str
        Which line or specimen, and which quantity.
    printed : str
        The text as printed.
    unit : str
        As printed.
    corrected : float or None
        Value in the printed unit where the page is wrong; None where it stands, or is open.
    erratum : str
        Id of `Erratum`; empty where nothing is known against the cell.
    confidence : str
        Of the correction.
    page : str
        Page or section.
    note : str
        What else to know.
    """

    report: ReportId
    table: str
    row: str
    column: str
    printed: str
    unit: str
    corrected: float | None
    erratum: str
    confidence: Confidence
    page: str
    note: str

    @property
    def key(self) -> tuple[str, str, str]:
        """Place in the report."""
        return self.table, self.row, self.column

    @property
    def value(self) -> float | None:
        """What to use: corrected, or as printed; None of text and of what is open."""
        if self.corrected is not None:
            return self.corrected
        return None if self.confidence == "open" else number_of(self.printed)


@dataclass(frozen=True)
class Erratum:
    """A fault of a page: what it prints, what is right, and why."""

    id: str
    report: ReportId
    place: str
    printed: str
    corrected: str
    evidence: str
    confidence: Confidence


def number_of(text: str) -> float | None:
    """The number that a printed text holds; None where there is none.

    Examples
    --------
    >>> number_of("1,725"), number_of("-.188"), number_of("about 30"), number_of("n/a")
    (1725.0, -0.188, 30.0, None)
    >>> number_of("-3/2"), number_of("1 1/4 in")
    (-1.5, 1.25)
    """
    found = _NUMBER.search(text)
    if found is None:
        return None
    fraction = _FRACTION.match(text, found.start())
    if fraction is not None:
        sign, whole, over, under = fraction.groups()
        return (-1 if sign == "-" else 1) * (int(whole or 0) + int(over) / int(under))
    return float(found[0].replace(",", ""))


def printed_step(text: str) -> float:
    """One unit of the last printed digit; 0 where there is no number, or a fraction.

    Examples
    --------
    >>> printed_step("6.317"), printed_step("1,725"), printed_step(".07"), printed_step("3.26e-11")
    (0.001, 1.0, 0.01, 1e-13)
    """
    found = _NUMBER.search(text)
    if found is None or _FRACTION.match(text, found.start()):
        return 0.0
    mantissa, _, power = found[0].lower().replace(",", "").partition("e")
    decimals = len(mantissa.partition(".")[2])
    return float(f"1e{int(power or 0) - decimals}")
