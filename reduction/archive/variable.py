"""What one variable of an archive is: name, dimensions, type, flags, uncertainty.

Unit and meaning come from `reduction.vocabulary`; a name with a suffix (its standard
uncertainty, count, least and greatest value, scatter) takes them from its base.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from reduction.errors import ArchiveError
from reduction.vocabulary import QUANTITIES

TEXT = "U"
SUFFIXES = {
    "_random_standard_uncertainty": (
        "random part (k=1) of the standard uncertainty of {}",
        "f8",
        "is an uncertainty",
    ),
    "_uncertainty_contribution": (
        "signed contribution of one standard uncertainty of each shared error to {}",
        "f8",
        "is part of an uncertainty",
    ),
    "_standard_uncertainty": ("standard uncertainty (k=1) of {}", "f8", "is an uncertainty"),
    "_count": ("number of cycles in the mean: {}", "i4", "count"),
    "_minimum": ("least over the cycles: {}", "f8", "bound: least value seen"),
    "_maximum": ("greatest over the cycles: {}", "f8", "bound: greatest value seen"),
    "_scatter": ("standard deviation over the cycles: {}", "f8", "is itself a measure of spread"),
}
"""Suffix: its long name, type, and why it has no uncertainty of its own."""


@dataclass(frozen=True)
class Variable:
    """One variable of an archive.

    Parameters
    ----------
    name : str
        A name of the vocabulary, with or without one of `SUFFIXES`.
    dims : tuple of str
        In order; empty for a scalar.
    dtype : str
        ``f8``, ``i4``, ``i1``, ``u2`` or `TEXT`.
    no_uncertainty : str
        Why there is no standard uncertainty; empty where there is one.
    ancillary : tuple of str
        Names of the variables that qualify this one, where they are present.
    flags : dict of str to int
        Meaning to value, or to mask where ``is_mask``.
    bounds : str
        Name of the variable with the edges of the cells.
    """

    name: str
    dims: tuple[str, ...]
    dtype: str
    no_uncertainty: str = ""
    ancillary: tuple[str, ...] = ()
    flags: dict[str, int] = field(default_factory=dict)
    is_mask: bool = False
    bounds: str = ""

    def __post_init__(self) -> None:
        """Refuse a name that the vocabulary lacks."""
        if self._base not in QUANTITIES:
            raise ArchiveError(
                f"'{self.name}' has no row in the vocabulary",
                needed="a quantity of reduction.vocabulary",
                hint="Add its row there, with unit and meaning.",
            )

    @property
    def _suffix(self) -> str:
        if self.name in QUANTITIES:
            return ""
        return next((suffix for suffix in SUFFIXES if self.name.endswith(suffix)), "")

    @property
    def _base(self) -> str:
        return self.name.removesuffix(self._suffix)

    @property
    def is_text(self) -> bool:
        """True for labels."""
        return self.dtype == TEXT

    @property
    def is_bounds(self) -> bool:
        """True for the edges of cells, which take their attributes from the centres."""
        return "bound" in self.dims

    @property
    def has_uncertainty(self) -> bool:
        """True where a standard uncertainty belongs to the variable."""
        return f"{self.name}_standard_uncertainty" in self.ancillary

    @property
    def unit(self) -> str:
        """CF unit; empty for labels."""
        return "1" if self._suffix == "_count" else QUANTITIES[self._base].unit

    @property
    def long_name(self) -> str:
        """What it means, in words."""
        words = QUANTITIES[self._base].long_name
        return SUFFIXES[self._suffix][0].format(words) if self._suffix else words

    @property
    def standard_name(self) -> str | None:
        """CF standard name, where the table has one."""
        return None if self._suffix else QUANTITIES[self._base].standard_name


def measured(
    name: str,
    dims: tuple[str, ...],
    *suffixes: str,
    uncertainty_dims: tuple[str, ...] | None = None,
    ancillary: tuple[str, ...] = (),
) -> list[Variable]:
    """Return a real with its standard uncertainty and other companions."""
    companions = ["_standard_uncertainty", *suffixes]
    rows = [
        Variable(
            name,
            dims,
            "f8",
            ancillary=(*(f"{name}{suffix}" for suffix in companions), *ancillary),
        )
    ]
    for suffix in companions:
        own_dims = dims
        if suffix == "_standard_uncertainty" and uncertainty_dims is not None:
            own_dims = uncertainty_dims
        rows.append(companion(name, suffix, own_dims))
    return rows


def companion(name: str, suffix: str, dims: tuple[str, ...]) -> Variable:
    """Return what qualifies a quantity: one of `SUFFIXES`."""
    return Variable(f"{name}{suffix}", dims, SUFFIXES[suffix][1], SUFFIXES[suffix][2])


def stated(
    name: str,
    dims: tuple[str, ...],
    no_uncertainty: str,
    *,
    ancillary: tuple[str, ...] = (),
    bounds: str = "",
) -> list[Variable]:
    """Return a real without a standard uncertainty, and the reason."""
    return [Variable(name, dims, "f8", no_uncertainty, ancillary=ancillary, bounds=bounds)]


def count(name: str, dims: tuple[str, ...]) -> list[Variable]:
    """Return a number that is counted."""
    return [Variable(name, dims, "i4", "count")]


def label(name: str, dims: tuple[str, ...] = ()) -> list[Variable]:
    """Return a text."""
    return [Variable(name, dims, TEXT, "label")]


def flag(name: str, dims: tuple[str, ...], values: dict[str, int]) -> list[Variable]:
    """Return a flag with one meaning a value."""
    return [Variable(name, dims, "i1", "flag", flags=values)]


def mask(name: str, dims: tuple[str, ...], masks: dict[str, int]) -> list[Variable]:
    """Return a flag in which each bit has a meaning."""
    return [Variable(name, dims, "u2", "flag", flags=masks, is_mask=True)]
