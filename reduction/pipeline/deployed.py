"""A deployed assembly from its tethers to its curve, its stiffness and its work."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from reduction.errors import DataError
from reduction.lookup.assembly import AssemblyCurve, assemble
from reduction.lookup.composite import CompositeCurve
from reduction.lookup.source import PieceSource
from reduction.lookup.splices import deployed_model
from reduction.lookup.tethers import SeriesPart, Tether, equal_tethers, unequal_tethers
from reduction.lookup.working import LoadSharing, WorkingPoint, working_point, worst_sharing
from reduction.record import Floats, read_only_arrays
from reduction.strain.model import StrainModel

_SPAN = 0.05
"""Share of a length to each side over which a secant is taken where no amplitude is stated."""


@dataclass(frozen=True)
class WorkingLevel:
    """Where an assembly stands: a tension [N], a total length [m], or a strain of its tethers [1].

    ``tension_amplitude`` is half the range about it. [N]
    """

    quantity: Literal["tension", "total_length", "strain"]
    value: float
    tension_amplitude: float = 0.0


@dataclass(frozen=True)
@read_only_arrays
class WorkingState:
    """An assembly at one working level.

    ``strain`` is that of the free length of each tether, shape (n_tethers,) [1];
    ``standard_uncertainty`` that of the tension at this length [N], of which
    ``random_standard_uncertainty`` is of the curve by itself and ``shared_standard_uncertainty`` of
    what its tests share with others [N]; ``secant_spring_constant`` is
    EA over the cycle, or over 5 % of the length to each side where it has no amplitude [N];
    ``is_moved`` is of the tangent there; ``sharing`` is there where the lengths have a
    tolerance.
    """

    level: WorkingLevel
    point: WorkingPoint
    strain: Floats
    standard_uncertainty: float
    random_standard_uncertainty: float
    shared_standard_uncertainty: float
    secant_spring_constant: float
    is_moved: bool
    sharing: LoadSharing | None


@dataclass(frozen=True)
@read_only_arrays
class DeployedAssembly:
    """An assembly and its work; arrays have the shape (n,) of the nodes of its curve.

    Parameters
    ----------
    assembly : AssemblyCurve
        Tension against length.
    strain : ndarray
        Of the assembly: length over that at which it goes slack, less one. [1]
    apparent_spring_constant : ndarray
        EA, tangent: slope of tension on that strain. [N]
    secant_spring_constant : ndarray
        EA over 5 % of the length that the assembly has there, to each side. [N]
    free_length : tuple of float
        Of each tether, relaxed; NaN where its strain model knows none. [m]
    working : tuple of WorkingState
        One a level.
    notes : tuple of str
        What is not in it.
    """

    assembly: AssemblyCurve
    strain: Floats
    apparent_spring_constant: Floats
    secant_spring_constant: Floats
    free_length: tuple[float, ...]
    working: tuple[WorkingState, ...]
    notes: tuple[str, ...]


@dataclass(frozen=True)
class DeployedLine:
    """An assembly with what it was made of.

    ``splices`` says by which law a tether has its length, in words.
    """

    name: str
    deployed: DeployedAssembly
    source: PieceSource
    curve: CompositeCurve
    splices: str
    parts: tuple[SeriesPart, ...] = ()

    @property
    def is_equal(self) -> bool:
        """Whether all tethers carry the same."""
        return bool(np.ptp(self.deployed.assembly.slack_length) == 0)

    @property
    def words(self) -> str:
        """What it is."""
        lengths = self.deployed.free_length
        free = [f"{length:.4g}" for length in dict.fromkeys(lengths)]
        told = f"{len(lengths)} x {self.source.name}, free length {', '.join(free)} m"
        named = ", ".join(f"{part.name} {part.length:.4g} m" for part in self.parts)
        return f"{told}, in line with {named}" if named else told


def deploy(
    curve: CompositeCurve,
    model: StrainModel,
    *,
    n_tethers: int,
    free_lengths: Sequence[float] = (),
    parts: Sequence[SeriesPart] = (),
    levels: Sequence[WorkingLevel] = (),
    tolerance: float = float("nan"),
    rated_break_strength: float = float("nan"),
    has_stated_splices: bool = False,
) -> DeployedAssembly:
    """Put tethers side by side and parts in line, and work them.

    Parameters
    ----------
    curve : CompositeCurve
        Tension against strain of the free length of a tether. [SI]
    model : StrainModel
        How the length of a tether follows from strain and tension.
    n_tethers : int
        Side by side. [1]
    free_lengths : sequence of float
        Relaxed, one a tether; that of the model for all where it is empty. [m]
    parts : sequence of SeriesPart
        In line.
    levels : sequence of WorkingLevel
        Where the assembly stands.
    tolerance : float
        Of a free length, of tethers that are all alike; NaN where none is stated. [1]
    rated_break_strength : float
        Of one tether; NaN where not known. [N]
    has_stated_splices : bool
        The law of the splices is stated, and not of the tests of the curve.

    Returns
    -------
    deployed : DeployedAssembly
        In SI.

    Raises
    ------
    SettingsError
        If there is no tether.
    DataError
        If tethers of these lengths cannot be, or a level is beyond the curve or lets a tether go
        slack; names the level by its place, ``working.1`` the first.
    """
    first = free_lengths[0] if free_lengths else None
    tether = Tether(curve, deployed_model(model, first), is_stated=has_stated_splices)
    alike = len(set(free_lengths)) < 2
    tethers = equal_tethers(tether, n_tethers) if alike else unequal_tethers(tether, free_lengths)
    assembly = assemble(tethers, parts)
    slack = float(assembly.total_length[0])
    lengths = tuple(one.model.relaxed_length for one in tethers)
    states = []
    for number, level in enumerate(levels, start=1):
        try:
            states.append(_state(assembly, tether, level, parts, tolerance, rated_break_strength))
        except DataError as error:
            raise DataError(
                f"working.{number}: {error.problem}", found=error.found, needed=error.needed,
                hint=error.hint,
            ) from error  # fmt: skip
    return DeployedAssembly(
        assembly=assembly,
        strain=assembly.total_length / slack - 1,
        apparent_spring_constant=slack * np.gradient(assembly.tension, assembly.total_length),
        secant_spring_constant=_secant(assembly, assembly.total_length),
        free_length=lengths,
        working=tuple(states),
        notes=_notes(assembly, model),
    )


def _secant(assembly: AssemblyCurve, length: Floats) -> Floats:
    """EA over a span about a length, cut off at the ends of the curve. [N]."""
    low = np.maximum((1 - _SPAN) * length, assembly.total_length[0])
    high = np.minimum((1 + _SPAN) * length, assembly.total_length[-1])
    rise = assembly.tension_at(high) - assembly.tension_at(low)
    return np.asarray(assembly.total_length[0] * rise / (high - low))


def _state(
    assembly: AssemblyCurve,
    tether: Tether,
    level: WorkingLevel,
    parts: Sequence[SeriesPart],
    tolerance: float,
    rated_break_strength: float,
) -> WorkingState:
    mean = _tension(assembly, level)
    point = working_point(
        assembly, mean, level.tension_amplitude, rated_break_strength=rated_break_strength
    )
    sharing = None
    if np.isfinite(tolerance):
        sharing = worst_sharing(
            tether,
            assembly.n_tethers,
            mean,
            free_length=tether.model.relaxed_length,
            tolerance=tolerance,
            parts=parts,
        )
    at = float(point.total_length)
    both, random, shared = assembly.uncertainty_at(at)
    return WorkingState(
        level=level,
        point=point,
        strain=np.array(
            [np.interp(at, assembly.total_length, row) for row in assembly.tether_strain]
        ),
        standard_uncertainty=both,
        random_standard_uncertainty=random,
        shared_standard_uncertainty=shared,
        secant_spring_constant=(
            float(point.apparent_spring_constant)
            if level.tension_amplitude
            else float(_secant(assembly, np.array(at)))
        ),
        is_moved=bool(assembly.is_moved[_node(assembly, at)]),
        sharing=sharing,
    )


def _node(assembly: AssemblyCurve, length: float) -> int:
    """The node at a length, or the next one above: flags are of the way to it."""
    place = int(np.searchsorted(assembly.total_length, length))
    return min(place, assembly.total_length.size - 1)


def _tension(assembly: AssemblyCurve, level: WorkingLevel) -> float:
    """Tension at a level; refused where the assembly is slack or its curve ends. [N]."""
    if level.quantity == "tension":
        return level.value
    axis = assembly.total_length if level.quantity == "total_length" else assembly.tether_strain[0]
    low, high = float(axis[0]), float(axis[-1])
    if not low < level.value <= high * (1 + 1e-12):
        unit = "m" if level.quantity == "total_length" else "of the free length"
        what = "slack" if level.value <= low else "beyond its curve"
        raise DataError(
            f"the assembly is {what} at this {level.quantity.replace('_', ' ')}",
            found=f"{level.value:.5g} {unit}",
            needed=f"above {low:.5g}, to {high:.5g} {unit}",
        )
    return float(np.interp(level.value, axis, assembly.tension))


def _notes(assembly: AssemblyCurve, model: StrainModel) -> tuple[str, ...]:
    notes = [
        "weight, buoyancy, bending and twist of the assembly are not in it; its bridles stay "
        "parallel",
        "the uncertainty is that of the curve, which all tethers share; that of the splices and "
        "of the lengths is not in it",
    ]
    high = float(assembly.tension[-1]) / assembly.n_tethers
    if model.method == "tension-driven" and high > model.tension_high:
        notes.append(
            f"the splices were marked up to {model.tension_high:.4g} N a tether; above that their "
            "law is extrapolated"
        )
    return tuple(notes)
