"""One row per quantity: its meaning, its place in an archive, and where it is shown.

A quantity is declared once.  Its variable in the archive with uncertainty and other companions, its
columns in CSV tables, its column on the page and its line in the reference all derive from its row.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

TEXT = "U"

COMPONENT = "uncertainty_component"
"""Axis of the errors shared by numbers."""

READING = "a reading; its uncertainty is that of the channel"

CLOCK = "a clock reading"

BOUND = "bound"

COUNT = "count"

SETTING = "setting"

STATED = "stated by the laboratory"

STRENGTH = "as stated; its stated error is in the numbers divided by it"

AXIS = "axis of the curve"

CHECK = "residual of a check"

CRITERION = "criterion of a fit"

STATISTIC = "a test statistic"

SPREAD = "a measure of spread"

OF_UNCERTAINTY = "degrees of freedom"

PART = "part of an uncertainty"

RANDOM_PART = "_random_standard_uncertainty"

CONTRIBUTION = "_uncertainty_contribution"

SUFFIXES = {
    RANDOM_PART: (
        "random part (k=1) of the standard uncertainty of {}",
        "f8",
        "is an uncertainty",
    ),
    CONTRIBUTION: (
        "signed contribution of each shared error (one standard uncertainty) to {}",
        "f8",
        "part of an uncertainty",
    ),
    "_standard_uncertainty": ("standard uncertainty (k=1) of {}", "f8", "is an uncertainty"),
    "_count": ("number of cycles averaged: {}", "i4", "count"),
    "_minimum": ("minimum over the cycles: {}", "f8", "bound: lowest value seen"),
    "_maximum": ("maximum over the cycles: {}", "f8", "bound: highest value seen"),
    "_scatter": ("standard deviation over the cycles: {}", "f8", "a measure of spread"),
}
"""Suffix: its long name, type, and the reason for having no uncertainty."""

GROUPS = {
    "specimens": "specimens: diameter readings and history",
    "record": "rows of the log, channel lag, standstills",
    "splice": "conversion of position to strain: method, coefficients, tape readings",
    "cycles": "single cycles, means over cycles, trends and slips",
    "curves": "tangent modulus of single cycles, and of untrimmed branches",
    "first_loading": "tangent modulus and tension of the first loading",
    "segments": "piecewise-linear moduli",
    "rubber": "stress at stated strains, slack strain, hyperelastic laws",
    "line": "three-parameter line model, and slow pulls",
    "programme": "steps of a rope test programme",
    "holds": "relaxation and creep",
    "comparisons": "comparison of the specimens of the test",
    "coefficients": "coefficients in other units, with significance tests",
    "quality": "goodness of fit of each surface",
    "anova": "analysis of variance",
    "stationary_point": "stationary point and principal directions of each surface",
    "runs": "runs: levels, measured, fitted, residuals",
    "points": "values of the surfaces at points",
    "blocks": "effects of blocks",
    "screening": "effects of a screening experiment, and their aliases",
    "stiffness": "dynamic stiffness in the forms of mooring codes",
    "single_time": "check of a single relaxation time over frequency",
    "design": "hose design: angles, diameters, cords, rubber",
    "cords": "cords: load against strain, angle and spacing along the curve",
    "layers": "non-load-bearing helical layers of the hose",
    "events": "slack, pick-up, working load and break",
    "energy": "energies of the measured and the predicted curve",
    "fill_pressure": "measured and predicted fill pressure",
    "statistics": "statistics behind the verdict",
    "fit": "parameters fitted to the measured curve",
    "uncertainty": "random parts of uncertainties, and contributions of shared errors",
    "notes": "warnings and notes on the results",
}
"""Groups of archives and their contents; the root holds the most used quantities."""

_PARTS = ("_random_standard_uncertainty", "_uncertainty_contribution")


class Quantity(NamedTuple):
    """One quantity, label or flag of an archive or a table.

    It is a tuple because each start makes 6,000, and a frozen data class takes four times as long.

    Parameters
    ----------
    name : str
        Name in code, archives, tables and documents.
    unit : str
        SI unit in CF notation; empty for text.
    long_name : str
        Meaning in words.
    dims : tuple of str
        Dimensions in order; empty for a scalar.
    dtype : str
        ``f8``, ``i4``, ``i1``, ``u2`` or `TEXT`.
    no_uncertainty : str
        Reason for having no standard uncertainty; empty if there is one.
    companions : tuple of str
        Suffixes from `SUFFIXES` stored beside it.
    uncertainty_dims : tuple of str, optional
        Dimensions of the standard uncertainty, if it has fewer.
    uncertainty_is : str
        Description of the standard uncertainty, if the usual words do not fit.
    qualified_by : tuple of str
        Other variables that describe its quality.
    flags : dict of str to int
        Value, or mask if ``is_mask``, by meaning.
    bounds : str
        Name of the variable with the edges of the cells.
    group : str
        Group of the archive; empty for the root.
    tables : tuple of str
        CSV tables with it as a column.
    page : tuple of str
        Table of the page, and its column heading there.
    percent : bool
        Whether it is displayed in percent.
    source : str
        Report and symbol: 000 is WHOI-2004-06, 002 WHOI-2005-10, 003 CG-D-39-80.
    standard_name : str, optional
        CF standard name, if there is one.
    """

    name: str
    unit: str
    long_name: str
    dims: tuple[str, ...] = ()
    dtype: str = "f8"
    no_uncertainty: str = ""
    companions: tuple[str, ...] = ()
    uncertainty_dims: tuple[str, ...] | None = None
    uncertainty_is: str = ""
    qualified_by: tuple[str, ...] = ()
    flags: Mapping[str, int] = MappingProxyType({})
    is_mask: bool = False
    bounds: str = ""
    group: str = ""
    tables: tuple[str, ...] = ()
    page: tuple[str, str] = ("", "")
    percent: bool = False
    source: str = ""
    standard_name: str | None = None

    @property
    def is_text(self) -> bool:
        """Whether it is a label."""
        return self.dtype == TEXT

    @property
    def is_bounds(self) -> bool:
        """Whether it holds cell edges, whose attributes are those of the centres."""
        return "bound" in self.dims

    @property
    def has_uncertainty(self) -> bool:
        """Whether it has a standard uncertainty."""
        return "_standard_uncertainty" in self.companions

    @property
    def shares_errors(self) -> bool:
        """Whether contributions of shared errors are stored beside it."""
        return "_uncertainty_contribution" in self.companions

    @property
    def contribution_dims(self) -> tuple[str, ...]:
        """Dimensions of those contributions, without the error axis."""
        return self.dims if self.uncertainty_dims is None else self.uncertainty_dims

    @property
    def ancillary(self) -> tuple[str, ...]:
        """Names of the variables that qualify it; parts of the uncertainty qualify that instead."""
        own = (one for one in self.companions if one not in _PARTS)
        return (*(f"{self.name}{suffix}" for suffix in own), *self.qualified_by)

    def companion(self, suffix: str) -> Quantity:
        """Return the companion with a suffix."""
        long_name, dtype, why = SUFFIXES[suffix]
        dims = self.dims
        if suffix in ("_standard_uncertainty", *_PARTS):
            dims = self.contribution_dims
        if suffix == "_uncertainty_contribution":
            at = 1 if dims[:1] == ("experiment",) else 0
            dims = (*dims[:at], COMPONENT, *dims[at:])
        is_said = suffix == "_standard_uncertainty" and self.uncertainty_is
        return Quantity(
            f"{self.name}{suffix}",
            "1" if suffix == "_count" else self.unit,
            self.uncertainty_is if is_said else long_name.format(self.long_name),
            dims,
            dtype,
            why,
            group="uncertainty" if suffix in _PARTS else self.group,
        )

    def variables(self) -> Iterator[Quantity]:
        """Yield the quantity and its companions."""
        yield self
        yield from map(self.companion, self.companions)


Rows = Iterable[Quantity]


def along(dims: tuple[str, ...], *rows: Quantity, group: str = "") -> Iterator[Quantity]:
    """Set the dimensions of rows, and their group in the archive."""
    if group and group not in GROUPS:
        raise ValueError(f"there is no group {group!r} in archives")
    return (row._replace(dims=dims, group=group) for row in rows)


def measured(
    name: str,
    unit: str,
    long_name: str,
    *suffixes: str,
    shares_errors: bool = False,
    **more: Any,
) -> Quantity:
    """Return a real quantity with its standard uncertainty and other companions."""
    parts = _PARTS if shares_errors else ()
    companions = ("_standard_uncertainty", *suffixes, *parts)
    return Quantity(name, unit, long_name, companions=companions, **more)


def stated(name: str, unit: str, long_name: str, why: str, **more: Any) -> Quantity:
    """Return a real quantity without a standard uncertainty, with the reason."""
    return Quantity(name, unit, long_name, no_uncertainty=why, **more)


def count(name: str, long_name: str, **more: Any) -> Quantity:
    """Return a count."""
    return Quantity(name, "1", long_name, dtype="i4", no_uncertainty=COUNT, **more)


def label(name: str, long_name: str, **more: Any) -> Quantity:
    """Return a text."""
    return Quantity(name, "", long_name, dtype=TEXT, no_uncertainty="label", **more)


def flag(name: str, long_name: str, values: Mapping[str, int], **more: Any) -> Quantity:
    """Return a flag with one meaning per value."""
    return Quantity(name, "1", long_name, dtype="i1", no_uncertainty="flag", flags=values, **more)


def mask(name: str, long_name: str, masks: Mapping[str, int], **more: Any) -> Quantity:
    """Return a flag with one meaning per bit."""
    return flag(name, long_name, masks, **more)._replace(dtype="u2", is_mask=True)


def again(row: Quantity, why: str = "", *, shares_errors: bool = False, **more: Any) -> Quantity:
    """Return a quantity for use in another product or table."""
    why = why or row.no_uncertainty
    companions = () if why else ("_standard_uncertainty", *(_PARTS if shares_errors else ()))
    own = {"uncertainty_dims": None, "qualified_by": (), "tables": (), "page": ("", "")}
    return row._replace(
        no_uncertainty=why, companions=companions, dims=(), group="", **(own | more)
    )


def schema_from(*rows: Rows) -> dict[str, Quantity]:
    """Return the variables of a product by name, each with its companions."""
    return {one.name: one for some in rows for row in some for one in row.variables()}
