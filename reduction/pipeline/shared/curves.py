"""What shared errors add to the curves and the segments of a specimen."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import median_filter

from reduction.moduli.product import ModulusCurves, Segments
from reduction.pipeline.shared.loops import speed_ratio
from reduction.product import ReducedTest
from reduction.record import Floats
from reduction.settings import CycleSettings
from reduction.strain.model import StrainModel
from reduction.uncertainty.curves import curve_contributions, strain_rate_of_wave
from reduction.uncertainty.field import error_field
from reduction.uncertainty.product import Contributions, InstrumentErrors
from reduction.uncertainty.segments import segment_contributions

__all__ = ["of_curves", "of_segments", "rise_rates", "strain_rates"]

_SMOOTHED = 5  # bins: a slope of the modulus from bin to bin is mostly scatter


def strain_rates(
    test: ReducedTest, index: int, model: StrainModel, cycles: CycleSettings
) -> Floats:
    """Strain rate on the grid, and its slope over strain; descending below ascending."""
    if test.amplitude is None or test.cycles is None or test.curves is None:
        return np.zeros((2, 2, 0 if test.curves is None else test.curves.strain_bin.size))
    summary = test.amplitude
    frequency, amplitude = summary.frequency[index], summary.strain_amplitude[index]
    if not (frequency > 0 and amplitude > 0):
        return np.zeros((2, 2, test.curves.strain_bin.size))
    rate, slope = strain_rate_of_wave(
        test.curves.strain_bin,
        frequency=float(frequency),
        mean_strain=float(summary.mean_strain[index]),
        strain_amplitude=float(amplitude),
        waveform=cycles.waveform,
        speed_ratio=float(speed_ratio(summary, index, model, test.cycles, cycles)),
    )
    return np.stack([[rate, -rate], [slope, -slope]])


def rise_rates(test: ReducedTest, index: int) -> Floats:
    """Strain rate of the first rise on its grid, and its slope; zero on the descending branch.

    From the times at which a strain is first reached: a stop on the way is one slow bin, which the
    median of its neighbours leaves out.
    """
    if test.first_loading is None or test.record is None or test.strain is None:
        return np.zeros(
            (2, 2, 0 if test.first_loading is None else test.first_loading.strain_bin.size)
        )
    at = test.first_loading.strain_bin
    still = np.zeros(at.size)
    strain = test.strain[index]
    reached = strain >= at[-1]
    end = int(reached.argmax()) + 1 if reached.any() else strain.size
    highest = np.fmax.accumulate(strain[:end])
    begin = int(np.isfinite(highest).argmax())
    place = np.searchsorted(highest[begin:], at) + begin
    inside = place < end
    if inside.sum() <= _SMOOTHED:
        return np.stack([[still, still], [still, still]])
    reach, time = at[inside], test.record.time[place[inside]]
    with np.errstate(divide="ignore"):
        found = median_filter(
            np.gradient(reach) / np.gradient(time), size=_SMOOTHED, mode="nearest"
        )
    rate = np.interp(at, reach, np.where(np.isfinite(found), found, 0.0))
    return np.stack([[rate, still], [_smooth_slope(rate, at), still]])


def _smooth_slope(modulus: Floats, strain: Floats) -> Floats:
    """Slope of the modulus over strain, of a running mean; zero where there are too few bins."""
    known = np.isfinite(modulus)
    if known.sum() <= _SMOOTHED:
        return np.zeros(modulus.shape)
    at, values = strain[known], modulus[known]
    edge = _SMOOTHED // 2
    # straight lines in windows: a running mean would flatten the ends
    left = np.clip(np.arange(at.size) - edge, 0, at.size - _SMOOTHED)
    window = left[:, None] + np.arange(_SMOOTHED)
    x = at[window] - at[window].mean(axis=1, keepdims=True)
    slope = np.sum(x * values[window], axis=1) / np.sum(x**2, axis=1)
    return np.asarray(np.interp(strain, at, slope))


def of_curves(
    curves: ModulusCurves,
    suffix: str,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    area: float,
    rate: Floats,
) -> Contributions:
    """Both branches of one specimen, by name of the archive."""
    strain = np.broadcast_to(curves.strain_bin, curves.branch_tension[index].shape)
    field = error_field(errors, model, strain=strain, tension=curves.branch_tension[index])
    values = {}
    for name, moduli in (
        (f"tangent_modulus{suffix}", curves.tangent_modulus),
        (f"tangent_modulus_untrimmed{suffix}", curves.tangent_modulus_untrimmed),
    ):
        modulus = moduli[index]
        found = curve_contributions(
            field, errors, tangent_modulus=modulus, area=area,
            modulus_slope=np.stack([_smooth_slope(row, curves.strain_bin) for row in modulus]),
            strain_rate=rate[0], strain_rate_slope=rate[1],
        )  # fmt: skip
        values[name] = found.values["tangent_modulus"]
    # trimmed or not, the tension is known wherever a modulus is
    values[f"branch_tension{suffix}"] = found.values["branch_tension"]
    if suffix:
        del values[f"tangent_modulus_untrimmed{suffix}"]
    return Contributions(found.component, values)


def of_segments(
    curves: ModulusCurves,
    segments: Segments,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    area: float,
    rate: Floats,
) -> Contributions:
    """Segments of both branches; zero where a branch has none."""
    of_curve = of_curves(curves, "", index, errors, model, area, rate)
    low, high = segments.segment_strain_low[index], segments.segment_strain_high[index]
    shape = (len(of_curve.component), *low.shape)
    names = ("segment_modulus", "segment_tension_low", "segment_tension_high")
    values = {name: np.zeros(shape) for name in names}
    for branch in range(low.shape[0]):
        known = np.isfinite(low[branch])
        if not known.any():
            continue
        knot = np.append(low[branch, known], high[branch, known][-1])
        rows = of_curve.values["branch_tension"][:, branch]
        inside = (curves.strain_bin >= knot[0]) & (curves.strain_bin <= knot[-1])
        inside &= np.isfinite(rows).all(axis=0)
        found = segment_contributions(
            Contributions(of_curve.component, {"branch_tension": rows[:, inside]}),
            errors, strain=curves.strain_bin[inside], knot=knot,
            segment_modulus=segments.segment_modulus[index, branch, known], area=area,
        )  # fmt: skip
        for name in names:
            values[name][:, branch, known] = found.values[name]
    return Contributions(of_curve.component, values)
