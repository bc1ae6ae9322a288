"""A measured curve on an axis of strain, from the samples of a test.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004.
.. [2] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of
   uncertainty in measurement" (type A and type B).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.compare.cells import Cells, fill_cells, reading_of, tension_at_centres
from reduction.compare.measuredcurve import Loading, MeasuredCurve
from reduction.compare.samples import select_samples
from reduction.compare.scatter import bin_noise, branch_scatter, shared_scatter
from reduction.compare.shared import SharedErrors, constant_errors
from reduction.errors import DataError, SettingsError
from reduction.record import Bools, Floats, Integers

_ONE_BRANCH = (
    "one branch was measured: it is judged itself, and lies above a midline by half the loop"
)
_GREATEST_STRAIN = 10.0  # no hose stretches to eleven times its length


def measured_curve(
    strain: ArrayLike,
    tension: ArrayLike,
    *,
    loading: Loading,
    cycle_number: ArrayLike | None = None,
    branch: ArrayLike | None = None,
    strain_step: float | None = None,
    break_in_cycles: int = 0,
    shared: SharedErrors | None = None,
) -> MeasuredCurve:
    r"""Tension of every cycle and branch at equally spaced strains, and over the cycles.

    With the mean strain :math:`\bar\varepsilon` and tension :math:`\bar T` of the samples in a
    bin, the tension at its centre :math:`\varepsilon_0` is

    .. math:: T = \bar T - T' (\bar\varepsilon - \varepsilon_0)
              + \tfrac{1}{2} T'' [(\bar\varepsilon - \varepsilon_0)^2 - s^2],

    slope and bend from the means of the two neighbouring bins, :math:`s^2` the variance of
    strain in the bin.

    Parameters
    ----------
    strain : array_like, shape (n_samples,)
        Nominal strain of the whole relaxed length; NaN where missing or flagged. [1]
    tension : array_like, shape (n_samples,)
        Tension; NaN where missing or flagged. [N]
    loading : {"static", "dynamic"}
        How it was pulled.
    cycle_number : array_like of int, shape (n_samples,), optional
        From 1; 0 outside cycles. Without it the record is one slow pull, which ends at its
        greatest tension. [1]
    branch : array_like of int, shape (n_samples,), optional
        0 none, 1 ascending, 2 descending; goes with ``cycle_number``. [1]
    strain_step : float, optional
        Between the strains of the curve; without it 1 %, or wider where samples are few. [1]
    break_in_cycles : int
        First cycles that are in no mean; they are kept cycle by cycle. [1]
    shared : SharedErrors, optional
        What is wrong alike with all samples; nothing where not given.

    Returns
    -------
    curve : MeasuredCurve
        Cycle by cycle, means, midline, and what they are uncertain by. [SI]

    Raises
    ------
    DataError
        If the series do not pair up, no sample belongs to a branch, no cycle is left after
        break-in, or a strain is one that no hose has.
    SettingsError
        If the step is not positive, one of ``cycle_number`` and ``branch`` is missing, or
        ``loading`` is neither.

    Notes
    -----
    *Bias.* A mean over a bin is high by a 24th of its bend; the third term takes that off, so
    that a parabola comes back exactly.  Where the cords pick up, the slope jumps and the curve
    is rounded over one bin; ``reading`` says how.  A bin at the end of a branch has one neighbour
    and no bend.  No value lies beyond the samples that it is read from.

    *End.* The last samples rarely reach the centre of their bin.  Where they do not, the curve
    goes on to the last sample, by the mean of those samples and the slope from the bin below.

    *Uncertainty* of the means is type A: scatter over the cycles, and for a single pull the
    noise in the bins and from bin to bin.  Where cycles lie high or low as a whole, that part
    is kept as signed contributions, since it does not average out over strain.  What is wrong
    alike with all samples is signed contributions too: what the curve is wrong by if the
    instrument reads one standard uncertainty high.  A strain that is read high moves the curve
    to the right: minus the slope times it.  The noise of a reading is no such thing: it is in
    the scatter.

    *NaN.* A sample that is missing in either series is left out; a bin is NaN where a branch
    has no sample, or only samples beside its centre with nothing beyond; a mean is NaN where
    fewer than half of the cycles came.  Strains below zero are left out: no hose is
    predicted there.

    More than 1000 cycles are kept as means of consecutive ones.

    Examples
    --------
    Two cycles of a parabola come back exactly, ascending 10 N above descending.

    >>> stroke = np.linspace(0.0, 0.5, 401)
    >>> strain = np.tile(np.concatenate([stroke, stroke[::-1]]), 2)
    >>> branch = np.tile(np.repeat([1, 2], 401), 2)
    >>> tension = 400 * strain**2 + np.where(branch == 1, 5, -5)
    >>> curve = measured_curve(
    ...     strain, tension, loading="static", cycle_number=np.repeat([1, 2], 802), branch=branch
    ... )
    >>> place = np.searchsorted(curve.strain, 0.2999)
    >>> print(curve.tension[:, :, place].round(6), curve.midline_tension[place].round(6))
    [[41. 31.] [41. 31.]] 36.0
    """
    if loading not in ("static", "dynamic"):
        raise SettingsError("loading is unknown", found=str(loading), needed="static or dynamic")
    samples = select_samples(
        strain, tension, cycle_number=cycle_number, branch=branch, break_in_cycles=break_in_cycles
    )
    step = samples.least_step() if strain_step is None else strain_step
    if not (np.isfinite(step) and step > 0):
        raise SettingsError("strain_step cannot be used", found=f"{step:g}", needed="above zero")
    greatest = float(samples.strain.max())
    if greatest > _GREATEST_STRAIN:
        raise DataError(
            "no hose stretches as far as this test: strain in per cent?",
            found=f"a strain of {greatest:.4g}, {100 * greatest:.4g} %",
            needed=f"strains as a part of the relaxed length, {_GREATEST_STRAIN:g} at most",
        )
    n_cycle = samples.cycle_number.size
    cells, centre = fill_cells(
        samples.strain, samples.tension, row=samples.row, n_rows=2 * n_cycle, step=step
    )
    by_row = tension_at_centres(cells)
    by_cycle = by_row.reshape(n_cycle, 2, centre.size)
    kept = by_cycle[samples.n_break_in :]
    noise = bin_noise(cells, by_row).reshape(by_cycle.shape)[samples.n_break_in :]
    mean, variance = branch_scatter(kept, noise)
    middle, noise_of_middle = kept.mean(axis=1), noise.mean(axis=1) / 2
    midline = branch_scatter(middle[:, None], noise_of_middle[:, None])[0][0]
    is_paired = bool(np.isfinite(midline).any())
    judged = midline if is_paired else mean[0]
    cycles, its_noise = (middle, noise_of_middle) if is_paired else (kept[:, 0], noise[:, 0])
    common, rest = shared_scatter(cycles, judged)
    _, independent = branch_scatter(rest[:, None], its_noise[:, None])
    type_a = np.sqrt(independent[0] + np.sum(common**2, axis=0))
    of_branch = np.sqrt(variance)
    if not is_paired:
        of_branch[0] = type_a
    known = shared or constant_errors()
    contribution, strain_error = _contributions(centre, mean, known)
    in_mean = np.isfinite(cycles) & np.isfinite(judged)
    row_weight = np.zeros(by_cycle.shape)
    part = in_mean / np.maximum(in_mean.sum(axis=0), 1)
    row_weight[samples.n_break_in :, : 1 + is_paired] = part[:, None] / (1 + is_paired)
    rows = 2 * np.arange(samples.n_break_in, n_cycle)[:, None] + np.arange(1 + is_paired)
    end = _end_of_curve(cells, rows, np.isfinite(judged), type_a)
    return MeasuredCurve(
        strain=centre,
        tension=by_cycle,
        count=cells.count.reshape(by_cycle.shape).astype(np.int64),
        cycle_number=samples.cycle_number,
        branch_tension=mean,
        branch_standard_uncertainty=of_branch,
        midline_tension=midline,
        midline_standard_uncertainty=type_a if is_paired else np.full(centre.size, np.nan),
        scatter_contribution=common,
        component=known.component,
        contribution=contribution,
        strain_error=strain_error.mean(axis=1) if is_paired else strain_error[:, 0],
        loading=loading,
        reading=reading_of(
            samples.strain,
            row=samples.row,
            cells=cells,
            row_weight=row_weight.reshape(by_row.shape),
            centre=centre,
            step=step,
        ),
        end_strain=centre[0] + step * end[0],
        end_tension=end[1],
        end_standard_uncertainty=end[2],
        cycles_pooled=samples.cycles_pooled,
        notes=samples.notes if is_paired else (*samples.notes, _ONE_BRANCH),
    )


def _end_of_curve(
    cells: Cells, rows: Integers, is_judged: Bools, type_a: Floats
) -> tuple[float, float, float]:
    """Strain from the first centre in bins, tension and type A where samples end; NaN if earlier.

    ``rows`` has the shape (n_cycle, n_branch).
    """
    nothing = float("nan"), float("nan"), float("nan")
    seen = np.flatnonzero(is_judged)
    last = int(seen[-1]) if seen.size else -1
    if not 0 <= last < is_judged.size - 1:
        return nothing
    gap = 1 + cells.offset[rows, last + 1] - cells.offset[rows, last]
    there = np.isfinite(gap).all(axis=1)
    if 2 * there.sum() < rows.shape[0] or not there.any():
        return nothing
    rows, gap = rows[there], gap[there]
    level, count = cells.tension[rows, last + 1], cells.count[rows, last + 1]
    onward = cells.furthest[rows, last + 1] - cells.offset[rows, last + 1]
    tension = level + (level - cells.tension[rows, last]) / gap * onward
    of_cycle = tension.mean(axis=1)
    noise = cells.residual.sum() / max(cells.freedom.sum(), 1.0)
    leverage = (1 + onward / gap) ** 2 / count + (onward / gap) ** 2 / cells.count[rows, last]
    variance = noise * float(leverage.mean()) / rows.size
    if of_cycle.size > 1:
        variance = max(variance, float(np.var(of_cycle, ddof=1)) / of_cycle.size)
    return (
        last + 1 + float(cells.furthest[rows, last + 1].mean()),
        float(of_cycle.mean()),
        float(np.hypot(type_a[last], np.sqrt(variance))),
    )


def _contributions(strain: Floats, tension: Floats, shared: SharedErrors) -> tuple[Floats, Floats]:
    """Errors of the branches and their middle in tension, and of the branches in strain."""
    errors = shared.at(strain, tension)
    slope = np.zeros(tension.shape)
    for branch, curve in zip(slope, tension, strict=True):
        there = np.isfinite(curve)
        if np.count_nonzero(there) > 1:
            branch[there] = np.gradient(curve[there], strain[there])
    of_branch = np.where(np.isfinite(tension), errors.tension - slope * errors.strain, 0.0)
    both = np.isfinite(tension).all(axis=0)
    middle = np.where(both, of_branch.mean(axis=1), 0.0)
    return np.concatenate([of_branch, middle[:, None]], axis=1), errors.strain
