"""Keys of the SPEC.toml of a deployed assembly, as they are written."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field

from reduction.campaign.quantities import Number
from reduction.lookup.pieces import PieceBranch, PieceKind

_MOST_TETHERS = 100


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class CurveKeys(_Section):
    """``[assembly.curve]``: what `reduction composite` is told."""

    source: str | tuple[str, ...]
    """A published tether, or archives and folders beside the file."""
    specimen: str | None = None
    branch: PieceBranch | None = None
    precedence: tuple[PieceKind, ...] | None = None


class SpliceKeys(_Section):
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


class PartKeys(_Section):
    """``[[assembly.parts]]``: in line with the tethers."""

    name: str = ""
    length: str
    spring_constant: str | None = None
    """Force per unit strain; rigid if nothing."""


class WorkingKeys(_Section):
    """``[[assembly.working]]``: one of tension, total length and strain."""

    tension: str | None = None
    total_length: str | None = None
    strain: Number | None = None
    """Of the free length of a tether."""
    tension_amplitude: str = "0 N"


class AssemblyKeys(_Section):
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
    curve: CurveKeys
    splices: SpliceKeys | None = None
    parts: tuple[PartKeys, ...] = ()
    working: tuple[WorkingKeys, ...] = ()


class AssemblyFile(_Section):
    """The whole of SPEC.toml."""

    assembly: AssemblyKeys
