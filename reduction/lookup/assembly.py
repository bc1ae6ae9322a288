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

from reduction.checks import as_positive
from reduction.errors import DataError, SettingsError
from reduction.lookup.composite import CompositeCurve
from reduction.record import Bools, Floats, freeze_arrays
from reduction.strain.inverse import position_by_model, with_free_length
from reduction.strain.model import StrainModel

__all__ = ["AssemblyCurve", "SeriesPart", "Tether", "assemble", "equal_tethers", "unequal_tethers"]

# nodes of tension beside those of the curve: denser near slack, where splices stretch fastest
_N_NODES = 400
_APART = 1e-9
"""Share of the range of lengths that two nodes are apart."""


@dataclass(frozen=True)
class Tether:
    """A tether with its splices.

    Parameters
    ----------
    curve : CompositeCurve
        Tension against strain of the free length. [SI]
    model : StrainModel
        How strain and tension give its length, thimble to thimble: the strain correction.
    """

    curve: CompositeCurve
    model: StrainModel


@dataclass(frozen=True)
class SeriesPart:
    """A part in line with the tethers.

    Parameters
    ----------
    name : str
        Chain, bridle, swivel, wire ...
    length : float
        Without tension. [m]
    spring_constant : float
        EA, force per unit strain; infinite where it is rigid. [N]
    curve : CompositeCurve or None
        In place of a spring constant.
    """

    name: str
    length: float
    spring_constant: float = float("inf")
    curve: CompositeCurve | None = None

    def __post_init__(self) -> None:
        """Refuse a part that is no part."""
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
        """Length [m] at a tension [N]; NaN beyond a curve."""
        load = np.asarray(tension, dtype=np.float64)
        if self.curve is not None:
            return np.asarray(self.length * (1 + self.curve.strain_at(load)))
        return np.asarray(self.length * (1 + load / self.spring_constant))


@dataclass(frozen=True)
class AssemblyCurve:
    """Tension of an assembly against its length; arrays have shape (n,), nodes of straight lines.

    Parameters
    ----------
    total_length, tension : ndarray
        End to end, both rising; the first is where the assembly goes slack, at zero. [m], [N]
    standard_uncertainty : ndarray
        Of the tension at one length: that of the curves, which all tethers share. [N]
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
    tether_length: Floats
    tether_tension: Floats
    tether_strain: Floats
    slack_length: Floats
    is_tested: Bools
    is_join: Bools
    is_moved: Bools

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)

    @property
    def n_tethers(self) -> int:
        """Tethers side by side."""
        return int(self.tether_tension.shape[0])

    def tension_at(self, total_length: ArrayLike) -> Floats:
        """Tension [N] at a length [m]; zero where it is slack, NaN beyond the curves."""
        at = np.asarray(total_length, dtype=np.float64)
        return np.interp(at, self.total_length, self.tension, right=np.nan)

    def length_at(self, tension: ArrayLike) -> Floats:
        """Length [m] at a tension [N]; NaN below zero and beyond the curves."""
        at = np.asarray(tension, dtype=np.float64)
        return np.interp(at, self.tension, self.total_length, left=np.nan, right=np.nan)

    def loads_at(self, tension: ArrayLike) -> Floats:
        """Load of each tether [N] at a tension of the assembly [N], shape (n_tethers, ...)."""
        at = np.asarray(tension, dtype=np.float64)
        rows = [
            np.interp(at, self.tension, row, left=np.nan, right=np.nan)
            for row in self.tether_tension
        ]
        return np.stack(rows)


def equal_tethers(tether: Tether, n_tethers: int) -> tuple[Tether, ...]:
    """Return tethers that are all alike.

    Parameters
    ----------
    tether : Tether
        One of them.
    n_tethers : int
        How many. [1]

    Returns
    -------
    tethers : tuple of Tether
        The same one again and again.

    Raises
    ------
    SettingsError
        If there are none.

    Notes
    -----
    Assemblies of [1]_ have one, four and six (sec. 2.3.2).

    Examples
    --------
    See `assemble`.
    """
    if n_tethers < 1:
        raise SettingsError("an assembly has tethers", found=str(n_tethers), needed="1 or more")
    return (tether,) * n_tethers


def unequal_tethers(tether: Tether, free_length: ArrayLike) -> tuple[Tether, ...]:
    """Return tethers of one material and one kind of splice, cut to lengths of their own.

    Parameters
    ----------
    tether : Tether
        As it was tested.
    free_length : array_like, shape (n_tethers,)
        Relaxed, splice toe to splice toe. [m]

    Returns
    -------
    tethers : tuple of Tether
        In that order.

    Raises
    ------
    DataError
        If a length is not positive, or the strain method knows no splice apart.

    Notes
    -----
    The shortest carries most; a load that all share equally is that of equal lengths.

    Examples
    --------
    See `reduction.lookup.working.worst_sharing`.
    """
    lengths = np.atleast_1d(as_positive("free_length", free_length))
    return tuple(
        Tether(tether.curve, with_free_length(tether.model, float(length))) for length in lengths
    )


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
    tethers share in full; the splice law's and the tolerance of the lengths are not in it.

    Examples
    --------
    Two tethers of 100 N per unit strain, 1 m of rubber each, and 0.5 m of bridle:

    >>> from reduction.lookup.composite import composite_curve
    >>> from reduction.lookup.pieces import CurvePiece
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
    begin = min(length[0] for length, *_ in own)
    end = min(length[-1] for length, *_ in own)
    last = max(length[0] for length, *_ in own)
    if last >= end:
        raise DataError(
            "a tether is at the end of its curve before another one is taut",
            found=f"{end:.4g} m",
            needed=f"above {last:.4g} m",
            hint="Their lengths differ by more than their stretch.",
        )
    nodes = np.unique(np.concatenate([length for length, *_ in own]))
    nodes = nodes[(nodes >= begin) & (nodes <= end)]
    load = np.stack([np.interp(nodes, length, force, left=0.0) for length, force, *_ in own])
    stretch = np.stack([np.interp(nodes, length, strain, left=0.0) for length, _, strain, _ in own])
    spread = sum(np.interp(nodes, length, doubt, left=0.0) for length, *_, doubt in own)
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
    slack = np.interp([length[0] for length, *_ in own], nodes, total)
    return AssemblyCurve(
        total_length=total,
        tension=tension,
        standard_uncertainty=np.asarray(spread)[kept] * stiffness,
        tether_length=nodes,
        tether_tension=load[:, kept],
        tether_strain=stretch[:, kept],
        slack_length=slack,
        is_tested=tested[kept],
        is_join=joined[kept],
        is_moved=moved[kept],
    )


def _lengths(tether: Tether) -> tuple[Floats, Floats, Floats, Floats]:
    """Length, tension, strain, and uncertainty of the tension at one length, on nodes."""
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
    of_curve = np.interp(strain, curve.strain, curve.standard_uncertainty)
    # splices take their share of what the curve is wrong by at one length
    share = np.gradient(free, force) / np.gradient(length, force)
    return length, force, strain, of_curve * share


def _has(curve: CompositeCurve, flags: Bools, strain: Floats) -> Bools:
    """Whether a strain is in an interval with a flag."""
    place = np.searchsorted(curve.strain, strain, side="left") - 1
    return flags[np.clip(place, 0, flags.size - 1)]
