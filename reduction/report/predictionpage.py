"""Pages of predictions that no campaign holds: a wave load, an armour."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from reduction.archive.write import write_whole
from reduction.pipeline.armour import PredictedArmour
from reduction.pipeline.waveload import PredictedWaveLoad
from reduction.report.figures.armour import draw_errors, draw_wire
from reduction.report.figures.waves import (
    draw_section,
    draw_surface,
    draw_wave_load,
    force_per_length,
)
from reduction.report.htmltable import Table, number_text
from reduction.report.predictiontables import (
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
from reduction.report.render import Page, about_page, render_page
from reduction.report.section import Part, Section, make_part
from reduction.report.style import Shown, shown, with_prefix
from reduction.report.summary import Finding, Tile
from reduction.units import UnitSystem

_OF_WAVE = (
    "A regular wave on a hose that lies along its crest and follows the surface; the water moves as"
    " if the hose were not there. S. Zhang et al., Open Petroleum Eng. J., vol. 8, 2015."
)
_OF_ARMOUR = (
    "Round elastic wires on a rigid core, stretched with their cable. H. Wang et al., J. Mar. Sci."
    " Eng., vol. 10, 642, 2022."
)


def write_wave_page(
    found: PredictedWaveLoad, out: Path, *, name: str, units: UnitSystem = "si"
) -> Path:
    """Write the page of a wave load.

    Parameters
    ----------
    found : PredictedWaveLoad
        The prediction.
    out : pathlib.Path
        Folder of the page; made where it is not there.
    name : str
        Of the case.
    units : UnitSystem
        What a reader is shown.

    Returns
    -------
    page : pathlib.Path
        ``out/index.html``; it appears whole or not at all.

    Raises
    ------
    ArchiveError
        If the disk refuses.
    """
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
    return _write(
        out, _title("Wave load", name), "load", parts, answer=extremes_table(found, units),
        tiles=tiles, notes=found.notes, units=units, about=_OF_WAVE,
    )  # fmt: skip


def write_armour_page(
    found: PredictedArmour, out: Path, *, name: str, units: UnitSystem = "si"
) -> Path:
    """Write the page of an armour.

    Parameters
    ----------
    found : PredictedArmour
        The prediction.
    out : pathlib.Path
        Folder of the page; made where it is not there.
    name : str
        Of the case.
    units : UnitSystem
        What a reader is shown.

    Returns
    -------
    page : pathlib.Path
        ``out/index.html``; it appears whole or not at all.

    Raises
    ------
    ArchiveError
        If the disk refuses.
    """
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
    return _write(
        out, _title("Armour", name), "armour", parts, answer=layers_table(found, units),
        tiles=tiles, notes=found.notes, units=units, about=_OF_ARMOUR,
    )  # fmt: skip


def _write(
    out: Path,
    title: str,
    key: str,
    parts: Sequence[Part],
    *,
    answer: Table | None,
    tiles: Sequence[Tile],
    notes: Sequence[str],
    units: UnitSystem,
    about: str,
) -> Path:
    section = Section(
        key=key, title=title, subtitle="Predicted: nothing of it was measured.",
        parts=tuple(parts), notes=(), provenance=(),
    )  # fmt: skip
    page = Page(
        title=title,
        campaign=title,
        summary="",
        about=about_page(
            units, "the numbers of its SPEC.toml alone", in_si="Notes are in SI.",
            definitions=[about],
        ),
        tiles=tiles,
        faults=[Finding("warning", (title,), f"{note[:1].upper()}{note[1:]}.") for note in notes],
        chapters=[section],
        answers=[] if answer is None else [answer],
    )  # fmt: skip
    path = out / "index.html"
    write_whole(path, render_page(page))
    return path


def _title(kind: str, name: str) -> str:
    """Kind and name of a case; a name that says the kind again is left out."""
    return kind if name.lower() in kind.lower() else f"{kind} {name}"


def _with_unit(value: float, unit: Shown) -> str:
    found = with_prefix(unit, value)
    return f"{number_text(value * found.factor)} {found.unit}"
