"""The comparisons of a campaign as one dataset that follows CF."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from reduction.archive.attributes import part_attributes
from reduction.archive.build import build_dataset
from reduction.archive.comparison_schema import COMPARISON_SCHEMA
from reduction.archive.shared import component_values
from reduction.archive.values import Values, pad, pad_texts, texts
from reduction.compare.measuredcurve import CURVES
from reduction.compare.product import Calibration, Comparison
from reduction.errors import ArchiveError
from reduction.predict.hose import predict_hose
from reduction.provenance import Origin
from reduction.record import Floats
from reduction.uncertainty.combine import combined_standard_uncertainty
from reduction.vocabulary import quantity

_OF_CURVE = {
    "tension_bias": "bias",
    "tension_rms": "rms",
    "tension_relative_rms": "relative_rms",
    "worst_strain": "worst_strain",
    "worst_tension_difference": "worst_difference",
}
_OF_VALIDATION = {
    "coverage_factor": "coverage_factor",
    "largest_ratio": "ratio",
    "largest_ratio_strain": "ratio_strain",
    "chi_square": "chi_square",
    "chi_square_freedom": "chi_square_freedom",
    "chi_square_probability": "chi_square_probability",
    "uncertainty_share": "share",
}
_OF_EVENT = {
    "event_strain": "strain",
    "event_tension": "tension",
    "event_measured_tension": "measured_tension",
    "event_tension_difference": "tension_difference",
    "event_tension_difference_standard_uncertainty": "tension_difference_standard_uncertainty",
    "event_measured_strain": "measured_strain",
    "event_strain_difference": "strain_difference",
    "event_strain_difference_standard_uncertainty": "strain_difference_standard_uncertainty",
}
_OF_ENERGY = {
    "energy_strain_low": "strain_low",
    "energy_strain_high": "strain_high",
    "measured_energy": "measured",
    "predicted_energy": "predicted",
    "energy_difference": "difference",
    "loop_energy": "loop",
    "loop_energy_share": "loop_share",
}
_OF_PARAMETER = {
    "parameter_start": "start",
    "parameter_value": "value",
    "parameter_value_standard_uncertainty": "standard_uncertainty",
    "parameter_low": "low",
    "parameter_high": "high",
    "parameter_lower_bound": "lower_bound",
    "parameter_upper_bound": "upper_bound",
}
_NOT_ASKED = 2
_RANDOM = "_random_standard_uncertainty"


@dataclass(frozen=True)
class NamedComparison:
    """A comparison with what it is of."""

    name: str
    test: str
    specimen: str
    hose: str
    comparison: Comparison

    @property
    def notes(self) -> tuple[str, ...]:
        """Of the comparison, its verdict and its calibration, none twice."""
        found = self.comparison
        own = () if found.calibration is None else found.calibration.notes
        return tuple(dict.fromkeys((*found.notes, *found.validation.notes, *own)))


def comparisons_to_dataset(named: Sequence[NamedComparison], *, origin: Origin) -> xr.Dataset:
    """Bring comparisons into the form of the archive; no file is touched.

    Parameters
    ----------
    named : sequence of NamedComparison
        One or more, each with a name of its own.
    origin : Origin
        The campaign, the archives of the tests, and the file that says how the hoses are made.

    Returns
    -------
    dataset : xarray.Dataset
        Names, dimensions and attributes of `COMPARISON_SCHEMA`, encoding included. Equal
        inputs give equal datasets.

    Raises
    ------
    ArchiveError
        If there is no comparison, or two have one name.
    """
    names = [one.name for one in named]
    if not named or len(set(names)) < len(names):
        raise ArchiveError(
            "the comparisons cannot be kept", found=", ".join(names) or "none",
            needed="one or more, each with a name of its own",
        )  # fmt: skip
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
        "note_comparison": texts([one.name for one in named for _ in one.notes]),
        "note": texts([note for one in named for note in one.notes]),
    }
    values |= _curve_values(found) | _judgement_values(found) | _calibration_values(found)
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


def _curve_values(found: Sequence[Comparison]) -> Values:
    length = max(one.measured.strain.size for one in found)
    shape = (len(found), len(CURVES), length)
    values: Values = {
        name: np.full(shape, np.nan)
        for name in (
            "measured_tension",
            f"measured_tension{_RANDOM}",
            "tension_difference",
        )
    }
    values |= {name: np.full(shape[:2], np.nan) for name in _OF_CURVE}
    for row, one in enumerate(found):
        size = one.measured.strain.size
        for place, curve in enumerate(CURVES):
            if curve not in one.differences:
                continue
            difference = one.differences[curve]
            values["measured_tension"][row, place, :size] = one.measured.tension_of(curve)
            values[f"measured_tension{_RANDOM}"][row, place, :size] = (
                one.measured.standard_uncertainty_of(curve)
            )
            values["tension_difference"][row, place, :size] = difference.difference
            for name, field in _OF_CURVE.items():
                values[name][row, place] = getattr(difference, field)
    values |= _shared_values(found, values)
    values["strain"] = pad([one.measured.strain for one in found])
    values["predicted_tension"] = pad([one.prediction.tension for one in found])
    values["predicted_tension_standard_uncertainty"] = pad(
        [one.validation.input_standard_uncertainty for one in found]
    )
    values["validation_uncertainty"] = pad([one.validation.standard_uncertainty for one in found])
    return values


def _shared_values(found: Sequence[Comparison], values: Values) -> Values:
    """What the samples of each test share, and the uncertainty of its curves with it."""
    measured = values["measured_tension"]
    component = sorted({each for one in found for each in one.measured.component})
    rows = np.zeros((len(component), *measured.shape))
    for place, one in enumerate(found):
        own = [component.index(each) for each in one.measured.component]
        rows[own, place, :, : one.measured.strain.size] = one.measured.contribution
    return component_values(component) | {
        # where there is no tension, nothing contributes to it
        "measured_tension_uncertainty_contribution": np.where(np.isnan(measured), np.nan, rows),
        "measured_tension_standard_uncertainty": combined_standard_uncertainty(
            rows, values[f"measured_tension{_RANDOM}"]
        ),
    }


def _judgement_values(found: Sequence[Comparison]) -> Values:
    values: Values = {
        name: np.array([float(getattr(one.validation, field)) for one in found])
        for name, field in _OF_VALIDATION.items()
    }
    for name in ("measured_pick_up_strain", "measured_pick_up_strain_standard_uncertainty"):
        values[name] = np.array([getattr(one, name) for one in found])
    values |= {
        "agrees": np.array([int(one.validation.agrees) for one in found]),
        "is_informative": np.array([int(one.validation.is_informative) for one in found]),
        "verdict": texts([one.validation.verdict for one in found]),
        "cycle_bias": pad([one.cycles.bias for one in found]),
        "cycle_rms": pad([one.cycles.rms for one in found]),
        "bias_per_decade": np.array([one.cycles.bias_per_decade for one in found]),
        "bias_per_decade_standard_uncertainty": np.array(
            [one.cycles.bias_per_decade_standard_uncertainty for one in found]
        ),
    }
    numbers = np.zeros(values["cycle_bias"].shape, dtype=np.int32)
    for row, one in zip(numbers, found, strict=True):
        row[: one.cycles.cycle_number.size] = one.cycles.cycle_number
    values["comparison_cycle_number"] = numbers
    for name, field in _OF_EVENT.items():
        values[name] = np.array([[getattr(event, field) for event in one.events] for one in found])
    for name, field in _OF_ENERGY.items():
        values[name] = np.array([getattr(one.energy, field) for one in found])
    return values


def _calibration_values(found: Sequence[Comparison]) -> Values:
    """Nothing where no number was to be fitted."""
    fits = [one.calibration for one in found]
    most = max((len(fit.parameter) for fit in fits if fit is not None), default=0)
    if not most:
        return {}
    named = [() if fit is None else fit.parameter for fit in fits]
    values: Values = {
        "parameter_name": pad_texts(named),
        "parameter_unit": pad_texts([[quantity(name).unit for name in names] for names in named]),
        "parameter_is_at_bound": (_rows(fits, "is_at_bound") == 1).astype(np.int8),
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
    values |= {name: _rows(fits, field) for name, field in _OF_PARAMETER.items()}
    correlation = np.full((len(fits), most, most), np.nan)
    for table, fit in zip(correlation, fits, strict=True):
        if fit is not None:
            size = len(fit.parameter)
            table[:size, :size] = fit.correlation
    values["parameter_correlation"] = correlation
    for name in ("bias", "rms", "relative_rms"):
        values[f"calibrated_{name}"] = np.array(
            [np.nan if fit is None else getattr(fit.after, name) for fit in fits]
        )
    for name in ("collinearity", "least_change", "needed_change"):
        values[name] = np.array(
            [np.nan if fit is None else getattr(fit.identifiability, name) for fit in fits]
        )
    for name in ("model_error", "effective_points"):
        values[name] = np.array([np.nan if fit is None else getattr(fit, name) for fit in fits])
    return values


def _rows(fits: Sequence[Calibration | None], field: str) -> Floats:
    return pad([() if fit is None else getattr(fit, field) for fit in fits])
