"""Made-up lines of design values that have everything that no campaign has at once."""

import numpy as np

from reduction.experiments.designs import quadratic_exponents
from reduction.lines.lookup_product import LineCurve, LineSource, LineSurface
from reduction.record.contributions import Component

LOW, HIGH = np.array([0.1, 2000.0, 900.0]), np.array([0.5, 9000.0, 2700.0])
FACTORS = ("frequency", "mean_tension", "tension_amplitude")
CELL, GAUGE = Component("tension_gain", "cell"), Component("diameter", "a", 1, 2.0)
CLOCK = Component("clock", "logger", 0, 7.5)


def _surface(quantity, mean, chance, *, spread=0.05, **fields):
    exponents = quadratic_exponents(3)
    coefficient = mean * np.append(1.0, chance.normal(0, 0.04, len(exponents) - 1))
    root = chance.normal(0, 0.2, (len(exponents), len(exponents)))
    fields = {
        "sigma": spread * abs(mean), "degrees_of_freedom": 5.0, "greatest_leverage": 0.9,
        "covariance_factor": np.eye(len(exponents)) / 8 + root @ root.T / 20,
    } | fields  # fmt: skip
    return LineSurface(quantity, coefficient, exponents, LOW, HIGH, **fields)


def _shared(quantity, mean, chance, of, **fields):
    rows = 0.02 * abs(mean) * chance.normal(0, 1, (len(of), 10))
    return _surface(quantity, mean, chance, component=of, contribution=rows, **fields)


def _rope(name, surfaces, **fields):
    return LineSource(
        name, "made up", "nylon", "braid", "new", 0.0127, 28e3, FACTORS,
        {one.quantity: one for one in surfaces}, kind="rope", **fields,
    )  # fmt: skip


def _tether(chance):
    at = np.round(np.cumsum(chance.uniform(0.01, 0.06, 24)), 4)
    force = 300 * at + 10 * np.cumsum(chance.uniform(0, 1, 24)) - 300 * at[0]
    own, rows = chance.uniform(1, 3, 24), chance.normal(0, 2, (3, 24))
    known = {
        "at": at, "gaps": np.array([[at[7], at[8]], [at[15], at[16]]]),
        "component": (CELL, GAUGE, CLOCK), "contribution": rows,
        "standard_uncertainty": np.sqrt(own**2 + np.sum(rows**2, axis=0)),
        "spread_of": "the mean over the cycles of this one test",
    }  # fmt: skip
    return LineSource(
        "tether", "made up", "rubber", "", "", 0.026, 500.0, kind="rubber tether",
        curves=(
            LineCurve(
                "branch_tension", "strain", at[0], at[-1], value=force, branch="ascending",
                degrees_of_freedom=np.full(24, 9.0), **known,
            ),
            LineCurve(
                "branch_tension", "strain", at[0], at[-1], value=0.8 * force, branch="descending",
                degrees_of_freedom=chance.choice([1.0, 1.5, 4.0, 2e4, np.inf], 24), **known,
            ),
            LineCurve(
                "tangent_modulus", "strain", 0.1, 1.0, branch="ascending",
                at=np.array([0.1, 0.4, 0.4, 0.7, 0.7, 1.0]),
                value=np.array([1e6, 1e6, 7e5, 7e5, 8.5e5, 8.5e5]), errata=("WH5-1",),
            ),
        ),
        linear_density=0.543, wet_linear_density=0.0123,
    )  # fmt: skip


def _own(chance):
    """Surfaces of known runs, tau as f tau, with a slow pull; K_1 is not that of the others."""
    terms = np.vstack([quadratic_exponents(3), [[3, 0, 0], [2, 1, 0], [0, 1, 3]]])

    def of(quantity, mean, **fields):
        root = 0.004 * abs(mean) * chance.normal(0, 1, (len(terms), 4))
        more = {
            "discrepancy": root @ root.T, "discrepancy_exponents": terms,
            "discrepancy_degrees_of_freedom": 12.0,
        }  # fmt: skip
        return _shared(quantity, mean, chance, (CELL, GAUGE), spread=0.004, **more, **fields)

    at = np.linspace(1000.0, 8000.0, 8)
    pull = LineCurve(
        "quasi_static_spring_constant", "mean_tension", 1000.0, 8000.0, at=at, value=8e4 + 4 * at,
        standard_uncertainty=np.full(8, 4e3), degrees_of_freedom=np.full(8, 11.0),
        component=(CELL, CLOCK), contribution=chance.normal(0, 1e3, (2, 8)),
    )  # fmt: skip
    surfaces = [
        of("apparent_spring_constant", 2e5),
        of("hysteresis_energy", np.log(7.6), exponent=0.0),
        of("dissipation_spring_constant", 1.6e5),
        of("relaxation_time", np.log(0.53), exponent=0.0, frequency_column=0),
    ]
    return _rope("own", surfaces, slow_pulls={"slow pull Q01": pull})


def odd_lines():
    """Lines by name: own surfaces, others on other scales with shared errors, open ones, curves with gaps."""
    chance = np.random.default_rng(3)
    spring, time, apparent, energy = (
        "dissipation_spring_constant", "relaxation_time", "apparent_spring_constant",
        "hysteresis_energy",
    )  # fmt: skip
    lines = [
        _rope("even", [_shared(spring, 9e4, chance, (CELL, GAUGE)), _shared(time, 3.0, chance, (GAUGE, CLOCK))]),
        _rope(
            "logarithms",
            [
                _shared(spring, 11.0, chance, (CELL, GAUGE), exponent=0.0, spread=0.01),
                _shared(time, 1.1, chance, (CELL,), exponent=0.0),
                _shared(apparent, 600.0, chance, (CELL, CLOCK), exponent=0.5, sigma=40.0),
                _surface(energy, -0.4, chance, exponent=-0.5, sigma=1.0),
            ],
        ),
        _rope(
            "one shared",
            [
                _shared(spring, 9e4, chance, (CELL,)),
                _surface(time, 3.0, chance),
                _surface(apparent, 2e5, chance, line_scatter=0.5, n_lines=2.0),
                _surface(energy, 30.0, chance, sigma=float("nan")),
            ],
            tensile_strength=9e3, strength_of="another line",
        ),
        _rope(
            "open",
            [
                _surface(
                    apparent, 2e5, chance, rounding=np.array([0.0, 2.2, 2.2]),
                    alternatives=2e5 * np.append(1.1, np.full(9, 0.03))[None],
                    alternative_boxes=((LOW, 1.1 * HIGH),), notes=("open",),
                ),
                _shared(
                    spring, 9e4, chance, (CELL,),
                    alternatives=9e4 * np.append(0.8, np.full(9, 0.02))[None],
                ),
                _shared(time, 0.05, chance, (CELL,), spread=2.0),
                _surface(energy, 30.0, chance, degrees_of_freedom=0.0),
            ],
        ),
        _own(chance),
        _tether(chance),
        LineSource(
            "pull", "made up", "", "", "", 0.02, 3e4,
            curves=(
                LineCurve("strain", "tension", 0.0, 9000.0, np.array([0.002, 3e-5, -4e-9, 2e-13])),
                LineCurve(
                    "quasi_static_spring_constant", "mean_tension", 0.0, 8000.0,
                    np.array([0.002, 3e-5, -4e-9, 2e-13]), is_inverse_slope=True,
                    range_note="beyond, it is not trusted",
                ),
            ),
        ),
    ]  # fmt: skip
    return {one.name: one for one in lines}
