"""Implements the command export."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from html import escape
from pathlib import Path
from typing import Any, Literal, cast

from reduction.archive.open import reading
from reduction.archive.workbook import sheets_of_tables, write_workbook
from reduction.campaign.toml_file import at_place
from reduction.cli.curves import deployed_line, is_of_pieces, piece_source, rule_of
from reduction.cli.output import CommandOutput
from reduction.cli.printed_numbers import plain
from reduction.lines.archive_source import (
    SURFACES,
    experiments_with_pulls,
    ropes_with_pulls,
)
from reduction.lines.client_runs import LIMITS, ClientCheck, in_words, verify_deck
from reduction.lines.composite import compose
from reduction.lines.deck_formats import FORMS, TABLES, closeness_of, export_line, export_table
from reduction.lines.deck_moordyn import fast_damping, segment_length
from reduction.lines.export_dynamics import Syrope, slow_and_waves
from reduction.lines.export_line import (
    CYLINDER,
    ExportLine,
    Hydrodynamics,
    beside_dashpot,
    curve_from_zero,
    doubts_first,
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
from reduction.lines.export_tables import ValueTable
from reduction.lines.line_search import names_with_words
from reduction.lines.published_source import published_sources
from reduction.lines.surface_table import printed_table, surface_table
from reduction.quantities.digits import plain_number
from reduction.quantities.units import Dimension, UnitSystem, parse_quantity
from reduction.record.errors import DataError, SettingsError

_HYDRODYNAMICS_NEEDED = 'two numbers, "1.6, 0.02": across the line, along it'


def _stated_hydrodynamics(
    drag: str | None, added_mass: str | None, source: str | None
) -> dict[str, Hydrodynamics]:
    """Stated coefficients that replace those of the assumed cylinder.

    Examples
    --------
    >>> _stated_hydrodynamics("1.6, 0.02", None, "a towing tank")["hydrodynamics"].axial_drag
    0.02
    """
    if drag is None and added_mass is None:
        if source is not None:
            raise SettingsError(
                "a source of coefficients is stated without coefficients",
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


def _of_option(
    name: str, text: str, dimension: Dimension, *, rated_break_strength: float | None = None
) -> float:
    """Value of an option in SI; errors name the option."""
    with at_place(f"--{name.replace('_', '-')}: "):
        return parse_quantity(text, dimension, rated_break_strength=rated_break_strength)


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
    """Add the working curves of a Syrope model to a line with dynamics."""
    if working_curve is None and greatest_mean_tension is None:
        return line
    if form != "syrope":
        raise SettingsError(
            "a working curve applies only to a Syrope line", found=f"--form {form}",
            needed="--form syrope",
        )  # fmt: skip
    if working_curve is None or greatest_mean_tension is None:
        raise SettingsError(
            "a Syrope line is only partly stated",
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
    if rated_break_strength is None and line.rated_break_strength > 0:
        rated_break_strength = line.rated_break_strength
    greatest = parse_quantity(
        greatest_mean_tension, "force", rated_break_strength=rated_break_strength
    )
    strain, tension, _ = curve_from_zero(line.strain, line.tension)
    # 30 %RBS is the end of many printed curves, apart from rounding in a product
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


@dataclass(frozen=True)
class ExportRequest:
    """Export request: format and the user's statements on the line, in words with units."""

    sources: tuple[str, ...]
    to: str
    out: Path
    form: str | None = None
    curve: str | None = None
    precedence: str | None = None
    specimen: str | None = None
    diameter: str | None = None
    linear_density: str | None = None
    wet_linear_density: str | None = None
    rated_break_strength: str | None = None
    drag: str | None = None
    added_mass: str | None = None
    hydrodynamics_source: str | None = None
    working_curve: str | None = None
    greatest_mean_tension: str | None = None
    frequency: str | None = None
    mean_tension: str | None = None
    tension_amplitude: str | None = None
    extrapolate: str = "refuse"
    verify: bool = False
    units: UnitSystem = "si"


@dataclass(frozen=True)
class ExportedFiles:
    """Exported files: of a line, of response-surface coefficients, or of all tables."""

    exported: ExportLine | ValueTable | str
    paths: tuple[Path, ...]
    notes: tuple[str, ...] = ()
    checks: tuple[ClientCheck, ...] = ()

    def plot(self, **options: Any) -> Any:
        """Draw the exported curve, like `xarray.DataArray.plot`; requires matplotlib.

        Raises
        ------
        SettingsError
            If a table of coefficients was exported, which has no curve.
        """
        if not isinstance(self.exported, ExportLine):
            raise SettingsError(
                "tables have no curve to plot", found=", ".join(map(str, self.paths)),
                needed="the export of a line",
            )  # fmt: skip
        import xarray as xr

        about = {"units": "N", "long_name": f"tension of {self.exported.name}"}
        strain = ("strain", self.exported.strain, {"units": "1"})
        curve = xr.DataArray(self.exported.tension, {"strain": strain}, "strain", attrs=about)
        return curve.plot(**options)

    def _repr_html_(self) -> str:
        """Show the written files and the notes on them in a notebook."""
        checks = (
            f"{one.program}: {one.quantity} at {one.at}: {one.found:.4g} {one.unit}, promised "
            f"{one.promised:.4g} {one.unit}"
            for one in self.checks
        )
        texts = [f"wrote {path}" for path in self.paths]
        texts += [f"note: {note}" for note in self.notes]
        rows = "".join(f"<li>{escape(text)}</li>" for text in (*texts, *checks))
        return f"<ul>{rows}</ul>"


def write_export(request: ExportRequest) -> ExportedFiles:
    """Write the curve of a source in a format, or the coefficients of response surfaces.

    Raises
    ------
    ReductionError
        If the source, format or level is unknown, or the source does not support the format.
    """
    if request.extrapolate not in ("refuse", "flag"):
        raise SettingsError(
            "--extrapolate is not known", found=repr(request.extrapolate), needed="refuse or flag"
        )
    if request.curve not in (None, "mean", "ascending", "descending"):
        raise SettingsError(
            "--curve is not known",
            found=repr(request.curve),
            needed="mean, ascending or descending",
        )
    to, out, form, sources = request.to, request.out, request.form, request.sources
    if not out.name:
        raise SettingsError("--out is not a file name", found=repr(str(out)), needed="a file")
    levels = {name: text for name in _LEVELS if (text := getattr(request, name)) is not None}
    tables = Path(sources[0]) / "tables"
    if to == "xlsx" and not levels and len(sources) == 1 and tables.is_dir():
        return _written_workbook(tables, request)
    surfaces = _surfaces_of(sources) if to in TABLES else None
    if surfaces == Path(sources[0]) and not levels:
        return _written_surfaces(surfaces, request)
    values: dict[str, Any] = {
        name: _of_option(name, text, dimension)
        for name, dimension in _DIMENSIONS.items()
        if (text := getattr(request, name)) is not None
    }
    water = _stated_hydrodynamics(request.drag, request.added_mass, request.hydrodynamics_source)
    line = _line_of(
        sources,
        cast("CurveName | None", request.curve),
        precedence=request.precedence,
        specimen=request.specimen,
        stated=values | water,
        levels=levels,
        extrapolate=cast('Literal["refuse", "flag"]', request.extrapolate),
    )
    line = _with_syrope(
        line,
        request.working_curve,
        request.greatest_mean_tension,
        form=form,
        rated_break_strength=_strength_of_shares(sources, values),
    )
    if form == "damped-table":
        line = beside_dashpot(line)
    paths = export_line(line, to, out, form=form, units=request.units)
    checks: list[ClientCheck] = []
    if request.verify:
        checks = verify_deck(line, to, form or next(iter(FORMS.get(to, ())), ""), paths)
        line = replace(line, notes=(*line.notes, *in_words(checks)))
        # the header contains the values returned by the program
        paths = export_line(line, to, out, form=form, units=request.units)
    doubts, notes = doubts_first(line.notes)
    about = (*_stiffness_said(request), *guards_of(line), *closeness_of(line, to, form))
    guards, others = doubts_first(about)
    return ExportedFiles(line, tuple(paths), (*doubts, *guards, *others, *notes), tuple(checks))


_DYNAMIC = ("static-dynamic", "load-dependent", "syrope", "library")

_FOR_WAVES = {
    "moordyn": "--form static-dynamic",
    "openfast": "--form static-dynamic",
    "moorpy": "--form library",
}


def _stiffness_said(request: ExportRequest) -> tuple[str, ...]:
    """Statement of which stiffness of a published rope is written, and which is not."""
    source = published_sources().get(request.sources[0]) if len(request.sources) == 1 else None
    if source is None:
        return ()
    strength = source.rated_break_strength
    levels = {
        name: _of_option(name, text, dimension, rated_break_strength=strength)
        for name, dimension in _LEVELS.items()
        if (text := getattr(request, name)) is not None
    }
    found = slow_and_waves(source, levels)
    if found is None:
        return ()
    rest, apparent, at = found
    slow = f"slow-pull stiffness K_0 {plain_number(rest / 1e3, 3)} kN"
    waves = f"for waves K_ap {plain_number(apparent / 1e3, 3)} kN ({at})"
    if request.to == "raft":
        return (f"written: {waves}; not in it: {slow}",)
    if request.form in _DYNAMIC:
        return (f"written: {slow}; {waves}",)
    also = _FOR_WAVES.get(request.to, "--to moordyn --form static-dynamic, or --to raft")
    return (f"written: {slow}; {waves}: {also}",)


def _written_surfaces(path: Path, request: ExportRequest) -> ExportedFiles:
    """Write the coefficients of response surfaces as a table."""
    to, form = request.to, request.form
    if form not in (None, "printed"):
        raise SettingsError(
            f"{to} of surfaces has no form '{form}'", found=form, needed="printed, or no --form"
        )
    if form == "printed":
        table = printed_table(path, specimen=request.specimen)
    else:
        units = "si" if to == "netcdf" else request.units
        table = surface_table(path, specimen=request.specimen, units=units)
    paths = export_table(table, to, request.out, units=request.units)
    return ExportedFiles(table, tuple(paths), tuple(table.notes))


def _written_workbook(tables: Path, request: ExportRequest) -> ExportedFiles:
    """Write the answer tables of a campaign as one workbook."""
    if request.form is not None or request.specimen is not None:
        raise SettingsError(
            "a workbook has all tables of a campaign, as they are",
            found=f"--form {request.form}" if request.form else f"--specimen {request.specimen}",
            needed="neither",
        )
    sheets = sheets_of_tables(tables)
    write_workbook(request.out, sheets)
    what = f"answer tables of {tables.parent.name}: {len(sheets) - 2} tables, SI"
    return ExportedFiles(what, (request.out,))


def export_source(request: ExportRequest, *, output: CommandOutput) -> None:
    """Write an export, and report what was written."""
    folder = request.out.parent
    there = set(folder.iterdir()) if folder.is_dir() else set()
    done = write_export(request)
    what = done.exported
    sources = () if isinstance(what, str) else what.sources
    if isinstance(what, ExportLine):
        output.say(f"{what.name}: {what.curve}")
    else:
        output.say(what.title if isinstance(what, ValueTable) else what)
    doubts, others = ([f"note: {note}" for note in some] for some in doubts_first(done.notes))
    for text in (*doubts, *sources, *others):
        output.say(f"  {text}")
    for path in done.paths:
        output.say(f"{'written over' if path in there else 'written'}: {path}")
    if not all(one.is_kept for one in done.checks):
        output.raise_status(DataError.exit_status)
    document: dict[str, Any] = {}
    if isinstance(what, ExportLine):
        document = _line_document(what, request, done)
    elif isinstance(what, ValueTable):
        document = {"title": what.title, "rows": int(what.columns[0].values.size)}
    else:
        document = {"title": what}
    output.answer(
        {
            "format": request.to,
            "files": [str(path) for path in done.paths],
            "sources": list(sources),
            "synthetic": None if isinstance(what, str) else what.is_synthetic,
            **document,
        }
    )


def _line_document(line: ExportLine, request: ExportRequest, done: ExportedFiles) -> dict[str, Any]:
    """Information on an exported line, for JSON."""
    return {
        "line": line.name,
        "form": request.form,
        "curve": line.curve,
        "tested": {"strain": plain(line.tested), "unit": "1"},
        "notes": list(done.notes),
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
            for one in done.checks
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
    """The line of SOURCE: published, from an archive, or a composite of tests."""
    surfaces = _surfaces_of(sources) if levels else None
    is_folder = len(sources) == 1 and Path(sources[0]).is_dir()
    if surfaces is not None or (levels and is_folder):
        chosen = {"--curve": curve, "--precedence": precedence}
        path = surfaces or Path(sources[0])
        return _of_levels(path, chosen, specimen, levels, extrapolate, stated)
    if is_of_pieces(sources) or _is_of_a_rise(sources):
        if levels:
            where = "several tests" if is_of_pieces(sources) else "an archive of one test"
            raise _levels_choose_nothing(levels, where)
        rule = rule_of(precedence)
        found = piece_source(sources, specimen=specimen, branch=curve)
        return line_from_composite(found, compose(found, rule), **stated)
    (source,) = sources
    if source.endswith(".toml"):
        chosen = {"--curve": curve, "--precedence": precedence, "--specimen": specimen}
        return _of_assembly(Path(source), chosen, levels, stated)
    if precedence is not None:
        raise SettingsError(
            f"{source} is a single curve, so precedence has no effect",
            found=f"--precedence {precedence}", needed="several tests, or no --precedence",
        )  # fmt: skip
    published = published_sources()
    if source in published:
        line = published[source]
        if curve == "mean" or specimen is not None:
            raise SettingsError(
                f"{source} is a single published line, and its report has no mean of the branches",
                found=f"--curve {curve}" if curve == "mean" else f"--specimen {specimen}",
                needed="--curve ascending or descending, or neither",
            )
        strength = _strength_of_shares(sources, stated)
        at = {
            name: _of_option(name, text, _LEVELS[name], rated_break_strength=strength)
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
    if not path.is_file() and path.suffix == ".nc":
        raise SettingsError(
            "there is no such archive", found=source,
            needed="the archive of a test that `reduction run` could reduce",
        )  # fmt: skip
    if not path.is_file():
        near = names_with_words(source, published)
        raise SettingsError(
            "unknown source to export",
            found=source,
            needed="archives of reduced tests or predicted hoses, processed/CAMPAIGN, or one of "
            + ", ".join(near or published),
        )
    if levels:
        raise _levels_choose_nothing(levels, "an archive of one test")
    return line_from_archive(path, curve=curve, specimen=specimen, **stated)


def _is_of_a_rise(sources: Sequence[str]) -> bool:
    """Whether SOURCE is one test without cycles: a slow pull, a first loading, weights."""
    if len(sources) > 1 or Path(sources[0]).suffix != ".nc" or not Path(sources[0]).is_file():
        return False
    with reading(Path(sources[0])) as archive:
        return "specimen" in archive and "branch_tension" not in archive


def _surfaces_of(sources: Sequence[str]) -> Path | None:
    """Archive of surfaces that SOURCE is, or that is in its campaign folder."""
    if len(sources) != 1:
        return None
    path = Path(sources[0])
    return next(
        (one for one in (path, path / SURFACES) if one.name == SURFACES and one.is_file()), None
    )


def _of_levels(
    path: Path,
    chosen: dict[str, str | None],
    specimen: str | None,
    levels: dict[str, str],
    extrapolate: Literal["refuse", "flag"],
    stated: dict[str, Any],
) -> ExportLine:
    """A rope of a campaign: K_ap and H from surfaces or levels, K_0 and curve from a slow pull."""
    given = [f"{name} {value}" for name, value in chosen.items() if value is not None]
    if given:
        raise SettingsError(
            "the curve used with levels is always that of the slow pull", found=", ".join(given),
            needed="levels without them",
        )  # fmt: skip
    _refuse_half_levels(str(path), levels)
    lines = experiments_with_pulls(path) if path.name == SURFACES else ropes_with_pulls(path)
    found = [one for one in lines if specimen in (None, one.name, one.name.split(" ")[-1])]
    if len(found) != 1:
        raise SettingsError(
            "several lines, none named" if found else f"there is no '{specimen}'",
            found=str(path),
            needed="--specimen with one of " + ", ".join(f'"{one.name}"' for one in lines),
        )
    (line,) = found
    if line.surfaces and set(line.factor_names) != set(_LEVELS):
        raise SettingsError(
            "static and dynamic stiffness at a mean tension need surfaces over tension",
            found=f"those of {line.name}, over {', '.join(line.factor_names)}",
            needed=", ".join(_LEVELS),
            hint="Export the archive of the run nearest to your cycle with --form damped-table: it"
            " has the K_ap and H of that run.",
        )
    strength = line.rated_break_strength
    strength = strength if math.isfinite(strength) else stated.get("rated_break_strength", math.nan)
    at = {
        name: _of_option(
            name,
            text,
            _LEVELS[name],
            rated_break_strength=strength if math.isfinite(strength) else None,
        )
        for name, text in levels.items()
    }
    return line_from_lookup(line, levels=at, extrapolate=extrapolate, **stated)


def _strength_of_shares(sources: Sequence[str], stated: dict[str, Any]) -> float | None:
    """Reference of %RBS: for a published line as in the look-up, else as stated."""
    line = published_sources().get(sources[0]) if len(sources) == 1 else None
    if line is not None and line.rated_break_strength > 0:
        return line.rated_break_strength
    return cast("float | None", stated.get("rated_break_strength"))


def _refuse_half_levels(source: str, levels: dict[str, str]) -> None:
    """Refuse a partial set of levels, since dynamics need all of them, or none."""
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
    """The line of an assembly from its specification."""
    given = [f"{name} {value}" for name, value in chosen.items() if value is not None]
    if given:
        raise SettingsError(
            "the curve of an assembly is set in its specification",
            found=", ".join(given), needed="[assembly.curve]",
        )  # fmt: skip
    if levels:
        raise _levels_choose_nothing(levels, "an assembly")
    return line_from_assembly(deployed_line(path), **stated)


def _levels_choose_nothing(levels: dict[str, str], where: str) -> SettingsError:
    return SettingsError(
        f"levels of a cycle have no effect for {where}",
        found=", ".join(f"--{name.replace('_', '-')}" for name in levels),
        needed="a published line, or a campaign with cycles of a rope and a slow pull",
    )
