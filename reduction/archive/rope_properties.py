"""Archive of change-in-length properties, and the rope steps used for it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import xarray as xr

from reduction.archive.dataset_builder import build_dataset, part_attributes
from reduction.archive.shared_errors import (
    component_values,
    components_of,
    shared_contributions,
)
from reduction.archive.variables import (
    Values,
    numbers,
    settings_of,
    texts,
)
from reduction.quantities.names import PROPERTY_SCHEMA
from reduction.quantities.row import COMPONENT, RANDOM_PART
from reduction.record.contributions import (
    Component,
    InstrumentErrors,
    combined_standard_uncertainty,
)
from reduction.record.errors import ArchiveError
from reduction.record.measurement import Floats, Origin
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.change_in_length import (
    MANY,
    BeddingCycles,
    ChangeInLength,
    CyclicLevel,
    FirstRise,
    HeldTension,
    PairOfHolds,
    StepNumber,
    StepOfProgramme,
)
from reduction.uncertainty.error_field import error_field

_U = "_standard_uncertainty"

_MEASURED = ("property_stiffness", "property_stiffness_over_strength", "property_strain")


def properties_to_dataset(
    found: Mapping[str, Sequence[ChangeInLength]],
    component: Mapping[tuple[str, str], Sequence[Component]],
    *,
    origin: Origin,
) -> xr.Dataset:
    """Convert properties to the archive dataset, without writing a file."""
    listed = [(specimen, one) for specimen, own in found.items() for one in own]
    rows = [one for _, one in listed]
    is_stiffness = np.array([one.is_stiffness for one in rows])
    values: Values = {
        "property": np.arange(1, len(rows) + 1),
        "property_specimen": texts([specimen for specimen, _ in listed]),
        "property_name": texts([one.name for one in rows]),
        "property_test": texts([one.step for one in rows]),
        "property_low_tension": numbers([one.low_tension for one in rows]),
        "property_high_tension": numbers([one.high_tension for one in rows]),
        "property_reference_time": numbers([one.reference_time for one in rows]),
        "property_remark": texts([one.reason for one in rows]),
    }
    of_rows = [component.get((specimen, one.step), ()) for specimen, one in listed]
    # an error that moves none of these properties has no row
    axis = tuple(
        sorted(
            {
                error
                for own, one in zip(of_rows, rows, strict=True)
                for amounts in (one.contribution, one.over_strength_contribution)
                for error, amount in zip(own, amounts, strict=False)
                if amount
            }
        )
    )
    value = numbers([one.value for one in rows])
    random = numbers([one.random_standard_uncertainty for one in rows])
    over = numbers([one.over_strength for one in rows])
    of_value = _on_axis(axis, of_rows, [one.contribution for one in rows])
    parts = {
        "property_stiffness": (np.where(is_stiffness, value, np.nan), random, of_value),
        "property_stiffness_over_strength": (
            over,
            numbers([one.over_strength_random_standard_uncertainty for one in rows]),
            _on_axis(axis, of_rows, [one.over_strength_contribution for one in rows]),
        ),
        "property_strain": (np.where(is_stiffness, np.nan, value), random, of_value),
    }
    freedom = numbers([one.degrees_of_freedom for one in rows])
    for name, (number, spread, contribution) in parts.items():
        is_given = np.isfinite(number)
        own = np.where(is_given, contribution, np.nan)
        values[name] = number
        values[f"{name}{_U}"] = combined_standard_uncertainty(
            own, np.where(is_given, spread, np.nan)
        )
        values[f"{name}_degrees_of_freedom"] = np.where(is_given, freedom, np.nan)
        if axis:
            values[f"{name}_random{_U}"] = np.where(is_given, spread, np.nan)
            values[f"{name}_uncertainty_contribution"] = own
    if axis:
        values |= component_values(axis)
    return build_dataset(
        values,
        PROPERTY_SCHEMA,
        attributes=part_attributes("change_in_length", list(found), origin=origin),
    )


def _on_axis(
    axis: Sequence[Component],
    component: Sequence[Sequence[Component]],
    contribution: Sequence[Floats],
) -> Floats:
    """Contributions to each property from all errors, shape (n_components, n_properties)."""
    rows = np.zeros((len(axis), len(contribution)))
    for place, (own, amounts) in enumerate(zip(component, contribution, strict=True)):
        # a property without a value has no contributions
        for error, amount in zip(own, amounts, strict=False):
            if amount:
                rows[axis.index(error), place] = amount
    return rows


_HELD = ("quasi-static stiffness", "creep")

CHANGES_LENGTH = ("bedding-in", "dynamic stiffness", *_HELD)
"""Steps that can give a change-in-length property."""


@dataclass(frozen=True)
class _ArchivedStep:
    """A step of a programme, and the shared errors of its contributions, in order."""

    step: StepOfProgramme
    component: tuple[Component, ...]


def step_of_archive(
    dataset: xr.Dataset,
    specimen: str,
    instruments: InstrumentErrors | None = None,
    model: StrainModel | None = None,
) -> _ArchivedStep:
    """Data in an archive on one specimen of a step."""
    names = dataset.variables["specimen"].values.astype(str).tolist()
    if specimen not in names:
        raise ArchiveError(f"the archive has no specimen '{specimen}'", found=", ".join(names))
    settings = settings_of(dataset)["reduction"]
    control = settings.get("cycles", {}).get("control")
    read = _Reader(dataset, names.index(specimen), instruments, model, control == "load")
    bedding = _bedding(read)
    step = StepOfProgramme(
        name=str(dataset.attrs["test"]),
        reference_time=float(settings["rope"]["reference_time"]),
        first_rise=_first_rise(read),
        bedding=bedding,
        level=None if bedding is not None else _level(read),
        pairs=_pairs(read, specimen),
        holds=_holds(read, specimen),
        strength_contribution=read.of_strength,
    )
    return _ArchivedStep(step, read.component)


@dataclass(frozen=True)
class _Reader:
    """One specimen of an archive, with its shared errors on one axis."""

    dataset: xr.Dataset
    row: int
    instruments: InstrumentErrors | None
    model: StrainModel | None
    is_load_kept: bool

    @cached_property
    def component(self) -> tuple[Component, ...]:
        """Errors in the archive, followed by other stated ones."""
        found = set(self.stored)
        if self.instruments is not None:
            found |= set(self.field_at(np.zeros(1), np.zeros(1))[0])
            if self.instruments.rated_break_strength:
                found.add(_strength(self.instruments))
        return tuple(sorted(found))

    @cached_property
    def stored(self) -> list[Component]:
        return components_of(self.dataset) if COMPONENT in self.dataset else []

    @property
    def of_strength(self) -> Floats:
        """Relative contributions to the rated break strength."""
        rows = np.zeros(len(self.component))
        if self.instruments is not None and self.instruments.rated_break_strength:
            place = self.component.index(_strength(self.instruments))
            rows[place] = self.instruments.rated_break_strength
        return rows

    def number(self, name: str, *place: int, degrees_of_freedom: float = MANY) -> StepNumber:
        """A number of the archive with both parts of its uncertainty."""
        at = place or (self.row,)
        kept = f"{name}{RANDOM_PART}"
        spread = self.dataset[kept if kept in self.dataset else f"{name}{_U}"].values[at]
        rows = np.zeros(len(self.component))
        for one, amount in shared_contributions(self.dataset, name, *at).items():
            rows[self.component.index(one)] = amount
        value = float(self.dataset.variables[name].values[at])
        return StepNumber(value, float(spread), rows, degrees_of_freedom)

    def value(self, name: str, *place: int) -> float:
        return float(self.dataset.variables[name].values[place or (self.row,)])

    def field_at(
        self, strain: Floats, tension: Floats
    ) -> tuple[tuple[Component, ...], Floats, Floats]:
        """Stated instrument errors at points: components, effects on strain and tension."""
        if self.instruments is None or self.model is None:
            return (), np.empty((0, strain.size)), np.empty((0, strain.size))
        field = error_field(self.instruments, self.model, strain=strain, tension=tension)
        return field.component, field.strain, field.tension

    def points(self, strain: Floats, tension: Floats) -> tuple[Floats, Floats]:
        """Contributions to strain and tension at points, shape (n_components, n_points)."""
        component, of_strain, of_tension = self.field_at(strain, tension)
        rows = np.zeros((2, len(self.component), strain.size))
        for one, *moved in zip(component, of_strain, of_tension, strict=True):
            rows[:, self.component.index(one)] = moved
            if one.source == "temperature" and self.is_load_kept and self.instruments is not None:
                # under load control a stiffer rope stretches less
                rows[:, self.component.index(one)] = (
                    -self.instruments.stiffness * strain,
                    0 * tension,
                )
        return rows[0], rows[1]


def _strength(instruments: InstrumentErrors) -> Component:
    return Component("rated_break_strength", instruments.specimen)


def _first_rise(read: _Reader) -> FirstRise | None:
    """Curve of the first rise; None if fewer than two strains have a tension."""
    dataset, row = read.dataset, read.row
    name = "branch_tension_first_loading"
    if name not in dataset:
        return None
    tension = dataset.variables[name].values[row, 0]
    grid = dataset.variables["first_loading_strain_bin"].values
    known = np.isfinite(tension) & (grid <= _first_peak(dataset, row))
    if np.count_nonzero(known) < 2:
        return None
    kept = f"{name}{RANDOM_PART}"
    spread = dataset[kept if kept in dataset else f"{name}{_U}"].values[row, 0]
    return FirstRise(
        grid[known],
        tension[known],
        np.nan_to_num(spread[known]),
        float(np.diff(grid).min()),
        *read.points(grid[known], tension[known]),
    )


def _first_peak(dataset: xr.Dataset, row: int) -> float:
    """Maximum strain up to the end of the first cycle; larger ones belong to later cycles."""
    if "cycle_last_sample" not in dataset:
        return float("inf")
    stop = int(dataset.variables["cycle_last_sample"].values[0]) + 1
    if "sample_index" in dataset:
        stop = int(np.searchsorted(dataset.variables["sample_index"].values, stop))
    return float(np.nanmax(dataset.variables["strain"].values[row, :stop]))


def _bedding(read: _Reader) -> BeddingCycles | None:
    if "bedding_permanent_strain" not in read.dataset:
        return None
    foot = read.value("foot_strain", read.row, 0)
    valley = read.value("valley_tension", read.row, 0)
    return BeddingCycles(
        first_stiffness=read.number("bedding_first_stiffness"),
        permanent_strain=read.number("bedding_permanent_strain"),
        foot_strain=foot,
        foot_strain_contribution=read.points(np.array([foot]), np.array([valley]))[0][:, 0],
        valley_tension=valley,
        first_peak_tension=read.value("peak_tension", read.row, 0),
        peak_tension=float(np.nanmax(read.dataset.variables["peak_tension"].values[read.row])),
    )


def _level(read: _Reader) -> CyclicLevel | None:
    if "dynamic_stiffness" not in read.dataset:
        return None
    # mean over this number of cycles
    cycles = read.value("dynamic_cycles") if "dynamic_cycles" in read.dataset else np.inf
    return CyclicLevel(
        read.number("dynamic_stiffness", degrees_of_freedom=max(cycles - 1, 1.0)),
        read.value("dynamic_mean_tension"),
        read.value("dynamic_tension_amplitude"),
    )


def _pairs(read: _Reader, specimen: str) -> tuple[PairOfHolds, ...]:
    if "held_pair_specimen" not in read.dataset:
        return ()
    return tuple(
        _pair(read, int(row))
        for row in np.flatnonzero(read.dataset.variables["held_pair_specimen"].values == specimen)
    )


def _pair(read: _Reader, row: int) -> PairOfHolds:
    reason = str(read.dataset.variables["static_refusal"].values[row])
    at = read.value("static_reference_time", row)
    elapsed = _known_times(read.dataset, row)
    if elapsed.size and not elapsed[0] <= at <= elapsed[-1]:
        reason = (
            f"extrapolated beyond the hold, which has points from {elapsed[0]:.3g} "
            f"to {elapsed[-1]:.3g} s"
        )
    return PairOfHolds(
        _held(read, "held_pair_low_tension", row),
        _held(read, "held_pair_high_tension", row),
        read.number("static_stiffness", row),
        at,
        reason,
    )


def _held(read: _Reader, name: str, row: int) -> StepNumber:
    """A tension kept by the machine: rope temperature affects only the strain."""
    found = read.number(name, row)
    is_kept = np.array([one.source != "temperature" for one in read.component], dtype=bool)
    return replace(found, contribution=np.where(is_kept, found.contribution, 0.0))


def _known_times(dataset: xr.Dataset, row: int) -> Floats:
    name = "static_elapsed_time"
    values: Floats = dataset.variables[name].values[row] if name in dataset else np.empty(0)
    return values[np.isfinite(values)]


def _holds(read: _Reader, specimen: str) -> tuple[HeldTension, ...]:
    """Holds of a step at constant tension."""
    dataset = read.dataset
    step = str(dataset.variables["programme_step"].values) if "programme_step" in dataset else ""
    if step not in _HELD or "hold_specimen" not in dataset:
        return ()
    is_own = dataset.variables["hold_specimen"].values == specimen
    tensions = (
        dataset.variables["hold_initial_tension"].values
        + dataset.variables["hold_final_tension"].values
    )
    start = dataset.variables["hold_start_time"].values
    ends = start + dataset.variables["hold_duration"].values
    centre = dataset.variables["hold_ramp_centre_time"].values
    begins = np.where(np.isfinite(centre), centre, start)
    return tuple(
        HeldTension(
            float(tensions[row]) / 2,
            float(ends[row] - begins[row]),
            read.number("creep_rate_per_decade", int(row)),
            str(dataset.variables["hold_refusal"].values[row]),
        )
        for row in np.flatnonzero(is_own & (dataset.variables["hold_kind"].values == "creep"))
    )
