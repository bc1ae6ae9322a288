"""Reading of a load cell without load, and test of its zero.

The zero of a load cell is its reading without load, which a log with a slack rest contains.  A
wrong zero is in every tension, and in a soft specimen it turns tension into compression.  The rests
distinguish a drift of the zero from relaxation or creep of the specimen: a specimen that was slack
at a length does not pull at a smaller one, whatever its history, unless it becomes shorter.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from reduction.record.measurement import Bools, Floats
from reduction.record.notes import Note, note
from reduction.record.samples import finite_extremes, take_samples
from reduction.stages.standstills import Standstills, estimate_noise

_BEYOND = 4.0  # standard errors of a mean

# of the greatest tension: least error of every stress that counts as serious
_SERIOUS = 0.01

_COVERED = 2.0  # stated standard uncertainties

_NO_PUSH = 0.1  # of the first reading at slack, below zero

_PUSHES = 10.0  # times the noise of a reading: least distance of a push below a rest

PULLS_BACK = 0.5  # of the load that pushed it: pull afterwards, by friction and creep

_STIFFER = 3.0  # near slack, compared with the whole stretch: rubber, whose stiffness falls first

_MOST = 4096  # samples used to test whether load rises with stretch


@dataclass(frozen=True)
class LoadAtSlack:
    """Mean load of one specimen over its slack rests.

    ``load`` [N] and ``standard_uncertainty`` [N] by noise and resolution; ``n_rests`` their
    number; ``earlier`` and ``later`` [N] the two most different means over the last quarter
    of a rest, in order of time: by then a load that was logged late or filtered has settled.
    ``drift`` [N] is the part of their difference that only a moving zero explains, in the time
    ``apart`` [s] between them.
    """

    load: float
    standard_uncertainty: float
    n_rests: int
    earlier: float
    later: float
    drift: float = 0.0
    apart: float = np.inf

    @property
    def is_beyond_noise(self) -> bool:
        """Whether it differs significantly from zero."""
        return abs(self.load) > _BEYOND * self.standard_uncertainty

    def zero_uncertainty(self, offset_uncertainty: float) -> float:
        """Uncertainty of the zero that the log shows; none if the stated one covers it. [N].

        A specimen that is slack has no load, and while it was loaded a drifting zero was anywhere
        between its two readings: an error uniformly distributed from zero to the reading, or to
        the drift, has a mean square of a third of its square.

        Examples
        --------
        >>> rest = LoadAtSlack(0.0, 0.01, 1, 0.0, 0.0, drift=3.0)
        >>> print(round(rest.zero_uncertainty(1.0), 3), rest.zero_uncertainty(2.0))
        1.732 0.0
        >>> print(round(LoadAtSlack(-3.0, 0.01, 1, -3.0, -3.0).zero_uncertainty(1.0), 3))
        1.732
        """
        seen = max(abs(self.drift), abs(self.load) if self.is_beyond_noise else 0.0)
        return seen / 3**0.5 if seen > _COVERED * offset_uncertainty else 0.0

    def drift_within(self, duration: float) -> float:
        """Uncertainty of a difference of two tensions due to a drift between them. [N].

        A stated error of the zero is in both, so it does not cover the drift.  A zero that moves
        at random moves with the root of the time; an even drift moves by less.

        Examples
        --------
        >>> rest = LoadAtSlack(0.0, 0.01, 2, 0.0, -3.0, drift=-3.0, apart=400.0)
        >>> print([round(rest.drift_within(duration), 3) for duration in (100.0, 800.0)])
        [0.866, 1.732]
        """
        share = min(duration / self.apart, 1.0)
        return abs(self.drift) * float(np.sqrt(share / 3))


def stands_at_slack_length(standstills: Standstills, is_slack: Bools) -> Bools:
    """Mask standstills in which a specimen is slack, or no longer than in an earlier slack one.

    Examples
    --------
    A rest, a hold under tension, and the length of the rest again, at 30 N:

    >>> stands = Standstills(
    ...     first=np.array([0, 20, 40]), last=np.array([9, 29, 49]), start_time=np.zeros(3),
    ...     end_time=np.ones(3), mean_position=np.array([1.0, 2.0, 1.0]),
    ...     mean_tension=np.array([[0.0, 200.0, 30.0]]), is_rest=np.array([True, False, False]),
    ...     position_tolerance=0.01, slack_tension=5.0)
    >>> print(stands_at_slack_length(stands, stands.is_rest))
    [ True False  True]
    """
    place = standstills.mean_position
    reached = np.fmax.accumulate(np.where(is_slack, place, -np.inf))
    return np.asarray(is_slack | (place <= reached + standstills.position_tolerance))


def pulls_as_at_reference(
    standstills: Standstills, load: Floats, *, reference_tension: float, half: float
) -> Bools:
    """Mask standstills in which a specimen pulls, if its strain is zero at a stated tension.

    ``load`` [N] is its mean load in each of them.  In a standstill that reads the reference tension
    within ``half`` [N] it is not slack; nor, as far as the log shows, in one that is no
    shorter and reads above zero.

    Examples
    --------
    A hose is mounted at 20 N, stretched, and returns to its length with 12 N; then it is slack:

    >>> load = np.array([20.0, 300.0, 12.0, 0.1])
    >>> stands = Standstills(
    ...     first=np.array([0, 20, 40, 60]), last=np.array([9, 29, 49, 69]),
    ...     start_time=np.zeros(4), end_time=np.ones(4),
    ...     mean_position=np.array([1.0, 2.0, 1.0, 0.8]), mean_tension=load[None],
    ...     is_rest=np.array([True, False, True, True]), position_tolerance=0.01,
    ...     slack_tension=25.0)
    >>> print(pulls_as_at_reference(stands, load, reference_tension=21.0, half=4.0))
    [ True  True  True False]
    """
    place = standstills.mean_position
    at_reference = np.abs(load - reference_tension) <= half
    if not at_reference.any():
        return at_reference
    shortest = float(place[at_reference].min()) - standstills.position_tolerance
    return np.asarray(at_reference | ((place >= shortest) & (load > 0)))


def load_at_slack(
    tension: Floats, standstills: Standstills, is_slack: Bools, *, stroke: float = np.nan
) -> LoadAtSlack | None:
    r"""Mean load of one specimen over the standstills in which it is slack.

    .. math:: u^2 = \frac{\sigma^2}{n} + \frac{q^2}{12}

    None if it is slack in none of them, or there are no readings.  ``stroke`` [m] is that of
    the log; without it a load that rises where the crosshead is further out is not a drift.

    Notes
    -----
    Noise averages out over the samples of a rest, but the step q of a converter does not if the
    noise is less than one step.  If the crosshead is further out than in another rest, and the
    load is greater by no more than that stretch explains, the specimen pulls: such a standstill
    gives no information on the zero.  Nor does one after a push, by half of which it may pull back.

    Examples
    --------
    >>> rest = Standstills(
    ...     first=np.array([0]), last=np.array([99]), start_time=np.array([0.0]),
    ...     end_time=np.array([9.9]), mean_position=np.array([1.0]),
    ...     mean_tension=np.array([[-14.4]]), is_rest=np.array([True]),
    ...     position_tolerance=0.01, slack_tension=5.0)
    >>> noise = np.random.default_rng(1).normal(-14.4, 0.5, 100)
    >>> found = load_at_slack(noise, rest, rest.is_rest)
    >>> print(round(found.load, 1), found.is_beyond_noise)
    -14.4 True
    """
    noise, quantum = estimate_noise(tension)
    rests = [
        _End.of(tension, slice(first, last + 1), place, time, _BEYOND * noise + quantum)
        for first, last, place, time in zip(
            standstills.first[is_slack].tolist(), standstills.last[is_slack].tolist(),
            standstills.mean_position[is_slack].tolist(),
            standstills.end_time[is_slack].tolist(), strict=True,
        )
    ]  # fmt: skip
    ends = [one for one in rests if one is not None]
    if not ends or np.count_nonzero(np.isfinite(tension[: 2 * _MOST])) < 8:
        return None
    # noise of a step or more blurs the steps, so that the mean is finer than one step
    step = quantum / 12**0.5 if noise < quantum else 0.0
    stiffness = _STIFFER * finite_extremes(tension)[1] / stroke if stroke > 0 else np.inf
    if np.isfinite(stiffness):
        ends = [
            one for one in ends
            if not any(
                _pulls(one, by, stiffness, noise, _push(tension, by, one, noise)) for by in ends
            )
        ]  # fmt: skip
    counts = np.array([one.n_samples for one in ends])
    own = noise / np.sqrt(counts.sum())
    readings = [one.load for one in ends]
    earlier, later = sorted((int(np.argmin(readings)), int(np.argmax(readings))))
    return LoadAtSlack(
        float(np.average([one.mean for one in ends], weights=counts)), float(np.hypot(own, step)),
        len(ends), ends[earlier].load, ends[later].load,
        drift=_moved(ends[earlier], ends[later], stiffness, noise, step),
        apart=ends[later].time - ends[earlier].time if later > earlier else np.inf,
    )  # fmt: skip


class _End(NamedTuple):
    """A slack rest: place [m], end [s], mean load over its end and all of it [N], its samples."""

    place: float
    time: float
    load: float
    mean: float
    n_samples: int
    samples: slice

    @classmethod
    def of(
        cls, tension: Floats, samples: slice, place: float, time: float, spread: float
    ) -> _End | None:
        """Make it from the loads of a standstill; None if none is known.

        A crosshead that is read in coarse steps shows the beginning of a pull late: a
        last part that rises out of the spread belongs to the pull.
        """
        loads = tension[samples]
        loads = loads[np.isfinite(loads)]
        if not loads.size:
            return None
        still = np.flatnonzero(loads <= np.median(loads) + spread)[-1] + 1
        if loads.size - still <= loads.size // 3:
            loads = loads[:still]
        last = loads[-_quarter(loads.size) :]
        return cls(place, time, float(last.mean()), float(loads.mean()), int(loads.size), samples)

    @property
    def n_read(self) -> int:
        """Number of samples of which ``load`` is the mean."""
        return _quarter(self.n_samples)


def _quarter(n_samples: int) -> int:
    return max(n_samples // 4, 1)


def _pulls(rest: _End, other: _End, stiffness: float, noise: float, push: float) -> bool:
    """Whether a rest reads more than another, by no more than its stretch or a push explains."""
    more = rest.load - other.load
    own = noise * np.sqrt(1 / rest.n_read + 1 / other.n_read)
    explained = max(stiffness * (rest.place - other.place), PULLS_BACK * push)
    return bool(_BEYOND * own < more <= explained)


def _push(tension: Floats, earlier: _End, later: _End, noise: float) -> float:
    """Fall of load below an earlier rest, which pushed the specimen shorter. [N]."""
    least, _ = finite_extremes(tension[earlier.samples.stop : later.samples.start])
    push = earlier.load - least
    return push if push > _PUSHES * noise else 0.0


def _moved(earlier: _End, later: _End, stiffness: float, noise: float, step: float) -> float:
    """Shift of the zero between two slack rests, as far as nothing else explains it. [N].

    A specimen that has been stretched since pulls no more than before, and never pushes: a load
    that rises, or falls below zero, is due to the load cell.  A rest further out may pull by its
    stretch.  A load that falls towards zero may be due to a specimen that became longer.
    """
    if later.load > earlier.load:
        further = later.place - earlier.place
        pulled = stiffness * further if further > 0 else 0.0
        moved = max(later.load - earlier.load - pulled, 0.0)
    elif later.load < -_NO_PUSH * earlier.load:
        moved = later.load - earlier.load
    else:
        moved = 0.0
    own = np.sqrt(noise**2 * (1 / earlier.n_read + 1 / later.n_read) + 2 * step**2)
    return moved if abs(moved) > _BEYOND * own else 0.0


def rises_with_stretch(position: Floats, tension: Floats) -> bool:
    """Whether load is greater where the crosshead is farther out, over the whole log.

    Examples
    --------
    >>> place = np.linspace(0, 1, 50)
    >>> rises_with_stretch(place, 80 * place - 100), rises_with_stretch(place, -80 * place)
    (True, False)
    """
    rows = np.arange(0, position.size, max(1, position.size // _MOST))
    place, load = take_samples(position, rows), take_samples(tension, rows)
    known = np.isfinite(place) & np.isfinite(load)
    place, load = place[known], load[known]
    return bool(place.size and (place - place.mean()) @ (load - load.mean()) > 0)


def notes_on_zero(
    names: Sequence[str],
    position: Floats,
    tension: Floats,
    at_slack: Sequence[LoadAtSlack | None],
    zeros: Sequence[str],
    offset_uncertainty: float = 0.0,
) -> tuple[Note, ...]:
    """Note load cells with a wrong zero, with the value to set if the log shows it.

    ``zeros`` holds the ``zero`` of each channel that would make its load at slack zero, as written
    in a layout.  A negative load has a wrong sign where it falls with stretch and a
    wrong zero where it rises.  A zero is serious if its error exceeds a hundredth of the
    greatest load and the stated uncertainty, which is in every interval; a zero that
    drifts by that much between the rests has no correct value.

    Examples
    --------
    >>> rest = LoadAtSlack(-14.4, 0.01, 2, -14.5, -14.3)
    >>> place = np.linspace(0, 1, 50)
    >>> [found] = notes_on_zero(["new"], place, 400 * place[None] - 14.4, [rest], ["-14.4 N"])
    >>> print(found)  # doctest: +ELLIPSIS
    new: the load cell reads -14.4 N at slack (2 rests), 3.6 % of the peak load, ...
    """
    notes = []
    for name, loads, rest, zero in zip(names, tension, at_slack, zeros, strict=True):
        low, high = finite_extremes(loads)
        if not low <= high:
            continue
        rows = np.arange(0, loads.size, max(1, loads.size // _MOST))
        middle = float(np.nanmedian(take_samples(loads, rows)))
        if -low > max(high, 0.0) and not rises_with_stretch(position, loads):
            notes.append(note("load-falls-with-stretch", name, load=middle))
        elif rest is None:
            # the log does not show which zero is right
            if middle < -_SERIOUS * (high - low):
                notes.append(note("load-negative", name, load=middle, least=low))
        else:
            reach = max(high - rest.load, rest.load - low)
            said = {"load": rest.load, "n_rests": rest.n_rests, "zero": zero}
            serious = max(_SERIOUS * reach, _COVERED * offset_uncertainty)
            # a rise that the stretch of the later rest explains does not count
            change = rest.drift or min(rest.later - rest.earlier, 0.0)
            if abs(change) > serious:
                notes.append(note("load-zero-drifts", name, earlier=rest.earlier, later=rest.later,
                                  effect=change / reach, carried=rest.drift))  # fmt: skip
            elif abs(rest.load) > serious and rest.is_beyond_noise:
                notes.append(note("load-zero-wrong", name, effect=rest.load / reach, **said))
            elif rest.is_beyond_noise:
                notes.append(note("load-zero-off", name, **said))
            if abs(change) <= serious and abs(rest.drift) > _COVERED * offset_uncertainty:
                notes.append(note("load-zero-drifted", name, drift=rest.drift))
    return tuple(notes)
