"""Pages of one prediction, composite or assembly, with their figures."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from reduction.archive.atomic_write import write_text_atomically
from reduction.lines.assembly import DeployedLine
from reduction.lines.composite import CompositeCurve, PieceSource
from reduction.prediction.armour import ARMOUR_QUANTITIES, SIMPLER_THEORIES, PredictedArmour
from reduction.prediction.wave_load import (
    CODE_OF_HYDROLOGY,
    PUBLISHED_COEFFICIENTS,
    PredictedWaveLoad,
)
from reduction.quantities.digits import plain_number
from reduction.quantities.units import UnitSystem, display_unit
from reduction.record.measurement import Bools, Floats
from reduction.record.notes import Note
from reduction.report.campaign_summary import SummaryFinding, Tile
from reduction.report.figure_data import Figure, Trace, axis, band, line, make_figure, plain_numbers
from reduction.report.figures.theory_figures import (
    THEORY_NAMES,
    THEORY_WORDS,
    draw_errors,
    draw_section,
    draw_surface,
    draw_wave_load,
    draw_wire,
    force_per_length,
    moment_unit,
    of_layers,
)
from reduction.report.page_template import Page, about_page, render_page
from reduction.report.sheet import Calculated, Sheet
from reduction.report.test_section import Part, TestSection, make_part
from reduction.report.test_view import NORMAL, factor_words
from reduction.report.text_style import (
    COLOURS,
    DEGREES,
    PERCENT,
    SYMBOLS,
    PageTable,
    Shown,
    TableCell,
    colour,
    make_table,
    measured,
    number,
    number_text,
    shown,
    span,
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
    """Draw EA against tension: of each test, of the curve, and the stated value of each cycle."""
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
    """Tensions along a curve, and EA over a twentieth of its load range to each side. [N]."""
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
    notes: Sequence[Note | str],
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
            SummaryFinding(
                one.severity if isinstance(one, Note) else "warning", (title,),
                f"{str(one)[:1].upper()}{str(one)[1:]}.",
            )
            for one in notes
        ],
        chapters=[section],
        answers=[] if answer is None else [answer],
    )  # fmt: skip
    path = out / "index.html"
    write_text_atomically(path, *render_page(page))
    return path


def _title(kind: str, name: str) -> str:
    """Kind and name of a case; a name that repeats the kind is left out."""
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
        notes=[*([f"DOUBTFUL: {curve.doubt}"] if curve.doubt else []), *curve.notes, *source.notes],
        sources=source.sources,
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
    """Table of the working points; None where none was requested."""
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
            " length. EA is that of the cycle, peak to valley, or without a cycle of"
            f" {100 * found.deployed.assembly.span_share:.2g} % of the length to each side. It is a"
            " mean over the tests that cover at least 70 % of it, over their common loads, weighted"
            " towards those nearest in mean and amplitude; least and greatest are the interval of"
            " these tests, 95 %. Loads by the tolerance of the lengths are at the mean tension."
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


def wires_table(found: PredictedArmour, units: UnitSystem) -> PageTable | None:
    """Return forces, moments and stresses of one wire of each layer by each theory."""
    pairs = [
        (place, theory, response)
        for place in range(len(found.layer_names))
        for theory, response in found.responses.items()
    ]
    sheet = Sheet(Calculated(units)).texts(
        "layer, theory", [f"{found.layer_names[place]}, {THEORY_WORDS[theory]}"
                          for place, theory, _ in pairs]
    )  # fmt: skip
    for name in ("axial_force", "shear_force", "bending_moment", "torsion_moment", "axial_stress",
                 "bending_stress", "torsion_stress"):  # fmt: skip
        words_, kind = name.replace("_", " "), name.partition("_")[2]
        unit = {"force": shown("tension", units), "moment": moment_unit(units)}.get(kind, "stress")
        values = [getattr(response, name)[place, 0] for place, _, response in pairs]
        sheet.numbers(words_, values, unit)  # type: ignore[arg-type]
    return sheet.table(
        f"One wire of each layer by each theory, at {100 * float(found.strain[0]):g} % of strain of"
        " the cable.",
        is_compact=True,
        remarks=[
            "Exact: the exact helix with the report's moments; small and intermediate angles are"
            " approximations. With an energy: the rod whose tension is the derivative of its"
            " strain energy, used for layers and cable. Large angles: a spring without a core, a"
            " different body.",
            "No uncertainty is given: none is stated for the armour. None includes thinning of the"
            " wires or compliance of the core.",
        ],
    )  # fmt: skip


def layers_table(found: PredictedArmour, units: UnitSystem) -> PageTable | None:
    """Return load and pressure of each layer, and whether its wires have room."""
    limit, together = found.layers.yield_stress, found.together
    yields = np.where(together.is_yielding[:, 0], "yes", "no")
    return (
        Sheet(Calculated(units))
        .texts("layer", found.layer_names)
        .numbers("tension", together.layer_tension[:, 0], "tension")
        .numbers("torque", together.layer_torque[:, 0], moment_unit(units))
        .numbers("pressure of the layer", together.layer_pressure[:, 0], "stress")
        .numbers("pressure with all outside", together.core_pressure[:, 0], "stress")
        .numbers("von Mises stress", together.wire_stress[:, 0], "stress")
        .numbers("yield stress", limit, "stress")
        .texts("yields", np.where(np.isfinite(limit), yields, ""))
        .numbers("gap between wires", found.gap, "small length", 3)
        .numbers("lost by thinning", found.thinning_loss, PERCENT, 2)
        .table(
            f"Layers at {100 * float(found.strain[0]):g} % of strain of the cable, innermost"
            " first.",
            is_compact=True,
            remarks=["Torque: positive for right-handed wires. The cable is held against rotation;"
                     " its core is rigid; friction between layers is neglected. Lost by thinning:"
                     " the amount by which strain and tension are too high, since a thinning wire"
                     " moves towards the core."],
        )
    )  # fmt: skip


def cable_table(found: PredictedArmour, units: UnitSystem) -> PageTable:
    """Return tension, torque, stiffness and first yield of all layers together."""
    force, together = shown("tension", units), found.together
    held, free = found.axial_stiffness
    sheet = Sheet(Calculated(units))

    def add(name: str, value: float) -> None:
        sheet.numbers(name, [value], with_prefix(force, value))

    add("tension", float(together.tension[0]))
    sheet.numbers("torque", together.torque, moment_unit(units))
    left_over = "net torque over the sum of the layers' magnitudes"
    sheet.numbers(left_over, together.torque_imbalance, PERCENT, 3)
    add("axial stiffness, held against rotation", held)
    add("axial stiffness, free to rotate", free)
    if found.strength is None:
        about = "First yield not given: not every layer has a yield stress."
    else:
        sheet.numbers("strain at first yield", [found.strength.strain], PERCENT)
        add("tension at first yield", found.strength.tension)
        about = f"Layer {found.layer_names[found.strength.governing_layer]} yields first."
    return sheet.turned(
        "The cable.", ("value",), "number",
        remarks=["Stiffness: force per unit strain of the cable, at rest.", about],
    )  # fmt: skip


def use_table(found: PredictedArmour) -> PageTable | None:
    """Return the angles between which each theory is within the tolerance, layer by layer."""
    pairs = [
        (f"{layer}, {THEORY_WORDS[theory]}", use.least_angle[i], use.greatest_angle[i])
        for layer, use in zip(found.layer_names, found.use, strict=True)
        for i, theory in enumerate(SIMPLER_THEORIES)
    ]
    sheet = Sheet(Calculated("si")).texts("layer, theory", [name for name, *_ in pairs])
    for k, name in enumerate(ARMOUR_QUANTITIES):
        sheet.cells(
            DEGREES.label(name.replace("_", " ")),
            [_angles(float(low[k]), float(high[k])) for _, low, high in pairs],
        )
    return sheet.table(
        f"Winding angles at which each theory is within {100 * found.tolerance:g} % of the exact"
        " rod.",
        remarks=["From 5 to 85 degrees in steps of 0.5; the longest of several ranges."],
    )


def _angles(low: float, high: float) -> TableCell:
    if not np.isfinite(low):
        return TableCell("nowhere", is_number=True)
    return number(low, DEGREES, digits=3) if low == high else span(low, high, DEGREES, places=1)


def armour_design_table(found: PredictedArmour, units: UnitSystem) -> PageTable | None:
    """Return the input data of each layer."""
    return (
        Sheet(Calculated(units))
        .texts("layer", found.layer_names)
        .numbers("winding angle", of_layers(found, "winding_angle"), DEGREES)
        .numbers("wire radius", of_layers(found, "wire_radius"), "small length")
        .numbers("core radius", of_layers(found, "core_radius"), "small length")
        .numbers("elastic modulus", of_layers(found, "elastic_modulus"), "stress")
        .numbers("poisson ratio", of_layers(found, "poisson_ratio"), "number")
        .counts("wires", of_layers(found, "n_wires"))
        .texts("lay", found.layers.lay)
        .table("Layers as given, innermost first.")
    )


def extremes_table(found: PredictedWaveLoad, units: UnitSystem) -> PageTable | None:
    """Return greatest and least load of both forms, and the reduction of the improved one."""
    unit = force_per_length(units)
    pairs = [(one, end) for one in ("horizontal", "vertical") for end in ("maximum", "minimum")]
    sheet = Sheet(Calculated(units)).texts("load", [", ".join(pair) for pair in pairs])
    for heading, form in (("improved", ""), ("classic", "_classic")):
        own = [(getattr(found.extremes, f"{one}{form}"), end) for one, end in pairs]
        sheet.numbers(heading, [getattr(load, end) for load, end in own], unit)
        times = [getattr(load, f"time_of_{end}") for load, end in own]
        sheet.numbers("at", times, "time", 3)
    less = [getattr(found.difference, f"{one}_of_{end}") for one, end in pairs]
    return sheet.numbers("reduction from classic", less, PERCENT).table(
        "Extremes of the load over a period, by optimisation between the plotted times.",
        remarks=[
            "Classic: Morison's equation on the whole section. Improved: on the part under water"
            " in still water. Each has its own times of extremes.",
            "No uncertainty is given: none is stated for wave, hose or coefficients; that of the"
            " coefficients alone is tens of percent.",
        ],
    )


def wave_table(found: PredictedWaveLoad, units: UnitSystem) -> PageTable:
    """Return the properties of the wave, and its distance from the limits of its theory."""
    theory = found.theory
    return (
        Sheet(Calculated(units))
        .numbers("height", [theory.steepness * theory.wave_length], "length")
        .numbers("period", [2 * np.pi / found.wave.angular_frequency], "time")
        .numbers("length", [theory.wave_length], "length")
        .numbers("depth of the water", [theory.relative_depth * theory.wave_length], "length")
        .numbers("current along the wave", [found.current_velocity], _velocity(units))
        .numbers("depth over length", [theory.relative_depth], "number")
        .numbers("height over length", [theory.steepness], "number")
        .numbers("height over breaking height", [theory.breaking_ratio], "number")
        .numbers("Ursell number", [theory.ursell_number], "number")
        .numbers(
            "second harmonic of the surface over the first", [theory.elevation_ratio], "number"
        )
        .numbers(
            "second harmonic of the velocity over the first", [theory.velocity_ratio], "number"
        )
        .numbers(
            "given length over that of the period, minus one", [theory.length_mismatch], PERCENT
        )
        .turned(
            "The wave.", ("value",), "number",
            remarks=[
                f"Computed by the theory of {_named(found.used)}. By relative depth, as the paper"
                f" reads its table: {_named(theory.theory)}; by the letter of the table:"
                f" {_named(theory.printed)}.",
            ],
        )
    )  # fmt: skip


def regime_table(found: PredictedWaveLoad, units: UnitSystem) -> PageTable:
    """Return the immersion of the hose, and the numbers by which coefficients are chosen."""
    section, regime = found.load.section, found.regime
    return (
        Sheet(Calculated(units))
        .numbers("outer diameter", [section.outer_diameter], "small length")
        .numbers("immersion depth", [section.immersion_depth], "small length")
        .numbers("share of the section under water", [section.submerged_share], PERCENT)
        .numbers("section under water", [section.submerged_section_area], "area")
        .numbers("level of the flow", [found.elevation], "small length")
        .numbers("maximum velocity of the water", [regime.greatest_velocity], _velocity(units))
        .numbers("Keulegan-Carpenter number", [regime.keulegan_carpenter_number], "number")
        .numbers("Reynolds number", [regime.reynolds_number], "number")
        .numbers("maximum drag over maximum inertia", [regime.drag_to_inertia], "number")
        .numbers("diameter over wave length", [regime.diameter_to_length], "number")
        .turned(
            "The hose in the water, and the flow past it.", ("value",), "number",
            remarks=["Velocity with the current, at the level of the load. Morison's equation holds"
                     " up to a diameter of 0.2 wave lengths."],
        )
    )  # fmt: skip


def anchor_table(found: PredictedWaveLoad, units: UnitSystem) -> PageTable:
    """Return the greatest horizontal force of wind, wave and current, as a sum and as one flow."""
    length, speed, anchor = shown("length", units), _velocity(units), found.anchor
    return (
        Sheet(Calculated(units))
        .numbers("wind alone", [anchor.wind], "tension")
        .numbers("current alone", [anchor.current], "tension")
        .numbers("wave alone, maximum", [anchor.wave], "tension")
        .numbers("sum of the three", [anchor.separate], "tension")
        .numbers("wave and current as one flow, with the wind", [anchor.combined], "tension")
        .numbers("combined minus sum, over combined", [anchor.difference], PERCENT)
        .turned(
            f"Horizontal force on {length.factor * found.hose_length:.4g} {length.unit} of hose,"
            " the anchor force.",
            ("value",), "force",
            remarks=[
                f"Wind {speed.factor * found.wind_velocity:.4g} {speed.unit} at the hose, current"
                f" {speed.factor * found.current_velocity:.4g} {speed.unit}. Drag varies with the"
                " square of the velocity: velocities add, loads do not. The whole length is at one"
                " phase: it lies along the crest.",
            ],
        )
    )  # fmt: skip


def wave_coefficient_table(found: PredictedWaveLoad) -> PageTable | None:
    """Return published coefficients, with those of this case and its flow regime."""
    regime, published = found.regime, (*PUBLISHED_COEFFICIENTS, CODE_OF_HYDROLOGY)
    at = f"KC {float(regime.keulegan_carpenter_number):.3g}"
    at += f", Re {plain_number(float(regime.reynolds_number), 3)}"
    return (
        Sheet(Calculated("si"))
        .texts("source", [one.source for one in published])
        .texts("wave theory", [one.wave_theory for one in published])
        .cells("drag", [_pair(*one.drag_coefficient) for one in published])
        .numbers("inertia", [one.inertia_coefficient for one in published], "number", 3)
        .texts("comment of the source", [one.comment for one in published])
        .row(
            words("this case"), words(_named(found.used)),
            number(found.drag_coefficient, digits=3), number(found.inertia_coefficient, digits=3),
            words(at),
        )
        .table(
            "Coefficients of drag and inertia as published, and of this case.",
            remarks=["None is for a floating cylinder, and none states its range of KC and Re."
                     " Inertia: one plus the added mass."],
        )
    )  # fmt: skip


def _named(theory: str) -> str:
    return THEORY_NAMES.get(theory, theory)


def _velocity(units: UnitSystem) -> Shown:
    unit, factor = display_unit("m s-1", units)
    return Shown({"m s-1": "m/s", "ft s-1": "ft/s"}.get(unit, unit), factor)


def _pair(low: float, high: float) -> TableCell:
    text = f"{low:g}" if low == high else f"{low:g} to {high:g}"
    return TableCell(text, f"{low!r} {high!r}", is_number=True)
