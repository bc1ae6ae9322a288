"""Pages of one prediction, composite or assembly, with their figures."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from reduction.archive.write import write_text_atomically
from reduction.lines.assembly import DeployedLine
from reduction.lines.composite import CompositeCurve, PieceSource
from reduction.prediction.armour import PredictedArmour
from reduction.prediction.wave_load import PredictedWaveLoad
from reduction.quantities.units import UnitSystem
from reduction.record.measurement import Bools, Floats
from reduction.report.campaign_summary import SummaryFinding, Tile
from reduction.report.figure_data import Figure, Trace, axis, band, line, make_figure, plain_numbers
from reduction.report.figures.theory_figures import (
    draw_errors,
    draw_section,
    draw_surface,
    draw_wave_load,
    draw_wire,
    force_per_length,
)
from reduction.report.page_template import Page, about_page, render_page
from reduction.report.prediction_tables import (
    anchor_table,
    armour_design_table,
    cable_table,
    extremes_table,
    layers_table,
    regime_table,
    use_table,
    wave_coefficient_table,
    wave_table,
    wires_table,
)
from reduction.report.test_section import Part, TestSection, make_part
from reduction.report.test_view import NORMAL, factor_words
from reduction.report.text_style import (
    COLOURS,
    SYMBOLS,
    PageTable,
    Shown,
    colour,
    make_table,
    measured,
    number,
    number_text,
    shown,
    with_prefix,
    words,
)

_CURVE, *_PIECES = COLOURS

_DASHES = {"cyclic": "solid", "static": "dash", "first-loading": "dot"}


def _draw_composite(source: PieceSource, curve: CompositeCurve, units: UnitSystem) -> Figure:
    """Draw the curve with its uncertainty over its pieces; gaps are dotted."""
    percent, force = shown("strain", units), shown("tension", units)
    strain, load = percent.factor * curve.strain, force.factor * curve.tension
    spread = NORMAL * force.factor * curve.standard_uncertainty
    used = set(curve.piece_names)
    names = list(dict.fromkeys(one.name for one in source.pieces))
    data: list[Trace] = [
        band(
            strain, load - spread, load + spread, name="expanded uncertainty, 95 %", colour=_CURVE,
            alpha=0.13,
        )
    ]  # fmt: skip
    named: set[str] = set()
    for one in source.pieces:
        if one.name not in used:
            continue
        tint = _PIECES[names.index(one.name) % len(_PIECES)]
        data.append(
            line(
                percent.factor * one.strain, force.factor * one.tension,
                name=f"{one.name}, {one.kind}", colour=tint, dash=_DASHES[one.kind], width=1.4,
                showlegend=f"{one.name} {one.kind}" not in named,
            )
        )  # fmt: skip
        named.add(f"{one.name} {one.kind}")
    data += [
        line(strain, _of(load, ~curve.is_gap), name="composite", colour=_CURVE, width=3.4),
        line(
            strain, _of(load, curve.is_gap), name="gap", colour=_CURVE, dash="dot", width=1.8,
        ),
    ]  # fmt: skip
    return make_figure(
        "composite", f"Composite curve of {source.name}",
        "Thick: the curve with its expanded uncertainty, dotted where no piece reaches (95 %,"
        f" {factor_words([NORMAL])}). Thin: its pieces, solid of cycles, dashed of static tests,"
        " dotted of first rises.",
        data, synthetic=source.is_synthetic, height=520, is_wide=True,
        xaxis=axis(percent.label("strain")), yaxis=axis(force.label("tension")),
    )  # fmt: skip


def _of(values: Floats, flags: Bools) -> Floats:
    """Values at the ends of the intervals that have a flag; NaN elsewhere."""
    ends = np.concatenate([[False], flags]) | np.concatenate([flags, [False]])
    return np.where(ends, values, np.nan)


def _draw_assembly(found: DeployedLine, units: UnitSystem) -> Figure:
    """Draw tension against length with its uncertainty, and the working points."""
    assembly = found.deployed.assembly
    length, force = shown("length", units), shown("tension", units)
    at, load = length.factor * assembly.total_length, force.factor * assembly.tension
    spread = NORMAL * force.factor * assembly.standard_uncertainty
    data: list[Trace] = [
        band(
            at, load - spread, load + spread, name="expanded uncertainty, 95 %", colour=COLOURS[0],
            alpha=0.15,
        ),
        line(
            at, np.where(assembly.is_tested, load, np.nan), name="assembly", colour=COLOURS[0],
            width=2.6,
        ),
        line(
            at, np.where(assembly.is_tested, np.nan, load), name="not tested", colour=COLOURS[0],
            dash="dot",
        ),
    ]  # fmt: skip
    for place, state in enumerate(found.deployed.working, start=1):
        point, tint = state.point, colour(place)
        ends = np.array([point.minimum_tension, point.mean_tension, point.peak_tension])
        lengths = np.array([state.minimum_length, float(point.total_length), state.peak_length])
        data.append(
            {
                "type": "scatter", "mode": "lines+markers", "name": f"working point {place}",
                "x": plain_numbers(length.factor * lengths),
                "y": plain_numbers(force.factor * ends),
                "line": {"color": tint, "width": 3},
                "marker": {"color": tint, "size": 9, "symbol": SYMBOLS[place % len(SYMBOLS)]},
            }
        )  # fmt: skip
    return make_figure(
        "assembly", f"Tension of {found.name}",
        f"Band: expanded uncertainty (95 %, {factor_words([NORMAL])}). Dotted where a tether is at"
        " a strain that no test reaches. Marked: working points, with cycles from valley to peak"
        " at the stiffness of their tests. The curve is softer where it passes from one test to"
        " the next.",
        data, synthetic=found.source.is_synthetic, height=460, is_wide=True,
        xaxis=axis(length.label("length")), yaxis=axis(force.label("tension")),
    )  # fmt: skip


_N_LOADS = 241


def _draw_stiffness(found: DeployedLine, units: UnitSystem) -> Figure:
    """Draw EA against tension: of each test, of the curve, and what is stated of each cycle."""
    force = shown("tension", units)
    deployed, slack = found.deployed, float(found.deployed.assembly.total_length[0])
    data: list[Trace] = []
    for place, one in enumerate(deployed.tests):
        at, spring = _chords(one.length, one.tension, slack)
        data.append(
            line(
                force.factor * at, force.factor * spring, name=one.words,
                colour=_PIECES[place % len(_PIECES)], width=1.6,
                dash="solid" if place < len(_PIECES) else "dash",
            )
        )  # fmt: skip
    at, spring = _chords(deployed.assembly.total_length, deployed.assembly.tension, slack)
    data.append(
        line(
            force.factor * at, force.factor * spring, name="curve that joins them, not used",
            colour=_CURVE, dash="dot", width=1.2,
        )
    )  # fmt: skip
    for place, state in enumerate(deployed.working, start=1):
        ends = force.factor * np.array([state.low, state.high])
        value, least, greatest = (
            np.full(2, force.factor * one)
            for one in (
                state.secant_spring_constant,
                state.least_spring_constant,
                state.greatest_spring_constant,
            )
        )
        name = f"working point {place}"
        data += [
            band(ends, least, greatest, name=f"{name}, its tests", colour=_CURVE, alpha=0.15),
            line(ends, value, name=name, colour=_CURVE, width=3.4),
        ]
    return make_figure(
        "assembly-stiffness", "Stiffness",
        "EA over the slack length of the assembly. Thin: each test alone, over 5 % of its load"
        " range to each side. Thick: each stated cycle, with the interval of the tests that cover"
        " it (95 %). Dotted: slope of the joined curve, which belongs to no test where it passes"
        " from one to the next.",
        data, synthetic=found.source.is_synthetic, height=520, is_wide=True,
        xaxis=axis(force.label("tension")), yaxis=axis(force.label("EA")),
    )  # fmt: skip


def _chords(length: Floats, tension: Floats, slack_length: float) -> tuple[Floats, Floats]:
    """Tensions along a curve, and EA over a twentieth of its loads to each side of them. [N]."""
    at = np.linspace(tension[0], tension[-1], _N_LOADS)
    reach = (tension[-1] - tension[0]) / 20
    low, high = np.maximum(at - reach, tension[0]), np.minimum(at + reach, tension[-1])
    ends = [np.interp(one, tension, length) for one in (low, high)]
    return at, slack_length * (high - low) / (ends[1] - ends[0])


_OF_WAVE = (
    "A regular wave on a hose that lies along its crest and follows the surface; the hose does not"
    " disturb the flow. S. Zhang et al., Open Petroleum Eng. J., vol. 8, 2015."
)

_OF_ARMOUR = (
    "Round elastic wires on a rigid core, stretched with their cable. H. Wang et al., J. Mar. Sci."
    " Eng., vol. 10, 642, 2022."
)


def write_wave_page(
    found: PredictedWaveLoad, out: Path, *, name: str, units: UnitSystem = "si"
) -> Path:
    """Write the page of a wave load."""
    unit, force = force_per_length(units), shown("tension", units)
    tiles = [
        Tile(_with_unit(float(one.greatest), unit), f"{words}, greatest", "load")
        for words, one in (
            ("horizontal", found.extremes.horizontal), ("vertical", found.extremes.vertical),
        )
    ]  # fmt: skip
    anchor = _with_unit(abs(float(found.anchor.combined)), force)
    tiles.append(Tile(anchor, "anchor force", "load"))
    parts = [
        make_part("Load over time", draw_wave_load(found, units)),
        make_part("Anchor force", (), [anchor_table(found, units)]),
        make_part(
            "Surface and section", [*draw_surface(found, units), *draw_section(found, units)],
            [wave_table(found, units), regime_table(found, units)],
        ),
        make_part("Coefficients", (), [wave_coefficient_table(found)]),
    ]  # fmt: skip
    return write_single_page(
        out, _title("Wave load", name), "load", parts, answer=extremes_table(found, units),
        tiles=tiles, notes=found.notes, units=units, about=_OF_WAVE,
    )  # fmt: skip


def write_armour_page(
    found: PredictedArmour, out: Path, *, name: str, units: UnitSystem = "si"
) -> Path:
    """Write the page of an armour."""
    force = shown("tension", units)
    size = len(found.layer_names)
    tension = _with_unit(float(found.together.tension[0]), force)
    tiles = [
        Tile(f"{size:,}", "layer" if size == 1 else "layers", "armour"),
        Tile(tension, f"at {100 * float(found.strain[0]):g} % of strain", "armour"),
    ]
    if found.strength is not None:
        load = _with_unit(found.strength.tension, force)
        tiles.append(Tile(load, "at first yield", "armour"))
    parts = [
        make_part(
            "The cable and its layers",
            (),
            [cable_table(found, units), armour_design_table(found, units)],
        ),
        make_part("One wire", draw_wire(found, units), [wires_table(found, units)]),
        make_part("Where each theory holds", draw_errors(found), [use_table(found)]),
    ]  # fmt: skip
    return write_single_page(
        out, _title("Armour", name), "armour", parts, answer=layers_table(found, units),
        tiles=tiles, notes=found.notes, units=units, about=_OF_ARMOUR,
    )  # fmt: skip


def write_single_page(
    out: Path,
    title: str,
    key: str,
    parts: Sequence[Part],
    *,
    answer: PageTable | None,
    tiles: Sequence[Tile],
    notes: Sequence[str],
    units: UnitSystem,
    about: str,
    made_from: str = "the numbers of its SPEC.toml alone",
    subtitle: str = "Predicted: nothing was measured.",
) -> Path:
    """Write a page of one section as ``index.html``."""
    section = TestSection(
        key=key, title=title, subtitle=subtitle,
        parts=tuple(parts), notes=(), provenance=(),
    )  # fmt: skip
    page = Page(
        title=title,
        campaign=title,
        summary="",
        about=about_page(
            units, made_from, in_si="Notes are in SI.", definitions=[about]
        ),
        tiles=tiles,
        faults=[
            SummaryFinding("warning", (title,), f"{note[:1].upper()}{note[1:]}.") for note in notes
        ],
        chapters=[section],
        answers=[] if answer is None else [answer],
    )  # fmt: skip
    path = out / "index.html"
    write_text_atomically(path, *render_page(page))
    return path


def _title(kind: str, name: str) -> str:
    """Kind and name of a case; a name that says the kind again is left out."""
    return kind if name.lower() in kind.lower() else f"{kind} {name}"


def _with_unit(value: float, unit: Shown) -> str:
    found = with_prefix(unit, value)
    return f"{number_text(value * found.factor)} {found.unit}"


_RULE = (
    "The curve is the rising curve nearest to all pieces, each weighted by its uncertainty and by"
    " the scatter between pieces of its kind."
)

_DOUBTS = ("DOUBTFUL", "no pieces of one curve", "slipped", "not known", "extrapolated")


def write_composite_page(
    source: PieceSource, curve: CompositeCurve, path: Path, *, units: UnitSystem = "si"
) -> None:
    """Write the page of a composite curve."""
    force, percent = shown("tension", units), shown("strain", units)
    tests = len(set(curve.piece_names))
    tiles = [
        Tile(f"{tests}", "test" if tests == 1 else "tests", "curve"),
        Tile(_rounded_with_unit(float(curve.strain[-1]), percent), "greatest strain", "curve"),
        Tile(_rounded_with_unit(float(curve.tension[-1]), force), "tension there", "curve"),
    ]
    part = make_part(
        "Tension against strain", [_draw_composite(source, curve, units)],
        [_piece_table(source, curve, units)],
    )  # fmt: skip
    _write_curve_page(
        path, f"Composite curve of {source.name}", [part], tiles=tiles, units=units,
        notes=(*_warning(curve), *curve.notes, *source.notes), sources=source.sources,
        synthetic=source.is_synthetic, subtitle=f"Branch: {source.branch}.",
    )  # fmt: skip


def write_assembly_page(found: DeployedLine, path: Path, *, units: UnitSystem = "si") -> None:
    """Write the page of a deployed assembly, with the curve of its tethers."""
    length = shown("length", units)
    assembly, source = found.deployed.assembly, found.source
    tiles = [
        Tile(f"{assembly.n_tethers}", "tethers" if assembly.n_tethers > 1 else "tether", "curve"),
        Tile(_rounded_with_unit(float(assembly.total_length[0]), length), "slack below", "curve"),
    ]
    parts = [
        make_part(
            "Tension against length", [_draw_assembly(found, units)], [_working_table(found, units)]
        ),
        make_part("Stiffness", [_draw_stiffness(found, units)]),
        make_part(
            "Curve of a tether", [_draw_composite(source, found.curve, units)],
            [_piece_table(source, found.curve, units)],
        ),
    ]  # fmt: skip
    _write_curve_page(
        path, f"Assembly {found.name}", parts, tiles=tiles, units=units,
        notes=(*(f"DOUBTFUL: {doubt}" for doubt in found.doubts), *found.notes),
        sources=(found.splices, *source.sources), synthetic=source.is_synthetic,
        subtitle=f"{found.words}.",
    )  # fmt: skip


def _warning(curve: CompositeCurve) -> tuple[str, ...]:
    """What makes a curve doubtful as a whole, to stand before its notes."""
    return (f"DOUBTFUL: {curve.doubt}",) if curve.doubt else ()


def _piece_table(source: PieceSource, curve: CompositeCurve, units: UnitSystem) -> PageTable:
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
        rows, is_tall=len(rows) > 12,
    )  # fmt: skip


def _working_table(found: DeployedLine, units: UnitSystem) -> PageTable | None:
    """None where no working point was asked for."""
    length, force, percent = shown("length", units), shown("tension", units), shown("strain", units)
    rows = []
    for place, state in enumerate(found.deployed.working, start=1):
        point, sharing = state.point, state.sharing
        doubts = (("not tested", not point.is_tested), ("doubtful", bool(state.doubt)))
        rows.append(
            [
                words(", ".join([str(place), *(word for word, holds in doubts if holds)])),
                measured(float(point.mean_tension), NORMAL * state.standard_uncertainty, force),
                number(state.level.tension_amplitude, force),
                number(float(point.total_length), length),
                number(float(state.strain.max()), percent),
                number(state.secant_spring_constant, force),
                number(state.least_spring_constant, force),
                number(state.greatest_spring_constant, force),
                words(state.nearest),
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
            percent.label("tether strain"), force.label("EA"), force.label("least EA"),
            force.label("greatest EA"), "nearest test", force.label("maximum per tether"),
            "of its strength [%]", force.label("least by the tolerance"),
            force.label("greatest by the tolerance"),
        ),
        rows,
        remarks=[
            f"±: expanded uncertainty, 95 % ({factor_words([NORMAL])}), of the curve at that"
            " length. EA is that of the cycle, peak to valley, or without a cycle of 5 % of the"
            " length to each side. It is a mean over the tests that cover at least 70 % of it,"
            " over their common loads, weighted towards those nearest in mean and amplitude;"
            " least and greatest are the interval of these tests, 95 %. Loads by the tolerance of"
            " the lengths are at the mean tension."
        ],
    )  # fmt: skip


def _write_curve_page(
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
    section = TestSection(
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
            SummaryFinding(
                "warning" if any(word in note for word in _DOUBTS) else "note",
                (title,),
                f"{note[:1].upper()}{note[1:]}.",
            )
            for note in dict.fromkeys(notes)
        ],
        chapters=[section],
        synthetic=synthetic,
    )
    write_text_atomically(path, *render_page(page))


def _rounded_with_unit(value: float, unit: Shown) -> str:
    return f"{number_text(value * unit.factor)} {unit.unit}"
