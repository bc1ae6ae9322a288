r"""Tension and fill pressure of a water-filled hose: the Snubber calculation.

**Loads of a hose from the tension of its cords, at any point of their curve.** Virtual work of the
cord layers, with layer diameters :math:`d_i`.

**Tension and fill pressure of a water-filled hose from its cords: the "Snubber" calculation.** A
hose of relaxed length one holds the energy of its cords and of its rubber.  With the layers
:math:`i = 1, 2` of mean diameter :math:`d_i`, :math:`n` cords a width of fabric, :math:`P` the load
on one cord, and :math:`\lambda_c(\lambda_h)` from `reduction.prediction.hose_geometry`,

.. math:: W = \sum_i \pi d_i n \int P \, d\lambda_c + W_r, \qquad T = dW/d\lambda_h =
   \pi (d_1 + d_2) n \frac{P}{\lambda_c}
   \left(\lambda_h \cos^2 a_0 - \frac{\sin^2 a_0}{2 \lambda_h^2}\right) + T_r

The first part is the axial load of the :math:`N_i = \pi d_i n \cos a_0` cords of each layer; the
second is the end-cap force of the layer pressures, :math:`p_i = 2 P n \sin^2 a_0/(\lambda_h
\lambda_c d_i)`, each on the *current* area :math:`\pi d_i^2/(4\lambda_h)` inside its cords, since
the rubber inside the cords is under the pressure too.

The hose is long, straight and does not turn; both layers have the same angle, except in
`predict_two_layers`; wall and filling keep their volume, so no water may leave; cords are elastic.
Where cords are slack the rubber alone carries and there is no pressure.  In compression a hose
buckles, and there is no prediction.

**Events of the cords of a hose, in closed form.** The strains hold for a long, straight hose that
keeps its volume, and for a slow pull of its cords.  The cords break where a single cord of the
curve would; a hose has weaker places, above all at its ends.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical Properties,"
   Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004, eq. (10), (11), (24),
   (26); sec. 1.2; sec. 1.2.1, 1.2.4, Fig. 11.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import partial
from math import pi, prod
from typing import Any, Literal, NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from reduction.prediction.cord_curve import (
    CordPieces,
    cord_energy,
    cord_strain_at,
    evaluate_into,
    piece_of,
    pieces_of,
)
from reduction.prediction.hose_geometry import (
    cord_stretch_ratio,
    hose_stretch_ratio,
    pick_up_stretch_ratio,
    slackest_stretch_ratio,
    wrap_angle_for,
)
from reduction.prediction.hose_product import (
    HoseDesign,
    HoseEvent,
    HoseEvents,
    HosePrediction,
    RubberLaw,
)
from reduction.prediction.rubber_wall import rubber_energy, rubber_tension, tension_into
from reduction.record.arrays import as_finite, run_blocks
from reduction.record.errors import DataError
from reduction.record.measurement import Floats, read_only_arrays


@dataclass(frozen=True)
class _HoseNumbers:
    """Parameters of designs needed for the loads, computed once.  Arrays of one shape."""

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

    def column(self, rows: slice) -> _HoseNumbers:
        """Some of the designs, flattened to a column of shape (n_rows, 1)."""
        parts = {item.name: getattr(self, item.name) for item in fields(self)}
        return _HoseNumbers(**{name: one.reshape(-1, 1)[rows] for name, one in parts.items()})


@dataclass(frozen=True)
class _HoseLoads:
    """Loads of cords and water; ``cord_axial_load`` includes the end cap."""

    fill_pressure: Floats
    end_cap_load: Floats
    cord_axial_load: Floats


def numbers_of(design: HoseDesign) -> _HoseNumbers:
    """Compute the parameters of a design that the loads need.

    Notes
    -----
    Source: [1]_, eq. (10) and (11): the number of cords is pi d n cos a0 per layer.

    Examples
    --------
    Mean diameter 3.5 in and 34 cords per inch, with the angles of the hoses of [1]_, sec. 3.0:

    >>> from reduction.prediction.cord_curve import CordCurve
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
    return _HoseNumbers(**{name: np.broadcast_to(one, shape) for name, one in parts.items()})


def loads_at(
    numbers: _HoseNumbers,
    stretch: Floats,
    cord_stretch: Floats,
    cord_tension: Floats,
    *,
    out: _HoseLoads | None = None,
) -> _HoseLoads:
    r"""Loads of cords and water.

    .. math:: p = \sum_i \frac{2 P n \sin^2 a_0}{\lambda_h \lambda_c d_i}, \qquad
       F = \frac{\pi (d_1 + d_2) n P \sin^2 a_0}{2 \lambda_h^2 \lambda_c}, \qquad
       T_c = \pi (d_1 + d_2) n \cos^2 a_0 \frac{\lambda_h P}{\lambda_c} - F

    Notes
    -----
    Source: [1]_, eq. (24) with a pressure for each layer, and eq. (26) with the end cap as the
    current area inside the cords: :math:`\sum_i p_i \pi d_i^2/(4\lambda_h)`.

    Examples
    --------
    The membrane value 2 N P sin a tan a/(pi d^2) at rest, with N/(pi d) = 2 n cos a:

    >>> from reduction.prediction.cord_curve import CordCurve
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
        out = _HoseLoads(np.empty(shape), np.empty(shape), np.empty(shape))
    along = np.divide(cord_tension, cord_stretch, out=out.cord_axial_load)
    around = np.divide(along, stretch, out=out.fill_pressure)
    end_cap = np.divide(around, stretch, out=out.end_cap_load)
    end_cap *= numbers.end_cap_factor
    around *= numbers.pressure_factor
    along *= stretch
    along *= numbers.axial_factor
    along -= end_cap
    return out


BLOCK = 131_072
"""Values per block: few enough for a cache, enough that threads seldom wait for the interpreter."""


def predict_hose(design: HoseDesign, strain: ArrayLike) -> HosePrediction:
    """Response of hoses at strains of their whole length.

    Parameters
    ----------
    design : HoseDesign
        One or many hoses, shape (...).
    strain : array_like, shape (n_strain,)
        Of the relaxed length including dead ends; zero or more, in any order. [1]

    Returns
    -------
    prediction : HosePrediction
        Arrays of shape (..., n_strain); NaN and flagged where the cords are broken.

    Raises
    ------
    DataError
        If a strain is not finite, or negative: compression is not modelled.

    Notes
    -----
    Source: [1]_, sec. 1.2.  Equation (8) gives the cord strain, the cord curve the cord tension,
    (24) the fill pressure, (26) the tension, with the end cap on the current area inside the
    cords and a rubber law that is zero at rest.  As printed, (25) closes the square root too late
    (its unit is lbf/in), (20) has the stretch of the cord instead of that of the hose, and (26)
    has the end cap at the bore.

    Strain of the stretching part is that of the whole hose over one less the share of the ends.
    Cord strain is divided by its scale before the curve is evaluated; load is multiplied by its
    own scale.  Where there is no tension the share of the cords is zero.

    Designs are computed in blocks, in parallel on the available processors; the answer does not
    depend on their number.

    Examples
    --------
    A hose with a wrap angle of 68 deg: rubber alone up to +102.5 %, then cords as well.

    >>> from reduction.prediction.cord_curve import CordCurve
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
    if np.any(asked < 0):
        raise DataError(
            f"{int(np.sum(asked < 0))} of {asked.size} strains are below zero",
            found=f"{asked.min():g}",
            needed="zero or more",
            hint="A hose buckles in compression; the prediction is for tension.",
        )
    numbers, pieces = numbers_of(design), pieces_of(design.cord)
    n_designs, n_strain = prod(design.shape), asked.size
    names = [item.name for item in fields(HosePrediction) if item.name != "strain"]
    flags = [name for name in names if name.startswith("is_")]
    numerals = [name for name in names if name not in flags]
    # one allocation for all: the system provides one large block faster than many small ones
    target: dict[str, Any] = {
        **dict(zip(numerals, np.empty((len(numerals), n_designs, n_strain)), strict=True)),
        **dict(
            zip(flags, np.empty((len(flags), n_designs, n_strain), dtype=np.bool_), strict=True)
        ),
    }
    n_rows, n_columns = max(1, BLOCK // max(n_strain, 1)), max(1, min(BLOCK, n_strain))

    def fill(block: tuple[slice, slice]) -> None:
        rows, columns = block
        _respond(
            numbers.column(rows),
            pieces,
            asked[columns],
            design,
            {name: array[rows, columns] for name, array in target.items()},
        )

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
        strain=asked.copy(), **{name: array.reshape(shape) for name, array in target.items()}
    )


Load = Literal["tension", "fill_pressure"]

_NEEDED = (
    "free_strain",
    "cord_strain",
    "cord_tension",
    "end_cap_load",
    "tension",
    "fill_pressure",
)


def hose_load(
    design: HoseDesign,
    strain: Floats,
    load: Load = "tension",
    *,
    beside: Callable[[slice, Floats], Floats] | None = None,
) -> Floats:
    """Tension or fill pressure alone, as `predict_hose` computes it, shape (..., n_strain).

    Notes
    -----
    For fits, which need thousands of curves.  ``beside`` gives a load of one cord to be added to
    its curve at strains on that curve, for the designs in ``rows``.

    Examples
    --------
    >>> from reduction.prediction.cord_curve import CordCurve
    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> at = np.array([0.5, 1.2])
    >>> print(bool(np.all(hose_load(design, at) == predict_hose(design, at).tension)))
    True
    """
    numbers, pieces = numbers_of(design), pieces_of(design.cord)
    found = np.empty((prod(design.shape), strain.size))
    n_rows = max(1, BLOCK // max(strain.size, 1))

    def fill(rows: slice) -> None:
        arrays = np.empty((len(_NEEDED), *found[rows].shape))
        out = {**dict(zip(_NEEDED, arrays, strict=True)), load: found[rows]}
        added = None if beside is None else partial(beside, rows)
        _loads_into(out, numbers.column(rows), pieces, strain, design.rubber_law, added)

    run_blocks(fill, [slice(row, row + n_rows) for row in range(0, len(found), n_rows)])
    return found.reshape(*design.shape, strain.size)


class _State(NamedTuple):
    """What the loads leave for other responses of a hose."""

    stretch: Floats
    inverse: Floats
    cord_stretch: Floats
    cord_axial_load: Floats
    piece: NDArray[np.intp]


def _loads_into(
    out: dict[str, Any],
    numbers: _HoseNumbers,
    pieces: CordPieces,
    strain: Floats,
    law: RubberLaw,
    beside: Callable[[Floats], Floats] | None = None,
) -> _State:
    """Fill a block of strains and loads, with operations in place to avoid allocations."""
    stretch, inverse, cord_stretch, spare, other = np.empty((5, *out["tension"].shape))
    free = np.divide(strain, numbers.free_share, out=out["free_strain"])
    np.add(free, 1, out=stretch)
    np.reciprocal(stretch, out=inverse)
    # lambda_c^2 - 1 without cancellation, so that a hose at rest has no cord strain
    square = np.add(free, 2, out=spare)
    square *= free
    square *= numbers.cosine2
    np.multiply(free, inverse, out=other)
    other *= numbers.sine2
    square -= other
    np.add(square, 1, out=cord_stretch)
    np.sqrt(cord_stretch, out=cord_stretch)
    cord_strain = np.add(cord_stretch, 1, out=out["cord_strain"])
    np.divide(square, cord_strain, out=cord_strain)
    curve_strain = np.divide(cord_strain, numbers.strain_scale, out=other)
    piece = piece_of(pieces, curve_strain)
    added = None if beside is None else beside(curve_strain)
    cord_tension = evaluate_into(out["cord_tension"], spare, pieces, curve_strain, piece)
    if added is not None:
        cord_tension += added
    cord_tension *= numbers.load_scale
    cords = _HoseLoads(out["fill_pressure"], out["end_cap_load"], spare)
    loads_at(numbers, stretch, cord_stretch, cord_tension, out=cords)
    tension = tension_into(out["tension"], stretch, numbers.area * numbers.modulus, law)
    tension += cords.cord_axial_load
    return _State(stretch, inverse, cord_stretch, spare, piece)


def _respond(
    numbers: _HoseNumbers,
    pieces: CordPieces,
    strain: Floats,
    design: HoseDesign,
    out: dict[str, Any],
) -> None:
    """Fill a block of each array."""
    state = _loads_into(out, numbers, pieces, strain, design.rubber_law)
    stretch, inverse, spare = state.stretch, state.inverse, state.cord_axial_load
    np.equal(state.piece, 0, out=out["is_slack"])
    np.equal(state.piece, len(pieces.knot), out=out["is_broken"])
    share = np.maximum(out["tension"], np.finfo(np.float64).tiny, out=out["cord_share"])
    np.divide(state.cord_axial_load, share, out=share)
    np.subtract(1, share, out=out["rubber_share"])
    thinning = np.sqrt(inverse, out=spare)
    bore = np.multiply(thinning, numbers.inner_diameter, out=out["current_inner_diameter"])
    np.less(bore, design.minimum_inner_diameter, out=out["is_bore_too_small"])
    inverse *= thinning
    inverse *= numbers.tangent
    np.arctan(inverse, out=out["current_wrap_angle"])
    stretch *= thinning
    stretch /= state.cord_stretch
    spacing = np.multiply(stretch, numbers.cord_spacing, out=out["cord_spacing"])
    np.less(spacing, numbers.cord_diameter, out=out["is_jammed"])


@dataclass(frozen=True)
@read_only_arrays
class _TwoLayers:
    """A hose whose layers have different angles.  Arrays have the shape (n_strain,)."""

    tension: Floats
    fill_pressure: Floats
    torque: Floats


def predict_two_layers(
    design: HoseDesign, outer_wrap_angle: float, strain: ArrayLike
) -> _TwoLayers:
    r"""Tension, fill pressure and torque of one hose whose outer layer has a different angle.

    .. math:: M = \sum_i \pm \frac{\pi d_i^2 n P_i \sin a_i \cos a_i}{2 \lambda_h \lambda_{c,i}}

    Notes
    -----
    The energies of the layers add.  With a twist psi per length of the relaxed hose, the squared
    stretch of a cord is (lambda_h cos a)^2 + (sin a +- psi d cos a / 2)^2 / lambda_h; the torque
    that holds the hose against turning is dW/dpsi at psi = 0, positive in the direction in which
    the inner layer would turn it.  NaN where a layer is broken.

    Examples
    --------
    Layers of equal angle do not balance, since the outer one is wider: torque grows as d^2.

    >>> from reduction.prediction.cord_curve import CordCurve
    >>> design = HoseDesign(
    ...     wrap_angle=np.radians(45.0), layer_diameter=(0.1, 0.11), inner_diameter=0.06,
    ...     outer_diameter=0.12, cords_per_length=1000.0, cord_diameter=0.0005, rubber_modulus=1e6,
    ...     cord=CordCurve(strain=np.array([0.0, 0.2]), load=np.array([0.0, 130.0])),
    ... )
    >>> hose = predict_two_layers(design, design.wrap_angle, [0.2])
    >>> along = 1000 * (np.sqrt(0.72 + 0.5 / 1.2) - 1) * 650 / np.sqrt(0.72 + 0.5 / 1.2)
    >>> print((hose.torque / (np.pi / 4 * (0.1**2 - 0.11**2) * along / 1.2)).round(9))
    [1.]
    """
    angle = np.array([float(design.wrap_angle), outer_wrap_angle])
    diameter = np.array([float(one) for one in design.layer_diameter])
    # each of the two is a hose with two equal layers: the hose is their mean
    twice = predict_hose(
        replace(design, wrap_angle=angle, layer_diameter=(diameter, diameter)), strain
    )
    width = np.array([1.0, -1.0]) * diameter**2 * np.sin(2 * angle)
    fabric = pi / 4 * float(design.cords_per_length)
    cord = twice.cord_tension / ((1 + twice.free_strain) * (1 + twice.cord_strain))
    return _TwoLayers(
        tension=twice.tension.mean(axis=0),
        fill_pressure=twice.fill_pressure.mean(axis=0),
        torque=fabric * width @ cord,
    )


def torque_balanced_angle(design: HoseDesign, strain: float) -> float:
    """Wrap angle of the outer layer at which a hose has no torque at a strain.

    Notes
    -----
    Between the angle of the inner layer, where the wider outer layer dominates, and that at which
    the outer layer would be slack.  NaN where the cords are slack or broken.

    Examples
    --------
    >>> from reduction.prediction.cord_curve import CordCurve
    >>> design = HoseDesign(
    ...     wrap_angle=np.radians(68.0), layer_diameter=(0.086, 0.091), inner_diameter=0.0635,
    ...     outer_diameter=0.127, cords_per_length=34 / 0.0254, cord_diameter=0.00056,
    ...     rubber_modulus=1.4e6,
    ...     cord=CordCurve(strain=np.array([0.0, 0.2]), load=np.array([0.0, 130.0])),
    ... )
    >>> outer = torque_balanced_angle(design, 1.3)
    >>> print(bool(abs(predict_two_layers(design, outer, [1.3]).torque[0]) < 1e-9))
    True
    """
    stretch = 1 + strain / (1 - float(design.dead_length_share))
    inner, slack = float(design.wrap_angle), float(wrap_angle_for(stretch, 1.0))

    def torque(outer: float) -> float:
        return float(predict_two_layers(design, outer, [strain]).torque[0])

    if not inner < slack or np.isnan(torque(inner)):
        return float("nan")
    # with layers of equal diameter only rounding is left
    return (
        inner
        if torque(inner) >= 0
        else float(scipy.optimize.brentq(torque, inner, slack, xtol=1e-14))
    )


def hose_energy(design: HoseDesign, stretch_ratio: ArrayLike) -> Floats:
    r"""Energy in cords and rubber, per relaxed length of the stretching part.

    .. math:: W = \pi (d_1 + d_2) n \int P \, d\lambda_c + \int T_r \, d\lambda_h

    Notes
    -----
    Both layers together have pi (d1 + d2) n cos a0 cords, each 1/cos a0 long per length of hose
    ([1]_, eq. (2), (10), (11)).  The water and the dead ends store none.

    Examples
    --------
    With 130 N at 20 % on a straight cord curve, slack cords, and a neo-Hookean wall:

    >>> from reduction.prediction.cord_curve import CordCurve
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


def find_events(design: HoseDesign) -> HoseEvents:
    """Find where cords are shortest, pick up, reach their working load, and break.

    Arrays of shape (...); strains refer to the whole relaxed length including dead ends.

    Notes
    -----
    Source: [1]_, eq. (8) and Fig. 11.  The safe working load is the tension of the hose "at which
    the nylon tire cords are stressed to 1/3rd of their breaking strength" (sec. 1.2.4): of the
    cords, not of the hose, whose third differs because of the rubber.

    Only the inverse of the cord curve, `cord_strain_at`, needs a search.  The cord strain at
    pick-up is exactly zero, and at the break exactly that of the last point times its scale.

    Examples
    --------
    >>> from reduction.prediction.cord_curve import CordCurve
    >>> design = HoseDesign(
    ...     wrap_angle=np.radians([50.0, 64.0, 68.0]), layer_diameter=(0.0889, 0.0889),
    ...     inner_diameter=0.0635, outer_diameter=0.127, cords_per_length=34 / 0.0254,
    ...     cord_diameter=0.00056, rubber_modulus=1.4e6,
    ...     cord=CordCurve(strain=np.array([0.0, 0.26]), load=np.array([0.0, 130.0])),
    ... )
    >>> events = find_events(design)
    >>> print((100 * events.pick_up.strain).round(2))
    [  0.    61.04 102.51]
    >>> print((100 * events.deepest_slack.cord_strain).round(2))
    [ 0.   -2.74 -5.77]
    >>> print((100 * events.cord_break.strain).round(2))
    [ 73.95 157.46 205.04]
    """
    numbers, angle = numbers_of(design), np.asarray(design.wrap_angle, dtype=np.float64)
    slackest = slackest_stretch_ratio(angle)
    shortest = np.where(slackest > 1, cord_stretch_ratio(slackest, angle) - 1, 0.0)
    nothing, curve = np.zeros(design.shape), design.cord
    working_load = design.working_share * curve.break_load
    working_strain = numbers.strain_scale * cord_strain_at(curve, working_load)
    break_strain = numbers.strain_scale * curve.break_strain
    return HoseEvents(
        deepest_slack=_event(design, numbers, slackest, shortest, nothing),
        pick_up=_event(design, numbers, pick_up_stretch_ratio(angle), nothing, nothing),
        working=_event(
            design,
            numbers,
            hose_stretch_ratio(1 + working_strain, angle),
            working_strain,
            numbers.load_scale * working_load,
        ),
        cord_break=_event(
            design,
            numbers,
            hose_stretch_ratio(1 + break_strain, angle),
            break_strain,
            numbers.load_scale * curve.break_load,
        ),
    )


def _event(
    design: HoseDesign,
    numbers: _HoseNumbers,
    stretch: Floats,
    cord_strain: Floats,
    cord_tension: Floats,
) -> HoseEvent:
    loads = loads_at(numbers, stretch, 1 + cord_strain, cord_tension)
    rubber = rubber_tension(
        stretch, area=numbers.area, modulus=numbers.modulus, law=design.rubber_law
    )
    return HoseEvent(
        strain=np.asarray((stretch - 1) * numbers.free_share),
        tension=np.asarray(rubber + loads.cord_axial_load),
        fill_pressure=loads.fill_pressure,
        cord_tension=np.array(np.broadcast_to(cord_tension, design.shape)),
        cord_strain=np.array(np.broadcast_to(cord_strain, design.shape)),
    )
