"""What a user of an exported line is told on the screen too: its range, and what does not fit.

References
----------
.. [1] M. Bigon and G. Regazzoni, "The Morrow Guide to Knots," Quill, New York, 1982, p. 14,
   "Comparison between fibers used in ropemaking."
"""

from __future__ import annotations

import math

from reduction.digits import plain_number
from reduction.export.product import SEA_WATER, ExportLine

_SAME = 1e-9
_LEAST_FILL = 0.6  # of the diameter: a third of the area, where ropes have two thirds


def range_of(line: ExportLine) -> str:
    """Over which strains a curve was tested, and what stands below.

    Parameters
    ----------
    line : ExportLine
        What is exported.

    Returns
    -------
    words : str
        One sentence.

    Raises
    ------
    AttributeError
        If it is no line.
    """
    low, high = line.tested
    if not low == low:
        return "nothing was tested"
    words = f"tested from strain {plain_number(low, 6)} to {plain_number(high, 6)}"
    if low > _SAME * high:
        words += (
            f"; the start, a line from 0 0 up to strain {low:.6g}, was NOT measured on this curve"
        )
    return words


def guards_of(line: ExportLine) -> tuple[str, ...]:
    """What of a line does not fit, or holds over a part alone.

    Parameters
    ----------
    line : ExportLine
        What is exported.

    Returns
    -------
    words : tuple of str
        One sentence each; what is in doubt begins with DOUBTFUL.

    Raises
    ------
    AttributeError
        If it is no line.

    Notes
    -----
    A rope of a fibre that is heavier than water does not float, no rope has more mass than a rod of
    its fibre, and none a third of it; densities of fibres as in [1]_.
    """
    words = [range_of(line)]
    mass, diameter = line.linear_density, line.diameter
    if not (math.isfinite(mass) and math.isfinite(diameter)):
        return tuple(words)
    volume, said = line.volume_diameter
    words.append(said)
    is_stated = math.isfinite(line.wet_linear_density)
    if mass < SEA_WATER * math.pi / 4 * volume**2 and not is_stated:
        words.append(
            f"DOUBTFUL: the line floats: {mass:.4g} kg/m displaces "
            f"{SEA_WATER * math.pi / 4 * volume**2:.4g} kg/m of water. Unless it does, state "
            "--wet-linear-density"
        )
    elif volume > (1 + _SAME) * diameter:
        words.append(
            f"DOUBTFUL: the displaced volume has a diameter of {1000 * volume:.4g} mm, above the "
            f"nominal one of {1000 * diameter:.4g} mm: mass a length and diameter do not fit"
        )
    elif volume < _LEAST_FILL * diameter:
        words.append(
            f"DOUBTFUL: the displaced volume has a diameter of {1000 * volume:.4g} mm, far below "
            f"the nominal one of {1000 * diameter:.4g} mm: mass a length and diameter do not fit"
        )
    return tuple(words)
