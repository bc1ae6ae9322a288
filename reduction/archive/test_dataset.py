"""Converts a reduced test to a dataset that follows CF."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.dataset_builder import build_dataset, global_attributes
from reduction.archive.shared_errors import with_shared
from reduction.archive.test_variables import (
    COEFFICIENTS,
    curve_values,
    cycle_values,
    elastomer_values,
    first_loading_values,
    hold_values,
    lag_values,
    line_values,
    pull_values,
    random_of_line,
    ratio_values,
    rope_values,
    segment_values,
    slip_values,
    spread_of_line_values,
    standstill_values,
    stepwise_values,
    stress_at_strain_values,
    values_of,
    with_uncertainty,
)
from reduction.archive.variables import Values, note_values, numbers, pad, texts
from reduction.quantities.flags import QUALITY_MASKS
from reduction.quantities.names import STEPWISE_SCHEMA, TEST_SCHEMA
from reduction.record.contributions import Contributions
from reduction.record.errors import ArchiveError
from reduction.record.measurement import (
    UNUSABLE,
    Floats,
    Integers,
    Record,
    Specimen,
    read_only_arrays,
)
from reduction.record.samples import empty_like, full_like, sample_blocks, take_samples
from reduction.record.settings import ReductionSettings, StrainMethod
from reduction.stages.moduli.local_regression import select_cycles
from reduction.stages.reduced_test import History, ReducedTest
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.strain.stress import nominal_stress


def strain_model_of(dataset: xr.Dataset, place: int) -> StrainModel | None:
    """Method and coefficients of one specimen's strain, without marks and covariance."""
    if "strain_method" not in dataset:
        return None

    def number(name: str) -> float:
        return float(dataset.variables[name].values[place]) if name in dataset else float("nan")

    known = {name: number(stored) for name, stored in COEFFICIENTS.items()}
    return StrainModel(
        specimen=str(dataset.variables["specimen"].values[place]),
        method=cast("StrainMethod", str(dataset.variables["strain_method"].values[place])),
        coefficients={name: value for name, value in known.items() if np.isfinite(value)},
        marks_from=str(dataset.variables["strain_marks_from"].values[place]),
        position_low=number("strain_position_low"),
        position_high=number("strain_position_high"),
        tension_low=number("strain_tension_low"),
        tension_high=number("strain_tension_high"),
        reference_tension=float(np.nan_to_num(number("strain_reference_tension"))),
    )


def _specimen_values(specimens: Sequence[Specimen]) -> Values:
    """Return the data of each specimen before the test."""
    known = [one.mean_diameter if one.diameter else None for one in specimens]
    area = numbers([one.area if one.has_area else None for one in specimens])
    spread = numbers([one.diameter_scatter for one in specimens])
    return {
        "specimen": texts([one.name for one in specimens]),
        "specimen_kind": texts([one.kind for one in specimens]),
        "specimen_material": texts([one.material for one in specimens]),
        "specimen_construction": texts([one.construction for one in specimens]),
        "specimen_condition": texts([one.condition for one in specimens]),
        "diameter": numbers(known),
        "diameter_standard_uncertainty": spread,
        "diameter_reading": pad([one.diameter for one in specimens]),
        "stretched_diameter_strain": pad(
            [[strain for strain, _ in one.stretched_diameters] for one in specimens]
        ),
        "stretched_diameter": pad(
            [[diameter for _, diameter in one.stretched_diameters] for one in specimens]
        ),
        "area": area,
        "area_standard_uncertainty": numbers(
            [one.area_scatter if one.has_area else None for one in specimens]
        ),
        "rated_break_strength": numbers([one.rated_break_strength for one in specimens]),
        "rated_break_strength_source": texts(
            [one.rated_break_strength_source for one in specimens]
        ),
        "declared_gauge_length": numbers([one.gauge_length for one in specimens]),
        **_linear_densities(specimens),
    }


def _random_of_section(specimens: Sequence[Specimen], contributions: Contributions) -> Values:
    """Random part of diameters and areas: none if the error of the mean diameter is shared."""
    rows = contributions.values.get("diameter")
    if rows is None:
        return {}
    stated = np.any(rows != 0, axis=0)
    own = _specimen_values(specimens)
    names = ("diameter", "area")
    return {name: np.where(stated, 0.0, own[f"{name}_standard_uncertainty"]) for name in names}


def _linear_densities(specimens: Sequence[Specimen]) -> Values:
    """Mass per length in air and in water, if stated for any specimen."""
    values = {
        "linear_density": numbers([one.linear_density for one in specimens]),
        "wet_linear_density": numbers([one.wet_linear_density for one in specimens]),
    }
    return {name: found for name, found in values.items() if np.isfinite(found).any()}


def _history_values(history: History) -> Values:
    """Return the history of each specimen before the test."""
    flex = history.earlier_flex_cycles
    return {
        "earlier_tests": texts([", ".join(tests) for tests in history.earlier_tests]),
        "earlier_maximum_strain": history.earlier_maximum_strain,
        "earlier_maximum_tension": history.earlier_maximum_tension,
        "earlier_cycles": history.earlier_cycles,
        **({} if flex is None else {"earlier_flex_cycles": flex}),
        "permanent_set": history.permanent_set,
        "permanent_set_standard_uncertainty": history.permanent_set_standard_uncertainty,
    }


def _strain_model_values(models: Sequence[StrainModel]) -> Values:
    """Return method, coefficients, ranges and marks for each specimen's strain."""
    values: Values = {
        "strain_method": texts([one.method for one in models]),
        "strain_marks_from": texts([one.marks_from for one in models]),
        "strain_slope_ratio": numbers([one.strain_slope_ratio for one in models]),
    }
    for end in ("position_low", "position_high", "tension_low", "tension_high"):
        values[f"strain_{end}"] = numbers([getattr(one, end) for one in models])
    if any(one.reference_tension for one in models):
        values["strain_reference_tension"] = numbers([one.reference_tension for one in models])
    values |= _coefficient_values(models)
    return values | _mark_values(models)


def _coefficient_values(models: Sequence[StrainModel]) -> Values:
    used = {name for one in models for name in one.coefficients}
    unknown = sorted(used - set(COEFFICIENTS))
    if unknown:
        raise ArchiveError(
            "a strain method has coefficients that the archive has no name for",
            found=", ".join(unknown),
            needed=f"names among {', '.join(COEFFICIENTS)}",
            hint="Add its row to reduction.quantities.samples_and_cycles, and the name to "
            "COEFFICIENTS.",
        )
    names = [name for name in COEFFICIENTS if name in used]
    uncertainty = np.full((len(models), len(names)), np.nan)
    correlation = np.full((len(models), len(names), len(names)), np.nan)
    for row, one in enumerate(models):
        at = [names.index(name) for name in one.coefficients]
        deviation, matrix = _deviation_and_correlation(one)
        uncertainty[row, at] = deviation
        correlation[row][np.ix_(at, at)] = matrix
    stored = [COEFFICIENTS[name] for name in names]
    values: Values = {
        "coefficient_name": texts(stored),
        "coefficient_name_other": texts(stored),
        "strain_coefficient_correlation": correlation,
    }
    for column, (name, here) in enumerate(zip(names, stored, strict=True)):
        values[here] = numbers([one.coefficients.get(name) for one in models])
        values[f"{here}_standard_uncertainty"] = uncertainty[:, column]
    return values


def _deviation_and_correlation(model: StrainModel) -> tuple[Floats, Floats]:
    """Split a covariance with mixed units into parts with one unit each."""
    size = len(model.coefficients)
    if model.covariance.shape != (size, size):
        return np.full(size, np.nan), np.full((size, size), np.nan)
    # from the tape and from the choice of splice law
    covariance = model.covariance + (model.law_covariance if model.law_covariance.size else 0.0)
    deviation = np.sqrt(np.diag(covariance))
    scale = np.outer(deviation, deviation)
    # an exact coefficient has no spread and correlates only with itself
    correlation = np.divide(covariance, scale, out=np.eye(size), where=scale > 0)
    return deviation, correlation


def _mark_values(models: Sequence[StrainModel]) -> Values:
    def joined(name: str) -> Floats:
        return np.concatenate([np.empty(0), *(getattr(one, name) for one in models)])

    return {
        "mark_specimen": texts([one.specimen for one in models for _ in one.mark_test]),
        "mark_test": texts([test for one in models for test in one.mark_test]),
        "mark_hold": texts([hold for one in models for hold in one.mark_hold]),
        "mark_position": joined("mark_position"),
        "mark_strain": joined("mark_strain"),
        "mark_tension": joined("mark_tension"),
        "mark_strain_residual": joined("mark_strain_residual"),
    }


_SHARE = 8
"""Of a record too long to be stored whole, at most this fraction for cycles, and for the rest."""


@dataclass(frozen=True)
@read_only_arrays
class _KeptSamples:
    """Selection of samples from a record that is not stored whole."""

    index: Integers
    words: str

    def of(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return the stored samples of a series, shape (..., n_stored)."""
        return take_samples(values, self.index)


def kept_samples(test: ReducedTest, settings: ReductionSettings) -> _KeptSamples | None:
    """Choose the samples of a test to be stored in its archive."""
    record, wanted = test.record, settings.archive
    if record is None or wanted.samples == "all":
        return None
    if wanted.samples is None and record.n_samples <= wanted.longest_record:
        return None
    numbers = _cycles_with_curves(test, settings.modulus.selected_cycles)
    first, last = (
        (np.empty(0, dtype=np.int64),) * 2
        if test.cycles is None
        else (test.cycles.first, test.cycles.last)
    )
    most = wanted.longest_record // _SHARE
    of_cycles, step = _places(first[numbers - 1], last[numbers - 1] + 1, most)
    outside, step_outside = _places(
        np.concatenate([[0], last + 1]), np.concatenate([first, [record.n_samples]]), most
    )
    # two cycles share the sample at the turn between them
    index = np.union1d(of_cycles, outside)
    if index.size == record.n_samples:
        return None
    words = f"{index.size} of {record.n_samples}"
    if numbers.size:
        listed = ", ".join(map(str, numbers))
        words += f"; {numbers.size} of {first.size} cycles ({listed}){_every(step)}"
    words += f"; what is in no cycle{_every(step_outside)}"
    return _KeptSamples(index=index, words=words)


def _cycles_with_curves(test: ReducedTest, longest: int) -> Integers:
    if test.cycles is None or not test.cycles.n_cycles:
        return np.empty(0, dtype=np.int64)
    numbers = select_cycles(test.cycles.n_cycles, longest=longest)
    # curves that pool cycles are named after the first one
    return numbers if test.curves is None else np.union1d(numbers, test.curves.selected_cycle)


def _places(start: Integers, stop: Integers, most: int) -> tuple[Integers, int]:
    """Every k-th sample of intervals and the last of each, about ``most`` in all; and k."""
    is_stretch = stop > start
    start, stop = start[is_stretch], stop[is_stretch]
    step = max(1, -(-int((stop - start).sum()) // most))
    pairs = zip(start.tolist(), stop.tolist(), strict=True)
    return np.concatenate([stop - 1, *(np.arange(*pair, step) for pair in pairs)]), step


def _every(step: int) -> str:
    return "" if step == 1 else f", one sample in {step} of it and its ends"


def stored_cycles(dataset: xr.Dataset) -> Integers:
    """Return the numbers of the cycles with stored samples in an archive."""
    if "cycle" not in dataset:
        return np.empty(0, dtype=np.int64)
    numbers: Integers = dataset.variables["cycle"].values
    if "sample_index" not in dataset:
        return numbers
    index = dataset.variables["sample_index"].values
    begin = np.searchsorted(index, dataset.variables["cycle_first_sample"].values, side="left")
    end = np.searchsorted(index, dataset.variables["cycle_last_sample"].values, side="right")
    return numbers[end - begin > 2]


def _sample_values(test: ReducedTest, record: Record, kept: _KeptSamples | None = None) -> Values:
    """Return all variables along ``sample``, with the declared uncertainties."""

    def stored(values: NDArray[Any]) -> NDArray[Any]:
        return values if kept is None else kept.of(values)

    position = "crosshead_position" if record.position_is_length else "crosshead_displacement"
    tension, flags = stored(record.tension), stored(record.quality_flag)
    values: Values = {
        "time": stored(record.time),
        position: stored(record.crosshead_position),
        f"{position}_standard_uncertainty": np.array(record.position_standard_uncertainty),
        "crosshead_position_quality_flag": stored(record.crosshead_position_quality_flag),
        "tension": tension,
        "quality_flag": flags,
    }
    if kept is not None:
        values["sample_index"] = kept.index
    if record.tension_standard_uncertainty:
        values["tension_standard_uncertainty"] = np.array(record.tension_standard_uncertainty)
    if record.measured_strain is not None:
        values["measured_strain"] = stored(record.measured_strain)
    if record.fill_pressure is not None:
        values["fill_pressure"] = stored(record.fill_pressure)
        values["fill_pressure_standard_uncertainty"] = np.array(
            record.fill_pressure_standard_uncertainty
        )
    if record.cycle_counter is not None:
        values["machine_cycle_number"] = _narrowed(stored(record.cycle_counter))
    if test.strain is not None:
        values["strain"] = stored(test.strain)
    if test.strain_standard_uncertainty is not None:
        values["strain_standard_uncertainty"] = test.strain_standard_uncertainty
    if any(specimen.has_area for specimen in test.specimens):
        values["nominal_stress"] = _stress(tension, flags, test.specimens)
    if test.nominal_stress_standard_uncertainty is not None:
        values["nominal_stress_standard_uncertainty"] = test.nominal_stress_standard_uncertainty
    if test.phase is not None:
        values["phase"] = stored(test.phase)
    if test.cycles is not None:
        values["cycle_number"] = stored(test.cycles.cycle_number)
        values["branch"] = stored(test.cycles.branch)
    return values


def _narrowed(numbers: Integers) -> Integers:
    """Integers in their stored width, processed by blocks."""
    narrow: Integers = empty_like(numbers, dtype=np.int32)
    for part in sample_blocks(numbers.size, numbers, narrow):
        narrow[part] = numbers[part]
    return narrow


def _stress(tension: Floats, flags: Integers, specimens: tuple[Specimen, ...]) -> Floats:
    """Nominal stress if an area is known and tension is usable, NaN elsewhere."""
    stress: Floats = full_like(tension, np.nan)
    for row, specimen in enumerate(specimens):
        if specimen.has_area:
            for part in sample_blocks(tension.shape[1], tension, flags, stress):
                known = np.where(flags[row, part] & UNUSABLE, np.nan, tension[row, part])
                stress[row, part] = nominal_stress(known, area=specimen.area)
    return stress


def _row_counts(record: Record, kept: _KeptSamples | None = None) -> Values:
    """Count rows read, kept, stored and flagged by channel and mask."""
    flags = [record.crosshead_position_quality_flag, *record.quality_flag]
    return {
        "n_rows_read": np.array(record.n_rows_read),
        "n_rows_kept": np.array(record.n_samples),
        "n_rows_stored": np.array(record.n_samples if kept is None else kept.index.size),
        "channel": texts(
            ["time and crosshead position", *(f"tension of {name}" for name in record.specimens)]
        ),
        "quality_mask": texts(list(QUALITY_MASKS)),
        "n_flagged": np.array([_counts(row) for row in flags]),
    }


def _counts(flags: Integers) -> list[int]:
    """Number of samples with each mask."""
    counts = dict.fromkeys(QUALITY_MASKS.values(), 0)
    for part in sample_blocks(flags.size, flags):
        block = flags[part]
        seen = int(np.bitwise_or.reduce(block))
        for bit in counts:
            if seen & bit:
                counts[bit] += int(np.count_nonzero(block & bit))
    return list(counts.values())


def to_dataset(
    test: ReducedTest, *, version: str, command: str, kept: _KeptSamples | None = None
) -> xr.Dataset:
    """Convert a reduced test to the archive dataset, without writing a file."""
    return build_dataset(
        _all_values(test, kept),
        TEST_SCHEMA if test.stepwise is None else STEPWISE_SCHEMA,
        attributes=global_attributes(
            test, version=version, command=command, samples="all" if kept is None else kept.words
        ),
    )


def _all_values(test: ReducedTest, kept: _KeptSamples | None) -> Values:
    names = tuple(one.name for one in test.specimens)
    values = _specimen_values(test.specimens) | note_values(test.all_notes())
    if test.stepwise is not None:
        values |= stepwise_values(test.stepwise)
    elif test.record is not None:
        values |= _row_counts(test.record, kept) | _sample_values(test, test.record, kept)
    if test.history is not None:
        values |= _history_values(test.history)
    if test.strain_models:
        values |= _strain_model_values(test.strain_models)
    if test.standstills is not None:
        values |= standstill_values(test.standstills)
    if test.cycles is not None:
        values |= cycle_values(test.cycles, control=test.description.control)
    if test.loops is not None:
        values |= with_uncertainty(test.loops)
    if test.end_moduli is not None:
        values |= values_of(test.end_moduli)
    if test.identity is not None:
        values |= values_of(test.identity, without=("notes",))
    if test.amplitude is not None:
        values |= with_uncertainty(test.amplitude, "test_")
    if test.line is not None and test.line_of_test is not None:
        values |= line_values(test.line, test.line_of_test, test.quasi_static_standard_uncertainty)
    if any(test.pulls):
        values |= pull_values(test.pulls, test.specimens)
    if test.rope_step is not None:
        values |= rope_values(test.rope_step, test.specimens)
    if test.trend is not None:
        values |= values_of(test.trend)
    if test.slips is not None:
        values |= slip_values(test.slips, specimens=names)
    if test.curves is not None:
        values |= curve_values(test.curves)
    if test.first_loading is not None:
        values |= first_loading_values(test.first_loading)
    if test.segments is not None:
        values |= segment_values(test.segments)
    if test.ratios:
        values |= ratio_values(test.ratios)
    if test.elastomers:
        values |= elastomer_values(test.elastomers)
    if test.holds:
        values |= hold_values(test.holds)
    stress, spread = test.stress_at_strain, test.stress_at_strain_standard_uncertainty
    if stress is not None and spread is not None:
        values |= stress_at_strain_values(stress, spread, test.stress_at_strain_levels)
    if test.slack_strain is not None:
        left = test.slack_strain
        values["slack_strain_at_unloading"] = left.strain
        values["slack_strain_at_unloading_standard_uncertainty"] = left.standard_uncertainty
    values = with_shared(
        values,
        test.contributions,
        test.shared_uncertainty_of_cycles,
        (
            {}
            if test.line is None or test.line_of_test is None
            else random_of_line(test.line, test.line_of_test)
        )
        | (
            {}
            if test.contributions is None
            else _random_of_section(test.specimens, test.contributions)
        ),
    )
    if test.channel_lag is not None:
        values |= lag_values(test.channel_lag)
    if test.line_of_test is not None and test.line_spread is not None:
        values |= spread_of_line_values(test.line_spread, values)
    return values
