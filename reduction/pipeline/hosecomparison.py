"""A reduced test of a hose against its prediction."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.compare.hose import compare_hose
from reduction.compare.measured import measured_curve
from reduction.compare.measuredcurve import Loading
from reduction.compare.product import Comparison
from reduction.compare.shared import SharedErrors
from reduction.errors import DataError
from reduction.prediction import HosePlan
from reduction.record import Floats, Integers

_STATIC = ("quasi-static", "tensile")
_WAY_BACK = 0.5
"""Share of the stroke that a way back has, to be a branch of its own."""


def loading_of(kind: str) -> Loading:
    """How a test of a kind is pulled, where nobody says it.

    >>> loading_of("cyclic")
    'dynamic'
    """
    return "static" if kind in _STATIC else "dynamic"


def compare_record(
    plan: HosePlan,
    strain: Floats,
    tension: Floats,
    *,
    loading: Loading,
    cycle_number: Integers | None,
    branch: Integers | None,
    break_in_cycles: int = 0,
    shared: SharedErrors | None = None,
    calibrate: Sequence[str] = (),
) -> Comparison:
    """Hold the prediction of a hose against one test.

    Parameters
    ----------
    plan : HosePlan
        The hose.
    strain, tension : ndarray, shape (n_samples,)
        Of the whole relaxed length [1], and axial load [N]; NaN where not usable.
    loading : {"static", "dynamic"}
        How it was pulled.
    cycle_number, branch : ndarray of int, shape (n_samples,), or None
        Cycles of the test, and their branches; None of a pull, whose way back is a branch too.
    break_in_cycles : int
        First cycles that enter no mean.
    shared : SharedErrors, optional
        What is wrong alike with all samples; nothing where not given.
    calibrate : sequence of str
        Numbers of the hose to be fitted.

    Returns
    -------
    comparison : Comparison
        Differences, verdict, and calibration where asked for.

    Raises
    ------
    DataError
        If no sample is usable, or test and prediction have no strain in common.
    FitError
        If the calibration does not come to an end.
    """
    usable = np.isfinite(strain) & np.isfinite(tension)
    if not usable.any():
        raise DataError(
            "the test has no sample with strain and tension", found=f"{strain.size} samples",
            needed="a record with strain and tension",
        )  # fmt: skip
    if cycle_number is None or branch is None:
        cycle_number, branch = _out_and_back(np.where(usable, strain, np.nan))
    curve = measured_curve(
        strain,
        tension,
        loading=loading,
        cycle_number=cycle_number,
        branch=branch,
        break_in_cycles=break_in_cycles,
        shared=shared,
    )
    return compare_hose(
        plan.design, curve, standard_uncertainty=plan.standard_uncertainty, calibrate=calibrate
    )


def _out_and_back(strain: Floats) -> tuple[Integers | None, Integers | None]:
    """A pull and its way back as one cycle; no cycle where it does not come back."""
    top = int(np.nanargmax(strain))
    least = np.nanmin(strain[: top + 1])
    stroke = strain[top] - least
    back = strain[top] - np.nanmin(strain[top:])
    if back < _WAY_BACK * stroke:
        return None, None
    branch = np.where(np.arange(strain.size) <= top, 1, 2)
    return np.ones(strain.size, dtype=np.int64), branch
