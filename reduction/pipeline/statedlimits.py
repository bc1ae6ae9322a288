"""What is stated of the instruments, against the log: errors that are no errors any more.

A zero of a thousand tons is a slip of a unit, and so is a lag of an hour; everything that is
computed of it would be printed without a word.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from reduction.errors import SettingsError
from reduction.pipeline.locate import Located
from reduction.record import Floats
from reduction.uncertainty.product import InstrumentErrors

__all__ = ["check_stated_errors"]

_TURN = 0.25  # of a period: there the loop has turned by 90 degrees, and its two axes change places


@dataclass(frozen=True)
class _Limit:
    key: str
    stated: float
    most: float
    unit: str
    what: str


def check_stated_errors(
    located: Located, instruments: Sequence[InstrumentErrors], *, place: str
) -> None:
    """Refuse standard uncertainties that a log shows to be impossible.

    Parameters
    ----------
    located : Located
        Record, with its cycles where the test has them.
    instruments : sequence of InstrumentErrors, length n_specimens
        What is stated.
    place : str
        File and table, for the message.

    Raises
    ------
    SettingsError
        If a zero or a reading of tension is beyond the greatest tension of its specimen, one of
        position beyond the greatest position, or a lag beyond a quarter of the shortest cycle, of
        the whole record where there are no cycles.

    Notes
    -----
    An error of the greatest tension is 100 % at the best point of the log.  A quarter of a period
    turns a loop by 90 degrees: no first order is left, and stiffness and loss change places.
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


def _limits(located: Located, index: int, errors: InstrumentErrors) -> Iterator[_Limit]:
    tension, position = _greatest(located.tension[index]), _greatest(located.position)
    of_tension = f"the greatest tension of '{errors.specimen}'"
    of_position = "the greatest position"
    yield _Limit("tension.offset", errors.tension_offset, tension, "N", of_tension)
    yield _Limit("tension.noise and resolution", errors.tension_reading, tension, "N", of_tension)
    yield _Limit("crosshead_position.offset", errors.position_offset, position, "m", of_position)
    yield _Limit(
        "crosshead_position.noise and resolution",
        errors.position_reading, position, "m", of_position,
    )  # fmt: skip
    time, cycles = located.record.time, located.cycles
    if cycles is not None and cycles.n_cycles:
        period = float(np.min(time[cycles.last] - time[cycles.first]))
        yield _Limit("lag", errors.lag, _TURN * period, "s", "a quarter of the shortest cycle")
    else:
        yield _Limit("lag", errors.lag, _TURN * float(np.ptp(time)), "s", "a quarter of the record")


def _greatest(values: Floats) -> float:
    known = np.abs(values[np.isfinite(values)])
    return float(known.max()) if known.size else float("nan")
