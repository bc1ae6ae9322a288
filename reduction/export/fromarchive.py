"""A line for export from an archive: the curve of a reduced test, or of a predicted hose.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Literal

import numpy as np
import xarray as xr

from reduction.archive.open import reading
from reduction.archive.pieceparts import parts_of
from reduction.archive.stored import stored
from reduction.digits import plain_number
from reduction.errors import DataError, SettingsError
from reduction.export.product import ExportLine
from reduction.export.spread import CurveSpread
from reduction.record import Bools, Floats
from reduction.uncertainty.combine import combined_standard_uncertainty

CurveName = Literal["mean", "ascending", "descending"]
_BRANCHES = ("ascending", "descending")
_NOT_APART = (
    "what the test shares with others, as a load cell, is not kept apart: all that is known of the "
    "uncertainty counts as that of the curve alone"
)
_STEP_BACK = 1e-3  # of the greatest tension: noise of a mean, not a loop


def line_from_archive(
    path: Path,
    *,
    curve: CurveName | None = None,
    specimen: str | None = None,
    **stated: Any,
) -> ExportLine:
    """Read one curve of an archive as a line.

    Parameters
    ----------
    path : pathlib.Path
        Archive of a reduced test, or of predicted hoses.
    curve : {"mean", "ascending", "descending"}, optional
        Of a test: mean over the cycles of one branch, or the mean of both; "mean" where it is
        not said. A hose has one curve.
    specimen : str, optional
        Which specimen or hose; needed where there are several.
    **stated
        Fields of `ExportLine` that the archive does not hold, or that are better known; None and
        NaN are passed over.

    Returns
    -------
    line : ExportLine
        With what the archive says of it.

    Raises
    ------
    ArchiveError
        If the archive cannot be opened.
    SettingsError
        If the specimen is not there or not said, or a hose is asked for a branch.
    DataError
        If there is no curve, or it falls by more than noise.
    """
    with reading(path) as archive:
        return line_from_open_archive(archive, path.stem, curve=curve, specimen=specimen, **stated)


def line_from_open_archive(
    archive: xr.Dataset,
    stem: str,
    *,
    curve: CurveName | None = None,
    specimen: str | None = None,
    **stated: Any,
) -> ExportLine:
    """One curve of an archive that is open, as `line_from_archive`.

    Parameters
    ----------
    archive : xarray.Dataset
        As `reduction.archive.open.open_archive` gives it.
    stem : str
        Of the name of its file.
    curve : {"mean", "ascending", "descending"}, optional
        As `line_from_archive`.
    specimen : str, optional
        As `line_from_archive`.
    **stated
        As `line_from_archive`.

    Returns
    -------
    line : ExportLine
        With what the archive says of it.

    Raises
    ------
    SettingsError
        If the specimen is not there or not said, or a hose is asked for a branch.
    DataError
        If there is no curve, or it falls by more than noise.
    """
    given = {
        name: value
        for name, value in stated.items()
        if value is not None and not (isinstance(value, float) and math.isnan(value))
    }
    if "hose" in archive.dims:
        if curve is not None:
            raise SettingsError("a predicted hose has one curve", found=curve, needed="no --curve")
        fields = _of_hose(archive, specimen)
    else:
        fields = _of_test(archive, curve or "mean", specimen)
    attributes = archive.attrs
    what = attributes.get("id", stem)
    sources = [f"archive {what}: {attributes.get('title', 'without a title')}"]
    if attributes.get("source"):
        sources.append(f"data: {attributes['source']}")
    if attributes.get("raw_file_sha256"):
        sources.append(
            f"raw file {attributes.get('raw_file', '')}, sha256 {attributes['raw_file_sha256']}"
        )
    if attributes.get("references"):
        sources.append(f"references: {attributes['references']}")
    sources += [f"{name.replace('_', ' ')}: stated at the export" for name in given]
    is_synthetic = attributes.get("synthetic", "no") == "yes"
    return ExportLine(**fields | given, sources=tuple(sources), is_synthetic=is_synthetic)


def _place(archive: xr.Dataset, dim: str, name: str | None) -> int:
    names = [str(value) for value in archive[dim].values]
    if name is None and len(names) == 1:
        return 0
    if name not in names:
        raise SettingsError(
            f"which {dim} is meant is not said" if name is None else f"there is no {dim} '{name}'",
            needed="--specimen " + " or ".join(names),
        )
    return names.index(name)


def _number(archive: xr.Dataset, name: str, place: int) -> float:
    return float(archive.variables[name].values[place]) if name in archive else math.nan


def _of_hose(archive: xr.Dataset, name: str | None) -> dict[str, Any]:
    place = _place(archive, "hose", name)
    strain, tension = (
        archive.variables["strain"].values[place],
        archive.variables["tension"].values[place],
    )
    state = archive.variables["hose_state"].values[place]
    flags = str(archive.variables["hose_state"].attrs["flag_meanings"]).split()
    broken = int(archive.variables["hose_state"].attrs["flag_masks"][flags.index("broken")])
    known = np.isfinite(strain) & np.isfinite(tension) & ((state & broken) == 0)
    strain, tension = strain[known], tension[known]
    spread = stored(archive, "tension_standard_uncertainty")
    return {
        "name": str(archive.variables["hose"].values[place]),
        "spread": None if spread is None else CurveSpread(spread.values[place][known]),
        **_rising(strain, tension),
        "curve": "predicted from construction, up to the break of the cords",
        "tested": (math.nan, math.nan),
        "diameter": _number(archive, "outer_diameter", place),
        "notes": ("a prediction: the range is that of the theory",),
    }


def _of_test(archive: xr.Dataset, curve: CurveName, name: str | None) -> dict[str, Any]:
    if "branch_tension" not in archive:
        raise DataError(
            "the archive has no curve of tension over strain",
            found=f"a test of the kind {archive.attrs.get('test_kind', 'unknown')}",
            needed="a test with cycles",
        )
    place = _place(archive, "specimen", name)
    branches = [str(value) for value in archive.variables["branch_name"].values]
    by_branch = archive.variables["branch_tension"].values[place]
    rows = [branches.index(one) for one in (_BRANCHES if curve == "mean" else (curve,))]
    # where a branch is not known there is no mean: half a loop is no curve
    tension = by_branch[rows].mean(axis=0)
    strain = archive.variables["strain_bin"].values
    known = np.isfinite(tension)
    if known.sum() < 2:
        raise DataError(
            f"the {curve} curve has not two points", found=f"{int(known.sum())} strain bins"
        )
    cycles = "the cycles of the test"
    words = {
        "mean": f"mean of the ascending and descending branches, over {cycles}",
        "ascending": f"ascending branch, mean over {cycles}",
        "descending": f"descending branch, mean over {cycles}",
    }[curve]
    specimen = str(archive.variables["specimen"].values[place])
    notes = [
        f"{key.removeprefix('specimen_')}: {archive[key].values[place]}"
        for key in ("specimen_material", "specimen_condition")
        if key in archive and str(archive[key].values[place])
    ]
    if curve == "mean":
        gap = np.nanmax(np.abs(np.diff(by_branch[[branches.index(b) for b in _BRANCHES]], axis=0)))
        notes.append(
            f"the branches are up to {plain_number(gap, 4)} N apart; the loop is not in this curve"
        )
    if np.flatnonzero(known).size <= np.ptp(np.flatnonzero(known)):
        notes.append("strain bins without a mean lie within the curve: a straight line joins them")
    strain, tension = strain[known], tension[known]
    spread = _spread_of(archive, place, rows, known)
    if spread is not None and spread.random is None:
        notes.append(_NOT_APART)
    return {
        "name": specimen,
        "spread": spread,
        **_rising(strain, tension),
        "curve": words,
        "tested": (float(strain[0]), float(strain[-1])),
        "diameter": _number(archive, "diameter", place),
        "rated_break_strength": _number(archive, "rated_break_strength", place),
        "linear_density": _number(archive, "linear_density", place),
        "wet_linear_density": _number(archive, "wet_linear_density", place),
        "material": (
            str(archive.variables["specimen_material"].values[place])
            if "specimen_material" in archive
            else ""
        ),
        "notes": tuple(notes),
    }


def _spread_of(
    archive: xr.Dataset, place: int, branches: list[int], known: Bools
) -> CurveSpread | None:
    """Uncertainty of one branch, or of the mean of both; None where the archive has none."""
    if "branch_tension_standard_uncertainty" not in archive:
        return None
    own, shared = parts_of(archive, "branch_tension", place, of="tension")
    own = own[branches]
    # what is of each branch alone scatters, what both share is in their mean by its sign
    random = np.sqrt(np.sum(own**2, axis=0))[known] / len(branches)
    if shared is None:
        return CurveSpread(random)
    rows = shared.values["tension"][:, branches].mean(axis=1)[:, known]
    return CurveSpread(combined_standard_uncertainty(rows, random), random, shared.component, rows)


def _rising(strain: Floats, tension: Floats) -> dict[str, Floats]:
    """The curve where it rises; a step back within noise is levelled, a greater one refused."""
    level = np.maximum.accumulate(tension)
    fall = float(np.max(level - tension))
    if fall > _STEP_BACK * float(level[-1]):
        first = int(np.argmax(level - tension))
        raise DataError(
            "the curve falls as the strain rises, and one curve of a mooring code cannot",
            found=f"by {plain_number(fall, 4)} N at strain {plain_number(strain[first], 4)}",
            needed=f"a fall of at most {_STEP_BACK:g} of the greatest tension",
        )
    return {"strain": np.array(strain), "tension": np.array(level)}
