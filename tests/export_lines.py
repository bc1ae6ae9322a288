"""Lines for the tests of the exports: a rubber tether, a rope, a Syrope."""

import numpy as np

from reduction.lines.export_dynamics import Syrope, Viscoelasticity
from reduction.lines.export_line import ExportLine


def rubber(strain):
    return 900 * (strain - 0.45 * strain**2 + 0.16 * strain**3)


def line(**changed):
    strain = np.linspace(0, 1.5, 400)
    fields = {
        "name": "new tether",
        "strain": strain,
        "tension": rubber(strain),
        "curve": "mean of both branches, cycles 5 to 10",
        "tested": (0.1, 1.4),
        "diameter": 0.026,
        "linear_density": 0.6,
        "sources": ("WHOI-2005-10, Table 5",),
    }
    return ExportLine(**fields | changed)


def constant(**changed):
    return Viscoelasticity(
        **{"static_stiffness": 2e4, "dynamic_stiffness": 5e4, "dashpot_coefficient": 9e4} | changed
    )


def growing():
    return Viscoelasticity(
        static_stiffness=2e4,
        dynamic_stiffness=3e4,
        dashpot_coefficient=9e5,
        dynamic_stiffness_per_mean_tension=10.0,
        mean_tension=2000.0,
        holds="mean tension 2 kN, 0.1 Hz",
    )


def syrope(**changed):
    fields = {
        "strain": np.array([0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.08]),
        "tension": np.array([0, 0.5e6, 1.3e6, 2.35e6, 3.0e6, 3.8e6, 4.6e6, 6.5e6]),
        "form": "LINEAR",
        "k1": 0.2,
        "k2": 0.0,
        "dynamic_stiffness": 1.5e8,
        "dynamic_stiffness_per_mean_tension": 25.0,
        "slow_damping": 1e8,
        "fast_damping": 1e6,
        "greatest_mean_tension": 3.0e6,
        "mean_tension": 1.0e6,
    }
    return Syrope(**fields | changed)
