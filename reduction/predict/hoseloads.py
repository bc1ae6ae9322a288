r"""Loads of a hose from the tension of its cords, wherever on its curve that is.

Virtual work of the cord layers, by layer diameter :math:`d_i`; see `reduction.predict.hose`.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   eq. (10), (11), (24), (26).
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import pi

import numpy as np

from reduction.predict.product import HoseDesign
from reduction.record import Floats


@dataclass(frozen=True)
class HoseNumbers:
    """What the loads need of designs, worked out once.  Arrays of one shape.

    Parameters
    ----------
    free_share : ndarray
        Part of the relaxed length that stretches. [1]
    cosine2, sine2, tangent : ndarray
        Of the wrap angle: squares of cosine and sine, and the tangent. [1]
    axial_factor : ndarray
        Axial load of the cords over their tension: pi (d1 + d2) n cos^2 a0. [1]
    end_cap_factor : ndarray
        End-cap load over cord tension: pi (d1 + d2) n sin^2 a0 / 2. [1]
    pressure_factor : ndarray
        Fill pressure over cord tension: 2 n (1/d1 + 1/d2) sin^2 a0. [m-2]
    cord_spacing : ndarray
        At rest. [m]
    inner_diameter, cord_diameter : ndarray
        As in the design. [m]
    area : ndarray
        Of the rubber wall at rest. [m2]
    modulus : ndarray
        Of the rubber. [Pa]
    load_scale, strain_scale : ndarray
        Of the cord curve. [1]
    """

    free_share: Floats
    cosine2: Floats
    sine2: Floats
    tangent: Floats
    axial_factor: Floats
    end_cap_factor: Floats
    pressure_factor: Floats
    cord_spacing: Floats
    inner_diameter: Floats
    cord_diameter: Floats
    area: Floats
    modulus: Floats
    load_scale: Floats
    strain_scale: Floats

    def column(self, rows: slice) -> HoseNumbers:
        """Some of the designs, flattened, as a column: shape (n_rows, 1)."""
        parts = {item.name: getattr(self, item.name) for item in fields(self)}
        return HoseNumbers(**{name: one.reshape(-1, 1)[rows] for name, one in parts.items()})


@dataclass(frozen=True)
class HoseLoads:
    """Loads of the cords and of the water; ``cord_axial_load`` is after the end cap."""

    fill_pressure: Floats
    end_cap_load: Floats
    cord_axial_load: Floats


def numbers_of(design: HoseDesign) -> HoseNumbers:
    """Work out what the loads need of a design.

    Parameters
    ----------
    design : HoseDesign
        One hose or many.

    Returns
    -------
    numbers : HoseNumbers
        Every array of the shape of the designs.

    Raises
    ------
    ValueError
        From numpy, if numbers of the design do not broadcast.

    Notes
    -----
    Source: [1]_, eq. (10) and (11): the number of cords is pi d n cos a0 a layer.

    Examples
    --------
    Mean diameter 3.5 in and 34 cords an inch, the angles of the hoses of [1]_, sec. 3.0:

    >>> from reduction.predict.cordcurve import CordCurve
    >>> design = HoseDesign(
    ...     wrap_angle=np.radians([64.0, 68.0]), layer_diameter=(0.0889, 0.0889),
    ...     inner_diameter=0.0635, outer_diameter=0.127, cords_per_length=34 / 0.0254,
    ...     cord_diameter=0.00056, rubber_modulus=1.4e6,
    ...     cord=CordCurve(strain=np.array([0.0, 0.2]), load=np.array([0.0, 130.0])),
    ... )
    >>> numbers = numbers_of(design)
    >>> print((numbers.axial_factor / np.sqrt(numbers.cosine2)).round(1))
    [327.8 280.1]
    """
    first, second = (np.asarray(one, dtype=np.float64) for one in design.layer_diameter)
    angle = np.asarray(design.wrap_angle, dtype=np.float64)
    count = np.asarray(design.cords_per_length, dtype=np.float64)
    bore = np.asarray(design.inner_diameter, dtype=np.float64)
    skin = np.asarray(design.outer_diameter, dtype=np.float64)
    cosine2, sine2 = np.cos(angle) ** 2, np.sin(angle) ** 2
    cords = pi * (first + second) * count
    parts = {
        "free_share": 1 - np.asarray(design.dead_length_share, dtype=np.float64),
        "cosine2": cosine2,
        "sine2": sine2,
        "tangent": np.tan(angle),
        "axial_factor": cords * cosine2,
        "end_cap_factor": cords * sine2 / 2,
        "pressure_factor": 2 * count * (1 / first + 1 / second) * sine2,
        "cord_spacing": 1 / count,
        "inner_diameter": bore,
        "cord_diameter": np.asarray(design.cord_diameter, dtype=np.float64),
        "area": pi / 4 * (skin - bore) * (skin + bore),
        "modulus": np.asarray(design.rubber_modulus, dtype=np.float64),
        "load_scale": np.asarray(design.cord_load_scale, dtype=np.float64),
        "strain_scale": np.asarray(design.cord_strain_scale, dtype=np.float64),
    }
    shape = design.shape
    return HoseNumbers(**{name: np.broadcast_to(one, shape) for name, one in parts.items()})


def loads_at(
    numbers: HoseNumbers,
    stretch: Floats,
    cord_stretch: Floats,
    cord_tension: Floats,
    *,
    out: HoseLoads | None = None,
) -> HoseLoads:
    r"""Loads of cords and water.

    .. math:: p = \sum_i \frac{2 P n \sin^2 a_0}{\lambda_h \lambda_c d_i}, \qquad
       F = \frac{\pi (d_1 + d_2) n P \sin^2 a_0}{2 \lambda_h^2 \lambda_c}, \qquad
       T_c = \pi (d_1 + d_2) n \cos^2 a_0 \frac{\lambda_h P}{\lambda_c} - F

    Parameters
    ----------
    numbers : HoseNumbers
        Of the designs, shape (...) or a column of them.
    stretch : ndarray, shape (...)
        :math:`\lambda_h`. [1]
    cord_stretch : ndarray, shape (...)
        :math:`\lambda_c`. [1]
    cord_tension : ndarray, shape (...)
        :math:`P`. [N]
    out : HoseLoads, optional
        Where to write.

    Returns
    -------
    loads : HoseLoads
        Of the shape of all four together.

    Raises
    ------
    ValueError
        From numpy, if shapes do not broadcast.

    Notes
    -----
    Source: [1]_, eq. (24) with a pressure for each layer, and eq. (26) with the end cap as the
    current area inside the cords: :math:`\sum_i p_i \pi d_i^2/(4\lambda_h)`.

    Examples
    --------
    The membrane value 2 N P sin a tan a/(pi d^2) at rest, with N/(pi d) = 2 n cos a:

    >>> from reduction.predict.cordcurve import CordCurve
    >>> design = HoseDesign(
    ...     wrap_angle=np.radians(45.0), layer_diameter=(0.1, 0.1), inner_diameter=0.06,
    ...     outer_diameter=0.12, cords_per_length=1000.0, cord_diameter=0.0005, rubber_modulus=1e6,
    ...     cord=CordCurve(strain=np.array([0.0, 0.2]), load=np.array([0.0, 130.0])),
    ... )
    >>> one = np.ones(())
    >>> print(loads_at(numbers_of(design), one, one, 10 * one).fill_pressure.round(6))
    200000.0
    """
    if out is None:
        shape = np.broadcast_shapes(numbers.cosine2.shape, stretch.shape, cord_tension.shape)
        out = HoseLoads(np.empty(shape), np.empty(shape), np.empty(shape))
    along = np.divide(cord_tension, cord_stretch, out=out.cord_axial_load)
    around = np.divide(along, stretch, out=out.fill_pressure)
    end_cap = np.divide(around, stretch, out=out.end_cap_load)
    end_cap *= numbers.end_cap_factor
    around *= numbers.pressure_factor
    along *= stretch
    along *= numbers.axial_factor
    along -= end_cap
    return out
