"""The names: one row a quantity, the same in code, netCDF, tables and documents.

A name that is not here may not be a variable of a product or a column of a
table (a test reads this module).  Symbols stand only beside their source.

References
----------
.. [1] WHOI-2005-10 (tethers), [2] CG-D-39-80 (line); CF standard names are
   given only where the CF table has them.
"""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["BRANCH_NAMES", "BRANCH_VALUES", "PHASE_VALUES", "QUANTITIES", "Quantity", "quantity"]


@dataclass(frozen=True)
class Quantity:
    """One quantity: code name, SI unit, what it means, and its symbol in the source."""

    name: str
    unit: str
    long_name: str
    symbol: str = ""
    standard_name: str | None = None


PHASE_VALUES = {"rest": 0, "approach": 1, "hold": 2, "cycling": 3}
BRANCH_VALUES = {"none": 0, "ascending": 1, "descending": 2}
BRANCH_NAMES = ("ascending", "descending")

_ROWS = (
    # per sample
    Quantity("time", "s", "elapsed time", standard_name="time"),
    Quantity("crosshead_position", "m", "crosshead position, thimble to thimble", "002 sec 3.2"),
    Quantity("crosshead_displacement", "m", "crosshead displacement from the reference length"),
    Quantity("tension", "N", "tension", "002, 003 T"),
    Quantity("strain", "1", "nominal strain of the splice-free length", "002 eps"),
    Quantity("nominal_stress", "Pa", "tension over the area at zero tension", "002 eq 2"),
    Quantity("phase", "1", "phase of the test"),
    Quantity("cycle_number", "1", "cycle number, 0 outside cycles"),
    Quantity("branch", "1", "branch of the cycle"),
    Quantity("quality_flag", "1", "quality of tension", standard_name="quality_flag"),
    Quantity(
        "crosshead_position_quality_flag",
        "1",
        "quality of time and crosshead position",
        standard_name="quality_flag",
    ),
    # per cycle
    Quantity("frequency", "Hz", "cycle frequency", "003 f"),
    Quantity("cycle_start_time", "s", "elapsed time at the start of the cycle"),
    Quantity("mean_tension", "N", "mean of peak and valley tension", "003 T_m"),
    Quantity("tension_amplitude", "N", "tension amplitude, half the range", "003 dT"),
    Quantity("mean_strain", "1", "mean of greatest and least strain of the cycle"),
    Quantity("strain_amplitude", "1", "strain amplitude, half the range"),
    Quantity("peak_tension", "N", "greatest tension of the cycle"),
    Quantity("valley_tension", "N", "least tension of the cycle"),
    Quantity(
        "apparent_spring_constant", "N", "tension amplitude over strain amplitude", "003 K_ap, eq 1"
    ),
    Quantity(
        "hysteresis_energy", "J m-1", "closed-loop area, tension against strain", "003 H, eq 4"
    ),
    Quantity("loss_factor", "1", "loss over storage spring constant"),
    Quantity("storage_spring_constant", "N", "in-phase part of the fundamental, force per strain"),
    Quantity("loss_spring_constant", "N", "quadrature part of the fundamental, force per strain"),
    Quantity(
        "fundamental_energy_share", "1", "share of the loop energy that the fundamental carries"
    ),
    Quantity("dynamic_modulus", "Pa", "apparent spring constant over area at zero tension"),
    Quantity("secant_modulus", "Pa", "stress over strain at the peak of the cycle", "002 eq 1"),
    Quantity("chord_modulus", "Pa", "end-to-end slope of a branch"),
    Quantity(
        "stroke_mean_modulus_difference",
        "Pa",
        "ascending minus descending stroke-mean tangent modulus",
    ),
    Quantity(
        "tension_loss_modulus", "Pa", "tension lost over the cycle, over area and strain stroke"
    ),
    Quantity(
        "identity_residual", "1", "closed-cycle identity residual over the stroke-mean modulus"
    ),
    Quantity("dissipation_spring_constant", "N", "dissipation spring constant", "003 K1"),
    Quantity("relaxation_time", "s", "relaxation time of the three-parameter line", "003 tau"),
    Quantity("quasi_static_spring_constant", "N", "slope of the slow pull", "003 K0"),
    # per strain bin
    Quantity("strain_bin", "1", "centre of the strain bin"),
    Quantity(
        "tangent_modulus",
        "Pa",
        "tangent modulus, trimmed branches, mean over the cycles",
        "002 eq 2",
    ),
    Quantity("tangent_modulus_untrimmed", "Pa", "tangent modulus, whole branches"),
    Quantity(
        "tangent_modulus_first_loading", "Pa", "tangent modulus of the first loading of the record"
    ),
    Quantity("tangent_modulus_by_cycle", "Pa", "tangent modulus of one cycle, trimmed branches"),
    Quantity("branch_tension", "N", "mean tension of the branch in the bin"),
    # segments
    Quantity("segment_modulus", "Pa", "slope of a piecewise-linear segment", "002 Tables 5, 6"),
    Quantity("segment_strain_low", "1", "lower strain end of the segment"),
    Quantity("segment_strain_high", "1", "upper strain end of the segment"),
    Quantity("segment_tension_low", "N", "tension at the lower end of the segment"),
    Quantity("segment_tension_high", "N", "tension at the upper end of the segment"),
    Quantity("stress_at_strain", "Pa", "nominal stress at a stated elongation"),
    # splices and specimens
    Quantity("free_length", "m", "splice toe to splice toe"),
    Quantity("relaxed_free_length", "m", "splice toe to splice toe at zero tension", "002 Table 3"),
    Quantity("relaxed_splice_length", "m", "both splices together at zero tension"),
    Quantity("splice_strain", "1", "nominal strain of both splices together"),
    Quantity("mark_strain", "1", "strain of the free length read at the marks"),
    Quantity("mark_tension", "N", "mean tension while the marks were read"),
    Quantity("mark_strain_residual", "1", "strain by the method minus strain at the marks"),
    Quantity(
        "strain_slope_ratio", "1", "strain slope of constant-fraction over that of the method"
    ),
    Quantity("area", "m2", "cross-sectional area at zero tension"),
    Quantity("diameter", "m", "mean diameter before stretch"),
    Quantity("rated_break_strength", "N", "rated break strength", "003 Table 2"),
    Quantity("earlier_maximum_strain", "1", "greatest strain in the specimen's earlier tests"),
    Quantity("earlier_maximum_tension", "N", "greatest tension in the specimen's earlier tests"),
    Quantity("earlier_cycles", "1", "cycles in the specimen's earlier tests"),
    Quantity("permanent_set", "1", "strain left at zero tension after the test"),
    # holds
    Quantity("hold_start_time", "s", "elapsed time at the start of the hold"),
    Quantity("hold_duration", "s", "length of the hold"),
    Quantity("hold_strain", "1", "mean strain in the hold"),
    Quantity("hold_initial_tension", "N", "tension at the start of the hold"),
    Quantity("hold_final_tension", "N", "tension at the end of the hold"),
    Quantity("relaxation_drop", "1", "share of tension lost over the hold"),
    Quantity("relaxation_rate_per_decade", "1", "share of tension lost per decade of time"),
    Quantity("creep_rate_per_decade", "1", "strain gained per decade of time"),
    Quantity("prony_tension", "N", "tension of a Prony term"),
    Quantity("prony_time", "s", "relaxation time of a Prony term"),
    Quantity("long_time_tension", "N", "tension the Prony series tends to"),
    # steps
    Quantity("gauge_length", "m", "distance between gauge marks at zero tension", "002 Table 4"),
    Quantity("eye_to_eye_length", "m", "eye-to-eye length", "002 Table 4"),
    # slips
    Quantity("slip_cycle", "1", "first cycle after a step"),
    Quantity("slip_tension_step", "N", "step of peak tension"),
    Quantity("slip_length", "m", "splice length let out by the step"),
)
QUANTITIES = {row.name: row for row in _ROWS}


def quantity(name: str) -> Quantity:
    """Return the row of a name; `KeyError` where the vocabulary lacks it."""
    return QUANTITIES[name]
