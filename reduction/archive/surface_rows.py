"""Variables of one response of an experiment, each named ``<response>_<what>``."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

from reduction.archive.reasons import BOUND, CHECK, CRITERION, NO_YES, PART, SPREAD, STATISTIC
from reduction.archive.shared import COMPONENT
from reduction.archive.variable import Variable, companion, flag, label, measured, stated
from reduction.surface.product import STATIONARY_KINDS

_STATIONARY_FLAGS = {name or "none": code for code, name in STATIONARY_KINDS.items()}

COUNT = "count"
LEVELS = "a property of the levels"
NOT_EVALUATED = "not evaluated by this version"
FROM_SURFACE = "from the surface: see its covariance"
"""Why a variable has no uncertainty beside it, of a response and of its experiment."""

_BASIS = "a direction: see the covariance of the coefficients"

_E = ("experiment",)
_T = ("experiment", "term")
_F = ("experiment", "factor")
_R = ("experiment", "run")
_A = ("experiment", "anova_row")
_P = ("experiment", "plan_column")
_X = ("experiment", "point")
_D = ("experiment", "ridge_direction", "ridge_radius")
_U = ("experiment", COMPONENT)


def rows_of_response(name: str, *, is_transformed: bool) -> Iterator[Variable]:
    """Give the variables of one response; what is measured is not transformed.

    Parameters
    ----------
    name : str
        One of `reduction.vocabulary.SURFACE_NAMES`, or ``response``.
    is_transformed : bool
        True for a surface of a transform: runs and effects are of the response itself.

    Yields
    ------
    row : Variable
    """
    yield from chain(
        *(
            _of_both_parts(of, _T)
            for of in (f"{name}_coefficient", f"{name}_coefficient_engineering")
        ),
        stated(f"{name}_t", _T, STATISTIC),
        stated(f"{name}_p_value", _T, STATISTIC),
        stated(f"{name}_term_degrees_of_freedom", _T, COUNT),
        stated(f"{name}_covariance_factor", (*_T, "term_other"), PART),
        label(f"{name}_transform", _E),
        stated(f"{name}_transform_exponent", _E, "see the ends of its interval"),
        stated(f"{name}_transform_exponent_low", _E, BOUND),
        stated(f"{name}_transform_exponent_high", _E, BOUND),
        stated(f"{name}_n_runs", _E, COUNT),
        label(f"{name}_refusal", _E),
        stated(f"{name}_sigma", _E, SPREAD),
        stated(f"{name}_degrees_of_freedom", _E, COUNT),
        *(
            stated(f"{name}_{what}", _E, CRITERION)
            for what in ("r2", "adjusted_r2", "predicted_r2", "probability_plot_correlation")
        ),
        *(
            stated(f"{name}_{what}", _E, STATISTIC)
            for what in (
                "overall_f",
                "overall_p_value",
                "printed_f",
                "lack_of_fit_f",
                "lack_of_fit_p_value",
            )
        ),
        label(f"{name}_lack_of_fit_refusal", _E),
        *(
            stated(f"{name}_anova_{what}", _A, why)
            for what, why in (
                ("degrees_of_freedom", COUNT),
                ("sum_of_squares", SPREAD),
                ("mean_square", SPREAD),
                ("f", STATISTIC),
                ("p_value", STATISTIC),
            )
        ),
        _of_both_parts(f"{name}_stationary_point", _F),
        stated(f"{name}_stationary_point_engineering", _F, "see the coded one"),
        flag(f"{name}_stationary_point_is_inside", _E, NO_YES),
        stated(f"{name}_stationary_value", _E, FROM_SURFACE),
        flag(f"{name}_stationary_kind", _E, _STATIONARY_FLAGS),
        label(f"{name}_stationary_refusal", _E),
        _of_both_parts(f"{name}_eigenvalue", ("experiment", "direction")),
        stated(f"{name}_eigenvector", ("experiment", "direction", "factor"), _BASIS),
        stated(f"{name}_fitted", _R, FROM_SURFACE),
        stated(f"{name}_residual", _R, CHECK),
        *(
            stated(f"{name}_{what}", _R, "says how much a run counts")
            for what in ("leverage", "cooks_distance")
        ),
        *(
            stated(f"{name}_{what}", _R, CHECK)
            for what in ("studentized_residual", "deleted_residual")
        ),
        measured(f"{name}_reduced_coefficient", _T),
        stated(f"{name}_reduced_coefficient_engineering", _T, "see the coded one"),
        flag(f"{name}_reduced_is_kept", _T, NO_YES),
        stated(f"{name}_reduced_sigma", _E, SPREAD),
        stated(f"{name}_reduced_aicc", _E, CRITERION),
        stated(f"{name}_full_aicc", _E, CRITERION),
        stated(f"{name}_block_effect", ("experiment", "block"), NOT_EVALUATED),
        stated(f"{name}_block_standard_deviation", _E, SPREAD),
        flag(f"{name}_block_at_boundary", _E, NO_YES),
        _of_both_parts(f"{name}_point_value", _X),
        *(
            stated(f"{name}_point_{kind}_{end}", _X, BOUND)
            for kind in ("confidence", "prediction", "simultaneous")
            for end in ("low", "high")
        ),
        stated(f"{name}_point_mean_value", _X, "see the intervals of the value"),
        stated(f"{name}_point_variance_factor", _X, LEVELS),
        flag(f"{name}_point_is_above_leverage", _X, NO_YES),
        stated(f"{name}_ridge_coded_level", (*_D, "factor"), NOT_EVALUATED),
        stated(f"{name}_ridge_level", (*_D, "factor"), NOT_EVALUATED),
        # the runs chose the point, so that only what holds everywhere at once holds there
        stated(f"{name}_ridge_value", _D, "see its simultaneous interval"),
        stated(f"{name}_ridge_simultaneous_low", _D, BOUND),
        stated(f"{name}_ridge_simultaneous_high", _D, BOUND),
    )
    if is_transformed:
        return
    yield from chain(
        measured(f"{name}_measured", _R),
        [companion(f"{name}_measured", "_random_standard_uncertainty", _R)],
        measured(f"{name}_effect", _P, uncertainty_dims=_E),
        stated(f"{name}_effect_t", _P, STATISTIC),
        stated(f"{name}_effect_p_value", _P, STATISTIC),
        flag(f"{name}_effect_is_significant", _P, NO_YES),
        label(f"{name}_effect_refusal", _E),
        stated(f"{name}_effect_size", _P, "that of the effect"),
        stated(f"{name}_effect_half_normal_quantile", _P, "a property of the order"),
        stated(f"{name}_mean", _E, NOT_EVALUATED),
        stated(f"{name}_minimum_significant_effect", _E, BOUND),
        stated(f"{name}_simultaneous_minimum_effect", _E, BOUND),
    )


def _of_both_parts(name: str, dims: tuple[str, ...]) -> list[Variable]:
    """A number with what the runs share and what not, in its uncertainty and apart."""
    return [
        *measured(name, dims),
        companion(name, "_random_standard_uncertainty", dims),
        companion(name, "_uncertainty_contribution", (*_U, *dims[1:])),
    ]
