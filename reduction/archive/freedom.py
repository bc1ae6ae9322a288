"""Degrees of freedom of the uncertainties of an archive: what each of them was found from.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 4.2.6, G.4.1 (Welch and Satterthwaite).
.. [2] J. von Neumann, R. H. Kent, H. R. Bellinson and B. I. Hart, "The mean square successive
   difference," Ann. Math. Statist., vol. 12, no. 2, pp. 153-162, 1941.
"""

from __future__ import annotations

import json
from functools import cache

import numpy as np
import xarray as xr

from reduction.archive.shared import COMPONENT, FREEDOM
from reduction.archive.stored import stored
from reduction.record import Floats
from reduction.uncertainty.combine import effective_degrees_of_freedom

_RANDOM = "_random_standard_uncertainty"
_CONTRIBUTION = "_uncertainty_contribution"
# one of them is a regression on samples, of which there are hundreds
_OF_SAMPLES = frozenset({
    "cycle", "selected_cycle", "hold", "held_pair", "slip", "step", "interval", "tension_grid",
    "break_share", "pull_term", "strain_level", "elastomer_parameter", "first_loading_strain_bin",
    "comparison_point", "sample", "property",
})  # fmt: skip
# read once, from the samples of one rise, one pull or two cycles
_ONCE = ("bedding_", "pull_", "tensile_strength", "strain_at_failure", "permanent_set",
         "slack_strain", "test_quasi_static_spring_constant")  # fmt: skip
_LAST = ("dynamic_stiffness", "dynamic_mean_tension", "dynamic_tension_amplitude")
_OF_SURFACE = ("_point_value", "_stationary_point", "_eigenvalue")
_LINES = ("_per_decade", "_per_cycle", "_change", "_drift")
_SINGLE = "tension_amplitude"
# from the differences of neighbouring cycles, of which each cycle is in two
_OF_NEIGHBOURS = frozenset({"peak_tension_change"})
_READINGS = {"diameter": "diameter_reading", "area": "diameter_reading"}
# bins are those of the cycles that reach them
_COUNTS = {"tangent_modulus": "tangent_modulus_count", "branch_tension": "branch_tension_count",
           "tangent_modulus_untrimmed": "branch_tension_count"}  # fmt: skip


def cycles_averaged(archive: xr.Dataset, name: str) -> Floats:
    """Cycles that the mean of a quantity over a test is of: those after the break-in that have one.

    Parameters
    ----------
    archive : xarray.Dataset
        Of a reduced test.
    name : str
        As the archive names the mean.

    Returns
    -------
    count : ndarray, shape (n_specimens,), or a single number
        Of an archive that keeps single cycles by specimen, else the same of all. [1]

    Raises
    ------
    ValueError
        If the settings of the archive are no JSON.

    Notes
    -----
    A cycle of which a channel is missing has no number and is in no mean.  Quantities that are
    not kept cycle by cycle are found where the tension amplitude is.

    Examples
    --------
    >>> cycles = xr.Dataset({"tension_amplitude": (("specimen", "cycle"), [[5.0, np.nan, 5.1]])})
    >>> print(cycles_averaged(cycles, "test_dynamic_modulus"))
    [2]
    """
    break_in = _break_in_cycles(str(archive.attrs.get("settings") or "{}"))
    for single in (name.removeprefix("test_"), _SINGLE):
        if single in archive and archive.variables[single].dims == ("specimen", "cycle"):
            known = np.isfinite(archive.variables[single].values[:, break_in:])
            return np.asarray(known.sum(axis=1))
    return np.asarray(max(archive.sizes.get("cycle", 0) - break_in, 0))


@cache
def _break_in_cycles(settings: str) -> int:
    """How many first cycles are in no mean, by the settings of an archive."""
    stated = json.loads(settings).get("reduction", {}).get("cycles", {})
    return int(stated.get("break_in_cycles", 0))


def random_freedom(archive: xr.Dataset, name: str) -> Floats:
    """Degrees of freedom of the random part of a quantity.

    Parameters
    ----------
    archive : xarray.Dataset
        Of a reduced test, or of experiments.
    name : str
        As the archive names it.

    Returns
    -------
    freedom : ndarray, in the shape of the quantity or a single number
        Of what the part was found from; at least 1. [1]

    Raises
    ------
    ValueError
        If the settings of the archive are no JSON.

    Notes
    -----
    Stated, where the archive states it: of a regression over runs, of a ratio.  Readings less one;
    cycles less one, or two for a line over them, of those that reach the number or of all after the
    break-in that have it; 2 (n - 1)^2 / (3 n - 4) for the differences of n neighbours, whose mean
    square has the variance 4 (3 n - 4) sigma^4 / (n - 1)^2 about 2 sigma^2 ([2]_); infinite for a
    regression on the samples of one rise, pull or hold, and where a single cycle leaves nothing
    but that ([1]_, 4.2.6).

    Examples
    --------
    >>> readings = xr.Dataset({"diameter_reading": (("specimen", "reading"), [[1.0, 2.0, 3.0]])})
    >>> print(random_freedom(readings, "area"), random_freedom(readings, "pull_peak_tension"))
    [2.] inf
    """
    base = name.removesuffix("_engineering").removesuffix("_coefficient")
    for stated in (f"{base}_term_degrees_of_freedom", f"{name}_degrees_of_freedom"):
        if stated in archive:
            return np.asarray(archive.variables[stated].values, dtype=np.float64)
    for of in _OF_SURFACE:
        if f"{name.removesuffix(of)}_term_degrees_of_freedom" in archive and name.endswith(of):
            found = archive.variables[f"{name.removesuffix(of)}_term_degrees_of_freedom"].values
            # all terms of a surface together count as the one that is known from the fewest
            fewest = np.min(found, axis=-1, where=np.isfinite(found), initial=np.inf)
            return np.asarray(fewest[:, None])
    if _READINGS.get(name) in archive:
        read = np.isfinite(archive.variables[_READINGS[name]].values).sum(axis=-1)
        return np.asarray(np.maximum(read - 1.0, 1.0))
    if _COUNTS.get(name) in archive:
        count = np.asarray(archive.variables[_COUNTS[name]].values, dtype=np.float64)
        return np.where(count > 1, count - 1, np.inf)
    dims = set(map(str, archive.variables[name].dims)) if name in archive else set()
    if _OF_SAMPLES & dims or name.startswith(_ONCE):
        return np.asarray(np.inf)
    fitted = 2.0 if name.endswith(_LINES) else 1.0
    if name.startswith(_LAST) and "dynamic_cycles" in archive:
        last = np.asarray(archive.variables["dynamic_cycles"].values, dtype=np.float64)
        return np.maximum(last - fitted, 1.0)
    if name in _OF_NEIGHBOURS:
        n_cycles = max(archive.sizes.get("cycle", 0), 2)
        return np.asarray(2.0 * (n_cycles - 1) ** 2 / (3 * n_cycles - 4))
    count = cycles_averaged(archive, name)
    if count.ndim:
        own = tuple(archive.variables[name].dims) if name in archive else ()
        # what stands behind the specimen: branches, segments and the like
        behind = [1] * (len(own) - 1)
        count = count.reshape(-1, *behind) if own[:1] == ("specimen",) else count.min()
    return np.asarray(np.maximum(count - fitted, 1.0))


def effective_freedom(archive: xr.Dataset, name: str) -> Floats:
    """Degrees of freedom of the combined uncertainty of a quantity.

    Parameters
    ----------
    archive : xarray.Dataset
        Of a reduced test, or of experiments.
    name : str
        As the archive names it.

    Returns
    -------
    freedom : ndarray, in the shape of the quantity
        Of the random part and of what is shared together; where an archive keeps no parts, all of
        its uncertainty counts as random. [1]

    Raises
    ------
    KeyError
        If the archive has no such quantity.

    Notes
    -----
    [1]_, G.4.1: what is stated of instruments counts as known, the scatter of a few readings does
    not.

    Examples
    --------
    A diameter of three readings that is all of the uncertainty of an area:

    >>> archive = xr.Dataset({
    ...     "area": ("specimen", [1.0]),
    ...     "area_random_standard_uncertainty": ("specimen", [0.0]),
    ...     "area_uncertainty_contribution": (("uncertainty_component", "specimen"), [[0.1]]),
    ...     "uncertainty_source_degrees_of_freedom": ("uncertainty_component", [2.0])})
    >>> print(effective_freedom(archive, "area"))
    [2.]
    """
    variable = archive.variables[name]
    spread = stored(archive, f"{name}{_RANDOM}")
    if spread is None:
        spread = stored(archive, f"{name}_standard_uncertainty")
    own = np.broadcast_to(random_freedom(archive, name), variable.shape)
    if spread is None or spread.dims != variable.dims:
        return np.array(own)
    rows, known = stored(archive, f"{name}{_CONTRIBUTION}"), stored(archive, FREEDOM)
    if rows is None:
        return effective_degrees_of_freedom(spread.values, own)
    of_rows = np.asarray(np.inf)
    if known is not None:
        # where the archive has several experiments each has its own errors
        of_each = xr.Variable(known.dims, np.where(known.values > 0, known.values, np.inf))
        of_rows = (of_each * xr.ones_like(rows)).transpose(COMPONENT, *variable.dims).values
    return effective_degrees_of_freedom(
        spread.values,
        own,
        contribution=rows.transpose(COMPONENT, *variable.dims).values,
        of_contribution=of_rows,
    )
