"""Pages of one curve: a composite of many tests, a deployed assembly."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from reduction.archive.write import write_whole
from reduction.lookup.composite import CompositeCurve
from reduction.lookup.source import PieceSource
from reduction.pipeline.deployed import DeployedLine
from reduction.report.figures.curves import draw_assembly, draw_composite, draw_stiffness
from reduction.report.htmltable import Table, make_table, measured, number, number_text, words
from reduction.report.render import Page, about_page, render_page
from reduction.report.section import Part, Section, make_part
from reduction.report.style import Shown, shown
from reduction.report.summary import Finding, Tile
from reduction.report.uncertainty import NORMAL, factor_words
from reduction.units import UnitSystem

_RULE = (
    "The curve is the one that rises and is nearest to all pieces, each weighted by its "
    "uncertainty and by what pieces of its kind differ by."
)
_RULED = "local EA by the rule"
_DOUBTS = ("DOUBTFUL", "no pieces of one curve", "slipped", "not known", "extrapolated")


def write_composite_page(
    source: PieceSource, curve: CompositeCurve, path: Path, *, units: UnitSystem = "si"
) -> None:
    """Write the page of a composite curve.

    Parameters
    ----------
    source : PieceSource
        Of the pieces.
    curve : CompositeCurve
        Of them.
    path : pathlib.Path
        The page; it appears whole or not at all.
    units : UnitSystem
        What a reader is shown.

    Raises
    ------
    ArchiveError
        If the disk refuses.
    """
    force, percent = shown("tension", units), shown("strain", units)
    tests = len(set(curve.piece_names))
    tiles = [
        Tile(f"{tests}", "test" if tests == 1 else "tests", "curve"),
        Tile(_with_unit(float(curve.strain[-1]), percent), "greatest strain", "curve"),
        Tile(_with_unit(float(curve.tension[-1]), force), "tension there", "curve"),
    ]
    part = make_part(
        "Tension against strain", [draw_composite(source, curve, units)],
        [_piece_table(source, curve, units)],
    )  # fmt: skip
    _write(
        path, f"Composite curve of {source.name}", [part], tiles=tiles, units=units,
        notes=(*_doubt(curve), *curve.notes, *source.notes), sources=source.sources,
        synthetic=source.is_synthetic, subtitle=f"Branch: {source.branch}.",
    )  # fmt: skip


def write_assembly_page(found: DeployedLine, path: Path, *, units: UnitSystem = "si") -> None:
    """Write the page of a deployed assembly, with the curve of its tethers.

    Parameters
    ----------
    found : DeployedLine
        The assembly.
    path : pathlib.Path
        The page; it appears whole or not at all.
    units : UnitSystem
        What a reader is shown.

    Raises
    ------
    ArchiveError
        If the disk refuses.
    """
    length = shown("length", units)
    assembly, source = found.deployed.assembly, found.source
    tiles = [
        Tile(f"{assembly.n_tethers}", "tethers" if assembly.n_tethers > 1 else "tether", "curve"),
        Tile(_with_unit(float(assembly.total_length[0]), length), "slack below", "curve"),
    ]
    parts = [
        make_part(
            "Tension against length", [draw_assembly(found, units)], [_working_table(found, units)]
        ),
        make_part("Stiffness", [draw_stiffness(found, units)]),
        make_part(
            "Curve of a tether", [draw_composite(source, found.curve, units)],
            [_piece_table(source, found.curve, units)],
        ),
    ]  # fmt: skip
    _write(
        path, f"Assembly {found.name}", parts, tiles=tiles, units=units,
        notes=(*_doubt(found.curve), *found.deployed.notes, *found.curve.notes, *source.notes),
        sources=(found.splices, *source.sources), synthetic=source.is_synthetic,
        subtitle=f"{found.words}.",
    )  # fmt: skip


def _doubt(curve: CompositeCurve) -> tuple[str, ...]:
    """What makes a curve doubtful as a whole, to stand before its notes."""
    return (f"DOUBTFUL: {curve.doubt}",) if curve.doubt else ()


def _piece_table(source: PieceSource, curve: CompositeCurve, units: UnitSystem) -> Table:
    percent, force = shown("strain", units), shown("tension", units)
    used = set(curve.piece_names)
    rows = [
        [
            words(one.name),
            words(one.kind),
            words(one.branch),
            number(float(one.strain[0]), percent),
            number(float(one.strain[-1]), percent),
            number(float(one.tension[0]), force),
            number(float(one.tension[-1]), force),
        ]
        for one in source.pieces
        if one.name in used
    ]
    return make_table(
        "Pieces of the curve.",
        (
            "test", "kind", "branch", percent.label("from strain"), percent.label("to strain"),
            force.label("from tension"), force.label("to tension"),
        ),
        rows, synthetic=source.is_synthetic, is_tall=len(rows) > 12,
    )  # fmt: skip


def _working_table(found: DeployedLine, units: UnitSystem) -> Table | None:
    """None where no working point was asked for."""
    length, force, percent = shown("length", units), shown("tension", units), shown("strain", units)
    rows = []
    for place, state in enumerate(found.deployed.working, start=1):
        point, sharing = state.point, state.sharing
        has_cycle = bool(state.level.tension_amplitude)
        doubts = (("not tested", not point.is_tested), (_RULED, state.is_moved and not has_cycle))
        local = float("nan") if has_cycle else float(point.apparent_spring_constant)
        rows.append(
            [
                words(", ".join([str(place), *(word for word, holds in doubts if holds)])),
                measured(float(point.mean_tension), NORMAL * state.standard_uncertainty, force),
                number(state.level.tension_amplitude, force),
                number(float(point.total_length), length),
                number(float(state.strain.max()), percent),
                number(state.secant_spring_constant, force),
                number(local, force),
                number(float(point.peak_tether_tension.max()), force),
                number(100 * float(point.peak_share.max())),
                number(float("nan") if sharing is None else float(sharing.least_load), force),
                number(float("nan") if sharing is None else float(sharing.greatest_load), force),
            ]
        )
    if not rows:
        return None
    return make_table(
        "Working points.",
        (
            "point", force.label("tension"), force.label("amplitude"), length.label("length"),
            percent.label("strain of a tether"), force.label("EA"), force.label("local EA"),
            force.label("greatest of a tether"), "of its strength [%]",
            force.label("least by the tolerance"), force.label("greatest by the tolerance"),
        ),
        rows, synthetic=found.source.is_synthetic,
        remarks=[
            f"±: expanded uncertainty, 95 % ({factor_words([NORMAL])}), of the curve at that"
            " length. EA is that of the cycle, peak to valley; where there is none it is over 5 %"
            " of the length to each side, and the tangent stands beside it as local EA, which is"
            " doubtful where it is that of the rule of rising. Loads by the tolerance of the"
            " lengths are at the mean tension."
        ],
    )  # fmt: skip


def _write(
    path: Path,
    title: str,
    parts: Sequence[Part],
    *,
    tiles: Sequence[Tile],
    units: UnitSystem,
    notes: Sequence[str],
    sources: Sequence[str],
    synthetic: bool,
    subtitle: str,
) -> None:
    section = Section(
        key="curve", title=title, subtitle=subtitle, parts=tuple(parts), notes=(),
        provenance=tuple(("source", text) for text in sources), noun="curve",
    )  # fmt: skip
    page = Page(
        title=title,
        campaign=title,
        summary="",
        about=about_page(
            units, "what its sources say", in_si="Notes are in SI.", definitions=[_RULE]
        ),
        tiles=tiles,
        faults=[
            Finding(
                "warning" if any(word in note for word in _DOUBTS) else "note",
                (title,),
                f"{note[:1].upper()}{note[1:]}.",
            )
            for note in dict.fromkeys(notes)
        ],
        chapters=[section],
        synthetic=synthetic,
    )
    write_whole(path, render_page(page))


def _with_unit(value: float, unit: Shown) -> str:
    return f"{number_text(value * unit.factor)} {unit.unit}"
