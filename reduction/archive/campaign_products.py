"""The archives of outcomes, predictions and comparisons of a campaign.

The dimension ``outcome`` has one entry per row of the table of results.  A value is stored under
the name of its quantity, with its unit; it is NaN under the other names.  Quantities absent from
all rows are left out. ``outcome_use`` states how statistics use the value: a break in the
termination and a stopped test give lower bounds.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, get_args

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from reduction.archive.dataset_builder import build_dataset, part_attributes
from reduction.archive.shared_errors import component_values
from reduction.archive.variables import (
    Values,
    note_values,
    numbers,
    pad,
    pad_texts,
    texts,
)
from reduction.experiments.outcomes import Outcome, OutcomeQuantity, Place
from reduction.prediction.comparison_error import Comparison, PressureComparison
from reduction.prediction.hose_prediction import HOSE_SERIES, PredictedHose
from reduction.prediction.hose_product import HOSE_PARAMETERS, HoseEvents
from reduction.prediction.hose_tension import predict_hose
from reduction.prediction.hose_uncertainty import PICK_UP, EventUncertainty
from reduction.prediction.measured_curve import CURVES
from reduction.quantities.flags import HOSE_STATES, OUTCOME_USES
from reduction.quantities.names import (
    COMPARISON_SCHEMA,
    OUTCOME_SCHEMA,
    PREDICTION_SCHEMA,
    quantity,
)
from reduction.quantities.row import RANDOM_PART
from reduction.record.contributions import combined_standard_uncertainty
from reduction.record.errors import ArchiveError
from reduction.record.measurement import Floats, Origin
from reduction.record.notes import Note

_PREFIX = re.compile("^(tension|calibrated|event|comparison|parameter)_")
"""Prefix of a name in the archive that the corresponding part of a comparison lacks."""

_NOT_ASKED = 2


@dataclass(frozen=True)
class NamedComparison:
    """A comparison with its names."""

    name: str
    test: str
    specimen: str
    hose: str
    comparison: Comparison
    is_synthetic: bool = False

    @property
    def notes(self) -> tuple[Note, ...]:
        """Notes of the comparison, its verdict and its calibration, without repeats."""
        found = self.comparison
        own = () if found.calibration is None else found.calibration.notes
        return tuple(dict.fromkeys((*found.notes, *found.validation.notes, *own)))


def comparisons_to_dataset(named: Sequence[NamedComparison], *, origin: Origin) -> xr.Dataset:
    """Convert comparisons to the archive dataset, without writing a file."""
    names = [one.name for one in named]
    found = [one.comparison for one in named]
    values: Values = {
        "comparison": texts(names),
        "curve": texts(CURVES),
        "hose_event": texts([event.name for event in found[0].events]),
        "comparison_test": texts([one.test for one in named]),
        "comparison_specimen": texts([one.specimen for one in named]),
        "comparison_hose": texts([one.hose for one in named]),
        "comparison_loading": texts([one.measured.loading for one in found]),
        "judged_curve": texts([one.judged for one in found]),
        "verdict": texts([one.validation.verdict for one in found]),
        "note_comparison": texts([one.name for one in named for _ in one.notes]),
        **note_values([replace(said, stage="comparison") for one in named for said in one.notes]),
    }
    values |= _compared_curves(found) | _compared_pressures(found)
    for dims in ((), ("curve",), ("hose_event",), ("comparison_cycle",), ("parameter",)):
        values |= _of_rows(found, *dims)
    values |= _calibration_values(found)
    for axis, along in (
        ("comparison_point", "strain"),
        ("comparison_cycle", "cycle_bias"),
        ("parameter", "parameter_value"),
        ("parameter_other", "parameter_value"),
    ):
        if along in values:
            values[axis] = np.arange(1, values[along].shape[1] + 1)
    return build_dataset(
        values,
        COMPARISON_SCHEMA,
        attributes=part_attributes("comparisons", names, origin=origin),
    )


def _of_rows(found: Sequence[Comparison], *dims: str) -> Values:
    """Numbers with the given dimensions, each from the part of the comparison that has it."""
    values: Values = {}
    for row in COMPARISON_SCHEMA.values():
        if row.dims != ("comparison", *dims) or row.is_text:
            continue
        given = [_numbers_of(one, row.name, *dims) for one in found]
        if all(each is None for each in given):
            continue
        table = pad([[] if each is None else each for each in given])
        table = table if row.dtype == "f8" else np.nan_to_num(table).astype(row.dtype)
        values[row.name] = table if dims else table[:, 0]
    return values


def _numbers_of(one: Comparison, name: str, *dims: str) -> ArrayLike | None:
    if dims == ("curve",):
        return [_number_of(one.differences.get(curve), name) for curve in CURVES]
    if dims == ("hose_event",):
        return [_number_of(event, name) for event in one.events]
    fit = one.calibration
    parts = (one, one.pressure, one.validation, one.energy, one.cycles)
    fitted = () if fit is None else (fit, fit.identifiability, fit.after)
    given = (_number_of(part, name, None) for part in (*parts, *fitted))
    return next((each for each in given if each is not None), None)


def _number_of(part: object, name: str, otherwise: Any = np.nan) -> Any:
    return getattr(part, name, getattr(part, _PREFIX.sub("", name), otherwise))


def _compared_curves(found: Sequence[Comparison]) -> Values:
    length = max(one.measured.strain.size for one in found)
    names = ("measured_tension", f"measured_tension{RANDOM_PART}", "tension_difference")
    values: Values = {name: np.full((len(found), len(CURVES), length), np.nan) for name in names}
    for row, one in enumerate(found):
        own = slice(one.measured.strain.size)
        for place, curve in enumerate(CURVES):
            if curve not in one.differences:
                continue
            curves = (
                one.measured.tension_of(curve),
                one.measured.standard_uncertainty_of(curve),
                one.differences[curve].difference,
            )
            for name, along in zip(names, curves, strict=True):
                values[name][row, place, own] = along
    return (
        values
        | _shared_values(found, values)
        | {
            "strain": pad([one.measured.strain for one in found]),
            "predicted_tension": pad([one.prediction.tension for one in found]),
            "predicted_tension_standard_uncertainty": pad(
                [one.validation.input_standard_uncertainty for one in found]
            ),
            "validation_uncertainty": pad([one.validation.validation_uncertainty for one in found]),
        }
    )


def _compared_pressures(found: Sequence[Comparison]) -> Values:
    """Comparison in fill pressure, on the strains of the tension; empty without any."""
    pressures = [one.pressure for one in found]
    if not any(pressures):
        return {}

    def on_axis(read: Callable[[PressureComparison], Floats]) -> Floats:
        return pad(
            [
                np.full(one.measured.strain.size, np.nan)
                if own is None
                else np.interp(
                    one.measured.strain, own.measured.strain, read(own), left=np.nan, right=np.nan
                )
                for one, own in zip(found, pressures, strict=True)
            ]
        )

    return {
        "measured_fill_pressure": on_axis(lambda own: own.measured.tension_of(own.measured.judged)),
        "measured_fill_pressure_standard_uncertainty": on_axis(
            lambda own: own.validation.measurement_standard_uncertainty
        ),
        "predicted_fill_pressure": on_axis(lambda own: own.predicted),
        "predicted_fill_pressure_standard_uncertainty": on_axis(
            lambda own: own.validation.input_standard_uncertainty
        ),
        "fill_pressure_validation_uncertainty": on_axis(
            lambda own: own.validation.validation_uncertainty
        ),
        "fill_pressure_verdict": texts(
            ["" if own is None else own.validation.verdict for own in pressures]
        ),
    }


def _shared_values(found: Sequence[Comparison], values: Values) -> Values:
    """Shared errors of the samples of each test, and its curve's uncertainty with them."""
    measured = values["measured_tension"]
    component = sorted({each for one in found for each in one.measured.component})
    rows = np.zeros((len(component), *measured.shape))
    for place, one in enumerate(found):
        own = [component.index(each) for each in one.measured.component]
        rows[own, place, :, : one.measured.strain.size] = one.measured.contribution
    return component_values(component) | {
        # without a tension there are no contributions
        "measured_tension_uncertainty_contribution": np.where(np.isnan(measured), np.nan, rows),
        "measured_tension_standard_uncertainty": combined_standard_uncertainty(
            rows, values[f"measured_tension{RANDOM_PART}"]
        ),
    }


def _calibration_values(found: Sequence[Comparison]) -> Values:
    """Calibration values without a row; empty if nothing was to be fitted."""
    fits = [one.calibration for one in found]
    most = max((len(fit.parameter) for fit in fits if fit is not None), default=0)
    if not most:
        return {}
    named = [() if fit is None else fit.parameter for fit in fits]
    correlation = np.full((len(fits), most, most), np.nan)
    for table, fit in zip(correlation, fits, strict=True):
        if fit is not None:
            size = len(fit.parameter)
            table[:size, :size] = fit.correlation
    return {
        "parameter_name": pad_texts(named),
        "parameter_unit": pad_texts([[quantity(name).unit for name in names] for names in named]),
        "parameter_correlation": correlation,
        "calibrated_tension": pad(
            [
                one.measured.strain * np.nan
                if one.calibration is None
                else predict_hose(one.calibration.design, one.measured.strain).tension
                for one in found
            ]
        ),
        "is_identified": np.array(
            [_NOT_ASKED if fit is None else int(fit.identifiability.is_identified) for fit in fits]
        ),
        "identifiability": texts(
            ["" if fit is None else fit.identifiability.words for fit in fits]
        ),
    }


EVENTS = ("deepest_slack", "pick_up", "working", "cord_break")

_STATES = {
    "slack": "is_slack",
    "broken": "is_broken",
    "jammed": "is_jammed",
    "bore_too_small": "is_bore_too_small",
}

_AT_EVENT = ("strain", "tension", "fill_pressure", "cord_tension", "cord_strain")

_DESIGN = (
    "wrap_angle", "inner_diameter", "outer_diameter", "cords_per_length", "cord_diameter",
    "rubber_modulus", "working_share", "cord_load_scale", "cord_strain_scale",
    "dead_length_share", "minimum_inner_diameter",
)  # fmt: skip

_OF_LAYER = ("least_strain", "greatest_strain", "break_strain", "least_angle", "greatest_angle")


def predictions_to_dataset(hoses: Sequence[PredictedHose], *, origin: Origin) -> xr.Dataset:
    """Convert predictions to the archive dataset, without writing a file."""
    names = [hose.plan.name for hose in hoses]
    values: Values = {
        "hose": texts(names),
        "hose_event": texts(EVENTS),
        "cord_layer": texts(("inner", "outer")),
        "rubber_law": texts([hose.plan.design.rubber_law for hose in hoses]),
        "note_hose": texts([hose.plan.name for hose in hoses for _ in hose.notes]),
        **note_values([replace(said, stage="prediction") for hose in hoses for said in hose.notes]),
    }
    values |= _design_values(hoses) | _predicted_curves(hoses) | _event_values(hoses)
    values |= _uncertainty_values(hoses) | _layer_values(hoses)
    for axis, along in (("hose_point", "strain"), ("cord_point", "cord_curve_strain")):
        values[axis] = np.arange(1, values[along].shape[1] + 1)
    return build_dataset(
        values,
        PREDICTION_SCHEMA,
        attributes=part_attributes("predictions", names, origin=origin),
    )


def _design_values(hoses: Sequence[PredictedHose]) -> Values:
    designs = [hose.plan.design for hose in hoses]
    values: Values = {
        name: np.array([float(getattr(design, name)) for design in designs]) for name in _DESIGN
    }
    values["layer_diameter"] = np.array([design.layer_diameter for design in designs], dtype=float)
    values["ribbon_width"] = np.array([hose.ribbon_width for hose in hoses])
    for name in ("number_of_cords", "working_torque", "balanced_wrap_angle"):
        values[name] = np.array([getattr(hose, name) for hose in hoses])
    values["cord_curve_strain"] = pad([design.cord.strain for design in designs])
    values["cord_curve_load"] = pad([design.cord.load for design in designs])
    for name in HOSE_PARAMETERS:
        spread = np.array(
            [hose.plan.standard_uncertainty.get(name, np.nan) for hose in hoses], dtype=float
        )
        if np.isfinite(spread).any():
            both = name == "layer_diameter"
            values[f"{name}_standard_uncertainty"] = np.stack([spread] * 2, 1) if both else spread
    return values


def _predicted_curves(hoses: Sequence[PredictedHose]) -> Values:
    values: Values = {
        name: pad([getattr(hose.prediction, name) for hose in hoses]) for name in HOSE_SERIES
    }
    state = np.zeros(values["strain"].shape, dtype=np.uint16)
    for row, hose in zip(state, hoses, strict=True):
        for name, bit in HOSE_STATES.items():
            is_so = getattr(hose.prediction, _STATES[name])
            row[: is_so.size] |= np.where(is_so, bit, 0).astype(np.uint16)
    return values | {"hose_state": state}


def _event_values(hoses: Sequence[PredictedHose]) -> Values:
    def at(events: HoseEvents, name: str) -> list[float]:
        return [float(getattr(getattr(events, event), name)) for event in EVENTS]

    return {
        f"event_{name}": np.array([at(hose.events, name) for hose in hoses]) for name in _AT_EVENT
    }


def _uncertainty_values(hoses: Sequence[PredictedHose]) -> Values:
    """Uncertainties of hoses; empty if all their inputs are exact."""
    given = [hose.uncertainty for hose in hoses]
    names = (*HOSE_PARAMETERS, PICK_UP)
    sources = [name for name in names if any(name in one.source for one in given)]
    if not sources:
        return {}
    n_points = max(hose.prediction.strain.size for hose in hoses)
    values: Values = {"uncertainty_source": texts(sources)}
    for name in ("tension", "fill_pressure"):
        parts = np.full((len(hoses), len(sources), n_points), np.nan)
        for part, hose in zip(parts, hoses, strict=True):
            found: Floats = getattr(hose.uncertainty, f"{name}_contribution")
            part[:, : found.shape[-1]] = 0.0
            for source, row in zip(hose.uncertainty.source, found, strict=True):
                part[sources.index(source), : row.size] = row
        values[f"{name}_contribution"] = parts
        values[f"{name}_standard_uncertainty"] = pad(
            [
                _nan_where_exact(hose, getattr(hose.uncertainty, f"{name}_standard_uncertainty"))
                for hose in hoses
            ]
        )
    for name in ("strain", "tension", "fill_pressure"):
        values[f"event_{name}_standard_uncertainty"] = np.array(
            [[_at_event(hose, event, name) for event in EVENTS] for hose in hoses]
        )
    return values


def _nan_where_exact(hose: PredictedHose, values: Floats) -> Floats:
    """NaN instead of zero for a hose with exact inputs."""
    return values if hose.uncertainty.source else np.full(values.shape, np.nan)


def _at_event(hose: PredictedHose, event: str, name: str) -> float:
    found: EventUncertainty = getattr(hose.uncertainty, event)
    if not hose.uncertainty.source:
        return np.nan
    return float(getattr(found, f"{name}_standard_uncertainty"))


def _layer_values(hoses: Sequence[PredictedHose]) -> Values:
    most = max(len(hose.layers) for hose in hoses)
    if not most:
        return {}
    values: Values = {
        "hose_layer": np.arange(1, most + 1),
        "hose_layer_name": pad_texts([[one.layer.name for one in hose.layers] for hose in hoses]),
    }
    for name in ("wrap_angle", "strain_limit", "compression_limit"):
        values[f"hose_layer_{name}"] = pad(
            [[getattr(one.layer, name) for one in hose.layers] for hose in hoses]
        )
    for name in _OF_LAYER:
        values[f"hose_layer_{name}"] = pad(
            [[getattr(one, name) for one in hose.layers] for hose in hoses]
        )
    return values


_QUANTITIES: tuple[OutcomeQuantity, ...] = get_args(OutcomeQuantity)

_PLACES: tuple[Place, ...] = get_args(Place)


_TEXTS = ("test", "specimen", "line", "material", "construction", "condition", "mode", "note")

_NUMBERS = (
    "diameter", "exposure", "minimum_load", "peak_load", "minimum_load_ratio", "peak_load_ratio",
)  # fmt: skip


def outcomes_to_dataset(outcomes: Sequence[Outcome], *, origin: Origin) -> xr.Dataset:
    """Convert outcomes to the archive dataset, without writing a file."""
    values: Values = {
        "outcome_row": np.array([one.row for one in outcomes]),
        "outcome_quantity": np.array([_QUANTITIES.index(one.quantity) for one in outcomes]),
        "outcome_use": np.array([OUTCOME_USES[one.use] for one in outcomes]),
        "outcome_place": np.array([_PLACES.index(one.place) for one in outcomes]),
        "outcome_is_valid": np.array([one.is_valid for one in outcomes]),
        "outcome_is_suspended": np.array([one.is_suspended for one in outcomes]),
    }
    for measured in _QUANTITIES:
        own = [one.value if one.quantity == measured else None for one in outcomes]
        values[measured] = numbers(own)
    for name in _TEXTS:
        values[f"outcome_{name}"] = texts([getattr(one, name) for one in outcomes])
    for name in _NUMBERS:
        values[f"outcome_{name}"] = numbers([getattr(one, name) for one in outcomes])
    return build_dataset(
        {name: array for name, array in values.items() if _says_something(array)},
        OUTCOME_SCHEMA,
        attributes=part_attributes("outcomes", origin=origin),
    )


def _says_something(array: np.ndarray[Any, np.dtype[Any]]) -> bool:
    if array.dtype.kind == "U":
        return any(array)
    return array.dtype.kind != "f" or bool(np.isfinite(array).any())


def outcomes_of_dataset(dataset: xr.Dataset) -> tuple[Outcome, ...]:
    """Return the outcomes stored in an archive."""
    if "outcome" not in dataset.sizes:
        raise ArchiveError(
            "the archive holds no outcomes", found=", ".join(map(str, dataset.sizes))
        )
    size = dataset.sizes["outcome"]

    def column(name: str, missing: object) -> list[Any]:
        # tolist gives Python numbers, which print and compare like those read
        return dataset.variables[name].values.tolist() if name in dataset else [missing] * size

    quantity = [_QUANTITIES[code] for code in column("outcome_quantity", 0)]
    by_quantity = {name: column(name, np.nan) for name in _QUANTITIES}
    kept: dict[str, list[Any]] = {name: column(f"outcome_{name}", "") for name in _TEXTS}
    kept |= {name: column(f"outcome_{name}", np.nan) for name in _NUMBERS}
    kept |= {
        "quantity": quantity,
        "value": [by_quantity[name][place] for place, name in enumerate(quantity)],
        "place": [_PLACES[code] for code in column("outcome_place", 0)],
        "is_valid": [bool(value) for value in column("outcome_is_valid", 1)],
        "is_suspended": [bool(value) for value in column("outcome_is_suspended", 0)],
        "row": column("outcome_row", 0),
    }
    return tuple(
        Outcome(**dict(zip(kept, row, strict=True))) for row in zip(*kept.values(), strict=True)
    )
