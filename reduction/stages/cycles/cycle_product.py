"""Results of the cycle stage."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import diric

from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.record.notes import Note
from reduction.record.samples import release_pages, trim_heap_after

_SAMPLES_OF_BLOCK = 1 << 17  # close to the cache size, but long enough for threads to pay


@dataclass(frozen=True)
@read_only_arrays
class Cycles:
    """Cycles of one test, all specimens together, since they share the crosshead.

    A cycle runs from one reversal to the next one of the same kind; it has
    one ascending and one descending branch.  Sample indices refer to the record.

    Parameters
    ----------
    first, last : ndarray of int, shape (n_cycles,)
        First and last sample of the cycle, both inside; ``last`` of a cycle is
        ``first`` of the next one where they touch.
    branch_first, branch_last : ndarray of int, shape (n_cycles, 2)
        Samples of the ascending (column 0) and descending (column 1) branch.
    plateau_rate : ndarray, shape (n_cycles, 2)
        Rate of the control channel on the plateau, positive. [m s-1] or [N s-1]
    cycle_number : ndarray of int32, shape (n_samples,)
        1 for the first cycle; 0 outside cycles.
    branch : ndarray of int8, shape (n_samples,)
        0 none, 1 ascending, 2 descending.
    is_in_trimmed_branch : ndarray of bool, shape (n_samples,)
        True inside the trimmed part of a branch.
    band : float
        Smallest range of the control channel that makes a reversal. [m] or [N]
    counted_by : str
        ``reversals`` or ``machine counter``.
    count : ndarray of int, shape (n_cycles,), or None
        Number of each cycle, counting those missing in the log; None: 1, 2, 3, ...
    is_count_sure : bool
        False where gaps of the log may contain cycles, or may not.
    notes : tuple of Note
        A count that differs from the plan, gaps of the record, ...
    made : tuple of str
        Half cycles at the ends of runs that were cut or left out: lines of the history.
    """

    first: Integers
    last: Integers
    branch_first: Integers
    branch_last: Integers
    plateau_rate: Floats
    cycle_number: NDArray[np.int32]
    branch: NDArray[np.int8]
    is_in_trimmed_branch: Bools
    band: float
    counted_by: str = "reversals"
    count: Integers | None = None
    is_count_sure: bool = True
    notes: tuple[Note, ...] = ()
    made: tuple[str, ...] = ()

    @property
    def n_cycles(self) -> int:
        """Number of whole cycles."""
        return int(self.first.shape[0])

    @property
    def number(self) -> Integers:
        """Number of each cycle, counting those missing in the log; shape (n_cycles,)."""
        return np.arange(1, self.n_cycles + 1) if self.count is None else self.count

    @property
    def n_between(self) -> int:
        """Cycles that surely ran between the first and the last of the log, but are not in it."""
        if self.count is None or not self.is_count_sure:
            return 0
        return int(np.maximum(np.diff(self.count) - 1, 0).sum())  # a counter may start again

    @property
    def longest(self) -> int:
        """Number of samples of the longest cycle."""
        return int((self.last - self.first).max(initial=0)) + 1

    def blocks(self, n_samples: int = _SAMPLES_OF_BLOCK) -> list[slice]:
        """Runs of whole cycles of about this many samples together, at least one cycle."""
        number = (self.first - self.first[:1]) // n_samples
        starts = np.flatnonzero(np.diff(number, prepend=-1))
        return [
            slice(int(start), int(stop))
            for start, stop in zip(starts, [*starts[1:], self.n_cycles], strict=True)
        ]


@dataclass(frozen=True)
@read_only_arrays
class Loops:
    """One row per cycle and specimen; every array has shape (n_specimens, n_cycles).

    The fields are the contract's per-cycle variables.  ``uncertainty`` holds the
    standard uncertainty of each field that has one, by the field's name, same
    shape and unit.  ``storage_over_time`` and ``loss_over_time`` are those of the
    fundamental over time, as a linear model of the material needs; for a sine
    they are the storage and loss spring constants.  ``tension_turn_missed`` and
    ``strain_turn_missed`` are the full width by which half a range that turns between samples may
    be too small or too large; ``energy_turn_missed`` is the same for the area.
    ``foot_strain`` is that of the turn with which a cycle begins, not corrected for creep.
    """

    frequency: Floats
    cycle_start_time: Floats
    mean_tension: Floats
    tension_amplitude: Floats
    mean_strain: Floats
    strain_amplitude: Floats
    peak_tension: Floats
    valley_tension: Floats
    apparent_spring_constant: Floats
    hysteresis_energy: Floats
    storage_spring_constant: Floats
    loss_spring_constant: Floats
    loss_factor: Floats
    fundamental_energy_share: Floats
    closed_loop_energy: Floats
    storage_over_time: Floats
    loss_over_time: Floats
    tension_turn_missed: Floats
    strain_turn_missed: Floats
    energy_turn_missed: Floats
    foot_strain: Floats
    uncertainty: dict[str, Floats]

    def over_time(self, n_samples: float) -> Loops:
        r"""Return the same with storage and loss of the fundamental over time.

        It misses no turn.  With ``n_samples`` a cycle, in step, harmonics that far away count as
        the fundamental: in a wave of ramps :math:`1 / (n - 1)^2` of it; for a specimen that is
        stiffer to them, less than half of that remains in the ratio of the channels.
        """
        alias = _LEFT_OF_ALIAS / (n_samples - 1) ** 2
        missed = {
            "tension_turn_missed": WITHIN_STEP * alias * self.tension_amplitude,
            "strain_turn_missed": np.zeros_like(self.strain_turn_missed),
            "energy_turn_missed": alias * np.pi * self.strain_amplitude**2
            * np.abs(self.storage_over_time),
        }  # fmt: skip
        of = {"storage_spring_constant": "storage_over_time"}
        of["loss_spring_constant"] = "loss_over_time"
        own = {name: self.uncertainty[other] for name, other in of.items()}
        return replace(
            self, **missed, **{name: getattr(self, other) for name, other in of.items()},
            uncertainty=self.uncertainty | own,
        )  # fmt: skip

    def shared_by_cycles(
        self, cycles: slice | Integers, *, turns_alike: Floats | float = 0.0
    ) -> dict[str, Floats]:
        """Standard uncertainties common to the cycles, which a mean over them does not reduce.

        A turn between two readings is there in all cycles, or nearly.  Shape (n_specimens,) each,
        over some of the cycles.
        ``turns_alike``, from `turns_alike`, is the correlation of the errors of tension and strain.
        """

        def mean(name: str) -> Floats:
            values: Floats = getattr(self, name)[:, cycles]
            known = np.isfinite(values)
            return np.asarray(np.where(known, values, 0.0).sum(axis=1) / known.sum(axis=1))

        with np.errstate(divide="ignore", invalid="ignore"):
            tension, strain, energy = (
                np.nan_to_num(mean(f"{name}_turn_missed"))
                for name in ("tension", "strain", "energy")
            )
            # tension may turn at another place between its samples than strain; the common error
            # of one turn, in equal shares, cancels in their ratio
            shares = np.array(
                [tension / mean("tension_amplitude"), strain / mean("strain_amplitude")]
            )
            apart = np.sqrt((shares**2).sum(axis=0) - 2 * turns_alike * shares.min(axis=0) ** 2)
            # of the area, and of the square of the amplitude by which it is divided
            loss = np.hypot(
                energy / (np.pi * mean("strain_amplitude") ** 2),
                2 * strain / mean("strain_amplitude") * mean("loss_spring_constant") / WITHIN_STEP,
            )
            storage = mean("storage_spring_constant")
            return {
                # of a peak that is missed by more than a valley
                "mean_tension": tension / WITHIN_STEP,
                "mean_strain": strain / WITHIN_STEP,
                "tension_amplitude": tension / WITHIN_STEP,
                "strain_amplitude": strain / WITHIN_STEP,
                "apparent_spring_constant": apart * mean("apparent_spring_constant") / WITHIN_STEP,
                "storage_spring_constant": apart * storage / WITHIN_STEP,
                # half of its possible error was added to the area: the truth is at either end
                "hysteresis_energy": energy,
                "loss_spring_constant": loss,
                "loss_factor": np.hypot(loss / storage, apart * mean("loss_factor") / WITHIN_STEP),
            }

    def drift_not_placed(self) -> Floats:
        """`drift_not_placed` of each specimen, shape (n_specimens,). [1]."""
        rows = zip(self.hysteresis_energy, self.closed_loop_energy, self.tension_amplitude,
                   self.strain_amplitude, strict=True)  # fmt: skip
        return np.array([drift_not_placed(one, closed, f * e) for one, closed, f, e in rows])

    def release_pages(self) -> None:
        """Release the tables of a long test, which are on disk, from the memory of the process."""
        own = (getattr(self, item.name) for item in fields(self))
        release_pages(
            *(one for one in own if isinstance(one, np.ndarray)), *self.uncertainty.values()
        )
        trim_heap_after(self.frequency)


def turns_alike(lag: Floats, interval: float, *, period: float = 0.0, n_cycles: int = 1) -> Floats:
    r"""Correlation of the errors of tension and strain at the corners that both have. [1].

    .. math:: r = 1 - \frac{64}{\pi^4} \sum_{k\ \mathrm{odd}} \frac{R_k^2}{k^4}
              \left(1 - e^{-2 \pi^2 k^2 \sigma^2}\right), \qquad
              R_k = \frac{\sin \pi k N p}{N \sin \pi k p}

    Notes
    -----
    A corner of two ramps is a distance d from the nearest reading, anywhere within half an interval
    to either side, and :math:`|d|` times the slope is missed.  Tension that is logged late turns at
    another place: r is the autocorrelation of :math:`|d|`, a triangle over the intervals, averaged
    over lags of standard uncertainty :math:`\sigma` intervals.  In the mean over N corners, p
    intervals apart, the harmonic k of that triangle keeps :math:`R_k`: all of it if each is
    at the same place between two readings, nothing if they are evenly distributed there.  The
    difference of two errors that lie anywhere within one width W then has the variance
    :math:`W^2 (1 - r) / 4`, where each alone has :math:`W^2 / 8` (`WITHIN_STEP`): corners rounded
    by the machine are common to both.

    Examples
    --------
    Lags of zero, a tenth and one interval:

    >>> print(turns_alike(np.array([0.0, 0.01, 0.1]), 0.1).round(3))
    [1.    0.874 0.333]

    For ten cycles of 50 and of 50.3 readings:

    >>> for readings in (50, 50.3):
    ...     print(turns_alike(np.array([0.1]), 0.1, period=0.1 * readings, n_cycles=10).round(3))
    [0.333]
    [1.]
    """
    odd = np.arange(1, 20, 2)
    apart = -np.expm1(-2 * (np.pi * np.outer(lag, odd) / interval) ** 2)
    kept = diric(2 * np.pi * odd * period / interval, n_cycles) ** 2
    return np.asarray(1 - 2 / 3 * (apart @ (kept / odd**4)) / (odd**-4.0).sum())


_LEFT_OF_ALIAS = 0.5

WITHIN_STEP = np.sqrt(8)  # width over standard deviation, for errors most likely at either end

PLACE_OF_DRIFT = np.sqrt(6)  # half width of a triangular distribution over its deviation

_FEWEST_TO_PLACE = 6  # cycles

_LEAST_NOT_PLACED = 0.02  # the drift of a cycle is the median of three


def drift_not_placed(energy: Floats, closed: Floats, work: Floats) -> float:
    r"""Standard uncertainty of the work of a drift, over that work, for one specimen. [1].

    .. math:: u = \min\left(\frac{1}{\sqrt 6}, \sqrt{\beta^2 + s_\beta^2 + 0.02^2}\right), \qquad
              \frac{H}{T_a \varepsilon_a} = a + \beta \frac{H_{closed} - H}{T_a \varepsilon_a}

    Parameters
    ----------
    energy, closed : ndarray, shape (n_cycles,)
        Energy without the work of an even drift, and as logged. [J m-1]
    work : ndarray, shape (n_cycles,)
        Product of the amplitudes. [J m-1]

    Returns
    -------
    not_placed : float
        That of a triangular distribution if the cycles do not determine it. [1]

    Notes
    -----
    A single cycle does not show in which part of it a drift takes place: at one turn it does no
    work, at the other twice that of an even one.  Cycles of unequal drift do: if all of them
    have one energy without the work of an even drift, the drift is even.  An energy that settles as
    the drift does reduces beta only by chance.  The first two cycles, which are still
    settling, and the last one, whose drift is that of its neighbour, are not used.
    Slope and its standard error are those of least squares ([1]_).

    References
    ----------
    .. [1] N. R. Draper and H. Smith, *Applied Regression Analysis*, 3rd ed., Wiley, 1998, sec. 1.4.

    Examples
    --------
    A drift that dies away, even over its cycles or all at the peak:

    >>> of_drift, energy, work = 1 / np.arange(1.0, 13.0), np.full(12, 10.0), np.full(12, 100.0)
    >>> print(round(drift_not_placed(energy, energy + of_drift, work), 3),
    ...     round(drift_not_placed(energy + of_drift, energy + 2 * of_drift, work), 3))
    0.02 0.408
    """
    most = 1 / float(PLACE_OF_DRIFT)
    beta, error = _slope_on_drift(energy, closed, work)
    if not np.isfinite(error):
        return most
    return min(most, float(np.hypot(np.hypot(beta, error), _LEAST_NOT_PLACED)))


def drift_at_peaks(energy: Floats, closed: Floats, work: Floats) -> float:
    r"""Half of the slope beta of `drift_not_placed`, where the cycles show it; else 0. [1].

    Notes
    -----
    Yielding while the load is highest makes beta 1, and its work is not part of the loop.  Losses
    that settle as an even drift does make the same slope: the energy is half way between.  A
    slope above 1 is not due to drift alone, and nothing yields at valleys.

    Examples
    --------
    >>> of_drift, energy, work = 1 / np.arange(1.0, 13.0), np.full(12, 10.0), np.full(12, 100.0)
    >>> print(drift_at_peaks(energy + of_drift, energy + 2 * of_drift, work).__round__(3),
    ...     drift_at_peaks(energy + 2 * of_drift, energy + 3 * of_drift, work))
    0.5 0.0
    """
    beta, error = _slope_on_drift(energy, closed, work)
    clear = _CLEARLY * error
    is_shown = clear < 1 and clear < beta < 1.1 + clear
    return min(beta, 1.0) / 2 if is_shown else 0.0


_CLEARLY = 3.0  # standard errors of a significant slope


def _slope_on_drift(energy: Floats, closed: Floats, work: Floats) -> tuple[float, float]:
    """Slope of `drift_not_placed` and its standard error; NaN if the cycles do not determine it."""
    inner = slice(2, -1)
    with np.errstate(divide="ignore", invalid="ignore"):
        share, of_drift = (one[inner] / work[inner] for one in (energy, closed - energy))
    known = np.isfinite(share) & np.isfinite(of_drift)
    if known.sum() < _FEWEST_TO_PLACE:
        return np.nan, np.nan
    y, x = (one[known] - one[known].mean() for one in (share, of_drift))
    spread = float(x @ x)
    if not spread > 0:
        return np.nan, np.nan
    beta = float(x @ y) / spread
    return beta, float(np.sqrt(np.sum((y - beta * x) ** 2) / (known.sum() - 2) / spread))
