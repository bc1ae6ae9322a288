"""Closed-cycle identity and tension level of each cycle.

**Tension level of each cycle: the whole loop compared with the mean loop, as one number.** The
peak of a sampled cycle is unreliable: at 20 samples a cycle the sample nearest the turn may miss
it.  Every sample of a cycle is compared with the mean branch at its own position.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduction.record.arrays import run_blocks
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.notes import note
from reduction.record.samples import BLOCK, count_samples, sample_blocks, take_samples, thinned
from reduction.record.settings import Control
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.cycles.periods import counted_on_flanks
from reduction.stages.moduli.local_regression import sums_by_cell
from reduction.stages.moduli.modulus_product import CycleIdentity
from reduction.stages.moduli.tangent_modulus import pair_specimens

_MOST_PIECES = 4  # of a stroke: more follow its curvature better, but with more noise

_PIECE_SAMPLES = 6

_FEWEST_SAMPLES = 3  # in a piece

_FEWEST_OF_BEND = 4  # in a piece

_POWERS = 5  # powers of the place in a piece that are summed; three of them also times tension

_SIGNIFICANT = 3.0  # standard errors

_WORTH_A_NOTE = 0.005

_LEAST_SPREAD = 0.5  # of the variance of samples spread evenly over a piece

_LEAST_ROOM = 0.1  # of the determinant that uncorrelated places and squares would have

_TIE = 1e-9  # of a piece: rounding must not decide between two pieces


_PART = 1 << 18  # samples of a long block that are summed together


def _tension_change(
    strain: Floats, tension: Floats, *, cycles: Cycles, n_pieces: int
) -> tuple[Floats, Floats]:
    """Tension change along each branch by lines and by parabolas, and its strain.

    Shapes (2, n_cycles, 2) and (n_cycles, 2).
    """
    start, end = (take_samples(strain, at) for at in (cycles.branch_first, cycles.branch_last))
    stroke = end - start
    begin, per_stroke = start.ravel(), 1 / np.where(stroke == 0, np.nan, stroke).ravel()
    first_tension = take_samples(tension, cycles.branch_first)
    known = np.isfinite(first_tension)
    reference = float(first_tension[known].mean()) if known.any() else 0.0
    change = np.empty((2, cycles.n_cycles, 2))

    def fit_block(block: slice) -> None:
        begins, ends = int(cycles.first[block.start]), int(cycles.last[block.stop - 1]) + 1
        sums: Floats | float = 0.0
        for part in sample_blocks(ends - begins, *series, size=_PART):
            sums = sums + sums_of(block, slice(begins + part.start, begins + part.stop))
        of_branch = _add_shared_reversals(
            np.asarray(sums).reshape(_POWERS + 3, -1, n_pieces), strain, tension, cycles, block,
            reference=reference,
        )  # fmt: skip
        change[:, block] = _mean_slope(of_branch)

    def sums_of(block: slice, samples: slice) -> Floats:
        number, side = cycles.cycle_number[samples], cycles.branch[samples]
        n_branches = 2 * (block.stop - block.start)
        own = slice(2 * block.start, 2 * block.stop)
        branch = (2 * (number - (block.start + 1)) + side - 1).astype(np.intp)
        y = tension[samples] - reference
        u = strain[samples] - begin[own].take(branch, mode="clip")
        u *= per_stroke[own].take(branch, mode="clip")
        at = n_pieces * u + _TIE
        # noise carries samples past the reversals: they belong to the end pieces
        with np.errstate(invalid="ignore"):  # the value to which a NaN is cast is not used
            piece = np.clip(at.astype(np.int32), 0, n_pieces - 1)
        cell = branch * n_pieces + piece
        n_cells = n_branches * n_pieces
        used = (branch >= 0) & (branch < n_branches) & (side > 0) & np.isfinite(u) & np.isfinite(y)
        cell[~used] = n_cells  # an extra cell, cut off later
        # a sample between two pieces counts in both; otherwise a record in step with the cycles
        # would divide its two branches differently, as one begins where the other ends
        tied = np.flatnonzero(used & (piece > 0) & (at - piece < 2 * _TIE))
        total = np.zeros((_POWERS + 3, n_cells))
        within = at - piece - 0.5
        of_tied = np.full(tied.size, 0.5)
        for into, x, load in ((cell, within, y), (cell[tied] - 1, of_tied, y[tied])):
            adds = sums_by_cell(into, n_cells + 1)
            total += [(adds @ one)[:n_cells] for one in _to_sum(x, load)]
        return total

    series = (strain, tension, cycles.cycle_number, cycles.branch)
    run_blocks(fit_block, cycles.blocks(), samples=series)
    return change, stroke


def _to_sum(within: Floats, load: Floats) -> Iterator[Floats]:
    """Powers of the place in a piece, and their products with tension."""
    power = np.ones_like(within)
    for order in range(_POWERS):
        yield power
        if order < 3:
            yield power * load
        power = power * within


def _add_shared_reversals(
    by_branch: Floats,
    strain: Floats,
    tension: Floats,
    cycles: Cycles,
    block: slice,
    *,
    reference: float,
) -> Floats:
    """Sums by branch and piece, with each reversal in both branches that it ends.

    A reversal has only one label.
    """
    own = np.arange(2 * block.start, 2 * block.stop).reshape(-1, 2)
    for reversal, place, piece_there in (
        (cycles.branch_first[block], -0.5, 0),
        (cycles.branch_last[block], 0.5, -1),
    ):
        label = 2 * cycles.cycle_number[reversal].astype(np.int64) + cycles.branch[reversal] - 3
        load = tension[reversal]
        shared = (label != own) & np.isfinite(strain[reversal]) & np.isfinite(load)
        y = load[shared] - reference
        by_branch[:, own[shared] - own[0, 0], piece_there] += np.stack(
            [*_to_sum(np.full(y.size, place), y)]
        )
    return by_branch


def _mean_slope(sums: Floats) -> Floats:
    """Mean over the pieces of each branch of the slope of tension on u, shape (2, n_cycles, 2).

    By lines, and by parabolas where a piece has enough readings: the slope of a line through
    readings that are uneven in a piece of a curve is not that of its chord, and
    readings in step with the cycles are equally uneven in all of them.
    """
    n, y, v, vy, vv, vvy, v3, v4 = sums
    with np.errstate(divide="ignore", invalid="ignore"):
        spread, rise = vv - v * v / n, vy - v * y / n
        of_square, over_square, skew = v4 - vv * vv / n, vvy - vv * y / n, v3 - v * vv / n
        line = rise / spread
        room = spread * of_square - skew**2
        parabola = (rise * of_square - over_square * skew) / room
        has_room = (n >= _FEWEST_OF_BEND) & (room > _LEAST_ROOM * spread * of_square)
        slopes = np.stack([line, np.where(has_room, parabola, line)])
        covered = (n >= _FEWEST_SAMPLES) & (spread >= _LEAST_SPREAD * n / 12)
    return np.asarray(np.where(covered, slopes, np.nan).sum(axis=-1).reshape(2, -1, 2))


def _mean_over_cycles(residual: Floats) -> tuple[Floats, Floats]:
    """Mean of each row and its standard error, NaN where fewer than two cycles have a value."""
    known = np.isfinite(residual)
    count = known.sum(axis=1)
    filled = np.where(known, residual, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = filled.sum(axis=1) / count
        square = np.where(known, (residual - mean[:, None]) ** 2, 0.0).sum(axis=1)
        error = np.sqrt(square / ((count - 1) * count))
    return mean, np.where(count > 1, error, np.nan)


def _is_in_step(first: Integers) -> bool:
    """Whether cycles are whole numbers of readings, to one reading over all of them.

    Examples
    --------
    >>> first = 50 * np.arange(9)
    >>> print(_is_in_step(first), _is_in_step(first + np.arange(9) // 3))
    True False
    """
    n = first.size - 1
    if n < 1:
        return False
    readings = int(first[-1] - first[0])
    return abs(readings - n * round(readings / n)) <= 1


def _opens(strain: Floats, tension: Floats, cycles: Cycles) -> float:
    """Height of rises above falls at both turns, by the lines through two readings inside.

    Negative where tension is logged late, positive where it falls at a turn; NaN if no turn has
    readings on both sides, for instance if the load cell saturates there.

    Examples
    --------
    >>> strain = 5.0 - np.abs(np.arange(11) - 5)
    >>> ends = np.array([[0, 5]])
    >>> cycles = Cycles(ends[:, 0], ends[:, 0] + 10, ends, ends + 5, np.ones((1, 2)),
    ...     np.zeros(11), np.zeros(11), np.zeros(11), 0.1)
    >>> print(_opens(strain, 2 * strain - 0.5 * (np.arange(11) > 5), cycles))
    1.0
    """
    begin, end = cycles.branch_first.T, cycles.branch_last.T

    def led_to(at: Floats, one: Integers, two: Integers) -> Floats:
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = (tension[one] - tension[two]) / (strain[one] - strain[two])
            return np.asarray(tension[one] + slope * (at - strain[one]))

    apart = [
        led_to(at, rise, rise + way) - led_to(at, fall, fall - way)
        for at, rise, fall, way in (
            (strain[end[0]], end[0] - 1, begin[1] + 1, -1),
            (strain[begin[0]], begin[0] + 1, end[1] - 1, 1),
        )
    ]
    if not all(np.isfinite(one).any() for one in apart):
        return np.nan
    return float(np.nanmedian(apart[0]) + np.nanmedian(apart[1]))


def _inside_turns(cycles: Cycles) -> Cycles:
    """Cycles whose branches begin and end a reading inside their turns."""
    branch_first, branch_last = cycles.branch_first + 1, cycles.branch_last - 1
    branch = cycles.branch.copy()
    branch[np.concatenate([cycles.branch_first, cycles.branch_last]).ravel()] = 0
    return replace(
        cycles, first=branch_first[:, 0], last=branch_last[:, 1],
        branch_first=branch_first, branch_last=branch_last, branch=branch,
    )  # fmt: skip


@dataclass(frozen=True)
class _StrokeBalance:
    """Both sides of the identity for the cycles of one specimen."""

    strain: Floats
    tension: Floats
    area: float
    cycles: Cycles
    n_pieces: int

    @cached_property
    def sides(self) -> Floats:
        """Both sides and the mean slope by lines and parabolas, shape (3, 2, n_cycles). [Pa]."""
        change, stroke = _tension_change(
            self.strain, self.tension, cycles=self.cycles, n_pieces=self.n_pieces
        )
        per_stroke = 1 / (self.area * np.abs(stroke).mean(axis=1))
        first, last = self.cycles.first, self.cycles.last
        lost = take_samples(self.tension, first) - take_samples(self.tension, last)
        # relaxation while the machine rests at its peak is on no branch
        peak, leaves = self.cycles.branch_last[:, 0], self.cycles.branch_first[:, 1]
        at_rest = take_samples(self.tension, peak) - take_samples(self.tension, leaves)
        lost = lost - np.where(leaves > peak + 1, at_rest, 0.0)
        rise = change * np.sign(stroke)
        apart = rise[..., 0] - rise[..., 1]
        sides = np.stack([apart, np.broadcast_to(lost, apart.shape), rise.mean(axis=-1)])
        return np.asarray(per_stroke * sides)

    @cached_property
    def mean(self) -> Floats:
        """Mean residual by lines and by parabolas. [1]."""
        return _mean_over_cycles((self.sides[0] + self.sides[1]) / self.sides[2])[0]

    @cached_property
    def way(self) -> int:
        """0 for lines, 1 for parabolas: a fault shows in both, uneven sampling in one of them."""
        return int(abs(self.mean[1]) < abs(self.mean[0]))

    def change_by(self, other: _StrokeBalance) -> float:
        """Change of the mean residual with another series or another number of pieces. [1]."""
        return float(np.nan_to_num(abs(other.mean[self.way] - self.mean[self.way])))

    def change_by_lag(self, time: ArrayLike, lag: float) -> float:
        """Change of the mean residual by twice the stated lag. [1]."""
        since = np.asarray(time, dtype=np.float64)
        late = np.interp(since - 2 * lag, since, self.tension)
        return self.change_by(replace(self, tension=late))

    @property
    def change_by_bend(self) -> float:
        """Change by half as many pieces, or half the difference between lines and parabolas. [1].

        The error of lines and parabolas from curvature within the pieces is not larger.
        """
        by_way = float(np.nan_to_num(abs(self.mean[1] - self.mean[0]))) / 2
        if self.n_pieces < _MOST_PIECES:
            return by_way
        return max(by_way, self.change_by(replace(self, n_pieces=self.n_pieces // 2)))

    @property
    def without_turns(self) -> float:
        """Mean residual without the readings at the turns, if all cycles are in step. [1]."""
        cycles = self.cycles
        if not _is_in_step(cycles.first) or _opens(self.strain, self.tension, cycles) < 0:
            return np.nan
        return float(replace(self, cycles=_inside_turns(cycles)).mean[self.way])

    def turns_late(self, effect: float) -> bool:
        """Whether the turns show a lag of tension that explains a mean residual.

        A lag of some share of the stroke opens the turns by four times the residual that it leaves.
        """
        begin, end = self.cycles.branch_first[:, 0], self.cycles.branch_last[:, 0]
        rise = np.nanmedian(take_samples(self.tension, end) - take_samples(self.tension, begin))
        opens = _opens(self.strain, self.tension, self.cycles)
        return effect < 0 and opens < -2 * abs(effect * float(rise))

    @property
    def of_strain(self) -> float:
        """Mean residual of the strain gained in cycles, the lesser of lines and parabolas. [1]."""
        return float(np.abs(replace(self, strain=self.tension, tension=self.strain).mean).min())


def check_identity(
    strain: ArrayLike,
    tension: ArrayLike,
    *,
    area: ArrayLike,
    cycles: Cycles,
    names: tuple[str, ...] | None = None,
    time: ArrayLike | None = None,
    lag: Sequence[float] = (),
    control: Control = "position",
) -> CycleIdentity:
    r"""Difference of the stroke-mean moduli compared with the tension lost, for every cycle.

    .. math::

        \bar E_{asc} - \bar E_{desc} = -\frac{F_{first} - F_{last}}{A \Delta\varepsilon}

    Parameters
    ----------
    strain : array_like, shape (n_specimens, n_samples)
        Nominal strain of the free length; NaN where missing. [1]
    tension : array_like, shape (n_specimens, n_samples)
        Tension; NaN where missing. [N]
    area : array_like, shape (n_specimens,)
        Cross-sectional area at zero tension. [m2]
    cycles : Cycles
        Cycles and branches; whole branches are used, ends included. [SI]
    names : tuple of str, length n_specimens, optional
        Names of the specimens in notes; by default they are numbered from 1.
    time : array_like, shape (n_samples,), optional
        Seconds since the start; needed where a lag is stated. [s]
    lag : sequence of float, length n_specimens, optional
        Standard uncertainty of the lag between the two channels; by default none is stated. [s]
    control : {"position", "load"}, optional
        Channel that the machine drives.

    Returns
    -------
    identity : CycleIdentity
        Both sides [Pa] and their residual over the mean modulus of the two
        branches [1]; shape (n_specimens, n_cycles). [SI]

    Raises
    ------
    DataError
        If strain, tension and area do not pair up, or an area is not positive.

    Notes
    -----
    Derivation: along a branch, :math:`A \int E\,d\varepsilon` is the change of tension.
    From first to last sample of the cycle the ascending branch adds tension, the descending one
    takes it away, and the difference is lost. ``tension_loss_modulus`` is
    positive where tension is lost, so that the sum of both sides is zero: a relaxing
    specimen has the *lower* stroke mean ascending. Of the two descriptions in sec. 4.1
    of [1]_, curves that cross can be true; a modulus "higher with increasing elongation"
    throughout cannot.

    *A check, not a tautology.* The left side is a mean of slopes, of lines or of parabolas, over up
    to four equal pieces of each stroke; the right side is two samples.  They share the record and
    nothing else. The identity fails where strain and tension are mispaired, a branch is
    mislabelled, or tension changes while strain does not.

    *Residual.* Noise of standard deviation :math:`\sigma` gives a residual of about
    :math:`\sigma B \sqrt{24 / n} / (A \bar E \Delta\varepsilon)` for B pieces and n samples a
    branch: 1 % on tests of 60 lbf range with 0.26 lbf of noise at 48 samples. Within a
    piece of width w a line and the chord differ by :math:`E'' w^2 / 60`, and by more where the
    readings are uneven in it; a parabola and the chord by less, except at a kink. Of the two, the
    one with the smaller mean residual is taken. The fall of tension in a dwell at the peak is
    subtracted.

    *Judgement.* The mean over the cycles is compared with its standard error (their scatter; two
    cycles or more): a note where it exceeds three standard errors and 0.5 %, for B pieces
    :math:`16 / B^2` times as much.  Relaxation after a turn takes a fraction of a stroke that is
    inversely proportional to its duration, and cancels between strokes of equal duration: the
    bound scales with the ratio of their readings.  A curve that bends within a piece, as a hose
    does where its cords pick up and a braid after a turn, leaves more with fewer pieces, and
    differs between lines and parabolas: the change with half as many pieces, or half the
    difference, is subtracted.  A lag acts only at the turn, in any piece.  So does a
    turn between two readings, which varies in cycles out of step with the clock and is constant in
    those in step: these are judged without the readings at the turns of the branches, and a lag
    of less than a reading cannot be detected.  Under a driven load, strain goes on after a turn of
    the tension, where slopes over strain have no branch: the residual is positive where creep
    reaches far, and negative for a sine on a curve that stiffens.  It therefore counts only if the
    strain gained in a cycle also differs from the compliances of its branches, or if the turns are
    open as tension logged late opens them.  This makes the residual negative on a curve that
    stiffens: by some 0.7 to 1.1 % for a two-hundredth of the period.

    NaN for a cycle in which a piece has fewer than 3 samples or samples in less than
    about two thirds of it, or whose first or last sample is missing, and for one that is counted
    from a flank on, since one of its strokes is in two parts.

    Examples
    --------
    A cycle of 1000 N per unit strain up and 1100 down loses 100 N on 1 cm2:

    >>> import numpy as np
    >>> stroke = np.linspace(1.0, 2.0, 201)
    >>> strain = np.concatenate([stroke, stroke[::-1]])[None, :]
    >>> tension = np.concatenate([1000 * stroke, 2000 - 1100 * (2.0 - stroke[::-1])])[None, :]
    >>> cycles = Cycles(
    ...     first=np.array([0]), last=np.array([401]),
    ...     branch_first=np.array([[0, 201]]), branch_last=np.array([[200, 401]]),
    ...     plateau_rate=np.ones((1, 2)), cycle_number=np.ones(402, dtype=np.int32),
    ...     branch=np.repeat(np.array([1, 2], dtype=np.int8), 201),
    ...     is_in_trimmed_branch=np.ones(402, dtype=bool), band=0.0,
    ... )
    >>> identity = check_identity(strain, tension, area=[1e-4], cycles=cycles)
    >>> print(identity.stroke_mean_modulus_difference.round(3), identity.tension_loss_modulus)
    [[-1000000.]] [[1000000.]]
    """
    strains, tensions, areas = pair_specimens(strain, tension, area)
    shape = (areas.size, cycles.n_cycles)
    if names is None:
        names = tuple(f"specimen {number}" for number in range(1, areas.size + 1))
    difference, loss, modulus = np.full((3, *shape), np.nan)
    balances: list[_StrokeBalance] = []
    worth_a_note = _WORTH_A_NOTE
    if cycles.n_cycles:
        steps = cycles.branch_last - cycles.branch_first
        n_pieces = int(np.clip(float(np.median(steps)) // _PIECE_SAMPLES, 1, _MOST_PIECES))
        fast, slow = np.sort(np.median(steps, axis=0)).tolist()
        worth_a_note *= (_MOST_PIECES / n_pieces) ** 2 * slow / fast
        for row in range(areas.size):
            one = _StrokeBalance(strains[row], tensions[row], areas[row], cycles, n_pieces)
            difference[row], loss[row], modulus[row] = one.sides[:, one.way]
            balances.append(one)
    difference[:, np.logical_or(*counted_on_flanks(cycles))] = np.nan
    residual = (difference + loss) / modulus
    mean, error = _mean_over_cycles(residual)
    notes = []
    for row, one in enumerate(balances):
        effect, size = float(mean[row]), abs(float(mean[row]))
        least = max(_SIGNIFICANT * float(error[row]), worth_a_note)
        if not (size > least and size > (most := least + one.change_by_bend)):
            continue
        # strain has no branch where it goes on after a turn of the load
        if control == "load" and one.of_strain <= most and not one.turns_late(effect):
            continue
        explained = 0.0 if time is None or not any(lag) else one.change_by_lag(time, lag[row])
        # intervals include the stated lag already; its residual is not worth a warning
        is_of_lag = explained > 0 and size <= explained + least
        is_of_turns = not is_of_lag and np.sign(effect) * one.without_turns <= most
        found = note(
            "identity-open", names[row], effect=effect, error=float(error[row]),
            is_coarse=one.n_pieces < _MOST_PIECES, of_lag=explained if is_of_lag else 0.0,
            is_of_turns=is_of_turns,
        )  # fmt: skip
        notes.append(replace(found, severity="note") if is_of_lag or is_of_turns else found)
    return CycleIdentity(
        stroke_mean_modulus_difference=difference,
        tension_loss_modulus=loss,
        identity_residual=residual,
        mean_identity_residual=mean,
        mean_identity_residual_standard_uncertainty=error,
        notes=tuple(notes),
    )


N_BINS = 32

SAMPLES_PER_CYCLE = 64

FEWEST_SAMPLES = 8

FEWEST_IN_A_CYCLE = 4

_MOST_READ = 1 << 18  # samples of the mean branch


def _reference_branch(position: Floats, tension: Floats) -> tuple[Floats, Floats, Floats]:
    """Mean branch on a grid of position: position, tension, slope; without empty bins.

    The grid leaves out the outer fiftieth of the stroke at each end, where the turn is.
    """
    low, high = np.quantile(position, [0.02, 0.98])
    index = np.clip(((position - low) / (high - low) * N_BINS).astype(np.intp), 0, N_BINS - 1)
    count = np.bincount(index, minlength=N_BINS)
    filled = np.flatnonzero(count)
    sums = np.stack(
        [count, np.bincount(index, position, N_BINS), np.bincount(index, tension, N_BINS)]
    )[:, filled]
    # Cycles in step with the clock repeat a few positions; one that is on an edge would
    # fall into both bins beside it, and the slope between those is noise.
    apart = np.diff(sums[1] / sums[0], prepend=-np.inf) > (high - low) / N_BINS / 4
    count, position, tension = np.add.reduceat(sums, np.flatnonzero(apart), axis=1)
    mean_position, mean_tension = position / count, tension / count
    return mean_position, mean_tension, np.gradient(mean_tension, mean_position)


def cycle_tension_level(
    crosshead_position: ArrayLike,
    tension: ArrayLike,
    *,
    cycle_number: Integers,
    branch: Integers,
    n_cycles: int,
) -> tuple[Floats, Floats]:
    r"""Tension level of each cycle: the whole loop compared with the mean loop, as one number.

    .. math:: \Delta T_c = g_{top} \sum_{i \in c} g_i (T_i - \bar T(x_i)) / \sum_{i \in c} g_i^2

    where :math:`\bar T` is the mean branch and :math:`g` its slope, so that the shift of
    position that explains the cycle best is given as tension at the top of the loop.

    Parameters
    ----------
    crosshead_position : array_like, shape (n_samples,)
        Position; NaN is left out. [m]
    tension : array_like, shape (n_specimens, n_samples)
        Tension; NaN is left out. [N]
    cycle_number : ndarray of int, shape (n_samples,)
        1 for the first cycle, 0 outside cycles. [1]
    branch : ndarray of int, shape (n_samples,)
        0 none, 1 ascending, 2 descending. [1]
    n_cycles : int
        Number of cycles. [1]

    Returns
    -------
    tension_level : ndarray, shape (n_specimens, n_cycles)
        Mean tension at the top of the loop plus the shift of the cycle; NaN where a cycle
        has fewer than four samples, or a specimen fewer than eight on a branch. [N]
    tension_slope : ndarray, shape (n_specimens,)
        Slope of the mean ascending and descending branch at the top. [N m-1]

    Raises
    ------
    DataError
        If the cycles have no samples or no stroke.

    Notes
    -----
    About 64 samples a cycle are used, evenly picked, whatever the rate, and some
    hundred thousand of those for the mean branch.  On a generated
    log of 20 samples a cycle the level has a third of the noise of the peak (0.09 against
    0.26 lbf), and it does not beat with the phase of the samples.

    Examples
    --------
    A specimen of 10 N/m that has let out 0.1 m after the second cycle:

    >>> x = np.tile([1.0, 2, 3, 4, 5, 6, 5, 4, 3, 2], 4)
    >>> cycle = np.repeat([1, 2, 3, 4], 10)
    >>> branch = np.tile([1, 1, 1, 1, 1, 1, 2, 2, 2, 2], 4)
    >>> level, slope = cycle_tension_level(
    ...     x, [10 * (x - 0.1 * (cycle > 2))], cycle_number=cycle, branch=branch, n_cycles=4
    ... )
    >>> print((level - level[:, :1]).round(6) + 0.0, slope.round(6))
    [[ 0.  0. -1. -1.]] [10.]
    """
    loads = np.atleast_2d(np.asarray(tension, dtype=np.float64))
    position = np.asarray(crosshead_position, dtype=np.float64)
    number, side = np.asarray(cycle_number), np.asarray(branch)
    # Thinned before anything is computed: a log may have thousands of samples a cycle.
    step = max(1, count_samples(number) // (SAMPLES_PER_CYCLE * max(1, n_cycles)))

    series = number, side, position

    def is_used(part: slice) -> Bools:
        return (number[part] > 0) & (side[part] > 0) & np.isfinite(position[part])

    read = thinned(is_used, position.size, most=_MOST_READ, every=step, samples=series)
    if read.size == 0 or np.ptp(take_samples(position, read)) == 0:
        raise DataError(
            "no stroke to compare cycles on",
            found=f"{read.size} samples in cycles",
            needed="samples at different positions",
        )
    level = np.full((loads.shape[0], n_cycles), np.nan)
    slope = np.full(loads.shape[0], np.nan)

    def find_level(row: int) -> None:
        load = loads[row]
        branches = _reference_branches(position, load, side, read)
        if branches is None:
            return
        product, power, count = np.zeros((3, n_cycles))
        for part in sample_blocks(position.size, *series, load, size=step * BLOCK):
            rows = part.start + step * np.flatnonzero(is_used(slice(part.start, part.stop, step)))
            for which, (grid, mean, gradient) in branches.items():
                keep = rows[(side[rows] == which) & np.isfinite(load[rows])]
                if not keep.size:
                    continue
                x, y, cycle = position[keep], load[keep], number[keep] - 1
                g = np.interp(x, grid, gradient)
                # Beyond the grid the branch is extended by the straight line of its end.
                over = x - np.clip(x, grid[0], grid[-1])
                shift = y - np.interp(x, grid, mean) - g * over
                low = int(cycle.min())
                here = slice(low, int(cycle.max()) + 1)
                product[here] += np.bincount(cycle - low, g * shift)
                power[here] += np.bincount(cycle - low, g * g)
                count[here] += np.bincount(cycle - low)
        slope[row] = np.mean([gradient[-1] for _, _, gradient in branches.values()])
        top = np.mean([mean[-1] for _, mean, _ in branches.values()])
        known = (count >= FEWEST_IN_A_CYCLE) & (power > 0)
        level[row, known] = top + slope[row] * product[known] / power[known]

    run_blocks(find_level, range(loads.shape[0]))
    return level, slope


def _reference_branches(
    position: Floats, load: Floats, side: Integers, read: NDArray[np.intp]
) -> dict[int, tuple[Floats, Floats, Floats]] | None:
    """Mean ascending (1) and descending (2) branch; None where one has no samples or no stroke."""
    branches = {}
    place, tension, of_branch = (take_samples(one, read) for one in (position, load, side))
    for which in (1, 2):
        keep = (of_branch == which) & np.isfinite(tension)
        if np.count_nonzero(keep) < FEWEST_SAMPLES or np.ptp(place[keep]) == 0:
            return None
        branches[which] = _reference_branch(place[keep], tension[keep])
    return branches
