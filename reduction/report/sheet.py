"""Tables of the page: columns by the name of a variable, values with their uncertainty.

Rows follow dimensions of the archive.  The unit is determined by the variable and the units of the
page, ± by ``<name>_standard_uncertainty``.  Values without an archive are given as arrays.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol, Self

import numpy as np
import xarray as xr

from reduction.quantities.names import ON_PAGE, QUANTITIES
from reduction.quantities.units import UnitSystem
from reduction.record.measurement import Bools, Integers
from reduction.report import text_style as htmltable
from reduction.report.test_view import (
    Expanded,
    RowView,
    TestView,
    expand,
    expanded_of,
    plus_minus_of_tests,
)
from reduction.report.text_style import (
    NOT_GIVEN,
    PERCENT,
    Kind,
    PageTable,
    Shown,
    TableCell,
    factors_of,
    make_table,
    shown,
    shown_unit,
    words,
)

Unit = Kind | Shown | None

Source = str | Iterable[Any]
"""Name of a variable, or the values of the rows."""


class _Shows(Protocol):
    """Subject of a table: any object with units."""

    @property
    def units(self) -> UnitSystem:
        """Display units."""


class Calculated(NamedTuple):
    """Subject for calculated values without an archive."""

    units: UnitSystem
    data: xr.Dataset = xr.Dataset()


@dataclass
class Sheet:
    """Rows of a table, one for each combination of entries of ``dims``; columns are added to it.

    ``where`` names a variable that has to be finite in a row.  A variable without one of the
    dimensions is constant along it.

    Examples
    --------
    >>> data = xr.Dataset({"peak_tension": ("cycle", [99.6, 101.2])}, {"cycle": [1, 2]})
    >>> sheet = Sheet(TestView("T", data), ("cycle",))
    >>> found = sheet.counts("cycle", "cycle").numbers("peak", "peak_tension").table("Peaks.")
    >>> found.columns, [[cell.text for cell in row] for row in found.rows]
    (('cycle', 'peak [N]'), [['1', '99.60'], ['2', '101.2']])
    """

    view: _Shows
    dims: Sequence[str] = ()
    where: str = ""
    headings: list[str] = field(default_factory=list)
    columns: list[list[TableCell]] = field(default_factory=list)
    known: list[str] = field(default_factory=list)
    """Variables shown in the table with their uncertainty."""
    places: dict[str, Integers] = field(init=False)
    views: list[Any] = field(init=False)

    def __post_init__(self) -> None:
        self.views = [self.view]
        own = self.view.sizes if isinstance(self.view, RowView) else {}
        sizes: dict[str, int] = {**{str(dim): n for dim, n in self.data.sizes.items()}, **own}
        shape = [sizes.get(dim, 0) for dim in self.dims]
        grid = np.indices(shape).reshape(len(shape), -1) if shape else np.zeros((0, 1), int)
        self.places = dict(zip(self.dims, grid, strict=True))
        if isinstance(self.view, RowView):
            row = str(next(iter(self.data.sizes)))
            self.places[row] = np.full(grid.shape[1:], self.view.index)
        if self.where:
            self.keep(np.isfinite(self.of(self.where)))

    @classmethod
    def stack(cls, sheets: Iterable[Sheet]) -> Sheet:
        """Return the rows of several sheets with equal columns, one below the other."""
        all_of = list(sheets)
        if not all_of:
            return cls(Calculated("si"))
        found = all_of[0]
        found.views = [one.view for one in all_of]
        found.columns = [
            [cell for column in same for cell in column]
            for same in zip(*(one.columns for one in all_of), strict=True)
        ]
        return found

    @property
    def data(self) -> xr.Dataset:
        """The archive; an empty one for calculated values."""
        found = getattr(self.view, "data", None)
        return found if isinstance(found, xr.Dataset) else xr.Dataset()

    @property
    def n_rows(self) -> int:
        """Number of rows, not counting those of further sheets."""
        return len(next(iter(self.places.values()), ()))

    def keep(self, which: Bools | Integers) -> Self:
        """Select or reorder rows; to be called before columns are added."""
        self.places = {dim: at[which] for dim, at in self.places.items()}
        return self

    def at(self, dim: str, place: int) -> Self:
        """Take the following columns at one place of a dimension that the rows do not follow."""
        self.places[dim] = np.full(self.n_rows, place)
        return self

    def of(self, name: str, otherwise: Any = np.nan) -> Any:
        """Values of a variable in the order of the rows."""
        if not self.n_rows or name not in self.data:
            return np.full(self.n_rows, otherwise)
        return self._at_rows(name, self.data.variables[name].values)

    def _at_rows(self, name: str, values: Any) -> Any:
        dims = self.data.variables[name].dims
        return values[tuple(self.places[str(dim)] for dim in dims)]

    def expanded(self, name: str) -> Expanded:
        """Expanded uncertainty of a variable in the order of the rows."""
        if not isinstance(self.view, TestView) or name not in self.data or not self.n_rows:
            return expand(self.of(f"{name}_standard_uncertainty"))
        found = expanded_of(self.view, name, self.data.variables[name].values)
        return Expanded(self._at_rows(name, found.half), self._at_rows(name, found.factor))

    def cells(self, heading: str, cells: Iterable[TableCell]) -> Self:
        """Add a column of given cells."""
        self.headings.append(heading)
        self.columns.append(list(cells))
        return self

    def row(self, *cells: TableCell) -> Self:
        """Add a row at the end, with one cell for each column."""
        for column, cell in zip(self.columns, cells, strict=True):
            column.append(cell)
        return self

    def texts(self, heading: str, source: Source) -> Self:
        """Add a column of words."""
        found = self.of(source, otherwise="") if isinstance(source, str) else source
        return self.cells(heading, (words(str(text)) for text in found))

    def counts(self, heading: str, source: Source) -> Self:
        """Add a column of counts."""
        return self._each(heading, htmltable.count, source)

    def probabilities(self, heading: str, source: Source) -> Self:
        """Add a column of probabilities."""
        return self._each(heading, htmltable.probability, source)

    def f_values(self, heading: str, source: Source) -> Self:
        """Add a column of F, ratios of variances."""
        return self._each(heading, htmltable.f_value, source)

    def numbers(self, heading: str, source: Source, unit: Unit = None, digits: int = 4) -> Self:
        """Add a column of numbers to so many digits."""
        own = self.unit_of(source, unit)
        return self._each(
            heading, lambda value: htmltable.number(value, own, digits=digits), source, own
        )

    def measured(
        self,
        heading: str,
        source: Source,
        unit: Unit = None,
        spread: Expanded | None = None,
        *,
        is_short: bool = False,
    ) -> Self:
        """Add a column of numbers with their expanded uncertainty."""
        own = self.unit_of(source, unit)
        if isinstance(source, str):
            self.known.append(source)
            spread = self.expanded(source) if spread is None else spread
        values = self._values(source)
        both = (np.nan, np.nan) if spread is None else (spread.half, spread.factor)
        halves, factors = (np.broadcast_to(np.asarray(one), len(values)) for one in both)
        return self.cells(
            _label(heading, own),
            (
                htmltable.measured(
                    float(value), float(half), own, factor=float(factor), is_short=is_short
                )
                for value, half, factor in zip(values, halves, factors, strict=True)
            ),
        )

    def spans(
        self, heading: str, low: Source, high: Source, unit: Unit = None, *, places: int = 0
    ) -> Self:
        """Add a column of ranges, both ends to so many decimal places or more."""
        own = self.unit_of(low, unit) or Shown("1", 1.0)
        pairs = zip(self._values(low), self._values(high), strict=True)
        return self.cells(
            own.label(heading),
            (htmltable.span(a, b, own, places=places) for a, b in pairs),
        )

    def intervals(
        self, heading: str, low: Source, high: Source, unit: Unit = None, digits: int = 3
    ) -> Self:
        """Add a column of ranges, each end to so many digits; empty where neither is known."""
        own = self.unit_of(low, unit)
        pairs = zip(self._values(low), self._values(high), strict=True)
        return self.cells(
            _label(heading, own),
            (htmltable.interval(float(a), float(b), own, digits=digits) for a, b in pairs),
        )

    def all_of(self, *columns: tuple[str, str] | tuple[str, str, Unit]) -> Self:
        """Add columns of numbers with their uncertainty where known."""
        for heading, name, *unit in columns:
            self.measured(heading, name, *unit)  # type: ignore[arg-type]
        return self

    def shown(self, page: str) -> Self:
        """Add the columns that `reduction.quantities` assigns to a table of the page."""
        return self.all_of(
            *(
                (row.page[1], row.name, PERCENT if row.percent else None)
                for row in ON_PAGE[page]
                if row.name in self.data
            )
        )

    def table(
        self,
        caption: str,
        *,
        remarks: Sequence[str] = (),
        tall: float = np.inf,
        optional: Container[str] = (),
        is_compact: bool = False,
        is_tall: bool = False,
    ) -> PageTable | None:
        """Return the table; None where it has no row."""
        pairs = [
            (heading, column)
            for heading, column in zip(self.headings, self.columns, strict=True)
            if heading not in optional or any(cell.text != NOT_GIVEN for cell in column)
        ]
        rows = list(zip(*(column for _, column in pairs), strict=True))
        if not rows:
            return None
        return make_table(
            caption, [heading for heading, _ in pairs], rows,
            remarks=remarks, is_tall=is_tall or len(rows) > tall, is_compact=is_compact,
        )  # fmt: skip

    def turned(
        self,
        caption: str,
        heads: Iterable[str],
        corner: str = "what, with its unit",
        *,
        remarks: Sequence[str] = (),
        optional: Container[str] = (),
    ) -> PageTable:
        """Return the table with a row for each column; ``heads`` become the column headings."""
        rows = [
            [words(heading), *column]
            for heading, column in zip(self.headings, self.columns, strict=True)
            if heading not in optional or any(cell.text != NOT_GIVEN for cell in column)
        ]
        return make_table(caption, (corner, *heads), rows, remarks=remarks)

    @property
    def is_known(self) -> bool:
        """True where the table contains any number."""
        return any(cell.value for column in self.columns for cell in column)

    @property
    def factors(self) -> list[float]:
        """Coverage factors in the table."""
        return factors_of(self.columns)

    def about(self, **how: Any) -> str:
        """Describe the scope of ± for tests."""
        return plus_minus_of_tests(self.factors, self.views, self.known, **how)

    def _values(self, source: Source) -> Sequence[Any]:
        return self.of(source) if isinstance(source, str) else list(source)

    def _each(
        self,
        heading: str,
        make: Callable[[float], TableCell],
        source: Source,
        unit: Shown | None = None,
    ) -> Self:
        cells = (make(float(value)) for value in self._values(source))
        return self.cells(_label(heading, unit), cells)

    def unit_of(self, source: Source, unit: Unit = None) -> Shown | None:
        """The unit of a column: as given, or that of the variable."""
        if isinstance(unit, Shown):
            return unit
        if unit is not None:
            return shown(unit, self.view.units)
        if not isinstance(source, str):
            return None
        own = self.data.variables[source].attrs.get("units") if source in self.data else None
        return shown_unit(own or QUANTITIES[source].unit, self.view.units)


def _label(heading: str, unit: Shown | None) -> str:
    return heading if unit is None else unit.label(heading)
