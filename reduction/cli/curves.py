"""Implements the commands composite and assembly."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, cast

import numpy as np
import xarray as xr

from reduction.archive.open import failing_reads, open_archive
from reduction.archive.product_files import archives_of_tests, earlier_run_words
from reduction.campaign.assembly_spec import AssemblyCase, load_assembly_case
from reduction.campaign.toml_file import at_place, in_toml
from reduction.cli.output import CommandOutput
from reduction.cli.printed_numbers import plain, short, table_of
from reduction.lines.archive_pieces import source_of_tests, specimens_of
from reduction.lines.assembly import DeployedLine, WorkingState, deploy, stated_model
from reduction.lines.composite import (
    LEAST_SLOPE,
    TAPER,
    CompositeCurve,
    CompositeRule,
    PieceBranch,
    PieceKind,
    PieceSource,
    compose,
    used_of,
)
from reduction.lines.cycle_stiffness import LEAST_COVER
from reduction.lines.deck_formats import export_table
from reduction.lines.export_sources import assembly_table, composite_table, ranges_of
from reduction.lines.published_source import published_piece_sources, published_sources
from reduction.quantities.digits import fixed_number, places_of
from reduction.record.contributions import Component, coverage_factor
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Floats
from reduction.report.single_pages import write_assembly_page, write_composite_page
from reduction.stages.strain.strain_model import StrainModel


def is_of_pieces(sources: Sequence[str]) -> bool:
    """Whether SOURCE is several tests: archives, a folder, a published tether."""
    return (
        len(sources) > 1
        or any(Path(one).is_dir() for one in sources)
        or any(one in published_piece_sources() for one in sources)
    )


def rule_of(precedence: str | None) -> CompositeRule:
    """The rule, from comma-separated kinds."""
    if precedence is None:
        return CompositeRule()
    kinds = tuple(cast("PieceKind", part.strip()) for part in precedence.split(","))
    with at_place("--precedence: "):
        return CompositeRule(precedence=kinds)


def piece_source(
    sources: Sequence[str], *, specimen: str | None = None, branch: PieceBranch | None = None
) -> PieceSource:
    """Pieces of SOURCE."""
    published = published_piece_sources()
    if any(one in published for one in sources):
        return _published(sources, specimen, branch)
    paths = [path for one in sources for path in _archives(one)]
    named = {Path(one) for one in sources}
    with failing_reads(" or ".join(map(str, paths))), ExitStack() as opened:
        datasets = [opened.enter_context(open_archive(path)) for path in paths]
        name = _specimen(datasets, sources, specimen)
        for path, one in zip(paths, datasets, strict=True):
            # a folder may contain other specimens; a named archive was intended
            if path in named and name not in specimens_of(one):
                raise SettingsError(
                    f"{path} has no specimen '{name}'",
                    found=", ".join(specimens_of(one)) or "no archive of a test",
                    needed="tests of one specimen",
                )
        made = source_of_tests(datasets, name, branch=branch or "mean")
        failed = [
            f"DOUBTFUL: {text}"
            for path, one in zip(paths, datasets, strict=True) if name in specimens_of(one)
            for text in earlier_run_words(path)
        ]  # fmt: skip
        return replace(made, notes=(*failed, *made.notes))


def _published(
    sources: Sequence[str], specimen: str | None, branch: PieceBranch | None
) -> PieceSource:
    if len(sources) > 1:
        raise SettingsError(
            "a published tether cannot be combined with other sources",
            found=", ".join(sources),
            needed="one SOURCE",
        )
    found = published_piece_sources()[sources[0]]
    if specimen is not None:
        raise SettingsError(
            f"{found.name} is one tether", found=f"specimen {specimen}", needed="no specimen"
        )
    if branch not in (None, found.branch):
        raise SettingsError(
            f"{found.name} has only its {found.branch} branch",
            found=str(branch),
            needed=found.branch,
        )
    return found


def _archives(source: str) -> list[Path]:
    path = Path(source)
    if path.is_file():
        return [path]
    if path.is_dir():
        found = archives_of_tests(path)
        if found:
            return found
        raise SettingsError(
            f"{path} contains no archive of a test",
            needed="processed/CAMPAIGN after `reduction run`",
        )
    tethers = published_piece_sources()
    if source in published_sources():
        near = [name for name in tethers if source.startswith(f"{name}-")]
        raise SettingsError(
            f"{source} is a single published curve, not a set of pieces",
            needed=", ".join(near or tethers),
            hint="`reduction export` and `reduction lookup` accept it as it is.",
        )
    raise SettingsError(
        f"unknown source '{source}'",
        needed="archives, a folder of a processed campaign, or one of " + ", ".join(tethers),
    )


def _specimen(datasets: Sequence[xr.Dataset], sources: Sequence[str], specimen: str | None) -> str:
    names = list(dict.fromkeys(name for one in datasets for name in specimens_of(one)))
    where = ", ".join(sources)
    if not names:
        raise SettingsError(f"{where}: no archive of a test", needed="archives of reduced tests")
    if specimen is None and len(names) > 1:
        raise SettingsError(
            f"{where}: several specimens", found=", ".join(names), needed="one specimen",
            hint="Name one with --specimen, or in the specification.",
        )  # fmt: skip
    if specimen is not None and specimen not in names:
        raise SettingsError(f"{where}: there is no specimen '{specimen}'", needed=", ".join(names))
    return specimen or names[0]


_ROWS = 24

_SHOWN = 1e-3
"""Share of the tension above which a row is reported as moved."""

PAGE = "page"

_FORMATS = {
    ".csv": "csv", ".json": "json", ".nc": "netcdf", ".md": "markdown", ".tex": "latex",
    ".html": PAGE,
}  # fmt: skip


def _table_format(path: Path) -> str:
    """Format of a table, or `PAGE`, from the suffix of its file."""
    if path.suffix.lower() not in _FORMATS:
        raise SettingsError(
            "unknown file format", found=path.name,
            needed="a name that ends in " + ", ".join(_FORMATS),
        )  # fmt: skip
    return _FORMATS[path.suffix.lower()]


def compose_tests(
    sources: Sequence[str],
    *,
    specimen: str | None,
    branch: PieceBranch | None,
    precedence: str | None,
    out: Path | None,
    output: CommandOutput,
) -> None:
    """Print the composite curve of SOURCE; if ``out``, write all its nodes."""
    form = None if out is None else _table_format(out)
    rule = rule_of(precedence)
    source = piece_source(sources, specimen=specimen, branch=branch)
    curve = compose(source, rule)
    source = used_of(source, curve)
    _show(source, curve, output)
    if out is not None and form is not None:
        if form == PAGE:
            write_composite_page(source, curve, out, units=output.system)
        else:
            export_table(composite_table(source, curve), form, out, units=output.system)
        output.say(f"written: {out}")
    output.answer(_document(source, curve, rule) | {"out": None if out is None else str(out)})


def _show(source: PieceSource, curve: CompositeCurve, output: CommandOutput) -> None:
    unit, factor = output.unit("N")
    made = ", SYNTHETIC: nothing was tested" if source.is_synthetic else ""
    doubt = f"; DOUBTFUL: {curve.doubt}" if curve.doubt else ""
    output.say(f"{composite_table(source, curve).title}{made}{doubt}")
    doubts, others = _doubts_first((*curve.notes, *source.notes))
    output.say_each("note", doubts)
    _end_in_doubt(curve, output)
    table = table_of(
        "strain [%]", f"tension [{unit}]", f"standard uncertainty [{unit}]",
        f"shared part [{unit}]", "piece", "remark",
        texts=0,
    )  # fmt: skip
    ends = np.flatnonzero(np.diff(curve.is_gap)) + 1
    some = np.linspace(0, curve.strain.size - 1, _ROWS).round().astype(int)
    is_moved = np.abs(np.nan_to_num(curve.monotone_change)) > _SHOWN * curve.tension
    shared = factor * curve.shared_standard_uncertainty
    for place in np.union1d(ends, some):
        flags = [
            word
            for word, of in (
                ("gap", curve.is_gap), ("join", curve.is_join),
            )
            if place and of[place - 1]
        ]  # fmt: skip
        change = factor * float(curve.monotone_change[place])
        if is_moved[place]:
            flags.append(f"moved {change:+.3g} to keep the curve rising")
        table.add_row(
            short(100 * float(curve.strain[place]), 4),
            _within(
                *(factor * float(one[place]) for one in (curve.tension, curve.standard_uncertainty))
            ),
            short(factor * float(curve.standard_uncertainty[place]), 3),
            short(float(shared[place]), 3),
            curve.piece_words[curve.piece[place]] if curve.piece[place] >= 0 else "-",
            ", ".join(flags),
        )
    output.show(table)
    output.say_each("note", others)
    output.say_each("source", source.sources)


def _doubts_first(notes: Sequence[str]) -> tuple[list[str], list[str]]:
    """Notes that doubt a test, which stand above the table, and the others."""
    doubts = [one for one in notes if one.startswith("DOUBTFUL: ")]
    return doubts, [one for one in notes if one not in doubts]


def _end_in_doubt(curve: CompositeCurve, output: CommandOutput) -> None:
    """Set status 4 if a curve is doubtful inside its stated range."""
    if curve.doubt:
        output.raise_status(DataError.exit_status)


def _contributions(component: Sequence[Component], rows: Floats) -> list[dict[str, Any]]:
    """Signed contribution of each shared error to a curve, for ``--json``."""
    return [
        {"source": one.source, "of": one.of, "number": one.number, "contribution": plain(row)}
        for one, row in zip(component, rows, strict=True)
    ]


def _document(source: PieceSource, curve: CompositeCurve, rule: CompositeRule) -> dict[str, Any]:
    """Output of ``--json`` in SI."""
    return {
        "name": source.name,
        "branch": source.branch,
        "rule": {
            "precedence": list(rule.precedence),
            "taper": TAPER,
            "least_slope": LEAST_SLOPE,
        },
        "strain": plain(curve.strain),
        "tension": plain(curve.tension),
        "tension_standard_uncertainty": plain(curve.standard_uncertainty),
        "tension_random_standard_uncertainty": plain(curve.random_standard_uncertainty),
        "tension_shared_standard_uncertainty": plain(curve.shared_standard_uncertainty),
        "tension_uncertainty_contributions": _contributions(curve.component, curve.contribution),
        "piece": [curve.piece_words[one] if one >= 0 else None for one in curve.piece],
        "units": {
            "strain": "1", "tension": "N", "tension_standard_uncertainty": "N",
            "tension_random_standard_uncertainty": "N",
            "tension_shared_standard_uncertainty": "N", "tension_uncertainty_contributions": "N",
            "joins": "1", "gaps": "1", "moved": "1", "monotone_change": "N",
            "between_pieces": "1",
        },
        "pieces": [
            {
                "name": one.name,
                "kind": one.kind,
                "branch": one.branch,
                "strain": [float(one.strain[0]), float(one.strain[-1])],
                "used": one.kind in rule.precedence,
            }
            for one in source.pieces
        ],
        "joins": [list(one) for one in ranges_of(curve, curve.is_join)],
        "gaps": [list(one) for one in ranges_of(curve, curve.is_gap)],
        "moved": [list(one) for one in ranges_of(curve, curve.is_moved)],
        "monotone_change": plain(curve.monotone_change),
        "between_pieces": plain(curve.between_pieces),
        "doubt": curve.doubt,
        "sources": list(source.sources),
        "notes": [*curve.notes, *source.notes],
        "synthetic": source.is_synthetic,
    }  # fmt: skip


def _assembly_document(line: DeployedLine) -> dict[str, Any]:
    """Output of ``--json`` in SI."""
    deployed, assembly = line.deployed, line.deployed.assembly
    return {
        "name": line.name,
        "n_tethers": assembly.n_tethers,
        "free_length": plain(np.array(deployed.free_length)),
        "slack_length": plain(assembly.slack_length),
        "total_length": plain(assembly.total_length),
        "tension": plain(assembly.tension),
        "tension_standard_uncertainty": plain(assembly.standard_uncertainty),
        "tension_random_standard_uncertainty": plain(assembly.random_standard_uncertainty),
        "tension_shared_standard_uncertainty": plain(assembly.shared_standard_uncertainty),
        "tension_uncertainty_contributions": _contributions(
            assembly.component, assembly.contribution
        ),
        "strain": plain(deployed.strain),
        "secant_spring_constant": plain(deployed.stiffness.spring_constant),
        "least_spring_constant": plain(deployed.stiffness.least),
        "greatest_spring_constant": plain(deployed.stiffness.greatest),
        "nearest_test": [name or None for name in deployed.nearest_test],
        "tether_length": plain(assembly.tether_length),
        "tether_tension": plain(assembly.tether_tension),
        "tether_strain": plain(assembly.tether_strain),
        "is_tested": plain(assembly.is_tested),
        "is_join": plain(assembly.is_join),
        "is_moved": plain(assembly.is_moved),
        "units": {
            **dict.fromkeys(
                ("free_length", "slack_length", "total_length", "tether_length", "peak_length",
                 "minimum_length"), "m",
            ),
            **dict.fromkeys(
                ("tension", "tension_standard_uncertainty", "tension_random_standard_uncertainty",
                 "tension_shared_standard_uncertainty", "tension_uncertainty_contributions",
                 "apparent_spring_constant", "secant_spring_constant", "least_spring_constant",
                 "greatest_spring_constant", "curve_spring_constant", "spring_constant",
                 "standard_uncertainty", "low", "high", "common_low", "common_high",
                 "tether_tension", "mean_tension", "peak_tension", "minimum_tension",
                 "peak_tether_tension", "minimum_tether_tension", "greatest_load", "least_load",
                 "tension_at_slack"), "N",
            ),
            **dict.fromkeys(
                ("strain", "tether_strain", "load_share", "peak_share", "minimum_share", "covered"),
                "1",
            ),
            "stiffness": "N m-1",
        },
        "working": [_state_document(state) for state in deployed.working],
        "doubts": list(line.doubts),
        "sources": [line.splices, *line.source.sources],
        "notes": list(line.notes),
        "synthetic": line.source.is_synthetic,
    }  # fmt: skip


def _state_document(state: WorkingState) -> dict[str, Any]:
    names = (
        "mean_tension", "peak_tension", "minimum_tension", "total_length", "tether_tension",
        "peak_tether_tension", "minimum_tether_tension", "load_share", "peak_share",
        "minimum_share", "is_tested",
    )  # fmt: skip
    sharing = None if state.sharing is None else {
        name: plain(getattr(state.sharing, name))
        for name in ("greatest_load", "least_load", "tension_at_slack")
    }  # fmt: skip
    return {
        "given": state.level.quantity,
        **{name: plain(getattr(state.point, name)) for name in names},
        "tension_standard_uncertainty": state.standard_uncertainty,
        "tension_random_standard_uncertainty": state.random_standard_uncertainty,
        "tension_shared_standard_uncertainty": state.shared_standard_uncertainty,
        **{
            name: plain(getattr(state, name))
            for name in (
                "low",
                "high",
                "secant_spring_constant",
                "least_spring_constant",
                "greatest_spring_constant",
                "stiffness",
                "peak_length",
                "minimum_length",
                "common_low",
                "common_high",
                "curve_spring_constant",
            )
        },
        "apparent_spring_constant": plain(state.secant_spring_constant),
        "nearest_test": state.nearest or None,
        "tests": [
            {name: plain(value) for name, value in asdict(one).items()} for one in state.tests
        ],
        "doubt": state.doubt,
        "note": state.note,
        "tether_strain": plain(state.strain),
        "sharing": sharing,
    }


_ASSEMBLY_ROWS = 16

_LARGER = 1.1
"""Ratio of amplitudes above which a test is one of larger cycles than the one asked for. [1]"""

_KNOWN = float(coverage_factor(np.inf))
"""Coverage factor for a curve of many tests, without degrees of freedom. [1]"""


def assemble_spec(path: Path, *, out: Path | None, output: CommandOutput) -> None:
    """Print curve and work of the assembly of SPEC.toml; if ``out``, write all nodes."""
    form = None if out is None else _table_format(out)
    line = deployed_line(path)
    _show_assembly(line, output)
    if out is not None and form is not None:
        if form == PAGE:
            write_assembly_page(line, out, units=output.system)
        else:
            export_table(assembly_table(line), form, out, units=output.system)
        output.say(f"written: {out}")
    output.answer(_assembly_document(line) | {"out": None if out is None else str(out)})


def deployed_line(path: Path) -> DeployedLine:
    """Read SPEC.toml, find its curve and its splices, and deploy the assembly."""
    case = load_assembly_case(path)
    source = _source(path, case)
    with at_place(f"{path}: assembly.curve: "):
        curve = compose(source, case.rule)
    model = _model(path, case, source)
    stated = case.rated_break_strength
    strength = stated if np.isfinite(stated) else source.rated_break_strength
    try:
        deployed = deploy(
            curve,
            model,
            n_tethers=case.n_tethers,
            free_lengths=case.free_lengths,
            parts=case.parts,
            levels=case.working,
            tolerance=case.tolerance,
            rated_break_strength=strength,
            has_stated_splices=case.splices is not None,
            loops=source.loops if "cyclic" in case.rule.precedence else (),
        )
    except DataError as error:
        # a level already includes its own place
        between = "." if error.problem.startswith("working.") else ": "
        raise DataError(
            f"{path}: assembly{between}{error.problem}", found=error.found, needed=error.needed,
            hint=error.hint,
        ) from error  # fmt: skip
    return DeployedLine(
        name=case.name,
        deployed=deployed,
        source=used_of(source, curve),
        curve=curve,
        splices=_splices_in_words(case, model),
        parts=case.parts,
    )


def _source(path: Path, case: AssemblyCase) -> PieceSource:
    """Pieces of the tethers; paths are relative to the specification."""
    published = published_piece_sources()
    words = [word if word in published else str(path.parent / word) for word in case.sources]
    with at_place(f"{path}: assembly.curve: "):
        return piece_source(words, specimen=case.specimen, branch=case.branch)


def _model(path: Path, case: AssemblyCase, source: PieceSource) -> StrainModel:
    """Length model of a tether: as stated, else as tested."""
    if case.splices is None:
        if source.model is None or source.model.method == "extensometer":
            raise in_toml(
                path, f"assembly.splices: the tests of {source.name} do not give the splices",
                found="no strain method with a length" if source.model is None
                else "strain of an extensometer",
                needed="[assembly.splices], with length = \"0 m\" where there are none",
            )  # fmt: skip
        return source.model
    tested = float("nan") if source.model is None else source.model.relaxed_length
    length = case.free_lengths[0] if case.free_lengths else tested
    if not np.isfinite(length):
        raise in_toml(
            path, f"assembly.free_length: the tests of {source.name} do not give it",
            needed="free_length, or free_lengths",
        )  # fmt: skip
    return stated_model(case.splices, length, name=source.name)


def _within(value: float, standard_uncertainty: float) -> str:
    """Return a number to the place of the third digit of its standard uncertainty.

    Examples
    --------
    >>> _within(44.1012, 18.2), _within(7.9e-6, 13.6), _within(0.0, 0.0)
    ('44.1', '0.0', '0')
    """
    if not 0 < standard_uncertainty < np.inf:
        return short(value)
    return fixed_number(value, places_of(standard_uncertainty, 3), mark="")


def _splices_in_words(case: AssemblyCase, model: StrainModel) -> str:
    where = "stated" if case.splices is not None else f"as tested ({model.marks_from})"
    numbers = ", ".join(
        f"{name.replace('_', ' ')} {value:.4g}" for name, value in model.coefficients.items()
    )
    return f"length of a tether by {model.method}, {where}: {numbers}"


def _show_assembly(line: DeployedLine, output: CommandOutput) -> None:
    deployed, assembly = line.deployed, line.deployed.assembly
    force, per_newton = output.unit("N")
    length, per_metre = output.unit("m")
    made = ", SYNTHETIC: nothing was tested" if line.source.is_synthetic else ""
    output.say(f"assembly {line.name}: {line.words}{made}")
    output.say_each("DOUBTFUL", line.doubts)
    doubts, others = _doubts_first(line.notes)
    output.say_each("note", doubts)
    if line.doubts:
        output.raise_status(DataError.exit_status)
    slack = assembly.slack_length
    output.say(
        f"slack below {per_metre * float(assembly.total_length[0]):.5g} {length}"
        + (
            f"; the longest tether below {per_metre * float(slack.max()):.5g} {length}"
            if slack.max() > slack.min()
            else ""
        )
    )
    equal = line.is_equal
    table = table_of(
        f"length [{length}]", f"tension [{force}]", f"standard uncertainty [{force}]",
        f"shared part [{force}]",
        f"EA, +- {100 * assembly.span_share:.2g} % [{force}]",
        f"least [{force}]", f"greatest [{force}]",
        f"load per tether [{force}]" if equal else f"greatest, least [{force}]",
        "tether strain [%]" if equal else "strains [%]", "remark", texts=0,
    )  # fmt: skip
    tension = assembly.tension
    shared = per_newton * assembly.shared_standard_uncertainty
    rows = np.searchsorted(tension, np.linspace(0.0, tension[-1], _ASSEMBLY_ROWS))
    for place in np.unique(np.clip(rows, 0, tension.size - 1)):
        load, strain = assembly.tether_tension[:, place], assembly.tether_strain[:, place]
        table.add_row(
            short(per_metre * float(assembly.total_length[place])),
            _within(
                *(
                    per_newton * float(one[place])
                    for one in (tension, assembly.standard_uncertainty)
                )
            ),
            short(per_newton * float(assembly.standard_uncertainty[place]), 3),
            short(float(shared[place]), 3),
            *(
                short(per_newton * float(one[place]), 4)
                for one in (
                    deployed.stiffness.spring_constant,
                    deployed.stiffness.least,
                    deployed.stiffness.greatest,
                )
            ),
            _pair(per_newton * load, equal=equal),
            _pair(100 * strain, equal=equal),
            ", ".join(
                word
                for word, flag in (
                    ("not tested", not assembly.is_tested[place]),
                    ("join", assembly.is_join[place]),
                    ("moved", assembly.is_moved[place]),
                )
                if flag
            ),
        )
    output.show(table)
    for number, state in enumerate(deployed.working, start=1):
        _show_working(number, state, assembly.span_share, output)
    output.say_each("note", others)
    output.say_each("source", (line.splices, *line.source.sources))


def _pair(values: Any, *, equal: bool) -> str:
    """One number if the tethers are equal, otherwise the maximum and minimum."""
    if equal:
        return short(float(values[0]), 4)
    return f"{short(float(values.max()), 4)}, {short(float(values.min()), 4)}"


def _stiffness_in_words(state: WorkingState, share: float, output: CommandOutput) -> str:
    """EA over the cycle with its interval, and the tests used for it."""
    force, per_newton = output.unit("N")
    around = f"+- {100 * share:.2g} % of the length"
    span = "the cycle" if state.level.tension_amplitude else around
    used = state.used
    if not used:
        return f"no EA: no test covers {100 * LEAST_COVER:.0f} % of {span}"
    tests = ", ".join(f"{one.words} {per_newton * one.spring_constant:.4g}" for one in used)
    nearest = f", of which {state.nearest} is nearest in mean and amplitude" if used[1:] else ""
    own = next(one for one in used if one.words == state.nearest)
    amplitude = (own.high - own.low) / 2
    if own.has_loop and amplitude > _LARGER * (state.high - state.low) / 2:
        nearest += (
            f"; {own.words} have an amplitude of {per_newton * amplitude:.4g} {force}: the interval"
            " includes what its loop leaves open about a smaller cycle"
        )
    return (
        f"EA {per_newton * state.secant_spring_constant:.4g} {force} over {span},"
        f" {per_newton * state.least_spring_constant:.4g} to"
        f" {per_newton * state.greatest_spring_constant:.4g} from the tests that cover it ({tests},"
        f" each from {per_newton * state.common_low:.4g} to {per_newton * state.common_high:.4g}"
        f" {force}{nearest})"
    )


def _show_working(number: int, state: WorkingState, share: float, output: CommandOutput) -> None:
    force, per_newton = output.unit("N")
    length, per_metre = output.unit("m")
    point = state.point
    told = (
        f"working.{number}: {per_newton * float(point.mean_tension):.4g} {force} "
        f"+- {per_newton * _KNOWN * state.standard_uncertainty:.3g} (95 %, k = {_KNOWN:.2f}) at "
        f"{per_metre * float(point.total_length):.5g} {length}, tether strain "
        f"{100 * float(state.strain.max()):.4g} %, {_stiffness_in_words(state, share, output)}"
    )
    if state.level.tension_amplitude:
        told += f"; cycles {per_newton * state.low:.4g} to {per_newton * state.high:.4g} {force}"
        if np.isfinite(state.secant_spring_constant):
            told += (
                f", {per_metre * state.minimum_length:.5g} to {per_metre * state.peak_length:.5g}"
                f" {length}"
            )
    share = float(point.peak_share.max())
    told += (
        f"; maximum load per tether {per_newton * float(point.peak_tether_tension.max()):.4g} "
        f"{force}"
    ) + (f", {100 * share:.3g} % of its strength" if np.isfinite(share) else "")
    if state.sharing is not None:
        told += (
            f"; by the tolerance of the lengths {per_newton * float(state.sharing.least_load):.4g}"
            f" to {per_newton * float(state.sharing.greatest_load):.4g} {force} at the mean"
        )
    output.say(told + ("" if point.is_tested else "; NOT TESTED there"))
