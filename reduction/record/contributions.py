"""Measurement errors, and the contribution of each to a result.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2, G.4 (effective degrees of freedom, Welch and Satterthwaite); F.1.2.3
   (correlation by common influence quantities); 4.3.3 (expanded), 4.3.7 (rectangular), 4.3.9
   (triangular), F.2.2.1 (resolution).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.record.arrays import as_positive
from reduction.record.errors import SettingsError
from reduction.record.measurement import Floats, Integers, read_only_arrays


@dataclass(frozen=True, kw_only=True)
class ErrorSizes:
    """Standard uncertainties of the instruments of a test; zero if not stated.

    Parameters
    ----------
    tension_gain : float
        Relative, for the load cell and its amplifier. [1]
    tension_offset : float
        Zero of the load cell. [N]
    tension_reversibility : float
        Falling less rising indication of the load cell at the middle of a cycle, over half the
        range of tension of the cycle. [1]
    tension_reading, position_reading : float
        A single reading (noise and resolution), independent of all other samples. [N], [m]
    position_gain : float
        Relative, for the scale of the crosshead. [1]
    position_offset : float
        Zero of the crosshead. [m]
    lag : float
        Time by which tension is logged late (or early) relative to position. [s]
    diameter : float
        Mean diameter. [m]
    area : float
        Relative, for an area stated instead of a diameter. [1]
    strain_gain : float
        Relative, for strain: error of the strain method itself. [1]
    rated_break_strength : float
        Relative. [1]
    stiffness : float
        Relative, for the effect of test temperature on the material; separate for each test. [1]
    attached_mass : float
        Mass between the specimen and a load cell at its moving end. [kg]
    linear_density : float
        [kg m-1]
    machine_compliance : float
        Machine deflection per tension. [m N-1]
    splice_friction : float
        Excess length of the splices when unloading over that when loading at the same tension, as a
        fraction of their extension. [1]
    is_splice_friction_known : bool
        Whether it is stated, or found from a mark on the way down.
    """

    tension_gain: float = 0.0
    tension_offset: float = 0.0
    tension_reversibility: float = 0.0
    tension_reading: float = 0.0
    position_gain: float = 0.0
    position_offset: float = 0.0
    position_reading: float = 0.0
    lag: float = 0.0
    diameter: float = 0.0
    area: float = 0.0
    strain_gain: float = 0.0
    rated_break_strength: float = 0.0
    stiffness: float = 0.0
    attached_mass: float = 0.0
    linear_density: float = 0.0
    machine_compliance: float = 0.0
    splice_friction: float = 0.0
    is_splice_friction_known: bool = False


@dataclass(frozen=True)
class InstrumentErrors(ErrorSizes):
    """Errors of the instruments of one specimen.

    All except those of a single reading are shared by all samples.

    Parameters
    ----------
    specimen : str
        Specimen of the tension channel.
    position_of_scale_zero : float
        Reading at which the crosshead scale is zero: the length there for a displacement, 0 for a
        pin-to-pin length.  It has no uncertainty. [m]
    smoothed_over : float
        Longest time constant of a tension filter, if the record shows that tension lags. [s]
    diameter_readings : int
        Number of readings that give the error of the diameter; 0 if it is stated. [1]
    splice_slip : float
        Slip of the splices after their marks were read. [m]
    splices_slipped_by : float
        Slip of the splices by the end of the test, from steps in tension. [m]
    drift_not_placed : float
        Of the work of the drift of a cycle, for the part of the cycle in which it takes place. [1]
    test : str
        Name of the test.
    tension_instrument, position_instrument : str
        Channels with the same name share their gain and offset.
    strain_model : str
        Strain models with the same name share the errors of their coefficients.
    """

    specimen: str
    position_of_scale_zero: float = 0.0
    smoothed_over: float = 0.0
    diameter_readings: int = 0
    splice_slip: float = 0.0
    splices_slipped_by: float = 0.0
    drift_not_placed: float = 0.0
    test: str = ""
    tension_instrument: str = "load cell"
    position_instrument: str = "crosshead"
    strain_model: str = ""

    def __post_init__(self) -> None:
        """Refuse values that are not a standard uncertainty."""
        for item in fields(self):
            value = getattr(self, item.name)
            if isinstance(value, float) and not (np.isfinite(value) and value >= 0):
                raise SettingsError(
                    f"{item.name} of '{self.specimen}' is not a standard uncertainty",
                    found=f"{value:g} in SI",
                    needed="zero or more",
                )


@dataclass(frozen=True, order=True)
class Component:
    """One independent error.

    Parameters
    ----------
    source : str
        Name in a budget: ``tension_gain``, ``strain_calibration``, ...
    of : str
        Instrument, specimen or model; with `source` it identifies the error.
    number : int
        Index if one source has several independent errors (the coefficients of a fit). [1]
    degrees_of_freedom : float
        Degrees of freedom of its standard uncertainty: infinite if stated, few if it is the scatter
        of a few readings. They do not distinguish two errors. [1]
    """

    source: str
    of: str
    number: int = 0
    degrees_of_freedom: float = field(default=math.inf, compare=False)


_OF_NAMED = (
    "tension_gain", "tension_offset", "lag", "position_gain", "position_offset",
    "machine_compliance",
)  # fmt: skip

_UNNAMED = ("load cell, channel ", "weights, channel ", "crosshead")


def within(component: Component, campaign: str) -> Component:
    """Error under a name that no other campaign has, unless it is one of a named instrument.

    Two campaigns may each have a specimen "new", and a load cell that neither names.

    Examples
    --------
    >>> one = Component("tension_gain", "load cell, channel 1")
    >>> within(one, "2005").of, within(Component("tension_gain", "cell 7, channel 1"), "2005").of
    ('load cell, channel 1 of 2005', 'cell 7, channel 1')
    """
    if component.source in _OF_NAMED and not component.of.startswith(_UNNAMED):
        return component
    return replace(component, of=f"{component.of} of {campaign}")


FROM_READINGS = frozenset(
    {
        "strain_calibration",
        "splice_method",
        "splice_law",
        "splice_friction",
        "splice_slip",
        "window",
        "quasi_static_fit",
        "pull_rate",
        "drift_place",
        "gauge_length",
    }
)
"""Sources that follow from readings of the tests, not from stated instrument errors."""


@dataclass(frozen=True)
@read_only_arrays
class Contributions:
    """Contributions of each component to some quantities.

    Parameters
    ----------
    component : tuple of Component, length n_components
        Components without repeats.
    values : dict of str to ndarray
        By name of the quantity: shape (n_components, ...) before the axes of the quantity; signed
        error from one standard deviation of the component. [as quantity]
    """

    component: tuple[Component, ...]
    values: dict[str, Floats] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check that every quantity has a row for each component, and make arrays read-only."""
        if len(set(self.component)) != len(self.component):
            raise SettingsError("a component appears twice among the contributions")
        for name, rows in self.values.items():
            rows.setflags(write=False)
            if rows.shape[:1] != (len(self.component),):
                raise SettingsError(
                    f"contributions to {name} do not fit their components",
                    found=f"shape {rows.shape}",
                    needed=f"({len(self.component)}, ...)",
                )

    @property
    def degrees_of_freedom(self) -> Floats:
        """Degrees of freedom of each component, shape (n_components,). [1]."""
        return np.array([one.degrees_of_freedom for one in self.component])

    def shared_standard_uncertainty(self, name: str) -> Floats:
        """Root of the sum of squares over the components, in the shape of the quantity."""
        return np.asarray(np.sqrt(np.sum(self.values[name] ** 2, axis=0)))


@dataclass(frozen=True)
@read_only_arrays
class LineSpread:
    """Uncertainty and 95 % interval of K_1, tau and N of a test, and the method used.

    Parameters
    ----------
    method : ndarray of int, shape (n_specimens,)
        One of `LINE_METHODS`: linear if Monte Carlo agrees within 5 %, else Monte Carlo. [1]
    without_solution_share : ndarray, shape (n_specimens,)
        Share of the draws. [1]
    standard_uncertainty, low, high : dict of str to ndarray, each of shape (n_specimens,)
        By parameter name; NaN if not given. [N], [s], [N s]
    """

    method: Integers
    without_solution_share: Floats
    standard_uncertainty: dict[str, Floats]
    low: dict[str, Floats]
    high: dict[str, Floats]


CONFIDENCE = 0.95
"""Of every interval. [1]"""

_FEWEST, _MANY = 1.0, 1e9
"""Degrees of freedom below which none are counted, and above which Student's t is normal."""


def combined_standard_uncertainty(contribution: ArrayLike, random: ArrayLike) -> Floats:
    """Root sum of squares of all contributions and the random part.

    Parameters
    ----------
    contribution : array_like, shape (n_components, ...)
        Signed contributions. [any]
    random : array_like, shape (...)
        Type A uncertainty of the number itself. [as contribution]

    Returns
    -------
    standard_uncertainty : ndarray, shape (...)
        NaN if the random part is NaN. [as contribution]

    Examples
    --------
    >>> print(combined_standard_uncertainty([[3.0], [0.0]], [4.0]))
    [5.]
    """
    rows = np.asarray(contribution, dtype=np.float64)
    return np.asarray(np.sqrt(np.sum(rows**2, axis=0) + np.asarray(random) ** 2))


def effective_degrees_of_freedom(
    random: ArrayLike,
    degrees_of_freedom: ArrayLike,
    *,
    contribution: ArrayLike | None = None,
    of_contribution: ArrayLike = np.inf,
) -> Floats:
    r"""Effective degrees of freedom of a combined uncertainty.

    .. math:: \nu_{eff} = \frac{u^4}{u_r^4 / \nu_r + \sum_k c_k^4 / \nu_k}

    Parameters
    ----------
    random : array_like, shape (...)
        Random part. [any]
    degrees_of_freedom : array_like, shape (...)
        Random part: those of the cycles, samples or readings it is based on. [1]
    contribution : array_like, shape (n_components, ...), optional
        Shared errors; NaN counts as zero. [as random]
    of_contribution : array_like, shape (n_components,) or of the contributions, optional
        Degrees of freedom of each contribution; infinite if stated. [1]

    Returns
    -------
    effective : ndarray, shape (...)
        Infinite if no part is based on a finite number of readings; NaN if the random part is NaN.
        [1]

    Notes
    -----
    Welch and Satterthwaite, [1]_, 5.2, G.4, G.4.1, eq. G.2b.

    Examples
    --------
    Scatter of ten cycles alone, then with a stated error of twice its size, then with the same
    error from three diameter readings:

    >>> print(effective_degrees_of_freedom(1.0, 9.0))
    9.0
    >>> for freedom in (np.inf, 2.0):
    ...     print(effective_degrees_of_freedom(
    ...         1.0, 9.0, contribution=[2.0], of_contribution=[freedom]).round(1))
    225.0
    3.1
    """
    part = np.asarray(random, dtype=np.float64)
    rows = np.zeros((0, *part.shape)) if contribution is None else np.nan_to_num(contribution)
    freedom = np.asarray(of_contribution, dtype=np.float64)
    if freedom.ndim == 1:
        freedom = freedom.reshape(-1, *(1,) * (rows.ndim - 1))
    total = part**2 + np.sum(rows**2, axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        # as shares of the variance: fourth powers of small numbers underflow
        own, shared = part**2 / total, rows**2 / total
        few = own**2 / np.asarray(degrees_of_freedom) + np.sum(shared**2 / freedom, axis=0)
        effective = np.where(total > 0, 1 / few, np.inf)
    return np.asarray(np.where(np.isnan(part), np.nan, effective))


def coverage_factor(degrees_of_freedom: ArrayLike) -> Floats:
    """Coverage factor of the expanded uncertainty.

    Parameters
    ----------
    degrees_of_freedom : array_like, shape (...)
        Effective degrees of freedom; below 1 counts as 1. [1]

    Returns
    -------
    factor : ndarray, shape (...)
        Factor k; 1.96 if stated errors dominate. [1]

    Notes
    -----
    Student's t, [1]_, 5.2, G.4, G.3.

    Examples
    --------
    Ten cycles, three readings, and a stated value:

    >>> print(coverage_factor([9.0, 2.0, np.inf]).round(2))
    [2.26 4.3  1.96]
    """
    freedom = np.asarray(degrees_of_freedom, dtype=np.float64)
    bounded = np.clip(freedom, _FEWEST, _MANY)
    return np.asarray(scipy.special.stdtrit(bounded, (1 + CONFIDENCE) / 2))


def covariance_root(covariance: Floats) -> Floats:
    """Matrix whose product with its own transpose is a covariance, which may be singular."""
    variance, direction = np.linalg.eigh(covariance)
    return np.asarray(direction * np.sqrt(np.maximum(variance, 0)))


def merged(parts: Sequence[Contributions]) -> Contributions:
    """Merge contributions over all their components; those to the same quantity are added.

    A component absent from a part contributes zero to its quantities.

    Notes
    -----
    Equal components are the same error ([1]_, F.1.2.3).

    Examples
    --------
    >>> from reduction.record.contributions import Component
    >>> gain, zero = Component("tension_gain", "cell"), Component("tension_offset", "cell")
    >>> parts = [Contributions((zero,), {"force": np.array([[2.0]])}),
    ...     Contributions((gain,), {"force": np.array([[1.5]]), "share": np.array([[0.01]])})]
    >>> both = merged([*parts, parts[1]])
    >>> print([one.source for one in both.component], both.values["force"].ravel())
    ['tension_gain', 'tension_offset'] [3. 2.]
    """
    component, place = _together(parts)
    values: dict[str, Floats] = {}
    for part in parts:
        rows = [place[one] for one in part.component]
        for name, array in part.values.items():
            table = values.setdefault(name, np.zeros((len(component), *array.shape[1:])))
            table[rows] += array
    return Contributions(component, values)


def stacked(entries: Sequence[Contributions]) -> Contributions:
    """Stack contributions to the same quantities of several specimens, holds, ... along one axis.

    Notes
    -----
    Equal components are the same error ([1]_, F.1.2.3).

    Examples
    --------
    >>> from reduction.record.contributions import Component
    >>> new, used = (Contributions((Component("diameter", name),), {"area": np.array([size])})
    ...     for name, size in (("new", 2.0), ("used", 3.0)))
    >>> print(stacked([new, used]).values["area"])
    [[2. 0.]
     [0. 3.]]
    """
    component, place = _together(entries)
    shapes = {name: array.shape[1:] for part in entries for name, array in part.values.items()}
    values = {}
    rows = [[place[one] for one in part.component] for part in entries]
    for name, shape in shapes.items():
        table = np.zeros((len(component), len(entries), *shape))
        for index, part in enumerate(entries):
            if name in part.values:
                table[rows[index], index] = part.values[name]
        values[name] = table
    return Contributions(component, values)


def renamed(found: Contributions, names: dict[str, str]) -> Contributions:
    """Contributions under new names; quantities without a new name are left out.

    Notes
    -----
    Nothing is computed ([1]_, F.1.2.3).

    Examples
    --------
    >>> from reduction.record.contributions import Component
    >>> cell = Contributions((Component("tension_gain", "cell"),), {"tension": np.array([1.0])})
    >>> print(list(renamed(cell, {"tension": "peak_tension"}).values))
    ['peak_tension']
    """
    return Contributions(found.component, {new: found.values[name] for name, new in names.items()})


def _together(
    parts: Sequence[Contributions],
) -> tuple[tuple[Component, ...], dict[Component, int]]:
    """Components of all parts without repeats, and the row of each."""
    component = tuple(sorted({one for part in parts for one in part.component}))
    return component, {one: row for row, one in enumerate(component)}


Shape = Literal["rectangular", "triangular", "arcsine"]

_SHAPE: dict[Shape, float] = {
    "rectangular": np.sqrt(3),
    "triangular": np.sqrt(6),
    "arcsine": np.sqrt(2),
}


def of_half_width(half_width: float, shape: Shape = "rectangular") -> float:
    """Standard uncertainty from the half-width of an interval.

    Notes
    -----
    [1]_, 4.3.3, 4.3.7 and 4.3.9; arcsine applies to a sinusoidal variation.

    Examples
    --------
    >>> print(round(of_half_width(0.3), 4), round(of_half_width(0.3, "triangular"), 4))
    0.1732 0.1225
    """
    if shape not in _SHAPE:
        raise SettingsError(
            "the shape of an error is not known", found=shape, needed=" or ".join(_SHAPE)
        )
    return half_width / float(_SHAPE[shape])


def of_expanded(expanded: float, coverage_factor: float) -> float:
    """Standard uncertainty from an expanded one.

    Notes
    -----
    [1]_, 4.3.3, 4.3.3.

    Examples
    --------
    >>> of_expanded(0.002, 2.0)
    0.001
    """
    as_positive("coverage_factor", coverage_factor)
    return expanded / coverage_factor


def of_resolution(resolution: float) -> float:
    """Standard uncertainty from the resolution of an indication.

    Notes
    -----
    [1]_, 4.3.3, F.2.2.1: half a step to either side, rectangular.

    Examples
    --------
    >>> print(round(of_resolution(0.1), 4))
    0.0289
    """
    return resolution / float(np.sqrt(12))


USUAL_SPLICE_FRICTION = 0.02
"""Default without a statement or a mark on the way down: a judgement, not a measurement."""


@dataclass(frozen=True)
class StatedErrors(ErrorSizes):
    """Errors stated by a campaign.

    Parameters
    ----------
    splice_friction : float
        As in `ErrorSizes`; not zero if unstated. [1]
    has_one_load_cell : bool
        Whether all tension channels share the errors of one load cell.
    """

    splice_friction: float = USUAL_SPLICE_FRICTION
    has_one_load_cell: bool = False

    @property
    def has_any(self) -> bool:
        """Whether any error is stated."""
        return any(
            getattr(self, item.name) != item.default
            for item in fields(self)
            if item.type == "float"
        )

    def of_channel(
        self,
        specimen: str,
        *,
        channel: int,
        test: str,
        load_cell: str = "",
        machine: str = "",
        strain_model: str = "",
    ) -> InstrumentErrors:
        """Errors for one specimen of one test; channels count from 1."""
        return InstrumentErrors(
            specimen,
            **{item.name: getattr(self, item.name) for item in fields(ErrorSizes)},
            test=test,
            tension_instrument=self.load_cell_name(load_cell, channel=channel),
            position_instrument=machine or "crosshead",
            strain_model=strain_model or specimen,
        )

    def load_cell_name(self, load_cell: str, *, channel: int) -> str:
        """Name under which tests share the errors of a load cell; channels count from 1."""
        cell = load_cell or "load cell"
        return cell if self.has_one_load_cell else f"{cell}, channel {channel}"
