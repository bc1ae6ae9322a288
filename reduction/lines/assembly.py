r"""Deployed assemblies: tension against length, stiffness, load of each tether.

**Tension of a deployed assembly against its length, with tethers side by side and parts in line.**
All tethers have one length between the bridles; each has the tension of its own curve there, and
the length of every part in line follows from the tension:

.. math:: T = \sum_i F_i(p), \qquad p = p_i(F_i), \qquad
          L(T) = p(T) + \sum_j \ell_j\,(1 + \varepsilon_j(T))

Length is explicit in tension for each part, so the curve is a table and needs no iteration.

Working state of a deployed assembly: length and load of each tether on the curve, EA and stroke
from the tests that cover the cycle, and whether a tether goes slack.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 2.3.2; sec. 2.3, Table 3; sec. 2.3.2, 2.3.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.lines.composite import (
    CompositeCurve,
    MeasuredLoop,
    PieceSource,
    curve_of_piece,
    whole_pieces,
)
from reduction.lines.cycle_stiffness import (
    LEAST_COVER,
    CycleStiffness,
    LineLoop,
    LoadedTest,
    middle_of_cycle,
    stiffness_of_cycles,
)
from reduction.lines.line_lookup import cycle_loads
from reduction.record.arrays import as_positive
from reduction.record.contributions import (
    Component,
    Contributions,
    combined_standard_uncertainty,
    stacked,
)
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats, read_only_arrays
from reduction.stages.strain.strain_model import StrainModel, position_by_model, with_free_length


@dataclass(frozen=True)
class _Tether:
    """A tether with its splices."""

    curve: CompositeCurve
    model: StrainModel
    is_stated: bool = False


@dataclass(frozen=True)
class SeriesPart:
    """A part in line with the tethers.

    Parameters
    ----------
    name : str
        For example chain, bridle, swivel, wire.
    length : float
        Length without tension. [m]
    spring_constant : float
        EA, force per unit strain; infinite for a rigid part. [N]
    """

    name: str
    length: float
    spring_constant: float = float("inf")

    def __post_init__(self) -> None:
        """Refuse an invalid part."""
        if not self.length >= 0:
            raise SettingsError(
                f"{self.name} has no length", found=f"{self.length:g} m", needed="zero or above"
            )
        if not self.spring_constant > 0:
            raise SettingsError(
                f"the spring constant of {self.name} is not positive",
                found=f"{self.spring_constant:g} N",
                needed="above zero",
            )

    def length_at(self, tension: ArrayLike) -> Floats:
        """Length [m] at a tension [N]."""
        load = np.asarray(tension, dtype=np.float64)
        return np.asarray(self.length * (1 + load / self.spring_constant))


def _equal_tethers(tether: _Tether, n_tethers: int) -> tuple[_Tether, ...]:
    """Return identical tethers.

    Notes
    -----
    Assemblies of [1]_ have one, four and six tethers (sec. 2.3.2).

    Examples
    --------
    See `reduction.lines.assembly._assemble`.
    """
    return (tether,) * n_tethers


def _unequal_tethers(tether: _Tether, free_length: ArrayLike) -> tuple[_Tether, ...]:
    """Return tethers of one material and one kind of splice, cut to different lengths.

    Notes
    -----
    The shortest carries most; loads are equal only where lengths are.

    Examples
    --------
    See `reduction.lines.assembly._worst_sharing`.
    """
    lengths = np.atleast_1d(as_positive("free_length", free_length))
    return tuple(
        replace(tether, model=with_free_length(tether.model, float(length))) for length in lengths
    )


@dataclass(frozen=True)
class StatedSplices:
    """Splices of a tether, stated without a test.

    Parameters
    ----------
    length : float
        Relaxed length of both together; zero where there are none. [m]
    strain_ratio : float or None
        Strain of the splices over that of the free length. [1]
    strain, at_tension : float or None
        Strain of the splices at a tension; rigid where neither this nor a ratio is stated. [1], [N]
    exponent : float
        Exponent of the tension, with ``strain``. [1]
    """

    length: float
    strain_ratio: float | None = None
    strain: float | None = None
    at_tension: float | None = None
    exponent: float = 1.0

    def __post_init__(self) -> None:
        """Refuse invalid splices."""
        checks = (
            ("length", self.length, self.length >= 0, "zero or above"),
            ("strain_ratio", self.strain_ratio, (self.strain_ratio or 0.0) >= 0, "zero or above"),
            ("strain", self.strain, self.strain is None or self.strain > 0, "above zero"),
            (
                "at_tension",
                self.at_tension,
                self.at_tension is None or self.at_tension > 0,
                "above zero",
            ),
            ("exponent", self.exponent, 0 < self.exponent < 2, "above 0, below 2"),
        )
        for name, value, holds, needed in checks:
            if not holds:
                raise SettingsError(
                    f"{name} is not a number of a splice", found=f"{value:g}", needed=needed
                )


def stated_model(splices: StatedSplices, free_length: float, *, name: str) -> StrainModel:
    r"""Strain model of a tether with stated splices.

    .. math:: \ell_s(F) = \ell_{s0} (1 + \rho\,\varepsilon) \quad \text{or} \quad
       \ell_{s0} \Big(1 + \varepsilon_1 \big(F / F_1\big)^n\Big)

    Notes
    -----
    The two laws are those of the strain correction: the strain of a splice is a share of that of
    the rubber, or depends on its tension ([1]_ has the first one, from Table 3).

    Examples
    --------
    >>> from reduction.stages.strain.strain_model import position_by_model
    >>> splices = StatedSplices(1.2, strain=0.4, at_tension=900.0, exponent=0.85)
    >>> model = stated_model(splices, 2.5, name="T")
    >>> print(position_by_model(model, strain=1.0, tension=900.0).round(6))
    6.68
    """
    free = float(as_positive("free_length", free_length))
    if splices.length == 0:
        return StrainModel(name, "gauge-length", {"reference_position": free, "gauge_length": free})
    lengths = {"relaxed_free_length": free, "relaxed_splice_length": splices.length}
    if splices.strain is not None and splices.at_tension is not None:
        compliance = splices.strain / splices.at_tension**splices.exponent
        law = {"splice_compliance": compliance, "splice_exponent": splices.exponent}
        return StrainModel(name, "tension-driven", lengths | law)
    ratio = splices.strain_ratio or 0.0
    return StrainModel(name, "strain-ratio", lengths | {"splice_strain_ratio": ratio})


def _deployed_model(model: StrainModel, free_length: float | None) -> StrainModel:
    """Strain model of a deployed tether, from that of the tested one.

    Notes
    -----
    With a gauge length, the origin of the position may be arbitrary: for a tether without splices
    the length is set to the free length.  For the rest see
    `reduction.stages.strain.strain_model.with_free_length`; a third of a tether of [1]_, Table 3,
    is splices.

    Examples
    --------
    >>> model = StrainModel("T", "gauge-length", {"reference_position": 0.0, "gauge_length": 2.0})
    >>> _deployed_model(model, None).coefficients["reference_position"]
    2.0
    """
    if model.method == "extensometer":
        raise DataError(
            f"strain of '{model.specimen}' is from an extensometer, which does not include splices",
            needed="splices that are stated",
        )
    if model.method == "gauge-length":
        own = model.coefficients["gauge_length"]
        return stated_model(StatedSplices(0.0), free_length or own, name=model.specimen)
    return model if free_length is None else with_free_length(model, free_length)


# nodes of tension added to those of the curve: denser near slack, where splices stretch fastest
_N_NODES = 400

_OF_CELL = ("tension_gain", "tension_offset")

_APART = 1e-9
"""Least distance between two nodes, as a share of the range of lengths."""


@dataclass(frozen=True)
@read_only_arrays
class _AssemblyCurve:
    """Tension of an assembly against its length; arrays of shape (n,) hold values at nodes."""

    total_length: Floats
    tension: Floats
    standard_uncertainty: Floats
    random_standard_uncertainty: Floats
    component: tuple[Component, ...]
    contribution: Floats
    tether_length: Floats
    tether_tension: Floats
    tether_strain: Floats
    slack_length: Floats
    is_tested: Bools
    is_join: Bools
    is_moved: Bools

    @property
    def n_tethers(self) -> int:
        """Tethers side by side."""
        return int(self.tether_tension.shape[0])

    @property
    def shared_standard_uncertainty(self) -> Floats:
        """Uncertainty of the tension from errors shared with others, all together. [N]."""
        return np.asarray(np.sqrt(np.sum(self.contribution**2, axis=0)))

    @property
    def span_share(self) -> float:
        """Half span of the cycle whose EA is given at a node, as a share of its length. [1]."""
        longer = float(self.total_length[-1] / self.total_length[0]) - 1
        return min(_SPAN, longer / _LEAST_SPANS)

    def tension_at(self, total_length: ArrayLike) -> Floats:
        """Tension [N] at a length [m]; zero where it is slack, NaN beyond the curves."""
        at = np.asarray(total_length, dtype=np.float64)
        return np.interp(at, self.total_length, self.tension, right=np.nan)

    def length_at(self, tension: ArrayLike) -> Floats:
        """Length [m] at a tension [N]; NaN below zero and beyond the curves."""
        at = np.asarray(tension, dtype=np.float64)
        return np.interp(at, self.tension, self.total_length, left=np.nan, right=np.nan)

    def uncertainty_at(self, total_length: float) -> tuple[float, float, float]:
        """Standard uncertainty of the tension [N] at a length [m]: both parts, random, shared."""
        random, *rows = (
            float(np.interp(total_length, self.total_length, one))
            for one in (self.random_standard_uncertainty, *self.contribution)
        )
        return float(np.hypot(random, np.linalg.norm(rows))), random, float(np.linalg.norm(rows))

    def loads_at(self, tension: ArrayLike) -> Floats:
        """Load of each tether [N] at a tension of the assembly [N], shape (n_tethers, ...)."""
        at = np.asarray(tension, dtype=np.float64)
        rows = [
            np.interp(at, self.tension, row, left=np.nan, right=np.nan)
            for row in self.tether_tension
        ]
        return np.stack(rows)


def _assemble(tethers: Sequence[_Tether], parts: Sequence[SeriesPart] = ()) -> _AssemblyCurve:
    """Tension of an assembly against its length.

    Notes
    -----
    Bridles stay parallel; weight, buoyancy, bending and twist of the assembly are left out
    ([1]_, sec. 2.3.2: a swivel has to turn, or the tethers do not share).  A part is straight at
    zero tension.  The splices stretch with the tension that they carry, as in the test: the length
    is the inverse of the strain correction.  The uncertainty is that of the curve, which equal
    tethers share in full; different curves share the errors of their tests, with their sign, and
    are independent in the rest.  Splices that are not stated are assumed marked under the same load
    cell, whose error in tension is then the same at one length as at one strain.  The errors of the
    splices, of the tolerance of the lengths and of parts in line are left out.

    Examples
    --------
    Two tethers of 100 N per unit strain, 1 m of rubber each, and 0.5 m of bridle:

    >>> from reduction.lines.composite import _composite_curve
    >>> from reduction.lines.composite import CurvePiece
    >>> from reduction.lines.assembly import _equal_tethers
    >>> from reduction.stages.strain.strain_model import StrainModel
    >>> at = np.linspace(0.1, 2.0, 20)
    >>> curve = _composite_curve([CurvePiece("T", "static", "ascending", at, 100 * at, 0 * at)])
    >>> model = StrainModel("T", "gauge-length", {"reference_position": 1.0, "gauge_length": 1.0})
    >>> two = _assemble(_equal_tethers(_Tether(curve, model), 2), [SeriesPart("bridle", 0.5)])
    >>> print(two.slack_length, two.tension_at([1.5, 2.5]).round(6))
    [1.5 1.5] [  0. 200.]
    """
    own = [_lengths(one) for one in tethers]
    begin = min(one.length[0] for one in own)
    end = min(one.length[-1] for one in own)
    last = max(one.length[0] for one in own)
    if last >= end:
        raise DataError(
            "a tether is at the end of its curve before another one is taut",
            found=f"{end:.4g} m",
            needed=f"above {last:.4g} m",
            hint="Their lengths differ by more than they stretch.",
        )
    nodes = np.unique(np.concatenate([one.length for one in own]))
    nodes = nodes[(nodes >= begin) & (nodes <= end)]
    load = np.stack([one.at(nodes, one.tension) for one in own])
    stretch = np.stack([one.at(nodes, one.strain) for one in own])
    spread = _random(tethers, np.stack([one.at(nodes, one.random) for one in own]))
    shared = stacked([one.shared_at(nodes) for one in own])
    pairs = list(zip(tethers, stretch, strict=True))
    tested = ~np.any([_has(one.curve, one.curve.is_gap, row) for one, row in pairs], axis=0)
    joined = np.any([_has(one.curve, one.curve.is_join, row) for one, row in pairs], axis=0)
    moved = np.any([_has(one.curve, one.curve.is_moved, row) for one, row in pairs], axis=0)
    tension = load.sum(axis=0)
    rises = np.concatenate([[True], np.diff(tension) > 0])
    more = np.sum([part.length_at(tension) for part in parts], axis=0) if parts else 0.0
    total = nodes + more
    kept = rises & np.isfinite(total)
    # lengths of two tethers may differ by rounding only: such nodes give no slope
    apart = _APART * (nodes[-1] - nodes[0])
    kept &= np.concatenate([[True], (np.diff(total) > apart) & (np.diff(nodes) > apart)])
    total, nodes, tension = total[kept], nodes[kept], tension[kept]
    # compliance in line reduces the error of the tension at one length
    stiffness = np.gradient(tension, total) / np.gradient(tension, nodes)
    slack = np.interp([one.length[0] for one in own], nodes, total)
    random = spread[kept] * stiffness
    moved_by = shared.values["tension"].sum(axis=1)[:, kept] * stiffness
    return _AssemblyCurve(
        total_length=total,
        tension=tension,
        standard_uncertainty=combined_standard_uncertainty(moved_by, random),
        random_standard_uncertainty=random,
        component=shared.component,
        contribution=moved_by,
        tether_length=nodes,
        tether_tension=load[:, kept],
        tether_strain=stretch[:, kept],
        slack_length=slack,
        is_tested=tested[kept],
        is_join=joined[kept],
        is_moved=moved[kept],
    )


@dataclass(frozen=True)
class _Loaded:
    """A tether on nodes of its tension; random part and ``moved`` are at constant length."""

    length: Floats
    tension: Floats
    strain: Floats
    random: Floats
    component: tuple[Component, ...]
    moved: Floats

    def at(self, length: Floats, values: Floats) -> Floats:
        """Values at lengths; zero where the tether is slack."""
        return np.interp(length, self.length, values, left=0.0)

    def shared_at(self, length: Floats) -> Contributions:
        """Contributions to ``tension`` at lengths."""
        rows = np.array([self.at(length, row) for row in self.moved])
        return Contributions(self.component, {"tension": rows.reshape(-1, length.size)})


def _random(tethers: Sequence[_Tether], spread: Floats) -> Floats:
    """Part not shared with other curves: added in full for tethers of one curve, else squared."""
    curves = [id(one.curve) for one in tethers]
    of_curves = [
        spread[[own == curve for own in curves]].sum(axis=0) for curve in dict.fromkeys(curves)
    ]
    return np.asarray(np.sqrt(np.sum(np.square(of_curves), axis=0)))


def _lengths(tether: _Tether) -> _Loaded:
    """Length, strain, and uncertainty of the tension at one length, on nodes of tension."""
    curve = tether.curve
    fine = curve.tension[-1] * np.linspace(0.0, 1.0, _N_NODES) ** 2
    force = np.union1d(curve.tension, fine)
    # merge nodes that differ by rounding only
    force = force[np.concatenate([[True], np.diff(force) > 1e-12 * force[-1]])]
    strain = curve.strain_at(force)
    length = position_by_model(tether.model, strain=strain, tension=force)
    if (np.diff(length) <= 0).any():
        raise DataError(
            f"a tether by the strain model of '{tether.model.specimen}' does not lengthen "
            "with tension",
            found=f"{length[0]:.4g} to {length[-1]:.4g} m",
            needed="a length that rises",
        )
    free = position_by_model(tether.model, strain=strain, tension=np.zeros(force.size))
    # splices reduce the error of the curve at one length
    share = np.gradient(free, force) / np.gradient(length, force)
    random = np.interp(strain, curve.strain, curve.random_standard_uncertainty) * share
    # the load cell with which the marks were read is in the law of the splices too: its error
    # moves the whole length
    is_whole = [not tether.is_stated and one.source in _OF_CELL for one in curve.component]
    rows = [
        np.interp(strain, curve.strain, row) * (1.0 if whole else share)
        for whole, row in zip(is_whole, curve.contribution, strict=True)
    ]
    return _Loaded(length, force, strain, random, curve.component, np.array(rows))


def _has(curve: CompositeCurve, flags: Bools, strain: Floats) -> Bools:
    """Whether a strain is in an interval with a flag."""
    place = np.searchsorted(curve.strain, strain, side="left") - 1
    return flags[np.clip(place, 0, flags.size - 1)]


@dataclass(frozen=True)
@read_only_arrays
class _WorkingPoint:
    """An assembly under a cycle of tension; arrays have the shape (...) of the points."""

    mean_tension: Floats
    peak_tension: Floats
    minimum_tension: Floats
    total_length: Floats
    tether_tension: Floats
    peak_tether_tension: Floats
    minimum_tether_tension: Floats
    load_share: Floats
    peak_share: Floats
    minimum_share: Floats
    is_tested: Bools


def _working_point(
    assembly: _AssemblyCurve,
    mean_tension: ArrayLike,
    tension_amplitude: ArrayLike = 0.0,
    *,
    rated_break_strength: float = float("nan"),
) -> _WorkingPoint:
    """Length and loads of an assembly under cycles of tension.

    Notes
    -----
    [1]_, sec. 2.3.2: a tether must not go slack, since it may then tangle and be cut.  The longest
    goes slack first, while the assembly is still taut.

    Examples
    --------
    One tether of 100 N per unit strain, 1 m long, between 60 and 140 N:

    >>> from reduction.lines.composite import _composite_curve
    >>> from reduction.lines.composite import CurvePiece
    >>> from reduction.stages.strain.strain_model import StrainModel
    >>> at = np.linspace(0.1, 2.0, 20)
    >>> curve = _composite_curve([CurvePiece("T", "static", "ascending", at, 100 * at, 0 * at)])
    >>> model = StrainModel("T", "gauge-length", {"reference_position": 1.0, "gauge_length": 1.0})
    >>> point = _working_point(_assemble([_Tether(curve, model)]), 100.0, 40.0)
    >>> print(point.total_length.round(6), point.peak_tether_tension.round(6))
    2.0 [140.]
    """
    cycle = cycle_loads(mean_tension, tension_amplitude, rated_break_strength=float("nan"))
    peak, least = cycle.peak_tension, cycle.minimum_tension
    mean = (peak + least) / 2
    if np.any(peak > assembly.tension[-1]):
        raise DataError(
            "the peak tension is beyond the curves of the assembly",
            found=f"{np.max(peak):.4g} N",
            needed=f"at most {assembly.tension[-1]:.4g} N",
        )
    loads, of_peak, of_least = (assembly.loads_at(one) for one in (mean, peak, least))
    slack = np.argwhere(of_least <= 0)
    if slack.size:
        which = tuple(slack[0])
        raise DataError(
            f"tether {which[0] + 1} of {assembly.n_tethers} goes slack",
            found=f"{least[which[1:]]:.4g} N on the assembly at the least",
            needed=f"above {_tension_at_slack(assembly):.4g} N",
            hint="A slack tether tangles and is cut: choose more stretch, less amplitude, or equal"
            " lengths.",
        )
    low, high = (np.searchsorted(assembly.tension, one) for one in (least, peak))
    n_untested = np.concatenate([[0], np.cumsum(~assembly.is_tested)])
    return _WorkingPoint(
        mean_tension=mean,
        peak_tension=peak,
        minimum_tension=least,
        total_length=assembly.length_at(mean),
        tether_tension=loads,
        peak_tether_tension=of_peak,
        minimum_tether_tension=of_least,
        load_share=loads / mean,
        peak_share=of_peak / rated_break_strength,
        minimum_share=of_least / rated_break_strength,
        is_tested=n_untested[high + 1] == n_untested[low],
    )


def _tension_at_slack(assembly: _AssemblyCurve) -> float:
    """Tension of the assembly at which its longest tether goes slack."""
    longest = assembly.slack_length.max()
    return float(np.interp(longest, assembly.total_length, assembly.tension))


@dataclass(frozen=True)
@read_only_arrays
class _LoadSharing:
    """Worst loads of one tether over a tolerance of lengths; arrays have the shape (...)."""

    tension: Floats
    greatest_load: Floats
    least_load: Floats
    tension_at_slack: float


def _worst_sharing(
    tether: _Tether,
    n_tethers: int,
    tension: ArrayLike,
    *,
    free_length: float,
    tolerance: float,
    parts: Sequence[SeriesPart] = (),
) -> _LoadSharing:
    """Greatest and least load of a tether in an assembly whose lengths have a tolerance.

    Notes
    -----
    The load of a tether falls with its own length and rises with that of every other one, so the
    worst case is at a corner: one short and all others long, or vice versa.  [1]_, sec. 2.3.2,
    2.3.3 has no tolerance; it says that an assembly that twists does not share (sec. 2.3.2).

    Examples
    --------
    Springs of 100 N per unit strain, 1 m within 1 %, at 100 N each:

    >>> from reduction.lines.composite import _composite_curve
    >>> from reduction.lines.composite import CurvePiece
    >>> from reduction.stages.strain.strain_model import StrainModel
    >>> at = np.linspace(0.1, 2.0, 20)
    >>> curve = _composite_curve([CurvePiece("T", "static", "ascending", at, 100 * at, 0 * at)])
    >>> model = StrainModel("T", "gauge-length", {"reference_position": 1.0, "gauge_length": 1.0})
    >>> found = _worst_sharing(_Tether(curve, model), 2, 200.0, free_length=1.0, tolerance=0.01)
    >>> print(found.greatest_load.round(2), found.least_load.round(2))
    102.0 98.0
    """
    load = np.asarray(tension, dtype=np.float64)
    if not np.all(load > 0):
        raise DataError(
            "an assembly without tension shares no load",
            found=f"{np.min(load):.4g} N",
            needed="above zero",
        )
    rows = []
    for sign in (-1.0, 1.0):
        lengths = np.full(n_tethers, free_length * (1 - sign * tolerance))
        lengths[0] = free_length * (1 + sign * tolerance)
        assembly = _assemble(_unequal_tethers(tether, lengths), parts)
        if np.any(load > assembly.tension[-1]):
            raise DataError(
                "the tension is beyond the curves of the assembly",
                found=f"{np.max(load):.4g} N",
                needed=f"at most {assembly.tension[-1]:.4g} N",
            )
        rows.append(assembly.loads_at(load)[0])
    return _LoadSharing(load, rows[0], rows[1], _tension_at_slack(assembly))


_SPAN, _LEAST_SPANS = 0.05, 10
"""Half width of a secant, as a share of the length, where no amplitude is stated, and the least
number of such spans in a curve: a rope breaks before it is 20 % longer."""


@dataclass(frozen=True)
class WorkingLevel:
    """State of an assembly: a tension [N], a total length [m], or a strain of its tethers [1].

    ``tension_amplitude`` is half the range about it. [N]
    """

    quantity: Literal["tension", "total_length", "strain"]
    value: float
    tension_amplitude: float = 0.0


@dataclass(frozen=True)
class _StiffnessOfTest:
    """Stiffness over a cycle from one test.

    Parameters
    ----------
    words : str
        Test, and part of it.
    low, high : float
        Loads of the assembly between which it was tested. [N]
    covered : float
        Share of the cycle between these loads. [1]
    spring_constant, standard_uncertainty : float
        EA over the loads common to all tests used; NaN where the test is not used. [N]
    has_loop : bool
        Whether ``low`` and ``high`` are the turns of its cycles.
    """

    words: str
    low: float
    high: float
    covered: float
    spring_constant: float
    standard_uncertainty: float
    has_loop: bool


@dataclass(frozen=True)
@read_only_arrays
class WorkingState:
    """An assembly at one working level.

    Mean length and loads are from the curve, EA and stroke from the tests.

    Parameters
    ----------
    level : WorkingLevel
        Requested level.
    point : _WorkingPoint
        Point on the curve.
    strain : ndarray, shape (n_tethers,)
        Strain of the free length of each tether. [1]
    standard_uncertainty, random_standard_uncertainty, shared_standard_uncertainty : float
        Of the tension at this length: both parts together, the part of the curve alone, and the
        part that its tests share with others. [N]
    low, high : float
        Ends of the requested cycle, or without an amplitude those of the span about it. [N]
    secant_spring_constant, least_spring_constant, greatest_spring_constant : float
        EA over the cycle, and the ends of its interval; NaN where no test covers it. [N]
    stiffness : float
        EA over the length at which the assembly goes slack. [N m-1]
    peak_length, minimum_length : float
        Middle of the cycle plus and minus half the stroke; NaN where EA is. [m]
    common_low, common_high : float
        Loads common to the tests that cover the cycle. [N]
    curve_spring_constant : float
        EA between these loads of the curve, which joins tests. [N]
    tests : tuple of _StiffnessOfTest
        One for each piece of the curve.
    nearest : str
        Test used that is nearest in mean and amplitude; empty without one.
    doubt : str
        Why the curve is in doubt at the requested level; else empty.
    note : str
        Doubt about its slope where no cycle was requested.
    sharing : _LoadSharing or None
        Given where the lengths have a tolerance.
    """

    level: WorkingLevel
    point: _WorkingPoint
    strain: Floats
    standard_uncertainty: float
    random_standard_uncertainty: float
    shared_standard_uncertainty: float
    low: float
    high: float
    secant_spring_constant: float
    least_spring_constant: float
    greatest_spring_constant: float
    stiffness: float
    peak_length: float
    minimum_length: float
    common_low: float
    common_high: float
    curve_spring_constant: float
    tests: tuple[_StiffnessOfTest, ...]
    nearest: str
    doubt: str
    note: str
    sharing: _LoadSharing | None

    @property
    def used(self) -> tuple[_StiffnessOfTest, ...]:
        """Tests whose EA is used."""
        return tuple(one for one in self.tests if np.isfinite(one.spring_constant))


@dataclass(frozen=True)
@read_only_arrays
class _DeployedAssembly:
    """An assembly and its working states; arrays hold values at the nodes of its curve, shape (n,).

    ``stiffness`` is for cycles of the span about a node: 5 % of the length to each side, or a tenth
    of the stretch of the curve.  ``tests`` are its sources.
    """

    assembly: _AssemblyCurve
    strain: Floats
    stiffness: CycleStiffness
    tests: tuple[LoadedTest, ...]
    free_length: tuple[float, ...]
    working: tuple[WorkingState, ...]
    notes: tuple[str, ...]

    @property
    def nearest_test(self) -> tuple[str, ...]:
        """Test with the nearest EA at each node; empty where none covers the cycle."""
        return tuple(
            self.tests[place].words if place >= 0 else "" for place in self.stiffness.nearest
        )


@dataclass(frozen=True)
class DeployedLine:
    """An assembly and its constituents.

    ``splices`` describes the law of the tether length, in words.
    """

    name: str
    deployed: _DeployedAssembly
    source: PieceSource
    curve: CompositeCurve
    splices: str
    parts: tuple[SeriesPart, ...] = ()

    @property
    def is_equal(self) -> bool:
        """Whether all tethers carry the same load."""
        return bool(np.ptp(self.deployed.assembly.slack_length) == 0)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Why the curve is in doubt inside the requested cycles; without any level, anywhere."""
        named = enumerate(self.deployed.working, start=1)
        found = tuple(f"working.{number}: {state.doubt}" for number, state in named if state.doubt)
        if self.deployed.working or not self.curve.doubt:
            return found
        return (self.curve.doubt,)

    @property
    def notes(self) -> tuple[str, ...]:
        """Other remarks, those of the levels first."""
        named = enumerate(self.deployed.working, start=1)
        found = [f"working.{number}: {state.note}" for number, state in named if state.note]
        if self.curve.doubt and not any(self.curve.doubt in one for one in self.doubts):
            found.append(f"elsewhere DOUBTFUL: {self.curve.doubt}")
        return (*found, *self.deployed.notes, *self.curve.notes, *self.source.notes)

    @property
    def words(self) -> str:
        """Description of the assembly."""
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
    loops: Sequence[MeasuredLoop] = (),
) -> _DeployedAssembly:
    """Put tethers side by side and parts in line, and find the working states.

    ``loops`` are those of the cyclic tests whose stiffness may be used.
    """
    first = free_lengths[0] if free_lengths else None
    tether = _Tether(curve, _deployed_model(model, first), is_stated=has_stated_splices)
    alike = len(set(free_lengths)) < 2
    tethers = _equal_tethers(tether, n_tethers) if alike else _unequal_tethers(tether, free_lengths)
    assembly = _up_to_turns(_assemble(tethers, parts), tethers, parts, loops)
    slack = float(assembly.total_length[0])
    lengths = tuple(one.model.relaxed_length for one in tethers)
    tests = _loaded_tests(tethers, parts, loops)
    states = []
    for number, level in enumerate(levels, start=1):
        try:
            states.append(
                _state(assembly, tests, tether, level, parts, tolerance, rated_break_strength)
            )
        except DataError as error:
            raise DataError(
                f"working.{number}: {error.problem}", found=error.found, needed=error.needed,
                hint=error.hint,
            ) from error  # fmt: skip
    return _DeployedAssembly(
        assembly=assembly,
        strain=assembly.total_length / slack - 1,
        stiffness=stiffness_of_cycles(
            tests, *_span_loads(assembly, assembly.total_length), slack_length=slack
        ),
        tests=tests,
        free_length=lengths,
        working=tuple(states),
        notes=_notes(assembly, model),
    )


_SET_WITHIN = 0.02
"""Share within which a machine reaches a load, and a cycle is the one that was tested. [1]"""


def _up_to_turns(
    assembly: _AssemblyCurve,
    tethers: Sequence[_Tether],
    parts: Sequence[SeriesPart],
    loops: Sequence[MeasuredLoop],
) -> _AssemblyCurve:
    """The curve up to the turns of its cycles, within which their branches end.

    What is between the turns was tested, also in a hole of the branches.  Beyond the last branch
    the curve goes straight on to the upper turn, as an exported curve does, and further by the
    share within which a machine reaches a load, so that the cycle that was tested can be asked for.
    """
    of_branches = {piece.words: piece for piece in whole_pieces(tethers[0].curve.pieces)}
    known = [one for one in loops if one.words in of_branches]
    strain, last = assembly.tether_strain[0, -1], assembly.tether_tension[:, -1]
    if not known or np.ptp(last) > _APART * last[0]:
        return assembly  # unequal tethers reach the ends of their curves at different lengths
    at, load = assembly.tether_strain[0], assembly.tether_tension[0]
    reached = np.zeros(load.size, dtype=bool)
    for loop in known:
        low, high = loop.tension * (1 - _SET_WITHIN, 1 + _SET_WITHIN)
        own = of_branches[loop.words]
        reached |= (own.strain[0] <= at) & (at <= own.strain[-1])
        reached |= (low <= load) & (load <= own.tension[0])
        reached |= (own.tension[-1] <= load) & (load <= high)
    # a flag is that of the interval before a node
    reached[1:] |= reached[:-1]
    assembly = replace(assembly, is_tested=assembly.is_tested | reached)
    highest = max(known, key=lambda one: float(one.tension[1]))
    rise = np.array([highest.tension[1] - last[0], highest.strain[1] - strain])
    if (rise <= 0).any():
        return assembly
    share = 1 + _SET_WITHIN * float(highest.tension[1]) / rise[0]
    pulled, stretch = np.array([last[0], strain]) + share * rise
    length = float(position_by_model(tethers[0].model, strain=stretch, tension=pulled))
    tension = last.size * pulled
    added: dict[str, Any] = {
        "total_length": length + sum(float(part.length_at(tension)) for part in parts),
        "tension": tension,
        "tether_length": length,
        "tether_tension": pulled,
        "tether_strain": stretch,
        "is_tested": True,
        "is_join": False,
        "is_moved": False,
        "standard_uncertainty": assembly.standard_uncertainty[-1],
        "random_standard_uncertainty": assembly.random_standard_uncertainty[-1],
        "contribution": assembly.contribution[:, -1:],
    }
    nodes: dict[str, Any] = {
        name: _with_node(getattr(assembly, name), new) for name, new in added.items()
    }
    return replace(assembly, **nodes)


def _with_node(values: Floats, new: ArrayLike) -> Floats:
    """Values with those of one more node at the end."""
    node = np.broadcast_to(np.asarray(new, dtype=values.dtype), values[..., -1:].shape)
    return np.concatenate([values, node], axis=-1)


def _loaded_tests(
    tethers: Sequence[_Tether], parts: Sequence[SeriesPart], loops: Sequence[MeasuredLoop]
) -> tuple[LoadedTest, ...]:
    """The assembly for each test alone, over the loads of that test.

    Notes
    -----
    A test is left out where tethers are so unequal that no length keeps all of them in its range.
    Cycles without a curve (of a rope without a diameter) are a straight line from turn to turn.
    """
    of_lines = {one.words: _loop_of_line(tethers, parts, one) for one in loops}
    drawn = {piece.words for piece in tethers[0].curve.pieces}
    found = [
        _straight_test(one, of_lines[one.words])
        for one in loops
        if one.words not in drawn and of_lines[one.words].stroke > 0
    ]
    for piece in whole_pieces(tethers[0].curve.pieces):
        own = curve_of_piece(piece)
        try:
            assembly = _assemble([replace(one, curve=own) for one in tethers], parts)
        except DataError:
            continue
        first = piece.strain[0] * (1 - _APART)
        inside = np.flatnonzero((assembly.tether_strain >= first).all(axis=0))
        if inside.size < 2:
            continue
        found.append(
            LoadedTest(
                words=piece.words,
                kind=piece.kind,
                length=assembly.total_length[inside],
                tension=assembly.tension[inside],
                random_standard_uncertainty=assembly.random_standard_uncertainty[inside],
                contribution=assembly.contribution[:, inside],
                low=float(assembly.tension[inside[0]]),
                high=float(assembly.tension[-1]),
                loop=of_lines.get(piece.words),
            )
        )
    return tuple(found)


def _loop_of_line(
    tethers: Sequence[_Tether], parts: Sequence[SeriesPart], loop: MeasuredLoop
) -> LineLoop:
    """Loop of the assembly where its tethers have the loop of a test.

    Parts in line are springs: they lengthen the stroke, and at one length of the assembly the loop
    is narrower by their share in its compliance.
    """
    load = len(tethers) * loop.tension
    own = np.mean(
        [position_by_model(one.model, strain=loop.strain, tension=loop.tension) for one in tethers],
        axis=0,
    )
    more = np.sum([part.length_at(load) for part in parts], axis=0) if parts else np.zeros(2)
    stroke, stretch = float(own[1] - own[0]), float(more[1] - more[0])
    rise, width = float(load[1] - load[0]), len(tethers) * loop.width
    # stiffness of the tethers within the branches, and compliance of the parts
    narrower = 1 + (rise - width[-1]) / stroke * stretch / rise
    return LineLoop(
        low=float(load[0]),
        high=float(load[1]),
        begin=float(own[0] + more[0]),
        stroke=stroke + stretch,
        distance=loop.distance * (stroke + stretch) / float(loop.strain[1] - loop.strain[0]),
        width=width / narrower,
        relative_uncertainty=loop.relative_uncertainty,
    )


def _straight_test(loop: MeasuredLoop, of_line: LineLoop) -> LoadedTest:
    """Cycles of which the archive has no curve: straight branches within their turns."""
    rise = of_line.high - of_line.low
    # turns are off the middle of the branches by half the width of the loop
    length = of_line.stroke * rise / (rise - float(of_line.width[-1]))
    error = loop.relative_uncertainty * rise / np.sqrt(2)
    return LoadedTest(
        words=loop.words,
        kind="cyclic",
        length=np.array([0.0, length]),
        tension=np.array([of_line.low, of_line.high]),
        random_standard_uncertainty=np.full(2, error),
        contribution=np.empty((0, 2)),
        low=of_line.low,
        high=of_line.high,
        loop=of_line,
    )


def _span_loads(assembly: _AssemblyCurve, length: Floats) -> tuple[Floats, Floats]:
    """Tensions at the ends of a span about a length, limited to the ends of the curve. [N]."""
    low = np.maximum((1 - assembly.span_share) * length, assembly.total_length[0])
    high = np.minimum((1 + assembly.span_share) * length, assembly.total_length[-1])
    return assembly.tension_at(low), assembly.tension_at(high)


def _state(
    assembly: _AssemblyCurve,
    tests: Sequence[LoadedTest],
    tether: _Tether,
    level: WorkingLevel,
    parts: Sequence[SeriesPart],
    tolerance: float,
    rated_break_strength: float,
) -> WorkingState:
    mean = _tension(assembly, level)
    point = _working_point(
        assembly, mean, level.tension_amplitude, rated_break_strength=rated_break_strength
    )
    sharing = None
    if np.isfinite(tolerance):
        sharing = _worst_sharing(
            tether,
            assembly.n_tethers,
            mean,
            free_length=tether.model.relaxed_length,
            tolerance=tolerance,
            parts=parts,
        )
    at, slack = float(point.total_length), float(assembly.total_length[0])
    both, random, shared = assembly.uncertainty_at(at)
    has_cycle = level.tension_amplitude > 0
    low, high = (
        (float(point.minimum_tension), float(point.peak_tension))
        if has_cycle
        else (float(one) for one in _span_loads(assembly, np.array(at)))
    )
    found = stiffness_of_cycles(tests, low, high, slack_length=slack)
    said = tuple(
        _StiffnessOfTest(
            one.words, *one.cycle, float(found.covered[place, 0]),
            float(found.test_spring_constant[place, 0]),
            float(found.test_standard_uncertainty[place, 0]), one.loop is not None,
        )
        for place, one in enumerate(tests)
    )  # fmt: skip
    value, least, greatest, common_low, common_high = (
        float(one[0])
        for one in (found.spring_constant, found.least, found.greatest, found.low, found.high)
    )
    joined = _curve_spring_constant(assembly, common_low, common_high)
    half = slack * level.tension_amplitude / value
    nearest = int(found.nearest[0])
    middle = at + (middle_of_cycle(tests[nearest], low, high) if nearest >= 0 else 0.0)
    pieces = [piece.words for piece in tether.curve.pieces]
    of_slope = _doubts_of_slope(
        said, joined, float(found.curve_least[0]), float(found.curve_greatest[0]), pieces
    )
    if nearest >= 0 and tests[nearest].words not in pieces:
        of_slope += _off_the_curve(assembly, tests[nearest])
    of_mean = [tether.curve.doubt] if _is_far(assembly, tether.curve, low, high) else []
    if has_cycle:
        gap = [] if point.is_tested else ["no test reaches a part of the cycle"]
        doubts, notes = [*gap, *of_slope, *of_mean], []
    else:
        doubts, notes = of_mean, of_slope
    return WorkingState(
        level=level,
        point=point,
        strain=np.array(
            [np.interp(at, assembly.total_length, row) for row in assembly.tether_strain]
        ),
        standard_uncertainty=both,
        random_standard_uncertainty=random,
        shared_standard_uncertainty=shared,
        low=low,
        high=high,
        secant_spring_constant=value,
        least_spring_constant=least,
        greatest_spring_constant=greatest,
        stiffness=value / slack,
        peak_length=middle + half,
        minimum_length=middle - half,
        common_low=common_low,
        common_high=common_high,
        curve_spring_constant=joined,
        tests=said,
        nearest=tests[nearest].words if nearest >= 0 else "",
        doubt="; ".join(doubts),
        note="; ".join(notes),
        sharing=sharing,
    )


def _is_far(assembly: _AssemblyCurve, curve: CompositeCurve, low: float, high: float) -> bool:
    """Whether the curve is in doubt at a strain that a tether reaches between two tensions."""
    ends = [np.interp((low, high), assembly.tension, row) for row in assembly.tether_strain]
    return any(
        bool(curve.is_doubtful[(curve.strain >= first) & (curve.strain <= last)].any())
        for first, last in ends
    )


def _curve_spring_constant(assembly: _AssemblyCurve, low: float, high: float) -> float:
    """EA of the curve between two loads; NaN where there are none. [N]."""
    short, long = assembly.length_at([low, high])
    return float(assembly.total_length[0] * (high - low) / (long - short))


_NEAREST_NAMED = 3

_FAR = 2.0
"""Distance from a curve that is more than its uncertainty, in standard uncertainties."""

_LITTLE = 0.1
"""Share of an EA by which new lines of one kind differ (CG-D-39-80, sec. 4.4.1)."""


def _doubts_of_slope(
    tests: Sequence[_StiffnessOfTest],
    joined: float,
    least: float,
    greatest: float,
    pieces: Sequence[str],
) -> list[str]:
    """Why EA of a cycle is unknown, or why EA of the curve differs from that of the tests."""
    if not np.isfinite(least):
        nearest = sorted(tests, key=lambda one: -one.covered)[:_NEAREST_NAMED]
        names = ", ".join(
            f"{one.words} {100 * one.covered:.0f} %" for one in nearest if one.covered > 0
        )
        return [
            f"no test covers {100 * LEAST_COVER:.0f} % of the cycle, so EA is unknown: "
            + (f"nearest are {names}" if names else "no test reaches it")
        ]
    if (1 - _LITTLE) * least <= joined <= (1 + _LITTLE) * greatest:
        return []
    used = [one.words for one in tests if np.isfinite(one.spring_constant)]
    nearer = least if joined < least else greatest
    why = (
        "the curve joins tests in different states"
        if set(used) <= set(pieces)
        else f"the curve is of {' and '.join(pieces)}"
    )
    return [
        f"over the loads of {' and '.join(used)} the slope of the curve is {joined / nearer:.3g} of"
        f" the {'lowest' if joined < least else 'highest'} EA of the tests, because {why}: use its"
        " tension, not its slope"
    ]


def _off_the_curve(assembly: _AssemblyCurve, test: LoadedTest) -> list[str]:
    """Where cycles that are no part of the curve lie beside it, at their mean tension."""
    if test.loop is None:
        return []
    tension = (test.loop.low + test.loop.high) / 2
    cycles, at = test.loop.begin + test.loop.stroke / 2, float(assembly.length_at(tension))
    error = assembly.uncertainty_at(at)[0]
    # a line that was not tested to this tension has no length there
    if not abs(float(assembly.tension_at(cycles)) - tension) > _FAR * error:
        return []
    return [
        f"at their mean tension of {tension:.4g} N {test.words} had {cycles:.5g} m, and the curve"
        f" has {at:.5g} m"
    ]


def _tension(assembly: _AssemblyCurve, level: WorkingLevel) -> float:
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


def _notes(assembly: _AssemblyCurve, model: StrainModel) -> tuple[str, ...]:
    notes = [
        "not included: weight, buoyancy, bending and twist of the assembly; its bridles stay"
        " parallel",
        "the uncertainty is that of the curve, common to all tethers; that of splices and lengths"
        " is not included",
    ]
    high = float(assembly.tension[-1]) / assembly.n_tethers
    if model.method == "tension-driven" and high > model.tension_high:
        notes.append(
            f"the splices were marked up to {model.tension_high:.4g} N per tether; above that"
            " their law is extrapolated"
        )
    return tuple(notes)
