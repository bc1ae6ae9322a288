"""What the two hoses of the report reached, beside the stretch at the working load.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   sec. 3.0.
"""

from __future__ import annotations

from math import degrees

from reduction.compare.measuredcurve import Loading
from reduction.errors import DataError

# [1] sec. 3.0: angle, stretch, cycle; then by its eq. 8 the stretch of a cord of 9.5 % at a third
# of its break load, and what a degree of angle is worth
_REPORTED = (
    (64.0, 0.79, "115,000th", 1.046, 0.086),
    (68.0, 1.30, "127,000th", 1.461, 0.125),
)
_NEAR = 1.0  # degree of wrap angle


def plausibility_of_working_strain(
    wrap_angle: float, working_strain: float, *, loading: Loading = "static"
) -> str:
    """Say how a stretch at the working load compares with the two hoses that were reported.

    Parameters
    ----------
    wrap_angle : float
        Of the cords at rest, from the axis. [rad]
    working_strain : float
        Stretch of the whole length at the working load, predicted or measured. [1]
    loading : {"static", "dynamic"}
        Of the stretch that is looked at: that of a static cord curve is static.

    Returns
    -------
    note : str
        Empty for a hose that is neither of the two.

    Raises
    ------
    DataError
        If the angle or the stretch is not a number above zero.

    Notes
    -----
    [1]_ reports a maximum stretch of 79 % at the 115,000th cycle for 64 degrees and 130 % at
    the 127,000th for 68 degrees, "to 1/3rd of its theoretical breaking strength".  These are
    dynamic, of two hoses whose cord curve and section are not printed, and one cord strain
    cannot give both (79 % needs 3.3 % in the cord, 130 % needs 5.6 %).  They are a band in
    which a hose of that angle may lie and no target: a static cord curve with 9.5 % at a third
    of its break load gives 105 and 146 %.  The band goes from the reported stretch down by one
    degree of wrap angle, and up to what a static curve adds and one degree more.

    Examples
    --------
    >>> import numpy as np
    >>> note = plausibility_of_working_strain(np.radians(64.0), 1.05)
    >>> print(note.split(":")[0])
    stretch of 105 % at the working load is inside the band of the hose reported at 64 deg
    """
    for name, value in (("wrap_angle", wrap_angle), ("working_strain", working_strain)):
        if not value > 0:
            raise DataError(f"{name} cannot be compared", found=f"{value:g}", needed="above zero")
    for angle, reported, cycle, static, slope in _REPORTED:
        off = degrees(wrap_angle) - angle
        if abs(off) > _NEAR:
            continue
        low, high = (stretch + off * slope for stretch in (reported - slope, static + slope))
        place = "below" if working_strain < low else "above" if working_strain > high else "inside"
        at_angle = "" if abs(off) < 0.05 else f" (moved by {off:+.1f} deg)"
        kind = "static" if loading == "static" else "dynamic"
        return (
            f"stretch of {100 * working_strain:.0f} % at the working load is {place} the band of "
            f"the hose reported at {angle:.0f} deg: {100 * low:.0f} to {100 * high:.0f} %"
            f"{at_angle}, about {100 * reported:.0f} % at its {cycle} cycle (dynamic, where this "
            f"is {kind}); a band of plausibility, not a target"
        )
    return ""
