"""Inputs of a look-up (surface, curve or tested levels of a line) and its result.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eq. 5, App. C; sec. 4.4 ("range of usefulness"),
   3.4.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 2.3.2.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from reduction.quantities.units import Dimension
from reduction.record.contributions import Component
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays

TENSIONS = ("mean_tension", "tension_amplitude", "tension")
"""Levels that can also be shares of a break strength."""

LEVEL_DIMENSIONS: dict[str, Dimension] = {
    "frequency": "frequency",
    "mean_tension": "force",
    "tension_amplitude": "force",
    "tension": "force",
    "strain": "strain",
    "mean_strain": "strain",
    "strain_amplitude": "strain",
}
"""Levels at which a line is looked up."""

OF_MEAN = "tension_amplitude_over_mean"
"""Factor of an experiment whose amplitudes are shares of the mean tension of each run."""


@dataclass(frozen=True)
@read_only_arrays
class LineSurface:
    """A quadratic surface of one quantity over coded factors.

    Parameters
    ----------
    quantity : str
        Name in the vocabulary of quantities.
    coefficient : ndarray, shape (n_terms,)
        Coded units, on the scale of ``exponent``. [unit of the quantity]
    exponents : ndarray of int, shape (n_terms, n_factors)
        Power of each factor in each term.
    low, high : ndarray, shape (n_factors,)
        Levels coded as -1 and +1. [SI unit of each factor]
    covariance_factor : ndarray, shape (n_terms, n_terms)
        Covariance of the coefficients over sigma squared. [1]
    sigma : float
        Standard deviation of a run about the surface; NaN where not known. [as coefficient]
    degrees_of_freedom : float
        Degrees of freedom of sigma. [1]
    greatest_leverage : float
        Greatest leverage of any run: a point with more is untested. [1]
    exponent : float
        Box-Cox exponent; 1 where the quantity was fitted as it is, 0 for its logarithm. [1]
    frequency_column : int or None
        Factor by which the quantity was multiplied before the fit; None for none.
    discrepancy : ndarray, shape (n_all, n_all)
        Second moment of the lack of fit of a quadratic, over ``discrepancy_exponents``; empty where
        the runs are not known. [as coefficient, squared]
    discrepancy_exponents : ndarray of int, shape (n_all, n_factors)
        Terms of the surface and those that it lacks.
    discrepancy_degrees_of_freedom : float
        Degrees of freedom of the discrepancy. [1]
    component : tuple of Component, length n_components
        Errors that the runs share; empty where none is known.
    contribution : ndarray, shape (n_components, n_terms)
        Signed contribution of each shared error to the coefficients. [as coefficient]
    alternatives : ndarray, shape (n_alternatives, n_terms)
        Other possible coefficients, where the right ones are open: an interval spans them all.
        [as coefficient]
    alternative_boxes : tuple of (low, high)
        Other possible levels, as ``low`` and ``high``, where the right ones are open: an interval
        spans those too. [SI unit of each factor]
    rounding : ndarray, shape (n_factors,)
        Half the last digit of the printed levels, within which a point is inside; empty where
        they are exact. [SI unit of each factor]
    line_scatter : float
        Standard deviation between lines of the kind over their mean; NaN where not known. [1]
    n_lines : float
        Number of lines in the surface; NaN where not known. [1]
    errata : tuple of str
        Ids of errata that affect it.
    notes : tuple of str
        Open values, failed checks, other remarks.
    """

    quantity: str
    coefficient: Floats
    exponents: Integers
    low: Floats
    high: Floats
    covariance_factor: Floats
    sigma: float
    degrees_of_freedom: float
    greatest_leverage: float
    exponent: float = 1.0
    frequency_column: int | None = None
    discrepancy: Floats = field(default_factory=lambda: np.empty((0, 0)))
    discrepancy_exponents: Integers = field(default_factory=lambda: np.empty((0, 0), dtype=np.intp))
    discrepancy_degrees_of_freedom: float = float("inf")
    component: tuple[Component, ...] = ()
    contribution: Floats = field(default_factory=lambda: np.empty((0, 0)))
    alternatives: Floats = field(default_factory=lambda: np.empty((0, 0)))
    alternative_boxes: tuple[tuple[Floats, Floats], ...] = ()
    rounding: Floats = field(default_factory=lambda: np.empty(0))
    line_scatter: float = float("nan")
    n_lines: float = float("nan")
    errata: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Check that terms and factors match, and make the arrays read-only."""
        n_terms, n_factors = self.exponents.shape
        shapes = {
            "coefficient": (n_terms,),
            "low": (n_factors,),
            "high": (n_factors,),
            "covariance_factor": (n_terms, n_terms),
        } | ({"rounding": (n_factors,)} if self.rounding.size else {})
        for name, shape in shapes.items():
            found = getattr(self, name).shape
            if found != shape:
                raise DataError(
                    f"{name} does not fit the surface", found=str(found), needed=str(shape)
                )
        if len(self.component) != len(self.contribution):
            raise DataError(
                "contributions to a surface do not pair up with the errors that the runs share",
                found=f"{len(self.contribution)} rows",
                needed=str(len(self.component)),
            )


_ROPE_RULE = (
    "peak at most 60 % of the break strength where the minimum stays at 3 % or above, 30 % where "
    "it is lower or the line goes slack: a preliminary guideline, from nylon"
)

_OF_ROPE = " (CG-D-39-80, sec. 3.4, 5.0)"

_TETHER_RULE = "a rubber tether must not go slack (WHOI-2005-10, sec. 2.3.2)"


@dataclass(frozen=True)
@read_only_arrays
class LineCurve:
    """A quantity over one variable, as a polynomial or through points.

    Parameters
    ----------
    quantity, variable : str
        By vocabulary: ``quasi_static_spring_constant`` over ``mean_tension``, ``strain`` over
        ``tension``, ``tangent_modulus`` over ``strain``.
    low, high : float
        Range of the variable that was tested and in which the curve can be trusted. [SI]
    coefficient : ndarray, shape (n_terms,)
        By rising powers of the variable; empty where the curve is given by points. [SI]
    at, value : ndarray, shape (n_points,)
        Points, increasing; straight lines between them. [SI]
    standard_uncertainty : ndarray, shape (n_points,)
        From all errors, at the points, also for a polynomial; empty where not known. [SI]
    degrees_of_freedom : ndarray, shape (n_points,)
        Degrees of freedom of the random part; empty where they are many, or not known. [1]
    spread_of : str
        Subject of the uncertainty, in words: it has no scatter between tests.
    component : tuple of Component, length n_components
        Errors that the curve shares with others; empty where none is known.
    contribution : ndarray, shape (n_components, n_points)
        Signed contribution of each to the value at the points; in the uncertainty too. [SI]
    gaps : ndarray, shape (n_gaps, 2)
        Ends of ranges without measurements; the ends are inside, points between them are not. [SI]
    range_note : str
        Why the range is smaller than the tested range; empty where it is not.
    branch : {"", "ascending", "descending"}
        Branch of a cycle, where the quantity differs by branch.
    is_inverse_slope : bool
        The value is the inverse of the slope of the polynomial: K_0 from strain on tension.
    loop_bend : float
        For K_0: how far the loops of the runs go from its slope at the mean tension to its chord
        over the cycle, as a share; zero where they are straight, or not known. [1]
    loop_bend_misfit : float
        Standard deviation of the K_0 of the runs about that, over K_0. [1]
    errata, notes : tuple of str
        As `LineSurface`.
    warnings : tuple of str
        As `DesignValues`.
    """

    quantity: str
    variable: str
    low: float
    high: float
    coefficient: Floats = field(default_factory=lambda: np.empty(0))
    at: Floats = field(default_factory=lambda: np.empty(0))
    value: Floats = field(default_factory=lambda: np.empty(0))
    standard_uncertainty: Floats = field(default_factory=lambda: np.empty(0))
    degrees_of_freedom: Floats = field(default_factory=lambda: np.empty(0))
    spread_of: str = ""
    component: tuple[Component, ...] = ()
    contribution: Floats = field(default_factory=lambda: np.empty((0, 0)))
    gaps: Floats = field(default_factory=lambda: np.empty((0, 2)))
    range_note: str = ""
    branch: Literal["", "ascending", "descending"] = ""
    is_inverse_slope: bool = False
    loop_bend: float = 0.0
    loop_bend_misfit: float = 0.0
    errata: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True)
@read_only_arrays
class LineLevels:
    """A quantity at the levels at which it was tested, one row per test.

    Parameters
    ----------
    quantity : str
        Name in the vocabulary of quantities.
    variables : tuple of str
        Levels, in the order of the columns of ``at``.
    at : ndarray, shape (n_tests, n_variables)
        Levels that the tests reached. [SI]
    value : ndarray, shape (n_tests,)
        [SI]
    random_standard_uncertainty, degrees_of_freedom : ndarray, shape (n_tests,)
        Of the part that is independent for each test. [SI], [1]
    tests : tuple of str, length n_tests
        Source of each value.
    component : tuple of Component, length n_components
        Errors that the tests share; empty where none is known.
    contribution : ndarray, shape (n_components, n_tests)
        Signed contribution of each to each value. [SI]
    conditions : tuple of dict, length n_tests
        Conditions of each test, as in `LineSource`.
    notes : tuple of str
        Other remarks.
    warnings : tuple of tuple of str, length n_tests
        Warnings of each test, to be read before its value.
    late_change : ndarray, shape (n_tests,) or (0,)
        Relative change from the mean to the later cycles, as from
        `reduction.stages.moduli.secant_modulus.late_change`. [1]
    """

    quantity: str
    variables: tuple[str, ...]
    at: Floats
    value: Floats
    random_standard_uncertainty: Floats
    degrees_of_freedom: Floats
    tests: tuple[str, ...]
    component: tuple[Component, ...] = ()
    contribution: Floats = field(default_factory=lambda: np.empty((0, 0)))
    conditions: tuple[dict[str, str], ...] = ()
    notes: tuple[str, ...] = ()
    warnings: tuple[tuple[str, ...], ...] = ()
    late_change: Floats = field(default_factory=lambda: np.empty(0))


@dataclass(frozen=True)
class LineSource:
    """A line or tether with known values.

    Parameters
    ----------
    name : str
        Name for the look-up.
    source : str
        Report, or campaign and file.
    material, construction, condition : str
        In words.
    diameter : float
        NaN where not stated. [m]
    rated_break_strength : float
        Reference of tensions in %RBS; NaN where not stated. [N]
    factor_names : tuple of str
        Factors of the surfaces, in the order of their levels.
    surfaces : dict of str to LineSurface
        Surfaces by quantity.
    curves : tuple of LineCurve
        Quantities over one variable.
    linear_density, wet_linear_density : float
        NaN where not stated. [kg m-1]
    absent : dict of str to str
        Quantities that were not measured, or are lost, with the reason.
    kind : str
        Kind of specimen, as in a campaign: ``rubber tether``, ``rope`` ...; empty where not
        stated.
    tensile_strength : float
        Residual strength of the line in its condition, to which the rule then applies; NaN where
        the rated one applies. [N]
    strength_of : str
        The other line to which the rated break strength belongs, in words; empty where it is its
        own.
    slow_pulls : dict of str to LineCurve
        K_0 over mean tension from each printed source, or from each slow pull of an experiment, by
        its name in words; only for a rope with response surfaces.
    by_fundamental : bool
        Whether K_1 and tau are from the fundamentals of non-sinusoidal waves, while K_ap and H are
        those of the wave: no line has both.
    levels : tuple of LineLevels
        Quantities known at the levels of single tests.
    conditions : dict of str to str
        Conditions of its tests, as a campaign states them: ``medium``, ``temperature`` ...
    specimens : tuple of str
        Specimens of the numbers; none for a published line.
    runs : tuple of (str, str)
        Test and specimen of each run of the surfaces; none for a published line.
    campaign : str
        Identification of the campaign; empty for published lines.
    notes, warnings : tuple of str
        Remarks on all its values, and warnings to be read before any value.
    """

    name: str
    source: str
    material: str
    construction: str
    condition: str
    diameter: float
    rated_break_strength: float
    factor_names: tuple[str, ...] = ()
    surfaces: dict[str, LineSurface] = field(default_factory=dict)
    curves: tuple[LineCurve, ...] = ()
    linear_density: float = float("nan")
    wet_linear_density: float = float("nan")
    absent: dict[str, str] = field(default_factory=dict)
    kind: str = ""
    tensile_strength: float = float("nan")
    strength_of: str = ""
    slow_pulls: dict[str, LineCurve] = field(default_factory=dict)
    by_fundamental: bool = False
    levels: tuple[LineLevels, ...] = ()
    conditions: dict[str, str] = field(default_factory=dict)
    specimens: tuple[str, ...] = ()
    runs: tuple[tuple[str, str], ...] = ()
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    campaign: str = ""

    @property
    def is_printed(self) -> bool:
        """Only the coefficients of its surfaces are known, not the runs."""
        return not any(one.discrepancy.size for one in self.surfaces.values())

    @property
    def is_tether(self) -> bool:
        """Rubber that must not go slack: by its kind, else by its material."""
        return self.kind == "rubber tether" if self.kind else "rubber" in self.material.lower()

    @property
    def rule(self) -> str:
        """Limits of the load on the line."""
        if self.is_tether:
            return _TETHER_RULE
        is_nylon = "nylon" in self.material.lower() or not self.material
        other = "" if is_nylon else self.material
        if self.kind not in ("", "rope", "wire"):
            other = f"a specimen of the kind {self.kind}"
        taken = f", taken over for {other}" if other else ""
        return f"{_ROPE_RULE}{taken}{_OF_ROPE}"

    @property
    def quantities(self) -> tuple[str, ...]:
        """Quantities that can be looked up."""
        derived = ["dashpot_coefficient"] if self.has_dashpot else []
        of_levels = [one.quantity for one in self.levels]
        of_curves = [one.quantity for one in self.curves]
        return tuple(dict.fromkeys([*self.surfaces, *derived, *of_levels, *of_curves]))

    @property
    def has_dashpot(self) -> bool:
        """True where N = K_1 tau follows from two surfaces."""
        return {"dissipation_spring_constant", "relaxation_time"} <= self.surfaces.keys()


@dataclass(frozen=True, kw_only=True)
@read_only_arrays
class CycleLoads:
    """Ends of a cycle of tension; arrays have the shape (...) of the points.

    Parameters
    ----------
    peak_tension, minimum_tension : ndarray
        Mean tension plus and minus amplitude; without a cycle the one tension, from the curve if
        a strain is given; NaN where not known. [N]
    peak_share, minimum_share : ndarray
        Relative to the rated break strength; NaN where that is not known. [1]
    own_peak_share, own_minimum_share : ndarray
        Relative to the strength of the line in its condition, or to the rated one where no other
        is known. [1]
    is_slack : ndarray of bool
        The minimum is zero.
    is_above_rule : ndarray of bool
        The peak exceeds 60 % of the strength that the line has, or 30 % where the minimum is below
        3 % of it.
    """

    peak_tension: Floats
    minimum_tension: Floats
    peak_share: Floats
    minimum_share: Floats
    own_peak_share: Floats
    own_minimum_share: Floats
    is_slack: Bools
    is_above_rule: Bools


@dataclass(frozen=True)
@read_only_arrays
class DesignValues(CycleLoads):
    """Values of one quantity at points, with loads; arrays have the shape (...) of the points.

    Parameters
    ----------
    quantity, unit : str
        Quantity of the look-up, and its SI unit.
    value : ndarray
        The median where the surface is of a transform. [unit]
    low, high : ndarray
        95 % interval of one more run of the same specimens there; NaN where the scatter is not
        known, as for a curve of one test. [unit]
    surface_low, surface_high : ndarray
        95 % interval of the surface itself, or of the curve of one test: `surface_interval_of`.
        [unit]
    kind_low, kind_high : ndarray
        95 % interval of the mean of all specimens of the kind; NaN where the scatter between
        specimens is not known. [unit]
    line_low, line_high : ndarray
        The same for another specimen of the kind. [unit]
    is_inside : ndarray of bool
        Within the tested levels or range.
    is_untested : ndarray of bool
        Inside, but farther from the runs than any run.
    rule : str
        Limits of the load on the line in the source.
    source : str
        Source of the numbers.
    errata, notes : tuple of str
        Known errors and remarks.
    warnings : tuple of str
        To be read before the values: other numbers of the source contradict them.
    branch : {"", "ascending", "descending"}
        Branch of a cycle, where the quantity differs by branch.
    component : tuple of Component, length n_components
        Errors that the values share with others; empty where none is known.
    contribution : ndarray, shape (n_components, ...)
        Signed contribution of each to the value; in the intervals too. [unit]
    random_standard_uncertainty, random_degrees_of_freedom : ndarray
        Of the part that is not shared; empty where only its interval is known. [unit], [1]
    run_standard_uncertainty : ndarray
        The same for one more run, with those degrees of freedom; empty where ``low`` and ``high``
        do not exist. [unit]
    interval_of, surface_interval_of : str
        Subject of ``low`` and ``high``, and of ``surface_low`` and ``surface_high``, in words;
        empty where there is no such interval.
    """

    quantity: str
    unit: str
    value: Floats
    low: Floats
    high: Floats
    surface_low: Floats
    surface_high: Floats
    kind_low: Floats
    kind_high: Floats
    line_low: Floats
    line_high: Floats
    is_inside: Bools
    is_untested: Bools
    rule: str
    source: str
    errata: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    branch: Literal["", "ascending", "descending"] = ""
    component: tuple[Component, ...] = ()
    contribution: Floats = field(default_factory=lambda: np.empty((0, 0)))
    random_standard_uncertainty: Floats = field(default_factory=lambda: np.empty(0))
    random_degrees_of_freedom: Floats = field(default_factory=lambda: np.empty(0))
    run_standard_uncertainty: Floats = field(default_factory=lambda: np.empty(0))
    interval_of: str = ""
    surface_interval_of: str = ""

    @property
    def is_below_zero(self) -> Bools:
        """Whether the value is negative, which no quantity can be."""
        return np.asarray(self.value < 0)
