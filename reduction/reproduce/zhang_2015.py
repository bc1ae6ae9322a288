"""Zhang (2015) again: what goes into its tables, and what its text says.

Settings follow from the tables that were made with them; Tables 5 to 8 are in
`reduction.reproduce.wave_tables`, equations in `reduction.reproduce.wave_equations`.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015.
"""

from __future__ import annotations

from math import pi

import numpy as np
import scipy

from reduction.predict.breaking import breaking_height
from reduction.predict.dispersion import STANDARD_GRAVITY, wave_period_of
from reduction.predict.immersion import immerse_hose
from reduction.predict.zhang2015 import DRAG_COEFFICIENT, INERTIA_COEFFICIENT, WATER_DENSITY
from reduction.published.read import table_of
from reduction.reproduce.answers import Answer, Answers, items_from
from reduction.reproduce.item import Item
from reduction.reproduce.wave_equations import equation_answers
from reduction.reproduce.wave_settings import (
    FREQUENCY,
    GRAVITY,
    HEIGHT,
    LENGTH,
    NUMBER,
    PERIOD,
    cells_of_table,
)
from reduction.reproduce.wave_tables import table_answers

_HOSE = {
    "outer_diameter": 114.0,
    "wall_thickness": 6.0,
    "water_density": 1.025,
    "wall_density": 1.25,
    "content_density": 0.83,
}
"""Table 3, in millimetres and g/cm3."""
_SYMBOLS = {
    "wall_thickness": "d",
    "water_density": "rho1",
    "wall_density": "rho2",
    "content_density": "rho3",
}
_IMMERSION = 95.1
_DIAMETER = 0.114
_AIRY, _STOKES = "Airy wave theory", "Stokes wave theory"
_EXAMPLES = {"example of the Airy theory": 6.0, "example of the Stokes theory": 3.0}
_HALF_DIGIT = 0.005  # of the loads of Table 7


def items() -> list[Item]:
    """One item for every printed number of the paper.

    Returns
    -------
    items : list of Item
        In the order of its cells.
    """
    return items_from("Zhang-2015", answers())


def answers() -> Answers:
    """What every printed number ought to be.

    Returns
    -------
    answers : Answers
        By cell.
    """
    tables = _conditions() | _hose() | _waves() | _coefficients() | table_answers()
    return tables | equation_answers() | _depths() | _claims()


def _conditions() -> Answers:
    """Tables 1 and 2."""
    quoted = "quoted from another book"
    conical = "conical and solitary wave theory"
    neighbour = "the limit of the neighbouring theory"
    depth, end = "relative depth d/L, from", "relative depth d/L, to"
    limit = float(breaking_height(NUMBER, 0.2 * LENGTH)) / LENGTH
    found: Answers = {
        ("1", _AIRY, depth): Answer(0.2, neighbour),
        ("1", _STOKES, end): Answer(0.2, neighbour),
        ("1", _STOKES, depth): Answer(0.1, neighbour),
        ("1", conical, end): Answer(0.1, neighbour),
        ("1", _AIRY, "steepness H/L, to"): quoted,
        ("1", _STOKES, "steepness H/L, from"): Answer(
            limit, "the steepest wave there is before it breaks, at d/L = 0.2"
        ),
    }
    for cell in cells_of_table("1"):
        found.setdefault(cell.key, quoted)
    return found | {cell.key: "measured by others, and quoted" for cell in cells_of_table("2")}


def _hose() -> Answers:
    """Table 3 from the immersion of (11), and (11) from Table 3."""
    hose = "floating pipeline"
    share = 0.834
    found: Answers = {
        ("3", hose, "outer_diameter D"): Answer(
            _IMMERSION / share,
            "h over h/D of (11), which are rounded",
            tolerance=0.05 / share + _IMMERSION / share**2 * 0.0005,
        )
    }
    for name, symbol in _SYMBOLS.items():
        value, low, high = (_needed(name, _IMMERSION + half) for half in (0.0, -0.05, 0.05))
        found["3", hose, f"{name} {symbol}"] = Answer(
            value,
            "what h = 95.1 mm needs with the others; the tolerance is that of h",
            tolerance=max(abs(high - value), abs(low - value)),
        )
    depth, area = _immersed(**_HOSE)
    how = "floating position of the hose of Table 3"
    return found | {
        ("eq 11", hose, "immersion_depth h"): Answer(depth, how),
        ("eq 11", hose, "immersion_depth over outer_diameter h/D"): Answer(
            depth / _HOSE["outer_diameter"], how
        ),
        ("eq 11", hose, "submerged_section_area S1"): Answer(area, how),
        ("sec 5", hose, "immersed share of the diameter"): Answer(
            100 * depth / _HOSE["outer_diameter"], how
        ),
    }


def _immersed(
    *,
    outer_diameter: float,
    wall_thickness: float,
    water_density: float,
    wall_density: float,
    content_density: float,
) -> tuple[float, float]:
    """Depth [mm] and area under water [m2]."""
    found = immerse_hose(
        outer_diameter=outer_diameter / 1000,
        wall_thickness=wall_thickness / 1000,
        water_density=1000 * water_density,
        wall_density=1000 * wall_density,
        content_density=1000 * content_density,
    )
    return 1000 * float(found.immersion_depth), float(found.submerged_section_area)


def _needed(name: str, immersion: float) -> float:
    def miss(value: float) -> float:
        return _immersed(**(_HOSE | {name: value}))[0] - immersion

    return float(scipy.optimize.brentq(miss, 0.95 * _HOSE[name], 1.05 * _HOSE[name], xtol=1e-12))


def _waves() -> Answers:
    """Table 4."""
    waves = "level 4 waves"
    at_6 = float(wave_period_of(NUMBER, 6.0))
    return {
        ("4", waves, "wave_length L"): Answer(
            STANDARD_GRAVITY * PERIOD**2 / (2 * pi), "that of 3.57 s in deep water, g T2 / 2 pi"
        ),
        ("4", waves, "wave_period T"): Answer(
            at_6, "linear dispersion of 20 m at 6 m depth; 4.17 s at 3 m; 20 m / 5.6 m/s is 3.57"
        ),
        ("4", waves, "angular_frequency omega"): Answer(FREQUENCY, "2 pi / 3.57 s"),
        ("4", waves, "phase speed c"): Answer(LENGTH / PERIOD, "20 m / 3.57 s"),
        ("4", waves, "wave_height H"): Answer(
            HEIGHT * _load("Airy theory, t = 0.00 s", "vertical load F0") / -_inertia(),
            "vertical F0 at t = 0 in Table 7, where there is no drag",
        ),
    }


def _load(row: str, column: str) -> float:
    return table_of("Zhang-2015", "7")[row, column].value or float("nan")


def _inertia() -> float:
    """Greatest vertical inertia load of the whole cylinder in an Airy wave. [N/m]."""
    area = pi * _DIAMETER**2 / 4
    return INERTIA_COEFFICIENT * WATER_DENSITY * area * HEIGHT * FREQUENCY**2 / 2


def _drag(velocity: float) -> float:
    return 0.5 * DRAG_COEFFICIENT * WATER_DENSITY * _DIAMETER * velocity * abs(velocity)


def _coefficients() -> Answers:
    """(12), and the level of the velocities, from Table 7 at t = 0: all drag or all inertia."""
    crest = HEIGHT * GRAVITY * NUMBER / (2 * FREQUENCY)
    along = _load("Airy theory, t = 0.00 s", "horizontal load F0")
    upwards = _load("Airy theory, t = 0.00 s", "vertical load F0")
    share = float(np.sqrt(along / _drag(crest)))
    deep = NUMBER * 6.0
    level = (float(np.arccosh(share * np.cosh(deep))) - deep) / NUMBER
    # a load goes with the squared velocity
    slack = _HALF_DIGIT / (2 * along) / (NUMBER * float(np.tanh(deep)))
    return {
        ("eq 12", "all examples", "drag_coefficient C_D"): Answer(
            DRAG_COEFFICIENT * along / _drag(crest), "horizontal F0 at t = 0 in Table 7"
        ),
        ("eq 12", "all examples", "inertia_coefficient C_M"): Answer(
            INERTIA_COEFFICIENT * upwards / -_inertia(), "vertical F0 at t = 0 in Table 7"
        ),
        ("sec 3", "velocity and acceleration of the water", "elevation at which they are taken"):
            Answer(
                1000 * level,
                "horizontal F0 at t = 0 in Table 7, whose rounding is the tolerance; "
                "the centre of the hose is at -38.1 mm",
                tolerance=1000 * slack,
            ),
    }  # fmt: skip


def _depths() -> Answers:
    """Depths of the examples, from the inertia loads that depend on them."""
    time, load = 0.9, _load("Airy theory, t = 0.90 s", "horizontal load F0")
    crest = HEIGHT * GRAVITY * NUMBER / (2 * FREQUENCY)
    phase = -FREQUENCY * time
    coth = (load - _drag(crest * float(np.cos(phase)))) / (_inertia() * float(np.sin(phase)))
    second = -_load("Stokes theory, t = 0.00 s", "vertical load F0") / _inertia() - 1

    def miss(depth: float) -> float:
        deep = NUMBER * depth
        return float(1.5 * pi * HEIGHT / LENGTH * np.sinh(2 * deep) / np.sinh(deep) ** 4) - second

    airy, stokes = _EXAMPLES
    found: Answers = {
        ("sec 5.1", airy, "water_depth"): Answer(
            float(np.arctanh(1 / coth)) / NUMBER,
            "horizontal F0 at 0.90 s in Table 7, nearly all inertia",
        ),
        ("sec 5.2", stokes, "water_depth"): Answer(
            float(scipy.optimize.brentq(miss, 1.0, 10.0)),
            "vertical F0 at t = 0 in Table 7: inertia of both harmonics",
        ),
    }
    for section in ("sec 5.3", "conclusion"):
        for example, depth in _EXAMPLES.items():
            found[section, example, "water_depth"] = Answer(depth, "printed in sec 5.1 and 5.2 too")
    return found


def _claims() -> Answers:
    ratios = [cell.value or 0.0 for cell in cells_of_table("7") if cell.column.endswith("ratio P")]
    averages = [cell.value or 0.0 for cell in cells_of_table("8") if cell.row == "average"]
    table_1 = "a limit of d/L in Table 1 times the wave length of Table 4"
    return {
        ("sec 2", "Morison's equation", "greatest size of the structure over the wave length"):
            "a convention of the field; the hose has 0.006",
        ("sec 5", "Airy theory", "water depth, from"): Answer(0.2 * LENGTH, table_1),
        ("sec 5", "Stokes theory", "water depth, from"): Answer(0.1 * LENGTH, table_1),
        ("sec 5", "Stokes theory", "water depth, to"): Answer(0.2 * LENGTH, table_1),
        ("sec 5.3", "ratio P of all loads", "maximum"): Answer(
            max(ratios), "the greatest P of Table 7, Stokes theory at 4.00 s"),
        ("sec 5.3", "ratio P of all loads", "greatest average"): Answer(
            max(averages), "the greatest average of Table 8, P3, with all its rows"),
        ("conclusion", "wave loads", "improvement of the accuracy"): Answer(
            averages[0], "P1 of Table 8, the one average that stands; the others are 10 to 17 %"),
    }  # fmt: skip
