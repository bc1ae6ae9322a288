"""What is stated of the instruments, against the log: errors that are no errors any more.

A zero of a thousand tons is a slip of a unit, and so is a lag of an hour; everything that is
computed of it would be printed without a word.  What is stated holds for a whole campaign, and one
of its tests may be small or fast against it: that is no slip.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from reduction.errors import SettingsError
from reduction.pipeline.locate import Located
from reduction.record import Floats
from reduction.samples.blocks import finite_extremes, take_samples
from reduction.uncertainty.product import InstrumentErrors

_TIMES = 10.0  # the greatest reading of a log
_RECORD = 0.25  # of a record without cycles, for a lag
_LINEAR = 0.05  # of a cycle: a loop that is turned by more has lost 5 % of its stiffness


@dataclass(frozen=True)
class _Limit:
    key: str
    stated: float
    most: float
    unit: str
    what: str


def check_stated_errors(
    located: Located, instruments: Sequence[InstrumentErrors], *, place: str
) -> tuple[str, ...]:
    """Refuse standard uncertainties that a log shows to be impossible; say which are too large.

    Parameters
    ----------
    located : Located
        Record, with its cycles where the test has them.
    instruments : sequence of InstrumentErrors, length n_specimens
        What is stated.
    place : str
        File and table, for the message.

    Returns
    -------
    notes : tuple of str
        That a lag is too long for the first order, in which errors are propagated.

    Raises
    ------
    SettingsError
        If a zero or a reading of tension is beyond ten times the greatest tension of its specimen,
        one of position beyond ten times the greatest position, or a lag beyond the longest cycle,
        beyond a quarter of the record where there are no cycles.

    Notes
    -----
    Ten times: a zero that is not known to 1 % of the capacity of an instrument is a fault of it,
    and a test that uses less than a thousandth of that capacity needs another instrument.  What
    the layout declares of one reading takes the place of what is stated, which then counts nowhere.

    A lag of a whole cycle lays a tension on the position of the cycle before: nobody can tell it
    from none.  A lag of the share s of a cycle turns the loop by 2 pi s, of which the stiffness
    loses 1 - cos(2 pi s), a twentieth at s = 1/20; that is of second order and in no contribution.
    """
    for index, errors in enumerate(instruments):
        for limit in _limits(located, index, errors):
            if np.isfinite(limit.most) and limit.stated > limit.most:
                raise SettingsError(
                    f"{place}.{limit.key}: this is no standard uncertainty for test "
                    f"'{located.record.test_id}'",
                    found=f"{limit.stated:.4g} {limit.unit}",
                    needed=f"at most {limit.most:.4g} {limit.unit}, {limit.what}",
                )
    period = _periods(located)
    lag = max((errors.lag for errors in instruments), default=0.0)
    is_short = lag > _LINEAR * period
    if not is_short.any():
        return ()
    return (
        f"the stated lag of {lag:.4g} s is more than a twentieth of {int(is_short.sum())} of "
        f"{period.size} cycles, the shortest of {period.min():.4g} s: what it does to stiffness "
        "and loss is of first order, and their uncertainties are too small",
    )


def _limits(located: Located, index: int, errors: InstrumentErrors) -> Iterator[_Limit]:
    record, period = located.record, _periods(located)
    tension = _TIMES * _greatest(located.tension[index])
    position = _TIMES * _greatest(located.position)
    of_tension = f"ten times the greatest tension of '{errors.specimen}'"
    of_position = "ten times the greatest position"
    yield _Limit("tension.offset", errors.tension_offset, tension, "N", of_tension)
    yield _Limit("crosshead_position.offset", errors.position_offset, position, "m", of_position)
    # readings as they count here; one that the layout declares is not of this table
    declared = (*record.tension_standard_uncertainty, *len(located.tension) * (np.nan,))[index]
    if not np.isfinite(declared):
        yield _Limit(
            "tension.noise and resolution", errors.tension_reading, tension, "N", of_tension
        )
    if not np.isfinite(record.position_standard_uncertainty):
        yield _Limit(
            "crosshead_position.noise and resolution",
            errors.position_reading, position, "m", of_position,
        )  # fmt: skip
    if period.size:
        yield _Limit("lag", errors.lag, float(period.max()), "s", "the longest cycle")
    else:
        first, last = finite_extremes(record.time)
        most = _RECORD * (last - first)
        yield _Limit("lag", errors.lag, most, "s", "a quarter of the record")


def _periods(located: Located) -> Floats:
    """How long each cycle lasts; empty where there are none. [s]."""
    time, cycles = located.record.time, located.cycles
    if cycles is None:
        return np.empty(0)
    return np.asarray(take_samples(time, cycles.last) - take_samples(time, cycles.first))


def _greatest(values: Floats) -> float:
    low, high = finite_extremes(values)
    return max(-low, high) if low <= high else float("nan")
