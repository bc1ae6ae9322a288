"""Products of a campaign in the form needed by the page."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.campaign_products import outcomes_of_dataset
from reduction.archive.open import in_memory
from reduction.archive.surfaces_dataset import is_share_of_mean, surface_names, surfaces_of
from reduction.archive.variables import at_places, settings_of, stored
from reduction.experiments.fit_results import ResponseSurfaces
from reduction.experiments.outcome_groups import Group
from reduction.experiments.outcomes import Outcome
from reduction.prediction.comparison_error import EventDifference
from reduction.prediction.hose_geometry import NEUTRAL_ANGLE
from reduction.quantities.names import QUANTITIES, RESPONSES, SCALES
from reduction.quantities.row import COMPONENT
from reduction.quantities.units import UnitSystem, combined_unit, display_unit
from reduction.record.measurement import Floats, Integers
from reduction.report.test_view import ArchiveView, Expanded, RowView, TestView, expand, expanded_of
from reduction.report.text_style import DEGREES, Shown, in_order, shown

EVENT_WORDS = {
    "deepest_slack": "cords slackest",
    "pick_up": "cords pick up",
    "working": "working load",
    "cord_break": "cords break",
}

SOURCE_WORDS = {
    "layer_diameter": "diameters of the cord layers",
    "cord_load_scale": "load of the cord curve",
    "cord_strain_scale": "strain of the cord curve",
    "dead_length_share": "share of dead length",
}
"""Name of a design parameter where its identifier is not self-explanatory."""


@dataclass(frozen=True)
class OneEvent:
    """An event of the cords; SI, NaN where an uncertainty is not known."""

    name: str
    strain: float
    tension: float
    fill_pressure: float
    cord_tension: float
    cord_strain: float
    strain_standard_uncertainty: float
    tension_standard_uncertainty: float
    fill_pressure_standard_uncertainty: float

    @property
    def words(self) -> str:
        """Name for the reader."""
        return EVENT_WORDS.get(self.name, self.name.replace("_", " "))


@dataclass(frozen=True)
class HoseView(RowView):
    """One hose on the page: a row of the archive of predictions."""

    KIND = "hose"

    ENDS_AT: ClassVar[Mapping[str, str]] = {
        "hose_point": "strain",
        "cord_point": "cord_curve_strain",
        "hose_layer": "hose_layer_name",
    }

    @property
    def wrap_angle(self) -> float:
        """Angle of the cords at rest, from the axis. [rad]."""
        return self.scalar("wrap_angle")

    @property
    def is_slack_at_first(self) -> bool:
        """True where the cords have to reach their rest length before they carry."""
        return self.wrap_angle > NEUTRAL_ANGLE

    @cached_property
    def sources(self) -> tuple[str, ...]:
        """Parameters of this hose with a stated uncertainty."""
        if "uncertainty_source" not in self.data:
            return ()
        return tuple(
            name
            for name in self.data.variables["uncertainty_source"].values.astype(str)
            if np.isfinite(self.array(f"{name}_standard_uncertainty")).any()
        )

    def contribution(self, source: str) -> Floats:
        """Change of tension for one standard uncertainty of a source, at each strain. [N]."""
        names = self.data.variables["uncertainty_source"].values.astype(str).tolist()
        return np.asarray(self.array("tension_contribution")[names.index(source)])

    def event_place(self, name: str) -> int:
        """Place of an event in the archive."""
        return int(self.data.variables["hose_event"].values.astype(str).tolist().index(name))

    @cached_property
    def events(self) -> dict[str, OneEvent]:
        """Events of the cords, by name; the slackest point only where there is one."""
        quantities = [name for name in OneEvent.__dataclass_fields__ if name != "name"]
        strain = self.array("event_strain")
        table = [self.array_like(f"event_{name}", strain) for name in quantities]
        found = {
            name: OneEvent(name, *(float(row[place]) for row in table))
            for place, name in enumerate(self.data.variables["hose_event"].values.astype(str))
        }
        if not self.is_slack_at_first:
            found.pop("deepest_slack")
        return found

    @property
    def per_length(self) -> Shown:
        """Display form of a number per length."""
        small = shown("small length", self.units)
        return Shown(f"1/{small.unit}", 1 / small.factor)


ShortVerdict = Literal["agrees", "says little", "differs", "not judged"]

_EVENT_WORDS = {**EVENT_WORDS, "break": EVENT_WORDS["cord_break"]}

_NUMBER_WORDS = {
    "cord_load_scale": "scale of the cords' load",
    "cord_strain_scale": "scale of the cords' strain",
}

_IDENTIFIED = {0: False, 1: True}


class _MetEvent(EventDifference):
    """An event of the cords, predicted and measured."""

    @property
    def words(self) -> str:
        """Name for the reader."""
        return _EVENT_WORDS.get(self.name, self.name.replace("_", " "))


@dataclass(frozen=True)
class FittedNumber:
    """A fitted parameter of the hose, in SI."""

    name: str
    unit: str
    start: float
    value: float
    value_standard_uncertainty: float
    low: float
    high: float
    lower_bound: float
    upper_bound: float
    is_at_bound: bool

    @property
    def words(self) -> str:
        """Name for the reader."""
        return _NUMBER_WORDS.get(self.name, self.name.replace("_", " "))

    def shown(self, units: UnitSystem) -> Shown:
        """Display unit: degrees for an angle, percent for a share."""
        if self.unit == "rad":
            return DEGREES
        if self.unit == "Pa":
            return shown("stress", units)
        return shown("strain", units) if self.name.endswith("_share") else Shown(self.unit, 1.0)


@dataclass(frozen=True)
class ComparisonView(RowView):
    """One comparison on the page: a row of the archive of comparisons."""

    KIND = "comparison"

    ENDS_AT: ClassVar[Mapping[str, str]] = {
        "comparison_point": "strain",
        "comparison_cycle": "comparison_cycle_number",
        "parameter": "parameter_name",
        "parameter_other": "parameter_name",
    }

    @property
    def test(self) -> str:
        """Test that is compared."""
        return self.text("comparison_test")

    @property
    def specimen(self) -> str:
        """Specimen of the test."""
        return self.text("comparison_specimen")

    @property
    def hose(self) -> str:
        """Hose that is predicted."""
        return self.text("comparison_hose")

    @property
    def loading(self) -> str:
        """Loading of the test: static or dynamic."""
        return self.text("comparison_loading")

    @property
    def judged(self) -> str:
        """Curve with which the prediction is compared."""
        return self.text("judged_curve")

    @property
    def verdict(self) -> str:
        """Verdict of the comparison, in words."""
        return self.text("verdict")

    @property
    def short_verdict(self) -> ShortVerdict:
        """The verdict in a word: agreement within a wide band says little."""
        if not np.isfinite(self.scalar("largest_ratio")):
            return "not judged"
        if not self.is_flag("agrees"):
            return "differs"
        return "agrees" if self.is_flag("is_informative") else "says little"

    @property
    def is_identified(self) -> bool | None:
        """Whether the curve identifies the fitted parameters; None where none was to be fitted."""
        if "is_identified" not in self.data:
            return None
        return _IDENTIFIED.get(int(self.data.variables["is_identified"].values[self.index]))

    def curve_place(self, curve: str) -> int:
        """Place of a curve of the test in the archive."""
        return int(self.data.variables["curve"].values.astype(str).tolist().index(curve))

    def of_curve(self, name: str, curve: str) -> Floats:
        """Values of a variable for one curve of the test: a number, or along the strains."""
        return np.asarray(self.array(name)[self.curve_place(curve)])

    def judged_scalar(self, name: str) -> float:
        """A number of the judged curve."""
        return float(self.of_curve(name, self.judged))

    def is_flag(self, name: str) -> bool:
        """Return whether a flag with the values no and yes is yes."""
        return self.scalar(name) == 1

    @property
    def curves(self) -> tuple[str, ...]:
        """Available curves of the test."""
        return tuple(
            name
            for name in self.data.variables["curve"].values.astype(str).tolist()
            if np.isfinite(self.of_curve("measured_tension", name)).any()
        )

    @property
    def difference(self) -> Floats:
        """Predicted less measured tension at the judged curve. [N]."""
        return self.of_curve("tension_difference", self.judged)

    @property
    def shared_sources(self) -> list[str]:
        """Sources of the errors that all samples of the test share, in fixed order."""
        rows = stored(self.data, "measured_tension_uncertainty_contribution")
        if rows is None:
            return []
        own = np.nan_to_num(rows.values[:, self.index]).reshape(rows.shape[0], -1)
        names = self.data.variables["uncertainty_source"].values.astype(str)
        return in_order(set(names[(own != 0).any(axis=1)].tolist()))

    @property
    def allowed(self) -> Floats:
        """Allowed difference at each strain: U, to both sides. [N]."""
        return np.asarray(self.scalar("coverage_factor") * self.array("validation_uncertainty"))

    @property
    def calibrated_difference(self) -> Floats:
        """Calibrated less measured tension at the judged curve; NaN without a calibration. [N]."""
        measured = self.of_curve("measured_tension", self.judged)
        return np.asarray(self.array_like("calibrated_tension", measured) - measured)

    @cached_property
    def events(self) -> tuple[_MetEvent, ...]:
        """Events of the cords, in the order of strain."""
        names = self.data.variables["hose_event"].values.astype(str)
        fields = [name for name in _MetEvent.__dataclass_fields__ if name != "name"]
        table = [self.array_like(f"event_{name}", np.zeros(names.size)) for name in fields]
        return tuple(
            _MetEvent(str(name), *(float(row[place]) for row in table))
            for place, name in enumerate(names)
        )

    @cached_property
    def fitted(self) -> tuple[FittedNumber, ...]:
        """Fitted parameters of the hose; none without a calibration."""
        if "parameter_name" not in self.data:
            return ()
        names, units = (
            self.data.variables[f"parameter_{one}"].values[self.index].astype(str)
            for one in ("name", "unit")
        )
        fields = (
            "start", "value", "value_standard_uncertainty", "low", "high", "lower_bound",
            "upper_bound",
        )  # fmt: skip
        table = {name: self.array(f"parameter_{name}") for name in fields}
        is_at_bound = self.array("parameter_is_at_bound")
        return tuple(
            FittedNumber(
                name=str(names[place]),
                unit=str(units[place]),
                is_at_bound=bool(is_at_bound[place] == 1),
                **{name: float(row[place]) for name, row in table.items()},
            )
            for place in range(self.sizes["parameter"])
        )


FORM_WORDS = {
    "del-vecchio": "Del Vecchio",
    "mean-load": "mean load",
    "quadratic": "quadratic surface",
}
"""Names of the forms of stiffness on the page."""

_STRAINS = ("mean_strain", "strain_amplitude")

_LOADS = ("mean_tension", "tension_amplitude")

_OF_MEAN = "% of mean"


@dataclass(frozen=True)
class ExperimentView(RowView):
    """One experiment on the page: a row of the archive of experiments."""

    KIND = "experiment"

    ENDS_AT: ClassVar[Mapping[str, str]] = {
        "run": "run_name",
        "factor": "factor_name",
        "plan_column": "plan_column_name",
    }

    @property
    def is_screening(self) -> bool:
        """True where the effects of many factors were measured, not a surface."""
        return self.text("experiment_kind") == "plackett-burman"

    @property
    def factors(self) -> tuple[str, ...]:
        """Names of the factors."""
        return self.texts("factor_name")

    @cached_property
    def responses(self) -> tuple[str, ...]:
        """Quantities measured in the runs."""
        return tuple(
            name
            for name in RESPONSES
            if f"{name}_measured" in self.data
            and (
                np.isfinite(self.array(f"{name}_measured")).any()
                or self.text(f"{name}_refusal")
                or self.text(f"{name}_effect_refusal")
            )
        )

    @cached_property
    def surfaces(self) -> ResponseSurfaces | None:
        """Surfaces of the responses and, last, of the transformed ones; None for a screening."""
        if not surface_names(self.data, self.name):
            return None
        return surfaces_of(self.data, self.name)

    @cached_property
    def runs(self) -> tuple[str, ...]:
        """Names of the runs, with the specimen where there are several."""
        names, specimens = self.texts("run_name"), self.texts("run_specimen")
        many = len(set(specimens)) > 1
        return tuple(
            f"{run} {specimen}" if many else run
            for run, specimen in zip(names, specimens, strict=True)
        )

    @cached_property
    def factor_units(self) -> tuple[Shown, ...]:
        """Display unit of the level of each factor."""
        pairs = zip(self.factors, self.texts("factor_unit"), strict=True)
        return tuple(
            self._share(place) if name in _LOADS and unit == "1"
            else _factor_unit(name, unit, self.units)
            for place, (name, unit) in enumerate(pairs)
        )  # fmt: skip

    def _share(self, place: int) -> Shown:
        """Display unit of a load that is a share of the break strength, or of the mean load."""
        is_of_mean = self.factors[place] == "tension_amplitude" and is_share_of_mean(
            self.array("run_level")[:, place],
            self.per_run("run_mean_tension"),
            self.per_run("run_tension_amplitude"),
        )
        return Shown(_OF_MEAN if is_of_mean else "%RBS", 100.0)

    def factor_label(self, place: int) -> str:
        """Name of a factor with its unit, for an axis or a column."""
        return self.factor_units[place].label(in_words(self.factors[place]))

    def levels(self, place: int) -> tuple[float, float, float]:
        """Low, middle and high level of a factor, in display units."""
        low, high = (self.array(f"factor_{end}")[place] for end in ("low", "high"))
        factor = self.factor_units[place].factor
        return float(low * factor), float((low + high) / 2 * factor), float(high * factor)

    def per_run(self, name: str) -> Floats:
        """Values of a variable, or NaN, one per run."""
        found = self.array(name)
        return found if found.shape == (len(self.runs),) else np.full(len(self.runs), np.nan)

    def texts(self, name: str) -> tuple[str, ...]:
        """Values of a text variable, one per entry of its dimension; as many "" where missing."""
        if name not in self.data:
            return ("",) * self.sizes.get("run" if name.startswith("run_") else "", 0)
        return super().texts(name)

    def array_of_texts(self, name: str) -> NDArray[np.str_]:
        """Values of a text variable in their shape; empty where missing."""
        if name not in self.data:
            return np.full((0, 0), "")
        return np.asarray(self.data.variables[name].values[self.index], dtype=np.str_)

    def own_rows(self, name: str) -> list[dict[str, str]]:
        """Rows of the cautions that concern this experiment."""
        if name not in self.data:
            return []
        columns = [one for one in map(str, self.data.variables) if one.startswith(name)]
        values = {one: self.data.variables[one].values.astype(str) for one in columns}
        own = np.flatnonzero(values[f"{name}_experiment"] == self.name)
        return [{one: str(values[one][place]) for one in columns} for place in own]

    def coefficient_unit(self, name: str, exponents: tuple[int, ...]) -> Shown:
        """Unit of an engineering coefficient of a surface, and its factor from SI."""
        of_response = response_unit(name, self.units)
        scale = of_response.factor
        for one, power in zip(self.factor_units, exponents, strict=True):
            scale /= one.factor**power
        units = ["%" if one.unit == _OF_MEAN else one.unit for one in self.factor_units]
        return Shown(combined_unit(of_response.unit, units, exponents), scale)


def in_words(name: str) -> str:
    """Return the name of a quantity for the reader.

    Examples
    --------
    >>> in_words("log_relaxation_time"), in_words("mean_tension")
    ('logarithm of relaxation time', 'mean tension')
    """
    scale = next((one for one in SCALES if name.startswith(one)), "")
    return SCALES.get(scale, "{}").format(name.removeprefix(scale).replace("_", " "))


def response_unit(name: str, system: UnitSystem) -> Shown:
    """Return the display form of a response, or of the scale of its transform.

    Examples
    --------
    >>> response_unit("dashpot_coefficient", "us").unit
    'lbf s'
    >>> response_unit("log_hysteresis_energy", "us")
    Shown(unit='1', factor=1.0)
    """
    if name not in RESPONSES:
        return Shown("1", 1.0)
    unit = QUANTITIES[name].unit
    if unit == "J m-1":
        return shown("energy", system)
    if unit == "N s":
        force = shown("tension", system)
        return Shown(f"{force.unit} s", force.factor)
    return Shown(*display_unit(unit, system))


def _factor_unit(name: str, unit: str, system: UnitSystem) -> Shown:
    if name in _STRAINS:
        return shown("strain", system)
    if name == "diameter":
        return shown("small length", system)
    return Shown(*display_unit(unit, system))


@dataclass(frozen=True)
class OutcomeView:
    """Outcomes of a campaign, the attributes of their archive, and the units of the page."""

    outcomes: tuple[Outcome, ...]
    attributes: dict[str, str]
    units: UnitSystem = "si"

    @property
    def is_synthetic(self) -> bool:
        """True where no specimen was ever pulled."""
        return self.attribute("synthetic").lower() == "yes"

    @property
    def summary(self) -> str:
        """Number of outcomes, and the results from them."""
        uses = Counter[str](one.use for one in self.outcomes)
        listed = [
            f"{uses[use]:,} {words}"
            for use, words in (
                ("value", "used as values"), ("lower_bound", "as lower bounds"),
                ("excluded", "invalid and not used"),
            )
            if uses[use]
        ]  # fmt: skip
        number = len(self.outcomes)
        noun = "outcome" if number == 1 else "outcomes"
        return f"{number:,} {noun} without a log: {', '.join(listed)}"

    def attribute(self, name: str) -> str:
        """Global attribute; empty where there is none."""
        return self.attributes.get(name, "")


def view_outcomes(archive: xr.Dataset, units: UnitSystem) -> OutcomeView:
    """Return the data of an archive of outcomes that the page needs; it may then be closed."""
    attributes = {str(name): str(value) for name, value in archive.attrs.items()}
    return OutcomeView(outcomes_of_dataset(archive), attributes, units)


def line_of(group: Group) -> Group:
    """Return the line of a group, without condition and exposure."""
    return replace(group, condition="", exposure=None)


def group_names(groups: Sequence[Group], units: UnitSystem) -> list[str]:
    """Return a name of each group: its own name, and its differences from the others.

    Examples
    --------
    >>> new = Group("PD", "polyester", "double braid", 0.0127, "new", 0.0)
    >>> group_names([new, replace(new, condition="worn", exposure=2.0)], "si")
    ['PD, new, 0 years', 'PD, worn, 2 years']
    """
    parts = [_parts(group, units) for group in groups]
    differ = {name for name in parts[0] if len({one[name] for one in parts}) > 1} if parts else ()
    names = []
    for one in parts:
        first = next((name for name in one if one[name]), "")
        names.append(
            ", ".join(text for name, text in one.items() if text and name in {first, *differ})
        )
    return [name or "not named" for name in names]


def _parts(group: Group, units: UnitSystem) -> dict[str, str]:
    small = shown("small length", units)
    diameter, years = group.diameter, group.exposure
    return {
        "line": group.line,
        "material": group.material,
        "construction": group.construction,
        "diameter": "" if diameter is None else f"{diameter * small.factor:.4g} {small.unit}",
        "condition": group.condition,
        "exposure": "" if years is None else f"{years:.4g} year{'' if years == 1 else 's'}",
    }


_ROUNDING = 1e-6


@dataclass(frozen=True)
class RopeView(ArchiveView):
    """One rope on the page.

    Parameters
    ----------
    key : str
        Prefix of every anchor.
    specimen : str
        Name of the specimen.
    data : xarray.Dataset
        Its rows of the archive of properties, in memory.
    tests : tuple of TestView
        Steps of its programme in the order in which they were done.
    units : UnitSystem
        Display units.
    """

    key: str
    specimen: str
    data: xr.Dataset
    tests: tuple[TestView, ...]
    units: UnitSystem = "si"

    @property
    def names(self) -> list[str]:
        """Property of each row."""
        return self.texts("property_name")

    def array(self, name: str) -> Floats:
        """Values of a variable, one per row."""
        return np.asarray(self.data.variables[name].values, dtype=np.float64)

    def texts(self, name: str) -> list[str]:
        """Texts of a variable, one per row."""
        return [str(value) for value in self.data.variables[name].values]

    def rows_of(self, name: str) -> list[int]:
        """Rows of one property that have a value."""
        stiffness, strain = self.array("property_stiffness"), self.array("property_strain")
        known = np.isfinite(stiffness) | np.isfinite(strain)
        return [row for row, one in enumerate(self.names) if one == name and known[row]]

    def entries(self, along: str, needed: str) -> Iterator[tuple[TestView, int]]:
        """Every test and place of this rope along ``specimen``, ``held_pair`` or ``hold``."""
        for view in self.tests:
            owners = view.texts(along if along == "specimen" else f"{along}_specimen")
            if needed in view.data:
                yield from (
                    (view, place) for place, own in enumerate(owners) if own == self.specimen
                )


def expanded_property(view: RopeView, name: str) -> Expanded:
    """Return the expanded uncertainty of a property in each row, from shared and random parts."""
    spread = view.array(f"{name}_standard_uncertainty")
    kept = f"{name}_random_standard_uncertainty"
    return expand(
        spread,
        random=view.array(kept) if kept in view.data else None,
        degrees_of_freedom=view.array(f"{name}_degrees_of_freedom"),
    )


def shared_by_properties(view: RopeView) -> set[str]:
    """Return the sources of the errors that the properties of a rope share with others."""
    if COMPONENT not in view.data:
        return set()
    sources = view.texts("uncertainty_source")
    reached = np.zeros(len(sources), dtype=bool)
    for name in ("stiffness", "stiffness_over_strength", "strain"):
        rows = view.array(f"property_{name}_uncertainty_contribution")
        # a zero error that cancels in a difference leaves its rounding
        reached |= (np.abs(rows) > _ROUNDING * np.abs(view.array(f"property_{name}"))).any(axis=1)
    return {one for one, is_in in zip(sources, reached, strict=True) if is_in}


def view_ropes(
    archive: xr.Dataset, tests: Mapping[str, TestView], units: UnitSystem
) -> list[RopeView]:
    """Return the ropes of an archive of properties, which may then be closed."""
    data = in_memory(archive)
    used = settings_of(data).get("tests", {})
    owners = data["property_specimen"].values.astype(str)
    return [
        RopeView(
            f"rope-{index}",
            name,
            _rows(data, np.flatnonzero(owners == name)),
            tuple(tests[test] for test in used.get(name, ()) if test in tests),
            units,
        )
        for index, name in enumerate(dict.fromkeys(owners.tolist()))
    ]


def _rows(data: xr.Dataset, places: Integers) -> xr.Dataset:
    variables = {name: at_places(one, "property", places) for name, one in data.variables.items()}
    return xr.Dataset(variables, attrs=data.attrs)


def expanded_of_runs(view: ExperimentView, name: str, tests: Mapping[str, TestView]) -> Expanded:
    """Return the expanded uncertainty of a response in each run."""
    spread = view.per_run(f"{name}_measured_standard_uncertainty")
    given = expand(spread)
    half, factor = given.half.copy(), given.factor.copy()
    pairs = zip(view.texts("run_name"), view.texts("run_specimen"), strict=True)
    for place, (run, specimen) in enumerate(pairs):
        test = tests.get(run)
        own = None if test is None else test.array(f"test_{name}")
        if test is None or own is None or specimen not in test.specimens:
            continue
        found = expanded_of(test, f"test_{name}", own)
        row = test.specimens.index(specimen)
        half[place], factor[place] = found.half[row], found.factor[row]
    return Expanded(half, factor)


def base_response(name: str) -> str:
    """Return the response of a surface, before any transform.

    Examples
    --------
    >>> base_response("log_hysteresis_energy")
    'hysteresis_energy'
    """
    return next(base for base in RESPONSES if name.endswith(base))
