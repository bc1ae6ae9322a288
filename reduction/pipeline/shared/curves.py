"""What shared errors add to the curves and the segments of a specimen."""

from __future__ import annotations

import numpy as np
import scipy

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
        found = scipy.ndimage.median_filter(
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
    known = curves.tangent_modulus[index], curves.tangent_modulus_untrimmed[index]
    # readers take an error of strain back out of the tension by the slope that an archive has there
    slope = np.where(np.isfinite(known[1]), known[1], known[0])
    tension, slope = _completed(curves.strain_bin, curves.branch_tension[index], slope, area)
    strain = np.broadcast_to(curves.strain_bin, tension.shape)
    field = error_field(errors, model, strain=strain, tension=tension)

    def at_slope(modulus: Floats) -> Contributions:
        bend = np.stack([_smooth_slope(row, curves.strain_bin) for row in modulus])
        return curve_contributions(
            field, errors, tangent_modulus=modulus, area=area, modulus_slope=bend,
            strain_rate=rate[0], strain_rate_slope=rate[1],
        )  # fmt: skip

    of_tension = at_slope(slope)
    values = {f"branch_tension{suffix}": of_tension.values["branch_tension"]}
    names = ("tangent_modulus",) if suffix else ("tangent_modulus", "tangent_modulus_untrimmed")
    for name, modulus in zip(names, known, strict=False):
        whole = np.where(np.isfinite(modulus), modulus, slope)
        values[f"{name}{suffix}"] = at_slope(whole).values["tangent_modulus"]
    return Contributions(of_tension.component, values)


def _completed(
    strain: Floats, tension: Floats, modulus: Floats, area: float
) -> tuple[Floats, Floats]:
    """Tension and modulus of each branch where either is known, the other from it.

    A bin may have enough samples for a mean and too few for a slope, or the reverse: an error at
    its strain moves both.
    """
    filled, slopes = tension.copy(), modulus.copy()
    for row, slope in zip(filled, slopes, strict=True):
        has = np.isfinite(row)
        if has.sum() < 2:
            continue
        bare = has & ~np.isfinite(slope)
        slope[bare] = np.gradient(row[has], strain[has])[bare[has]] / area
        lacks = np.isfinite(slope) & ~has
        nearest = np.flatnonzero(has)[np.abs(strain[lacks, None] - strain[has]).argmin(axis=1)]
        row[lacks] = row[nearest] + area * slope[lacks] * (strain[lacks] - strain[nearest])
    return filled, slopes


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
