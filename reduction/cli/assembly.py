"""The command assembly: tethers as they are deployed, from a specification."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import numpy as np

from reduction.campaign.assemblyspec import AssemblyCase, load_assembly_case
from reduction.campaign.faults import in_toml
from reduction.cli.assemblydocument import assembly_document
from reduction.cli.commandoutput import CommandOutput
from reduction.cli.composite import PAGE, table_format
from reduction.cli.compositesource import piece_source
from reduction.cli.numbers import short, table_of
from reduction.errors import DataError, ReductionError
from reduction.export.fromassembly import assembly_table
from reduction.export.write import export_table
from reduction.lookup.source import PieceSource, compose, used_of
from reduction.lookup.splices import stated_model
from reduction.pipeline.deployed import DeployedLine, WorkingState, deploy
from reduction.published.piecesource import published_piece_sources
from reduction.report.curvepage import write_assembly_page
from reduction.strain.model import StrainModel
from reduction.uncertainty.combine import coverage_factor
from reduction.units import UnitSystem, display_unit

_ROWS = 16
_KNOWN = float(coverage_factor(np.inf))
"""Coverage factor of a curve of many tests, whose degrees of freedom are not counted. [1]"""


def assemble_spec(path: Path, *, out: Path | None, output: CommandOutput) -> None:
    """Print curve and work of the assembly of SPEC.toml; with ``out``, write every node."""
    form = None if out is None else table_format(out)
    line = deployed_line(path)
    units = cast("UnitSystem", output.units)
    _show(line, output, units)
    if out is not None and form is not None:
        if form == PAGE:
            write_assembly_page(line, out, units=units)
        else:
            export_table(assembly_table(line), form, out, units=units)
        output.say(f"written: {out}")
    output.answer(assembly_document(line) | {"out": None if out is None else str(out)})


def deployed_line(path: Path) -> DeployedLine:
    """Read SPEC.toml, find its curve and its splices, and deploy it.

    Raises
    ------
    SettingsError
        If a key, a value or a source cannot be used.
    DataError
        If the assembly cannot be, or a level of its work is none.
    ArchiveError
        If an archive cannot be read.
    """
    case = load_assembly_case(path)
    source = _source(path, case)
    try:
        curve = compose(source, case.rule)
    except DataError as error:
        raise _at(path, "assembly.curve", error) from error
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
        )
    except DataError as error:
        # a level brings its own place
        raise _at(path, "assembly", error) from error
    return DeployedLine(
        name=case.name,
        deployed=deployed,
        source=used_of(source, curve),
        curve=curve,
        splices=_splices_told(case, model),
        parts=case.parts,
    )


def _at(path: Path, place: str, error: ReductionError) -> ReductionError:
    """The same error with file and key in front."""
    between = "." if error.problem.startswith("working.") else ": "
    return type(error)(
        f"{path}: {place}{between}{error.problem}", found=error.found, needed=error.needed,
        hint=error.hint,
    )  # fmt: skip


def _source(path: Path, case: AssemblyCase) -> PieceSource:
    """Pieces of the tethers; archives and folders stand beside the specification."""
    published = published_piece_sources()
    words = [word if word in published else str(path.parent / word) for word in case.sources]
    try:
        return piece_source(words, specimen=case.specimen, branch=case.branch)
    except ReductionError as error:
        raise _at(path, "assembly.curve", error) from error


def _model(path: Path, case: AssemblyCase, source: PieceSource) -> StrainModel:
    """How the length of a tether follows: as stated, else as tested."""
    if case.splices is None:
        if source.model is None or source.model.method == "extensometer":
            raise in_toml(
                path, f"assembly.splices: the tests of {source.name} do not know the splices",
                found="no strain method with a length" if source.model is None
                else "strain of an extensometer",
                needed="[assembly.splices], with length = \"0 m\" where there are none",
            )  # fmt: skip
        return source.model
    tested = float("nan") if source.model is None else source.model.relaxed_length
    length = case.free_lengths[0] if case.free_lengths else tested
    if not np.isfinite(length):
        raise in_toml(
            path, f"assembly.free_length: the tests of {source.name} do not know it",
            needed="free_length, or free_lengths",
        )  # fmt: skip
    return stated_model(case.splices, length, name=source.name)


def _splices_told(case: AssemblyCase, model: StrainModel) -> str:
    where = "stated" if case.splices is not None else f"as tested ({model.marks_from})"
    numbers = ", ".join(
        f"{name.replace('_', ' ')} {value:.4g}" for name, value in model.coefficients.items()
    )
    return f"length of a tether by {model.method}, {where}: {numbers}"


def _show(line: DeployedLine, output: CommandOutput, system: UnitSystem) -> None:
    deployed, assembly = line.deployed, line.deployed.assembly
    force, per_newton = display_unit("N", system)
    length, per_metre = display_unit("m", system)
    made = ", SYNTHETIC: nothing was tested" if line.source.is_synthetic else ""
    output.say(f"assembly {line.name}: {line.words}{made}")
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
        f"of it shared [{force}]",
        f"EA, +- 5 % [{force}]", f"EA, local [{force}]",
        f"a tether [{force}]" if equal else f"greatest, least [{force}]",
        "its strain [%]" if equal else "strains [%]", "remark", texts=0,
    )  # fmt: skip
    tension = assembly.tension
    shared = per_newton * assembly.shared_standard_uncertainty
    rows = np.searchsorted(tension, np.linspace(0.0, tension[-1], _ROWS))
    for place in np.unique(np.clip(rows, 0, tension.size - 1)):
        load, strain = assembly.tether_tension[:, place], assembly.tether_strain[:, place]
        table.add_row(
            short(per_metre * float(assembly.total_length[place])),
            short(per_newton * float(tension[place])),
            short(per_newton * float(assembly.standard_uncertainty[place]), 3),
            short(float(shared[place]), 3),
            short(per_newton * float(deployed.secant_spring_constant[place]), 4),
            short(per_newton * float(deployed.apparent_spring_constant[place]), 4),
            _pair(per_newton * load, equal=equal),
            _pair(100 * strain, equal=equal),
            ", ".join(
                word
                for word, flag in (
                    ("not tested", not assembly.is_tested[place]),
                    ("join", assembly.is_join[place]),
                    ("moved: local EA is the rule's", assembly.is_moved[place]),
                )
                if flag
            ),
        )
    output.show(table)
    for number, state in enumerate(deployed.working, start=1):
        _show_working(number, state, output, system)
    for text in (*deployed.notes, *line.curve.notes, *line.source.notes):
        output.say(f"note: {text}")
    for text in (line.splices, *line.source.sources):
        output.say(f"source: {text}")


def _pair(values: Any, *, equal: bool) -> str:
    """One number where the tethers are alike, the greatest and the least where they are not."""
    if equal:
        return short(float(values[0]), 4)
    return f"{short(float(values.max()), 4)}, {short(float(values.min()), 4)}"


def _show_working(
    number: int, state: WorkingState, output: CommandOutput, system: UnitSystem
) -> None:
    force, per_newton = display_unit("N", system)
    length, per_metre = display_unit("m", system)
    point = state.point
    told = (
        f"working.{number}: {per_newton * float(point.mean_tension):.4g} {force} "
        f"+- {per_newton * _KNOWN * state.standard_uncertainty:.3g} (95 %, k = {_KNOWN:.2f}) at "
        f"{per_metre * float(point.total_length):.5g} {length}, strain of a tether "
        f"{100 * float(state.strain.max()):.4g} %, EA "
        f"{per_newton * state.secant_spring_constant:.4g} {force} over "
    )
    if not state.level.tension_amplitude:
        rule = " by the rule of rising, DOUBTFUL" if state.is_moved else ""
        told += (
            f"+- 5 % of the length, locally "
            f"{per_newton * float(point.apparent_spring_constant):.4g} {force}{rule}"
        )
    else:
        told += (
            "the cycle"
            f"; cycles {per_newton * float(point.minimum_tension):.4g} to "
            f"{per_newton * float(point.peak_tension):.4g} {force}, "
            f"{per_metre * float(point.minimum_length):.5g} to "
            f"{per_metre * float(point.peak_length):.5g} {length}"
        )
    share = float(point.peak_share.max())
    told += (
        f"; a tether carries up to {per_newton * float(point.peak_tether_tension.max()):.4g} "
        f"{force}"
    ) + (f", {100 * share:.3g} % of its strength" if np.isfinite(share) else "")
    if state.sharing is not None:
        told += (
            f"; by the tolerance of the lengths "
            f"{per_newton * float(state.sharing.least_load):.4g} to "
            f"{per_newton * float(state.sharing.greatest_load):.4g} {force} at the mean"
        )
    output.say(told + ("" if point.is_tested else "; NOT TESTED there"))
