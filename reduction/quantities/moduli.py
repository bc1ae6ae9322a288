"""Quantities of the modulus curves: bins, segments, first loading, rubber, ratios."""

from __future__ import annotations

from reduction.quantities.flags import NO_YES
from reduction.quantities.row import (
    AXIS,
    BOUND,
    CRITERION,
    OF_UNCERTAINTY,
    SETTING,
    SPREAD,
    Quantity,
    along,
    count,
    flag,
    label,
    measured,
    stated,
)

_BIN = ("specimen", "branch_name", "strain_bin")

_COMPARISON = ("comparison",)

_FIRST_BIN = ("specimen", "branch_name", "first_loading_strain_bin")

_FIT = ("elastomer_fit",)

_PARAMETER = ("elastomer_parameter",)

_RATIO = ("comparison", "branch_name", "ratio_strain_bin")

_SEGMENT = ("specimen", "branch_name", "segment")

_SPECIMEN = ("specimen",)


OF_MODULI: tuple[Quantity, ...] = (
    *along(
        ("selected_cycle",),
        count("selected_cycle", "number of a cycle whose curves are stored"),
    ),
    *along(
        ("segment",),
        count("segment", "segment number, from the lowest strain"),
    ),
    *along(
        ("strain_level",),
        stated("strain_level", "1", "stated strain", SETTING),
    ),
    *along(
        ("strain_bin",),
        stated("strain_bin", "1", "centre of the strain bin", AXIS, bounds="strain_bin_bounds"),
    ),
    *along(
        ("strain_bin", "bound"),
        stated("strain_bin_bounds", "1", "edges of the strain bin", BOUND),
    ),
    *along(
        ("first_loading_strain_bin",),
        stated(
            "first_loading_strain_bin",
            "1",
            "centre of the strain bin of the first loading",
            AXIS,
            bounds="first_loading_strain_bin_bounds",
        ),
    ),
    *along(
        ("first_loading_strain_bin", "bound"),
        stated(
            "first_loading_strain_bin_bounds",
            "1",
            "edges of the strain bin of the first loading",
            BOUND,
        ),
    ),
    *along(
        ("ratio_strain_bin",),
        stated("ratio_strain_bin", "1", "centre of the strain bin of the modulus ratio", AXIS),
    ),
    stated("strain_window", "1", "width of the regression window of the tangent modulus", SETTING),
    *along(
        _BIN,
        measured(
            "tangent_modulus",
            "Pa",
            "tangent modulus, trimmed branches, mean over the cycles",
            "_count",
            "_minimum",
            "_maximum",
            "_scatter",
            shares_errors=True,
            tables=("tangent_modulus",),
            source="002 eq 2",
        ),
        measured(
            "branch_tension",
            "N",
            "mean tension of the branch in the strain bin",
            "_count",
            shares_errors=True,
            tables=("tangent_modulus",),
        ),
    ),
    *along(
        _SPECIMEN,
        stated(
            "alignment_strain",
            "1",
            "mean strain to which the cycles are shifted before averaging the curves",
            "a choice of reference; see mean_strain_drift",
            tables=("trend",),
            page=("means", "mean strain to which the cycles are shifted"),
            percent=True,
        ),
        group="curves",
    ),
    *along(
        _BIN,
        measured(
            "tangent_modulus_untrimmed",
            "Pa",
            "tangent modulus, untrimmed branches",
            shares_errors=True,
            tables=("tangent_modulus",),
        ),
        group="curves",
    ),
    *along(
        ("specimen", "selected_cycle", "branch_name", "strain_bin"),
        measured(
            "tangent_modulus_by_cycle", "Pa", "tangent modulus of a single cycle, trimmed branches"
        ),
        group="curves",
    ),
    *along(
        _FIRST_BIN,
        measured(
            "tangent_modulus_first_loading",
            "Pa",
            "tangent modulus of the first loading in the record",
            shares_errors=True,
            tables=("first_loading",),
        ),
        measured(
            "branch_tension_first_loading",
            "N",
            "tension of the first loading in the strain bin",
            shares_errors=True,
            tables=("first_loading",),
        ),
        group="first_loading",
    ),
    *along(
        _SEGMENT,
        measured(
            "segment_tension_low",
            "N",
            "tension at the lower end of the segment",
            shares_errors=True,
            tables=("moduli",),
        ),
        measured(
            "segment_tension_high",
            "N",
            "tension at the upper end of the segment",
            shares_errors=True,
            tables=("moduli",),
        ),
        stated(
            "segment_strain_low",
            "1",
            "strain at the lower end of the segment",
            BOUND,
            tables=("moduli",),
        ),
        stated(
            "segment_strain_high",
            "1",
            "strain at the upper end of the segment",
            BOUND,
            tables=("moduli",),
        ),
        measured(
            "segment_modulus",
            "Pa",
            "modulus of the straight-line segment",
            shares_errors=True,
            tables=("moduli",),
            source="002 Tables 5, 6",
        ),
        stated(
            "segment_misfit",
            "N",
            "rms deviation of the mean branch from the segment",
            SPREAD,
            tables=("moduli",),
        ),
        group="segments",
    ),
    *along(
        (),
        label("segment_criterion", "criterion that chose the number of segments"),
        group="segments",
    ),
    *along(
        ("specimen", "strain_level"),
        measured(
            "stress_at_strain",
            "Pa",
            "nominal stress at a stated strain, first loading",
            shares_errors=True,
            tables=("stress_at_strain",),
        ),
        group="rubber",
    ),
    *along(
        _SPECIMEN,
        measured(
            "slack_strain_at_unloading",
            "1",
            "strain at which the specimen goes slack on unloading",
            shares_errors=True,
            tables=("slack_strain_at_unloading",),
            page=("means", "slack strain on unloading"),
            percent=True,
        ),
        group="rubber",
    ),
    *along(
        _FIT,
        label("elastomer_specimen", "specimen of the elastomer fit"),
        label("elastomer_law", "hyperelastic law"),
        stated(
            "elastomer_rms_stress", "Pa", "root-mean-square residual of the elastomer fit", SPREAD
        ),
        stated("elastomer_strain_low", "1", "lower limit of the fitted strain range", BOUND),
        stated("elastomer_strain_high", "1", "upper limit of the fitted strain range", BOUND),
        flag(
            "elastomer_is_stable", "whether the fitted law is stable over the fitted range", NO_YES
        ),
        stated(
            "elastomer_aicc",
            "1",
            "corrected Akaike criterion of the fit (lower is better)",
            CRITERION,
        ),
        group="rubber",
    ),
    *along(
        _PARAMETER,
        count("elastomer_parameter_fit", "number of the fit to which the parameter belongs"),
        label(
            "elastomer_parameter_name", "name of the parameter of the law", tables=("elastomer",)
        ),
        measured(
            "elastomer_modulus",
            "Pa",
            "parameter of the law with the dimension of a modulus",
            shares_errors=True,
            tables=("elastomer",),
        ),
        measured(
            "elastomer_exponent",
            "1",
            "dimensionless exponent of the law",
            shares_errors=True,
            tables=("elastomer",),
        ),
        group="rubber",
    ),
    *along(
        _COMPARISON,
        label("ratio_numerator", "specimen or cycles in the numerator of the modulus ratio"),
        label("ratio_denominator", "specimen in the denominator of the modulus ratio"),
        group="comparisons",
    ),
    *along(
        _RATIO,
        measured(
            "modulus_ratio",
            "1",
            "ratio of tangent moduli of two specimens, or of cycles and a specimen",
            shares_errors=True,
            tables=("comparison",),
        ),
        stated(
            "modulus_ratio_low",
            "1",
            "lower limit of the 95 % interval of the modulus ratio",
            BOUND,
            tables=("comparison",),
        ),
        stated(
            "modulus_ratio_high",
            "1",
            "upper limit of the 95 % interval of the modulus ratio",
            BOUND,
            tables=("comparison",),
        ),
        flag(
            "modulus_ratio_is_different",
            "whether the interval excludes 1",
            NO_YES,
            tables=("comparison",),
        ),
        stated(
            "modulus_ratio_degrees_of_freedom",
            "1",
            "degrees of freedom of the random part of the modulus ratio",
            OF_UNCERTAINTY,
            tables=("comparison",),
        ),
        group="comparisons",
    ),
)
