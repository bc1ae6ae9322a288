"""Experiments in campaign.toml and SPEC.toml, and tables of runs."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Annotated, Literal, NoReturn

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from reduction.campaign.model import ExperimentSection
from reduction.campaign.plan import ExperimentPlan, TestPlan, product_of
from reduction.campaign.toml_file import (
    at_place,
    in_toml,
    listed,
    not_utf8,
    read_small_text,
    read_toml,
    split_row,
    split_rows,
)
from reduction.campaign.unit_types import PositiveForce, ReadText
from reduction.experiments.designs import DesignKind, FactorLevels, LevelBasis
from reduction.experiments.response_transform import Transform
from reduction.experiments.run_sheet import RepeatPlacing
from reduction.quantities.names import QUANTITIES, quantity
from reduction.quantities.units import (
    Dimension,
    parse_quantity,
    scale_of_unit,
    scale_to_show,
)
from reduction.record.errors import DataError, LogError, SettingsError
from reduction.record.measurement import Floats, Specimen, read_only_arrays
from reduction.record.plain_text import cut
from reduction.stages.three_parameter_line.line_product import LINE_PARAMETERS

_CODED = "coded"
"""Marks, in place of a unit, a column of coded levels."""

"""Responses that need the quasi-static spring constant."""

_DIMENSIONS: dict[str, Dimension] = {
    "frequency": "frequency",
    "mean_tension": "force",
    "tension_amplitude": "force",
    "mean_strain": "strain",
    "strain_amplitude": "strain",
    "temperature": "temperature",
    "duration": "number",
    "diameter": "length",
}

_SHARE = re.compile(r"^\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*%\s*(RBS|MBS|MBL|of mean)\s*$")

_BASIS: dict[str, LevelBasis] = {
    "RBS": "rated_break_strength",
    "MBS": "rated_break_strength",
    "MBL": "rated_break_strength",
    "of mean": "mean_tension",
}

_DYNAMIC = ("cyclic", "fatigue", "snap")

_PULLS = ("quasi-static", "tensile")


def _parse_factor(name: str, levels: tuple[str, str]) -> FactorLevels:
    """Levels of a factor from text with units.

    Examples
    --------
    >>> _parse_factor("mean_tension", ("12 %RBS", "30 %RBS"))
    FactorLevels(name='mean_tension', low=0.12, high=0.3, basis='rated_break_strength')
    """
    shares = [_SHARE.match(text) for text in levels]
    bases = {_BASIS[share[2]] if share else "absolute" for share in shares}
    if len(bases) > 1:
        raise SettingsError(
            f"the two levels of {name} are given in different forms",
            found=" and ".join(levels),
            needed="both in a unit, both in %RBS, or both in % of mean",
        )
    low, high = (
        float(share[1]) / 100 if share else parse_quantity(text, _DIMENSIONS.get(name, "number"))
        for share, text in zip(shares, levels, strict=True)
    )
    basis: LevelBasis = _BASIS[shares[0][2]] if shares[0] else "absolute"
    return FactorLevels(name, low, high, basis)


def plan_experiment(
    path: Path,
    name: str,
    section: ExperimentSection,
    *,
    tests: Mapping[str, TestPlan],
    specimens: Mapping[str, Specimen],
) -> ExperimentPlan:
    """An experiment with all its names resolved."""

    def refuse(problem: str, *, found: str | None = None, needed: str | None = None) -> NoReturn:
        raise SettingsError(f"{path}: experiment '{name}': {problem}", found=found, needed=needed)

    try:
        factors = tuple(_parse_factor(key, levels) for key, levels in section.factors.items())
    except SettingsError as error:
        raise SettingsError(f"{path}: experiment '{name}': {error}") from error
    _check_responses(section, refuse)
    runs: dict[str, tuple[float, ...]] = {}
    for run, coded in section.runs.items():
        product, kind = product_of(run, tests) or refuse(
            "a run is not a test of the campaign", found=run,
            needed="a test, or test/step: " + ", ".join(tests),
        )  # fmt: skip
        if kind not in _DYNAMIC:
            refuse(f"run '{run}' has no cycles", found=kind, needed="a cyclic test or step")
        is_short = len(coded) < len(factors)
        if is_short or (section.kind == "box-behnken" and len(coded) != len(factors)):
            refuse(
                f"run '{run}' has {len(coded)} coded levels",
                needed=f"{len(factors)}, one per factor",
            )
        # not (a <= 1) also catches NaN
        beyond = [level for level in coded if not abs(level) <= 1]
        if beyond:
            refuse(
                f"run '{run}' is planned outside the levels of its factors",
                found=f"coded {beyond[0]:g}", needed="coded levels from -1 to 1",
            )  # fmt: skip
        runs[product] = coded
    if len({len(coded) for coded in runs.values()}) > 1:
        refuse("the runs differ in the number of coded levels")
    pulls: dict[str, str] = {}
    for specimen, pull in section.quasi_static.items():
        product, kind = product_of(pull, tests) or refuse(
            f"the slow pull of '{specimen}' is not a test of the campaign", found=pull,
            needed="a test, or test/step: " + ", ".join(tests),
        )  # fmt: skip
        if kind not in _PULLS:
            refuse(f"'{pull}' is not a slow pull", found=kind, needed=" or ".join(_PULLS))
        if specimen not in tests[pull.partition("/")[0]].specimens:
            refuse(f"the slow pull '{pull}' does not pull '{specimen}'")
        pulls[specimen] = product
    if any(factor.basis == "rated_break_strength" for factor in factors):
        pulled = {one for run in section.runs for one in tests[run.partition("/")[0]].specimens}
        bare = sorted(one for one in pulled if specimens[one].rated_break_strength is None)
        if bare:
            refuse(
                "a level is relative to the break strength, which is not stated",
                found="no rated_break_strength of " + ", ".join(bare),
                needed='specimens.NAME.rated_break_strength = "6400 lbf"',
            )
    return ExperimentPlan(
        name=name,
        kind=section.kind,
        factors=factors,
        runs=runs,
        quasi_static=pulls,
        responses=section.responses,
        transform={str(key): value for key, value in section.transform.items()},
        specimens_as=section.specimens_as,
    )


def _check_responses(section: ExperimentSection, refuse: Callable[..., NoReturn]) -> None:
    """Refuse duplicate responses, and transforms of other responses."""
    listed = ", ".join(section.responses)
    if len(set(section.responses)) < len(section.responses):
        refuse("a response is listed twice", found=listed, needed="each response once")
    others = [name for name in section.transform if name not in section.responses]
    if others:
        refuse(
            "a transform is stated for a response that is not requested", found=", ".join(others),
            needed=f"one of responses: {listed}",
        )  # fmt: skip


def agree_on_pulls(
    path: Path, experiments: Mapping[str, ExperimentPlan], tests: Mapping[str, TestPlan]
) -> None:
    """Refuse a run shared by experiments that name different slow pulls for one specimen."""
    first: dict[tuple[str, str], tuple[str, str]] = {}
    for name, plan in experiments.items():
        asks = not set(LINE_PARAMETERS).isdisjoint(plan.responses)
        for run in plan.runs:
            for specimen in tests[run.partition(".")[0]].specimens:
                pull = plan.quasi_static.get(specimen, "")
                if not pull and not asks:
                    continue
                other, before = first.setdefault((run, specimen), (name, pull))
                if before != pull:
                    raise SettingsError(
                        f"{path}: run '{run}' is in two experiments with different slow pulls of "
                        f"'{specimen}'",
                        found=f"{before or 'none'} in '{other}', {pull or 'none'} in '{name}'",
                        needed="the same quasi_static in both: a run has one K_0",
                    )


# used in a header of the run sheet and in the name of a term
ColumnName = Annotated[
    str, StringConstraints(pattern=r"^[^\s\[\]*^,;#][^\[\]*^,;]{0,99}$", strip_whitespace=True)
]

_UNIT = re.compile(r"^\s*[-+]?[\d.]+(?:[eE][-+]?\d+)?\s*(.*?)\s*$")


def _written_unit(text: str) -> str:
    match = _UNIT.match(text)
    return match[1] if match else ""


def _limit(text: str) -> tuple[float | None, float | None]:
    """A load limit in newtons, or as a fraction of the break strength."""
    number = parse_quantity(text, "force", rated_break_strength=1.0)
    return (None, number) if re.search(r"%\s*(RBS|MBS|MBL)\s*$", text) else (number, None)


def _sigma(text: str) -> tuple[float, str]:
    """Scatter of one run and its unit; a fraction of the response if the unit is 1."""
    unit = _written_unit(text)
    number = parse_quantity(text.strip().removesuffix(unit), "number")
    si_unit, factor, _ = scale_to_show(unit)
    if not number > 0:
        raise SettingsError("sigma is not above zero", found=repr(text), needed='such as "2 %"')
    return factor * number, si_unit


class _ExperimentSection(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


class _ExperimentKeys(_ExperimentSection):
    """``[experiment]``, in SI after reading."""

    kind: DesignKind | None = None
    levels: Literal["engineering", "coded"] = "engineering"
    """Default content of the factor columns in a table of runs without unit headers."""
    rated_break_strength: PositiveForce | None = None
    load_limit: Annotated[tuple[float | None, float | None], ReadText(_limit)] = (None, None)
    """Maximum tension of machine, cell or laboratory: a force or a share, ``"40 %RBS"``."""
    n_centre: int | None = Field(default=None, ge=0)
    n_runs: int | None = None
    repeats: RepeatPlacing = "together"
    sigma: Annotated[tuple[float | None, str], ReadText(_sigma)] = (None, "1")
    """Scatter of one run: ``"2 %"`` of the response, or in its unit."""
    specimens_as: Literal["blocks", "random"] = "blocks"


class _ResponseKeys(_ExperimentSection):
    """``[responses.NAME]``."""

    unit: str = ""
    transform: Transform = "none"


class _SpecFile(_ExperimentSection):
    """The whole of SPEC.toml."""

    experiment: _ExperimentKeys = _ExperimentKeys()
    factors: dict[ColumnName, tuple[str | float, str | float]] = Field(default_factory=dict)
    responses: dict[ColumnName, _ResponseKeys] = Field(default_factory=dict)


@dataclass(frozen=True)
class _FactorSpec:
    """A factor with the unit of its stated levels and the corresponding SI unit."""

    name: str
    levels: FactorLevels | None = None
    unit: str = _CODED
    si_unit: str = "1"

    def axis(self, strength: float | None) -> tuple[str, float, float]:
        """Unit, low and high level on the scale of the fitted surface."""
        if self.levels is None:
            return self.si_unit, -1.0, 1.0
        if self.levels.basis == "rated_break_strength" and strength is not None:
            return "N", strength * self.levels.low, strength * self.levels.high
        return self.si_unit, self.levels.low, self.levels.high


@dataclass(frozen=True)
class _ResponseSpec:
    """A response as stated; the unit is empty if not stated."""

    name: str
    unit: str = ""
    transform: Transform = "none"


@dataclass(frozen=True)
class ExperimentSpec:
    """An experiment in SI; factors and responses are empty if the table of runs names them."""

    keys: _ExperimentKeys
    factors: tuple[_FactorSpec, ...]
    responses: tuple[_ResponseSpec, ...]


def _factor(name: str, written: tuple[str | float, str | float]) -> _FactorSpec:
    low, high = (str(level).strip() for level in written)
    units = {_written_unit(level) for level in (low, high)}
    if len(units) > 1:
        raise SettingsError(
            f"the two levels of {name} are given in different forms",
            found=f"{low} and {high}",
            needed="both in one unit",
        )
    (unit,) = units
    if "%" in unit and unit != "%":
        return _FactorSpec(name, _parse_factor(name, (low, high)), unit)
    if name in ("frequency", "mean_tension", "tension_amplitude"):
        return _FactorSpec(name, _parse_factor(name, (low, high)), unit, quantity(name).unit)
    # any other factor has the dimension of its unit
    si_unit, factor, offset = scale_of_unit(unit)
    numbers = [parse_quantity(level.removesuffix(unit), "number") for level in (low, high)]
    bottom, top = (factor * number + offset for number in numbers)
    return _FactorSpec(name, FactorLevels(name, bottom, top), unit, si_unit)


def _response_unit(name: str, unit: str) -> tuple[str, float, float]:
    """SI unit of a response, with the factor and offset to it.

    Examples
    --------
    >>> _response_unit("hysteresis_energy", "kN")
    ('J m-1', 1000.0, 0.0)
    >>> _response_unit("loss", "J/m")
    ('J m-1', 1.0, 0.0)
    """
    if not unit:
        return "", 1.0, 0.0
    if name not in QUANTITIES:
        return scale_to_show(unit)
    si_unit, factor, offset = scale_of_unit(unit)
    known = quantity(name).unit
    if scale_of_unit(known)[0] != si_unit:
        raise SettingsError(
            f"unit '{unit}' is not a unit of {name}", found=f"'{unit}'", needed=f"such as {known}"
        )
    return known, factor, offset


def load_spec(path: Path) -> ExperimentSpec:
    """Read SPEC.toml."""
    file = read_toml(
        path,
        _SpecFile,
        what="the experiment",
        needed="a SPEC.toml with [experiment], [factors] and [responses]",
        keys="docs/experiments.md lists every key",
    )
    factors = []
    for name, levels in file.factors.items():
        with at_place(f"{path}: factors.{name}: "):
            factors.append(_factor(name, levels))
    for name, response in file.responses.items():
        with at_place(f"{path}: responses.{name}: "):
            _response_unit(name, response.unit)
    twice = sorted(file.factors.keys() & file.responses.keys())
    if twice:
        raise in_toml(path, "a name is both a factor and a response", found=", ".join(twice))
    return ExperimentSpec(
        keys=file.experiment,
        factors=tuple(factors),
        responses=tuple(
            _ResponseSpec(name, response.unit, response.transform)
            for name, response in file.responses.items()
        ),
    )


_HEADER = re.compile(r"^(.*?)\s*(?:\[([^\]]*)\])?$")

_MISSING = {"", "nan", "na", "n/a"}

_CELL_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")


@dataclass(frozen=True)
class _CellColumn:
    """One column: its header, the name and unit in it, and its cells."""

    header: str
    name: str
    unit: str
    cells: tuple[str, ...]


@dataclass(frozen=True)
class _CellSheet:
    """Cells of a file, by column."""

    path: Path
    row: tuple[int, ...]
    columns: tuple[_CellColumn, ...]
    first: int

    def fault(self, problem: str, *, header: str | None = None, needed: str) -> LogError:
        """An error in the header line."""
        return LogError(
            self.path, problem, row=self.first, channel=header,
            found=", ".join(column.header for column in self.columns), needed=needed,
        )  # fmt: skip

    def named(self, name: str) -> list[_CellColumn]:
        """Columns with a name, in any unit."""
        return [column for column in self.columns if column.name == name]

    def one(self, name: str, what: str) -> _CellColumn:
        """The column of a name; levels with a unit have priority over planned coded ones."""
        found = self.named(name)
        reached = [column for column in found if column.unit != _CODED] or found
        if len(reached) == 1:
            return reached[0]
        if reached:
            raise self.fault(f"two columns contain {name}", needed="one")
        near = get_close_matches(name, [column.name for column in self.columns], n=1)
        raise self.fault(
            f"{what} '{name}' has no column", needed=f"a column {name}" + (
                f"; is it {near[0]}?" if near else ""
            ),
        )  # fmt: skip

    def numbers(self, column: _CellColumn) -> Floats:
        """Numbers of a column, NaN for empty cells."""
        values = np.full(len(column.cells), math.nan)
        for place, (row, cell) in enumerate(zip(self.row, column.cells, strict=True)):
            if cell.lower() in _MISSING:
                continue
            if not _CELL_NUMBER.fullmatch(cell):
                raise LogError(
                    self.path, "a value is not a number", row=row, channel=column.header,
                    found=repr(cell),
                    needed="a number with a decimal point and no unit, or an empty cell",
                )  # fmt: skip
            values[place] = float(cell)
            if not math.isfinite(values[place]):
                raise LogError(
                    self.path, "a value is not finite", row=row,
                    channel=column.header, found=repr(cut(cell, 60)), needed="a finite number",
                )  # fmt: skip
        return values


def _text(path: Path) -> str:
    try:
        return read_small_text(path)
    except UnicodeDecodeError as error:
        raise LogError(path, "the table of runs is not UTF-8 text", **not_utf8(error)) from error
    except OSError as error:
        raise LogError(
            path, "the table of runs cannot be read", found=error.strerror or str(error)
        ) from error


def _cells(path: Path, row: int, line: str, delimiter: str) -> list[str]:
    cells = split_row(line, delimiter)
    if cells is None:
        raise LogError(
            path, "a row of the table of runs cannot be split into cells", row=row,
            found=repr(cut(line, 60)), needed="one line per row, with every quote closed",
        )  # fmt: skip
    return [cell.strip() for cell in cells]


def _read_cells(path: Path) -> _CellSheet:
    """Cells of the table, without lines that are empty or begin with #."""
    lines = [
        (row, line)
        for row, line in enumerate(split_rows(_text(path)), start=1)
        if line.strip(" ,;\t") and not line.lstrip().startswith("#")
    ]
    if not lines:
        raise LogError(path, "the table of runs is empty", needed="a header and one row per run")
    delimiter = max(",;\t", key=lines[0][1].count)
    table = [(row, _cells(path, row, line, delimiter)) for row, line in lines]
    (first, header), *rows = table
    if not all(header) or len(set(header)) < len(header):
        raise LogError(
            path, "the header of the runs cannot be used", row=first, found=", ".join(header),
            needed="a unique name for every column",
        )  # fmt: skip
    if all(_CELL_NUMBER.fullmatch(cell) for cell in header):
        raise LogError(
            path, "the table of runs has no header", row=first, found=", ".join(header),
            needed="the names of factors and responses in the first row",
        )  # fmt: skip
    for row, cells in rows:
        if len(cells) != len(header):
            raise LogError(
                path, "the number of cells in a row differs from the header", row=row,
                found=str(len(cells)), needed=str(len(header)),
            )  # fmt: skip
    if not rows:
        raise LogError(path, "the table of runs has no rows", needed="one row per run")
    cells_by_column = zip(*(cells for _, cells in rows), strict=True)
    columns = []
    for name, column in zip(header, cells_by_column, strict=True):
        match = _HEADER.match(name)
        stem, unit = (match[1], match[2] or "") if match else (name, "")
        columns.append(_CellColumn(name, stem, unit.strip(), tuple(column)))
    questions = [
        f"{path}:{row} [{column.header}]"
        for column in columns
        for (row, _), cell in zip(rows, column.cells, strict=True)
        if cell == "?"
    ]
    if questions:
        count = f"{len(questions)} values are" if len(questions) > 1 else "1 value is"
        raise in_toml(path, listed(f"{count} still '?'", questions))
    return _CellSheet(path, tuple(row for row, _ in rows), tuple(columns), first)


_SHARE_UNIT = re.compile(r"%\s*(RBS|MBS|MBL|of mean)")

_OFF_PLAN = 1.0
"""Coded distance between the mean of all runs and the centre of the plan, beyond which the levels
are in a different unit.
"""


def _levels_of_factor(
    sheet: _CellSheet, factor: _FactorSpec, spec: ExperimentSpec | None, mean: Floats | None
) -> tuple[_CellColumn, Floats]:
    """Column and coded levels of a factor."""
    column = sheet.one(factor.name, "factor")
    values = sheet.numbers(column)
    is_coded = factor.levels is None or (spec is not None and spec.keys.levels == _CODED)
    unit = column.unit or (_CODED if is_coded else factor.unit)
    if unit == _CODED:
        return column, values

    def refuse(problem: str, needed: str) -> NoReturn:
        raise SettingsError(
            f"{sheet.path}:{sheet.first} [{column.header}]: {problem}", found=f"'{unit}'",
            needed=needed,
        )  # fmt: skip

    if factor.levels is None:
        refuse(
            "the column is in a unit, but the levels for -1 and +1 are not stated",
            "[factors] in a SPEC.toml, or coded levels without a unit",
        )
    axis, low, high = factor.axis(None if spec is None else spec.keys.rated_break_strength)
    basis = factor.levels.basis
    share = _SHARE_UNIT.fullmatch(unit)
    if share is not None:
        if basis != ("mean_tension" if share[1] == "of mean" else "rated_break_strength"):
            refuse(f"{factor.name} is no such share in the plan", f"a unit such as {factor.unit}")
        strength = spec.keys.rated_break_strength if spec is not None and axis == "N" else None
        found = values / 100 * (1.0 if strength is None else strength)
    else:
        try:
            si_unit, by, offset = scale_of_unit(unit)
        except SettingsError as error:
            refuse(error.problem, error.needed or "")
        found = by * values + offset
        if basis == "mean_tension" and si_unit == "N" and mean is not None:
            found = found / mean
        elif si_unit != axis:
            beside = "" if basis == "absolute" else ", or rated_break_strength in [experiment]"
            refuse(f"unit '{unit}' does not fit {factor.name}", f"such as {factor.unit}{beside}")
    coded: Floats = (found - (low + high) / 2) / ((high - low) / 2)
    return column, coded


def _is_of_mean(factor: _FactorSpec) -> bool:
    """Whether the levels of a factor are fractions of the mean tension."""
    return factor.levels is not None and factor.levels.basis == "mean_tension"


def _check_levels(
    sheet: _CellSheet, column: _CellColumn, name: str, coded: Floats, *, stated: bool
) -> None:
    """Refuse levels outside the plan, which are in another unit."""
    known = coded[np.isfinite(coded)]
    if known.size and abs(known.mean()) > _OFF_PLAN:
        raise DataError(
            f"{sheet.path}:{sheet.row[0]} [{column.header}]: the levels of {name} are far off the "
            "plan",
            found=f"{known.min():.4g} to {known.max():.4g} coded",
            needed="about -1 to 1",
            hint='Coded levels under [factors] in units need levels = "coded" in [experiment].'
            if stated
            else "Levels in units need a SPEC.toml with [factors].",
        )


_LABELS = ("run", "run_order", "block", "specimen")

_DUMMY = re.compile(r"dummy_\d+")


@dataclass(frozen=True)
@read_only_arrays
class RunSeries:
    """Completed runs.

    Parameters
    ----------
    factor_names, factor_units : tuple of str, length n_factors
        SI units of low and high.
    low, high : ndarray, shape (n_factors,)
        Levels coded as -1 and +1. [SI unit of each factor]
    coded : ndarray, shape (n_runs, n_factors)
        Achieved levels; NaN if a run was not done. [1]
    dummy : ndarray, shape (n_runs, n_dummy)
        Columns ``dummy_1``, .. of a screening. [1]
    response_names, response_units : tuple of str, length n_responses
        The unit is empty if not stated.
    responses : ndarray, shape (n_responses, n_runs)
        NaN if a run gave no value. [SI unit of each response]
    run_names : tuple of str, length n_runs
    row : tuple of int, length n_runs
        Row in the file; its first line is 1.
    run_order : ndarray, shape (n_runs,)
        NaN if not given. [1]
    blocks : tuple of str, length n_runs, or None
        Block or specimen of each run, if there are several.
    notes : tuple of str
        Notes for the user of the results.
    """

    factor_names: tuple[str, ...]
    factor_units: tuple[str, ...]
    low: Floats
    high: Floats
    coded: Floats
    dummy: Floats
    response_names: tuple[str, ...]
    response_units: tuple[str, ...]
    responses: Floats
    run_names: tuple[str, ...]
    row: tuple[int, ...]
    run_order: Floats
    blocks: tuple[str, ...] | None
    notes: tuple[str, ...]


def _declared(
    sheet: _CellSheet, spec: ExperimentSpec | None
) -> tuple[tuple[_FactorSpec, ...], tuple[_ResponseSpec, ...]]:
    """Factors and responses: as declared, else the last column is the response."""
    factors, responses = ((), ()) if spec is None else (spec.factors, spec.responses)
    named = {factor.name for factor in factors} | {entry.name for entry in responses}
    free = [
        column
        for column in sheet.columns
        if column.name not in (*_LABELS, *named) and not _DUMMY.fullmatch(column.name)
    ]
    if not responses:
        if not free or sheet.columns[-1] is not free[-1]:
            raise sheet.fault("the last column is not a response", needed="the response last")
        responses = (_ResponseSpec(free.pop().name),)
    if not factors:
        factors = tuple(_FactorSpec(column.name) for column in free)
        if not factors:
            raise sheet.fault("the table has no factor", needed="one column per factor")
    return factors, responses


def _labels(sheet: _CellSheet, name: str) -> tuple[str, ...] | None:
    found = sheet.named(name)
    return found[0].cells if found else None


def _same_run(sheet: _CellSheet, header: str, keys: Iterable[tuple[str, ...]]) -> None:
    seen: dict[tuple[str, ...], int] = {}
    for row, key in zip(sheet.row, keys, strict=True):
        if key[-1] and seen.setdefault(key, row) != row:
            raise DataError(
                f"{sheet.path}:{row} [{header}]: a run is listed twice",
                found=f"{key[-1]!r}, also in row {seen[key]}",
                needed="each run once",
                hint="Give a repeat its own run number.",
            )


def read_runs(path: Path, spec: ExperimentSpec | None = None) -> RunSeries:
    """Read a table of runs."""
    sheet = _read_cells(path)
    factors, responses = _declared(sheet, spec)
    strength = None if spec is None else spec.keys.rated_break_strength
    coded = np.full((len(sheet.row), len(factors)), math.nan)
    used: set[str] = set()
    axes = [factor.axis(strength) for factor in factors]
    mean: Floats | None = None
    # an amplitude relative to the mean is read after the mean
    for place in sorted(range(len(factors)), key=lambda index: _is_of_mean(factors[index])):
        factor = factors[place]
        column, coded[:, place] = _levels_of_factor(sheet, factor, spec, mean)
        _check_levels(sheet, column, factor.name, coded[:, place], stated=factor.levels is not None)
        used.add(column.header)
        unit, low, high = axes[place]
        if factor.name == "mean_tension" and unit == "N":
            mean = (low + high) / 2 + coded[:, place] * (high - low) / 2
    values, units = [], []
    for response in responses:
        column = sheet.one(response.name, "response")
        used.add(column.header)
        try:
            unit, by, offset = _response_unit(response.name, column.unit or response.unit)
        except SettingsError as error:
            raise SettingsError(
                f"{path}:{sheet.first} [{column.header}]: {error.problem}", found=error.found,
                needed=error.needed, hint=error.hint,
            ) from error  # fmt: skip
        values.append(by * sheet.numbers(column) + offset)
        units.append(unit)
    measured = np.array(values)
    lost = np.isfinite(measured).any(axis=0) & ~np.isfinite(coded).all(axis=1)
    if lost.any():
        first = int(np.flatnonzero(lost)[0])
        name = factors[int(np.flatnonzero(~np.isfinite(coded[first]))[0])].name
        raise DataError(
            f"{path}:{sheet.row[first]} [{name}]: a run has a value but no level",
            needed="the level reached in the run",
        )
    dummies = [column for column in sheet.columns if _DUMMY.fullmatch(column.name)]
    blocks, notes = _blocks(sheet)
    known = {*_LABELS, *(factor.name for factor in factors)}
    others = [
        column.header
        for column in sheet.columns
        if column.header not in used and column not in dummies and column.name not in known
    ]
    if others:
        notes.append(f"columns that are not used: {', '.join(others)}")
    return RunSeries(
        factor_names=tuple(factor.name for factor in factors),
        factor_units=tuple(unit for unit, _, _ in axes),
        low=np.array([low for _, low, _ in axes]),
        high=np.array([high for _, _, high in axes]),
        coded=coded,
        dummy=np.array([sheet.numbers(column) for column in dummies]).T.reshape(
            len(sheet.row), len(dummies)
        ),
        response_names=tuple(response.name for response in responses),
        response_units=tuple(units),
        responses=measured,
        run_names=_run_names(sheet),
        row=sheet.row,
        run_order=_order(sheet),
        blocks=blocks,
        notes=tuple(notes),
    )


def _blocks(sheet: _CellSheet) -> tuple[tuple[str, ...] | None, list[str]]:
    """Blocks, if there are several, from the column block, else from the column specimen."""
    several = {
        name: labels
        for name in ("block", "specimen")
        if (labels := _labels(sheet, name)) and len(set(labels)) > 1
    }
    if not several:
        return None, []
    name, labels = next(iter(several.items()))
    empty = [row for row, label in zip(sheet.row, labels, strict=True) if not label]
    if empty:
        raise LogError(
            sheet.path, f"a run has no {name}", row=empty[0], channel=name,
            needed="a name in every row, or in no row",
        )  # fmt: skip
    pairs = set(zip(*several.values(), strict=True))
    if len(several) > 1 and len(pairs) > len(set(labels)):
        return labels, ["blocks are those of the column block; specimens within one are pooled"]
    return labels, []


def _run_names(sheet: _CellSheet) -> tuple[str, ...]:
    """Names of the runs, with the specimen if a run has several; otherwise their numbers."""
    names, specimens = _labels(sheet, "run"), _labels(sheet, "specimen")
    apart = specimens or _labels(sheet, "block") or ("",) * len(sheet.row)
    if names is None:
        return tuple(str(number + 1) for number in range(len(sheet.row)))
    _same_run(sheet, "run", zip(apart, names, strict=True))
    empty = [row for row, name in zip(sheet.row, names, strict=True) if not name]
    if empty:
        raise LogError(
            sheet.path,
            "a run has no name",
            row=empty[0],
            channel="run",
            needed="a name or a number",
        )
    many = max(Counter(names).values()) > 1
    return tuple(f"{name} {of}" if many else name for name, of in zip(names, apart, strict=True))


def _order(sheet: _CellSheet) -> Floats:
    """Position of each run in the order, unique within a block."""
    found = sheet.named("run_order")
    if not found:
        return np.full(len(sheet.row), math.nan)
    apart = _labels(sheet, "specimen") or _labels(sheet, "block") or ("",) * len(sheet.row)
    order = sheet.numbers(found[0])
    _same_run(sheet, found[0].header, zip(apart, found[0].cells, strict=True))
    return order
