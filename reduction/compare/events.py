"""Comparison error at what happens to the cords: where they pick up, at working load, at break.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   sec. 1.2.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from reduction.compare.difference import strain_at_tension
from reduction.compare.measuredcurve import MeasuredCurve
from reduction.compare.product import EventDifference
from reduction.predict.events import find_events
from reduction.predict.hose import predict_hose
from reduction.predict.product import HoseDesign, HoseEvent
from reduction.predict.uncertainty import EventUncertainty, propagate_hose
from reduction.record import Floats

EVENTS = ("pick_up", "working", "break")


def event_differences(
    design: HoseDesign,
    measured: MeasuredCurve,
    *,
    standard_uncertainty: Mapping[str, float] | None = None,
) -> tuple[EventDifference, ...]:
    r"""Predicted less measured at each event, in tension and in strain.

    With an error :math:`\delta T` and :math:`\delta\varepsilon` of the predicted event, the
    difference of tension at its strain errs by :math:`\delta T - D' \delta\varepsilon`, where
    D' is the slope of the measured curve, and by the error of that curve.

    Parameters
    ----------
    design : HoseDesign
        One hose.
    measured : MeasuredCurve
        The test; its judged curve counts. [SI]
    standard_uncertainty : mapping of str to float, optional
        Of numbers of the design. [SI]

    Returns
    -------
    events : tuple of EventDifference
        In the order of `EVENTS`. [SI]

    Raises
    ------
    SettingsError
        If an uncertainty is of no number of a hose, or below zero.

    Notes
    -----
    At pick-up the tension is compared, and the strain at which the test had that tension; neither
    is where the cords of the test pick up (`reduction.compare.pickup.measured_pick_up`).  The
    difference of strain at the working load is what a designer asks for: how much less or more
    the hose stretches under its safe load.  The judged curve counts up to its last sample, which
    lies beyond the last bin centre.  Between two strains of the curve the difference is taken as
    straight, since both curves have the kink; near the break, where one of them has no
    prediction, the measured curve is.

    Examples
    --------
    >>> from reduction.compare.measured import measured_curve
    >>> from reduction.predict.cordcurve import CordCurve
    >>> from reduction.predict.hose import predict_hose
    >>> hose = HoseDesign(1.117, (0.0889, 0.0889), 0.0635, 0.127, 34 / 0.0254, 5.6e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> stroke = np.linspace(0.0, 1.2, 1201)
    >>> stiffer = measured_curve(stroke, 1.1 * predict_hose(hose, stroke).tension, loading="static")
    >>> pick_up = event_differences(hose, stiffer)[0]
    >>> print(round(pick_up.tension_difference / pick_up.measured_tension, 2))
    -0.09
    """
    found = find_events(design)
    known = propagate_hose(design, np.zeros(1), standard_uncertainty or {})
    curve = measured.tension_of(measured.judged)
    there = np.isfinite(curve)
    x, y = measured.strain[there], curve[there]
    own = np.vstack(
        [
            measured.independent_uncertainty()[None, there],
            measured.contribution_of(measured.judged)[:, there],
            measured.scatter_contribution[:, there],
        ]
    )
    if np.isfinite(measured.end_strain):
        x, y = np.append(x, measured.end_strain), np.append(y, measured.end_tension)
        last = own[:, -1].copy()
        last[0] = measured.end_standard_uncertainty
        own = np.column_stack([own, last])
    test = _Test(x, y, predict_hose(design, x).tension, own)
    pairs = (
        (found.pick_up, known.pick_up),
        (found.working, known.working),
        (found.cord_break, known.cord_break),
    )
    return tuple(
        _compare(name, event, error, test)
        for name, (event, error) in zip(EVENTS, pairs, strict=True)
    )


class _Test(NamedTuple):
    """Judged curve up to its last sample, the prediction there, and errors, (n_source, n)."""

    strain: Floats
    tension: Floats
    predicted: Floats
    own: Floats


def _compare(
    name: str, event: HoseEvent, error: EventUncertainty, test_curve: _Test
) -> EventDifference:
    x, y, predicted, own = test_curve
    strain, tension = float(event.strain), float(event.tension)
    reached = strain_at_tension(x, y, tension)
    slope = np.gradient(y, x) if x.size > 1 else np.full(x.size, np.nan)

    def uncertainty(at: float) -> float:
        of_test = np.array([_at(at, x, row) for row in own])
        of_model = error.tension_contribution - _at(at, x, slope) * error.strain_contribution
        return float(np.sqrt(np.sum(of_test**2) + np.sum(of_model**2)))

    # between two strains the difference is straight where both curves have a kink
    apart = _at(strain, x, predicted - y)
    test = _between(tension - apart, strain, x, y) if np.isfinite(apart) else _at(strain, x, y)
    return EventDifference(
        name=name,
        strain=strain,
        tension=tension,
        measured_tension=test,
        tension_difference=tension - test,
        tension_difference_standard_uncertainty=uncertainty(strain),
        measured_strain=reached,
        strain_difference=strain - reached,
        strain_difference_standard_uncertainty=uncertainty(reached) / _at(reached, x, slope),
    )


def _between(tension: float, strain: float, x: Floats, y: Floats) -> float:
    """A tension that is not beyond those of the two strains beside it.

    A test without the kink of the prediction would get the bow of it the other way round.
    """
    k = int(np.clip(np.searchsorted(x, strain), 1, max(x.size - 1, 1)))
    return float(np.clip(tension, y[k - 1 : k + 1].min(), y[k - 1 : k + 1].max()))


def _at(strain: float, x: Floats, y: Floats) -> float:
    """Value on the straight line between two points; NaN outside of them."""
    if not (x.size and x[0] <= strain <= x[-1]):
        return float("nan")
    return float(np.interp(strain, x, y))
