"""Predicted hoses for the tests of archive, tables and page; expected values by formulas apart.

The kinematics of WHOI-2004-06, eq. (8), solved by hand: a cord has its length again where
cos2 L**2 + cos2 L - sin2 = 0, the cubic without its root at L = 1.
"""

from dataclasses import replace
from math import pi

import numpy as np

from reduction.archive.campaign_products import predictions_to_dataset
from reduction.prediction.cord_curve import CordCurve
from reduction.prediction.hose_prediction import HelicalLayer, HosePlan, predict_from_plan
from reduction.prediction.hose_product import HoseDesign
from reduction.record.measurement import Origin, Source, Step

INCH, POUND, PSI = 0.0254, 4.4482216152605, 6894.757293168
CORD_STRAIN = np.array([0.0, 0.02, 0.06, 0.10, 0.15, 0.22])
CORD_LOAD = np.array([0.0, 1.6, 5.0, 10.0, 18.0, 30.0]) * POUND
AT_WORK = 0.10
"""Cord strain at a third of the break load: the fourth of the measured points."""
UNCERTAIN = {"wrap_angle": np.radians(0.5), "rubber_modulus": 10 * PSI, "cord_load_scale": 0.03}
LAYERS = (
    HelicalLayer("Kevlar", np.radians(66.0), 0.02, 0.08),
    HelicalLayer("conductors", np.radians(78.0), 0.01, np.nan),
)


def plan(name="gumby", degrees=68.0, *, uncertain=UNCERTAIN, layers=LAYERS, cord=None, **changes):
    about = {"strain_step": 0.02} | {
        key: changes.pop(key) for key in ("strain_step", "greatest_strain") if key in changes
    }
    numbers = {
        "wrap_angle": np.radians(degrees),
        "layer_diameter": (3.4 * INCH, 3.6 * INCH),
        "inner_diameter": 2.5 * INCH,
        "outer_diameter": 5 * INCH,
        "cords_per_length": 34 / INCH,
        "cord_diameter": 0.022 * INCH,
        "rubber_modulus": 200 * PSI,
        "cord": cord or CordCurve(CORD_STRAIN.copy(), CORD_LOAD.copy()),
    }
    design = HoseDesign(**(numbers | changes))
    return HosePlan(
        name, design, standard_uncertainty=dict(uncertain), layers=tuple(layers), **about
    )


def predicted(*arguments, **options):
    return predict_from_plan(plan(*arguments, **options))


def renamed(hose, name):
    return replace(hose, plan=replace(hose.plan, name=name))


def dataset(*hoses, synthetic="", **changed):
    about = {
        "campaign_id": "hoses",
        "attributes": {"title": "Hoses", "synthetic": synthetic},
        "sources": [Source("hose.toml", "ab" * 32, 99)],
        "steps": [Step("predict", "hoses")],
        "settings_json": "{}",
        "version": "1",
        "command": "reduction predict hose hose.toml",
    }
    return predictions_to_dataset(hoses, origin=Origin(**(about | changed)))


def pick_up_strain(degrees):
    """Of a hose without dead length: (sqrt(1 + 4 tan2) - 3)/2."""
    return (np.sqrt(1 + 4 * np.tan(np.radians(degrees)) ** 2) - 3) / 2


def stretch_at(degrees, cord_strain):
    """Greatest root of L**3 cos2 - L (1 + cord_strain)**2 + sin2."""
    cos2 = np.cos(np.radians(degrees)) ** 2
    roots = np.roots([cos2, 0, -((1 + cord_strain) ** 2), 1 - cos2])
    return float(roots.real.max())


def rubber_tension(stretch):
    """Neo-Hookean: A E/3 (L - L**-2)."""
    area = pi / 4 * (5**2 - 2.5**2) * INCH**2
    return area * 200 * PSI / 3 * (stretch - stretch**-2)


def working_tension(degrees):
    """Rubber, and N P cos a of the current angle less the end cap, by virtual work."""
    stretch, angle = stretch_at(degrees, AT_WORK), np.radians(degrees)
    cos2, sin2 = np.cos(angle) ** 2, np.sin(angle) ** 2
    cord_length_a_hose_length = pi * 7 * 34  # (3.4 + 3.6) in at 34 an inch, over cos a times cos a
    slope = (stretch * cos2 - sin2 / (2 * stretch**2)) / (1 + AT_WORK)
    return rubber_tension(stretch) + cord_length_a_hose_length * 10 * POUND * slope
