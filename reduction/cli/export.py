"""The command export: a curve in the words of another program."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, Literal, cast

from reduction.cli.assembly import deployed_line
from reduction.cli.commandoutput import CommandOutput
from reduction.cli.compositesource import is_of_pieces, piece_source, rule_of
from reduction.cli.hydrodynamics import stated_hydrodynamics
from reduction.cli.numbers import plain
from reduction.cli.syrope import with_syrope
from reduction.errors import SettingsError
from reduction.export.closeness import closeness_of
from reduction.export.fromarchive import CurveName, line_from_archive
from reduction.export.fromassembly import line_from_assembly
from reduction.export.fromcomposite import line_from_composite
from reduction.export.fromlookup import line_from_lookup
from reduction.export.guards import guards_of
from reduction.export.product import ExportLine
from reduction.export.start import siblings_of
from reduction.export.write import export_line
from reduction.lookup.source import compose
from reduction.published.linesource import published_sources
from reduction.units import Dimension, UnitSystem, parse_quantity

_DIMENSIONS: dict[str, Dimension] = {
    "diameter": "length",
    "linear_density": "linear_density",
    "wet_linear_density": "linear_density",
    "rated_break_strength": "force",
}
_LEVELS: dict[str, Dimension] = {
    "frequency": "frequency",
    "mean_tension": "force",
    "tension_amplitude": "force",
}


def export_source(
    sources: Sequence[str],
    *,
    to: str,
    out: Path,
    form: str | None,
    curve: str | None,
    precedence: str | None,
    specimen: str | None,
    stated: dict[str, str | None],
    water: tuple[str | None, str | None, str | None],
    syrope: tuple[str | None, str | None],
    levels: dict[str, str | None],
    extrapolate: str,
    output: CommandOutput,
) -> None:
    """Write the curve of a source in a format, and say what was written."""
    if extrapolate not in ("refuse", "flag"):
        raise SettingsError(
            "--extrapolate is not known", found=repr(extrapolate), needed="refuse or flag"
        )
    if curve not in (None, "mean", "ascending", "descending"):
        raise SettingsError(
            "--curve is not known", found=repr(curve), needed="mean, ascending or descending"
        )
    if not out.name:
        raise SettingsError("--out names no file", found=repr(str(out)), needed="a file")
    values: dict[str, Any] = {
        name: parse_quantity(text, _DIMENSIONS[name])
        for name, text in stated.items()
        if text is not None
    }
    line = line_of(
        sources,
        cast("CurveName | None", curve),
        precedence=precedence,
        specimen=specimen,
        stated=values | stated_hydrodynamics(*water),
        levels={name: text for name, text in levels.items() if text is not None},
        extrapolate=cast('Literal["refuse", "flag"]', extrapolate),
    )
    strength = _strength_of_shares(sources, values)
    line = with_syrope(line, *syrope, form=form, rated_break_strength=strength)
    units = cast("UnitSystem", output.units)
    there = set(out.parent.iterdir()) if out.parent.is_dir() else set()
    paths = export_line(line, to, out, form=form, units=units)
    notes = (*guards_of(line), *closeness_of(line, to, form), *line.notes)
    output.say(f"{line.name}: {line.curve}")
    for text in (*line.sources, *(f"note: {note}" for note in notes)):
        output.say(f"  {text}")
    for path in paths:
        output.say(f"{'written over' if path in there else 'written'}: {path}")
    output.answer(
        {
            "line": line.name,
            "format": to,
            "form": form,
            "curve": line.curve,
            "tested": {"strain": plain(line.tested), "unit": "1"},
            "files": [str(path) for path in paths],
            "sources": list(line.sources),
            "notes": list(notes),
            "synthetic": line.is_synthetic,
            "hydrodynamics": asdict(line.hydrodynamics),
            **{
                name: {"value": plain(getattr(line, name)), "unit": unit}
                for name, unit in (
                    ("diameter", "m"),
                    ("linear_density", "kg m-1"),
                    ("rated_break_strength", "N"),
                )
            },
        }
    )


def line_of(
    sources: Sequence[str],
    curve: CurveName | None,
    *,
    precedence: str | None,
    specimen: str | None,
    stated: dict[str, Any],
    levels: dict[str, str],
    extrapolate: Literal["refuse", "flag"],
) -> ExportLine:
    """The line that SOURCE means: a published one, that of an archive, or a composite of tests."""
    if is_of_pieces(sources):
        if levels:
            raise _levels_choose_nothing(levels, "several tests")
        rule = rule_of(precedence)
        found = piece_source(sources, specimen=specimen, branch=curve)
        return line_from_composite(found, compose(found, rule), **stated)
    (source,) = sources
    if source.endswith(".toml"):
        chosen = {"--curve": curve, "--precedence": precedence, "--specimen": specimen}
        return _of_assembly(Path(source), chosen, levels, stated)
    if precedence is not None:
        raise SettingsError(
            f"{source} is one curve: there are no pieces that could go before others",
            found=f"--precedence {precedence}", needed="several tests, or no --precedence",
        )  # fmt: skip
    published = published_sources()
    if source in published:
        line = published[source]
        if curve == "mean" or specimen is not None:
            raise SettingsError(
                f"{source} is one published line, and its report has no mean of the branches",
                found=f"--curve {curve}" if curve == "mean" else f"--specimen {specimen}",
                needed="--curve ascending or descending, or neither",
            )
        strength = _strength_of_shares(sources, stated)
        at = {
            name: parse_quantity(text, _LEVELS[name], rated_break_strength=strength)
            for name, text in levels.items()
        }
        _refuse_half_levels(source, levels)
        made = line_from_lookup(
            line,
            branch=curve,
            siblings=siblings_of(line, tuple(published.values())),
            levels=at or None,
            extrapolate=extrapolate,
            **stated,
        )
        if strength is None or not any("%" in text for text in levels.values()):
            return made
        whose = "the source" if line.rated_break_strength > 0 else "the export"
        said = f"levels in percent of the break strength: of {strength:.6g} N, that of {whose}"
        return replace(made, sources=(*made.sources, said))
    path = Path(source)
    if not path.is_file():
        words = source.lower().replace("-", " ").split()
        near = [name for name in published if all(word in name for word in words)]
        raise SettingsError(
            "there is nothing of that name to export",
            found=source,
            needed="archives of reduced tests or predicted hoses, processed/CAMPAIGN, or one of "
            + ", ".join(near or published),
        )
    if levels:
        raise _levels_choose_nothing(levels, "an archive of one test")
    return line_from_archive(path, curve=curve, specimen=specimen, **stated)


def _strength_of_shares(sources: Sequence[str], stated: dict[str, Any]) -> float | None:
    """What %RBS is a share of: of a published line what it is at the look-up, else as stated."""
    line = published_sources().get(sources[0]) if len(sources) == 1 else None
    if line is not None and line.rated_break_strength > 0:
        return line.rated_break_strength
    return cast("float | None", stated.get("rated_break_strength"))


def _refuse_half_levels(source: str, levels: dict[str, str]) -> None:
    """Dynamics are at a point: all of its levels are needed, or none."""
    missing = [f"--{name.replace('_', '-')}" for name in _LEVELS if name not in levels]
    if levels and missing:
        raise SettingsError(
            f"static and dynamic stiffness of {source} need all levels of a cycle",
            found=", ".join(f"--{name.replace('_', '-')}" for name in levels),
            needed=" and ".join(missing) + " too",
        )


def _of_assembly(
    path: Path, chosen: dict[str, str | None], levels: dict[str, str], stated: dict[str, Any]
) -> ExportLine:
    """The line of an assembly, whose specification says the rest."""
    given = [f"{name} {value}" for name, value in chosen.items() if value is not None]
    if given:
        raise SettingsError(
            "the specification of an assembly says of which curve it is",
            found=", ".join(given), needed="[assembly.curve]",
        )  # fmt: skip
    if levels:
        raise _levels_choose_nothing(levels, "an assembly")
    return line_from_assembly(deployed_line(path), **stated)


def _levels_choose_nothing(levels: dict[str, str], where: str) -> SettingsError:
    return SettingsError(
        f"levels of a cycle choose nothing in {where}",
        found=", ".join(f"--{name.replace('_', '-')}" for name in levels),
        needed="a published line",
    )
