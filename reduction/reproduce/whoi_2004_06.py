"""WHOI-2004-06 again: the equations, and what the text says of cords, angles and hoses.

The report gives neither the curve of a cord nor the size of a hose, so that no load of a hose can
be recomputed, and no stretch at a load.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004.
"""

from __future__ import annotations

import numpy as np

from reduction.predict.cord import cord_stretch_ratio, pick_up_stretch_ratio
from reduction.predict.helix import NEUTRAL_ANGLE
from reduction.reproduce.answers import Answer, Answers, items_from
from reduction.reproduce.hose_equations import equation_answers
from reduction.reproduce.item import Item

_FABRIC, _HOSE = "nylon tire cord fabric", "stretch hose"
_MEDIUM, _HIGH = "medium high stretching hose", "high stretching hose"
_TEST = "sec 3.0"


def items() -> list[Item]:
    """One item for every printed number of the report.

    Returns
    -------
    items : list of Item
        In the order of its cells.
    """
    return items_from("WHOI-2004-06", answers())


def answers() -> Answers:
    """What every printed number ought to be.

    Returns
    -------
    answers : Answers
        By cell.
    """
    return equation_answers() | _cords() | _angles() | _tests()


def _cords() -> Answers:
    denier, bundle, cord, metres, per_inch, diameter = 840.0, 0.0933, 0.1867, 9000.0, 34.0, 0.022
    half = 0.5e-4  # of the linear densities
    setting = "a property of the fabric"
    both = "0.1867 over 0.0933 g/m of footnote 1"
    gap = 1 / (per_inch * diameter) - 1
    return {
        ("sec 1.1", _FABRIC, "gap between cords over the cord diameter"): Answer(
            gap, "1 / 34 in less 0.022 in, over 0.022 in; the tolerance is that of 34 and 0.022",
            tolerance=(1 + gap) * (0.5 / per_inch + 0.5e-3 / diameter)),
        ("sec 1.2.2", _FABRIC, "cords_per_length"): setting,
        ("sec 1.2.2", _FABRIC, "cord_diameter"): setting,
        ("sec 1.2.2", _FABRIC, "breaking strength of one cord"): setting,
        ("sec 1.2.2", _FABRIC, "breaking strength of the fabric"): Answer(
            30 * per_inch, "34 cords of about 30 lbf, which has one digit: 5 lbf a cord",
            tolerance=5 * per_inch),
        ("sec 1.2.2", _FABRIC, "cord_denier"): Answer(denier, "printed in footnote 1 too"),
        ("sec 1.2.2", _FABRIC, "number of plies"): Answer(cord / bundle, both),
        ("footnote 1", "denier", "length that is weighed"): Answer(
            denier / bundle, "840 over 0.0933 g/m, which is rounded",
            tolerance=denier / bundle**2 * half),
        ("footnote 1", _FABRIC, "cord_denier"): Answer(
            bundle * metres, "0.0933 g/m times 9000 m, rounded", tolerance=half * metres),
        ("footnote 1", "one fiber bundle of 840 denier", "linear density"): Answer(
            denier / metres, "840 g over 9000 m"),
        ("footnote 1", _FABRIC, "number of plies"): Answer(cord / bundle, both),
        ("footnote 1", _FABRIC, "linear density"): Answer(
            2 * denier / metres, "2 x 840 g over 9000 m"),
    }  # fmt: skip


def _angles() -> Answers:
    load = "load over the theoretical breaking strength"
    third = Answer(1 / 3, "printed three times: sec 1.2.4 and, for both hoses, 3.0")
    figure = "wrap_angle in the caption of Figure 11"
    return {
        ("sec 1.2.1", _HOSE, "neutral wrap angle"): Answer(
            float(np.degrees(NEUTRAL_ANGLE)), "atan(sqrt 2): the slope of (8) is nothing at rest"),
        ("sec 1.2.3", "cord around a cylinder", "wrap_angle in the text"): Answer(
            90.0, "(17) is (14) where the sine is one"),
        ("sec 1.2.3", "cord around a cylinder", "wrap_angle in the caption of Figure 9"): Answer(
            90.0, "90 degree in the text above the figure"),
        ("sec 1.2.3", "full wrap", "contact angle"): Answer(
            float(np.degrees(2 * np.pi)), "2 pi, the factor of (13)"),
        ("sec 1.2.4", "Snubber program", "least step of hose elongation"): "a setting",
        ("sec 1.2.4", "Snubber program", "greatest step of hose elongation"): "a setting",
        ("sec 1.2.4", _HOSE, "safe working load over the breaking strength of the cords"): third,
        (_TEST, _MEDIUM, load): third,
        (_TEST, _HIGH, load): third,
        ("sec 1.2.4", _HIGH, figure): Answer(68.0, "680 in sec 3.0, without its degree sign"),
        (_TEST, _HIGH, "wrap_angle"): Answer(68.0, "68 degree in the caption of Figure 11"),
        (_TEST, _MEDIUM, "wrap_angle"):
            "an angle from the axis is below 90 degrees, so that the 0 is a degree sign, as in 680",
        ("sec 2.0", _HOSE, "temperature of the curing steam"):
            "3000 F melts the steel of the mandrel: the 0 is a degree sign, as in 680",
    }  # fmt: skip


def _tests() -> Answers:
    counted, place = "counted in a test, and printed once", "a fact of a deployment"
    sea = "an estimate for a sea that is not described"
    stretch = "maximum stretch"
    return {
        ("abstract", _HOSE, "elastic stretch, from"):
            "a range of designs, whose least wrap angle is not given",
        ("abstract", _HOSE, "elastic stretch, to"): Answer(
            130.0, "130% of the hose of 68 deg, sec 3.0"),
        (_TEST, "Snubber test hose of 1994", "length"): "a setting",
        (_TEST, "Snubber test hose of 1994", "flex cycles"): counted,
        (_TEST, "Snubber test hose of 1994", "tension cycles"): counted,
        (_TEST, "Snubber test hose of 1994", "flex angle"): "a setting",
        (_TEST, _MEDIUM, stretch): _stretch(64.0, 79.0),
        (_TEST, _HIGH, stretch): _stretch(68.0, 130.0),
        (_TEST, _MEDIUM, "cycle of the maximum stretch"): counted,
        (_TEST, _HIGH, "cycle of the maximum stretch"): counted,
        (_TEST, "mooring at sea", "tension cycles in a month"): sea,
        (_TEST, "mooring at sea", "flex cycles in a month"): sea,
        ("sec 4.0", "MOOS mooring of MBARI", "water_depth"): place,
        ("sec 4.0", "fish feed hose of the University of New Hampshire", "time in service"): place,
        ("sec 4.0", "fish feed hose of the University of New Hampshire", "tide"): place,
        ("sec 4.0", "taut surface mooring of 2004", "length"): place,
        ("sec 4.0", "taut surface mooring of 2004", "water_depth"): place,
    }  # fmt: skip


def _stretch(degrees: float, percent: float) -> str:
    """Say what a measured stretch is worth: it is possible, and no more can be said."""
    angle = np.radians(degrees)
    cord = 100 * (float(cord_stretch_ratio(1 + percent / 100, angle)) - 1)
    pick_up = 100 * (float(pick_up_stretch_ratio(angle)) - 1)
    return (
        "measured; neither cord curve nor load is given. Possible: (8) has the cords at "
        f"{cord:.2f} % there, beyond their pick-up at {pick_up:.1f} % of stretch and below break. "
        "No one cord strain gives both hoses their stretch: 130 / 79 is 1.65, (8) has 1.40 to 1.51"
    )
