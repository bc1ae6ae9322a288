r"""Whether tape and crosshead agree on the length of a specimen while its marks were read.

Both measure the distance between the thimbles: one with an instrument whose scale and zero stand
in campaign.toml, the other by values typed into a file.  Where they disagree, one of the two is
wrong, and no strain can be computed from both.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from itertools import permutations

import numpy as np

from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers, SpliceMarks
from reduction.record.notes import Note, note
from reduction.record.samples import finite_extremes
from reduction.stages.standstills import Standstills

POSITION_TOLERANCE = 0.05
"""Within this a tape and a scaled crosshead agree on a length; holds are much farther apart. [m]"""

TAPE_UNCERTAINTY = 0.003
"""A hundredth of a foot: a tape on a stretched tether cannot be read better than this. [m]"""

UNITS = {"ft": 0.3048, "in": 0.0254, "m": 1.0, "mm": 1e-3, "cm": 1e-2}
"""Units that the columns of a marks file may have, by their suffix, in metres. [m]"""

_FAR = 4.0  # standard uncertainties

# rows that one wrong zero explains are as far apart as the holds, within the tape's error
_ONE_ZERO = 0.01


def check_tape_against_crosshead(
    marks: SpliceMarks,
    *,
    test_id: str,
    standstills: Standstills,
    position: Floats,
    position_uncertainty: float = 0.0,
) -> tuple[Note, ...]:
    """Refuse tape readings that the crosshead of the same test contradicts.

    Parameters
    ----------
    marks : SpliceMarks
        Marks of one specimen, over the campaign.
    test_id : str
        The test that this log belongs to; rows of other tests are left alone.
    standstills : Standstills
        Standstills of the same log.
    position : ndarray, shape (n_samples,)
        Distance between the thimbles by the crosshead; NaN where not usable. [m]
    position_uncertainty : float
        Standard uncertainty of its zero and scale at the marks, where stated. [m]

    Returns
    -------
    notes : tuple of Note
        Where the two differ by more than their errors explain but by less than is refused.

    Raises
    ------
    DataError
        If the crosshead was never where the tape says it was, if another unit for the column
        or one shift of position brings the rows to the holds, or if the unloaded crosshead
        stood farther out than the slack length.

    Notes
    -----
    The marks are read while the machine stands at them ([1]_, sec. 4.1).  A log need not contain
    that: rows inside the range of the
    log that match no hold, and rows outside it when none matches one, contradict nothing unless
    another unit or one shift explains them all.  A slack specimen may hang: its thimbles are
    nearer than the tape says, but never farther.

    Examples
    --------
    Readings in inches under a header that says feet:

    >>> from reduction.record.measurement import MarkPlace
    >>> hold = Standstills(
    ...     first=np.array([0, 9]), last=np.array([5, 15]), start_time=np.array([0.0, 9.0]),
    ...     end_time=np.array([5.0, 15.0]), mean_position=np.array([5.904, 7.349]),
    ...     mean_tension=np.array([[380.0, 480.0]]), is_rest=np.array([False, False]),
    ...     position_tolerance=0.01, slack_tension=5.0)
    >>> marks = SpliceMarks("new", 2 * ("T-1",), ("min", "max"), 0.3048 * np.array([29.5, 31.9]),
    ...     0.3048 * np.array([206.4, 261.4]), 0.3048 * np.array([232.4, 289.3]),
    ...     place=tuple(MarkPlace("marks.csv", row, "far_thimble_ft") for row in (2, 3)))
    >>> check_tape_against_crosshead(
    ...     marks, test_id="T-1", standstills=hold,
    ...     position=np.array([5.9, 7.35]))  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    reduction.record.errors.DataError: marks.csv:2 [far_thimble_ft]: the tape and the crosshead ...
    """
    own = np.array([test == test_id for test in marks.test], dtype=bool)
    low, high = finite_extremes(position)
    if not own.any() or not low <= high:
        return ()
    allowance = POSITION_TOLERANCE + _FAR * float(
        np.hypot(marks.reading_uncertainty, position_uncertainty)
    )
    stretched = np.flatnonzero(own & ~marks.is_slack)
    tape = marks.far_thimble[stretched]
    holds = standstills.mean_position[~standstills.is_rest]
    meets = _meets(tape, holds, allowance)
    outside = (tape < low - allowance) | (tape > high + allowance)
    if not meets.all():
        _check_unit(marks, stretched, holds, (low, high), allowance, outside)
        if not meets.any():
            _check_zero(marks, stretched, holds, allowance)
        if outside.all() or (outside.any() and meets.any()):
            row = int(stretched[np.flatnonzero(outside)[0]])
            raise _contradiction(
                marks, row, f"the crosshead between {low:.4g} and {high:.4g} m",
                hint=_CORRECT,
            )  # fmt: skip
    rests = np.flatnonzero(standstills.is_rest)
    if rests.size:
        stood = float(standstills.mean_position[rests[0]])
        _check_slack(marks, np.flatnonzero(own & marks.is_slack), stood, allowance)
    alike = _alike(marks, stretched)
    if not meets.any():
        return alike
    nearest = np.abs(holds - tape[meets][:, None]).argmin(axis=1)
    ends = _ends(standstills, position)[nearest]
    # where the specimen creeps at a held load, the tape may have been read at any time in the hold
    apart = float(np.mean(np.clip(tape[meets], *ends.T) - tape[meets]))
    reading = max(marks.reading_uncertainty, TAPE_UNCERTAINTY)
    if abs(apart) <= _FAR * np.hypot(reading, position_uncertainty):
        return alike
    apart_note = note("tape-off-crosshead", marks.specimen, n_marks=int(meets.sum()), apart=apart)
    return (apart_note, *alike)


def _ends(standstills: Standstills, position: Floats) -> Floats:
    """Least and greatest of the start and end of each hold, means over a tenth, shape (n, 2)."""
    ends = []
    for mean, first, last in zip(
        standstills.mean_position[~standstills.is_rest],
        standstills.first[~standstills.is_rest],
        standstills.last[~standstills.is_rest],
        strict=True,
    ):
        of_hold = position[first : last + 1]
        known = of_hold[np.isfinite(of_hold)]
        n_tenth = max(known.size // 10, 1)
        both = [known[:n_tenth].mean(), known[-n_tenth:].mean()] if known.size else [mean, mean]
        ends.append(sorted(both))
    return np.array(ends)


def _alike(marks: SpliceMarks, rows: Integers) -> tuple[Note, ...]:
    """Rows for two holds of one test that have exactly the same three lengths."""
    seen: dict[tuple[float, ...], int] = {}
    for row in map(int, rows):
        lengths = tuple(
            float(one[row]) for one in (marks.near_toe, marks.far_toe, marks.far_thimble)
        )
        first = seen.setdefault(lengths, row)
        holds = [marks.hold[one].removesuffix(" down") for one in (first, row)]
        if holds[0] != holds[1]:
            return (note("marks-alike", marks.specimen, first=holds[0], second=holds[1]),)
    return ()


def _meets(tape: Floats, holds: Floats, allowance: float) -> Bools:
    """Which readings have a hold at their position."""
    if not holds.size:
        return np.zeros(tape.size, dtype=bool)
    return np.asarray(np.abs(holds - tape[:, None]).min(axis=1) <= allowance)


def _check_slack(marks: SpliceMarks, rows: Integers, stood: float, allowance: float) -> None:
    for row in rows:
        if stood > marks.far_thimble[row] + allowance:
            raise _contradiction(
                marks, int(row), f"the crosshead at {stood:.4g} m without tension",
                hint="A slack specimen may hang, but does not reach farther than its length: "
                "correct the row or its unit, or unit and zero of crosshead_position.",
            )  # fmt: skip


_CORRECT = (
    "Correct the row, or the unit of the column, or column, unit and zero of crosshead_position in "
    "the layout."
)


def _check_unit(
    marks: SpliceMarks,
    rows: Integers,
    holds: Floats,
    logged: tuple[float, float],
    allowance: float,
    outside: Bools,
) -> None:
    """Refuse readings that agree with the crosshead in another unit."""
    declared = _unit(marks, int(rows[0]))
    tape = marks.far_thimble[rows]
    for unit, size in UNITS.items():
        other = tape * (size / UNITS[declared])
        inside = (other >= logged[0] - allowance) & (other <= logged[1] + allowance)
        # without a hold in the log, ask only that all are in range in this unit and none as
        # declared
        fits = _meets(other, holds, allowance).all() or (outside.all() and inside.all())
        if unit == declared or not fits:
            continue
        row = int(rows[0])
        beside = float(holds[np.abs(holds - other[0]).argmin()]) if holds.size else other[0]
        factor = UNITS[declared] / size
        # nearer to each other, or to zero, than the allowance they fit any log near zero
        is_told = (np.ptp(other) if other.size > 1 else other[0]) > allowance
        raise _contradiction(
            marks, row, f"the crosshead at {beside:.4g} m",
            hint=f"All {rows.size} stretched marks of the test fit if their unit is {unit}: is the "
            f"header far_thimble_{unit}? (Or the log's crosshead_position, stated {factor:.4g} "
            "times too small.)" if is_told else _CORRECT,
        )  # fmt: skip
    for stated, of_log in permutations(UNITS, 2):
        factor = UNITS[stated] / UNITS[of_log]
        if np.unique(tape).size < 2 or not _meets(factor * tape, holds, factor * allowance).all():
            continue
        row = int(rows[0])
        beside = float(holds[np.abs(holds - factor * tape[0]).argmin()])
        raise _contradiction(
            marks, row, f"the crosshead at {beside:.4g} m",
            hint=f"All {rows.size} stretched marks of the test fit if crosshead_position is stated "
            f"{factor:.4g} times too large, as {of_log} stated as {stated} would be: correct its "
            "unit in the layout.",
        )  # fmt: skip


def _check_zero(marks: SpliceMarks, rows: Integers, holds: Floats, allowance: float) -> None:
    """Refuse readings that are all off the holds by the same length."""
    tape = marks.far_thimble[rows]
    if np.unique(tape).size < 2:
        return
    shifts = holds - tape[0]
    for shift in shifts[np.argsort(np.abs(shifts), kind="stable")]:
        left = np.abs(holds - (tape + shift)[:, None]).min(axis=1)
        if abs(shift) > allowance and (left <= _ONE_ZERO + _FAR * marks.reading_uncertainty).all():
            raise _contradiction(
                marks, int(rows[0]), f"the crosshead at {tape[0] + shift:.4g} m",
                hint=f"All {rows.size} stretched marks of the test are off by {shift:+.4g} m: the "
                "zero of crosshead_position is wrong (its zero or reference_length in the layout),"
                " or the tape was not read from the near thimble.",
            )  # fmt: skip


def _unit(marks: SpliceMarks, row: int) -> str:
    return marks.place[row].column.rpartition("_")[2] if marks.place else "m"


def _contradiction(marks: SpliceMarks, row: int, crosshead: str, *, hint: str) -> DataError:
    """Error for a row that the crosshead contradicts, with both values."""
    unit, length = _unit(marks, row), float(marks.far_thimble[row])
    read = f"far_thimble {length:.4g} m"
    if unit != "m":
        read += f" ({length / UNITS[unit]:.6g} {unit})"
    facts: dict[str, str | int] = {}
    if marks.place:
        place = marks.place[row]
        facts = {"file": place.file, "row": place.row, "channel": place.column}
    return DataError(
        f"the tape and the crosshead contradict each other: '{marks.specimen}' in test "
        f"{marks.test[row]}, hold {marks.hold[row]}",
        found=f"{read} by the tape, {crosshead}",
        needed="the same distance between the thimbles by both",
        hint=hint,
        **facts,
    )
