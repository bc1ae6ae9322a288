"""One reduced test in the form needed by the page, with expanded uncertainty.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty
   in measurement," 6.2, 7.2.3 (an expanded uncertainty is given with its coverage factor), G.4.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from reduction.archive.open import in_memory
from reduction.archive.shared_errors import FREEDOM, stated_errors_of
from reduction.archive.test_dataset import stored_cycles
from reduction.archive.uncertainty_budget import effective_freedom
from reduction.archive.variables import at_places, read_notes, stored
from reduction.quantities.flags import LINE_METHODS
from reduction.quantities.row import COMPONENT
from reduction.quantities.units import UnitSystem
from reduction.record.contributions import (
    FROM_READINGS,
    StatedErrors,
    coverage_factor,
    effective_degrees_of_freedom,
)
from reduction.record.measurement import Floats, Integers
from reduction.record.notes import Note
from reduction.report.text_style import (
    PageTable,
    Shown,
    in_order,
    make_table,
    number,
    shown,
    source_words,
    words,
)

OF_NO_TEST = "of_no_test"
"""Status of an archive without a row in status.csv: the campaign no longer has such a test."""

_OF_SECTION = (
    "_by_cycle", "_untrimmed", "elastomer_", "prony_", "modulus_ratio_uncertainty",
    "segment_tension_low_", "segment_tension_high_", "standstill_", "mark_", "splice_",
    "stretched_diameter", "crosshead_position_", "nominal_stress_", "closed_loop_energy",
    "storage_spring_constant", "loss_spring_constant", "slope_reading_spread",
    "mean_identity_residual", "segment_misfit", "segment_criterion",
    "tangent_modulus_scatter", "strain_coefficient_correlation", "alignment_strain", "area_",
    "channel_lag", "coefficient_name", "cycles_counted_by", "declared_gauge_length", "diameter_",
    "dynamic_modulus_per_decade", "earlier_maximum_tension", "earlier_tests", "hold_logged_",
    "long_time_tension", "mean_strain_drift", "mean_strain_per_decade",
    "modulus_ratio_degrees_of_freedom", "modulus_ratio_random", "modulus_ratio_standard",
    "n_flagged", "peak_tension_change", "peak_tension_per_decade", "permanent_set",
    "position_band", "quality_mask", "relaxed_", "slack_", "strain_bin_bounds", "strain_level",
    "strain_marks_from", "strain_position_", "strain_slope_ratio", "strain_tension_",
    "strain_window", "stress_at_strain",
)  # fmt: skip
"""Parts of the names of quantities that figures and tables over several tests do not use."""

_OF_CYCLES = ("first_loading", "branch_tension")
"""The same for tests with cycles; for a pull these quantities are the answer."""

_OF_HOLDS = (
    "_at_time", "hold_criterion", "hold_final_tension", "hold_kind", "hold_ramp_",
    "hold_start_time",
)  # fmt: skip
"""The same for specimens that are not ropes, whose holds have separate figures."""

_ATTRIBUTES_OF_SECTION = ("raw_metadata", "history")
"""Long texts that only the section of a test shows, folded."""

_REACHED = (
    "apparent_spring_constant",  # needed to see whether it had settled
    "mean_tension", "tension_amplitude", "mean_strain", "strain_amplitude",
)  # fmt: skip


_ROPES = frozenset({"rope", "wire"})


@dataclass(frozen=True)
class Status:
    """One row of status.csv."""

    test: str
    status: str
    message: str = ""
    raw_sha256: str = ""


class ArchiveView:
    """Part of an archive on the page."""

    data: xr.Dataset

    def attribute(self, name: str) -> str:
        """Global attribute as text; empty where there is none."""
        return str(self.data.attrs.get(name, ""))

    @property
    def is_synthetic(self) -> bool:
        """True where no specimen was ever pulled."""
        return self.attribute("synthetic").lower() == "yes"


@dataclass(frozen=True)
class TestView(ArchiveView):
    """One test on the page; a variable that the archive lacks is None.

    Parameters
    ----------
    key : str
        Prefix of every anchor of the test; made by the page, not from a name.
    data : xarray.Dataset
        The archive, strings decoded.
    units : UnitSystem
        Display units.
    status : Status or None
        Row of status.csv, where there is one.
    """

    __test__ = False  # a test of a tether, not of this software

    key: str
    data: xr.Dataset
    units: UnitSystem = "si"
    status: Status | None = None

    @property
    def id(self) -> str:
        """Name of the test."""
        return self.attribute("test")

    @property
    def is_of_earlier_run(self) -> bool:
        """True where the last run of the campaign neither made nor kept this archive."""
        return self.status is not None and self.status.status in ("failed", OF_NO_TEST)

    @property
    def kind(self) -> str:
        """Kind of the test: cyclic, fatigue, relaxation, stepwise, ..."""
        return self.attribute("test_kind")

    @property
    def is_stepwise(self) -> bool:
        """True for weights hung one after another; there is no record then."""
        return "step" in self.data.sizes

    @cached_property
    def specimens(self) -> tuple[str, ...]:
        """Names of the specimens."""
        return self.texts("specimen")

    @property
    def is_rope(self) -> bool:
        """True where every specimen is a rope or a wire."""
        kinds = self.texts("specimen_kind")
        return bool(kinds) and set(kinds) <= _ROPES

    @property
    def has_rope(self) -> bool:
        """True where any specimen is a rope or a wire."""
        return not _ROPES.isdisjoint(self.texts("specimen_kind"))

    @property
    def is_hose(self) -> bool:
        """True where every specimen is a hose."""
        return set(self.texts("specimen_kind")) == {"stretch hose"}

    @property
    def is_rubber(self) -> bool:
        """False where cords, fibres or wires carry the load in every specimen."""
        kinds = self.texts("specimen_kind")
        return not kinds or not set(kinds) <= {"rope", "wire", "stretch hose"}

    @property
    def n_cycles(self) -> int:
        """Number of whole cycles."""
        return int(self.data.sizes.get("cycle", 0))

    @property
    def start_time(self) -> float:
        """First time of the record in seconds; infinite where there is none."""
        time = self.array("time")
        known = np.zeros(0) if time is None else time[np.isfinite(time)]
        return float(known[0]) if known.size else float("inf")

    @property
    def is_whole(self) -> bool:
        """False where only samples of some cycles are stored."""
        return "sample_index" not in self.data

    @property
    def pieces(self) -> Integers:
        """Piece of the record of each stored sample; between two pieces cycles are left out."""
        index, first = self.array("sample_index"), self.array("cycle_first_sample")
        last = self.array("cycle_last_sample")
        if index is None or first is None or last is None:
            return np.zeros(int(self.data.sizes.get("sample", 0)), dtype=np.int64)
        # cycles from one sample to the next: neighbours share the sample at the turn
        begun = np.searchsorted(first, index[:-1], side="left")
        ended = np.searchsorted(last, index[1:], side="right")
        return np.concatenate([[0], np.cumsum(ended > begun)])

    def stored_near(self, cycles: Floats) -> Floats:
        """Numbers of cycles, each once; where only some have samples, the nearest of these."""
        stored = np.zeros(0) if self.is_whole else stored_cycles(self.data)
        if not stored.size:
            return np.unique(cycles)
        return np.unique(stored[np.abs(stored[:, None] - cycles).argmin(axis=0)])

    def array(self, name: str) -> Floats | None:
        """Values of a variable; missing flags and counts keep their code numbers."""
        if name not in self.data:
            return None
        return np.asarray(self.data.variables[name].values, dtype=np.float64)

    def array_like(self, name: str, other: Floats) -> Floats:
        """Values of a variable, or NaN in the shape of another."""
        found = self.array(name)
        return np.full(other.shape, np.nan) if found is None else found

    def scalar(self, name: str) -> float:
        """Value of a variable without dimensions; NaN where there is none."""
        found = self.array(name)
        return float("nan") if found is None else float(found)

    def texts(self, name: str) -> tuple[str, ...]:
        """Values of a text variable; empty where there is none."""
        if name not in self.data:
            return ()
        return tuple(str(value) for value in np.ravel(self.data.variables[name].values))

    @cached_property
    def notes(self) -> tuple[Note, ...]:
        """Notes for the reader, most serious first."""
        return read_notes(self.data)

    @property
    def hold_numbers(self) -> tuple[int, ...]:
        """Number of each hold in time, from 1: specimens held at the same time share one."""
        number = self.array("hold_number")
        return () if number is None else tuple(int(value) for value in number)

    def text(self, name: str) -> str:
        """Value of a text variable without dimensions."""
        return " ".join(self.texts(name))

    def flag_meanings(self, name: str) -> dict[str, int]:
        """Meaning to mask or value of a flag variable, as the archive declares them."""
        attributes = self.data.variables[name].attrs
        numbers = attributes.get("flag_masks", attributes.get("flag_values", ()))
        words = str(attributes.get("flag_meanings", "")).split()
        return {word: int(number) for word, number in zip(words, np.ravel(numbers), strict=True)}

    def without_samples(self) -> TestView:
        """Return the same test without its record, all in memory, for campaign figures."""
        single = self.data.data_vars
        left_out = [
            name
            for name, variable in self.data.variables.items()
            if "sample" in variable.dims
            or ("cycle" in variable.dims and name in single and name not in _REACHED)
        ]
        return replace(self, data=in_memory(self.data.drop_vars(left_out)))

    def of_campaign(self, known: dict[str, str]) -> TestView:
        """Return the same test without most of the numbers that only its own section shows.

        Texts that earlier tests have, which ``known`` contains, are not stored again.
        """
        left_out = _OF_SECTION + (_OF_CYCLES if self.n_cycles else ())
        left_out += () if self.has_rope else _OF_HOLDS
        # the table of rests between cycles of a tether is in its section
        has_holds = self.has_rope or not self.n_cycles
        own = [
            name
            for name, variable in self.data.variables.items()
            # values of a whole test may be those of a run of an experiment
            if (not str(name).startswith("test_") and any(one in str(name) for one in left_out))
            or (not has_holds and "hold" in variable.dims)
        ]
        return replace(self, data=_shared(_one_row_a_source(self.data.drop_vars(own)), known))

    def at_cycles(self, name: str, places: Integers) -> TestView:
        """Return a quantity at some cycles, counted from 0, with the basis of its uncertainty."""
        own = {
            key: at_places(variable, "cycle", places)
            for key, variable in self.data.variables.items()
            if str(key).startswith(name) or key == FREEDOM
        }
        return replace(self, data=xr.Dataset(own))


def _one_row_a_source(data: xr.Dataset) -> xr.Dataset:
    """Return an archive with the independent errors of one source and item combined, unsigned.

    They take most of the memory of a test, and tables over several tests form no differences.
    """
    if COMPONENT not in data.sizes:
        return data
    source, of = (data.variables[f"uncertainty_source{end}"].values for end in ("", "_of"))
    freedom = stored(data, FREEDOM)
    # errors known from few readings count separately in the degrees of freedom
    is_few = np.isfinite(freedom.values) if freedom is not None else np.zeros(len(of), dtype=bool)
    is_next = (source[1:] != source[:-1]) | (of[1:] != of[:-1]) | is_few[1:] | is_few[:-1]
    first = np.flatnonzero(np.concatenate([[True], is_next]))
    is_sum = np.diff([*first, len(source)]) > 1
    found = {name: at_places(one, COMPONENT, first) for name, one in data.variables.items()}
    for name, variable in data.variables.items():
        if variable.dims[:1] == (COMPONENT,) and str(name).endswith("_uncertainty_contribution"):
            sums = np.sqrt(np.add.reduceat(variable.values**2, first))
            found[name].values[is_sum] = sums[is_sum]
    return xr.Dataset(found, attrs=data.attrs)


def _shared(data: xr.Dataset, known: dict[str, str]) -> xr.Dataset:
    """Return an archive that uses the texts of ``known`` where another test had them before.

    Only attributes that pages read are kept.
    """
    found = {}
    for name, variable in data.variables.items():
        values = variable.values
        if values.dtype.kind == "O":
            texts = [known.setdefault(text, text) for text in values.ravel()]
            values = np.array(texts, dtype=object).reshape(values.shape)
        attributes = {
            key: known.setdefault(value, value) if isinstance(value, str) else value
            for key, value in variable.attrs.items()
            if key == "units" or str(key).startswith("flag_")
        }
        # a pandas index is used as it is; for an array xarray asks Dask
        found[name] = (
            xr.IndexVariable(variable.dims, pd.Index(values, dtype=values.dtype), attributes)
            if name in data.dims
            else xr.Variable(variable.dims, values, attributes or None, fastpath=True)
        )
    about = {
        name: known.setdefault(one, one)
        for name, one in data.attrs.items()
        if name not in _ATTRIBUTES_OF_SECTION
    }
    return xr.Dataset(found, attrs=about)


def all_specimens(tests: Sequence[TestView]) -> list[str]:
    """Return the specimens of several tests, each once, in order of first appearance."""
    return list(dict.fromkeys(name for view in tests for name in view.specimens))


def any_synthetic(tests: Sequence[TestView]) -> bool:
    """Return whether a figure or table of these tests has to be marked as synthetic."""
    return any(view.is_synthetic for view in tests)


NOTHING_STATED = (
    "No instrument errors are stated: the uncertainty includes only scatter and tape readings."
)

_PERCENT = Shown("%", 100.0)


def instrument_table(tests: Sequence[TestView], units: UnitSystem) -> PageTable | None:
    """Return the stated instrument errors, a column for each statement; None without any."""
    statements: dict[StatedErrors, list[TestView]] = {}
    for view in tests:
        if _is_stated(view):
            statements.setdefault(stated_errors_of(view.data), []).append(view)
    if not statements:
        return None
    rows = [
        [words(unit.label(text)),
         *(number(getattr(one, key), unit, digits=3) for one in statements)]
        for key, text, unit in _rows(units)
        if any(getattr(one, key) for one in statements)
    ]  # fmt: skip
    is_one = len(statements) == 1 and len(next(iter(statements.values()))) == len(tests)
    columns = (
        ["standard uncertainty"]
        if is_one
        else [", ".join(view.id for view in views) for views in statements.values()]
    )
    without = [view.id for view in tests if not _is_stated(view)]
    has_one_cell = any(one.has_one_load_cell for one in statements)
    remarks = [
        "Standard uncertainties (k = 1) from campaign.toml; anything without a row is treated as"
        " exact, except tape readings and friction in the splices, which have default values.",
        *(["All tension channels share one load cell."] if has_one_cell else []),
        *([f"Nothing is stated for {', '.join(without)}."] if without else []),
    ]
    return make_table(
        "Stated instrument errors.", ("error", *columns), rows,
        remarks=remarks,
    )  # fmt: skip


def instrument_sentences(tests: Sequence[TestView]) -> list[str]:
    """Return the sentence that nothing is stated, where that holds for all tests."""
    return [NOTHING_STATED] if tests and not any(_is_stated(view) for view in tests) else []


def _is_stated(view: TestView) -> bool:
    """Return whether the archive states any error of the instruments."""
    return stated_errors_of(view.data).has_any


def _rows(units: UnitSystem) -> tuple[tuple[str, str, Shown], ...]:
    force = shown("tension", units)
    small, time = shown("small length", units), Shown("ms", 1e3)
    return (
        ("tension_gain", "gain of tension", _PERCENT),
        ("tension_offset", "zero of tension", force),
        ("tension_reversibility", "reversibility of tension", _PERCENT),
        ("tension_reading", "one reading of tension", force),
        ("position_gain", "gain of position", _PERCENT),
        ("position_offset", "zero of position", small),
        ("position_reading", "one reading of position", small),
        ("lag", "lag between the channels", time),
        ("diameter", "mean diameter", small),
        ("area", "area before stretch, where no diameter is stated", _PERCENT),
        ("strain_gain", "strain, by its method", _PERCENT),
        ("rated_break_strength", "rated break strength", _PERCENT),
        ("stiffness", "stiffness, from test temperature", _PERCENT),
        ("attached_mass", "mass attached to a moving load cell", Shown("kg", 1.0)),
        ("linear_density", "mass per length of the specimens", Shown("kg/m", 1.0)),
        ("machine_compliance", "compliance of frame, load cell and grips", Shown("m/N", 1.0)),
    )


DRAWN = (
    "In brackets: 95 % interval by Monte Carlo, where the same errors are too large to propagate"
    " linearly."
)

MANY = np.inf
"""Degrees of freedom of a regression on hundreds of samples, and of values taken as known."""

_CYCLES = "scatter between cycles, noise, regression"

_INSTRUMENTS = "errors of the instruments"


@dataclass(frozen=True)
class Expanded:
    """Expanded uncertainty of several numbers and the factor of each; arrays of one shape."""

    half: Floats
    factor: Floats

    @property
    def factors(self) -> tuple[float, ...]:
        """Factors of the values that have an uncertainty."""
        return tuple(np.unique(self.factor[np.isfinite(self.half)]).tolist())


def expand(
    standard_uncertainty: ArrayLike,
    *,
    random: ArrayLike | None = None,
    degrees_of_freedom: ArrayLike = MANY,
) -> Expanded:
    """Return the expanded uncertainty for 95 %.

    Examples
    --------
    The scatter of ten cycles alone, and together with a shared part of twice its size:

    >>> found = expand([1.0, np.sqrt(5)], random=[1.0, 1.0], degrees_of_freedom=9.0)
    >>> print(found.half.round(1), found.factor.round(2))
    [2.3 4.4] [2.26 1.97]
    """
    spread = np.asarray(standard_uncertainty, dtype=np.float64)
    part = spread if random is None else np.asarray(random, dtype=np.float64)
    rest = np.sqrt(np.maximum(spread**2 - part**2, 0.0))
    effective = effective_degrees_of_freedom(part, degrees_of_freedom, contribution=rest[None])
    factor = np.asarray(coverage_factor(effective))
    return Expanded(factor * spread, factor)


NORMAL = float(expand(1.0).factor)
"""Coverage factor of values taken as known, or found from hundreds of samples. [1]"""


def expanded_of(view: TestView, name: str, values: Floats) -> Expanded:
    """Return the expanded uncertainty of a quantity in an archive, in the shape of its values."""
    spread = view.array_like(f"{name}_standard_uncertainty", values)
    if name not in view.data:
        return expand(spread)
    return expand(spread, degrees_of_freedom=effective_freedom(view.data, name))


def drawn_interval(view: TestView, name: str, place: int) -> tuple[float, float] | None:
    """Return the 95 % interval of a line parameter where it was found by Monte Carlo."""
    method = view.array("test_line_uncertainty_method")
    low, high = view.array(f"{name}_low"), view.array(f"{name}_high")
    if method is None or low is None or high is None:
        return None
    if method[place] != LINE_METHODS["monte_carlo"] or not np.isfinite(high[place] - low[place]):
        return None
    return float(low[place]), float(high[place])


def shared_sources(views: Sequence[TestView], names: Sequence[str]) -> list[str]:
    """Return the sources of shared errors that affect any of some quantities, in fixed order."""
    found: set[str] = set()
    for view in views:
        sources = view.texts("uncertainty_source")
        for name in names:
            rows = view.array(f"{name}_uncertainty_contribution")
            if rows is not None:
                reached = (np.nan_to_num(rows) != 0).reshape(len(sources), -1).any(axis=1)
                found |= {one for one, is_in in zip(sources, reached, strict=True) if is_in}
    return in_order(found)


def factor_words(factors: Iterable[float]) -> str:
    """Return the coverage factors of several numbers as text.

    Examples
    --------
    >>> factor_words([2.2622, 1.9745, np.nan]), factor_words([1.96])
    ('k = 1.97 to 2.26', 'k = 1.96')
    """
    known = [f"{one:.2f}" for one in sorted(factors) if np.isfinite(one)]
    ends = list(dict.fromkeys([known[0], known[-1]])) if known else []
    return f"k = {' to '.join(ends)}" if ends else ""


def plus_minus(
    factors: Iterable[float],
    found_from: str = _CYCLES,
    *,
    left_out: str = _INSTRUMENTS,
    mark: str = "±",
) -> str:
    """Return a sentence on the sources that an uncertainty includes and those that it leaves out.

    Examples
    --------
    >>> plus_minus([2.26], "tape readings", left_out="position scale")
    '±: expanded uncertainty, 95 % (k = 2.26): tape readings. Not included: position scale.'
    """
    factor = factor_words(factors)
    head = f"{mark}: expanded uncertainty, 95 %{f' ({factor})' if factor else ''}"
    tail = f" Not included: {left_out}." if left_out else ""
    return f"{head}: {found_from}.{tail}"


def plus_minus_of_tests(
    factors: Iterable[float],
    views: Sequence[TestView],
    names: Sequence[str],
    *,
    found_from: str = _CYCLES,
    mark: str = "±",
) -> str:
    """Return the sentence for quantities of tests, including shared errors."""
    shared = shared_sources(views, names)
    held = found_from
    if shared:
        held += (
            f"; and errors common to all samples: {', '.join(source_words(one) for one in shared)}"
        )
    said = plus_minus(factors, held, left_out="", mark=mark)
    if set(shared) - FROM_READINGS:
        return said
    if not any(_is_stated(view) for view in views):
        nothing = NOTHING_STATED if shared else NOTHING_STATED.replace(" and tape readings", "")
        return f"{said} {nothing}"
    if any(f"{name}_uncertainty_contribution" in view.data for view in views for name in names):
        return f"{said} No stated instrument error affects it."
    return f"{said} Not included: {_INSTRUMENTS}."


@dataclass(frozen=True)
class RowView(ArchiveView):
    """One item on the page: a hose, a comparison, an experiment.

    Parameters
    ----------
    key : str
        Prefix of every anchor; made by the page, not from a name.
    data : xarray.Dataset
        The archive, in memory, strings decoded.
    index : int
        Row in the archive.
    units : UnitSystem
        Display units.
    """

    KIND: ClassVar[str]
    """Dimension of the rows, and the variable with their names."""

    ENDS_AT: ClassVar[Mapping[str, str]] = {}
    """For each dimension shared by the rows, the variable whose last known value ends a row."""

    key: str
    data: xr.Dataset
    index: int
    units: UnitSystem = "si"

    @classmethod
    def rows_of(cls, archive: xr.Dataset, units: UnitSystem) -> list[Self]:
        """Every row of an archive, which may then be closed."""
        data = in_memory(archive)
        return [cls(f"{cls.KIND}-{k}", data, k, units) for k in range(data.sizes[cls.KIND])]

    @property
    def name(self) -> str:
        """Name of the row."""
        return self.text(self.KIND)

    @cached_property
    def notes(self) -> tuple[Note, ...]:
        """Notes on the row."""
        return read_notes(self.data, of=(f"note_{self.KIND}", self.name))

    @cached_property
    def sizes(self) -> dict[str, int]:
        """Length for this row of the dimensions that rows share."""
        found = {}
        for dim, name in self.ENDS_AT.items():
            if name in self.data:
                values = self.data.variables[name].values[self.index]
                is_own = np.isfinite(values) if values.dtype.kind == "f" else values.astype(object)
                found[dim] = int(np.count_nonzero(is_own.astype(bool)))
        return found

    def array(self, name: str) -> Floats:
        """Values of a variable of this row; empty where missing."""
        if name not in self.data:
            return np.full(0, np.nan)
        return np.asarray(self._own(name), dtype=np.float64)

    def texts(self, name: str) -> tuple[str, ...]:
        """Values of a text variable of this row; none where missing."""
        return tuple(map(str, np.ravel(self._own(name)))) if name in self.data else ()

    def _own(self, name: str) -> NDArray[Any]:
        """Values of a variable of this row, without the padding for longer rows."""
        variable = self.data.variables[name]
        cut = tuple(slice(self.sizes.get(str(dim))) for dim in variable.dims[1:])
        return np.asarray(variable.values[self.index][cut] if cut else variable.values[self.index])

    def array_like(self, name: str, other: Floats) -> Floats:
        """Values of a variable, or NaN in the shape of another."""
        found = self.array(name)
        return found if found.shape == other.shape else np.full(other.shape, np.nan)

    def scalar(self, name: str) -> float:
        """A number of this row; NaN where missing."""
        found = self.array(name)
        return float(found) if found.ndim == 0 else float("nan")

    def text(self, name: str) -> str:
        """Value of a text variable without further dimensions; "" where missing."""
        return str(self.data.variables[name].values[self.index]) if name in self.data else ""
