"""What the crosshead's scale and the readings of the tape do to strain at points of the plane.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.1.3 (sensitivity coefficients) and 5.2 (correlated inputs).
"""

from __future__ import annotations

import numpy as np

from reduction.record import Floats
from reduction.strain.evaluate import strain_by_model, strain_sensitivity_of
from reduction.strain.inverse import position_by_model
from reduction.strain.model import StrainModel
from reduction.uncertainty.fieldrows import FieldPart, field_rows, steps_of
from reduction.uncertainty.product import Component, InstrumentErrors

_REACH = 1e-4  # of the strain 1, for the slopes


def position_parts(
    errors: InstrumentErrors, model: StrainModel, at: Floats, load: Floats
) -> list[FieldPart]:
    """Gain and zero of the crosshead's scale; none for an extensometer.

    Where zero strain is a position of the log itself, a wrong zero is in both and leaves strain as
    it is, and a wrong scale is one of what lies between.
    """
    gain, offset = errors.position_gain, errors.position_offset
    begin = 0.0
    if model.is_zero_logged:
        begin, offset = model.coefficients["reference_position"], 0.0
    if model.method == "extensometer" or not (gain or offset):
        return []
    step = steps_of(load)
    # all points at once: what a model costs is its call
    position, further, longer, shorter = position_by_model(
        model,
        strain=np.stack([at, at + 1, at, at]),
        tension=np.stack([load, load, load + step, load - step]),
    )
    slope = 1 / (further - position)
    found: list[FieldPart] = []
    if gain:
        rows = field_rows(
            load,
            strain=gain * slope * (position - begin),
            strain_slope=gain,
            strain_slope_over_tension=gain * slope * (longer - shorter) / (2 * step),
        )
        found.append((Component("position_gain", errors.position_instrument), rows))
    if offset:
        rows = field_rows(load, strain=offset * slope)
        found.append((Component("position_offset", errors.position_instrument), rows))
    return found


def coefficient_errors(model: StrainModel) -> Floats:
    """Independent errors whose sum is the covariance of the coefficients.

    Parameters
    ----------
    model : StrainModel
        With the covariance of its coefficients.

    Returns
    -------
    errors : ndarray, shape (n_coefficients, n_errors)
        Signed change of each coefficient, in the order of the model, by each error: entry n is
        that of the component ``strain_calibration`` with number n. [SI]

    Raises
    ------
    DataError
        Never.

    Notes
    -----
    Whatever rests on one of the coefficients moves with them together ([1]_, 5.2): the relaxed
    length is in the strain at slack, in a permanent set, and in every strain of the test.

    Examples
    --------
    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0}, np.diag([0.0, 0.002**2]))
    >>> print(coefficient_errors(model).ravel())
    [0.    0.002]
    """
    size = len(model.coefficients)
    if model.covariance.shape != (size, size) or not model.covariance.any():
        return np.empty((size, 0))
    # of correlations: the coefficients have units many powers of ten apart
    deviation = np.sqrt(np.diag(model.covariance))
    scale = np.where(deviation > 0, deviation, 1.0)
    variance, direction = np.linalg.eigh(model.covariance / np.outer(scale, scale))
    kept = variance > 1e-12 * variance.max()
    root = scale[:, None] * direction * np.sqrt(np.maximum(variance, 0))
    return np.asarray(root[:, kept])


def coefficient_parts(
    errors: InstrumentErrors, model: StrainModel, at: Floats, load: Floats
) -> list[FieldPart]:
    """Coefficients of the strain model, their covariance taken apart into independent errors."""
    root = coefficient_errors(model)
    if not root.size:
        return []
    position, further = position_by_model(
        model, strain=np.stack([at, at + 1]), tension=np.stack([load, load])
    )
    reach = _REACH * (further - position)
    push = steps_of(load)
    # the point itself, then one step of position and one of tension to either side
    place = np.stack([position, position + reach, position - reach, position, position])
    force = np.stack([load, load, load, load + push, load - push])
    _, slope = strain_sensitivity_of(model, position=place, tension=force)
    # a product of matrices this small and long only waits for processors to share it
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
            Component("strain_calibration", of, number),
            field_rows(
                load,
                strain=centre[number],
                strain_slope=along[number],
                strain_slope_over_tension=across[number],
            ),
        )
        for number in range(root.shape[1])
    ]
