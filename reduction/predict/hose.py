r"""Tension and fill pressure of a water-filled hose from its cords: the "Snubber" calculation.

A hose of relaxed length one holds the energy of its cords and of its rubber.  With the layers
:math:`i = 1, 2` of mean diameter :math:`d_i`, :math:`n` cords a width of fabric, :math:`P` the
load on one cord, and :math:`\lambda_c(\lambda_h)` from `reduction.predict.cord`,

.. math:: W = \sum_i \pi d_i n \int P \, d\lambda_c + W_r, \qquad T = dW/d\lambda_h =
   \pi (d_1 + d_2) n \frac{P}{\lambda_c}
   \left(\lambda_h \cos^2 a_0 - \frac{\sin^2 a_0}{2 \lambda_h^2}\right) + T_r

The first part is the axial load of the :math:`N_i = \pi d_i n \cos a_0` cords of each layer; the
second is what the pressures of the layers, :math:`p_i = 2 P n \sin^2 a_0/(\lambda_h \lambda_c
d_i)`, put on the end cap: each on the *current* area :math:`\pi d_i^2/(4\lambda_h)` inside its
cords, for the rubber inside the cords is under the pressure too.

The hose is long, straight and does not turn; both layers have one angle (with two angles it would
turn under load); wall and filling keep their volume, so that none of the water may leave; cords
are elastic.  Where cords are slack the rubber alone carries and there is no pressure.  In
compression a hose buckles, and there is no prediction.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   sec. 1.2.
"""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite
from reduction.errors import DataError
from reduction.predict.cord import cord_stretch_ratio
from reduction.predict.cordload import CordPieces, cord_energy, evaluate, piece_of, pieces_of
from reduction.predict.hoseloads import HoseNumbers, loads_at, numbers_of
from reduction.predict.product import HoseDesign, HosePrediction, RubberLaw
from reduction.predict.rubber import rubber_energy, rubber_tension
from reduction.record import Floats
from reduction.workers import run_blocks

__all__ = ["hose_energy", "predict_hose"]

BLOCK = 8192
"""Values a block: what a block computes on the way stays in the cache of one processor."""


def predict_hose(design: HoseDesign, strain: ArrayLike) -> HosePrediction:
    """Response of hoses at strains of their whole length.

    Parameters
    ----------
    design : HoseDesign
        One hose or many, shape (...).
    strain : array_like, shape (n_strain,)
        Of the relaxed length, dead ends included; zero or more, in any order. [1]

    Returns
    -------
    prediction : HosePrediction
        Arrays of shape (..., n_strain); NaN and flagged where the cords are broken.

    Raises
    ------
    DataError
        If the strains are no series, not finite, or below zero: compression is not of this model.

    Notes
    -----
    Source: [1]_, sec. 1.2.  Equation (8) gives the cord strain, the cord curve the cord tension,
    (24) the fill pressure, (26) the tension, with the end cap on the current area inside the
    cords and a law of rubber that is zero at rest.  As printed, (25) has the square root closed
    too late (its unit is lbf/in), (20) has the stretch of the cord for that of the hose, and (26)
    takes the end cap at the bore.

    Strain of the part that stretches is that of the whole over one less the share of the ends.
    Cord strain is divided by its scale before the curve is read, load is multiplied by its own.
    Where there is no tension the share of the cords is zero.

    Designs are worked in blocks, side by side on the processors there are; the answer does not
    depend on their number.

    Examples
    --------
    A hose with a wrap angle of 68 deg: the rubber alone up to +102.5 %, then the cords.

    >>> from reduction.predict.cordcurve import CordCurve
    >>> design = HoseDesign(
    ...     wrap_angle=np.radians(68.0), layer_diameter=(0.0889, 0.0889), inner_diameter=0.0635,
    ...     outer_diameter=0.127, cords_per_length=34 / 0.0254, cord_diameter=0.00056,
    ...     rubber_modulus=1.4e6,
    ...     cord=CordCurve(strain=np.array([0.0, 0.2]), load=np.array([0.0, 130.0])),
    ... )
    >>> prediction = predict_hose(design, [0.0, 1.0, 1.05, 2.0])
    >>> print(prediction.is_slack, prediction.is_broken)
    [ True  True False False] [False False False  True]
    >>> print((prediction.cord_strain * 100).round(2))
    [ 0.   -0.44  0.45 24.48]
    """
    asked = as_finite("strain", strain)
    if asked.ndim != 1:
        raise DataError("strain is not a series", found=f"shape {asked.shape}", needed="1-D")
    if np.any(asked < 0):
        raise DataError(
            f"{int(np.sum(asked < 0))} of {asked.size} strains are below zero",
            found=f"{asked.min():g}",
            needed="zero or more",
            hint="A hose buckles in compression; the prediction is for tension.",
        )
    numbers, pieces = numbers_of(design), pieces_of(design.cord)
    n_designs, n_strain = max(1, int(np.prod(design.shape))), asked.size
    target: dict[str, Any] = {
        item.name: np.empty(
            (n_designs, n_strain), dtype=np.bool_ if item.name.startswith("is_") else np.float64
        )
        for item in fields(HosePrediction)
        if item.name != "strain"
    }

    def fill(block: tuple[slice, slice]) -> None:
        rows, columns = block
        out = {name: array[rows, columns] for name, array in target.items()}
        _respond(
            numbers.column(rows),
            pieces,
            asked[columns],
            design.rubber_law,
            design.minimum_inner_diameter,
            out,
        )

    n_rows, n_columns = max(1, BLOCK // max(n_strain, 1)), min(BLOCK, max(n_strain, 1))
    run_blocks(
        fill,
        [
            (slice(row, row + n_rows), slice(column, column + n_columns))
            for row in range(0, n_designs, n_rows)
            for column in range(0, n_strain, n_columns)
        ],
    )
    shape = (*design.shape, n_strain)
    return HosePrediction(
        strain=asked, **{name: array.reshape(shape) for name, array in target.items()}
    )


def _respond(
    numbers: HoseNumbers,
    pieces: CordPieces,
    strain: Floats,
    law: RubberLaw,
    smallest_bore: float,
    out: dict[str, Any],
) -> None:
    free = np.divide(strain, numbers.free_share, out=out["free_strain"])
    stretch = 1 + free
    inverse = 1 / stretch
    square = (2 + free) * free * numbers.cosine2 - free * inverse * numbers.sine2
    cord_stretch = np.sqrt(1 + square)
    cord_strain = np.divide(square, 1 + cord_stretch, out=out["cord_strain"])
    curve_strain = cord_strain / numbers.strain_scale
    piece = piece_of(pieces, curve_strain)
    np.equal(piece, 0, out=out["is_slack"])
    np.equal(piece, len(pieces.knot), out=out["is_broken"])
    load = evaluate(pieces, curve_strain, piece)
    cord_tension = np.multiply(load, numbers.load_scale, out=out["cord_tension"])
    loads = loads_at(numbers, stretch, cord_stretch, cord_tension)
    out["fill_pressure"][...] = loads.fill_pressure
    out["end_cap_load"][...] = loads.end_cap_load
    rubber = rubber_tension(stretch, area=numbers.area, modulus=numbers.modulus, law=law)
    tension = np.add(rubber, loads.cord_axial_load, out=out["tension"])
    share = np.divide(
        loads.cord_axial_load, np.maximum(tension, np.finfo(float).tiny), out=out["cord_share"]
    )
    np.subtract(1, share, out=out["rubber_share"])
    thinning = np.sqrt(inverse)
    np.arctan(inverse * thinning * numbers.tangent, out=out["current_wrap_angle"])
    spacing = np.multiply(
        stretch * thinning / cord_stretch, numbers.cord_spacing, out=out["cord_spacing"]
    )
    np.less(spacing, numbers.cord_diameter, out=out["is_jammed"])
    bore = np.multiply(thinning, numbers.inner_diameter, out=out["current_inner_diameter"])
    np.less(bore, smallest_bore, out=out["is_bore_too_small"])


def hose_energy(design: HoseDesign, stretch_ratio: ArrayLike) -> Floats:
    r"""Energy in cords and rubber, a relaxed length of the part that stretches.

    .. math:: W = \pi (d_1 + d_2) n \int P \, d\lambda_c + \int T_r \, d\lambda_h

    Parameters
    ----------
    design : HoseDesign
        One hose or many, shape (...).
    stretch_ratio : array_like, shape (n_stretch,)
        :math:`\lambda_h` of the part that stretches. [1]

    Returns
    -------
    energy : ndarray, shape (..., n_stretch)
        NaN where the cords are broken. [J m-1]

    Raises
    ------
    DataError
        If a stretch ratio is not a positive number.

    Notes
    -----
    Cords of both layers together are pi (d1 + d2) n cos a0, each 1/cos a0 long a length of hose
    ([1]_, eq. (2), (10), (11)).  The water and the dead ends hold none.

    Examples
    --------
    With 130 N at 20 % in a straight cord curve, slack cords, and a neo-Hookean wall:

    >>> from reduction.predict.cordcurve import CordCurve
    >>> design = HoseDesign(
    ...     wrap_angle=np.radians(68.0), layer_diameter=(0.0889, 0.0889), inner_diameter=0.0635,
    ...     outer_diameter=0.127, cords_per_length=34 / 0.0254, cord_diameter=0.00056,
    ...     rubber_modulus=1.4e6,
    ...     cord=CordCurve(strain=np.array([0.0, 0.2]), load=np.array([0.0, 130.0])),
    ... )
    >>> area = np.pi / 4 * (0.127**2 - 0.0635**2)
    >>> print((hose_energy(design, [2.0]) / (1.4e6 * area)).round(6))
    [0.333333]
    """
    stretch, numbers = np.asarray(stretch_ratio, dtype=np.float64), numbers_of(design)
    cords = numbers.axial_factor + 2 * numbers.end_cap_factor
    scale = numbers.strain_scale[..., None]
    cord_strain = cord_stretch_ratio(stretch, np.asarray(design.wrap_angle)[..., None]) - 1
    held = cord_energy(design.cord, cord_strain / scale) * scale * numbers.load_scale[..., None]
    rubber = rubber_energy(
        stretch,
        area=numbers.area[..., None],
        modulus=numbers.modulus[..., None],
        law=design.rubber_law,
    )
    return np.asarray(held * cords[..., None] + rubber)
