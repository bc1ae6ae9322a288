"""What happens to the cords of a hose, and at which stretch: closed forms.

The strains belong to a long, straight hose that keeps its volume, and to a slow pull of its cords
(see `reduction.predict.hose`).  Where the cords break is where a single cord of the curve would:
a hose has weaker places, at its ends above all.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   sec. 1.2.1, 1.2.4, Fig. 11.
"""

from __future__ import annotations

import numpy as np

from reduction.predict.cord import (
    cord_stretch_ratio,
    hose_stretch_ratio,
    pick_up_stretch_ratio,
    slackest_stretch_ratio,
)
from reduction.predict.cordload import cord_strain_at
from reduction.predict.hoseloads import HoseNumbers, loads_at, numbers_of
from reduction.predict.product import HoseDesign, HoseEvent, HoseEvents
from reduction.predict.rubber import rubber_tension
from reduction.record import Floats


def find_events(design: HoseDesign) -> HoseEvents:
    """Where cords are shortest, pick up, reach their working load, and break.

    Parameters
    ----------
    design : HoseDesign
        One hose or many, shape (...).

    Returns
    -------
    events : HoseEvents
        Arrays of shape (...); strains of the whole relaxed length, dead ends included.

    Raises
    ------
    ValueError
        From numpy, if numbers of the design do not broadcast.

    Notes
    -----
    Source: [1]_, eq. (8) and Fig. 11.  The safe working load is the tension of the hose "at which
    the nylon tire cords are stressed to 1/3rd of their breaking strength" (sec. 1.2.4): of the
    cords, not of the hose, which the rubber makes another number.

    No search but for the inverse of the cord curve, `cord_strain_at`.  The cord strain at pick-up
    is exactly zero and at the break exactly that of the last point times its scale.

    Examples
    --------
    >>> from reduction.predict.cordcurve import CordCurve
    >>> design = HoseDesign(
    ...     wrap_angle=np.radians([50.0, 64.0, 68.0]), layer_diameter=(0.0889, 0.0889),
    ...     inner_diameter=0.0635, outer_diameter=0.127, cords_per_length=34 / 0.0254,
    ...     cord_diameter=0.00056, rubber_modulus=1.4e6,
    ...     cord=CordCurve(strain=np.array([0.0, 0.26]), load=np.array([0.0, 130.0])),
    ... )
    >>> events = find_events(design)
    >>> print((100 * events.pick_up.strain).round(2))
    [  0.    61.04 102.51]
    >>> print((100 * events.deepest_slack.cord_strain).round(2))
    [ 0.   -2.74 -5.77]
    >>> print((100 * events.cord_break.strain).round(2))
    [ 73.95 157.46 205.04]
    """
    numbers, angle = numbers_of(design), np.asarray(design.wrap_angle, dtype=np.float64)
    slackest = slackest_stretch_ratio(angle)
    shortest = np.where(slackest > 1, cord_stretch_ratio(slackest, angle) - 1, 0.0)
    nothing, curve = np.zeros(design.shape), design.cord
    working_load = design.working_share * curve.break_load
    working_strain = numbers.strain_scale * cord_strain_at(curve, working_load)
    break_strain = numbers.strain_scale * curve.break_strain
    return HoseEvents(
        deepest_slack=_event(design, numbers, slackest, shortest, nothing),
        pick_up=_event(design, numbers, pick_up_stretch_ratio(angle), nothing, nothing),
        working=_event(
            design,
            numbers,
            hose_stretch_ratio(1 + working_strain, angle),
            working_strain,
            numbers.load_scale * working_load,
        ),
        cord_break=_event(
            design,
            numbers,
            hose_stretch_ratio(1 + break_strain, angle),
            break_strain,
            numbers.load_scale * curve.break_load,
        ),
    )


def _event(
    design: HoseDesign,
    numbers: HoseNumbers,
    stretch: Floats,
    cord_strain: Floats,
    cord_tension: Floats,
) -> HoseEvent:
    loads = loads_at(numbers, stretch, 1 + cord_strain, cord_tension)
    rubber = rubber_tension(
        stretch, area=numbers.area, modulus=numbers.modulus, law=design.rubber_law
    )
    return HoseEvent(
        strain=np.asarray((stretch - 1) * numbers.free_share),
        tension=np.asarray(rubber + loads.cord_axial_load),
        fill_pressure=loads.fill_pressure,
        cord_tension=np.array(np.broadcast_to(cord_tension, design.shape)),
        cord_strain=np.array(np.broadcast_to(cord_strain, design.shape)),
    )
