"""Numbers of a look-up with what has to be told of them.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4, 4.4.1.
"""

from __future__ import annotations

import numpy as np

from reduction.lookup.linesurface import LineSurface
from reduction.lookup.loads import CycleLoads
from reduction.lookup.product import DesignValues, LineCurve, LineSource
from reduction.record import Bools, Floats
from reduction.uncertainty.product import Component
from reduction.vocabulary import quantity as quantity_of


def design_values(
    line: LineSource,
    of: LineSurface | LineCurve,
    *,
    loads: CycleLoads,
    inside: Bools,
    untested: Bools,
    words: tuple[str, str],
    more: tuple[str, ...] = (),
    component: tuple[Component, ...] = (),
    **numbers: Floats,
) -> DesignValues:
    """Put a look-up together.

    Parameters
    ----------
    line : LineSource
        Whose values they are.
    of : LineSurface or LineCurve
        That they are of.
    loads : CycleLoads
        Ends of the tension at the points.
    inside, untested : ndarray of bool, shape (...)
        Inside what was tested, and there farther from the runs than any. [1]
    words : tuple of str
        What ``low`` and ``high``, and what ``surface_low`` and ``surface_high`` are of.
    more : tuple of str, optional
        Notes beside those of line, surface and curve.
    component : tuple of Component, optional
        Errors that ``contribution`` is of.
    **numbers : ndarray, shape (...)
        Value, limits and contribution, by name. [SI]

    Returns
    -------
    values : DesignValues
        With notes on what the numbers show.

    Raises
    ------
    KeyError
        If the vocabulary has no such quantity.

    Examples
    --------
    See `reduction.lookup.overcurve.values_of_curve`.
    """
    notes = [*line.notes, *of.notes, *more]
    if words[0] or words[1]:
        notes.append(_scatter_told(of, words))
    elif isinstance(of, LineCurve):
        notes.append("no interval is given: the source states no scatter of this curve")
    if loads.is_above_rule.any():
        notes.append(f"the peak tension is above what the source allows: {line.rule}")
    if loads.is_slack.any() and loads.peak_tension.max() > 0:
        notes.append(
            "the minimum is zero: a snap load, by which fibres fail (CG-D-39-80, sec. 5.0)"
        )
    below = int(np.sum(numbers["value"] < 0))
    if below:
        notes.append(
            f"{below} of {inside.size} values are below zero, which {of.quantity} cannot be: the "
            "surface says nothing there"
        )
    return DesignValues(
        quantity=of.quantity,
        unit=quantity_of(of.quantity).unit,
        component=component,
        **numbers,
        is_inside=inside,
        is_untested=untested,
        peak_tension=loads.peak_tension,
        minimum_tension=loads.minimum_tension,
        peak_share=loads.peak_share,
        minimum_share=loads.minimum_share,
        own_peak_share=loads.own_peak_share,
        own_minimum_share=loads.own_minimum_share,
        is_slack=loads.is_slack,
        is_above_rule=loads.is_above_rule,
        rule=line.rule,
        source=line.source,
        errata=of.errata,
        notes=tuple(dict.fromkeys(notes)),
        branch=of.branch if isinstance(of, LineCurve) else "",
        interval_of=words[0],
        surface_interval_of=words[1],
    )


def _scatter_told(of: LineSurface | LineCurve, words: tuple[str, str]) -> str:
    """What the intervals hold, and what they do not."""
    if isinstance(of, LineSurface) and np.isfinite(of.line_scatter):
        return (
            f"lines of this kind differ among each other by about {100 * of.line_scatter:.0f} % "
            f"(CG-D-39-80, sec. 4.4.1), taken with {of.n_lines:.0f} lines and the degrees of "
            "freedom of the surface: in the intervals of the kind and of another line alone"
        )
    told = words[0] or words[1]
    return f"the interval is of {told}: how lines differ among each other is not in it"
