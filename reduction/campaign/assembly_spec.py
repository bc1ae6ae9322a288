"""Converts SPEC.toml of a deployed assembly to a case in SI: tethers, curve and splices."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from reduction.campaign.toml_file import at_place, in_toml, read_toml
from reduction.campaign.unit_types import (
    Force,
    InSI,
    Length,
    PositiveForce,
    PositiveLength,
    PositiveStrain,
    Ratio,
    Strain,
)
from reduction.lines.assembly import SeriesPart, StatedSplices, WorkingLevel
from reduction.lines.composite import CompositeRule, PieceBranch, PieceKind

_MOST_TETHERS = 100


class _AssemblySection(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


class _CurveKeys(_AssemblySection):
    """``[assembly.curve]``: input of `reduction composite`."""

    source: str | tuple[str, ...]
    """A published tether, or archives and folders beside the file."""
    specimen: str | None = None
    branch: PieceBranch | None = None
    precedence: tuple[PieceKind, ...] | None = None


class _SpliceKeys(_AssemblySection):
    """``[assembly.splices]``; default: those of the tested tether."""

    length: Length
    """Total relaxed length of both; 0 m if there are none."""
    strain_ratio: Strain | None = None
    """Ratio of splice strain to the strain of the free length."""
    strain: Strain | None = None
    """Splice strain at ``at_tension``."""
    at_tension: Force | None = None
    exponent: Ratio = 1.0
    """Exponent of the tension, with ``strain``."""


class _PartKeys(_AssemblySection):
    """``[[assembly.parts]]``: parts in line with the tethers."""

    name: str = ""
    length: Length
    spring_constant: Force | None = None
    """Force per unit strain; rigid if omitted."""


class _WorkingKeys(_AssemblySection):
    """``[[assembly.working]]``: one of tension, total length and strain."""

    tension: PositiveForce | None = None
    total_length: PositiveLength | None = None
    strain: PositiveStrain | None = None
    """Strain of the free length of a tether."""
    tension_amplitude: Annotated[float, InSI("force", least=0.0)] = Field(
        "0 N", validate_default=True
    )


class _AssemblyKeys(_AssemblySection):
    """``[assembly]``."""

    n_tethers: int | None = Field(default=None, ge=1, le=_MOST_TETHERS)
    """Number of identical tethers; alternatively ``free_lengths``."""
    free_length: PositiveLength | None = None
    """Relaxed length of the rubber; default that of the tested tether."""
    free_lengths: tuple[PositiveLength, ...] | None = Field(
        default=None, min_length=1, max_length=_MOST_TETHERS
    )
    tolerance: Strain | None = None
    """Of the free lengths; it gives the maximum and minimum load of a tether."""
    rated_break_strength: PositiveForce | None = None
    """Of one tether; default that of the source."""
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

    ``free_lengths`` [m] has an entry per tether, or is empty if all ``n_tethers`` have the tested
    length; ``tolerance`` [1] and ``rated_break_strength`` [N] are NaN if not stated.
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
    n_tethers, lengths = _tethers(path, keys)
    if keys.tolerance is not None:
        _check_tolerance(path, keys, n_tethers, keys.tolerance)
    source = keys.curve.source
    words = (source,) if isinstance(source, str) else source
    if not words or not all(word.strip() for word in words):
        raise in_toml(
            path, "assembly.curve.source is empty", needed="a tether, archives or a folder"
        )
    stated = keys.curve.precedence
    with at_place(f"{path}: assembly.curve.precedence: "):
        rule = CompositeRule() if stated is None else CompositeRule(precedence=stated)
    parts = []
    for number, part in enumerate(keys.parts, start=1):
        with at_place(f"{path}: assembly.parts.{part.name or number}: "):
            spring = np.inf if part.spring_constant is None else part.spring_constant
            parts.append(SeriesPart(part.name or f"part {number}", part.length, spring))
    return AssemblyCase(
        name=path.stem,
        n_tethers=n_tethers,
        free_lengths=lengths,
        tolerance=_or_nan(keys.tolerance),
        rated_break_strength=_or_nan(keys.rated_break_strength),
        sources=words,
        specimen=keys.curve.specimen,
        branch=keys.curve.branch,
        rule=rule,
        splices=None if keys.splices is None else _splices(path, keys.splices),
        parts=tuple(parts),
        working=tuple(
            _working(path, number, one, equal=len(set(lengths)) < 2)
            for number, one in enumerate(keys.working, start=1)
        ),
    )


def _or_nan(value: float | None) -> float:
    return float("nan") if value is None else value


def _tethers(path: Path, keys: _AssemblyKeys) -> tuple[int, tuple[float, ...]]:
    """Number of tethers and the free length of each; empty for that of the tested tether."""
    if (keys.n_tethers is None) == (keys.free_lengths is None):
        raise in_toml(
            path, "assembly: state the number of tethers once",
            found="both" if keys.n_tethers else "neither", needed="n_tethers or free_lengths",
        )  # fmt: skip
    if keys.free_lengths is not None:
        if keys.free_length is not None:
            raise in_toml(
                path, "assembly.free_length and free_lengths are both stated",
                needed="one of them",
            )  # fmt: skip
        return len(keys.free_lengths), keys.free_lengths
    n_tethers = int(keys.n_tethers or 0)
    return n_tethers, () if keys.free_length is None else (keys.free_length,) * n_tethers


def _check_tolerance(path: Path, keys: _AssemblyKeys, n_tethers: int, tolerance: float) -> None:
    if not 0 < tolerance < 1:
        raise in_toml(
            path, "assembly.tolerance is not a fraction of a length", found=f"{tolerance:g}",
            needed="above 0, below 100 %",
        )  # fmt: skip
    if keys.free_lengths is not None or n_tethers < 2:
        raise in_toml(
            path, "assembly.tolerance applies only to two or more identical tethers",
            found="free_lengths" if keys.free_lengths is not None else "one tether",
            needed="n_tethers = 2 or more",
        )  # fmt: skip
    if not keys.working:
        raise in_toml(
            path, "assembly.tolerance needs a working tension at which the load is shared",
            needed="[[assembly.working]]",
        )  # fmt: skip


def _splices(path: Path, keys: _SpliceKeys) -> StatedSplices:
    if keys.strain_ratio is not None and keys.strain is not None:
        raise in_toml(
            path, "assembly.splices: strain_ratio and strain are two laws", needed="one of them"
        )
    if (keys.strain is None) != (keys.at_tension is None):
        raise in_toml(
            path, "assembly.splices: strain and at_tension go together",
            found="strain alone" if keys.at_tension is None else "at_tension alone",
            needed="strain and at_tension",
        )  # fmt: skip
    with at_place(f"{path}: assembly.splices."):
        return StatedSplices(**keys.model_dump())


def _working(path: Path, number: int, keys: _WorkingKeys, *, equal: bool) -> WorkingLevel:
    place = f"assembly.working.{number}"
    names: tuple[Literal["tension", "total_length", "strain"], ...]
    names = ("tension", "total_length", "strain")
    given = [name for name in names if getattr(keys, name) is not None]
    if len(given) != 1:
        raise in_toml(
            path, f"{place}: state one working level",
            found=", ".join(given) or "nothing", needed=" or ".join(names),
        )  # fmt: skip
    if keys.strain is not None and not equal:
        raise in_toml(
            path, f"{place}.strain: tethers of different length have no common strain",
            needed="tension or total_length",
        )  # fmt: skip
    return WorkingLevel(given[0], getattr(keys, given[0]), keys.tension_amplitude)
