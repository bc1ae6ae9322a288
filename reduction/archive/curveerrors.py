"""What the shared errors of a test do along its branches, as its archive holds it."""

from __future__ import annotations

import numpy as np
import xarray as xr

from reduction.archive.shared import components_of
from reduction.archive.statederrors import stated_errors_of
from reduction.archive.stored import stored
from reduction.compare.shared import SharedErrors, constant_errors
from reduction.record import Bools, Floats

_OF_STRAIN = frozenset(
    {"position_gain", "position_offset", "strain_calibration", "strain_gain", "splice_method"}
)
"""Sources that move a point of the curve along the axis of strain alone."""

# the curve, the modulus that its errors of strain were carried with, and the axis of both
_CURVES = (
    ("branch_tension", "tangent_modulus_untrimmed", "strain_bin"),
    ("branch_tension_first_loading", "tangent_modulus_first_loading", "first_loading_strain_bin"),
)
_OF_ALL_SAMPLES = (
    "tension_gain", "tension_offset", "position_gain", "position_offset", "lag", "strain_gain",
    "stiffness",
)  # fmt: skip
"""What may be stated of a test that is in its curve: not the noise of a reading."""
_NO_CURVE = (
    "the archive of the test holds no curve with what its instruments may be wrong by (a specimen "
    "without a diameter has none): what is stated of load and crosshead is not in the comparison"
)


def curve_errors_of(archive: xr.Dataset, place: int) -> tuple[SharedErrors, tuple[str, ...]]:
    """Errors that all samples share, at the bins of the curve of one specimen.

    Parameters
    ----------
    archive : xarray.Dataset
        Of a reduced test.
    place : int
        Row of the specimen.

    Returns
    -------
    errors : SharedErrors
        Of its cycles, or else of its first rise.
    notes : tuple of str
        What a reader has to know where they are not all of them.

    Notes
    -----
    The archive keeps what an error adds to the tension at one strain.  Of an error of strain that
    is minus the slope of the curve times it, and is taken back by the same slope: it can move the
    curve along its axis then.  What a layout declares of a channel is the noise of one reading,
    which no other sample shares; it is in the scatter.
    """
    for curve, modulus, axis in _CURVES:
        rows = stored(archive, f"{curve}_uncertainty_contribution")
        if rows is None or modulus not in archive:
            continue
        tension, of_error = archive[curve].values[place], rows.values[:, place]
        slope = archive[modulus].values[place] * float(archive.variables["area"].values[place])
        there = np.isfinite(of_error).all(axis=0) & np.isfinite(tension) & (slope != 0)
        there &= np.isfinite(slope)
        if there.any():
            return _errors(archive, archive[axis].values, tension, of_error, slope, there), ()
    stated = stated_errors_of(archive)
    has_curve = any(
        curve in archive and np.isfinite(archive[curve].values[place]).any()
        for curve, *_ in _CURVES
    )
    is_left_out = not has_curve and any(getattr(stated, name) for name in _OF_ALL_SAMPLES)
    return _of_length(archive, place), (_NO_CURVE,) if is_left_out else ()


def _errors(
    archive: xr.Dataset, strain: Floats, tension: Floats, of_error: Floats, slope: Floats,
    there: Bools,
) -> SharedErrors:  # fmt: skip
    component = components_of(archive)
    tension, slope, there = tension.copy(), slope.copy(), there.copy()
    kept = [k for k, row in enumerate(of_error) if np.any(row[there] != 0)]
    is_strain = np.array([component[k].source in _OF_STRAIN for k in kept], dtype=bool)
    rows = of_error[kept]
    known = np.where(there, rows, np.nan)
    for own, other in ((0, 1), (1, 0)):
        if not there[own].any():
            # a first rise is alone; on the way back a lag has the other sign
            way = np.array([-1.0 if component[k].source == "lag" else 1.0 for k in kept])
            there[own], tension[own], slope[own] = there[other], tension[other], slope[other]
            known[:, own] = way[:, None] * known[:, other]
    moved = -known / np.where(there, slope, np.nan)
    choice = is_strain[:, None, None]
    return SharedErrors(
        tuple(component[k] for k in kept),
        strain=strain,
        tension=tension,
        tension_error=np.where(choice, np.where(there, 0.0, np.nan), known),
        strain_error=np.where(choice, moved, np.where(there, 0.0, np.nan)),
    )


def _of_length(archive: xr.Dataset, place: int) -> SharedErrors:
    """A gauge length scales every strain; nothing where strain is not over one."""
    gauge = _number(archive, "strain_gauge_length", place)
    spread = _number(archive, "strain_gauge_length_standard_uncertainty", place)
    return constant_errors(strain_gain=spread / gauge if gauge > 0 and spread > 0 else 0.0)


def _number(archive: xr.Dataset, name: str, place: int) -> float:
    """A number of one specimen, or of all; NaN where it is not there."""
    if name not in archive:
        return float("nan")
    return float(np.broadcast_to(archive.variables[name].values, archive.sizes["specimen"])[place])
