"""What a name stands for."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """One quantity: code name, SI unit, what it means, and its symbol in the source.

    An empty unit marks text: a label is not measured.
    """

    name: str
    unit: str
    long_name: str
    symbol: str = ""
    standard_name: str | None = None
