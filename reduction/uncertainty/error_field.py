r"""Errors of tension and strain at a point of the loop, by source.

**Effect of the zero and the gain of load cells at points of the plane: in tension, and by
splices.** A splice law gives strain from the logged tension, and was itself fitted to tensions that
a load cell read at the marks.  That may be the same cell or another: each cell affects the tension
of the samples that it logged and the law through the marks that it read.

**Error of strain by position alone, for splices that stretch by the tension they carry.** A line
through the marks gives one strain for each position.  On a loop the same position is passed at two
tensions, and the splices are longer at the greater one.  The same marks show by how much, through a
law of tension fitted to them:

.. math:: D(\varepsilon, T) = \varepsilon
          - \left(\frac{p(\varepsilon) - \ell_s (1 + c T^n)}{\ell_0} - 1\right)

**Errors of tension and strain at a point of the loop, and their slopes from point to point.** Any
error of a test moves each point of its tension-strain plane by a small vector
:math:`(\delta\varepsilon, \delta T)` that depends on the position of the point.  That field and its
slopes give the errors of everything that is read off the plane: of a modulus, a spring constant, an
area.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.1.3 (sensitivity coefficients) and F.1.2.3 (common influence quantities); 4.3.7
   and F.2.4.5 (limits, and an error that is known and not corrected); 5.1.3 (sensitivity
   coefficients) and 5.2 (correlated inputs).
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, Table 3.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_same_shape
from reduction.record.contributions import Component, InstrumentErrors
from reduction.record.measurement import Bools, Floats, read_only_arrays
from reduction.stages.strain.splice_calibration import HELD_EXPONENT
from reduction.stages.strain.strain_model import (
    StrainModel,
    position_by_model,
    strain_by_model,
    strain_sensitivity_of,
)

ROWS = (
    "tension", "strain", "tension_slope", "strain_slope", "strain_slope_over_tension",
    "tension_slope_over_strain",
)  # fmt: skip
"""Arrays of one error, in the order of the first axis of `_field_rows`."""

FieldPart = tuple[Component, Floats]
"""An error and its rows."""

_STEP = 1e-4  # of the strain 1, and of the tension: for the slopes of the field


def _field_rows(
    like: Floats,
    *,
    tension: Floats | float = 0.0,
    strain: Floats | float = 0.0,
    tension_slope: Floats | float = 0.0,
    strain_slope: Floats | float = 0.0,
    strain_slope_over_tension: Floats | float = 0.0,
    tension_slope_over_strain: Floats | float = 0.0,
) -> Floats:
    """The arrays of one error, shape (6, ...) in the order of `ROWS`; ``like`` gives the shape."""
    given = (
        tension, strain, tension_slope, strain_slope, strain_slope_over_tension,
        tension_slope_over_strain,
    )  # fmt: skip
    rows = np.empty((len(given), *like.shape))
    for place, one in enumerate(given):
        rows[place] = one
    return rows


def _steps_of(load: Floats) -> Floats:
    """Steps of tension for a numerical derivative by it. [N]."""
    return np.asarray(_STEP * np.maximum(np.abs(load), 1.0))


_BY_TENSION = ("tension-driven", "mixed")


def _load_parts(errors: InstrumentErrors, model: StrainModel, load: Floats) -> list[FieldPart]:
    """Gain and zero of each load cell: that of the samples, and those of the marks.

    Notes
    -----
    First order ([1]_, 5.1.3).  A wrong gain of a single cell that read samples and marks does not
    change strain, and a wrong zero hardly does: at its marks a splice strains as the tape shows,
    whatever the cell reads.  Under another cell 1 % of gain is 0.14 % of strain on the tethers of
    [2]_, and the error of the marks' cell is equal and opposite.

    Examples
    --------
    >>> model = StrainModel("new", "tension-driven", {"relaxed_free_length": 2.5,
    ...     "relaxed_splice_length": 1.2, "splice_compliance": 5e-4, "splice_exponent": 1.0},
    ...     mark_hold=("min", "max"), mark_tension=np.array([300.0, 500.0]),
    ...     mark_load_cell=("A", "A"))
    >>> for cell in ("A", "B"):
    ...     of = InstrumentErrors("new", tension_gain=0.01, tension_instrument=cell)
    ...     print([(one.of, float(rows[1].round(6))) for one, rows in
    ...            _load_parts(of, model, np.array(400.0))])
    [('A', 0.0)]
    [('B', -0.00096), ('A', 0.00096)]
    """
    found: list[FieldPart] = []
    step = _steps_of(load)
    read = _used(model)
    told = model.mark_load_cell or ("",) * len(model.mark_tension)
    cells = tuple(cell or errors.tension_instrument for cell in told)
    others = (cell for cell, is_used in zip(cells, read, strict=True) if is_used)
    for cell in dict.fromkeys((errors.tension_instrument, *others)):
        is_own = cell == errors.tension_instrument
        is_read = read & np.array([one == cell for one in cells], dtype=bool)
        for source, gain, offset in (
            ("tension_gain", errors.tension_gain, 0.0),
            ("tension_offset", 0.0, errors.tension_offset),
        ):
            if not (gain or offset) or not (is_own or model.method in _BY_TENSION):
                continue
            law = _refitted(model, gain, offset, is_read)
            strain, above, below = (
                _splice_error(model, force, gain * is_own, offset * is_own, law)
                for force in (load, load + step, load - step)
            )
            rows = _field_rows(
                load,
                tension=is_own * (gain * load + offset),
                strain=strain,
                tension_slope=is_own * gain,
                strain_slope_over_tension=(above - below) / (2 * step),
            )
            found.append((Component(source, cell), rows))
    return found


def _strain_by_tension(model: StrainModel, at: Floats, load: Floats) -> Floats:
    """Slope of strain over the logged tension at one position; zero for an extensometer. [N-1]."""
    if model.method == "extensometer":
        return np.zeros(load.shape)
    position = position_by_model(model, strain=at, tension=load)
    step = _steps_of(load)
    above, below = strain_by_model(
        model, position=np.stack([position, position]), tension=np.stack([load + step, load - step])
    )
    return np.asarray((above - below) / (2 * step))


def _used(model: StrainModel) -> Bools:
    """Mark the marks to which a law of tension is fitted: stretched, with a tension."""
    stretched = np.array([hold != "slack" for hold in model.mark_hold], dtype=bool)
    is_known = np.nan_to_num(model.mark_tension) > 0
    return is_known & stretched if stretched.size else is_known


def _splice_error(
    model: StrainModel, load: Floats, gain: float, offset: float, law: Floats
) -> Floats:
    """Error of strain due to errors of the tension and of the law (`_splice_terms`)."""
    if model.method not in _BY_TENSION:
        return np.zeros(load.shape)
    known = model.coefficients
    share = known["relaxed_splice_length"] / known["relaxed_free_length"]
    # where the splices also follow the free length, part of the error is absorbed by that
    share /= 1 + share * known.get("splice_strain_ratio", 0.0)
    force = np.maximum(load, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        # below the wrong zero itself, the error of the splices is at most their strain
        relative = np.where(force > 0, gain + offset / np.maximum(force, abs(offset)), 0.0)
    steepness, terms = _splice_terms(known, force)
    change = steepness * relative + np.tensordot(law, terms[: law.size], axes=1)
    return np.where(np.isnan(load), np.nan, -share * change)


def _splice_terms(known: dict[str, float], force: Floats) -> tuple[Floats, Floats]:
    """Derivatives of splice strain by ln F, ln c and n; also by ln a and ln b if it saturates."""
    with np.errstate(divide="ignore"):
        logarithm = np.where(force > 0, np.log(force), 0.0)
    exponent, limit = known["splice_exponent"], known.get("splice_limit", 0.0)
    power = known["splice_compliance"] * force**exponent
    steepness, terms = exponent * power, [power, logarithm * power]
    if limit:
        reached = known["splice_saturation"] * force
        rising = limit * reached * np.exp(-reached)
        steepness, terms = steepness + rising, [*terms, -limit * np.expm1(-reached), rising]
    return steepness, np.stack(terms)


def _refitted(model: StrainModel, gain: float, offset: float, is_read: Bools) -> Floats:
    """Change of the splice law due to marks that a wrong cell read (`_splice_terms`)."""
    used = _used(model)
    if model.method not in _BY_TENSION or not is_read.any():
        return np.zeros(2)
    force = model.mark_tension[used]
    # marks are weighted by the strain of the splices there, as in their fit
    steepness, terms = _splice_terms(model.coefficients, force)
    wanted = -steepness * (gain + offset / force) * is_read[used]
    # an average over laws includes the effect of a change of the exponent, and more
    if model.coefficients["splice_exponent"] == HELD_EXPONENT and model.method != "mixed":
        terms = terms[:1]
    return np.asarray(np.linalg.lstsq(terms.T, wanted, rcond=None)[0])


def _splice_method_error(
    model: StrainModel, *, strain: ArrayLike, tension: ArrayLike
) -> tuple[Floats, Floats, Floats] | None:
    r"""Error of strain by position alone, and its slopes, taken as one standard uncertainty.

    Notes
    -----
    The law was asked for; the marks support another one, the average over the laws that they do not
    reject.  The error lies between 0 and D, the difference of both, and has one sign.  It is not
    corrected: its standard uncertainty is the root of its mean square about zero ([1]_, 4.3.7 and
    F.2.4.5). If the whole range were equally likely, that would be :math:`D / \sqrt 3`.
    It is not: where marks show it ([2]_), the error is D.  On synthetic tethers whose splices
    follow tension, with marks over 360-600 N, 95 % intervals held the truth of the loop energy in
    70 % of cases by :math:`D / \sqrt 3`, and those of a segment in 87 %; by D in 100 and 94 %.
    Therefore D is used.

    Examples
    --------
    Splices that strain 22 % at 450 N, and a line through the marks: error of the strain of a
    branch 60 N above the marks, and relative error of the energy of a loop.

    >>> law = StrainModel("new", "tension-driven", {"relaxed_free_length": 2.55,
    ...     "relaxed_splice_length": 1.19, "splice_compliance": 0.22 / 450, "splice_exponent": 1.0})
    >>> line = StrainModel("new", "marks", {"free_length_intercept": -0.835,
    ...     "free_length_slope": 0.905, "relaxed_free_length": 2.55}, by_marks=law)
    >>> strain, over_strain, _ = _splice_method_error(line, strain=[1.0, 1.0],
    ...     tension=[450.0, 510.0])
    >>> print(np.diff(strain).round(4), over_strain[:1].round(3))
    [0.0137] [-0.105]
    """
    if model.by_marks is None:
        return None
    at, load = as_same_shape(strain=strain, tension=tension)
    push = _steps_of(load)
    # the point itself, then one step of strain and one of tension to either side
    strains = np.stack([at, at + _REACH, at - _REACH, at, at])
    loads = np.stack([load, load, load, load + push, np.maximum(load - push, 0.0)])
    position = position_by_model(model, strain=strains, tension=loads)
    error = strains - strain_by_model(model.by_marks, position=position, tension=loads)
    of_strain = (error[1] - error[2]) / (2 * _REACH)
    between = loads[3] - loads[4]
    with np.errstate(divide="ignore", invalid="ignore"):
        of_tension = np.where(load > 0, (error[3] - error[4]) / between, 0.0)
    return error[0], of_strain, of_tension


_REACH = 1e-4  # of the strain 1, for the slopes


def _position_parts(
    errors: InstrumentErrors, model: StrainModel, at: Floats, load: Floats
) -> list[FieldPart]:
    """Gain and zero of the crosshead's scale, and slip of the splices; none for an extensometer.

    An error of scale applies to the reading: of a displacement, not of the length at its zero.
    Where zero strain is a position of the log itself, a wrong zero is in both and does not change
    strain, and a wrong scale applies to the difference.  Length let out by splices is taken for
    strain of the free length.  Tests share the error of that length found by steps of tension: the
    same length, too small by the same ratio.
    """
    gain, offset = errors.position_gain, errors.position_offset
    begin = errors.position_of_scale_zero
    if model.is_zero_logged:
        begin, offset = model.coefficients["reference_position"], 0.0
    lengths = {
        Component("position_offset", errors.position_instrument): offset,
        Component("splice_slip", errors.specimen): errors.splices_slipped_by,
        Component("splice_slip", f"{errors.specimen}, marks of {errors.test}"): errors.splice_slip,
    }
    if model.method == "extensometer" or not (gain or any(lengths.values())):
        return []
    step = _steps_of(load)
    # all points at once, since each call of a model is costly
    position, further, longer, shorter = position_by_model(
        model,
        strain=np.stack([at, at + _REACH, at, at]),
        tension=np.stack([load, load, load + step, load - step]),
    )
    slope = _REACH / (further - position)
    found: list[FieldPart] = []
    if gain:
        rows = _field_rows(
            load,
            strain=gain * slope * (position - begin),
            strain_slope=gain,
            strain_slope_over_tension=gain * slope * (longer - shorter) / (2 * step),
        )
        found.append((Component("position_gain", errors.position_instrument), rows))
    by_length = (
        (one, _field_rows(load, strain=size * slope)) for one, size in lengths.items() if size
    )
    return [*found, *by_length]


def coefficient_errors(model: StrainModel, covariance: Floats | None = None) -> Floats:
    """Independent errors that add up to the covariance of the coefficients, or another covariance.

    Notes
    -----
    Results that depend on the same coefficient change together ([1]_, 5.1.3, 5.2): the
    relaxed length is in the strain at slack, in a permanent set, and in every strain of the test.

    Examples
    --------
    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0}, np.diag([0.0, 0.002**2]))
    >>> print(coefficient_errors(model).ravel())
    [0.    0.002]
    """
    size = len(model.coefficients)
    of_all = model.covariance if covariance is None else covariance
    if of_all.shape != (size, size) or not of_all.any():
        return np.empty((size, 0))
    # of correlations, since the units of the coefficients differ by many powers of ten
    deviation = np.sqrt(np.diag(of_all))
    scale = np.where(deviation > 0, deviation, 1.0)
    variance, direction = np.linalg.eigh(of_all / np.outer(scale, scale))
    kept = variance > 1e-12 * variance.max()
    root = scale[:, None] * direction * np.sqrt(np.maximum(variance, 0))
    return np.asarray(root[:, kept])


def _coefficient_parts(
    errors: InstrumentErrors, model: StrainModel, at: Floats, load: Floats
) -> list[FieldPart]:
    """Coefficients of the strain model, their covariance split into independent errors.

    These are the uncertainty left by the tape, and the choice of splice law.
    """
    roots = {
        "strain_calibration": coefficient_errors(model),
        "splice_law": coefficient_errors(model, model.law_covariance),
    }
    root = np.concatenate(list(roots.values()), axis=1)
    if not root.size:
        return []
    names = [(source, number) for source, own in roots.items() for number in range(own.shape[1])]
    position, further = position_by_model(
        model, strain=np.stack([at, at + _REACH]), tension=np.stack([load, load])
    )
    reach = further - position
    push = _steps_of(load)
    # the point itself, then one step of position and one of tension to either side
    place = np.stack([position, position + reach, position - reach, position, position])
    force = np.stack([load, load, load, load + push, load - push])
    _, slope = strain_sensitivity_of(model, position=place, tension=force)
    # a matrix product this small and long would only wait for processors to share it
    centre, farther, nearer, above, below = np.einsum("ce,cp...->pe...", root, slope)
    strain = strain_by_model(model, position=place, tension=force)
    by_position = (farther - nearer) / (2 * reach)
    by_tension = (above - below) / (2 * push)
    of_position = (strain[1] - strain[2]) / (2 * reach)
    of_tension = (strain[3] - strain[4]) / (2 * push)
    along = by_position / of_position
    across = by_tension - along * of_tension
    of = errors.strain_model or errors.specimen
    return [
        (
            Component(source, of, number),
            _field_rows(
                load,
                strain=centre[column],
                strain_slope=along[column],
                strain_slope_over_tension=across[column],
            ),
        )
        for column, (source, number) in enumerate(names)
    ]


def _compliance_part(
    errors: InstrumentErrors, model: StrainModel, at: Floats, load: Floats
) -> list[FieldPart]:
    """Machine compliance: length reduced by it times tension; none for an extensometer."""
    if model.method == "extensometer" or not errors.machine_compliance:
        return []
    step = _steps_of(load)
    push = np.stack([load, load + step, load - step])
    position, further = position_by_model(
        model, strain=np.stack([at, at + _REACH]), tension=np.stack([load, load])
    )
    strain = -errors.machine_compliance * push * _REACH / (further - position)
    rows = _field_rows(
        load, strain=strain[0], strain_slope_over_tension=(strain[1] - strain[2]) / (2 * step)
    )
    return [(Component("machine_compliance", errors.position_instrument), rows)]


def splice_friction_error(
    errors: InstrumentErrors, model: StrainModel, *, strain: ArrayLike, tension: ArrayLike
) -> Floats:
    r"""Error of strain on the way down, by splices that are longer there. [1].

    .. math:: \phi\, \ell_s \varepsilon_s\, d\varepsilon/dp

    Notes
    -----
    Friction holds a splice back: at a given tension it is longer on the way down.  The law is
    that of the marks, which are read on the way up.

    Examples
    --------
    Splices that stretch 20 % at 450 N, known to 5 % of that:

    >>> model = StrainModel("new", "tension-driven", {"relaxed_free_length": 2.5,
    ...     "relaxed_splice_length": 1.25, "splice_compliance": 0.2 / 450, "splice_exponent": 1.0})
    >>> errors = InstrumentErrors("new", splice_friction=0.05)
    >>> print(splice_friction_error(errors, model, strain=[1.0], tension=[450.0]).round(4))
    [0.005]
    """
    at, load = as_same_shape(strain=strain, tension=tension)
    splices = model.by_marks or model
    known = splices.coefficients
    if not errors.splice_friction or "relaxed_splice_length" not in known:
        return np.zeros(at.shape)
    position, further = position_by_model(
        splices, strain=np.stack([at, at + _REACH]), tension=np.stack([load, load])
    )
    rest = known["relaxed_free_length"] * (1 + at) + known["relaxed_splice_length"]
    longer = np.maximum(position - rest, 0.0)
    return np.asarray(errors.splice_friction * longer * _REACH / (further - position))


@dataclass(frozen=True)
@read_only_arrays
class Inertia:
    r"""Mass whose inertia was subtracted from the tension of cycles, and its motion in them.

    .. math:: \ddot x = -(2 \pi f)^2 (x - x_m)

    Parameters
    ----------
    mass : float
        Mass at the moving end. [kg]
    error : tuple of (Component, float)
        Its independent standard uncertainties. [kg]
    frequency, mean_strain, mean_tension : ndarray, shape (...)
        Values of the cycles; they have or broadcast to the shape of the points. [Hz], [1], [N]
    length_by_stroke : float
        Stroke over range of strain; NaN where the strain model knows the length. [m]
    """

    mass: float
    error: tuple[tuple[Component, float], ...]
    frequency: Floats
    mean_strain: Floats
    mean_tension: Floats
    length_by_stroke: float = np.nan

    def acceleration(
        self, model: StrainModel, *, strain: Floats, tension: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Acceleration at points of the cycles, with its slopes over strain and tension.

        Examples
        --------
        0.1 of strain from the middle of 1 m, at 0.5 Hz:

        >>> model = StrainModel("rope", "gauge-length",
        ...     {"reference_position": 0.0, "gauge_length": 1.0})
        >>> inertia = Inertia(5.0, (), np.array(0.5), np.array(0.3), np.array(100.0))
        >>> found, over_strain, _ = inertia.acceleration(model, strain=np.array([0.4]),
        ...     tension=np.array([120.0]))
        >>> print(found.round(4), over_strain.round(4))
        [-0.987] [-9.8696]
        """
        square = -((2 * np.pi * self.frequency) ** 2)
        middle = np.broadcast_to(self.mean_strain, tension.shape)
        if np.isfinite(self.length_by_stroke):
            over_strain = np.broadcast_to(square * self.length_by_stroke, tension.shape)
            return over_strain * (strain - middle), over_strain, np.zeros(tension.shape)
        step = _steps_of(tension)
        level = np.broadcast_to(self.mean_tension, tension.shape)
        position, further, longer, shorter, centre = position_by_model(
            model,
            strain=np.stack([strain, strain + _REACH, strain, strain, middle]),
            tension=np.stack([tension, tension, tension + step, tension - step, level]),
        )
        return (
            np.asarray(square * (position - centre)),
            np.asarray(square * (further - position) / _REACH),
            np.asarray(square * (longer - shorter) / (2 * step)),
        )


def _with_inertia(
    parts: list[FieldPart],
    errors: InstrumentErrors,
    model: StrainModel,
    at: Floats,
    load: Floats,
    inertia: Inertia,
) -> list[FieldPart]:
    """Errors of the subtracted inertia: of its mass, its acceleration and the cell."""
    found, over_strain, over_tension = inertia.acceleration(model, strain=at, tension=load)
    of_mass = _field_rows(
        load, tension=found, tension_slope=over_tension, tension_slope_over_strain=over_strain
    )
    # a load cell that reads high also reads the inertia high; a scale scales the acceleration
    felt = {
        Component("tension_gain", errors.tension_instrument): errors.tension_gain,
        Component("position_gain", errors.position_instrument): -errors.position_gain,
    }
    moved = [
        (one, rows + felt[one] * inertia.mass * of_mass if one in felt else rows)
        for one, rows in parts
    ]
    return [*moved, *((one, -spread * of_mass) for one, spread in inertia.error)]


_PIECE = 4096  # points


@dataclass(frozen=True)
@read_only_arrays
class ErrorField:
    """Errors at points of the plane; arrays have shape (n_components, ...).

    Parameters
    ----------
    component : tuple of Component, length n_components
        Lag is not included, since it depends on rates.
    tension, strain : ndarray
        Logged less true. [N], [1]
    tension_slope : ndarray
        Derivative of the tension's error by tension. [1]
    strain_slope : ndarray
        Derivative of the strain's error by strain at one tension. [1]
    strain_slope_over_tension : ndarray
        Derivative of the strain's error by tension at one strain. [N-1]
    tension_slope_over_strain : ndarray
        Derivative of the tension's error by strain at one tension. [N]
    strain_by_tension : ndarray, shape (...)
        Change of strain with the tension logged at one position: negative where the
        splices are taken to stretch by it, else zero. [N-1]
    """

    component: tuple[Component, ...]
    tension: Floats
    strain: Floats
    tension_slope: Floats
    strain_slope: Floats
    strain_slope_over_tension: Floats
    tension_slope_over_strain: Floats
    strain_by_tension: Floats

    @property
    def divergence(self) -> Floats:
        """Relative growth of a small area of the plane, or of the energy of a loop there. [1]."""
        return self.tension_slope + self.strain_slope


def error_field(
    errors: InstrumentErrors,
    model: StrainModel,
    *,
    strain: ArrayLike,
    tension: ArrayLike,
    held: Literal["position", "tension"] = "position",
    inertia: Inertia | None = None,
) -> ErrorField:
    r"""Effect of each shared error on tension and strain at points of the plane.

    .. math::

        \delta T &= g_T T + o_T \\
        \delta\varepsilon &= \frac{\partial\varepsilon}{\partial p} (g_p p + o_p)
            + \frac{\partial\varepsilon}{\partial F} \delta T
            + \sum_i \frac{\partial\varepsilon}{\partial\theta_i} \delta\theta_i
            + g_\varepsilon \varepsilon

    Parameters
    ----------
    errors : InstrumentErrors
        Standard uncertainties.
    model : StrainModel
        Conversion of position to strain, with the covariance of its coefficients.
    strain, tension : array_like, shape (...)
        Points, NaN where missing. [1], [N]
    held : {"position", "tension"}, optional
        The one that the temperature of the specimen does not change: controlled by the machine
        (or a weight), or the value at which a number is read.
    inertia : Inertia, optional
        Inertia subtracted from the tension of cycles; none where points stand still.

    Returns
    -------
    field : ErrorField
        One component for each error that is not zero.

    Raises
    ------
    DataError
        If strain and tension differ in shape.

    Notes
    -----
    First order ([1]_, 5.1.3).  Where the marks were read under tensions from the same load
    cell, the splice law is fitted to them: an error of that cell is in the law too, and strain
    remains as the tape shows; a law made under another cell has the errors of that one
    (`reduction.uncertainty.error_field._load_parts`, [2]_).  An extensometer has neither error; the
    error of position alone is `_splice_method_error`.

    Examples
    --------
    A gauge length of 1 m known to 2 mm, 1 % of load cell gain, at 50 % and 900 N:

    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0}, np.diag([0.0, 0.002**2]))
    >>> field = error_field(InstrumentErrors("rope", tension_gain=0.01), model,
    ...     strain=0.5, tension=900.0)
    >>> print([one.source for one in field.component], field.tension, field.strain.round(6))
    ['tension_gain', 'strain_calibration'] [9. 0.] [ 0.    -0.001]
    """
    at, load = as_same_shape(strain=strain, tension=tension)

    def part_of(part: slice) -> Inertia | None:
        if inertia is None:
            return None
        frequency, strain, tension = (
            np.broadcast_to(one, load.shape).ravel()[part]
            for one in (inertia.frequency, inertia.mean_strain, inertia.mean_tension)
        )
        return replace(inertia, frequency=frequency, mean_strain=strain, mean_tension=tension)

    # point by point, in pieces that stay in the processor cache
    parts = [slice(begin, begin + _PIECE) for begin in range(0, max(load.size, 1), _PIECE)]
    pieces = [
        _table_at(errors, model, at.ravel()[part], load.ravel()[part], held, part_of(part))
        for part in parts
    ]
    components, tables, by_tension = zip(*pieces, strict=True)
    table = np.concatenate(tables, axis=-1).reshape(len(components[0]), len(ROWS), *load.shape)
    return ErrorField(
        components[0],
        **dict(zip(ROWS, np.moveaxis(table, 1, 0), strict=True)),
        strain_by_tension=np.concatenate(by_tension).reshape(load.shape),
    )


def _table_at(
    errors: InstrumentErrors,
    model: StrainModel,
    at: Floats,
    load: Floats,
    held: Literal["position", "tension"],
    inertia: Inertia | None,
) -> tuple[tuple[Component, ...], Floats, Floats]:
    """Errors at points in a row, the effect of each there, and the strain by tension."""
    parts = [
        *_load_parts(errors, model, load),
        *_position_parts(errors, model, at, load),
        *_coefficient_parts(errors, model, at, load),
        *_compliance_part(errors, model, at, load),
    ]
    if inertia is not None:
        parts = _with_inertia(parts, errors, model, at, load, inertia)
    missed = _splice_method_error(model, strain=at, tension=load)
    if missed is not None:
        rows = _field_rows(load, strain=missed[0], strain_slope=missed[1],
                     strain_slope_over_tension=missed[2])  # fmt: skip
        parts.append((Component("splice_method", errors.specimen), rows))
    if model.by_marks is not None and model.by_marks.law_covariance.size:
        # uncertainty of the law by which the requested one is judged
        left_open = replace(model.by_marks, covariance=np.empty((0, 0)))
        parts += _coefficient_parts(errors, left_open, at, load)
    if errors.stiffness:
        # the rubber is warmer or colder than stated: the cell reads the actual tension, or the
        # specimen stretches less under the weight hung on it
        rows = (
            _field_rows(load, strain=-errors.stiffness * at, strain_slope=-errors.stiffness)
            if held == "tension"
            else _field_rows(load, tension=errors.stiffness * load, tension_slope=errors.stiffness)
        )
        parts.append((Component("temperature", errors.test), rows))
    if errors.strain_gain:
        rows = _field_rows(load, strain=errors.strain_gain * at, strain_slope=errors.strain_gain)
        parts.append((Component("strain_gain", errors.strain_model or errors.specimen), rows))
    table = np.stack([rows for _, rows in parts]) if parts else np.empty((0, len(ROWS), load.size))
    return tuple(one for one, _ in parts), table, _strain_by_tension(model, at, load)
