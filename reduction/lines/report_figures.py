r"""Data of the figures in the five reports: corrected curves, printed points and own lines.

The list of figures, with the reason where one is not drawn, is in ``published/data/figures.csv``.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
.. [3] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication and Mechanical Properties,"
   Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004.
.. [4] S. Zhang et al., "Wave Loads Computation for Offshore Floating Hose Based on Partially
   Immersed Cylinder Model of Improved Morison Formula," Open Petroleum Eng. J., vol. 8, 2015.
.. [5] H. Wang et al., "Prediction Method and Validation Study of Tensile Performance of
   Reinforced Armor Layer in Marine Flexible Pipe/Cables," J. Mar. Sci. Eng., vol. 10, 642, 2022.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from importlib.resources import files
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.experiments.strength_statistics import fit_exposure_trend
from reduction.lines.line_lookup import look_up
from reduction.lines.line_rank import JUST_OUTSIDE
from reduction.lines.lookup_product import LineSource
from reduction.lines.published_source import published_sources
from reduction.prediction.armour import ArmourDesign, ArmourTheory, predict_armour
from reduction.prediction.hose_geometry import NEUTRAL_ANGLE, cord_strain_chart
from reduction.published import whoi_2005_10
from reduction.published.cg_cells import Pages
from reduction.published.cg_claims import strength_over_years
from reduction.published.printed_cells import Cell, ReportId, cells_of, number_of, printed_step
from reduction.published.published_lines import POUND, published_static_test
from reduction.published.reproduced_item import ReproducedItem
from reduction.published.zhang_2015 import loads_of_table_7
from reduction.quantities.names import quantity as quantity_of
from reduction.quantities.units import scale_to_si
from reduction.record.errors import DataError
from reduction.record.measurement import Floats
from reduction.stages.moduli.stepwise_test import reduce_stepwise
from reduction.stages.three_parameter_line.line_model import (
    apparent_spring_constant,
    hysteresis_energy,
)

Form = Literal["curve", "points", "surface", "edges"]

_INCH, _PSI = scale_to_si("inch", "length")[0], scale_to_si("psi", "stress")[0]

_CG: ReportId = "CG-D-39-80"

_TETHERS: ReportId = "WHOI-2005-10"

_K_AP, _K_0 = "apparent_spring_constant", "quasi_static_spring_constant"

_PLAITED = "nylon-8-strand-plaited-0.5in-{}"

_BRAIDED = tuple(f"nylon-double-braid-{size}in-new" for size in ("0.5", "0.75", "1", "1.25"))

_POINTS, _SIDE = 121, 15

_ROUNDING = 1e-12


@dataclass(frozen=True)
class FigureRow:
    """A numbered figure: its subject, and the data it is drawn from, or why it is not drawn."""

    report: str
    figure: str
    shows: str
    drawn: str
    from_or_why_not: str

    @property
    def is_drawn(self) -> bool:
        """Whether its numbers are printed or can be derived."""
        return self.drawn == "yes"


@dataclass(frozen=True)
class Axis:
    """Label and SI unit of an axis; angles are in radians."""

    words: str
    unit: str
    is_log: bool = False
    names: tuple[str, ...] = ()


@dataclass(frozen=True)
class Series:
    """Numbers drawn in one colour, in SI.

    ``z`` is the value of a surface, or of the corners of a cube, over ``x`` and ``y``; ``w`` is the
    frequency of the corners.  For printed points ``computed`` is the value of the curve there (NaN
    without one), ``half`` the reading error, and ``errata`` names the known errors of each.
    ``colour`` numbers the lines, ``dash`` the series of each line.
    """

    name: str
    form: Form
    x: Floats
    y: Floats
    z: Floats = field(default_factory=lambda: np.empty(0))
    w: Floats = field(default_factory=lambda: np.empty(0))
    computed: Floats = field(default_factory=lambda: np.empty(0))
    half: Floats = field(default_factory=lambda: np.empty(0))
    errata: tuple[str, ...] = ()
    colour: int = 0
    dash: int = 0
    is_own: bool = False


@dataclass(frozen=True)
class ReportFigure:
    """One figure in numbers.

    ``is_flipped`` where the value is on the horizontal axis, ``is_synthetic`` where own lines are.
    """

    row: FigureRow
    axes: tuple[Axis, ...]
    series: tuple[Series, ...]
    is_flipped: bool = False
    is_synthetic: bool = False


def figure_rows() -> list[FigureRow]:
    """Every numbered figure of the five reports.

    Examples
    --------
    >>> [row.from_or_why_not for row in figure_rows() if row.figure == "24"]
    ['photograph or drawing, no curve', 'record not printed; sec. 4.1 prints two of its loads']
    """
    text = (files("reduction.published") / "data" / "figures.csv").read_text("utf-8")
    return [FigureRow(**row) for row in csv.DictReader(text.splitlines())]


def figure_in_numbers(row: FigureRow, own: Sequence[LineSource] = ()) -> ReportFigure:
    """Numbers of a figure, with those of own lines that have the same quantity.

    Examples
    --------
    >>> (row,) = (one for one in figure_rows() if (one.report, one.figure) == ("CG-D-39-80", "4"))
    >>> points = figure_in_numbers(row).series[-1]
    >>> print((points.y / 44482.216).round(1), (points.computed / 44482.216).round(1))
    [11. 12. 17.5] [11.9 10.8 17.5]
    >>> points.errata
    ('CG-62', 'CG-62', '')
    """
    made = _DRAWN.get((row.report, row.figure))
    if made is None:
        raise DataError(
            f"Figure {row.figure} of {row.report} is not drawn", found=row.from_or_why_not,
            needed="a figure whose numbers are printed", hint="`reduction figures` lists them.",
        )  # fmt: skip
    found = made(row, own)
    has_own = any(one.is_own for one in found.series)
    return replace(
        found, is_synthetic=has_own and any("synthetic data" in line.notes for line in own)
    )


def _level(line: LineSource, quantity: str, name: str, coded: ArrayLike) -> Floats:
    """Levels of a factor in SI from coded ones."""
    surface, place = line.surfaces[quantity], line.factor_names.index(name)
    low, high = float(surface.low[place]), float(surface.high[place])
    return np.asarray((low + high) / 2 + np.asarray(coded) * (high - low) / 2)


def _is_near(line: LineSource, quantity: str, amplitude: float) -> bool:
    """Whether an amplitude was tested, or is near enough for a ranking."""
    low, high = _level(line, quantity, "tension_amplitude", [-1.0, 1.0])
    return bool(max(low - amplitude, amplitude - high) <= JUST_OUTSIDE * (high - low) / 2)


@dataclass(frozen=True)
class _Curves:
    """Figures of one quantity, or of several of one unit, over a tension.

    ``amplitudes`` are coded, or in newtons; ``claim`` is the column of the sentences that give
    points, at a tension of ``at`` (in newtons, or as a share of the break strength).
    """

    quantities: tuple[str, ...]
    across: str
    lines: tuple[str, ...]
    frequency: float = 0.3
    amplitudes: tuple[float, ...] = (0.0,)
    is_share: bool = False
    is_flipped: bool = False
    claim: str = ""
    at: float = 0.0

    def __call__(self, row: FigureRow, own: Sequence[LineSource]) -> ReportFigure:
        """Draw the figure."""
        lines = [published_sources()[name] for name in self.lines]
        series = [one for place, line in enumerate(lines) for one in self._of(line, place)]
        if self.claim:
            series.append(self._printed(lines))
        # where an experiment has a surface its single tests are in the surface
        has_surface = any(quantity in line.surfaces for line in own for quantity in self.quantities)
        for place, line in enumerate(own, start=len(lines)):
            tests = () if has_surface else self._levels(line, place)
            series += [replace(one, is_own=True) for one in (*self._of(line, place), *tests)]
        of_share = Axis("mean tension over rated break strength", "1")
        axes = (
            of_share if self.is_share else Axis(self.across.replace("_", " "), "N"),
            Axis(" and ".join(map(_words, self.quantities)), quantity_of(self.quantities[0]).unit),
        )
        return ReportFigure(row, axes, tuple(series), self.is_flipped)

    def _of(self, line: LineSource, colour: int) -> Iterator[Series]:
        scale = 1 / line.rated_break_strength if self.is_share else 1.0
        for quantity in self.quantities:
            told = line.name if len(self.quantities) == 1 else f"{line.name}, {_words(quantity)}"
            if set(line.factor_names) == {"frequency", self.across, "tension_amplitude"} and (
                quantity in line.surfaces
            ):
                tension = _level(line, quantity, self.across, np.linspace(-1.0, 1.0, _POINTS))
                for dash, coded in enumerate(self.amplitudes):
                    amplitude = coded
                    if abs(coded) <= 1:
                        amplitude = float(_level(line, quantity, "tension_amplitude", coded))
                    at = tension[tension >= amplitude * (1 - _ROUNDING)]  # a line that stays taut
                    if _is_near(line, quantity, amplitude):
                        found = look_up(
                            line, quantity, extrapolate="flag", frequency=self.frequency,
                            mean_tension=at, tension_amplitude=amplitude,
                        )  # fmt: skip
                        name = f"{told}, ±{amplitude / POUND:,.0f} lbf ({amplitude / 1e3:.3g} kN)"
                        yield Series(
                            name, "curve", at * scale, found.value, colour=colour, dash=dash
                        )
            for curve in line.curves:
                if (curve.quantity, curve.variable) == (quantity, self.across):
                    at = np.linspace(curve.low, curve.high, _POINTS)
                    across: dict[str, Any] = {self.across: at}
                    found = look_up(line, quantity, extrapolate="flag", **across)
                    dash = self.quantities.index(quantity)
                    yield Series(told, "curve", at * scale, found.value, colour=colour, dash=dash)

    def _levels(self, line: LineSource, colour: int) -> Iterator[Series]:
        scale = 1 / line.rated_break_strength if self.is_share else 1.0
        for levels in line.levels:
            if levels.quantity in self.quantities and self.across in levels.variables:
                at = levels.at[:, levels.variables.index(self.across)] * scale
                name = f"{line.name}, {_words(levels.quantity)}, each test"
                half = 1.96 * levels.random_standard_uncertainty
                nothing = np.full(at.size, np.nan)
                yield Series(name, "points", at, levels.value, computed=nothing, half=half,
                             errata=("",) * at.size, colour=colour)  # fmt: skip

    def _printed(self, lines: Sequence[LineSource]) -> Series:
        """Points from sentences of the text, for the quantity and lines that are drawn."""
        (quantity,) = self.quantities
        scale = scale_to_si("%", "strain")[0] if quantity == "strain" else 1e4 * POUND
        found = []
        for cell in cells_of(_CG):
            for line in lines:
                if cell.column != self.claim or _row_of(line) != cell.row:
                    continue
                tension = self.at * (line.rated_break_strength if self.at < 1 else 1.0)
                levels: dict[str, Any] = {self.across: tension}
                if quantity in line.surfaces:
                    levels |= {
                        "frequency": self.frequency,
                        "tension_amplitude": self.amplitudes[-1],
                    }
                value = look_up(line, quantity, extrapolate="flag", **levels).value
                place = tension / (line.rated_break_strength if self.is_share else 1.0)
                half = scale * printed_step(cell.printed) / 2
                printed = scale * (number_of(cell.printed) or np.nan)
                found.append((place, printed, float(value), half, _fault(cell)))
        return _points("printed", found)


def _points(name: str, rows: Sequence[tuple[float, float, float, float, str]]) -> Series:
    """Printed points: place, value, value of the curve, reading error, erratum."""
    numbers = np.array([row[:4] for row in rows]).reshape(-1, 4).T
    return Series(name, "points", numbers[0], numbers[1], computed=numbers[2], half=numbers[3],
                  errata=tuple(row[4] for row in rows), colour=-1)  # fmt: skip


def _fault(cell: Cell) -> str:
    """Erratum that replaces the printed number, or leaves it open."""
    return cell.erratum if cell.confidence else ""


def _words(quantity: str) -> str:
    return {_K_AP: "K_ap", _K_0: "K_0", "hysteresis_energy": "H", "relaxation_time": "τ"}.get(
        quantity, quantity.replace("_", " ")
    )


def _row_of(line: LineSource) -> str:
    """Key of a line in the tables, such as ``nylon | double braid | 3/4 in | new``."""
    sizes = {0.5: "1/2", 0.75: "3/4", 1.0: "1", 1.25: "1 1/4"}
    size = sizes.get(round(line.diameter / _INCH, 4), "")
    return f"{line.material} | {line.construction} | {size} in | {line.condition}"


@dataclass(frozen=True)
class _Surfaces:
    """A quantity over mean tension and amplitude at one frequency, with K_0 where requested."""

    quantity: str
    lines: tuple[str, ...]
    frequency: float
    with_rest: bool = False

    def __call__(self, row: FigureRow, own: Sequence[LineSource]) -> ReportFigure:
        """Draw the figure."""
        published = [published_sources()[name] for name in self.lines]
        having = [line for line in own if self.quantity in line.surfaces]
        series = []
        for place, line in enumerate((*published, *having)):
            tension, amplitude = np.meshgrid(
                *(
                    _level(line, self.quantity, name, np.linspace(-1.0, 1.0, _SIDE))
                    for name in ("mean_tension", "tension_amplitude")
                )
            )
            found = look_up(line, self.quantity, extrapolate="flag", frequency=self.frequency,
                            mean_tension=tension, tension_amplitude=amplitude)  # fmt: skip
            name = f"{line.name}, {_words(self.quantity)}"
            series.append(Series(name, "surface", tension, amplitude, found.value, colour=place,
                                 is_own=line in having))  # fmt: skip
            if self.with_rest and line is published[0]:
                rest = look_up(line, _K_0, extrapolate="flag", mean_tension=tension).value
                series.append(Series(f"{line.name}, K_0", "surface", tension, amplitude, rest,
                                     colour=len(published) + len(having)))  # fmt: skip
        axes = (Axis("mean tension", "N"), Axis("tension amplitude", "N"),
                Axis(_words(self.quantity), quantity_of(self.quantity).unit))  # fmt: skip
        return ReportFigure(row, axes, tuple(series))


def _cube(row: FigureRow, own: Sequence[LineSource]) -> ReportFigure:
    """Figure 6 of [1]_: K_ap at the corners, along the twelve edges."""
    series = []
    having = [line for line in own if _K_AP in line.surfaces]
    for place, line in enumerate((published_sources()[_PLAITED.format("new")], *having)):
        names = ("frequency", "mean_tension", "tension_amplitude")
        corners = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
        at: dict[str, Any] = {
            name: _level(line, _K_AP, name, column)
            for name, column in zip(names, corners.T, strict=True)
        }
        value = look_up(line, _K_AP, extrapolate="flag", **at).value
        series.append(
            Series(line.name, "edges", at["mean_tension"], at["tension_amplitude"], value,
                   at["frequency"], colour=place, is_own=line in having)
        )  # fmt: skip
    axes = (Axis("mean tension", "N"), Axis("tension amplitude", "N"), Axis("K_ap", "N"),
            Axis("frequency", "Hz"))  # fmt: skip
    return ReportFigure(row, axes, tuple(series))


@dataclass(frozen=True)
class _Segments:
    """Moduli, or loads, over the strain of tethers: Tables 5 and 6 of [2]_."""

    tests: tuple[str, ...]
    tethers: tuple[str, ...] = ("new", "used")
    is_load: bool = False
    with_weights: bool = False

    def __call__(self, row: FigureRow, own: Sequence[LineSource]) -> ReportFigure:
        """Draw the figure."""
        items: dict[tuple[str, str, str], dict[str, ReproducedItem]] = {}
        for item in whoi_2005_10.items():
            words = item.cell.row.split(" ")
            if item.cell.table in ("5", "6") and words[1] == "rubber" and words[0] in self.tests:
                key = item.cell.table, words[0], words[3].rstrip(",")
                items.setdefault(key, {})[f"{item.cell.row}|{item.cell.column}"] = item
        series: list[Series] = []
        for (table, test, tether), cells in items.items():
            # the raw segments of loads are finer; the summary contains these segments too
            is_wanted = table == "5" or not (self.is_load or len(self.tests) > 1)
            if tether in self.tethers and is_wanted:
                series += self._of(table, test, tether, cells)
        if self.with_weights:
            series += _of_weights()
        quantity = "branch_tension" if self.is_load else "tangent_modulus"
        for place, line in enumerate(own, start=2):
            for curve in line.curves:
                if (curve.quantity, curve.variable) == (quantity, "strain"):
                    name = f"{line.name}, {curve.branch}"
                    at, value = curve.at, curve.value
                    series.append(Series(name, "curve", at, value, colour=place, is_own=True,
                                         dash=int(curve.branch == "descending")))  # fmt: skip
        axes = (Axis("strain", "1"), Axis("tension", "N") if self.is_load else
                Axis("tangent modulus", "Pa"))  # fmt: skip
        return ReportFigure(row, axes, tuple(series))

    def _of(
        self, table: str, test: str, tether: str, cells: Mapping[str, ReproducedItem]
    ) -> Iterator[Series]:
        steps, points = [], []
        for name in dict.fromkeys(key.partition("|")[0] for key in cells):
            ends = {one: cells[f"{name}|segment_{one}"] for one in _ENDS}
            low, high = (_used(ends[f"strain_{end}"]) for end in ("low", "high"))
            modulus = ends["modulus"]
            loads = [ends[f"tension_{end}"] for end in ("low", "high")]
            # without a known correct value there is no curve
            is_open = any(
                one.verdict == "open" or np.isnan(one.recomputed)
                for one in (loads if self.is_load else [modulus])
            )
            values = [_used(one) for one in loads] if self.is_load else [modulus.recomputed] * 2
            if is_open:
                values = [np.nan, np.nan]
            steps += [(low, values[0]), (high, values[1]), (np.nan, np.nan)]
            if self.is_load:
                points += [
                    _printed_load(ends[f"strain_{end}"], ends[f"tension_{end}"])
                    for end in ("low", "high")
                ]
            else:
                printed = number_of(modulus.cell.printed) or np.nan
                points.append((
                    (low + high) / 2, printed, modulus.recomputed, modulus.tolerance,
                        _fault(modulus.cell)
                ))  # fmt: skip
        scale = POUND if self.is_load else _PSI
        x, y = np.array(steps).T
        many = len(self.tests) > 1
        colour = self.tests.index(test) if many else self.tethers.index(tether)
        dash = self.tethers.index(tether) if many else int(table == "6")
        name = f"{test} {tether}, Table {table}"
        yield Series(name, "curve", x, scale * y, colour=colour, dash=dash)
        read = _points(f"{name}, printed", points)
        yield replace(read, y=scale * read.y, computed=scale * read.computed,
                      half=scale * read.half, colour=colour, dash=dash)  # fmt: skip


_ENDS = ("strain_low", "strain_high", "tension_low", "tension_high", "modulus")


def _used(item: ReproducedItem) -> float:
    """Number of a cell as corrected, or as printed where it is right or open."""
    value = item.cell.value
    return float(number_of(item.cell.printed) or np.nan) if value is None else value


def _printed_load(
    strain: ReproducedItem, load: ReproducedItem
) -> tuple[float, float, float, float, str]:
    """A point as printed: both of its numbers may be wrong."""
    errata = filter(None, (_fault(one.cell) for one in (strain, load)))
    x, y = (float(number_of(one.cell.printed) or np.nan) for one in (strain, load))
    if x > 10 * _used(strain):  # a decimal comma
        x = _used(strain)
    return x, y, load.recomputed, load.tolerance, " ".join(dict.fromkeys(errata))


def _of_weights() -> Iterator[Series]:
    """Slopes between the weights of Table 4 of [2]_, on a tether of 1 in."""
    found = reduce_stepwise(published_static_test(), area=np.pi / 4 * _INCH**2)
    middle = (found.strain[1:] + found.strain[:-1]) / 2
    for dash, (word, way) in enumerate((("up", 1), ("down", 2))):
        keep = (found.interval_branch == way) & np.isfinite(found.interval_modulus)
        yield Series(f"static test, 1997, {word}", "curve", middle[keep],
                     found.interval_modulus[keep], colour=6, dash=dash)  # fmt: skip


def _strength(row: FigureRow, own: Sequence[LineSource]) -> ReportFigure:
    """Figure 15 of [1]_."""
    del own  # breaks of own lines are not lines
    years, mean, scatter, counts = map(np.array, strength_over_years(Pages(cells_of(_CG))))
    line = fit_exposure_trend(years, mean, scatter, counts)
    at = np.linspace(0.0, 5.0, 11)

    def trend(years: Floats) -> Floats:
        return line.intercept + line.slope * years

    half = np.where(np.isfinite(scatter), scatter, scatter[0])
    points = zip(years, mean, trend(years), half, ("",) * years.size, strict=True)
    read = _points("printed", list(points))
    series = (
        Series("straight line", "curve", at, POUND * trend(at)),
        replace(read, y=POUND * read.y, computed=POUND * read.computed, half=POUND * read.half),
    )
    axes = Axis("exposure [years]", ""), Axis("tensile strength", "N")
    return ReportFigure(row, axes, series)


def _abrasion(row: FigureRow, own: Sequence[LineSource]) -> ReportFigure:
    """Figure 23 of [1]_."""
    del own
    means, deviations = (
        {cell.row: cell.value for cell in cells_of(_CG)
         if (cell.table, cell.column) == ("20", f"abrasion_cycles {kind}")}
        for kind in ("mean", "standard deviation")
    )  # fmt: skip
    points = [
        (float(place), float(value or np.nan), np.nan, float(deviations[name] or np.nan), "")
        for place, (name, value) in enumerate(means.items())
    ]
    names = tuple("\n".join(name.split(" | ")[:2]) for name in means)
    axes = Axis("", "", names=names), Axis("cycles to failure", "")
    return ReportFigure(row, axes, (_points("mean and standard deviation", points),))


def _dissipation(row: FigureRow, own: Sequence[LineSource]) -> ReportFigure:
    """Figure A-1 of [1]_: both relative to their greatest value, and where H is a tenth of it."""
    del own
    x = np.geomspace(0.01, 100.0, 401)
    series = []
    for place, ratio in enumerate((2.0, 3.0)):
        line: dict[str, Any] = {
            "quasi_static_spring_constant": 1.0, "dissipation_spring_constant": ratio,
            "relaxation_time": 1.0, "frequency": x / (2 * np.pi),
        }  # fmt: skip
        energy = hysteresis_energy(tension_amplitude=1.0, **line)
        # u / (1 + u^2) with u = (1 + K_1/K_0) x is greatest at 1, and a tenth of that above it at
        tenth = (10 + np.sqrt(99.0)) / (1 + ratio)
        top = float(hysteresis_energy(
            tension_amplitude=1.0, **line | {"frequency": 1 / (2 * np.pi * (1 + ratio))}
        ))  # fmt: skip
        told = f"K_1 = {ratio:g} K_0"
        series += [
            Series(f"H / H_max, {told}", "curve", x, energy / top, colour=place),
            Series(f"K_ap / (K_0 + K_1), {told}", "curve", x,
                   apparent_spring_constant(**line) / (1 + ratio), colour=place, dash=1),
            Series(f"H = 0.1 H_max, {told}", "curve", np.full(2, tenth), np.array([0.0, 1.0]),
                   colour=place, dash=2),
        ]  # fmt: skip
    axes = Axis("ωτ", "", is_log=True), Axis("share of the greatest value", "")
    return ReportFigure(row, axes, tuple(series))


def _cords(row: FigureRow, own: Sequence[LineSource]) -> ReportFigure:
    """Figure 7 of [3]_."""
    del own
    strain = np.linspace(0.0, 1.6, _POINTS)
    angle = np.array([np.radians(45.0), NEUTRAL_ANGLE, *np.radians([60.0, 64.0, 68.0])])
    chart = cord_strain_chart(angle, strain)
    series = [
        Series(f"{np.degrees(one):.4g}°", "curve", strain, cord, colour=place)
        for place, (one, cord) in enumerate(zip(angle, chart.cord_strain, strict=True))
    ]
    # cords carry load again where they have their rest length again
    slack = chart.pick_up_strain[2:]
    found = [(float(at), 0.0, 0.0, 1e-9, "") for at in slack]
    axes = Axis("hose strain", "1"), Axis("cord strain", "1")
    return ReportFigure(row, axes, (*series, _points("pick-up", found)))


def _waves(
    row: FigureRow, own: Sequence[LineSource], *, theory: str, columns: tuple[str, ...]
) -> ReportFigure:
    """Figures 4 to 9 of [4]_."""
    del own
    time = np.linspace(0.0, 5.0 if theory == "Airy" else 10.0, 501)
    found = loads_of_table_7(theory, time)
    series = []
    for place, column in enumerate(columns):
        points = []
        for cell in cells_of("Zhang-2015"):
            if (cell.table, cell.column) == ("7", column) and cell.row.startswith(theory):
                at = float(cell.row.partition(" t = ")[2].removesuffix(" s"))
                value = float(loads_of_table_7(theory, np.array([at]))[column][0])
                half = 0.51 * printed_step(cell.printed)
                points.append((at, number_of(cell.printed) or 0.0, value, half, _fault(cell)))
        series += [
            Series(column, "curve", time, found[column], colour=place),
            replace(_points(f"{column}, Table 7", points), colour=place),
        ]
    return ReportFigure(row, (Axis("time", "s"), Axis("load", "N m-1")), tuple(series))


def _wires(
    row: FigureRow, own: Sequence[LineSource], *, theories: tuple[ArmourTheory, ...]
) -> ReportFigure:
    """Figures 7(a) and 9(a) of [5]_, for any core radius."""
    del own
    angle = np.radians(np.linspace(10.0, 80.0, 141))
    design = ArmourDesign(angle, 2.5e-3, 25e-3, 210e9)
    series = []
    for place, theory in enumerate(theories):
        force = predict_armour(design, 1e-3, theory=theory).axial_force[:, 0]
        series.append(Series(theory, "curve", angle, force, colour=place, dash=place))
    axes = Axis("winding angle", "rad"), Axis("axial tension", "N")
    return ReportFigure(row, axes, tuple(series))


_EXPOSED = (
    "nylon-double-braid-0.5in-new", "nylon-double-braid-0.5in-5-years",
    _PLAITED.format("new"), _PLAITED.format("5-years"),
)  # fmt: skip

_POLYESTER = (
    "polyester-double-braid-0.5in-new", "polyester-double-braid-0.5in-5-years",
    "polyester-8-strand-plaited-0.5in-4-years",
)  # fmt: skip

_BOTH = (_PLAITED.format("new"), _PLAITED.format("5-years"))

_STRAIN = partial(_Curves, ("strain",), "tension", is_flipped=True, is_share=True,
                  claim="quasi_static_strain at 30 %RBS", at=0.30)  # fmt: skip

_TESTS = tuple(f"T-{number}" for number in range(1, 7))

_DRAWN: Mapping[tuple[str, str], Callable[[FigureRow, Sequence[LineSource]], ReportFigure]] = {
    (_CG, "3"): _Curves((_K_AP, _K_0), "mean_tension", _BOTH),
    (_CG, "4"): _Curves(
        (_K_AP,), "mean_tension", _BRAIDED, 0.1, (-1.0, 1.0, 1600 * POUND),
        claim="apparent_spring_constant at 4,000 and 1,600 lb", at=4000 * POUND,
    ),
    (_CG, "6"): _cube,
    (_CG, "7"): _Surfaces(_K_AP, _BOTH, 0.5, with_rest=True),
    (_CG, "8"): _Curves((_K_0,), "mean_tension", _BRAIDED),
    (_CG, "9"): _Curves((_K_0,), "mean_tension", _POLYESTER),
    (_CG, "10"): _Curves((_K_0,), "mean_tension", _EXPOSED),
    (_CG, "11"): _Curves((_K_0,), "mean_tension", _BRAIDED, is_share=True),
    (_CG, "12"): _STRAIN(_BRAIDED),
    (_CG, "13"): _STRAIN(_EXPOSED),
    (_CG, "14"): _STRAIN(_POLYESTER),
    (_CG, "15"): _strength,
    (_CG, "16"): _Surfaces("hysteresis_energy", _BOTH[:1], 0.1),
    (_CG, "17"): _Surfaces("relaxation_time", _BOTH[:1], 0.1),
    (_CG, "23"): _abrasion,
    (_CG, "A-1"): _dissipation,
    (_TETHERS, "22"): _Segments(_TESTS, ("new",), is_load=True),
    (_TETHERS, "23"): _Segments(_TESTS, ("used",), is_load=True),
    **{(_TETHERS, f"{25 + place}"): _Segments((test,)) for place, test in enumerate(_TESTS)},
    (_TETHERS, "31"): _Segments(_TESTS),
    (_TETHERS, "35"): _Segments(("T-2", "T-4", "T-5"), with_weights=True),
    ("WHOI-2004-06", "7"): _cords,
    **{
        ("Zhang-2015", f"{4 + 2 * place + step}"): partial(
            _waves, theory=theory, columns=(f"{direction} load F0", f"{direction} load F1")
        )
        for place, theory in enumerate(("Airy", "Stokes"))
        for step, direction in enumerate(("horizontal", "vertical"))
    },
    **{
        ("Zhang-2015", f"{8 + place}"): partial(
            _waves, theory=theory, columns=("horizontal difference F2", "vertical difference F2")
        )
        for place, theory in enumerate(("Airy", "Stokes"))
    },
    ("Wang-2022", "7(a)"): partial(_wires, theories=("exact",)),
    ("Wang-2022", "9(a)"): partial(_wires, theories=("exact", "intermediate", "small")),
}  # fmt: skip
