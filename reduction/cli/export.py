"""The command export."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, Literal, cast

from reduction.cli.curves import deployed_line, is_of_pieces, piece_source, rule_of
from reduction.cli.output import CommandOutput
from reduction.cli.printed_numbers import plain
from reduction.lines.archive_source import SURFACES, experiments_with_pulls
from reduction.lines.client_runs import LIMITS, ClientCheck, in_words, verify_deck
from reduction.lines.composite import compose
from reduction.lines.deck_formats import FORMS, TABLES, closeness_of, export_line, export_table
from reduction.lines.deck_moordyn import fast_damping, segment_length
from reduction.lines.export_dynamics import Syrope
from reduction.lines.export_line import (
    CYLINDER,
    ExportLine,
    Hydrodynamics,
    curve_from_zero,
    guards_of,
    siblings_of,
)
from reduction.lines.export_sources import (
    CurveName,
    line_from_archive,
    line_from_assembly,
    line_from_composite,
    line_from_lookup,
)
from reduction.lines.published_source import published_sources
from reduction.lines.surface_table import surface_table
from reduction.quantities.units import Dimension, parse_quantity
from reduction.record.errors import DataError, SettingsError

_HYDRODYNAMICS_NEEDED = 'two numbers, "1.6, 0.02": across the line, along it'


def _stated_hydrodynamics(
    drag: str | None, added_mass: str | None, source: str | None
) -> dict[str, Hydrodynamics]:
    """Coefficients that stand in place of the assumed cylinder.

    Examples
    --------
    >>> _stated_hydrodynamics("1.6, 0.02", None, "a towing tank")["hydrodynamics"].axial_drag
    0.02
    """
    if drag is None and added_mass is None:
        if source is not None:
            raise SettingsError(
                "a source of coefficients without coefficients",
                found=f"--hydrodynamics-source {source}",
                needed="--drag or --added-mass with it",
            )
        return {}
    said = f"stated at the export, {source or 'without a source'}"
    found, words = CYLINDER, []
    if drag is not None:
        normal, axial = _pair("--drag", drag)
        found = replace(found, normal_drag=normal, axial_drag=axial)
    if added_mass is not None:
        normal, axial = _pair("--added-mass", added_mass)
        found = replace(found, normal_added_mass=normal, axial_added_mass=axial)
    for what, text in (("drag", drag), ("added mass", added_mass)):
        words.append(f"{what} {CYLINDER.source if text is None else said}")
    both = drag is not None and added_mass is not None
    return {"hydrodynamics": replace(found, source=said if both else "; ".join(words))}


def _pair(option: str, text: str) -> tuple[float, float]:
    parts = [part.strip() for part in text.split(",")]
    if len(parts) != 2:
        raise SettingsError(
            f"{option} is not a pair of coefficients",
            found=repr(text),
            needed=_HYDRODYNAMICS_NEEDED,
        )
    try:
        normal, axial = (parse_quantity(part, "number") for part in parts)
    except SettingsError as error:
        raise SettingsError(
            f"{option}: {error.problem}", found=error.found, needed=_HYDRODYNAMICS_NEEDED
        ) from error
    if normal < 0 or axial < 0:
        raise SettingsError(f"{option} is negative", found=repr(text), needed="zero or above")
    return normal, axial


_ROUNDING = 1e-9

_NEEDED = 'a form and its numbers: "LINEAR, 0.2", "QUADRATIC, 0.2, 0.5" or "EXP, 0.2, 1.5"'


def _with_syrope(
    line: ExportLine,
    working_curve: str | None,
    greatest_mean_tension: str | None,
    *,
    form: str | None,
    rated_break_strength: float | None = None,
) -> ExportLine:
    """Give a line with dynamics the working curves of a Syrope model."""
    if working_curve is None and greatest_mean_tension is None:
        return line
    if form != "syrope":
        raise SettingsError(
            "a working curve is of a Syrope line alone", found=f"--form {form}",
            needed="--form syrope",
        )  # fmt: skip
    if working_curve is None or greatest_mean_tension is None:
        raise SettingsError(
            "half a Syrope line is stated",
            found="--working-curve" if working_curve else "--greatest-mean-tension",
            needed="--working-curve and --greatest-mean-tension",
        )
    part = line.viscoelasticity
    if part is None:
        raise SettingsError(
            f"a Syrope line needs the dynamics of {line.name}",
            needed="a published line, or a campaign with an experiment and a slow pull, with "
            "--frequency, --mean-tension and --tension-amplitude",
        )
    shape, k1, k2 = _parts(working_curve)
    greatest = parse_quantity(
        greatest_mean_tension, "force", rated_break_strength=rated_break_strength
    )
    strain, tension, _ = curve_from_zero(line.strain, line.tension)
    # 30 %RBS is the end of many printed curves, but for the last digit of a product
    if math.isclose(greatest, tension[-1], rel_tol=_ROUNDING):
        greatest = float(tension[-1])
    syrope = Syrope(
        strain=strain,
        tension=tension,
        form=cast("Any", shape),
        k1=k1,
        k2=k2,
        dynamic_stiffness=part.dynamic_stiffness,
        dynamic_stiffness_per_mean_tension=part.dynamic_stiffness_per_mean_tension,
        slow_damping=part.slow_dashpot_coefficient,
        fast_damping=fast_damping(
            part.fast_stiffness, line.needed("linear_density"), segment_length(line)
        ),
        greatest_mean_tension=greatest,
        mean_tension=part.mean_tension,
    )
    return replace(
        line,
        syrope=syrope,
        sources=(
            *line.sources,
            f"Syrope: working curve {shape} {k1:g} {k2:g} and greatest mean tension "
            f"{syrope.greatest_mean_tension:.6g} N stated at the export; stiffness and slow "
            "dashpot are those of the three parameters, the fast dashpot is numerical",
        ),
    )


def _parts(text: str) -> tuple[str, float, float]:
    form, *numbers = (part.strip() for part in text.split(","))
    if not 1 <= len(numbers) <= 2:
        raise SettingsError("--working-curve is not understood", found=repr(text), needed=_NEEDED)
    try:
        k1, k2 = (parse_quantity(part, "number") for part in [*numbers, "0"][:2])
    except SettingsError as error:
        raise SettingsError(
            f"--working-curve: {error.problem}", found=error.found, needed=_NEEDED
        ) from error
    return form.upper(), k1, k2


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
    verify: bool,
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
    surfaces = _surfaces_of(sources) if to in TABLES else None
    if surfaces == Path(sources[0]) and not any(levels.values()):
        _export_surfaces(surfaces, to, out, specimen=specimen, form=form, output=output)
        return
    values: dict[str, Any] = {
        name: parse_quantity(text, _DIMENSIONS[name])
        for name, text in stated.items()
        if text is not None
    }
    line = _line_of(
        sources,
        cast("CurveName | None", curve),
        precedence=precedence,
        specimen=specimen,
        stated=values | _stated_hydrodynamics(*water),
        levels={name: text for name, text in levels.items() if text is not None},
        extrapolate=cast('Literal["refuse", "flag"]', extrapolate),
    )
    strength = _strength_of_shares(sources, values)
    line = _with_syrope(line, *syrope, form=form, rated_break_strength=strength)
    there = set(out.parent.iterdir()) if out.parent.is_dir() else set()
    paths = export_line(line, to, out, form=form, units=output.system)
    checks: list[ClientCheck] = []
    if verify:
        checks = verify_deck(line, to, form or next(iter(FORMS.get(to, ())), ""), paths)
        line = replace(line, notes=(*line.notes, *in_words(checks)))
        # the header carries what the program gave
        paths = export_line(line, to, out, form=form, units=output.system)
        if not all(one.is_kept for one in checks):
            output.raise_status(DataError.exit_status)
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
            "checks": [
                {
                    "program": one.program,
                    "quantity": one.quantity,
                    "at": one.at,
                    "promised": plain(one.promised),
                    "found": plain(one.found),
                    "unit": one.unit,
                    "error": plain(one.error),
                    "limit": LIMITS[one.quantity],
                    "kept": one.is_kept,
                }
                for one in checks
            ],
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


def _export_surfaces(
    path: Path,
    to: str,
    out: Path,
    *,
    specimen: str | None,
    form: str | None,
    output: CommandOutput,
) -> None:
    """Write the coefficients of response surfaces as a table."""
    if form is not None:
        raise SettingsError(f"{to} has no form '{form}'", found=form, needed=f"no --form with {to}")
    table = surface_table(path, specimen=specimen, units="si" if to == "netcdf" else output.system)
    was_there = out.exists()
    paths = export_table(table, to, out, units=output.system)
    output.say(table.title)
    for text in (*table.sources, *(f"note: {note}" for note in table.notes)):
        output.say(f"  {text}")
    output.say(f"{'written over' if was_there else 'written'}: {out}")
    output.answer(
        {
            "title": table.title,
            "format": to,
            "rows": int(table.columns[0].values.size),
            "files": [str(one) for one in paths],
            "sources": list(table.sources),
            "synthetic": table.is_synthetic,
        }
    )


def _line_of(
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
    surfaces = _surfaces_of(sources) if levels else None
    if surfaces is not None:
        chosen = {"--curve": curve, "--precedence": precedence}
        return _of_experiment(surfaces, chosen, specimen, levels, extrapolate, stated)
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


def _surfaces_of(sources: Sequence[str]) -> Path | None:
    """Archive of surfaces that SOURCE is, or that lies in the folder of its campaign."""
    if len(sources) != 1:
        return None
    path = Path(sources[0])
    return next(
        (one for one in (path, path / SURFACES) if one.name == SURFACES and one.is_file()), None
    )


def _of_experiment(
    path: Path,
    chosen: dict[str, str | None],
    specimen: str | None,
    levels: dict[str, str],
    extrapolate: Literal["refuse", "flag"],
    stated: dict[str, Any],
) -> ExportLine:
    """The line of an experiment: K_ap and H of its surfaces, K_0 and the curve of its slow pull."""
    given = [f"{name} {value}" for name, value in chosen.items() if value is not None]
    if given:
        raise SettingsError(
            "the curve of an experiment is that of its slow pull", found=", ".join(given),
            needed="levels without them",
        )  # fmt: skip
    _refuse_half_levels(str(path), levels)
    lines = experiments_with_pulls(path)
    found = [one for one in lines if specimen in (None, one.name, one.name.split(" ")[-1])]
    if len(found) != 1:
        raise SettingsError(
            "which experiment is meant is not said" if found else f"there is no '{specimen}'",
            found=str(path),
            needed="--specimen with one of " + ", ".join(f'"{one.name}"' for one in lines),
        )
    (line,) = found
    strength = line.rated_break_strength
    strength = strength if math.isfinite(strength) else stated.get("rated_break_strength", math.nan)
    at = {
        name: parse_quantity(
            text,
            _LEVELS[name],
            rated_break_strength=strength if math.isfinite(strength) else None,
        )
        for name, text in levels.items()
    }
    return line_from_lookup(line, levels=at, extrapolate=extrapolate, **stated)


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
        needed="a published line, or a campaign with an experiment and a slow pull",
    )
