"""SPEC.toml of a deployed assembly to a case in SI: its tethers, their curve and splices."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from reduction.campaign.toml_file import Number, TableReader, in_toml, read_toml
from reduction.lines.assembly import SeriesPart, StatedSplices, WorkingLevel
from reduction.lines.composite import CompositeRule, PieceBranch, PieceKind
from reduction.record.errors import SettingsError

_MOST_TETHERS = 100


class _AssemblySection(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class _CurveKeys(_AssemblySection):
    """``[assembly.curve]``: what `reduction composite` is told."""

    source: str | tuple[str, ...]
    """A published tether, or archives and folders beside the file."""
    specimen: str | None = None
    branch: PieceBranch | None = None
    precedence: tuple[PieceKind, ...] | None = None


class _SpliceKeys(_AssemblySection):
    """``[assembly.splices]``; without it those of the tested tether."""

    length: str
    """Of both together, relaxed; 0 m where there are none."""
    strain_ratio: Number | None = None
    """Their strain over that of the free length."""
    strain: Number | None = None
    """Theirs, at ``at_tension``."""
    at_tension: str | None = None
    exponent: Number = 1.0
    """Of the tension, with ``strain``."""


class _PartKeys(_AssemblySection):
    """``[[assembly.parts]]``: in line with the tethers."""

    name: str = ""
    length: str
    spring_constant: str | None = None
    """Force per unit strain; rigid if nothing."""


class _WorkingKeys(_AssemblySection):
    """``[[assembly.working]]``: one of tension, total length and strain."""

    tension: str | None = None
    total_length: str | None = None
    strain: Number | None = None
    """Of the free length of a tether."""
    tension_amplitude: str = "0 N"


class _AssemblyKeys(_AssemblySection):
    """``[assembly]``."""

    n_tethers: int | None = Field(default=None, ge=1, le=_MOST_TETHERS)
    """All alike; or ``free_lengths``."""
    free_length: str | None = None
    """Of the rubber, relaxed; that of the tested tether if nothing."""
    free_lengths: tuple[str, ...] | None = Field(
        default=None, min_length=1, max_length=_MOST_TETHERS
    )
    tolerance: Number | None = None
    """Of the free lengths: the greatest and the least load of a tether follow."""
    rated_break_strength: str | None = None
    """Of one tether; that of the source if nothing."""
    curve: _CurveKeys
    splices: _SpliceKeys | None = None
    parts: tuple[_PartKeys, ...] = ()
    working: tuple[_WorkingKeys, ...] = ()


class _AssemblyFile(_AssemblySection):
    """The whole of SPEC.toml."""

    assembly: _AssemblyKeys


@dataclass(frozen=True)
class AssemblyCase:
    """An assembly in SI.

    ``free_lengths`` [m] has an entry a tether, or is empty where the tested length stands for
    all ``n_tethers``; ``tolerance`` [1] and ``rated_break_strength`` [N] are NaN where they are
    not stated.
    """

    name: str
    n_tethers: int
    free_lengths: tuple[float, ...]
    tolerance: float
    rated_break_strength: float
    sources: tuple[str, ...]
    specimen: str | None
    branch: PieceBranch | None
    rule: CompositeRule
    splices: StatedSplices | None
    parts: tuple[SeriesPart, ...]
    working: tuple[WorkingLevel, ...]


def load_assembly_case(path: Path) -> AssemblyCase:
    """Read SPEC.toml of an assembly."""
    keys = read_toml(
        path,
        _AssemblyFile,
        what="the assembly",
        needed="a SPEC.toml with [assembly] and [assembly.curve]",
        keys="docs/deployed.md lists every key",
    ).assembly
    read = TableReader(path, "assembly")
    n_tethers, lengths = _tethers(read, keys)
    tolerance = read.optional("tolerance", keys.tolerance, "strain")
    if tolerance is not None:
        _check_tolerance(path, keys, n_tethers, tolerance)
    strength = read.optional("rated_break_strength", keys.rated_break_strength, "force")
    if strength is not None and not strength > 0:
        raise _negative(path, "assembly.rated_break_strength", strength, "N")
    source = keys.curve.source
    words = (source,) if isinstance(source, str) else source
    if not words or not all(word.strip() for word in words):
        raise in_toml(
            path, "assembly.curve.source is empty", needed="a tether, archives or a folder"
        )
    try:
        rule = (
            CompositeRule()
            if keys.curve.precedence is None
            else CompositeRule(precedence=keys.curve.precedence)
        )
    except SettingsError as error:
        raise TableReader(path, "assembly.curve").fault(
            f"precedence: {error.problem}", error
        ) from error
    return AssemblyCase(
        name=path.stem,
        n_tethers=n_tethers,
        free_lengths=lengths,
        tolerance=float("nan") if tolerance is None else tolerance,
        rated_break_strength=float("nan") if strength is None else strength,
        sources=words,
        specimen=keys.curve.specimen,
        branch=keys.curve.branch,
        rule=rule,
        splices=None if keys.splices is None else _splices(path, keys.splices),
        parts=tuple(_part(path, number, one) for number, one in enumerate(keys.parts, start=1)),
        working=tuple(
            _working(path, number, one, equal=len(set(lengths)) < 2)
            for number, one in enumerate(keys.working, start=1)
        ),
    )


def _negative(path: Path, place: str, value: float, unit: str) -> SettingsError:
    return in_toml(path, f"{place} is not positive", found=f"{value:g} {unit}", needed="above zero")


def _tethers(read: TableReader, keys: _AssemblyKeys) -> tuple[int, tuple[float, ...]]:
    """How many, and the free length of each; none where it is that of the tested tether."""
    if (keys.n_tethers is None) == (keys.free_lengths is None):
        raise in_toml(
            read.path, "assembly: how many tethers there are is not said once",
            found="both" if keys.n_tethers else "neither", needed="n_tethers or free_lengths",
        )  # fmt: skip
    if keys.free_lengths is not None:
        if keys.free_length is not None:
            raise in_toml(
                read.path, "assembly.free_length and free_lengths stand beside each other",
                needed="one of them",
            )  # fmt: skip
        lengths = tuple(
            read.value(f"free_lengths.{number}", text, "length")
            for number, text in enumerate(keys.free_lengths, start=1)
        )
        for number, one in enumerate(lengths, start=1):
            if not one > 0:
                raise _negative(read.path, f"assembly.free_lengths.{number}", one, "m")
        return len(lengths), lengths
    n_tethers = int(keys.n_tethers or 0)
    length = read.optional("free_length", keys.free_length, "length")
    if length is None:
        return n_tethers, ()
    if not length > 0:
        raise _negative(read.path, "assembly.free_length", length, "m")
    return n_tethers, (length,) * n_tethers


def _check_tolerance(path: Path, keys: _AssemblyKeys, n_tethers: int, tolerance: float) -> None:
    if not 0 < tolerance < 1:
        raise in_toml(
            path, "assembly.tolerance is no share of a length", found=f"{tolerance:g}",
            needed="above 0, below 100 %",
        )  # fmt: skip
    if keys.free_lengths is not None or n_tethers < 2:
        raise in_toml(
            path, "assembly.tolerance is of tethers that are all alike",
            found="free_lengths" if keys.free_lengths is not None else "one tether",
            needed="n_tethers = 2 or more",
        )  # fmt: skip
    if not keys.working:
        raise in_toml(
            path, "assembly.tolerance has no tension at which loads could be shared",
            needed="[[assembly.working]]",
        )  # fmt: skip


def _splices(path: Path, keys: _SpliceKeys) -> StatedSplices:
    read = TableReader(path, "assembly.splices")
    if keys.strain_ratio is not None and keys.strain is not None:
        raise in_toml(
            path, "assembly.splices: strain_ratio and strain are two laws", needed="one of them"
        )
    if (keys.strain is None) != (keys.at_tension is None):
        raise in_toml(
            path, "assembly.splices: a strain belongs to a tension",
            found="strain alone" if keys.at_tension is None else "at_tension alone",
            needed="strain and at_tension",
        )  # fmt: skip
    values = {
        "length": read.value("length", keys.length, "length"),
        "strain_ratio": read.optional("strain_ratio", keys.strain_ratio, "strain"),
        "strain": read.optional("strain", keys.strain, "strain"),
        "at_tension": read.optional("at_tension", keys.at_tension, "force"),
    }
    exponent = read.value("exponent", keys.exponent, "number")
    try:
        return StatedSplices(
            length=float(values["length"] or 0.0),
            strain_ratio=values["strain_ratio"],
            strain=values["strain"],
            at_tension=values["at_tension"],
            exponent=exponent,
        )
    except SettingsError as error:
        raise read.fault(error.problem, error) from error


def _part(path: Path, number: int, keys: _PartKeys) -> SeriesPart:
    read = TableReader(path, f"assembly.parts.{keys.name or number}")
    length = read.value("length", keys.length, "length")
    spring = read.optional("spring_constant", keys.spring_constant, "force")
    try:
        return SeriesPart(
            keys.name or f"part {number}", length, np.inf if spring is None else spring
        )
    except SettingsError as error:
        raise in_toml(
            path, f"{read.place}: {error.problem}", found=error.found, needed=error.needed
        ) from error


def _working(path: Path, number: int, keys: _WorkingKeys, *, equal: bool) -> WorkingLevel:
    read = TableReader(path, f"assembly.working.{number}")
    given: dict[Literal["tension", "total_length", "strain"], float | None] = {
        "tension": read.optional("tension", keys.tension, "force"),
        "total_length": read.optional("total_length", keys.total_length, "length"),
        "strain": read.optional("strain", keys.strain, "strain"),
    }
    named = [(name, value) for name, value in given.items() if value is not None]
    if len(named) != 1:
        raise in_toml(
            path, f"{read.place}: where the assembly stands is not said once",
            found=", ".join(name for name, _ in named) or "nothing", needed=" or ".join(given),
        )  # fmt: skip
    (name, value) = named[0]
    if not value > 0:
        raise _negative(path, f"{read.place}.{name}", value, "in SI")
    if name == "strain" and not equal:
        raise in_toml(
            path, f"{read.place}.strain: the tethers differ, and so do their strains",
            needed="tension or total_length",
        )  # fmt: skip
    amplitude = read.value("tension_amplitude", keys.tension_amplitude, "force")
    if amplitude < 0:
        raise in_toml(
            path, f"{read.place}.tension_amplitude is negative", found=f"{amplitude:g} N",
            needed="zero or above",
        )  # fmt: skip
    return WorkingLevel(name, value, amplitude)
