"""Recomputation of Zhang (2015): input of its tables, and claims of its text.

Settings were found from the tables that were computed with them.  No number here is a
recommendation.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015.
"""

from __future__ import annotations

from dataclasses import replace
from math import cosh, log, pi, sinh, tanh
from typing import Literal

import numpy as np
import scipy

from reduction.prediction.wave_load import ImmersedSection, immerse_hose, load_factors, wave_load
from reduction.prediction.wave_theory import (
    WaveHarmonics,
    airy_wave,
    breaking_height,
    stokes_wave,
    wave_period_of,
)
from reduction.published.printed_cells import Cell, cells_of, table_of
from reduction.published.reproduced_item import Answer, Answers, ReproducedItem, items_from
from reduction.record.errors import SettingsError
from reduction.record.measurement import STANDARD_GRAVITY, Floats

LENGTH, PERIOD, SPEED, HEIGHT = 20.0, 3.57, 5.6, 1.25
"""Table 4. [m], [s], [m/s], [m]."""

NUMBER, FREQUENCY = 2 * pi / LENGTH, 2 * pi / PERIOD
"""Wave number [rad/m] and angular frequency [rad/s]; Table 4 prints 1.93 for the latter."""

DEPTH = 6.0
"""Depth in the example of the Airy theory. [m]."""

GRAVITY = 9.8
"""Not printed. [m/s2]."""


def _cells_of_table(table: str) -> list[Cell]:
    """Cells of one table of the paper."""
    return [cell for cell in cells_of("Zhang-2015") if cell.table == table]


def _equation_answers() -> Answers:
    """Answers to the numbers in equations (1) to (17)."""
    return _load_equations() | _airy() | _stokes()


def _load_equations() -> Answers:
    drag, inertia, density = 1.2, 2.0, 1025.0
    section = printed_section()
    diameter = float(section.outer_diameter)
    factors = load_factors(
        section, drag_coefficient=drag, inertia_coefficient=inertia, water_density=density
    )
    load, morison = "horizontal wave load per length", "Morison's load of a whole cylinder"
    frequency = FREQUENCY
    length = 2 * pi * SPEED / frequency
    return {
        ("eq 1", load, "factor of the drag term"): Answer(
            float(factors.classic_drag) / (drag * density * diameter), morison),
        ("eq 1", load, "divisor of pi D2 in the inertia term"): Answer(
            inertia * density * pi * diameter**2 / float(factors.classic_inertia), morison),
        ("eq 5", "buoyancy F_B", "acceleration of gravity"): Answer(
            STANDARD_GRAVITY, "a weight over its mass"),
        ("eq 9", "load across the surface", "width of the vertical drag"): Answer(
            2000 * float(factors.vertical_drag) / (drag * density),
            "width of the submerged part, seen along a vertical flow"),
        ("eq 14", "wave number k", "divisor of 2 pi"): Answer(
            length, "speed over frequency of Table 4, c T, which are rounded",
            tolerance=length * 0.05 / SPEED),
    }  # fmt: skip


def _wave_of_depth(depth: float, *, stokes: bool) -> WaveHarmonics:
    theory = stokes_wave if stokes else airy_wave
    return theory(
        wave_height=HEIGHT,
        wave_period=float(wave_period_of(NUMBER, depth)),
        water_depth=depth,
        elevation=0.0,
    )


def _airy() -> Answers:
    wave = _wave_of_depth(DEPTH, stokes=False)
    period = 2 * pi / wave.angular_frequency
    slope = HEIGHT * STANDARD_GRAVITY * NUMBER / wave.angular_frequency
    depth = NUMBER * DEPTH
    acceleration = pi**2 * HEIGHT / period**2
    how = "Airy wave of the package, at the mean level"
    along, upwards = wave.horizontal_velocity[0], wave.vertical_velocity[0]
    return {
        ("eq 13", "Airy horizontal velocity", "divisor, with omega"): Answer(
            float(slope / along), how),
        ("eq 13", "Airy horizontal acceleration", "factor of pi2 H / T2"): Answer(
            float(wave.horizontal_acceleration[0] * np.tanh(depth) / acceleration), how),
        ("eq 15", "Airy vertical velocity", "divisor, with omega"): Answer(
            float(slope * np.tanh(depth) / upwards), how),
        ("eq 15", "Airy vertical acceleration", "factor of pi2 H / T2"): Answer(
            float(wave.vertical_acceleration[0] / acceleration), how),
    }  # fmt: skip


def _stokes() -> Answers:
    how = "second-order Stokes wave of the package, at the mean level"
    answers: Answers = {}
    for equation, direction, wide in (
        ("eq 16", "horizontal", np.cosh),
        ("eq 17", "vertical", np.sinh),
    ):
        spread = []
        depths = np.array([3.0, 4.0])
        for depth in depths:
            wave = _wave_of_depth(float(depth), stokes=True)
            period = 2 * pi / wave.angular_frequency
            velocity = getattr(wave, f"{direction}_velocity")[1]
            unit = pi * HEIGHT / period * pi * HEIGHT / LENGTH * wide(2 * NUMBER * depth)
            spread.append(float(velocity / unit))
        sinh = np.sinh(NUMBER * depths)
        power = -log(spread[1] / spread[0]) / log(sinh[1] / sinh[0])
        acceleration = getattr(wave, f"{direction}_acceleration")
        first = pi**2 * HEIGHT / period**2
        second = first * pi * HEIGHT / LENGTH * wide(2 * NUMBER * depth) / sinh[1] ** 4
        first *= wide(NUMBER * depth) / sinh[1]
        row = f"Stokes {direction}"
        answers |= {
            (equation, f"{row} velocity, second harmonic", "factor"): Answer(
                spread[0] * float(sinh[0]) ** 4, how),
            (equation, f"{row} velocity, second harmonic", "power of sinh(kd) in the divisor"):
                Answer(power, how + "; slope of a logarithm over the depth"),
            (equation, f"{row} acceleration, first harmonic", "factor"): Answer(
                float(acceleration[0] / first), how),
            (equation, f"{row} acceleration, second harmonic", "factor"): Answer(
                float(acceleration[1] / second), how),
        }  # fmt: skip
    return answers


_METHODS = {"Morison theory": "F0", "improved Morison theory": "F1"}

_SETTINGS = "(1), (10) with 1030 kg/m3, z = 0, omega = 2 pi / 3.57 s, g = 9.8 m/s2"

_WITH_15 = "velocity of (15) in both columns"

_AS_PRINTED = "as printed with (pi H / T) tanh kd in F0 and pi H / T in F1"


def _table_answers() -> Answers:
    """Answers to the loads, the extremes and the ratios."""
    answers: Answers = {}
    for table, last in (("5", 5.0), ("6", 10.0)):
        for cell in _cells_of_table(table):
            answers[cell.key] = _extreme(cell, last)
    for cell in _cells_of_table("7"):
        answers[cell.key] = _load(cell)
    for cell in _cells_of_table("8"):
        answers[cell.key] = _ratio(cell)
    return answers


def _wave(theory: str) -> WaveHarmonics:
    if theory.startswith("Stokes"):
        return replace(printed_stokes_wave(), angular_frequency=FREQUENCY)
    velocity = HEIGHT * GRAVITY * NUMBER / (2 * FREQUENCY) * tanh(NUMBER * DEPTH)
    return replace(
        printed_airy_wave(), angular_frequency=FREQUENCY, vertical_velocity=np.array([velocity])
    )


def loads_of_table_7(theory: str, time: Floats) -> dict[str, Floats]:
    """Columns of Table 7 at these times, by their names."""
    load = wave_load(
        _wave(theory),
        printed_section(),
        time,
        drag_coefficient=DRAG_COEFFICIENT,
        inertia_coefficient=INERTIA_COEFFICIENT,
        water_density=WATER_DENSITY,
        vertical_width="immersion depth",
    )
    columns: dict[str, Floats] = {}
    for direction in ("horizontal", "vertical"):
        classic, improved = getattr(load, f"{direction}_classic"), getattr(load, direction)
        columns |= {
            f"{direction} load F0": classic,
            f"{direction} load F1": improved,
            f"{direction} difference F2": classic - improved,
            f"{direction} ratio P": 100 * (1 - improved / classic),
        }
    return columns


def _load(cell: Cell) -> Answer:
    theory, _, rest = cell.row.partition(", t = ")
    time = np.array([float(rest.removesuffix(" s"))])
    how = _SETTINGS
    if theory.startswith("Airy") and cell.column.startswith("vertical"):
        how = f"{_SETTINGS}, {_WITH_15}; {_AS_PRINTED}"
    return Answer(float(loads_of_table_7(theory, time)[cell.column][0]), how)


def _extreme(cell: Cell, last: float) -> Answer:
    theory = "Airy theory" if cell.table == "5" else "Stokes theory"
    direction, _, end = cell.column.partition(" load, ")
    time = np.arange(round(10 * last) + 1) / 10
    series = loads_of_table_7(theory, time)[f"{direction} load {_METHODS[cell.row]}"]
    how = f"{end} on a grid of 0.1 s up to {last:g} s; {_SETTINGS}"
    if cell.table == "5" and direction == "vertical":
        how += f", {_WITH_15}; {_AS_PRINTED}"
    return Answer(float(series.max() if end == "maximum" else series.min()), how)


def _ratio(cell: Cell) -> Answer:
    """From Table 7 as corrected, rounded as there."""
    direction, theory = cell.column[4:-1].split(", ")
    values = np.array(
        [
            one.value
            for one in _cells_of_table("7")
            if one.row.startswith(theory) and one.column == f"{direction} ratio P"
        ],
        dtype=np.float64,
    )
    value = values.max() if cell.row == "maximum" else values.mean()
    how = f"{cell.row} of the {values.size} ratios in Table 7, as corrected"
    if theory.startswith("Stokes"):
        how += "; as printed without the row of 4.00 s"
    return Answer(float(value), how)


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

_HALF_DIGIT = 0.005  # in the loads of Table 7


def items() -> list[ReproducedItem]:
    """One item for every printed number of the paper."""
    return items_from("Zhang-2015", _answers())


def _answers() -> Answers:
    """Expected value of every printed number."""
    tables = _conditions() | _hose() | _waves() | _coefficients() | _table_answers()
    return tables | _equation_answers() | _depths() | _claims()


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
    for cell in _cells_of_table("1"):
        found.setdefault(cell.key, quoted)
    return found | {cell.key: "measured by others, and quoted" for cell in _cells_of_table("2")}


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
            HEIGHT * _printed_load("Airy theory, t = 0.00 s", "vertical load F0") / -_inertia(),
            "vertical F0 at t = 0 in Table 7, where there is no drag",
        ),
    }


def _printed_load(row: str, column: str) -> float:
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
    along = _printed_load("Airy theory, t = 0.00 s", "horizontal load F0")
    upwards = _printed_load("Airy theory, t = 0.00 s", "vertical load F0")
    share = float(np.sqrt(along / _drag(crest)))
    deep = NUMBER * 6.0
    level = (float(np.arccosh(share * np.cosh(deep))) - deep) / NUMBER
    # a load is proportional to the squared velocity
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
    time, load = 0.9, _printed_load("Airy theory, t = 0.90 s", "horizontal load F0")
    crest = HEIGHT * GRAVITY * NUMBER / (2 * FREQUENCY)
    phase = -FREQUENCY * time
    coth = (load - _drag(crest * float(np.cos(phase)))) / (_inertia() * float(np.sin(phase)))
    second = -_printed_load("Stokes theory, t = 0.00 s", "vertical load F0") / _inertia() - 1

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
    ratios = [cell.value or 0.0 for cell in _cells_of_table("7") if cell.column.endswith("ratio P")]
    averages = [cell.value or 0.0 for cell in _cells_of_table("8") if cell.row == "average"]
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
            averages[0],
            "P1 of Table 8, the one average that is correct; the others are 10 to 17 %"),
    }  # fmt: skip


PrintedLoad = Literal["classic", "improved"]

DRAG_COEFFICIENT = 1.2
"""Eq. (12). [1]"""

INERTIA_COEFFICIENT = 2.0
"""Eq. (12). [1]"""

WATER_DENSITY = 1030.0
"""Density of Tables 5-7; Table 3 prints 1.025 g/cm3, used for the immersion. [kg m-3]"""

_WAVE_HEIGHT = 1.25  # m, Table 4

_WAVE_LENGTH = 20.0  # m, Table 4

_WAVE_PERIOD = 3.57  # s, Table 4; in the amplitudes

_ANGULAR_FREQUENCY = 1.76  # rad/s: 2 pi / 3.57; Table 4 prints 1.93

_GRAVITY = 9.8  # m/s2: not printed

_WAVE_NUMBER = 2 * pi / _WAVE_LENGTH  # eq. (14) prints 2 pi / T

_AIRY_DEPTH = 6.0  # m, sec. 5.1

_STOKES_DEPTH = 3.0  # m, sec. 5.2

# loads are at z = 0, the mean level; sec. 3 states the centre of the hose, 38 mm below


def printed_section() -> ImmersedSection:
    """Hose of the examples with the rounded immersion used in the tables.

    Notes
    -----
    `reduction.prediction.wave_load.immerse_hose` gives 95.124 mm and 0.0090994 m2 for it.

    Examples
    --------
    >>> print((printed_section().immersion_depth / printed_section().outer_diameter).round(3))
    0.834
    """
    return ImmersedSection(
        outer_diameter=np.array(0.114),
        submerged_section_area=np.array(0.0091),
        immersion_depth=np.array(0.0951),
    )


def printed_airy_wave(load: PrintedLoad = "improved") -> WaveHarmonics:
    """Linear wave, 6 m deep, as used in Tables 5 and 7.

    Notes
    -----
    Eq. (13): velocity H g k / (2 omega), acceleration 2 pi^2 H / T^2 coth kd; one would be the
    derivative of the other if length and period matched.  The vertical velocity of eq. (15) is
    H g k / (2 omega) tanh kd; the tables have pi H / T tanh kd in the classic column and
    pi H / T in the improved one.  This causes the 8.4 % between them at the largest vertical
    loads; with one velocity for both it is 16.7 %.

    Examples
    --------
    >>> wave = printed_airy_wave()
    >>> print(wave.horizontal_velocity.round(4), wave.vertical_velocity.round(4))
    [1.0933] [1.1]
    """
    depth = _WAVE_NUMBER * _AIRY_DEPTH
    rise = pi * _WAVE_HEIGHT / _WAVE_PERIOD
    vertical = {"classic": rise * tanh(depth), "improved": rise}
    if load not in vertical:
        raise SettingsError(
            "the paper has no such load", found=repr(load), needed="'classic' or 'improved'"
        )
    acceleration = 2 * pi**2 * _WAVE_HEIGHT / _WAVE_PERIOD**2
    return WaveHarmonics(
        wave_number=_WAVE_NUMBER,
        angular_frequency=_ANGULAR_FREQUENCY,
        elevation=np.array([_WAVE_HEIGHT / 2]),
        horizontal_velocity=np.array(
            [_WAVE_HEIGHT * _GRAVITY * _WAVE_NUMBER / (2 * _ANGULAR_FREQUENCY)]
        ),
        vertical_velocity=np.array([vertical[load]]),
        horizontal_acceleration=np.array([acceleration / tanh(depth)]),
        vertical_acceleration=np.array([-acceleration]),
    )


def printed_stokes_wave() -> WaveHarmonics:
    """Stokes' wave of second order, 3 m deep, as used in Tables 6 and 7.

    Notes
    -----
    Eq. (16) and (17), with omega rounded to 1.76 in the phase and T = 3.57 s in the amplitudes.
    The second harmonic of the surface is not printed; it is that of
    `reduction.prediction.wave_theory.stokes_wave`, and no load depends on it.

    Examples
    --------
    >>> print(printed_stokes_wave().horizontal_velocity.round(3))
    [1.494 0.389]
    """
    depth = _WAVE_NUMBER * _STOKES_DEPTH
    rise = pi * _WAVE_HEIGHT / _WAVE_PERIOD
    second = 3 / 4 * rise * pi * _WAVE_HEIGHT / _WAVE_LENGTH / sinh(depth) ** 4
    horizontal = np.array([rise / tanh(depth), second * cosh(2 * depth)])
    vertical = np.array([rise, second * sinh(2 * depth)])
    frequency = 2 * pi / _WAVE_PERIOD * np.array([1.0, 2.0])
    surface = _WAVE_NUMBER * _WAVE_HEIGHT**2 / 16
    surface *= cosh(depth) * (2 + cosh(2 * depth)) / sinh(depth) ** 3
    return WaveHarmonics(
        wave_number=_WAVE_NUMBER,
        angular_frequency=_ANGULAR_FREQUENCY,
        elevation=np.array([_WAVE_HEIGHT / 2, surface]),
        horizontal_velocity=horizontal,
        vertical_velocity=vertical,
        horizontal_acceleration=frequency * horizontal,
        vertical_acceleration=-frequency * vertical,
    )
