"""The way of the data, on one page: a record in SI to a reduced test.  Pure: no file, no clock.

`locate` finds where the test stands still and where it cycles; the tension at the
splice marks is measured there.  `reduce_test` does the rest once the marks of all
tests of a specimen have been pooled.  `reduce_steps` is for tests read by a person.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.cycles.find import find_cycles
from reduction.cycles.label import label_phases
from reduction.cycles.loops import close_loops
from reduction.cycles.product import Cycles
from reduction.errors import DataError, FitError
from reduction.holds.reduce import reduce_holds
from reduction.moduli.amplitude import summarise_amplitude
from reduction.moduli.compare import compare_curves, compare_cycles
from reduction.moduli.elastomer import fit_elastomers
from reduction.moduli.first_loading import first_loading_curves
from reduction.moduli.identity import check_identity
from reduction.moduli.permanent_set import permanent_set
from reduction.moduli.product import ElastomerFit
from reduction.moduli.segments import find_segments
from reduction.moduli.slip import cycle_tension_level, find_slips
from reduction.moduli.stepwise import reduce_stepwise
from reduction.moduli.stress_at import stress_at_strain
from reduction.moduli.tangent import tangent_curves
from reduction.moduli.trend import fit_peak_trend
from reduction.phases.standstill import Standstills, find_standstills
from reduction.product import History, ReducedTest, TestDescription
from reduction.provenance import Source, Step
from reduction.record import Floats, Quality, Record, Specimen, StepReadings
from reduction.settings import ReductionSettings
from reduction.strain.evaluate import extrapolated, free_length_strain_of
from reduction.strain.model import StrainModel
from reduction.strain.stress import check_constant_volume

__all__ = ["CYCLIC", "Located", "locate", "reduce_steps", "reduce_test"]

CYCLIC = ("cyclic", "fatigue")
PULLED = ("quasi-static", "tensile")
HELD = ("relaxation", "creep")
# cycles at each end of a long test of which the kept curves are compared
ENDS = 6
_UNUSABLE = Quality.MISSING | Quality.SATURATED | Quality.STUCK | Quality.SPIKE


@dataclass(frozen=True)
class Located:
    """A record with its standstills and, where the test has them, its cycles."""

    record: Record
    standstills: Standstills
    cycles: Cycles | None


def locate(record: Record, *, kind: str, settings: ReductionSettings) -> Located:
    """Find the standstills and the cycles of a record; only cyclic kinds have cycles."""
    if kind not in (*CYCLIC, *PULLED, *HELD):
        raise DataError(
            f"test '{record.test_id}' is of a kind that this version does not reduce",
            found=kind,
            needed="one of " + ", ".join((*CYCLIC, *PULLED, *HELD, "stepwise")),
        )
    standstills = find_standstills(
        record.time, record.crosshead_position, record.tension, settings=settings.phases
    )
    if kind not in CYCLIC:
        return Located(record, standstills, None)
    cycles = find_cycles(
        record.time,
        record.crosshead_position,
        record.tension,
        standstills,
        settings=settings.cycles,
        cycle_counter=record.cycle_counter,
    )
    return Located(record, standstills, cycles)


def _usable(values: Floats, flags: NDArray[np.uint16]) -> Floats:
    """A channel without the samples that no number may rest on, NaN there."""
    flagged = (flags & _UNUSABLE) != 0
    return np.where(flagged, np.nan, values) if flagged.any() else values


def _flag(located: Located, models: Sequence[StrainModel]) -> Record:
    """The record with the flags that only cycles and strain models can set."""
    record, cycles = located.record, located.cycles
    flags = record.quality_flag.copy()
    of_position = record.crosshead_position_quality_flag
    for index, model in enumerate(models):
        outside = extrapolated(model, record.crosshead_position, record.tension[index])
        flags[index][outside] |= np.uint16(Quality.EXTRAPOLATED)
    if cycles is not None:
        uneven = (cycles.cycle_number > 0) & ~cycles.is_constant_rate
        flags[:, uneven] |= np.uint16(Quality.NOT_CONSTANT_RATE)
        of_position = of_position.copy()
        of_position[uneven] |= np.uint16(Quality.NOT_CONSTANT_RATE)
    return replace(record, quality_flag=flags, crosshead_position_quality_flag=of_position)


def _strain(record: Record, tension: Floats, models: Sequence[StrainModel]) -> Floats:
    """Strain of each specimen; NaN where position, or a tension that it needs, is not usable."""
    position = _usable(record.crosshead_position, record.crosshead_position_quality_flag)
    strain = np.empty_like(tension)
    for index, model in enumerate(models):
        strain[index] = free_length_strain_of(
            model,
            position=position,
            tension=tension[index],
            measured_strain=None
            if record.measured_strain is None
            else record.measured_strain[index],
        )
    return strain


def _of_cycles(
    located: Located, strain: Floats, tension: Floats, area: Floats, settings: ReductionSettings
) -> dict[str, Any]:
    """Loops, curves, segments and what follows from them, by field of `ReducedTest`."""
    record, cycles = located.record, located.cycles
    if cycles is None:
        return {}
    break_in = settings.cycles.break_in_cycles
    loops = close_loops(record.time, tension, strain, cycles, waveform=settings.cycles.waveform)
    curves = tangent_curves(
        strain, tension, area=area, cycles=cycles, settings=settings.modulus,
        break_in_cycles=break_in,
    )  # fmt: skip
    parts: dict[str, Any] = {
        "loops": loops,
        "curves": curves,
        "segments": find_segments(curves, area=area, settings=settings.modulus),
        "identity": check_identity(strain, tension, area=area, cycles=cycles),
        "amplitude": summarise_amplitude(loops, area=area, break_in_cycles=break_in),
        "trend": fit_peak_trend(loops, area=area, break_in_cycles=break_in),
    }
    # each specimen against the first: used against new, where the campaign names new first
    ratios = [
        compare_curves(
            curves, curves, numerator_specimen=index, denominator_specimen=0,
            numerator_name=name, denominator_name=record.specimens[0],
        )
        for index, name in enumerate(record.specimens[1:], start=1)
    ]  # fmt: skip
    if cycles.n_cycles >= settings.slip.minimum_cycles:
        level, slope = cycle_tension_level(
            record.crosshead_position, tension, cycle_number=cycles.cycle_number,
            branch=cycles.branch, n_cycles=cycles.n_cycles,
        )  # fmt: skip
        parts["slips"] = find_slips(
            loops, specimens=record.specimens, settings=settings.slip,
            tension_level=level, tension_slope=slope,
        )  # fmt: skip
        kept = curves.selected_cycle
        begin = kept[kept <= ENDS].tolist()
        end = kept[kept > cycles.n_cycles - ENDS].tolist()
        for index, name in enumerate(record.specimens):
            ratio = compare_cycles(
                curves, specimen=index, numerator_cycles=end, denominator_cycles=begin
            )
            ratios.append(
                replace(
                    ratio,
                    numerator=f"{name}, {ratio.numerator}",
                    denominator=f"{name}, {ratio.denominator}",
                )
            )
    parts["ratios"] = tuple(ratios)
    return parts


def _elastomers(
    name: str, strain: Floats, stress: Floats, earlier_maximum_strain: float
) -> tuple[tuple[ElastomerFit, ...], str]:
    """Hyperelastic laws of one first loading, or the reason why there are none."""
    known = np.isfinite(stress)
    try:
        fits = fit_elastomers(strain[known], stress[known], specimen=name)
    except (DataError, FitError) as error:
        return (), f"{name}: no hyperelastic law from the first loading: {error}"
    if not np.isfinite(earlier_maximum_strain):
        return fits, ""
    note = (
        "not a first loading of the specimen: earlier tests reached "
        f"{100 * earlier_maximum_strain:.0f} %, and below that the rubber is softened"
    )
    return tuple(replace(fit, notes=(*fit.notes, note)) for fit in fits), ""


def _of_first_loading(
    located: Located,
    strain: Floats,
    tension: Floats,
    area: Floats,
    settings: ReductionSettings,
    history: History | None,
) -> dict[str, Any]:
    """The first rise of a record that begins slack: curve, stress at elongation, laws."""
    curves = first_loading_curves(
        strain, tension, area=area, settings=settings.modulus, standstills=located.standstills
    )
    if curves is None or curves.strain_bin.size < 2:
        return {}
    rise = curves.branch_tension[:, 0]
    levels = settings.modulus.stress_at_strain
    parts: dict[str, Any] = {
        "first_loading": curves,
        "stress_at_strain": stress_at_strain(curves.strain_bin, rise, area=area, levels=levels),
        "stress_at_strain_levels": levels,
    }
    if located.standstills.is_rest.any() or located.cycles is None:
        earlier = np.full(area.size, np.nan) if history is None else history.earlier_maximum_strain
        found = [
            _elastomers(name, curves.strain_bin, rise[index] / area[index], float(earlier[index]))
            for index, name in enumerate(located.record.specimens)
        ]
        parts["elastomers"] = tuple(fit for fits, _ in found for fit in fits)
        parts["notes"] = [reason for _, reason in found if reason]
    return parts


def reduce_test(
    located: Located,
    *,
    description: TestDescription,
    specimens: tuple[Specimen, ...],
    models: Sequence[StrainModel],
    history: History | None,
    sources: tuple[Source, ...],
    settings: ReductionSettings,
    settings_json: str,
) -> ReducedTest:
    """Reduce one located test.

    Parameters
    ----------
    located : Located
        From `locate`.
    description : TestDescription
        What the laboratory kept.
    specimens : tuple of Specimen, length n_specimens
        In the order of the record.
    models : sequence of StrainModel, length n_specimens
        How position becomes strain.
    history : History or None
        What the specimens had seen before.
    sources : tuple of Source
        Raw files.
    settings : ReductionSettings
        In force.
    settings_json : str
        The same with everything else that was in force, for the product.

    Returns
    -------
    test : ReducedTest
        Ready for the archive.

    Raises
    ------
    DataError
        If the record cannot support a stage that its kind needs.
    """
    record, standstills, cycles = located.record, located.standstills, located.cycles
    area = np.array([specimen.area for specimen in specimens])
    tension = _usable(record.tension, record.quality_flag)
    strain = _strain(record, tension, models)
    parts = _of_cycles(located, strain, tension, area, settings)
    parts |= _of_first_loading(located, strain, tension, area, settings, history)
    holds = reduce_holds(
        record.time, record.crosshead_position, tension, strain, standstills,
        specimens=record.specimens, settings=settings.holds,
        kind="creep" if description.kind == "creep" else "relaxation",
    )  # fmt: skip
    left, left_uncertainty, remarks = permanent_set(
        record.crosshead_position,
        tension,
        slack_tension=standstills.slack_tension,
        relaxed_free_length=np.array(
            [model.coefficients.get("relaxed_free_length", np.nan) for model in models]
        ),
    )
    notes = [note for specimen in specimens for note in check_constant_volume(specimen)]
    notes += parts.pop("notes", [])
    notes += [
        f"{name}, permanent set: {text}"
        for name, text in zip(record.specimens, remarks, strict=True)
        if text
    ]
    return ReducedTest(
        description=description,
        specimens=specimens,
        record=_flag(located, models),
        sources=sources,
        steps=_steps(located, models),
        settings_json=settings_json,
        notes=tuple(dict.fromkeys(notes)),
        history=history,
        standstills=standstills,
        phase=label_phases(record.n_samples, standstills=standstills, cycles=cycles),
        strain=strain,
        strain_models=tuple(models),
        cycles=cycles,
        holds=holds,
        permanent_set=left,
        permanent_set_standard_uncertainty=left_uncertainty,
        **parts,
    )


def reduce_steps(
    readings: StepReadings,
    *,
    description: TestDescription,
    specimens: tuple[Specimen, ...],
    sources: tuple[Source, ...],
    settings_json: str,
) -> ReducedTest:
    """Reduce a stepwise test of one specimen; parameters as in `reduce_test`."""
    if len(specimens) != 1:
        raise DataError(
            f"stepwise test '{description.test_id}' has several specimens",
            found=str(len(specimens)),
            needed="one",
        )
    specimen = specimens[0]
    stepwise = reduce_stepwise(
        readings, area=specimen.area, stated_gauge_length=specimen.gauge_length
    )
    return ReducedTest(
        description=description,
        specimens=specimens,
        record=None,
        sources=sources,
        steps=(
            Step("ingest", f"{readings.tension.size} readings"),
            Step("moduli", "gauge length recovered, slopes between readings"),
        ),
        settings_json=settings_json,
        notes=check_constant_volume(specimen),
        stepwise=stepwise,
    )


def _steps(located: Located, models: Sequence[StrainModel]) -> tuple[Step, ...]:
    """One line a stage, with the numbers it found."""
    record, standstills, cycles = located.record, located.standstills, located.cycles
    steps = [
        Step("ingest", f"{record.n_rows_read} rows read, {record.n_samples} kept"),
        Step(
            "phases",
            f"{standstills.n_standstills} standstills within "
            f"{standstills.position_tolerance:.4g} m, slack at {standstills.slack_tension:.4g} N",
        ),
    ]
    for model in models:
        numbers = ", ".join(f"{name} {value:.6g}" for name, value in model.coefficients.items())
        steps.append(Step("strain", f"{model.specimen} by {model.method}: {numbers}"))
    if cycles is not None:
        steps.append(
            Step("cycles", f"{cycles.n_cycles} by {cycles.counted_by}, band {cycles.band:.4g}")
        )
        steps.append(Step("moduli", "regression in a moving window on a strain grid, SI"))
    return tuple(steps)
