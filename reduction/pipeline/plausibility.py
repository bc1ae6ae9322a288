"""Numbers of a reduced test that no test gives unless its layout or campaign is wrong.

Each is computed all the same, and named: the reader is the one who knows the machine.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from reduction.cycles.product import Cycles, Loops
from reduction.moduli.product import ModulusCurves
from reduction.record import Floats
from reduction.samples.blocks import count_samples, finite_extremes
from reduction.samples.intervals import over_intervals

_GREATEST_STRAIN = 10.0  # no rubber is stretched to eleven times its length
# a sine logged thirteen times a cycle misses 1.5 % of its range, a triangle has 23 % more
_OFF_THE_SINE = 0.05
_TRIANGULAR_SHARE = 0.6  # of samples at a constant rate; a sine has a half
_MOST_DRIFT = 0.2  # of the range of a cycle: a rope that creeps drifts by a hundredth
_FEWEST_SAMPLES = 10  # of a branch: below, its two ends are a good part of it


def plausibility_notes(
    strain: Floats,
    *,
    specimens: tuple[str, ...],
    slack_tension: float,
    waveform: Literal["triangular", "sinusoidal", "other"],
    cycles: Cycles | None,
    loops: Loops | None,
    curves: ModulusCurves | None,
    control: Literal["position", "load"] = "position",
    is_snap: bool = False,
) -> tuple[str, ...]:
    """Name what is hardly so: sign, unit of position, slack or drift in cycles, waveform.

    Parameters
    ----------
    strain : ndarray, shape (n_specimens, n_samples)
        NaN where it is not known. [1]
    specimens : tuple of str, length n_specimens
        Their names.
    slack_tension : float
        At or below it a specimen is slack. [N]
    waveform : {"triangular", "sinusoidal", "other"}
        As declared. [-]
    cycles : Cycles or None
        None where the test has none.
    loops : Loops or None
        Likewise.
    curves : ModulusCurves or None
        Likewise.
    control : {"position", "load"}, optional
        Channel that the machine moved, and whose wave was declared. [-]
    is_snap : bool, optional
        Whether each cycle is to go slack, so that one that does is no fault.

    Returns
    -------
    notes : tuple of str
        Empty for a test that is as tests are.
    """
    notes = []
    greatest = [finite_extremes(one)[1] for one in strain]
    for name, one in zip(specimens, greatest, strict=True):
        if one > _GREATEST_STRAIN:
            notes.append(
                f"{name}: strain reaches {one:.4g}, which no specimen does; is the unit of "
                "position, or the length that strain refers to, right?"
            )
    if cycles is None or loops is None:
        return tuple(notes)
    for index, name in enumerate(specimens):
        slopes = None if curves is None else curves.tangent_modulus[index]
        slack = _taut if is_snap else _slack
        # of a channel of the wrong sign a valley says nothing about slack
        half_strain = _half_range(strain[index], cycles)
        if waveform == "sinusoidal":
            notes += _shape(name, loops, index, half_strain, control)
        else:
            notes += _drift(name, loops, index, half_strain)
        notes += _sign(name, loops.mean_tension[index], slopes) or slack(
            name, loops.valley_tension[index], slack_tension
        )
    return (*notes, *_waveform(cycles, waveform))


def _half_range(strain: Floats, cycles: Cycles) -> Floats:
    """Half the range of strain within each cycle."""
    high, low = (
        over_intervals(extreme, strain, cycles.first, cycles.last) for extreme in (np.fmax, np.fmin)
    )
    return np.asarray((high - low) / 2, dtype=np.float64)


def _shape(name: str, loops: Loops, index: int, half_strain: Floats, control: str) -> list[str]:
    """A sinusoidal test whose range is not that of its fundamental, from which numbers come.

    The channel that the machine moved tells whether it moved in sines; the other one is no
    sine where the curve of tension against strain bends or has a kink.
    """
    half_tension = (loops.peak_tension[index] - loops.valley_tension[index]) / 2
    of_strain = _median(half_strain / loops.strain_amplitude[index]) - 1
    of_tension = _median(half_tension / loops.tension_amplitude[index]) - 1
    moved, excess = ("tension", of_tension) if control == "load" else ("strain", of_strain)
    if abs(excess) > _OFF_THE_SINE:
        return [
            f"{name}: declared sinusoidal, but half the range of {moved} is {excess:+.0%} off the "
            "amplitude of its fundamental, which stands for it; is waveform right?"
        ]
    other, excess = ("strain", of_strain) if control == "load" else ("tension", of_tension)
    if not abs(excess) > _OFF_THE_SINE:
        return []
    return [
        f"{name}: {moved} is a sine and {other} is none: half its range is {excess:+.0%} off the "
        "amplitude of its fundamental, which stands for it"
    ]


def _drift(name: str, loops: Loops, index: int, half_strain: Floats) -> list[str]:
    """Cycles whose loop is what is left of a drift: half of it has been taken off the range."""
    half_tension = (loops.peak_tension[index] - loops.valley_tension[index]) / 2
    kept = [
        amplitude[index][half > 0] / half[half > 0]
        for amplitude, half in (
            (loops.tension_amplitude, half_tension),
            (loops.strain_amplitude, half_strain),
        )
    ]
    # NaN, where nothing is left, is no comparison either
    n_far = max(int(np.count_nonzero(~(share >= 1 - _MOST_DRIFT / 2))) for share in kept)
    if not n_far:
        return []
    return [
        f"{name}: {n_far} of {half_tension.size} cycles drift by more than {_MOST_DRIFT:.0%} of "
        "their range: their amplitudes, slopes and energies rest on it"
    ]


def _sign(name: str, mean_tension: Floats, slopes: Floats | None) -> list[str]:
    """Tension that pushes, or falls with stretch."""
    level = _median(mean_tension)
    slope = np.nan if slopes is None else _median(slopes)
    what = []
    if level < 0:
        what.append(f"mean tension of the cycles is negative ({level:.4g} N)")
    if slope <= 0:
        what.append(f"tension falls with stretch (median tangent modulus {slope:.4g} Pa)")
    if not what:
        return []
    hint = "does the log count compression positive? Then set sign = -1 for this channel"
    return [f"{name}: {' and '.join(what)}; {hint}"]


def _slack(name: str, valley_tension: Floats, slack_tension: float) -> list[str]:
    """Cycles that go slack: strain below it is no strain of the specimen."""
    slack = int(np.count_nonzero(valley_tension <= slack_tension))
    if not slack:
        return []
    return [
        f"{name}: slack within {slack} of {valley_tension.size} cycles (tension at or below "
        f"{slack_tension:.4g} N): amplitudes and energies of these include the slack part"
    ]


def _taut(name: str, valley_tension: Floats, slack_tension: float) -> list[str]:
    """Snap loads that are none: cycles in which the line stays taut."""
    taut = int(np.count_nonzero(valley_tension > slack_tension))
    if not taut:
        return []
    return [
        f"{name}: {taut} of {valley_tension.size} cycles are no snap loads: "
        f"tension stays above {slack_tension:.4g} N, so the line does not go slack in them"
    ]


def _waveform(cycles: Cycles, waveform: str) -> list[str]:
    """A triangular test of which little runs at a constant rate."""
    n_samples = cycles.branch_last - cycles.branch_first + 1
    if waveform != "triangular" or np.median(n_samples) < _FEWEST_SAMPLES:
        return []
    share = count_samples(cycles.is_constant_rate) / int(n_samples.sum())
    if share >= _TRIANGULAR_SHARE:
        return []
    return [
        f"declared triangular, but only {share:.0%} of the branches run at a constant rate; is "
        'waveform = "sinusoidal" right?'
    ]


def _median(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else float("nan")
