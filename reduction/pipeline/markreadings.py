"""Tension at the splice marks of a test: at both ends of the holds in which the tape was read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reduction.pipeline.locate import Located
from reduction.record import Floats, SpliceMarks
from reduction.strain.marks import MarkReading, measure_mark_tension


def tension_at_marks(
    located: Located, marks: Mapping[str, SpliceMarks], specimens: Sequence[str], *, log: str
) -> dict[MarkReading, dict[str, Floats]]:
    """Tension of each specimen while each of its marks was read.

    Parameters
    ----------
    located : Located
        The whole log, since a mark belongs to a log and not to a step of it.
    marks : mapping of str to SpliceMarks
        Tape readings by specimen, over the campaign.
    specimens : sequence of str, length n_specimens
        In the order of the record.
    log : str
        Name by which the marks know it.

    Returns
    -------
    tension : dict of {"end", "start"} to dict of str to ndarray
        By specimen, one a mark of this log in the order of the marks, as
        `reduction.strain.marks.measure_mark_tension` has it; specimens without one are left
        out. [N]

    Raises
    ------
    DataError
        If marks of the log contradict each other.
    """
    in_log = {
        name: tension
        for name, tension in zip(specimens, located.tension, strict=True)
        if name in marks and log in marks[name].test
    }

    def measured(reading: MarkReading) -> dict[str, Floats]:
        return {
            name: measure_mark_tension(
                marks[name],
                test_id=log,
                standstills=located.standstills,
                tension=tension,
                reading=reading,
            )
            for name, tension in in_log.items()
        }

    return {"end": measured("end"), "start": measured("start")}
