"""Logs in the file's own units to one record in SI."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise

import numpy as np

from reduction.errors import DataError, SettingsError
from reduction.ingest.flags import flag_record
from reduction.ingest.layout import Layout
from reduction.ingest.piece import Piece, to_piece
from reduction.ingest.rawlog import RawLog
from reduction.record import Floats, Integers, Record
from reduction.samples.blocks import finite_extremes, join_columns, sample_blocks
from reduction.samples.scratch import empty_like, zeros_like
from reduction.settings import QualitySettings
from reduction.units import Dimension, parse_quantity

_WORKERS = 4
_NO_COUNT = -1
_DATUM_SHARE = 0.05
_ABSURD = 1e9  # m, N or 1: no machine is as long or as strong
_ABSURD_TIME = 1e12  # s: 30,000 years, and beyond it a float is no clock


def to_record(
    logs: Sequence[tuple[RawLog, Layout]],
    *,
    test_id: str,
    specimens: Sequence[str],
    quality: QualitySettings,
    length_needed: bool = True,
) -> Record:
    """Convert the log or logs of a test; several are a record in pieces, in order.

    Parameters
    ----------
    logs : sequence of (RawLog, Layout)
        In order of time.
    test_id : str
        Key of the test.
    specimens : sequence of str
        Names; ``tension.1`` belongs to the first.
    quality : QualitySettings
        When a sample is flagged.
    length_needed : bool
        Whether position has to be a thimble-to-thimble length.  False where strain
        comes from an extensometer or a gauge length, or where cycles alone are wanted:
        a displacement without a reference length is then kept as a displacement.

    Returns
    -------
    record : Record
        In SI, flags set, every row kept.

    Raises
    ------
    SettingsError
        If the layouts do not fit the test, or a displacement is used as a length.
    DataError
        If the logs have two time bases, or a channel holds no number.
    """
    if not logs:
        raise SettingsError(f"test '{test_id}' has no file", needed="one or more logs")
    n_strain = [_check_channels(layout, test_id, len(specimens)) for _, layout in logs]
    position_is_length = _check_datum([layout for _, layout in logs], test_id, length_needed)
    pieces = [to_piece(log, layout, gap_factor=quality.gap_factor) for log, layout in logs]
    _check_order(pieces)
    n_samples = sum(piece.time.size for piece in pieces)
    beside, rows = pieces[0].time, (len(specimens), n_samples)
    position = empty_like(beside, shape=n_samples)
    tension = empty_like(beside, shape=rows)
    strain = empty_like(beside, shape=rows) if any(n_strain) else None
    targets = [("crosshead_position", position)]
    targets += [(f"tension.{number}", row) for number, row in enumerate(tension, 1)]
    if strain is not None:
        targets += [(f"strain.{number}", row) for number, row in enumerate(strain, 1)]
    with ThreadPoolExecutor(_WORKERS) as workers:  # fresh memory is slow to touch
        list(workers.map(lambda target: _fill(target[1], pieces, target[0]), targets))
    counter, counter_notes = _counter(pieces, n_samples)
    for piece in pieces:
        _check_clock(piece)
    times = [piece.time for piece in pieces]
    record = Record(
        test_id=test_id,
        specimens=tuple(specimens),
        time=join_columns(times),
        crosshead_position=position,
        tension=tension,
        quality_flag=zeros_like(tension, dtype=np.uint16),
        crosshead_position_quality_flag=zeros_like(position, dtype=np.uint16),
        measured_strain=strain,
        cycle_counter=counter,
        position_is_length=position_is_length,
        n_rows_read=sum(log.n_rows_read for log, _ in logs),
        tension_standard_uncertainty=tuple(
            _uncertainty(pieces, f"tension.{number}", "force")
            for number in range(1, len(specimens) + 1)
        ),
        position_standard_uncertainty=_uncertainty(pieces, "crosshead_position", "length"),
        metadata=_metadata(pieces),
        notes=(*_piece_notes(pieces), *counter_notes),
    )
    return flag_record(
        record,
        settings=quality,
        resampled=sorted(frozenset().union(*(piece.resampled for piece in pieces))),
        verified=_verified(pieces, len(specimens)),
        notes=_datum_notes(record, pieces[0]),
    )


def _check_channels(layout: Layout, test_id: str, n_specimens: int) -> int:
    """Channels for every specimen; returns how many strain channels there are."""
    if "crosshead_position" not in layout.channels:
        raise SettingsError(
            f"test '{test_id}': its layout has no crosshead_position channel",
            found=", ".join(layout.channels),
            needed="crosshead_position",
        )
    counts = {}
    for kind in ("tension", "strain"):
        there = [name for name in layout.channels if name.split(".")[0] == kind]
        wanted = [[f"{kind}.{number}" for number in range(1, len(there) + 1)], [kind]]
        if there and sorted(there) not in [sorted(names) for names in wanted]:
            raise SettingsError(
                f"test '{test_id}': the {kind} channels of its layout are not numbered from 1",
                found=", ".join(there),
                needed=", ".join(wanted[0]),
            )
        counts[kind] = len(there)
    if counts["tension"] != n_specimens or counts["strain"] not in (0, n_specimens):
        kind = "tension" if counts["tension"] != n_specimens else "strain"
        raise SettingsError(
            f"test '{test_id}': its layout has {counts[kind]} {kind} channels "
            f"for {n_specimens} specimens",
            found=", ".join(name for name in layout.channels if name.startswith(kind)) or "none",
            needed=", ".join(f"{kind}.{number}" for number in range(1, n_specimens + 1)),
        )
    return counts["strain"]


def _check_datum(layouts: Sequence[Layout], test_id: str, length_needed: bool) -> bool:
    """Whether position is a length in every layout."""
    is_length = set()
    for layout in layouts:
        channel = layout.channels["crosshead_position"]
        is_length.add(channel.datum == "pin-to-pin" or channel.reference_length is not None)
    if (length_needed and False in is_length) or len(is_length) > 1:
        raise SettingsError(
            f"test '{test_id}': a displacement is used as a length",
            found='crosshead_position with datum = "displacement" and no reference_length',
            needed="reference_length, the thimble-to-thimble length at displacement zero",
            hint="Measure it at slack, or at a reference_tension that is stated too.",
        )
    return is_length == {True}


def _check_order(pieces: Sequence[Piece]) -> None:
    """Time goes on from piece to piece; strain and counter are in all pieces or in none."""
    for before, after in pairwise(pieces):
        end, start = finite_extremes(before.time)[1], finite_extremes(after.time)[0]
        if start <= end:
            raise DataError(
                "the pieces of a record have two time bases",
                found=f"{after.log.source.name} from {start:g} s, "
                f"{before.log.source.name} to {end:g} s",
                needed="pieces in order, whose time goes on",
                hint="Give pieces that each count from zero tests of their own.",
            )
        if set(before.values) != set(after.values):
            raise SettingsError(
                "the pieces of a record have different channels",
                found=f"{', '.join(before.values)} in {before.log.source.name}, "
                f"{', '.join(after.values)} in {after.log.source.name}",
                needed="the same channels in all pieces",
            )


def _fill(target: Floats, pieces: Sequence[Piece], key: str) -> None:
    """Write a channel of all pieces, in SI, one after another."""
    start = 0
    for piece in pieces:
        part = target[start : start + piece.time.size]
        factor, shift = piece.scale[key]
        values = piece.values[key]
        is_absurd = False
        for block in sample_blocks(part.size, values, target):
            np.multiply(values[block], factor, out=part[block])
            if shift:
                part[block] += shift
            low, high = part[block].min(), part[block].max()
            is_absurd |= not (low >= -_ABSURD and high <= _ABSURD)  # so is a NaN, at first
        if is_absurd:
            _check_size(part, piece, key)
        start += piece.time.size


def _check_size(part: Floats, piece: Piece, key: str) -> None:
    """Refuse numbers that no machine can have measured."""
    absurd = np.concatenate(
        [
            block.start + np.flatnonzero(np.abs(part[block]) > _ABSURD)
            for block in sample_blocks(part.size, part)
        ]
    )
    if absurd.size:
        raise DataError(
            f"{key} has {absurd.size} values that nothing measures, "
            f"first at {piece.row_of(int(absurd[0]))}",
            found=f"{part[absurd[0]]:g} in SI",
            needed=f"at most {_ABSURD:g}",
            hint="Check the unit and the column; a value that stands for none belongs to missing.",
        )


def _check_clock(piece: Piece) -> None:
    """Refuse times that no clock can have shown."""
    low, high = finite_extremes(piece.time)
    if low < -_ABSURD_TIME or high > _ABSURD_TIME:
        value = low if low < -_ABSURD_TIME else high
        raise DataError(
            f"the time of {piece.log.source.name} has values that no clock shows",
            found=f"{value:g} s",
            needed=f"at most {_ABSURD_TIME:g} s",
            hint="Check the unit and the column of the time channel.",
        )


def _counter(pieces: Sequence[Piece], n_samples: int) -> tuple[Integers | None, tuple[str, ...]]:
    """The machine's own count as whole numbers, -1 where it is missing."""
    key = "cycle_counter"
    if key not in pieces[0].values:
        return None, ()
    count = empty_like(pieces[0].time, shape=n_samples)
    _fill(count, pieces, key)
    whole, n_missing = empty_like(count, dtype=np.int64), 0
    for part in sample_blocks(n_samples, count, whole):
        block = count[part]
        missing = np.isnan(block)
        n_missing += int(np.count_nonzero(missing))
        numbers = np.where(missing, _NO_COUNT, block)
        whole[part] = numbers
        odd = np.flatnonzero(whole[part] != numbers)
        if odd.size:
            raise DataError(
                "the cycle counter is not a whole number, first at sample "
                f"{part.start + int(odd[0]) + 1}",
                found=f"{block[odd[0]]:g}",
                needed="whole numbers",
            )
    if n_missing:
        return whole, (f"the cycle counter is missing on {n_missing} rows, -1 there",)
    return whole, ()


def _uncertainty(pieces: Sequence[Piece], key: str, dimension: Dimension) -> float:
    """Largest declared standard uncertainty; NaN where a piece declares none."""
    texts = [piece.channel(key).standard_uncertainty for piece in pieces]
    return max(
        (np.nan if text is None else parse_quantity(text, dimension) for text in texts),
        key=lambda value: np.inf if np.isnan(value) else value,
    )


def _metadata(pieces: Sequence[Piece]) -> dict[str, str]:
    metadata: dict[str, str] = {}
    for piece in pieces:
        for key, value in piece.log.metadata.items():
            same = metadata.get(key, value) == value
            metadata[key if same else f"{key} ({piece.log.source.name})"] = value
    return metadata


def _piece_notes(pieces: Sequence[Piece]) -> list[str]:
    if len(pieces) == 1:
        return list(pieces[0].notes)
    joined = " and ".join(piece.log.source.name for piece in pieces)
    named = [f"{piece.log.source.name}: {note}" for piece in pieces for note in piece.notes]
    return [f"one record of {len(pieces)} pieces: {joined}", *named]


def _verified(
    pieces: Sequence[Piece], n_specimens: int
) -> dict[tuple[int, int, int], tuple[float, float]]:
    """Verified range of each load cell by specimen, first row and row after the last. [N]."""
    verified = {}
    start = 0
    for piece in pieces:
        stop = start + int(piece.time.size)
        for index in range(n_specimens):
            limits = piece.channel(f"tension.{index + 1}").verified_range
            if limits is not None:
                low, high = (parse_quantity(limit, "force") for limit in limits)
                verified[index, start, stop] = (low, high)
        start = stop
    return verified


def _datum_notes(record: Record, piece: Piece) -> tuple[str, ...]:
    """Compare the tension at displacement zero with that at which the length was read."""
    channel = piece.channel("crosshead_position")
    if channel.datum != "displacement" or channel.reference_length is None:
        return ()
    zero = parse_quantity(channel.reference_length, "length")
    stated = parse_quantity(channel.reference_tension or "0 N", "force")
    position = record.crosshead_position
    before = None
    for part in sample_blocks(position.size, position, overlap=1):
        away = position[part] - zero
        crossing = np.flatnonzero(away[:-1] * away[1:] <= 0)
        if crossing.size:
            before = part.start + int(crossing[0])
            break
    if before is None:
        return ()
    after = before + 1
    span = position[before] - position[after]
    weight = (position[before] - zero) / span if span else 0.0
    notes = []
    for name, load in zip(record.specimens, record.tension, strict=True):
        found = float(load[before] + weight * (load[after] - load[before]))
        low, high = finite_extremes(load)
        if abs(found - stated) > _DATUM_SHARE * (high - low):
            notes.append(
                f"reference_length is stated at {stated:.4g} N, but where displacement is first "
                f"zero the tension of {name} is {found:.4g} N"
            )
    return tuple(notes)
