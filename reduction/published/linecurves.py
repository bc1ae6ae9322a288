r"""Cubics of CG-D-39-80 as curves of a line, over the range in which they can be trusted.

A cubic is given up to the end of its range on the page.  Two things show where it is wrong there:

- A line does not shorten under more load.  Where the cubic of strain turns, its range ends; its
  slope is wrong by as much as it is below zero, and K_0, the inverse of it, is trusted where that
  is at most a share of the slope.
- The slope of the cubic of strain is 1/K_0 (sec. 4.4.2): the cubic of K_0 is trusted where it is
  above zero, and within that share of the slope.

The share is the scatter of new lines, 1.96 times a tenth (sec. 4.4.1).

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, Tables 6-9, sec. 4.4.1-4.4.3.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.polynomial import polynomial

from reduction.line.cubic import slope_of_cubic
from reduction.lookup.product import LineCurve
from reduction.published.lineproduct import PublishedCubic, PublishedLine
from reduction.published.lines import published_lines
from reduction.record import Bools, Floats

OF_CUBIC = {"quasi_static_strain": "strain"}
"""Names of cubics that are looked up by another one."""
_REST = "quasi_static_spring_constant"
_SHARE = 1.96 * 0.1
_NODES = 8001


def curves_of_line(line: PublishedLine) -> tuple[tuple[LineCurve, ...], dict[str, str]]:
    """K_0 and strain of a line, and why one of them is not there.

    Parameters
    ----------
    line : PublishedLine
        As the page has it, in SI.

    Returns
    -------
    curves : tuple of LineCurve
        K_0 from the slope of strain where there is no cubic of its own.
    absent : dict of str to str
        Reasons, by quantity.
    """
    rest, strain = (
        None if cubic is None else _curve(cubic) for cubic in (line.stiffness, line.load_strain)
    )
    absent = {OF_CUBIC.get(name, name): why for name, why in line.absent.items()}
    for cubic, found in ((line.stiffness, rest), (line.load_strain, strain)):
        if cubic is not None and found is None:
            why = "; ".join(term.note for term in cubic.open_terms) or "the range is"
            absent[OF_CUBIC.get(cubic.quantity, cubic.quantity)] = f"open: {why}"
    if rest is not None:
        rest = _beside_slope(rest, strain or _of_same_row(line))
    elif strain is not None:
        rest = _slope(strain)
        absent.pop(_REST, None)
    elif line.load_strain is not None and _REST in absent:
        absent[_REST] = (
            "no table has such a row, and the load-strain cubic, whose slope would take its place, "
            f"is {absent['strain']}"
        )
    if strain is not None:
        strain = _rising(strain)
    return tuple(one for one in (rest, strain) if one is not None), absent


def _curve(cubic: PublishedCubic) -> LineCurve | None:
    """None where a coefficient or the range is open; a constant that is open moves little."""
    coefficient, notes = np.array(cubic.coefficient), [cubic.note] if cubic.note else []
    if [term.index for term in cubic.open_terms] == [0]:
        (term,) = cubic.open_terms
        coefficient[0] = term.values[0]
        notes.append(f"open: constant of {cubic.quantity}: {term.note}; the first is taken")
    if not (np.isfinite(coefficient).all() and np.isfinite(cubic.tension_high)):
        return None
    is_strain = cubic.quantity == "quasi_static_strain"
    return LineCurve(
        quantity=OF_CUBIC.get(cubic.quantity, cubic.quantity),
        variable="tension" if is_strain else "mean_tension",
        low=0.0,
        high=cubic.tension_high,
        coefficient=coefficient,
        errata=cubic.errata,
        notes=tuple(notes),
    )


def _of_same_row(line: PublishedLine) -> LineCurve | None:
    """Strain of the other condition whose K_0 stands in the same row."""
    if line.stiffness is None:
        return None
    for other in published_lines():
        if other.stiffness is None or other.load_strain is None:
            continue
        if np.array_equal(other.stiffness.coefficient, line.stiffness.coefficient):
            return _curve(other.load_strain)
    return None


def _slope(strain: LineCurve) -> LineCurve:
    """K_0 from the slope of load on strain, for a line without a cubic of its own."""
    curve = LineCurve(
        quantity=_REST,
        variable="mean_tension",
        low=0.0,
        high=strain.high,
        coefficient=np.array(strain.coefficient),
        is_inverse_slope=True,
        errata=strain.errata,
        notes=(*strain.notes, "from the slope of load against strain: no K_0 that can be used"),
    )
    at = np.linspace(0.0, strain.high, _NODES)
    slope = polynomial.polyval(at, polynomial.polyder(strain.coefficient))
    wrong = max(0.0, -float(slope.min()))
    return _within(
        curve, at, (slope > 0) & (wrong <= _SHARE * slope),
        "beyond, the slope of the cubic of strain, which turns, may be wrong by more than "
        f"{100 * _SHARE:.0f} %",
    )  # fmt: skip


def _rising(strain: LineCurve) -> LineCurve:
    at = np.linspace(0.0, strain.high, _NODES)
    slope = polynomial.polyval(at, polynomial.polyder(strain.coefficient))
    return _within(strain, at, slope > 0, "beyond, the cubic of strain falls under more load")


def _beside_slope(rest: LineCurve, strain: LineCurve | None) -> LineCurve:
    at = np.linspace(0.0, rest.high, _NODES)
    value = polynomial.polyval(at, rest.coefficient)
    is_good, why = value > 0, "beyond, the cubic of K_0 is below zero"
    if strain is not None:
        slope = slope_of_cubic(at, strain.coefficient)
        known = at <= strain.high
        is_good &= ~known | (np.abs(value / slope - 1) <= _SHARE)
        why = (
            "beyond, the cubic of K_0 is below zero or differs from the slope of the load-strain "
            f"cubic by more than {100 * _SHARE:.0f} %"
        )
    return _within(rest, at, is_good, why)


def _within(curve: LineCurve, at: Floats, is_good: Bools, why: str) -> LineCurve:
    """The curve over the longest part of its range that is good."""
    if is_good.all():
        return curve
    edges = np.flatnonzero(np.diff(np.concatenate([[0], is_good.astype(int), [0]])))
    low, high = max(
        ((at[first], at[last - 1]) for first, last in zip(edges[::2], edges[1::2], strict=True)),
        key=lambda ends: ends[1] - ends[0],
    )
    return replace(
        curve,
        low=float(low),
        high=float(high),
        range_note=f"printed for 0 to {curve.high:.5g} N, trusted from {low:.5g} to {high:.5g} N: "
        f"{why}",
    )
