"""A reduced test held against a second reading of its files, by a few lines of numpy.

`readings_that_differ` holds for every product, flagged or not: a sample is what the file says, in
the unit that the campaign says, or is marked as missing.  `numbers_that_differ` is for a product
that carries no flag: its cycles are turns of the position in the file, their peak and valley lie
within half a step of the samples, and slope, energy and modulus follow from the samples between
them by the definition alone.
"""

import numpy as np

__all__ = ["numbers_that_differ", "readings_that_differ"]

MISSING = 1
_TURN = 0.03  # of the range of position: what makes a turn
_CLOSED = 0.02
_DRIFT = 0.12  # what may be taken off a cycle before a note says so
_ENERGY, _SLOPE = 0.15, 0.10  # the package corrects the one and trims the other


def _apart(name, found, wanted, tolerance=1e-9, atol=0.0):
    found, wanted = np.asarray(found, float), np.asarray(wanted, float)
    if found.shape != wanted.shape:
        return [f"{name}: {found.size} values, {wanted.size} in the file"]
    bad = ~np.isclose(found, wanted, rtol=tolerance, atol=atol, equal_nan=True)
    if not bad.any():
        return []
    first = int(np.flatnonzero(bad)[0])
    return [
        f"{name}: {int(bad.sum())} values differ, first {first}: "
        f"{found.ravel()[first]:.9g} for {wanted.ravel()[first]:.9g}"
    ]


def _is_missing(flags):
    return (np.asarray(flags).astype(int) & MISSING) != 0


def readings_that_differ(reading, dataset):
    """What the samples of a product are that the file does not say, as a list of words."""
    found = []
    flags = {
        "time": dataset["crosshead_position_quality_flag"].values,
        "crosshead_position": dataset["crosshead_position_quality_flag"].values,
        "tension": dataset["quality_flag"].values[0],
    }
    for name, wanted in (
        ("time", reading.time),
        ("crosshead_position", reading.position),
        ("tension", reading.tension),
    ):
        values = np.atleast_2d(dataset[name].values)[0]
        if values.size == wanted.size:
            missing = np.isnan(wanted)
            if (missing & ~_is_missing(flags[name])).any():
                found.append(f"{name}: missing in the file and not flagged")
            # a missing time is bridged
            values = np.where(missing, np.nan, values)
        found += _apart(name, values, wanted, atol=1e-12)
    if found:
        return found
    if "nominal_stress" in dataset:
        stress = dataset["nominal_stress"].values[0]
        known, wanted = np.isfinite(stress), reading.tension / reading.area
        found += _apart("nominal_stress", stress[known], wanted[known], atol=1e-6)
        found += _apart("area", dataset["area"].values[0], reading.area)
    if "strain" in dataset:
        strain, known = dataset["strain"].values[0], np.isfinite(dataset["strain"].values[0])
        found += _apart("strain", strain[known], _strain(reading, strain)[known], 1e-9, 1e-9)
    return found


def _strain(reading, strain):
    """Strain by the files; where it is zero is the package's word, to a fiftieth."""
    if reading.marks:
        hold, near, far, thimble = (np.array(part) for part in zip(*reading.marks, strict=True))
        free, slack = far - near, hold == "slack"
        slope, at_zero = np.polyfit(thimble[~slack], free[~slack], 1)
        return (at_zero + slope * reading.position) / free[slack].mean() - 1
    if reading.gauge_length is None:
        return strain
    zero = np.nanmedian(reading.position - strain * reading.gauge_length)
    rests = np.concatenate([reading.position[:6], reading.position[-6:]])
    if not np.nanmin(np.abs(zero - rests)) <= 0.02 * reading.gauge_length:
        return np.full(strain.shape, np.inf)
    return (reading.position - zero) / reading.gauge_length


def _slopes(load, stretch):
    """Range of tension over that of strain, with half of the drift of the cycle in it or not."""
    slopes = []
    for share in (0.0, 0.5):
        part = [
            np.nanmax(values) - np.nanmin(values) - share * abs(values[-1] - values[0])
            for values in (load, stretch)
        ]
        slopes.append(part[0] / part[1])
    return slopes


def _turns_that_differ(name, found, extreme, step):
    """Turns farther from the greatest or least reading than half of what lies between readings."""
    found, extreme, step = map(np.asarray, (found, extreme, step))
    if found.shape != extreme.shape:
        return [f"{name}_tension: {found.size} values, {extreme.size} in the file"]
    far = ~(np.abs(found - extreme) <= 0.5 * step) & np.isfinite(extreme)
    if not far.any():
        return []
    first = int(np.flatnonzero(far)[0])
    return [
        f"{name}_tension: {int(far.sum())} values differ, first {first}: "
        f"{found[first]:.9g} for {extreme[first]:.9g}"
    ]


def _n_peaks(position):
    """Peaks of the position: rises and falls of a thirtieth of its range on either side."""
    threshold = _TURN * np.ptp(position)
    peaks, rising, extreme = 0, True, position[0]
    for value in position:
        if (value - extreme) * (1 if rising else -1) > 0:
            extreme = value
        elif abs(value - extreme) > threshold:
            peaks += rising
            rising, extreme = not rising, value
    return peaks


def numbers_that_differ(reading, dataset):
    """Numbers of the cycles that do not follow from the samples, as a list of words."""
    if not {"cycle_first_sample", "strain", "peak_tension"} <= set(dataset.variables):
        return []
    first, last = (dataset[f"cycle_{end}_sample"].values.astype(int) for end in ("first", "last"))
    found = []
    n_peaks = _n_peaks(reading.position[np.isfinite(reading.position)])
    if not n_peaks - 2 <= first.size <= n_peaks + 1:  # a jump makes a peak and spoils a cycle
        found.append(f"{first.size} cycles for {n_peaks} peaks of the position")
    strain, area = dataset["strain"].values[0], []
    peak, valley, slope, step = [], [], [], []
    for begin, end in zip(first, last, strict=True):
        part = slice(begin, end + 1)
        load, stretch = reading.tension[part], strain[part]
        ends = np.nanmin(load), np.nanmax(load)
        valley.append(ends[0])
        peak.append(ends[1])
        step.append(np.nanmax(np.abs(np.diff(load))))
        slope.append(_slopes(load, stretch))
        # of a cycle that does not close the area has more than one meaning
        closes = abs(load[-1] - load[0]) < _CLOSED * (ends[1] - ends[0])
        area.append(np.trapezoid(load, stretch) if closes else np.nan)
    found += _turns_that_differ("peak", dataset["peak_tension"].values[0], peak, step)
    found += _turns_that_differ("valley", dataset["valley_tension"].values[0], valley, step)
    apparent = dataset["apparent_spring_constant"].values[0]
    low, high = np.sort(np.reshape(slope, (-1, 2)), axis=1).T
    found += [
        f"apparent_spring_constant of cycle {place + 1}: {apparent[place]:.6g}, "
        f"{low[place]:.6g} to {high[place]:.6g} by its samples"
        for place in np.flatnonzero(
            (apparent < (1 - _DRIFT) * low) | (apparent > (1 + _DRIFT) * high)
        )
    ]
    energy = dataset["hysteresis_energy"].values[0]
    known = np.isfinite(energy) & np.isfinite(area)
    scale = np.nanmax(np.abs(energy), initial=0.0)
    found += _apart(
        "hysteresis_energy", np.abs(energy[known]), np.abs(area)[known], _ENERGY, _ENERGY * scale
    )
    time = reading.time
    # a cycle begins between two samples
    period = time[last] - time[first]
    apart = np.max(np.diff(time)) / np.min(period)
    found += _apart("frequency", dataset["frequency"].values[0], 1 / period, apart)
    return found + _moduli_that_differ(reading, dataset, strain)


def _moduli_that_differ(reading, dataset, strain):
    """Mean tangent modulus over the middle of the strain, within chords of the single branches."""
    if "tangent_modulus" not in dataset or not np.isfinite(reading.area):
        return []
    branch, stress = dataset["branch"].values, reading.tension / reading.area
    cycle, bins = dataset["cycle_number"].values, dataset["strain_bin"].values
    if not (cycle > 0).any():
        return []
    low, high = np.nanmin(strain[cycle > 0]), np.nanmax(strain[cycle > 0])
    low, high = low + 0.25 * (high - low), high - 0.25 * (high - low)
    inside = (bins > low) & (bins < high)
    found = []
    for place, (name, number) in enumerate((("ascending", 1), ("descending", 2))):
        curve = dataset["tangent_modulus"].values[0, place, inside]
        middle = (branch == number) & (strain > low) & (strain < high) & np.isfinite(stress)
        slopes = [
            np.polyfit(strain[rows], stress[rows], 1)[0]
            for rows in (middle & (cycle == one) for one in range(1, cycle.max() + 1))
            if rows.sum() >= 5
        ]
        if not np.isfinite(curve).any() or len(slopes) < 2:
            continue
        modulus, margin = np.nanmean(curve), _SLOPE * np.abs(slopes).max()
        if not min(slopes) - margin <= modulus <= max(slopes) + margin:
            found.append(
                f"tangent_modulus {name}: {modulus:.4g}, chords {min(slopes):.4g} to {max(slopes):.4g}"
            )
    return found
