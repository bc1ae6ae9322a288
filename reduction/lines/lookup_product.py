"""What a look-up takes, a surface, a curve or tested levels of a line, and what it returns.

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

from reduction.record.contributions import Component
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays

TENSIONS = ("mean_tension", "tension_amplitude", "tension")
"""Levels that are shares of a break strength as well."""


@dataclass(frozen=True)
@read_only_arrays
class LineSurface:
    """A quadratic surface of one quantity over coded factors.

    Parameters
    ----------
    quantity : str
        Of the vocabulary.
    coefficient : ndarray, shape (n_terms,)
        Coded units, on the scale of ``exponent``. [unit of the quantity]
    exponents : ndarray of int, shape (n_terms, n_factors)
        Power of each factor in each term.
    low, high : ndarray, shape (n_factors,)
        Levels that are -1 and +1. [SI unit of each factor]
    covariance_factor : ndarray, shape (n_terms, n_terms)
        Covariance of the coefficients over sigma squared. [1]
    sigma : float
        Standard deviation of a run about the surface; NaN where not known. [as coefficient]
    degrees_of_freedom : float
        Of sigma. [1]
    greatest_leverage : float
        Of any run: where a point has more, nothing was tested. [1]
    exponent : float
        Of Box and Cox; 1 where the quantity was fitted as it is, 0 for its logarithm. [1]
    frequency_column : int or None
        Factor by which the quantity was multiplied before it was fitted; None for none.
    discrepancy : ndarray, shape (n_all, n_all)
        Moment of what a quadratic may miss, over ``discrepancy_exponents``; empty where the runs
        are not known. [as coefficient, squared]
    discrepancy_exponents : ndarray of int, shape (n_all, n_factors)
        Terms of the surface and those that it does without.
    discrepancy_degrees_of_freedom : float
        Of the discrepancy. [1]
    component : tuple of Component, length n_components
        Errors that the runs share; none where nothing is known of any.
    contribution : ndarray, shape (n_components, n_terms)
        What each error that the runs share adds to the coefficients, signed. [as coefficient]
    alternatives : ndarray, shape (n_alternatives, n_terms)
        Other coefficients that may be the right ones, where that is open: an interval spans
        them all. [as coefficient]
    alternative_boxes : tuple of (low, high)
        Other levels that may be the right ones, as ``low`` and ``high``: an interval spans those
        too. [SI unit of each factor]
    rounding : ndarray, shape (n_factors,)
        Half the last digit of the levels as printed, within which a point is inside; empty where
        they are exact. [SI unit of each factor]
    line_scatter : float
        Standard deviation between lines of the kind over their mean; NaN where not known. [1]
    n_lines : float
        That the surface is of; NaN where not known. [1]
    errata : tuple of str
        Ids that touch it.
    notes : tuple of str
        What is open, what fails, what else to know.
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
        """Check that terms and factors pair up, and make the arrays read-only."""
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
        Of the vocabulary: ``quasi_static_spring_constant`` over ``mean_tension``, ``strain`` over
        ``tension``, ``tangent_modulus`` over ``strain``.
    low, high : float
        Range of the variable that was tested, and in which the curve can be trusted. [SI]
    coefficient : ndarray, shape (n_terms,)
        Of rising powers of the variable; empty where the curve is given by points. [SI]
    at, value : ndarray, shape (n_points,)
        Points, rising; straight lines between them. [SI]
    standard_uncertainty : ndarray, shape (n_points,)
        At the points, of a polynomial too, of all errors; empty where not known. [SI]
    degrees_of_freedom : ndarray, shape (n_points,)
        Of what is random in it; empty where they are many, or not known. [1]
    spread_of : str
        What the uncertainty is of, in words: there is none between tests in it.
    component : tuple of Component, length n_components
        Errors that the curve shares with others; none where nothing is known of any.
    contribution : ndarray, shape (n_components, n_points)
        What each of them adds to the value at the points, signed; in the uncertainty too. [SI]
    gaps : ndarray, shape (n_gaps, 2)
        Ends between which nothing was measured; they are inside, what is between is not. [SI]
    range_note : str
        Why the range is less than what was tested; empty where it is not.
    branch : {"", "ascending", "descending"}
        Of a cycle, where the quantity differs.
    is_inverse_slope : bool
        The value is the inverse of the slope of the polynomial: K_0 from strain on tension.
    loop_bend : float
        Of K_0: share of the way from its slope at the mean tension to its chord over the cycle that
        the loops of the runs go; zero where they are straight, or not known. [1]
    loop_bend_misfit : float
        What that misses of the K_0 of the runs, as a standard deviation over K_0. [1]
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
        Of the vocabulary.
    variables : tuple of str
        Levels, in the order of the columns of ``at``.
    at : ndarray, shape (n_tests, n_variables)
        As the tests reached them. [SI]
    value : ndarray, shape (n_tests,)
        [SI]
    random_standard_uncertainty, degrees_of_freedom : ndarray, shape (n_tests,)
        Of what is of each test alone. [SI], [1]
    tests : tuple of str, length n_tests
        Where each value is from.
    component : tuple of Component, length n_components
        Errors that the tests share; none where nothing is known of any.
    contribution : ndarray, shape (n_components, n_tests)
        What each of them adds to each value, signed. [SI]
    conditions : tuple of dict, length n_tests
        In which each test was made, as `LineSource`.
    notes : tuple of str
        What else to know.
    warnings : tuple of tuple of str, length n_tests
        What of each test has to be read before its value.
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


@dataclass(frozen=True)
class LineSource:
    """A line or tether of which something is known.

    Parameters
    ----------
    name : str
        By which it is asked for.
    source : str
        Report, or campaign and file.
    material, construction, condition : str
        In words.
    diameter : float
        NaN where not stated. [m]
    rated_break_strength : float
        That tensions in %RBS are shares of; NaN where not stated. [N]
    factor_names : tuple of str
        Of the surfaces, in the order of their levels.
    surfaces : dict of str to LineSurface
        By quantity.
    curves : tuple of LineCurve
        Quantities over one variable.
    linear_density, wet_linear_density : float
        NaN where not stated. [kg m-1]
    absent : dict of str to str
        Quantities that were not measured, or are lost, with the reason.
    kind : str
        Of the specimen, as a campaign names it: ``rubber tether``, ``rope`` ...; empty where
        not stated.
    tensile_strength : float
        That the line still has in its condition, by which the rule is judged then; NaN where
        the rated one counts. [N]
    strength_of : str
        Of which other line the rated break strength is, in words; empty where it is its own.
    slow_pulls : dict of str to LineCurve
        K_0 over mean tension by each printed way to it, or by each slow pull of an experiment, by
        its name in words; of a rope with response surfaces alone.
    by_fundamental : bool
        Whether K_1 and tau are of the fundamentals of waves that are no sines, whose K_ap and H are
        those of the wave: no line has both.
    levels : tuple of LineLevels
        Quantities that are known at the levels of single tests.
    conditions : dict of str to str
        In which it was tested, as a campaign states them: ``medium``, ``temperature`` ...
    specimens : tuple of str
        That the numbers are of; none of a published line.
    notes, warnings : tuple of str
        What holds of all of it, and what of that has to be read before any value.
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
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    @property
    def is_printed(self) -> bool:
        """Of its surfaces the coefficients alone are known, and not the runs."""
        return not any(one.discrepancy.size for one in self.surfaces.values())

    @property
    def is_tether(self) -> bool:
        """Of rubber, that must not go slack: by its kind, else by its material."""
        return self.kind == "rubber tether" if self.kind else "rubber" in self.material.lower()

    @property
    def rule(self) -> str:
        """How high the line may be loaded, or how low."""
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
        """What can be asked for."""
        derived = ["dashpot_coefficient"] if self.has_dashpot else []
        of_levels = [one.quantity for one in self.levels]
        of_curves = [one.quantity for one in self.curves]
        return tuple(dict.fromkeys([*self.surfaces, *derived, *of_levels, *of_curves]))

    @property
    def has_dashpot(self) -> bool:
        """True where N = K_1 tau follows from two surfaces."""
        return {"dissipation_spring_constant", "relaxation_time"} <= self.surfaces.keys()


@dataclass(frozen=True)
@read_only_arrays
class DesignValues:
    """Values of one quantity at points.  Arrays have the shape (...) of the points.

    Parameters
    ----------
    quantity, unit : str
        What was asked for, and its SI unit.
    value : ndarray
        The median where the surface is of a transform. [unit]
    low, high : ndarray
        95 % interval of one more run of the same specimens there; NaN where nothing is known of the
        scatter, as of a curve of one test. [unit]
    surface_low, surface_high : ndarray
        95 % interval of the surface itself, or of the curve of one test: `surface_interval_of`.
        [unit]
    kind_low, kind_high : ndarray
        95 % interval of the mean of all specimens of the kind; NaN where the scatter between
        specimens is not known. [unit]
    line_low, line_high : ndarray
        The same of another specimen of the kind. [unit]
    is_inside : ndarray of bool
        Between the levels, or the ends of the range, that were tested.
    is_untested : ndarray of bool
        Inside, but farther from the runs than any run is.
    peak_tension, minimum_tension : ndarray
        Mean tension and amplitude together; the one tension where there is no cycle, as it is
        on the curve at a strain; NaN where none is known. [N]
    peak_share, minimum_share : ndarray
        Of the rated break strength; NaN where that is not known. [1]
    own_peak_share, own_minimum_share : ndarray
        Of the strength that the line has in its condition: the rated one where no other is
        known. [1]
    is_slack : ndarray of bool
        The minimum is zero.
    is_above_rule : ndarray of bool
        The peak is above 60 % of the strength that the line has, or above 30 % where the minimum
        is below 3 % of it.
    rule : str
        How high, or how low, the source lets the line be loaded.
    source : str
        Where the numbers are from.
    errata, notes : tuple of str
        What is known against them.
    warnings : tuple of str
        What has to be read before the values: other numbers of the source contradict them.
    branch : {"", "ascending", "descending"}
        Of a cycle, where the quantity differs.
    component : tuple of Component, length n_components
        Errors that the values share with others; none where nothing is known of any.
    contribution : ndarray, shape (n_components, ...)
        What each of them adds to the value, signed; in the intervals too. [unit]
    random_standard_uncertainty, random_degrees_of_freedom : ndarray
        What is of the value alone; empty where that is known as an interval only. [unit], [1]
    run_standard_uncertainty : ndarray
        The same of one more run, with those degrees of freedom; empty where ``low`` and ``high``
        are of none. [unit]
    interval_of, surface_interval_of : str
        What ``low`` and ``high``, and ``surface_low`` and ``surface_high``, are of, in words;
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
    peak_tension: Floats
    minimum_tension: Floats
    peak_share: Floats
    minimum_share: Floats
    own_peak_share: Floats
    own_minimum_share: Floats
    is_slack: Bools
    is_above_rule: Bools
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
        """The value is below zero, which none of the quantities can be."""
        return np.asarray(self.value < 0)
