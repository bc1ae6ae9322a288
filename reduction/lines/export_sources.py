"""Lines for export from archives, assemblies, composites and look-ups.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 2.3.2; sec. 4.8.
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1-4, Tables 6, 8, 14, 17.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from reduction.archive.open import reading
from reduction.archive.product_files import earlier_run_words
from reduction.archive.variables import stored
from reduction.lines.archive_pieces import (
    Turns,
    alignment_words,
    check_words,
    loop_of_test,
    number_of,
    parts_of,
    turns_of,
)
from reduction.lines.assembly import DeployedLine
from reduction.lines.composite import (
    CompositeCurve,
    MeasuredLoop,
    PieceSource,
    tests_of_curve,
    used_of,
)
from reduction.lines.cycle_stiffness import LoadedTest, stiffness_of_cycles
from reduction.lines.export_dynamics import line_dynamics
from reduction.lines.export_line import (
    CurveSpread,
    CycleDamping,
    ExportLine,
    cycle_damping,
    start_against,
)
from reduction.lines.export_tables import TableColumn, ValueTable, spread_columns
from reduction.lines.line_curve import evaluate_curve
from reduction.lines.line_lookup import Branch
from reduction.lines.lookup_product import LineCurve, LineSource
from reduction.quantities.digits import plain_number
from reduction.quantities.names import BRANCH_NAMES
from reduction.record.arrays import runs_of_true
from reduction.record.contributions import combined_standard_uncertainty
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats

CurveName = Literal["mean", "ascending", "descending"]

_NOT_APART = (
    "errors shared with other tests, such as the load cell, are not stored separately: the whole"
    " uncertainty is assigned to this curve"
)

_STEP_BACK = 1e-3  # share of the greatest tension: noise of a mean, not a loop


def line_from_archive(
    path: Path,
    *,
    curve: CurveName | None = None,
    specimen: str | None = None,
    **stated: Any,
) -> ExportLine:
    """Read one curve of an archive as a line."""
    with reading(path) as archive:
        line = _line_from_open_archive(archive, path.stem, curve=curve, specimen=specimen, **stated)
    failed = tuple(f"DOUBTFUL: {text}" for text in earlier_run_words(path))
    return replace(line, notes=(*failed, *line.notes))


def _line_from_open_archive(
    archive: xr.Dataset,
    stem: str,
    *,
    curve: CurveName | None = None,
    specimen: str | None = None,
    **stated: Any,
) -> ExportLine:
    """One curve of an open archive, as `line_from_archive`."""
    given, origins = _known_of(stated)
    if "hose" in archive.dims:
        if curve is not None:
            raise SettingsError("a predicted hose has one curve", found=curve, needed="no --curve")
        fields = _of_hose(archive, specimen)
    else:
        fields = _of_test(archive, curve or "mean", specimen)
    attributes = archive.attrs
    what = attributes.get("id", stem)
    sources = [f"archive {what}: {attributes.get('title', 'without a title')}"]
    if attributes.get("source"):
        sources.append(f"data: {attributes['source']}")
    if attributes.get("raw_file_sha256"):
        sources.append(
            f"raw file {attributes.get('raw_file', '')}, sha256 {attributes['raw_file_sha256']}"
        )
    if attributes.get("references"):
        sources.append(f"references: {attributes['references']}")
    sources += origins
    is_synthetic = attributes.get("synthetic", "no") == "yes"
    return ExportLine(**fields | given, sources=tuple(sources), is_synthetic=is_synthetic)


def _known_of(stated: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Known values that are stated at the export, and a sentence on the source of each."""
    given = {
        name: value
        for name, value in stated.items()
        if value is not None and not (isinstance(value, float) and math.isnan(value))
    }
    return given, [f"{name.replace('_', ' ')}: stated at the export" for name in given]


def _place(archive: xr.Dataset, dim: str, name: str | None) -> int:
    names = [str(value) for value in archive[dim].values]
    if name is None and len(names) == 1:
        return 0
    if name not in names:
        raise SettingsError(
            f"which {dim} is meant is not stated"
            if name is None
            else f"there is no {dim} '{name}'",
            needed="--specimen " + " or ".join(names),
        )
    return names.index(name)


def _of_hose(archive: xr.Dataset, name: str | None) -> dict[str, Any]:
    place = _place(archive, "hose", name)
    strain, tension = (
        archive.variables["strain"].values[place],
        archive.variables["tension"].values[place],
    )
    state = archive.variables["hose_state"].values[place]
    flags = str(archive.variables["hose_state"].attrs["flag_meanings"]).split()
    broken = int(archive.variables["hose_state"].attrs["flag_masks"][flags.index("broken")])
    known = np.isfinite(strain) & np.isfinite(tension) & ((state & broken) == 0)
    strain, tension = strain[known], tension[known]
    spread = stored(archive, "tension_standard_uncertainty")
    return {
        "name": str(archive.variables["hose"].values[place]),
        "spread": None if spread is None else CurveSpread(spread.values[place][known]),
        **_rising(strain, tension),
        "curve": "predicted from construction, up to the break of the cords",
        "tested": (math.nan, math.nan),
        "diameter": number_of(archive, "outer_diameter", place),
        "notes": ("a prediction: the range is that of the theory",),
    }


def _of_test(archive: xr.Dataset, curve: CurveName, name: str | None) -> dict[str, Any]:
    if "branch_tension" not in archive:
        raise DataError(
            "the archive has no curve of tension over strain",
            found=f"a test of the kind {archive.attrs['test_kind']}"
            if "test_kind" in archive.attrs
            else archive.attrs.get("id", "an archive of no test"),
            needed="the archive of a test with cycles or a rise, or the folder of a campaign",
        )
    place = _place(archive, "specimen", name)
    branches = [str(value) for value in archive.variables["branch_name"].values]
    by_branch = archive.variables["branch_tension"].values[place]
    rows = [branches.index(one) for one in (BRANCH_NAMES if curve == "mean" else (curve,))]
    # where one branch is unknown there is no mean: half a loop is no curve
    tension = by_branch[rows].mean(axis=0)
    strain = archive.variables["strain_bin"].values
    known = np.isfinite(tension)
    if known.sum() < 2:
        raise DataError(
            f"the {curve} curve has not two points", found=f"{int(known.sum())} strain bins"
        )
    cycles = "the cycles of the test"
    words = {
        "mean": f"mean of the ascending and descending branches, over {cycles}",
        "ascending": f"ascending branch, mean over {cycles}",
        "descending": f"descending branch, mean over {cycles}",
    }[curve]
    specimen = str(archive.variables["specimen"].values[place])
    notes = [f"DOUBTFUL: {text}" for text in check_words(archive, specimen)]
    notes += [
        f"{key.removeprefix('specimen_')}: {archive[key].values[place]}"
        for key in ("specimen_material", "specimen_condition")
        if key in archive and str(archive[key].values[place])
    ]
    notes += alignment_words(archive, place)
    if curve == "mean":
        gap = np.nanmax(np.abs(np.diff(by_branch[rows], axis=0)))
        notes.append(
            f"the branches are up to {plain_number(gap, 4)} N apart; this curve has no hysteresis"
        )
    if np.flatnonzero(known).size <= np.ptp(np.flatnonzero(known)):
        notes.append("strain bins without a mean lie within the curve: a straight line joins them")
    strain, tension = strain[known], tension[known]
    tested = (float(strain[0]), float(strain[-1]))
    spread = _spread_of(archive, place, rows, known)
    if spread is not None and spread.random is None:
        notes.append(_NOT_APART)
    if curve == "mean":
        turns = turns_of(archive, place)
        branches_only = strain, tension
        strain, tension, added = _to_turns(strain, tension, turns)
        notes += _smaller_cycle(
            loop_of_test(archive, specimen, specimen), *branches_only, strain, tension
        )
        if added.any():
            spread = None if spread is None else _with_ends(spread, added)
            notes.append(
                f"both branches are known from strain {plain_number(tested[0], 4)} to"
                f" {plain_number(tested[1], 4)}; from there a straight line goes on to the turning"
                f" points of the mean cycle, at {plain_number(strain[0], 4)} and"
                f" {plain_number(strain[-1], 4)}"
            )
        if turns.strain[1] - strain[-1] > _SHORT * (turns.strain[1] - turns.strain[0]):
            notes.append(
                f"DOUBTFUL: the curve ends at strain {plain_number(strain[-1], 4)} and the mean "
                f"cycle at {plain_number(turns.strain[1], 4)}: beyond the last row a code keeps"
                " the tension, so a whole cycle is softer than the test"
            )
    return {
        "name": specimen,
        "damping": _damping_of(archive, place) if curve == "mean" else None,
        "spread": spread,
        **_rising(strain, tension),
        "curve": words,
        "tested": tested,
        "turns": (float(strain[0]), float(strain[-1])),
        "diameter": number_of(archive, "diameter", place),
        "rated_break_strength": number_of(archive, "rated_break_strength", place),
        "linear_density": number_of(archive, "linear_density", place),
        "wet_linear_density": number_of(archive, "wet_linear_density", place),
        "material": (
            str(archive.variables["specimen_material"].values[place])
            if "specimen_material" in archive
            else ""
        ),
        "notes": tuple(notes),
    }


def _damping_of(archive: xr.Dataset, place: int) -> CycleDamping | None:
    """Dashpot of the cycles of a test; None where the energy of their loop is not known."""
    energy, frequency, amplitude, uncertainty, stiffness = (
        number_of(archive, name, place)
        for name in (
            "test_hysteresis_energy",
            "test_frequency",
            "test_strain_amplitude",
            "test_hysteresis_energy_standard_uncertainty",
            "test_apparent_spring_constant",
        )
    )
    if not (energy > 0 and frequency > 0 and amplitude > 0):
        return None
    return cycle_damping(energy, frequency, amplitude, uncertainty, stiffness)


# share of the range of the curve, at each end: for a sinusoidal load and a loss factor of 0.5, a
# third of the range, where one or the other branch has been trimmed
_FARTHEST = 0.5

_SHORT = 0.02  # share of the range of a cycle that a curve may lack at its upper end


def _to_turns(
    strain: Floats, tension: Floats, turns: Turns
) -> tuple[Floats, Floats, NDArray[np.int64]]:
    """A mean curve continued to the turns of the cycles, and the number of points added.

    Branches are trimmed at their ends, and a slope needs samples on both sides; a mooring code
    that moves the line over the whole cycle would find no stiffness there.  Both branches meet at
    the turns, whose tensions were measured.

    Examples
    --------
    A parabola from 1 to 2 whose cycles turn at 0.9 and 2.1.

    >>> strain = np.linspace(1, 2, 21)
    >>> longer, tension, added = _to_turns(strain, strain**2, Turns((0.9, 2.1), (0.81, 4.41)))
    >>> print(longer[[0, -1]], tension[[0, -1]].round(6), added)
    [0.9 2.1] [0.81 4.41] [1 1]
    """
    added = np.zeros(2, dtype=np.int64)
    reach = _FARTHEST * float(strain[-1] - strain[0])
    points, values = [strain], [tension]
    for end, way in enumerate((-1, 1)):
        inner = -end  # the first point, or the last
        beyond = way * (turns.strain[end] - float(strain[inner]))
        if not (0 < beyond <= reach and way * (turns.tension[end] - float(tension[inner])) > 0):
            continue
        place = 0 if end == 0 else len(points)
        points.insert(place, np.array([turns.strain[end]]))
        values.insert(place, np.array([turns.tension[end]]))
        added[end] = 1
    return np.concatenate(points), np.concatenate(values), added


def _with_ends(spread: CurveSpread, added: NDArray[np.int64]) -> CurveSpread:
    """The curve's uncertainty, with the errors of the end points at points added beyond them."""

    def longer(values: Floats) -> Floats:
        padding = [(0, 0)] * (values.ndim - 1) + [(int(added[0]), int(added[1]))]
        return np.asarray(np.pad(values, padding, mode="edge"))

    return replace(
        spread,
        standard=longer(spread.standard),
        random=None if spread.random is None else longer(spread.random),
        contribution=longer(spread.contribution) if spread.component else spread.contribution,
    )


def _spread_of(
    archive: xr.Dataset, place: int, branches: list[int], known: Bools
) -> CurveSpread | None:
    """Uncertainty of one branch, or of the mean of both; None where the archive has none."""
    if "branch_tension_standard_uncertainty" not in archive:
        return None
    own, shared = parts_of(archive, "branch_tension", place, of="tension")
    own = own[branches]
    # errors of each branch alone are independent; shared errors enter the mean with their sign
    random = np.sqrt(np.sum(own**2, axis=0))[known] / len(branches)
    if shared is None:
        return CurveSpread(random)
    rows = shared.values["tension"][:, branches].mean(axis=1)[:, known]
    return CurveSpread(combined_standard_uncertainty(rows, random), random, shared.component, rows)


def _rising(strain: Floats, tension: Floats) -> dict[str, Floats]:
    """The rising curve; a decrease within noise is levelled, a greater one refused."""
    level = np.maximum.accumulate(tension)
    fall = float(np.max(level - tension))
    if fall > _STEP_BACK * float(level[-1]):
        first = int(np.argmax(level - tension))
        raise DataError(
            "the curve falls as the strain rises, and one curve of a mooring code cannot",
            found=f"by {plain_number(fall, 4)} N at strain {plain_number(strain[first], 4)}",
            needed=f"a fall of at most {_STEP_BACK:g} of the greatest tension",
        )
    return {"strain": np.array(strain), "tension": np.array(level)}


def assembly_table(line: DeployedLine) -> ValueTable:
    """Return every node of an assembly: length, tension, stiffness, load of each tether."""
    deployed, assembly = line.deployed, line.deployed.assembly
    stiffness = deployed.stiffness
    columns = [
        TableColumn("total_length", "m", "end to end", np.array(assembly.total_length)),
        TableColumn("tension", "N", "of the assembly", np.array(assembly.tension)),
        *spread_columns(_assembly_spread(line), both="of the curve, at one length: of both parts"),
        TableColumn(
            "strain", "1", "of the length at which the assembly goes slack",
            np.array(deployed.strain),
        ),
        TableColumn(
            "secant_spring_constant", "N",
            "EA over that length, for a cycle of 5 % of the length to each side, from the tests"
            " that cover it",
            np.array(stiffness.spring_constant),
        ),
        TableColumn(
            "least_spring_constant", "N", "least EA of these tests, 95 %",
            np.array(stiffness.least),
        ),
        TableColumn(
            "greatest_spring_constant", "N", "greatest EA of these tests, 95 %",
            np.array(stiffness.greatest),
        ),
        TableColumn(
            "nearest_test", "", "of these, the nearest to the cycle in mean and amplitude",
            np.array(deployed.nearest_test),
        ),
        TableColumn("tether_length", "m", "thimble to thimble", np.array(assembly.tether_length)),
    ]  # fmt: skip
    several = [(1, "")] if line.is_equal else [
        (number, f"_{number}") for number in range(1, assembly.n_tethers + 1)
    ]  # fmt: skip
    for number, tail in several:
        which = "of each tether" if line.is_equal else f"of tether {number}"
        columns += [
            TableColumn(
                f"tether_tension{tail}", "N", f"{which}, zero where it is slack",
                np.array(assembly.tether_tension[number - 1]),
            ),
            TableColumn(
                f"tether_strain{tail}", "1", f"{which}, of its free length",
                np.array(assembly.tether_strain[number - 1]),
            ),
        ]  # fmt: skip
    columns.append(
        TableColumn(
            "is_tested", "", "every tether at a strain that a test reaches",
            np.array(assembly.is_tested),
        )
    )  # fmt: skip
    columns += [
        TableColumn("is_join", "", "pieces of a curve hand over", np.array(assembly.is_join)),
        TableColumn(
            "is_moved", "", "a curve was made to rise: its slope is that of the rule",
            np.array(assembly.is_moved),
        ),
    ]  # fmt: skip
    return ValueTable(
        title=f"{line.name}: {line.words}",
        columns=tuple(columns),
        sources=(line.splices, *line.source.sources),
        notes=(*(f"DOUBTFUL: {doubt}" for doubt in line.doubts), *line.notes),
        is_synthetic=line.source.is_synthetic,
        component=assembly.component,
        contribution=np.array(assembly.contribution),
    )


def _assembly_spread(line: DeployedLine) -> CurveSpread:
    assembly = line.deployed.assembly
    return CurveSpread(
        np.array(assembly.standard_uncertainty),
        np.array(assembly.random_standard_uncertainty),
        assembly.component,
        np.array(assembly.contribution),
    )


def line_from_assembly(line: DeployedLine, **stated: Any) -> ExportLine:
    """Make an export line of an assembly; its strain refers to the length at which it goes slack.

    Notes
    -----
    Diameter and mass of several tethers side by side are not those of one, and have to be stated
    ([1]_, sec. 2.3.2 prints none).
    """
    given, origins = _known_of(stated)
    deployed, assembly = line.deployed, line.deployed.assembly
    reached = np.flatnonzero(assembly.is_tested)
    tested = (
        (float(deployed.strain[reached[0]]), float(deployed.strain[reached[-1]]))
        if reached.size
        else (math.nan, math.nan)
    )
    return ExportLine(
        name=line.name,
        strain=np.array(deployed.strain),
        tension=np.array(assembly.tension),
        curve=f"assembly of {line.words}; tension of all tethers together",
        tested=tested,
        spread=_assembly_spread(line),
        sources=(
            line.splices,
            *line.source.sources,
            *origins,
        ),
        notes=(
            *_stiffness_notes(
                deployed.tests,
                assembly.total_length,
                assembly.tension,
                {
                    f"working.{number}": (state.low, state.high)
                    for number, state in enumerate(deployed.working, start=1)
                },
            ),
            *(f"DOUBTFUL: {doubt}" for doubt in line.doubts),
            "strain is of the unstretched length of the whole assembly,"
            f" {assembly.total_length[0]:.6g} m: this is the length of the line in the deck",
            *line.notes,
        ),
        is_synthetic=line.source.is_synthetic,
        **{"unstretched_length": float(assembly.total_length[0])} | given,
    )


_ON_GRID = 1e-3  # share of an EA by which the grid of strain can change it


def _stiffness_notes(
    tests: Sequence[LoadedTest],
    length: Floats,
    tension: Floats,
    cycles: Mapping[str, tuple[float, float]] | None = None,
) -> list[str]:
    """EA of the tests beside that of the exported table, and a warning where they differ.

    Each test is a cycle of its own loads; both EA are taken over the loads common to the tests that
    cover it.
    """
    named = list((cycles or {}).items()) + [(one.words, one.cycle) for one in tests]
    # a mean of tests may end below the loads of one of them
    low, high = np.minimum(np.array([loads for _, loads in named]).reshape(-1, 2).T, tension[-1])
    found = stiffness_of_cycles(tests, low, high, slack_length=float(length[0]))
    ends = [np.interp(at, tension, length) for at in (found.low, found.high)]
    own = length[0] * (found.high - found.low) / (ends[1] - ends[0])
    known = np.flatnonzero(np.isfinite(own)).tolist()
    if not known:
        return []

    def words(place: int) -> str:
        value, first, last, table = (
            plain_number(float(one[place]), 4)
            for one in (found.spring_constant, found.least, found.greatest, own)
        )
        loads = " to ".join(plain_number(float(one[place]), 4) for one in (found.low, found.high))
        return f"{named[place][0]} {value} N ({first} to {last}), table {table} N, {loads} N"

    said = ["EA of the tests, 95 %, beside that of this table: " + "; ".join(map(words, known))]
    # a table has no loop: it is compared with the curves of the tests without theirs
    least, greatest = found.curve_least, found.curve_greatest
    is_off = (own < (1 - _ON_GRID) * least) | (own > (1 + _ON_GRID) * greatest)
    off = [
        f"{named[place][0]} ({own[place] / found.spring_constant[place]:.2g} of it)"
        for place in known
        if is_off[place]
    ]
    if off:
        said.append(
            "DOUBTFUL: the table joins unlike tests, and between these loads its EA is outside"
            f" their interval: {', '.join(off)}; a mooring code uses its slope: for the stiffness"
            " of a cycle, export only the tests at its mean"
        )
    return said


_SMALLER = 0.5  # of the amplitude of the test

_SOFTER = 1.1  # stiffest cycle that a loop leaves open, over the slope of its mean curve


def _smaller_cycle(
    loop: MeasuredLoop | None,
    branch_strain: Floats,
    branch_tension: Floats,
    strain: Floats,
    tension: Floats,
) -> list[str]:
    """What the loop of a test leaves open about cycles of half its amplitude, beside the table."""
    if loop is None:
        return []
    mean = LoadedTest(
        words=loop.words,
        kind="cyclic",
        length=1 + branch_strain,
        tension=branch_tension,
        random_standard_uncertainty=0 * branch_strain,
        contribution=np.empty((0, branch_strain.size)),
        low=float(branch_tension[0]),
        high=float(branch_tension[-1]),
        loop=loop.of_line(),
    )
    middle, half = loop.tension.mean(), _SMALLER * np.ptp(loop.tension) / 2
    loads = np.array([middle - half, middle + half])
    if np.any(np.diff(branch_tension) <= 0):
        return []
    found = stiffness_of_cycles([mean], loads[:1], loads[1:], slack_length=1.0)
    least, greatest = float(found.least[0]), float(found.greatest[0])
    table = float(np.diff(loads)[0] / np.diff(np.interp(loads, tension, strain))[0])
    if not greatest > _SOFTER * table:
        return []
    return [
        "smaller cycles are stiffer than this curve, which is the middle of a loop: at half the"
        f" tension amplitude of the test the loop leaves EA between {plain_number(least, 3)} and"
        f" {plain_number(greatest, 3)} N, the curve has {plain_number(table, 3)} N; a test at that"
        " amplitude would show it"
    ]


def _cycles_without_a_curve(source: PieceSource, curve: CompositeCurve) -> list[str]:
    """K_ap of cyclic tests that are no part of the curve, beside its EA over their loads."""
    drawn = {piece.words for piece in curve.pieces}
    said = []
    for one in source.loops:
        low, high = one.tension.tolist()
        if one.words in drawn or high > curve.tension[-1]:
            continue
        ends = np.interp(one.tension, curve.tension, curve.strain)
        own, table = (
            plain_number(float((high - low) / (at[1] - at[0])), 4) for at in (one.strain, ends)
        )
        said.append(
            f"{one.words} {own} N, table {table} N, {plain_number(low, 4)} to"
            f" {plain_number(high, 4)} N"
        )
    return [
        "EA of cycles that are not in this curve, beside that of its table: " + "; ".join(said)
        + "; for waves, --form static-dynamic"
    ] if said else []  # fmt: skip


_WAYS = {
    "mean": "mean of both branches",
    "ascending": "ascending branch",
    "descending": "descending branch",
}


def ranges_of(curve: CompositeCurve, flags: Bools) -> list[tuple[float, float]]:
    """Strain ranges in which intervals of a curve have a flag, neighbours joined. [1].

    Examples
    --------
    >>> from reduction.lines.composite import _composite_curve
    >>> from reduction.lines.composite import CurvePiece
    >>> at = np.array([0.5, 1.0])
    >>> curve = _composite_curve([CurvePiece("T", "static", "ascending", at, 100 * at, 0 * at)])
    >>> ranges_of(curve, curve.is_gap)
    [(0.0, 0.5)]
    """
    return [tuple(curve.strain[ends].tolist()) for ends in runs_of_true(flags)]


def composite_table(source: PieceSource, curve: CompositeCurve) -> ValueTable:
    """Return every node of a composite curve, its piece, and the flags of the interval below it."""
    source = used_of(source, curve)
    piece = np.array([curve.piece_words[place] if place >= 0 else "" for place in curve.piece])

    def below(flags: Bools) -> Bools:
        return np.concatenate([[False], flags])

    return ValueTable(
        title=f"{source.name}: composite curve, {_WAYS[source.branch]}",
        columns=(
            TableColumn("strain", "1", "nominal strain", np.array(curve.strain)),
            TableColumn("tension", "N", "tension", np.array(curve.tension)),
            *spread_columns(
                _composite_spread(curve),
                "from the pieces, their mutual scatter, and the correction that makes the curve"
                " rise",
            ),
            TableColumn("piece", "", "with the greatest weight; none in a gap", piece),
            TableColumn(
                "is_join", "", "from the previous node: several pieces contribute",
                below(curve.is_join),
            ),
            TableColumn(
                "is_gap", "", "from the previous node: no piece reaches", below(curve.is_gap)
            ),
            TableColumn(
                "is_moved", "", "from the previous node: not the mean of the pieces, which falls"
                                " or "
                "is too soft nearby", below(curve.is_moved),
            ),
            TableColumn(
                "monotone_change", "N", "added to the mean of the pieces to make the curve rise",
                np.array(curve.monotone_change),
            ),
        ),
        sources=source.sources,
        notes=(
            *([f"DOUBTFUL: {curve.doubt}"] if curve.doubt else []), *curve.notes, *source.notes,
        ),
        is_synthetic=source.is_synthetic,
        component=curve.component,
        contribution=np.array(curve.contribution),
    )  # fmt: skip


def _composite_spread(curve: CompositeCurve) -> CurveSpread:
    return CurveSpread(
        np.array(curve.standard_uncertainty),
        np.array(curve.random_standard_uncertainty),
        curve.component,
        np.array(curve.contribution),
    )


def line_from_composite(source: PieceSource, curve: CompositeCurve, **stated: Any) -> ExportLine:
    """Make a line for export of a composite curve.

    Notes
    -----
    Tested from the first node of a piece to the last; gaps between are in the notes ([1]_, sec.
    4.8).
    """
    source = used_of(source, curve)
    given, origins = _known_of(stated)
    first = int(np.argmax(curve.piece >= 0))
    rises = all(piece.branch == "ascending" for piece in source.pieces)
    n_tests = len(set(curve.piece_names))
    tests = f"{n_tests} tests" if n_tests > 1 else "1 test"
    joins = [
        f"{plain_number(low, 4)} to {plain_number(high, 4)}"
        for low, high in ranges_of(curve, curve.is_join)
    ]
    fields = {
        "diameter": source.diameter,
        "rated_break_strength": source.rated_break_strength,
        "linear_density": source.linear_density,
        "wet_linear_density": source.wet_linear_density,
    }
    return ExportLine(
        name=source.name,
        strain=np.array(curve.strain),
        tension=np.array(curve.tension),
        curve=f"composite of {tests}, {_WAYS['ascending' if rises else source.branch]}; one curve,"
        " no loop",
        tested=(float(curve.strain[first]), float(curve.strain[-1])),
        spread=_composite_spread(curve),
        sources=(
            *source.sources,
            *origins,
        ),
        notes=(
            *([f"DOUBTFUL: {curve.doubt}"] if curve.doubt else []),
            *_stiffness_notes(tests_of_curve(curve, source.loops), 1 + curve.strain, curve.tension),
            *_cycles_without_a_curve(source, curve),
            *curve.notes,
            *([f"several pieces contribute at strain {', '.join(joins)}"] if joins else []),
            *source.notes,
        ),
        is_synthetic=source.is_synthetic,
        **fields | given,
    )


_POINTS = 201

_LARGE_CONSTANT = 0.01

_MOST_CUT, _LEAST_CUT = 0.9, 0.05  # shares of the greatest tension that a cut may leave or remove

_STRAIN = ("strain", "quasi_static_strain")

_TENSION = ("tension", "branch_tension")


def line_from_lookup(
    source: LineSource,
    *,
    branch: Branch | None = None,
    siblings: Sequence[LineSource] = (),
    levels: Mapping[str, float] | None = None,
    extrapolate: Literal["refuse", "flag"] = "refuse",
    **stated: Any,
) -> ExportLine:
    """Make a line for export of a source of design values.

    Notes
    -----
    Static and dynamic stiffness are those of `reduction.lines.export_dynamics.line_dynamics`: K_0
    and K_0 + K_1 at the mean tension, N = K_1 tau ([2]_), identified so that the line reproduces
    its own K_ap and H.
    """
    curve = _trusted(source, _curve_of(source, branch))
    strain, tension, cut = _points(source, curve)
    start = start_against(strain, tension, curve.branch, siblings)
    doubts = [f"DOUBTFUL: {text}" for text in (*source.warnings, *curve.warnings)]
    notes = [*doubts, *source.notes, *curve.notes, curve.range_note, *cut, *start]
    words = "of a pull" if not curve.branch else f"{curve.branch} branch"
    sources = [f"{source.source}: {curve.quantity} over {curve.variable}, {words}"]
    if curve.errata:
        sources.append(f"errata that apply to the curve: {', '.join(curve.errata)}")
    part = None
    if levels:
        dynamics = line_dynamics(source, levels, extrapolate)
        part = dynamics.part
        sources += dynamics.sources
        notes += dynamics.notes
    given, origins = _known_of(stated)
    sources += origins
    own = {
        name: getattr(source, name)
        for name in (
            "diameter",
            "rated_break_strength",
            "linear_density",
            "wet_linear_density",
            "material",
        )
    }
    own["rated_break_strength"], said = _strength(source)
    if "rated_break_strength" not in given:
        notes.append(said)
    return ExportLine(
        name=source.name,
        strain=strain,
        tension=tension,
        curve=f"{curve.quantity} over {curve.variable}, {words}; one curve, no loop",
        tested=_tested(curve, strain, tension),
        viscoelasticity=part,
        sources=tuple(sources),
        notes=tuple(note for note in dict.fromkeys(notes) if note),
        is_synthetic="synthetic data" in source.notes,
        **own | given,
    )


def _strength(source: LineSource) -> tuple[float, str]:
    """Strength to export where none is stated, and why it is not the rated one. [N]."""
    if source.strength_of:
        return math.nan, (
            f"no break strength is exported: that of the source is of {source.strength_of}; state "
            "--rated-break-strength"
        )
    left = source.tensile_strength
    # NaN where the line is new: then the rated strength is used
    if left < source.rated_break_strength:
        return left, (
            f"break strength {plain_number(left)} N: residual strength in this condition; rated"
            f" when new {plain_number(source.rated_break_strength)} N"
        )
    return source.rated_break_strength, ""


def _curve_of(source: LineSource, branch: Branch | None) -> LineCurve:
    """The only curve of strain and tension."""
    found = [
        one
        for one in source.curves
        if (one.quantity in _STRAIN and one.variable in ("tension", "mean_tension"))
        or (one.quantity in _TENSION and one.variable == "strain")
    ]
    if not found:
        why = next(
            (source.absent[name] for name in (*_STRAIN, *_TENSION) if name in source.absent), ""
        )
        raise SettingsError(
            f"{source.name} has no curve of tension and strain" + (f": {why}" if why else ""),
            found=", ".join(source.quantities) or "nothing",
            needed="strain over tension, or tension over strain",
        )
    # where only one branch was measured it need not be named
    wanted = branch or (found[0].branch if len(found) == 1 else "")
    of_branch = [one for one in found if one.branch in ("", wanted)]
    if not of_branch:
        raise SettingsError(
            f"the curve of {source.name} differs by branch",
            found=branch or "no branch",
            needed=" or ".join(one.branch for one in found),
        )
    return of_branch[0]


def _trusted(source: LineSource, curve: LineCurve) -> LineCurve:
    """The curve up to the limit of K_0, where the source gives K_0 as its slope."""
    for rest in source.curves:
        if rest.is_inverse_slope and rest.high < curve.high and curve.variable == "tension":
            why = f"{curve.range_note}; {rest.range_note}" if curve.range_note else rest.range_note
            return replace(curve, high=rest.high, range_note=why)
    return curve


def _points(source: LineSource, curve: LineCurve) -> tuple[Floats, Floats, list[str]]:
    """Strain and tension where both rise, and notes on the parts left out."""
    at = curve.at if curve.at.size else np.linspace(curve.low, curve.high, _POINTS)
    value = evaluate_curve(curve, at).value
    strain, tension = (value, at) if curve.quantity in _STRAIN else (at, value)
    if not (np.isfinite(strain).all() and np.isfinite(tension).all()):
        raise DataError(
            f"the curve of {source.name} is not known throughout",
            found="values that are open or lost",
            hint="The errata of the source say which.",
        )
    # adjoining segments repeat their common point
    new = np.append(True, (np.diff(strain) != 0) | (np.diff(tension) != 0))
    strain, tension, notes = strain[new], tension[new], []
    back = np.flatnonzero((np.diff(strain) <= 0) | (np.diff(tension) <= 0))
    if back.size:
        first, top = int(back[0]), float(tension.max())
        if not curve.coefficient.size or tension[first] < _MOST_CUT * top:
            raise DataError(
                f"the curve of {source.name} does not rise throughout what was tested",
                found=f"strain {plain_number(strain[first], 4)} to "
                f"{plain_number(strain[first + 1], 4)}, tension "
                f"{plain_number(tension[first])} to {plain_number(tension[first + 1])} N",
                needed="one that rises",
            )
        strain, tension = strain[: first + 1], tension[: first + 1]
        notes.append(
            f"ends at {plain_number(tension[-1])} N, where the polynomial turns back; the source"
            f" states it up to {plain_number(top)} N"
        )
    below = (strain < 0) | ((strain == 0) & (tension > 0))
    if below.any() and tension[below][-1] < _LEAST_CUT * tension[-1]:
        notes.append(
            f"the polynomial has strain below zero up to {plain_number(tension[below][-1], 4)} N,"
            " from the constant of its fit; that part is left out"
        )
        strain, tension = strain[~below], tension[~below]
    if curve.coefficient.size and strain[0] > 0 and tension[0] == 0:
        strain, tension, said = _without_constant(strain, tension)
        notes.append(said)
    return strain, tension, notes


def _without_constant(strain: Floats, tension: Floats) -> tuple[Floats, Floats, str]:
    """The curve of a regression, from the point where its constant is small.

    A pull starts at zero strain and tension; the strain of a cubic there is an error of the fit,
    not measured slack.  At twice the constant it is half of the strain; there, or at a twentieth
    of the greatest tension, the straight line from 0 0 joins the curve.
    """
    constant = float(strain[0])
    joins = (strain >= 2 * constant) | (tension >= _LEAST_CUT * tension[-1])
    first = int(np.argmax(joins))
    doubt = "DOUBTFUL: " if constant > _LARGE_CONSTANT else ""
    said = (
        f"{doubt}the regression has strain {constant:.4g} at no tension, a constant of the fit, not"
        " measured slack: replaced by a straight line from zero that joins it at strain"
        f" {plain_number(strain[first], 4)} and {plain_number(tension[first], 4)} N; as slack it"
        f" would be {100 * constant:.2g} m in 100 m of line"
    )
    return strain[first:], tension[first:], said


def _tested(curve: LineCurve, strain: Floats, tension: Floats) -> tuple[float, float]:
    ends = np.array([curve.low, curve.high])
    if curve.quantity in _STRAIN:
        ends = np.interp(ends, tension, strain)
    return max(float(ends[0]), 0.0), min(float(ends[1]), float(strain[-1]))
