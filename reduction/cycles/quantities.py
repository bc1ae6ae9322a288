"""Dynamic quantities of a cycle from sums over its samples, and how far noise moves them.

References
----------
.. [1] CG-D-39-80, sec. 2.2: apparent spring constant (eq. 1) and hysteresis (eq. 4).
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from reduction.cycles.drift import mean_drift
from reduction.cycles.energy import without_drift
from reduction.cycles.product import Cycles
from reduction.record import Floats

Waveform = Literal["triangular", "sinusoidal", "other"]

MEASURED = (
    "peak", "valley", "high", "low", "energy", "strain_step_norm", "force_cosine", "force_sine",
    "force_mean", "strain_cosine", "strain_sine", "strain_mean", "force_end", "strain_end",
    "force_rise", "force_turn", "force_fall", "strain_rise", "strain_turn", "strain_fall",
)  # fmt: skip
"""What is summed over the samples of a cycle, in this order."""


def quantities_of_cycles(
    measured: Floats,
    cycles: Cycles,
    ends: Floats,
    *,
    waveform: Waveform,
    noise: float,
    strain_noise: float,
) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Quantities of each cycle of one specimen, and their standard uncertainties.

    Parameters
    ----------
    measured : ndarray, shape (n_measured, n_cycles)
        What only the samples tell, in the order of `MEASURED`. [SI unit of each row]
    cycles : Cycles
        For the number of samples of each.
    ends : ndarray, shape (4, n_cycles)
        Times of the first sample, of the middles of rise and fall, and of the last one. [s]
    waveform : {"triangular", "sinusoidal", "other"}
        A sine has the amplitude of its fundamental, any other wave half its range.
    noise : float
        Standard deviation of one reading of tension. [N]
    strain_noise : float
        Standard deviation of one reading of strain. [1]

    Returns
    -------
    values, uncertainty : dict of str to ndarray, shape (n_cycles,)
        By field of `Loops`; the uncertainty is type A, from noise and sampling alone. [SI]

    Raises
    ------
    ValueError
        If ``measured`` has another number of rows than `MEASURED`.

    Notes
    -----
    Source: [1]_, eq. 1 and 4, freed of drift.  Where the drift is more than the range of the
    cycle, what it is taken off is NaN.

    Examples
    --------
    Of a triangular cycle from 100 to 300 N and from 1 to 3 %, K_ap is 100 N over 1 %:

    >>> known = {"peak": 300.0, "valley": 100.0, "high": 0.03, "low": 0.01, "strain_cosine": 0.01}
    >>> measured = np.array([[known.get(name, 0.0)] for name in MEASURED])
    >>> one, pair = np.array([0]), np.array([[0, 50]])
    >>> cycles = Cycles(
    ...     one, one + 100, pair, pair + 50, np.ones((1, 2)), np.zeros(101, np.int32),
    ...     np.zeros(101, np.int8), np.zeros(101, bool), 0.1,
    ... )
    >>> values, _ = quantities_of_cycles(
    ...     measured, cycles, np.array([[0.0], [2.5], [7.5], [10.0]]),
    ...     waveform="triangular", noise=1.0, strain_noise=0.0,
    ... )
    >>> values["apparent_spring_constant"].round(6), values["mean_tension"]
    (array([10000.]), array([200.]))
    """
    row = dict(zip(MEASURED, measured, strict=True))
    n_samples = (cycles.last - cycles.first).astype(np.float64)
    peak, valley = row["peak"], row["valley"]
    force_cos, strain_cos = row["force_cosine"], row["strain_cosine"]
    force_drift, strain_drift = (
        mean_drift(np.stack([row[f"{name}_{part}"] for part in ("rise", "turn", "fall")]), ends)
        for name in ("force", "strain")
    )
    # drift of more than the range is that of a jump among the neighbours: no steady cycle is left
    force_drift[np.abs(force_drift) > peak - valley] = np.nan
    strain_drift[np.abs(strain_drift) > row["high"] - row["low"]] = np.nan
    force_sin = row["force_sine"] + force_drift / np.pi
    strain_sin = row["strain_sine"] + strain_drift / np.pi
    if waveform == "sinusoidal":
        mean, mean_strain = row["force_mean"], row["strain_mean"]
        amplitude = np.hypot(force_cos, force_sin)
        strain_amplitude = np.hypot(strain_cos, strain_sin)
    else:
        mean, mean_strain = (peak + valley) / 2, (row["high"] + row["low"]) / 2
        # between a turn and the next, half a period, a drift adds half of itself to the range
        amplitude = (peak - valley - np.abs(force_drift) / 2) / 2
        strain_amplitude = (row["high"] - row["low"] - np.abs(strain_drift) / 2) / 2
    energy = without_drift(
        row["energy"],
        end_tension=row["force_end"],
        mean_tension=row["force_mean"],
        tension_drift=force_drift,
        end_strain=row["strain_end"],
        mean_strain=row["strain_mean"],
        strain_drift=strain_drift,
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        # a series a cos + b sin is the real part of (a - ib) exp(i omega t)
        square = strain_cos**2 + strain_sin**2
        storage = (force_cos * strain_cos + force_sin * strain_sin) / square
        loss = (force_cos * strain_sin - force_sin * strain_cos) / square
        apparent = amplitude / strain_amplitude
        share = np.pi * square * loss / energy
        factor = loss / storage
        both = np.hypot(noise, apparent * strain_noise)
        u_part = np.sqrt(2 / n_samples) * both / np.sqrt(square)
        u_energy = row["strain_step_norm"] * both
        u_extreme = np.hypot(noise, _missed_turn(amplitude, n_samples))
        if waveform == "sinusoidal":
            u_half, u_strain = np.sqrt(2 / n_samples) * noise, np.sqrt(2 / n_samples) * strain_noise
            u_apparent = u_part
        else:
            u_half = u_extreme / np.sqrt(2)
            u_strain = np.hypot(strain_noise, _missed_turn(strain_amplitude, n_samples))
            u_strain /= np.sqrt(2)
            # a missed turn takes the same share off both amplitudes; only noise is left
            u_apparent = apparent * np.hypot(noise / amplitude, strain_noise / strain_amplitude)
            u_apparent /= np.sqrt(2)
        values = {
            "mean_tension": mean,
            "tension_amplitude": amplitude,
            "mean_strain": mean_strain,
            "strain_amplitude": strain_amplitude,
            "peak_tension": peak,
            "valley_tension": valley,
            "apparent_spring_constant": apparent,
            "hysteresis_energy": energy,
            "storage_spring_constant": storage,
            "loss_spring_constant": loss,
            "loss_factor": factor,
            "fundamental_energy_share": share,
        }
        uncertainty = {
            "mean_tension": u_half,
            "tension_amplitude": u_half,
            "mean_strain": u_strain,
            "strain_amplitude": u_strain,
            "peak_tension": u_extreme,
            "valley_tension": u_extreme,
            "apparent_spring_constant": u_apparent,
            "hysteresis_energy": u_energy,
            "storage_spring_constant": u_part,
            "loss_spring_constant": u_part,
            "loss_factor": u_part / np.abs(storage) * np.sqrt(1 + factor**2),
            "fundamental_energy_share": np.abs(share)
            * np.hypot(u_part / np.abs(loss), u_energy / np.abs(energy)),
        }
    return values, uncertainty


def _missed_turn(amplitude: Floats, n_samples: Floats) -> Floats:
    """How far the logged extreme may lie below the turn between two samples.

    A branch at constant rate rises by four amplitudes over N per sample; the turn lies
    within half a sample of the logged extreme, evenly spread, so the loss is spread evenly
    over half a step: the root of its mean square is the step over the root of 12.
    """
    missed: Floats = 4 * amplitude / n_samples / np.sqrt(12)
    return missed
