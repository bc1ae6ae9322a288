"""The line to be exported: curve, range, uncertainty, properties.

References
----------
.. [1] M. Bigon and G. Regazzoni, "The Morrow Guide to Knots," Quill, New York, 1982, p. 14,
   "Comparison between fibers used in ropemaking."
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005, Tables 5, 6.
.. [3] H. Imai and M. Iri, "An optimal algorithm for approximating a piecewise linear function,"
   J. Inf. Process., vol. 9, no. 3, pp. 159-162, 1986.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from reduction.lines.export_dynamics import Syrope, Viscoelasticity
from reduction.lines.lookup_product import LineSource
from reduction.quantities.digits import plain_number
from reduction.record.contributions import Component
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Floats, Integers, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class CurveSpread:
    """Standard uncertainties of the tensions of a curve, NaN where they are not known.

    Parameters
    ----------
    standard : ndarray, shape (n_points,)
        Both parts. [N]
    random : ndarray, shape (n_points,), optional
        Part that is not shared with other curves; None where the parts are not separate. [N]
    component : tuple of Component, length n_components
        Errors that the curve shares with others.
    contribution : ndarray, shape (n_components, n_points)
        Signed contribution of each shared error to the tension. [N]
    """

    standard: Floats
    random: Floats | None = None
    component: tuple[Component, ...] = ()
    contribution: Floats = field(default_factory=lambda: np.empty((0, 0)))

    def __post_init__(self) -> None:
        """Check that all arrays are of the same points, and make them read-only."""
        n_points = self.standard.size
        of_random = n_points if self.random is None else self.random.size
        rows = (len(self.component), n_points)
        if of_random != n_points or (self.component and self.contribution.shape != rows):
            raise DataError(
                "parts of the uncertainty of a curve are not of the same points",
                found=f"{n_points} uncertainties, {of_random} random ones, contributions of shape "
                f"{self.contribution.shape} to {len(self.component)} errors",
            )

    @property
    def shared(self) -> Floats:
        """Uncertainty from shared errors, all together. [N]."""
        if not self.component:
            return np.where(np.isnan(self.standard), np.nan, 0.0)
        return np.asarray(np.sqrt(np.sum(self.contribution**2, axis=0)))

    def at(self, wanted: Floats, strain: Floats) -> CurveSpread:
        """The same at other strains of the curve.

        Interpolated linearly between the points; NaN beyond them, where nothing was measured.

        Examples
        --------
        >>> both = CurveSpread(np.array([1.0, 3.0]))
        >>> both.at(np.array([0.0, 0.2, 0.3]), np.array([0.1, 0.3])).standard
        array([nan,  2.,  3.])
        """

        def read(values: Floats) -> Floats:
            return np.interp(wanted, strain, values, left=np.nan, right=np.nan)

        rows = np.array([read(row) for row in self.contribution]).reshape(-1, wanted.size)
        return CurveSpread(
            read(self.standard),
            None if self.random is None else read(self.random),
            self.component,
            rows if self.component else np.empty((0, wanted.size)),
        )


SEA_WATER = 1025.0
"""Density that converts a wet mass into a displaced volume. [kg m-3]"""

FIBRE_DENSITY = {"nylon": 1140.0, "polyester": 1380.0}
"""Density by material, from the specific gravity in [1]_. [kg m-3]"""


@dataclass(frozen=True)
class Hydrodynamics:
    """Drag and added-mass coefficients, transverse and axial, with their source.

    The transverse drag area is diameter times length, the axial one pi times that, as in MoorDyn.
    """

    normal_drag: float
    axial_drag: float
    normal_added_mass: float
    axial_added_mass: float
    source: str


CYLINDER = Hydrodynamics(
    1.2,
    0.0,
    1.0,
    0.0,
    "assumed, not measured: a smooth cylinder across the flow, zero along it",
)


@dataclass(frozen=True)
class CycleDamping:
    """A dashpot beside the curve of a test that reproduces the hysteresis energy of its cycles.

    Parameters
    ----------
    coefficient : float
        Tension over the rate of strain. [N s]
    frequency : float
        Frequency of the cycles. [Hz]
    strain_amplitude : float
        Half the strain range of the cycles. [1]
    hysteresis_energy : float
        Energy of one cycle. [J m-1]
    standard_uncertainty : float
        Uncertainty of that energy. [J m-1]
    apparent_stiffness : float
        K_ap of the test; NaN where not known. [N]
    """

    coefficient: float
    frequency: float
    strain_amplitude: float
    hysteresis_energy: float
    standard_uncertainty: float
    apparent_stiffness: float = math.nan


def cycle_damping(
    hysteresis_energy: float,
    frequency: float,
    strain_amplitude: float,
    standard_uncertainty: float = math.nan,
    apparent_stiffness: float = math.nan,
) -> CycleDamping:
    r"""Dashpot of a line from the hysteresis energy of its sinusoidal cycle.

    .. math:: c = \frac{H}{2 \pi^2 f \varepsilon_a^2}

    since c times the rate of strain, over a cycle of strain amplitude :math:`\varepsilon_a`, does
    the work :math:`\pi (2 \pi f c) \varepsilon_a^2`.

    Parameters
    ----------
    hysteresis_energy : float
        Energy of one cycle. [J m-1]
    frequency : float
        [Hz]
    strain_amplitude : float
        Half the strain range. [1]
    standard_uncertainty : float, optional
        Uncertainty of the energy. [J m-1]
    apparent_stiffness : float, optional
        K_ap of the cycle. [N]

    Returns
    -------
    damping : CycleDamping
        Holds at this frequency and amplitude.

    Raises
    ------
    DataError
        If any of these numbers is not above zero.

    Examples
    --------
    The work of a unit dashpot at 1/(2 pi) Hz and unit amplitude is pi.

    >>> round(cycle_damping(math.pi, 1 / (2 * math.pi), 1.0).coefficient, 12)
    1.0
    """
    found = (hysteresis_energy, frequency, strain_amplitude)
    if not all(value > 0 for value in found):
        raise DataError(
            "no dashpot reproduces the cycles of the test",
            found=f"H {hysteresis_energy:.4g} J/m, {frequency:.4g} Hz, strain amplitude "
            f"{strain_amplitude:.4g}",
            needed="all above zero",
        )
    coefficient = hysteresis_energy / (2 * math.pi**2 * frequency * strain_amplitude**2)
    return CycleDamping(
        coefficient,
        frequency,
        strain_amplitude,
        hysteresis_energy,
        standard_uncertainty,
        apparent_stiffness,
    )


def damping_words(damping: CycleDamping) -> str:
    """Cycle that the dashpot beside a table represents, and the limits of the dashpot."""
    energy, spread = damping.hysteresis_energy, 1.96 * damping.standard_uncertainty
    known = f" +-{plain_number(spread, 2)} (95 percent)" if math.isfinite(spread) else ""
    doubt = "DOUBTFUL, the interval includes zero: " if spread >= energy else ""
    return (
        f"{doubt}internal damping {plain_number(damping.coefficient, 4)} N s, by which a sinusoidal"
        f" cycle of {damping.frequency:.4g} Hz and strain amplitude {damping.strain_amplitude:.4g}"
        f" has the hysteresis energy of the test, {plain_number(energy, 4)} J/m{known}; at twice"
        " the frequency it has twice as much, which was not measured"
    )


@dataclass(frozen=True)
@read_only_arrays
class ExportLine:
    """A line in the form that a mooring code needs.

    Parameters
    ----------
    name : str
        Becomes the line type; characters other than letters, digits, ``_`` and ``-`` become ``_``.
    strain, tension : ndarray, shape (n_points,)
        One curve; strain increases, tension does not decrease. [1], [N]
    curve : str
        Kind of curve, in words: branch, cycles, or mean of several. Never a loop.
    tested : tuple of float
        Least and greatest tested strain; NaN where nothing was tested. [1]
    turns : tuple of float
        Turning strains of a mean cycle, where its curve is continued to them beyond the trimmed
        branches; else NaN. [1]
    diameter : float
        NaN where not stated. [m]
    linear_density, wet_linear_density : float
        In air and in water; NaN where not stated. [kg m-1]
    rated_break_strength : float
        NaN where not stated. [N]
    unstretched_length : float
        Length of the whole line; NaN where a curve holds for any length. [m]
    material : str
        Material of the fibre, where stated.
    viscoelasticity : Viscoelasticity, optional
        Given where it was found.
    syrope : Syrope, optional
        Given where it is known.
    damping : CycleDamping, optional
        Damping of the cycles whose mean is the curve.
    spread : CurveSpread, optional
        Uncertainty of the tensions, where it is known.
    hydrodynamics : Hydrodynamics
        Coefficients with their source.
    sources : tuple of str
        Source of every number, its range, and the errata that affect it.
    notes : tuple of str
        Joins, gaps and other remarks.
    is_synthetic : bool
        Nothing was tested: the numbers are synthetic.
    """

    name: str
    strain: Floats
    tension: Floats
    curve: str
    tested: tuple[float, float]
    turns: tuple[float, float] = (math.nan, math.nan)
    diameter: float = math.nan
    linear_density: float = math.nan
    wet_linear_density: float = math.nan
    rated_break_strength: float = math.nan
    unstretched_length: float = math.nan
    material: str = ""
    viscoelasticity: Viscoelasticity | None = None
    syrope: Syrope | None = None
    damping: CycleDamping | None = None
    spread: CurveSpread | None = None
    hydrodynamics: Hydrodynamics = field(default_factory=lambda: CYLINDER)
    sources: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    is_synthetic: bool = False

    def __post_init__(self) -> None:
        """Check that the kind of the curve and its source are stated."""
        for name, needed in (
            ("name", "letters or digits"),
            ("curve", "a branch or a mean, in words"),
        ):
            if not re.search(r"\w", getattr(self, name)):
                raise SettingsError(f"a line for export has no {name}", needed=needed)
        if self.wet_linear_density >= self.linear_density:
            raise SettingsError(
                f"{self.name} is not lighter in water than in air",
                found=f"{self.wet_linear_density:g} kg/m in water, {self.linear_density:g} kg/m in "
                "air",
                needed="a wet linear density below the dry one",
            )
        if not self.sources:
            raise SettingsError(f"{self.name} has no source", needed="where its numbers are from")

    @property
    def measured(self) -> tuple[float, float]:
        """Least and greatest strain with a measured tension, of the branches or of the turns."""
        (low, high), (lower, upper) = self.tested, self.turns
        return (lower if lower < low else low, upper if upper > high else high)

    @property
    def identifier(self) -> str:
        """The name as one ASCII word that every code accepts; accents are removed."""
        bare = unicodedata.normalize("NFKD", self.name)
        bare = "".join(sign for sign in bare if not unicodedata.combining(sign))
        word = re.sub(r"[^A-Za-z0-9_-]+", "_", re.sub("-{2,}", "-", bare)).strip("-")
        if not word.strip("_"):
            raise SettingsError(
                "the name has no character that a mooring code accepts", found=self.name,
                needed="letters A to Z or digits", hint="csv, json and netcdf accept any name.",
            )  # fmt: skip
        return word

    @property
    def volume_diameter(self) -> tuple[float, str]:
        """Diameter of the cylinder that displaces as much water, and how it was found. [m]."""
        displaced = (self.linear_density - self.wet_linear_density) / SEA_WATER
        words = f"dry and wet mass in water of {SEA_WATER:g} kg/m3"
        density = FIBRE_DENSITY.get(self.material.strip().lower(), math.nan)
        if not math.isfinite(displaced):
            displaced = self.linear_density / density
            words = (
                f"the mass per length and the density of {self.material} fibre, {density:g} kg/m3 "
                "(Bigon and Regazzoni, The Morrow Guide to Knots, p. 14), since no wet mass is "
                "stated"
            )
        if displaced > 0:
            diameter = math.sqrt(4 * displaced / math.pi)
            nominal = "" if math.isnan(self.diameter) else (
                f"; drag refers to it, and not to the nominal {1000 * self.diameter:.4g} mm"
            )  # fmt: skip
            found = f"{1000 * diameter:.4g} mm, of the displaced volume"
            return diameter, f"diameter: {found}, from {words}{nominal}"
        is_solid = "rubber" in self.material.lower()
        return (
            self.needed("diameter"),
            "diameter: nominal"
            + ("" if is_solid else "; the displaced volume of a fibre rope is smaller"),
        )

    def needed(self, name: str) -> float:
        """A property that a format needs; `SettingsError` where it is not stated."""
        value = float(getattr(self, name))
        if not (math.isfinite(value) and value > 0):
            raise SettingsError(
                f"the {name.replace('_', ' ')} of {self.name} is not known, and this format needs "
                "it",
                needed=f"{name} above zero",
                hint=f"Give --{name.replace('_', '-')} with a unit.",
            )
        return value


_DOUBT = 0.05


def siblings_of(line: LineSource, others: Sequence[LineSource]) -> tuple[LineSource, ...]:
    """Other tests of the same tether in the same condition."""
    if not line.is_tether:
        return ()
    same = ("kind", "material", "construction", "condition", "diameter")
    return tuple(
        one
        for one in others
        if one.name != line.name and all(getattr(one, key) == getattr(line, key) for key in same)
    )


def start_against(
    strain: Floats, tension: Floats, branch: str, siblings: Sequence[LineSource]
) -> tuple[str, ...]:
    """Difference between the straight line from 0 0 and tensions measured there in other tests.

    Notes
    -----
    The windows of a tether ([2]_) begin at the stretch at which it was cycled.
    """
    said = []
    for other in siblings:
        for curve in other.curves:
            if curve.quantity != "branch_tension" or curve.branch != branch or not curve.at.size:
                continue
            below = (curve.at > 0) & (curve.at < strain[0]) & (curve.value > 0)
            if not below.any():
                continue
            at, measured = curve.at[below], curve.value[below]
            off = tension[0] * at / strain[0] / measured - 1
            worst = int(np.argmax(np.abs(off)))
            doubt = "DOUBTFUL: " if abs(off[worst]) > _DOUBT else ""
            said.append(
                f"{doubt}the straight start is off by {100 * off[worst]:+.0f} percent at strain"
                f" {plain_number(at[worst], 4)}, where {other.name} has"
                f" {plain_number(measured[worst], 4)} N; exported without the test, the tether has"
                " what each measured"
            )
    return tuple(said)


LIFT = 1e-6
"""Share of the greatest tension that is added along the curve where it does not rise. [1]"""

LEAST_SHARE = 1e-3
"""Share of the greatest tension below which errors are taken relative to that share. [1]"""

_HALVINGS = 56

_ENOUGH, _LOOSER = 0.01, 1.25

_ROUNDING = 1e-12

_DIGITS = 10


class _Close(Protocol):
    @property
    def share(self) -> float: ...
    @property
    def local(self) -> float: ...


@dataclass(frozen=True)
@read_only_arrays
class ThinnedCurve:
    """A strictly rising curve from 0 0; arrays have the shape (n_points,).

    ``error`` is the greatest difference in tension from the given curve [N], ``share`` the same
    over the greatest tension, ``local`` the greatest difference over the tension at that point, and
    ``words`` a description of the changes.
    """

    strain: Floats
    tension: Floats
    error: float
    share: float
    local: float
    words: str


def curve_from_zero(strain: ArrayLike, tension: ArrayLike) -> tuple[Floats, Floats, str]:
    """Begin a curve at zero strain and zero tension, and make it rise strictly.

    Parameters
    ----------
    strain : array_like, shape (n_points,)
        Strictly increasing. [1]
    tension : array_like, shape (n_points,)
        Not decreasing. [N]

    Returns
    -------
    strain : ndarray, shape (n_kept,)
        The first is zero. [1]
    tension : ndarray, shape (n_kept,)
        The first is zero. [N]
    words : str
        Description of the added points.

    Raises
    ------
    DataError
        If there are fewer than two points, one is not finite, the curve turns back or falls (a
        loop), ends at zero tension, or has tension at zero strain.

    Notes
    -----
    Points without strain or without tension are left out. The last of them with a strain is where
    the line becomes taut; below it the line is slack. Without such a point, a straight line joins
    0 0 and the first point; it was not measured. Where the curve does not rise, one millionth of
    the greatest tension is added evenly over the strain.

    Examples
    --------
    >>> strain, tension, words = curve_from_zero([0.1, 0.3], [200.0, 500.0])
    >>> print(strain, tension, words)
    [0.  0.1 0.3] [  0. 200. 500.] a straight line from zero to the first point at strain 0.1
    """
    at = np.asarray(strain, dtype=np.float64)
    load = np.asarray(tension, dtype=np.float64)
    if at.ndim != 1 or at.shape != load.shape or at.size < 2:
        raise DataError(
            "a curve has fewer than two points", found=f"{at.shape} strains, {load.shape} tensions"
        )
    if not (np.isfinite(at).all() and np.isfinite(load).all()):
        raise DataError("a curve has values that are not numbers", needed="finite numbers")
    back = (np.diff(at) <= 0) | (np.diff(load) < 0)
    if back.any():
        first = int(np.argmax(back))
        raise DataError(
            f"the curve reverses at {int(back.sum())} of {back.size} steps: a loop cannot be"
            " exported",
            found=f"strain {at[first]:g} to {at[first + 1]:g}, tension {load[first]:g} to "
            f"{load[first + 1]:g} N after point {first + 1}",
            needed="one branch, or a mean: strain rising, tension not falling",
        )
    if np.any((at <= 0) & (load > 0)):
        raise DataError(
            "a curve has tension at zero strain",
            found=f"{load[at <= 0].max():g} N at strain {at[at <= 0].max():g}",
            needed="strain of the length at zero tension",
        )
    kept = load > 0
    if not kept.any():
        raise DataError("a curve ends at zero tension", found=f"{load[-1]:g} N")
    slack = at[(at > 0) & ~kept]
    zero: Floats = np.zeros(1)
    if slack.size:
        at = np.concatenate([zero, slack[-1:], at[kept]])
        load = np.concatenate([zero, zero, load[kept]])
        words = f"slack from zero to strain {slack[-1]:g}"
    else:
        has_zero = bool(np.any(~kept & (at == 0)))
        at, load = np.concatenate([zero, at[kept]]), np.concatenate([zero, load[kept]])
        words = "" if has_zero else (
            f"a straight line from zero to the first point at strain {at[1]:g}"
        )  # fmt: skip
    if np.any(np.diff(load) <= _ROUNDING * load[-1]):
        load = load + LIFT * load[-1] * at / at[-1]
        added = f"{LIFT:g} of the greatest tension added over the strain, where it did not rise"
        words = f"{words}; {added}" if words else added
    return at, load, words


CONTINUED = 0.3
"""Share of its greatest strain by which a curve continues straight in a table. [1]"""

_LAST = 0.02  # share of the greatest strain over which the end slope is taken


def end_slope(strain: Floats, tension: Floats) -> float:
    """Slope of the last fiftieth of a curve that begins at 0 0. [N].

    Examples
    --------
    >>> print(round(end_slope(np.array([0.0, 0.5, 1.0]), np.array([0.0, 20.0, 60.0])), 3))
    80.0
    """
    end = float(strain[-1])
    below = float(np.interp((1 - _LAST) * end, strain, tension))
    return (float(tension[-1]) - below) / (_LAST * end)


def continued_tension(line: ExportLine, strain: ArrayLike) -> Floats:
    """Tension expected at a strain: that of the curve from 0 0, continued straight beyond its end.

    Parameters
    ----------
    line : ExportLine
        Line with its curve.
    strain : array_like, shape (...)
        At least zero. [1]

    Returns
    -------
    tension : ndarray, shape (...)
        [N]
    """
    at, load, _ = curve_from_zero(line.strain, line.tension)
    wanted = np.asarray(strain, dtype=np.float64)
    beyond = np.maximum(wanted - at[-1], 0.0) * end_slope(at, load)
    return np.asarray(np.interp(wanted, at, load) + beyond)


@dataclass(frozen=True)
class _StraightCycle:
    """The straight line through the turns of a cycle, and the energy that it lacks.

    Parameters
    ----------
    strain, tension : float
        At the middle of the cycle. [1], [N]
    strain_amplitude : float
        Half the strain range. [1]
    stiffness : float
        Tension range over strain range, K_ap. [N]
    hysteresis_energy : float
        [J m-1]
    holds : str
        Levels of the cycle, in words.
    """

    strain: float
    tension: float
    strain_amplitude: float
    stiffness: float
    hysteresis_energy: float
    holds: str

    @property
    def slack_strain(self) -> float:
        """Strain at which the straight line has no tension. [1]."""
        return self.strain - self.tension / self.stiffness


_IN_A_CYCLE = 2000


def _loop_tensions(line: ExportLine, damping: CycleDamping) -> Floats:
    """Tensions of a curve and its dashpot over a sinusoid up to the end of the curve. [N]."""
    phase = 2 * np.pi * np.arange(_IN_A_CYCLE) / _IN_A_CYCLE
    strain = float(line.strain[-1]) + damping.strain_amplitude * (np.sin(phase) - 1)
    rate = 2 * np.pi * damping.frequency * damping.strain_amplitude * np.cos(phase)
    return continued_tension(line, strain) + damping.coefficient * rate


def loop_stiffness(line: ExportLine, damping: CycleDamping) -> float:
    """K_ap of a curve with its dashpot, over the cycle of the dashpot. [N]."""
    return float(np.ptp(_loop_tensions(line, damping))) / (2 * damping.strain_amplitude)


def beside_dashpot(line: ExportLine) -> ExportLine:
    """The curve of a test with its ends moved so that curve and dashpot have the K_ap of the test.

    Unchanged where there is no dashpot, or no straight end.

    Notes
    -----
    The tension of the dashpot is part of the greatest and least tension. Beside a curve that ends
    at these it would count twice: with a loss factor of 0.3, K_ap would be 3 % too high. The
    straight line therefore ends where curve and dashpot together reach these tensions.

    Examples
    --------
    A spring of 100 N with a dashpot of 30 N at the frequency, known up to 0.8 of the amplitude.

    >>> strain, reach = np.array([1.0, 1.1, 1.9, 2.0]), 50 * math.hypot(1, 0.3)
    >>> tension = np.array([150 - reach, 110.0, 190.0, 150 + reach])
    >>> damping = cycle_damping(math.pi * 30 * 0.25, 1 / (2 * math.pi), 0.5)
    >>> line = ExportLine("a", strain, tension, "mean", (1.1, 1.9), sources=("none",),
    ...                   damping=damping)
    >>> print(beside_dashpot(line).tension.round(2))
    [100. 110. 190. 200.]
    """
    damping = line.damping
    if damping is None:
        return line
    turns, made = line.tension[[0, -1]], line
    for end, inner, side in ((0, 1, -1), (-1, -2, 1)):
        if not (side * (line.strain[end] - line.tested[end]) > 0 and turns[end] > 0):
            continue
        low, high = sorted((float(line.tension[inner]), float(turns[end])))
        for _ in range(_HALVINGS):
            tension = made.tension.copy()
            tension[end] = (low + high) / 2
            made = replace(line, tension=tension)
            if side * np.max(side * _loop_tensions(made, damping)) > turns[end]:
                high = float(tension[end])
            else:
                low = float(tension[end])
    begins, ends = made.tension[[0, -1]] - turns
    if made is line:
        return line
    said = (
        f"beside its dashpot the table begins {plain_number(begins, 3)} N above the least tension "
        f"of the cycle and ends {plain_number(-ends, 3)} N below the greatest: with both, K_ap of "
        f"that cycle is {plain_number(loop_stiffness(made, damping), 6)} N"
    )
    return replace(made, notes=(*line.notes, said))


_CLOSE_TO_MEAN = 0.01  # share of the mean tension, the limit of `--verify`


def straight_cycle(line: ExportLine) -> _StraightCycle | None:
    """The cycle of a line about its mean; None where none is known.

    Notes
    -----
    For a test, the cycle whose upper turn is the end of its curve; for a line with surfaces, the
    cycle at the levels, about the curve at the mean tension.

    Examples
    --------
    >>> strain = np.array([0.0, 1.0])
    >>> line = ExportLine("a", strain, 100 * strain, "mean", (0, 1), sources=("none",),
    ...                   damping=cycle_damping(math.pi, 1 / (2 * math.pi), 0.25))
    >>> found = straight_cycle(line)
    >>> print(found.strain, found.tension, round(found.stiffness, 2))
    0.75 75.0 101.27
    """
    part, damping = line.viscoelasticity, line.damping
    if damping is not None:
        amplitude = damping.strain_amplitude
        mean = float(line.strain[-1]) - amplitude
        turns = continued_tension(line, np.array([mean - amplitude, mean + amplitude]))
        known = math.isfinite(damping.apparent_stiffness)
        return _StraightCycle(
            mean, float(turns.mean()), amplitude,
            damping.apparent_stiffness if known else loop_stiffness(line, damping),
            damping.hysteresis_energy,
            f"{damping.frequency:.4g} Hz, strain {mean:.4g} +- {amplitude:.4g}",
        )  # fmt: skip
    if part is None or not (part.mean_tension > 0 and math.isfinite(part.tension_amplitude)):
        return None
    strain, tension, _ = curve_from_zero(line.strain, line.tension)
    if part.mean_tension > tension[-1]:
        return None
    stiffness = part.apparent_stiffness
    return _StraightCycle(
        float(np.interp(part.mean_tension, tension, strain)), part.mean_tension,
        part.tension_amplitude / stiffness, stiffness,
        part.hysteresis_energy_at(part.frequency, part.tension_amplitude), part.holds,
    )  # fmt: skip


def without_damping(line: ExportLine) -> str:
    """Damping that a form without damping leaves out; empty where no cycle of the line is known."""
    cycle = straight_cycle(line)
    if cycle is None:
        return ""
    of, stiffness = "that cycle", cycle.stiffness
    if line.damping is not None:
        # K_ap of the cycle includes the tension of the dashpot, which this form does not have
        half = cycle.strain_amplitude
        ends = continued_tension(line, np.array([cycle.strain - half, cycle.strain + half]))
        of, stiffness = "the curve over that cycle", float(np.ptp(ends)) / (2 * half)
    return (
        "no damping in this form: the hysteresis energy of a cycle,"
        f" {plain_number(cycle.hysteresis_energy, 4)} J/m at {cycle.holds}, is NOT included; K_ap"
        f" of {of} is {plain_number(stiffness, 6)} N"
    )


def about_mean(line: ExportLine) -> str:
    """Position of a line of constant stiffness at its mean tension; empty without a mean tension.

    Examples
    --------
    >>> strain = np.linspace(0.0, 0.06, 61)
    >>> part = Viscoelasticity(800e3, 1500e3, 840e3, mean_tension=20e3)
    >>> line = ExportLine("a", strain, 400e3 * strain + 6e6 * strain**2, "mean", (0, 0.06),
    ...                   sources=("none",), viscoelasticity=part)
    >>> print(about_mean(line)[-67:])
    at the strain of the curve the tension is 33 percent above the mean
    """
    part = line.viscoelasticity
    if part is None or not part.mean_tension > 0:
        return ""
    strain, tension, _ = curve_from_zero(line.strain, line.tension)
    if part.mean_tension > tension[-1]:
        return ""
    of_curve = float(np.interp(part.mean_tension, tension, strain))
    of_spring = part.mean_tension / part.static_stiffness
    share, off = 1 + of_curve - of_spring, of_curve / of_spring - 1
    said = (
        f"a spring constant holds about a mean: {plain_number(part.mean_tension, 6)} N is at "
        f"strain {of_curve:.6g} of the curve, and at {of_spring:.6g} of this line"
    )
    if abs(off) < _CLOSE_TO_MEAN or not share > 0:
        return said
    return (
        f"{said}. Multiply the length of your line and all numbers of EA and BA by {share:.6g} "
        f"and divide the mass by it, or at the strain of the curve the tension is "
        f"{plain_number(100 * abs(off), 2)} percent {'above' if off > 0 else 'below'} the mean"
    )


def thin_curve(strain: ArrayLike, tension: ArrayLike, *, most: int) -> ThinnedCurve:
    """Choose few points of a curve so that straight lines between them stay close to the curve.

    Parameters
    ----------
    strain : array_like, shape (n_points,)
        Strictly increasing. [1]
    tension : array_like, shape (n_points,)
        Not decreasing. [N]
    most : int
        Greatest number of points to keep, including 0 0; at least 3.

    Returns
    -------
    curve : ThinnedCurve
        From 0 0, strictly rising, values with ten digits.

    Raises
    ------
    DataError
        If the curve cannot be exported; see `curve_from_zero`.

    Notes
    -----
    A line works at small tensions and breaks at great ones. First the error relative to the local
    tension (to a thousandth of the greatest one where the local one is smaller) is minimised; then
    the error over the greatest tension, with the first limited to a hundredth, or to a quarter more
    than its minimum where that exceeds a hundredth.

    From each kept point, the next is the farthest point whose chord leaves all points between
    within a tolerance (a cone of slopes, [3]_). The tolerance is found by bisection. The error is
    then computed from the points as written.

    Examples
    --------
    >>> at = np.linspace(0, 1, 5000)
    >>> curve = thin_curve(at, 100 * at**2, most=30)
    >>> print(curve.strain.size, curve.error < 0.1, curve.local < 0.01)
    30 True True
    """
    at, load, words = curve_from_zero(strain, tension)
    high = float(load[-1])
    chosen: Integers = np.arange(at.size)
    if at.size > most:
        scale = np.maximum(load, LEAST_SHARE * high)
        chosen, least = _fewest(at, load, lambda share: share * scale, most)
        near = max(_ENOUGH, _LOOSER * least) * scale
        closer, _ = _fewest(at, load, lambda share: np.minimum(share * high, near), most)
        chosen = closer if closer.size > 2 else chosen
    kept, held = _written(at[chosen]), _written(load[chosen])
    if np.any(np.diff(kept) <= 0) or np.any(np.diff(held) <= 0):
        kept, held = at[chosen], load[chosen]
    # tension of the given points, where they have strain and tension of their own
    given, measured = np.asarray(strain, dtype=np.float64), np.asarray(tension, dtype=np.float64)
    own = given >= 0
    difference = np.interp(given[own], kept, held) - np.maximum(measured[own], 0.0)
    error = float(np.abs(difference).max(initial=0.0))
    local = local_share(difference, measured[own], high)
    return ThinnedCurve(kept, held, error, error / high, local, words)


def local_words(curve: _Close) -> str:
    """Error of a curve, over the greatest tension and over that of each point.

    A tension below `LEAST_SHARE` of the greatest counts as that much.
    """
    return (
        f"({100 * curve.share:.2g} % of the greatest tension, {100 * curve.local:.2g} % of the "
        "local tension)"
    )


def local_share(difference: ArrayLike, tension: ArrayLike, greatest: float) -> float:
    """Greatest difference over the local tension, or over a thousandth of the greatest one.

    Examples
    --------
    >>> print(local_share([1.0, 10.0], [20.0, 1000.0], 1000.0))
    0.05
    """
    scale = np.maximum(np.asarray(tension, dtype=np.float64), LEAST_SHARE * greatest)
    return float(np.max(np.abs(np.asarray(difference)) / scale, initial=0.0))


def _fewest(
    at: Floats, load: Floats, allowed: Callable[[float], Floats], most: int
) -> tuple[Integers, float]:
    """Points for the least share whose tolerances leave few enough points, and that share."""
    chosen: Integers = np.array([0, at.size - 1])
    low, high = 0.0, 1 / LEAST_SHARE
    for _ in range(_HALVINGS):
        middle = max((low + high) / 2, _ROUNDING)
        found = _within(at, load, allowed(middle), most)
        if found is None:
            low = middle
        else:
            chosen, high = found, middle
    return chosen, high


def _within(at: Floats, load: Floats, tolerance: Floats, most: int) -> Integers | None:
    """Points whose chords stay within the tolerances; None where there are too many."""
    last = at.size - 1
    chosen = [0]
    while chosen[-1] < last:
        if len(chosen) == most:
            return None
        here = chosen[-1]
        run, rise = at[here + 1 :] - at[here], load[here + 1 :] - load[here]
        slope = rise / run
        steepest = np.minimum.accumulate((rise + tolerance[here + 1 :]) / run)
        flattest = np.maximum.accumulate((rise - tolerance[here + 1 :]) / run)
        reached = np.flatnonzero((slope >= flattest) & (slope <= steepest))
        chosen.append(here + 1 + int(reached[-1]))
    return np.array(chosen)


def _written(values: Floats) -> Floats:
    """The values after rounding to ten digits."""
    return np.array([float(f"{value:.{_DIGITS}g}") for value in values])


_SAME = 1e-9

_OVER_RATED = 1.5  # a rope breaks above its rated strength, but not so far

_GREATEST_FILL = 1.02  # of the diameter: it and the wet mass (fresh water perhaps) are rounded

_LEAST_FILL = 0.6  # of the diameter: a third of the area, where ropes fill two thirds


def range_of(line: ExportLine) -> str:
    """Tested strains of a curve, and the state below them."""
    of_branches = line.tested
    if not of_branches[0] == of_branches[0]:
        return "nothing was tested"
    low, high = line.measured
    words = f"tested from strain {plain_number(low, 6)} to {plain_number(high, 6)}"
    if (low, high) != of_branches:
        words += f" (both branches from {' to '.join(plain_number(at, 6) for at in of_branches)})"
    if low > _SAME * high:
        words += (
            f"; the start, a straight line from zero to strain {low:.6g}, was NOT measured on this"
            " curve"
        )
    return words


def doubts_first(notes: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Notes about doubts, and the other notes, each in their order.

    Examples
    --------
    >>> doubts_first(["a join", "DOUBTFUL: the line floats"])
    (('DOUBTFUL: the line floats',), ('a join',))
    """
    doubts = tuple(text for text in notes if text.startswith("DOUBTFUL"))
    return doubts, tuple(text for text in notes if text not in doubts)


def guards_of(line: ExportLine) -> tuple[str, ...]:
    """Properties of a line that are inconsistent, or hold over a part only.

    Notes
    -----
    A rope of a fibre heavier than water does not float; a rope has no more mass than a rod of its
    fibre, and no less than a third of it; densities of fibres as in [1]_.
    """
    words = [range_of(line)]
    most = float(line.tension.max())
    if most > _OVER_RATED * line.rated_break_strength:  # not so where none is stated
        words.append(
            f"DOUBTFUL: the curve goes to {most:.4g} N, above the break strength of"
            f" {line.rated_break_strength:.4g} N: check its unit"
        )
    drag = line.hydrodynamics
    if drag.axial_drag > drag.normal_drag:
        words.append(
            f"DOUBTFUL: the axial drag coefficient, {drag.axial_drag:g}, is above the transverse"
            f" one, {drag.normal_drag:g}: --drag has the transverse one first"
        )
    mass, diameter = line.linear_density, line.diameter
    if not (math.isfinite(mass) and math.isfinite(diameter)):
        return tuple(words)
    volume, said = line.volume_diameter
    words.append(said)
    is_stated = math.isfinite(line.wet_linear_density)
    if mass < SEA_WATER * math.pi / 4 * volume**2 and not is_stated:
        words.append(
            f"DOUBTFUL: the line floats: {mass:.4g} kg/m displaces"
            f" {SEA_WATER * math.pi / 4 * volume**2:.4g} kg/m of water. Unless it does, state"
            " --wet-linear-density"
        )
    elif volume > (_GREATEST_FILL if is_stated else 1 + _SAME) * diameter:
        words.append(
            f"DOUBTFUL: the displaced volume has a diameter of {1000 * volume:.4g} mm, above the "
            f"nominal one of {1000 * diameter:.4g} mm: mass per length and diameter disagree"
        )
    elif volume < _LEAST_FILL * diameter:
        words.append(
            f"DOUBTFUL: the displaced volume has a diameter of {1000 * volume:.4g} mm, far below "
            f"the nominal one of {1000 * diameter:.4g} mm: mass per length and diameter disagree"
        )
    return tuple(words)
