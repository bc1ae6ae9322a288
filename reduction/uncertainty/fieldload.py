r"""What the zero and the gain of load cells do at points of the plane: in tension, and by splices.

A splice law gives strain by the tension that is logged, and was itself fitted to tensions that a
load cell read at the marks.  The same cell or another: each cell moves the tension of the samples
that it logged and the law by the marks that it read.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.1.3 (sensitivity coefficients) and F.1.2.3 (common influence quantities).
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, Table 3.
"""

from __future__ import annotations

import numpy as np

from reduction.record import Bools, Floats
from reduction.strain.evaluate import strain_by_model
from reduction.strain.inverse import position_by_model
from reduction.strain.law import HELD_EXPONENT
from reduction.strain.model import StrainModel
from reduction.uncertainty.fieldrows import FieldPart, field_rows, steps_of
from reduction.uncertainty.product import Component, InstrumentErrors


def load_parts(errors: InstrumentErrors, model: StrainModel, load: Floats) -> list[FieldPart]:
    """Gain and zero of each load cell: that of the samples, and those of the marks.

    Parameters
    ----------
    errors : InstrumentErrors
        Standard uncertainties, which hold for every cell of the campaign.
    model : StrainModel
        Its ``mark_load_cell`` says under which cell each mark was read; where it says nothing
        the cell is that of the samples.
    load : ndarray, shape (...)
        Tension at the points. [N]

    Returns
    -------
    parts : list of (Component, ndarray)
        Two a cell, less what is zero.

    Notes
    -----
    First order ([1]_).  A wrong gain of the one cell that read samples and marks leaves strain as
    it is, and a wrong zero nearly so: a splice strains at its marks what the tape says, whatever
    the cell reads.  Under another cell 1 % of gain is 0.14 % of strain on the tethers of [2]_,
    and the error of the marks' cell is as much, the other way.

    Examples
    --------
    >>> model = StrainModel("new", "tension-driven", {"relaxed_free_length": 2.5,
    ...     "relaxed_splice_length": 1.2, "splice_compliance": 5e-4, "splice_exponent": 1.0},
    ...     mark_hold=("min", "max"), mark_tension=np.array([300.0, 500.0]),
    ...     mark_load_cell=("A", "A"))
    >>> for cell in ("A", "B"):
    ...     of = InstrumentErrors("new", tension_gain=0.01, tension_instrument=cell)
    ...     print([(one.of, float(rows[1].round(6))) for one, rows in
    ...            load_parts(of, model, np.array(400.0))])
    [('A', 0.0)]
    [('B', -0.00096), ('A', 0.00096)]
    """
    found: list[FieldPart] = []
    step = steps_of(load)
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
            if not (gain or offset) or not (is_own or model.method == "tension-driven"):
                continue
            law = _refitted(model, gain, offset, is_read)
            strain, above, below = (
                _splice_error(model, force, gain * is_own, offset * is_own, law)
                for force in (load, load + step, load - step)
            )
            rows = field_rows(
                load,
                tension=is_own * (gain * load + offset),
                strain=strain,
                tension_slope=is_own * gain,
                strain_slope_over_tension=(above - below) / (2 * step),
            )
            found.append((Component(source, cell), rows))
    return found


def strain_by_tension(model: StrainModel, at: Floats, load: Floats) -> Floats:
    """Slope of strain over the logged tension at one position; zero for an extensometer. [N-1]."""
    if model.method == "extensometer":
        return np.zeros(load.shape)
    position = position_by_model(model, strain=at, tension=load)
    step = steps_of(load)
    above, below = strain_by_model(
        model, position=np.stack([position, position]), tension=np.stack([load + step, load - step])
    )
    return np.asarray((above - below) / (2 * step))


def _used(model: StrainModel) -> Bools:
    """Marks that a law of tension is fitted to: stretched, with a tension."""
    stretched = np.array([hold != "slack" for hold in model.mark_hold], dtype=bool)
    is_known = np.nan_to_num(model.mark_tension) > 0
    return is_known & stretched if stretched.size else is_known


def _splice_error(
    model: StrainModel, load: Floats, gain: float, offset: float, law: tuple[float, float]
) -> Floats:
    """Error of the strain by that of the tension and by those of ln c and n of the law."""
    if model.method != "tension-driven":
        return np.zeros(load.shape)
    known = model.coefficients
    compliance, exponent = known["splice_compliance"], known["splice_exponent"]
    share = known["relaxed_splice_length"] / known["relaxed_free_length"]
    force = np.maximum(load, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        logarithm = np.where(force > 0, np.log(force), 0.0)
        relative = np.where(force > 0, gain + offset / force, 0.0)
    of_factor, of_exponent = law
    splice = compliance * force**exponent
    change = splice * (exponent * relative + of_factor + logarithm * of_exponent)
    return np.where(np.isnan(load), np.nan, -share * change)


def _refitted(
    model: StrainModel, gain: float, offset: float, is_read: Bools
) -> tuple[float, float]:
    """Change of ln c and n of the splice law by the marks that a wrong cell read."""
    used = _used(model)
    if model.method != "tension-driven" or not is_read.any():
        return 0.0, 0.0
    force = model.mark_tension[used]
    exponent = model.coefficients["splice_exponent"]
    # marks weigh by the strain of the splices there, as in their fit
    weight = force**exponent
    wanted = -exponent * (gain + offset / force) * weight * is_read[used]
    basis = np.stack([weight, np.log(force) * weight], axis=1)
    if exponent == HELD_EXPONENT:
        basis = basis[:, :1]
    solved = np.linalg.lstsq(basis, wanted, rcond=None)[0]
    return float(solved[0]), float(solved[1]) if solved.size > 1 else 0.0
