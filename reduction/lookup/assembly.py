r"""Tethers side by side, other parts in line: tension of a deployed assembly against its length.

All tethers have one length between the bridles; each has the tension of its own curve there, and
the length of every part in line follows from the tension:

.. math:: T = \sum_i F_i(p), \qquad p = p_i(F_i), \qquad
          L(T) = p(T) + \sum_j \ell_j\,(1 + \varepsilon_j(T))

Length is explicit in tension part by part, so that the curve is a table and nothing is iterated.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 2.3, Table 3.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError, SettingsError
from reduction.lookup.composite import CompositeCurve
from reduction.lookup.tethers import SeriesPart, Tether
from reduction.record import Bools, Floats, read_only_arrays
from reduction.strain.inverse import position_by_model
from reduction.uncertainty.combine import combined_standard_uncertainty
from reduction.uncertainty.join import stacked
from reduction.uncertainty.product import Component, Contributions

# nodes of tension beside those of the curve: denser near slack, where splices stretch fastest
_N_NODES = 400
_OF_CELL = ("tension_gain", "tension_offset")
_APART = 1e-9
"""Share of the range of lengths that two nodes are apart."""


@dataclass(frozen=True)
@read_only_arrays
class AssemblyCurve:
    """Tension of an assembly against its length; arrays have shape (n,), nodes of straight lines.

    Parameters
    ----------
    total_length, tension : ndarray
        End to end, both rising; the first is where the assembly goes slack, at zero. [m], [N]
    standard_uncertainty : ndarray
        Of the tension at one length: that of the curves, which all tethers share; both parts that
        follow, together. [N]
    random_standard_uncertainty : ndarray
        Of the curves by themselves. [N]
    component : tuple of Component, length n_components
        Errors that the curves share with others.
    contribution : ndarray, shape (n_components, n)
        What each of them adds to the tension at one length, signed. [N]
    tether_length : ndarray
        Thimble to thimble, one for all. [m]
    tether_tension : ndarray, shape (n_tethers, n)
        Zero where a tether is slack. [N]
    tether_strain : ndarray, shape (n_tethers, n)
        Of the free length. [1]
    slack_length : ndarray, shape (n_tethers,)
        Length of the assembly below which each tether is slack. [m]
    is_tested : ndarray of bool
        Every tether is at a strain that a piece of its curve reaches.
    is_join, is_moved : ndarray of bool
        A tether is where pieces of its curve hand over; where the rule of rising has moved it, so
        that its slope is that of the rule and of no piece.
    """

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
        """Of the tension by what is shared with others, all errors together. [N]."""
        return np.asarray(np.sqrt(np.sum(self.contribution**2, axis=0)))

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


def assemble(tethers: Sequence[Tether], parts: Sequence[SeriesPart] = ()) -> AssemblyCurve:
    """Tension of an assembly against its length.

    Parameters
    ----------
    tethers : sequence of Tether, length n_tethers
        Side by side between two bridles.
    parts : sequence of SeriesPart, optional
        In line with them.

    Returns
    -------
    assembly : AssemblyCurve
        To where the first tether, or part, is at the end of its curve.

    Raises
    ------
    SettingsError
        If there is no tether.
    DataError
        If a tether does not lengthen with tension, or is at its end before another one is taut.

    Notes
    -----
    Bridles stay parallel; weight, buoyancy, bending and the twist of the assembly are not in it
    ([1]_, sec. 2.3.2: a swivel has to turn, or the tethers do not share).  A part is straight at
    zero tension.  The splices stretch by the tension they carry, as in the test: the length is
    the inverse of the strain correction.  The uncertainty is that of the curve, which equal
    tethers share in full; curves that differ share what their tests do, by its sign, and are
    independent in the rest.  A load cell is taken as the one under which the splices were marked,
    unless they are stated: then tension at one length is wrong by as much as at one strain.  The
    splices' own, that of the tolerance of the lengths and of parts in line are not in it.

    Examples
    --------
    Two tethers of 100 N per unit strain, 1 m of rubber each, and 0.5 m of bridle:

    >>> from reduction.lookup.composite import composite_curve
    >>> from reduction.lookup.pieces import CurvePiece
    >>> from reduction.lookup.tethers import equal_tethers
    >>> from reduction.strain.model import StrainModel
    >>> at = np.linspace(0.1, 2.0, 20)
    >>> curve = composite_curve([CurvePiece("T", "static", "ascending", at, 100 * at, 0 * at)])
    >>> model = StrainModel("T", "gauge-length", {"reference_position": 1.0, "gauge_length": 1.0})
    >>> two = assemble(equal_tethers(Tether(curve, model), 2), [SeriesPart("bridle", 0.5)])
    >>> print(two.slack_length, two.tension_at([1.5, 2.5]).round(6))
    [1.5 1.5] [  0. 200.]
    """
    if not tethers:
        raise SettingsError("an assembly has tethers", found="none", needed="1 or more")
    own = [_lengths(one) for one in tethers]
    begin = min(one.length[0] for one in own)
    end = min(one.length[-1] for one in own)
    last = max(one.length[0] for one in own)
    if last >= end:
        raise DataError(
            "a tether is at the end of its curve before another one is taut",
            found=f"{end:.4g} m",
            needed=f"above {last:.4g} m",
            hint="Their lengths differ by more than their stretch.",
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
    # lengths of two tethers may differ by rounding alone: no slope stands between such nodes
    apart = _APART * (nodes[-1] - nodes[0])
    kept &= np.concatenate([[True], (np.diff(total) > apart) & (np.diff(nodes) > apart)])
    total, nodes, tension = total[kept], nodes[kept], tension[kept]
    # compliance in line takes its share of what the tension is wrong by at one length
    stiffness = np.gradient(tension, total) / np.gradient(tension, nodes)
    slack = np.interp([one.length[0] for one in own], nodes, total)
    random = spread[kept] * stiffness
    moved_by = shared.values["tension"].sum(axis=1)[:, kept] * stiffness
    return AssemblyCurve(
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
    """A tether on nodes of its tension; what is random and ``moved`` is of that at one length."""

    length: Floats
    tension: Floats
    strain: Floats
    random: Floats
    component: tuple[Component, ...]
    moved: Floats

    def at(self, length: Floats, values: Floats) -> Floats:
        """Values at lengths; zero where it is slack."""
        return np.interp(length, self.length, values, left=0.0)

    def shared_at(self, length: Floats) -> Contributions:
        """Contributions to ``tension`` at lengths."""
        rows = np.array([self.at(length, row) for row in self.moved])
        return Contributions(self.component, {"tension": rows.reshape(-1, length.size)})


def _random(tethers: Sequence[Tether], spread: Floats) -> Floats:
    """What is not shared with other curves: in full by tethers of one curve, else as squares."""
    curves = [id(one.curve) for one in tethers]
    of_curves = [
        spread[[own == curve for own in curves]].sum(axis=0) for curve in dict.fromkeys(curves)
    ]
    return np.asarray(np.sqrt(np.sum(np.square(of_curves), axis=0)))


def _lengths(tether: Tether) -> _Loaded:
    """Length, strain, and uncertainty of the tension at one length, on nodes of tension."""
    curve = tether.curve
    fine = curve.tension[-1] * np.linspace(0.0, 1.0, _N_NODES) ** 2
    force = np.union1d(curve.tension, fine)
    # nodes that rounding has put side by side
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
    # splices take their share of what the curve is wrong by at one length
    share = np.gradient(free, force) / np.gradient(length, force)
    random = np.interp(strain, curve.strain, curve.random_standard_uncertainty) * share
    # the load cell that read the marks is in the law of the splices too, and moves the whole length
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
