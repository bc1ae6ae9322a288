"""A made-up source of design values for the tests of the exports."""

import numpy as np

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.lines.lookup_product import LineCurve, LineSource, LineSurface

LOW, HIGH = np.array([0.1, 1000.0, 500.0]), np.array([0.5, 3000.0, 900.0])
EXPONENTS = quadratic_exponents(3)
DESIGN = box_behnken(3).coded
INVERSE = np.linalg.inv(model_matrix(DESIGN, EXPONENTS).T @ model_matrix(DESIGN, EXPONENTS))
LEVELS = {"frequency": 0.3, "mean_tension": 2000.0, "tension_amplitude": 700.0}

REST, SPRING, TIME = 2e4, 3e4, 0.8


def loop(rest=REST, spring=SPRING, time=TIME):
    """K_ap and H of eqs. 1-4 of CG-D-39-80, written out as complex numbers."""
    turned = 2j * np.pi * LEVELS["frequency"] * time
    stiffness = rest + spring * turned / (1 + turned)
    amplitude = LEVELS["tension_amplitude"]
    # a strain of amplitude dT/|K| against a tension with the part K'' a quarter cycle ahead
    energy = np.pi * (amplitude / abs(stiffness)) ** 2 * stiffness.imag
    return abs(stiffness), energy


def surface(quantity, centre, *, per_mean=0.0, errata=(), sigma=10.0):
    coefficient = np.zeros(10)
    coefficient[0] = centre
    place = [tuple(row) for row in EXPONENTS].index((0, 1, 0))
    coefficient[place] = per_mean
    return LineSurface(
        quantity, coefficient, EXPONENTS, LOW, HIGH, INVERSE, sigma, 5.0, 0.75, errata=errata
    )


def source(*, curves=None, growth=5000.0, **changed):
    pull = LineCurve(
        "strain", "tension", 0.0, 4000.0, coefficient=np.array([0, 1e-4, -1e-8]), errata=("CG-8",)
    )
    rest = LineCurve(
        "quasi_static_spring_constant", "mean_tension", 0.0, 4000.0, coefficient=np.array([2e4])
    )
    fields = {
        "factor_names": ("frequency", "mean_tension", "tension_amplitude"),
        "surfaces": {
            "dissipation_spring_constant": surface(
                "dissipation_spring_constant", 3e4, per_mean=growth, errata=("CG-14",)
            ),
            "relaxation_time": surface("relaxation_time", 3.0),
        },
        "curves": (pull, rest) if curves is None else curves,
        "linear_density": 0.1,
        "notes": ("wet",),
    } | changed
    return LineSource("a rope", "CG-D-39-80", "nylon", "braid", "new", 0.0127, 28e3, **fields)
