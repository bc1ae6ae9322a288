"""What the first loading of a located test gives, by field of `ReducedTest`."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np

from reduction.errors import DataError, FitError
from reduction.moduli.elastomer import fit_elastomers
from reduction.moduli.first_loading import first_loading_curves
from reduction.moduli.product import ElastomerFit, ModulusCurves
from reduction.moduli.stress_at import stress_at_strain
from reduction.pipeline.locate import Located
from reduction.product import History
from reduction.record import Bools, Floats, Specimen, areas_of
from reduction.samples.search import first_sample
from reduction.settings import ReductionSettings
from reduction.workers import run_blocks


def _elastomers(
    name: str,
    strain: Floats,
    stress: Floats,
    earlier_maximum_strain: float,
    *,
    is_first: bool,
) -> tuple[tuple[ElastomerFit, ...], str]:
    """Hyperelastic laws of one first loading, or the reason why there are none."""
    known = np.isfinite(stress)
    if not (strain[known] > 0).any():
        reached = "no stress is known on it"
        if known.any():
            reached = f"strain reaches {100 * strain[known].max():.3g} % on it"
        return (), (
            f"{name}: no hyperelastic law: the first rise of the record is no pull from slack "
            f"({reached}); is the kind of the test right, and where strain is zero?"
        )
    try:
        fits = fit_elastomers(strain[known], stress[known], specimen=name)
    except (DataError, FitError) as error:
        return (), f"{name}: no hyperelastic law from the first loading: {error}"
    if is_first:
        return fits, ""
    note = (
        "not a first loading of the specimen: earlier tests reached "
        f"{100 * earlier_maximum_strain:.0f} %, and below that the rubber is softened"
        if np.isfinite(earlier_maximum_strain)
        else "not a first loading of the specimen: how far earlier tests reached is not known"
    )
    return tuple(replace(fit, notes=(*fit.notes, note)) for fit in fits), ""


def _first_finite(series: Floats) -> float:
    """First finite sample of a series; NaN where there is none."""
    at = first_sample(lambda part: np.isfinite(series[part]), 0, series.size, series)
    return float("nan") if at is None else float(series[at])


def _is_new(history: History, index: int) -> bool:
    """Whether a specimen had seen nothing before the test, logged or not."""
    return not (history.earlier_tests[index] or history.earlier_cycles[index] > 0)


def _without_modulus(curves: ModulusCurves, lacks_area: Bools) -> ModulusCurves:
    """Leave the tension alone to specimens without an area."""
    moduli = [item.name for item in fields(curves) if item.name.startswith("tangent_modulus")]
    emptied = {}
    for name in moduli:
        values = getattr(curves, name).copy()
        values[lacks_area] = 0 if values.dtype.kind == "i" else np.nan
        emptied[name] = values
    return replace(curves, **emptied)


def parts_of_first_loading(
    located: Located,
    strain: Floats,
    tension: Floats,
    specimens: tuple[Specimen, ...],
    settings: ReductionSettings,
    history: History | None,
    *,
    kind: str,
) -> tuple[dict[str, Any], list[str]]:
    """The first rise of a record that begins slack: curve; of rubber, stress and laws too.

    Without an area there is one of a bedding-in alone: its tension, and no modulus.  Beside the
    fields, what a reader has to know of them.
    """
    begins = [_first_finite(force) for force in tension]
    if all(start > located.standstills.slack_tension for start in begins):
        return {}, []
    area = areas_of(specimens)
    has_area = np.isfinite(area)
    if not has_area.all() and kind != "bedding-in":
        return {}, []  # the slow pull of a rope or hose is `reduction.line`'s, without an area
    curves = first_loading_curves(
        strain, tension, area=np.where(has_area, area, 1.0), settings=settings.modulus,
        standstills=located.standstills,
    )  # fmt: skip
    if curves is None or curves.strain_bin.size < 2:
        return {}, []
    curves = _without_modulus(curves, ~has_area)
    rise = curves.branch_tension[:, 0]
    names = located.record.specimens
    parts: dict[str, Any] = {"first_loading": curves}
    rubber = np.array([specimen.is_rubber for specimen in specimens])
    if not rubber.any():
        # cords carry a hose: neither a law of rubber nor its trade's stress at an elongation
        return parts, []
    levels = settings.modulus.stress_at_strain
    stresses = run_blocks(
        lambda row: stress_at_strain(
            strain[row],
            tension[row],
            area=area[row],
            levels=levels,
            is_still=located.standstills.covers,
        ),
        range(area.size),
    )
    notes = [
        f"{name}: stress at {100 * level:g} % not given: {reason}"
        for name, (_, _, reasons), given in zip(names, stresses, rubber, strict=True)
        if given
        for level, reason in zip(levels, reasons, strict=True)
        if reason
    ]
    stress, spread = (
        np.where(rubber[:, None], np.array([one[part] for one in stresses]), np.nan)
        for part in (0, 1)
    )
    parts |= {
        "stress_at_strain": stress,
        "stress_at_strain_standard_uncertainty": spread,
        "stress_at_strain_levels": levels,
    }
    earlier = np.full(area.size, np.nan) if history is None else history.earlier_maximum_strain
    is_first = [history is None or _is_new(history, index) for index in range(area.size)]
    found = [
        _elastomers(
            name,
            curves.strain_bin,
            rise[index] / area[index],
            float(earlier[index]),
            is_first=is_first[index],
        )
        for index, name in enumerate(names)
        if rubber[index]
    ]
    parts["elastomers"] = tuple(fit for fits, _ in found for fit in fits)
    notes += [reason for _, reason in found if reason]
    return parts, notes
